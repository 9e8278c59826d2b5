//! Probes: the pixels at which hypotheses are tried, each with the colors that are expected there. Either a
//! grid of pixels that is the same for all images of a frame, so that what is rendered at it can be kept; or
//! a few pixels that represent the whole image, wrong ones of every kind and right ones, the most significant
//! first.
//!
//! If a shader has its own random numbers, no pixel has an exact color. Then the difference of a hypothesis
//! from the expected means is projected onto the shader's own bias, see [`bias`](super::bias).

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use toyproof_eval::Places;
use toyproof_image::Image;
use toyproof_tracer::ColorRange;
use toyproof_verify::MAX_DIFFERING;
use toyproof_verify::compare::{EXACT_TOLERANCE, PixelStatus};
use toyproof_verify::random::NoisyPixel;
use toyproof_verify::{CheckResult, Expected};

use super::bias::{Bias, Projection, project};
use super::{Colors, colors_of, differ};

/// The number of wrong pixels at which all hypotheses are evaluated, and of a stochastic shader's, whose bias
/// is the most significant. Most of them change nothing there.
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

/// The number of probes of a stochastic shader that are evaluated first.
const FIRST_MEANS: usize = 32;

/// A pixel with its accepted colors.
#[derive(Debug, Clone)]
pub(crate) struct Probe {
    /// The pixel's center.
    pub(crate) point: [f64; 2],
    /// The color without a hypothesis.
    pub(crate) before: [f64; 3],
    range: ColorRange,
    /// How far the shader's mean is from the expected one, if it has its own random numbers.
    pub(super) bias: Option<Bias>,
    /// Whether no color but NaN is accepted.
    expects_nan: bool,
    /// Whether the color without a hypothesis is wrong.
    pub(crate) is_wrong: bool,
    /// The share of the image's pixels that it represents.
    share: f64,
}

/// The probes, in the order in which they are evaluated.
#[derive(Debug, Clone)]
pub(crate) struct Probes {
    pub(crate) all: Vec<Probe>,
    /// The grid whose pixels they are, row by row.
    pub(crate) grid: Option<Places>,
    limits: Limits,
}

/// How much an explanation may leave wrong.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// The largest distance of a color from the accepted ones.
    pub(crate) tolerance: f64,
    /// The largest shares of all probes, and of the wrong ones.
    pub(crate) of_all: f64,
    pub(crate) of_wrong: f64,
    /// A number of probes in addition.
    pub(crate) extra: usize,
    /// The largest estimated shares of the image's pixels, and of the wrong pixels, with which more probes
    /// may be left wrong: rare kinds have more probes than pixels.
    pub(crate) of_image: Option<[f64; 2]>,
}

/// Of edits, which are confirmed on whole images: an edit moves edges, and a probe may lie on one. A verdict
/// tolerates a few pixels.
const EDIT_LIMITS: Limits = Limits {
    tolerance: EXACT_TOLERANCE,
    of_all: 0.01,
    of_wrong: f64::INFINITY,
    extra: 0,
    of_image: Some([2.0 * MAX_DIFFERING, 0.25]),
};

impl Limits {
    /// The largest number of probes that may be left wrong.
    pub(crate) fn most(&self, all: usize, wrong: usize) -> usize {
        (self.of_all * all as f64).min(self.of_wrong * wrong as f64) as usize + self.extra
    }
}

/// The effect of a hypothesis at the probes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Outcome {
    /// The number of wrong pixels that it repairs.
    pub(crate) repaired: usize,
    /// The number of right pixels that it breaks.
    pub(crate) broken: usize,
    /// The number of probes that were evaluated.
    pub(crate) evaluated: usize,
    /// The number of evaluated probes that are still wrong.
    pub(crate) left: usize,
    /// The share of the differences that remains, of the wrong pixels that were evaluated; 1 without an edit.
    pub(crate) remaining: f64,
    /// Whether it may explain the image: at most a few of all probes are wrong.
    pub(crate) passes: bool,
}

impl Outcome {
    /// Whether it may be half of an explanation.
    pub(crate) fn is_progress(&self) -> bool {
        self.repaired > self.broken || (self.broken == 0 && self.remaining < 1.0 - MIN_PROGRESS)
    }
}

/// The share of the differences that half of an explanation must remove.
const MIN_PROGRESS: f64 = 0.25;

impl Probes {
    // The choice of pixels.

    /// All pixels of a grid, with the colors that a hypothesis must have there and those without one.
    pub(crate) fn on_grid(grid: &Places, expected: &Image, before: &Image, limits: Limits) -> Self {
        let columns = grid.columns.len();
        let probe = |(at, color): (usize, [f64; 3])| Probe {
            range: exactly(color),
            expects_nan: color.iter().any(|part| part.is_nan()),
            ..Probe::new([grid.columns[at % columns], grid.rows[at / columns]])
        };
        let probes = Self {
            all: colors_of(expected).into_iter().enumerate().map(probe).collect(),
            grid: Some(grid.clone()),
            limits,
        };
        probes.with_before(&colors_of(before))
    }

    /// Selects probes from the pixels of the algorithm check of an image `width` pixels wide. Pixels that are
    /// excluded there are not probed. `None` if no pixel is wrong.
    pub(crate) fn select(check: &CheckResult, expected: &Expected, width: usize) -> Option<Self> {
        // Pixels that agree have the reference's color; those of the others are kept as far as there is room.
        let actual = |at: usize| {
            check
                .actual
                .get(&at)
                .map_or([0.0; 3], |color| color.map(f64::from))
        };
        let pixels = |wanted: PixelStatus| -> Vec<usize> {
            let statuses = check.statuses.iter().enumerate();
            statuses
                .filter(|&(_, &status)| status == wanted)
                .map(|(at, _)| at)
                .collect()
        };
        let pixel = |at: usize| [(at % width) as u32, (at / width) as u32];
        let reference = |at: usize| {
            let [x, y] = pixel(at);
            expected.pixel(x, y)
        };
        let (wrong, right) = (pixels(PixelStatus::Differs), pixels(PixelStatus::Agrees));
        let all = (wrong.len() + right.len()) as f64;
        let shares = [&wrong, &right].map(|pixels| pixels.len() as f64 / all);
        let wrong = spread(&thinned(&wrong), MAX_WRONG, |at| {
            kind(&[reference(at), actual(at)])
        });
        let right = spread(&thinned(&right), MAX_RIGHT, |at| kind(&[reference(at)]));
        let probe = |(at, share): (usize, f64), is_wrong: bool| {
            let [x, y] = pixel(at);
            Probe {
                range: expected.color_range(x, y),
                is_wrong,
                share: share * shares[usize::from(!is_wrong)],
                ..Probe::new([x, y].map(|at| f64::from(at) + 0.5))
            }
        };
        let wrong = wrong.into_iter().map(|at| probe(at, true));
        let right = right.into_iter().map(|at| probe(at, false));
        Self::in_order(wrong.collect(), right.collect(), EDIT_LIMITS)
    }

    /// Some of the probes of a grid, of all kinds of colors; `None` if none is wrong.
    pub(crate) fn selection(&self) -> Option<Self> {
        let of = |is_wrong: bool, most: usize| -> Vec<Probe> {
            let pixels = (0..self.all.len()).filter(|&at| self.all[at].is_wrong == is_wrong);
            let pixels: Vec<usize> = pixels.collect();
            let kind = |at: usize| kind(&[self.all[at].range.low, self.all[at].before]);
            let selected = spread(&thinned(&pixels), most, kind).into_iter();
            selected.map(|(at, _)| self.all[at].clone()).collect()
        };
        Self::in_order(of(true, MAX_WRONG), of(false, MAX_RIGHT), self.limits)
    }

    /// Probes of a stochastic shader. `None` if no pixel is significantly biased.
    pub(crate) fn of_means(pixels: &[NoisyPixel], places: &Places) -> Option<Self> {
        let columns = &places.columns;
        let probe = |(at, pixel): (usize, &NoisyPixel)| {
            let bias = Bias::new(pixel);
            Probe {
                range: exactly(pixel.reference),
                is_wrong: bias.is_significant(pixel),
                bias: Some(bias),
                ..Probe::new([columns[at % columns.len()], places.rows[at / columns.len()]])
            }
        };
        let probes = pixels.iter().enumerate().map(probe);
        let (wrong, right): (Vec<Probe>, Vec<Probe>) = probes.partition(|probe| probe.is_wrong);
        let shuffled = |probes: &[Probe]| -> Vec<Probe> {
            let order = bit_reversed(probes.len()).into_iter();
            order.map(|at| probes[at].clone()).collect()
        };
        let mut wrong = shuffled(&wrong);
        let significance = |probe: &Probe| probe.bias.map_or(0.0, Bias::significance);
        wrong.sort_by(|a, b| significance(b).total_cmp(&significance(a)));
        let first = wrong.len().min(SCREENING_MEANS);
        let rest = shuffled(&wrong[first..]);
        wrong.truncate(first);
        wrong.extend(rest);
        Self::in_order(wrong, shuffled(&right), EDIT_LIMITS)
    }

    /// The probes in their order; `None` if no probe is wrong.
    fn in_order(wrong: Vec<Probe>, right: Vec<Probe>, limits: Limits) -> Option<Self> {
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
        (count > 0).then_some(Self {
            all,
            grid: None,
            limits,
        })
    }

    /// Some of the probes.
    pub(crate) fn part(&self, range: Range<usize>) -> Cow<'_, Self> {
        if range == (0..self.all.len()) {
            return Cow::Borrowed(self);
        }
        Cow::Owned(Self {
            all: self.all[range].to_vec(),
            grid: None,
            limits: self.limits,
        })
    }

    /// The same probes of an image that has these colors without a hypothesis.
    pub(crate) fn with_before(mut self, colors: &[[f64; 3]]) -> Self {
        let are_means = self.are_means();
        for (probe, &color) in self.all.iter_mut().zip(colors) {
            probe.before = color;
            // A single evaluation says nothing about means.
            probe.is_wrong = if are_means {
                probe.is_wrong
            } else {
                probe.distance(color) > self.limits.tolerance
            };
        }
        self
    }

    /// The same probes for a shader that has these colors there; `None` if all are right.
    pub(crate) fn with_colors(self, colors: &[[f64; 3]]) -> Option<Self> {
        let limits = self.limits;
        let is_in_order = self.are_means();
        let probes = self.with_before(colors);
        if is_in_order {
            return Some(probes);
        }
        let (wrong, right) = probes.all.into_iter().partition(|probe| probe.is_wrong);
        Self::in_order(wrong, right, limits)
    }

    // What the probes say.

    /// The number of wrong probes.
    pub(crate) fn wrong(&self) -> usize {
        self.all.iter().filter(|probe| probe.is_wrong).count()
    }

    /// Whether the shader has its own random numbers.
    pub(crate) fn are_means(&self) -> bool {
        self.all.iter().any(|probe| probe.bias.is_some())
    }

    /// Whether a color is wrong at a probe.
    pub(crate) fn is_wrong(&self, probe: &Probe, color: [f64; 3]) -> bool {
        probe.distance(color) > self.limits.tolerance
    }

    /// Whether a color differs from that without a hypothesis.
    pub(crate) fn is_changed(&self, probe: &Probe, color: [f64; 3]) -> bool {
        differ(color, probe.before, self.limits.tolerance)
    }

    /// The number of probes at which all hypotheses are evaluated.
    pub(crate) fn screening(&self) -> usize {
        match (&self.grid, self.are_means()) {
            (Some(_), _) => self.all.len(),
            (None, true) => SCREENING_MEANS.min(self.all.len()),
            (None, false) => SCREENING.min(self.all.len()),
        }
    }

    /// Tests a hypothesis. `colors` returns its colors at some of the probes; if it returns `None`, so does
    /// this function.
    pub(crate) fn test(&self, mut colors: impl FnMut(Range<usize>) -> Option<Colors>) -> Option<Outcome> {
        let are_means = self.are_means();
        let first = match &self.grid {
            Some(_) => self.all.len(),
            None => (if are_means { FIRST_MEANS } else { FIRST }).min(self.all.len()),
        };
        let mut all = colors(0..first)?;
        let outcome = self.outcome(&all)?;
        // Partial repairs are worth more probes: two of them may be one repair.
        let improves = !are_means && outcome.repaired > 0 && outcome.broken == 0;
        if first == self.all.len() || !(outcome.passes || improves) {
            return Some(outcome);
        }
        all.extend(colors(first..self.all.len())?);
        self.outcome(&all)
    }

    /// The effect of a hypothesis, by its colors at the first probes; `None` if their mean is not a number.
    pub(crate) fn outcome(&self, colors: &[[f64; 3]]) -> Option<Outcome> {
        if self.are_means() {
            let projection = self.project(colors)?;
            return Some(Outcome {
                evaluated: colors.len(),
                remaining: projection.remaining(),
                passes: projection.is_small(),
                ..Outcome::default()
            });
        }
        let mut outcome = Outcome {
            evaluated: colors.len(),
            ..Outcome::default()
        };
        let (mut old_error, mut new_error, mut left_share) = (0.0, 0.0, 0.0);
        for (probe, &color) in self.all.iter().zip(colors) {
            let distance = probe.distance(color);
            let is_right = distance <= self.limits.tolerance;
            left_share += if is_right { 0.0 } else { probe.share };
            outcome.left += usize::from(!is_right);
            if probe.is_wrong {
                outcome.repaired += usize::from(is_right);
                // The distance of NaN is infinite.
                old_error += probe.distance(probe.before).min(1.0);
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
        outcome.passes = outcome.left <= self.limits.most(self.all.len(), self.wrong())
            || self
                .limits
                .of_image
                .is_some_and(|limits| left_share <= self.max_left_share(limits));
        Some(outcome)
    }

    /// The largest share of the image's pixels that may be left wrong.
    fn max_left_share(&self, [of_image, of_wrong]: [f64; 2]) -> f64 {
        let wrong = self.all.iter().filter(|probe| probe.is_wrong);
        let wrong: f64 = wrong.map(|probe| probe.share).sum();
        of_image.min(of_wrong * wrong)
    }

    /// The part of the shader's bias that some colors still have, by a single evaluation of each of the first
    /// probes; `None` if they are not finite.
    pub(crate) fn project(&self, colors: &[[f64; 3]]) -> Option<Projection> {
        project(
            self.all
                .iter()
                .zip(colors)
                .map(|(probe, color)| (probe.bias, color)),
        )
    }
}

impl Probe {
    fn new(point: [f64; 2]) -> Self {
        let any = ColorRange {
            low: [0.0; 3],
            high: [1.0; 3],
        };
        Self {
            point,
            before: [0.0; 3],
            range: any,
            bias: None,
            expects_nan: false,
            is_wrong: false,
            share: 0.0,
        }
    }

    /// The distance of a color from the accepted ones; infinite for NaN, unless NaN is expected.
    pub(crate) fn distance(&self, color: [f64; 3]) -> f64 {
        match (self.expects_nan, color.iter().any(|part| part.is_nan())) {
            (true, true) => 0.0,
            (true, false) => f64::INFINITY,
            (false, _) => self.range.distance(color),
        }
    }

    /// The accepted color, in the middle of its range.
    pub(crate) fn target(&self) -> [f64; 3] {
        std::array::from_fn(|i| f64::midpoint(self.range.low[i], self.range.high[i]).clamp(0.0, 1.0))
    }
}

/// The range of one color.
fn exactly(color: [f64; 3]) -> ColorRange {
    ColorRange {
        low: color,
        high: color,
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
    pub(crate) fn exact(color: [f64; 3], is_wrong: bool) -> Self {
        Self {
            range: exactly(color),
            before: color,
            is_wrong,
            ..Self::new([0.5; 2])
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
