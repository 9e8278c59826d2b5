//! The mean squared error.

use rayon::prelude::*;
use toyproof_image::Image;

/// The number of pixels whose errors are added first: sums of sums lose few digits, and their order is fixed.
const BLOCK: usize = 1 << 12;

/// The mean squared difference of red, green and blue, clamped to [0, 1]. NaN equals NaN, and differs from
/// everything else by 1.
///
/// # Panics
/// If the sizes differ.
pub(crate) fn mean(reference: &Image, actual: &Image) -> f64 {
    assert_eq!(reference.size(), actual.size());
    let pairs = reference
        .pixels()
        .par_chunks(BLOCK)
        .zip(actual.pixels().par_chunks(BLOCK));
    let block = |(reference, actual): (&[[f32; 4]], &[[f32; 4]])| {
        let pairs = reference.iter().flat_map(|pixel| &pixel[..3]);
        let pairs = pairs.zip(actual.iter().flat_map(|pixel| &pixel[..3]));
        pairs.map(|(&a, &b)| difference(a, b).powi(2)).sum::<f64>()
    };
    let sums: Vec<f64> = pairs.map(block).collect();
    sums.iter().sum::<f64>() / (3 * reference.pixels().len().max(1)) as f64
}

/// The difference of two components as displayed.
fn difference(a: f32, b: f32) -> f64 {
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) => f64::from(a).clamp(0.0, 1.0) - f64::from(b).clamp(0.0, 1.0),
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_over_components_as_displayed() {
        let image = |red: f32| Image::new(2, 1, vec![[red, 0.5, 3.0, 0.0], [0.25, 0.5, 1.0, 1.0]]);
        // One of six components differs by 0.5.
        assert_eq!(mean(&image(0.5), &image(1.0)), 0.25 / 6.0);
        assert_eq!(mean(&image(7.0), &image(1.0)), 0.0);
        assert_eq!(mean(&image(f32::NAN), &image(f32::NAN)), 0.0);
        assert_eq!(mean(&image(f32::NAN), &image(0.0)), 1.0 / 6.0);
    }
}
