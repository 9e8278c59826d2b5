//! The decisions of a teacher that apply to the shaders of one command.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use toyproof_classroom::decisions::{Decisions, FILE_NAME};
use toyproof_report::{Record, StudentSubmission};

use super::submission::Submission;
use crate::cli::shader::parse_named;
use crate::cli::{CliError, Terminal};

/// Collects the decisions from the file that the user names, else from those beside the class and the
/// assignments.
#[derive(Default)]
pub(super) struct DecisionFiles {
    decisions: Decisions,
    /// The files that were read, by their canonical paths, and for which assignment; `None` for all.
    read: HashSet<(PathBuf, Option<String>)>,
    is_given: bool,
}

impl DecisionFiles {
    /// Reads the file that the user names, or that beside the class.
    pub(super) fn new(given: Option<&Path>, class: Option<&Path>) -> Result<Self, CliError> {
        let mut files = Self::default();
        match (given, class) {
            (Some(path), _) => {
                files.read(path, None)?;
                files.is_given = true;
            }
            (None, Some(class)) => files.add_beside(class, None)?,
            (None, None) => {}
        }
        Ok(files)
    }

    /// Reads the file beside that of a class or of an assignment, if there is one. `assignment` is its name
    /// in a class.
    pub(super) fn add_beside(&mut self, path: &Path, assignment: Option<&str>) -> Result<(), CliError> {
        let file = path.with_file_name(FILE_NAME);
        if self.is_given || !file.is_file() {
            return Ok(());
        }
        self.read(&file, assignment)
    }

    fn read(&mut self, file: &Path, assignment: Option<&str>) -> Result<(), CliError> {
        let path = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        let is_known = self.read.contains(&(path.clone(), None));
        if !is_known && self.read.insert((path, assignment.map(str::to_owned))) {
            let decisions = parse_named(file, |files, id| Decisions::parse(files, id, assignment))?;
            self.decisions.extend(decisions);
        }
        Ok(())
    }

    /// The decisions; warns of those that are on none of the submissions, or on several students.
    pub(super) fn finish(self, submissions: &[Submission], terminal: &Terminal) -> Decisions {
        let shaders: Vec<(String, Option<&StudentSubmission>)> = submissions
            .iter()
            .map(|submission| (submission.shown_name(), submission.submitted.as_ref()))
            .collect();
        for (warning, help) in self.decisions.warnings(&shaders) {
            terminal.warn(warning);
            if let Some(help) = help {
                terminal.help(help);
            }
        }
        self.decisions
    }
}

/// The record with the decision on it, if there is one. Records that later runs reuse have none.
pub(super) fn decided(record: Record, decisions: &Decisions) -> Record {
    match decisions.find(&record.shader, record.submitted.as_ref()) {
        Some(decision) => record.with_decision(decision),
        None => record,
    }
}
