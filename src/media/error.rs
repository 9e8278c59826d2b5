//! What is wrong with a file of media.

use std::path::PathBuf;

use thiserror::Error;
use toyproof_diagnostic::path_name;
use toyproof_image::ImageError;

/// A file that cannot be used.
#[derive(Debug, Error)]
pub enum MediaError {
    /// An image cannot be read.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The file is not what it is used as.
    #[error("{}: {problem}", path_name(path))]
    File {
        /// The file.
        path: PathBuf,
        /// One sentence without a full stop.
        problem: String,
        /// What the user can do.
        help: Option<&'static str>,
    },
}

impl MediaError {
    /// An error with a file that no general advice helps with.
    pub(crate) fn new(path: &std::path::Path, problem: impl Into<String>) -> Self {
        Self::File {
            path: path.to_owned(),
            problem: problem.into(),
            help: None,
        }
    }

    /// The error with what the user can do.
    #[must_use]
    pub(crate) fn with_help(mut self, advice: &'static str) -> Self {
        if let Self::File { help, .. } = &mut self {
            *help = Some(advice);
        }
        self
    }

    /// What the user can do.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            Self::Image(_) => None,
            Self::File { help, .. } => *help,
        }
    }
}
