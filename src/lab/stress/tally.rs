//! What a subject made of the cases of one step of an axis.

use serde::Serialize;

use super::cells::{Otherwise, Truth};
use super::exact::Precise;
use super::formula::Reading;
use super::function::Answers;

/// A root that is off by more than this share is as good as none: a ULP of f32 is a ten-thousandth of it.
const LARGEST_ERROR: f64 = 1e-3;

/// Counted over the cases of one step.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Tally {
    /// How many cases there were.
    pub cases: u64,
    /// Hits told for misses, and misses for hits.
    pub wrong_hits: u64,
    /// Of rays that meet the surface and were found to: errors of t in units in the last place of the number type: the median, the
    /// one that one in a hundred exceeds, and the largest. None where there was no such ray.
    pub t_ulp: Option<[f64; 3]>,
    /// Answers that are NaN or infinite.
    pub nan: u64,
    /// Rays that met the surface that they leave.
    pub self_hits: u64,
    /// Rays that did not meet what is near.
    pub lost: u64,
    /// Cases whose answer cannot be used: a wrong hit, a NaN, a t that is off by more than a thousandth, a self-hit, a lost root.
    pub failing: u64,
}

/// What a shader says of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Outcome {
    Miss,
    Hit(f64),
    Nan,
}

impl Outcome {
    /// Whether it can be used where `exact` is right.
    pub(super) fn is_right(self, exact: &Truth) -> bool {
        let agrees = |with: Option<Precise>| match (self, with) {
            (Self::Hit(t), Some(exact)) => (t - exact.high).abs() <= LARGEST_ERROR * exact.high,
            (Self::Miss, None) => true,
            (Self::Nan, None) => exact.undefined,
            _ => false,
        };
        agrees(exact.t)
            || match exact.otherwise {
                Otherwise::Nothing => false,
                Otherwise::Miss => agrees(None),
                Otherwise::Hit(t) => agrees(Some(t)),
            }
    }
}

impl Reading {
    /// What a colour says of a ray.
    ///
    /// `misses`: how a function says no.
    pub(super) fn outcome(misses: Option<&Answers>, color: [f64; 3]) -> Outcome {
        if let Some(answers) = misses {
            return answers.outcome(color);
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
    /// `digits` are those of the number type, in bits; `answers` tell how a function says no.
    pub(super) fn of(
        reading: &Reading,
        digits: u32,
        answers: Option<&Answers>,
        cases: impl Iterator<Item = ([f64; 3], Truth)>,
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
            let outcome = Reading::outcome(answers, color);
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

    /// The share of cases whose answer cannot be used.
    #[must_use]
    pub fn failing_share(&self) -> f64 {
        self.failing as f64 / self.cases.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_case_counts_for_what_it_is() {
        let exact = |t: f64| Some(Precise { high: t, low: 0.0 });
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
        let truth = |t| Truth {
            t,
            ..Truth::default()
        };
        let colors = cases.map(|(t, exact)| ([t, 0.0, 0.0], truth(exact)));
        let tally = Tally::of(&Reading::Root, 24, None, colors.into_iter());
        assert_eq!((tally.cases, tally.wrong_hits, tally.nan), (8, 3, 2));
        assert_eq!(tally.failing, 5, "all but two hits and a miss");
        assert_eq!(tally.t_ulp, Some([1.0, 4_194_304.0, 4_194_304.0]));
        let secondary = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0; 3]].map(|color| (color, truth(None)));
        let tally = Tally::of(&Reading::Secondary, 24, None, secondary.into_iter());
        assert_eq!((tally.self_hits, tally.lost, tally.failing), (2, 1, 2));
    }

    #[test]
    fn what_is_next_to_the_start_may_be_left_out_or_not() {
        let precise = |high| Precise { high, low: 0.0 };
        let truth = Truth {
            t: Some(precise(1e-7)),
            otherwise: Otherwise::Hit(precise(2.0)),
            undefined: false,
        };
        for (outcome, right) in [
            (Outcome::Hit(1e-7), true),
            (Outcome::Hit(2.0), true),
            (Outcome::Miss, false),
            (Outcome::Hit(1.0), false),
        ] {
            assert_eq!(outcome.is_right(&truth), right, "{outcome:?}");
        }
    }
}
