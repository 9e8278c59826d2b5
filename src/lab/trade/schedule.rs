//! Schedules the runs of all methods within the time budget. Runs are interleaved, so that a temporary
//! slowdown of the machine affects all methods equally.

use serde::Serialize;

/// Runs methods, and has a clock; a mock in tests.
pub(super) trait Runner {
    /// The reason why the runner had to stop.
    type Error;

    /// Runs a method. Returns the seconds of a frame; `None` if the method cannot run and is to be skipped.
    fn run(&mut self, method: usize, kind: RunKind) -> Result<Option<f64>, Self::Error>;

    /// Seconds since the start.
    fn now(&self) -> f64;
}

/// The purpose of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RunKind {
    /// The first run of a method, whose image is compared and whose time does not count.
    WarmUp,
    Measurement,
}

/// The maximum number of measured runs of a method.
const MAX_RUNS: usize = 31;

/// The safety factor on the estimated time of a warm-up run.
const WARM_UP_MARGIN: f64 = 1.5;

/// The estimated cost of a method.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cost {
    /// The kind of method: the times of cheap methods predict those of others of the same kind.
    pub(super) kind: usize,
    /// The cost of a frame, in a unit that is the same for all methods of the kind.
    pub(super) size: f64,
}

/// The times measured for methods of one kind, in seconds.
#[derive(Debug, Clone, Copy, Default)]
struct CostModel {
    /// The time of a frame per unit of cost.
    per_cost: f64,
    /// The time outside of the frame, such as compilation.
    overhead: f64,
}

impl CostModel {
    fn estimate(&self, cost: f64) -> f64 {
        self.overhead + WARM_UP_MARGIN * self.per_cost * cost
    }

    /// Adds a measurement; `took`: seconds of the whole run; `frame`: seconds of its frame.
    fn learn(&mut self, cost: f64, took: f64, frame: f64) {
        // The fixed cost of a frame weighs more in cheap frames, so expensive ones predict better.
        self.per_cost = (0.5 * self.per_cost).max(frame / cost.max(f64::MIN_POSITIVE));
        self.overhead = self.overhead.max(took - frame);
    }
}

/// Measures the seconds of each method, without its warm-up run. Cheap methods run first; a method whose
/// warm-up run does not fit in the budget has no times.
pub(super) fn measure<R: Runner>(
    runner: &mut R,
    costs: &[Cost],
    budget: f64,
) -> Result<Vec<Vec<f64>>, R::Error> {
    let mut seconds: Vec<Vec<f64>> = vec![Vec::new(); costs.len()];
    // Seconds of a whole run, including everything outside of the frame; `None` for skipped methods.
    let mut run_seconds: Vec<Option<f64>> = vec![None; costs.len()];
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by(|&a, &b| costs[a].size.total_cmp(&costs[b].size));
    let kinds = costs.iter().map(|cost| cost.kind + 1).max().unwrap_or(0);
    let mut models = vec![CostModel::default(); kinds];
    for &method in &order {
        let (start, Cost { kind, size }) = (runner.now(), costs[method]);
        if start + models[kind].estimate(size) > budget {
            continue;
        }
        if let Some(frame) = runner.run(method, RunKind::WarmUp)? {
            let took = runner.now() - start;
            run_seconds[method] = Some(took);
            models[kind].learn(size, took, frame);
        }
    }
    order.retain(|&method| run_seconds[method].is_some());
    for iteration in 0..MAX_RUNS {
        let mut ran = false;
        // Alternating directions and a moving start, so that no method always follows the same other.
        let offset = iteration * order.len() / 3;
        for i in 0..order.len() {
            let position = if iteration % 2 == 0 {
                i
            } else {
                order.len() - 1 - i
            };
            let method = order[(position + offset) % order.len()];
            let start = runner.now();
            if start + run_seconds[method].unwrap_or(f64::INFINITY) > budget {
                continue;
            }
            if let Some(took) = runner.run(method, RunKind::Measurement)? {
                seconds[method].push(took);
                ran = true;
            }
            run_seconds[method] = Some(runner.now() - start);
        }
        if !ran {
            break;
        }
    }
    Ok(seconds)
}

// Statistics of measured times.

/// The maximum modified z-score of an inlier: Iglewicz and Hoaglin, “How to Detect and Handle Outliers”
/// (ASQC, 1993), section 3.3. It uses the median absolute deviation, because outliers inflate the standard
/// deviation.
const MAX_MODIFIED_Z_SCORE: f64 = 3.5;

/// The third quartile of the standard normal distribution: the ratio of its median absolute deviation to its
/// standard deviation.
const QUARTILE: f64 = 0.6745;

/// Statistics of a method's times.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct TimeStatistics {
    /// The number of runs, without the warm-up.
    pub runs: usize,
    /// The median without outliers, in seconds.
    pub median: f64,
    /// The median absolute deviation from the median, in seconds.
    #[serde(rename = "median_absolute_deviation")]
    pub deviation: f64,
    /// The number of outliers.
    pub outliers: usize,
}

/// The median of the values; 0 if there are none.
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

impl TimeStatistics {
    /// Computes the statistics of times in seconds.
    #[must_use]
    pub fn new(seconds: &[f64]) -> Self {
        let center = median(seconds);
        let spread = deviation(seconds, center);
        let is_inlier = |second: &f64| QUARTILE * (second - center).abs() <= MAX_MODIFIED_Z_SCORE * spread;
        let inliers: Vec<f64> = seconds.iter().copied().filter(is_inlier).collect();
        let median = median(&inliers);
        Self {
            runs: seconds.len(),
            median,
            deviation: deviation(&inliers, median),
            outliers: seconds.len() - inliers.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Methods with given durations on a simulated clock.
    #[derive(Default)]
    struct Mock {
        now: f64,
        /// By method: seconds of a frame, and of the overhead.
        durations: Vec<(f64, f64)>,
        ran: Vec<(usize, RunKind)>,
        broken: Option<usize>,
    }

    impl Runner for Mock {
        type Error = ();

        fn run(&mut self, method: usize, kind: RunKind) -> Result<Option<f64>, ()> {
            self.ran.push((method, kind));
            let (frame, overhead) = self.durations[method];
            self.now += frame + overhead + if kind == RunKind::WarmUp { overhead } else { 0.0 };
            Ok((self.broken != Some(method)).then_some(frame))
        }

        fn now(&self) -> f64 {
            self.now
        }
    }

    fn costs(sizes: &[f64]) -> Vec<Cost> {
        sizes.iter().map(|&size| Cost { kind: 0, size }).collect()
    }

    fn mock(durations: &[(f64, f64)]) -> Mock {
        Mock {
            durations: durations.to_vec(),
            ..Mock::default()
        }
    }

    #[test]
    fn methods_warm_up_once_and_are_interleaved() {
        let mut mock = mock(&[(0.01, 0.0), (0.02, 0.01), (0.03, 0.0)]);
        let seconds = measure(&mut mock, &costs(&[1.0, 2.0, 3.0]), 1.0).unwrap();
        assert!(seconds.iter().all(|times| times.len() > 8), "{seconds:?}");
        assert_eq!(seconds[1][0], 0.02, "what surrounds a frame is not counted");
        assert_eq!(
            mock.ran
                .iter()
                .filter(|(_, kind)| *kind == RunKind::WarmUp)
                .count(),
            3
        );
        let counts = seconds.iter().map(Vec::len);
        assert!(counts.clone().max().unwrap() - counts.min().unwrap() <= 2);
        // Each method has followed each other one.
        let measured: Vec<_> = mock
            .ran
            .iter()
            .filter(|(_, kind)| *kind == RunKind::Measurement)
            .map(|(method, _)| *method)
            .collect();
        for (a, b) in [(0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)] {
            assert!(measured.windows(2).any(|pair| pair == [a, b]), "{a} before {b}");
        }
    }

    #[test]
    fn budget_is_kept_and_used() {
        for budget in [0.5, 2.0, 10.0] {
            let mut mock = mock(&[(0.01, 0.002), (0.1, 0.0), (0.3, 0.1), (4.0, 0.0)]);
            measure(&mut mock, &costs(&[1.0, 10.0, 30.0, 400.0]), budget).unwrap();
            assert!(mock.now <= 1.1 * budget, "{} of {budget}", mock.now);
            assert!(mock.now >= 0.5 * budget.min(4.0), "{} of {budget}", mock.now);
        }
    }

    #[test]
    fn methods_beyond_the_budget_never_start() {
        let mut mock = mock(&[(0.1, 0.0), (50.0, 0.0)]);
        let seconds = measure(&mut mock, &costs(&[1.0, 500.0]), 3.0).unwrap();
        assert!(seconds[1].is_empty() && seconds[0].len() > 20, "{seconds:?}");
    }

    #[test]
    fn kinds_have_separate_cost_estimates() {
        let mut mock = mock(&[(0.001, 1.0), (0.01, 0.0), (0.6, 0.0)]);
        let costs = [(0, 1.0), (1, 1.0), (1, 64.0)].map(|(kind, size)| Cost { kind, size });
        let seconds = measure(&mut mock, &costs, 10.0).unwrap();
        assert!(seconds.iter().all(|times| !times.is_empty()), "{seconds:?}");
    }

    #[test]
    fn failing_methods_are_skipped() {
        let mut mock = mock(&[(0.1, 0.0), (0.1, 0.0)]);
        mock.broken = Some(1);
        let seconds = measure(&mut mock, &costs(&[1.0, 1.0]), 1.0).unwrap();
        assert!(seconds[1].is_empty() && !seconds[0].is_empty());
        assert_eq!(mock.ran.iter().filter(|(method, _)| *method == 1).count(), 1);
    }

    #[test]
    fn runs_are_limited() {
        let mut mock = mock(&[(1e-6, 0.0)]);
        let seconds = measure(&mut mock, &costs(&[1.0]), 1e9).unwrap();
        assert_eq!(seconds[0].len(), MAX_RUNS);
    }

    #[test]
    fn median_and_deviation_ignore_outliers() {
        assert_eq!(median(&[]), 0.0);
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        let times = TimeStatistics::new(&[1.0, 1.1, 0.9, 1.0, 1.05, 0.95, 9.0]);
        assert_eq!((times.runs, times.outliers, times.median), (7, 1, 1.0));
        assert!((times.deviation - 0.05).abs() < 1e-12);
    }

    #[test]
    fn uniform_and_equal_times_have_no_outliers() {
        assert_eq!(TimeStatistics::new(&[1.0, 2.0, 3.0, 4.0, 5.0]).outliers, 0);
        let times = TimeStatistics::new(&[2.0; 5]);
        assert_eq!((times.outliers, times.median, times.deviation), (0, 2.0, 0.0));
    }

    #[test]
    fn score_matches_iglewicz_and_hoaglin() {
        // With median 2 and deviation 1, the limit is 2 + 3.5 / 0.6745 = 7.189.
        assert_eq!(
            TimeStatistics::new(&[1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 7.18]).outliers,
            0
        );
        assert_eq!(
            TimeStatistics::new(&[1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 7.20]).outliers,
            1
        );
    }
}
