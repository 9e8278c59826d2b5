//! The owner of a file of a download, by the names that Moodle and Canvas give to submissions.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use toyproof_project::files::is_hidden;
use unicode_normalization::UnicodeNormalization;

/// What the path of a file in a download says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SubmissionPath {
    /// The owner.
    pub student: Student,
    /// The path in the submission; empty for a folder.
    pub path: Vec<String>,
    /// What the names of the student's files in the download begin with: the name of a folder with `/`, or
    /// what the system wrote before the name of a file, such as `smithanna_1234_5678_`.
    pub download: String,
    /// Whether the system marks it as late; `None` if the system marks nothing in names.
    pub is_late: Option<bool>,
}

/// A student, as a download names one.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Student {
    /// The name.
    pub name: String,
    /// The number that the system gives to the student or to the submission.
    pub id: Option<String>,
}

impl Student {
    /// The name, and the number in parentheses.
    pub(crate) fn described(&self) -> String {
        match &self.id {
            Some(id) => format!("{} ({id})", self.name),
            None => self.name.clone(),
        }
    }
}

/// The student of a file, by its path in the download, which is not empty: what the system wrote into the
/// name of the file, of its archive or of its folder, else the folder, else the file's name without its
/// extension.
///
/// # Panics
/// If the path is empty.
#[must_use]
pub fn submission_path(path: &[String]) -> SubmissionPath {
    let (first, rest) = path.split_first().expect("the path is not empty");
    let is_file = rest.is_empty() || is_archive(first);
    let named = moodle(first).or_else(|| canvas(first).filter(|_| is_file));
    let NameParts {
        student,
        file,
        is_late,
    } = named.unwrap_or_else(|| by_place(first, is_file));
    let download = match &file {
        // A system's name ends with that of the file.
        Some(file) if first.len() > file.len() => first[..first.len() - file.len()].to_owned(),
        Some(_) => format!("{}/", student.name),
        None => format!("{first}/"),
    };
    // macOS writes names in decomposed form.
    let student = Student {
        name: student.name.nfc().collect(),
        ..student
    };
    SubmissionPath {
        student,
        path: file.into_iter().chain(rest.iter().cloned()).collect(),
        download,
        is_late,
    }
}

/// The student of a folder or a file that no system named.
fn by_place(first: &str, is_file: bool) -> NameParts {
    let name = match first.rsplit_once('.') {
        Some((stem, _)) if is_file && !stem.is_empty() => stem,
        _ => first,
    };
    NameParts {
        student: Student {
            name: name.to_owned(),
            id: None,
        },
        file: is_file.then(|| first.to_owned()),
        is_late: None,
    }
}

/// Whether a path is that of an archive.
#[must_use]
pub fn is_archive(path: impl AsRef<Path>) -> bool {
    let extension = path.as_ref().extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("zip"))
}

/// Whether a name is one that Moodle or Canvas gives.
#[must_use]
pub fn is_of_system(name: &str) -> bool {
    moodle(name).or_else(|| canvas(name)).is_some()
}

/// The parts of a name.
struct NameParts {
    student: Student,
    /// The name that the student gave to the file; `None` for a folder.
    file: Option<String>,
    is_late: Option<bool>,
}

/// Moodle: `Anna Smith_1234567_assignsubmission_file_shader.glsl`, or a folder `Anna
/// Smith_1234567_assignsubmission_file`, with or without a last `_`; `onlinetext` instead of `file` where the
/// text was typed.
fn moodle(name: &str) -> Option<NameParts> {
    let (student, rest) = name.split_once("_assignsubmission_")?;
    let (name, id) = student.rsplit_once('_')?;
    let file = ["file", "onlinetext"]
        .iter()
        .find_map(|kind| rest.strip_prefix(kind))?;
    let file = file.strip_prefix('_').or_else(|| file.is_empty().then_some(""))?;
    is_number(id).then(|| NameParts {
        student: Student {
            name: name.to_owned(),
            id: Some(id.to_owned()),
        },
        file: (!file.is_empty()).then(|| file.to_owned()),
        is_late: None,
    })
}

/// Canvas: `smithanna_12345_678901_shader.glsl`, or `smithanna_LATE_12345_678901_shader.glsl`: the student's
/// name and number, the number of the file and its name.
fn canvas(name: &str) -> Option<NameParts> {
    let (student, rest) = name.split_once('_')?;
    let late = rest.strip_prefix("LATE_");
    let mut parts = late.unwrap_or(rest).splitn(3, '_');
    let (id, number, file) = (parts.next()?, parts.next()?, parts.next()?);
    let is_name = !student.is_empty() && !file.is_empty();
    (is_name && is_number(id) && is_number(number)).then(|| NameParts {
        student: Student {
            name: student.to_owned(),
            id: Some(id.to_owned()),
        },
        file: Some(file.to_owned()),
        is_late: Some(late.is_some()),
    })
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// The longest name of a collected file or folder, in bytes: names that `check` derives from it, such as
/// `NAME-algorithm.png`, stay below the limits of all file systems.
const MAX_NAME_BYTES: usize = 120;

/// A name as a component of a path on any system, without spaces: letters, digits, `-`, `_` and `.`, but no
/// hidden file, no device of Windows, and of limited length.
#[must_use]
pub fn file_name(name: &str) -> String {
    let plain = name.nfc().map(|character| match character {
        _ if character.is_alphanumeric() || "-_.".contains(character) => character,
        _ => '-',
    });
    let plain: String = plain.collect();
    let plain = shortened(plain.trim_matches(['-', '.']))
        .trim_matches(['-', '.'])
        .to_owned();
    match plain.as_str() {
        "" => "unnamed".to_owned(),
        name if is_device(name) || is_hidden(name.as_ref()) => format!("_{name}"),
        _ => plain,
    }
}

/// A name without what exceeds [`MAX_NAME_BYTES`] before its extension.
fn shortened(name: &str) -> String {
    const MAX_EXTENSION_BYTES: usize = 16;
    if name.len() <= MAX_NAME_BYTES {
        return name.to_owned();
    }
    let extension = name.rfind('.').map_or("", |at| &name[at..]);
    let extension = if extension.len() <= MAX_EXTENSION_BYTES {
        extension
    } else {
        ""
    };
    let end = (0..=MAX_NAME_BYTES - extension.len())
        .rev()
        .find(|&end| name.is_char_boundary(end));
    format!("{}{extension}", &name[..end.unwrap_or_default()])
}

/// Whether Windows treats a name as a device, whatever its extension.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().to_uppercase();
    let is_numbered = |kind: &str| {
        let number = stem.strip_prefix(kind).unwrap_or_default();
        let mut number = number.chars();
        number.next().is_some_and(|digit| "0123456789¹²³".contains(digit)) && number.next().is_none()
    };
    matches!(stem.as_str(), "CON" | "PRN" | "AUX" | "NUL") || is_numbered("COM") || is_numbered("LPT")
}

/// Unique paths of files below a folder; no path is the folder of another. Case does not distinguish
/// them: some file systems store names that differ only in case in one file.
#[derive(Debug, Default)]
pub struct Paths {
    /// The paths in use, in one case.
    used: HashSet<String>,
    /// The next number for a path that was already in use.
    numbers: HashMap<String, u64>,
    /// The paths of folders, by their original ones.
    folders: HashMap<Vec<String>, String>,
}

impl Paths {
    /// Starts with names that are in use.
    #[must_use]
    pub fn with_reserved(names: &[&str]) -> Self {
        Self {
            used: names.iter().map(|name| without_case(name)).collect(),
            ..Self::default()
        }
    }

    /// The path of a file with this name in a folder: the given one, or one with a number before the
    /// extension.
    pub fn file(&mut self, folder: &[String], name: &str) -> String {
        let folder = self.folder(folder);
        self.free(&folder, name)
    }

    fn folder(&mut self, original: &[String]) -> String {
        let Some((name, parents)) = original.split_last() else {
            return String::new();
        };
        if let Some(known) = self.folders.get(original) {
            return known.clone();
        }
        let name = if is_archive(name) {
            file_name(&name[..name.len() - ".zip".len()])
        } else {
            file_name(name)
        };
        let parent = self.folder(parents);
        let path = self.free(&parent, &name);
        self.folders.insert(original.to_vec(), path.clone());
        path
    }

    /// A path that is not in use.
    fn free(&mut self, folder: &str, name: &str) -> String {
        let path = match folder {
            "" => name.to_owned(),
            folder => format!("{folder}/{name}"),
        };
        if self.used.insert(without_case(&path)) {
            return path;
        }
        let at = path.len() - name.len() + name.rfind('.').unwrap_or(name.len());
        let (stem, extension) = path.split_at(at);
        let number = self.numbers.entry(without_case(&path)).or_insert(2);
        loop {
            let numbered = format!("{stem}-{number}{extension}");
            *number += 1;
            if self.used.insert(without_case(&numbered)) {
                return numbered;
            }
        }
    }

    /// The folder of a student: the name, with the number if another has the same name.
    pub fn student(&mut self, student: &Student) -> String {
        let name = file_name(&student.name);
        match &student.id {
            Some(id) if self.used.contains(&without_case(&name)) => {
                self.free("", &file_name(&format!("{name}-{id}")))
            }
            _ => self.free("", &name),
        }
    }
}

/// A name in one case: Windows compares upper case, and macOS folds case.
fn without_case(name: &str) -> String {
    name.to_uppercase().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(path: &str) -> (String, Option<String>, String, bool) {
        let path: Vec<_> = path.split('/').map(str::to_owned).collect();
        let SubmissionPath {
            student,
            path,
            is_late,
            ..
        } = submission_path(&path);
        (student.name, student.id, path.join("/"), is_late == Some(true))
    }

    #[test]
    fn systems_name_students_and_files() {
        let file = |name: &str, id: &str, path: &str, is_late| {
            let id = (!id.is_empty()).then(|| id.to_owned());
            (name.to_owned(), id, path.to_owned(), is_late)
        };
        for (path, expected) in [
            (
                "Anna Smith_12_assignsubmission_file/a.glsl",
                file("Anna Smith", "12", "a.glsl", false),
            ),
            (
                "Anna Smith_12_assignsubmission_file_/x/a.glsl",
                file("Anna Smith", "12", "x/a.glsl", false),
            ),
            (
                "Bo van_Dam_7_assignsubmission_file_my_a.glsl",
                file("Bo van_Dam", "7", "my_a.glsl", false),
            ),
            (
                "Participant 9_9_assignsubmission_onlinetext/onlinetext.html",
                file("Participant 9", "9", "onlinetext.html", false),
            ),
            ("doejane_12_345_a.glsl", file("doejane", "12", "a.glsl", false)),
            (
                "doejane_LATE_12_345_my_a-1.glsl",
                file("doejane", "12", "my_a-1.glsl", true),
            ),
            ("anna/a_1_2_b.glsl", file("anna", "", "a_1_2_b.glsl", false)),
            ("anna_1_2_x/a.glsl", file("anna_1_2_x", "", "a.glsl", false)),
            ("anna.glsl", file("anna", "", "anna.glsl", false)),
            ("anna.lee/a.glsl", file("anna.lee", "", "a.glsl", false)),
            (
                "a_x_assignsubmission_file/a.glsl",
                file("a_x_assignsubmission_file", "", "a.glsl", false),
            ),
        ] {
            assert_eq!(read(path), expected, "{path}");
        }
    }

    #[test]
    fn the_names_of_a_download_are_kept() {
        for (path, expected) in [
            (
                "Anna Smith_12_assignsubmission_file_/x/a.glsl",
                "Anna Smith_12_assignsubmission_file_/",
            ),
            (
                "Anna Smith_12_assignsubmission_file_my_a.glsl",
                "Anna Smith_12_assignsubmission_file_",
            ),
            (
                "Anna Smith_12_assignsubmission_file_a.zip/x/a.glsl",
                "Anna Smith_12_assignsubmission_file_",
            ),
            ("doejane_LATE_12_345_my_a-1.glsl", "doejane_LATE_12_345_"),
            ("anna/a_1_2_b.glsl", "anna/"),
            ("anna.glsl", "anna/"),
        ] {
            let path: Vec<_> = path.split('/').map(str::to_owned).collect();
            assert_eq!(submission_path(&path).download, expected);
        }
    }

    #[test]
    fn file_names_are_harmless() {
        for (name, expected) in [
            ("Zoë Müller", "Zoë-Müller"),
            ("../../etc", "etc"),
            ("..", "unnamed"),
            (".git", "git"),
            ("a\u{1b}[31m/b\\c:d", "a--31m-b-c-d"),
            ("Mu\u{308}ller. ", "Müller"),
            ("-__MACOSX", "___MACOSX"),
            ("con", "_con"),
            ("LPT1.glsl", "_LPT1.glsl"),
            ("com¹", "_com¹"),
            ("console.glsl", "console.glsl"),
        ] {
            assert_eq!(file_name(name), expected);
        }
        for name in [
            "ä".repeat(300) + ".glsl",
            "a".repeat(300),
            format!("a.{}", "b".repeat(300)),
        ] {
            let short = file_name(&name);
            assert!((118..=MAX_NAME_BYTES).contains(&short.len()), "{short}");
            let is_shader = |name: &str| {
                name.rsplit_once('.')
                    .is_some_and(|(_, extension)| extension == "glsl")
            };
            assert_eq!(is_shader(&short), is_shader(&name));
        }
    }

    /// Pairs of names that are one on some file system, and a file that is the folder of another.
    #[test]
    fn paths_are_unique_on_every_file_system() {
        let place = |paths: &mut Paths, path: &str| {
            let mut folder: Vec<_> = path.split('/').map(str::to_owned).collect();
            let name = file_name(&folder.pop().unwrap());
            paths.file(&folder, &name)
        };
        for (one, other, expected) in [
            ("a.glsl", "A.GLSL", "A-2.GLSL"),
            (
                "\u{1112}\u{1161}\u{11ab}.glsl",
                "\u{d55c}.glsl",
                "\u{d55c}-2.glsl",
            ),
            ("\u{f900}.glsl", "\u{8c48}.glsl", "\u{8c48}-2.glsl"),
            ("straße.glsl", "STRASSE.glsl", "STRASSE-2.glsl"),
            ("ſ.glsl", "s.glsl", "s-2.glsl"),
            ("a.glsl", "a.glsl. ", "a-2.glsl"),
            ("a b.glsl", "a-b.glsl", "a-b-2.glsl"),
            ("a.glsl", "a.glsl/b.glsl", "a-2.glsl/b.glsl"),
            ("a.glsl/b.glsl", "a.glsl", "a-2.glsl"),
            ("a.zip/x.glsl", "a/x.glsl", "a-2/x.glsl"),
            ("a/b/x.glsl", "a/b", "a/b-2"),
            ("a/x.glsl", "a/y.glsl", "a/y.glsl"),
        ] {
            let mut paths = Paths::default();
            place(&mut paths, one);
            assert_eq!(place(&mut paths, other), expected, "{one} {other}");
        }
        let mut paths = Paths::with_reserved(&["submissions.json"]);
        let student = |name: &str, id: &str| Student {
            name: name.to_owned(),
            id: Some(id.to_owned()),
        };
        for (name, id, expected) in [
            ("Submissions.JSON", "7", "Submissions.JSON-7"),
            ("Anna", "7", "Anna"),
            ("anna", "8", "anna-8"),
            ("Anna", "8", "Anna-8-2"),
        ] {
            assert_eq!(paths.student(&student(name, id)), expected);
        }
    }
}
