//! The reports that are written to `--out` in addition to the images.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use toyproof_diagnostic::path_name;
use toyproof_image::output;
use toyproof_report::{
    ClassTable, Hints, LargeReport, MAX_PAGE_SHADERS, MAX_SHADERS_WITH_IMAGES, PARTS, Report, Rubrics, csv,
    gradescope, html, junit, part_name, sarif,
};
use toyproof_verify::contain::{Part, contain};

use super::images::{gallery, gallery_of_sources, thumbnails};
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
/// `results.json`, which show the `hints`.
pub(super) fn write(
    report: &Report,
    submissions: &[&Submission],
    rubrics: &Rubrics,
    hints: Hints,
    out: &Path,
    terminal: &Terminal,
) -> bool {
    let [page, table, class, tests, log, marks, verdicts] = REPORT_NAMES;
    let records = report.shaders();
    let date = SystemTime::now();
    let mut folder = Folder {
        out,
        terminal,
        is_complete: true,
    };
    folder.write_pages(page, report, submissions, rubrics, date);
    folder.write(Path::new(table), |file| csv(records, rubrics, file));
    if submissions.iter().any(|submission| submission.is_assigned()) {
        folder.write(Path::new(class), |file| {
            ClassTable::of(records, rubrics)?.csv(file)
        });
    }
    folder.write(Path::new(tests), |file| junit(records, hints, file));
    folder.write(Path::new(log), |file| sarif(records, file));
    match rubrics.of_all() {
        Some(rubric) if !are_of_several_students(submissions) => folder.write(Path::new(marks), |file| {
            gradescope(records, rubric, hints, &thumbnails(submissions, rubric), file)
        }),
        _ => folder.remove(Path::new(marks)),
    }
    folder.write(Path::new(verdicts), |file| report.json(file));
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
    fn write(&mut self, path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) {
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

    /// Removes a file of an earlier run.
    fn remove(&mut self, path: &Path) {
        if let Err(error) = output::remove_inside(self.out, &self.out.join(path)) {
            self.terminal.error(format_args!("cannot remove {error}"));
            self.is_complete = false;
        }
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
        if report.shaders().len() <= MAX_PAGE_SHADERS {
            self.write(Path::new(name), |file| {
                file.write_all(html(report, rubrics, &gallery(submissions), date)?.as_bytes())
            });
        } else {
            let gallery = if submissions.len() > MAX_SHADERS_WITH_IMAGES {
                gallery_of_sources
            } else {
                gallery
            };
            let large = LargeReport::new(report);
            for part in large.parts() {
                parts = part.number();
                self.write(&part_path(parts), |file| {
                    let page = part.html(rubrics, &gallery(&submissions[part.places()]), date)?;
                    file.write_all(page.as_bytes())
                });
            }
            self.write(Path::new(name), |file| large.index(rubrics, date, file));
        }
        let stale = (parts + 1..).map(|number| self.out.join(part_path(number)));
        for stale in stale.take_while(|path| path.exists()) {
            if let Err(error) = output::remove_inside(self.out, &stale) {
                self.terminal.error(format_args!("cannot remove {error}"));
                self.is_complete = false;
                return;
            }
        }
    }
}

/// The path of a page in the folder.
fn part_path(number: usize) -> PathBuf {
    Path::new(PARTS).join(part_name(number))
}
