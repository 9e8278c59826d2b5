//! Compares shaders that differ from a stochastic reference only by their random numbers.
//!
//! A shader with other random numbers than its reference renders another image with the same mean. If all
//! pixels that differ depend on random numbers, the means are compared: the reference's over many sets of
//! random numbers, and the shader's over its replicates, or over many pixels of its one image.

use std::ops::Range;

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_tracer::{RESAMPLED_ROWS, Tracer};

use super::estimates::{
    ESTIMATE_SETS, SELECTION_SETS, StochasticReference, differs, mean, of_pixel, variance,
};
use super::mean_test::{RandomPixel, means, uses_scene_numbers};
use super::reference::draws_by_random_numbers;
use super::replicates::{Incomparable, MIN_CHANGED_SHARE, ReplicatedShader};
use super::reseed::Reseeding;
use super::sample_count::fewer_samples;
use crate::case::Case;
use crate::compare::{CheckResult, CheckSummary, PixelStatus, Regions};
use crate::evidence::{Checks, MeanComparison, OtherRandomNumbers};
use crate::expected::Expected;
use crate::limits::MAX_VARIANCE_RATIO;

/// The largest number of differing pixels that are resampled.
const MAX_RESAMPLED_PIXELS: usize = 256;

/// The share of the resampled differing pixels that must change in at least one of the sets.
const MIN_RANDOM_SHARE: f64 = 0.98;

/// The largest number of pixels that are resampled.
const MAX_PIXELS: u32 = 1 << 18;

/// The largest number of samples of one set of random numbers.
const MAX_SAMPLES: u32 = 1 << 20;

/// The largest number of paths of one set of random numbers.
const MAX_PATHS: u32 = 1 << 18;

/// A stochastic reference, with what is recorded to compare the means of a shader with it.
#[derive(Debug)]
pub(crate) struct Stochastic<'a> {
    reference: &'a dyn StochasticReference,
    size: [u32; 2],
    /// The rows of a scene.
    rows: Option<SampledRows<'a>>,
    /// Whether the reference is an image, whose noise is unknown.
    is_image: bool,
}

/// The colors of a shader and of a scene in rows spread over an image.
#[derive(Debug)]
struct SampledRows<'a> {
    tracer: &'a Tracer<f64>,
    size: [u32; 2],
    /// The first rows, from the bottom up: [`RESAMPLED_ROWS`] rows each, or the rest of the image.
    bottoms: Vec<u32>,
    /// The colors so far, row by row: the shader's, and the reference's.
    colors: Vec<[[f32; 3]; 2]>,
}

/// The comparison of the means of a shader and of its reference.
pub(crate) struct MeansEvidence {
    pub(crate) random_numbers: OtherRandomNumbers,
    /// How the shader's random numbers were changed; `None` if they were not.
    pub(crate) reseeding: Option<Reseeding>,
}

impl<'a> Stochastic<'a> {
    /// Selects what is recorded of an image of that size; none if the reference is a scene without random
    /// numbers.
    pub(crate) fn new(expected: &'a Expected, size: [u32; 2]) -> Option<Self> {
        let new = |reference: &'a dyn StochasticReference, rows| Self {
            reference,
            size,
            rows,
            is_image: matches!(expected, Expected::Image(_)),
        };
        match expected {
            Expected::Scene(_) => {
                let tracer = expected.tracer().filter(|tracer| tracer.sampler().is_some())?;
                Some(new(tracer, Some(SampledRows::new(tracer, size))))
            }
            Expected::Shader(shader) => Some(new(&**shader, None)),
            Expected::Image(image) => Some(new(image, None)),
        }
    }

    /// Records a band of the shader in f64 and of the reference that begins at `row`.
    pub(crate) fn record(&mut self, band: &Image, reference: &Image, row: u32) {
        if let Some(rows) = &mut self.rows {
            rows.record(band, reference, row);
        }
    }

    pub(crate) fn reference(&self) -> &'a dyn StochasticReference {
        self.reference
    }

    /// Compares the means of a shader that differs from its reference only in random pixels; `None` if it
    /// differs elsewhere too. The precision check of the other pixels is left out.
    pub(crate) fn compare_means(
        &self,
        shader: ReplicatedShader<'_>,
        algorithm: &CheckResult,
        checks: &Checks,
    ) -> Option<MeansEvidence> {
        let reference = self.reference;
        if !reference.is_stochastic() {
            return None;
        }
        let is_random = self.differs_randomly(algorithm);
        if !is_random && shader.effective_reseeding(algorithm, MIN_CHANGED_SHARE).is_none() {
            return None;
        }
        // An image of such a shader has no noise.
        let Case { checked, frame, .. } = *shader.case;
        if self.is_image && draws_by_random_numbers(checked, frame) {
            return None;
        }
        let (means, reseeding) = match shader.compare_with_reference(algorithm) {
            Ok(compared) => {
                let test = compared.test;
                let is_noisier = test.variance > MAX_VARIANCE_RATIO && test.is_uniform;
                let fewer_samples = || fewer_samples(&checked.tree, reference.samples()?, test.variance);
                let means = MeanComparison::Replicates {
                    test,
                    pixels: compared.pixels as u64,
                    fewer_samples: is_noisier.then(fewer_samples).flatten(),
                };
                (means, Some(compared.reseeding))
            }
            Err(Incomparable::UnknownNoise) => (MeanComparison::UnknownNoise, None),
            Err(Incomparable::NotReseeded) if is_random => match &self.rows {
                None => (MeanComparison::UnknownNoise, None),
                Some(rows) => {
                    let pairs = rows.pairs(algorithm);
                    if uses_scene_numbers(&pairs) {
                        return None;
                    }
                    let means = MeanComparison::OneImage {
                        test: means(&pairs, self.size),
                        pixels: 2 * pairs.len() as u64,
                    };
                    (means, None)
                }
            },
            Err(Incomparable::NotReseeded | Incomparable::NotRandom | Incomparable::SameNumbers) => {
                return None;
            }
        };
        let without_differing = CheckSummary {
            differing: 0,
            ill_conditioned: 0,
            tied: 0,
            regions: Regions::default(),
            ..algorithm.summary.clone()
        };
        let random_numbers = OtherRandomNumbers {
            sampler: reference.sampler(),
            samples: reference.samples(),
            means,
            other_pixels: Checks {
                algorithm: Some(without_differing),
                precision: None,
                toolchain: checks.toolchain.clone(),
            },
        };
        Some(MeansEvidence {
            random_numbers,
            reseeding,
        })
    }

    /// Returns the precision check without the pixels that differ from the scene, and without random ones: in
    /// float32, the same formula may yield other random numbers.
    pub(crate) fn precision_of_others(
        &self,
        algorithm: &CheckResult,
        precision: &CheckResult,
    ) -> CheckSummary {
        let width = self.size[0] as usize;
        let statuses = precision.statuses.iter().zip(&algorithm.statuses);
        let others = statuses.enumerate().filter(|&(_, (&precision, &algorithm))| {
            precision == PixelStatus::Differs
                && !matches!(algorithm, PixelStatus::Differs | PixelStatus::IllConditioned)
        });
        let others: Vec<[u32; 2]> = others
            .map(|(at, _)| [(at % width) as u32, (at / width) as u32])
            .collect();
        let random = self.reference.are_random(&others);
        CheckSummary {
            differing: random.iter().filter(|&&random| !random).count() as u64,
            ..precision.summary.clone()
        }
    }

    /// Whether the differing pixels are random in the reference, and there are any.
    fn differs_randomly(&self, algorithm: &CheckResult) -> bool {
        let resampled = algorithm.sample_pixels(self.size, MAX_RESAMPLED_PIXELS);
        let random = self.reference.are_random(&resampled);
        let random = random.iter().filter(|&&random| random).count();
        !resampled.is_empty() && random as f64 >= MIN_RANDOM_SHARE * resampled.len() as f64
    }
}

impl<'a> SampledRows<'a> {
    /// Selects rows of an image of that size.
    fn new(tracer: &'a Tracer<f64>, size: [u32; 2]) -> Self {
        let samples = if tracer.traces_paths() {
            MAX_PATHS
        } else {
            MAX_SAMPLES
        };
        let pixels = (samples / tracer.samples()).min(MAX_PIXELS);
        let all = size[1].div_ceil(RESAMPLED_ROWS);
        let count = (pixels / (RESAMPLED_ROWS * size[0])).clamp(1, all);
        let bottom = |at| (2 * at + 1) * all / (2 * count) * RESAMPLED_ROWS;
        Self {
            tracer,
            size,
            bottoms: (0..count).map(bottom).collect(),
            colors: Vec::new(),
        }
    }

    /// The rows from `bottom` on.
    fn rows(&self, bottom: u32) -> Range<u32> {
        bottom..self.size[1].min(bottom + RESAMPLED_ROWS)
    }

    /// Records a band of the shader in f64 and of the reference that begins at `row`. No group of rows
    /// crosses a band's edge.
    fn record(&mut self, band: &Image, reference: &Image, row: u32) {
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

    /// Pairs of neighbors with at least one random pixel, with the tracer's means. Each square of four
    /// pixels has two: along an edge rather than across it, where shared random numbers cause the same noise.
    fn pairs(&self, algorithm: &CheckResult) -> Vec<[RandomPixel; 2]> {
        let width = self.size[0] as usize;
        let recorded = self
            .bottoms
            .par_iter()
            .zip(self.colors.par_chunks(RESAMPLED_ROWS as usize * width));
        let pairs = recorded.flat_map_iter(|(&bottom, colors)| {
            let selection = SampleSets::new(self.tracer, bottom, SELECTION_SETS);
            let estimate = SampleSets::new(self.tracer, bottom, ESTIMATE_SETS);
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

/// The pixels of some rows with several sets of random numbers.
struct SampleSets<'a> {
    tracer: &'a Tracer<f64>,
    /// The means of samples of each set, before the tone map.
    means: Vec<Vec<[f64; 3]>>,
    /// The means after the tone map.
    colors: Vec<Vec<[f64; 3]>>,
}

impl<'a> SampleSets<'a> {
    fn new(tracer: &'a Tracer<f64>, bottom: u32, sets: Range<u32>) -> Self {
        let means: Vec<_> = sets.map(|set| tracer.resampled_rows(bottom, set)).collect();
        let tone_mapped = |means: &Vec<_>| means.iter().map(|&mean| tracer.tone_mapped(mean)).collect();
        Self {
            tracer,
            colors: means.iter().map(tone_mapped).collect(),
            means,
        }
    }

    fn differs(&self, at: usize) -> bool {
        self.colors
            .iter()
            .any(|colors| differs(colors[at], self.colors[0][at]))
    }

    fn mean(&self, at: usize) -> [f64; 3] {
        mean(&of_pixel(&self.colors, at))
    }

    /// The difference of the means of two pixels, summed over components.
    fn distance(&self, pair: [usize; 2]) -> f64 {
        let [a, b] = pair.map(|at| self.mean(at));
        (0..3).map(|i| (a[i] - b[i]).abs()).sum()
    }

    fn variance(&self, at: usize) -> [f64; 3] {
        variance(&of_pixel(&self.colors, at))
    }

    /// How much brighter a pixel is if the samples of all sets are averaged before the tone map.
    fn tone_map_bias(&self, at: usize) -> [f64; 3] {
        let together = self.tracer.tone_mapped(mean(&of_pixel(&self.means, at)));
        let mean = self.mean(at);
        [0, 1, 2].map(|i| together[i] - mean[i])
    }
}
