//! `submissions.json`: the students whose submissions a folder has, so that `check` has a row for each.

use std::collections::{HashMap, HashSet};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{grouped, path_name, plural, printable};
use toyproof_image::{input, output};
use toyproof_project::files::{Input, ReadError};
use toyproof_report::{Late, StudentSubmission};
use toyproof_toml::Moment;

use super::lateness::{Lateness, SubmissionTime};
use super::naming::file_name;

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
    /// Whether the class has a deadline for the assignment, which `late` refers to.
    #[serde(default)]
    pub has_deadline: bool,
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
    /// What the names of the student's files in the download begin with: a folder with `/`, or the start of
    /// file names; null if the student is not in the download.
    #[serde(default)]
    pub download: Option<String>,
    /// When the files were submitted.
    #[serde(default = "unknown")]
    pub time: SubmissionTime,
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

/// The time in a list that an earlier version wrote.
fn unknown() -> SubmissionTime {
    SubmissionTime {
        is_unknown: true,
        ..SubmissionTime::default()
    }
}

impl Entry {
    /// The path of the student's page, under the name that the download has for the student.
    fn page(&self) -> String {
        // The list may be edited, and names in archives are the students' own.
        let is_usable = |download: &&String| {
            let name = download.strip_suffix('/').unwrap_or(download);
            !matches!(name, "" | "." | "..")
                && name.len() <= MAX_DOWNLOAD_BYTES
                && !name.contains(|character: char| "/\\:".contains(character) || character.is_control())
        };
        match self.download.as_ref().filter(is_usable) {
            Some(download) => format!("{download}{FEEDBACK_NAME}"),
            None => format!("{}/{FEEDBACK_NAME}", file_name(&self.folder)),
        }
    }

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

    /// Computes how late the submissions are, unless the class has a deadline; returns how many have no
    /// time, and so count as on time.
    fn set_deadline(&mut self, deadline: Option<Moment>) -> u64 {
        if self.has_deadline || deadline.is_none() {
            return 0;
        }
        let mut unknown = 0;
        for student in &mut self.students {
            match student.time.lateness(deadline) {
                Lateness::Late(late) => student.late = Some(late),
                Lateness::OnTime => student.late = None,
                // The list of an earlier version has marks, but no times.
                Lateness::Unknown => unknown += u64::from(student.late.is_none()),
            }
        }
        unknown
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

/// The warning of submissions in a folder without a time, which count as on time.
#[must_use]
pub fn unknown_times(folder: &Path, count: u64) -> String {
    format!(
        "{}: {} {} as on time: the download does not state when",
        path_name(folder),
        grouped(count),
        plural(count, "submission counts", "submissions count")
    )
}

/// The name of the page that a student reads.
pub const FEEDBACK_NAME: &str = "feedback.html";

/// The longest name in a download that the path of a page begins with, in bytes: file systems can store it
/// with the name of the page.
const MAX_DOWNLOAD_BYTES: usize = 240;

/// A student whose folder has inputs.
#[derive(Debug, Clone)]
pub struct Owner {
    /// Whose they are.
    pub submitted: StudentSubmission,
    /// The path of the student's page in an archive that the learning management system reads, with `/`.
    pub page: String,
}

/// The owners of inputs, by the folders of students.
#[derive(Debug, Default)]
pub struct Owners {
    students: HashMap<PathBuf, Owner>,
}

impl Owners {
    /// Reads the rosters of folders, and adds an error for each student who has no shader, in the order of
    /// the paths. Other folders have no roster; a file that is not one is ignored with a warning. Where a
    /// class has no deadline, that of the assignment counts.
    pub fn read(
        folders: &[PathBuf],
        inputs: &mut Vec<Result<Input, ReadError>>,
        deadline: Option<Moment>,
        mut warn: impl FnMut(String),
    ) -> Self {
        let mut owners = Self::default();
        for folder in folders {
            let mut roster = match Roster::read(folder) {
                Ok(Some(roster)) => roster,
                Ok(None) => continue,
                Err(error) => {
                    warn(error);
                    continue;
                }
            };
            if let unknown @ 1.. = roster.set_deadline(deadline) {
                warn(unknown_times(folder, unknown));
            }
            add_missing(folder, &roster, inputs);
            let students = roster.students.into_iter().map(|student| {
                let page = student.page();
                let submitted = StudentSubmission {
                    assignment: roster.assignment.clone(),
                    student: student.name,
                    id: student.id,
                    late: student.late,
                };
                (folder.join(student.folder), Owner { submitted, page })
            });
            owners.students.extend(students);
        }
        owners
    }

    /// The student who submitted an input, if any.
    #[must_use]
    pub fn find(&self, input: &Result<Input, ReadError>) -> Option<&Owner> {
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
    fn pages_have_the_names_of_the_download_and_stay_in_their_folder() {
        for (download, expected) in [
            (
                Some("Anna Smith_1_assignsubmission_file_/"),
                "Anna Smith_1_assignsubmission_file_/feedback.html",
            ),
            (Some("smithanna_1_2_"), "smithanna_1_2_feedback.html"),
            (None, "Anna-Smith/feedback.html"),
            (Some("../"), "Anna-Smith/feedback.html"),
            (Some("a/../../"), "Anna-Smith/feedback.html"),
            (Some("a\\b/"), "Anna-Smith/feedback.html"),
            (Some("/"), "Anna-Smith/feedback.html"),
        ] {
            let entry = Entry {
                folder: "Anna-Smith".to_owned(),
                name: "Anna Smith".to_owned(),
                id: None,
                download: download.map(str::to_owned),
                time: unknown(),
                late: None,
                files: Vec::new(),
                skipped: Vec::new(),
            };
            assert_eq!(entry.page(), expected, "{download:?}");
        }
    }

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
