//! Images whose colors are changed in the same way everywhere: exchanged channels and color curves.

use std::collections::{BTreeMap, BTreeSet};

use toyproof_image::Image;
use toyproof_verify::Difference;
use toyproof_verify::compare::{EXACT_TOLERANCE, Pixel, PixelStatus, TOLERANCE};

use super::Alternative;
use super::curve::{Curve, Isotonic, usual};
use super::submission::Submission;
use crate::known::KnownMistake;

/// The orders of red, green and blue, other than their own.
const ORDERS: [([usize; 3], &str); 5] = [
    ([2, 1, 0], "red and blue are exchanged"),
    ([1, 0, 2], "red and green are exchanged"),
    ([0, 2, 1], "green and blue are exchanged"),
    (
        [1, 2, 0],
        "the color channels are exchanged: `.gbr` in place of `.rgb`",
    ),
    (
        [2, 0, 1],
        "the color channels are exchanged: `.brg` in place of `.rgb`",
    ),
];

/// Finds the order of the color channels that explains the image.
pub(super) fn swapped_channels(submission: &Submission) -> Option<Alternative> {
    let tolerance = submission.tolerance();
    ORDERS.iter().find_map(|&(order, text)| {
        let pixels = submission.reference.pixels().iter();
        let swapped = pixels.map(|pixel| {
            let [r, g, b] = order.map(|channel| pixel[channel]);
            [r, g, b, pixel[3]]
        });
        let [width, height] = submission.reference.size();
        let swapped = Image::new(width, height, swapped.collect());
        let agrees = |at| Pixel::at(at, &swapped, &submission.actual).difference() <= tolerance;
        submission.predicted(&swapped, agrees, || {
            KnownMistake::new(Difference::SwappedChannels.id(), text)
        })
    })
}

// Color curves.

/// A component of a pixel in both images.
#[derive(Debug, Clone, Copy)]
struct Sample {
    expected: f64,
    actual: f64,
    /// The ratios of the expected color's components, and which of them this is.
    hue: [u8; 4],
}

/// The largest level of a color component in an image of 8 bits. Colors are distinguished by such levels.
const LEVELS: f64 = 255.0;

/// The smallest number of levels that a usual curve must change and explain. Such a curve has no parameter,
/// so that four levels agree by accident with a probability of less than 10⁻⁸.
const MIN_LEVELS_OF_USUAL: usize = 4;

/// The smallest change of a level that counts.
const MIN_CHANGE: f64 = 4.0 / LEVELS;

/// The smallest number of levels on which a fitted curve must agree for several hues or channels. A curve can
/// be fitted to any levels that are there once; only if different colors have a component in common does it
/// predict the others.
const MIN_SHARED_LEVELS: usize = 24;

/// The largest number of samples to which a curve is fitted.
const MAX_FITTED: usize = 1 << 16;

/// The largest share of the samples that may be off the first fit, which they distort.
const MAX_OUTLIERS: f64 = 0.02;

/// The smallest share of the wrong pixels that differ by more than the tolerance of a curve. If fewer than
/// a hypothesis may leave unexplained do, the curve that changes nothing would explain the image.
const MIN_BEYOND_TOLERANCE: f64 = 0.2;

/// Finds the color curve that explains the image: one function of all components of all pixels.
pub(super) fn curve(submission: &Submission) -> Option<Alternative> {
    let pixels = 0..submission.statuses().len();
    let is_beyond = |&at: &usize| {
        Pixel::at(at, &submission.reference, &submission.actual).difference() > submission.tolerance()
    };
    let beyond = pixels.filter(is_beyond).count();
    if (beyond as f64) < MIN_BEYOND_TOLERANCE * submission.confirmer.before.summary.differing as f64 {
        return None;
    }
    let samples = samples(submission);
    let all = usual();
    let mut usual = all.iter().filter(|curve| explains(curve, &samples, submission));
    usual
        .find_map(|curve| {
            let distance = submission.expected().tolerance();
            predicted(
                submission,
                |expected| curve.value(expected),
                |expected, actual| {
                    let [low, high] = curve.range(expected, distance);
                    (low..=high).contains(&actual)
                },
                || format!("{THIS_CURVE}{}", curve.name),
            )
        })
        .or_else(|| fitted(submission, samples))
}

const THIS_CURVE: &str = "the colors differ only by a color curve: ";

fn samples(submission: &Submission) -> Vec<Sample> {
    let pixels = submission.statuses().iter().enumerate();
    let defined = pixels.filter(|&(_, &status)| status != PixelStatus::Undefined);
    let samples = defined.flat_map(|(at, _)| {
        let pixel = Pixel::at(at, &submission.reference, &submission.actual);
        let largest = pixel.expected.iter().fold(0.0, |most: f32, &part| most.max(part));
        let ratios = pixel.expected.map(|part| (16.0 * part / largest) as u8);
        (0..3).map(move |channel| Sample {
            expected: f64::from(pixel.expected[channel]),
            actual: f64::from(pixel.actual[channel]).clamp(0.0, 1.0),
            hue: [ratios[0], ratios[1], ratios[2], ratios[channel]],
        })
    });
    samples
        .filter(|sample| sample.expected.is_finite() && sample.actual.is_finite())
        .collect()
}

/// Whether a usual curve explains enough of the levels, of a part of the samples.
fn explains(curve: &Curve, samples: &[Sample], submission: &Submission) -> bool {
    let distance = submission.expected().tolerance();
    let step = samples.len().div_ceil(4096).max(1) | 1;
    let (mut off, mut count) = (0, 0);
    for sample in samples.iter().step_by(step) {
        let [low, high] = curve.range(sample.expected, distance);
        count += 1;
        off += usize::from(!(low..=high).contains(&sample.actual));
    }
    if off as f64 > MAX_OUTLIERS * f64::from(count) {
        return false;
    }
    let changed = samples.iter().filter(|sample| {
        let is_changed = (curve.value(sample.expected) - sample.expected.clamp(0.0, 1.0)).abs() > MIN_CHANGE;
        is_changed && sample.expected > MIN_CHANGE
    });
    let levels: BTreeSet<u64> = changed.map(|sample| level(sample.expected)).collect();
    // Neighboring levels are not independent.
    let mut apart = 0;
    let mut last = None;
    for level in levels {
        if last.is_none_or(|last| level >= last + 8) {
            apart += 1;
            last = Some(level);
        }
    }
    apart >= MIN_LEVELS_OF_USUAL
}

fn level(component: f64) -> u64 {
    (component * LEVELS) as u64
}

/// Fits a curve, if one function explains several hues or channels.
fn fitted(submission: &Submission, mut samples: Vec<Sample>) -> Option<Alternative> {
    let step = samples.len().div_ceil(MAX_FITTED).max(1) | 1;
    samples = samples.into_iter().step_by(step).collect();
    samples.sort_by(|a, b| {
        a.expected
            .total_cmp(&b.expected)
            .then(a.actual.total_cmp(&b.actual))
    });
    let tolerance = submission.tolerance() + 2.0 * (submission.expected().tolerance() - EXACT_TOLERANCE);
    let points = |samples: &[Sample]| -> Vec<[f64; 2]> {
        samples
            .iter()
            .map(|sample| [sample.expected, sample.actual])
            .collect()
    };
    let is_on = |fit: &Isotonic, expected: f64, actual: f64| {
        let [low, high] = fit.range(expected);
        (low - tolerance..=high + tolerance).contains(&actual)
    };
    let first = Isotonic::fit(&points(&samples));
    let on: Vec<Sample> = samples
        .iter()
        .copied()
        .filter(|sample| is_on(&first, sample.expected, sample.actual))
        .collect();
    let off = samples.len() - on.len();
    if on.is_empty() || off as f64 > MAX_OUTLIERS * samples.len() as f64 || !is_one_function(&on) {
        return None;
    }
    let fit = Isotonic::fit(&points(&on));
    predicted(
        submission,
        |expected| fit.at(expected),
        |expected, actual| is_on(&fit, expected, actual),
        || description(&on, &fit),
    )
}

/// Whether enough levels occur in several hues or channels, and enough of them are changed to different ones.
fn is_one_function(samples: &[Sample]) -> bool {
    let mut hues = BTreeMap::<u64, BTreeSet<[u8; 4]>>::new();
    for sample in samples {
        if sample.expected > MIN_CHANGE {
            hues.entry(level(sample.expected)).or_default().insert(sample.hue);
        }
    }
    let shared = hues.values().filter(|hues| hues.len() > 1).count();
    let values: BTreeSet<u64> = samples.iter().map(|sample| level(sample.actual)).collect();
    shared >= MIN_SHARED_LEVELS && values.len() >= MIN_SHARED_LEVELS
}

/// Describes a fitted curve: a factor, or what becomes of three levels.
fn description(samples: &[Sample], fit: &Isotonic) -> String {
    let unsaturated = samples
        .iter()
        .filter(|sample| sample.expected > MIN_CHANGE && sample.actual < 1.0);
    let ratios = unsaturated.clone().map(|sample| sample.actual / sample.expected);
    let (low, high) = ratios.fold((f64::INFINITY, 0.0_f64), |(low, high), ratio| {
        (low.min(ratio), high.max(ratio))
    });
    if high - low < 4.0 * TOLERANCE {
        return format!(
            "{THIS_CURVE}every color is multiplied by {:.3}",
            0.5 * (low + high)
        );
    }
    let range = |share: f64| samples[((samples.len() - 1) as f64 * share) as usize].expected;
    let (darkest, brightest) = (range(0.0), range(1.0).min(1.0));
    let levels = [0.25, 0.5, 0.75].map(|share| {
        let expected = darkest + share * (brightest - darkest);
        format!("{expected:.2} → {:.2}", fit.at(expected))
    });
    format!("{THIS_CURVE}{}", levels.join(", "))
}

/// Compares the whole image with the expected one after a curve.
fn predicted(
    submission: &Submission,
    curve: impl Fn(f64) -> f64,
    is_on: impl Fn(f64, f64) -> bool,
    text: impl FnOnce() -> String,
) -> Option<Alternative> {
    let [width, height] = submission.reference.size();
    let pixels = submission.reference.pixels().iter().map(|&[r, g, b, a]| {
        let [r, g, b] = [r, g, b].map(|part| curve(f64::from(part)) as f32);
        [r, g, b, a]
    });
    let curved = Image::new(width, height, pixels.collect());
    let agrees = |at| {
        let pixel = Pixel::at(at, &submission.reference, &submission.actual);
        (0..3).all(|i| {
            is_on(
                f64::from(pixel.expected[i]),
                f64::from(pixel.actual[i]).clamp(0.0, 1.0),
            )
        })
    };
    submission.predicted(&curved, agrees, || {
        KnownMistake::new(Difference::ColorCurve.id(), text())
    })
}

/// The descriptions of all kinds of differences here, as examples.
#[cfg(test)]
pub(super) fn examples() -> Vec<KnownMistake> {
    let orders = ORDERS.map(|(_, text)| KnownMistake::new(Difference::SwappedChannels.id(), text));
    let curves = usual()
        .into_iter()
        .map(|curve| format!("{THIS_CURVE}{}", curve.name));
    let curves = curves.map(|text| KnownMistake::new(Difference::ColorCurve.id(), text));
    orders.into_iter().chain(curves).collect()
}
