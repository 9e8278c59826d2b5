//! A user's function at extreme arguments: its signature, how it reports a miss, where it fails first, and
//! which mistake explains the failure.

mod mistake;
mod replace;
mod role;
mod signature;

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

pub use mistake::Mistake;
pub use replace::replacements;
pub use role::{Role, RoleMap};
use serde::Serialize;
pub(super) use signature::clear_misses;
pub use signature::{MissConvention, Signature, Unrecognized};
use toyproof_eval::UndefinedPolicy;
use toyproof_eval_native::Program;
use toyproof_glsl as glsl;
use toyproof_gpu::Worker;

use super::axis::{Axis, Kind, axes};
use super::case::{Case, Label, RaySphere, Step};
use super::case_sampler::Random;
use super::cells::{Cells, Reference, reference_of};
use super::formula::{Reading, Subject, main};
use super::tally::Outcome;
use super::{Failure, Report, Settings, case_frame, check_subject, exact, render_on_cpu, study};

/// The results for a function.
#[derive(Debug, Clone)]
pub struct Findings {
    /// Where it fails.
    pub report: Report,
    /// The mistake that explains its results for typical rays.
    pub mistake: Option<Mistake>,
    /// The simplest ray with a wrong result in f32.
    pub example: Option<Example>,
}

impl Findings {
    /// The summary: the mistake, an example, then where the function fails.
    #[must_use]
    pub fn summary(&self, name: &str) -> Vec<String> {
        let mut lines = vec![match (&self.mistake, &self.example) {
            (Some(mistake), _) => format!("{name} {} ({})", mistake.description, mistake.name),
            (None, Some(_)) => {
                format!("{name} makes none of the known mistakes, but fails for extreme input")
            }
            (None, None) => format!("{name} is right for all tested input"),
        }];
        if let Some(example) = &self.example {
            lines.push(format!(
                "for example, simplified from a case with {}:",
                example.found_at
            ));
            lines.extend(example.assignments.iter().map(|line| format!("    {line}")));
            let actual = match example.actual.strip_prefix("t = ") {
                Some(t) if example.expected.starts_with("t = ") => t,
                _ => &example.actual,
            };
            lines.push(format!("  expected {}, got {actual}", example.expected));
        }
        if !self.report.breakdowns.is_empty() {
            lines.push(String::new());
            lines.extend(self.report.function_summary());
        }
        lines
    }

    /// All results as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        self.report
            .json_with(&serde_json::json!({ "mistake": self.mistake, "example": self.example }))
    }
}

/// A ray with a wrong result, simplified to few digits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Example {
    /// Statements that assign the ray and sphere to the function's parameters.
    pub assignments: Vec<String>,
    /// The right result.
    pub expected: String,
    /// The actual result.
    pub actual: String,
    /// The step of the case that it was simplified from.
    pub found_at: String,
}

/// A shader with another `mainImage` than its own, which is kept as `tpMainImage`.
#[must_use]
pub fn with_main(text: &str, main: &str) -> String {
    format!("#define mainImage tpMainImage\n{text}\n#undef mainImage\n{main}")
}

/// A shader that calls a function of `text` for each case.
#[must_use]
pub fn subject(text: &str, signature: &Signature, options: glsl::Options) -> Subject {
    let (steps, result) = signature.call();
    Subject {
        name: signature.name.clone(),
        kind: Kind::Spheres,
        text: with_main(text, &main(&steps, &result)),
        in_f64: true,
        reading: Reading::Function(signature.clone()),
        options,
    }
}

/// Tests a function on all axes.
///
/// # Errors
///
/// [`Failure`] if the function cannot be run.
pub fn examine(
    subject: &Subject,
    signature: &Signature,
    worker: Option<&mut Worker>,
    settings: Settings,
    interrupt: &AtomicBool,
    done: impl Fn(),
) -> Result<Findings, Failure> {
    let report = study(std::slice::from_ref(subject), worker, settings, interrupt, done)?;
    let checked = check_subject(subject)?;
    let program =
        Program::prepared(&checked, UndefinedPolicy::Plain).map_err(toyproof_eval::Failure::from)?;
    let runner = FunctionRunner {
        program: &program,
        signature,
        deadline: None,
    };
    let convention_f32 = runner.miss_convention::<f32>()?;
    let convention_f64 = runner.miss_convention::<f64>()?;
    let [unit, other] = [true, false].map(|unit| {
        let ray_spheres = typical_cases(unit);
        let outcomes = runner.outcomes::<f64>(&ray_spheres, &convention_f64)?;
        Ok::<_, Failure>(ray_spheres.into_iter().zip(outcomes).collect::<Vec<_>>())
    });
    let mistake = mistake::recognize(
        &unit?,
        &other?,
        convention_f64.behind_is_miss(),
        signature.adds_squared_radius,
    );
    Ok(Findings {
        example: runner.example(settings, &convention_f32, interrupt)?,
        report,
        mistake,
    })
}

/// The results of a function for rays and spheres of typical size.
#[derive(Debug, Clone, Copy)]
pub struct TypicalResults {
    /// The number of cases.
    pub cases: u64,
    /// The number of cases with the right result.
    pub right: u64,
    /// The mistake that explains the others.
    pub mistake: Option<Mistake>,
}

/// Tests a function in f64, for rays of length 1 and spheres of typical size. `timeout` is the time limit of
/// its compilation and of its evaluation.
///
/// # Errors
///
/// [`Failure`] if the function cannot be run in time.
pub fn test_typical(
    subject: &Subject,
    signature: &Signature,
    timeout: Duration,
) -> Result<TypicalResults, Failure> {
    let checked = check_subject(subject)?;
    let program = Program::prepared_within(&checked, UndefinedPolicy::Plain, Some(timeout))
        .map_err(toyproof_eval::Failure::from)?;
    let runner = FunctionRunner {
        program: &program,
        signature,
        deadline: Some(Instant::now() + timeout),
    };
    let convention = runner.miss_convention::<f64>()?;
    let ray_spheres = typical_cases(true);
    let outcomes = runner.outcomes::<f64>(&ray_spheres, &convention)?;
    let outcomes: Vec<_> = ray_spheres.into_iter().zip(outcomes).collect();
    let is_right =
        |(ray_sphere, outcome): &&(RaySphere, Outcome)| outcome.is_right(&reference(ray_sphere, false));
    let right = outcomes.iter().filter(is_right).count();
    Ok(TypicalResults {
        cases: outcomes.len() as u64,
        right: right as u64,
        mistake: mistake::recognize(
            &outcomes,
            &[],
            convention.behind_is_miss(),
            signature.adds_squared_radius,
        ),
    })
}

/// Evaluates a function on chosen cases.
struct FunctionRunner<'a> {
    program: &'a Program,
    signature: &'a Signature,
    deadline: Option<Instant>,
}

impl FunctionRunner<'_> {
    fn colors<N: toyproof_eval::Number>(&self, ray_spheres: &[RaySphere]) -> Result<Vec<[f64; 3]>, Failure> {
        let cases: Vec<_> = ray_spheres.iter().copied().map(Case::Sphere).collect();
        let mut colors = render_on_cpu::<N>(self.program, &case_frame(&cases), self.deadline)?;
        colors.truncate(ray_spheres.len());
        Ok(colors)
    }

    fn miss_convention<N: toyproof_eval::Number>(&self) -> Result<MissConvention, Failure> {
        Ok(MissConvention::of(
            self.signature,
            &self.colors::<N>(&clear_misses())?,
        ))
    }

    fn outcomes<N: toyproof_eval::Number>(
        &self,
        ray_spheres: &[RaySphere],
        convention: &MissConvention,
    ) -> Result<Vec<Outcome>, Failure> {
        let colors = self.colors::<N>(ray_spheres)?;
        Ok(colors
            .into_iter()
            .map(|color| convention.outcome(color))
            .collect())
    }

    /// The simplest failing case of the least extreme step that fails.
    fn example(
        &self,
        settings: Settings,
        convention: &MissConvention,
        interrupt: &AtomicBool,
    ) -> Result<Option<Example>, Failure> {
        let axes = axes();
        let cells = Cells::sample(&axes, Kind::Spheres, settings.seed, settings.cases, interrupt);
        let cells = cells.ok_or(Failure::Interrupted)?;
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
            let near = cell.axis == "origin";
            let failing = |ray_spheres: &[RaySphere]| -> Result<Vec<bool>, Failure> {
                let outcomes = self.outcomes::<f32>(ray_spheres, convention)?;
                let pairs = ray_spheres.iter().zip(outcomes);
                Ok(pairs
                    .map(|(ray_sphere, outcome)| is_wrong(ray_sphere, outcome, near))
                    .collect())
            };
            if let Some(ray_sphere) = simplest_failing(&wrong, failing)? {
                return Ok(Some(self.describe_example(
                    ray_sphere,
                    convention,
                    near,
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
        near: bool,
        found_at: String,
    ) -> Result<Example, Failure> {
        let colors = self.colors::<f32>(&[ray_sphere])?;
        let actual = convention.outcome(colors[0]);
        let expected = reference(&ray_sphere, near);
        let number = |t: f64| format!("t = {t:?}");
        Ok(Example {
            assignments: self
                .signature
                .assignments(ray_sphere.o, ray_sphere.d, ray_sphere.c, ray_sphere.r),
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

/// Rays and spheres of typical size, from all sides and from inside; none is nearly tangent.
fn typical_cases(unit: bool) -> Vec<RaySphere> {
    let random = &mut Random::new(1, &["ordinary"]);
    let mut ray_spheres = Vec::new();
    while ray_spheres.len() < 240 {
        let r = random.between(0.4, 2.5);
        let c = random.direction() * random.between(0.5, 4.0);
        let inside = random.unit() < 0.25;
        let away = if inside {
            random.between(0.1, 0.8)
        } else {
            random.between(1.5, 6.0)
        };
        let ahead = random.direction();
        let aside = ahead.cross(random.direction()).normalize_or(glam::DVec3::X);
        let o = c - ahead * (away * r);
        let target = c + aside * (r * random.between(0.0, 1.6));
        let d = (target - o).normalize() * if random.unit() < 0.2 { -1.0 } else { 1.0 };
        let stretch = if unit { 1.0 } else { random.log_between(0.3, 4.0) };
        let to_f32 = |v: glam::DVec3| v.to_array().map(|x| x as f32);
        let ray_sphere = RaySphere {
            o: to_f32(o),
            d: to_f32(d * stretch),
            c: to_f32(c),
            r: r as f32,
        };
        let intersection = exact::sphere(ray_sphere.o, ray_sphere.d, ray_sphere.c, ray_sphere.r);
        if intersection.is_some_and(|intersection| intersection.discriminant.abs() > 0.02) {
            ray_spheres.push(ray_sphere);
        }
    }
    ray_spheres
}

// Simplification of a failing case to few digits, zeros and ones.

/// The minimum |δ| of an example: cases nearer to tangency are not instructive.
const MIN_EXAMPLE_DELTA: f64 = 1e-12;

/// The reference result of a case.
fn reference(ray_sphere: &RaySphere, near: bool) -> Reference {
    reference_of(&Case::Sphere(*ray_sphere), near).map_or(Reference::UNDEFINED, |(reference, _)| reference)
}

/// Whether an outcome is wrong for a case.
fn is_wrong(ray_sphere: &RaySphere, outcome: Outcome, near: bool) -> bool {
    match reference_of(&Case::Sphere(*ray_sphere), near) {
        Some((_, discriminant)) if discriminant.abs() < MIN_EXAMPLE_DELTA => false,
        Some((reference, _)) => !outcome.is_right(&reference),
        None => !outcome.is_right(&Reference::UNDEFINED),
    }
}

/// The simplest case derived from failing ones that still fails.
fn simplest_failing(
    wrong: &[RaySphere],
    failing: impl Fn(&[RaySphere]) -> Result<Vec<bool>, Failure>,
) -> Result<Option<RaySphere>, Failure> {
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

/// The length of its numbers as text.
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
