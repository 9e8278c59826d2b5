//! A group of candidates that are compiled together, and evaluated side by side at the probes.

use std::ops::Range;

use toyproof_eval::{Point, PointEvaluator};

use super::probe::Probes;
use super::schema::Selection;
use super::term::Numbers;

/// A candidate, with its numbers, at some of the probes.
#[derive(Debug, Clone)]
pub(super) struct Run {
    /// Its place in the group; `None` for the shader as it is.
    pub(super) candidate: Option<usize>,
    pub(super) numbers: Numbers,
    pub(super) probes: Range<usize>,
}

/// Evaluates the candidates of a group.
pub(super) struct Group<'a, 'e> {
    evaluator: &'a mut PointEvaluator<'e>,
    /// The number of candidates.
    count: usize,
}

impl<'a, 'e> Group<'a, 'e> {
    pub(super) fn new(evaluator: &'a mut PointEvaluator<'e>, count: usize) -> Self {
        Self { evaluator, count }
    }

    /// The colors of each run at its probes; `None` if a limit is exceeded there.
    pub(super) fn colors(&mut self, probes: &Probes, runs: &[Run]) -> Vec<Option<Vec<[f64; 3]>>> {
        let selections: Vec<Selection> = runs
            .iter()
            .map(|run| Selection::of(self.count, run.candidate, &run.numbers))
            .collect();
        let points: Vec<Point> = runs
            .iter()
            .zip(&selections)
            .flat_map(|(run, selection)| {
                let points = probes.all[run.probes.clone()].iter();
                points.map(|probe| Point {
                    at: probe.point,
                    values: selection.values(),
                })
            })
            .collect();
        let Ok(colors) = self.evaluator.colors(&points) else {
            return vec![None; runs.len()];
        };
        let mut colors = colors.into_iter();
        runs.iter()
            .map(|run| colors.by_ref().take(run.probes.len()).collect::<Vec<_>>())
            .map(|colors| colors.into_iter().collect())
            .collect()
    }

    /// The colors of one run.
    pub(super) fn run(&mut self, probes: &Probes, run: Run) -> Option<Vec<[f64; 3]>> {
        self.colors(probes, &[run]).pop()?
    }

    /// The largest number of loop iterations of the last colors.
    pub(super) fn iterations(&self) -> u32 {
        self.evaluator.iterations()
    }

    /// The work so far.
    pub(super) fn work(&self) -> f64 {
        self.evaluator.work()
    }
}
