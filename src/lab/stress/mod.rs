//! Numerical stability at extreme arguments: finds where ray–surface intersection formulas fail.
//!
//! A subject is a shader that reads rays and surfaces from its channels and returns its results, one pixel
//! per case. It runs in f32 and f64 on the evaluator, and on a GPU; [`exact`] computes the reference from the
//! same floats.

pub mod axis;
pub mod case;
mod case_sampler;
mod cells;
pub mod exact;
pub mod formula;
pub mod function;
mod output;
mod summary;
mod tally;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use axis::{Kind, axes};
use case::{Case, Step};
use cells::Cells;
use formula::{Reading, Subject};
use function::MissConvention;
use serde::Serialize;
pub use tally::{Breakdown, Tally};
use thiserror::Error;
use toyproof_diagnostic::{Diagnostic, File, Files};
use toyproof_eval::{self as eval, Number, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{self as gpu, Worker};
use toyproof_image::{Frame, Image, Texture};
use toyproof_translate::FloatMode;

/// The settings of a study.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// The seed of all cases.
    pub seed: u64,
    /// The number of cases for each step of an axis.
    pub cases: usize,
    /// How far the GPU's driver may rearrange arithmetic.
    pub float: FloatMode,
}

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
    #[serde(serialize_with = "output::serialize_step")]
    #[serde(rename = "step")]
    pub value: Step,
    /// The statistics.
    #[serde(flatten)]
    pub tally: Tally,
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

/// Tests subjects on all axes; calls `done` after each run.
///
/// # Errors
///
/// [`Failure`] if a subject cannot be run; [`Failure::Interrupted`] as soon as `interrupt` is set.
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
        let cells = Cells::sample(&axes, kind, settings.seed, settings.cases, interrupt)
            .ok_or(Failure::Interrupted)?;
        // The last cases reveal how a function reports a miss.
        let count = cells.cases.len();
        let misses = function::clear_misses().into_iter().map(Case::Sphere);
        let all_cases: Vec<Case> = cells.cases.iter().copied().chain(misses).collect();
        let frame = case_frame(&all_cases);
        for subject in subjects {
            let checked = check_subject(subject)?;
            let program = Program::prepared(&checked, UndefinedPolicy::Plain).map_err(eval::Failure::from)?;
            let mut record = |precision, digits, device: &str, colors: &[[f64; 3]]| {
                let convention = match &subject.reading {
                    Reading::Function(signature) => {
                        Some(MissConvention::of(signature, &colors[count..all_cases.len()]))
                    }
                    _ => None,
                };
                let run = Run {
                    precision,
                    digits,
                    device,
                    convention,
                };
                rows.extend(cells.rows(subject, &run, colors));
                done();
                if interrupt.load(Ordering::Relaxed) {
                    Err(Failure::Interrupted)
                } else {
                    Ok(())
                }
            };
            record("f32", 24, CPU, &render_on_cpu::<f32>(&program, &frame, None)?)?;
            if subject.in_f64 {
                record("f64", 53, CPU, &render_on_cpu::<f64>(&program, &frame, None)?)?;
            }
            if let Some(worker) = worker.as_deref_mut() {
                let (colors, device) = render_on_gpu(worker, &checked, &frame, settings.float)?;
                record("f32", 24, &device, &colors)?;
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

/// One run of a subject.
struct Run<'a> {
    precision: &'static str,
    digits: u32,
    device: &'a str,
    convention: Option<MissConvention>,
}

impl Cells {
    /// The results of a run: a row for each step.
    fn rows(&self, subject: &Subject, run: &Run, colors: &[[f64; 3]]) -> Vec<Row> {
        let rows = self.steps.iter().map(|cell| {
            let range = cell.range.clone();
            let results = colors[range.clone()].iter().copied();
            let cases = results.zip(self.references[range].iter().copied());
            Row {
                formula: subject.name.clone(),
                precision: run.precision,
                device: run.device.to_owned(),
                axis: cell.axis,
                value: cell.step,
                tally: Tally::of(&subject.reading, run.digits, run.convention.as_ref(), cases),
            }
        });
        rows.collect()
    }
}

// Running a subject: one pixel per case, whose numbers are in the channels.

/// The width of the image, in cases.
const FRAME_WIDTH: usize = 512;

/// The reason why a subject could not be run.
#[derive(Debug, Error)]
pub enum Failure {
    /// The shader made for it does not compile.
    #[error("{}", first_message(.0))]
    Invalid(Vec<Diagnostic>),
    /// The evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] gpu::Failure),
    /// The user interrupted the run.
    #[error("interrupted")]
    Interrupted,
}

fn first_message(diagnostics: &[Diagnostic]) -> &str {
    diagnostics.first().map_or("", |first| &first.message)
}

/// Parses and checks a subject's shader.
fn check_subject(subject: &Subject) -> Result<Checked, Failure> {
    let mut files = Files::default();
    let file = files.add(File::new("<stress>", subject.text.as_str()));
    glsl::check(&files, file, &subject.options).map_err(|errors| Failure::Invalid(errors.into()))
}

/// A frame whose channels hold the cases.
fn case_frame(cases: &[Case]) -> Frame {
    let width = cases.len().clamp(1, FRAME_WIDTH);
    let height = cases.len().div_ceil(width).max(1);
    let channel = |i: usize| {
        let mut pixels: Vec<_> = cases.iter().map(|case| case.texels()[i]).collect();
        pixels.resize(width * height, [0.0; 4]);
        Texture::from(Image::new(width as u32, height as u32, pixels))
    };
    Frame {
        size: [width as u32, height as u32],
        channels: [0, 1, 2, 3].map(|at| (at < 3).then(|| channel(at))),
        ..Frame::default()
    }
}

/// Runs a shader on the evaluator, and returns the colors of all pixels in order: one per case, then padding.
fn render_on_cpu<N: Number>(
    program: &Program,
    frame: &Frame,
    deadline: Option<Instant>,
) -> Result<Vec<[f64; 3]>, Failure> {
    let settings = eval::Settings::<N> {
        undefined: UndefinedPolicy::Plain,
        deadline,
        ..eval::Settings::default()
    };
    let framebuffer = program.render(frame, &settings)?.framebuffer;
    let [width, height] = frame.size;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Ok(places
        .map(|(x, y)| framebuffer.get(x, y).map(toyproof_eval::Arithmetic::to_f64))
        .collect())
}

/// Runs a shader on a GPU, and returns the colors and the device's name.
fn render_on_gpu(
    worker: &mut Worker,
    checked: &Checked,
    frame: &Frame,
    float: FloatMode,
) -> Result<(Vec<[f64; 3]>, String), Failure> {
    let rendered = worker.draw_unwatched(float.lower(checked), frame.clone(), float)?;
    let device = rendered.device.clone();
    let image = rendered.image();
    let colors = image.pixels().iter();
    let colors = colors.map(|&[r, g, b, _]| [r, g, b].map(f64::from));
    Ok((colors.collect(), device))
}
