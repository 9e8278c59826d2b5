//! The colors of a film of at most 255: those of sampled frames, divided where this reduces the error most,
//! and then improved as k-means does.

use std::collections::BTreeSet;

use crate::frame::DisplayFrame;

/// The maximum number of colors. The 256th index of a GIF is that of unchanged pixels.
pub(crate) const MAX_COLORS: usize = 255;

/// Bits of each component that select a cell of the histogram.
const BITS: u32 = 5;

/// Iterations of k-means: more change the error of the palette by less than 1 %.
const ITERATIONS: usize = 6;

/// The colors of frames.
#[derive(Debug)]
pub(crate) struct Histogram {
    cells: Vec<Cell>,
    /// All colors, until there are too many.
    colors: BTreeSet<[u8; 3]>,
}

/// Colors that are near each other: their number and their sum.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    count: f64,
    sum: [f64; 3],
}

impl Cell {
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        for (sum, more) in self.sum.iter_mut().zip(other.sum) {
            *sum += more;
        }
    }

    /// The colors of several cells.
    fn total(cells: &[Self]) -> Self {
        let mut total = Self::default();
        for cell in cells {
            total.add(cell);
        }
        total
    }

    fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| sum / self.count)
    }

    /// The part of the sum of squares that the mean explains.
    fn explained(&self) -> f64 {
        self.sum.iter().map(|sum| sum * sum).sum::<f64>() / self.count
    }
}

impl Histogram {
    pub(crate) fn new() -> Self {
        Self {
            cells: vec![Cell::default(); 1 << (3 * BITS)],
            colors: BTreeSet::new(),
        }
    }

    pub(crate) fn add(&mut self, frame: &DisplayFrame) {
        let mut last = None;
        for &[r, g, b, _] in &frame.pixels {
            let color = [r, g, b];
            let index = color
                .iter()
                .fold(0, |index, part| index << BITS | usize::from(part >> (8 - BITS)));
            self.cells[index].add(&Cell {
                count: 1.0,
                sum: color.map(f64::from),
            });
            if last != Some(color) && self.colors.len() <= MAX_COLORS {
                self.colors.insert(color);
            }
            last = Some(color);
        }
    }

    /// At most [`MAX_COLORS`] colors: all that occur, if these suffice. At least one.
    pub(crate) fn palette(&self) -> Vec<[u8; 3]> {
        if self.colors.is_empty() {
            return vec![[0; 3]];
        }
        if self.colors.len() <= MAX_COLORS {
            return self.colors.iter().copied().collect();
        }
        let cells = self.cells.iter().filter(|cell| cell.count > 0.0).copied();
        let cells: Vec<Cell> = cells.collect();
        let mut means = divided(cells.clone());
        for _ in 0..ITERATIONS {
            means = moved(&cells, &means);
        }
        let mut palette: Vec<_> = means
            .into_iter()
            .map(|mean| mean.map(|part| part.round() as u8))
            .collect();
        palette.sort_unstable();
        palette.dedup();
        palette
    }
}

/// Cells in a range of colors, and where to divide them.
struct Range {
    /// The cells before the division come first.
    cells: Vec<Cell>,
    at: usize,
    /// By how much the division reduces the sum of squared errors.
    gain: f64,
}

impl Range {
    /// Finds the best division: between two cells in the order of a component.
    fn new(mut cells: Vec<Cell>) -> Self {
        let whole = Cell::total(&cells);
        let (mut axis, mut at, mut gain) = (0, 0, 0.0);
        for tried in 0..3 {
            sort(&mut cells, tried);
            let mut left = Cell::default();
            for (before, cell) in cells.iter().enumerate().take(cells.len() - 1) {
                left.add(cell);
                let right = Cell {
                    count: whole.count - left.count,
                    sum: [0, 1, 2].map(|at| whole.sum[at] - left.sum[at]),
                };
                let reduced = left.explained() + right.explained() - whole.explained();
                if reduced > gain {
                    (axis, at, gain) = (tried, before + 1, reduced);
                }
            }
        }
        sort(&mut cells, axis);
        Self { cells, at, gain }
    }
}

fn sort(cells: &mut [Cell], axis: usize) {
    cells.sort_by(|one, other| one.mean()[axis].total_cmp(&other.mean()[axis]));
}

/// The means of [`MAX_COLORS`] ranges: the range whose division reduces the error most is divided next, as in
/// X. Wu, “Color Quantization by Dynamic Programming and Principal Analysis”, ACM TOG 11(4), 1992.
fn divided(cells: Vec<Cell>) -> Vec<[f64; 3]> {
    let mut ranges = vec![Range::new(cells)];
    while ranges.len() < MAX_COLORS {
        let gains = ranges.iter().map(|range| range.gain).enumerate();
        let Some((widest, gain)) = gains.max_by(|one, other| one.1.total_cmp(&other.1)) else {
            break;
        };
        if gain <= 0.0 {
            break;
        }
        let mut range = ranges.swap_remove(widest);
        let right = range.cells.split_off(range.at);
        ranges.push(Range::new(range.cells));
        ranges.push(Range::new(right));
    }
    ranges
        .iter()
        .map(|range| Cell::total(&range.cells).mean())
        .collect()
}

/// The means of the cells that are nearest to each color.
fn moved(cells: &[Cell], colors: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut sums = vec![Cell::default(); colors.len()];
    for cell in cells {
        let mean = cell.mean();
        let distance = |color: &[f64; 3]| -> f64 { (0..3).map(|at| (color[at] - mean[at]).powi(2)).sum() };
        let distances = colors.iter().map(distance).enumerate();
        if let Some((nearest, _)) = distances.min_by(|one, other| one.1.total_cmp(&other.1)) {
            sums[nearest].add(cell);
        }
    }
    let moved = sums.iter().zip(colors);
    let moved = moved.map(|(sum, &color)| if sum.count > 0.0 { sum.mean() } else { color });
    moved.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn palette(pixels: Vec<[u8; 4]>) -> Vec<[u8; 3]> {
        let mut histogram = Histogram::new();
        histogram.add(&DisplayFrame {
            size: [pixels.len() as u32, 1],
            pixels,
        });
        histogram.palette()
    }

    /// The root mean square of the distances of all pixels to the palette.
    fn error(pixels: &[[u8; 4]], palette: &[[u8; 3]]) -> f64 {
        let squares = pixels.iter().map(|pixel| {
            let distance = |color: &[u8; 3]| -> u32 {
                (0..3)
                    .map(|at| u32::from(color[at].abs_diff(pixel[at])).pow(2))
                    .sum()
            };
            f64::from(palette.iter().map(distance).min().unwrap())
        });
        (squares.sum::<f64>() / pixels.len() as f64).sqrt()
    }

    #[test]
    fn few_colors_are_kept_exactly() {
        let pixels: Vec<_> = (0..255).map(|at| [at, 255 - at, at ^ 0x5b, 255]).collect();
        let colors: BTreeSet<_> = pixels.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        assert_eq!(palette(pixels), colors.into_iter().collect::<Vec<_>>());
        assert_eq!(palette(Vec::new()), [[0; 3]]);
    }

    /// A plane of colors has 65,536 of them. A square grid of 255 cells has cells of 256/√255 levels, whose
    /// root mean square distance from the center is 256/√(255·6) = 6.54 levels, and no palette has less than
    /// 0.98 of that, which hexagons have. Rounding of the palette to integers adds √(3/12) at most.
    #[test]
    fn many_colors_have_the_error_of_a_grid() {
        let pixels: Vec<_> = (0..=u16::MAX)
            .map(|at| [(at >> 8) as u8, at as u8, 80, 255])
            .collect();
        let palette = palette(pixels.clone());
        assert!(
            palette.len() <= MAX_COLORS && palette.len() > 250,
            "{}",
            palette.len()
        );
        let error = error(&pixels, &palette);
        assert!(error < 6.54 * 1.05, "{error}");
        assert!(error > 6.54 * 0.95, "the limit is tight: {error}");
    }

    #[test]
    fn a_small_area_of_another_hue_has_a_color() {
        let mut pixels: Vec<_> = (0..40_000_u32)
            .map(|at| [(at / 200) as u8, (at / 200) as u8, (at % 200) as u8, 255])
            .collect();
        pixels.extend([[255, 0, 0, 255]; 40]);
        let nearest = palette(pixels.clone());
        assert!(error(&[[255, 0, 0, 255]], &nearest) < 8.0);
    }
}
