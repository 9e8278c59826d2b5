//! When two colors of images agree: a tolerance, and what rounding to 8 bits adds to it.

use std::ffi::OsStr;
use std::path::Path;

use crate::compare::{Pixel, TOLERANCE};

/// How the colors of an image were rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantization {
    /// To 8 bits, as in a PNG file.
    EightBit,
    /// To floats of 16 or 32 bits, as in an EXR file.
    Float,
}

impl Quantization {
    /// The default tolerance of images of 8 bits: one level, since a color between two levels may be rounded
    /// to either.
    pub const EIGHT_BIT_TOLERANCE: f64 = 1.0 / 255.0;

    /// The quantization of an image file, by its extension; `None` for other files.
    #[must_use]
    pub fn of_file(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        match extension.to_ascii_lowercase().as_str() {
            "png" | "jpg" | "jpeg" | "gif" => Some(Self::EightBit),
            "exr" | "hdr" => Some(Self::Float),
            _ => None,
        }
    }

    /// The largest error of a rounded component, in [0, 1].
    fn error(self) -> f64 {
        match self {
            Self::EightBit => 0.5 / 255.0,
            Self::Float => 0.0,
        }
    }
}

/// When two colors agree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// The largest difference of a component, in [0, 1], besides the rounding of one of the images.
    pub tolerance: f64,
    /// How the two images were rounded.
    pub quantization: [Quantization; 2],
}

impl Agreement {
    /// The default agreement of two images: one 8-bit level if one of them has only these, else
    /// [`TOLERANCE`].
    #[must_use]
    pub fn of_images(quantization: [Quantization; 2]) -> Self {
        let tolerance = if quantization.contains(&Quantization::EightBit) {
            Quantization::EIGHT_BIT_TOLERANCE
        } else {
            TOLERANCE
        };
        Self {
            tolerance,
            quantization,
        }
    }

    /// Whether one of the images has only 8 bits, so that its differences are read in levels.
    #[must_use]
    pub fn is_in_levels(&self) -> bool {
        self.quantization.contains(&Quantization::EightBit)
    }

    /// The largest difference of a component of colors that agree, in [0, 1]. Two images of 8 bits hold exact
    /// levels; if only one does, its rounding adds half a level.
    #[must_use]
    pub fn limit(&self) -> f64 {
        match self.quantization {
            [Quantization::EightBit, Quantization::EightBit] => self.tolerance,
            [a, b] => self.tolerance + a.error() + b.error(),
        }
    }

    /// Whether the colors of a pixel agree.
    #[must_use]
    pub fn holds(&self, pixel: &Pixel) -> bool {
        /// Far below a level, and far above the rounding of a level to f32.
        const ROUNDING: f64 = 1e-6;
        let rounding = match self.quantization {
            [Quantization::EightBit, Quantization::EightBit] => ROUNDING,
            _ => 0.0,
        };
        pixel.difference() <= self.limit() + rounding
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixel(expected: f32, actual: f32) -> Pixel {
        Pixel {
            x: 0,
            y: 0,
            expected: [0.0, expected, 1.0],
            actual: [0.0, actual, 1.0],
        }
    }

    #[test]
    fn neighboring_levels_agree_wherever_they_are() {
        let agreement = Agreement::of_images([Quantization::EightBit; 2]);
        let level = |level: u16| f32::from(level) / 255.0;
        for at in 0..=253 {
            assert!(agreement.holds(&pixel(level(at), level(at + 1))), "{at}");
            assert!(!agreement.holds(&pixel(level(at), level(at + 2))), "{at}");
        }
        let exact = Agreement {
            tolerance: 0.0,
            ..agreement
        };
        assert!(exact.holds(&pixel(level(7), level(7))) && !exact.holds(&pixel(level(7), level(8))));
    }

    /// A float agrees with a level if it would be rounded to one that is at most one level away.
    #[test]
    fn rounding_to_levels_adds_half_a_level() {
        let agreement = Agreement::of_images([Quantization::EightBit, Quantization::Float]);
        assert!(agreement.holds(&pixel(10.0 / 255.0, 11.49 / 255.0)));
        assert!(!agreement.holds(&pixel(10.0 / 255.0, 11.51 / 255.0)));
        let floats = Agreement::of_images([Quantization::Float; 2]);
        assert!(floats.holds(&pixel(0.5, 0.5009)) && !floats.holds(&pixel(0.5, 0.5011)));
        assert!(!floats.holds(&pixel(0.0, f32::NAN)) && floats.holds(&pixel(f32::NAN, f32::NAN)));
    }

    #[test]
    fn the_extension_tells_the_quantization() {
        let of = |path: &str| Quantization::of_file(Path::new(path));
        assert_eq!(of("a/b.PNG"), Some(Quantization::EightBit));
        assert_eq!(of("b.exr"), Some(Quantization::Float));
        assert_eq!(of("png"), None);
    }
}
