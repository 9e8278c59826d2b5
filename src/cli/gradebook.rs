//! `toyproof gradebook`: marks in the table that a learning management system imports.

use std::path::{Path, PathBuf};

use toyproof_classroom::collect::text;
use toyproof_classroom::gradebook::Marks;
use toyproof_diagnostic::{grouped, path_name, plural};
use toyproof_image::input;

use super::{CliError, Exit, Terminal};

/// Write the points of a checked class into a table of Moodle or Canvas
///
/// The table is Moodle's grading worksheet, or the gradebook of Moodle or Canvas, as they export it. Students
/// are found by their numbers or names. Nothing but the points changes, so that the result can be imported.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof gradebook canvas.csv --marks marks -o canvas-filled.csv
  toyproof gradebook worksheet.csv --marks marks --assignment torus -o filled.csv")]
pub(super) struct Args {
    /// The table (.csv) that the system exported
    table: PathBuf,
    /// What `check --out` wrote: the folder, or its report.csv
    #[arg(long, value_name = "DIR")]
    marks: PathBuf,
    /// The table to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The assignment of the class whose points are written [default: all that have a column]
    #[arg(long, value_name = "NAME")]
    assignment: Option<String>,
    /// The column for the points [default: that with the assignment's name, or `Grade`]
    #[arg(long, value_name = "NAME")]
    column: Option<String>,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let report = if args.marks.is_dir() {
        args.marks.join("report.csv")
    } else {
        args.marks.clone()
    };
    let marks = Marks::parse(&read(&report)?).map_err(in_file(&report))?;
    let table = read(&args.table)?;
    let (assignment, column) = (args.assignment.as_deref(), args.column.as_deref());
    let filled = marks
        .fill(&table, assignment, column)
        .map_err(in_file(&args.table))?;
    for warning in &filled.warnings {
        terminal.warn(warning);
    }
    terminal.write(&args.output, filled.text.as_bytes())?;
    let count = format!(
        "{} {}",
        grouped(filled.count),
        plural(filled.count, "mark", "marks")
    );
    terminal.confirm(&args.output, &count);
    Ok(Exit::Success)
}

/// Reads a table in any of the encodings that spreadsheets write.
fn read(path: &Path) -> Result<String, String> {
    let bytes = input::read(path).map_err(|error| format!("{}: {error}", path_name(path)))?;
    let not_text = || {
        format!(
            "{} is not a text\nhelp: export the table as CSV, not as a spreadsheet",
            path_name(path)
        )
    };
    text::decode(&bytes).map(|(text, _)| text).ok_or_else(not_text)
}

/// Names the file of an error.
fn in_file(path: &Path) -> impl Fn(String) -> String {
    let name = path_name(path);
    move |error| format!("{name}: {error}")
}
