//! The command line: one file per command. Each parses its arguments, calls the other crates and prints the
//! result.
//!
//! # Parts
//!
//! - `check`: `args` gives `options`, `work` reads what one command checks, `batch` runs it,
//!   `submission_check` and `shader_check` check one shader, `sharding` distributes a batch over shards, and
//!   `merge` repeats the command of the shards with their results.
//! - `shader`: finds and reads the shaders that arguments name.
//! - `terminal`: all output to the terminal.
//! - `watch`: `studio` reads the shader that the page of `toyproof_watch` shows, `watched` renders it, and
//!   `verdict` checks it with this program.
//! - `error`: the error that ends a command, which is printed here.

mod autograder;
mod check;
mod collect;
mod compare;
mod convert;
mod dap;
mod debug;
mod doctor;
mod error;
mod explain;
mod fmt;
mod gradebook;
mod help;
mod inputs;
mod lsp;
mod names;
mod new;
mod pool;
mod project;
mod reduce;
mod reference;
mod render;
mod run;
mod scenes;
mod sequence;
mod shader;
mod shell;
mod similar;
mod stress;
mod terminal;
mod test;
mod trade;
mod watch;

use std::ffi::OsString;
use std::io;
use std::panic;

use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand};
use toyproof_gpu as gpu;
use toyproof_verify::contain::{Part, contain};

use self::error::CliError;
pub use self::error::Exit;
use self::terminal::Terminal;

/// Check, render and convert ShaderToy shaders
///
/// `check` compares shaders with a reference in double precision and states for each difference whether the
/// algorithm, float32 precision or the toolchain (naga and the driver) causes it. `render` renders reference
/// images, `run` runs shaders, and `convert` translates them to WGSL, SPIR-V, Metal, HLSL or GLSL ES.
#[derive(Debug, Parser)]
#[command(
    name = "toyproof",
    version,
    max_term_width = 110,
    after_long_help = EXAMPLES,
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Print more details
    #[arg(short, long, global = true, help_heading = "Output")]
    verbose: bool,
    /// Print results and errors only, one line each
    #[arg(
        short,
        long,
        global = true,
        conflicts_with = "verbose",
        help_heading = "Output"
    )]
    quiet: bool,
    /// Color the output: `auto` on terminals, unless `NO_COLOR` is set
    #[arg(
        long,
        global = true,
        value_name = "WHEN",
        default_value = "auto",
        help_heading = "Output"
    )]
    color: ColorChoice,
}

const EXAMPLES: &str = "\
Examples:
  toyproof scenes --write course           write the built-in scenes and shaders to a folder
  toyproof check course --out report       check a folder of shaders, with a report page
  toyproof check mine.glsl --scene 02-sphere
  toyproof render 12-whitted -o whitted.png
  toyproof convert mine.glsl -o mine.wgsl --verify

Exit code: 0 on success, 1 if a shader is at fault or images differ, 2 for any other error.";

#[derive(Debug, Subcommand)]
enum Command {
    Check(Box<check::Args>),
    Test(test::Args),
    Merge(check::MergeArgs),
    Collect(collect::Args),
    Render(render::Args),
    Run(run::Args),
    Convert(convert::Args),
    Debug(debug::Args),
    Dap(dap::Args),
    Watch(watch::Args),
    Explain(explain::Args),
    Fmt(fmt::Args),
    Compare(compare::Args),
    Reduce(Box<reduce::Args>),
    Trade(trade::Args),
    Stress(stress::Args),
    Export(render::ExportArgs),
    Import(project::ImportArgs),
    New(new::Args),
    Autograder(autograder::Args),
    Gradebook(gradebook::Args),
    Similar(similar::Args),
    Scenes(scenes::Args),
    Doctor(doctor::Args),
    Lsp(lsp::Args),
    Completions(shell::CompletionsArgs),
    Man(shell::ManArgs),
}

/// The argument with which this program serves as the worker process of a command. It is not a command, so
/// that it is not listed or suggested.
pub const WORKER: &str = "__worker";

/// Runs the program with these arguments; the first is the program's name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Exit {
    let arguments: Vec<_> = arguments.into_iter().collect();
    if arguments.get(1).is_some_and(|argument| argument == WORKER) {
        return serve_worker();
    }
    let command = help::with_groups(command()).color(requested_color(&arguments));
    let parsed = command
        .clone()
        .try_get_matches_from(&arguments)
        .and_then(|matches| Cli::from_arg_matches(&matches))
        .map_err(|error| help::with_nearest(error, &command));
    match parsed {
        Ok(cli) => cli.run(),
        Err(error) => {
            // Help and the version are not errors; if they cannot be printed, nothing can.
            let _ = error.print();
            if error.use_stderr() {
                Exit::Error
            } else {
                Exit::Success
            }
        }
    }
}

/// The commands. Only `run` renders images that are larger than memory.
fn command() -> clap::Command {
    Cli::command().mut_subcommand("run", |run| {
        run.mut_arg("size", |size| size.value_parser(inputs::parse_banded_size))
    })
}

/// The value of `--color`, if it is valid, for the messages on arguments that cannot be parsed.
fn requested_color(arguments: &[OsString]) -> ColorChoice {
    let texts: Vec<_> = arguments
        .iter()
        .filter_map(|argument| argument.to_str())
        .collect();
    let separate = texts
        .windows(2)
        .find(|pair| pair[0] == "--color")
        .map(|pair| pair[1]);
    let joined = texts.iter().find_map(|text| text.strip_prefix("--color="));
    match separate.or(joined) {
        Some("always") => ColorChoice::Always,
        Some("never") => ColorChoice::Never,
        _ => ColorChoice::Auto,
    }
}

impl Cli {
    /// Runs the command that the arguments name.
    fn run(self) -> Exit {
        match self.color {
            ColorChoice::Auto => anstream::ColorChoice::Auto,
            ColorChoice::Always => anstream::ColorChoice::Always,
            ColorChoice::Never => anstream::ColorChoice::Never,
        }
        .write_global();
        let terminal = Terminal::new(self.quiet, self.verbose);
        if std::env::var_os("RUST_BACKTRACE").is_none() {
            panic::set_hook(Box::new(Terminal::print_panic));
        }
        let ended = contain(Part::Command, || self.command.run(&terminal));
        let ended = ended.unwrap_or_else(|panic| Err(panic.into()));
        let exit = ended.unwrap_or_else(|error| terminal.fail(&error));
        if terminal.has_failed() { Exit::Error } else { exit }
    }
}

impl Command {
    fn run(&self, terminal: &Terminal) -> Result<Exit, CliError> {
        match self {
            Self::Check(args) => check::run(args, terminal),
            Self::Test(args) => test::run(args, terminal),
            Self::Merge(args) => check::merge(args, terminal),
            Self::Collect(args) => collect::run(args, terminal),
            Self::Render(args) => render::run(args, terminal),
            Self::Run(args) => run::run(args, terminal),
            Self::Convert(args) => convert::run(args, terminal),
            Self::Debug(args) => debug::run(args, terminal),
            Self::Dap(dap::Args {}) => dap::run(terminal),
            Self::Watch(args) => watch::run(args, terminal),
            Self::Explain(args) => Ok(explain::run(args, terminal)),
            Self::Fmt(args) => Ok(fmt::run(args, terminal)),
            Self::Compare(args) => compare::run(args, terminal),
            Self::Reduce(args) => reduce::run(args, terminal),
            Self::Trade(args) => trade::run(args, terminal),
            Self::Stress(args) => stress::run(args, terminal),
            Self::Export(args) => render::export(args, terminal),
            Self::Import(args) => project::import(args, terminal),
            Self::New(args) => new::run(args, terminal),
            Self::Autograder(args) => autograder::run(args, terminal),
            Self::Gradebook(args) => gradebook::run(args, terminal),
            Self::Similar(args) => Ok(similar::run(args, terminal)),
            Self::Scenes(args) => scenes::run(args, terminal),
            Self::Doctor(args) => doctor::run(args, terminal),
            Self::Lsp(args) => lsp::run(args),
            Self::Completions(args) => shell::completions(args, terminal),
            Self::Man(args) => shell::man(args, terminal),
        }
    }
}

/// Serves as the worker process that `check`, `run`, `convert` and `doctor` start.
fn serve_worker() -> Exit {
    match gpu::serve(io::stdin(), io::stdout()) {
        Ok(()) => Exit::Success,
        Err(_) => Exit::Error,
    }
}
