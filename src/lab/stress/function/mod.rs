//! An author's own function at the extremes: what it takes, how it says no, where it fails first, and by which mistake.

mod leaf;
mod mistake;
mod reading;
mod replace;
mod role;
mod shrink;
mod signature;

use std::sync::atomic::AtomicBool;

pub use mistake::Mistake;
pub use reading::Answers;
pub(super) use reading::clear_misses;
pub use replace::replacements;
pub use role::Role;
use serde::Serialize;
pub use signature::{Map, Signature};
use toyproof_eval::{Program, Variant};
use toyproof_glsl as glsl;
use toyproof_gpu::Worker;

use super::axis::{Case, Kind, Shot, Step, axes};
use super::cells::Cells;
use super::formula::{Reading, Subject, main};
use super::random::Random;
use super::tally::Outcome;
use super::{Failure, Report, Settings, paint, study};

/// What is known of a function.
#[derive(Debug, Clone)]
pub struct Findings {
    /// Where it fails, and where not.
    pub report: Report,
    /// The mistake that explains what it says of ordinary rays.
    pub mistake: Option<Mistake>,
    /// The simplest ray that it is wrong about in f32.
    pub example: Option<Example>,
}

impl Findings {
    /// Everything that was found.
    #[must_use]
    pub fn json(&self) -> String {
        self.report
            .json_with(&serde_json::json!({ "mistake": self.mistake, "example": self.example }))
    }
}

/// A ray that a function is wrong about.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Example {
    /// Statements that give the function's parameters their values.
    pub paste: Vec<String>,
    /// What is right.
    pub expected: String,
    /// What came.
    pub came: String,
    /// Where it was met first.
    pub at: String,
}

/// The shader that calls a function of `text` for each case.
#[must_use]
pub fn subject(text: &str, signature: &Signature, options: glsl::Options) -> Subject {
    let (steps, result) = signature.call();
    Subject {
        name: signature.name.clone(),
        kind: Kind::Spheres,
        // The author's own main function stays, under another name.
        text: format!(
            "#define mainImage tpMainImage\n{text}\n#undef mainImage\n{}",
            main(&steps, &result)
        ),
        in_f64: true,
        reading: Reading::Function(signature.clone()),
        options,
    }
}

/// Puts a function to the test.
///
/// # Errors
/// Why it could not be done.
pub fn examine(
    subject: &Subject,
    signature: &Signature,
    worker: Option<&mut Worker>,
    settings: Settings,
    interrupt: &AtomicBool,
    done: impl Fn(),
) -> Result<Findings, Failure> {
    let report = study(std::slice::from_ref(subject), worker, settings, interrupt, done)?;
    let checked = paint::checked(subject)?;
    let program = Program::prepared(&checked, Variant::Plain).map_err(toyproof_eval::Failure::from)?;
    let asked = Asked {
        program: &program,
        signature,
    };
    let single = asked.answers::<f32>()?;
    let double = asked.answers::<f64>()?;
    let [unit, other] = [true, false].map(|unit| {
        let shots = ordinary(unit);
        let told = asked.ask::<f64>(&shots, &double)?;
        Ok::<_, Failure>(shots.into_iter().zip(told).collect::<Vec<_>>())
    });
    let mistake = mistake::recognise(&unit?, &other?, double.behind_is_miss());
    Ok(Findings {
        example: asked.example(settings, &single, interrupt)?,
        report,
        mistake,
    })
}

/// A function that can be asked.
struct Asked<'a> {
    program: &'a Program,
    signature: &'a Signature,
}

impl Asked<'_> {
    fn colors<N: toyproof_eval::Number>(&self, shots: &[Shot]) -> Result<Vec<[f64; 3]>, Failure> {
        let cases: Vec<_> = shots.iter().copied().map(Case::Sphere).collect();
        let mut colors = paint::on_cpu::<N>(self.program, &paint::frame(&cases))?;
        colors.truncate(shots.len());
        Ok(colors)
    }

    fn answers<N: toyproof_eval::Number>(&self) -> Result<Answers, Failure> {
        Ok(Answers::of(self.signature, &self.colors::<N>(&clear_misses())?))
    }

    fn ask<N: toyproof_eval::Number>(
        &self,
        shots: &[Shot],
        answers: &Answers,
    ) -> Result<Vec<Outcome>, Failure> {
        let colors = self.colors::<N>(shots)?;
        Ok(colors.into_iter().map(|color| answers.outcome(color)).collect())
    }

    /// The simplest failing case, of the step that is the least extreme.
    fn example(
        &self,
        settings: Settings,
        answers: &Answers,
        interrupt: &AtomicBool,
    ) -> Result<Option<Example>, Failure> {
        let axes = axes();
        let cells = Cells::draw(&axes, Kind::Spheres, settings.seed, settings.cases, interrupt);
        let cells = cells.ok_or(Failure::Interrupted)?;
        let mut order: Vec<_> = cells.steps.iter().collect();
        order.sort_by(|a, b| extremeness(a.axis, a.step).total_cmp(&extremeness(b.axis, b.step)));
        for cell in order {
            let shots: Vec<Shot> = cells.cases[cell.range.clone()]
                .iter()
                .filter_map(|case| match case {
                    Case::Sphere(shot) => Some(*shot),
                    _ => None,
                })
                .collect();
            let told = self.ask::<f32>(&shots, answers)?;
            let truths = &cells.exact[cell.range.clone()];
            let wrong: Vec<Shot> = shots
                .iter()
                .zip(told.iter().zip(truths))
                .filter(|(_, (told, truth))| !told.is_right(truth))
                .map(|(shot, _)| *shot)
                .collect();
            // Now and then a ray hangs by a hair of the function's own.
            if wrong.len() * 100 <= shots.len() {
                continue;
            }
            let near = cell.axis == "origin";
            let failing = |shots: &[Shot]| -> Result<Vec<bool>, Failure> {
                let told = self.ask::<f32>(shots, answers)?;
                let pairs = shots.iter().zip(told);
                Ok(pairs
                    .map(|(shot, told)| shrink::is_wrong(shot, told, near))
                    .collect())
            };
            if let Some(shot) = shrink::smallest(&wrong, failing)? {
                return Ok(Some(self.tell(
                    shot,
                    answers,
                    near,
                    format!("{} {}", cell.axis, cell.step),
                )?));
            }
        }
        Ok(None)
    }

    fn tell(&self, shot: Shot, answers: &Answers, near: bool, at: String) -> Result<Example, Failure> {
        let colors = self.colors::<f32>(&[shot])?;
        let came = answers.outcome(colors[0]);
        let expected = shrink::truth(&shot, near);
        let number = |t: f64| format!("t = {t:?}");
        Ok(Example {
            paste: self.signature.assignments(shot.o, shot.d, shot.c, shot.r),
            expected: expected.t.map_or_else(|| "no hit".to_owned(), |t| number(t.high)),
            came: match came {
                Outcome::Miss => format!("no hit ({})", f64::from(colors[0][0] as f32)),
                Outcome::Hit(t) => number(t),
                Outcome::Nan => "NaN".to_owned(),
            },
            at,
        })
    }
}

/// How far a step is from what scenes are made of; what has no size comes last.
fn extremeness(axis: &str, step: Step) -> f64 {
    match (axis, step) {
        ("grazing", Step::Number(delta)) => 20.0 - libm::log10(delta.abs()),
        (_, Step::Number(number)) if number > 0.0 => libm::log10(number).abs(),
        (_, Step::Number(_)) => 0.0,
        ("origin", Step::Word("the origin inside")) => 0.5,
        ("origin", Step::Word(_)) => 10.0,
        (_, Step::Word(_)) => 100.0,
    }
}

/// Rays and spheres of ordinary size from all sides, and from inside; none close to an edge.
fn ordinary(unit: bool) -> Vec<Shot> {
    let random = &mut Random::new(1, &["ordinary"]);
    let mut shots = Vec::new();
    while shots.len() < 240 {
        let r = random.between(0.4, 2.5);
        let c = random.direction() * random.between(0.5, 4.0);
        let inside = random.number() < 0.25;
        let away = if inside {
            random.between(0.1, 0.8)
        } else {
            random.between(1.5, 6.0)
        };
        let ahead = random.direction();
        let aside = ahead.cross(random.direction()).normalize_or(glam::DVec3::X);
        let o = c - ahead * (away * r);
        let target = c + aside * (r * random.between(0.0, 1.6));
        let d = (target - o).normalize() * if random.number() < 0.2 { -1.0 } else { 1.0 };
        let stretch = if unit { 1.0 } else { random.log_between(0.3, 4.0) };
        let single = |v: glam::DVec3| v.to_array().map(|x| x as f32);
        let shot = Shot {
            o: single(o),
            d: single(d * stretch),
            c: single(c),
            r: r as f32,
        };
        let met = super::exact::sphere(shot.o, shot.d, shot.c, shot.r);
        if met.is_some_and(|met| met.discriminant.abs() > 0.02) {
            shots.push(shot);
        }
    }
    shots
}
