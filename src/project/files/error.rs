//! Why an input cannot be read.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Code, Diagnostic, File, Files, Span, path_name, without_error_numbers};

use super::{MAX_BYTES, MAX_JSON_BYTES};

/// The error of finding or reading an input.
#[derive(Debug)]
pub enum ReadError {
    /// No such file or folder.
    Missing {
        /// The path.
        path: PathBuf,
        /// What the user may mean instead, to follow the message; may be empty.
        hint: String,
    },
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
    /// More than [`MAX_BYTES`], or 8 MiB for JSON.
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
    /// There is no such file or folder.
    #[must_use]
    pub fn missing(path: &Path) -> Self {
        Self::Missing {
            path: path.to_owned(),
            hint: String::new(),
        }
    }

    /// The name of the file or folder.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Missing { path, .. }
            | Self::NoShader(path)
            | Self::NotSubmitted(path, _)
            | Self::Scene(path) => path_name(path),
            Self::Unreadable { name, .. } | Self::TooLarge { name } => name.clone(),
            Self::NotUtf8 { file, .. } => file.name().to_owned(),
        }
    }

    /// What is wrong with the file.
    #[must_use]
    pub fn reason(&self) -> String {
        match self {
            Self::Missing { hint, .. } => format!("no such file or folder{hint}"),
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
pub const TOO_LARGE: &str =
    "the file is larger than 1 MiB, the most that a shader or a scene may have (8 MiB for ShaderToy's JSON)";
const _: () = assert!(MAX_BYTES == 1 << 20 && MAX_JSON_BYTES == 8 << 20);
/// The message on a file that is not UTF-8.
pub const NOT_UTF8: &str = "this is not UTF-8 text; save the file as UTF-8";

/// Converts an error in a file's content to a diagnostic, and adds the file to `files` so that it can be
/// shown.
///
/// # Errors
/// The same error, if the path or the operating system causes it, not the content.
pub fn content_diagnostic(error: ReadError, files: &mut Files) -> Result<Diagnostic, ReadError> {
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
