//! Statistics of a subject's results for one step of an axis.

use serde::Serialize;

use super::Row;
use super::axis::{Axis, EasySteps, Kind, Step};
use super::cells::{Alternative, Reference};
use super::exact::DoubleDouble;
use super::formula::Reading;
use super::function::MissConvention;

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
    pub t_ulp: Option<[f64; 3]>,
    /// Results that are NaN or infinite.
    pub nan: u64,
    /// Rays that hit the surface that they leave.
    pub self_hits: u64,
    /// Rays that missed a nearby surface.
    pub lost: u64,
    /// Cases with an unusable result: a wrong hit, NaN, a t with a relative error above 1/1000, a self-hit, a
    /// lost hit.
    pub failing: u64,
}

/// A shader's result for a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Outcome {
    Miss,
    Hit(f64),
    Nan,
}

impl Outcome {
    /// Whether the result is usable, given the reference `exact`.
    pub(super) fn is_right(self, exact: &Reference) -> bool {
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

impl Reading {
    /// Interprets a color.
    ///
    /// `misses`: how a function reports a miss.
    pub(super) fn outcome(misses: Option<&MissConvention>, color: [f64; 3]) -> Outcome {
        if let Some(convention) = misses {
            return convention.outcome(color);
        }
        let [t, _, _] = color;
        if !t.is_finite() {
            Outcome::Nan
        } else if t > 0.0 {
            Outcome::Hit(t)
        } else {
            Outcome::Miss
        }
    }
}

impl Tally {
    /// Counts the results of one step. `digits`: the precision of the number type, in bits; `convention`: how
    /// a function reports a miss.
    pub(super) fn of(
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
                tally.self_hits += u64::from(own);
                tally.lost += u64::from(lost);
                tally.failing += u64::from(own || lost);
                continue;
            }
            let outcome = Reading::outcome(convention, color);
            tally.failing += u64::from(!outcome.is_right(&exact));
            match (outcome, exact.t) {
                (Outcome::Hit(t), Some(exact)) => errors.push(exact.ulps(t, digits)),
                (Outcome::Nan, exact) => {
                    tally.nan += 1;
                    tally.wrong_hits += u64::from(exact.is_some());
                }
                (Outcome::Hit(_), None) | (Outcome::Miss, Some(_)) => tally.wrong_hits += 1,
                (Outcome::Miss, None) => {}
            }
        }
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| errors[((errors.len() - 1) as f64 * share).round() as usize];
        tally.t_ulp = (!errors.is_empty()).then(|| [at(0.5), at(0.99), at(1.0)]);
        tally
    }

    /// The share of cases with an unusable result, in [0, 1].
    #[must_use]
    pub fn failing_share(&self) -> f64 {
        self.failing as f64 / self.cases.max(1) as f64
    }
}

// Breakdowns: the steps from which a formula fails.

/// A step fails if the share of unusable results exceeds this.
const MAX_FAILING_SHARE: f64 = 0.01;

/// Where a formula fails on an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Breakdown {
    /// The formula.
    pub formula: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// The axis.
    pub axis: &'static str,
    /// The first failing step, counted from the easy ones.
    pub from: String,
    /// The share of unusable results in that step, in [0, 1].
    pub failing: f64,
    /// The failure as text, to follow “fails”.
    #[serde(rename = "says")]
    pub description: String,
}

/// All breakdowns in the rows of one formula, precision and device.
pub(super) fn breakdowns(axes: &[Axis], rows: &[&Row]) -> Vec<Breakdown> {
    axes.iter().flat_map(|axis| axis_breakdowns(axis, rows)).collect()
}

/// Joins items as “a, b and c”.
pub(super) fn join_list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn axis_breakdowns(axis: &Axis, rows: &[&Row]) -> Vec<Breakdown> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.axis == axis.name).copied().collect();
    let name = axis.name;
    let breakdown = |row: &Row, description: String| Breakdown {
        formula: row.formula.clone(),
        precision: row.precision,
        axis: name,
        from: row.value.to_string(),
        failing: row.tally.failing_share(),
        description,
    };
    let fails = |row: &&&Row| row.tally.failing_share() > MAX_FAILING_SHARE;
    let is = |row: &&&Row, side: fn(f64) -> bool| matches!(row.value, Step::Number(x) if side(x));
    let found: Vec<_> = match axis.easy {
        EasySteps::First => {
            let first = rows.iter().find(fails);
            first
                .map(|row| breakdown(row, format!("from {name} {} on", row.value)))
                .into_iter()
                .collect()
        }
        EasySteps::One => {
            let low = rows.iter().rev().filter(|row| is(row, |x| x <= 1.0)).find(fails);
            let high = rows.iter().filter(|row| is(row, |x| x > 1.0)).find(fails);
            let low = low.map(|row| breakdown(row, format!("from {name} {} down", row.value)));
            let high = high.map(|row| breakdown(row, format!("from {name} {} up", row.value)));
            low.into_iter().chain(high).collect()
        }
        EasySteps::Ends => {
            let size = |row: &Row| match row.value {
                Step::Number(x) => Step::Number(x.abs()),
                label @ Step::Label(_) => label,
            };
            let hits = rows.iter().filter(|row| is(row, |x| x > 0.0)).find(fails);
            let misses = rows.iter().rev().filter(|row| is(row, |x| x < 0.0)).find(fails);
            let hits =
                hits.map(|row| breakdown(row, format!("on hits that graze from |δ| {} on", size(row))));
            let misses =
                misses.map(|row| breakdown(row, format!("on misses that graze from |δ| {} on", size(row))));
            hits.into_iter().chain(misses).collect()
        }
        EasySteps::Unordered => rows
            .iter()
            .filter(fails)
            .map(|row| breakdown(row, describe_unordered_step(axis, row)))
            .collect(),
    };
    found
}

fn describe_unordered_step(axis: &Axis, row: &Row) -> String {
    let percent = |count: u64| 100.0 * count as f64 / row.tally.cases.max(1) as f64;
    match axis.kind {
        Kind::Secondaries => {
            let parts = [
                (row.tally.self_hits, "meet their own surface"),
                (row.tally.lost, "lose what is near"),
            ];
            let parts = parts.into_iter().filter(|(count, _)| *count > 0);
            let parts: Vec<_> = parts
                .map(|(count, says)| format!("{:.1} % {says}", percent(count)))
                .collect();
            format!("for {} at {} ({})", axis.name, row.value, join_list(&parts))
        }
        _ => format!("with {}", row.value),
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
        let tally = Tally::of(&Reading::Root, 24, None, colors.into_iter());
        assert_eq!((tally.cases, tally.wrong_hits, tally.nan), (8, 3, 2));
        assert_eq!(tally.failing, 5, "all but two hits and a miss");
        assert_eq!(tally.t_ulp, Some([1.0, 4_194_304.0, 4_194_304.0]));
        let secondary = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0; 3]].map(|color| (color, reference(None)));
        let tally = Tally::of(&Reading::Secondary, 24, None, secondary.into_iter());
        assert_eq!((tally.self_hits, tally.lost, tally.failing), (2, 1, 2));
    }

    #[test]
    fn near_hits_may_be_ignored() {
        let precise = |high| DoubleDouble { high, low: 0.0 };
        let reference = Reference {
            t: Some(precise(1e-7)),
            alternative: Alternative::Hit(precise(2.0)),
            undefined: false,
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
