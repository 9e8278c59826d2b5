//! The `toyproof` command: runs the command line and exits.

use std::process::ExitCode;

use toyproof::cli::{self, Exit};

fn main() -> ExitCode {
    match cli::run(std::env::args_os()) {
        Exit::Success => ExitCode::SUCCESS,
        Exit::ShaderFault => ExitCode::from(1),
        Exit::Error => ExitCode::from(2),
    }
}
