//! Verifies a shader in three checks: whether its algorithm is right, whether float32 is precise enough, and
//! whether the toolchain preserves every bit. GPU, evaluator and tracer run in parallel; [`verify`] returns
//! the verdict and what explains it.
//!
//! ```
//! use std::time::Duration;
//!
//! use toyproof_diagnostic::{Deadline, File, Files};
//! use toyproof_image::Frame;
//! use toyproof_translate::FloatMode;
//! use toyproof_verify::{Case, Expected, Verdict, verify};
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
pub mod compare;
pub mod contain;
pub mod conversion;
mod cpu;
pub mod debug;
mod decide;
mod expected;
mod findings;
pub mod mistake;
mod notes;
mod replicates;
mod reseed;
mod sample_loops;
mod session;
mod silhouette_precision;
mod stochastic;

use std::iter;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use thiserror::Error;
use toyproof_diagnostic::{Deadline, Diagnostic, Overdue, grouped, plural};
use toyproof_eval::{self as eval, Program};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{self as gpu, Drawn, SAFE_ITERATIONS, Worker};
use toyproof_image::{Frame, Image};
use toyproof_lint::Lints;
use toyproof_translate::FloatMode;

use self::cpu::Evaluator;
pub use self::decide::{
    CheckEvidence, Checks, Evidence, MAX_DIFFERING, MAX_UNDEFINED, MAX_UNSTABLE, MeanComparison, Means,
    OtherRandomNumbers, Reason, Share, Verdict, decide,
};
pub use self::expected::Expected;
pub use self::findings::{CheckResult, Findings, Painter};
pub use self::notes::unbound;
use crate::contain::Panic;
use crate::mistake::Hypotheses;
use crate::session::{IterationCount, VerifySession};

/// A shader to verify, and how.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The lints' results for it.
    pub lints: &'a Lints,
    /// The reference, if there is a scene; its frame and its film's size must be those of `frame`.
    pub expected: Option<&'a Expected>,
    /// The mistakes that are searched for in a wrong image, for that scene and frame.
    pub suspects: Option<&'a Hypotheses>,
    /// The frame.
    pub frame: &'a Frame,
    /// How far the driver may rearrange arithmetic. If it may, there is no toolchain check.
    pub float: FloatMode,
    /// The time limit of an image.
    pub timeout: Duration,
    /// The thread pool of the evaluator and the tracer; rayon's global pool if none. There, a slow shader's
    /// rows could run before another shader's, whose time limit elapses meanwhile.
    pub pool: Option<&'a ThreadPool>,
}

/// Why there is no image of a shader.
#[derive(Debug, Clone, Error)]
pub enum Failure {
    /// The shader, or its scene, cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// The shader does not compile.
    #[error("it does not compile")]
    Invalid(Vec<Diagnostic>),
    /// The scene is invalid.
    #[error("its scene is invalid")]
    InvalidScene(Vec<Diagnostic>),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] gpu::Failure),
    /// There is no GPU, and the evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The shader takes too long to compile.
    #[error(transparent)]
    Overdue(#[from] Overdue),
    /// The driver truncated loops in that many pixels.
    #[error("a loop was ended by force in {} {}", grouped(*.0), plural(*.0, "pixel", "pixels"))]
    LoopTruncated(u64),
    /// There was an internal error.
    #[error(transparent)]
    Panic(#[from] Panic),
}

impl Failure {
    /// Returns the diagnostics on the shader or its scene.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        match self {
            Self::Invalid(diagnostics)
            | Self::InvalidScene(diagnostics)
            | Self::Gpu(gpu::Failure::Invalid(diagnostics) | gpu::Failure::Refused(diagnostics)) => {
                diagnostics.clone()
            }
            Self::Overdue(overdue) => vec![glsl::overdue(*overdue)],
            _ => Vec::new(),
        }
    }
}

/// The capacity of the queue of GPU bands that wait to be compared: an image of 1920×1080. If a larger image
/// has to wait, so does watching its loops.
const MAX_QUEUED_BANDS: usize = 9;

/// The evaluator's time limit as a multiple of the GPU's: a slow evaluator is not the shader's fault.
const EVALUATOR_TIME_FACTOR: u32 = 4;
/// The time limit of all checks of a shader as a multiple of one image's.
const TOTAL_TIME_FACTOR: u32 = 8;

/// Runs the three checks. Without a `worker`, the evaluator renders the image, and there is no toolchain
/// check. Everything together takes at most eight times the time limit of an image, besides what is computed
/// once per scene.
///
/// # Errors
/// Returns why there is no image of the shader: [`Failure::Gpu`], [`Failure::Cpu`], [`Failure::Overdue`] or
/// [`Failure::LoopTruncated`].
pub fn verify(worker: Option<&mut Worker>, case: &Case) -> Result<Findings, Failure> {
    let deadline = Instant::now() + case.timeout * TOTAL_TIME_FACTOR;
    let program = Program::within(case.checked, case.timeout * EVALUATOR_TIME_FACTOR);
    if let Err(eval::Refusal::TooSlow(overdue)) = program {
        return Err(overdue.into());
    }
    let stop = AtomicBool::new(false);
    // With a GPU, the time limit applies to the GPU.
    let limit = case.timeout
        * if worker.is_some() {
            EVALUATOR_TIME_FACTOR
        } else {
            1
        };
    let (counts, iteration_counts) = mpsc::channel();
    let evaluator = match &program {
        Ok(program) => Ok(Evaluator::new(program, case, limit, deadline, &stop)),
        Err(refusal) => Err((*refusal).into()),
    };
    let session = VerifySession::new(case, evaluator, deadline, counts);
    let Some(worker) = worker else {
        return on_cpu(case, session);
    };
    let mut session = session;
    // They share the cores, but none waits for another's latency. The worker runs on this thread: its process
    // ends with the thread that started it.
    let comparing_session = &mut session;
    let (drawn, compared) = thread::scope(|scope| {
        let (sender, bands) = mpsc::sync_channel(MAX_QUEUED_BANDS);
        let comparing = scope.spawn(move || within(case.pool, move || comparing_session.bands(Some(&bands))));
        let drawn = draw(worker, case, &iteration_counts, &sender);
        let is_usable = |drawn: &Drawn| drawn.loop_truncated.is_none_or(|pixels| pixels == 0);
        stop.store(!drawn.as_ref().is_ok_and(is_usable), Ordering::Relaxed);
        drop(sender);
        (drawn, join(comparing))
    });
    let drawn = match drawn {
        Err(Failure::Gpu(failure)) if failure.is_slow_compilation() => {
            return without_compiler(failure, case, program.as_ref(), deadline);
        }
        drawn => drawn?,
    };
    compared?;
    // The evaluator found a loop that does not end, on a driver that may have truncated it and could not be
    // watched.
    if let (None, Err(failure @ (eval::Failure::Timeout { .. } | eval::Failure::TooOften { .. }))) =
        (drawn.loop_truncated, &session.evaluator)
    {
        return Err(failure.clone().into());
    }
    // Where the driver could not be watched in time, the evaluator has counted the iterations.
    let painter = match drawn.loop_truncated.unwrap_or(session.observed.beyond_cap) {
        0 => Painter::of(drawn),
        pixels => return Err(Failure::LoopTruncated(pixels)),
    };
    Ok(within(case.pool, || session.findings(Some(painter))))
}

/// Verifies with the evaluator alone.
fn on_cpu(case: &Case, mut session: VerifySession) -> Result<Findings, Failure> {
    within(case.pool, || {
        session.bands(None)?;
        Ok(session.findings(None))
    })
}

/// Verifies with the evaluator alone because the driver's compiler exceeded the time limit: how long it takes
/// does not show how long the shader runs. Fails if the evaluator cannot compile the shader either.
fn without_compiler(
    failure: gpu::Failure,
    case: &Case,
    program: Result<&Program, &eval::Refusal>,
    deadline: Instant,
) -> Result<Findings, Failure> {
    let Ok(program) = program else {
        return Err(failure.into());
    };
    let stop = AtomicBool::new(false);
    let (counts, _) = mpsc::channel();
    let evaluator = Evaluator::new(
        program,
        case,
        case.timeout * EVALUATOR_TIME_FACTOR,
        deadline,
        &stop,
    );
    let mut findings = on_cpu(case, VerifySession::new(case, Ok(evaluator), deadline, counts))?;
    findings.notes.push(notes::slow_compilation(case.timeout));
    Ok(findings)
}

/// Runs `work` in the pool, if there is one.
fn within<T: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Renders on the GPU, sends the bands on, and watches the loops unless the evaluator shows that they are
/// short.
fn draw(
    worker: &mut Worker,
    case: &Case,
    iteration_counts: &Receiver<IterationCount>,
    bands: &SyncSender<Image>,
) -> Result<Drawn, Failure> {
    // A strict run has the evaluator's iteration counts, which are often known by now. Otherwise, no band is
    // waited for longer than the driver would need to render the image again.
    let are_short = |render_time| {
        let mut counts = iter::from_fn(|| iteration_counts.recv_timeout(render_time).ok());
        let last = counts.find(|counts| counts.most > SAFE_ITERATIONS || counts.is_last);
        last.is_some_and(|counts| counts.most <= SAFE_ITERATIONS)
    };
    let send_band = |band| {
        // If the receiver is gone, the comparison has failed and reports it.
        let _ = bands.send(band);
    };
    let watch = |drawn: &Drawn, render_time| {
        drawn.may_truncate_loops() && (case.float == FloatMode::Fast || !are_short(render_time))
    };
    let lowered = case
        .float
        .lower_within(case.checked, &Deadline::after(case.timeout))?;
    let drawn = worker.draw_in_bands(lowered, case.frame.clone(), case.float, send_band, watch)?;
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
