//! The visible difference of two images, and one pixel in both.

use serde::{Deserialize, Deserializer, Serialize};
use toyproof_image::{Image, quantize};

use crate::compare::{Agreement, DiffLevel, Quantization};

/// The difference of two images. Colors are compared clamped to [0, 1]; NaN equals NaN, and differs from
/// everything else by 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Pixels in the image.
    pub pixels: u64,
    /// Pixels whose colors do not agree.
    pub differing: u64,
    /// Pixels that differ when both are rounded to 8 bits.
    pub differing_8bit: u64,
    /// The largest difference in 8-bit levels.
    pub max_8bit: u8,
    /// The largest absolute difference of a component, in [0, 1].
    pub max_abs: f64,
    /// The mean absolute difference over all components.
    pub mean_abs: f64,
    /// The first differing pixel: lowest y, then lowest x.
    pub first: Option<Pixel>,
    /// The pixel with the largest difference among those.
    pub worst: Option<Pixel>,
}

/// One pixel in both images, RGB as stored.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pixel {
    /// From the left, from 0.
    pub x: u32,
    /// From the bottom, from 0.
    pub y: u32,
    /// In the reference.
    #[serde(deserialize_with = "color")]
    pub expected: [f32; 3],
    /// In the image that is compared.
    #[serde(deserialize_with = "color")]
    pub actual: [f32; 3],
}

/// Reads a color from JSON, where values that are not finite are null.
fn color<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f32; 3], D::Error> {
    let parts = <[Option<f32>; 3]>::deserialize(deserializer)?;
    Ok(parts.map(|part| part.unwrap_or(f32::NAN)))
}

impl Pixel {
    /// The pixel at `index`, bottom row first, in two images of one size.
    #[must_use]
    pub fn at(index: usize, expected: &Image, actual: &Image) -> Self {
        let width = expected.size()[0] as usize;
        let rgb = |image: &Image| {
            let [r, g, b, _] = image.pixels()[index];
            [r, g, b]
        };
        Self {
            x: (index % width) as u32,
            y: (index / width) as u32,
            expected: rgb(expected),
            actual: rgb(actual),
        }
    }

    /// The same pixel in an image with `rows` more rows below it.
    pub(super) fn raised(mut self, rows: u32) -> Self {
        self.y += rows;
        self
    }

    /// The one with the larger difference; of equals, the first.
    pub(super) fn worse(first: Option<Self>, second: Option<Self>) -> Option<Self> {
        match (first, second) {
            (Some(first), Some(second)) if second.difference() > first.difference() => Some(second),
            (first, second) => first.or(second),
        }
    }

    /// The largest difference of a component, clamped to [0, 1]; 1 if exactly one of the two is NaN.
    #[must_use]
    pub fn difference(&self) -> f64 {
        self.components().fold(0.0, f64::max)
    }

    fn components(&self) -> impl Iterator<Item = f64> {
        let component = |i: usize| match (self.expected[i], self.actual[i]) {
            (a, b) if a.is_nan() && b.is_nan() => 0.0,
            (a, b) if a.is_nan() || b.is_nan() => 1.0,
            (a, b) => (f64::from(a).clamp(0.0, 1.0) - f64::from(b).clamp(0.0, 1.0)).abs(),
        };
        (0..3).map(component)
    }

    fn levels(&self) -> u8 {
        let level = |i: usize| quantize(self.expected[i]).abs_diff(quantize(self.actual[i]));
        (0..3).map(level).fold(0, u8::max)
    }
}

impl Comparison {
    /// Adds the comparison of the rows above the first `height`, which this one covers.
    pub fn extend(&mut self, above: &Self, height: u32) {
        let raised = |pixel: Option<Pixel>| pixel.map(|pixel| pixel.raised(height));
        let sums = [&*self, above].map(|part| part.mean_abs * part.pixels as f64);
        self.pixels += above.pixels;
        self.mean_abs = (sums[0] + sums[1]) / self.pixels.max(1) as f64;
        self.differing += above.differing;
        self.differing_8bit += above.differing_8bit;
        self.max_8bit = self.max_8bit.max(above.max_8bit);
        self.max_abs = self.max_abs.max(above.max_abs);
        self.first = self.first.or(raised(above.first));
        self.worst = Pixel::worse(self.worst, raised(above.worst));
    }
}

/// Compares `actual` with `reference`, both of floats; also returns the difference level of each pixel.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn compare(reference: &Image, actual: &Image) -> (Comparison, Vec<DiffLevel>) {
    compare_within(reference, actual, &Agreement::of_images([Quantization::Float; 2]))
}

/// Like [`compare`], where `agreement` decides which pixels differ.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn compare_within(
    reference: &Image,
    actual: &Image,
    agreement: &Agreement,
) -> (Comparison, Vec<DiffLevel>) {
    assert_eq!(reference.size(), actual.size());
    let pixels = reference.pixels().len();
    let mut comparison = Comparison {
        pixels: pixels as u64,
        differing: 0,
        differing_8bit: 0,
        max_8bit: 0,
        max_abs: 0.0,
        mean_abs: 0.0,
        first: None,
        worst: None,
    };
    let mut sum = 0.0;
    let mut diff_levels = Vec::with_capacity(pixels);
    for index in 0..pixels {
        let pixel = Pixel::at(index, reference, actual);
        let (difference, levels) = (pixel.difference(), pixel.levels());
        sum += pixel.components().sum::<f64>();
        comparison.differing_8bit += u64::from(levels > 0);
        comparison.max_8bit = comparison.max_8bit.max(levels);
        if !agreement.holds(&pixel) {
            comparison.differing += 1;
            comparison.first.get_or_insert(pixel);
            if difference > comparison.max_abs {
                comparison.worst = Some(pixel);
            }
        }
        comparison.max_abs = comparison.max_abs.max(difference);
        diff_levels.push(DiffLevel::by(difference as f32));
    }
    comparison.mean_abs = sum / (3 * pixels.max(1)) as f64;
    (comparison, diff_levels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(pixels: &[[f32; 3]]) -> Image {
        let pixels: Vec<_> = pixels.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
        Image::new(pixels.len() as u32 / 2, 2, pixels)
    }

    #[test]
    fn equal_images_have_no_difference() {
        let a = image(&[[0.1, 0.2, 0.3], [f32::NAN, 2.0, -1.0], [0.0; 3], [1.0; 3]]);
        let b = image(&[[0.1, 0.2, 0.3], [f32::NAN, 7.0, -0.0], [0.0; 3], [1.0; 3]]);
        let (comparison, _) = compare(&a, &b);
        assert_eq!(
            (
                comparison.differing,
                comparison.max_abs,
                comparison.differing_8bit
            ),
            (0, 0.0, 0)
        );
        assert_eq!((comparison.first, comparison.worst), (None, None));
    }

    #[test]
    fn first_and_worst_are_found_from_the_bottom_left() {
        let a = image(&[[0.0; 3]; 4]);
        let b = image(&[[0.0; 3], [0.0, 0.1, 0.0], [0.9, 0.0, 0.0], [0.9, 0.0, 0.0]]);
        let (comparison, diff_levels) = compare(&a, &b);
        let at = |pixel: Option<Pixel>| pixel.map(|pixel| (pixel.x, pixel.y));
        assert_eq!(comparison.differing, 3);
        assert_eq!(at(comparison.first), Some((1, 0)));
        assert_eq!(at(comparison.worst), Some((0, 1)), "the first of equals");
        assert_eq!(comparison.max_8bit, 230);
        assert!((comparison.mean_abs - 1.9 / 12.0).abs() < 1e-7);
        assert_eq!(diff_levels[0], DiffLevel::by(0.0));
    }

    #[test]
    fn the_comparison_of_bands_is_that_of_the_whole_image() {
        let row = |greens: [f32; 2]| Image::new(2, 1, greens.map(|green| [0.0, green, 0.0, 1.0]).to_vec());
        let whole = Image::new(
            2,
            2,
            [0.0, 0.25, 0.0, 0.75]
                .map(|green| [0.0, green, 0.0, 1.0])
                .to_vec(),
        );
        let black = row([0.0; 2]);
        let (mut bands, _) = compare(&black, &row([0.0, 0.25]));
        bands.extend(&compare(&black, &row([0.0, 0.75])).0, 1);
        assert_eq!(bands, compare(&image(&[[0.0; 3]; 4]), &whole).0);
    }

    #[test]
    fn nan_differs_from_every_number() {
        let (comparison, _) = compare(&image(&[[0.0; 3]; 2]), &image(&[[f32::NAN; 3], [0.0; 3]]));
        assert_eq!((comparison.differing, comparison.max_abs), (1, 1.0));
    }
}
