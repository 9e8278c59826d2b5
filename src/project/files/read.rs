//! Reads the texts of inputs, within limits.

use std::fs::File as OsFile;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Diagnostics, File, Files, path_name};
use toyproof_image::input;

use super::search::OutsideLink;
use super::{Input, InputSource, MAX_BYTES, MAX_JSON_BYTES, ProjectTexts, ReadError, Texts, is_json};
use crate::folder::PROJECT_FILE;
use crate::pass::Tab;
use crate::project::Project;

/// Reads the texts of an input, without byte order marks. JSON is recognized by its extension or its
/// content.
///
/// # Errors
/// Those of [`ReadError`]; no more than one byte above the limit of a file is ever read.
pub fn read(found: &Input) -> Result<Texts, ReadError> {
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
        Some(match OutsideLink::find(&path, folder) {
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

impl ProjectTexts {
    /// The folder of a project; `None` for JSON, and for a shader that is read as a project.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        match self {
            Self::Folder { folder, .. } => folder.as_deref(),
            Self::Json(_) => None,
        }
    }

    /// Reads a project from its texts, which are added to `files`.
    ///
    /// # Errors
    /// The texts are not those of a project.
    pub fn parse(self, files: &mut Files) -> Result<Project, Diagnostics> {
        match self {
            Self::Json(file) => {
                let file = files.add(file);
                Project::from_json(files, file)
            }
            Self::Folder { toml, tabs, .. } => {
                let toml = toml.map(|file| files.add(file));
                let tabs: Vec<_> = tabs
                    .into_iter()
                    .map(|(tab, file)| (tab, files.add(file)))
                    .collect();
                Project::from_folder(files, toml, &tabs)
            }
        }
    }
}

/// The image of a project in its folder: a regular file, to which no link leads out of the folder.
///
/// # Errors
/// Why it cannot be read.
pub fn project_image(folder: &Path, name: &str) -> Result<PathBuf, String> {
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
    match OutsideLink::find(&path, folder) {
        Some(skipped) => Err(skipped.to_string()),
        None => Ok(path),
    }
}

/// Reads the text of a file, without a byte order mark.
///
/// # Errors
/// Those of [`ReadError`]; no more than one byte above the limit is ever read.
pub fn read_text(path: &Path) -> Result<File, ReadError> {
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
pub fn read_named(path: &Path) -> Result<File, ReadError> {
    decode(read_bytes(path)?, path_name(path), MAX_BYTES)
}

/// Reads a file that the user named, or a pipe of the shell, which is in `/dev` or `/proc`, but at most one
/// byte more than the maximum. Other pipes may be among files that a pattern of the shell named.
///
/// # Errors
/// Those of [`ReadError`].
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let is_of_shell = path.starts_with("/dev") || path.starts_with("/proc");
    let opened = if is_of_shell {
        OsFile::open(path)
    } else {
        input::open(path)
    };
    read_limited(opened, path, MAX_BYTES)
}

/// Reads all bytes of an opened file, but at most one more than the maximum.
pub(super) fn read_limited(
    opened: io::Result<impl Read>,
    path: &Path,
    limit: u64,
) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let read = opened.and_then(|input| input.take(limit + 1).read_to_end(&mut bytes));
    match read {
        Ok(_) => Ok(bytes),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(ReadError::missing(path)),
        Err(error) => Err(ReadError::Unreadable {
            name: path_name(path),
            error,
        }),
    }
}

pub(super) fn decode(bytes: Vec<u8>, name: String, limit: u64) -> Result<File, ReadError> {
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
