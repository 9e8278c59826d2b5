//! The judges of the fuzz targets: each takes an input as toyproof does, and panics if the result breaks a rule.
//!
//! The suite runs them on the seeds and the findings in `fuzz/`, with the stable compiler.

pub mod front_end;
pub mod images;
pub mod programs;
pub mod projects;
pub mod records;
pub mod scenes;

use std::panic::resume_unwind;
use std::thread::{self, ScopedJoinHandle};
use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

/// The stack of a thread of Rust's own, in bytes.
const STACK: usize = 2 << 20;

/// Runs `work` on a thread with an ordinary stack.
///
/// # Panics
/// If `work` does, or if it takes more than `allowed` of a processor.
fn within<T: Send>(allowed: Duration, work: impl FnOnce() -> T + Send) -> T {
    let (result, took) = on_a_thread("judge", STACK, || {
        let start = clock_gettime(ClockId::ThreadCPUTime);
        let result = work();
        let took = clock_gettime(ClockId::ThreadCPUTime) - start;
        (result, Duration::try_from(took).unwrap_or_default())
    })
    .unwrap_or_else(|payload| resume_unwind(payload));
    assert!(took <= allowed, "took {took:?}, more than {allowed:?}");
    result
}

fn on_a_thread<T: Send>(name: &str, stack: usize, work: impl FnOnce() -> T + Send) -> thread::Result<T> {
    thread::scope(|scope| {
        let builder = thread::Builder::new().name(name.to_owned()).stack_size(stack);
        builder
            .spawn_scoped(scope, work)
            .map(ScopedJoinHandle::join)
            .expect("a thread can be had")
    })
}
