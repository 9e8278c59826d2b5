//! Why a film is not written, and ways out.

use std::io;

use thiserror::Error;

use crate::settings::Format;

/// Why a film is not written: a sentence without a full stop.
#[derive(Debug, Error)]
pub enum FilmError {
    /// A file cannot be written, or not be read again. The message names the file.
    #[error("cannot write {0}")]
    Unwritable(io::Error),
    /// The frames of an earlier run cannot be read.
    #[error("{0} is damaged")]
    Damaged(String),
    /// A frame has another size than the film.
    #[error("a frame has {}×{} pixels, and the film {}×{}", .0[0], .0[1], .1[0], .1[1])]
    Size([u32; 2], [u32; 2]),
    /// The format has no partial transparency.
    #[error("{0} has no partial transparency")]
    Opaque(Format),
    /// The format has no sound.
    #[error("{0} has no sound")]
    Silent(Format),
    /// There is no ffmpeg.
    #[error("ffmpeg is not installed, or not in PATH; it writes {0}")]
    NoFfmpeg(Format),
    /// The version is too old.
    #[error("ffmpeg {0} is too old to write {1}: version 4 or later is needed")]
    OldFfmpeg(String, Format),
    /// ffmpeg was built without the encoder.
    #[error("the installed ffmpeg was built without {encoder}, which encodes {format}")]
    NoEncoder {
        /// ffmpeg's name of the encoder.
        encoder: &'static str,
        /// The format of the film.
        format: Format,
    },
    /// ffmpeg failed with this message.
    #[error("ffmpeg cannot write the film: {0}")]
    Ffmpeg(String),
    /// The caller ended the encoding.
    #[error("the encoding was interrupted")]
    Interrupted,
}

impl FilmError {
    /// A way out, if there is one that is not obvious.
    pub fn help(&self) -> Option<&'static str> {
        match self {
            Self::NoFfmpeg(_) | Self::OldFfmpeg(..) => Some(INSTALL),
            Self::NoEncoder { .. } => Some("install a complete ffmpeg, or write .gif, .apng or .y4m"),
            Self::Opaque(_) => Some("write .webm or .apng, or leave out --transparent"),
            Self::Silent(_) => Some("write .mp4 or .webm"),
            Self::Damaged(_) => Some("delete it, and run the same command again"),
            Self::Unwritable(_) | Self::Size(..) | Self::Ffmpeg(_) | Self::Interrupted => None,
        }
    }
}

/// How to install ffmpeg.
const INSTALL: &str = "install it (apt install ffmpeg, dnf install ffmpeg-free, brew install ffmpeg, winget \
                       install ffmpeg), or write .gif, .apng or .y4m, which need no other program";
