//! The kinds of differences between a whole image and the expected one, and their ids.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A difference between a shader's image and the expected one that concerns the whole image. A check may
/// permit it; otherwise it is reported as the likely mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Difference {
    /// The shader averages several samples of each pixel; the expected image has one.
    Antialiasing,
    /// Every color component is changed by the same monotone function, such as gamma correction.
    ColorCurve,
    /// Color channels are exchanged.
    SwappedChannels,
    /// The image is mirrored: left and right are exchanged.
    MirroredX,
    /// The image is upside down: top and bottom are exchanged.
    MirroredY,
    /// The image is rotated by a multiple of 90°, or x and y are exchanged.
    Rotated,
    /// The image is scaled or shifted by another convention for screen coordinates.
    Framing,
    /// The image is right for another position of the mouse.
    Mouse,
    /// The frame's number and its time are confused.
    Time,
    /// The image is right only in the resolution that the shader has in place of `iResolution`.
    FixedResolution,
}

impl Difference {
    /// All kinds, the ones that are cheaper to test and harder to confuse first.
    pub const ALL: [Self; 10] = [
        Self::MirroredX,
        Self::MirroredY,
        Self::Rotated,
        Self::SwappedChannels,
        Self::Mouse,
        Self::Time,
        Self::FixedResolution,
        Self::Framing,
        Self::Antialiasing,
        Self::ColorCurve,
    ];

    /// The id, under which the guide lists it.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Antialiasing => "antialiasing",
            Self::ColorCurve => "color-curve",
            Self::SwappedChannels => "swapped-channels",
            Self::MirroredX => "mirrored-x",
            Self::MirroredY => "mirrored-y",
            Self::Rotated => "rotated",
            Self::Framing => "framing",
            Self::Mouse => "mouse",
            Self::Time => "time",
            Self::FixedResolution => "fixed-resolution",
        }
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.id())
    }
}

/// A text is not the id of a [`Difference`].
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("expected one of {}", ids())]
pub struct UnknownDifference;

fn ids() -> String {
    Difference::ALL.map(Difference::id).join(", ")
}

impl FromStr for Difference {
    type Err = UnknownDifference;

    fn from_str(text: &str) -> Result<Self, UnknownDifference> {
        let mut all = Self::ALL.into_iter();
        all.find(|difference| difference.id() == text)
            .ok_or(UnknownDifference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_difference_is_read_from_its_id() {
        for difference in Difference::ALL {
            assert_eq!(difference.id().parse(), Ok(difference));
        }
        let error = "blur".parse::<Difference>().unwrap_err().to_string();
        assert!(
            error.starts_with("expected one of mirrored-x, mirrored-y"),
            "{error}"
        );
    }
}
