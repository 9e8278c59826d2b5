//! The worker process that `check`, `run`, `convert` and `doctor` start.

use std::io;
use std::thread::{self, JoinHandle};

use toyproof_gpu as gpu;

use super::Exit;

/// What Linux gives a main thread unless told otherwise.
const STACK_BYTES: usize = 8 << 20;

pub(super) fn run() -> Exit {
    // A thread whose stack is as large whatever limit the shell sets: drivers compile shaders on it.
    let serving = thread::Builder::new().stack_size(STACK_BYTES).spawn(|| {
        let (input, output) = (io::stdin().lock(), io::stdout().lock());
        gpu::serve(input, output)
    });
    match serving.map(JoinHandle::join) {
        Ok(Ok(Ok(()))) => Exit::Good,
        _ => Exit::Trouble,
    }
}
