//! Threads and pools.

use std::thread::ScopedJoinHandle;
use std::time::{Duration, Instant};

use rayon::ThreadPool;

/// Runs `work` in the pool, if there is one.
pub fn within<T: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Runs `work`, and returns the time it took.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let value = work();
    (value, start.elapsed())
}

/// Waits for a thread, and panics with its panic.
#[must_use]
pub fn join<T>(thread: ScopedJoinHandle<T>) -> T {
    thread
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
