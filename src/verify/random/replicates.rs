//! Replicates of a shader: several evaluations with other random numbers, at pixels spread over a frame.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;
use toyproof_eval::{Places, Settings};
use toyproof_eval_native::Program;
use toyproof_image::Image;

use super::estimates::{
    Estimate, Estimates, StochasticReference, differ_by, differs, mean, of_pixel, pixels, variance,
};
use super::mean_test::{MIN_SHARED_CORRELATION, MIN_STANDARD_DEVIATION};
use super::replicate_test::{REPLICATES, ReplicateTest, ReplicatedPixel, compare_replicates};
use super::reseed::{Reseeding, is_deterministic};
use crate::bounds::MAX_ITERATIONS;
use crate::case::Case;
use crate::compare::{CheckResult, EXACT_TOLERANCE, PixelStatus};
use crate::limits::MAX_DIFFERING;

/// The number of further replicates that estimate the weights of pixels, so that weights are independent of
/// the values that are compared.
const WEIGHT_REPLICATES: usize = 4;

/// The largest mean of samples: above it, the inverse of a tone map has no precision left.
const MAX_SAMPLE_MEAN: f64 = 1e4;

/// The share of the reference's random pixels that must change, or the reseeding had no effect. Most pixels
/// do not change if a rare event decides, such as a direction that hits a lamp.
pub(crate) const MIN_CHANGED_SHARE: f64 = 0.1;

/// The largest ratio of the squared distances from the reference of a shader with other random numbers and
/// with its own.
pub(crate) const MAX_DISTANCE_RATIO: f64 = 2.0;

/// A pixel that is the same in all replicates may still be random if it is within this many standard
/// deviations of its neighbors.
const MAX_RARE_DEVIATION: f64 = 3.0;

/// A pixel of a stochastic shader, over several sets of random numbers. Components are in [0, 1].
#[derive(Debug, Clone, Copy)]
pub struct NoisyPixel {
    /// The shader's sample mean.
    pub own: [f64; 3],
    /// The tracer's sample mean.
    pub reference: [f64; 3],
    /// The variance of the difference of the two means under the hypothesis that their expectations are
    /// equal.
    pub variance: [f64; 3],
}

/// Why a shader cannot be compared by its replicates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Incomparable {
    /// The shader differs in pixels that are random neither in the reference nor in the shader.
    NotRandom,
    /// The shader uses the reference's own random numbers, so that its pixels must be the reference's.
    SameNumbers,
    /// The reference cannot be rendered with other random numbers.
    UnknownNoise,
    /// No reseeding works for the shader.
    NotReseeded,
}

/// The number of columns and of rows of pixels that are sampled to detect whether a shader is random.
pub(crate) const RANDOMNESS_GRID: u32 = 32;

/// The smallest change of a random pixel with other random numbers; moving the pixel by a thousandth of its
/// size changes it less.
pub(crate) const MIN_RANDOM_CHANGE: f64 = 20.0 * EXACT_TOLERANCE;

/// The result of a comparison.
pub(crate) struct ReferenceComparison {
    pub(crate) test: ReplicateTest,
    /// The number of pixels that were compared.
    pub(crate) pixels: usize,
    /// The reseeding of the shader.
    pub(crate) reseeding: Reseeding,
}

/// The number of sets of random numbers in which noisy pixels are sought.
pub const MEAN_SETS: usize = 2 * REPLICATES;

/// A shader that is evaluated with other random numbers, and its reference.
#[derive(Clone, Copy)]
pub(crate) struct ReplicatedShader<'a> {
    pub(crate) program: &'a Program,
    pub(crate) case: &'a Case<'a>,
    pub(crate) reference: &'a dyn StochasticReference,
    pub(crate) deadline: Instant,
}

/// The reference at the pixels at which replicates are compared with it.
struct ReferenceSample {
    places: Places,
    pixels: Vec<[u32; 2]>,
    estimates: Arc<Estimates>,
    /// Whether each pixel depends on random numbers.
    is_random: Vec<bool>,
}

impl ReplicatedShader<'_> {
    /// Compares the replicates of a shader that differs from its reference with those of the reference.
    ///
    /// # Errors
    /// Returns why the shader cannot be compared this way.
    pub(crate) fn compare_with_reference(
        self,
        algorithm: &CheckResult,
    ) -> Result<ReferenceComparison, Incomparable> {
        let reference = self.reference;
        let places = places(self.case.frame.size, reference);
        let unsalted = self.unsalted(&places).ok_or(Incomparable::NotReseeded)?;
        let estimates = reference.estimates(&places).ok_or(Incomparable::UnknownNoise)?;
        let sample = ReferenceSample {
            pixels: pixels(&places),
            is_random: estimates
                .pixels
                .par_iter()
                .map(|estimate| estimate.is_random(reference))
                .collect(),
            places,
            estimates,
        };
        if uses_reference_numbers(reference, &unsalted, &sample.estimates.pixels) {
            return Err(Incomparable::SameNumbers);
        }
        let mut first = None;
        // An added number may make a hash equal in neighboring pixels, where another reseeding does not.
        for reseeding in Reseeding::all() {
            let Some(sets) = self.replicates(&sample, reseeding, &unsalted) else {
                continue;
            };
            let comparison = self.compare(&sample, reseeding, sets, algorithm);
            if comparison
                .as_ref()
                .is_ok_and(|comparison| !comparison.test.is_correlated)
            {
                return comparison;
            }
            first.get_or_insert(comparison);
        }
        if first.is_none() && is_deterministic(self.case.checked) {
            // The shader has no randomness: all replicates are the same.
            let [.., untouched] = Reseeding::all();
            let sets = vec![unsalted; REPLICATES + WEIGHT_REPLICATES];
            first = Some(self.compare(&sample, untouched, sets, algorithm));
        }
        first.unwrap_or(Err(Incomparable::NotReseeded))
    }

    /// The first reseeding that changes some of the differing pixels of a shader, at least this share of
    /// them.
    pub(crate) fn effective_reseeding(self, algorithm: &CheckResult, least: f64) -> Option<Reseeding> {
        let size = self.case.frame.size;
        let places = Places::spread(size, [RANDOMNESS_GRID; 2]);
        let unsalted = self.unsalted(&places)?;
        let differs = |&[x, y]: &[u32; 2]| {
            let status = algorithm.statuses[y as usize * size[0] as usize + x as usize];
            matches!(status, PixelStatus::Differs | PixelStatus::IllConditioned)
        };
        let pixels = pixels(&places);
        let differing: Vec<usize> = (0..pixels.len()).filter(|&at| differs(&pixels[at])).collect();
        Reseeding::all().into_iter().find(|&reseeding| {
            self.salted(&places, reseeding, 1).is_some_and(|other| {
                let changes = |&&at: &&usize| {
                    let [a, b] = [&unsalted, &other].map(|own| own[at].tone_mapped);
                    differ_by(a, b, MIN_RANDOM_CHANGE)
                };
                let changed = differing.iter().filter(changes).count();
                changed > 0 && changed as f64 >= least * differing.len() as f64
            })
        })
    }

    /// The means of a shader and of the reference at other places, each over [`MEAN_SETS`] sets of random
    /// numbers.
    pub(crate) fn noisy_pixels(self, reseeding: Reseeding, places: &Places) -> Option<Vec<NoisyPixel>> {
        let count = MEAN_SETS as u32;
        let tone_mapped = |set: Vec<ShaderPixel>| set.iter().map(|pixel| pixel.tone_mapped).collect();
        let own = (1..=count).map(|salt| self.salted(places, reseeding, salt).map(tone_mapped));
        let own: Vec<Vec<[f64; 3]>> = own.collect::<Option<_>>()?;
        let expected = self.reference.sets(places, count)?;
        let pixels = (0..expected[0].len()).into_par_iter().map(|at| {
            let (own, reference) = (of_pixel(&own, at), of_pixel(&expected, at));
            let variances = [&own, &reference].map(|all| variance(all));
            NoisyPixel {
                own: mean(&own),
                reference: mean(&reference),
                variance: [0, 1, 2].map(|i| (variances[0][i] + variances[1][i]) / f64::from(count)),
            }
        });
        Some(pixels.collect())
    }

    /// The shader's pixels with its own random numbers.
    fn unsalted(&self, places: &Places) -> Option<Vec<ShaderPixel>> {
        let settings = Settings::<f64> {
            max_iterations: MAX_ITERATIONS,
            deadline: Some(self.deadline),
            ..Settings::plain()
        };
        let image = self.program.at(self.case.frame, places, &settings).ok()?;
        Some(self.shader_pixels(&image))
    }

    fn salted(&self, places: &Places, reseeding: Reseeding, salt: u32) -> Option<Vec<ShaderPixel>> {
        let Case { checked, frame, .. } = *self.case;
        let image = reseeding.evaluate(checked, salt, frame, places, Some(self.deadline))?;
        Some(self.shader_pixels(&image))
    }

    fn shader_pixels(&self, image: &Image) -> Vec<ShaderPixel> {
        let own = |&[r, g, b, _]: &[f32; 4]| {
            let color = [r, g, b].map(f64::from);
            let mean = self.reference.inverse_tone_mapped(color);
            ShaderPixel {
                tone_mapped: color.map(|part| part.clamp(0.0, 1.0)),
                // NaN becomes the largest mean, which agrees with nothing.
                mean: mean.map(|part| {
                    if part.abs() < MAX_SAMPLE_MEAN {
                        part
                    } else {
                        MAX_SAMPLE_MEAN
                    }
                }),
            }
        };
        image.pixels().iter().map(own).collect()
    }

    /// Compares the replicates of one reseeding with the reference.
    fn compare(
        &self,
        sample: &ReferenceSample,
        reseeding: Reseeding,
        mut sets: Vec<Vec<ShaderPixel>>,
        algorithm: &CheckResult,
    ) -> Result<ReferenceComparison, Incomparable> {
        let (pixels, estimates) = (&sample.pixels, &sample.estimates.pixels);
        let weight_sets = sets.split_off(REPLICATES);
        let width = self.case.frame.size[0] as usize;
        let status = |[x, y]: [u32; 2]| algorithm.statuses[y as usize * width + x as usize];
        let is_random = |at: usize| {
            sample.is_random[at]
                || sets
                    .iter()
                    .any(|set| differs(set[at].tone_mapped, sets[0][at].tone_mapped))
        };
        let smoothed = smoothed_variance(&weight_sets, sample.places.columns.len());
        // A rare event: it occurs in the reference's own samples and in no other set, or sometimes in the
        // shader's neighboring pixels.
        let is_rare = |at: usize| {
            let (own, estimate) = (&sets[0][at], &estimates[at]);
            let is_noise = |i: usize| {
                (own.mean[i] - estimate.mean()[i]).abs()
                    <= MAX_RARE_DEVIATION * smoothed[at][i].sqrt() + EXACT_TOLERANCE
            };
            differs(estimate.own, self.reference.tone_mapped(estimate.mean())) || (0..3).all(is_noise)
        };
        let fixed = (0..pixels.len())
            .filter(|&at| status(pixels[at]) == PixelStatus::Differs && !is_random(at) && !is_rare(at))
            .count();
        if fixed as f64 > (MAX_DIFFERING * pixels.len() as f64).max(1.0) {
            return Err(Incomparable::NotRandom);
        }
        let clamps_samples = clamps_samples(self.reference, &sets, estimates);
        let selected =
            (0..pixels.len()).filter(|&at| is_random(at) && status(pixels[at]) != PixelStatus::Undefined);
        let replicated_pixels: Vec<ReplicatedPixel> = selected
            .filter_map(|at| {
                let estimate = &estimates[at];
                let mean = estimate.mean();
                let own: [[f64; 3]; REPLICATES] = std::array::from_fn(|set| sets[set][at].mean);
                if is_white(self.reference, mean, &own, estimate, clamps_samples) {
                    return None;
                }
                let slope = self.reference.slope(mean);
                let scaled = |color: [f64; 3]| [0, 1, 2].map(|i| slope[i] * color[i]);
                let squared = |color: [f64; 3]| scaled(scaled(color));
                let selected = squared(variance(&estimate.selection));
                let shader_variance = squared(smoothed[at]);
                let sets = REPLICATES as f64;
                let single_variance = squared(estimate.variance);
                Some(ReplicatedPixel {
                    at: pixels[at],
                    weight: [0, 1, 2].map(|i| {
                        sets / (selected[i]
                            + shader_variance[i]
                            + MIN_STANDARD_DEVIATION * MIN_STANDARD_DEVIATION)
                    }),
                    reference: estimate.halves.map(scaled),
                    reference_variance: single_variance.map(|one| one / sets),
                    single_variance,
                    own: own.map(scaled),
                })
            })
            .collect();
        Ok(ReferenceComparison {
            test: compare_replicates(
                &replicated_pixels,
                self.case.frame.size,
                sample.estimates.are_correlated,
            ),
            pixels: replicated_pixels.len(),
            reseeding,
        })
    }

    /// The shader's own pixels and its replicates; `None` if the reseeding does not change the random numbers
    /// alone.
    fn replicates(
        &self,
        sample: &ReferenceSample,
        reseeding: Reseeding,
        unsalted: &[ShaderPixel],
    ) -> Option<Vec<Vec<ShaderPixel>>> {
        let distance = |own: &[ShaderPixel]| {
            let pixels = own.iter().zip(&sample.estimates.pixels).map(|(own, estimate)| {
                let reference = self.reference.tone_mapped(estimate.mean());
                (0..3)
                    .map(|i| (own.tone_mapped[i] - reference[i]).powi(2))
                    .sum::<f64>()
            });
            pixels.sum::<f64>()
        };
        let is_changed = |other: &[ShaderPixel]| {
            let random = (0..unsalted.len()).filter(|&at| sample.is_random[at]);
            let (mut all, mut changed) = (0, 0);
            for at in random {
                all += 1;
                changed += usize::from(differs(unsalted[at].tone_mapped, other[at].tone_mapped));
            }
            changed as f64 >= MIN_CHANGED_SHARE * f64::from(all) && all > 0
        };
        let own = distance(unsalted);
        let is_as_far = |other: &[ShaderPixel]| {
            let other = distance(other);
            other <= MAX_DISTANCE_RATIO * own && own <= MAX_DISTANCE_RATIO * other
        };
        let first = self.salted(&sample.places, reseeding, 1)?;
        if !is_changed(&first) || !is_as_far(&first) {
            return None;
        }
        let mut all = vec![unsalted.to_vec(), first];
        for salt in 2..(REPLICATES + WEIGHT_REPLICATES) as u32 {
            all.push(
                self.salted(&sample.places, reseeding, salt)
                    .filter(|other| is_as_far(other))?,
            );
        }
        Some(all)
    }
}

/// Whether a shader uses the reference's random numbers.
fn uses_reference_numbers(
    reference: &dyn StochasticReference,
    own: &[ShaderPixel],
    estimates: &[Estimate],
) -> bool {
    let of_each = own.par_iter().zip(estimates).map(|(own, estimate)| {
        let expected = reference.inverse_tone_mapped(estimate.own);
        let (mean, selected) = (estimate.mean(), variance(&estimate.selection));
        let mut sums = [0.0; 3];
        for i in 0..3 {
            let [a, b] = [own.mean[i] - mean[i], expected[i] - mean[i]];
            let weight = 1.0 / (selected[i] + MIN_STANDARD_DEVIATION * MIN_STANDARD_DEVIATION);
            let terms = [a * a, a * b, b * b].map(|term| if term.is_finite() { weight * term } else { 0.0 });
            (0..3).for_each(|at| sums[at] += terms[at]);
        }
        sums
    });
    let of_each: Vec<[f64; 3]> = of_each.collect();
    let [own, covariance, reference] = of_each
        .iter()
        .fold([0.0; 3], |sum, each| [0, 1, 2].map(|at| sum[at] + each[at]));
    covariance > MIN_SHARED_CORRELATION * (own * reference).sqrt()
}

/// Pixels spread over an image.
pub(crate) fn places(size: [u32; 2], reference: &dyn StochasticReference) -> Places {
    let max_pixels = f64::from(reference.max_pixels());
    let all = f64::from(size[0]) * f64::from(size[1]);
    let share = (max_pixels / all).sqrt().min(1.0);
    Places::spread(size, size.map(|side| (f64::from(side) * share) as u32))
}

/// A pixel of the shader.
#[derive(Clone, Copy)]
struct ShaderPixel {
    /// The color as it is shown.
    tone_mapped: [f64; 3],
    /// The mean of the pixel's samples, by the inverse of the tone map.
    mean: [f64; 3],
}

/// The number of columns and of rows of pixels over which variances are averaged.
const SMOOTHING_BLOCK: usize = 4;

/// The variance of the shader's pixels, averaged over blocks, since a few replicates estimate the variance of
/// a single pixel poorly.
fn smoothed_variance(sets: &[Vec<ShaderPixel>], width: usize) -> Vec<[f64; 3]> {
    let count = sets.first().map_or(0, Vec::len);
    let each: Vec<[f64; 3]> = (0..count)
        .map(|at| variance(&sets.iter().map(|set| set[at].mean).collect::<Vec<_>>()))
        .collect();
    let (columns, rows) = (
        width.div_ceil(SMOOTHING_BLOCK),
        (count / width.max(1)).div_ceil(SMOOTHING_BLOCK),
    );
    let mut sums = vec![([0.0; 3], 0.0); columns * rows];
    let part = |at: usize| at / width / SMOOTHING_BLOCK * columns + at % width / SMOOTHING_BLOCK;
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

/// Whether the shader clamps its samples to white, which changes their mean.
fn clamps_samples(
    reference: &dyn StochasticReference,
    sets: &[Vec<ShaderPixel>],
    estimates: &[Estimate],
) -> bool {
    let is_above = |color: &[f64; 3]| {
        let tone_mapped = reference.tone_mapped(*color);
        (0..3).any(|i| color[i] > 1.0 && tone_mapped[i] >= 1.0)
    };
    let shader_is_above = sets.iter().flatten().any(|own| is_above(&own.mean));
    !shader_is_above
        && estimates
            .iter()
            .any(|estimate| estimate.selection.iter().any(is_above))
}

/// Whether a pixel is white on both sides, so that no difference is visible, or may be for a shader that
/// clamps.
fn is_white(
    reference: &dyn StochasticReference,
    mean: [f64; 3],
    own: &[[f64; 3]],
    estimate: &Estimate,
    clamps_samples: bool,
) -> bool {
    let own_mean = self::mean(own);
    let [shown, own_shown] = [mean, own_mean].map(|mean| reference.tone_mapped(mean));
    // Nearly all values are within three standard deviations.
    let is_beyond = |mean: f64, variance: f64| mean + 3.0 * variance.sqrt() > 1.0;
    let variances = [estimate.variance, variance(own)];
    (0..3).any(|i| {
        (shown[i] >= 1.0 && own_shown[i] >= 1.0)
            || (clamps_samples
                && (is_beyond(mean[i], variances[0][i]) || is_beyond(own_mean[i], variances[1][i])))
    })
}
