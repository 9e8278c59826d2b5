//! Periodic grids of numbers, of which the materials are made: sums of noise of several scales, distances to
//! scattered points, distortions and slopes.
//!
//! Only operations that IEEE 754 rounds exactly, integers, and sums in a fixed order are used, so that all
//! machines compute the same bits, with any number of threads.

use rayon::prelude::*;
use toyproof_image::pcg;

/// A square grid whose opposite sides meet, bottom row first.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    side: usize,
    values: Vec<f32>,
}

/// A hash of a position, different for each seed.
pub(crate) fn hash(seed: u32, x: u32, y: u32) -> u32 {
    pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(seed)))))
}

/// A number in [0, 1), of 24 random bits.
pub(crate) fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 / (1 << 24) as f32
}

/// A number in [−1, 1).
fn signed(hash: u32) -> f32 {
    2.0 * unit(hash) - 1.0
}

/// `a + (b − a)·t`
pub(crate) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// The cubic step of GLSL: 0 below `low`, 1 above `high`.
pub(crate) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl Field {
    /// A value for each column and row.
    ///
    /// # Panics
    /// If `side` is not a power of two.
    pub(crate) fn new(side: usize, value: impl Fn(usize, usize) -> f32 + Sync) -> Self {
        assert!(side.is_power_of_two());
        let mut values = vec![0.0; side * side];
        values.par_chunks_mut(side).enumerate().for_each(|(y, row)| {
            for (x, cell) in row.iter_mut().enumerate() {
                *cell = value(x, y);
            }
        });
        Self { side, values }
    }

    /// Noise of all scales from `cells` (powers of two, columns and rows of the coarsest scale) down to
    /// single texels, of mean 0 and standard deviation 1. Each scale has half the size of the one before it
    /// and `persistence` times its amplitude: 1 for the spectrum 1/f² that photographs have, less for
    /// smoother surfaces. Different numbers of columns and rows stretch the noise.
    ///
    /// Each step subdivides a uniform quadratic B-spline (Chaikin, 1974), so that no lattice shows.
    pub(crate) fn fractal(side: usize, cells: [usize; 2], seed: u32, persistence: f32) -> Self {
        let [mut columns, mut rows] = cells;
        let noise =
            |level: u32, x: usize, y: usize| signed(hash(seed.wrapping_mul(31) + level, x as u32, y as u32));
        let mut values: Vec<f32> = (0..rows * columns)
            .map(|at| noise(0, at % columns, at / columns))
            .collect();
        let (mut level, mut amplitude) = (0, 1.0);
        while columns < side || rows < side {
            let (wider, higher) = (columns < side, rows < side);
            if wider {
                values = subdivided_rows(&values, columns);
                columns *= 2;
            }
            if higher {
                values = subdivided_columns(&values, columns);
                rows *= 2;
            }
            level += 1;
            amplitude *= persistence;
            values.par_chunks_mut(columns).enumerate().for_each(|(y, row)| {
                for (x, value) in row.iter_mut().enumerate() {
                    *value += amplitude * noise(level, x, y);
                }
            });
        }
        Self { side, values }.normalized()
    }

    /// The value of a cell; positions outside are those of the periodic continuation.
    pub(crate) fn get(&self, x: isize, y: isize) -> f32 {
        let last = self.side - 1;
        self.values[(y as usize & last) * self.side + (x as usize & last)]
    }

    /// The value between cells, whose centers are at whole numbers.
    pub(crate) fn between(&self, x: f32, y: f32) -> f32 {
        let (left, low) = (x.floor(), y.floor());
        let (across, up) = (x - left, y - low);
        let corner = |dx, dy| self.get(left as isize + dx, low as isize + dy);
        mix(
            mix(corner(0, 0), corner(1, 0), across),
            mix(corner(0, 1), corner(1, 1), across),
            up,
        )
    }

    /// The field with a function of each value.
    pub(crate) fn map(&self, f: impl Fn(f32) -> f32 + Sync) -> Self {
        Self {
            side: self.side,
            values: self.values.par_iter().map(|&value| f(value)).collect(),
        }
    }

    /// The field moved at each cell by two others, times `distance` in cells.
    pub(crate) fn warped(&self, by: [&Self; 2], distance: f32) -> Self {
        Self::new(self.side, |x, y| {
            let [dx, dy] = by.map(|field| field.values[y * self.side + x] * distance);
            self.between(x as f32 + dx, y as f32 + dy)
        })
    }

    /// The slope against light from the upper left: how much the surface rises away from it, per cell.
    pub(crate) fn lit(&self) -> Self {
        Self::new(self.side, |x, y| {
            let (x, y) = (x as isize, y as isize);
            let rise = |dx, dy| self.get(x + dx, y + dy) - self.get(x - dx, y - dy);
            0.25 * (rise(1, 0) - rise(0, 1))
        })
    }

    /// The mean of a square of `2·radius + 1` cells around each cell, three times over, which is nearly a
    /// Gaussian of the standard deviation √(radius·(radius + 1)).
    pub(crate) fn blurred(&self, radius: usize) -> Self {
        let mut field = self.clone();
        for _ in 0..3 {
            field = field.box_rows(radius).transposed();
            field = field.box_rows(radius).transposed();
        }
        field
    }

    fn box_rows(&self, radius: usize) -> Self {
        let (side, width) = (self.side, 2 * radius + 1);
        let mut values = vec![0.0; side * side];
        let rows = values.par_chunks_mut(side).zip(self.values.par_chunks(side));
        rows.for_each(|(out, row)| {
            let at = |x: usize| row[x % side];
            let mut sum: f32 = (0..width).map(|x| at(x + side - radius)).sum();
            for (x, cell) in out.iter_mut().enumerate() {
                *cell = sum / width as f32;
                sum += at(x + radius + 1) - at(x + side - radius);
            }
        });
        Self { side, values }
    }

    fn transposed(&self) -> Self {
        Self::new(self.side, |x, y| self.values[x * self.side + y])
    }

    /// The field with mean 0 and standard deviation 1.
    pub(crate) fn normalized(&self) -> Self {
        let [[mean, deviation]] = statistics(self.side, &self.values, |&value| [value]);
        self.map(|value| (value - mean) / deviation)
    }
}

/// Mean and standard deviation of each component. Rows are summed in parallel, and the sums in their order.
pub(crate) fn statistics<T: Sync, const N: usize>(
    side: usize,
    values: &[T],
    components: impl Fn(&T) -> [f32; N] + Sync,
) -> [[f32; 2]; N] {
    let add = |sums: [[f64; 2]; N], more: [[f64; 2]; N]| {
        std::array::from_fn(|i| [sums[i][0] + more[i][0], sums[i][1] + more[i][1]])
    };
    let moments = |value: &T| components(value).map(|x| [f64::from(x), f64::from(x) * f64::from(x)]);
    let rows = values.par_chunks(side);
    let sums: Vec<_> = rows
        .map(|row| row.iter().map(moments).fold([[0.0; 2]; N], add))
        .collect();
    let count = values.len() as f64;
    sums.into_iter().fold([[0.0; 2]; N], add).map(|[sum, squares]| {
        let mean = sum / count;
        let variance = (squares / count - mean * mean).max(0.0);
        [mean as f32, variance.sqrt() as f32]
    })
}

/// Each row with twice as many cells.
fn subdivided_rows(values: &[f32], columns: usize) -> Vec<f32> {
    let mut wide = vec![0.0; 2 * values.len()];
    let rows = wide.par_chunks_mut(2 * columns).zip(values.par_chunks(columns));
    rows.for_each(|(out, row)| {
        for x in 0..columns {
            let (last, next) = (row[(x + columns - 1) % columns], row[(x + 1) % columns]);
            out[2 * x] = 0.75 * row[x] + 0.25 * last;
            out[2 * x + 1] = 0.75 * row[x] + 0.25 * next;
        }
    });
    wide
}

/// Twice as many rows.
fn subdivided_columns(values: &[f32], columns: usize) -> Vec<f32> {
    let rows = values.len() / columns;
    let row = |y: usize| &values[y % rows * columns..][..columns];
    let mut high = vec![0.0; 2 * values.len()];
    high.par_chunks_mut(columns).enumerate().for_each(|(y, out)| {
        let near = row(y / 2);
        let far = row(if y % 2 == 0 { y / 2 + rows - 1 } else { y / 2 + 1 });
        for ((cell, near), far) in out.iter_mut().zip(near).zip(far) {
            *cell = 0.75 * near + 0.25 * far;
        }
    });
    high
}

/// Points scattered over the square [0, 1)², one in each cell of a grid, whose opposite sides meet.
#[derive(Debug)]
pub(crate) struct Points {
    columns: u32,
    rows: u32,
    /// Those of the cells, row by row.
    all: Vec<Point>,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    /// The position in its cell, at least a tenth from the border.
    within: [f32; 2],
    id: u32,
}

/// The point that is nearest to a position. Distances are in cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    /// The distance of the nearest point.
    pub(crate) first: f32,
    /// The distance of the second nearest: the difference of both is 0 on the border between two regions.
    pub(crate) second: f32,
    /// The position relative to the nearest point.
    pub(crate) offset: [f32; 2],
    /// A hash of the nearest point.
    pub(crate) id: u32,
}

impl Points {
    /// The points of a grid of columns and rows, different for each seed.
    pub(crate) fn new([columns, rows]: [u32; 2], seed: u32) -> Self {
        let point = |at| {
            let id = hash(seed, at % columns, at / columns);
            let within = [id, pcg(id)].map(|random| 0.1 + 0.8 * unit(random));
            Point { within, id }
        };
        Self {
            columns,
            rows,
            all: (0..columns * rows).map(point).collect(),
        }
    }

    /// The nearest point to a position (u, v), of which only the fractions count.
    pub(crate) fn nearest(&self, u: f32, v: f32) -> Nearest {
        let x = (u - u.floor()) * self.columns as f32;
        let y = (v - v.floor()) * self.rows as f32;
        // The product may round to the number of cells.
        let (column, row) = ((x as u32).min(self.columns - 1), (y as u32).min(self.rows - 1));
        let mut nearest = Nearest {
            first: f32::INFINITY,
            second: f32::INFINITY,
            offset: [0.0; 2],
            id: 0,
        };
        let around = |at: u32, count: u32| [(at + count - 1) % count, at, (at + 1) % count];
        for (dy, cell_row) in (-1_i8..).zip(around(row, self.rows)) {
            for (dx, cell_column) in (-1_i8..).zip(around(column, self.columns)) {
                let Point { within, id } = self.all[(cell_row * self.columns + cell_column) as usize];
                let offset = [
                    x - column as f32 - f32::from(dx) - within[0],
                    y - row as f32 - f32::from(dy) - within[1],
                ];
                let square = offset[0] * offset[0] + offset[1] * offset[1];
                if square < nearest.first {
                    nearest = Nearest {
                        first: square,
                        second: nearest.first,
                        offset,
                        id,
                    };
                } else if square < nearest.second {
                    nearest.second = square;
                }
            }
        }
        Nearest {
            first: nearest.first.sqrt(),
            second: nearest.second.sqrt(),
            ..nearest
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_the_stated_mean_and_deviation_and_continues_across_its_sides() {
        for (cells, persistence) in [([4, 4], 0.6), ([2, 32], 0.9)] {
            let field = Field::fractal(128, cells, 7, persistence);
            let [[mean, deviation]] = statistics(128, &field.values, |&value| [value]);
            assert!(mean.abs() < 1e-5 && (deviation - 1.0).abs() < 1e-5);
            // The step across a side is as large as the steps inside.
            let step = |x: isize| {
                (0..128)
                    .map(|y| (field.get(x, y) - field.get(x - 1, y)).abs())
                    .sum::<f32>()
            };
            let inside = (1..128).map(step).sum::<f32>() / 127.0;
            assert!(
                (0.5..1.5).contains(&(step(0) / inside)),
                "{} of {inside}",
                step(0)
            );
        }
    }

    #[test]
    fn a_blur_keeps_the_mean_and_spreads_a_point_evenly() {
        let point = Field::new(32, |x, y| f32::from(u8::from([x, y] == [3, 5])));
        let blurred = point.blurred(2);
        let sum: f32 = blurred.values.iter().sum();
        assert!((sum - 1.0).abs() < 1e-4, "{sum}");
        for offset in 1..6 {
            let around = [(offset, 0), (-offset, 0), (0, offset), (0, -offset)];
            let values = around.map(|(dx, dy)| blurred.get(3 + dx, 5 + dy));
            assert!(
                values.iter().all(|value| (value - values[0]).abs() < 1e-6),
                "{values:?}"
            );
        }
    }

    #[test]
    fn the_nearest_point_is_that_of_all_points() {
        let points = Points::new([5, 3], 1);
        let position = |column: i32, row: i32| {
            let id = hash(1, column.rem_euclid(5) as u32, row.rem_euclid(3) as u32);
            [
                column as f32 + 0.1 + 0.8 * unit(id),
                row as f32 + 0.1 + 0.8 * unit(pcg(id)),
            ]
        };
        for at in 0..400 {
            let (u, v) = (unit(pcg(at)), unit(pcg(at + 1000)));
            let distances = (-5..10).flat_map(|column| (-3..6).map(move |row| position(column, row)));
            let squares = distances.map(|[x, y]| (5.0 * u - x).powi(2) + (3.0 * v - y).powi(2));
            let least = squares.fold(f32::INFINITY, f32::min).sqrt();
            let nearest = points.nearest(u, v);
            assert!((nearest.first - least).abs() < 1e-5, "{} {least}", nearest.first);
            assert!(nearest.second >= nearest.first);
        }
    }
}
