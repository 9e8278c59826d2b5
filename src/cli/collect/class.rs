//! `class.toml`: the students of a class, and the files of its assignments.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Diagnostics, FileId, Files};
use toyproof_toml::{Format, Located, Table};

use super::naming::{Student, file_name};

static FORMAT: Format = Format {
    form_code: "E0505",
    value_code: "E0506",
    aliases: &[],
    renamed: &[],
};

/// A class.
#[derive(Debug, Default)]
pub(super) struct Class {
    /// The path of the list of students, if there is one.
    pub(super) students: Option<PathBuf>,
    /// The assignments whose submissions are separated; empty if there is one assignment.
    pub(super) assignments: Vec<ClassAssignment>,
}

/// An assignment, and which files are its submissions.
#[derive(Debug)]
pub(super) struct ClassAssignment {
    /// The name of its folder.
    pub(super) name: String,
    /// Patterns for the paths of its files in a submission.
    patterns: Vec<String>,
    /// The file or the folder of the assignment, if it is named.
    pub(super) assignment: Option<PathBuf>,
}

impl ClassAssignment {
    /// Whether a file with this path in a submission, with `/`, belongs to the assignment.
    pub(super) fn has(&self, path: &str) -> bool {
        let path = path.to_lowercase();
        self.patterns
            .iter()
            .any(|pattern| matches(&pattern.to_lowercase(), &path))
    }
}

/// Whether a text matches a pattern, in which `*` stands for any characters, and `?` for one.
fn matches(pattern: &str, text: &str) -> bool {
    let (pattern, text): (Vec<char>, Vec<char>) = (pattern.chars().collect(), text.chars().collect());
    let (mut at, mut of) = (0, 0);
    // The last `*`, and the end of what it stands for.
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
    pub(super) fn parse(files: &Files, file: FileId, folder: &Path) -> Result<Self, Diagnostics> {
        toyproof_toml::read(&FORMAT, files, file, |document| {
            let students = path(document, "students", folder);
            let mut assignments: Vec<ClassAssignment> = Vec::new();
            document.tables("assignment", |table| {
                let name = table.required::<String>("name");
                if let Some(name) = &name
                    && name.value != file_name(&name.value)
                {
                    let problem = "must be the name of a folder: letters, digits, `-`, `_` and `.`";
                    table.reject_value("name", name, problem);
                }
                let patterns = table.required::<Vec<String>>("files");
                let assignment = ClassAssignment {
                    name: name.map_or_else(String::new, |name| name.value),
                    patterns: patterns.map_or_else(Vec::new, |patterns| patterns.value),
                    assignment: path(table, "assignment", folder),
                };
                if assignments.iter().any(|other| other.name == assignment.name) && table.is_valid() {
                    let message = format!("there are two assignments `{}`", assignment.name);
                    table.reject(table.span(), message, "give one of them another name");
                }
                assignments.push(assignment);
            });
            document.report_unknown_keys();
            Self {
                students,
                assignments,
            }
        })
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

/// The listed students of a class.
#[derive(Debug, Default)]
pub(super) struct Students {
    listed: Vec<Student>,
    /// The places of the students in the list, by their names and numbers in lower case.
    places: HashMap<String, usize>,
}

impl Students {
    /// Reads a list: a line for each student, with the name or number that the download has, and then, after
    /// a `,`, `;` or tab, the name to show.
    pub(super) fn parse(text: &str) -> Self {
        let mut students = Self::default();
        for line in text.lines() {
            let mut fields = line
                .split([',', ';', '\t'])
                .map(|field| field.trim().trim_matches('"').trim());
            let Some(key) = fields.next().filter(|key| !key.is_empty()) else {
                continue;
            };
            let name = fields.next().filter(|name| !name.is_empty());
            let place = students.listed.len();
            for key in std::iter::once(key).chain(name) {
                students.places.entry(key.to_lowercase()).or_insert(place);
            }
            students.listed.push(Student {
                name: name.unwrap_or(key).to_owned(),
                id: name.map(|_| key.to_owned()),
            });
        }
        students
    }

    /// The listed students.
    pub(super) fn all(&self) -> &[Student] {
        &self.listed
    }

    /// The listed student that a download names, by number or name; the given one if none is.
    pub(super) fn find(&self, student: Student) -> Student {
        let keys = student.id.iter().chain([&student.name]);
        let place = keys
            .into_iter()
            .find_map(|key| self.places.get(&key.to_lowercase()));
        place.map_or(student, |&place| self.listed[place].clone())
    }
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

    #[test]
    fn students_are_found_by_number_or_name() {
        let students = Students::parse("12, Anna Smith\n\n\"13\";\"Bo\"\nmai\n");
        let find = |name: &str, id: Option<&str>| {
            let student = Student {
                name: name.to_owned(),
                id: id.map(str::to_owned),
            };
            students.find(student).name
        };
        assert_eq!(find("smithanna", Some("12")), "Anna Smith");
        assert_eq!(find("BO", None), "Bo");
        assert_eq!(find("Mai", Some("99")), "mai");
        assert_eq!(find("other", None), "other");
        assert_eq!(students.all().len(), 3);
    }
}
