//! Verifies a shader in three checks: whether its algorithm is right, whether float32 is precise enough, and
//! whether the toolchain preserves every bit. GPU, evaluator and tracer run in parallel; [`verify`] returns
//! the verdict and what explains it.
//!
//! # The checks
//!
//! | check | expected | actual |
//! |---|---|---|
//! | algorithm | the [reference](Expected), in double precision | the shader on the CPU, in double precision |
//! | precision | the shader in double precision | the shader in float32 on the GPU |
//! | toolchain | the shader in float32 on the CPU | the shader in float32 on the GPU, to the bit |
//!
//! Without a reference there is no algorithm check; without a GPU the evaluator's image in float32 takes the
//! place of the GPU's, and there is no toolchain check; neither is there in a fast run, which leaves the order of
//! operations to the driver. Images are compared in bands of rows, while they are rendered.
//!
//! # Pixels that are not held against a shader
//!
//! - **Undefined**: the color depends on an operation that GLSL leaves undefined. Derivatives across an edge
//!   belong here. They are left out of all checks and counted.
//! - **Ill-conditioned**: the pixel differs, and its color changes when every f64 operation is perturbed by a
//!   random unit in the last place. If only such pixels differ, the verdict is `unstable`, not `wrong`.
//! - Colors between those of the accepted offsets of secondary rays: offsets are a matter of style.
//!
//! A stochastic shader that uses other random numbers than its reference is compared by its mean. The verdict
//! does not depend on the load of the machine, the number of threads or the speed of the driver.
//!
//! # Explanations
//!
//! A wrong image is compared with those of classic mistakes ([`mistake`]); an imprecise one is traced to the
//! operation that loses the digits ([`debug`]). `conversion` proves that a converted shader still renders the
//! original's bits.
//!
//! # Without a GPU, and with one
//!
//! ```
//! use std::time::Duration;
//!
//! use toyproof_diagnostic::{Deadline, File, Files};
//! use toyproof_image::Frame;
//! use toyproof_translate::FloatMode;
//! use toyproof_verify::{Case, Expected, Verdict, verify};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut files = Files::default();
//! let scene = files.add(File::new("red.toml", "[background]\ncolor = [1.0, 0.0, 0.0]\n"));
//! let scene = toyproof_scene::parse(&files, scene)?;
//! let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1, 0, 0, 1); }";
//! let shader = files.add(File::new("red.glsl", text));
//! let checked = toyproof_glsl::check(&files, shader, &Default::default())?;
//! let lints = toyproof_lint::lint(&files, &checked, &Deadline::default());
//! let frame = Frame { size: [16, 9], ..Frame::default() };
//! let expected = Expected::of_scene(scene, &frame);
//! let case = Case {
//!     checked: &checked,
//!     lints: &lints,
//!     expected: Some(&expected),
//!     hypotheses: None,
//!     search: None,
//!     alternatives: None,
//!     frame: &frame,
//!     from_start: None,
//!     float: FloatMode::Strict,
//!     timeout: Duration::from_secs(10),
//!     pool: None,
//! };
//! // Without a GPU worker, the toolchain check is left out.
//! assert_eq!(verify(None, &case)?.verdict, Verdict::Correct);
//! # Ok(())
//! # }
//! ```
//!
//! With a GPU, the shader runs in a worker process, so that a hang or a crash of the driver takes nothing else
//! with it. The worker is the program itself, started again with other arguments; `main` must serve it before
//! anything else:
//!
//! ```no_run
//! # #[cfg(feature = "gpu")]
//! # fn main() {
//! use std::time::Duration;
//!
//! use toyproof_gpu::{AdapterSelector, Worker, serve};
//!
//! if std::env::args().nth(1).as_deref() == Some("worker") {
//!     serve(std::io::stdin(), std::io::stdout()).unwrap();
//!     return;
//! }
//! let program = std::env::current_exe().unwrap();
//! let timeout = Duration::from_secs(10);
//! let mut worker = Worker::new(program, vec!["worker".into()], AdapterSelector::Auto, timeout);
//! // verify(Some(&mut worker), &case)
//! # }
//! # #[cfg(not(feature = "gpu"))]
//! # fn main() {}
//! ```
//!
//! The feature `gpu`, on by default, can be left out: the crate then needs no processes and compiles to
//! WebAssembly, and [`Worker`] has no values.

#![cfg_attr(
    not(feature = "gpu"),
    expect(dead_code, reason = "what only a GPU or a conversion needs")
)]

mod acne;
pub mod alternative;
mod bounds;
mod buffers;
pub mod compare;
pub mod contain;
#[cfg(feature = "gpu")]
pub mod conversion;
mod cpu;
pub mod debug;
mod decide;
mod expected;
mod findings;
pub mod growth;
pub mod mistake;
mod notes;
#[cfg(feature = "gpu")]
mod on_gpu;
#[cfg(not(feature = "gpu"))]
#[path = "no_gpu.rs"]
mod on_gpu;
mod pixel_dependence;
pub mod playback;
pub mod repair;
mod replicates;
mod resampled;
mod reseed;
mod sample_loops;
mod session;
mod silhouette_precision;
#[cfg(feature = "gpu")]
mod spool;
mod stochastic;
pub mod trail;
pub mod unused;

use std::sync::atomic::AtomicBool;
use std::sync::mpsc;
use std::thread::ScopedJoinHandle;
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use thiserror::Error;
use toyproof_diagnostic::{Diagnostic, Overdue, grouped, plural};
use toyproof_eval::{self as eval, Program};
use toyproof_glsl::tree::{ExprKind, Input, VariableKind};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_image::Frame;
use toyproof_lint::Lints;
use toyproof_translate::FloatMode;

use self::cpu::Evaluator;
pub use self::decide::{
    CheckEvidence, Checks, Evidence, MAX_DIFFERING, MAX_UNDEFINED, MAX_UNSTABLE, MeanComparison, Means,
    OtherRandomNumbers, Reason, SelfIntersection, Share, Verdict, decide, is_different,
};
pub use self::expected::{
    Conditioning, DEFAULT_TOLERANCE, Expected, ImageReference, MarchDependence, Quantization,
    ReferenceFindings, ReferenceKind, SceneReference, ShaderReference,
};
pub use self::findings::{CheckResult, Findings, GpuRun};
pub use self::notes::{driver_failure, unbound, unbound_channels};
#[cfg(feature = "gpu")]
pub use self::on_gpu::is_replaceable;
pub use self::on_gpu::{GpuFailure, Worker};
use crate::alternative::Alternatives;
use crate::contain::Panic;
use crate::growth::VisibleGrowth;
use crate::mistake::Hypotheses;
use crate::repair::SearchOptions;
use crate::session::VerifySession;

/// A shader to verify, and how.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The lints' results for it.
    pub lints: &'a Lints,
    /// The reference, if there is one; its frame must be `frame`.
    pub expected: Option<&'a Expected>,
    /// The mistakes that are searched for in a wrong image, for that scene and frame.
    pub hypotheses: Option<&'a Hypotheses>,
    /// What a wrong image is compared with as a whole; none if it is not.
    pub alternatives: Option<Alternatives<'a>>,
    /// The frame. The textures of its channels are in float32.
    pub frame: &'a Frame,
    /// What earlier frames contribute; none if the frame does not depend on them.
    pub from_start: Option<FromStart<'a>>,
    /// How to search for repairs of a wrong shader; none if not at all.
    pub search: Option<SearchOptions<'a>>,
    /// How far the driver may rearrange arithmetic. If it may, there is no toolchain check.
    pub float: FloatMode,
    /// The time limit of an image.
    pub timeout: Duration,
    /// The thread pool of the evaluator and the tracer; rayon's global pool if none. There, a slow shader's
    /// rows could run before another shader's, whose time limit elapses meanwhile.
    pub pool: Option<&'a ThreadPool>,
}

/// A frame that depends on earlier ones.
#[derive(Debug, Clone, Copy)]
pub struct FromStart<'a> {
    /// The frame with what earlier ones rendered in double precision.
    pub double: &'a Frame,
    /// The visible difference of that to float32, if there is one.
    pub growth: Option<VisibleGrowth>,
}

/// Why there is no image of a shader.
#[derive(Debug, Clone, Error)]
pub enum Failure {
    /// No shader was submitted.
    #[error("{0}")]
    Missing(String),
    /// The shader, or its scene, cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// The shader is part of a project that cannot be rendered yet.
    #[error("{0}")]
    Unrendered(String),
    /// The shader does not compile.
    #[error("the shader does not compile")]
    Invalid(Vec<Diagnostic>),
    /// The scene is invalid.
    #[error("the scene is invalid")]
    InvalidScene(Vec<Diagnostic>),
    /// The reference cannot be evaluated.
    #[error("the reference cannot be evaluated: {0}")]
    Reference(eval::Failure),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuFailure),
    /// There is no GPU, and the evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The shader takes too long to compile.
    #[error(transparent)]
    Overdue(#[from] Overdue),
    /// The driver truncated loops in that many pixels.
    #[error("the driver stopped a loop in {} {}", grouped(*.0), plural(*.0, "pixel", "pixels"))]
    LoopTruncated(u64),
    /// The GPU's image, which waited in a temporary file, cannot be read.
    #[error("the image cannot be read from a temporary file: {0}")]
    Spool(String),
    /// There was an internal error.
    #[error(transparent)]
    Panic(#[from] Panic),
}

impl Failure {
    /// Returns the diagnostics on the shader or its scene.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        match self {
            Self::Invalid(diagnostics) | Self::InvalidScene(diagnostics) => diagnostics.clone(),
            Self::Gpu(failure) => failure.diagnostics().to_vec(),
            Self::Overdue(overdue) => vec![glsl::overdue(*overdue)],
            _ => Vec::new(),
        }
    }
}

/// The evaluator's time limit as a multiple of the GPU's: a slow evaluator is not the shader's fault.
const EVALUATOR_TIME_FACTOR: u32 = 4;

/// Runs the three checks. Without a `worker`, or where it renders no image of a shader that has a reference, the
/// evaluator renders the image, and there is no toolchain check.
///
/// # Errors
/// Returns why there is no image of the shader: [`Failure::Gpu`], [`Failure::Cpu`], [`Failure::Overdue`] or
/// [`Failure::LoopTruncated`].
pub fn verify(worker: Option<&mut Worker>, case: &Case) -> Result<Findings, Failure> {
    let program = Program::within(case.checked, case.timeout * EVALUATOR_TIME_FACTOR);
    if let Err(eval::Refusal::TooSlow(overdue)) = program {
        return Err(overdue.into());
    }
    let stop = AtomicBool::new(false);
    // With a GPU, the time limit applies to the GPU.
    let limit = match worker {
        Some(_) => case.timeout * EVALUATOR_TIME_FACTOR,
        None => case.timeout,
    };
    let (counts, iteration_counts) = mpsc::channel();
    let evaluator = match &program {
        Ok(program) => Ok(Evaluator::new(program, case.frame, limit, &stop)
            .with_double(case.from_start.map(|from_start| from_start.double))),
        Err(refusal) => Err((*refusal).into()),
    };
    let session = VerifySession::new(case, evaluator, counts);
    match worker {
        None => on_cpu(case, session),
        Some(worker) => {
            let program = program.as_ref();
            on_gpu::verify(worker, case, program, session, &iteration_counts, &stop)
        }
    }
}

/// Verifies an edit of a shader, or the like, with the evaluator. The result does not depend on the load of the
/// machine: what takes long are pixels with more than `max_iterations` loop iterations, which fail. The deadline
/// is only there against a hang.
pub(crate) fn verify_within(
    case: &Case,
    max_iterations: u32,
    deadline: Instant,
) -> Result<Findings, Failure> {
    let left = deadline.saturating_duration_since(Instant::now());
    let program = Program::within(case.checked, left).map_err(eval::Failure::from)?;
    let stop = AtomicBool::new(false);
    let evaluator = Evaluator::new(&program, case.frame, left, &stop)
        .with_double(case.from_start.map(|from_start| from_start.double))
        .with_max_iterations(max_iterations);
    let (counts, _) = mpsc::channel();
    on_cpu(case, VerifySession::new(case, Ok(evaluator), counts))
}

/// Verifies with the evaluator alone.
fn on_cpu(case: &Case, mut session: VerifySession) -> Result<Findings, Failure> {
    within(case.pool, || {
        session.bands(None)?;
        Ok(session.findings(None))
    })
}

/// Runs `work` in the pool, if there is one.
fn within<T: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Whether a shader reads an input.
fn reads(checked: &Checked, input: Input) -> bool {
    let tree = &checked.tree;
    tree.exprs.iter().any(|(_, expr)| match expr.kind {
        ExprKind::Variable(variable) => tree[variable].kind == VariableKind::Input(input),
        _ => false,
    })
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
