//! `submissions.json`: the students whose submissions a folder has, so that `check` has a row for each.

use std::fs;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{path_name, printable};

use crate::cli::files::{Input, ReadError};

/// The name of the file.
pub(super) const FILE_NAME: &str = "submissions.json";

/// The students of a folder of submissions.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Roster {
    pub(super) students: Vec<Entry>,
}

/// A student.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Entry {
    /// The folder of the student's files.
    pub(super) folder: String,
    pub(super) name: String,
    pub(super) id: Option<String>,
    /// Whether a file was marked as late.
    pub(super) is_late: bool,
    /// The files that were collected.
    pub(super) files: Vec<String>,
    /// The files that were not.
    pub(super) skipped: Vec<Skipped>,
}

/// A file that was not collected.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Skipped {
    pub(super) file: String,
    pub(super) reason: String,
}

impl Entry {
    /// What was submitted instead of a shader, in parentheses; empty if nothing was.
    fn instead(&self) -> String {
        let list =
            |skipped: &Skipped| printable(&format!("{}: {}", skipped.file, skipped.reason)).into_owned();
        match &self.skipped[..] {
            [] => String::new(),
            [first] => format!(" ({})", list(first)),
            [first, rest @ ..] => format!(" ({}; and {} more)", list(first), rest.len()),
        }
    }
}

/// Adds an error for each student of a collected folder who has no shader, in the order of the paths. Other
/// folders have no roster.
///
/// # Errors
/// The roster cannot be read.
pub(in crate::cli) fn add_missing(
    folder: &Path,
    inputs: &mut Vec<Result<Input, ReadError>>,
) -> Result<(), String> {
    let path = folder.join(FILE_NAME);
    let text = match fs::read(&path) {
        Ok(text) => text,
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
            ) =>
        {
            return Ok(());
        }
        Err(error) => return Err(format!("{}: {error}", path_name(&path))),
    };
    let roster: Roster =
        serde_json::from_slice(&text).map_err(|error| format!("{}: {error}", path_name(&path)))?;
    for student in roster.students {
        let own = folder.join(&student.folder);
        let is_own = |input: &Result<Input, ReadError>| match input {
            Ok(input) => input.path().is_some_and(|path| path.starts_with(&own)),
            Err(error) => Path::new(&error.name()).starts_with(&own),
        };
        if !inputs.iter().any(is_own) {
            let is_later = |input: &Result<Input, ReadError>| match input {
                Ok(input) => input
                    .path()
                    .is_some_and(|path| path.starts_with(folder) && *path > *own),
                Err(_) => false,
            };
            let at = inputs.iter().position(is_later).unwrap_or(inputs.len());
            let instead = student.instead();
            inputs.insert(at, Err(ReadError::NotSubmitted(own, instead)));
        }
    }
    inputs.retain(|input| !matches!(input, Err(ReadError::NoShader(empty)) if empty == folder));
    Ok(())
}
