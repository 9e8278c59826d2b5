//! A page for each student, under the names that a learning management system gave to the submissions.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use toyproof_classroom::collect::naming::is_archive;
use toyproof_classroom::collect::roster::FEEDBACK_NAME;
use toyproof_diagnostic::{grouped, path_name, plural};
use toyproof_image::output;
use toyproof_project::archive::{self, Mode};
use toyproof_report::{Hints, Record, Report, Rubrics, StudentImages, StudentSubmission, Visibility, html};

use super::images::{Shown, gallery};
use super::options::BatchOptions;
use super::submission::Submission;
use crate::cli::Terminal;

/// The shaders of a student, as indices into the report.
struct Student {
    /// The assignment of a class, if there are several.
    assignment: Option<String>,
    /// The path of the page, with `/`.
    page: String,
    shaders: Vec<usize>,
}

/// Writes a page for each student, if the options ask for them; returns false on failure. The submissions are
/// those of the report's records, in the same order.
pub(super) fn write(
    report: &Report,
    submissions: &[&Submission],
    rubrics: &Rubrics,
    options: &BatchOptions,
    terminal: &Terminal,
) -> bool {
    let (Some(target), Some(out)) = (&options.feedback, &options.out) else {
        return true;
    };
    let students = students(submissions, out);
    let page = |student: &Student| {
        let of_student: Vec<_> = student.shaders.iter().map(|&index| submissions[index]).collect();
        page(report, student, &of_student, rubrics, options.students_hints)
    };
    let written = if is_archive(target) {
        write_archives(target, &students, page)
    } else {
        write_folder(target, &students, page)
    };
    match written {
        Ok(names) => {
            let count = students.len() as u64;
            let pages = format!("{} {}", grouped(count), plural(count, "page", "pages"));
            terminal.note(&format!("feedback: {} ({pages})", names.join(", ")));
            true
        }
        Err(error) => {
            terminal.error(format_args!("cannot write {error}"));
            false
        }
    }
}

/// The students, each with a page of its own. A shader of an unknown student has one, too.
fn students(submissions: &[&Submission], out: &Path) -> Vec<Student> {
    let assignment = |submission: &Submission| submission.submitted.as_ref()?.assignment.clone();
    let assignments: BTreeSet<_> = submissions.iter().map(|one| assignment(one)).collect();
    let are_several = assignments.len() > 1;
    let mut places: BTreeMap<(Option<String>, Option<String>, String), usize> = BTreeMap::new();
    let mut used = HashSet::new();
    let mut students: Vec<Student> = Vec::new();
    for (index, submission) in submissions.iter().enumerate() {
        let Some(page) = submission
            .page
            .clone()
            .or_else(|| page_of_shader(submission, out))
        else {
            continue;
        };
        let assignment = assignment(submission).filter(|_| are_several);
        let name = |submitted: &StudentSubmission| format!("{:?}", (&submitted.student, &submitted.id));
        let owner = (
            assignment.clone(),
            submission.submitted.as_ref().map(name),
            page.clone(),
        );
        let place = *places.entry(owner).or_insert_with(|| {
            let page = unused(&page, |page| {
                used.insert((assignment.clone(), page.to_lowercase()))
            });
            students.push(Student {
                assignment,
                page,
                shaders: Vec::new(),
            });
            students.len() - 1
        });
        students[place].shaders.push(index);
    }
    students
}

/// The page of a shader whose author is unknown: in a folder with its name.
fn page_of_shader(submission: &Submission, out: &Path) -> Option<String> {
    let stem = submission.output_stem.as_ref()?.strip_prefix(out).ok()?;
    let parts: Vec<_> = stem.iter().map(|part| part.to_string_lossy()).collect();
    Some(format!("{}/{FEEDBACK_NAME}", parts.join("/")))
}

/// A path that no other student has: this one, or one with a number.
fn unused(page: &str, mut insert: impl FnMut(&str) -> bool) -> String {
    let start = page.strip_suffix(FEEDBACK_NAME).unwrap_or(page);
    let numbered = (2_u64..).map(|number| format!("{start}{number}-{FEEDBACK_NAME}"));
    std::iter::once(page.to_owned())
        .chain(numbered)
        .find(|page| insert(page))
        .expect("one of endlessly many names is free")
}

/// The page of a student: that of the report, with nothing of others, and of the mistakes only what the hints
/// permit. Edits may have expressions of the reference or of other students, so their lines alone are shown.
fn page(
    report: &Report,
    student: &Student,
    submissions: &[&Submission],
    rubrics: &Rubrics,
    hints: Hints,
) -> String {
    let hints = hints.min(Hints::Line);
    let records = student.shaders.iter().map(|&index| {
        let record = report.shaders()[index].clone().redacted(hints);
        // Paths and other commands are those of the teacher's files.
        let help = record.help.clone();
        let file_name = |path: &String| {
            let name = Path::new(path).file_name();
            name.map_or_else(|| path.clone(), |name| name.to_string_lossy().into_owned())
        };
        Record {
            help: help.filter(|help| help.starts_with("toyproof explain ")),
            scene: record.scene.as_ref().map(file_name),
            reference: record.reference.as_ref().map(file_name),
            ..record
        }
    });
    let records: Vec<Record> = records.collect();
    let rubric = records.iter().find_map(|record| rubrics.find(record));
    let images = rubric.map_or(StudentImages::All, |rubric| rubric.images);
    let is_hidden = rubric.is_some_and(|rubric| matches!(rubric.visibility, Visibility::Hidden));
    let rubrics = if is_hidden { &Rubrics::default() } else { rubrics };
    let gallery = gallery(submissions, Shown::Student(images, hints));
    let report = Report::new(report.device().map(str::to_owned), records);
    html(&report, rubrics, &gallery, SystemTime::now())
}

/// Writes the pages into a folder, with a folder for each of several assignments; returns its name.
fn write_folder(
    folder: &Path,
    students: &[Student],
    page: impl Fn(&Student) -> String,
) -> io::Result<Vec<String>> {
    for student in students {
        let of_assignment = folder.join(student.assignment.as_deref().unwrap_or_default());
        let path = of_assignment.join(&student.page);
        output::write_inside(folder, &path, page(student).as_bytes())?;
    }
    Ok(vec![path_name(folder)])
}

/// Packs the pages into an archive, or into one for each of several assignments; returns their names.
fn write_archives(
    archive: &Path,
    students: &[Student],
    page: impl Fn(&Student) -> String,
) -> io::Result<Vec<String>> {
    let mut by_assignment: BTreeMap<&Option<String>, Vec<&Student>> = BTreeMap::new();
    for student in students {
        by_assignment
            .entry(&student.assignment)
            .or_default()
            .push(student);
    }
    let mut names = Vec::new();
    for (assignment, students) in by_assignment {
        let pages: Vec<String> = students.iter().map(|student| page(student)).collect();
        let files: Vec<_> = students
            .iter()
            .zip(&pages)
            .map(|(student, page)| (student.page.as_str(), Mode::Plain, page.as_bytes()))
            .collect();
        let path = archive_path(archive, assignment.as_deref());
        output::write(&path, &archive::pack(&files)?)?;
        names.push(path_name(&path));
    }
    Ok(names)
}

/// The archive of an assignment: `feedback-torus.zip` for `feedback.zip`.
fn archive_path(archive: &Path, assignment: Option<&str>) -> PathBuf {
    let Some(assignment) = assignment else {
        return archive.to_owned();
    };
    let stem = archive.file_stem().unwrap_or_default().to_string_lossy();
    archive.with_file_name(format!("{stem}-{assignment}.zip"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_student_has_a_path_and_each_assignment_an_archive() {
        let mut used = HashSet::new();
        let mut path = |page: &str| unused(page, |page| used.insert(page.to_lowercase()));
        assert_eq!(path("Mai/feedback.html"), "Mai/feedback.html");
        assert_eq!(path("mai/feedback.html"), "mai/2-feedback.html");
        assert_eq!(path("mai_1_2_feedback.html"), "mai_1_2_feedback.html");
        let archive = Path::new("a/feedback.zip");
        assert_eq!(
            archive_path(archive, Some("torus")),
            Path::new("a/feedback-torus.zip")
        );
        assert_eq!(archive_path(archive, None), archive);
    }
}
