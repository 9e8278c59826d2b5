//! `submissions.json`: the students whose submissions a folder has, so that `check` has a row for each.

use std::collections::{HashMap, HashSet};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{path_name, printable};
use toyproof_image::{input, output};
use toyproof_project::files::{Input, ReadError};
use toyproof_report::{Late, StudentSubmission};

/// The name of the file.
pub const FILE_NAME: &str = "submissions.json";

/// The maximum size of the file, in bytes: a million students. A student may have a file of this name, of
/// any size.
const MAX_BYTES: u64 = 256 << 20;

/// The students of a folder of submissions.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Roster {
    /// The name of the assignment, if a class has several.
    #[serde(default)]
    pub assignment: Option<String>,
    /// The students.
    pub students: Vec<Entry>,
}

/// A student.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Entry {
    /// The folder of the student's files.
    pub folder: String,
    /// The student's name.
    pub name: String,
    /// The student's number, if there is one.
    pub id: Option<String>,
    /// How late the files are; null if they are not.
    #[serde(default)]
    pub late: Option<Late>,
    /// The files that were collected.
    pub files: Vec<String>,
    /// The files that were not.
    pub skipped: Vec<SkippedFile>,
}

/// A file that was not collected.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SkippedFile {
    /// The path.
    pub file: String,
    /// Why, in one sentence.
    pub reason: String,
}

impl Entry {
    /// The files submitted instead of a shader, in parentheses; empty if there are none.
    fn instead(&self) -> String {
        let list =
            |skipped: &SkippedFile| printable(&format!("{}: {}", skipped.file, skipped.reason)).into_owned();
        match &self.skipped[..] {
            [] => String::new(),
            [first] => format!(" ({})", list(first)),
            [first, rest @ ..] => format!(" ({}; and {} more)", list(first), rest.len()),
        }
    }
}

impl Roster {
    /// Reads the roster of a folder; `None` if it has none. In a folder that `collect` did not write, a
    /// student may have a file or a folder of this name.
    ///
    /// # Errors
    /// The file is not a roster, and is ignored.
    pub fn read(folder: &Path) -> Result<Option<Self>, String> {
        let path = folder.join(FILE_NAME);
        if matches!(path.metadata(), Err(error) if error.kind() != io::ErrorKind::PermissionDenied) {
            return Ok(None);
        }
        let name = path_name(&path);
        let not_roster = |error: io::Error| format!("{name} is not a list of students: {error}");
        let file = input::open(&path).map_err(not_roster)?;
        let bytes = file.metadata().map_or(0, |metadata| metadata.len());
        if bytes > MAX_BYTES {
            return Err(format!(
                "{name} is too large: a list of students has at most {} MiB",
                MAX_BYTES >> 20
            ));
        }
        let mut text = Vec::new();
        let read = file.take(MAX_BYTES).read_to_end(&mut text);
        let parsed = read.and_then(|_| Ok(serde_json::from_slice(&text)?));
        parsed.map(Some).map_err(not_roster)
    }

    /// Writes the roster into a folder.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        let text = serde_json::to_string_pretty(self).map_err(|error| error.to_string())? + "\n";
        let written = output::write_inside(folder, &folder.join(FILE_NAME), text.as_bytes());
        written.map_err(|error| format!("cannot write {error}"))
    }
}

/// The owners of inputs, by the folders of students.
#[derive(Debug, Default)]
pub struct Owners {
    students: HashMap<PathBuf, StudentSubmission>,
}

impl Owners {
    /// Reads the rosters of folders, and adds an error for each student who has no shader, in the order of
    /// the paths. Other folders have no roster; a file that is not one is ignored with a warning.
    pub fn read(
        folders: &[PathBuf],
        inputs: &mut Vec<Result<Input, ReadError>>,
        mut warn: impl FnMut(String),
    ) -> Self {
        let mut owners = Self::default();
        for folder in folders {
            let roster = match Roster::read(folder) {
                Ok(Some(roster)) => roster,
                Ok(None) => continue,
                Err(error) => {
                    warn(error);
                    continue;
                }
            };
            add_missing(folder, &roster, inputs);
            let students = roster.students.into_iter().map(|student| {
                let submitted = StudentSubmission {
                    assignment: roster.assignment.clone(),
                    student: student.name,
                    id: student.id,
                    late: student.late,
                };
                (folder.join(student.folder), submitted)
            });
            owners.students.extend(students);
        }
        owners
    }

    /// The student who submitted an input, if any.
    #[must_use]
    pub fn find(&self, input: &Result<Input, ReadError>) -> Option<&StudentSubmission> {
        let path = input_path(input)?;
        path.ancestors().find_map(|folder| self.students.get(folder))
    }
}

fn input_path(input: &Result<Input, ReadError>) -> Option<PathBuf> {
    match input {
        Ok(input) => input.path().map(Path::to_owned),
        Err(ReadError::NotSubmitted(folder, _)) => Some(folder.clone()),
        Err(error) => Some(error.name().into()),
    }
}

/// Adds an error for each student without a shader to the inputs of a folder, which are together and in the
/// order of their paths.
fn add_missing(folder: &Path, roster: &Roster, inputs: &mut Vec<Result<Input, ReadError>>) {
    let is_of_folder =
        |input: &Result<Input, ReadError>| input_path(input).is_some_and(|path| path.starts_with(folder));
    let at = inputs.iter().position(is_of_folder).unwrap_or(inputs.len());
    let count = inputs[at..]
        .iter()
        .take_while(|input| is_of_folder(input))
        .count();
    let mut own: Vec<_> = inputs.drain(at..at + count).collect();
    own.retain(|input| !matches!(input, Err(ReadError::NoShader(empty)) if empty == folder));
    let first_part = |input: &Result<Input, ReadError>| {
        let path = input_path(input)?;
        let part = path.strip_prefix(folder).ok()?.iter().next()?;
        Some(part.to_owned())
    };
    let present: HashSet<_> = own.iter().filter_map(first_part).collect();
    let absent = roster.students.iter().filter(|student| {
        let folder: &std::ffi::OsStr = student.folder.as_ref();
        !present.contains(folder)
    });
    own.extend(absent.map(|student| {
        let own = folder.join(&student.folder);
        Err(ReadError::NotSubmitted(own, student.instead()))
    }));
    own.sort_by_cached_key(input_path);
    inputs.splice(at..at, own);
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use super::*;

    #[test]
    fn a_roster_above_the_limit_is_too_large_and_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = File::create(folder.path().join(FILE_NAME)).unwrap();
        // The file has no blocks on the disk.
        file.set_len(MAX_BYTES + 1).unwrap();
        let error = Roster::read(folder.path()).unwrap_err();
        assert!(
            error.ends_with("submissions.json is too large: a list of students has at most 256 MiB"),
            "{error}"
        );
        file.set_len(2).unwrap();
        let error = Roster::read(folder.path()).unwrap_err();
        assert!(error.contains("is not a list of students"), "{error}");
    }
}
