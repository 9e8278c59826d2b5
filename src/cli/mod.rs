//! The command line: one file per command. Each parses its arguments, calls the other crates and prints the
//! result.

mod check;
mod compare;
mod convert;
mod doctor;
mod explain;
mod files;
mod inputs;
mod names;
mod pool;
mod render;
mod run;
mod scenes;
mod sequence;
mod shader;
mod stress;
mod terminal;
mod trade;

use std::io;
use std::panic;
use std::thread::{self, JoinHandle};

use clap::{Parser, Subcommand};
use toyproof_gpu as gpu;
use toyproof_verify::contain::{Part, contain};

use self::terminal::Terminal;

/// Checks, renders and converts ShaderToy shaders.
#[derive(Debug, Parser)]
#[command(version, about, propagate_version = true, max_term_width = 110)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Say more: times, and the driver that ran
    #[arg(short, long, global = true)]
    verbose: bool,
    /// Say nothing but results
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compare what shaders paint with the reference tracer, and give a verdict on each
    Check(check::Args),
    /// Render a scene with the reference tracer
    Render(render::Args),
    /// Run shaders and keep the pictures that they paint
    Run(run::Args),
    /// Translate shaders to WGSL, SPIR-V, Metal, HLSL or GLSL ES
    Convert(convert::Args),
    /// Tell what one pixel does, in f32 beside f64, line by line
    Explain(explain::Args),
    Stress(stress::Args),
    Trade(trade::Args),
    /// Compare two pictures
    Compare(compare::Args),
    /// Write the shader that paints a scene
    Export(render::ExportArgs),
    /// List the course's scenes and shaders, or write them to a folder
    Scenes(scenes::Args),
    /// Say which Vulkan drivers are installed, what is missing and how to get it
    Doctor(doctor::Args),
    /// Serve as the worker process of another command
    #[command(hide = true)]
    Worker,
}

/// The exit status of a command; the codes have the meanings that they have in grep, diff and cmp.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// Exit code 0.
    Success,
    /// Exit code 1: a shader is at fault, or images differ.
    ShaderFault,
    /// Exit code 2: any other error.
    Error,
}

impl Cli {
    /// Runs the command that the arguments name.
    #[must_use]
    pub fn run(self) -> Exit {
        let terminal = Terminal::new(self.quiet, self.verbose);
        if std::env::var_os("RUST_BACKTRACE").is_none() {
            panic::set_hook(Box::new(Terminal::print_panic));
        }
        let exit = contain(Part::Command, || self.command.run(&terminal)).unwrap_or_else(|panic| {
            terminal.error(panic);
            Exit::Error
        });
        if terminal.has_failed() { Exit::Error } else { exit }
    }
}

impl Command {
    fn run(&self, terminal: &Terminal) -> Exit {
        match self {
            Self::Check(args) => check::run(args, terminal),
            Self::Render(args) => render::run(args, terminal),
            Self::Run(args) => run::run(args, terminal),
            Self::Convert(args) => convert::run(args, terminal),
            Self::Explain(args) => explain::run(args, terminal),
            Self::Stress(args) => stress::run(args, terminal),
            Self::Trade(args) => trade::run(args, terminal),
            Self::Compare(args) => compare::run(args, terminal),
            Self::Export(args) => render::export(args, terminal),
            Self::Scenes(args) => scenes::run(args, terminal),
            Self::Doctor(args) => doctor::run(args, terminal),
            Self::Worker => serve_worker(),
        }
    }
}

/// The size of a worker's stack: the default of a main thread on Linux.
const STACK_BYTES: usize = 8 << 20;

/// Serves as the worker process that `check`, `run`, `convert` and `doctor` start.
fn serve_worker() -> Exit {
    // Drivers compile shaders on this stack, so its size must not depend on the limit that the shell sets.
    let serving = thread::Builder::new().stack_size(STACK_BYTES).spawn(|| {
        let (input, output) = (io::stdin().lock(), io::stdout().lock());
        gpu::serve(input, output)
    });
    match serving.map(JoinHandle::join) {
        Ok(Ok(Ok(()))) => Exit::Success,
        _ => Exit::Error,
    }
}
