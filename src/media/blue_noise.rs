//! Blue noise: evenly scattered numbers, of which neighbors differ.

use rayon::prelude::*;
use toyproof_image::{Image, pcg};

/// The side of the tile that is computed; the texture repeats it.
const TILE: usize = 128;
const TEXELS: usize = TILE * TILE;
/// How far a point counts as crowding another, in texels.
const REACH: isize = 7;

/// 1024×1024 texels of four independent components, each with every 8-bit value equally often.
pub(crate) fn blue_noise() -> Image {
    const SIDE: usize = 1024;
    let tiles: Vec<Vec<u16>> = (0..4_u32).into_par_iter().map(ranks).collect();
    let tile: Vec<[f32; 4]> = (0..TEXELS)
        .map(|at| {
            let level = |component: usize| usize::from(tiles[component][at]) * 256 / TEXELS;
            [0, 1, 2, 3].map(|component| level(component) as f32 / 255.0)
        })
        .collect();
    let pixels = (0..SIDE).flat_map(|y| {
        let row = &tile[y % TILE * TILE..][..TILE];
        (0..SIDE).map(move |x| row[x % TILE])
    });
    Image::new(SIDE as u32, SIDE as u32, pixels.collect())
}

/// The ranks of a tile's texels by the void-and-cluster method of Ulichney, “The void-and-cluster method for
/// dither array generation”, 1993.
fn ranks(seed: u32) -> Vec<u16> {
    let mut points = Points::new();
    // A tenth of the texels at random.
    let mut random = seed;
    while points.count < TEXELS / 10 {
        random = pcg(random ^ 0x5bd1_e995);
        let at = random as usize % TEXELS;
        if !points.is_set[at] {
            points.toggle(at);
        }
    }
    // Points move from the tightest cluster to the largest void, as long as that lowers the energy.
    loop {
        let cluster = points.tightest_cluster();
        points.toggle(cluster);
        let void = points.largest_void();
        if points.energy[void] >= points.energy[cluster] {
            points.toggle(cluster);
            break;
        }
        points.toggle(void);
    }
    let mut ranks = vec![0; TEXELS];
    let mut removed = points.clone();
    for rank in (0..points.count).rev() {
        let cluster = removed.tightest_cluster();
        removed.toggle(cluster);
        ranks[cluster] = rank as u16;
    }
    for rank in points.count..TEXELS {
        let void = points.largest_void();
        points.toggle(void);
        ranks[void] = rank as u16;
    }
    ranks
}

/// A set of texels, with the energy that they cause at each texel.
#[derive(Clone)]
struct Points {
    is_set: Vec<bool>,
    /// In units that make sums exact, so that adding and removing a point restores them.
    energy: Vec<i32>,
    count: usize,
    kernel: Vec<i32>,
    /// The extremes of each row: the texel of highest energy in the set, and that of lowest energy outside.
    rows: Vec<[Option<usize>; 2]>,
}

impl Points {
    fn new() -> Self {
        Self {
            is_set: vec![false; TEXELS],
            energy: vec![0; TEXELS],
            count: 0,
            kernel: kernel(),
            rows: (0..TILE).map(|row| [None, Some(row * TILE)]).collect(),
        }
    }

    fn tightest_cluster(&self) -> usize {
        let in_rows = self.rows.iter().filter_map(|row| row[0]);
        // Of equal energies, the first.
        in_rows
            .rev()
            .max_by_key(|&at| self.energy[at])
            .expect("the set is not empty")
    }

    fn largest_void(&self) -> usize {
        let in_rows = self.rows.iter().filter_map(|row| row[1]);
        in_rows
            .min_by_key(|&at| self.energy[at])
            .expect("the set is not full")
    }

    /// Adds a texel to the set, or removes it.
    fn toggle(&mut self, at: usize) {
        let is_added = !self.is_set[at];
        self.is_set[at] = is_added;
        self.count = if is_added { self.count + 1 } else { self.count - 1 };
        let [x, y] = [(at % TILE) as isize, (at / TILE) as isize];
        let side = TILE as isize;
        for dy in -REACH..=REACH {
            let row = (y + dy).rem_euclid(side) as usize;
            let column = |dx: isize| (x + dx).rem_euclid(side) as usize;
            let kernel = (dy + REACH) * (2 * REACH + 1) + REACH;
            for dx in -REACH..=REACH {
                let energy = self.kernel[(kernel + dx) as usize];
                self.energy[row * TILE + column(dx)] += if is_added { energy } else { -energy };
            }
            let has_changed = |extreme: &usize| {
                let distance = (*extreme % TILE).abs_diff(at % TILE);
                distance.min(TILE - distance) <= REACH as usize
            };
            if self.rows[row].iter().flatten().any(has_changed) {
                self.rows[row] = [None; 2];
                (0..TILE).for_each(|x| self.consider(row, x));
            } else {
                // All others are as they were.
                (-REACH..=REACH).for_each(|dx| self.consider(row, column(dx)));
            }
        }
    }

    /// Makes a texel an extreme of its row if it is more extreme.
    fn consider(&mut self, row: usize, x: usize) {
        let at = row * TILE + x;
        let (energy, is_set) = (&self.energy, self.is_set[at]);
        let extreme = &mut self.rows[row][usize::from(!is_set)];
        let is_better = extreme.is_none_or(|extreme| {
            if is_set {
                energy[at] > energy[extreme]
            } else {
                energy[at] < energy[extreme]
            }
        });
        if is_better {
            *extreme = Some(at);
        }
    }
}

/// A Gaussian of the standard deviation 1.9 texels, as integers. The binomial coefficients of 14 approximate
/// it without an exponential function.
fn kernel() -> Vec<i32> {
    let mut binomial = [0_i32; 2 * REACH as usize + 1];
    binomial[0] = 1;
    for row in 1..binomial.len() {
        for at in (1..=row).rev() {
            binomial[at] += binomial[at - 1];
        }
    }
    // All products together are 2²⁸, so that sums of them fit.
    binomial
        .iter()
        .flat_map(|a| binomial.iter().map(move |b| a * b))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_is_equally_frequent() {
        let image = blue_noise();
        for component in 0..4 {
            let mut counts = [0; 256];
            for pixel in image.pixels() {
                counts[(pixel[component] * 255.0).round() as usize] += 1;
            }
            assert_eq!(counts, [4096; 256]);
        }
    }

    #[test]
    fn neighbors_differ_more_than_those_of_white_noise() {
        let image = blue_noise();
        for component in 0..4 {
            // The variance of means of 4×4 texels: 1/12 / 16 for white noise.
            let mean = |x: u32, y: u32| {
                let texels = (0..4).flat_map(|dy| (0..4).map(move |dx| (x + dx, y + dy)));
                texels.map(|(x, y)| image.get(x, y)[component]).sum::<f32>() / 16.0
            };
            let means: Vec<_> = (0..32)
                .flat_map(|y| (0..32).map(move |x| mean(4 * x, 4 * y)))
                .collect();
            let variance =
                means.iter().map(|mean| (mean - 0.5) * (mean - 0.5)).sum::<f32>() / means.len() as f32;
            let white = 1.0 / 12.0 / 16.0;
            assert!(variance < 0.25 * white, "{variance} of {white}");
        }
    }
}
