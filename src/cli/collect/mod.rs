//! `toyproof collect`: a folder for each student, from the downloads of a learning management system.

mod writer;

use std::path::{Path, PathBuf};

use toyproof_classroom::collect::class::{Class, Purpose};
use toyproof_classroom::collect::collection::Collection;
use toyproof_classroom::collect::roster::Roster;
use toyproof_classroom::collect::storage::remove_earlier;
use toyproof_diagnostic::{path_name, printable};

use self::writer::{Listing, Writer};
use super::inputs::shell_word;
use super::shader::parse_named;
use super::{CliError, Exit, Terminal};

/// Collect submissions from downloads into a folder for each student
///
/// Reads what Moodle and Canvas let teachers download, or any archive or folder with a folder or a file for
/// each student, and archives in them. Shaders are recognized by their names or by their texts, and saved as
/// UTF-8. What is not a shader is reported and left out. `toyproof check` has a row for each student of the
/// folder.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof collect moodle.zip -o homework
  toyproof collect submissions.zip --class class.toml -o homework

Exit code: 0 on success, even if a student submitted no shader, 2 for any error.")]
pub(super) struct Args {
    /// Archives (.zip) and folders
    #[arg(required = true, value_name = "DOWNLOAD")]
    downloads: Vec<PathBuf>,
    /// The folder to create
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The class (.toml): the list of its students, and the files and deadlines of several assignments
    #[arg(long, value_name = "FILE")]
    class: Option<PathBuf>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let class = match &args.class {
        Some(path) => read_class(path, Purpose::Collect)?,
        None => Class::default(),
    };
    collect(args, &class, terminal)?;
    Ok(Exit::Success)
}

fn read_class(path: &Path, purpose: Purpose) -> Result<Class, CliError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    parse_named(path, |files, file| Class::parse(files, file, folder, purpose))
}

fn collect(args: &Args, class: &Class, terminal: &Terminal) -> Result<(), CliError> {
    check_empty(&args.output)?;
    let collection = Collection::read(&args.downloads, class)?;
    if !class.assignments.is_empty() {
        write_class(&args.output, &collection, class, Listing::Everyone, terminal)?;
        for assignment in &class.assignments {
            next(
                &args.output.join(&assignment.name),
                assignment.assignment.as_deref(),
                terminal,
            );
        }
        return Ok(());
    }
    let writer = Writer {
        folder: &args.output,
        assignment: None,
        listing: Listing::Everyone,
        terminal,
    };
    writer.write(&collection)?;
    next(&args.output, None, terminal);
    Ok(())
}

/// Writes a folder for each assignment of a class, and reports files that belong to no assignment.
fn write_class(
    folder: &Path,
    collection: &Collection,
    class: &Class,
    listing: Listing,
    terminal: &Terminal,
) -> Result<(), CliError> {
    if class
        .assignments
        .iter()
        .any(|assignment| assignment.deadline.is_some())
    {
        for download in &collection.copies {
            terminal.warn(format_args!(
                "{}: the files of all students have the same time, which is not that of their submissions",
                path_name(download)
            ));
        }
    }
    for assignment in &class.assignments {
        let writer = Writer {
            folder: &folder.join(&assignment.name),
            assignment: Some(assignment),
            listing,
            terminal,
        };
        writer.write(collection)?;
    }
    for own in &collection.students {
        for file in &own.submission.files {
            let path = file.original_path();
            let is_of_none = !class.assignments.iter().any(|assignment| assignment.has(&path));
            if file.is_shader() && is_of_none {
                terminal.warn(format_args!(
                    "{}: {} was left out: no assignment of the class has this file",
                    own.name,
                    printable(&path)
                ));
            }
        }
    }
    Ok(())
}

/// The submissions of an assignment of a class, as `check` reads them.
pub(super) struct ClassPart {
    /// The name of the assignment.
    pub(super) name: String,
    /// The folder with the folders of all students.
    pub(super) folder: PathBuf,
    /// The file or the folder of the assignment.
    pub(super) assignment: PathBuf,
    /// The rubric, if it is not that of the assignment.
    pub(super) rubric: Option<PathBuf>,
}

/// Finds the submissions of each assignment of a class: in a folder that `collect` wrote, or in downloads,
/// from which they are collected into the folder `to`; if `to` is `None`, as for a shard, downloads are
/// refused.
pub(super) fn class_parts(
    downloads: &[PathBuf],
    class: &Path,
    to: Option<&Path>,
    terminal: &Terminal,
) -> Result<Vec<ClassPart>, CliError> {
    let class = read_class(class, Purpose::Check)?;
    let collected = match downloads {
        [folder] if is_collected(folder, &class) => folder.clone(),
        _ => {
            let Some(to) = to else {
                let error = CliError::new("a shard needs collected submissions, not a download");
                return Err(error.with_help(
                    "`toyproof collect DOWNLOAD --class class.toml -o homework`, and check `homework`",
                ));
            };
            let collection = Collection::read(downloads, &class)?;
            remove_earlier(to)?;
            write_class(to, &collection, &class, Listing::Notes, terminal)?;
            to.to_owned()
        }
    };
    let parts = class.assignments.iter().map(|assignment| ClassPart {
        name: assignment.name.clone(),
        folder: collected.join(&assignment.name),
        // `Purpose::Check` requires one.
        assignment: assignment.assignment.clone().unwrap_or_default(),
        rubric: assignment.rubric.clone(),
    });
    Ok(parts.collect())
}

/// Whether a folder has the collected submissions of all assignments.
fn is_collected(folder: &Path, class: &Class) -> bool {
    let has_roster = |name: &str| matches!(Roster::read(&folder.join(name)), Ok(Some(_)));
    class
        .assignments
        .iter()
        .all(|assignment| has_roster(&assignment.name))
}

/// Prints the `check` command for the collected folder.
fn next(folder: &Path, assignment: Option<&Path>, terminal: &Terminal) {
    let assignment = assignment.map(|path| shell_word(&path_name(path)));
    terminal.note(&format!(
        "to check them: toyproof check {} --assignment {} --out marks",
        shell_word(&path_name(folder)),
        assignment.as_deref().unwrap_or("FILE")
    ));
}

/// Checks that a folder can be written: it does not exist or is empty.
///
/// # Errors
/// Why not.
fn check_empty(folder: &Path) -> Result<(), String> {
    match std::fs::read_dir(folder).map(|mut entries| entries.next().is_none()) {
        Ok(true) => Ok(()),
        Ok(false) => Err(format!(
            "{} already has files; nothing was written",
            path_name(folder)
        )),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(format!("{}: {error}", path_name(folder))),
    }
}
