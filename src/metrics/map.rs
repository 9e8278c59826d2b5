//! A number for each pixel, and its image in colors.

use toyproof_image::{Rgb8Image, quantize};

/// An error in [0, 1] for each pixel; those of SSIM are 1 − the similarity, which may be larger.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    size: [u32; 2],
    /// Bottom row first.
    errors: Vec<f32>,
}

impl ErrorMap {
    pub(crate) fn new(size: [u32; 2], errors: Vec<f32>) -> Self {
        assert_eq!(errors.len(), size[0] as usize * size[1] as usize);
        Self { size, errors }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// All errors, bottom row first.
    pub fn errors(&self) -> &[f32] {
        &self.errors
    }

    /// The mean over all pixels.
    pub fn mean(&self) -> f64 {
        self.inner_mean(0)
    }

    /// The mean over the pixels that are at least `margin` pixels away from the edges.
    pub(crate) fn inner_mean(&self, margin: usize) -> f64 {
        let [width, height] = self.size.map(|side| side as usize);
        let rows = self.errors.chunks(width).skip(margin).take(height - 2 * margin);
        // Sums of rows: they lose few digits.
        let sums = rows.map(|row| {
            let inner = &row[margin..width - margin];
            inner.iter().copied().map(f64::from).sum::<f64>()
        });
        sums.sum::<f64>() / ((width - 2 * margin) * (height - 2 * margin)) as f64
    }

    /// The larger error of two maps in each pixel.
    pub(crate) fn max(mut self, other: &Self) -> Self {
        for (error, &other) in self.errors.iter_mut().zip(&other.errors) {
            *error = error.max(other);
        }
        self
    }

    /// The map in the colors of magma: black for 0, over violet, red and orange to a light yellow for 1.
    #[must_use]
    pub fn magma(&self) -> Rgb8Image {
        let colors: [[u8; 3]; 256] = std::array::from_fn(|at| magma(at as f32 / 255.0));
        let color = |&error: &f32| colors[usize::from(quantize(error))];
        let [width, height] = self.size;
        Rgb8Image::new(width, height, self.errors.iter().map(color).collect())
    }
}

/// A component as it is displayed: in [0, 1], with black for NaN.
pub(crate) fn displayed(component: f32) -> f64 {
    if component > 0.0 {
        f64::from(component.min(1.0))
    } else {
        0.0
    }
}

/// The colors of matplotlib's magma (Smith and van der Walt, 2015) at sixteen values from 0 to 1.
const MAGMA: [[u8; 3]; 16] = [
    [0, 0, 4],
    [11, 9, 36],
    [32, 17, 75],
    [59, 15, 112],
    [87, 21, 126],
    [114, 31, 129],
    [140, 41, 129],
    [168, 50, 125],
    [196, 60, 117],
    [222, 73, 104],
    [241, 96, 93],
    [250, 127, 94],
    [254, 159, 109],
    [254, 191, 132],
    [253, 222, 160],
    [252, 253, 191],
];

/// The color of a value in [0, 1]: linear between those of [`MAGMA`], and at most three levels from
/// matplotlib's table of 256 colors.
fn magma(value: f32) -> [u8; 3] {
    let at = value * (MAGMA.len() - 1) as f32;
    let below = (at as usize).min(MAGMA.len() - 2);
    let share = at - below as f32;
    std::array::from_fn(|component| {
        let [low, high] = [below, below + 1].map(|at| f32::from(MAGMA[at][component]));
        (low + share * (high - low)).round_ties_even() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magma_is_black_violet_orange_and_light_yellow() {
        // Of matplotlib's table, at 0, 96, 176, 255.
        for (value, expected) in [
            (0.0, [0, 0, 4]),
            (96.0 / 255.0, [131_u8, 38, 129]),
            (176.0 / 255.0, [245, 107, 92]),
            (1.0, [252, 253, 191]),
        ] {
            let color = magma(value);
            let difference = (0..3).map(|at| color[at].abs_diff(expected[at])).max().unwrap();
            assert!(difference <= 3, "{value}: {color:?}");
        }
        let map = ErrorMap::new([2, 1], vec![-0.5, 1.5]);
        assert_eq!(map.magma().pixels(), [[0, 0, 4], [252, 253, 191]]);
    }

    #[test]
    fn the_inner_mean_leaves_the_edges_out() {
        let map = ErrorMap::new([3, 3], (0..9).map(|at| (at * at) as f32).collect());
        assert_eq!(map.inner_mean(1), 16.0);
        assert_eq!(map.mean(), 204.0 / 9.0);
    }
}
