//! Compares a shader with what it should render, in three checks: is the algorithm right, is float32 precise enough, and
//! does the toolchain keep every bit. GPU, evaluator and tracer run at once; [`verify`] gives the verdict and what explains it.
//!
//! ```
//! use std::time::Duration;
//!
//! use toyproof_diagnostic::{Deadline, File, Files};
//! use toyproof_image::Frame;
//! use toyproof_translate::FloatMode;
//! use toyproof_verify::compare::Verdict;
//! use toyproof_verify::{Case, Expected, verify};
//!
//! let mut files = Files::default();
//! let scene = files.add(File::new("red.toml", "[background]\ncolor = [1.0, 0.0, 0.0]\n"));
//! let scene = toyproof_scene::parse(&files, scene).unwrap();
//! let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1, 0, 0, 1); }";
//! let shader = files.add(File::new("red.glsl", text));
//! let checked = toyproof_glsl::check(&files, shader, &Default::default()).unwrap();
//! let lints = toyproof_lint::lint(&files, &checked, &Deadline::default());
//! let frame = Frame { size: [16, 9], ..Frame::default() };
//! let expected = Expected::new(scene, &frame);
//! let case = Case {
//!     checked: &checked,
//!     lints: &lints,
//!     expected: Some(&expected),
//!     suspects: None,
//!     frame: &frame,
//!     float: FloatMode::Strict,
//!     timeout: Duration::from_secs(10),
//!     pool: None,
//! };
//! // Without a GPU worker, the toolchain check is left out.
//! assert_eq!(verify(None, &case).unwrap().verdict, Verdict::Correct);
//! ```

mod acne;
mod cause;
pub mod compare;
pub mod contain;
pub mod conversion;
mod cpu;
mod drawn;
mod expected;
pub mod explain;
mod inquiry;
pub mod mistake;
mod notes;
mod replicates;
mod reseed;
mod sample_loops;
mod tangent;

use std::collections::HashMap;
use std::iter;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use thiserror::Error;
use toyproof_diagnostic::{Deadline, Diagnostic, Overdue, Span};
use toyproof_eval::{self as eval, Program};
use toyproof_glsl::Checked;
use toyproof_gpu::{self as gpu, Drawn, SAFE_ROUNDS, Worker};
use toyproof_image::{Frame, Image, Shown};
use toyproof_lint::Lints;
use toyproof_translate::FloatMode;

use self::cpu::Evaluator;
pub use self::expected::Expected;
use self::inquiry::{Counted, Inquiry};
pub use self::notes::unbound;
use crate::compare::{Answer, Comparison, Mark, Standing, Verdict};
use crate::contain::Panic;
use crate::mistake::{Named, Suspects};

/// What is to be verified.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// What the lints found in it.
    pub lints: &'a Lints,
    /// What it should paint, if that is known: of that frame, and the film's size is the frame's.
    pub expected: Option<&'a Expected>,
    /// What a wrong picture is compared with, to tell what went wrong: of that scene and frame.
    pub suspects: Option<&'a Suspects>,
    /// The frame.
    pub frame: &'a Frame,
    /// How far the driver may rearrange arithmetic. If it may, the toolchain question is not asked.
    pub float: FloatMode,
    /// How long a picture may take.
    pub timeout: Duration,
    /// Where the evaluator and the tracer run; in the pool that all share, if none is given. There a slow shader's rows would be painted
    /// before another's, whose time runs meanwhile.
    pub pool: Option<&'a ThreadPool>,
}

/// What was found.
#[derive(Debug)]
pub struct Findings {
    /// The verdict.
    pub verdict: Verdict,
    /// Why, in one sentence.
    pub reason: String,
    /// Is the algorithm right? Asked where there is a scene.
    pub maths: Option<Asked>,
    /// Is float32 enough?
    pub rounding: Option<Asked>,
    /// Was the shader run as it stands? Asked where a GPU painted strictly.
    pub toolchain: Option<Asked>,
    /// The shader's picture beside the reference's.
    pub picture: Option<(Comparison, Vec<Mark>)>,
    /// What the tracer painted.
    pub reference: Option<Shown>,
    /// What the GPU painted, or the evaluator in f32 where there is none.
    pub actual: Shown,
    /// How the GPU painted; none if the evaluator did.
    pub painter: Option<Painter>,
    /// What was seen on the way, with its line.
    pub notes: Vec<Diagnostic>,
    /// Where a shader loses its digits, if float32 is not enough for it and that could be found; a warning or a note says how.
    pub cause: Option<Span>,
    /// What explains a wrong picture, if that is a classic mistake, or two.
    pub mistake: Option<Vec<Named>>,
    /// What failed internally beside the verdict: the parts that are missing here.
    pub panics: Vec<Panic>,
    /// How long the evaluator took, for all its pictures.
    pub eval: Duration,
    /// How long the tracer took; next to nothing where the picture was known.
    pub trace: Option<Duration>,
}

/// A GPU at work: [`Drawn`] without its picture.
#[derive(Debug, Clone)]
pub struct Painter {
    /// Adapter and driver.
    pub device: String,
    /// Time for naga to parse, validate and write.
    pub translate: Duration,
    /// Time for the driver to compile.
    pub compile: Duration,
    /// Time to paint and read back.
    pub draw: Duration,
}

impl Painter {
    fn of(drawn: Drawn) -> Self {
        Self {
            device: drawn.device,
            translate: drawn.translate,
            compile: drawn.compile,
            draw: drawn.draw,
        }
    }
}

/// The answer to a question, and what its picture shows.
#[derive(Debug, Default)]
pub struct Asked {
    /// The answer.
    pub answer: Answer,
    /// A mark for each pixel, bottom row first.
    pub marks: Vec<Mark>,
    /// How each pixel stands.
    standings: Vec<Standing>,
    /// The colors that are compared, of pixels that do not agree: by their place in the picture.
    actual: HashMap<usize, [f32; 3]>,
}

impl Asked {
    /// Adds the band above the first `height` rows.
    fn extend(&mut self, expected: &Image, actual: &Image, standings: &[Standing], height: u32) {
        self.answer
            .extend(&Answer::new(expected, actual, standings), height);
        self.marks.extend(compare::marks(expected, actual, standings));
        let below = self.standings.len();
        let own = standings.iter().enumerate();
        let own = own.filter(|&(_, &standing)| matches!(standing, Standing::Differs | Standing::Undecided));
        let room = MOST_KEPT.saturating_sub(self.actual.len());
        self.actual.extend(own.take(room).map(|(at, _)| {
            let [r, g, b, _] = actual.pixels()[at];
            (below + at, [r, g, b])
        }));
        self.standings.extend(standings);
    }
}

/// Why there are no findings.
#[derive(Debug, Error)]
pub enum Failure {
    /// The GPU's side failed.
    #[error(transparent)]
    Gpu(#[from] gpu::Failure),
    /// There is no GPU, and the evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// It takes too long to make the shader ready to run.
    #[error(transparent)]
    Overdue(#[from] Overdue),
    /// The driver ended loops by force in that many pixels.
    #[error("a loop was ended by force in {} {}", compare::grouped(*.0), compare::plural(*.0, "pixel", "pixels"))]
    CutShort(u64),
}

/// So many pairs of mistakes are looked for in a wrong picture: a few seconds' work.
const PAIRS: usize = 512;

/// The colors of so many pixels that do not agree are kept.
const MOST_KEPT: usize = 1 << 16;

/// So many bands of a GPU's picture wait to be compared: a picture of 1920×1080. If a larger one must wait, so must the watching of its
/// loops.
const WAITING: usize = 9;

/// The evaluator may take so many times as long as the GPU: that it is slow is not the shader's fault.
const PATIENCE: u32 = 4;
/// All that is asked of a shader may take so many times as long.
const ALL: u32 = 8;

/// Asks the three questions. Without a `worker` the evaluator paints in its stead, and the toolchain question is not asked. All together takes
/// no longer than eight times what a picture may take, beside what there is to do once for each scene.
///
/// # Errors
/// Why there is no picture of the shader.
pub fn verify(worker: Option<&mut Worker>, case: &Case) -> Result<Findings, Failure> {
    let until = Instant::now() + case.timeout * ALL;
    let program = Program::within(case.checked, case.timeout * PATIENCE);
    if let Err(eval::Refusal::TooSlow(overdue)) = program {
        return Err(overdue.into());
    }
    let stop = AtomicBool::new(false);
    // Where a GPU paints too, it is the one that must not take long.
    let each = case.timeout * if worker.is_some() { PATIENCE } else { 1 };
    let (counted, rounds) = mpsc::channel();
    let evaluator = match &program {
        Ok(program) => Ok(Evaluator::new(program, case, each, until, &stop)),
        Err(refusal) => Err((*refusal).into()),
    };
    let inquiry = Inquiry::new(case, evaluator, until, counted);
    let Some(worker) = worker else {
        return on_cpu(case, inquiry);
    };
    let mut inquiry = inquiry;
    // They share the cores, but none waits for the others' latencies. The worker is asked from this thread: it dies with the one that
    // started it.
    let asked = &mut inquiry;
    let (drawn, compared) = thread::scope(|scope| {
        let (sender, bands) = mpsc::sync_channel(WAITING);
        let comparing = scope.spawn(move || within(case.pool, move || asked.bands(Some(&bands))));
        let drawn = draw(worker, case, &rounds, &sender);
        let is_usable = |drawn: &Drawn| drawn.cut_short.is_none_or(|pixels| pixels == 0);
        stop.store(!drawn.as_ref().is_ok_and(is_usable), Ordering::Relaxed);
        drop(sender);
        (drawn, join(comparing))
    });
    let drawn = match drawn {
        Err(Failure::Gpu(failure)) if failure.is_slow_compilation() => {
            return without_compiler(failure, case, program.as_ref(), until);
        }
        drawn => drawn?,
    };
    compared?;
    // A loop that the evaluator saw no end of, on a driver that may have ended it by force and could not be watched.
    if let (None, Err(failure @ (eval::Failure::Timeout { .. } | eval::Failure::TooOften { .. }))) =
        (drawn.cut_short, &inquiry.evaluator)
    {
        return Err(failure.clone().into());
    }
    // Where the driver could not be watched in time, the evaluator has counted the rounds.
    let painter = match drawn.cut_short.unwrap_or(inquiry.noted.beyond_cap) {
        0 => Painter::of(drawn),
        pixels => return Err(Failure::CutShort(pixels)),
    };
    Ok(within(case.pool, || inquiry.findings(Some(painter))))
}

/// What the evaluator finds alone.
fn on_cpu(case: &Case, mut inquiry: Inquiry) -> Result<Findings, Failure> {
    within(case.pool, || {
        inquiry.bands(None)?;
        Ok(inquiry.findings(None))
    })
}

/// What the evaluator finds alone where the driver's compiler did not come to an end: how long that takes says nothing of how
/// long the shader runs. If the evaluator cannot compile it either, neither can be waited for.
fn without_compiler(
    failure: gpu::Failure,
    case: &Case,
    program: Result<&Program, &eval::Refusal>,
    until: Instant,
) -> Result<Findings, Failure> {
    let Ok(program) = program else {
        return Err(failure.into());
    };
    let stop = AtomicBool::new(false);
    let (counted, _) = mpsc::channel();
    let evaluator = Evaluator::new(program, case, case.timeout * PATIENCE, until, &stop);
    let mut findings = on_cpu(case, Inquiry::new(case, Ok(evaluator), until, counted))?;
    findings.notes.push(notes::slow_compilation(case.timeout));
    Ok(findings)
}

/// Does work in a pool, if there is one.
fn within<T: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Has the worker paint, sends on what it painted, and has it watch the loops unless the evaluator tells that they are short.
fn draw(
    worker: &mut Worker,
    case: &Case,
    rounds: &Receiver<Counted>,
    bands: &SyncSender<Image>,
) -> Result<Drawn, Failure> {
    // A strict run goes round as often as the evaluator does, who has often counted by now. Otherwise, no band is waited for longer
    // than it would take the driver to paint all again.
    let are_short = |painting| {
        let mut counted = iter::from_fn(|| rounds.recv_timeout(painting).ok());
        let last = counted.find(|counted| counted.most > SAFE_ROUNDS || counted.is_last);
        last.is_some_and(|counted| counted.most <= SAFE_ROUNDS)
    };
    let each = |band| {
        // If nobody takes it, the comparing has failed, and tells of it.
        let _ = bands.send(band);
    };
    let watch = |drawn: &Drawn, painting| {
        drawn.may_be_cut_short() && (case.float == FloatMode::Fast || !are_short(painting))
    };
    let lowered = case
        .float
        .lower_within(case.checked, &Deadline::after(case.timeout))?;
    let drawn = worker.draw_in_bands(lowered, case.frame.clone(), case.float, each, watch)?;
    Ok(drawn)
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let value = work();
    (value, start.elapsed())
}

fn join<T>(thread: ScopedJoinHandle<T>) -> T {
    thread
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
