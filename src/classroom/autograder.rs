//! The archive of an autograder for Gradescope: an assignment, the program, and the scripts that Gradescope
//! runs.

use std::io;
use std::path::{Component, Path, PathBuf};

use toyproof_diagnostic::path_name;
use toyproof_image::{FrameInputs, input};
use toyproof_project::archive::{self, Mode};
use toyproof_project::{PROJECT_FILE, Tab};

use crate::assignment::{Assignment, FILE_NAME, Reference};

const SETUP: &str = include_str!("gradescope/setup.sh");
const RUN: &str = include_str!("gradescope/run_autograder.sh");

/// Packs the autograder of an assignment, whose file is at `path`, with a program for Linux on x86-64.
///
/// # Errors
/// If the assignment gives no points, or a file cannot be read or is outside the assignment's folder.
pub fn pack(program: &Path, path: &Path, assignment: &Assignment) -> Result<Vec<u8>, String> {
    if assignment.rubric.is_none() {
        return Err(format!(
            "{} gives no points\nhelp: add a table such as [rubric.algorithm] with `points = 6`",
            path_name(path)
        ));
    }
    let with_path = |path: &Path, error: io::Error| format!("{}: {error}", path_name(path));
    let read = |path: &Path| input::read(path).map_err(|error| with_path(path, error));
    let program_bytes = read(program)?;
    if !is_for_linux(&program_bytes) {
        return Err(format!(
            "{} is not a program for Linux on x86-64, which Gradescope runs\nhelp: name one with --program",
            path_name(program)
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
    archive::pack(&packed).map_err(|error| error.to_string())
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
