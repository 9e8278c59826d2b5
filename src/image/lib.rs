//! Images of linear floats and of the 8 bits that a display shows, the inputs of one ShaderToy frame, and files that
//! appear whole or not at all. PNG holds what a display shows; EXR holds the floats.
//!
//! Rows run upwards, as fragment coordinates do: row 0 is the bottom. `file` is the one place that flips rows and
//! quantizes.
//!
//! ```
//! use toyproof_image::{Image, encode};
//!
//! let ramp = Image::new(2, 1, vec![[0.0, 0.0, 0.0, 1.0], [1.0, 0.5, 0.0, 1.0]]);
//! let png = encode(&ramp, "ramp.png".as_ref()).unwrap();
//! assert!(png.starts_with(b"\x89PNG"));
//! ```

mod file;
mod frame;
mod noise;
pub mod output;
mod shown;

pub use file::{ImageError, encode, encode_shown, read, read_shown};
pub use frame::{BLOCK_BYTES, FRAME_RATE, Frame, SAMPLE_RATE};
pub use noise::{noise, pcg};
use serde::{Deserialize, Serialize};
pub use shown::Shown;

/// The longest side of a picture, in pixels: what Vulkan drivers commonly take.
pub const MAX_SIDE: u32 = 16_384;

/// The most pixels of a picture: one 8K frame (7680×4320) and a little.
pub const MAX_PIXELS: u64 = 1 << 25;

/// A picture of linear RGBA floats, bottom row first. Colours are nominally in [0, 1] but are kept as they
/// are, NaN and infinities included.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 4]>,
}

impl Image {
    /// A picture from its pixels, bottom row first.
    ///
    /// # Panics
    /// If the count of pixels is not `width · height`.
    #[must_use]
    pub fn new(width: u32, height: u32, pixels: Vec<[f32; 4]>) -> Self {
        assert_eq!(pixels.len(), width as usize * height as usize);
        Self {
            width,
            height,
            pixels,
        }
    }

    /// A picture of bands of rows of one width, from the bottom up. Each is given up once it is taken over.
    ///
    /// # Panics
    /// If there is none, or the widths differ.
    #[must_use]
    pub fn of_bands(bands: Vec<Self>) -> Self {
        let height: u32 = bands.iter().map(|band| band.height).sum();
        let mut bands = bands.into_iter();
        let mut whole = bands.next().expect("a picture has a band");
        let more = (height - whole.height) as usize * whole.width as usize;
        whole.pixels.reserve_exact(more);
        for band in bands {
            assert_eq!(band.width, whole.width);
            whole.pixels.extend_from_slice(&band.pixels);
        }
        whole.height = height;
        whole
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// All pixels, bottom row first.
    #[must_use]
    pub fn pixels(&self) -> &[[f32; 4]] {
        &self.pixels
    }

    /// The pixel at (x, y), y upwards from the bottom.
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> [f32; 4] {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The same with its first row last.
    #[must_use]
    pub fn upside_down(&self) -> Self {
        let [width, height] = self.size();
        Self::new(width, height, self.rows().rev().flatten().copied().collect())
    }

    /// The rows, from the bottom up.
    #[must_use]
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[[f32; 4]]> {
        self.pixels.chunks(self.width as usize)
    }
}

/// The 8-bit value of a colour component: `round_ties_even(255 · clamp(c, 0, 1))`; NaN becomes 0.
#[must_use]
#[inline]
pub fn quantise(component: f32) -> u8 {
    let clamped = if component > 0.0 { component.min(1.0) } else { 0.0 };
    // From 2²³ on floats are the whole numbers, so that the sum is rounded to one, whose last bits are the value. Not all processors
    // have an instruction that rounds, and a call takes ten times as long.
    (clamped * 255.0 + 8_388_608.0).to_bits() as u8
}

/// Whether a picture of that size can be made; says what is wrong otherwise.
///
/// # Errors
/// A sentence without a full stop, naming the limit.
pub fn check_size(width: u64, height: u64) -> Result<[u32; 2], String> {
    let side = u64::from(MAX_SIDE);
    if width == 0 || height == 0 {
        return Err(format!(
            "a picture of {width}×{height} pixels has nothing to show; both sides must be at least 1"
        ));
    }
    if width > side || height > side || width * height > MAX_PIXELS {
        return Err(format!(
            "a picture of {width}×{height} pixels is too large; each side may be at most {MAX_SIDE}, \
             and the picture at most {} million pixels",
            MAX_PIXELS / 1_000_000
        ));
    }
    Ok([width as u32, height as u32])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantises_as_float_targets_are_stored_in_eight_bits() {
        assert_eq!(quantise(-1.0), 0);
        assert_eq!(quantise(2.0), 255);
        assert_eq!(quantise(f32::NAN), 0);
        assert_eq!(quantise(0.5), 128, "127.5 rounds to even");
        assert_eq!(quantise(126.5 / 255.0), 126, "126.5 rounds to even");
        for at in 0..=1 << 16 {
            let component = at as f32 / (1 << 16) as f32;
            let rounded = (component * 255.0).round_ties_even();
            assert_eq!(f32::from(quantise(component)), rounded, "{component}");
        }
    }

    #[test]
    fn sizes_are_checked_without_overflow() {
        assert_eq!(check_size(7680, 4320), Ok([7680, 4320]));
        assert!(check_size(0, 5).unwrap_err().contains("nothing to show"));
        assert!(check_size(100_000, 100_000).unwrap_err().contains("too large"));
        assert!(check_size(u64::MAX, u64::MAX).unwrap_err().contains("too large"));
        assert!(check_size(16_384, 16_384).unwrap_err().contains("million"));
    }
}
