//! A study: runs subjects on all axes, and counts their failures.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Serialize, Serializer};
use toyproof_glsl::Checked;
use toyproof_image::Frame;
use toyproof_player::{DrawOutput, DriverFailure};

use crate::axis::{Kind, axes};
use crate::case::{Case, Step};
use crate::cells::Cells;
use crate::formula::{Reading, Subject};
use crate::function::{MissConvention, clear_misses};
use crate::run::{RunError, ShaderRunner, case_frame};
use crate::tally::{self, Breakdown, Tally};

/// The settings of a study.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// The seed of all cases.
    pub seed: u64,
    /// The number of cases for each step of an axis.
    pub cases: usize,
}

/// Renders a frame of a shader on a GPU.
pub type Gpu<'a> = dyn FnMut(&Checked, &Frame) -> Result<DrawOutput, DriverFailure> + 'a;

/// The results of a subject for one step of an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The subject's name.
    pub formula: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// `cpu`, or the adapter and its driver.
    pub device: String,
    /// The axis.
    pub axis: &'static str,
    /// The step.
    #[serde(serialize_with = "serialize_step")]
    #[serde(rename = "step")]
    pub value: Step,
    /// The statistics.
    #[serde(flatten)]
    pub tally: Tally,
}

fn serialize_step<S: Serializer>(step: &Step, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(step)
}

/// The results of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The seed of the cases.
    pub seed: u64,
    /// The maximum number of cases for each step.
    pub cases: usize,
    /// Where the formulas fail on the CPU.
    pub breakdowns: Vec<Breakdown>,
    /// The results of every subject on every device for every step.
    pub rows: Vec<Row>,
}

/// The device name of the evaluator.
pub const CPU: &str = "cpu";

/// The number of runs in a [`study`], each of which calls `done`.
#[must_use]
pub fn run_count(subjects: &[Subject], gpu: bool) -> u64 {
    let runs = subjects
        .iter()
        .map(|subject| 1 + u64::from(subject.in_f64) + u64::from(gpu));
    runs.sum()
}

/// Tests subjects on all axes, also on a GPU if there is one; calls `done` after each run.
///
/// # Errors
///
/// [`RunError`] if a subject cannot be run; [`RunError::Interrupted`] as soon as `interrupt` is set.
pub fn study(
    subjects: &[Subject],
    mut gpu: Option<&mut Gpu>,
    settings: Settings,
    interrupt: &AtomicBool,
    done: impl Fn(),
) -> Result<Report, RunError> {
    let axes = axes();
    let mut rows = Vec::new();
    for kind in [Kind::Spheres, Kind::Quadrics, Kind::Secondaries] {
        let mut subjects = subjects.iter().filter(|subject| subject.kind == kind).peekable();
        if subjects.peek().is_none() {
            continue;
        }
        let cells = Cells::sample(&axes, kind, settings.seed, settings.cases, interrupt)
            .ok_or(RunError::Interrupted)?;
        // The last cases reveal how a function reports a miss.
        let count = cells.cases.len();
        let misses = clear_misses().into_iter().map(Case::Sphere);
        let all_cases: Vec<Case> = cells.cases.iter().copied().chain(misses).collect();
        let frame = case_frame(&all_cases);
        for subject in subjects {
            let runner = ShaderRunner::new(&subject.text, &subject.options, None)?;
            let mut record = |precision, digits, device: &str, colors: &[[f64; 3]]| {
                let convention = match &subject.reading {
                    Reading::Function(signature) => {
                        Some(MissConvention::new(signature, &colors[count..all_cases.len()]))
                    }
                    _ => None,
                };
                rows.extend(cells.steps.iter().map(|cell| {
                    let range = cell.range.clone();
                    let results = colors[range.clone()].iter().copied();
                    let cases = results.zip(cells.references[range].iter().copied());
                    Row {
                        formula: subject.name.clone(),
                        precision,
                        device: device.to_owned(),
                        axis: cell.axis,
                        value: cell.step,
                        tally: Tally::new(&subject.reading, digits, convention.as_ref(), cases),
                    }
                }));
                done();
                if interrupt.load(Ordering::Relaxed) {
                    Err(RunError::Interrupted)
                } else {
                    Ok(())
                }
            };
            record("f32", f32::MANTISSA_DIGITS, CPU, &runner.colors::<f32>(&frame)?)?;
            if subject.in_f64 {
                record("f64", f64::MANTISSA_DIGITS, CPU, &runner.colors::<f64>(&frame)?)?;
            }
            if let Some(gpu) = gpu.as_deref_mut() {
                let rendered = gpu(&runner.checked, &frame)?;
                let device = rendered.device.clone();
                let image = rendered.image();
                let colors = image
                    .pixels()
                    .iter()
                    .map(|&[r, g, b, _]| [r, g, b].map(f64::from));
                record("f32", f32::MANTISSA_DIGITS, &device, &colors.collect::<Vec<_>>())?;
            }
        }
    }
    let cpu_rows: Vec<&Row> = rows.iter().filter(|row| row.device == CPU).collect();
    let same = |a: &&Row, b: &&Row| a.formula == b.formula && a.precision == b.precision;
    let breakdowns = cpu_rows.chunk_by(same);
    let breakdowns = breakdowns.flat_map(|rows| tally::breakdowns(&axes, rows));
    Ok(Report {
        seed: settings.seed,
        cases: settings.cases,
        breakdowns: breakdowns.collect(),
        rows,
    })
}
