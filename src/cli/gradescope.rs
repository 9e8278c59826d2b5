//! `toyproof gradescope`: an autograder for Gradescope.

use std::path::PathBuf;

use toyproof_classroom::autograder;

use super::check::read_assignment;
use super::terminal::file_size;
use super::{CliError, Exit, Terminal};

/// Create an autograder for Gradescope from an assignment
///
/// The archive has the assignment, this program, and the scripts that Gradescope runs: `setup.sh` installs
/// the driver, and `run_autograder` checks a submission and writes its marks. Upload it as it is.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Example:
  toyproof gradescope shadows/assignment.toml -o autograder.zip")]
pub(super) struct Args {
    /// The assignment (.toml), with points, or its folder
    assignment: PathBuf,
    /// The archive to create
    #[arg(short, long, value_name = "FILE", default_value = "autograder.zip")]
    output: PathBuf,
    /// The program for Gradescope's machines, which run Linux on x86-64 [default: this program]
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let (path, assignment) = read_assignment(&args.assignment)?;
    let program = match &args.program {
        Some(program) => program.clone(),
        None => std::env::current_exe().map_err(|error| format!("the program's own file: {error}"))?,
    };
    let archive = autograder::pack(&program, &path, &assignment)?;
    terminal.write(&args.output, &archive)?;
    terminal.confirm(&args.output, &file_size(archive.len()));
    terminal.note("to use it: upload it on Gradescope, under Configure Autograder");
    Ok(Exit::Success)
}
