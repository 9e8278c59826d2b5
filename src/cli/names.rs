//! Names for the outputs of several inputs below one folder.

use std::collections::{HashMap, HashSet};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use crate::cli::files::Found;

/// Gives every input a place of its own below an output folder: its own relative path where that is free. No file of one input has the name of
/// another's, of a folder on the way to another's, or of a report.
#[derive(Debug)]
pub(super) struct Names {
    /// What is appended to an input's place, for each of its files.
    suffixes: Vec<String>,
    /// Places that were given out, each with the folder of its input.
    taken: HashMap<Key, Option<PathBuf>>,
    /// All files of them, and those that are not any input's.
    files: HashSet<Key>,
    /// The folders on the way to them.
    folders: HashSet<Key>,
}

/// A relative path, the same for names that differ only in case: some file systems keep one file for them.
#[derive(Debug, PartialEq, Eq, Hash)]
struct Key(String);

impl Key {
    fn of(path: &Path) -> Self {
        Self(path.to_string_lossy().to_lowercase())
    }
}

impl Names {
    /// Names for inputs each of which gets a file for each suffix, in a folder that also has the `reserved` files.
    pub(super) fn new(suffixes: &[&str], reserved: &[&str]) -> Self {
        Self {
            suffixes: suffixes.iter().copied().map(str::to_owned).collect(),
            taken: HashMap::new(),
            files: reserved.iter().map(|name| Key::of(Path::new(name))).collect(),
            folders: HashSet::new(),
        }
    }

    /// The place of an input's outputs, without a suffix. Of two inputs that would share one, the second has its extension, too, or before
    /// its name that of its folder, if that is another.
    pub(super) fn place(&mut self, found: &Found) -> PathBuf {
        let source = found.path().and_then(Path::parent);
        let folder = self.folder(found.relative.parent().unwrap_or(Path::new("")));
        let name = found.relative.file_name().unwrap_or_default();
        let stem = found.relative.file_stem().unwrap_or_default();
        let is_beside = self
            .taken
            .get(&Key::of(&folder.join(stem)))
            .is_none_or(|other| other.as_deref() == source);
        let with_folder = || source?.file_name().map(|of| joined(&[of, "-".as_ref(), stem]));
        let candidates = [
            Some(stem.to_owned()),
            with_folder().filter(|_| !is_beside),
            Some(name.to_owned()),
        ];
        let place = candidates
            .into_iter()
            .flatten()
            .chain(numbered(stem))
            .map(|name| folder.join(name))
            .find(|place| self.is_free(place))
            .expect("one of endlessly many names is free");
        self.files.extend(
            self.suffixes
                .iter()
                .map(|suffix| Key::of(&with_suffix(&place, suffix))),
        );
        self.folders.extend(place.ancestors().skip(1).map(Key::of));
        self.taken.insert(Key::of(&place), source.map(Path::to_owned));
        place
    }

    /// The folder of outputs for a folder of inputs: a part of it that is the name of a file gets a number.
    fn folder(&self, of_inputs: &Path) -> PathBuf {
        of_inputs.iter().fold(PathBuf::new(), |folder, part| {
            std::iter::once(part.to_owned())
                .chain(numbered(part))
                .map(|name| folder.join(name))
                .find(|folder| !self.files.contains(&Key::of(folder)))
                .expect("one of endlessly many names is free")
        })
    }

    fn is_free(&self, place: &Path) -> bool {
        let is_free = |suffix: &String| {
            let key = Key::of(&with_suffix(place, suffix));
            !self.files.contains(&key) && !self.folders.contains(&key)
        };
        !self.taken.contains_key(&Key::of(place)) && self.suffixes.iter().all(is_free)
    }
}

/// `name-2`, `name-3` and so on.
fn numbered(name: &OsStr) -> impl Iterator<Item = OsString> + use<'_> {
    (2_u64..).map(move |number| joined(&[name, format!("-{number}").as_ref()]))
}

fn joined(parts: &[&OsStr]) -> OsString {
    parts.iter().copied().collect()
}

/// A place with a suffix behind its last name.
pub(super) fn with_suffix(place: &Path, suffix: &str) -> PathBuf {
    joined(&[place.as_os_str(), suffix.as_ref()]).into()
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::path_name;

    use super::*;
    use crate::cli::files::FoundIn;

    fn place(names: &mut Names, folder: &str, relative: &str) -> String {
        let place = FoundIn::File(Path::new(folder).join(relative));
        let found = Found {
            place,
            relative: PathBuf::from(relative),
            folder: None,
        };
        path_name(&names.place(&found))
    }

    #[test]
    fn no_two_inputs_share_an_output() {
        let mut names = Names::new(&["-actual.png"], &[]);
        let mut place = |folder, relative| place(&mut names, folder, relative);
        assert_eq!(place("in", "a/x.glsl"), "a/x");
        assert_eq!(place("in", "a/x.frag"), "a/x.frag");
        assert_eq!(place("in", "a/x.glsl"), "a/x.glsl", "named twice");
        assert_eq!(place("in", "a/x.glsl"), "a/x-2");
        assert_eq!(place("in/ann", "x.glsl"), "x");
        assert_eq!(place("in/bob", "x.glsl"), "bob-x");
        assert_eq!(place("out/bob", "x.glsl"), "x.glsl");
        assert_eq!(place("out/bob", "y.glsl"), "y");
        assert_eq!(place("out/bob", "Y.glsl"), "Y.glsl", "one file on some systems");
    }

    #[test]
    fn no_output_takes_the_name_of_a_report_or_of_a_folder() {
        let mut names = Names::new(
            &["-actual.png", "-reference.png"],
            &["report.html", "results.jsonl"],
        );
        let mut place = |relative| place(&mut names, "in", relative);
        assert_eq!(place("report.html/x.glsl"), "report.html-2/x");
        assert_eq!(
            place("Report.HTML/y.glsl"),
            "Report.HTML-2/y",
            "one file on some systems"
        );
        assert_eq!(
            place("a/report.html/x.glsl"),
            "a/report.html/x",
            "reports are not there"
        );
        assert_eq!(place("good.glsl"), "good");
        assert_eq!(place("good-reference.png/x.glsl"), "good-reference.png-2/x");
        assert_eq!(place("bad-actual.png/x.glsl"), "bad-actual.png/x");
        assert_eq!(
            place("bad.glsl"),
            "bad.glsl",
            "its image would be where a folder is"
        );
        assert_eq!(place("x-actual.png.glsl"), "x-actual.png");
        assert_eq!(place("x.glsl"), "x");
    }
}
