//! Shaders named on a command line: files, folders and standard input.

use std::ffi::OsStr;
use std::fs::File as OsFile;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use thiserror::Error;
use toyproof_diagnostic::{File, path_name};

use crate::cli::files::search::{Search, search};

/// What a folder is searched for.
pub(super) const EXTENSIONS: [&str; 4] = ["glsl", "frag", "fs", "shadertoy"];

/// The most bytes that a text may have. ShaderToy's own editor takes 65,536 characters a tab.
pub(super) const MAX_BYTES: u64 = 1 << 20;

/// Where an input's text comes from.
#[derive(Debug, Clone)]
pub(crate) enum FoundIn {
    /// Standard input, or a pipe: it can be read only once.
    Stream {
        /// What messages call it.
        name: String,
        /// What was read.
        bytes: Vec<u8>,
    },
    /// A file.
    File(PathBuf),
}

/// One input: where it is, and where its outputs go below an output folder.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Where the text is.
    pub place: FoundIn,
    /// Below the folder that was named; just the file's name for a file named itself.
    pub relative: PathBuf,
    /// The folder that was named and searched; none for a file named itself.
    pub folder: Option<PathBuf>,
}

impl Found {
    /// The file, where it is one.
    #[must_use]
    pub(crate) fn path(&self) -> Option<&Path> {
        match &self.place {
            FoundIn::Stream { .. } => None,
            FoundIn::File(path) => Some(path),
        }
    }

    /// The name that messages and reports use: the path as the user typed it.
    #[must_use]
    pub(crate) fn name(&self) -> String {
        match &self.place {
            FoundIn::Stream { name, .. } => name.clone(),
            FoundIn::File(path) => path_name(path),
        }
    }
}

/// Why an input's text could not be had.
#[derive(Debug, Error)]
pub(crate) enum ReadError {
    /// There is nothing of that name.
    #[error("{}: no such file or folder", path_name(.0))]
    Missing(PathBuf),
    /// A scene where a shader is needed.
    #[error(
        "{name}: this is a scene, not a shader; `toyproof check SHADER --scene {name}` compares a shader with it, and \
         `toyproof render {name} -o PICTURE` traces it",
        name = path_name(.0)
    )]
    Scene(PathBuf),
    /// A folder without any shader.
    #[error(
        "{}: no shader in this folder (looked for .glsl .frag .fs .shadertoy, also in the folders below)",
        path_name(.0)
    )]
    NoShader(PathBuf),
    /// The system refused.
    #[error("{name}: cannot be read: {error}")]
    Unreadable {
        /// The file or folder.
        name: String,
        /// The system's own words.
        error: io::Error,
    },
    /// More than [`MAX_BYTES`].
    #[error("{name}: {TOO_LARGE}")]
    TooLarge {
        /// The file.
        name: String,
    },
    /// Not UTF-8.
    #[error("{}:{}:{}: {NOT_UTF8}", file.name(), file.position(*at).line, file.position(*at).column)]
    NotUtf8 {
        /// The file, with stand-ins for what is not UTF-8.
        file: File,
        /// The first byte that is not.
        at: usize,
    },
}

/// What is said of a file that is too large.
pub(crate) const TOO_LARGE: &str =
    "the file is larger than 1 MiB, the most that a shader or a scene may have";
const _: () = assert!(MAX_BYTES == 1 << 20);
/// What is said of a file that is not UTF-8.
pub(crate) const NOT_UTF8: &str = "this is not UTF-8 text; save the file as UTF-8";

/// The shaders that one argument names; a folder gives those below it, in the order of their names, without what is hidden and what links
/// lead out of it to. Standard input and pipes are read.
#[must_use]
pub(crate) fn find(argument: &Path) -> Search {
    let named = |place, name: &OsStr| Found {
        place,
        relative: PathBuf::from(name),
        folder: None,
    };
    let only = |input| Search {
        inputs: vec![input],
        skipped: Vec::new(),
    };
    let stream = |bytes: Result<Vec<u8>, ReadError>, name: String, relative| {
        bytes.map(|bytes| named(FoundIn::Stream { name, bytes }, relative))
    };
    if argument == Path::new("-") {
        let name = "<stdin>".to_owned();
        let bytes = bytes_of(io::stdin().lock(), &name);
        return only(stream(bytes, name, OsStr::new("stdin")));
    }
    if !argument.is_dir() {
        let name = argument.file_name().unwrap_or(argument.as_os_str());
        return only(
            if argument.extension() == Some(OsStr::new("toml")) && argument.exists() {
                Err(ReadError::Scene(argument.to_owned()))
            } else if argument.exists() && !argument.is_file() {
                stream(bytes_at(argument), path_name(argument), name)
            } else if argument.exists() {
                Ok(named(FoundIn::File(argument.to_owned()), name))
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

/// Whether a file is a shader by its name.
#[must_use]
pub(crate) fn is_shader(path: &Path) -> bool {
    path.extension()
        .and_then(OsStr::to_str)
        .is_some_and(|extension| EXTENSIONS.contains(&extension))
}

/// The text of an input, without a byte order mark.
///
/// # Errors
/// Those of [`ReadError`]; no more than [`MAX_BYTES`] are ever read.
pub(crate) fn read(found: &Found) -> Result<File, ReadError> {
    match &found.place {
        FoundIn::Stream { name, bytes } => decoded(bytes.clone(), name.clone()),
        FoundIn::File(path) => read_text(path),
    }
}

/// The text of a file, without a byte order mark.
///
/// # Errors
/// Those of [`ReadError`]; no more than [`MAX_BYTES`] are ever read.
pub(crate) fn read_text(path: &Path) -> Result<File, ReadError> {
    decoded(bytes_at(path)?, path_name(path))
}

fn bytes_at(path: &Path) -> Result<Vec<u8>, ReadError> {
    let name = path_name(path);
    match OsFile::open(path) {
        Ok(file) => bytes_of(file, &name),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(ReadError::Missing(path.to_owned())),
        Err(error) => Err(ReadError::Unreadable { name, error }),
    }
}

/// What there is to read, or one byte more than may be decoded.
fn bytes_of(input: impl Read, name: &str) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    match input.take(MAX_BYTES + 1).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(ReadError::Unreadable {
            name: name.to_owned(),
            error,
        }),
    }
}

fn decoded(bytes: Vec<u8>, name: String) -> Result<File, ReadError> {
    if bytes.len() as u64 > MAX_BYTES {
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

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_folder_gives_its_shaders_in_order_with_relative_paths() {
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
    fn what_is_hidden_is_found_only_by_its_name() {
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
    fn an_endless_file_is_too_large_and_not_read_to_its_end() {
        let endless = bytes_of(io::repeat(b' '), "x").unwrap();
        assert_eq!(endless.len() as u64, MAX_BYTES + 1);
        let endless = decoded(endless, "x".to_owned());
        assert!(matches!(endless, Err(ReadError::TooLarge { .. })));
    }

    #[test]
    fn a_byte_that_is_not_utf8_is_named_by_line_and_column() {
        let error = decoded(b"ok\nab\xffc".to_vec(), "x".to_owned()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "x:2:3: this is not UTF-8 text; save the file as UTF-8"
        );
    }

    #[test]
    fn a_byte_order_mark_is_not_part_of_the_text() {
        let file = decoded("\u{feff}void".into(), "x".to_owned()).unwrap();
        assert_eq!(file.text(), "void");
    }
}
