//! Verifies a shader in three checks: whether its algorithm is right, whether float32 is precise enough, and
//! whether the toolchain preserves every bit. GPU, evaluator and tracer run in parallel; [`verify`] returns
//! the results, from which the verdict follows.
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
//! place of the GPU's, and there is no toolchain check; neither is there in a fast run, which leaves the
//! order of operations to the driver. Images are compared in bands of rows, while they are rendered.
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
//! # Parts
//!
//! - `session`: the checks of one frame, one band of rows after the other; with a driver (`driver`, whose bands
//!   wait in `spool`), or on the `evaluator` alone
//! - [`compare`]: two images, pixel by pixel
//! - `expected`: what a shader is compared with: a scene, another shader or an image
//! - [`random`]: shaders with other random numbers than their reference
//! - [`project`]: shaders with several passes over frames
//! - `decide`: the verdict and its reason, a pure function of the evidence; `settle`: the evidence that a fault
//!   calls for, and all places where a verdict may change
//! - [`profile`]: where the operations of a shader are executed
//! - [`debug`], `loss`, `notes`: one pixel in both precisions, and the diagnostics about a run
//!
//! `toyproof_explain` searches for the mistake that explains a wrong image, and for its repair;
//! `toyproof_convert` proves that a converted shader still renders the original's bits.
//!
//! # Example
//!
//! ```
//! use toyproof_diagnostic::{Deadline, File, Files};
//! use toyproof_image::Frame;
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
//! let expected = Expected::from_scene(scene, &frame);
//! let case = Case::new(&checked, &lints, &frame).with_expected(&expected);
//! // Without a driver, the toolchain check is left out.
//! assert_eq!(verify(None, &case)?.ruling().verdict, Verdict::Correct);
//! # Ok(())
//! # }
//! ```
//!
//! With a driver, such as `toyproof_gpu::Worker`, the shader runs in a worker process, so that a hang or a
//! crash takes nothing else with it.

pub mod bounds;
mod case;
pub mod compare;
pub mod contain;
pub mod debug;
mod decide;
mod difference;
mod driver;
mod driver_check;
pub mod evaluator;
mod evidence;
mod expected;
mod failure;
mod limits;
mod loss;
mod notes;
mod pool;
pub mod profile;
pub mod project;
pub mod random;
mod self_intersection;
mod session;
mod settle;
mod spool;
mod verified;

use std::sync::atomic::AtomicBool;
use std::sync::mpsc;
use std::time::Instant;

use toyproof_eval as eval;
use toyproof_eval_native::Program;

pub use self::bounds::EVALUATOR_TIME_FACTOR;
pub use self::case::{Case, FromStart};
pub use self::compare::{CheckResult, Quantization, Share};
pub use self::decide::{Means, Reason, Ruling, Verdict, decide};
pub use self::difference::{Difference, UnknownDifference};
pub use self::driver::{Driver, GpuRun, is_replaceable};
use self::evaluator::Evaluator;
pub use self::evidence::{
    CheckEvidence, Checks, Evidence, MeanComparison, OtherRandomNumbers, SelfIntersection,
};
pub use self::expected::{
    Conditioning, DEFAULT_TOLERANCE, Expected, ImageReference, MarchDependence, NumberType, ReferenceBand,
    ReferenceFindings, ReferenceKind, SceneReference, ShaderReference,
};
pub use self::failure::Failure;
pub use self::limits::{MAX_DIFFERING, MAX_UNDEFINED, MAX_UNSTABLE, is_different};
pub use self::loss::cause;
pub use self::notes::{driver_failure, unbound, unbound_channels};
pub use self::pool::{join, within};
pub use self::session::BandReference;
use self::session::VerifySession;
pub use self::settle::{Basis, Settlement};
pub use self::verified::{CheckResults, Subject, Verified};

/// Runs the three checks. Without a `driver`, or where it renders no image of a shader that has a reference,
/// the evaluator renders the image, and there is no toolchain check.
///
/// # Errors
/// Returns why there is no image of the shader: [`Failure::Gpu`], [`Failure::Cpu`], [`Failure::Overdue`] or
/// [`Failure::LoopTruncated`].
pub fn verify<'a>(driver: Option<&mut Driver>, case: &'a Case<'a>) -> Result<Verified<'a>, Failure> {
    let program = match Program::within(case.checked, case.timeout * EVALUATOR_TIME_FACTOR) {
        Err(eval::Refusal::TooSlow(overdue)) => return Err(overdue.into()),
        program => program,
    };
    let stop = AtomicBool::new(false);
    // With a GPU, the time limit applies to the GPU.
    let limit = match driver {
        Some(_) => case.timeout * EVALUATOR_TIME_FACTOR,
        None => case.timeout,
    };
    let (counts, iteration_counts) = mpsc::channel();
    let evaluator = match &program {
        Ok(program) => Ok(Evaluator::new(program, case.frame, limit, &stop)
            .with_double(case.from_start.map(|from_start| from_start.double))),
        Err(refusal) => Err((*refusal).into()),
    };
    let mut session = VerifySession::new(case, evaluator, counts);
    let drawn = match driver {
        None => {
            within(case.pool, || session.bands(None))?;
            None
        }
        Some(driver) => Some(driver_check::check(
            driver,
            case,
            &mut session,
            &iteration_counts,
            &stop,
        )?),
    };
    let verified = within(case.pool, || session.finish(drawn, program.as_ref().ok()));
    Ok(Verified {
        program: program.ok(),
        ..verified
    })
}

/// Verifies an edit of a shader, or the like, with the evaluator. The result does not depend on the load of
/// the machine: what takes long are pixels with more than `max_iterations` loop iterations, which fail. The
/// deadline is only there against a hang.
///
/// # Errors
/// Returns why there is no image of the shader.
pub fn verify_within<'a>(
    case: &'a Case<'a>,
    max_iterations: u32,
    deadline: Instant,
) -> Result<Verified<'a>, Failure> {
    let left = deadline.saturating_duration_since(Instant::now());
    let program = Program::within(case.checked, left).map_err(eval::Failure::from)?;
    let stop = AtomicBool::new(false);
    let evaluator = Evaluator::new(&program, case.frame, left, &stop)
        .with_double(case.from_start.map(|from_start| from_start.double))
        .with_max_iterations(max_iterations);
    let (counts, _) = mpsc::channel();
    let mut session = VerifySession::new(case, Ok(evaluator), counts);
    let verified = within(case.pool, || {
        session.bands(None)?;
        Ok::<_, Failure>(session.finish(None, Some(&program)))
    })?;
    Ok(Verified {
        program: Some(program),
        ..verified
    })
}
