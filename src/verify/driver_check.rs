//! Verification with a driver: it renders while the evaluator and the tracer compare what it sends.

use std::iter;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::thread;

use toyproof_diagnostic::{Deadline, Diagnostic};
use toyproof_eval as eval;
use toyproof_player::DrawOutput;
use toyproof_translate::FloatMode;

use crate::case::Case;
use crate::driver::{Driver, GpuRun, is_replaceable};
use crate::failure::Failure;
use crate::notes;
use crate::pool::{join, within};
use crate::session::{IterationCount, VerifySession};
use crate::spool::Spool;

/// Maximum number of pixels of an image after which the worker waits for the next shader. Comparing a larger
/// one takes seconds, in which the driver would hold 100 MB; starting it again takes a fraction of that time.
const MAX_PIXELS_OF_IDLE_WORKER: u64 = 1 << 22;

/// Checks all bands with a driver. `stop` ends the evaluator, whose `iteration_counts` show whether loops are
/// short. Where the driver fails, the evaluator takes its place if it can. Returns the driver's times, or the
/// note about its failure.
pub(super) fn check(
    driver: &mut Driver,
    case: &Case,
    session: &mut VerifySession,
    iteration_counts: &Receiver<IterationCount>,
    stop: &AtomicBool,
) -> Result<Result<GpuRun, Diagnostic>, Failure> {
    let has_program = session.has_program();
    let is_replaceable = |failure: &Failure| match failure {
        Failure::Gpu(failure) => has_program && is_replaceable(failure, case.expected.is_some()),
        _ => false,
    };
    // They share the cores, but none waits for another's latency. The worker runs on this thread: its process
    // ends with the thread that started it.
    let (comparing_session, bands) = (&mut *session, &Spool::default());
    let (drawn, compared) = thread::scope(|scope| {
        let comparing = scope.spawn(move || {
            let mut next = || bands.receive().map_err(|error| Failure::Spool(error.to_string()));
            within(case.pool, move || comparing_session.bands(Some(&mut next)))
        });
        let drawn = draw(driver, case, iteration_counts, bands);
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
            return Ok(Err(notes::driver_failure(&failure)));
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
    match drawn.loop_truncated.unwrap_or(session.observed.beyond_cap) {
        0 => Ok(Ok(drawn.into())),
        pixels => Err(Failure::LoopTruncated(pixels)),
    }
}

/// Renders on the GPU, sends the bands on, and watches the loops unless the evaluator shows that they are
/// short.
fn draw(
    driver: &mut Driver,
    case: &Case,
    iteration_counts: &Receiver<IterationCount>,
    bands: &Spool,
) -> Result<DrawOutput, Failure> {
    // A strict run has the evaluator's iteration counts, which are often known by now. Otherwise, no band is
    // waited for longer than the driver would need to render the image again.
    let safe_iterations = driver.safe_iterations();
    let are_short = |render_time| {
        let mut counts = iter::from_fn(|| iteration_counts.recv_timeout(render_time).ok());
        let last = counts.find(|counts| counts.most > safe_iterations || counts.is_last);
        last.is_some_and(|counts| counts.most <= safe_iterations)
    };
    let mut checks_loops = |drawn: &DrawOutput, render_time| {
        drawn.may_truncate_loops && (case.float == FloatMode::Fast || !are_short(render_time))
    };
    let lowered = case
        .float
        .lower_within(case.checked, &Deadline::after(case.timeout))?;
    let mut send = |band| bands.send(band);
    let drawn = driver.draw_in_bands(
        (lowered, case.float),
        case.frame.clone(),
        &mut send,
        &mut checks_loops,
    )?;
    let [width, height] = case.frame.size;
    if u64::from(width) * u64::from(height) > MAX_PIXELS_OF_IDLE_WORKER {
        driver.stop();
    }
    Ok(drawn)
}
