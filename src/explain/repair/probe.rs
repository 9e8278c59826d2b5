//! Probes: a few pixels that represent the whole image, wrong ones of every kind and right ones. A candidate
//! is evaluated at them, the most significant first, and rejected as soon as too many are wrong.
//!
//! If a shader has its own random numbers, no pixel has an exact color. Then the difference of a
//! candidate from the expected means is projected onto the shader's own bias ([`Bias`]).

use std::collections::BTreeMap;
use std::ops::Range;

use toyproof_eval::Places;
use toyproof_tracer::ColorRange;
use toyproof_verify::MAX_DIFFERING;
use toyproof_verify::compare::{EXACT_TOLERANCE, PixelStatus};
use toyproof_verify::random::MEAN_SETS;
use toyproof_verify::random::NoisyPixel;
use toyproof_verify::{CheckResult, Expected};

/// The number of wrong pixels at which all candidates are evaluated, and of a stochastic shader's, whose bias
/// is the most significant. Most candidates change nothing there.
const SCREENING: usize = 4;
const SCREENING_MEANS: usize = 8;

/// The number of wrong and of right pixels that are probed.
const MAX_WRONG: usize = 200;
const MAX_RIGHT: usize = 120;

/// The number of probes that are evaluated next, and how many of them are wrong pixels. Most of the others
/// fail there.
const FIRST: usize = 16;
const FIRST_WRONG: usize = 12;

/// The numbers of wrong and of right pixels that follow alternately.
const MIXED_WRONG: usize = 5;
const MIXED_RIGHT: usize = 3;

/// The share of probes that a repair may leave wrong: an edit moves edges, and a probe may lie on one.
const MAX_LEFT_SHARE: f64 = 0.01;

/// The estimated share of the image's pixels that a repair may leave wrong, and of the wrong pixels: a
/// verdict tolerates some, whose kinds have more probes than pixels. The confirmation compares all pixels.
const MAX_LEFT_OF_IMAGE: f64 = 2.0 * MAX_DIFFERING;
const MAX_LEFT_OF_WRONG: f64 = 0.25;

/// The number of probes of a stochastic shader that are evaluated first.
const FIRST_MEANS: usize = 32;

/// The significance of a pixel's bias, in standard deviations, and the least difference of a biased one.
const MIN_DEVIATIONS: f64 = 2.0;
const LEAST_DIFFERENCE: f64 = 1e-3;

/// The least variance of a pixel in weights: models of noise are not exact.
const LEAST_VARIANCE: f64 = 1e-4;

/// The largest amplitude and the largest share of the squared bias that a repair leaves, and the significance
/// of exceeding them, in standard deviations. The confirmation is stricter.
const MAX_AMPLITUDE: f64 = 0.15;
const MAX_REMAINING: f64 = 0.1;
const MAX_DEVIATIONS: f64 = 3.0;

/// A pixel with its accepted colors.
#[derive(Debug, Clone)]
pub(super) struct Probe {
    /// The pixel's center.
    pub(super) point: [f64; 2],
    range: ColorRange,
    /// How far the shader's mean is from the expected one, if it has its own random numbers.
    bias: Option<Bias>,
    /// Whether the shader is wrong there.
    pub(super) is_wrong: bool,
    /// The share of the image's pixels that it represents.
    share: f64,
}

/// The bias of a pixel of a stochastic shader.
#[derive(Debug, Clone, Copy)]
struct Bias {
    /// The expected mean of each component.
    mean: [f64; 3],
    /// The difference of the shader's mean from it.
    difference: [f64; 3],
    /// The variance of one evaluation of the pixel.
    variance: [f64; 3],
}

/// The probes, in the order in which they are evaluated.
#[derive(Debug, Clone)]
pub(super) struct Probes {
    pub(super) all: Vec<Probe>,
}

/// The effect of a candidate at the probes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Outcome {
    /// The number of wrong pixels that it repairs.
    pub(super) repaired: usize,
    /// The number of right pixels that it breaks.
    pub(super) broken: usize,
    /// The number of probes that were evaluated.
    pub(super) evaluated: usize,
    /// The share of the differences that remains, of the wrong pixels that were evaluated; 1 without an edit.
    pub(super) remaining: f64,
    /// Whether it may be a repair: at most a few of all probes are wrong.
    pub(super) passes: bool,
}

impl Probes {
    /// Selects probes from the pixels of the algorithm check of an image `width` pixels wide. Pixels that are
    /// excluded there are not probed. `None` if no pixel is wrong.
    pub(super) fn select(check: &CheckResult, expected: &Expected, width: usize) -> Option<Self> {
        // Pixels that agree have the reference's color; those of the others are kept as far as there is room.
        let actual = |at: usize| {
            check
                .actual
                .get(&at)
                .map_or([0.0; 3], |color| color.map(f64::from))
        };
        let pixels = |wanted: PixelStatus| {
            let statuses = check.statuses.iter().enumerate();
            statuses
                .filter(move |&(_, &status)| status == wanted)
                .map(|(at, _)| at)
        };
        let pixel = |at: usize| [(at % width) as u32, (at / width) as u32];
        let reference = |at: usize| {
            let [x, y] = pixel(at);
            expected.pixel(x, y)
        };
        let wrong: Vec<usize> = pixels(PixelStatus::Differs).collect();
        let right: Vec<usize> = pixels(PixelStatus::Agrees).collect();
        let all = (wrong.len() + right.len()) as f64;
        let shares = [&wrong, &right].map(|pixels| pixels.len() as f64 / all);
        let wrong = spread(&thinned(&wrong), MAX_WRONG, |at| {
            kind(&[reference(at), actual(at)])
        });
        let right = spread(&thinned(&right), MAX_RIGHT, |at| kind(&[reference(at)]));
        let probe = |(at, share): (usize, f64), is_wrong: bool| {
            let [x, y] = pixel(at);
            Probe {
                point: [f64::from(x) + 0.5, f64::from(y) + 0.5],
                range: expected.color_range(x, y),
                bias: None,
                is_wrong,
                share: share * shares[usize::from(!is_wrong)],
            }
        };
        let wrong = wrong.into_iter().map(|at| probe(at, true));
        let right = right.into_iter().map(|at| probe(at, false));
        Self::of(wrong.collect(), right.collect())
    }

    /// The probes in their order; `None` if no probe is wrong.
    fn of(wrong: Vec<Probe>, right: Vec<Probe>) -> Option<Self> {
        let count = wrong.len();
        let (mut wrong, mut right) = (wrong.into_iter(), right.into_iter());
        let mut all: Vec<Probe> = wrong.by_ref().take(FIRST_WRONG).collect();
        all.extend(right.by_ref().take(FIRST - FIRST_WRONG));
        // Each prefix has both kinds.
        loop {
            let before = all.len();
            all.extend(wrong.by_ref().take(MIXED_WRONG));
            all.extend(right.by_ref().take(MIXED_RIGHT));
            if all.len() == before {
                break;
            }
        }
        (count > 0).then_some(Self { all })
    }

    /// Probes of a stochastic shader. `None` if no pixel is significantly biased.
    pub(super) fn of_means(pixels: &[NoisyPixel], places: &Places) -> Option<Self> {
        let columns = &places.columns;
        let probe = |(at, pixel): (usize, &NoisyPixel)| {
            let difference: [f64; 3] = std::array::from_fn(|i| pixel.own[i] - pixel.reference[i]);
            let is_biased = |i: usize| {
                let deviation = pixel.variance[i].sqrt().max(LEAST_DIFFERENCE);
                difference[i].abs() > MIN_DEVIATIONS * deviation
            };
            Probe {
                point: [columns[at % columns.len()], places.rows[at / columns.len()]],
                range: ColorRange {
                    low: pixel.reference,
                    high: pixel.reference,
                },
                bias: Some(Bias {
                    mean: pixel.reference,
                    difference,
                    // The means are over several sets of random numbers.
                    variance: pixel.variance.map(|variance| variance * MEAN_SETS as f64),
                }),
                is_wrong: (0..3).any(is_biased),
                share: 0.0,
            }
        };
        let (wrong, right): (Vec<Probe>, Vec<Probe>) = pixels
            .iter()
            .enumerate()
            .map(probe)
            .partition(|probe| probe.is_wrong);
        let shuffled = |probes: &[Probe]| -> Vec<Probe> {
            let order = bit_reversed(probes.len()).into_iter();
            order.map(|at| probes[at].clone()).collect()
        };
        let mut wrong = shuffled(&wrong);
        wrong.sort_by(|a, b| b.significance().total_cmp(&a.significance()));
        let first = wrong.len().min(SCREENING_MEANS);
        let rest = shuffled(&wrong[first..]);
        wrong.truncate(first);
        wrong.extend(rest);
        Self::of(wrong, shuffled(&right))
    }

    /// The first probes.
    pub(super) fn truncated(&self, count: usize) -> Self {
        Self {
            all: self.all[..count.min(self.all.len())].to_vec(),
        }
    }

    /// Whether the shader has its own random numbers.
    pub(super) fn are_means(&self) -> bool {
        self.all.iter().any(|probe| probe.bias.is_some())
    }

    /// The same probes for a shader that has these colors there; `None` if all are right. A single evaluation
    /// says nothing about means.
    pub(super) fn with_colors(&self, colors: &[[f64; 3]]) -> Option<Self> {
        if self.are_means() {
            return Some(self.clone());
        }
        let probes = self.all.iter().zip(colors).map(|(probe, &color)| Probe {
            is_wrong: probe.distance(color) > EXACT_TOLERANCE,
            ..probe.clone()
        });
        let (wrong, right) = probes.partition(|probe| probe.is_wrong);
        Self::of(wrong, right)
    }

    /// The largest number of probes that a repair may leave wrong.
    fn max_left(&self) -> usize {
        (MAX_LEFT_SHARE * self.all.len() as f64) as usize
    }

    /// The largest share of the image's pixels that a repair may leave wrong.
    fn max_left_share(&self) -> f64 {
        let wrong = self.all.iter().filter(|probe| probe.is_wrong);
        let wrong: f64 = wrong.map(|probe| probe.share).sum();
        MAX_LEFT_OF_IMAGE.min(MAX_LEFT_OF_WRONG * wrong)
    }

    /// The number of probes at which all candidates are evaluated.
    pub(super) fn screening(&self) -> usize {
        let count = if self.are_means() {
            SCREENING_MEANS
        } else {
            SCREENING
        };
        count.min(self.all.len())
    }

    /// Tests an edit. `colors` returns its colors at some of the probes; if it returns `None`, so does this
    /// function. `before` are the colors without edits.
    pub(super) fn test(
        &self,
        before: &[[f64; 3]],
        mut colors: impl FnMut(Range<usize>) -> Option<Vec<[f64; 3]>>,
    ) -> Option<Outcome> {
        let are_means = self.are_means();
        let first = if are_means { FIRST_MEANS } else { FIRST }.min(self.all.len());
        let mut all = colors(0..first)?;
        let outcome = self.outcome(&all, before)?;
        // Partial repairs are worth more probes: two of them may be one repair.
        let improves = !are_means && outcome.repaired > 0 && outcome.broken == 0;
        if !outcome.passes && !improves {
            return Some(outcome);
        }
        all.extend(colors(first..self.all.len())?);
        self.outcome(&all, before)
    }

    /// The effect of an edit, by its colors at the first probes; `None` if their mean is not a number.
    pub(super) fn outcome(&self, colors: &[[f64; 3]], before: &[[f64; 3]]) -> Option<Outcome> {
        if self.are_means() {
            return self.outcome_of_means(colors);
        }
        let mut outcome = Outcome {
            evaluated: colors.len(),
            ..Outcome::default()
        };
        let (mut wrong, mut old_error, mut new_error, mut left) = (0, 0.0, 0.0, 0.0);
        for ((probe, &color), &before) in self.all.iter().zip(colors).zip(before) {
            let distance = probe.distance(color);
            let is_right = distance <= EXACT_TOLERANCE;
            left += if is_right { 0.0 } else { probe.share };
            if probe.is_wrong {
                wrong += 1;
                outcome.repaired += usize::from(is_right);
                // The distance of NaN is infinite.
                old_error += probe.distance(before).min(1.0);
                new_error += distance.min(1.0);
            } else {
                outcome.broken += usize::from(!is_right);
            }
        }
        outcome.remaining = if old_error > 0.0 {
            new_error / old_error
        } else {
            1.0
        };
        outcome.passes =
            wrong - outcome.repaired + outcome.broken <= self.max_left() || left <= self.max_left_share();
        Some(outcome)
    }

    /// The effect of an edit of a stochastic shader, by a single evaluation of each of the first probes.
    fn outcome_of_means(&self, colors: &[[f64; 3]]) -> Option<Outcome> {
        let projection = self.project(colors)?;
        let is_unbiased = projection.amplitude.abs() <= MAX_AMPLITUDE + MAX_DEVIATIONS * projection.deviation;
        let limit = MAX_REMAINING + MAX_DEVIATIONS * projection.remaining_deviation;
        Some(Outcome {
            evaluated: colors.len(),
            remaining: projection.remaining.clamp(0.0, 2.0),
            passes: is_unbiased && projection.remaining <= limit,
            ..Outcome::default()
        })
    }

    /// The part of the shader's bias that some colors still have, by a single evaluation of each of the first
    /// probes; `None` if they are not finite.
    pub(super) fn project(&self, colors: &[[f64; 3]]) -> Option<Projection> {
        let [mut product, mut square, mut variance, mut left, mut left_variance] = [0.0; 5];
        for (probe, color) in self.all.iter().zip(colors) {
            let bias = probe.bias.as_ref()?;
            for (i, part) in color.iter().enumerate() {
                let rest = part.clamp(0.0, 1.0) - bias.mean[i];
                if !rest.is_finite() {
                    return None;
                }
                let weight = 1.0 / (bias.variance[i] + LEAST_VARIANCE);
                product += weight * bias.difference[i] * rest;
                square += weight * bias.difference[i].powi(2);
                variance += weight.powi(2) * bias.difference[i].powi(2) * bias.variance[i];
                left += weight * (rest * rest - bias.variance[i]);
                left_variance += 2.0 * (weight * bias.variance[i]).powi(2);
            }
        }
        (square > 0.0).then(|| Projection {
            amplitude: product / square,
            deviation: variance.sqrt() / square,
            remaining: left / square,
            remaining_deviation: left_variance.sqrt() / square,
        })
    }
}

/// The differences of colors from expected means, compared with the shader's bias.
pub(super) struct Projection {
    /// 1 for the shader itself, 0 for an unbiased one; and its standard deviation.
    pub(super) amplitude: f64,
    deviation: f64,
    /// The squared bias as a share of the shader's, and its standard deviation.
    remaining: f64,
    remaining_deviation: f64,
}

impl Probe {
    /// How much larger the bias is than the deviation of one evaluation; 0 without random numbers.
    fn significance(&self) -> f64 {
        let significance = |bias: Bias| -> f64 {
            (0..3)
                .map(|i| bias.difference[i].powi(2) / (bias.variance[i] + LEAST_VARIANCE))
                .sum()
        };
        self.bias.map_or(0.0, significance)
    }

    /// The distance of a color from the accepted ones; infinite for NaN.
    pub(super) fn distance(&self, color: [f64; 3]) -> f64 {
        self.range.distance(color)
    }

    /// The accepted color, in the middle of its range.
    pub(super) fn target(&self) -> [f64; 3] {
        std::array::from_fn(|i| f64::midpoint(self.range.low[i], self.range.high[i]).clamp(0.0, 1.0))
    }
}

/// The largest number of pixels that are classified.
const MAX_CLASSIFIED: usize = 4096;

/// Some of the pixels, evenly spread.
fn thinned(pixels: &[usize]) -> Vec<usize> {
    let count = pixels.len().min(MAX_CLASSIFIED);
    (0..count)
        .map(|at| pixels[(2 * at + 1) * pixels.len() / (2 * count)])
        .collect()
}

/// The kind of a pixel: its colors in few levels.
fn kind(colors: &[[f64; 3]]) -> u32 {
    let levels = colors
        .iter()
        .flatten()
        .map(|part| (part.clamp(0.0, 1.0) * 3.999) as u32);
    levels.fold(0, |kind, level| kind * 4 + level)
}

/// Selects pixels of all kinds, alternately, and within a kind evenly spread. Each has the share of the
/// pixels that it represents.
fn spread(pixels: &[usize], most: usize, kind: impl Fn(usize) -> u32) -> Vec<(usize, f64)> {
    let mut kinds: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for &pixel in pixels {
        kinds.entry(kind(pixel)).or_default().push(pixel);
    }
    let mut kinds: Vec<Vec<usize>> = kinds.into_values().collect();
    kinds.sort_by_key(|pixels| std::cmp::Reverse(pixels.len()));
    let orders: Vec<Vec<usize>> = kinds.iter().map(|pixels| bit_reversed(pixels.len())).collect();
    let mut selected = Vec::new();
    let mut counts = vec![0; kinds.len()];
    let rounds = kinds.iter().map(Vec::len).max().unwrap_or(0);
    'all: for round in 0..rounds {
        for (kind, order) in orders.iter().enumerate() {
            if selected.len() == most {
                break 'all;
            }
            if let Some(&at) = order.get(round) {
                selected.push((kinds[kind][at], kind));
                counts[kind] += 1;
            }
        }
    }
    let share = |kind: usize| kinds[kind].len() as f64 / (counts[kind] * pixels.len()) as f64;
    selected
        .into_iter()
        .map(|(pixel, kind)| (pixel, share(kind)))
        .collect()
}

/// The numbers below `count`, each prefix of them spread evenly (van der Corput).
fn bit_reversed(count: usize) -> Vec<usize> {
    let bits = usize::BITS - count.saturating_sub(1).leading_zeros();
    let reversed = |at: usize| {
        if bits == 0 {
            0
        } else {
            at.reverse_bits() >> (usize::BITS - bits)
        }
    };
    (0..1 << bits).map(reversed).filter(|&at| at < count).collect()
}

#[cfg(test)]
impl Probe {
    /// A probe whose only accepted color is this.
    pub(super) fn exact(color: [f64; 3], is_wrong: bool) -> Self {
        Self {
            point: [0.5; 2],
            range: ColorRange {
                low: color,
                high: color,
            },
            bias: None,
            is_wrong,
            share: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_projection_tells_the_biased_shader_from_the_unbiased_one() {
        let places = Places {
            columns: (0..8).map(f64::from).collect(),
            rows: (0..4).map(f64::from).collect(),
        };
        // The left half of each row is too bright by 0.2.
        let bias = |at: usize| if at % 8 < 4 { 0.2 } else { 0.0 };
        let pixels: Vec<NoisyPixel> = (0..32)
            .map(|at| NoisyPixel {
                own: [0.4 + bias(at); 3],
                reference: [0.4; 3],
                variance: [1e-6; 3],
            })
            .collect();
        let probes = Probes::of_means(&pixels, &places).unwrap();
        assert_eq!(probes.all.iter().filter(|probe| probe.is_wrong).count(), 16);
        let amplitude = |color: &dyn Fn(&Probe) -> f64| {
            let colors: Vec<_> = probes.all.iter().map(|probe| [color(probe); 3]).collect();
            probes.project(&colors).unwrap().amplitude
        };
        let is_left = |probe: &Probe| probe.point[0] < 4.0;
        let own = amplitude(&|probe| if is_left(probe) { 0.6 } else { 0.4 });
        assert!((own - 1.0).abs() < 1e-12, "{own}");
        assert!(amplitude(&|_| 0.4).abs() < 1e-12);
        assert!(probes.project(&[[f64::NAN; 3]]).is_none());
    }

    #[test]
    fn pixels_of_rare_kinds_come_first() {
        let pixels: Vec<usize> = (0..1000).collect();
        let selected = spread(&pixels, 20, |at| u32::from(at == 500));
        assert_eq!(selected.len(), 20);
        assert_eq!(selected[1].0, 500);
        let share: f64 = selected.iter().map(|(_, share)| share).sum();
        assert!(
            (share - 1.0).abs() < 1e-12 && selected[1].1 == 0.001,
            "{selected:?}"
        );
        assert_eq!(spread(&pixels[..3], 20, |_| 0).len(), 3);
    }

    #[test]
    fn each_prefix_is_spread() {
        assert_eq!(bit_reversed(8), [0, 4, 2, 6, 1, 5, 3, 7]);
        let mut all = bit_reversed(100);
        assert!(all[..8].windows(2).all(|pair| pair[0].abs_diff(pair[1]) > 8));
        all.sort_unstable();
        assert!(all.into_iter().eq(0..100));
        assert_eq!((bit_reversed(0), bit_reversed(1)), (vec![], vec![0]));
    }
}
