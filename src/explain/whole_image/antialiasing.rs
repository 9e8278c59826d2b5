//! Shaders that take several samples of each pixel, where the reference takes one.
//!
//! The usual regular grids are tried as they are. Other samples are recognized by what all means of samples
//! have in common: a pixel's color lies between the colors within the pixel, and nearer to their mean than a
//! single sample does. A blur has colors from other pixels; a shifted image has single samples.

use rayon::prelude::*;
use toyproof_eval::Places;
use toyproof_verify::Difference;
use toyproof_verify::Expected;
use toyproof_verify::compare::PixelStatus;

use super::Alternative;
use super::submission::Submission;
use crate::known::KnownMistake;

/// The usual numbers of samples along each axis.
const SIDES: [u32; 6] = [2, 3, 4, 5, 6, 8];

/// The first sample of a grid, from the center of the pixel: as a share of the distance of samples, and in
/// pixels. Grids are centered, or begin at an edge of the pixel, or at its center.
const STARTS: [[f64; 2]; 3] = [[0.5, -0.5], [0.0, -0.5], [0.0, 0.0]];

/// Offsets of samples from the center of the pixel, the same for x and y.
fn grid(side: u32, [share, start]: [f64; 2]) -> Vec<f64> {
    (0..side)
        .map(|at| (f64::from(at) + share) / f64::from(side) + start)
        .collect()
}

/// The largest number of rows at which a grid is tried.
const MAX_PROBED_ROWS: usize = 12;

/// The largest number of pixels of a row at which a grid is tried.
const MAX_PROBED_COLUMNS: usize = 24;

/// The share of the probed pixels that must agree.
const MIN_PROBES: f64 = 0.95;

/// The largest number of samples of the reference that are taken.
const MAX_SAMPLES: usize = 1 << 23;

/// The number of samples along each axis that show which colors occur within a pixel, its edges included.
const WITHIN: u32 = 9;

/// How far a color may be outside of those within its pixel, as a share of their range: there may be smaller
/// features than the samples show.
const MARGIN: f64 = 0.05;

/// The smallest range of colors within an edge pixel. The color of such a pixel shows how it is sampled.
const MIN_RANGE: f64 = 0.05;

/// The smallest number of edge pixels.
const MIN_EDGE_PIXELS: u64 = 24;

/// The smallest number of independent samples whose means scatter as little as the colors do.
const MIN_EFFECTIVE_SAMPLES: f64 = 2.0;

/// The largest sum of squared distances to the means within the pixels, as a share of the sum of those to the
/// colors at the pixels' centers. For n samples it is 1/(n + 1); where a color is wrong for another reason,
/// both sums are equal.
const MAX_UNEXPLAINED: f64 = 0.4;

/// The smallest share of edge pixels with an intermediate color.
const MIN_INTERMEDIATE: f64 = 0.3;

/// Finds the samples of each pixel that explain the image.
pub(super) fn find(submission: &Submission) -> Option<Alternative> {
    // The random numbers of a reference move within pixels themselves.
    if submission.expected().is_stochastic() {
        return None;
    }
    let rows = Rows::differing(submission);
    let probes = rows.thinned();
    // The first evaluation also shows whether the reference has a color everywhere.
    within(submission, &probes).filter(Statistics::is_within)?;
    let grids = SIDES
        .into_iter()
        .flat_map(|side| STARTS.map(|start| (side, start)));
    let exact = grids.into_iter().find_map(|(side, start)| {
        let offsets = grid(side, start);
        let agreeing = means(submission, &probes, &offsets)?.len();
        if (agreeing as f64) < MIN_PROBES * probes.count() as f64 {
            return None;
        }
        predicted(submission, means(submission, &rows, &offsets)?, || {
            format!("each pixel is the mean of {side}×{side} samples; the reference has one, at its center")
        })
    });
    exact.or_else(|| {
        let statistics = within(submission, &rows).filter(Statistics::is_average)?;
        predicted(submission, statistics.within, || ANY_SAMPLES.to_owned())
    })
}

/// Some pixels, by rows.
struct Rows(Vec<(u32, Vec<u32>)>);

impl Rows {
    /// The pixels in which the shader differs.
    fn differing(submission: &Submission) -> Self {
        let width = submission.frame().size[0] as usize;
        let rows = submission.statuses().chunks(width).zip(0..).map(|(statuses, y)| {
            let columns = statuses.iter().zip(0..);
            let differing = columns.filter(|(status, _)| {
                matches!(
                    status,
                    PixelStatus::Differs | PixelStatus::IllConditioned | PixelStatus::Tied
                )
            });
            (y, differing.map(|(_, x)| x).collect())
        });
        Self(
            rows.filter(|(_, columns): &(u32, Vec<u32>)| !columns.is_empty())
                .collect(),
        )
    }

    /// Few of the pixels, spread over all.
    fn thinned(&self) -> Self {
        let step = self.0.len().div_ceil(MAX_PROBED_ROWS).max(1);
        let rows = self.0.iter().skip(step / 2).step_by(step);
        let rows = rows.map(|(y, columns)| {
            let step = columns.len().div_ceil(MAX_PROBED_COLUMNS).max(1);
            (*y, columns.iter().copied().skip(step / 2).step_by(step).collect())
        });
        Self(rows.collect())
    }

    fn count(&self) -> usize {
        self.0.iter().map(|(_, columns)| columns.len()).sum()
    }
}

/// The colors of the samples of each pixel, in the order of the pixels; `None` if there are too many samples,
/// or the reference has no color within pixels.
fn samples(expected: &Expected, rows: &Rows, offsets: &[f64]) -> Option<Vec<Vec<[f64; 3]>>> {
    let side = offsets.len();
    if rows.count() * side * side > MAX_SAMPLES {
        return None;
    }
    let rows = rows.0.par_iter().map(|(y, columns)| {
        let moved = |at: u32| offsets.iter().map(move |offset| f64::from(at) + 0.5 + offset);
        let positions = Places {
            columns: columns.iter().flat_map(|&x| moved(x)).collect(),
            rows: moved(*y).collect(),
        };
        let colors = expected.colors_within(&positions)?;
        let width = positions.columns.len();
        let of = |pixel: usize| {
            let all = (0..side * side).map(|at| colors[at / side * width + pixel * side + at % side]);
            all.map(|color| color.map(|part| part.clamp(0.0, 1.0))).collect()
        };
        Some((0..columns.len()).map(of).collect())
    });
    let rows: Option<Vec<Vec<Vec<[f64; 3]>>>> = rows.collect();
    Some(rows?.concat())
}

fn mean(samples: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|i| samples.iter().map(|sample| sample[i]).sum::<f64>() / samples.len() as f64)
}

impl Submission<'_> {
    fn color(&self, x: u32, y: u32) -> [f64; 3] {
        let [r, g, b, _] = self.actual.get(x, y);
        [r, g, b].map(|part| f64::from(part).clamp(0.0, 1.0))
    }
}

fn pixels(rows: &Rows) -> impl Iterator<Item = [u32; 2]> + '_ {
    let rows = rows.0.iter();
    rows.flat_map(|(y, columns)| columns.iter().map(move |&x| [x, *y]))
}

/// The pixels whose colors are the means of their samples; `None` if there are too many samples, or the
/// reference has no color within pixels.
fn means(submission: &Submission, rows: &Rows, offsets: &[f64]) -> Option<Vec<[u32; 2]>> {
    let samples = samples(submission.expected(), rows, offsets)?;
    let is_mean = |&([x, y], samples): &([u32; 2], &Vec<[f64; 3]>)| {
        let (own, mean) = (submission.color(x, y), mean(samples));
        (0..3).all(|i| (own[i] - mean[i]).abs() <= submission.tolerance())
    };
    Some(
        pixels(rows)
            .zip(&samples)
            .filter(is_mean)
            .map(|(pixel, _)| pixel)
            .collect(),
    )
}

const ANY_SAMPLES: &str = "each pixel is the mean of several samples; the reference has one, at its center";

/// Confirms that some of the differing pixels agree.
fn predicted(
    submission: &Submission,
    agreeing: Vec<[u32; 2]>,
    text: impl FnOnce() -> String,
) -> Option<Alternative> {
    let width = submission.frame().size[0];
    let statuses = submission.statuses().iter();
    let mut agrees: Vec<bool> = statuses.map(|&status| status == PixelStatus::Agrees).collect();
    for [x, y] in agreeing {
        agrees[(y * width + x) as usize] = true;
    }
    let mistake = || KnownMistake::new(Difference::Antialiasing.id(), text());
    submission.predicted(&submission.reference, |at| agrees[at], mistake)
}

/// Where each pixel's color lies in the range of its sub-pixel colors; the middle sample is the center.
#[derive(Default)]
struct Statistics {
    pixels: usize,
    /// The pixels whose color is within.
    within: Vec<[u32; 2]>,
    /// The number of pixels with an edge.
    edges: u64,
    /// The number of edge pixels with an intermediate color.
    intermediate: u64,
    /// The sum of the variances within edge pixels.
    variance: f64,
    /// The sum of the squared distances of colors to the means within their pixels.
    to_mean: f64,
    /// The sum of the squared distances of colors to the reference's colors at the centers.
    to_center: f64,
}

impl Statistics {
    fn add(&mut self, pixel: [u32; 2], color: [f64; 3], samples: &[[f64; 3]], tolerance: f64) {
        self.pixels += 1;
        let mean = mean(samples);
        let range = |i: usize| {
            let parts = samples.iter().map(|sample| sample[i]);
            parts.fold((1.0_f64, 0.0_f64), |(low, high), part| {
                (low.min(part), high.max(part))
            })
        };
        let ranges = [0, 1, 2].map(range);
        let is_within = (0..3).all(|i| {
            let (low, high) = ranges[i];
            let margin = tolerance + MARGIN * (high - low);
            (low - margin..=high + margin).contains(&color[i])
        });
        if is_within {
            self.within.push(pixel);
        }
        let widest =
            (0..3).max_by(|&a, &b| (ranges[a].1 - ranges[a].0).total_cmp(&(ranges[b].1 - ranges[b].0)));
        let i = widest.unwrap_or(0);
        let (low, high) = ranges[i];
        if high - low > MIN_RANGE {
            self.edges += 1;
            let margin = 2.0 * MARGIN * (high - low);
            self.intermediate += u64::from((low + margin..=high - margin).contains(&color[i]));
            let squares = samples.iter().map(|sample| (sample[i] - mean[i]).powi(2));
            self.variance += squares.sum::<f64>() / samples.len() as f64;
            self.to_mean += (color[i] - mean[i]).powi(2);
            self.to_center += (color[i] - samples[samples.len() / 2][i]).powi(2);
        }
    }

    fn is_within(&self) -> bool {
        self.within.len() as f64 >= MIN_PROBES * self.pixels as f64
    }

    fn is_average(&self) -> bool {
        self.edges >= MIN_EDGE_PIXELS
            && self.intermediate as f64 >= MIN_INTERMEDIATE * self.edges as f64
            && self.variance >= MIN_EFFECTIVE_SAMPLES * self.to_mean
            && self.to_mean <= MAX_UNEXPLAINED * self.to_center
    }
}

/// Compares pixels with the colors within them; `None` if there are too many samples, or the reference has no
/// color within pixels.
fn within(submission: &Submission, rows: &Rows) -> Option<Statistics> {
    let offsets: Vec<f64> = (0..WITHIN)
        .map(|at| f64::from(at) / f64::from(WITHIN - 1) - 0.5)
        .collect();
    let samples = samples(submission.expected(), rows, &offsets)?;
    let mut statistics = Statistics::default();
    for ([x, y], samples) in pixels(rows).zip(&samples) {
        statistics.add([x, y], submission.color(x, y), samples, submission.tolerance());
    }
    Some(statistics)
}

/// The descriptions of the recognized differences, as examples.
#[cfg(test)]
pub(super) fn examples() -> Vec<KnownMistake> {
    let grid = "each pixel is the mean of 2×2 samples; the reference has one, at its center";
    [grid, ANY_SAMPLES]
        .map(|text| KnownMistake::new(Difference::Antialiasing.id(), text))
        .into()
}
