//! The reports that are written to `--out` in addition to the images.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use toyproof_diagnostic::path_name;
use toyproof_image::output;
use toyproof_report::{
    ClassTable, MAX_PAGE_SHADERS, PARTS, Report, Rubrics, csv, html, html_index, html_part, junit, part_name,
    sarif,
};
use toyproof_verify::contain::{Part, contain};

use super::images::{Shown, gallery, thumbnails};
use super::options::BatchOptions;
use super::submission::Submission;
use crate::cli::Terminal;

/// The file names of the reports, in the order in which they are written: once the last exists, all do.
pub(super) const REPORT_NAMES: [&str; 7] = [
    "report.html",
    "report.csv",
    "class.csv",
    "junit.xml",
    "report.sarif",
    "results.json",
    "verdict.json",
];

/// Writes the reports into the folder; returns false on failure. The submissions are those of the report's
/// records, in the same order. `results.json` is written only with a rubric of all shaders and unless they
/// are those of several students, and `class.csv` only for a class. Students read `junit.xml` and
/// `results.json`, which show the hints for them.
pub(super) fn write(
    report: &Report,
    submissions: &[&Submission],
    rubrics: &Rubrics,
    options: &BatchOptions,
    out: &Path,
    terminal: &Terminal,
) -> bool {
    let hints = options.students_hints;
    let [page, table, class, tests, log, marks, verdicts] = REPORT_NAMES;
    let records = report.shaders();
    let date = SystemTime::now();
    let mut folder = Folder {
        out,
        terminal,
        is_complete: true,
    };
    folder.write_pages(page, report, submissions, rubrics, date);
    folder.write(table, |file| csv(records, rubrics, file));
    if submissions.iter().any(|submission| submission.is_assigned()) {
        folder.write(class, |file| ClassTable::new(records, rubrics).csv(file));
    }
    folder.write(tests, |file| junit(records, hints, file));
    folder.write(log, |file| sarif(records, file));
    match rubrics.common() {
        Some(rubric) if !are_of_several_students(submissions) => folder.write(marks, |file| {
            let images = thumbnails(submissions, rubric);
            options
                .platform
                .write_results(records, rubric, hints, &images, file)
        }),
        _ => {
            folder.remove(marks);
        }
    }
    folder.write(verdicts, |file| report.json(file));
    folder.is_complete
}

/// Whether the submissions are known to be those of several students.
fn are_of_several_students(submissions: &[&Submission]) -> bool {
    let mut students = submissions
        .iter()
        .filter_map(|submission| submission.submitted.as_ref())
        .map(|submitted| (&submitted.student, &submitted.id));
    let first = students.next();
    students.any(|student| Some(student) != first)
}

/// The folder of the reports.
struct Folder<'a> {
    out: &'a Path,
    terminal: &'a Terminal,
    /// Whether everything was written.
    is_complete: bool,
}

impl Folder<'_> {
    /// Writes a file, given by its path in the folder. A failure costs only this file.
    fn write(&mut self, path: impl AsRef<Path>, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) {
        let path = self.out.join(path);
        let written = contain(Part::Report, || output::stream_inside(self.out, &path, write));
        match written {
            Ok(Ok(())) => return,
            Ok(Err(error)) => self.terminal.error(format_args!("cannot write {error}")),
            Err(panic) => self
                .terminal
                .error(format_args!("cannot write {}: {panic}", path_name(&path))),
        }
        self.is_complete = false;
    }

    /// Removes a file of an earlier run; returns whether there is none now.
    fn remove(&mut self, path: impl AsRef<Path>) -> bool {
        let removed = output::remove_inside(self.out, &self.out.join(path));
        if let Err(error) = &removed {
            self.terminal.error(format_args!("cannot remove {error}"));
            self.is_complete = false;
        }
        removed.is_ok()
    }

    /// Writes the page, or the table and the pages of the parts of a large report, and removes those of an
    /// earlier, larger one.
    fn write_pages(
        &mut self,
        name: &str,
        report: &Report,
        submissions: &[&Submission],
        rubrics: &Rubrics,
        date: SystemTime,
    ) {
        let mut parts = 0;
        if submissions.len() <= MAX_PAGE_SHADERS {
            self.write(name, |file| {
                file.write_all(html(report, rubrics, &gallery(submissions, Shown::All), date).as_bytes())
            });
        } else {
            for submissions in submissions.chunks(MAX_PAGE_SHADERS) {
                parts += 1;
                self.write(part_path(parts), |file| {
                    let page = html_part(report, parts, rubrics, &gallery(submissions, Shown::All), date);
                    file.write_all(page.as_bytes())
                });
            }
            self.write(name, |file| {
                file.write_all(html_index(report, rubrics, date).as_bytes())
            });
        }
        for stale in (parts + 1..).map(part_path) {
            if !self.out.join(&stale).exists() || !self.remove(&stale) {
                return;
            }
        }
    }
}

/// The path of a page in the folder.
fn part_path(number: usize) -> PathBuf {
    Path::new(PARTS).join(part_name(number))
}
