//! Times that were measured, and what they say.

use serde::Serialize;

/// A time is an outlier if its modified z-score is larger than this: Iglewicz and Hoaglin, “How to Detect and Handle Outliers” (ASQC, 1993),
/// section 3.3. The median absolute deviation stands in for the standard deviation, which an outlier would widen itself.
const LARGEST_SCORE: f64 = 3.5;
/// The third quartile of the normal distribution: what makes a median absolute deviation of a standard one.
const QUARTILE: f64 = 0.6745;

/// Of the times that a way took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Times {
    /// How often it ran, warm-up left out.
    pub runs: usize,
    /// The median, in seconds, of those that are no outliers.
    pub median: f64,
    /// The median absolute deviation from it, in seconds.
    pub deviation: f64,
    /// How many runs were left out as outliers.
    pub outliers: usize,
}

/// The median; 0 of nothing.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        count if count % 2 == 1 => sorted[count / 2],
        count => 0.5 * (sorted[count / 2 - 1] + sorted[count / 2]),
    }
}

fn deviation(values: &[f64], from: f64) -> f64 {
    let distances: Vec<_> = values.iter().map(|value| (value - from).abs()).collect();
    median(&distances)
}

impl Times {
    /// Of times in seconds.
    #[must_use]
    pub fn of(seconds: &[f64]) -> Self {
        let middle = median(seconds);
        let spread = deviation(seconds, middle);
        let is_usual = |second: &f64| QUARTILE * (second - middle).abs() <= LARGEST_SCORE * spread;
        let usual: Vec<f64> = seconds.iter().copied().filter(is_usual).collect();
        let median = median(&usual);
        Self {
            runs: seconds.len(),
            median,
            deviation: deviation(&usual, median),
            outliers: seconds.len() - usual.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_and_its_deviation_ignore_what_is_far_off() {
        assert_eq!(median(&[]), 0.0);
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        let times = Times::of(&[1.0, 1.1, 0.9, 1.0, 1.05, 0.95, 9.0]);
        assert_eq!((times.runs, times.outliers, times.median), (7, 1, 1.0));
        assert!((times.deviation - 0.05).abs() < 1e-12);
    }

    #[test]
    fn times_that_scatter_evenly_have_no_outliers_and_equal_times_none_either() {
        assert_eq!(Times::of(&[1.0, 2.0, 3.0, 4.0, 5.0]).outliers, 0);
        let times = Times::of(&[2.0; 5]);
        assert_eq!((times.outliers, times.median, times.deviation), (0, 2.0, 0.0));
    }

    #[test]
    fn the_score_is_that_of_the_book() {
        // Median 2, deviation 1: the limit lies at 2 + 3.5 / 0.6745 = 7.189.
        assert_eq!(Times::of(&[1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 7.18]).outliers, 0);
        assert_eq!(Times::of(&[1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 7.20]).outliers, 1);
    }
}
