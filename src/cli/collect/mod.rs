//! `toyproof collect`: a folder for each student, from the downloads of a learning management system.

mod class;
mod download;
mod naming;
mod roster;
mod text;

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use anstyle::{AnsiColor, Style};
use toyproof_diagnostic::{Files, grouped, path_name, plural, printable};

use self::class::{Class, Students};
use self::download::{Found, is_archive};
use self::naming::{Student, Submitted, file_name, is_of_system, submitted};
pub(super) use self::roster::add_missing;
use self::roster::{Entry, FILE_NAME, Roster, Skipped};
use self::text::Content;
use super::files;
use super::inputs::shell_word;
use super::shader::Unusable;
use super::{Exit, Terminal};
use crate::report::{Detail, Layout};

/// Collect submissions from downloads into a folder for each student
///
/// Reads what Moodle and Canvas let teachers download, or any archive or folder with a folder or a file for
/// each student, and archives in them. Shaders are recognized by their names or by their texts, and saved as
/// UTF-8. What is not a shader is reported and left out. `toyproof check` has a row for each student of the
/// folder.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof collect moodle.zip -o homework
  toyproof collect submissions.zip --class class.toml -o homework

Exit code: 0 on success, also if students have no shader, 2 for any error.")]
pub(super) struct Args {
    /// Archives (.zip) and folders
    #[arg(required = true, value_name = "DOWNLOAD")]
    downloads: Vec<PathBuf>,
    /// The folder to create
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The class (.toml): the list of its students, and the files of several assignments
    #[arg(long, value_name = "FILE")]
    class: Option<PathBuf>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let Ok(class) = read_class(args, terminal) else {
        return Exit::Error;
    };
    match collect(args, &class, terminal) {
        Ok(()) => Exit::Success,
        Err(error) => {
            terminal.error(error);
            Exit::Error
        }
    }
}

fn read_class(args: &Args, terminal: &Terminal) -> Result<Class, ()> {
    let Some(path) = &args.class else {
        return Ok(Class::default());
    };
    let mut files = Files::default();
    let unusable = match files::read_text(path) {
        Ok(text) => {
            let file = files.add(text);
            match Class::parse(&files, file, path.parent().unwrap_or(Path::new(""))) {
                Ok(class) => return Ok(class),
                Err(errors) => Unusable::Invalid(errors.into()),
            }
        }
        Err(error) => Unusable::of(error, &mut files),
    };
    unusable.print(&files, terminal);
    Err(())
}

fn collect(args: &Args, class: &Class, terminal: &Terminal) -> Result<(), String> {
    download::check_empty(&args.output)?;
    let students = match &class.students {
        None => Students::default(),
        Some(path) => Students::parse(files::read_text(path).map_err(|error| error.to_string())?.text()),
    };
    let mut submissions: BTreeMap<Student, Submission> = students
        .all()
        .iter()
        .map(|student| (student.clone(), Submission::default()))
        .collect();
    for download in &args.downloads {
        let found = download::read(download).map_err(|error| format!("{}: {error}", path_name(download)))?;
        for Found { path, content } in download::without_common_folder(found, is_of_system) {
            let Submitted {
                student,
                path,
                is_late,
            } = submitted(&path);
            let submission = submissions.entry(students.find(student)).or_default();
            submission.is_late |= is_late;
            // The folder of a student may be empty.
            if path.iter().all(|part| !part.is_empty()) {
                submission.files.push((path, content));
            }
        }
    }
    if submissions.is_empty() {
        return Err("there is no file to collect".to_owned());
    }
    let mut names = Taken::default();
    let named: Vec<(String, &Student, &Submission)> = submissions
        .iter()
        .map(|(student, submission)| (names.folder(student), student, submission))
        .collect();
    if class.assignments.is_empty() {
        return write(&args.output, &named, |_| true, terminal).map(|()| next(&args.output, None, terminal));
    }
    for assignment in &class.assignments {
        let folder = args.output.join(&assignment.name);
        write(&folder, &named, |path| assignment.has(path), terminal)?;
        next(&folder, assignment.assignment.as_deref(), terminal);
    }
    let is_of_none = |path: &str| !class.assignments.iter().any(|assignment| assignment.has(path));
    for (folder, _, submission) in &named {
        for (path, content) in &submission.files {
            let path = path.join("/");
            if matches!(content, Ok(Content::Text { .. })) && is_of_none(&path) {
                terminal.warn(format_args!(
                    "{folder}: {} was left out: no assignment of the class has this file",
                    printable(&path)
                ));
            }
        }
    }
    Ok(())
}

/// The files of a student, each with its path.
#[derive(Debug, Default)]
struct Submission {
    files: Vec<(Vec<String>, Result<Content, String>)>,
    is_late: bool,
}

/// Names in use, without case: some file systems store names that differ only in case in one file.
#[derive(Debug, Default)]
struct Taken(HashSet<String>);

impl Taken {
    /// A name that is not in use: the given one, or one with a number before the extension.
    fn free(&mut self, name: &str) -> String {
        let (stem, extension) = match name.rsplit_once('.') {
            Some((stem, extension)) if !extension.contains('/') => (stem, format!(".{extension}")),
            _ => (name, String::new()),
        };
        let numbered = (2_u64..).map(|number| format!("{stem}-{number}{extension}"));
        let free = std::iter::once(name.to_owned())
            .chain(numbered)
            .find(|name| !self.0.contains(&name.to_lowercase()));
        let free = free.expect("one of endlessly many names is free");
        self.0.insert(free.to_lowercase());
        free
    }

    /// The folder of a student: the name, with the number if another has the same name.
    fn folder(&mut self, student: &Student) -> String {
        let name = file_name(&student.name);
        match &student.id {
            Some(id) if self.0.contains(&name.to_lowercase()) => {
                self.free(&file_name(&format!("{name}-{id}")))
            }
            _ => self.free(&name),
        }
    }
}

/// Writes the shaders of all students that belong to an assignment, and the roster, and prints a line for
/// each student.
fn write(
    folder: &Path,
    submissions: &[(String, &Student, &Submission)],
    belongs: impl Fn(&str) -> bool,
    terminal: &Terminal,
) -> Result<(), String> {
    let layout = Layout::new(
        submissions.iter().map(|(name, ..)| name.as_str()),
        terminal.width(),
        Detail::Normal,
        false,
    );
    let mut students = Vec::new();
    for (name, student, submission) in submissions {
        let mut entry = Entry {
            folder: name.clone(),
            name: student.name.clone(),
            id: student.id.clone(),
            is_late: submission.is_late,
            files: Vec::new(),
            skipped: Vec::new(),
        };
        let mut notes = Vec::new();
        let mut taken = Taken::default();
        for (path, content) in &submission.files {
            let original = path.join("/");
            let mut skip = |reason: &str| {
                let (file, reason) = (original.clone(), reason.to_owned());
                entry.skipped.push(Skipped { file, reason });
            };
            match content {
                Err(reason) => skip(reason),
                Ok(Content::Other(reason)) => skip(reason),
                Ok(Content::Text { .. }) if !belongs(&original) => {}
                Ok(Content::Text {
                    text,
                    encoding,
                    is_renamed,
                }) => {
                    let file = taken.free(&output_name(path, *is_renamed));
                    let path = folder.join(name).join(&file);
                    if !terminal.write_output(folder, &path, text.as_bytes()) {
                        return Err("not all submissions were written".to_owned());
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
        notes.extend(entry.skipped.iter().map(|skipped| {
            format!(
                "skipped {}: {}",
                printable(&skipped.file),
                printable(&skipped.reason)
            )
        }));
        print(&entry, &notes, &layout, terminal);
        students.push(entry);
    }
    let with_shader = students
        .iter()
        .filter(|student| !student.files.is_empty())
        .count() as u64;
    let roster = Roster { students };
    let text = serde_json::to_string_pretty(&roster).map_err(|error| error.to_string())? + "\n";
    if !terminal.write_output(folder, &folder.join(FILE_NAME), text.as_bytes()) {
        return Err("the list of students was not written".to_owned());
    }
    let count = roster.students.len() as u64;
    terminal.note(&format!(
        "\n{}: {} {}, {} with a shader",
        path_name(folder),
        grouped(count),
        plural(count, "student", "students"),
        grouped(with_shader)
    ));
    Ok(())
}

/// The path of a collected file: harmless on any system, with a shader's extension in lower case.
fn output_name(path: &[String], is_renamed: bool) -> String {
    let (last, folders) = path.split_last().expect("a file has a name");
    let folders = folders.iter().map(|part| match part {
        part if is_archive(part) => file_name(&part[..part.len() - ".zip".len()]),
        part => file_name(part),
    });
    let name = file_name(last);
    let (stem, extension) = name.rsplit_once('.').unwrap_or((&name, ""));
    let file = match is_renamed {
        false => format!("{stem}.{}", extension.to_lowercase()),
        true if stem.to_lowercase().ends_with(".glsl") => stem.to_lowercase(),
        true if stem.is_empty() => format!("{name}.glsl"),
        true => format!("{stem}.glsl"),
    };
    folders.chain([file]).collect::<Vec<_>>().join("/")
}

fn print(entry: &Entry, notes: &[String], layout: &Layout, terminal: &Terminal) {
    let count = entry.files.len() as u64;
    let late = if entry.is_late { ", late" } else { "" };
    let (label, color, sentence) = match count {
        0 => ("missing", AnsiColor::Red, "no shader was submitted".to_owned()),
        _ => (
            "collected",
            AnsiColor::Green,
            format!("{} {}", grouped(count), plural(count, "file", "files")),
        ),
    };
    let style = Style::new().fg_color(Some(color.into())).bold();
    let mut lines = vec![layout.row((label, style), &entry.folder, &(sentence + late))];
    lines.extend(notes.iter().map(|note| layout.below("", note)));
    terminal.result(&lines.join("\n"));
}

/// Prints the command that checks what was collected.
fn next(folder: &Path, assignment: Option<&Path>, terminal: &Terminal) {
    let assignment = assignment.map(|path| format!(" --assignment {}", shell_word(&path_name(path))));
    terminal.note(&format!(
        "to check them: toyproof check {}{} --out marks",
        shell_word(&path_name(folder)),
        assignment.unwrap_or_default()
    ));
}
