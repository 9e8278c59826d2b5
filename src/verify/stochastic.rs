//! Verdicts on shaders that differ from a stochastic scene only by their random numbers.
//!
//! A shader with other random numbers than its scene renders another image with the same mean. Where all
//! pixels that differ depend on random numbers, the means are compared: the tracer's over many sets of random
//! numbers, and the shader's over its replicates, or over many pixels of its one image.

use std::fmt::Write;
use std::ops::Range;
use std::time::Instant;

use rayon::prelude::*;
use toyproof_eval::Program;
use toyproof_image::Image;
use toyproof_scene::Sampler;
use toyproof_tracer::{RESAMPLED_ROWS, Tracer};

use crate::compare::{
    Answer, Answers, EXACT_TOLERANCE, MeanTest, PixelStatus, RARE_EVENT_VARIANCE_RATIO, REPLICATES,
    RandomPixel, ReplicateTest, Verdict, decide, differing, grouped, means, uses_scene_numbers,
};
use crate::mistake::Named;
use crate::notes::sample_pixels;
use crate::replicates::{self, Incomparable, SceneComparison};
use crate::sample_loops::fewer_samples;
use crate::{Case, CheckResult};

/// The largest number of differing pixels that are resampled.
const MAX_RESAMPLED_PIXELS: usize = 256;

/// The number of times they are resampled. A feature that covers the part a of a pixel is hit by a sample of
/// a shader and missed by n other samples with a probability of a·(1 − a)ⁿ, which is below 1/(e·n).
const RESAMPLES: u32 = 16;

/// The share of them that must change in at least one of the sets.
const MIN_RANDOM_SHARE: f64 = 0.98;

/// The ratio of variances above which the noise is reported.
const MAX_VARIANCE_RATIO: f64 = 1.2;

/// The largest undetected difference of means, two and a half 8-bit levels; above it the verdict is
/// inconclusive.
const MAX_BIAS_BOUND: f64 = 0.01;

/// The smallest number of random pixels: with fewer, a mistake in some of them is not detected.
const MIN_PIXELS: usize = 1000;

/// The sets of random numbers that select pixels and estimate their weights. They are disjoint from the sets
/// that estimate the means, and independent of the shader's image; otherwise pixels would be selected because
/// a set hit a small feature.
const SELECTION_SETS: Range<u32> = 1..9;

/// The sets of random numbers that estimate the means.
const ESTIMATE_SETS: Range<u32> = 9..17;

/// The largest number of pixels that are resampled.
const MAX_PIXELS: u32 = 1 << 18;

/// The largest numbers of samples and of paths of one set of random numbers.
const MAX_SAMPLES: u32 = 1 << 20;
const MAX_PATHS: u32 = 1 << 18;

/// The colors of a shader and of the reference in rows spread over an image.
pub(super) struct SampledRows<'a> {
    tracer: &'a Tracer<f64>,
    sampler: &'static str,
    size: [u32; 2],
    /// The first rows, from the bottom up: [`RESAMPLED_ROWS`] rows each, or the rest of the image.
    bottoms: Vec<u32>,
    /// The colors so far, row by row: the shader's, and the reference's.
    colors: Vec<[[f32; 3]; 2]>,
}

/// A verdict on a stochastic shader.
pub(super) struct StochasticVerdict {
    pub(super) verdict: Verdict,
    pub(super) reason: String,
    /// The recognized mistake.
    pub(super) mistake: Option<Vec<Named>>,
}

/// The results of the three checks.
#[derive(Clone, Copy)]
pub(super) struct CheckResults<'a> {
    pub(super) algorithm: &'a CheckResult,
    pub(super) precision: Option<&'a CheckResult>,
    pub(super) toolchain: Option<&'a CheckResult>,
}

impl<'a> SampledRows<'a> {
    /// Selects rows of an image of that size; none if the scene uses no random numbers.
    pub(super) fn new(tracer: &'a Tracer<f64>, size: [u32; 2]) -> Option<Self> {
        let sampler = match tracer.sampler()? {
            Sampler::Center => return None,
            Sampler::SineHash => "sine-hash",
            Sampler::Independent => "independent",
            Sampler::Stratified => "stratified",
            Sampler::Sobol => "sobol",
        };
        let samples = if tracer.traces_paths() {
            MAX_PATHS
        } else {
            MAX_SAMPLES
        };
        let pixels = (samples / tracer.samples()).min(MAX_PIXELS);
        let all = size[1].div_ceil(RESAMPLED_ROWS);
        let count = (pixels / (RESAMPLED_ROWS * size[0])).clamp(1, all);
        let bottom = |at| (2 * at + 1) * all / (2 * count) * RESAMPLED_ROWS;
        Some(Self {
            tracer,
            sampler,
            size,
            bottoms: (0..count).map(bottom).collect(),
            colors: Vec::new(),
        })
    }

    /// The rows from `bottom` on.
    fn rows(&self, bottom: u32) -> Range<u32> {
        bottom..self.size[1].min(bottom + RESAMPLED_ROWS)
    }

    /// Records a band of the shader in f64 and of the reference that begins at `row`. No group of rows
    /// crosses a band's edge.
    pub(super) fn record(&mut self, band: &Image, reference: &Image, row: u32) {
        let [width, height] = band.size();
        let all = row..row + height;
        for &bottom in self.bottoms.iter().filter(|&bottom| all.contains(bottom)) {
            let rows = self.rows(bottom);
            let within = ((rows.start - row) * width) as usize..((rows.end - row) * width) as usize;
            let pixels = band.pixels()[within.clone()]
                .iter()
                .zip(&reference.pixels()[within]);
            let color = |&[r, g, b, _]: &[f32; 4]| [r, g, b];
            self.colors
                .extend(pixels.map(|(own, reference)| [color(own), color(reference)]));
        }
    }

    /// Returns the verdict on a shader that differs from its scene only in random pixels; none if it differs
    /// elsewhere too.
    pub(super) fn verdict(
        &self,
        checks: CheckResults,
        program: &Program,
        case: &Case,
        deadline: Instant,
    ) -> Option<StochasticVerdict> {
        let differs = format!(
            "{}, only where the samples' random numbers decide: it draws others than the scene, whose sampler is `{}`",
            differing(&checks.algorithm.answer),
            self.sampler
        );
        let is_random = self.differs_randomly(checks.algorithm);
        if !is_random && !replicates::is_random(program, case, self.tracer, checks.algorithm, deadline) {
            return None;
        }
        match replicates::compare_with_scene(program, case, self.tracer, checks.algorithm, deadline) {
            Ok(compared) => {
                let (verdict, reason) = self.by_replicates(&differs, &compared, checks, case);
                let mistake = case
                    .suspects
                    .filter(|_| verdict == Verdict::Wrong)
                    .and_then(|suspects| {
                        let (tracer, places) = (self.tracer, suspects.places());
                        let pixels = replicates::noisy_pixels(
                            program,
                            case,
                            tracer,
                            compared.reseeding,
                            places,
                            deadline,
                        )?;
                        suspects.recognize_noisy(&pixels)
                    });
                Some(StochasticVerdict {
                    verdict,
                    reason,
                    mistake,
                })
            }
            Err(Incomparable::NotReseeded) if is_random => {
                let pairs = self.pairs(checks.algorithm);
                (!uses_scene_numbers(&pairs)).then(|| {
                    let (verdict, reason) = self.by_one_image(&differs, &pairs, checks);
                    StochasticVerdict {
                        verdict,
                        reason,
                        mistake: None,
                    }
                })
            }
            Err(Incomparable::NotReseeded | Incomparable::NotRandom | Incomparable::SceneNumbers) => None,
        }
    }

    /// The verdict from replicates of the shader.
    fn by_replicates(
        &self,
        differs: &str,
        &SceneComparison { test, pixels, .. }: &SceneComparison,
        checks: CheckResults,
        case: &Case,
    ) -> (Verdict, String) {
        let ReplicateTest {
            bias: (deviations, [x, y]),
            is_biased,
            is_correlated,
            variance,
            is_uniform,
            within,
        } = test;
        if is_biased {
            let much = if deviations.is_finite() {
                format!("by {deviations:.0} standard deviations")
            } else {
                "and nothing random is left to explain it".to_owned()
            };
            return (
                Verdict::Wrong,
                format!(
                    "{differs}; but there its mean is another too, most of all around ({x}, {y}), {much}"
                ),
            );
        }
        if is_correlated {
            return (Verdict::Inconclusive, correlated(differs));
        }
        if pixels >= MIN_PIXELS
            && within > MAX_BIAS_BOUND
            && variance > RARE_EVENT_VARIANCE_RATIO
            && variance.is_finite()
        {
            return (Verdict::Inconclusive, too_noisy(differs, variance));
        }
        if pixels < MIN_PIXELS || within > MAX_BIAS_BOUND {
            return (Verdict::Inconclusive, underpowered(differs));
        }
        let samples = self.tracer.samples();
        if variance > MAX_VARIANCE_RATIO
            && is_uniform
            && let Some(own) = fewer_samples(&case.checked.tree, samples, variance)
        {
            return (
                Verdict::Wrong,
                format!(
                    "{differs}; the mean is the same, but it takes fewer samples, {own} where the scene has {samples}: its noise has \
                     {variance:.1} times the variance"
                ),
            );
        }
        match checks.ignoring_random_pixels(self) {
            (Verdict::Correct, _) => {
                let pixels = grouped(pixels as u64);
                let mut reason = format!(
                    "the same in the mean, to within {within:.4} over {pixels} pixels, with {REPLICATES} sets of random numbers; {differs}"
                );
                if variance > MAX_VARIANCE_RATIO {
                    let _ = write!(
                        reason,
                        "; its noise has {variance:.1} times the variance of the scene's own sampler"
                    );
                }
                (Verdict::Correct, reason)
            }
            other => other,
        }
    }

    /// The verdict from the shader's one image, where no reseeding works.
    fn by_one_image(
        &self,
        differs: &str,
        pairs: &[[RandomPixel; 2]],
        checks: CheckResults,
    ) -> (Verdict, String) {
        match means(pairs, self.size) {
            MeanTest::Same(within) => match checks.ignoring_random_pixels(self) {
                (Verdict::Correct, _) => {
                    let pixels = grouped(2 * pairs.len() as u64);
                    let reason = format!(
                        "the same in the mean, to within {within:.4} over {pixels} pixels; {differs}"
                    );
                    (Verdict::Correct, reason)
                }
                other => other,
            },
            MeanTest::Different([x, y]) => (
                Verdict::Wrong,
                format!("{differs}; but there its mean is another too, most of all around ({x}, {y})"),
            ),
            MeanTest::Underpowered => (Verdict::Inconclusive, underpowered(differs)),
            MeanTest::Correlated => (Verdict::Inconclusive, correlated(differs)),
        }
    }

    fn is_random(&self, at: [u32; 2]) -> bool {
        let first = self.tracer.resampled(at, 1);
        (2..=RESAMPLES).any(|set| differs(first, self.tracer.resampled(at, set)))
    }

    /// Whether the differing pixels are random in the scene, and there are any.
    fn differs_randomly(&self, algorithm: &CheckResult) -> bool {
        let resampled = sample_pixels(algorithm, self.size, MAX_RESAMPLED_PIXELS);
        let random = resampled.par_iter().filter(|&&at| self.is_random(at)).count();
        !resampled.is_empty() && random as f64 >= MIN_RANDOM_SHARE * resampled.len() as f64
    }

    /// Pairs of neighbors, at least one of which is random, with the tracer's means. Each square of four
    /// pixels has two: along an edge rather than across it, where shared random numbers cause the same noise.
    fn pairs(&self, algorithm: &CheckResult) -> Vec<[RandomPixel; 2]> {
        let width = self.size[0] as usize;
        let recorded = self
            .bottoms
            .par_iter()
            .zip(self.colors.par_chunks(RESAMPLED_ROWS as usize * width));
        let pairs = recorded.flat_map_iter(|(&bottom, colors)| {
            let selection = SampleSets::of(self.tracer, bottom, SELECTION_SETS);
            let estimate = SampleSets::of(self.tracer, bottom, ESTIMATE_SETS);
            let statuses = &algorithm.statuses[bottom as usize * width..];
            let rows = (0..colors.len() / width / 2).map(move |row| 2 * row * width);
            let squares = rows.flat_map(move |row| (0..width / 2).map(move |column| row + 2 * column));
            squares.flat_map(move |at| {
                let [left, right] = [[at, at + width], [at + 1, at + width + 1]];
                let [below, above] = [[at, at + 1], [at + width, at + width + 1]];
                let distance =
                    |pairs: [[usize; 2]; 2]| pairs.map(|pair| selection.distance(pair)).iter().sum::<f64>();
                let along = if distance([left, right]) < distance([below, above]) {
                    [left, right]
                } else {
                    [below, above]
                };
                along.map(|pair| {
                    let is_defined = pair.iter().all(|&at| statuses[at] != PixelStatus::Undefined);
                    let is_random = pair.iter().any(|&at| selection.differs(at));
                    let [a, b] = pair.map(|at| selection.variance(at));
                    let pixel = |at: usize| RandomPixel {
                        at: [(at % width) as u32, bottom + (at / width) as u32],
                        rendered: colors[at][0].map(|part| f64::from(part).clamp(0.0, 1.0)),
                        reference: colors[at][1].map(|part| f64::from(part).clamp(0.0, 1.0)),
                        mean: estimate.mean(at),
                        variance: [0, 1, 2].map(|i| f64::midpoint(a[i], b[i])),
                        tone_map_bias: estimate.tone_map_bias(at),
                    };
                    (is_defined && is_random).then(|| pair.map(pixel))
                })
            })
        });
        pairs.flatten_iter().collect()
    }
}

fn underpowered(differs: &str) -> String {
    format!(
        "random: {differs}, and samples or pixels are too few to compare means. Draw as docs/scenes.md tells, give the scene the sampler \
         that draws as the shader does, or ask for a larger picture"
    )
}

fn too_noisy(differs: &str, variance: f64) -> String {
    format!(
        "random: {differs}, and its noise has {variance:.0} times the variance of the scene's own sampler: too much to compare means, as where \
         directions seldom meet a light. Sample the lights as well, or take more samples"
    )
}

fn correlated(differs: &str) -> String {
    format!(
        "random: {differs}, and what they do in neighbouring pixels has much in common, so that means cannot be compared. Draw as docs/scenes.md \
         tells, or start each pixel's numbers from its place"
    )
}

/// The pixels of some rows with several sets of random numbers.
struct SampleSets<'a> {
    tracer: &'a Tracer<f64>,
    /// The means of samples of each set, before the tone map.
    means: Vec<Vec<[f64; 3]>>,
    colors: Vec<Vec<[f64; 3]>>,
}

impl<'a> SampleSets<'a> {
    fn of(tracer: &'a Tracer<f64>, bottom: u32, sets: Range<u32>) -> Self {
        let means: Vec<_> = sets.map(|set| tracer.redrawn_rows(bottom, set)).collect();
        let developed = |means: &Vec<_>| means.iter().map(|&mean| tracer.developed(mean)).collect();
        Self {
            tracer,
            colors: means.iter().map(developed).collect(),
            means,
        }
    }

    fn differs(&self, at: usize) -> bool {
        self.colors
            .iter()
            .any(|colors| differs(colors[at], self.colors[0][at]))
    }

    fn mean(&self, at: usize) -> [f64; 3] {
        mean(&self.colors, at)
    }

    /// The difference of the means of two pixels, summed over components.
    fn distance(&self, pair: [usize; 2]) -> f64 {
        let [a, b] = pair.map(|at| self.mean(at));
        (0..3).map(|i| (a[i] - b[i]).abs()).sum()
    }

    fn variance(&self, at: usize) -> [f64; 3] {
        let mean = self.mean(at);
        let count = self.colors.len() as f64;
        [0, 1, 2].map(|i| {
            let squares = self.colors.iter().map(|colors| (colors[at][i] - mean[i]).powi(2));
            squares.sum::<f64>() / (count - 1.0)
        })
    }

    /// How much brighter a pixel is if the samples of all sets are averaged before the tone map.
    fn tone_map_bias(&self, at: usize) -> [f64; 3] {
        let together = self.tracer.developed(mean(&self.means, at));
        let mean = self.mean(at);
        [0, 1, 2].map(|i| together[i] - mean[i])
    }
}

/// The mean of a pixel over all sets.
fn mean(sets: &[Vec<[f64; 3]>], at: usize) -> [f64; 3] {
    let count = sets.len() as f64;
    [0, 1, 2].map(|i| sets.iter().map(|set| set[at][i]).sum::<f64>() / count)
}

fn differs(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).any(|i| (a[i] - b[i]).abs() > EXACT_TOLERANCE)
}

impl CheckResults<'_> {
    /// The verdict if pixels that differ from the scene are ignored: there, float32 may change the random
    /// numbers as well.
    fn ignoring_random_pixels(self, sampled_rows: &SampledRows) -> (Verdict, String) {
        let algorithm = Answer {
            differing: 0,
            undecided: 0,
            tied: 0,
            ..self.algorithm.answer.clone()
        };
        let precision = self.precision.map(|precision| {
            let statuses = precision.statuses.iter().zip(&self.algorithm.statuses);
            let left = statuses.enumerate().filter(|&(_, (&precision, &algorithm))| {
                precision == PixelStatus::Differs
                    && !matches!(algorithm, PixelStatus::Differs | PixelStatus::Undecided)
            });
            // In float32, the same formula may yield other random numbers.
            let width = sampled_rows.size[0] as usize;
            let left =
                left.filter(|&(at, _)| !sampled_rows.is_random([(at % width) as u32, (at / width) as u32]));
            Answer {
                differing: left.count() as u64,
                ..precision.answer.clone()
            }
        });
        decide(Answers {
            algorithm: Some(&algorithm),
            precision: precision.as_ref(),
            toolchain: self.toolchain.map(|check| &check.answer),
        })
    }
}
