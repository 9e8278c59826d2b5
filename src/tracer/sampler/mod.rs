//! Where in a pixel its samples lie, and the numbers that lights and surfaces draw for them.

mod sine_hash;
mod stratified;

use toyproof_image::pcg;
use toyproof_scene::{Sampler, unit};

pub(super) use self::stratified::Strata;
use super::real::Real;

/// A sample of a picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    pub(super) pixel: [u32; 2],
    /// Which of the pixel's samples, from 0, of how many.
    pub(super) index: u32,
    pub(super) count: u32,
    /// The same samples of another set have nothing to do with these.
    pub(super) set: u32,
}

/// The numbers of one sample, in the order in which they are drawn: the place in the pixel comes first.
#[derive(Debug, Clone)]
pub(super) enum Draws {
    /// At the centre, and nothing more.
    Center,
    /// As the course draws it; the number is the sample's.
    SineHash(u32),
    /// The state starts as `pcg(x + pcg(y + pcg(index)))`, x and y the pixel's; each draw puts its hash in its
    /// place and takes the upper 24 bits.
    Independent(u32),
    Stratified(Strata),
    Sobol {
        index: u32,
        dimension: u32,
        seed: u32,
    },
}

/// Sobol's sequence is tabulated for as many dimensions; a path that draws more than that starts over with another
/// seed.
const DIMENSIONS: u32 = sobol_burley::NUM_DIMENSIONS;

/// What the draws of all samples of a pixel are made of, for each set of samples.
#[inline]
fn seed([x, y]: [u32; 2], set: u32) -> u32 {
    pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(set)))))
}

/// From the middle of a square to a place in it.
#[inline]
pub(super) fn offset<T: Real>(place: [f64; 2]) -> [T; 2] {
    place.map(|along| T::from_f64(along) - T::from_f64(0.5))
}

impl Draws {
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
                let index = index.wrapping_add(set.wrapping_mul(1 << 17));
                Self::Independent(pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(index))))))
            }
            Sampler::Stratified => Self::Stratified(Strata::new(index, count, seed())),
            Sampler::Sobol => Self::Sobol {
                index,
                dimension: 0,
                seed: seed(),
            },
        }
    }

    /// The sample's offset from the pixel's centre, in pixels, in [−½, ½).
    pub(super) fn jitter<T: Real>(&mut self) -> [T; 2] {
        match self {
            Self::Center => [T::zero(); 2],
            Self::SineHash(sample) => sine_hash::jitter(*sample),
            _ => offset(self.pair()),
        }
    }

    /// A number in [0, 1).
    pub(super) fn number<T: Real>(&mut self) -> T {
        T::from_f64(match self {
            // A scene in which anything draws from these is refused.
            Self::Center | Self::SineHash(_) => 0.5,
            Self::Independent(state) => {
                *state = pcg(*state);
                unit(*state)
            }
            Self::Stratified(strata) => strata.number(),
            Self::Sobol {
                index,
                dimension,
                seed,
            } => {
                if *dimension == DIMENSIONS {
                    *dimension = 0;
                    *seed = pcg(*seed);
                }
                *dimension += 1;
                f64::from(sobol_burley::sample(*index, *dimension - 1, *seed))
            }
        })
    }

    /// Two numbers in [0, 1) that belong together.
    pub(super) fn pair<T: Real>(&mut self) -> [T; 2] {
        if let Self::Stratified(strata) = self {
            return strata.pair().map(T::from_f64);
        }
        // The first is drawn first.
        let first = self.number();
        [first, self.number()]
    }

    /// A pair that is taken as a place in a disk: (r², the turn). What is spread evenly over the square is so over the disk,
    /// and what lies close together stays so, as long as nobody else is to draw the same.
    pub(super) fn polar<T: Real>(&mut self) -> [T; 2] {
        let pair = self.pair();
        match self {
            Self::Stratified(_) | Self::Sobol { .. } => concentric(pair),
            _ => pair,
        }
    }
}

/// Takes the square to the disk, squares around the middle to circles: P. Shirley and K. Chiu, “A Low Distortion Map
/// Between Disk and Square”, 1997. The place in the disk is (r², φ/2π), both in [0, 1), and every part of the square
/// keeps its area.
fn concentric<T: Real>([u, v]: [T; 2]) -> [T; 2] {
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
    // The square's edge at 0 belongs to it, and there r is 1, which no number that is drawn is: lobes have no density there.
    let below_one = T::one() - half * T::epsilon();
    [(radius * radius).min(below_one), turn - turn.floor()]
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: u32 = 64;

    fn draws(sampler: Sampler, index: u32) -> Draws {
        let sample = Sample {
            pixel: [7, 11],
            index,
            count: COUNT,
            set: 0,
        };
        Draws::new(sampler, sample)
    }

    #[test]
    fn the_independent_sampler_draws_what_the_documentation_says() {
        let mut state = pcg(7 + pcg(11u32.wrapping_add(pcg(3))));
        let mut draws = draws(Sampler::Independent, 3);
        for _ in 0..5 {
            state = pcg(state);
            assert_eq!(draws.number::<f64>(), f64::from(state >> 8) / 16_777_216.0);
        }
    }

    #[test]
    fn every_quarter_holds_its_share_of_every_pair() {
        for (sampler, room) in [
            (Sampler::Independent, 12),
            (Sampler::Stratified, 0),
            (Sampler::Sobol, 0),
        ] {
            for skipped in 0..3 {
                let mut counts = [0u32; 16];
                for index in 0..COUNT {
                    let mut draws = draws(sampler, index);
                    for _ in 0..skipped {
                        let _: [f64; 2] = draws.pair();
                    }
                    let [u, v]: [f64; 2] = draws.pair();
                    assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v));
                    counts[(u * 4.0) as usize + 4 * (v * 4.0) as usize] += 1;
                }
                for count in counts {
                    assert!(
                        count.abs_diff(COUNT / 16) <= room,
                        "{sampler:?} {skipped}: {counts:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_disk_is_filled_evenly_and_neighbours_stay_so() {
        let side = 64u32;
        let place = |i: u32, j: u32| concentric([i, j].map(|at| (f64::from(at) + 0.5) / f64::from(side)));
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
        // Rings of one width, whose areas are as the odd numbers; the cells on a diagonal belong to one side of it.
        for ring in 0..4u32 {
            let even = (2 * ring + 1) * side * side / 128;
            for eighth in counts {
                assert!(eighth[ring as usize].abs_diff(even) <= side / 8, "{counts:?}");
            }
        }
    }

    #[test]
    fn two_pairs_of_one_sample_are_not_tied_to_each_other() {
        for sampler in [Sampler::Independent, Sampler::Stratified, Sampler::Sobol] {
            let mut sum = 0.0;
            for index in 0..COUNT {
                let mut draws = draws(sampler, index);
                let [u, _]: [f64; 2] = draws.pair();
                let [v, _]: [f64; 2] = draws.pair();
                sum += (u - 0.5) * (v - 0.5);
            }
            // The variance of the product is 1/144.
            let correlation = sum / f64::from(COUNT) * 12.0;
            assert!(correlation.abs() < 0.4, "{sampler:?}: {correlation}");
        }
    }
}
