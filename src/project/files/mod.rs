//! The texts that a command line names: files, folders and standard input.

mod error;
mod include;
mod read;
mod search;
#[cfg(test)]
mod tests;

use std::ffi::OsStr;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{File, path_name};
use toyproof_image::input;

pub use self::error::{NOT_UTF8, ReadError, TOO_LARGE, content_diagnostic};
pub use self::include::{IncludeFolders, IncludedFile, OpenTexts, drop_included};
pub use self::read::{project_image, read, read_bytes, read_named, read_text};
pub use self::search::{OutsideLink, Search, find, search};
use crate::archive::Archive;
use crate::pass::{PassKind, Tab};
use crate::project::Project;

/// The extensions of shaders, by which folders are searched.
pub const EXTENSIONS: [&str; 4] = ["glsl", "frag", "fs", "shadertoy"];

/// The maximum size of a text in bytes. ShaderToy's own editor takes 65,536 characters a tab.
pub const MAX_BYTES: u64 = 1 << 20;

/// The maximum size of a project's JSON in bytes: eight tabs.
const MAX_JSON_BYTES: u64 = 8 << 20;

/// The source of an input's text.
#[derive(Debug, Clone)]
pub enum InputSource {
    /// Standard input, or a pipe: it can be read only once.
    Stream {
        /// The name in messages.
        name: String,
        /// The content.
        bytes: Vec<u8>,
    },
    /// A file, or the folder of a project.
    File(PathBuf),
}

/// The texts of an input.
#[derive(Debug)]
pub enum Texts {
    /// A shader.
    Shader(File),
    /// A project of several tabs.
    Project(ProjectTexts),
}

/// The texts of a project.
#[derive(Debug)]
pub enum ProjectTexts {
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
    #[must_use]
    pub fn files(&self) -> Vec<&File> {
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
pub struct Input {
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
    pub fn path(&self) -> Option<&Path> {
        match &self.source {
            InputSource::Stream { .. } => None,
            InputSource::File(path) => Some(path),
        }
    }

    /// The name in messages and reports: the path as the user typed it.
    #[must_use]
    pub fn name(&self) -> String {
        match &self.source {
            InputSource::Stream { name, .. } => name.clone(),
            InputSource::File(path) => path_name(path),
        }
    }
}

/// Returns whether a folder is a project.
#[must_use]
pub fn is_project(folder: &Path) -> bool {
    folder.join(Tab::Pass(PassKind::Image).file_name()).is_file()
}

/// Returns whether a path is a folder that may have several shaders, and not a project.
#[must_use]
pub fn is_folder_of_shaders(path: &Path) -> bool {
    path.is_dir() && !is_project(path)
}

/// Returns whether a file is a tab of the project in whose folder it lies.
fn is_tab(path: &Path) -> bool {
    let is_named = |name: &OsStr| Tab::ALL.iter().any(|tab| name == OsStr::new(&tab.file_name()));
    path.file_name().is_some_and(is_named) && path.parent().is_some_and(is_project)
}

/// Returns whether a file has the extension of JSON.
#[must_use]
pub fn is_json(path: &Path) -> bool {
    has_extension(path, "json")
}

/// Returns whether a file is the site's JSON.
fn is_project_json(path: &Path) -> bool {
    is_json(path) && read_text(path).is_ok_and(|file| Project::is_json(file.text()))
}

/// Returns whether a text or an archive, which is not searched, has a shader.
#[must_use]
pub fn has_shader(path: &Path) -> bool {
    // As many as `collect` reads.
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
pub fn is_shader(path: &Path) -> bool {
    EXTENSIONS.iter().any(|extension| has_extension(path, extension))
}

/// Returns whether a file is an input by itself.
fn is_input(path: &Path) -> bool {
    is_shader(path) && !is_tab(path) || is_project_json(path)
}

/// Returns whether a file or folder is hidden, as `.git` is, or is the `__MACOSX` folder that macOS adds to
/// archives.
#[must_use]
pub fn is_hidden(name: &OsStr) -> bool {
    name.as_encoded_bytes().starts_with(b".") || name == "__MACOSX"
}
