//! Bands of rows of several components, and separable filters of them.
//!
//! A metric computes an image in bands, each with the rows around it that its filters read. So it needs
//! memory for bands instead of images, and bands are computed in parallel.

use std::ops::Range;

use rayon::prelude::*;

/// The number of rows of a band: the rows around it, which are computed again for its neighbors, are few
/// beside them.
const ROWS: usize = 64;

/// What a filter reads outside of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Border {
    /// The nearest pixel.
    Nearest,
    /// The image mirrored at the outer edges of its pixels: the pixel at the edge is next to itself.
    Mirrored,
}

impl Border {
    /// The position inside of `0..length` that is read at `at`.
    pub(crate) fn inside(self, at: isize, length: usize) -> usize {
        let last = length as isize - 1;
        match self {
            Self::Nearest => at.clamp(0, last) as usize,
            Self::Mirrored => {
                let period = 2 * length as isize;
                let folded = at.rem_euclid(period);
                folded.min(period - 1 - folded) as usize
            }
        }
    }
}

/// The weights of a filter of one dimension around its middle; their number is odd.
#[derive(Debug, Clone)]
pub(crate) struct Kernel(Vec<f64>);

impl Kernel {
    /// The weights at the integers up to `radius`.
    pub(crate) fn new(radius: usize, weight: impl Fn(f64) -> f64) -> Self {
        let radius = radius as isize;
        Self((-radius..=radius).map(|at| weight(at as f64)).collect())
    }

    pub(crate) fn radius(&self) -> usize {
        self.0.len() / 2
    }

    pub(crate) fn weights(&self) -> &[f64] {
        &self.0
    }

    /// The weights times a factor.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self(self.0.iter().map(|weight| weight * factor).collect())
    }

    /// The kernel whose weights have the sum 1.
    pub(crate) fn normalized(&self) -> Self {
        self.scaled(1.0 / self.0.iter().sum::<f64>())
    }

    /// The kernel whose positive weights have the sum 1 and whose negative ones have the sum −1.
    pub(crate) fn balanced(&self) -> Self {
        let sum = |sign: f64| self.0.iter().map(|weight| (weight * sign).max(0.0)).sum::<f64>();
        let (positive, negative) = (sum(1.0), sum(-1.0));
        let balanced = self
            .0
            .iter()
            .map(|&weight| weight / if weight > 0.0 { positive } else { negative });
        Self(balanced.collect())
    }
}

/// Rows of one component.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    width: usize,
    values: Vec<f64>,
}

impl Plane {
    pub(crate) fn new(width: usize, values: Vec<f64>) -> Self {
        Self { width, values }
    }

    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    fn height(&self) -> usize {
        self.values.len() / self.width
    }

    /// A plane with a value for each pair of those of two planes.
    pub(crate) fn combine(&self, other: &Self, value: impl Fn(f64, f64) -> f64) -> Self {
        let pairs = self.values.iter().zip(&other.values);
        Self::new(self.width, pairs.map(|(&a, &b)| value(a, b)).collect())
    }

    /// Filters along the rows.
    pub(crate) fn along_rows(&self, kernel: &Kernel, border: Border) -> Self {
        let radius = kernel.radius() as isize;
        let positions: Vec<usize> = (-radius..self.width as isize + radius)
            .map(|at| border.inside(at, self.width))
            .collect();
        let mut filtered = vec![0.0; self.values.len()];
        let mut padded = vec![0.0; positions.len()];
        let rows = self
            .values
            .chunks(self.width)
            .zip(filtered.chunks_mut(self.width));
        for (row, filtered) in rows {
            for (value, &at) in padded.iter_mut().zip(&positions) {
                *value = row[at];
            }
            for (first, &weight) in kernel.weights().iter().enumerate() {
                for (sum, value) in filtered.iter_mut().zip(&padded[first..]) {
                    *sum += weight * value;
                }
            }
        }
        Self::new(self.width, filtered)
    }

    /// Filters along the columns. The result has the `rows` in the middle; the kernel does not reach beyond
    /// the plane.
    pub(crate) fn along_columns(&self, kernel: &Kernel, rows: usize) -> Self {
        let around = (self.height() - rows) / 2 - kernel.radius();
        let mut filtered = vec![0.0; rows * self.width];
        for (row, filtered) in filtered.chunks_mut(self.width).enumerate() {
            for (below, &weight) in kernel.weights().iter().enumerate() {
                let start = (around + row + below) * self.width;
                for (sum, value) in filtered.iter_mut().zip(&self.values[start..start + self.width]) {
                    *sum += weight * value;
                }
            }
        }
        Self::new(self.width, filtered)
    }
}

/// A band of rows of an image: `rows` are its own, and it is read with `radius` more on each side.
#[derive(Debug, Clone)]
pub(crate) struct Band {
    pub(crate) rows: Range<usize>,
    /// The rows of the image that are read, in order; some are read more than once at the border.
    read: Vec<usize>,
    width: usize,
}

impl Band {
    /// The planes of the components that a function returns for each pixel, given by its index in the image.
    pub(crate) fn planes<const N: usize>(&self, components: impl Fn(usize) -> [f64; N]) -> [Plane; N] {
        let mut planes = [(); N].map(|()| Vec::with_capacity(self.read.len() * self.width));
        for &row in &self.read {
            for index in row * self.width..(row + 1) * self.width {
                for (plane, component) in planes.iter_mut().zip(components(index)) {
                    plane.push(component);
                }
            }
        }
        planes.map(|values| Plane::new(self.width, values))
    }
}

/// Computes a value for each pixel in bands, in parallel: all values, bottom row first. `radius` is the
/// largest one of the filters.
pub(crate) fn in_bands(
    [width, height]: [u32; 2],
    radius: usize,
    border: Border,
    compute: impl Fn(&Band) -> Vec<f64> + Sync,
) -> Vec<f32> {
    let (width, height) = (width as usize, height as usize);
    let bands: Vec<Vec<f32>> = (0..height.div_ceil(ROWS))
        .into_par_iter()
        .map(|band| {
            let rows = band * ROWS..((band + 1) * ROWS).min(height);
            let read = rows.start as isize - radius as isize..(rows.end + radius) as isize;
            let read = read.map(|row| border.inside(row, height)).collect();
            let values = compute(&Band { rows, read, width });
            values.into_iter().map(|value| value as f32).collect()
        })
        .collect();
    bands.concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_outside_are_read_inside() {
        let all = |border: Border, length| (-4..7).map(|at| border.inside(at, length)).collect::<Vec<_>>();
        assert_eq!(all(Border::Nearest, 3), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(all(Border::Mirrored, 3), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(all(Border::Mirrored, 1), [0; 11]);
    }

    /// A separable filter in bands is the sum over all pixels of the image.
    #[test]
    fn bands_are_filtered_as_the_whole_image() {
        let (width, height) = (13_usize, 2 * ROWS + 9);
        let value = |index: usize| f64::from((index as u32).wrapping_mul(2_654_435_761) >> 8) / 1e6;
        let kernel = Kernel::new(3, |at| 1.0 / (1.5 + at));
        for border in [Border::Nearest, Border::Mirrored] {
            // A larger radius than the kernel's, as if another filter read more.
            let filtered = in_bands([width as u32, height as u32], 5, border, |band| {
                let [plane] = band.planes(|index| [value(index)]);
                let rows = plane.along_rows(&kernel, border);
                rows.along_columns(&kernel, band.rows.len()).values().to_vec()
            });
            for (index, &filtered) in filtered.iter().enumerate() {
                let (x, y) = ((index % width) as isize, (index / width) as isize);
                let mut sum = 0.0;
                for (dy, vertical) in (-3..).zip(kernel.weights()) {
                    for (dx, horizontal) in (-3..).zip(kernel.weights()) {
                        let row = border.inside(y + dy, height) * width;
                        sum += vertical * horizontal * value(row + border.inside(x + dx, width));
                    }
                }
                // The values are rounded to f32, relative to sums of about 10⁴.
                assert!(
                    (f64::from(filtered) - sum).abs() < 1e-2,
                    "{border:?} {index}: {filtered} {sum}"
                );
            }
        }
    }

    #[test]
    fn weights_are_normalized_and_balanced() {
        let sum = |kernel: &Kernel| kernel.weights().iter().sum::<f64>();
        let kernel = Kernel::new(2, |at| at + 0.25);
        assert!((sum(&kernel.normalized()) - 1.0).abs() < 1e-15);
        let balanced = kernel.balanced();
        let positive: f64 = balanced.weights().iter().filter(|weight| **weight > 0.0).sum();
        assert!((positive - 1.0).abs() < 1e-15 && sum(&balanced).abs() < 1e-15);
    }
}
