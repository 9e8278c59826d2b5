//! The submissions of all students in downloads.

use std::collections::{BTreeMap, HashSet};
use std::io;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::path_name;
use toyproof_project::archive::FileTime;
use toyproof_project::files;

use super::class::{Class, ClassAssignment, StudentList};
use super::download::{self, DownloadFile};
use super::lateness::SubmissionTime;
use super::naming::{Paths, Student, SubmissionPath, is_archive, submission_path};
use super::roster::FILE_NAME;
use super::students::Students;
use super::text::{self, Content};

/// Times of files that are this close, in seconds, are those of one copy.
const COPY_SECONDS: i64 = 60;

/// A file of a student.
#[derive(Debug)]
pub struct SubmittedFile {
    /// The path in the submission.
    pub path: Vec<String>,
    /// The content, or why it cannot be read.
    pub content: Result<Content, String>,
    /// What the names of the student's files in the download begin with, as in [`SubmissionPath`].
    pub download: String,
    pub(super) time: Option<FileTime>,
    /// Whether the system marks it as late; `None` if the system marks nothing in names.
    pub(super) is_late: Option<bool>,
}

impl SubmittedFile {
    /// The path in the submission, with `/`.
    #[must_use]
    pub fn original_path(&self) -> String {
        self.path.join("/")
    }

    /// Whether it is a shader, or a file of a project.
    #[must_use]
    pub fn is_shader(&self) -> bool {
        matches!(self.content, Ok(Content::Text { .. }))
    }
}

/// The submission of a student.
#[derive(Debug, Default)]
pub struct Submission {
    /// The files.
    pub files: Vec<SubmittedFile>,
}

impl Submission {
    /// When the shaders of an assignment, or those of all assignments, were submitted.
    #[must_use]
    pub fn time(&self, assignment: Option<&ClassAssignment>) -> SubmissionTime {
        let belongs = |file: &&SubmittedFile| {
            let path = file.original_path();
            file.is_shader() && assignment.is_none_or(|assignment| assignment.has(&path))
        };
        SubmissionTime::of(self.files.iter().filter(belongs))
    }
}

/// The folder of a student, and what it holds.
#[derive(Debug)]
pub struct StudentFolder {
    /// The name of the folder.
    pub name: String,
    /// The student.
    pub student: Student,
    /// The student's files.
    pub submission: Submission,
}

/// The submissions of all students.
#[derive(Debug)]
pub struct Collection {
    /// The folders of the students.
    pub students: Vec<StudentFolder>,
    /// The downloads whose times are not those of submissions.
    pub copies: Vec<PathBuf>,
}

impl Collection {
    /// Reads downloads, and the list of students if the class has one in a file.
    ///
    /// # Errors
    /// Something cannot be read, or there is nothing.
    pub fn read(downloads: &[PathBuf], class: &Class) -> Result<Self, String> {
        let students = match &class.students {
            StudentList::None => Students::default(),
            StudentList::Table(students) => students.clone(),
            StudentList::File(path) => {
                let bytes = files::read_bytes(path).map_err(|error| error.to_string())?;
                let (text, _) =
                    text::decode(&bytes).ok_or_else(|| format!("{}: this is not a text", path_name(path)))?;
                Students::parse(&text)
            }
        };
        let mut submissions = BTreeMap::new();
        let mut copies = Vec::new();
        let mut found = HashSet::new();
        for download in downloads {
            if add(download, &students, &mut submissions, &mut found)? {
                copies.push(download.clone());
            }
        }
        let absent = students
            .all()
            .iter()
            .enumerate()
            .filter(|(place, _)| !found.contains(place));
        for (_, student) in absent {
            submissions.entry(student.clone()).or_default();
        }
        if submissions.is_empty() {
            return Err("there is no file to collect".to_owned());
        }
        let mut names = Paths::with_reserved(&[FILE_NAME]);
        let folders = submissions
            .into_iter()
            .map(|(student, submission)| StudentFolder {
                name: names.student(&student),
                student,
                submission,
            });
        Ok(Self {
            students: folders.collect(),
            copies,
        })
    }
}

/// Adds the files of a download, and the places of its students in the list; returns whether the times of the
/// files are those of a copy.
fn add(
    download: &Path,
    students: &Students,
    submissions: &mut BTreeMap<Student, Submission>,
    places: &mut HashSet<usize>,
) -> Result<bool, String> {
    let found = download::read(download).map_err(|error| unreadable(download, &error))?;
    let mut submitted_files = Vec::new();
    for DownloadFile { path, content, time } in found {
        let SubmissionPath {
            student,
            path,
            download,
            is_late,
        } = submission_path(&path);
        let file = SubmittedFile {
            path,
            content,
            download,
            time,
            is_late,
        };
        submitted_files.push((student, file));
    }
    let is_copy = is_copy(&submitted_files);
    let (listed, found) = students.find(submitted_files.iter().map(|(student, _)| student));
    places.extend(found);
    let listed: Vec<_> = submitted_files
        .iter()
        .map(|(student, _)| listed.get(student).cloned())
        .collect();
    for ((student, mut file), listed) in submitted_files.into_iter().zip(listed) {
        let submission = submissions.entry(listed.unwrap_or(student)).or_default();
        file.time = file.time.filter(|_| !is_copy);
        // The folder of a student may be empty.
        if file.path.iter().all(|part| !part.is_empty()) {
            submission.files.push(file);
        }
    }
    Ok(is_copy)
}

/// Why a download cannot be read, and what to do instead.
fn unreadable(download: &Path, error: &io::Error) -> String {
    let name = path_name(download);
    let is_named_archive = is_archive(download);
    if error.kind() != io::ErrorKind::InvalidData || is_named_archive {
        return format!("{name}: {error}");
    }
    let help = if files::is_shader(download) {
        "\nhelp: `toyproof check` takes shaders as they are"
    } else {
        ""
    };
    format!("{name} is neither an archive (.zip) nor a folder{help}")
}

/// Whether the files of several students have about the same time.
fn is_copy(files: &[(Student, SubmittedFile)]) -> bool {
    let timed = files
        .iter()
        .filter_map(|(student, file)| Some((student, file.time?)));
    let (mut students, mut times) = (HashSet::new(), Vec::new());
    for (student, time) in timed {
        students.insert(student);
        let (FileTime::Utc(seconds) | FileTime::Local(seconds)) = time;
        times.push(seconds);
    }
    let range = times.iter().max().zip(times.iter().min());
    students.len() > 1 && range.is_some_and(|(last, first)| last - first <= COPY_SECONDS)
}
