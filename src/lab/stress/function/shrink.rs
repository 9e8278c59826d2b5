//! A failing case made as simple as it can be: few digits, zeros and ones.

use super::super::Failure;
use super::super::axis::{Case, Shot};
use super::super::cells::{Truth, truth_of};
use super::super::tally::Outcome;

/// Closer to touching than this, an example would be of little use.
const MARGIN: f64 = 1e-12;

/// What is right about a case.
pub(super) fn truth(shot: &Shot, near: bool) -> Truth {
    truth_of(&Case::Sphere(*shot), near).map_or(Truth::UNDEFINED, |(truth, _)| truth)
}

/// Whether that is wrong about a case.
pub(super) fn is_wrong(shot: &Shot, told: Outcome, near: bool) -> bool {
    match truth_of(&Case::Sphere(*shot), near) {
        Some((_, discriminant)) if discriminant.abs() < MARGIN => false,
        Some((truth, _)) => !told.is_right(&truth),
        None => !told.is_right(&Truth::UNDEFINED),
    }
}

/// The simplest case that can be made of failing ones and still fails.
pub(super) fn smallest(
    wrong: &[Shot],
    failing: impl Fn(&[Shot]) -> Result<Vec<bool>, Failure>,
) -> Result<Option<Shot>, Failure> {
    let mut best: Option<Shot> = None;
    let mut candidates: Vec<Shot> = wrong.iter().take(200).flat_map(simpler).collect();
    candidates.extend(wrong);
    for _ in 0..6 {
        let fails = failing(&candidates)?;
        let failed = candidates.iter().zip(fails).filter(|(_, fails)| *fails);
        let simplest = failed.map(|(shot, _)| *shot).min_by_key(digits);
        match (simplest, best) {
            (Some(found), Some(before)) if digits(&found) >= digits(&before) => break,
            (None, _) => break,
            (Some(found), _) => {
                best = Some(found);
                candidates = simpler(&found);
            }
        }
    }
    Ok(best)
}

/// How many letters its numbers take.
fn digits(shot: &Shot) -> usize {
    let numbers = shot.o.iter().chain(&shot.d).chain(&shot.c).chain([&shot.r]);
    numbers
        .map(|x| format!("{x:e}").len() + usize::from(*x != 0.0))
        .sum()
}

/// So many digits of a decimal number.
fn rounded(x: f32, digits: usize) -> f32 {
    format!("{x:.digits$e}").parse().unwrap_or(x)
}

fn simpler(shot: &Shot) -> Vec<Shot> {
    let map = |f: &dyn Fn(f32) -> f32| Shot {
        o: shot.o.map(f),
        d: shot.d.map(f),
        c: shot.c.map(f),
        r: f(shot.r),
    };
    let mut all: Vec<Shot> = (0..7).map(|digits| map(&|x| rounded(x, digits))).collect();
    // With the sphere about the origin.
    let moved = |shot: &Shot| Shot {
        o: [0, 1, 2].map(|i| shot.o[i] - shot.c[i]),
        c: [0.0; 3],
        ..*shot
    };
    let more: Vec<Shot> = all.iter().map(moved).chain([moved(shot)]).collect();
    all.extend(more);
    // With a part of it gone, or 1, or of fewer digits.
    let bases: Vec<Shot> = all.iter().copied().chain([*shot]).collect();
    for base in bases {
        for i in 0..10 {
            let part = |shot: &Shot| {
                [shot.o, shot.d, shot.c]
                    .concat()
                    .get(i)
                    .copied()
                    .unwrap_or(shot.r)
            };
            let x = part(&base);
            for value in [0.0, 1.0, -1.0, 2.0, -2.0, x.round(), rounded(x, 0), rounded(x, 1)] {
                let mut changed = base;
                match i {
                    0..3 => changed.o[i] = value,
                    3..6 => changed.d[i - 3] = value,
                    6..9 => changed.c[i - 6] = value,
                    _ if value > 0.0 => changed.r = value,
                    _ => continue,
                }
                all.push(changed);
            }
        }
    }
    all
}
