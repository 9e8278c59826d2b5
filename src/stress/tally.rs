//! Statistics of a subject's results for one step of an axis.

use serde::Serialize;

use crate::axis::{Axis, EasySteps};
use crate::case::Step;
use crate::cells::{Alternative, Reference};
use crate::exact::DoubleDouble;
use crate::formula::Reading;
use crate::function::MissConvention;
use crate::study::Row;

/// The maximum relative error of a usable root: about ten thousand ULPs of f32.
const MAX_RELATIVE_ERROR: f64 = 1e-3;

/// Counts over the cases of one step.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Tally {
    /// The number of cases.
    pub cases: u64,
    /// Misses reported as hits, and hits reported as misses.
    pub wrong_hits: u64,
    /// Errors of t for rays that hit the surface and were reported as hits, in units in the last place of the
    /// number type: median, 99th percentile and maximum. `None` if there were no such rays.
    pub t_error_ulp: Option<[f64; 3]>,
    /// Results that are NaN or infinite.
    pub non_finite: u64,
    /// Rays that hit the surface that they start from.
    pub self_intersections: u64,
    /// Rays that missed a nearby surface.
    pub missed_nearby: u64,
    /// Cases with an unusable result: a wrong hit, NaN, a t with a relative error above 1/1000, a
    /// self-intersection, a missed nearby surface.
    pub failing: u64,
}

/// A shader's result for a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Outcome {
    Miss,
    Hit(f64),
    Nan,
}

impl Outcome {
    /// Whether the result is usable, given the reference `exact`.
    pub(crate) fn is_right(self, exact: &Reference) -> bool {
        let agrees = |with: Option<DoubleDouble>| match (self, with) {
            (Self::Hit(t), Some(exact)) => (t - exact.high).abs() <= MAX_RELATIVE_ERROR * exact.high,
            (Self::Miss, None) => true,
            (Self::Nan, None) => exact.undefined,
            _ => false,
        };
        agrees(exact.t)
            || match exact.alternative {
                Alternative::Nothing => false,
                Alternative::Miss => agrees(None),
                Alternative::Hit(t) => agrees(Some(t)),
            }
    }
}

/// The result of a formula, whose color is t; a value that is not positive is a miss.
fn root_outcome([t, _, _]: [f64; 3]) -> Outcome {
    if !t.is_finite() {
        Outcome::Nan
    } else if t > 0.0 {
        Outcome::Hit(t)
    } else {
        Outcome::Miss
    }
}

impl Tally {
    /// Counts the results of one step. `digits`: the precision of the number type, in bits; `convention`: how
    /// a function reports a miss.
    pub(crate) fn new(
        reading: &Reading,
        digits: u32,
        convention: Option<&MissConvention>,
        cases: impl Iterator<Item = ([f64; 3], Reference)>,
    ) -> Self {
        let mut tally = Self::default();
        let mut errors = Vec::new();
        for (color, exact) in cases {
            tally.cases += 1;
            if matches!(reading, Reading::Secondary) {
                let [own, lost] = [color[0] != 0.0, color[1] != 0.0];
                tally.self_intersections += u64::from(own);
                tally.missed_nearby += u64::from(lost);
                tally.failing += u64::from(own || lost);
                continue;
            }
            let outcome =
                convention.map_or_else(|| root_outcome(color), |convention| convention.outcome(color));
            tally.failing += u64::from(!outcome.is_right(&exact));
            match (outcome, exact.t) {
                (Outcome::Hit(t), Some(exact)) => errors.push(exact.ulps(t, digits)),
                (Outcome::Nan, exact) => {
                    tally.non_finite += 1;
                    tally.wrong_hits += u64::from(exact.is_some());
                }
                (Outcome::Hit(_), None) | (Outcome::Miss, Some(_)) => tally.wrong_hits += 1,
                (Outcome::Miss, None) => {}
            }
        }
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| errors[((errors.len() - 1) as f64 * share).round() as usize];
        tally.t_error_ulp = (!errors.is_empty()).then(|| [at(0.5), at(0.99), at(1.0)]);
        tally
    }

    /// The share of cases with an unusable result, in [0, 1].
    #[must_use]
    pub fn failing_share(&self) -> f64 {
        self.failing as f64 / self.cases.max(1) as f64
    }

    /// Whether the share of unusable results is too large.
    pub(crate) fn fails(&self) -> bool {
        self.failing_share() > MAX_FAILING_SHARE
    }
}

// Breakdowns: the steps from which a formula fails.

/// A step fails if the share of unusable results exceeds this.
pub(crate) const MAX_FAILING_SHARE: f64 = 0.01;

/// The first step at which a formula fails in one direction of an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Breakdown {
    /// The formula.
    pub formula: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// The axis.
    pub axis: &'static str,
    /// The direction: the quantity with `≤` or `≥`; for a named step its description.
    pub condition: String,
    /// The first failing step, counted from the easy ones.
    pub first_failing_step: String,
    /// The share of unusable results in that step, in [0, 1].
    pub failing_share: f64,
}

/// All breakdowns in the rows of one formula, precision and device.
pub(crate) fn breakdowns(axes: &[Axis], rows: &[&Row]) -> Vec<Breakdown> {
    let found = axes.iter().flat_map(|axis| {
        let directions = directions(axis).into_iter();
        directions.filter_map(|direction| {
            let row = direction.steps.iter().find_map(|step| {
                let mut rows = rows.iter();
                rows.find(|row| row.axis == axis.name && row.value == *step && row.tally.fails())
            })?;
            let step = match row.value {
                Step::Number(x) if axis.easy == EasySteps::Ends => Step::Number(x.abs()),
                step => step,
            };
            Some(Breakdown {
                formula: row.formula.clone(),
                precision: row.precision,
                axis: axis.name,
                condition: direction.condition,
                first_failing_step: step.to_string(),
                failing_share: row.tally.failing_share(),
            })
        })
    });
    found.collect()
}

/// One direction in which the steps of an axis get harder.
pub(crate) struct Direction {
    /// The quantity with `≤` or `≥`; for a named step its description.
    pub(crate) condition: String,
    /// The steps, easiest first.
    pub(crate) steps: Vec<Step>,
}

/// The directions in which the steps of an axis get harder.
pub(crate) fn directions(axis: &Axis) -> Vec<Direction> {
    let label = axis.label;
    let where_number = |side: fn(f64) -> bool| {
        let steps = axis.steps.iter().copied();
        steps.filter(move |step| matches!(step, Step::Number(x) if side(*x)))
    };
    let direction = |condition: String, steps: Vec<Step>| Direction { condition, steps };
    match axis.easy {
        EasySteps::First => {
            let sign = if axis.steps[0].value() < axis.steps[axis.steps.len() - 1].value() {
                '≥'
            } else {
                '≤'
            };
            vec![direction(format!("{label} {sign}"), axis.steps.clone())]
        }
        EasySteps::One => vec![
            direction(format!("{label} ≤"), where_number(|x| x <= 1.0).rev().collect()),
            direction(format!("{label} ≥"), where_number(|x| x > 1.0).collect()),
        ],
        EasySteps::Ends => vec![
            direction(
                "grazing hits, |δ| ≤".to_owned(),
                where_number(|x| x > 0.0).collect(),
            ),
            direction(
                "near misses, |δ| ≤".to_owned(),
                where_number(|x| x < 0.0).rev().collect(),
            ),
        ],
        EasySteps::Unordered => {
            let steps = axis.steps.iter();
            steps
                .map(|&step| direction(axis.describe(step), vec![step]))
                .collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tally_counts_each_kind_of_failure() {
        let exact = |t: f64| Some(DoubleDouble { high: t, low: 0.0 });
        let off = 2.0 + 2.0 * f64::from(f32::EPSILON);
        let cases = [
            (2.0, exact(2.0)),
            (off, exact(2.0)),
            (3.0, exact(2.0)),
            (-1.0, exact(2.0)),
            (f64::NAN, exact(2.0)),
            (f64::NAN, None),
            (1.0, None),
            (-1.0, None),
        ];
        let reference = |t| Reference {
            t,
            ..Reference::default()
        };
        let colors = cases.map(|(t, exact)| ([t, 0.0, 0.0], reference(exact)));
        let tally = Tally::new(&Reading::Root, 24, None, colors.into_iter());
        assert_eq!((tally.cases, tally.wrong_hits, tally.non_finite), (8, 3, 2));
        assert_eq!(tally.failing, 5, "all but two hits and a miss");
        assert_eq!(tally.t_error_ulp, Some([1.0, 4_194_304.0, 4_194_304.0]));
        let secondary = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0; 3]].map(|color| (color, reference(None)));
        let tally = Tally::new(&Reading::Secondary, 24, None, secondary.into_iter());
        assert_eq!(
            (tally.self_intersections, tally.missed_nearby, tally.failing),
            (2, 1, 2)
        );
    }

    #[test]
    fn near_hits_may_be_ignored() {
        let precise = |high| DoubleDouble { high, low: 0.0 };
        let reference = Reference {
            t: Some(precise(1e-7)),
            alternative: Alternative::Hit(precise(2.0)),
            ..Reference::default()
        };
        for (outcome, right) in [
            (Outcome::Hit(1e-7), true),
            (Outcome::Hit(2.0), true),
            (Outcome::Miss, false),
            (Outcome::Hit(1.0), false),
        ] {
            assert_eq!(outcome.is_right(&reference), right, "{outcome:?}");
        }
    }
}
