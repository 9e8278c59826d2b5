//! The command line: one file for each command. Each turns its arguments into the stages' own terms,
//! composes the stages and prints what came out.

mod check;
mod codes;
mod compare;
mod convert;
mod course;
mod doctor;
mod explain;
mod export;
mod files;
mod inputs;
mod interrupt;
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
mod worker;

use std::panic;

use clap::{Parser, Subcommand};
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
    /// Find out where formulas for rays and surfaces fail: numerical stability at the extremes
    Stress(stress::Args),
    /// Measure what accuracy costs: every way to a picture, with its time and its error
    Trade(trade::Args),
    /// Compare two pictures
    Compare(compare::Args),
    /// Write the shader that paints a scene
    Export(export::Args),
    /// List the course's scenes and shaders, or write them to a folder
    Scenes(scenes::Args),
    /// Say which Vulkan drivers are installed, what is missing and how to get it
    Doctor(doctor::Args),
    /// Serve as the worker process of another command
    #[command(hide = true)]
    Worker,
}

/// How a command ended, in the manner of grep, diff and cmp.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// Exit code 0.
    Good,
    /// Exit code 1: a shader is at fault, or pictures differ.
    Bad,
    /// Exit code 2: something else is.
    Trouble,
}

impl Cli {
    /// Does what the arguments ask for.
    #[must_use]
    pub fn run(self) -> Exit {
        let terminal = Terminal::new(self.quiet, self.verbose);
        if std::env::var_os("RUST_BACKTRACE").is_none() {
            panic::set_hook(Box::new(Terminal::panicked));
        }
        let exit = contain(Part::Command, || self.command.run(&terminal)).unwrap_or_else(|panic| {
            terminal.error(panic);
            Exit::Trouble
        });
        if terminal.has_lost() { Exit::Trouble } else { exit }
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
            Self::Export(args) => export::run(args, terminal),
            Self::Scenes(args) => scenes::run(args, terminal),
            Self::Doctor(args) => doctor::run(args, terminal),
            Self::Worker => worker::run(),
        }
    }
}
