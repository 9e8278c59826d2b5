//! How far a picture is from the truth.

use serde::Serialize;
use toyproof_image::Image;
use toyproof_verify::compare::{self, TOLERANCE};

/// What a picture differs by from the truth, both clamped to [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Error {
    /// The root of the mean square over all components, in [0, 1].
    pub rmse: f64,
    /// The largest absolute difference of a component.
    pub max: f64,
    /// Pixels whose 8-bit values differ.
    pub mismatches_8bit: u64,
    /// Pixels that show the background in one picture and something else in the other; none where the background is not known.
    pub flips: Option<u64>,
}

impl Error {
    /// `background` is what is seen where nothing is met.
    pub(super) fn of(truth: &Image, picture: &Image, background: Option<&Image>) -> Self {
        let (comparison, _) = compare::compare(truth, picture);
        Self {
            rmse: rmse(truth, picture),
            max: comparison.max_abs,
            mismatches_8bit: comparison.differing_8bit,
            flips: background.map(|background| {
                let empty = |picture: &Image, at: usize| {
                    let pairs = picture.pixels()[at].iter().zip(background.pixels()[at]).take(3);
                    pairs
                        .into_iter()
                        .all(|(a, b)| f64::from((a - b).abs()) <= TOLERANCE)
                };
                let pixels = 0..truth.pixels().len();
                pixels
                    .filter(|&at| empty(truth, at) != empty(picture, at))
                    .count() as u64
            }),
        }
    }
}

/// The root of the mean square difference of components, clamped to [0, 1]; NaN differs by 1.
pub(super) fn rmse(one: &Image, other: &Image) -> f64 {
    let pairs = one.pixels().iter().zip(other.pixels());
    let squares = pairs.flat_map(|(a, b)| {
        (0..3).map(|i| match (a[i], b[i]) {
            (a, b) if a.is_nan() && b.is_nan() => 0.0,
            (a, b) if a.is_nan() || b.is_nan() => 1.0,
            (a, b) => (f64::from(a).clamp(0.0, 1.0) - f64::from(b).clamp(0.0, 1.0)).powi(2),
        })
    });
    let count = 3 * one.pixels().len().max(1);
    (squares.sum::<f64>() / count as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(values: [f32; 4]) -> Image {
        Image::new(2, 2, values.map(|v| [v, v, v, 1.0]).to_vec())
    }

    #[test]
    fn errors_are_counted_by_hand() {
        let truth = image([0.0, 0.5, 1.0, 0.2]);
        let picture = image([0.1, 0.5, 7.0, 0.0]);
        let background = image([0.0, 0.0, 0.0, 0.0]);
        let error = Error::of(&truth, &picture, Some(&background));
        assert!(
            (error.rmse - ((0.01f64 + 0.04) / 4.0).sqrt()).abs() < 1e-8,
            "{error:?}"
        );
        assert!((error.max - 0.2).abs() < 1e-7);
        assert_eq!((error.mismatches_8bit, error.flips), (2, Some(2)));
        let same = Error::of(&truth, &truth, None);
        assert_eq!(
            (same.rmse, same.max, same.mismatches_8bit, same.flips),
            (0.0, 0.0, 0, None)
        );
    }
}
