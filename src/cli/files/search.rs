//! The shaders below a folder. Links are followed as long as they stay inside of it.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::{fmt, io};

use toyproof_diagnostic::path_name;
use walkdir::{DirEntry, WalkDir};

use crate::cli::files::{Found, FoundIn, ReadError, is_shader};

/// The most files and folders that a search looks at: more is a mistake, as `check /` is.
const MAX_ENTRIES: usize = 1_000_000;

/// A link that is not followed, since it leads out of the folder that is searched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Skipped {
    /// The link.
    pub link: PathBuf,
    /// What it leads to.
    pub target: PathBuf,
    /// The folder that is searched.
    pub folder: PathBuf,
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "skipped `{}`: it links to `{}`, outside `{}`; name the file itself if it is to be read",
            path_name(&self.link),
            path_name(&self.target),
            path_name(&self.folder)
        )
    }
}

impl Skipped {
    /// Whether a path leads out of a folder that it lies in, over links of any kind.
    #[must_use]
    pub(crate) fn of(path: &Path, folder: &Path) -> Option<Self> {
        let here = if folder == Path::new("") {
            Path::new(".")
        } else {
            folder
        };
        let target = path.canonicalize().ok()?;
        let leaves = !target.starts_with(here.canonicalize().ok()?);
        leaves.then(|| Self {
            link: path.to_owned(),
            target,
            folder: here.to_owned(),
        })
    }
}

/// What a search found.
#[derive(Debug, Default)]
pub(crate) struct Search {
    /// The shaders, in the order of their names.
    pub inputs: Vec<Result<Found, ReadError>>,
    /// The links that were not followed.
    pub skipped: Vec<Skipped>,
}

/// Searches a folder and those below it, without what is hidden. Each folder is searched once, by whatever links it can be reached.
pub(super) fn search(folder: &Path) -> Search {
    let mut walk = Walk {
        folder,
        found: Vec::new(),
        skipped: Vec::new(),
        folders: HashSet::new(),
        links: Vec::new(),
        entries: 0,
    };
    walk.visit(folder);
    // Links to folders come last: one that was searched under its own name is not searched again.
    let mut next = 0;
    while let Some(link) = walk.links.get(next).cloned() {
        next += 1;
        if let Ok(target) = link.canonicalize()
            && !walk.folders.contains(&target)
        {
            walk.visit(&link);
        }
    }
    let mut found = walk.found;
    found.sort_by(|(a, _), (b, _)| a.cmp(b));
    Search {
        inputs: found.into_iter().map(|(_, found)| found).collect(),
        skipped: walk.skipped,
    }
}

struct Walk<'a> {
    folder: &'a Path,
    /// Each with its path.
    found: Vec<(PathBuf, Result<Found, ReadError>)>,
    skipped: Vec<Skipped>,
    /// The folders that were searched, as what they are without links.
    folders: HashSet<PathBuf>,
    /// Links to folders.
    links: Vec<PathBuf>,
    entries: usize,
}

impl Walk<'_> {
    /// Searches a folder, which may be a link, and notes the links in it.
    fn visit(&mut self, folder: &Path) {
        let is_top = folder == self.folder;
        let entries = WalkDir::new(folder)
            .follow_root_links(true)
            .sort_by_file_name()
            .into_iter()
            .filter_entry(|entry| is_top && entry.depth() == 0 || !is_hidden(entry.file_name()));
        for entry in entries {
            self.entries += 1;
            if self.entries > MAX_ENTRIES {
                let error =
                    format!("there are more than {MAX_ENTRIES} files and folders in it; name a smaller one");
                self.fail(self.folder.to_owned(), io::Error::other(error));
                self.links.clear();
                return;
            }
            match entry {
                Ok(entry) => self.enter(entry),
                Err(error) => {
                    let path = error.path().unwrap_or(folder).to_owned();
                    self.fail(path, error.into());
                }
            }
        }
    }

    fn enter(&mut self, entry: DirEntry) {
        let kind = entry.file_type();
        if entry.path_is_symlink() && entry.depth() > 0 {
            self.follow(entry.into_path());
        } else if kind.is_dir() || entry.depth() == 0 {
            self.folders.extend(entry.path().canonicalize());
        } else if kind.is_file() && is_shader(entry.path()) {
            self.add(entry.into_path());
        }
    }

    fn follow(&mut self, link: PathBuf) {
        let metadata = match link.metadata() {
            Ok(metadata) => metadata,
            Err(error) => return self.fail(link, error),
        };
        let matters = metadata.is_dir() || metadata.is_file() && is_shader(&link);
        match Skipped::of(&link, self.folder) {
            _ if !matters => {}
            Some(skipped) => self.skipped.push(skipped),
            None if metadata.is_dir() => self.links.push(link),
            None => self.add(link),
        }
    }

    fn add(&mut self, path: PathBuf) {
        let found = Found {
            relative: path.strip_prefix(self.folder).unwrap_or(&path).to_owned(),
            folder: Some(self.folder.to_owned()),
            place: FoundIn::File(path.clone()),
        };
        self.found.push((path, Ok(found)));
    }

    fn fail(&mut self, path: PathBuf, error: io::Error) {
        let name = path_name(&path);
        self.found
            .push((path, Err(ReadError::Unreadable { name, error })));
    }
}

/// Whether a file or folder is hidden, as `.git` is, or macOS put it into an archive beside what was packed.
fn is_hidden(name: &OsStr) -> bool {
    name.as_encoded_bytes().starts_with(b".") || name == "__MACOSX"
}

#[cfg(all(test, unix))]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::*;

    /// A folder `in` with two shaders, and one outside.
    fn folder() -> (tempfile::TempDir, PathBuf) {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("in");
        fs::create_dir_all(folder.join("ann")).unwrap();
        fs::create_dir_all(folder.join(".kept/new")).unwrap();
        for name in ["in/ann/a.glsl", "in/b.glsl", "in/.kept/new/c.glsl", "secret.glsl"] {
            fs::write(outer.path().join(name), "").unwrap();
        }
        (outer, folder)
    }

    fn relative(search: &Search) -> Vec<&Path> {
        let found = search.inputs.iter();
        found
            .map(|found| found.as_ref().unwrap().relative.as_path())
            .collect()
    }

    #[test]
    fn links_out_of_the_folder_are_skipped_and_named() {
        let (outer, folder) = folder();
        symlink("/", folder.join("root")).unwrap();
        symlink(outer.path(), folder.join("ann/up")).unwrap();
        symlink(outer.path().join("secret.glsl"), folder.join("leak.glsl")).unwrap();
        symlink(outer.path().join("secret.glsl"), folder.join("notes.txt")).unwrap();
        let search = search(&folder);
        assert_eq!(relative(&search), ["ann/a.glsl", "b.glsl"].map(Path::new));
        let links: Vec<_> = search
            .skipped
            .iter()
            .map(|skipped| skipped.link.as_path())
            .collect();
        let wanted = ["ann/up", "leak.glsl", "root"].map(|name| folder.join(name));
        assert_eq!(links, wanted);
        let root = search.skipped[2].to_string();
        assert!(root.contains("root`: it links to `/`, outside `"), "{root}");
    }

    #[test]
    fn loops_end_and_each_folder_is_searched_once() {
        let (_outer, folder) = folder();
        symlink("..", folder.join("ann/loop")).unwrap();
        symlink("ann", folder.join("again")).unwrap();
        symlink("../again", folder.join("ann/again")).unwrap();
        symlink("here", folder.join("here")).unwrap();
        symlink(".kept/new", folder.join("newest")).unwrap();
        symlink(".kept/new", folder.join("latest")).unwrap();
        symlink("b.glsl", folder.join("link.glsl")).unwrap();
        let mut search = search(&folder);
        assert!(search.skipped.is_empty(), "{:?}", search.skipped);
        // What links to itself is nothing.
        let nothing = search.inputs.iter().position(Result::is_err).unwrap();
        let error = search.inputs.remove(nothing).unwrap_err().to_string();
        assert!(error.contains("here: cannot be read"), "{error}");
        let wanted = ["ann/a.glsl", "b.glsl", "latest/c.glsl", "link.glsl"];
        assert_eq!(relative(&search), wanted.map(Path::new));
    }

    #[test]
    fn a_folder_that_is_a_link_itself_is_searched() {
        let (outer, folder) = folder();
        let link = outer.path().join("link");
        symlink(&folder, &link).unwrap();
        let search = search(&link);
        assert_eq!(relative(&search), ["ann/a.glsl", "b.glsl"].map(Path::new));
        assert!(search.skipped.is_empty());
    }
}
