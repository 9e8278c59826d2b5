//! Random and quasi-random numbers: the position of each sample in its pixel, and the choices of lights and
//! surfaces.

use toyproof_image::pcg;
use toyproof_scene::{Sampler, unit};

use crate::lanes::{Kernel, Lanes, Level, MAX_LANES, Vectorized, Wide, lanes_of};
use crate::real::Real;
use crate::spheres::PACKET_RAYS;

/// A sample of a pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    pub(super) pixel: [u32; 2],
    /// Index of the sample in the pixel, from 0 to `count` − 1.
    pub(super) index: u32,
    /// Number of samples of the pixel.
    pub(super) count: u32,
    /// Number of the set; samples of different sets are independent.
    pub(super) set: u32,
}

/// The numbers of one sample, in the order of use: the position in the pixel comes first.
#[derive(Debug, Clone)]
pub(super) enum SampleStream {
    /// The pixel center and no random numbers.
    Center,
    /// The course's hash, by the index of the sample.
    SineHash(u32),
    /// The state starts as `pcg(x + pcg(y + pcg(index)))` for the pixel (x, y). Each number replaces the
    /// state by its hash and takes the upper 24 bits.
    Independent(u32),
    Stratified(Strata),
    Sobol {
        index: u32,
        dimension: u32,
        seed: u32,
        /// The numbers of the current four dimensions, which are computed together.
        numbers: [f32; 4],
    },
}

/// Number of tabulated dimensions of Sobol's sequence. A path that uses more starts over with a different
/// seed.
const SOBOL_DIMENSIONS: u32 = sobol_burley::NUM_DIMENSIONS;

/// Seed of all samples of a pixel in one set.
#[inline]
fn seed([x, y]: [u32; 2], set: u32) -> u32 {
    pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(set)))))
}

/// Converts a position in the unit square to an offset from its center.
#[inline]
pub(super) fn centered<T: Real>(position: [f64; 2]) -> [T; 2] {
    position.map(|along| T::from_f64(along) - T::from_f64(0.5))
}

impl SampleStream {
    #[inline]
    pub(super) fn new(sampler: Sampler, sample: Sample) -> Self {
        let Sample {
            pixel: [x, y],
            index,
            count,
            set,
        } = sample;
        let seed = || seed([x, y], set);
        match sampler {
            Sampler::Center => Self::Center,
            Sampler::SineHash => Self::SineHash(index),
            Sampler::Independent => {
                // A pixel has at most 2¹⁶ samples, so that sets do not overlap.
                let index = index.wrapping_add(set.wrapping_mul(1 << 17));
                Self::Independent(pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(index))))))
            }
            Sampler::Stratified => Self::Stratified(Strata::new(index, count, seed())),
            Sampler::Sobol => Self::Sobol {
                index,
                dimension: 0,
                seed: seed(),
                numbers: [0.0; 4],
            },
        }
    }

    /// Returns the offset of the sample from the pixel center, in pixels, in [−½, ½).
    pub(super) fn jitter<T: Real>(&mut self) -> [T; 2] {
        match self {
            Self::Center => [T::zero(); 2],
            Self::SineHash(sample) => sine_hash_jitter(*sample),
            _ => centered(self.next_2d()),
        }
    }

    /// Returns the next number in [0, 1).
    pub(super) fn next_1d<T: Real>(&mut self) -> T {
        T::from_f64(match self {
            // Scenes that need random numbers are rejected with these samplers.
            Self::Center | Self::SineHash(_) => 0.5,
            Self::Independent(state) => {
                *state = pcg(*state);
                unit(*state)
            }
            Self::Stratified(strata) => strata.next_1d(),
            Self::Sobol {
                index,
                dimension,
                seed,
                numbers,
            } => {
                if *dimension == SOBOL_DIMENSIONS {
                    *dimension = 0;
                    *seed = pcg(*seed);
                }
                let (set, at) = (*dimension / 4, *dimension as usize % 4);
                if at == 0 {
                    *numbers = sobol_burley::sample_4d(*index, set, *seed);
                }
                *dimension += 1;
                f64::from(numbers[at])
            }
        })
    }

    /// Returns a point in the unit square, [0, 1)².
    pub(super) fn next_2d<T: Real>(&mut self) -> [T; 2] {
        if let Self::Stratified(strata) = self {
            return strata.next_2d().map(T::from_f64);
        }
        // The first number must be generated first.
        let first = self.next_1d();
        [first, self.next_1d()]
    }

    /// Returns the polar coordinates (r², turn) of a point in the unit disk. The stratified and Sobol
    /// samplers use an area-preserving map that keeps nearby points together; the independent sampler, whose
    /// numbers shaders reproduce, uses the pair itself.
    pub(super) fn next_disk<T: Real>(&mut self) -> [T; 2] {
        let pair = self.next_2d();
        match self {
            Self::Stratified(_) | Self::Sobol { .. } => square_to_disk(pair),
            _ => pair,
        }
    }
}

/// Returns the next number of each lane in `active`.
#[inline(always)]
pub(super) fn next_numbers<T: Real>(streams: &mut [SampleStream], active: u32) -> [T; MAX_LANES] {
    let mut numbers = [T::zero(); MAX_LANES];
    for lane in lanes_of(active) {
        numbers[lane] = streams[lane].next_1d();
    }
    numbers
}

/// Returns the next point in the unit disk of each lane in `active`; see [`SampleStream::next_disk`].
#[inline(always)]
pub(super) fn next_disks<T: Real, S: Lanes<T>>(
    simd: S,
    streams: &mut [SampleStream],
    active: u32,
) -> [Wide<T, S>; 2] {
    let [mut squares, mut turns] = [[T::zero(); MAX_LANES]; 2];
    for lane in lanes_of(active) {
        [squares[lane], turns[lane]] = streams[lane].next_disk();
    }
    [squares, turns].map(|numbers| Wide::load(simd, &numbers))
}

/// Maps the unit square to the unit disk, concentric squares to concentric circles: P. Shirley and K. Chiu,
/// “A Low Distortion Map Between Disk and Square”, 1997. The result is (r², φ/2π), both in [0, 1). The map
/// preserves relative areas.
fn square_to_disk<T: Real>([u, v]: [T; 2]) -> [T; 2] {
    let [eighth, quarter, half, two] = [0.125, 0.25, 0.5, 2.0].map(T::from_f64);
    let (x, y) = (two * u - T::one(), two * v - T::one());
    let (radius, turn) = if x.abs() > y.abs() {
        (x, eighth * (y / x))
    } else if y == T::zero() {
        (y, T::zero())
    } else {
        (y, quarter - eighth * (x / y))
    };
    let turn = if radius < T::zero() { turn + half } else { turn };
    // The edge of the square at 0 is included and maps to r = 1, where lobes have zero density. Clamp r²
    // below 1, the upper bound of all other numbers.
    let below_one = T::one() - half * T::epsilon();
    [(radius * radius).min(below_one), turn - turn.floor()]
}

/// Multiplier of the sine hash, as the course's shaders write it.
const SINE_HASH_MULTIPLIER: f64 = 43_758.545_312_3;

/// Returns two hashed numbers per sample, x first. The seed continues through the samples of a pixel.
fn sine_hash_jitter<T: Real>(sample: u32) -> [T; 2] {
    [0, 1].map(|axis| {
        let seed = f64::from(sample) * 2.0 + f64::from(axis);
        let (sine, _) = T::from_f64(seed).sine_and_cosine();
        let scaled = sine * T::from_f64(SINE_HASH_MULTIPLIER);
        scaled - scaled.floor() - T::from_f64(0.5)
    })
}

/// A sample's index and the grid of cells of all samples of its pixel.
#[derive(Debug, Clone, Copy)]
struct Grid {
    index: u32,
    count: u32,
    /// Number of cells along the first coordinate of a pair; the second has count / columns cells.
    columns: u32,
}

impl Grid {
    fn new(index: u32, count: u32) -> Self {
        // The largest divisor not above the square root: 1 for a prime.
        let columns = (1..=count.isqrt()).rev().find(|side| count.is_multiple_of(*side));
        Self {
            index,
            count,
            columns: columns.unwrap_or(1),
        }
    }

    #[inline(always)]
    fn with_index(self, index: u32) -> Self {
        Self { index, ..self }
    }

    /// Returns the jittered point in a cell.
    #[inline(always)]
    fn pair(self, cell: u32, seed: u32) -> [f64; 2] {
        let columns = f64::from(self.columns);
        // Exact: a quotient that is not an integer is farther from the next integer than its rounding error.
        let row = f64::from((f64::from(cell) / columns) as u32);
        let column = f64::from(cell) - row * columns;
        let rows = f64::from(self.count) / columns;
        [
            (column + self.cell_offset(0, seed)) / columns,
            (row + self.cell_offset(1, seed)) / rows,
        ]
    }

    /// Returns the offset within a cell, in [0, 1).
    #[inline(always)]
    fn cell_offset(self, axis: u32, seed: u32) -> f64 {
        unit(pcg(seed.wrapping_add(pcg(2 * self.index + axis))))
    }
}

/// The stratified numbers of one sample: a different cell for each of them.
#[derive(Debug, Clone)]
pub(super) struct Strata {
    grid: Grid,
    /// Hashed for each number or pair.
    seed: u32,
}

impl Strata {
    fn new(index: u32, count: u32, seed: u32) -> Self {
        Self {
            grid: Grid::new(index, count),
            seed,
        }
    }

    fn next_1d(&mut self) -> f64 {
        let cell = self.cell();
        (f64::from(cell) + self.grid.cell_offset(0, self.seed)) / f64::from(self.grid.count)
    }

    fn next_2d(&mut self) -> [f64; 2] {
        let cell = self.cell();
        self.grid.pair(cell, self.seed)
    }

    /// Returns the cell of the sample for its next number.
    fn cell(&mut self) -> u32 {
        self.seed = pcg(self.seed);
        permute(self.grid.index, self.grid.count, self.seed)
    }

    /// Returns the streams of samples of several pixels, by their indices and pixels, after their first pair,
    /// and those pairs.
    pub(super) fn first_pairs(
        level: Level,
        [count, set]: [u32; 2],
        indices: &[u32; PACKET_RAYS],
        pixels: &[[u32; PACKET_RAYS]; 2],
    ) -> ([Self; PACKET_RAYS], [[f64; PACKET_RAYS]; 2]) {
        let grid = Grid::new(0, count);
        let mut pairs = [[0.0; PACKET_RAYS]; 2];
        let seeds = f64::run(
            level,
            FirstPairs {
                grid,
                set,
                indices,
                pixels,
                pairs: &mut pairs,
            },
        );
        let strata = |at: usize| Self {
            grid: grid.with_index(indices[at]),
            seed: seeds[at],
        };
        (std::array::from_fn(strata), pairs)
    }
}

/// Kernel for the first pairs of several pixels; the compiler vectorizes it.
struct FirstPairs<'a> {
    grid: Grid,
    set: u32,
    indices: &'a [u32; PACKET_RAYS],
    pixels: &'a [[u32; PACKET_RAYS]; 2],
    pairs: &'a mut [[f64; PACKET_RAYS]; 2],
}

impl Kernel<f64> for FirstPairs<'_> {
    /// The seeds after the first pairs.
    type Output = [u32; PACKET_RAYS];

    #[inline(always)]
    fn run<S: Lanes<f64>>(self, _: S) -> [u32; PACKET_RAYS] {
        let Self {
            grid,
            set,
            indices,
            pixels,
            ..
        } = self;
        let (mut seeds, mut cells) = ([0; PACKET_RAYS], [0; PACKET_RAYS]);
        let scramble = Scramble::new(grid.count);
        for at in 0..PACKET_RAYS {
            seeds[at] = pcg(seed([pixels[0][at], pixels[1][at]], set));
            cells[at] = scramble.apply(indices[at], seeds[at]);
        }
        while cells.iter().fold(0, |most, &cell| most.max(cell)) >= grid.count {
            for at in 0..PACKET_RAYS {
                let again = scramble.apply(cells[at], seeds[at]);
                cells[at] = if cells[at] < grid.count { cells[at] } else { again };
            }
        }
        for at in 0..PACKET_RAYS {
            [self.pairs[0][at], self.pairs[1][at]] = grid.with_index(indices[at]).pair(cells[at], seeds[at]);
        }
        seeds
    }
}

/// Maps `index` by the permutation of 0 … count − 1 that the seed selects: a bijection of the next power of
/// two, applied until the value is in range (cycle walking).
fn permute(index: u32, count: u32, seed: u32) -> u32 {
    let scramble = Scramble::new(count);
    let mut value = index;
    loop {
        value = scramble.apply(value, seed);
        if value < count {
            return value;
        }
    }
}

/// Bijections of the smallest power of two not below a count.
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
    fn apply(self, mut value: u32, seed: u32) -> u32 {
        let mut key = seed;
        for _ in 0..4 {
            key = pcg(key);
            // Each step is invertible modulo the power of two.
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

    const COUNT: u32 = 64;

    fn stream(sampler: Sampler, index: u32) -> SampleStream {
        let sample = Sample {
            pixel: [7, 11],
            index,
            count: COUNT,
            set: 0,
        };
        SampleStream::new(sampler, sample)
    }

    #[test]
    fn independent_sampler_matches_its_documentation() {
        let mut state = pcg(7 + pcg(11u32.wrapping_add(pcg(3))));
        let mut stream = stream(Sampler::Independent, 3);
        for _ in 0..5 {
            state = pcg(state);
            assert_eq!(stream.next_1d::<f64>(), f64::from(state >> 8) / 16_777_216.0);
        }
    }

    #[test]
    fn pairs_are_evenly_distributed_over_quarters() {
        for (sampler, tolerance) in [
            (Sampler::Independent, 12),
            (Sampler::Stratified, 0),
            (Sampler::Sobol, 0),
        ] {
            for skipped in 0..3 {
                let mut counts = [0u32; 16];
                for index in 0..COUNT {
                    let mut stream = stream(sampler, index);
                    for _ in 0..skipped {
                        let _: [f64; 2] = stream.next_2d();
                    }
                    let [u, v]: [f64; 2] = stream.next_2d();
                    assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v));
                    counts[(u * 4.0) as usize + 4 * (v * 4.0) as usize] += 1;
                }
                for count in counts {
                    assert!(
                        count.abs_diff(COUNT / 16) <= tolerance,
                        "{sampler:?} {skipped}: {counts:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn square_to_disk_preserves_area_and_adjacency() {
        let side = 64u32;
        let place = |i: u32, j: u32| square_to_disk([i, j].map(|at| (f64::from(at) + 0.5) / f64::from(side)));
        let mut counts = [[0u32; 4]; 8];
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let [r2, turn] = place(i, j);
            assert!((0.0..1.0).contains(&r2) && (0.0..1.0).contains(&turn));
            counts[(turn * 8.0) as usize][(r2.sqrt() * 4.0) as usize] += 1;
            let at = |[r2, turn]: [f64; 2]| {
                let (sine, cosine) = (std::f64::consts::TAU * turn).sin_cos();
                [r2.sqrt() * cosine, r2.sqrt() * sine]
            };
            let ([x, y], [u, v]) = (at([r2, turn]), at(place(i, (j + 1).min(side - 1))));
            assert!((x - u).hypot(y - v) < 2.6 / f64::from(side), "{i} {j}");
        }
        // Rings of equal width, whose areas are proportional to the odd numbers. Cells on a diagonal count to
        // one side of it.
        for ring in 0..4u32 {
            let expected = (2 * ring + 1) * side * side / 128;
            for eighth in counts {
                assert!(eighth[ring as usize].abs_diff(expected) <= side / 8, "{counts:?}");
            }
        }
    }

    #[test]
    fn pairs_of_one_sample_are_uncorrelated() {
        for sampler in [Sampler::Independent, Sampler::Stratified, Sampler::Sobol] {
            let mut sum = 0.0;
            for index in 0..COUNT {
                let mut stream = stream(sampler, index);
                let [u, _]: [f64; 2] = stream.next_2d();
                let [v, _]: [f64; 2] = stream.next_2d();
                sum += (u - 0.5) * (v - 0.5);
            }
            // The variance of the product is 1/144.
            let correlation = sum / f64::from(COUNT) * 12.0;
            assert!(correlation.abs() < 0.4, "{sampler:?}: {correlation}");
        }
    }

    #[test]
    fn sobol_numbers_are_those_of_their_dimensions() {
        let mut stream = stream(Sampler::Sobol, 5);
        let mut seed = seed([7, 11], 0);
        for dimension in (0..SOBOL_DIMENSIONS).chain(0..9) {
            let expected = f64::from(sobol_burley::sample(5, dimension, seed));
            assert_eq!(stream.next_1d::<f64>(), expected, "{dimension}");
            if dimension == SOBOL_DIMENSIONS - 1 {
                seed = pcg(seed);
            }
        }
    }

    #[test]
    fn permute_is_a_bijection() {
        for count in [1, 2, 3, 10, 16, 37, 1000] {
            for seed in 0..20 {
                let mut seen: Vec<_> = (0..count).map(|index| permute(index, count, seed)).collect();
                seen.sort_unstable();
                assert!(seen.into_iter().eq(0..count), "{count} {seed}");
            }
        }
    }

    #[test]
    fn every_stratum_is_sampled_once() {
        for count in [1u32, 6, 7, 16] {
            let mut ones: Vec<_> = (0..count)
                .map(|index| (Strata::new(index, count, 5).next_1d() * f64::from(count)) as u32)
                .collect();
            ones.sort_unstable();
            assert!(ones.into_iter().eq(0..count));
        }
    }

    #[test]
    fn batched_first_pairs_match_single_pixels() {
        let pixels = [
            std::array::from_fn(|at| at as u32 % 8),
            std::array::from_fn(|at| at as u32 / 8),
        ];
        for (count, level) in [1u32, 6, 7, 16, 37]
            .into_iter()
            .flat_map(|count| Level::all().map(move |level| (count, level)))
        {
            for first in [0, count / 2, count - 1] {
                let indices = std::array::from_fn(|at| (first + at as u32 % 3) % count);
                let (mut strata, pairs) = Strata::first_pairs(level, [count, 3], &indices, &pixels);
                for at in 0..PACKET_RAYS {
                    let mut single = Strata::new(indices[at], count, seed([pixels[0][at], pixels[1][at]], 3));
                    assert_eq!(
                        [pairs[0][at], pairs[1][at]],
                        single.next_2d(),
                        "{count} {first} {level:?}"
                    );
                    assert_eq!(strata[at].next_1d(), single.next_1d(), "the next number");
                }
            }
        }
    }
}
