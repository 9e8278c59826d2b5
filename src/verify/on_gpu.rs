//! Verification with a GPU: the worker renders while the evaluator and the tracer compare what it sends.

use std::iter;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::thread;

use toyproof_diagnostic::Deadline;
use toyproof_eval::{self as eval, Program, Refusal};
use toyproof_gpu::{DrawOutput, SAFE_ITERATIONS};
pub use toyproof_gpu::{Failure as GpuFailure, Worker};
use toyproof_translate::FloatMode;

use crate::session::{IterationCount, VerifySession};
use crate::spool::Spool;
use crate::{Case, Failure, Findings, GpuRun, join, notes, within};

/// Maximum number of pixels of an image after which the worker waits for the next shader. Comparing a larger
/// one takes seconds, in which the driver would hold 100 MB; starting it again takes a fraction of that time.
const MAX_PIXELS_OF_IDLE_WORKER: u64 = 1 << 22;

impl GpuRun {
    fn of(drawn: DrawOutput) -> Self {
        Self {
            device: drawn.device,
            translate: drawn.translate,
            compile: drawn.compile,
            draw: drawn.draw,
        }
    }
}

/// Verifies with a worker. `stop` ends the evaluator, whose `iteration_counts` show whether loops are short. Where
/// the driver fails, the evaluator takes its place if it can.
pub(super) fn verify(
    worker: &mut Worker,
    case: &Case,
    program: Result<&Program, &Refusal>,
    mut session: VerifySession,
    iteration_counts: &Receiver<IterationCount>,
    stop: &AtomicBool,
) -> Result<Findings, Failure> {
    let is_replaceable = |failure: &Failure| match failure {
        Failure::Gpu(failure) => program.is_ok() && is_replaceable(failure, case.expected.is_some()),
        _ => false,
    };
    // They share the cores, but none waits for another's latency. The worker runs on this thread: its process
    // ends with the thread that started it.
    let (comparing_session, bands) = (&mut session, &Spool::default());
    let (drawn, compared) = thread::scope(|scope| {
        let comparing = scope.spawn(move || {
            let mut next = || bands.receive().map_err(|error| Failure::Spool(error.to_string()));
            within(case.pool, move || comparing_session.bands(Some(&mut next)))
        });
        let drawn = draw(worker, case, iteration_counts, bands);
        let is_needed = match &drawn {
            Ok(drawn) => drawn.loop_truncated.is_none_or(|pixels| pixels == 0),
            Err(failure) => is_replaceable(failure),
        };
        stop.store(!is_needed, Ordering::Relaxed);
        bands.close();
        (drawn, join(comparing))
    });
    let drawn = match drawn {
        Ok(drawn) => drawn,
        Err(failure) if is_replaceable(&failure) => {
            compared?;
            let mut findings = within(case.pool, || session.findings(None));
            findings.notes.push(notes::driver_failure(&failure));
            return Ok(findings);
        }
        Err(failure) => return Err(failure),
    };
    compared?;
    match (&session.evaluator, drawn.loop_truncated) {
        // A loop does not end, whatever the driver made of it.
        (Err(failure @ eval::Failure::TooOften { .. }), _)
        // The driver may have truncated the loop, and could not be watched.
        | (Err(failure @ eval::Failure::Timeout { .. }), None) => return Err(failure.clone().into()),
        _ => {}
    }
    // Where the driver could not be watched in time, the evaluator has counted the iterations.
    let gpu_run = match drawn.loop_truncated.unwrap_or(session.observed.beyond_cap) {
        0 => GpuRun::of(drawn),
        pixels => return Err(Failure::LoopTruncated(pixels)),
    };
    Ok(within(case.pool, || session.findings(Some(gpu_run))))
}

/// Whether the evaluator may take the place of a worker that failed. How long the driver takes shows nothing about
/// the shader. Without a reference, other failures are what the check is about.
#[must_use]
pub fn is_replaceable(failure: &GpuFailure, has_reference: bool) -> bool {
    let is_decisive = failure.is_invalid() || failure.is_without_driver();
    !is_decisive && (failure.is_timeout() || has_reference)
}

/// Renders on the GPU, sends the bands on, and watches the loops unless the evaluator shows that they are
/// short.
fn draw(
    worker: &mut Worker,
    case: &Case,
    iteration_counts: &Receiver<IterationCount>,
    bands: &Spool,
) -> Result<DrawOutput, Failure> {
    // A strict run has the evaluator's iteration counts, which are often known by now. Otherwise, no band is
    // waited for longer than the driver would need to render the image again.
    let are_short = |render_time| {
        let mut counts = iter::from_fn(|| iteration_counts.recv_timeout(render_time).ok());
        let last = counts.find(|counts| counts.most > SAFE_ITERATIONS || counts.is_last);
        last.is_some_and(|counts| counts.most <= SAFE_ITERATIONS)
    };
    let watch = |drawn: &DrawOutput, render_time| {
        drawn.may_truncate_loops() && (case.float == FloatMode::Fast || !are_short(render_time))
    };
    let lowered = case
        .float
        .lower_within(case.checked, &Deadline::after(case.timeout))?;
    let drawn = worker.draw_in_bands(
        lowered,
        case.frame.clone(),
        case.float,
        |band| bands.send(band),
        watch,
    )?;
    let [width, height] = case.frame.size;
    if u64::from(width) * u64::from(height) > MAX_PIXELS_OF_IDLE_WORKER {
        worker.stop();
    }
    Ok(drawn)
}
