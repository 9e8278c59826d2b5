//! The `toyproof` command: parses, dispatches and exits.

use std::process::ExitCode;

use clap::Parser;
use toyproof::cli::{Cli, Exit};

fn main() -> ExitCode {
    match Cli::parse().run() {
        Exit::Good => ExitCode::SUCCESS,
        Exit::Bad => ExitCode::from(1),
        Exit::Trouble => ExitCode::from(2),
    }
}
