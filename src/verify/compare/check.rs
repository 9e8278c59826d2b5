//! The precision and toolchain checks, the results of a check for each pixel and for the image, and the
//! tolerances.

use serde::{Deserialize, Serialize};
use toyproof_image::Image;

use crate::compare::{DiffLevel, Pixel, Region, Regions};

/// The largest difference of a component of two images that agree.
///
/// A quarter of an 8-bit level: it changes a rounded value by at most one level.
pub const TOLERANCE: f64 = 1e-3;

/// The largest difference of a component between a shader in f64 and the tracer in f64 that agree.
///
/// Equivalent formulas in f64 differ by 3e−7, which is the cost of storing the images in f32; constants
/// written with four digits, such as π = 3.1416 or a gamma of 0.4545, by up to 4e−5. The test
/// `the_tolerance_is_no_larger_than_needed` measures the difference again, and fails if the tolerance is ten
/// times as large.
pub const EXACT_TOLERANCE: f64 = 1e-4;

/// The status of a pixel in a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelStatus {
    /// The pixel agrees with the reference.
    Agrees,
    /// The pixel differs, but might not with another rounding of the same operations: it is ill-conditioned.
    IllConditioned,
    /// The pixel differs, and so does the scene itself when its numbers are perturbed by less than a shader's
    /// precision: an edge passes through the pixel's sample.
    Tied,
    /// The color depends on undefined behavior.
    Undefined,
    /// The pixel differs.
    Differs,
}

/// The result of a check over the whole image.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CheckSummary {
    /// Pixels in the image.
    pub pixels: u64,
    /// Pixels that differ.
    pub differing: u64,
    /// Pixels that differ, but are ill-conditioned in f64.
    pub ill_conditioned: u64,
    /// The ones that are ill-conditioned in the scene itself, whatever the shader.
    #[serde(skip)]
    pub tied: u64,
    /// Pixels that are excluded because their color depends on undefined behavior.
    pub undefined: u64,
    /// The largest absolute difference of a component of colors clamped to [0, 1], over all pixels that are
    /// not undefined.
    pub max_abs: f64,
    /// The first differing pixel: lowest y, then lowest x; if no pixel differs, the first ill-conditioned
    /// one.
    pub first: Option<Pixel>,
    /// The one with the largest difference among those.
    pub worst: Option<Pixel>,
    /// The regions of the differing pixels; empty before they were found.
    #[serde(default)]
    pub regions: Regions,
    /// The largest compact region of the pixels that depend on undefined behavior.
    #[serde(default)]
    pub undefined_region: Option<Region>,
}

impl CheckSummary {
    /// Counts the statuses of all pixels, bottom row first, of two images of one size.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn new(expected: &Image, actual: &Image, statuses: &[PixelStatus]) -> Self {
        assert_eq!(expected.size(), actual.size());
        assert_eq!(statuses.len(), actual.pixels().len());
        let count = |status| statuses.iter().filter(|&&s| s == status).count() as u64;
        let differing = count(PixelStatus::Differs);
        let reported = if differing > 0 {
            PixelStatus::Differs
        } else {
            PixelStatus::IllConditioned
        };
        let mut first = None;
        let mut worst: Option<(f64, Pixel)> = None;
        let mut max_abs = 0.0f64;
        for (index, &status) in statuses.iter().enumerate() {
            if status == PixelStatus::Undefined {
                continue;
            }
            let pixel = Pixel::at(index, expected, actual);
            let difference = pixel.difference();
            max_abs = max_abs.max(difference);
            if status == reported {
                first.get_or_insert(pixel);
                if worst.is_none_or(|(largest, _)| difference > largest) {
                    worst = Some((difference, pixel));
                }
            }
        }
        Self {
            pixels: statuses.len() as u64,
            differing,
            ill_conditioned: count(PixelStatus::IllConditioned) + count(PixelStatus::Tied),
            tied: count(PixelStatus::Tied),
            undefined: count(PixelStatus::Undefined),
            max_abs,
            first,
            worst: worst.map(|(_, pixel)| pixel),
            regions: Regions::default(),
            undefined_region: None,
        }
    }

    /// Adds the result for the rows above the first `height`, which this one covers.
    pub fn extend(&mut self, above: &Self, height: u32) {
        let raised = |pixel: Option<Pixel>| pixel.map(|pixel| pixel.raised(height));
        let (first, worst) = (raised(above.first), raised(above.worst));
        match (self.differing > 0, above.differing > 0) {
            (true, false) => {}
            (false, true) => (self.first, self.worst) = (first, worst),
            _ => {
                self.first = self.first.or(first);
                self.worst = Pixel::worse(self.worst, worst);
            }
        }
        self.pixels += above.pixels;
        self.differing += above.differing;
        self.ill_conditioned += above.ill_conditioned;
        self.tied += above.tied;
        self.undefined += above.undefined;
        self.max_abs = self.max_abs.max(above.max_abs);
    }

    /// The share of the pixels that `count` is, in [0, 1].
    #[must_use]
    pub fn share(&self, count: u64) -> f64 {
        count as f64 / self.pixels.max(1) as f64
    }

    /// Whether no pixel differs or is ill-conditioned.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.differing + self.ill_conditioned == 0
    }
}

/// Returns the difference level of each pixel for the image of a check.
#[must_use]
pub fn diff_levels(expected: &Image, actual: &Image, statuses: &[PixelStatus]) -> Vec<DiffLevel> {
    let mark = |(index, status): (usize, &PixelStatus)| match status {
        PixelStatus::IllConditioned | PixelStatus::Tied => DiffLevel::ILL_CONDITIONED,
        PixelStatus::Undefined => DiffLevel::UNDEFINED,
        PixelStatus::Agrees | PixelStatus::Differs => {
            DiffLevel::by(Pixel::at(index, expected, actual).difference() as f32)
        }
    };
    statuses.iter().enumerate().map(mark).collect()
}

/// The largest invisible difference of a component: two 8-bit levels, since rounding a color to 8 bits may
/// change it by one level itself.
pub const SEEN: f64 = 2.0 / 255.0;

/// The precision check: compares the shader's image in f32, `actual`, with that of the same shader in f64,
/// `expected`.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn precision(expected: &Image, actual: &Image, undefined: &[bool]) -> Vec<PixelStatus> {
    assert_eq!(expected.size(), actual.size());
    let status = |(index, &undefined): (usize, &bool)| {
        if undefined {
            PixelStatus::Undefined
        } else if Pixel::at(index, expected, actual).difference() > SEEN {
            PixelStatus::Differs
        } else {
            PixelStatus::Agrees
        }
    };
    undefined.iter().enumerate().map(status).collect()
}

/// The number of pixels of two images whose difference is visible: more than [`SEEN`].
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn visible_pixels(one: &Image, other: &Image) -> u64 {
    let statuses = precision(one, other, &vec![false; one.pixels().len()]);
    let visible = statuses.iter().filter(|status| **status == PixelStatus::Differs);
    visible.count() as u64
}

/// The toolchain check: compares the bits of red, green and blue of the GPU's image in f32, `actual`, with
/// the CPU's in f32, `expected`. All NaN are equal: GLSL gives their bits no meaning. So are the two zeros:
/// Vulkan leaves the sign of zero to the driver unless `SignedZeroInfNanPreserve` requires it; llvmpipe 22.3
/// then keeps that of `0.0 * x`, but not of `0.0 - x`, and loses others. Results that depend on the sign,
/// such as `1.0 / x`, differ by more.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn toolchain(expected: &Image, actual: &Image, undefined: &[bool]) -> Vec<PixelStatus> {
    assert_eq!(expected.size(), actual.size());
    let same = |a: f32, b: f32| a == b || (a.is_nan() && b.is_nan());
    let pixels = expected.pixels().iter().zip(actual.pixels()).zip(undefined);
    let status = |((a, b), &undefined): ((&[f32; 4], &[f32; 4]), &bool)| {
        if undefined {
            PixelStatus::Undefined
        } else if (0..3).all(|i| same(a[i], b[i])) {
            PixelStatus::Agrees
        } else {
            PixelStatus::Differs
        }
    };
    pixels.map(status).collect()
}

/// A number of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    /// These pixels.
    pub count: u64,
    /// All pixels of the image.
    pub of: u64,
}

impl Share {
    /// Returns `count` pixels of those of a check.
    #[must_use]
    pub fn new(check: &CheckSummary, count: u64) -> Self {
        Self {
            count,
            of: check.pixels,
        }
    }

    /// Returns the pixels that differ in a check.
    #[must_use]
    pub fn differing(check: &CheckSummary) -> Self {
        Self::new(check, check.differing)
    }

    /// The share, from 0 to 1.
    #[must_use]
    pub fn ratio(self) -> f64 {
        self.count as f64 / self.of.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(reds: &[f32]) -> Image {
        Image::new(
            reds.len() as u32,
            1,
            reds.iter().map(|&red| [red, 0.0, 0.0, 1.0]).collect(),
        )
    }

    #[test]
    fn undefined_pixels_are_not_counted_otherwise() {
        use PixelStatus::{Agrees, Differs, IllConditioned, Undefined};
        let (a, b) = (row(&[0.0; 5]), row(&[1.0, 0.0, 0.25, 0.5, 0.375]));
        let summary = CheckSummary::new(&a, &b, &[Undefined, Agrees, Differs, Differs, IllConditioned]);
        assert_eq!(
            (
                summary.pixels,
                summary.differing,
                summary.ill_conditioned,
                summary.undefined
            ),
            (5, 2, 1, 1)
        );
        assert_eq!(summary.max_abs, 0.5);
        assert_eq!(summary.first.map(|pixel| pixel.x), Some(2));
        assert_eq!(summary.worst.map(|pixel| pixel.x), Some(3));
        assert!(!summary.is_same());
    }

    #[test]
    fn the_result_of_bands_is_that_of_the_whole_image() {
        use PixelStatus::{Agrees, Differs, IllConditioned, Undefined};
        let column = |reds: &[f32]| Image::new(1, reds.len() as u32, row(reds).pixels().to_vec());
        let reds = [0.9, 0.5, 0.2, 0.7, 0.7, 0.0];
        let all = [
            IllConditioned,
            Undefined,
            Differs,
            IllConditioned,
            Differs,
            Agrees,
        ];
        // Differing pixels are reported even if ill-conditioned ones are below them; without any, the
        // ill-conditioned ones are.
        for statuses in [
            all,
            all.map(|own| if own == Differs { IllConditioned } else { own }),
        ] {
            let whole = CheckSummary::new(&column(&[0.0; 6]), &column(&reds), &statuses);
            for height in 0..=reds.len() {
                let part = |rows: std::ops::Range<usize>| {
                    let black = column(&[0.0; 6][rows.clone()]);
                    CheckSummary::new(&black, &column(&reds[rows.clone()]), &statuses[rows])
                };
                let mut summary = part(0..height);
                summary.extend(&part(height..reds.len()), height as u32);
                assert_eq!(summary, whole, "{height}");
            }
        }
    }

    #[test]
    fn the_first_ill_conditioned_pixel_is_reported_where_none_differs() {
        use PixelStatus::{Agrees, IllConditioned};
        let summary = CheckSummary::new(&row(&[0.0; 2]), &row(&[0.0, 0.1]), &[Agrees, IllConditioned]);
        assert_eq!(summary.first.map(|pixel| pixel.x), Some(1));
        assert!(!summary.is_same() && summary.differing == 0);
    }

    #[test]
    fn two_levels_are_invisible_and_three_are_visible() {
        let level = |n: f32| [n / 255.0, 0.0, 0.0, 1.0];
        let exact = Image::new(3, 1, vec![level(100.0); 3]);
        let single = Image::new(3, 1, vec![level(101.9), level(103.0), level(0.0)]);
        let statuses = precision(&exact, &single, &[false, false, true]);
        assert_eq!(
            statuses,
            [PixelStatus::Agrees, PixelStatus::Differs, PixelStatus::Undefined]
        );
    }

    #[test]
    fn one_bit_is_a_difference_but_nans_and_zeros_are_equal() {
        let one = |red: f32| Image::new(1, 1, vec![[red, 0.0, 0.0, 1.0]]);
        let check = |a, b| toolchain(&one(a), &one(b), &[false])[0];
        assert_eq!(check(1.0, 1.0), PixelStatus::Agrees);
        assert_eq!(check(1.0, 1.0f32.next_up()), PixelStatus::Differs);
        assert_eq!(check(0.0, -0.0), PixelStatus::Agrees);
        assert_eq!(check(0.0, f32::from_bits(1)), PixelStatus::Differs);
        assert_eq!(check(f32::NAN, -f32::NAN), PixelStatus::Agrees);
        assert_eq!(check(f32::NAN, 0.0), PixelStatus::Differs);
        assert_eq!(toolchain(&one(0.0), &one(1.0), &[true]), [PixelStatus::Undefined]);
    }
}
