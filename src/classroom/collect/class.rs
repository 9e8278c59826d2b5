//! `class.toml`: the students of a class, and the files of its assignments.

use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Code, Diagnostics, FileId, Files};
use toyproof_toml::{Format, Located, Moment, Table};

use super::naming::file_name;
use super::students::Students;

static FORMAT: Format = Format {
    form_code: Code::AssignmentSyntax,
    value_code: Code::AssignmentValue,
    aliases: &[],
};

/// A class.
#[derive(Debug, Default)]
pub struct Class {
    /// The students.
    pub students: StudentList,
    /// The assignments whose submissions are separated; empty if there is one assignment.
    pub assignments: Vec<ClassAssignment>,
}

/// The file that lists the students of a class.
#[derive(Debug, Default)]
pub enum StudentList {
    /// Nowhere: they are those of the download.
    #[default]
    None,
    /// In a file, a line for each.
    File(PathBuf),
    /// In the file of the class.
    Table(Students),
}

/// An assignment, and which files are its submissions.
#[derive(Debug)]
pub struct ClassAssignment {
    /// The name of the assignment's folder.
    pub name: String,
    /// Patterns for the paths of the assignment's files in a submission.
    patterns: Vec<String>,
    /// The file or the folder of the assignment, if it is named.
    pub assignment: Option<PathBuf>,
    /// The rubric, if it is not that of the assignment.
    pub rubric: Option<PathBuf>,
    /// When the submissions are due.
    pub deadline: Option<Moment>,
}

/// The purpose of reading the class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// Collecting submissions.
    Collect,
    /// Collecting and checking submissions, for which each assignment has to be named.
    Check,
}

impl ClassAssignment {
    /// Whether a file with this path in a submission, with `/`, belongs to the assignment.
    #[must_use]
    pub fn has(&self, path: &str) -> bool {
        let path = path.to_lowercase();
        self.patterns
            .iter()
            .any(|pattern| matches(&pattern.to_lowercase(), &path))
    }
}

/// Whether a text matches a pattern, in which `*` matches any characters, and `?` one.
fn matches(pattern: &str, text: &str) -> bool {
    let (pattern, text): (Vec<char>, Vec<char>) = (pattern.chars().collect(), text.chars().collect());
    let (mut at, mut of) = (0, 0);
    // The last `*`, and the end of the text that it matches.
    let mut star = None;
    while at < text.len() {
        match pattern.get(of) {
            Some('*') => {
                star = Some((of, at));
                of += 1;
            }
            Some(&character) if character == '?' || character == text[at] => {
                at += 1;
                of += 1;
            }
            _ => {
                let Some((place, end)) = star else {
                    return false;
                };
                star = Some((place, end + 1));
                (of, at) = (place + 1, end + 1);
            }
        }
    }
    pattern[of..].iter().all(|&character| character == '*')
}

impl Class {
    /// Parses a class whose file lies in `folder`.
    ///
    /// # Errors
    /// The first syntax error of the TOML, or all other errors.
    pub fn parse(files: &Files, file: FileId, folder: &Path, purpose: Purpose) -> Result<Self, Diagnostics> {
        toyproof_toml::read(&FORMAT, files, file, |document| {
            let students = students(document, folder);
            let mut assignments: Vec<ClassAssignment> = Vec::new();
            document.tables("assignment", |table| {
                let assignment = assignment(table, folder, purpose);
                let mut names = assignments.iter().map(|other| other.name.to_lowercase());
                if table.is_valid() && names.any(|other| other == assignment.name.to_lowercase()) {
                    let message = format!("there are two assignments `{}`", assignment.name);
                    table.reject(table.span(), message, "give one of them another name");
                }
                assignments.push(assignment);
            });
            document.report_unknown_keys();
            if purpose == Purpose::Check && assignments.is_empty() && document.is_valid() {
                let help = "add a table [[assignment]] with `name`, `files` and `assignment`";
                document.reject(document.span(), "the class has no assignment", help);
            }
            Self {
                students,
                assignments,
            }
        })
    }
}

/// Reads the list of students: a file, or a table with a name for each number.
fn students(document: &mut Table, folder: &Path) -> StudentList {
    if document.has_table("students") {
        let students = document.table("students", |table| Students::new(table.take_entries::<String>()));
        return StudentList::Table(students.unwrap_or_default());
    }
    match path(document, "students", folder) {
        Some(path) => StudentList::File(path),
        None => StudentList::None,
    }
}

fn assignment(table: &mut Table, folder: &Path, purpose: Purpose) -> ClassAssignment {
    let name = table.required::<String>("name");
    if let Some(name) = &name
        && name.value != file_name(&name.value)
    {
        let problem = "must be the name of a folder: letters, digits, `-`, `_` and `.`";
        table.reject_value("name", name, problem);
    }
    let patterns = table.required::<Vec<String>>("files");
    if let Some(patterns) = &patterns
        && patterns.value.is_empty()
    {
        let help = "for example `files = [\"*shading*\"]`; `*` stands for any characters";
        table.reject(patterns.span, "`files` has no pattern", help);
    }
    if purpose == Purpose::Check && !table.has("assignment") {
        table.require("assignment", "\"shading/assignment.toml\"");
    }
    ClassAssignment {
        name: name.map_or_else(String::new, |name| name.value),
        patterns: patterns.map_or_else(Vec::new, |patterns| patterns.value),
        assignment: path(table, "assignment", folder),
        rubric: path(table, "rubric", folder),
        deadline: table
            .optional::<Moment>("deadline")
            .map(|deadline| deadline.value),
    }
}

/// Reads a path relative to the folder of the class, which must exist.
fn path(table: &mut Table, key: &'static str, folder: &Path) -> Option<PathBuf> {
    let Located { value, span } = table.optional::<String>(key)?;
    let path = folder.join(&value);
    if !path.exists() {
        let message = format!("there is no file {}", table.excerpt(span));
        table.reject(span, message, "paths are relative to the folder of this file");
    }
    Some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_whole_paths() {
        for (pattern, text, expected) in [
            ("*", "", true),
            ("a.glsl", "a.glsl", true),
            ("a.glsl", "b/a.glsl", false),
            ("*a.glsl", "b/a.glsl", true),
            ("*shading*", "x/my-shading-2.glsl", true),
            ("hw?/*", "hw3/a.glsl", true),
            ("hw?/*", "hw/a.glsl", false),
            ("*a*b*c", "xaxbxbxc", true),
            ("*a*b*c", "xaxbxbxcx", false),
        ] {
            assert_eq!(matches(pattern, text), expected, "{pattern} {text}");
        }
    }
}
