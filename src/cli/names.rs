//! Output paths for several inputs below one folder.

use std::collections::{HashMap, HashSet};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use toyproof_project::files::Input;

/// Gives each input its own path below an output folder: its own relative path if that is free. No file of an
/// input collides with a file of another input, with a folder on the path to one, or with a report.
#[derive(Debug)]
pub(super) struct Names {
    /// The suffixes that are appended to an input's path, one for each of its files.
    suffixes: Vec<String>,
    /// The paths in use, each with the folder of its input.
    taken: HashMap<Key, Option<PathBuf>>,
    /// The files of all inputs, and the reserved ones.
    files: HashSet<Key>,
    /// The folders that contain them.
    folders: HashSet<Key>,
}

/// A relative path without case: some file systems store names that differ only in case in one file.
#[derive(Debug, PartialEq, Eq, Hash)]
struct Key(String);

impl Key {
    fn new(path: &Path) -> Self {
        Self(path.to_string_lossy().to_lowercase())
    }
}

impl Names {
    /// Starts without inputs. Each input gets one file per suffix, in a folder that also holds the `reserved`
    /// files.
    pub(super) fn new(suffixes: &[&str], reserved: &[&str]) -> Self {
        Self {
            suffixes: suffixes.iter().copied().map(str::to_owned).collect(),
            taken: HashMap::new(),
            files: reserved.iter().map(|name| Key::new(Path::new(name))).collect(),
            folders: HashSet::new(),
        }
    }

    /// Chooses the path of an input's outputs, without a suffix. Where two inputs collide, the second is
    /// named with its folder, if that differs, or else with its extension.
    pub(super) fn assign(&mut self, found: &Input) -> PathBuf {
        let input_folder = found.path().and_then(Path::parent);
        let folder = self.folder(found.relative.parent().unwrap_or(Path::new("")));
        let name = found.relative.file_name().unwrap_or_default();
        let stem = &shortened(found.relative.file_stem().unwrap_or_default());
        let is_beside = self
            .taken
            .get(&Key::new(&folder.join(stem)))
            .is_none_or(|other| other.as_deref() == input_folder);
        let with_folder = || {
            input_folder?
                .file_name()
                .map(|of| joined(&[of, "-".as_ref(), stem]))
        };
        let candidates = [
            Some(stem.to_owned()),
            with_folder().filter(|_| !is_beside),
            Some(name.to_owned()),
        ];
        let path = candidates
            .into_iter()
            .flatten()
            .map(|name| shortened(&name))
            .chain(numbered(stem))
            .map(|name| folder.join(name))
            .find(|path| self.is_free(path))
            .expect("one of endlessly many names is free");
        self.files.extend(
            self.suffixes
                .iter()
                .map(|suffix| Key::new(&with_suffix(&path, suffix))),
        );
        self.folders.extend(path.ancestors().skip(1).map(Key::new));
        self.taken
            .insert(Key::new(&path), input_folder.map(Path::to_owned));
        path
    }

    /// The output folder for a folder of inputs: a component that collides with a file gets a number.
    fn folder(&self, of_inputs: &Path) -> PathBuf {
        of_inputs.iter().fold(PathBuf::new(), |folder, part| {
            std::iter::once(part.to_owned())
                .chain(numbered(part))
                .map(|name| folder.join(name))
                .find(|folder| !self.files.contains(&Key::new(folder)))
                .expect("one of endlessly many names is free")
        })
    }

    fn is_free(&self, path: &Path) -> bool {
        let is_free = |suffix: &String| {
            let key = Key::new(&with_suffix(path, suffix));
            !self.files.contains(&key) && !self.folders.contains(&key)
        };
        !self.taken.contains_key(&Key::new(path)) && self.suffixes.iter().all(is_free)
    }
}

/// The first bytes of a name, so that names derived from it are not too long for a file system.
fn shortened(name: &OsStr) -> OsString {
    const MAX_BYTES: usize = 200;
    if name.len() <= MAX_BYTES {
        return name.to_owned();
    }
    let text = name.to_string_lossy();
    let end = (0..=MAX_BYTES).rev().find(|&end| text.is_char_boundary(end));
    OsString::from(&text[..end.unwrap_or_default()])
}

/// Yields `name-2`, `name-3` and so on.
fn numbered(name: &OsStr) -> impl Iterator<Item = OsString> + use<'_> {
    (2_u64..).map(move |number| joined(&[name, format!("-{number}").as_ref()]))
}

fn joined(parts: &[&OsStr]) -> OsString {
    parts.iter().copied().collect()
}

/// Appends a suffix to the last component of a path.
pub(super) fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    joined(&[path.as_os_str(), suffix.as_ref()]).into()
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::path_name;
    use toyproof_project::files::InputSource;

    use super::*;

    fn output(names: &mut Names, folder: &str, relative: &str) -> String {
        let source = InputSource::File(Path::new(folder).join(relative));
        let found = Input {
            source,
            relative: PathBuf::from(relative),
            folder: None,
        };
        path_name(&names.assign(&found))
    }

    #[test]
    fn outputs_of_long_names_are_short_enough() {
        let mut names = Names::new(&["-algorithm.png"], &[]);
        let long = ["a", "b"].map(|end| format!("{}{end}.glsl", "é".repeat(120)));
        let outputs = long.map(|name| output(&mut names, "in", &name));
        assert!(
            outputs[0] != outputs[1] && outputs.iter().all(|name| name.len() <= 210),
            "{outputs:?}"
        );
    }

    #[test]
    fn no_two_inputs_share_an_output() {
        let mut names = Names::new(&["-actual.png"], &[]);
        let mut output = |folder, relative| output(&mut names, folder, relative);
        assert_eq!(output("in", "a/x.glsl"), "a/x");
        assert_eq!(output("in", "a/x.frag"), "a/x.frag");
        assert_eq!(output("in", "a/x.glsl"), "a/x.glsl", "named twice");
        assert_eq!(output("in", "a/x.glsl"), "a/x-2");
        assert_eq!(output("in/ann", "x.glsl"), "x");
        assert_eq!(output("in/bob", "x.glsl"), "bob-x");
        assert_eq!(output("out/bob", "x.glsl"), "x.glsl");
        assert_eq!(output("out/bob", "y.glsl"), "y");
        assert_eq!(output("out/bob", "Y.glsl"), "Y.glsl", "one file on some systems");
    }

    #[test]
    fn no_output_takes_the_name_of_a_report_or_of_a_folder() {
        let mut names = Names::new(
            &["-actual.png", "-reference.png"],
            &["report.html", "results.jsonl"],
        );
        let mut output = |relative| output(&mut names, "in", relative);
        assert_eq!(output("report.html/x.glsl"), "report.html-2/x");
        assert_eq!(
            output("Report.HTML/y.glsl"),
            "Report.HTML-2/y",
            "one file on some systems"
        );
        assert_eq!(
            output("a/report.html/x.glsl"),
            "a/report.html/x",
            "reports are not there"
        );
        assert_eq!(output("good.glsl"), "good");
        assert_eq!(output("good-reference.png/x.glsl"), "good-reference.png-2/x");
        assert_eq!(output("bad-actual.png/x.glsl"), "bad-actual.png/x");
        assert_eq!(
            output("bad.glsl"),
            "bad.glsl",
            "its image would be where a folder is"
        );
        assert_eq!(output("x-actual.png.glsl"), "x-actual.png");
        assert_eq!(output("x.glsl"), "x");
    }
}
