//! Whose a file of a download is: the names that Moodle and Canvas give to submissions.

use super::download::is_archive;

/// A file of a download.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Submitted {
    pub(super) student: Student,
    /// Its path in the submission; empty for a folder.
    pub(super) path: Vec<String>,
    /// Whether the system marks it as late; none if the system marks nothing in names.
    pub(super) is_late: Option<bool>,
}

/// A student, as a download names one.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Student {
    pub(super) name: String,
    /// The number that the system gives to the student or to the submission.
    pub(super) id: Option<String>,
}

/// The student of a file, by its path in the download, which is not empty: what the system wrote into the
/// name of the file, of its archive or of its folder, else the folder, else the file's name without its
/// extension.
pub(super) fn submitted(path: &[String]) -> Submitted {
    let (first, rest) = path.split_first().expect("the path is not empty");
    let is_file = rest.is_empty() || is_archive(first);
    let named = moodle(first).or_else(|| canvas(first).filter(|_| is_file));
    let Named {
        student,
        file,
        is_late,
    } = named.unwrap_or_else(|| by_place(first, is_file));
    Submitted {
        student,
        path: file.into_iter().chain(rest.iter().cloned()).collect(),
        is_late,
    }
}

/// The student of a folder or a file that no system named.
fn by_place(first: &str, is_file: bool) -> Named {
    let name = match first.rsplit_once('.') {
        Some((stem, _)) if is_file && !stem.is_empty() => stem,
        _ => first,
    };
    Named {
        student: Student {
            name: name.to_owned(),
            id: None,
        },
        file: is_file.then(|| first.to_owned()),
        is_late: None,
    }
}

/// Whether a name is one that Moodle or Canvas gives.
pub(super) fn is_of_system(name: &str) -> bool {
    moodle(name).or_else(|| canvas(name)).is_some()
}

/// What a name has.
struct Named {
    student: Student,
    /// The name that the student gave to the file; none for a folder.
    file: Option<String>,
    is_late: Option<bool>,
}

/// Moodle: `Anna Smith_1234567_assignsubmission_file_shader.glsl`, or a folder `Anna
/// Smith_1234567_assignsubmission_file`, with or without a last `_`; `onlinetext` instead of `file` where the
/// text was typed.
fn moodle(name: &str) -> Option<Named> {
    let (student, rest) = name.split_once("_assignsubmission_")?;
    let (name, id) = student.rsplit_once('_')?;
    let file = ["file", "onlinetext"]
        .iter()
        .find_map(|kind| rest.strip_prefix(kind))?;
    let file = file.strip_prefix('_').or_else(|| file.is_empty().then_some(""))?;
    is_number(id).then(|| Named {
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
fn canvas(name: &str) -> Option<Named> {
    let (student, rest) = name.split_once('_')?;
    let late = rest.strip_prefix("LATE_");
    let mut parts = late.unwrap_or(rest).splitn(3, '_');
    let (id, number, file) = (parts.next()?, parts.next()?, parts.next()?);
    let is_name = !student.is_empty() && !file.is_empty();
    (is_name && is_number(id) && is_number(number)).then(|| Named {
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

/// A name as a component of a path on any system, without spaces: letters, digits, `-`, `_` and `.`, but no
/// hidden file.
pub(super) fn file_name(name: &str) -> String {
    let plain = name.chars().map(|character| match character {
        _ if character.is_alphanumeric() || "-_.".contains(character) => character,
        _ => '-',
    });
    let plain: String = plain.collect();
    match plain.trim_matches(['-', '.']) {
        "" => "unnamed".to_owned(),
        name => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(path: &str) -> (String, Option<String>, String, bool) {
        let path: Vec<_> = path.split('/').map(str::to_owned).collect();
        let Submitted {
            student,
            path,
            is_late,
        } = submitted(&path);
        (student.name, student.id, path.join("/"), is_late == Some(true))
    }

    #[test]
    fn systems_name_students_and_files() {
        let of = |name: &str, id: &str, path: &str, is_late| {
            let id = (!id.is_empty()).then(|| id.to_owned());
            (name.to_owned(), id, path.to_owned(), is_late)
        };
        for (path, expected) in [
            (
                "Anna Smith_12_assignsubmission_file/a.glsl",
                of("Anna Smith", "12", "a.glsl", false),
            ),
            (
                "Anna Smith_12_assignsubmission_file_/x/a.glsl",
                of("Anna Smith", "12", "x/a.glsl", false),
            ),
            (
                "Bo van_Dam_7_assignsubmission_file_my_a.glsl",
                of("Bo van_Dam", "7", "my_a.glsl", false),
            ),
            (
                "Participant 9_9_assignsubmission_onlinetext/onlinetext.html",
                of("Participant 9", "9", "onlinetext.html", false),
            ),
            ("doejane_12_345_a.glsl", of("doejane", "12", "a.glsl", false)),
            (
                "doejane_LATE_12_345_my_a-1.glsl",
                of("doejane", "12", "my_a-1.glsl", true),
            ),
            ("anna/a_1_2_b.glsl", of("anna", "", "a_1_2_b.glsl", false)),
            ("anna_1_2_x/a.glsl", of("anna_1_2_x", "", "a.glsl", false)),
            ("anna.glsl", of("anna", "", "anna.glsl", false)),
            ("anna.lee/a.glsl", of("anna.lee", "", "a.glsl", false)),
            (
                "a_x_assignsubmission_file/a.glsl",
                of("a_x_assignsubmission_file", "", "a.glsl", false),
            ),
        ] {
            assert_eq!(read(path), expected, "{path}");
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
        ] {
            assert_eq!(file_name(name), expected);
        }
    }
}
