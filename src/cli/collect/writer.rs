//! Writes collected submissions: a folder for each student, and the list of all.

use std::path::{Component, Path};
use std::{fs, io};

use anstyle::{AnsiColor, Style};
use toyproof_classroom::collect::class::ClassAssignment;
use toyproof_classroom::collect::collection::{Collection, Lateness, Submission};
use toyproof_classroom::collect::naming::{Paths, Student, file_name};
use toyproof_classroom::collect::roster::{Entry, FILE_NAME, Roster, Skipped};
use toyproof_classroom::collect::text::Content;
use toyproof_diagnostic::{grouped, path_name, plural, printable};
use toyproof_image::output;
use toyproof_report::{Detail, Layout};

use crate::cli::{CliError, Terminal};

/// The largest number of skipped files of a student that are printed.
const MAX_NOTES: usize = 10;

/// The output for each student.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Listing {
    /// A line on standard output, and below it what happened to the files.
    Everyone,
    /// Notes on the files, on standard error.
    Notes,
}

/// Writes the submissions of an assignment, or of all, into a folder.
pub(super) struct Writer<'a> {
    pub(super) folder: &'a Path,
    pub(super) assignment: Option<&'a ClassAssignment>,
    pub(super) listing: Listing,
    pub(super) terminal: &'a Terminal,
}

impl Writer<'_> {
    /// Writes the shaders of all students, and the roster, and prints what happened to them.
    pub(super) fn write(&self, collection: &Collection) -> Result<(), CliError> {
        let names = collection.students.iter().map(|(folder, ..)| folder.as_str());
        let layout = Layout::new(names, self.terminal.width(), Detail::Normal, false);
        let mut students = Vec::new();
        let mut unknown = 0;
        for (folder, student, submission) in &collection.students {
            let lateness = submission.lateness(self.assignment);
            unknown += u64::from(lateness == Lateness::Unknown);
            let (entry, notes) = self.write_student(folder, student, submission, lateness)?;
            self.print(&entry, &notes, &layout);
            students.push(entry);
        }
        let with_shader = students.iter().filter(|student| !student.files.is_empty());
        let with_shader = grouped(with_shader.count() as u64);
        let roster = Roster {
            assignment: self.assignment.map(|assignment| assignment.name.clone()),
            students,
        };
        let text = serde_json::to_string_pretty(&roster).map_err(|error| error.to_string())? + "\n";
        let path = self.folder.join(FILE_NAME);
        let written = self.terminal.write_output(self.folder, &path, text.as_bytes());
        if let Err(error) = written {
            self.terminal.fail(&error);
            return Err(CliError::new("the list of students was not written"));
        }
        if unknown > 0 {
            self.terminal.warn(format_args!(
                "{}: {} {} as on time: the download does not state when",
                path_name(self.folder),
                grouped(unknown),
                plural(unknown, "submission counts", "submissions count")
            ));
        }
        let count = roster.students.len() as u64;
        self.terminal.note(&format!(
            "{}{}: {} {}, {with_shader} with a shader",
            if self.listing == Listing::Everyone {
                "\n"
            } else {
                ""
            },
            path_name(self.folder),
            grouped(count),
            plural(count, "student", "students"),
        ));
        Ok(())
    }

    fn write_student(
        &self,
        folder: &str,
        student: &Student,
        submission: &Submission,
        lateness: Lateness,
    ) -> Result<(Entry, Vec<String>), String> {
        let mut entry = Entry {
            folder: folder.to_owned(),
            name: student.name.clone(),
            id: student.id.clone(),
            late: match lateness {
                Lateness::Late(late) => Some(late),
                Lateness::OnTime | Lateness::Unknown => None,
            },
            files: Vec::new(),
            skipped: Vec::new(),
        };
        let mut notes = Vec::new();
        let mut paths = Paths::default();
        for handed in &submission.files {
            let original = handed.original_path();
            let mut skip = |reason: &str| {
                let (file, reason) = (original.clone(), reason.to_owned());
                entry.skipped.push(Skipped { file, reason });
            };
            let belongs = self.assignment.is_none_or(|assignment| assignment.has(&original));
            match &handed.content {
                Err(reason) => skip(reason),
                Ok(Content::Other(reason)) => skip(reason),
                Ok(Content::Text { .. }) if !belongs => {}
                Ok(Content::Text {
                    text,
                    encoding,
                    is_renamed,
                }) => {
                    let (last, parents) = handed.path.split_last().expect("a file has a name");
                    let file = paths.file(parents, &output_name(last, *is_renamed));
                    let path = self.folder.join(folder).join(&file);
                    match output::write_inside(self.folder, &path, text.as_bytes()) {
                        Ok(()) => {}
                        // The path is invalid; another one may be valid.
                        Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
                            skip("its path is too long for this file system");
                            continue;
                        }
                        Err(error) => {
                            return Err(format!(
                                "cannot write {error}\nhelp: not all submissions were written; collect them again"
                            ));
                        }
                    }
                    notes.extend(
                        encoding.map(|encoding| format!("{file} was saved as {encoding}, now as UTF-8")),
                    );
                    notes.extend(
                        is_renamed.then(|| format!("{} is a shader, now {file}", printable(&original))),
                    );
                    entry.files.push(file);
                }
            }
        }
        let skipped = entry.skipped.iter().map(|skipped| {
            let (file, reason) = (printable(&skipped.file), printable(&skipped.reason));
            format!("skipped {file}: {reason}")
        });
        notes.extend(skipped.take(MAX_NOTES));
        if let Some(more @ 1..) = entry.skipped.len().checked_sub(MAX_NOTES) {
            let files = plural(more as u64, "file", "files");
            notes.push(format!(
                "skipped {} more {files}: see {FILE_NAME}",
                grouped(more as u64)
            ));
        }
        Ok((entry, notes))
    }

    fn print(&self, entry: &Entry, notes: &[String], layout: &Layout) {
        if self.listing == Listing::Notes {
            for note in notes {
                self.terminal.note(&format!("{}: {note}", entry.folder));
            }
            return;
        }
        let count = entry.files.len() as u64;
        let late = entry.late.map(|late| format!(", {late}"));
        let (label, color, sentence) = match count {
            0 => ("missing", AnsiColor::Red, "no shader was submitted".to_owned()),
            _ => (
                "collected",
                AnsiColor::Green,
                format!("{} {}", grouped(count), plural(count, "file", "files")),
            ),
        };
        let style = Style::new().fg_color(Some(color.into())).bold();
        let sentence = sentence + &late.unwrap_or_default();
        let mut lines = vec![layout.row((label, style), &entry.folder, &sentence)];
        lines.extend(notes.iter().map(|note| layout.below("", note)));
        self.terminal.result(&lines.join("\n"));
    }
}

/// The name of a collected file: harmless on any system, with a shader's extension in lower case.
fn output_name(name: &str, is_renamed: bool) -> String {
    let name = file_name(name);
    let (stem, extension) = name.rsplit_once('.').unwrap_or((&name, ""));
    match is_renamed {
        false => format!("{stem}.{}", extension.to_lowercase()),
        true if stem.to_lowercase().ends_with(".glsl") => stem.to_lowercase(),
        true if stem.is_empty() => format!("{name}.glsl"),
        true => format!("{stem}.glsl"),
    }
}

/// Removes the files that an earlier run collected into the folders of assignments in a folder; other files
/// stay.
///
/// # Errors
/// The folder only has other files, which `collect` did not write.
pub(super) fn remove_earlier(folder: &Path) -> Result<(), String> {
    let with_path = |error| format!("{}: {error}", path_name(folder));
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(with_path(error)),
    };
    let (mut is_collected, mut is_empty) = (false, true);
    for entry in entries {
        is_empty = false;
        let assignment = entry.map_err(with_path)?.path();
        let Ok(Some(roster)) = Roster::read(&assignment) else {
            continue;
        };
        is_collected = true;
        for student in roster.students {
            let own = assignment.join(&student.folder);
            let is_inside = |path: &Path| path.components().all(|part| matches!(part, Component::Normal(_)));
            if !is_inside(student.folder.as_ref()) {
                continue;
            }
            for file in student.files.iter().filter(|file| is_inside(file.as_ref())) {
                // A file that cannot be removed is written again, or reported as a shader without a student.
                let _ = fs::remove_file(own.join(file));
            }
            let _ = fs::remove_dir(own);
        }
        let _ = fs::remove_file(assignment.join(FILE_NAME));
    }
    if is_collected || is_empty {
        return Ok(());
    }
    Err(format!(
        "{} already has files that toyproof did not collect\nhelp: give the report another folder with --out",
        path_name(folder)
    ))
}
