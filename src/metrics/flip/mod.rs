//! FLIP, of Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, “FLIP: A Difference
//! Evaluator for Alternating Images”, Proceedings of the ACM on Computer Graphics and Interactive Techniques
//! 3(2), 2020; and HDR-FLIP, of Andersson, Nilsson, Shirley and Akenine-Möller, “Visualizing Errors in
//! Rendered High Dynamic Range Images”, Eurographics 2021.
//!
//! FLIP is the difference that a person sees who flips between two images at a normal distance. Colors are
//! filtered by the eye's sensitivity to contrast and compared in CIELAB (the color pipeline, section 4.1);
//! edges and points that only one image has (the feature pipeline, section 4.2) raise the error of the color
//! (section 4.3).

mod color;
mod high_dynamic_range;

use toyproof_image::Image;

use self::color::{ColorSpaces, hyab, linear_of_srgb};
pub(crate) use self::high_dynamic_range::high_dynamic_range;
use crate::band::{Band, Border, Kernel, Plane, in_bands};
use crate::map::{self, ErrorMap};

/// The assumed number of pixels in a degree of the visual field: on a monitor with 3840 pixels on 0.7 m, seen
/// from a distance of 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// The exponent qc of color differences.
const COLOR_EXPONENT: f64 = 0.7;

/// The share pc of the largest color difference below which differences take the range up to [`LOW_RANGE`].
const LOW_SHARE: f64 = 0.4;

/// The error pt of that difference.
const LOW_RANGE: f64 = 0.95;

/// The width w of a feature, in degrees: what people recognize as an edge.
const FEATURE_WIDTH: f64 = 0.082;

/// The exponent qf of feature differences.
const FEATURE_EXPONENT: f64 = 0.5;

/// The sensitivity to contrast of a channel of `YCxCz` as a sum of Gaussians a·√(π/b)·exp(−π²x²/b), x in
/// degrees: pairs (a, b) of table 1 of the paper.
const SENSITIVITY: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];

/// FLIP of two images as displayed.
pub(crate) fn displayed(reference: &Image, actual: &Image) -> ErrorMap {
    let linear = |image: &Image, index: usize| {
        let [r, g, b, _] = image.pixels()[index];
        [r, g, b].map(|component| linear_of_srgb(map::displayed(component)))
    };
    Flip::new().map(
        reference.size(),
        |index| linear(reference, index),
        |index| linear(actual, index),
    )
}

/// The filters and constants of FLIP.
#[derive(Debug)]
struct Flip {
    spaces: ColorSpaces,
    /// The filters of a channel of `YCxCz`, whose results are added.
    sensitivity: [Vec<Kernel>; 3],
    /// The share of each of them.
    shares: [Vec<f64>; 3],
    gaussian: Kernel,
    /// The first and the second derivative of the Gaussian.
    derivatives: [Kernel; 2],
    /// The largest color difference: that of green and blue.
    largest: f64,
}

impl Flip {
    fn new() -> Self {
        let spaces = ColorSpaces::new();
        let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|color| spaces.adapted_lab(color));
        let widest = SENSITIVITY
            .iter()
            .copied()
            .flatten()
            .map(|&(_, b)| b)
            .fold(0.0, f64::max);
        let pi = std::f64::consts::PI;
        // Three standard deviations of the widest Gaussian.
        let radius = (3.0 * (widest / (2.0 * pi * pi)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
        let gaussian = |b: f64| {
            Kernel::new(radius, move |at| {
                let degrees = at / PIXELS_PER_DEGREE;
                (-pi * pi * degrees * degrees / b).exp()
            })
        };
        let shares = SENSITIVITY.map(|terms| {
            // The volume under each Gaussian of two dimensions.
            let volumes = terms.iter().map(|&(a, b)| {
                let sum: f64 = gaussian(b).weights().iter().sum();
                a * (pi / b).sqrt() * sum * sum
            });
            let volumes: Vec<f64> = volumes.collect();
            let total: f64 = volumes.iter().sum();
            volumes.into_iter().map(|volume| volume / total).collect()
        });
        let deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
        let feature = |factor: fn(f64, f64) -> f64| {
            Kernel::new((3.0 * deviation).ceil() as usize, |at| {
                factor(at, deviation) * (-0.5 * (at / deviation).powi(2)).exp()
            })
        };
        Self {
            largest: hyab(green, blue).powf(COLOR_EXPONENT),
            spaces,
            sensitivity: SENSITIVITY
                .map(|terms| terms.iter().map(|&(_, b)| gaussian(b).normalized()).collect()),
            shares,
            gaussian: feature(|_, _| 1.0).normalized(),
            derivatives: [
                feature(|at, _| -at).balanced(),
                feature(|at, deviation| (at / deviation).powi(2) - 1.0).balanced(),
            ],
        }
    }

    /// The map of two images, given by the linear color of each pixel in [0, 1], by its index.
    fn map(
        &self,
        size: [u32; 2],
        reference: impl Fn(usize) -> [f64; 3] + Sync,
        actual: impl Fn(usize) -> [f64; 3] + Sync,
    ) -> ErrorMap {
        let radius = self.sensitivity[0][0].radius().max(self.gaussian.radius());
        let errors = in_bands(size, radius, Border::Nearest, |band| {
            let own = band.planes(|index| self.spaces.opponent(reference(index)));
            let other = band.planes(|index| self.spaces.opponent(actual(index)));
            let colors = self.seen(&own, band).zip(self.seen(&other, band));
            let features = self.features(&own[0], band).zip(self.features(&other[0], band));
            let errors = colors.zip(features).map(|((a, b), (own, other))| {
                let color = self.redistribute(hyab(a, b).powf(COLOR_EXPONENT));
                let [edge, point] = [0, 1].map(|kind| f64::abs(own[kind] - other[kind]));
                let feature = (edge.max(point) / std::f64::consts::SQRT_2).powf(FEATURE_EXPONENT);
                color.powf(1.0 - feature)
            });
            errors.collect()
        });
        ErrorMap::new(size, errors)
    }

    /// The colors that the eye sees, in CIELAB.
    fn seen(&self, channels: &[Plane; 3], band: &Band) -> impl Iterator<Item = [f64; 3]> {
        let rows = band.rows.len();
        let filtered: [Plane; 3] = std::array::from_fn(|channel| {
            let terms = self.sensitivity[channel].iter().zip(&self.shares[channel]);
            let terms = terms.map(|(kernel, &share)| {
                let along_rows = channels[channel].along_rows(kernel, Border::Nearest);
                along_rows.along_columns(&kernel.scaled(share), rows)
            });
            let sum = terms.reduce(|sum, term| sum.combine(&term, |a, b| a + b));
            sum.expect("a channel has at least one Gaussian")
        });
        (0..filtered[0].values().len()).map(move |at| {
            let color = filtered.each_ref().map(|channel| channel.values()[at]);
            let linear = self.spaces.linear_of_opponent(color);
            self.spaces
                .adapted_lab(linear.map(|component| component.clamp(0.0, 1.0)))
        })
    }

    /// How much each pixel is an edge, and how much a point, of the luminance.
    fn features(&self, luminance: &Plane, band: &Band) -> impl Iterator<Item = [f64; 2]> {
        let rows = band.rows.len();
        let normalized = luminance.combine(luminance, |y, _| (y + 16.0) / 116.0);
        let blurred = normalized.along_rows(&self.gaussian, Border::Nearest);
        let gradients = self.derivatives.each_ref().map(|derivative| {
            let across = normalized.along_rows(derivative, Border::Nearest);
            let [x, y] = [
                across.along_columns(&self.gaussian, rows),
                blurred.along_columns(derivative, rows),
            ];
            x.combine(&y, f64::hypot)
        });
        (0..gradients[0].values().len())
            .map(move |at| gradients.each_ref().map(|gradient| gradient.values()[at]))
    }

    /// Maps the difference of two colors to [0, 1], most of which is for differences that occur.
    fn redistribute(&self, difference: f64) -> f64 {
        let low = LOW_SHARE * self.largest;
        if difference < low {
            difference / low * LOW_RANGE
        } else {
            LOW_RANGE + (difference - low) / (self.largest - low) * (1.0 - LOW_RANGE)
        }
    }
}
