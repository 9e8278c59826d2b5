//! Writes collected submissions, and prints what happened to the files of each student.

use std::path::Path;

use anstyle::{AnsiColor, Style};
use toyproof_classroom::collect::class::ClassAssignment;
use toyproof_classroom::collect::collection::Collection;
use toyproof_classroom::collect::lateness::Lateness;
use toyproof_classroom::collect::roster::{Entry, Roster, unknown_times};
use toyproof_classroom::collect::storage::write_student;
use toyproof_diagnostic::{grouped, path_name, plural};
use toyproof_report::{Detail, Layout};

use crate::cli::{CliError, Terminal};

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
        let names = collection.students.iter().map(|own| own.name.as_str());
        let layout = Layout::new(names, self.terminal.width(), Detail::Normal);
        let deadline = self.assignment.and_then(|assignment| assignment.deadline);
        let mut students = Vec::new();
        let mut unknown = 0;
        for own in &collection.students {
            let lateness = own.submission.time(self.assignment).lateness(deadline);
            unknown += u64::from(lateness == Lateness::Unknown);
            let (entry, notes) = write_student(self.folder, self.assignment, own, lateness)?;
            self.print(&entry, &notes, &layout);
            students.push(entry);
        }
        let with_shader = students.iter().filter(|student| !student.files.is_empty());
        let with_shader = grouped(with_shader.count() as u64);
        let roster = Roster {
            assignment: self.assignment.map(|assignment| assignment.name.clone()),
            has_deadline: deadline.is_some(),
            students,
        };
        if let Err(error) = roster.write(self.folder) {
            self.terminal.error(error);
            return Err(CliError::new("the list of students was not written"));
        }
        if unknown > 0 {
            self.terminal.warn(unknown_times(self.folder, unknown));
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
