//! Several pictures of a shader, each with other random numbers, at places from all over a frame.

use std::time::Instant;

use rayon::prelude::*;
use toyproof_eval::{Places, Program, Settings, Variant};
use toyproof_image::Image;
use toyproof_tracer::Tracer;

use super::reseed::{Reseeding, is_without_chance};
use super::{Asked, Case};
use crate::compare::{
    EXACT_TOLERANCE, MAX_DIFFERING, REPLICATES, Replicated, ReplicatedPixel, Standing, replicated,
};
use crate::mistake::NoisyPixel;

/// So many further pictures say what each pixel counts, so that what is compared has no part in it.
const WEIGHING: usize = 4;

/// The tracer's sets of samples: by these pixels are chosen and weighed, and these two halves make the means.
const CHOOSING: std::ops::Range<u32> = 1..9;
const HALVES: [std::ops::Range<u32>; 2] = [9..13, 13..17];

/// A picture takes so many samples or paths at most, and has so many pixels.
const SAMPLES: u32 = 1 << 18;
const PATHS: u32 = 1 << 17;
const PIXELS: u32 = 1 << 15;

/// Pixels count as if their noise were at least this: what eight sets of samples happen not to see is not seen by others either.
const LEAST_NOISE: f64 = 0.01;

/// A sample brings no more than this; beyond lies what a tone curve has lost the digits of.
const MOST: f64 = 1e4;

/// If fewer of the pixels that are random in the scene change, a shader was not given other random numbers. Where a rare event decides, as that a
/// direction meets a lamp, most of them do not.
const LEAST_CHANGED: f64 = 0.1;

/// With other random numbers, a shader is about as far from the reference as with its own: its squares are within this factor.
const SAME_DISTANCE: f64 = 2.0;

/// A pixel that is the same with all of a shader's random numbers may still be so by chance if it is within so many standard deviations of
/// those around it.
const RARE: f64 = 3.0;

/// Why there is nothing to compare by chance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unfit {
    /// The shader differs in pixels that are random neither in the scene nor in the shader.
    Fixed,
    /// The shader draws the scene's own numbers: its noise is the reference's, and its pixels are to be those of the scene.
    Follows,
    /// No way was found to give the shader other random numbers, or there was no time.
    Unsalted,
}

/// What the pixels of some places are for the tracer.
struct Drawn {
    /// Means of samples, for each set of [`CHOOSING`].
    choosing: Vec<[f64; 3]>,
    halves: [[f64; 3]; 2],
    /// Of one set of samples, by those of the halves.
    variance: [f64; 3],
}

impl Drawn {
    fn at(tracer: &Tracer<f64>, pixel: [u32; 2]) -> Self {
        let sets = |sets: std::ops::Range<u32>| -> Vec<[f64; 3]> {
            sets.map(|set| tracer.redrawn_mean(pixel, set)).collect()
        };
        let halves = HALVES.map(sets);
        let all = halves.concat();
        Self {
            choosing: sets(CHOOSING),
            variance: variance(&all),
            halves: halves.map(|half| mean(&half)),
        }
    }

    fn mean(&self) -> [f64; 3] {
        mean(&self.halves)
    }

    /// Whether chance decides about its color.
    fn moves(&self, tracer: &Tracer<f64>) -> bool {
        let first = tracer.developed(self.choosing[0]);
        let mut others = self.choosing.iter().chain(&self.halves);
        others.any(|&other| differ(first, tracer.developed(other)))
    }
}

fn mean(all: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|i| all.iter().map(|each| each[i]).sum::<f64>() / all.len() as f64)
}

fn variance(all: &[[f64; 3]]) -> [f64; 3] {
    let mean = mean(all);
    [0, 1, 2].map(|i| {
        let squares = all.iter().map(|each| (each[i] - mean[i]).powi(2));
        squares.sum::<f64>() / (all.len() - 1) as f64
    })
}

fn differ(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).any(|i| (a[i] - b[i]).abs() > EXACT_TOLERANCE)
}

/// Compares a shader that differs from its scene with it, where chance decides.
///
/// # Errors
/// Why that cannot be done.
pub(super) fn compared(
    program: &Program,
    case: &Case,
    tracer: &Tracer<f64>,
    maths: &Asked,
    until: Instant,
) -> Result<Compared, Unfit> {
    let shader = Shader {
        program,
        case,
        tracer,
        places: places(case.frame.size, tracer),
        until,
    };
    let usual = shader.usual().ok_or(Unfit::Unsalted)?;
    let [columns, rows] = shader.places.pixels();
    let pixels = rows.iter().flat_map(|&y| columns.iter().map(move |&x| [x, y]));
    let pixels: Vec<[u32; 2]> = pixels.collect();
    let drawn: Vec<Drawn> = pixels.par_iter().map(|&pixel| Drawn::at(tracer, pixel)).collect();
    let moves: Vec<bool> = drawn.par_iter().map(|drawn| drawn.moves(tracer)).collect();
    if follows(tracer, &pixels, &usual, &drawn) {
        return Err(Unfit::Follows);
    }
    let compare = |(reseeding, sets)| shader.compare(reseeding, sets, &pixels, &drawn, &moves, maths);
    let mut first = None;
    // A salt may take from a hash what tells neighbors apart, where another does not.
    for reseeding in Reseeding::all() {
        let Some(sets) = shader.replicates(reseeding, &usual, &drawn, &moves) else {
            continue;
        };
        let compared = compare((reseeding, sets));
        if compared
            .as_ref()
            .is_ok_and(|compared| !compared.replicated.is_repeated)
        {
            return compared;
        }
        first.get_or_insert(compared);
    }
    if first.is_none() && is_without_chance(case.checked) {
        // Nothing is random in it: it is the same with any numbers.
        let [.., untouched] = Reseeding::all();
        first = Some(compare((untouched, vec![usual; REPLICATES + WEIGHING])));
    }
    first.unwrap_or(Err(Unfit::Unsalted))
}

/// So many places a side are looked at to see whether a shader is random at all.
const GLANCE: u32 = 32;

/// With other random numbers, a random pixel moves by more than this: more than it does where its place moves by a thousandth of a pixel.
const MOVES: f64 = 20.0 * EXACT_TOLERANCE;

/// Whether enough of the pixels that differ are random in the shader.
pub(super) fn is_random(
    program: &Program,
    case: &Case,
    tracer: &Tracer<f64>,
    maths: &Asked,
    until: Instant,
) -> bool {
    let size = case.frame.size;
    let shader = Shader {
        program,
        case,
        tracer,
        places: Places::spread(size, [GLANCE; 2]),
        until,
    };
    let Some(usual) = shader.usual() else {
        return false;
    };
    let [columns, rows] = shader.places.pixels();
    let differs = |at: usize| {
        let [x, y] = [columns[at % columns.len()], rows[at / columns.len()]];
        let standing = maths.standings[y as usize * size[0] as usize + x as usize];
        matches!(standing, Standing::Differs | Standing::Undecided)
    };
    let differing: Vec<usize> = (0..usual.len()).filter(|&at| differs(at)).collect();
    Reseeding::all().into_iter().any(|reseeding| {
        shader.salted(reseeding, 1).is_some_and(|other| {
            let moves = |&&at: &&usize| {
                let [a, b] = [&usual, &other].map(|own| own[at].developed);
                (0..3).any(|i| (a[i] - b[i]).abs() > MOVES)
            };
            let moved = differing.iter().filter(moves).count();
            moved > 0 && moved as f64 >= LEAST_CHANGED * differing.len() as f64
        })
    })
}

/// What a comparison found.
pub(super) struct Compared {
    pub(super) replicated: Replicated,
    /// How many pixels were compared.
    pub(super) pixels: usize,
    /// How the shader was given other random numbers.
    pub(super) reseeding: Reseeding,
}

/// The means of a shader and of the tracer at other places, over so many sets of random numbers each.
pub(super) fn noisy(
    program: &Program,
    case: &Case,
    tracer: &Tracer<f64>,
    reseeding: Reseeding,
    places: &Places,
    until: Instant,
) -> Option<Vec<NoisyPixel>> {
    let shader = Shader {
        program,
        case,
        tracer,
        places: places.clone(),
        until,
    };
    let count = 2 * REPLICATES as u32;
    let salted: Option<Vec<Vec<OwnPixel>>> = (1..=count).map(|salt| shader.salted(reseeding, salt)).collect();
    let salted = salted?;
    let [columns, rows] = places.pixels();
    let noisy = (0..columns.len() * rows.len()).into_par_iter().map(|at| {
        let pixel = [columns[at % columns.len()], rows[at / columns.len()]];
        let own: Vec<_> = salted.iter().map(|set| set[at].developed).collect();
        let reference: Vec<_> = (1..=count).map(|set| tracer.redrawn(pixel, set)).collect();
        let variances = [&own, &reference].map(|all| variance(all));
        NoisyPixel {
            own: mean(&own),
            reference: mean(&reference),
            variance: [0, 1, 2].map(|i| (variances[0][i] + variances[1][i]) / f64::from(count)),
        }
    });
    Some(noisy.collect())
}

/// A shader draws the scene's numbers if its noise and the reference's are correlated more than this. It is 0.1 if they have only the mean in
/// common which both are told from.
const THE_SCENES: f64 = 0.5;

/// Whether a shader draws the scene's numbers.
fn follows(tracer: &Tracer<f64>, pixels: &[[u32; 2]], own: &[OwnPixel], drawn: &[Drawn]) -> bool {
    let of_each = (0..pixels.len()).into_par_iter().map(|at| {
        let [x, y] = pixels[at];
        let reference = tracer.undeveloped(tracer.pixel(x, y));
        let (mean, chosen) = (drawn[at].mean(), variance(&drawn[at].choosing));
        let mut sums = [0.0; 3];
        for i in 0..3 {
            let [a, b] = [own[at].mean[i] - mean[i], reference[i] - mean[i]];
            let weight = 1.0 / (chosen[i] + LEAST_NOISE * LEAST_NOISE);
            let terms = [a * a, a * b, b * b].map(|term| if term.is_finite() { weight * term } else { 0.0 });
            (0..3).for_each(|at| sums[at] += terms[at]);
        }
        sums
    });
    let of_each: Vec<[f64; 3]> = of_each.collect();
    let [own, both, reference] = of_each
        .iter()
        .fold([0.0; 3], |sum, each| [0, 1, 2].map(|at| sum[at] + each[at]));
    both > THE_SCENES * (own * reference).sqrt()
}

/// Places from all over a picture.
fn places(size: [u32; 2], tracer: &Tracer<f64>) -> Places {
    let samples = if tracer.traces_paths() { PATHS } else { SAMPLES };
    let most = f64::from((samples / tracer.samples()).clamp(1, PIXELS));
    let all = f64::from(size[0]) * f64::from(size[1]);
    let share = (most / all).sqrt().min(1.0);
    Places::spread(size, size.map(|side| (f64::from(side) * share) as u32))
}

/// A pixel of a shader's.
#[derive(Clone, Copy)]
struct OwnPixel {
    /// As it is shown.
    developed: [f64; 3],
    /// What the mean of its samples must have been.
    mean: [f64; 3],
}

/// A shader at some places.
struct Shader<'a> {
    program: &'a Program,
    case: &'a Case<'a>,
    tracer: &'a Tracer<f64>,
    places: Places,
    until: Instant,
}

impl Shader<'_> {
    fn usual(&self) -> Option<Vec<OwnPixel>> {
        self.picture(self.program, &self.places)
    }

    fn picture(&self, program: &Program, places: &Places) -> Option<Vec<OwnPixel>> {
        let settings = Settings::<f64> {
            variant: Variant::Plain,
            deadline: Some(self.until),
            ..Settings::default()
        };
        let image = program.at(self.case.frame, places, &settings).ok()?;
        Some(self.own_pixels(&image))
    }

    fn own_pixels(&self, image: &Image) -> Vec<OwnPixel> {
        let own = |&[r, g, b, _]: &[f32; 4]| {
            let color = [r, g, b].map(f64::from);
            let mean = self.tracer.undeveloped(color);
            OwnPixel {
                developed: color.map(|part| part.clamp(0.0, 1.0)),
                // NaN becomes the largest number, which nothing agrees with.
                mean: mean.map(|part| if part.abs() < MOST { part } else { MOST }),
            }
        };
        image.pixels().iter().map(own).collect()
    }

    fn salted(&self, reseeding: Reseeding, salt: u32) -> Option<Vec<OwnPixel>> {
        let checked = reseeding.of(self.case.checked, salt);
        let program = Program::prepared(&checked, Variant::Plain).ok()?;
        self.picture(&program, &self.places.shifted(Reseeding::shift(salt)))
    }

    /// Compares the pictures of a reseeding with the tracer's.
    fn compare(
        &self,
        reseeding: Reseeding,
        mut sets: Vec<Vec<OwnPixel>>,
        pixels: &[[u32; 2]],
        drawn: &[Drawn],
        moves: &[bool],
        maths: &Asked,
    ) -> Result<Compared, Unfit> {
        let weighing = sets.split_off(REPLICATES);
        let width = self.case.frame.size[0] as usize;
        let standing = |[x, y]: [u32; 2]| maths.standings[y as usize * width + x as usize];
        let is_random = |at: usize| {
            moves[at]
                || sets
                    .iter()
                    .any(|set| differ(set[at].developed, sets[0][at].developed))
        };
        let spread = smooth(&weighing, self.places.pixels()[0].len());
        // A rare event: the scene's own samples met it and no others did, or the shader's neighbors do now and then.
        let is_rare = |at: usize| {
            let ([x, y], own, drawn) = (pixels[at], &sets[0][at], &drawn[at]);
            let is_noise = |i: usize| {
                (own.mean[i] - drawn.mean()[i]).abs() <= RARE * spread[at][i].sqrt() + EXACT_TOLERANCE
            };
            differ(self.tracer.pixel(x, y), self.tracer.developed(drawn.mean())) || (0..3).all(is_noise)
        };
        let fixed = (0..pixels.len())
            .filter(|&at| standing(pixels[at]) == Standing::Differs && !is_random(at) && !is_rare(at))
            .count();
        if fixed as f64 > (MAX_DIFFERING * pixels.len() as f64).max(1.0) {
            return Err(Unfit::Fixed);
        }
        let clamps = clamps(self.tracer, &sets, drawn);
        let chosen =
            (0..pixels.len()).filter(|&at| is_random(at) && standing(pixels[at]) != Standing::Undefined);
        let replicated_pixels: Vec<ReplicatedPixel> = chosen
            .filter_map(|at| {
                let drawn = &drawn[at];
                let mean = drawn.mean();
                let own: [[f64; 3]; REPLICATES] = std::array::from_fn(|set| sets[set][at].mean);
                if is_white(self.tracer, mean, &own, drawn, clamps) {
                    return None;
                }
                let slope = self.tracer.slope(mean);
                let scaled = |color: [f64; 3]| [0, 1, 2].map(|i| slope[i] * color[i]);
                let squared = |color: [f64; 3]| scaled(scaled(color));
                let chosen = squared(variance(&drawn.choosing));
                let shaders = squared(spread[at]);
                let sets = REPLICATES as f64;
                let single_variance = squared(drawn.variance);
                Some(ReplicatedPixel {
                    at: pixels[at],
                    weight: [0, 1, 2].map(|i| sets / (chosen[i] + shaders[i] + LEAST_NOISE * LEAST_NOISE)),
                    reference: drawn.halves.map(scaled),
                    reference_variance: single_variance.map(|one| one / sets),
                    single_variance,
                    own: own.map(scaled),
                })
            })
            .collect();
        Ok(Compared {
            replicated: replicated(&replicated_pixels, self.case.frame.size),
            pixels: replicated_pixels.len(),
            reseeding,
        })
    }

    /// The usual pixels, and those with other random numbers; none if the reseeding does not give it such.
    fn replicates(
        &self,
        reseeding: Reseeding,
        usual: &[OwnPixel],
        drawn: &[Drawn],
        moves: &[bool],
    ) -> Option<Vec<Vec<OwnPixel>>> {
        let distance = |own: &[OwnPixel]| {
            let pixels = own.iter().zip(drawn).map(|(own, drawn)| {
                let reference = self.tracer.developed(drawn.mean());
                (0..3)
                    .map(|i| (own.developed[i] - reference[i]).powi(2))
                    .sum::<f64>()
            });
            pixels.sum::<f64>()
        };
        let is_changed = |other: &[OwnPixel]| {
            let random = (0..usual.len()).filter(|&at| moves[at]);
            let (mut all, mut changed) = (0, 0);
            for at in random {
                all += 1;
                changed += usize::from(differ(usual[at].developed, other[at].developed));
            }
            changed as f64 >= LEAST_CHANGED * f64::from(all) && all > 0
        };
        let own = distance(usual);
        let is_as_far = |other: &[OwnPixel]| {
            let other = distance(other);
            other <= SAME_DISTANCE * own && own <= SAME_DISTANCE * other
        };
        let first = self.salted(reseeding, 1)?;
        if !is_changed(&first) || !is_as_far(&first) {
            return None;
        }
        let mut all = vec![usual.to_vec(), first];
        for salt in 2..(REPLICATES + WEIGHING) as u32 {
            all.push(self.salted(reseeding, salt).filter(|other| is_as_far(other))?);
        }
        Some(all)
    }
}

/// Variances are told from so many columns and rows of places together.
const SIDE: usize = 4;

/// The variance of a shader's pixels, each with those around it, since few pictures tell little of one.
fn smooth(sets: &[Vec<OwnPixel>], width: usize) -> Vec<[f64; 3]> {
    let count = sets.first().map_or(0, Vec::len);
    let each: Vec<[f64; 3]> = (0..count)
        .map(|at| variance(&sets.iter().map(|set| set[at].mean).collect::<Vec<_>>()))
        .collect();
    let (columns, rows) = (width.div_ceil(SIDE), (count / width.max(1)).div_ceil(SIDE));
    let mut sums = vec![([0.0; 3], 0.0); columns * rows];
    let part = |at: usize| at / width / SIDE * columns + at % width / SIDE;
    for (at, each) in each.iter().enumerate() {
        let (sum, count) = &mut sums[part(at)];
        *count += 1.0;
        for i in 0..3 {
            sum[i] += each[i];
        }
    }
    (0..count)
        .map(|at| {
            let (sum, count) = sums[part(at)];
            sum.map(|sum| sum / count)
        })
        .collect()
}

/// Whether the shader clamps its colors to white, which makes other means of them.
fn clamps(tracer: &Tracer<f64>, sets: &[Vec<OwnPixel>], drawn: &[Drawn]) -> bool {
    let is_above = |color: &[f64; 3]| {
        let developed = tracer.developed(*color);
        (0..3).any(|i| color[i] > 1.0 && developed[i] >= 1.0)
    };
    let shaders = sets.iter().flatten().any(|own| is_above(&own.mean));
    !shaders && drawn.iter().any(|drawn| drawn.choosing.iter().any(is_above))
}

/// Whether a pixel is white on both sides, so that nothing is seen of what differs, or may be for a shader that clamps.
fn is_white(tracer: &Tracer<f64>, mean: [f64; 3], own: &[[f64; 3]], drawn: &Drawn, clamps: bool) -> bool {
    let owns = self::mean(own);
    let [shown, own_shown] = [mean, owns].map(|mean| tracer.developed(mean));
    let is_beyond = |mean: f64, variance: f64| mean + 3.0 * variance.sqrt() > 1.0;
    let variances = [drawn.variance, variance(own)];
    (0..3).any(|i| {
        (shown[i] >= 1.0 && own_shown[i] >= 1.0)
            || (clamps && (is_beyond(mean[i], variances[0][i]) || is_beyond(owns[i], variances[1][i])))
    })
}
