//! The simplest ray for which a function fails.

use std::sync::atomic::AtomicBool;

use serde::Serialize;

use super::{FunctionRunner, MissConvention};
use crate::axis::{Axis, Kind, axes};
use crate::case::{Case, Label, RaySphere, Step};
use crate::cells::{Cells, RayStart, Reference};
use crate::run::RunError;
use crate::study::Settings;
use crate::tally::Outcome;

/// A ray with a wrong result, simplified to few digits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Example {
    /// The actual result.
    pub actual: String,
    /// Statements that assign the ray and sphere to the function's parameters.
    pub assignments: Vec<String>,
    /// The right result.
    pub expected: String,
    /// The step of the case that it was simplified from.
    pub found_at: String,
}

impl FunctionRunner<'_> {
    /// The simplest failing case of the least extreme step that fails.
    pub(super) fn example(
        &self,
        settings: Settings,
        interrupt: &AtomicBool,
    ) -> Result<Option<Example>, RunError> {
        let convention = &self.miss_convention::<f32>()?;
        let axes = axes();
        let cells = Cells::sample(&axes, Kind::Spheres, settings.seed, settings.cases, interrupt);
        let cells = cells.ok_or(RunError::Interrupted)?;
        let mut order: Vec<_> = cells.steps.iter().collect();
        order.sort_by(|a, b| extremeness(a.axis, a.step).total_cmp(&extremeness(b.axis, b.step)));
        for cell in order {
            let ray_spheres: Vec<RaySphere> = cells.cases[cell.range.clone()]
                .iter()
                .filter_map(|case| match case {
                    Case::Sphere(ray_sphere) => Some(*ray_sphere),
                    _ => None,
                })
                .collect();
            let outcomes = self.outcomes::<f32>(&ray_spheres, convention)?;
            let references = &cells.references[cell.range.clone()];
            let wrong: Vec<RaySphere> = ray_spheres
                .iter()
                .zip(outcomes.iter().zip(references))
                .filter(|(_, (outcome, reference))| !outcome.is_right(reference))
                .map(|(ray_sphere, _)| *ray_sphere)
                .collect();
            // Up to 1 % of the rays may be ill-conditioned for the function's own epsilon.
            if wrong.len() * 100 <= ray_spheres.len() {
                continue;
            }
            let start = RayStart::on_axis(cell.axis);
            let failing = |ray_spheres: &[RaySphere]| -> Result<Vec<bool>, RunError> {
                let outcomes = self.outcomes::<f32>(ray_spheres, convention)?;
                let pairs = ray_spheres.iter().zip(outcomes);
                Ok(pairs
                    .map(|(ray_sphere, outcome)| is_wrong(ray_sphere, outcome, start))
                    .collect())
            };
            if let Some(ray_sphere) = simplest_failing(&wrong, failing)? {
                return Ok(Some(self.describe_example(
                    ray_sphere,
                    convention,
                    start,
                    describe_step(&axes, cell.axis, cell.step),
                )?));
            }
        }
        Ok(None)
    }

    fn describe_example(
        &self,
        ray_sphere: RaySphere,
        convention: &MissConvention,
        start: RayStart,
        found_at: String,
    ) -> Result<Example, RunError> {
        let colors = self.colors::<f32>(&[ray_sphere])?;
        let actual = convention.outcome(colors[0]);
        let expected = Reference::new(&Case::Sphere(ray_sphere), start);
        let number = |t: f64| format!("t = {t:?}");
        Ok(Example {
            assignments: self.signature.assignments(&ray_sphere),
            expected: expected.t.map_or_else(|| "no hit".to_owned(), |t| number(t.high)),
            actual: match actual {
                Outcome::Miss => format!("no hit (returned {})", f64::from(colors[0][0] as f32)),
                Outcome::Hit(t) => number(t),
                Outcome::Nan => "NaN".to_owned(),
            },
            found_at,
        })
    }
}

fn describe_step(axes: &[Axis], name: &str, step: Step) -> String {
    let axis = axes.iter().find(|axis| axis.name == name);
    axis.map_or_else(|| name.to_owned(), |axis| axis.describe(step))
}

/// How far a step is from typical scenes; named configurations come last.
fn extremeness(axis: &str, step: Step) -> f64 {
    match (axis, step) {
        ("grazing", Step::Number(delta)) => 20.0 - libm::log10(delta.abs()),
        (_, Step::Number(number)) if number > 0.0 => libm::log10(number).abs(),
        (_, Step::Number(_)) => 0.0,
        (_, Step::Label(Label::OriginInside)) => 0.5,
        ("origin", Step::Label(_)) => 10.0,
        (_, Step::Label(_)) => 100.0,
    }
}

// Simplification of a failing case to few digits, zeros and ones.

/// The minimum |δ| of an example: cases nearer to tangency are not instructive.
const MIN_EXAMPLE_DELTA: f64 = 1e-12;

/// Whether an outcome is wrong for a case.
fn is_wrong(ray_sphere: &RaySphere, outcome: Outcome, start: RayStart) -> bool {
    let reference = Reference::new(&Case::Sphere(*ray_sphere), start);
    let is_nearly_tangent = reference.discriminant.abs() < MIN_EXAMPLE_DELTA;
    !is_nearly_tangent && !outcome.is_right(&reference)
}

/// The simplest case derived from failing ones that still fails.
fn simplest_failing(
    wrong: &[RaySphere],
    failing: impl Fn(&[RaySphere]) -> Result<Vec<bool>, RunError>,
) -> Result<Option<RaySphere>, RunError> {
    let mut best: Option<RaySphere> = None;
    let mut candidates: Vec<RaySphere> = wrong.iter().take(200).flat_map(simpler_cases).collect();
    candidates.extend(wrong);
    for _ in 0..6 {
        let fails = failing(&candidates)?;
        let failed = candidates.iter().zip(fails).filter(|(_, fails)| *fails);
        let simplest = failed.map(|(ray_sphere, _)| *ray_sphere).min_by_key(text_length);
        match (simplest, best) {
            (Some(found), Some(before)) if text_length(&found) >= text_length(&before) => break,
            (None, _) => break,
            (Some(found), _) => {
                best = Some(found);
                candidates = simpler_cases(&found);
            }
        }
    }
    Ok(best)
}

/// The length of the numbers of a case as text.
fn text_length(ray_sphere: &RaySphere) -> usize {
    let numbers = ray_sphere
        .o
        .iter()
        .chain(&ray_sphere.d)
        .chain(&ray_sphere.c)
        .chain([&ray_sphere.r]);
    numbers
        .map(|x| format!("{x:e}").len() + usize::from(*x != 0.0))
        .sum()
}

/// Rounds to `digits` decimal digits after the first.
fn round_digits(x: f32, digits: usize) -> f32 {
    format!("{x:.digits$e}").parse().unwrap_or(x)
}

fn simpler_cases(ray_sphere: &RaySphere) -> Vec<RaySphere> {
    let map = |f: &dyn Fn(f32) -> f32| RaySphere {
        o: ray_sphere.o.map(f),
        d: ray_sphere.d.map(f),
        c: ray_sphere.c.map(f),
        r: f(ray_sphere.r),
    };
    let mut all: Vec<RaySphere> = (0..7).map(|digits| map(&|x| round_digits(x, digits))).collect();
    // With the sphere at the origin.
    let moved = |ray_sphere: &RaySphere| RaySphere {
        o: [0, 1, 2].map(|i| ray_sphere.o[i] - ray_sphere.c[i]),
        c: [0.0; 3],
        ..*ray_sphere
    };
    let more: Vec<RaySphere> = all.iter().map(moved).chain([moved(ray_sphere)]).collect();
    all.extend(more);
    // With one component set to 0, ±1, ±2, or fewer digits.
    let bases: Vec<RaySphere> = all.iter().copied().chain([*ray_sphere]).collect();
    for base in bases {
        for i in 0..10 {
            let part = |ray_sphere: &RaySphere| {
                [ray_sphere.o, ray_sphere.d, ray_sphere.c]
                    .concat()
                    .get(i)
                    .copied()
                    .unwrap_or(ray_sphere.r)
            };
            let x = part(&base);
            for value in [
                0.0,
                1.0,
                -1.0,
                2.0,
                -2.0,
                x.round(),
                round_digits(x, 0),
                round_digits(x, 1),
            ] {
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
