//! One sample in each cell of a grid.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use toyproof_image::pcg;
use toyproof_scene::unit;

use super::super::lanes::{Kernel, Lanes, Level, Vectorised};
use super::super::spheres::PACKET;
use super::seed;

/// Which sample of how many, and the grid.
#[derive(Debug, Clone, Copy)]
struct Grid {
    index: u32,
    count: u32,
    /// Cells along the first number of a pair; the second has count / columns of them.
    columns: u32,
}

impl Grid {
    fn new(index: u32, count: u32) -> Self {
        // The largest divisor that is not above the root: 1 for a prime.
        let columns = (1..=count.isqrt()).rev().find(|side| count.is_multiple_of(*side));
        Self {
            index,
            count,
            columns: columns.unwrap_or(1),
        }
    }

    /// The pair in that cell.
    #[inline(always)]
    fn pair(self, cell: u32, seed: u32) -> [f64; 2] {
        let columns = f64::from(self.columns);
        // Exact: a quotient that is no whole number is farther from the next than it is rounded.
        let row = f64::from((f64::from(cell) / columns) as u32);
        let column = f64::from(cell) - row * columns;
        let rows = f64::from(self.count) / columns;
        [
            (column + self.within(0, seed)) / columns,
            (row + self.within(1, seed)) / rows,
        ]
    }

    /// The place within a cell, in [0, 1).
    #[inline(always)]
    fn within(self, axis: u32, seed: u32) -> f64 {
        unit(pcg(seed.wrapping_add(pcg(2 * self.index + axis))))
    }
}

/// The cells of one sample, a new one for each draw.
#[derive(Debug, Clone)]
pub(in super::super) struct Strata {
    grid: Grid,
    /// Hashed for each draw.
    seed: u32,
}

impl Strata {
    pub(super) fn new(index: u32, count: u32, seed: u32) -> Self {
        Self {
            grid: Grid::new(index, count),
            seed,
        }
    }

    pub(super) fn number(&mut self) -> f64 {
        let cell = self.cell();
        (f64::from(cell) + self.grid.within(0, self.seed)) / f64::from(self.grid.count)
    }

    pub(super) fn pair(&mut self) -> [f64; 2] {
        let cell = self.cell();
        self.grid.pair(cell, self.seed)
    }

    /// The sample's cell in the next draw.
    fn cell(&mut self) -> u32 {
        self.seed = pcg(self.seed);
        permuted(self.grid.index, self.grid.count, self.seed)
    }

    /// The draws of one sample in each of several pixels, of a set of samples, and the first pair of each.
    pub(in super::super) fn first_pairs(
        level: Level,
        [index, count, set]: [u32; 3],
        pixels: &[[u32; PACKET]; 2],
    ) -> ([Self; PACKET], [[f64; PACKET]; 2]) {
        let grid = Grid::new(index, count);
        let mut pairs = [[0.0; PACKET]; 2];
        let seeds = f64::run(
            level,
            FirstPairs {
                grid,
                set,
                pixels,
                pairs: &mut pairs,
            },
        );
        (seeds.map(|seed| Self { grid, seed }), pairs)
    }
}

/// The first pairs of several pixels: lanes are the compiler's to make.
struct FirstPairs<'a> {
    grid: Grid,
    set: u32,
    pixels: &'a [[u32; PACKET]; 2],
    pairs: &'a mut [[f64; PACKET]; 2],
}

impl Kernel<f64> for FirstPairs<'_> {
    /// The seeds after them.
    type Output = [u32; PACKET];

    #[inline(always)]
    fn run<S: Lanes<f64>>(self, _: S) -> [u32; PACKET] {
        let Self {
            grid, set, pixels, ..
        } = self;
        let (mut seeds, mut cells) = ([0; PACKET], [0; PACKET]);
        let scramble = Scramble::new(grid.count);
        for at in 0..PACKET {
            seeds[at] = pcg(seed([pixels[0][at], pixels[1][at]], set));
            cells[at] = scramble.once(grid.index, seeds[at]);
        }
        while cells.iter().fold(0, |most, &cell| most.max(cell)) >= grid.count {
            for at in 0..PACKET {
                let again = scramble.once(cells[at], seeds[at]);
                cells[at] = if cells[at] < grid.count { cells[at] } else { again };
            }
        }
        for at in 0..PACKET {
            [self.pairs[0][at], self.pairs[1][at]] = grid.pair(cells[at], seeds[at]);
        }
        seeds
    }
}

/// Where a permutation of 0 … count − 1, drawn by the seed, takes `index`: a bijection of the next power of two,
/// applied until it falls into the range.
fn permuted(index: u32, count: u32, seed: u32) -> u32 {
    let scramble = Scramble::new(count);
    let mut value = index;
    loop {
        value = scramble.once(value, seed);
        if value < count {
            return value;
        }
    }
}

/// Bijections of the power of two that is not below a count.
#[derive(Clone, Copy)]
struct Scramble {
    mask: u32,
    half: u32,
}

impl Scramble {
    fn new(count: u32) -> Self {
        let bits = (count.max(2) - 1).ilog2() + 1;
        Self {
            mask: (1u32 << bits) - 1,
            half: bits.div_ceil(2),
        }
    }

    #[inline(always)]
    fn once(self, mut value: u32, seed: u32) -> u32 {
        let mut key = seed;
        for _ in 0..4 {
            key = pcg(key);
            // Each step can be undone modulo the power of two.
            value = (value ^ key) & self.mask;
            value = value.wrapping_mul(key | 1) & self.mask;
            value ^= value >> self.half;
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_permutation_takes_every_value_once() {
        for count in [1, 2, 3, 10, 16, 37, 1000] {
            for seed in 0..20 {
                let mut seen: Vec<_> = (0..count).map(|index| permuted(index, count, seed)).collect();
                seen.sort_unstable();
                assert!(seen.into_iter().eq(0..count), "{count} {seed}");
            }
        }
    }

    #[test]
    fn every_cell_is_hit_once_for_any_count() {
        for count in [1u32, 6, 7, 16] {
            let mut ones: Vec<_> = (0..count)
                .map(|index| (Strata::new(index, count, 5).number() * f64::from(count)) as u32)
                .collect();
            ones.sort_unstable();
            assert!(ones.into_iter().eq(0..count));
        }
    }

    #[test]
    fn the_first_pairs_of_many_pixels_are_those_of_each() {
        let pixels = [
            std::array::from_fn(|at| at as u32 % 8),
            std::array::from_fn(|at| at as u32 / 8),
        ];
        for (count, level) in [1u32, 6, 7, 16, 37]
            .into_iter()
            .flat_map(|count| Level::all().map(move |level| (count, level)))
        {
            for index in [0, count / 2, count - 1] {
                let (mut strata, pairs) = Strata::first_pairs(level, [index, count, 3], &pixels);
                for at in 0..PACKET {
                    let mut alone = Strata::new(index, count, seed([pixels[0][at], pixels[1][at]], 3));
                    assert_eq!(
                        [pairs[0][at], pairs[1][at]],
                        alone.pair(),
                        "{count} {index} {level:?}"
                    );
                    assert_eq!(strata[at].number(), alone.number(), "what is drawn next");
                }
            }
        }
    }
}
