//! The texts that a command line names: files, folders and standard input. Links are followed as long as they
//! stay inside the searched folder.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::fmt;
use std::fs::File as OsFile;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Code, Diagnostic, File, Files, Span, path_name};
use toyproof_image::input;
use toyproof_project::{PROJECT_FILE, PassKind, Project, Tab};
use walkdir::{DirEntry, WalkDir};

use crate::cli::scenes::builtin_name;
use crate::cli::terminal::without_error_numbers;
use crate::cli::zip::Archive;

/// The extensions of shaders, by which folders are searched.
pub(super) const EXTENSIONS: [&str; 4] = ["glsl", "frag", "fs", "shadertoy"];

/// The maximum size of a text in bytes. ShaderToy's own editor takes 65,536 characters a tab.
pub(super) const MAX_BYTES: u64 = 1 << 20;

/// The maximum size of a project's JSON in bytes: eight tabs.
const MAX_JSON_BYTES: u64 = 8 << 20;

/// The source of an input's text.
#[derive(Debug, Clone)]
pub(crate) enum InputSource {
    /// Standard input, or a pipe: it can be read only once.
    Stream {
        /// Its name in messages.
        name: String,
        /// The content.
        bytes: Vec<u8>,
    },
    /// A file, or the folder of a project.
    File(PathBuf),
}

/// The texts of an input.
#[derive(Debug)]
pub(crate) enum Texts {
    /// A shader.
    Shader(File),
    /// A project of several tabs.
    Project(ProjectTexts),
}

/// The texts of a project.
#[derive(Debug)]
pub(crate) enum ProjectTexts {
    /// The site's JSON.
    Json(File),
    /// A folder.
    Folder {
        /// `project.toml`.
        toml: Option<File>,
        /// The tabs.
        tabs: Vec<(Tab, File)>,
        /// The folder; `None` for a shader that is read as a project.
        folder: Option<PathBuf>,
    },
}

impl Texts {
    /// All files.
    pub(crate) fn files(&self) -> Vec<&File> {
        match self {
            Self::Shader(file) | Self::Project(ProjectTexts::Json(file)) => vec![file],
            Self::Project(ProjectTexts::Folder { toml, tabs, .. }) => {
                toml.iter().chain(tabs.iter().map(|(_, file)| file)).collect()
            }
        }
    }
}

/// An input: the source of its text, and the path of its outputs below an output folder.
#[derive(Debug, Clone)]
pub(crate) struct Input {
    /// The source of the text.
    pub source: InputSource,
    /// The path relative to the folder argument; the file name for a file argument.
    pub relative: PathBuf,
    /// The folder argument that was searched; `None` for a file argument.
    pub folder: Option<PathBuf>,
}

impl Input {
    /// The path of the file; `None` for a stream.
    #[must_use]
    pub(crate) fn path(&self) -> Option<&Path> {
        match &self.source {
            InputSource::Stream { .. } => None,
            InputSource::File(path) => Some(path),
        }
    }

    /// The name in messages and reports: the path as the user typed it.
    #[must_use]
    pub(crate) fn name(&self) -> String {
        match &self.source {
            InputSource::Stream { name, .. } => name.clone(),
            InputSource::File(path) => path_name(path),
        }
    }
}

/// The error of finding or reading an input.
#[derive(Debug)]
pub(crate) enum ReadError {
    /// No such file or folder.
    Missing(PathBuf),
    /// A scene where a shader is required.
    Scene(PathBuf),
    /// A folder without any shader.
    NoShader(PathBuf),
    /// The folder of a student without any shader, and what there is instead.
    NotSubmitted(PathBuf, String),
    /// An error of the operating system.
    Unreadable {
        /// The file or folder.
        name: String,
        /// The operating system's error.
        error: io::Error,
    },
    /// More than [`MAX_BYTES`], or for JSON [`MAX_JSON_BYTES`].
    TooLarge {
        /// The file.
        name: String,
    },
    /// Not UTF-8.
    NotUtf8 {
        /// The file, with replacement characters for invalid bytes.
        file: File,
        /// The offset of the first invalid byte.
        at: usize,
    },
}

impl ReadError {
    /// The name of the file or folder.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Missing(path) | Self::NoShader(path) | Self::NotSubmitted(path, _) | Self::Scene(path) => {
                path_name(path)
            }
            Self::Unreadable { name, .. } | Self::TooLarge { name } => name.clone(),
            Self::NotUtf8 { file, .. } => file.name().to_owned(),
        }
    }

    /// What is wrong with it.
    pub(crate) fn reason(&self) -> String {
        match self {
            Self::Missing(path) => match builtin_name(path) {
                None => "no such file or folder".to_owned(),
                Some(name) => format!(
                    "no such file or folder; `{name}` is a built-in scene (to render it: `toyproof render {name}`; to compare \
                     a shader with it: `toyproof check SHADER --scene {name}`)"
                ),
            },
            Self::Scene(path) => format!(
                "this is a scene, not a shader (to compare a shader with it: `toyproof check SHADER --scene {name}`; to \
                 render it: `toyproof render {name}`)",
                name = path_name(path)
            ),
            Self::NoShader(_) => {
                "no shader in this folder or its subfolders (searched for .glsl .frag .fs .shadertoy)"
                    .to_owned()
            }
            Self::NotSubmitted(_, instead) => format!("no shader was submitted{instead}"),
            Self::Unreadable { error, .. } => without_error_numbers(&format!("cannot be read: {error}")),
            Self::TooLarge { .. } => TOO_LARGE.to_owned(),
            Self::NotUtf8 { .. } => NOT_UTF8.to_owned(),
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())?;
        if let Self::NotUtf8 { file, at } = self {
            let at = file.position(*at);
            write!(f, ":{}:{}", at.line, at.column)?;
        }
        write!(f, ": {}", self.reason())
    }
}

/// The message on a file that is too large.
pub(crate) const TOO_LARGE: &str =
    "the file is larger than 1 MiB, the most that a shader or a scene may have (8 MiB for ShaderToy's JSON)";
const _: () = assert!(MAX_BYTES == 1 << 20 && MAX_JSON_BYTES == 8 << 20);
/// The message on a file that is not UTF-8.
pub(crate) const NOT_UTF8: &str = "this is not UTF-8 text; save the file as UTF-8";

/// Finds the shaders that one argument names; a folder yields those below it, sorted by name, without hidden
/// files and without targets of links that lead out of it. Standard input and pipes are read.
#[must_use]
pub(crate) fn find(argument: &Path) -> Search {
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
                Err(ReadError::Missing(argument.to_owned()))
            },
        );
    }
    let mut search = search(argument);
    if search.inputs.is_empty() {
        search.inputs = vec![Err(ReadError::NoShader(argument.to_owned()))];
    }
    search
}

/// Returns whether a folder is a project.
#[must_use]
pub(crate) fn is_project(folder: &Path) -> bool {
    folder.join(Tab::Pass(PassKind::Image).file_name()).is_file()
}

/// Returns whether a path is a folder that may have several shaders, and not a project.
#[must_use]
pub(crate) fn is_folder_of_shaders(path: &Path) -> bool {
    path.is_dir() && !is_project(path)
}

/// Returns whether a file is a tab of the project in whose folder it lies.
fn is_tab(path: &Path) -> bool {
    let is_named = |name: &OsStr| Tab::ALL.iter().any(|tab| name == OsStr::new(&tab.file_name()));
    path.file_name().is_some_and(is_named) && path.parent().is_some_and(is_project)
}

/// Returns whether a file has the extension of JSON.
#[must_use]
pub(crate) fn is_json(path: &Path) -> bool {
    has_extension(path, "json")
}

/// Returns whether a file is the site's JSON.
fn is_project_json(path: &Path) -> bool {
    is_json(path) && read_text(path).is_ok_and(|file| Project::is_json(file.text()))
}

/// Returns whether a text or an archive, which is not searched, has a shader.
pub(super) fn has_shader(path: &Path) -> bool {
    const MAX_ENTRIES: usize = 10_000;
    if !has_extension(path, "zip") {
        return read_text(path).is_ok_and(|file| file.text().contains("mainImage"));
    }
    let archive = input::open(path).and_then(|file| Archive::open(BufReader::new(file), MAX_ENTRIES));
    let entries = archive.map(|mut archive| archive.take_entries());
    entries.is_ok_and(|entries| entries.iter().any(|entry| is_shader(Path::new(&entry.name))))
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension()
        .is_some_and(|actual| actual.eq_ignore_ascii_case(extension))
}

/// Returns whether a file has a shader's extension.
#[must_use]
pub(crate) fn is_shader(path: &Path) -> bool {
    EXTENSIONS.iter().any(|extension| has_extension(path, extension))
}

/// Reads the texts of an input, without byte order marks. JSON is recognized by its extension or its
/// content.
///
/// # Errors
/// Those of [`ReadError`]; no more than one byte above the limit of a file is ever read.
pub(crate) fn read(found: &Input) -> Result<Texts, ReadError> {
    let file = match &found.source {
        InputSource::Stream { name, bytes } => decode(bytes.clone(), name.clone(), MAX_BYTES)?,
        InputSource::File(path) if path.is_dir() => return read_folder(path).map(Texts::Project),
        InputSource::File(path) => read_text(path)?,
    };
    Ok(
        if found.path().is_some_and(is_json) || Project::is_json(file.text()) {
            Texts::Project(ProjectTexts::Json(file))
        } else {
            Texts::Shader(file)
        },
    )
}

/// Reads the files of a project; links that lead out of the folder are errors.
fn read_folder(folder: &Path) -> Result<ProjectTexts, ReadError> {
    let read = |name: &str| -> Option<Result<File, ReadError>> {
        let path = folder.join(name);
        if !path.is_file() {
            return None;
        }
        Some(match Skipped::of(&path, folder) {
            Some(skipped) => Err(ReadError::Unreadable {
                name: path_name(&path),
                error: io::Error::other(skipped.to_string()),
            }),
            None => read_text(&path),
        })
    };
    let mut tabs = Vec::new();
    for tab in Tab::ALL {
        if let Some(file) = read(&tab.file_name()) {
            tabs.push((tab, file?));
        }
    }
    let toml = read(PROJECT_FILE).transpose()?;
    Ok(ProjectTexts::Folder {
        toml,
        tabs,
        folder: Some(folder.to_owned()),
    })
}

/// The image of a project in its folder: a regular file, to which no link leads out of the folder.
///
/// # Errors
/// Why it cannot be read.
pub(super) fn project_image(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let path = folder.join(name);
    let shown = path_name(Path::new(name));
    match path.metadata() {
        Ok(found) if !found.is_file() => return Err(format!("{shown} is not a regular file")),
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(format!("there is no file {shown} in the folder of the project"));
        }
        Err(error) => return Err(format!("{shown} cannot be read: {error}")),
    }
    match Skipped::of(&path, folder) {
        Some(skipped) => Err(skipped.to_string()),
        None => Ok(path),
    }
}

/// Reads the text of a file, without a byte order mark.
///
/// # Errors
/// Those of [`ReadError`]; no more than one byte above the limit is ever read.
pub(crate) fn read_text(path: &Path) -> Result<File, ReadError> {
    let limit = if is_json(path) { MAX_JSON_BYTES } else { MAX_BYTES };
    decode(
        read_limited(input::open(path), path, limit)?,
        path_name(path),
        limit,
    )
}

/// Reads the text of a file as [`read_text`] does, also of a pipe: one that the user named, as in `--scene
/// <(…)`, and not one that was found in a folder.
///
/// # Errors
/// As for [`read_text`].
pub(crate) fn read_named(path: &Path) -> Result<File, ReadError> {
    decode(read_bytes(path)?, path_name(path), MAX_BYTES)
}

/// Reads a file that the user named, or a pipe of the shell, which is in `/dev` or `/proc`, but at most one byte
/// more than the maximum. Other pipes may be among files that a pattern of the shell named.
///
/// # Errors
/// Those of [`ReadError`].
pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let is_of_shell = path.starts_with("/dev") || path.starts_with("/proc");
    let opened = if is_of_shell {
        OsFile::open(path)
    } else {
        input::open(path)
    };
    read_limited(opened, path, MAX_BYTES)
}

/// Reads all bytes of an opened file, but at most one more than the maximum.
fn read_limited(opened: io::Result<impl Read>, path: &Path, limit: u64) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let read = opened.and_then(|input| input.take(limit + 1).read_to_end(&mut bytes));
    match read {
        Ok(_) => Ok(bytes),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(ReadError::Missing(path.to_owned())),
        Err(error) => Err(ReadError::Unreadable {
            name: path_name(path),
            error,
        }),
    }
}

fn decode(bytes: Vec<u8>, name: String, limit: u64) -> Result<File, ReadError> {
    if bytes.len() as u64 > limit {
        return Err(ReadError::TooLarge { name });
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(File::new(name, text.strip_prefix('\u{feff}').unwrap_or(&text))),
        Err(error) => Err(ReadError::NotUtf8 {
            at: error.utf8_error().valid_up_to(),
            file: File::new(name, String::from_utf8_lossy(error.as_bytes())),
        }),
    }
}

// The shaders below a folder.

/// The maximum number of files and folders that a search visits: more is a mistake, as `check /` is.
const MAX_ENTRIES: usize = 1_000_000;

/// A link that is not followed, since it leads out of the searched folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Skipped {
    /// The link.
    pub link: PathBuf,
    /// Its target.
    pub target: PathBuf,
    /// The searched folder.
    pub folder: PathBuf,
}

impl fmt::Display for Skipped {
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

impl Skipped {
    /// Returns the link if a path leads out of the folder that it lies in, through links of any kind.
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

/// The result of a search.
#[derive(Debug, Default)]
pub(crate) struct Search {
    /// The shaders, sorted by name.
    pub inputs: Vec<Result<Input, ReadError>>,
    /// The links that were not followed.
    pub skipped: Vec<Skipped>,
    /// The archives and plain texts, in which `collect` finds shaders.
    pub unread: Vec<PathBuf>,
}

/// Searches a folder and its subfolders, except hidden ones. Each folder is searched once, however many links
/// lead to it.
pub(super) fn search(folder: &Path) -> Search {
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
        unread: walk.unread,
    }
}

struct Walk<'a> {
    folder: &'a Path,
    /// The inputs, each with its path.
    found: Vec<(PathBuf, Result<Input, ReadError>)>,
    skipped: Vec<Skipped>,
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
        let entries = WalkDir::new(folder)
            .follow_root_links(true)
            .sort_by_file_name()
            .into_iter()
            .filter_entry(|entry| is_top && entry.depth() == 0 || !is_hidden(entry.file_name()));
        for entry in entries {
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
        match Skipped::of(&link, self.folder) {
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

/// Returns whether a file is an input by itself.
fn is_input(path: &Path) -> bool {
    is_shader(path) && !is_tab(path) || is_project_json(path)
}

/// Returns whether a file or folder is hidden, as `.git` is, or is the `__MACOSX` folder that macOS adds to
/// archives.
pub(super) fn is_hidden(name: &OsStr) -> bool {
    name.as_encoded_bytes().starts_with(b".") || name == "__MACOSX"
}

// Errors in the content of a file, as diagnostics.

/// Converts an error in a file's content to a diagnostic, and adds the file to `files` so that it can be
/// shown.
///
/// # Errors
/// The same error, if the path or the operating system causes it, not the content.
pub(crate) fn content_diagnostic(error: ReadError, files: &mut Files) -> Result<Diagnostic, ReadError> {
    let mut of = |message, file, start: usize, end: usize| {
        let id = files.add(file);
        Diagnostic::new(Code::UnreadableFile, message).at(Span::new(id, start as u32, end as u32))
    };
    match error {
        ReadError::TooLarge { name } => Ok(of(TOO_LARGE, File::new(name, ""), 0, 0)),
        ReadError::NotUtf8 { file, at } => {
            let end = at + char::REPLACEMENT_CHARACTER.len_utf8();
            Ok(of(NOT_UTF8, file, at, end).help("`toyproof collect FOLDER -o NEW` saves shaders as UTF-8"))
        }
        other => Err(other),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn folders_yield_their_shaders_in_order_with_relative_paths() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("b")).unwrap();
        for name in ["z.frag", "a.glsl", "b/c.fs", "notes.txt"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let relative: Vec<_> = find(folder.path())
            .inputs
            .into_iter()
            .map(|found| found.unwrap().relative)
            .collect();
        assert_eq!(relative, ["a.glsl", "b/c.fs", "z.frag"].map(PathBuf::from));
    }

    #[test]
    fn hidden_files_are_found_only_by_name() {
        let folder = tempfile::tempdir().unwrap();
        for below in [".git", "__MACOSX", "a"] {
            fs::create_dir(folder.path().join(below)).unwrap();
        }
        for name in [".git/x.glsl", ".h.glsl", "__MACOSX/._a.glsl", "a/b.glsl"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let relative = |argument: &Path| -> Vec<PathBuf> {
            let found = find(argument).inputs.into_iter();
            found.map(|found| found.unwrap().relative).collect()
        };
        assert_eq!(relative(folder.path()), [Path::new("a/b.glsl")]);
        assert_eq!(relative(&folder.path().join(".git")), [Path::new("x.glsl")]);
        assert_eq!(relative(&folder.path().join(".h.glsl")), [Path::new(".h.glsl")]);
    }

    #[test]
    fn endless_files_are_too_large_and_not_read_completely() {
        let endless = read_limited(Ok(io::repeat(b' ')), Path::new("x"), MAX_BYTES).unwrap();
        assert_eq!(endless.len() as u64, MAX_BYTES + 1);
        let endless = decode(endless, "x".to_owned(), MAX_BYTES);
        assert!(matches!(endless, Err(ReadError::TooLarge { .. })));
    }

    #[test]
    fn invalid_utf8_is_reported_by_line_and_column() {
        let error = decode(b"ok\nab\xffc".to_vec(), "x".to_owned(), MAX_BYTES).unwrap_err();
        assert_eq!(
            error.to_string(),
            "x:2:3: this is not UTF-8 text; save the file as UTF-8"
        );
    }

    #[test]
    fn a_byte_order_mark_is_not_part_of_the_text() {
        let file = decode("\u{feff}void".into(), "x".to_owned(), MAX_BYTES).unwrap();
        assert_eq!(file.text(), "void");
    }

    #[test]
    fn invalid_utf8_is_shown_as_a_replacement_character() {
        let mut files = Files::default();
        let error = ReadError::NotUtf8 {
            file: File::new("x", "ok\nab\u{fffd}c"),
            at: 5,
        };
        let diagnostic = content_diagnostic(error, &mut files).unwrap();
        assert_eq!(files.text(diagnostic.span.unwrap()), "\u{fffd}");
        assert!(content_diagnostic(ReadError::Missing("y".into()), &mut files).is_err());
    }
}

#[cfg(all(test, unix))]
mod link_tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::*;

    /// Creates a folder `in` with two visible shaders and a hidden one, and a shader outside of it.
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
    fn links_out_of_the_folder_are_skipped_and_reported() {
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
    fn link_cycles_end_and_each_folder_is_searched_once() {
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
        // A link to itself leads nowhere.
        let nothing = search.inputs.iter().position(Result::is_err).unwrap();
        let error = search.inputs.remove(nothing).unwrap_err().to_string();
        assert!(error.contains("here: cannot be read"), "{error}");
        let wanted = ["ann/a.glsl", "b.glsl", "latest/c.glsl", "link.glsl"];
        assert_eq!(relative(&search), wanted.map(Path::new));
    }

    #[test]
    fn a_linked_folder_is_searched() {
        let (outer, folder) = folder();
        let link = outer.path().join("link");
        symlink(&folder, &link).unwrap();
        let search = search(&link);
        assert_eq!(relative(&search), ["ann/a.glsl", "b.glsl"].map(Path::new));
        assert!(search.skipped.is_empty());
    }
}
