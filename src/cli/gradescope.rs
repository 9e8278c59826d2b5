//! `toyproof gradescope`: an autograder for Gradescope.

use std::io;
use std::path::{Component, Path, PathBuf};

use toyproof_diagnostic::path_name;
use toyproof_image::{FrameInputs, input};
use toyproof_project::{PROJECT_FILE, Tab};

use super::check::read_assignment;
use super::terminal::file_size;
use super::zip::{self, Mode};
use super::{Exit, Terminal};
use crate::assignment::{Assignment, FILE_NAME, Reference};

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

const SETUP: &str = include_str!("gradescope/setup.sh");
const RUN: &str = include_str!("gradescope/run_autograder.sh");

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let Ok((path, assignment)) = read_assignment(&args.assignment, terminal) else {
        return Exit::Error;
    };
    match pack(args, &path, &assignment) {
        Ok(archive) => {
            if !terminal.write(&args.output, &archive) {
                return Exit::Error;
            }
            terminal.confirm(&args.output, &file_size(archive.len()));
            terminal.note("to use it: upload it on Gradescope, under Configure Autograder");
            Exit::Success
        }
        Err(error) => {
            terminal.error(error);
            Exit::Error
        }
    }
}

fn pack(args: &Args, path: &Path, assignment: &Assignment) -> Result<Vec<u8>, String> {
    if assignment.rubric.is_none() {
        return Err(format!(
            "{} gives no points\nhelp: add a table such as [rubric.algorithm] with `points = 6`",
            path_name(path)
        ));
    }
    let with_path = |path: &Path, error: io::Error| format!("{}: {error}", path_name(path));
    let read = |path: &Path| input::read(path).map_err(|error| with_path(path, error));
    let program = match &args.program {
        Some(program) => program.clone(),
        None => std::env::current_exe().map_err(|error| format!("the program's own file: {error}"))?,
    };
    let program_bytes = read(&program)?;
    if !is_for_linux(&program_bytes) {
        return Err(format!(
            "{} is not a program for Linux on x86-64, which Gradescope runs\nhelp: name one with --program",
            path_name(&program)
        ));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files = vec![(format!("assignment/{FILE_NAME}"), read(path)?)];
    for named in named_files(assignment) {
        let inside = named.strip_prefix(folder).unwrap_or(&named);
        let is_inside = inside
            .components()
            .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !is_inside {
            return Err(format!(
                "{} is not in the folder of the assignment\nhelp: copy it there, and name the copy",
                path_name(&named)
            ));
        }
        let parts: Vec<_> = inside
            .components()
            .filter_map(|part| match part {
                Component::Normal(part) => part.to_str(),
                _ => None,
            })
            .collect();
        let name = format!("assignment/{}", parts.join("/"));
        if !files.iter().any(|(other, _)| *other == name) {
            files.push((name, read(&named)?));
        }
    }
    let mut packed = vec![
        ("setup.sh", Mode::Executable, SETUP.as_bytes()),
        ("run_autograder", Mode::Executable, RUN.as_bytes()),
        ("toyproof", Mode::Executable, &program_bytes[..]),
    ];
    packed.extend(
        files
            .iter()
            .map(|(name, bytes)| (name.as_str(), Mode::Plain, &bytes[..])),
    );
    zip::pack(&packed).map_err(|error| with_path(&args.output, error))
}

/// The files that an assignment names; of a project, the files in its folder.
fn named_files(assignment: &Assignment) -> Vec<PathBuf> {
    let reference = match &assignment.reference {
        Reference::Scene(path) | Reference::Given { path, .. } => path.clone(),
    };
    let names = Tab::ALL
        .into_iter()
        .map(Tab::file_name)
        .chain([PROJECT_FILE.to_owned()]);
    let mut files: Vec<_> = if reference.is_dir() {
        names
            .map(|name| reference.join(name))
            .filter(|path| path.is_file())
            .collect()
    } else {
        vec![reference]
    };
    let channels = assignment.frames.iter().flat_map(FrameInputs::files);
    files.extend(channels.map(Path::to_owned));
    files
}

/// Whether a program is an ELF file of 64 bits for x86-64.
fn is_for_linux(program: &[u8]) -> bool {
    program.starts_with(b"\x7fELF\x02\x01") && program.get(18..20) == Some(&[0x3e, 0])
}
