//! The `toyproof` command: parses, dispatches and exits.

use std::process::ExitCode;

use clap::Parser;
use toyproof::cli::{Cli, Exit};

fn main() -> ExitCode {
    match Cli::parse().run() {
        Exit::Success => ExitCode::SUCCESS,
        Exit::ShaderFault => ExitCode::from(1),
        Exit::Error => ExitCode::from(2),
    }
}
