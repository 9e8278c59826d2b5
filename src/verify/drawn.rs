//! Whether what differs from the scene is only drawn otherwise.
//!
//! A shader that draws other random numbers than its scene paints another picture of the same mean. Where all that differs hangs on what is
//! drawn, the means are compared: of many drawings of the tracer's, and of the one that the shader paints, over many pixels.

use std::fmt::Write;
use std::ops::Range;
use std::time::Instant;

use rayon::prelude::*;
use toyproof_eval::Program;
use toyproof_image::Image;
use toyproof_scene::Sampler;
use toyproof_tracer::{REDRAWN_ROWS, Tracer};

use super::cause::some;
use super::replicates::{self, Compared, Unfit};
use super::sample_loops::fewer_samples;
use super::{Asked, Case};
use crate::compare::{
    Answer, Answers, DrawnPixel, EXACT_TOLERANCE, Means, RARE_EVENTS, REPLICATES, Replicated, Standing,
    Verdict, differing, follows_scene, grouped, judge, means,
};
use crate::mistake::Named;

/// So many of the pixels that differ are drawn anew.
const ASKED: usize = 256;

/// So often. A sliver that covers the part a of a pixel is met by a sample of a shader and by none of n that are drawn anew with a chance of
/// a·(1 − a)ⁿ, which is below 1/(e·n).
const TIMES: u32 = 16;

/// So many of them must be another colour in one of the drawings.
const MOST: f64 = 0.98;

/// Noise of more than so many times the variance is worth a word.
const NOISIER: f64 = 1.2;

/// Nothing is said where means that are this much apart, two and a half levels of 8 bits, might not be seen.
const FINEST: f64 = 0.01;

/// Fewer random pixels say nothing: a mistake in a part of them would not be seen.
const FEWEST: usize = 1000;

/// These drawings choose pixels and what each counts. They are not those that the means are made of, nor is the shader's picture asked, or
/// whoever met a sliver would be chosen for it.
const CHOOSING: Range<u32> = 1..9;

/// These make the means.
const DRAWINGS: Range<u32> = 9..17;

/// At most so many pixels are drawn again.
const PIXELS: u32 = 1 << 18;

/// A drawing of them takes at most so many samples, or so many paths.
const SAMPLES: u32 = 1 << 20;
const PATHS: u32 = 1 << 18;

/// What a shader paints in some rows from all over a picture.
pub(super) struct Painted<'a> {
    tracer: &'a Tracer<f64>,
    sampler: &'static str,
    size: [u32; 2],
    /// Where they begin, from the bottom up: [`REDRAWN_ROWS`] rows each, or what is left of them.
    bottoms: Vec<u32>,
    /// So far, row by row: the shader's colour, and the reference's.
    colours: Vec<[[f32; 3]; 2]>,
}

/// A verdict on a stochastic shader.
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) reason: String,
    /// What it does wrong.
    pub(super) mistake: Option<Vec<Named>>,
}

/// What the three questions found.
#[derive(Clone, Copy)]
pub(super) struct Found<'a> {
    pub(super) maths: &'a Asked,
    pub(super) rounding: Option<&'a Asked>,
    pub(super) toolchain: Option<&'a Asked>,
}

impl<'a> Painted<'a> {
    /// Of a picture of that size; nothing if its scene draws nothing.
    pub(super) fn new(tracer: &'a Tracer<f64>, size: [u32; 2]) -> Option<Self> {
        let sampler = match tracer.sampler()? {
            Sampler::Center => return None,
            Sampler::SineHash => "sine-hash",
            Sampler::Independent => "independent",
            Sampler::Stratified => "stratified",
            Sampler::Sobol => "sobol",
        };
        let samples = if tracer.traces_paths() { PATHS } else { SAMPLES };
        let pixels = (samples / tracer.samples()).min(PIXELS);
        let all = size[1].div_ceil(REDRAWN_ROWS);
        let count = (pixels / (REDRAWN_ROWS * size[0])).clamp(1, all);
        let bottom = |at| (2 * at + 1) * all / (2 * count) * REDRAWN_ROWS;
        Some(Self {
            tracer,
            sampler,
            size,
            bottoms: (0..count).map(bottom).collect(),
            colours: Vec::new(),
        })
    }

    /// The rows that begin there.
    fn rows(&self, bottom: u32) -> Range<u32> {
        bottom..self.size[1].min(bottom + REDRAWN_ROWS)
    }

    /// Takes note of a band that begins at that row, in f64, and of what it should be. Bands begin where such rows do.
    pub(super) fn look(&mut self, band: &Image, reference: &Image, row: u32) {
        let [width, height] = band.size();
        let all = row..row + height;
        for &bottom in self.bottoms.iter().filter(|&bottom| all.contains(bottom)) {
            let rows = self.rows(bottom);
            let within = ((rows.start - row) * width) as usize..((rows.end - row) * width) as usize;
            let pixels = band.pixels()[within.clone()]
                .iter()
                .zip(&reference.pixels()[within]);
            let colour = |&[r, g, b, _]: &[f32; 4]| [r, g, b];
            self.colours
                .extend(pixels.map(|(own, reference)| [colour(own), colour(reference)]));
        }
    }

    /// The verdict on a shader that differs from its scene where chance decides, and the reason; none if it differs elsewhere too.
    pub(super) fn judged(
        &self,
        found: Found,
        program: &Program,
        case: &Case,
        until: Instant,
    ) -> Option<Judged> {
        let differs = format!(
            "{}, only where the samples' random numbers decide: it draws others than the scene, whose sampler is `{}`",
            differing(&found.maths.answer),
            self.sampler
        );
        let is_drawn = self.is_drawn(found.maths);
        if !is_drawn && !replicates::is_random(program, case, self.tracer, found.maths, until) {
            return None;
        }
        match replicates::compared(program, case, self.tracer, found.maths, until) {
            Ok(compared) => {
                let (verdict, reason) = self.by_replicates(&differs, &compared, found, case);
                let mistake = case
                    .suspects
                    .filter(|_| verdict == Verdict::Wrong)
                    .and_then(|suspects| {
                        let (tracer, places) = (self.tracer, suspects.places());
                        let noisy =
                            replicates::noisy(program, case, tracer, compared.reseeding, places, until)?;
                        suspects.recognise_noisy(&noisy)
                    });
                Some(Judged {
                    verdict,
                    reason,
                    mistake,
                })
            }
            Err(Unfit::Unsalted) if is_drawn => {
                let pairs = self.pairs(found.maths);
                (!follows_scene(&pairs)).then(|| {
                    let (verdict, reason) = self.by_one_picture(&differs, &pairs, found);
                    Judged {
                        verdict,
                        reason,
                        mistake: None,
                    }
                })
            }
            Err(Unfit::Unsalted | Unfit::Fixed | Unfit::Follows) => None,
        }
    }

    /// By several pictures of the shader, each with other random numbers.
    fn by_replicates(
        &self,
        differs: &str,
        &Compared {
            replicated, pixels, ..
        }: &Compared,
        found: Found,
        case: &Case,
    ) -> (Verdict, String) {
        let Replicated {
            bias: (deviations, [x, y]),
            is_biased,
            is_repeated,
            variance,
            is_uniform,
            within,
        } = replicated;
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
        if is_repeated {
            return (Verdict::Inconclusive, repeated(differs));
        }
        if pixels >= FEWEST && within > FINEST && variance > RARE_EVENTS && variance.is_finite() {
            return (Verdict::Inconclusive, noisy(differs, variance));
        }
        if pixels < FEWEST || within > FINEST {
            return (Verdict::Inconclusive, unseen(differs));
        }
        let samples = self.tracer.samples();
        if variance > NOISIER
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
        match found.without_chance(self) {
            (Verdict::Correct, _) => {
                let pixels = grouped(pixels as u64);
                let mut reason = format!(
                    "the same in the mean, to within {within:.4} over {pixels} pixels, with {REPLICATES} sets of random numbers; {differs}"
                );
                if variance > NOISIER {
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

    /// By the one picture that there is, where no way is found to give the shader other random numbers.
    fn by_one_picture(&self, differs: &str, pairs: &[[DrawnPixel; 2]], found: Found) -> (Verdict, String) {
        match means(pairs, self.size) {
            Means::Same(within) => match found.without_chance(self) {
                (Verdict::Correct, _) => {
                    let pixels = grouped(2 * pairs.len() as u64);
                    let reason = format!(
                        "the same in the mean, to within {within:.4} over {pixels} pixels; {differs}"
                    );
                    (Verdict::Correct, reason)
                }
                other => other,
            },
            Means::Apart([x, y]) => (
                Verdict::Wrong,
                format!("{differs}; but there its mean is another too, most of all around ({x}, {y})"),
            ),
            Means::Unseen => (Verdict::Inconclusive, unseen(differs)),
            Means::Repeated => (Verdict::Inconclusive, repeated(differs)),
        }
    }

    fn is_redrawn(&self, at: [u32; 2]) -> bool {
        let first = self.tracer.redrawn(at, 1);
        (2..=TIMES).any(|set| moves(first, self.tracer.redrawn(at, set)))
    }

    /// Whether other draws paint another colour wherever the shader differs, and there is such a pixel.
    fn is_drawn(&self, maths: &Asked) -> bool {
        let asked = some(maths, self.size, ASKED);
        let drawn = asked.par_iter().filter(|&&at| self.is_redrawn(at)).count();
        !asked.is_empty() && drawn as f64 >= MOST * asked.len() as f64
    }

    /// Pairs of neighbours one of which at least hangs on what is drawn, and what they are on the average. Each square of four has two: along an edge
    /// rather than across it, where the same draws make the same noise.
    fn pairs(&self, maths: &Asked) -> Vec<[DrawnPixel; 2]> {
        let width = self.size[0] as usize;
        let noted = self
            .bottoms
            .par_iter()
            .zip(self.colours.par_chunks(REDRAWN_ROWS as usize * width));
        let pairs = noted.flat_map_iter(|(&bottom, colours)| {
            let chosen = Drawings::of(self.tracer, bottom, CHOOSING);
            let drawn = Drawings::of(self.tracer, bottom, DRAWINGS);
            let standings = &maths.standings[bottom as usize * width..];
            let rows = (0..colours.len() / width / 2).map(move |row| 2 * row * width);
            let squares = rows.flat_map(move |row| (0..width / 2).map(move |column| row + 2 * column));
            squares.flat_map(move |at| {
                let [left, right] = [[at, at + width], [at + 1, at + width + 1]];
                let [below, above] = [[at, at + 1], [at + width, at + width + 1]];
                let apart = |pairs: [[usize; 2]; 2]| pairs.map(|pair| chosen.apart(pair)).iter().sum::<f64>();
                let along = if apart([left, right]) < apart([below, above]) {
                    [left, right]
                } else {
                    [below, above]
                };
                along.map(|pair| {
                    let is_defined = pair.iter().all(|&at| standings[at] != Standing::Undefined);
                    let hangs = pair.iter().any(|&at| chosen.moves(at));
                    let [a, b] = pair.map(|at| chosen.variance(at));
                    let pixel = |at: usize| DrawnPixel {
                        at: [(at % width) as u32, bottom + (at / width) as u32],
                        painted: colours[at][0].map(|part| f64::from(part).clamp(0.0, 1.0)),
                        reference: colours[at][1].map(|part| f64::from(part).clamp(0.0, 1.0)),
                        mean: drawn.mean(at),
                        spread: [0, 1, 2].map(|i| f64::midpoint(a[i], b[i])),
                        gain: drawn.gain(at),
                    };
                    (is_defined && hangs).then(|| pair.map(pixel))
                })
            })
        });
        pairs.flatten_iter().collect()
    }
}

fn unseen(differs: &str) -> String {
    format!(
        "random: {differs}, and samples or pixels are too few to compare means. Draw as docs/scenes.md tells, give the scene the sampler \
         that draws as the shader does, or ask for a larger picture"
    )
}

fn noisy(differs: &str, variance: f64) -> String {
    format!(
        "random: {differs}, and its noise has {variance:.0} times the variance of the scene's own sampler: too much to compare means, as where \
         directions seldom meet a light. Sample the lights as well, or take more samples"
    )
}

fn repeated(differs: &str) -> String {
    format!(
        "random: {differs}, and what they do in neighbouring pixels has much in common, so that means cannot be compared. Draw as docs/scenes.md \
         tells, or start each pixel's numbers from its place"
    )
}

/// What the pixels of some rows are in several drawings.
struct Drawings<'a> {
    tracer: &'a Tracer<f64>,
    /// The means of a drawing's samples.
    means: Vec<Vec<[f64; 3]>>,
    colours: Vec<Vec<[f64; 3]>>,
}

impl<'a> Drawings<'a> {
    fn of(tracer: &'a Tracer<f64>, bottom: u32, sets: Range<u32>) -> Self {
        let means: Vec<_> = sets.map(|set| tracer.redrawn_rows(bottom, set)).collect();
        let developed = |means: &Vec<_>| means.iter().map(|&mean| tracer.developed(mean)).collect();
        Self {
            tracer,
            colours: means.iter().map(developed).collect(),
            means,
        }
    }

    fn moves(&self, at: usize) -> bool {
        self.colours
            .iter()
            .any(|colours| moves(colours[at], self.colours[0][at]))
    }

    fn mean(&self, at: usize) -> [f64; 3] {
        mean(&self.colours, at)
    }

    /// How far the means of two pixels are apart.
    fn apart(&self, pair: [usize; 2]) -> f64 {
        let [a, b] = pair.map(|at| self.mean(at));
        (0..3).map(|i| (a[i] - b[i]).abs()).sum()
    }

    fn variance(&self, at: usize) -> [f64; 3] {
        let mean = self.mean(at);
        let count = self.colours.len() as f64;
        [0, 1, 2].map(|i| {
            let squares = self
                .colours
                .iter()
                .map(|colours| (colours[at][i] - mean[i]).powi(2));
            squares.sum::<f64>() / (count - 1.0)
        })
    }

    /// How much brighter a pixel is if its samples are those of all drawings.
    fn gain(&self, at: usize) -> [f64; 3] {
        let together = self.tracer.developed(mean(&self.means, at));
        let mean = self.mean(at);
        [0, 1, 2].map(|i| together[i] - mean[i])
    }
}

/// The mean of a pixel over all drawings.
fn mean(drawings: &[Vec<[f64; 3]>], at: usize) -> [f64; 3] {
    let count = drawings.len() as f64;
    [0, 1, 2].map(|i| drawings.iter().map(|drawing| drawing[at][i]).sum::<f64>() / count)
}

fn moves(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).any(|i| (a[i] - b[i]).abs() > EXACT_TOLERANCE)
}

impl Found<'_> {
    /// The verdict, if no pixel is held against the shader in which it differs from the scene: there, float32 may draw other numbers as well.
    fn without_chance(self, painted: &Painted) -> (Verdict, String) {
        let maths = Answer {
            differing: 0,
            undecided: 0,
            tied: 0,
            ..self.maths.answer.clone()
        };
        let rounding = self.rounding.map(|rounding| {
            let standings = rounding.standings.iter().zip(&self.maths.standings);
            let left = standings.enumerate().filter(|&(_, (&rounding, &maths))| {
                rounding == Standing::Differs && !matches!(maths, Standing::Differs | Standing::Undecided)
            });
            // In float32, other random numbers may come of the same formula.
            let width = painted.size[0] as usize;
            let left =
                left.filter(|&(at, _)| !painted.is_redrawn([(at % width) as u32, (at / width) as u32]));
            Answer {
                differing: left.count() as u64,
                ..rounding.answer.clone()
            }
        });
        judge(Answers {
            maths: Some(&maths),
            rounding: rounding.as_ref(),
            toolchain: self.toolchain.map(|asked| &asked.answer),
        })
    }
}
