//! How the textures of a buffer are made.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::grouped;
use toyproof_image::{MAX_PIXELS, MAX_SIDE, SizeError, check_size};

use crate::{SizeExpr, Target};

/// How the textures of a buffer are made.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BufferFormat {
    /// The size of the textures.
    pub size: BufferSize,
    /// Whether mipmaps are made.
    pub mipmaps: bool,
    /// Whether the textures become zero before each frame; otherwise they keep their content.
    pub is_cleared: bool,
}

/// The size of a buffer.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum BufferSize {
    /// That of the image.
    #[default]
    Image,
    /// Width and height, computed from those of the image.
    Computed(Box<[SizeExpr; 2]>),
}

/// Buffers that are too large.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum OversizedBuffer {
    /// One would be larger than an image can be.
    #[error("{buffer}: {error}")]
    One {
        /// The buffer.
        buffer: Target,
        /// Its size and the limit.
        error: SizeError,
    },
    /// All buffers together.
    #[error(
        "the buffers have {} pixels together, more than {}",
        grouped(*.texels),
        grouped(*.limit)
    )]
    All {
        /// The number of their pixels.
        texels: u64,
        /// The limit.
        limit: u64,
    },
}

impl BufferSize {
    /// Width and height in pixels for an image of this size: integers, rounded down, of at least 1. A size
    /// beyond the limits of an image is reduced to them.
    pub fn of(&self, image: [u32; 2]) -> [u32; 2] {
        let Some(size) = self.computed(image) else {
            return image;
        };
        let [width, height] = size.map(|side| side.min(f64::from(MAX_SIDE)) as u32);
        let rows = MAX_PIXELS / u64::from(width);
        [width, u64::from(height).min(rows) as u32]
    }

    /// Checks that an image can have the size.
    ///
    /// # Errors
    /// If it is too large.
    pub(crate) fn check(&self, image: [u32; 2]) -> Result<(), SizeError> {
        let Some(size) = self.computed(image) else {
            return Ok(());
        };
        // Conversion saturates, below a number whose square overflows.
        let [width, height] = size.map(|side| u64::from(side as u32));
        check_size(width, height).map(drop)
    }

    /// The integers that are computed, of at least 1; `None` for the size of the image. What is not a number
    /// becomes 1, as in the hosts of ISF.
    fn computed(&self, image: [u32; 2]) -> Option<[f64; 2]> {
        match self {
            Self::Image => None,
            Self::Computed(sides) => Some(sides.each_ref().map(|side| side.value(image).floor().max(1.0))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BinaryFunction, Step};

    /// A width that is the image's, multiplied, and a height of 3.
    fn scaled(factor: f64) -> BufferSize {
        let width = vec![
            Step::Width,
            Step::Constant(factor),
            Step::Binary(BinaryFunction::Multiply),
        ];
        BufferSize::Computed(Box::new(
            [width, vec![Step::Constant(3.0)]].map(|steps| SizeExpr::new(steps).unwrap()),
        ))
    }

    #[test]
    fn sizes_are_integers_within_the_limits_of_an_image() {
        assert_eq!(BufferSize::Image.of([7, 5]), [7, 5]);
        assert_eq!(scaled(0.5).of([7, 5]), [3, 3]);
        assert_eq!(scaled(0.01).of([7, 5]), [1, 3]);
        assert_eq!(scaled(-2.0).of([7, 5]), [1, 3]);
        assert_eq!(scaled(f64::NAN).of([7, 5]), [1, 3]);
        assert_eq!(scaled(f64::INFINITY).of([7, 5]), [MAX_SIDE, 3]);
        assert_eq!(scaled(1e5).check([7, 5]), Err(SizeError::TooLarge(700_000, 3)));
        let largest = u64::from(u32::MAX);
        assert_eq!(
            scaled(f64::INFINITY).check([7, 5]),
            Err(SizeError::TooLarge(largest, 3))
        );
        assert_eq!(scaled(2.0).check([7, 5]), Ok(()));
        // Both sides are within their limit, and the area is not.
        let side = || SizeExpr::new(vec![Step::Constant(f64::from(MAX_SIDE))]).unwrap();
        let square = BufferSize::Computed(Box::new([side(), side()]));
        assert_eq!(square.of([1, 1]), [MAX_SIDE, 2048]);
        assert!(square.check([1, 1]).is_err());
    }
}
