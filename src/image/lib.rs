//! Images of linear floats and of 8-bit display values, the inputs of one ShaderToy frame, and atomic file
//! output. PNG holds display values; EXR holds floats.
//!
//! Rows run upwards, as fragment coordinates do: row 0 is the bottom. `file` converts to and from the
//! top-down rows of image files.
//!
//! ```
//! use toyproof_image::{Image, encode};
//!
//! let ramp = Image::new(2, 1, vec![[0.0, 0.0, 0.0, 1.0], [1.0, 0.5, 0.0, 1.0]]);
//! let png = encode(&ramp, "ramp.png".as_ref()).unwrap();
//! assert!(png.starts_with(b"\x89PNG"));
//! ```
//!
//! # Parts
//!
//! - `rgb8`: images as displayed, in 8 bits.
//! - `texture`: images, [cube maps](cube) and volumes with mipmaps; `noise`: substitutes for ShaderToy's
//!   noise textures.
//! - `frame`: ShaderToy's inputs of one frame and their uniform block.
//! - `frame_inputs`: these inputs as a user describes them, before files are read.
//! - `moving`: textures that change from frame to frame.
//! - `keys`, `script`: the keyboard, and the user's actions over the frames of a run.
//! - `file`: image files, the only place that quantizes; `exr_channels`: EXR with channels beside the colors.
//!   Only these flip rows.
//! - `output`: atomic writing of files.
//! - [`input`]: the only place that opens files of others: regular files only.

pub mod cube;
#[cfg(feature = "files")]
mod exr_channels;
#[cfg(feature = "files")]
mod file;
mod frame;
mod frame_inputs;
#[cfg(feature = "files")]
pub mod input;
mod inputs;
mod keys;
mod moving;
mod noise;
#[cfg(feature = "files")]
pub mod output;
mod rgb8;
mod sampling;
mod script;
mod texture;

#[cfg(feature = "files")]
pub use exr_channels::{ChannelValues, ExrAttributes, ExrChannel, encode_exr};
#[cfg(feature = "files")]
pub use file::{
    ImageError, check_extension, decoder_limits, encode, encode_shown, encode_transparent, from_decoded,
    open_image, read, read_shown, stream_png, write_png,
};
pub use frame::{FRAME_RATE, Frame, IDLE_MOUSE, SAMPLE_RATE};
pub use frame_inputs::{Channel, FrameInputs, UniformValue};
pub use inputs::{BLOCK_BYTES, Input, InputType};
pub use keys::{KeySet, Keys};
pub use moving::{Moving, MovingTextures};
pub use noise::{Noise, noise};
pub use rgb8::Rgb8Image;
pub use sampling::{Filter, Sampling, Wrap};
pub use script::{InputEvent, Script};
use serde::{Deserialize, Serialize};
pub use texture::{Component, Shape, Texels, Texture};
use thiserror::Error;
use toyproof_diagnostic::grouped;

/// Maximum side of an image, in pixels: the common limit of Vulkan drivers.
pub const MAX_SIDE: u32 = 16_384;

/// Maximum number of pixels of an image: slightly more than one 8K frame (7680×4320).
pub const MAX_PIXELS: u64 = 1 << 25;

/// Maximum side of an image that is rendered in bands and never in memory as a whole, in pixels. Up to 2²³,
/// float32 holds the centers of pixels exactly; the limit is that of the memory of a band.
pub const MAX_BANDED_SIDE: u32 = 1 << 18;

/// An image of linear RGBA floats, bottom row first. Colors are nominally in [0, 1] but are stored unchanged,
/// including NaN and infinities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Image<T = f32> {
    width: u32,
    height: u32,
    pixels: Vec<[T; 4]>,
}

impl<T: Copy> Image<T> {
    /// Makes an image from its pixels, bottom row first.
    ///
    /// # Panics
    /// If the number of pixels is not `width · height`.
    pub fn new(width: u32, height: u32, pixels: Vec<[T; 4]>) -> Self {
        assert_eq!(pixels.len(), width as usize * height as usize);
        Self {
            width,
            height,
            pixels,
        }
    }

    /// Whether the number of pixels agrees with the size, which may be false after reading from a file.
    pub fn is_whole(&self) -> bool {
        self.pixels.len() as u64 == u64::from(self.width) * u64::from(self.height)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// All pixels, bottom row first.
    pub fn pixels(&self) -> &[[T; 4]] {
        &self.pixels
    }

    /// The pixel at (x, y), y upwards from the bottom.
    pub fn get(&self, x: u32, y: u32) -> [T; 4] {
        self.pixels[y as usize * self.width as usize + x as usize]
    }
}

impl Image {
    /// Makes an image from bands of rows of one width, from the bottom up. Each band is freed after it is
    /// copied.
    ///
    /// # Panics
    /// If there is no band, or the widths differ.
    pub fn of_bands(bands: Vec<Self>) -> Self {
        let height: u32 = bands.iter().map(|band| band.height).sum();
        let mut bands = bands.into_iter();
        let mut whole = bands.next().expect("an image has at least one band");
        let more = (height - whole.height) as usize * whole.width as usize;
        whole.pixels.reserve_exact(more);
        for band in bands {
            assert_eq!(band.width, whole.width);
            whole.pixels.extend_from_slice(&band.pixels);
        }
        whole.height = height;
        whole
    }

    /// The part of the image with this lower left corner, in pixels; `None` if it is empty or not within the
    /// image.
    #[must_use]
    pub fn part(&self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> Option<Self> {
        let is_inside = |from: u32, length: u32, whole: u32| {
            length > 0 && from.checked_add(length).is_some_and(|end| end <= whole)
        };
        if !is_inside(x, width, self.width) || !is_inside(y, height, self.height) {
            return None;
        }
        let rows = self.rows().skip(y as usize).take(height as usize);
        let rows = rows.flat_map(|row| &row[x as usize..(x + width) as usize]);
        Some(Self::new(width, height, rows.copied().collect()))
    }

    /// The image flipped vertically.
    #[must_use]
    pub fn upside_down(&self) -> Self {
        let [width, height] = self.size();
        Self::new(width, height, self.rows().rev().flatten().copied().collect())
    }

    /// The rows, from the bottom up.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[[f32; 4]]> + Clone {
        self.pixels.chunks(self.width as usize)
    }
}

/// The 8-bit value of a color component: `round_ties_even(255 · clamp(c, 0, 1))`; NaN becomes 0.
#[inline]
pub fn quantize(component: f32) -> u8 {
    let clamped = if component > 0.0 { component.min(1.0) } else { 0.0 };
    // From 2²³ on, floats are the integers, so that the sum is rounded to an integer, whose low byte is the
    // value. Not all processors have a rounding instruction, and a call takes ten times as long.
    (clamped * 255.0 + 8_388_608.0).to_bits() as u8
}

/// Why an image cannot have a size: a sentence without a full stop, naming the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SizeError {
    /// No pixels.
    #[error("invalid image size {0}×{1}: width and height must be at least 1 pixel")]
    Empty(u64, u64),
    /// More than [`MAX_SIDE`] or [`MAX_PIXELS`].
    #[error(
        "image size {0}×{1} is too large: the limits are {side} pixels per side and {million} million pixels in total",
        side = grouped(MAX_SIDE.into()),
        million = MAX_PIXELS / 1_000_000
    )]
    TooLarge(u64, u64),
    /// More than [`MAX_BANDED_SIDE`].
    #[error("image size {0}×{1} is too large: the limit is {side} pixels per side", side = grouped(MAX_BANDED_SIDE.into()))]
    TooLargeInBands(u64, u64),
}

/// Checks that an image can have this size.
///
/// # Errors
/// If it has no pixels, or too many.
pub fn check_size(width: u64, height: u64) -> Result<[u32; 2], SizeError> {
    let side = u64::from(MAX_SIDE);
    if width == 0 || height == 0 {
        return Err(SizeError::Empty(width, height));
    }
    if width > side || height > side || width * height > MAX_PIXELS {
        return Err(SizeError::TooLarge(width, height));
    }
    Ok([width as u32, height as u32])
}

/// Whether an image of this size is rendered in bands, because it is above the limits of [`check_size`].
pub fn is_banded_size([width, height]: [u32; 2]) -> bool {
    check_size(width.into(), height.into()).is_err()
}

/// Checks that an image can have this size if it is rendered in bands.
///
/// # Errors
/// If it has no pixels, or a side of more than [`MAX_BANDED_SIDE`].
pub fn check_banded_size(width: u64, height: u64) -> Result<[u32; 2], SizeError> {
    let side = u64::from(MAX_BANDED_SIDE);
    if width == 0 || height == 0 {
        return Err(SizeError::Empty(width, height));
    }
    if width > side || height > side {
        return Err(SizeError::TooLargeInBands(width, height));
    }
    Ok([width as u32, height as u32])
}

/// The PCG hash of Jarzynski and Olano, “Hash Functions for GPU Rendering”, JCGT 9(3), 2020.
#[inline]
pub fn pcg(input: u32) -> u32 {
    let state = input.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantizes_like_conversion_of_float_targets_to_eight_bits() {
        assert_eq!(quantize(-1.0), 0);
        assert_eq!(quantize(2.0), 255);
        assert_eq!(quantize(f32::NAN), 0);
        assert_eq!(quantize(0.5), 128, "127.5 rounds to even");
        assert_eq!(quantize(126.5 / 255.0), 126, "126.5 rounds to even");
        for at in 0..=1 << 16 {
            let component = at as f32 / (1 << 16) as f32;
            let rounded = (component * 255.0).round_ties_even();
            assert_eq!(f32::from(quantize(component)), rounded, "{component}");
        }
    }

    #[test]
    fn a_part_begins_at_its_lower_left_corner() {
        let pixels = (0..12).map(|at| [at as f32, 0.0, 0.0, 1.0]).collect();
        let image = Image::new(4, 3, pixels);
        let part = image.part([1, 1], [3, 2]).unwrap();
        let reds: Vec<f32> = part.pixels().iter().map(|pixel| pixel[0]).collect();
        assert_eq!(part.size(), [3, 2]);
        assert_eq!(reds, [5.0, 6.0, 7.0, 9.0, 10.0, 11.0]);
        for (corner, size) in [
            ([2, 0], [3, 1]),
            ([0, 3], [1, 1]),
            ([0, 0], [0, 1]),
            ([u32::MAX, 0], [2, 1]),
        ] {
            assert_eq!(image.part(corner, size), None, "{corner:?} {size:?}");
        }
    }

    #[test]
    fn sizes_are_checked_without_overflow() {
        assert_eq!(check_size(7680, 4320), Ok([7680, 4320]));
        let refusal = |width, height| check_size(width, height).unwrap_err().to_string();
        assert!(refusal(0, 5).contains("at least 1 pixel"));
        assert!(refusal(100_000, 100_000).contains("too large"));
        assert!(refusal(u64::MAX, u64::MAX).contains("too large"));
        assert!(refusal(16_384, 16_384).contains("million"));
        assert_eq!(check_banded_size(100_000, 5), Ok([100_000, 5]));
        assert!(is_banded_size([100_000, 5]) && !is_banded_size([7680, 4320]));
        let error = check_banded_size(u64::MAX, 5).unwrap_err().to_string();
        assert!(error.contains("262,144 pixels per side"), "{error}");
    }
}
