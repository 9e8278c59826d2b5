//! How far float32 is from double precision in each pixel: bands of errors as a map, and as a histogram.

use toyproof_image::{Image, Rgb8Image, quantize};

use super::legend::map_above;

/// The unit of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorUnit {
    /// Levels of 8 bits, of colors clamped to [0, 1]: what is seen.
    Levels,
    /// Units in the last place: the number of floats between both, of colors as they are.
    Ulps,
}

/// A band of errors.
#[derive(Debug, Clone, Copy)]
struct Band {
    /// The largest error in it.
    most: f64,
    name: &'static str,
    color: [f32; 3],
}

const fn band(most: f64, name: &'static str, color: [f32; 3]) -> Band {
    Band { most, name, color }
}

/// Errors that are not seen, up to half a level, have cool colors.
const LEVELS: [Band; 9] = [
    band(0.0, "0", [0.0, 0.0, 0.0]),
    band(0.001, "<= 0.001", [0.05, 0.05, 0.2]),
    band(0.01, "<= 0.01", [0.08, 0.12, 0.4]),
    band(0.1, "<= 0.1", [0.1, 0.25, 0.6]),
    band(0.5, "<= 0.5", [0.15, 0.45, 0.75]),
    band(1.0, "<= 1", [0.55, 0.5, 0.2]),
    band(2.0, "<= 2", [0.75, 0.55, 0.1]),
    band(16.0, "<= 16", [0.95, 0.35, 0.1]),
    band(f64::INFINITY, "> 16 levels", [1.0, 0.1, 0.1]),
];

/// A float has 24 bits: an error of 2^16 ULPs leaves 8 of them.
const ULPS: [Band; 9] = [
    band(0.0, "0", [0.0, 0.0, 0.0]),
    band(1.0, "1", [0.05, 0.05, 0.2]),
    band(4.0, "<= 4", [0.08, 0.12, 0.4]),
    band(16.0, "<= 16", [0.1, 0.25, 0.6]),
    band(256.0, "<= 2^8", [0.15, 0.45, 0.75]),
    band(4096.0, "<= 2^12", [0.55, 0.5, 0.2]),
    band(65536.0, "<= 2^16", [0.75, 0.55, 0.1]),
    band(1_048_576.0, "<= 2^20", [0.95, 0.35, 0.1]),
    band(f64::INFINITY, "> 2^20 ULPs", [1.0, 0.1, 0.1]),
];

/// What a pixel is apart from its error.
const UNDEFINED: (&str, [f32; 3]) = ("undefined", [0.3, 0.3, 0.3]);
const NOT_FINITE: (&str, [f32; 3]) = ("NaN or infinite", [1.0, 1.0, 1.0]);

/// The errors of an image.
#[derive(Debug)]
pub struct PrecisionMap {
    size: [u32; 2],
    unit: ErrorUnit,
    /// The band of each pixel, bottom row first; past the bands, undefined and not finite.
    classes: Vec<u8>,
    /// The largest error, and its pixel.
    worst: Option<(f64, [u32; 2])>,
}

impl PrecisionMap {
    /// Compares an image in float32 with that in double precision, rounded to floats. The error of a pixel is
    /// that of its worst component of red, green and blue. Pixels that depend on undefined behavior are left
    /// out; a pixel that is NaN or infinite in one image only has no error, but a class of its own.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn new(single: &Image, double: &Image, undefined: &[bool], unit: ErrorUnit) -> Self {
        let size = single.size();
        assert_eq!(size, double.size(), "both are images of one frame");
        let mut worst: Option<(f64, [u32; 2])> = None;
        let bands = unit.bands();
        let pixels = single.pixels().iter().zip(double.pixels()).zip(undefined);
        let classes = pixels.enumerate().map(|(at, ((single, double), &undefined))| {
            if undefined {
                return bands.len() as u8;
            }
            let components = single[..3].iter().zip(&double[..3]);
            let errors = components.map(|(&single, &double)| unit.error(single, double));
            let Some(error) = errors.reduce(|a, b| Some(a?.max(b?))).flatten() else {
                return bands.len() as u8 + 1;
            };
            if worst.is_none_or(|(most, _)| error > most) {
                let at = at as u32;
                worst = Some((error, [at % size[0], at / size[0]]));
            }
            bands.partition_point(|band| band.most < error) as u8
        });
        Self {
            size,
            unit,
            classes: classes.collect(),
            worst,
        }
    }

    /// The largest error in the unit, and the first pixel that has it; `None` if no pixel has an error.
    #[must_use]
    pub fn worst(&self) -> Option<(f64, [u32; 2])> {
        self.worst
    }

    /// The classes of pixels with the number of pixels in each, in ascending order of errors.
    #[must_use]
    pub fn histogram(&self) -> Vec<(&'static str, u64)> {
        let mut counts = vec![0; self.unit.bands().len() + 2];
        for &class in &self.classes {
            counts[usize::from(class)] += 1;
        }
        self.entries().map(|(name, _)| name).zip(counts).collect()
    }

    /// The map, with the legend in a strip below it.
    #[must_use]
    pub fn image(&self) -> Rgb8Image {
        let entries: Vec<_> = self
            .entries()
            .map(|(name, color)| (name.to_owned(), color))
            .collect();
        let colors: Vec<_> = self.entries().map(|(_, color)| color.map(quantize)).collect();
        let pixels = self.classes.iter().map(|&class| colors[usize::from(class)]);
        map_above(self.size, pixels, &entries)
    }

    fn entries(&self) -> impl Iterator<Item = (&'static str, [f32; 3])> {
        let bands = self.unit.bands().iter().map(|band| (band.name, band.color));
        bands.chain([UNDEFINED, NOT_FINITE])
    }
}

impl ErrorUnit {
    fn bands(self) -> &'static [Band] {
        match self {
            Self::Levels => &LEVELS,
            Self::Ulps => &ULPS,
        }
    }

    /// The error of a component; `None` if only one of both is finite, or if they are different infinities.
    fn error(self, single: f32, double: f32) -> Option<f64> {
        if single.is_nan() && double.is_nan() || single == double {
            return Some(0.0);
        }
        if !single.is_finite() || !double.is_finite() {
            return None;
        }
        Some(match self {
            Self::Levels => {
                let [single, double] = [single, double].map(|color| f64::from(color.clamp(0.0, 1.0)));
                255.0 * (single - double).abs()
            }
            Self::Ulps => (place(single) - place(double)).abs() as f64,
        })
    }
}

/// The number of a float in the order of all floats; both zeros have number 0.
fn place(float: f32) -> i64 {
    let magnitude = i64::from(float.abs().to_bits());
    if float < 0.0 { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(single: [f32; 4], double: [f32; 4], unit: ErrorUnit) -> PrecisionMap {
        let image = |values: [f32; 4]| Image::new(4, 1, values.map(|value| [value, 0.0, 0.0, 1.0]).to_vec());
        PrecisionMap::new(&image(single), &image(double), &[false, false, false, true], unit)
    }

    fn counts(map: &PrecisionMap) -> Vec<(&'static str, u64)> {
        let all = map.histogram().into_iter();
        all.filter(|&(_, count)| count > 0).collect()
    }

    #[test]
    fn errors_are_counted_in_floats() {
        let one = 1.0_f32;
        let single = [one.next_up(), f32::MIN_POSITIVE, f32::NAN, 9.0];
        let found = map(single, [one, -f32::MIN_POSITIVE, 1.0, 0.0], ErrorUnit::Ulps);
        assert_eq!(
            counts(&found),
            [
                ("1", 1),
                ("> 2^20 ULPs", 1),
                ("undefined", 1),
                ("NaN or infinite", 1)
            ]
        );
        let (worst, at) = found.worst().unwrap();
        assert_eq!((worst, at), (f64::from(2 * f32::MIN_POSITIVE.to_bits()), [1, 0]));
    }

    #[test]
    fn levels_are_those_of_displayed_colors() {
        let found = map(
            [7.0, 0.5, 0.25, 0.0],
            [2.0, 0.5 + 3.0 / 255.0, 0.25, 1.0],
            ErrorUnit::Levels,
        );
        assert_eq!(counts(&found), [("0", 2), ("<= 16", 1), ("undefined", 1)]);
        let (worst, at) = found.worst().unwrap();
        assert!((worst - 3.0).abs() < 1e-4 && at == [1, 0], "{worst}");
    }

    #[test]
    fn nan_in_both_images_is_no_error() {
        let single = [f32::NAN, f32::INFINITY, 0.0, 0.0];
        let found = map(single, [f32::NAN, f32::INFINITY, -0.0, 0.0], ErrorUnit::Ulps);
        assert_eq!(counts(&found), [("0", 3), ("undefined", 1)]);
        let image = found.image();
        assert!(image.size()[1] > 1, "the legend is below the map");
    }
}
