//! Waiting for what other processes do, without asserting a time.

use std::thread;
use std::time::{Duration, Instant};

/// The limit of waits that only a hang exceeds.
pub const HANG_GUARD: Duration = Duration::from_secs(300);

/// Waits until a condition holds.
///
/// # Panics
/// If it does not hold within the hang guard.
#[track_caller]
pub fn wait_until(mut condition: impl FnMut() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < HANG_GUARD, "this wait does not end");
        thread::sleep(Duration::from_millis(5));
    }
}
