//! The structural similarity (SSIM) of Wang, Bovik, Sheikh and Simoncelli, “Image Quality Assessment: From
//! Error Visibility to Structural Similarity”, IEEE Transactions on Image Processing 13(4), 2004.
//!
//! The windows are Gaussians of 11×11 pixels with a standard deviation of 1.5 (section III-B), the constants
//! K₁ = 0.01, K₂ = 0.03 and L = 1. Red, green and blue are compared separately, and their similarities
//! averaged: a wrong color of the right luminance counts. As in the paper, the mean is over the pixels whose
//! windows lie within the image; the map also has the others, with the image mirrored at its edges. The
//! values are those of scikit-image's `structural_similarity` with `gaussian_weights=True, sigma=1.5,
//! use_sample_covariance=False, data_range=1`.

use toyproof_image::Image;

use crate::band::{Band, Border, Kernel, Plane, in_bands};
use crate::map::{ErrorMap, displayed};

/// The side of a window, in pixels.
pub(crate) const WINDOW: u32 = 11;

/// The standard deviation of the weights of a window, in pixels.
const DEVIATION: f64 = 1.5;

/// C₁ = (K₁L)², which keeps the quotient of means defined (equation 7).
const C1: f64 = 0.01 * 0.01;

/// C₂ = (K₂L)², which keeps the quotient of variances defined (equation 9).
const C2: f64 = 0.03 * 0.03;

/// The mean similarity of two images that have at least [`WINDOW`] pixels on each side, and 1 − the
/// similarity of each pixel.
pub(crate) fn compare(reference: &Image, actual: &Image) -> (f64, ErrorMap) {
    let size = reference.size();
    let radius = WINDOW as usize / 2;
    let weight = |at: f64| (-0.5 * (at / DEVIATION).powi(2)).exp();
    let kernel = Kernel::new(radius, weight).normalized();
    let errors = in_bands(size, radius, Border::Mirrored, |band| {
        let color = |image: &Image, index: usize| {
            let [r, g, b, _] = image.pixels()[index];
            [r, g, b].map(displayed)
        };
        let own = band.planes(|index| color(reference, index));
        let other = band.planes(|index| color(actual, index));
        let mut errors = vec![0.0; band.rows.len() * size[0] as usize];
        for (own, other) in own.iter().zip(&other) {
            for (error, similarity) in errors.iter_mut().zip(similarities(own, other, band, &kernel)) {
                *error += (1.0 - similarity) / 3.0;
            }
        }
        errors
    });
    let map = ErrorMap::new(size, errors);
    (1.0 - map.inner_mean(radius), map)
}

/// The similarity of each pixel of a component (equation 13).
fn similarities(x: &Plane, y: &Plane, band: &Band, kernel: &Kernel) -> impl Iterator<Item = f64> {
    let mean = |plane: &Plane| {
        let rows = plane.along_rows(kernel, Border::Mirrored);
        rows.along_columns(kernel, band.rows.len())
    };
    let product = |a: &Plane, b: &Plane| mean(&a.combine(b, |a, b| a * b));
    let (mean_x, mean_y) = (mean(x), mean(y));
    let [xx, yy, xy] = [product(x, x), product(y, y), product(x, y)];
    (0..mean_x.values().len()).map(move |at| {
        let (mx, my) = (mean_x.values()[at], mean_y.values()[at]);
        let variances = xx.values()[at] - mx * mx + yy.values()[at] - my * my;
        let covariance = xy.values()[at] - mx * my;
        let luminance = (2.0 * mx * my + C1) / (mx * mx + my * my + C1);
        luminance * (2.0 * covariance + C2) / (variances + C2)
    })
}
