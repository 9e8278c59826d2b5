//! Finds the shaders that a command line names. Links are followed as long as they stay inside the searched
//! folder.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::path_name;
use walkdir::{DirEntry, WalkDir};

use super::read::{read_bytes, read_limited};
use super::{Input, InputSource, MAX_BYTES, ReadError, has_extension, is_hidden, is_input, is_project};

/// Finds the shaders that one argument names; a folder yields those below it, sorted by name, without hidden
/// files and without targets of links that lead out of it. Standard input and pipes are read.
#[must_use]
pub fn find(argument: &Path) -> Search {
    let named = |source, name: &OsStr| Input {
        source,
        relative: PathBuf::from(name),
        folder: None,
    };
    let only = |input| Search {
        inputs: vec![input],
        ..Search::default()
    };
    let stream = |bytes: Result<Vec<u8>, ReadError>, name: String, relative| {
        bytes.map(|bytes| named(InputSource::Stream { name, bytes }, relative))
    };
    if argument == Path::new("-") {
        let name = "<stdin>".to_owned();
        let bytes = read_limited(Ok(io::stdin().lock()), Path::new(&name), MAX_BYTES);
        return only(stream(bytes, name, OsStr::new("stdin")));
    }
    if !argument.is_dir() {
        let name = argument.file_name().unwrap_or(argument.as_os_str());
        return only(
            if argument.extension() == Some(OsStr::new("toml")) && argument.exists() {
                Err(ReadError::Scene(argument.to_owned()))
            } else if argument.exists() && !argument.is_file() {
                stream(read_bytes(argument), path_name(argument), name)
            } else if argument.exists() {
                Ok(named(InputSource::File(argument.to_owned()), name))
            } else {
                Err(ReadError::missing(argument))
            },
        );
    }
    let mut search = search(argument);
    if search.inputs.is_empty() {
        search.inputs = vec![Err(ReadError::NoShader(argument.to_owned()))];
    }
    search
}

/// The maximum number of files and folders that a search visits: more is a mistake, as `check /` is.
const MAX_ENTRIES: usize = 1_000_000;

/// A link that is not followed, since it leads out of the searched folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutsideLink {
    /// The link.
    pub link: PathBuf,
    /// The target of the link.
    pub target: PathBuf,
    /// The searched folder.
    pub folder: PathBuf,
}

impl fmt::Display for OutsideLink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "skipped `{}`: it links to `{}`, outside `{}`; to read it, name the file itself",
            path_name(&self.link),
            path_name(&self.target),
            path_name(&self.folder)
        )
    }
}

impl OutsideLink {
    /// Returns the link if a path leads out of the folder that it lies in, through links of any kind.
    #[must_use]
    pub fn find(path: &Path, folder: &Path) -> Option<Self> {
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

/// The result of a search.
#[derive(Debug, Default)]
pub struct Search {
    /// The shaders, sorted by name.
    pub inputs: Vec<Result<Input, ReadError>>,
    /// The links that were not followed.
    pub skipped: Vec<OutsideLink>,
    /// The archives and plain texts, in which `collect` finds shaders.
    pub unread: Vec<PathBuf>,
}

/// Searches a folder and its subfolders, except hidden ones. Each folder is searched once, however many links
/// lead to it.
#[must_use]
pub fn search(folder: &Path) -> Search {
    let mut walk = Walk {
        folder,
        found: Vec::new(),
        skipped: Vec::new(),
        unread: Vec::new(),
        folders: HashSet::new(),
        links: Vec::new(),
        entries: 0,
    };
    walk.visit(folder);
    // Links to folders come last: a folder already searched under its own name is not searched again.
    let mut next = 0;
    while let Some(link) = walk.links.get(next).cloned() {
        next += 1;
        walk.visit(&link);
    }
    let mut found = walk.found;
    found.sort_by(|(a, _), (b, _)| a.cmp(b));
    Search {
        inputs: found.into_iter().map(|(_, found)| found).collect(),
        skipped: walk.skipped,
        unread: walk.unread,
    }
}

struct Walk<'a> {
    folder: &'a Path,
    /// The inputs, each with its path.
    found: Vec<(PathBuf, Result<Input, ReadError>)>,
    skipped: Vec<OutsideLink>,
    unread: Vec<PathBuf>,
    /// The canonical paths of the searched folders.
    folders: HashSet<PathBuf>,
    /// Links to folders.
    links: Vec<PathBuf>,
    entries: usize,
}

impl Walk<'_> {
    /// Searches a folder, which may be a link, and collects the links in it.
    fn visit(&mut self, folder: &Path) {
        let is_top = folder == self.folder;
        let mut entries = WalkDir::new(folder)
            .follow_root_links(true)
            .sort_by_file_name()
            .into_iter()
            .filter_entry(|entry| is_top && entry.depth() == 0 || !is_hidden(entry.file_name()));
        while let Some(entry) = entries.next() {
            self.entries += 1;
            if self.entries > MAX_ENTRIES {
                let error = format!(
                    "the folder contains more than {MAX_ENTRIES} files and folders; name a smaller one"
                );
                self.fail(self.folder.to_owned(), io::Error::other(error));
                self.links.clear();
                return;
            }
            match entry {
                // A link may lead to a folder of which another link has led to a part.
                Ok(entry) if self.is_searched(&entry) => entries.skip_current_dir(),
                Ok(entry) => self.enter(entry),
                Err(error) => {
                    let path = error.path().unwrap_or(folder).to_owned();
                    self.fail(path, error.into());
                }
            }
        }
    }

    /// Whether an entry is a folder that has been searched before; adds other folders to the searched ones.
    fn is_searched(&mut self, entry: &DirEntry) -> bool {
        let is_folder = entry.depth() == 0 || entry.file_type().is_dir();
        is_folder
            && entry
                .path()
                .canonicalize()
                .is_ok_and(|folder| !self.folders.insert(folder))
    }

    fn enter(&mut self, entry: DirEntry) {
        let kind = entry.file_type();
        if entry.path_is_symlink() && entry.depth() > 0 {
            self.follow(entry.into_path());
        } else if kind.is_dir() || entry.depth() == 0 {
            if is_project(entry.path()) {
                self.add(entry.into_path());
            }
        } else if kind.is_file() && is_input(entry.path()) {
            self.add(entry.into_path());
        } else if kind.is_file()
            && ["zip", "txt"]
                .iter()
                .any(|other| has_extension(entry.path(), other))
        {
            self.unread.push(entry.into_path());
        }
    }

    fn follow(&mut self, link: PathBuf) {
        let metadata = match link.metadata() {
            Ok(metadata) => metadata,
            Err(error) => return self.fail(link, error),
        };
        let matters = metadata.is_dir() || metadata.is_file() && is_input(&link);
        match OutsideLink::find(&link, self.folder) {
            _ if !matters => {}
            Some(skipped) => self.skipped.push(skipped),
            None if metadata.is_dir() => self.links.push(link),
            None => self.add(link),
        }
    }

    fn add(&mut self, path: PathBuf) {
        let is_folder = path == self.folder;
        let relative = if is_folder {
            let canonical = path.canonicalize().unwrap_or_else(|_| path.clone());
            PathBuf::from(canonical.file_name().unwrap_or_else(|| "project".as_ref()))
        } else {
            path.strip_prefix(self.folder).unwrap_or(&path).to_owned()
        };
        let found = Input {
            relative,
            folder: (!is_folder).then(|| self.folder.to_owned()),
            source: InputSource::File(path.clone()),
        };
        self.found.push((path, Ok(found)));
    }

    fn fail(&mut self, path: PathBuf, error: io::Error) {
        let name = path_name(&path);
        self.found
            .push((path, Err(ReadError::Unreadable { name, error })));
    }
}
