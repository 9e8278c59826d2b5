//! `toyproof autograder`: what a grading platform runs for each submission.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use toyproof_classroom::autograder::Autograder;
use toyproof_classroom::collect::naming::is_archive;
use toyproof_diagnostic::path_name;
use toyproof_report::platform::{PLATFORMS, Platform};

use super::check::read_assignment;
use super::terminal::file_size;
use super::{CliError, Exit, Terminal};

/// Create an autograder for a grading platform from an assignment
///
/// The autograder has the assignment, this program, and the files that the platform runs for each submission.
/// The guide's page on autograders has the steps for each platform.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof autograder gradescope shadows/assignment.toml -o autograder.zip
  toyproof autograder prairielearn shadows -o course/questions/shadows")]
pub(super) struct Args {
    /// The grading platform
    #[arg(value_parser = platform())]
    platform: &'static Platform,
    /// The assignment (.toml), with points, or its folder
    assignment: PathBuf,
    /// The archive (.zip) or the folder to create
    #[arg(short, long, value_name = "ZIP|DIR", default_value = "autograder.zip")]
    output: PathBuf,
    /// The program for the platform's machines, which run Linux on x86-64 [default: this program]
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
}

/// Parses the name of a platform.
pub(super) fn platform() -> impl TypedValueParser<Value = &'static Platform> {
    PossibleValuesParser::new(PLATFORMS.map(|platform| platform.name))
        .map(|name| Platform::find(&name).expect("the name is one of the possible values"))
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let (path, assignment) = read_assignment(&args.assignment)?;
    let program = match &args.program {
        Some(program) => program.clone(),
        None => std::env::current_exe().map_err(|error| format!("the program's own file: {error}"))?,
    };
    let autograder = Autograder::new(args.platform, &program, &path, &assignment)?;
    if is_archive(&args.output) {
        let archive = autograder.zip()?;
        terminal.write(&args.output, &archive)?;
        terminal.confirm(&args.output, &file_size(archive.len()));
    } else {
        write_folder(&args.output, &autograder, terminal)?;
    }
    terminal.note(&format!("to use it: {}", args.platform.advice));
    Ok(Exit::Success)
}

/// Writes the files into a folder, which may have those of an earlier run and others.
fn write_folder(folder: &Path, autograder: &Autograder, terminal: &Terminal) -> Result<(), CliError> {
    if folder.is_file() {
        let error = CliError::new(format_args!("{} is a file", path_name(folder)));
        return Err(error.with_help("name a folder, or an archive that ends in .zip"));
    }
    let mut bytes = 0;
    for file in autograder.files() {
        let path = folder.join(&file.path);
        terminal.write_output(folder, &path, &file.bytes)?;
        if file.is_executable {
            let set = make_executable(&path);
            set.map_err(|error| format!("cannot write {}: {error}", path_name(&path)))?;
        }
        bytes += file.bytes.len();
    }
    terminal.confirm(folder, &file_size(bytes));
    Ok(())
}

/// Makes a file a program. Where files have no such permission, the scripts of the autograder do it.
#[cfg(unix)]
fn make_executable(path: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
#[expect(clippy::unnecessary_wraps, reason = "as on other systems")]
fn make_executable(_: &Path) -> io::Result<()> {
    Ok(())
}
