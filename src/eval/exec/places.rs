//! The parts of a frame that are evaluated.

use std::ops::Range;

/// Sample positions that are evaluated instead of the centers of all pixels: all pairs of these coordinates,
/// as in `fragCoord`. Neighbors at an even and the next odd index form a quad.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// x, from the left.
    pub columns: Vec<f64>,
    /// y, from the bottom up.
    pub rows: Vec<f64>,
}

impl Places {
    /// Returns the centers of pixels spread over a frame of this size, at most `most` columns and rows, in
    /// whole quads.
    #[must_use]
    pub fn spread(size: [u32; 2], most: [u32; 2]) -> Self {
        let along = |axis: usize| {
            let (length, most) = (size[axis], most[axis]);
            let pixels: Vec<u32> = if most >= length {
                (0..length).collect()
            } else {
                let pairs = (most / 2).max(1);
                let first = |pair| 2 * ((2 * pair + 1) * (length / 2) / (2 * pairs));
                (0..pairs)
                    .flat_map(|pair| [first(pair), first(pair) + 1])
                    .filter(|&at| at < length)
                    .collect()
            };
            pixels.into_iter().map(|at| f64::from(at) + 0.5).collect()
        };
        Self {
            columns: along(0),
            rows: along(1),
        }
    }

    /// Returns the columns and rows of the pixels that contain the positions.
    #[must_use]
    pub fn pixels(&self) -> [Vec<u32>; 2] {
        [&self.columns, &self.rows].map(|along| along.iter().map(|&at| at as u32).collect())
    }

    /// Returns width and height of the image that has a pixel for each position.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [&self.columns, &self.rows].map(|along| along.len() as u32)
    }

    /// Returns the positions moved by an offset in pixels.
    #[must_use]
    pub fn shifted(&self, [x, y]: [f64; 2]) -> Self {
        Self {
            columns: self.columns.iter().map(|column| column + x).collect(),
            rows: self.rows.iter().map(|row| row + y).collect(),
        }
    }
}

/// The part of a frame that is evaluated.
pub enum Part<'a> {
    Rows(Range<u32>),
    Places(&'a Places),
}
