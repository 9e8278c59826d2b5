//! The worker process that `check`, `run`, `convert` and `doctor` start.

use std::io;

use super::Exit;
use crate::gpu;

pub(super) fn run() -> Exit {
    match gpu::serve(io::stdin().lock(), io::stdout().lock()) {
        Ok(()) => Exit::Good,
        Err(_) => Exit::Trouble,
    }
}
