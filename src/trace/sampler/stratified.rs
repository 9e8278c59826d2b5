//! One sample in each cell of a grid.

use crate::image::pcg;
use crate::scene::unit;

/// The cells of one sample, a new one for each draw.
#[derive(Debug, Clone)]
pub(in super::super) struct Strata {
    index: u32,
    count: u32,
    /// Cells along the first number of a pair; the second has count / columns of them.
    columns: u32,
    /// Hashed for each draw.
    seed: u32,
}

impl Strata {
    pub(super) fn new(index: u32, count: u32, seed: u32) -> Self {
        // The largest divisor that is not above the root: 1 for a prime.
        let columns = (1..=count.isqrt()).rev().find(|side| count.is_multiple_of(*side));
        Self {
            index,
            count,
            columns: columns.unwrap_or(1),
            seed,
        }
    }

    pub(super) fn number(&mut self) -> f64 {
        let cell = self.cell();
        (f64::from(cell) + self.within(0)) / f64::from(self.count)
    }

    pub(super) fn pair(&mut self) -> [f64; 2] {
        let cell = self.cell();
        let rows = self.count / self.columns;
        [
            (f64::from(cell % self.columns) + self.within(0)) / f64::from(self.columns),
            (f64::from(cell / self.columns) + self.within(1)) / f64::from(rows),
        ]
    }

    /// The sample's cell in the next draw.
    fn cell(&mut self) -> u32 {
        self.seed = pcg(self.seed);
        permuted(self.index, self.count, self.seed)
    }

    /// The place within the cell, in [0, 1).
    fn within(&self, axis: u32) -> f64 {
        unit(pcg(self.seed.wrapping_add(pcg(2 * self.index + axis))))
    }
}

/// Where a permutation of 0 … count − 1, drawn by the seed, takes `index`: a bijection of the next power of two,
/// applied until it falls into the range.
fn permuted(index: u32, count: u32, seed: u32) -> u32 {
    let bits = (count.max(2) - 1).ilog2() + 1;
    let mask = (1u32 << bits) - 1;
    let half = bits.div_ceil(2);
    let mut value = index;
    loop {
        let mut key = seed;
        for _ in 0..4 {
            key = pcg(key);
            // Each step can be undone modulo the power of two.
            value = (value ^ key) & mask;
            value = value.wrapping_mul(key | 1) & mask;
            value ^= value >> half;
        }
        if value < count {
            return value;
        }
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
}
