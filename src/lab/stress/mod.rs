//! Numerical stability at the extremes: how formulas that find where a ray meets a surface fail, and from where on.
//!
//! A subject is a shader that reads rays and surfaces from its channels and paints what it makes of them, a pixel for each. It runs in f32
//! and in f64 on the evaluator, and on a GPU; [`exact`] tells the truth about the very floats that it read.

pub mod axis;
mod breakdown;
mod cells;
pub mod exact;
pub mod formula;
pub mod function;
mod paint;
mod picture;
mod random;
mod table;
mod tally;

use std::sync::atomic::{AtomicBool, Ordering};

pub use breakdown::Breakdown;
pub use paint::Failure;
use serde::Serialize;
pub use tally::Tally;
use toyproof_eval::Program;
use toyproof_gpu::Worker;
use toyproof_translate::FloatMode;

use self::axis::{Case, Kind, Step, axes};
use self::cells::Cells;
use self::formula::{Reading, Subject};
use self::function::Answers;

/// How much is tested.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// What all cases are drawn from.
    pub seed: u64,
    /// How many for each step of an axis.
    pub cases: usize,
    /// How far the GPU's driver may rearrange arithmetic.
    pub float: FloatMode,
}

/// What a subject made of one step of an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The subject's name.
    pub formula: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// `cpu`, or the adapter and its driver.
    pub device: String,
    /// What is taken to its limits.
    pub axis: &'static str,
    /// How far.
    #[serde(serialize_with = "table::word")]
    pub value: Step,
    /// What came of it.
    #[serde(flatten)]
    pub tally: Tally,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// What the cases were drawn from.
    pub seed: u64,
    /// How many there were at most for each step.
    pub cases: usize,
    /// Where the formulas fail, on the CPU.
    pub breakdowns: Vec<Breakdown>,
    /// Of every subject, on every device, for every step.
    pub rows: Vec<Row>,
}

/// The evaluator's name among devices.
pub const CPU: &str = "cpu";

/// How many runs [`study`] reports as done, one by one.
#[must_use]
pub fn runs(subjects: &[Subject], gpu: bool) -> u64 {
    let runs = subjects
        .iter()
        .map(|subject| 1 + u64::from(subject.in_f64) + u64::from(gpu));
    runs.sum()
}

/// Puts subjects to the test; `done` is called after each run.
///
/// # Errors
/// Why it could not be done; [`Failure::Interrupted`] as soon as `interrupt` is set.
pub fn study(
    subjects: &[Subject],
    mut worker: Option<&mut Worker>,
    settings: Settings,
    interrupt: &AtomicBool,
    done: impl Fn(),
) -> Result<Report, Failure> {
    let axes = axes();
    let mut rows = Vec::new();
    for kind in [Kind::Spheres, Kind::Quadrics, Kind::Secondaries] {
        let mut subjects = subjects.iter().filter(|subject| subject.kind == kind).peekable();
        if subjects.peek().is_none() {
            continue;
        }
        let cells =
            Cells::draw(&axes, kind, settings.seed, settings.cases, interrupt).ok_or(Failure::Interrupted)?;
        // After all cases come those that tell how a function says no.
        let count = cells.cases.len();
        let misses = function::clear_misses().into_iter().map(Case::Sphere);
        let asked: Vec<Case> = cells.cases.iter().copied().chain(misses).collect();
        let frame = paint::frame(&asked);
        for subject in subjects {
            let checked = paint::checked(subject)?;
            let program = Program::prepared(&checked, toyproof_eval::Variant::Plain)
                .map_err(toyproof_eval::Failure::from)?;
            let mut take = |precision, digits, device: &str, colors: &[[f64; 3]]| {
                let answers = match &subject.reading {
                    Reading::Function(signature) => Some(Answers::of(signature, &colors[count..asked.len()])),
                    _ => None,
                };
                let run = Run {
                    precision,
                    digits,
                    device,
                    answers,
                };
                rows.extend(cells.rows(subject, &run, colors));
                done();
                if interrupt.load(Ordering::Relaxed) {
                    Err(Failure::Interrupted)
                } else {
                    Ok(())
                }
            };
            take("f32", 24, CPU, &paint::on_cpu::<f32>(&program, &frame)?)?;
            if subject.in_f64 {
                take("f64", 53, CPU, &paint::on_cpu::<f64>(&program, &frame)?)?;
            }
            if let Some(worker) = worker.as_deref_mut() {
                let (colors, device) = paint::on_gpu(worker, &checked, &frame, settings.float)?;
                take("f32", 24, &device, &colors)?;
            }
        }
    }
    let of_cpu: Vec<&Row> = rows.iter().filter(|row| row.device == CPU).collect();
    let same = |a: &&Row, b: &&Row| a.formula == b.formula && a.precision == b.precision;
    let breakdowns = of_cpu.chunk_by(same);
    let breakdowns = breakdowns.flat_map(|rows| breakdown::breakdowns(&axes, rows));
    Ok(Report {
        seed: settings.seed,
        cases: settings.cases,
        breakdowns: breakdowns.collect(),
        rows,
    })
}

/// One run of a subject.
struct Run<'a> {
    precision: &'static str,
    digits: u32,
    device: &'a str,
    answers: Option<Answers>,
}

impl Cells {
    /// A row for each step, of what a subject left for all cases.
    fn rows(&self, subject: &Subject, run: &Run, colors: &[[f64; 3]]) -> Vec<Row> {
        let rows = self.steps.iter().map(|cell| {
            let range = cell.range.clone();
            let answers = colors[range.clone()].iter().copied();
            let cases = answers.zip(self.exact[range].iter().copied());
            Row {
                formula: subject.name.clone(),
                precision: run.precision,
                device: run.device.to_owned(),
                axis: cell.axis,
                value: cell.step,
                tally: Tally::of(&subject.reading, run.digits, run.answers.as_ref(), cases),
            }
        });
        rows.collect()
    }
}
