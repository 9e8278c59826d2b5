//! The files that `--out` gets beside the pictures.

use std::path::Path;

use toyproof_diagnostic::Files;
use toyproof_verify::contain::{Part, contain};

use super::Args;
use super::gallery::gallery;
use super::judge::Submission;
use crate::cli::files::of_content;
use crate::cli::shader::Unusable;
use crate::cli::{Terminal, files};
use crate::report::{Report, Rubric, csv, gradescope, html, junit, sarif};

/// The rubric that the arguments name, if they name one.
///
/// # Errors
/// None if it cannot be used, which has been told.
pub(super) fn rubric(args: &Args, terminal: &Terminal) -> Result<Option<Rubric>, ()> {
    let Some(path) = &args.rubric else {
        return Ok(None);
    };
    let mut files = Files::default();
    let rubric = match files::read_text(path) {
        Ok(text) => {
            let file = files.add(text);
            Rubric::parse(&files, file).map_err(Unusable::Invalid)
        }
        Err(error) => Err(match of_content(error, &mut files) {
            Ok(diagnostic) => Unusable::Invalid(vec![diagnostic]),
            Err(error) => Unusable::Trouble(error.to_string()),
        }),
    };
    rubric.map(Some).map_err(|unusable| match unusable {
        Unusable::Invalid(diagnostics) => terminal.diagnostics(&diagnostics, &files),
        Unusable::Trouble(error) => terminal.error(error),
    })
}

/// The reports, in the order in which they are written: whoever sees the last sees all.
pub(super) const NAMES: [&str; 6] = [
    "report.html",
    "report.csv",
    "junit.xml",
    "report.sarif",
    "results.json",
    "verdict.json",
];

/// Writes the reports into the folder; whether that worked. The submissions are those of the report's records. `results.json` is for a
/// rubric alone.
pub(super) fn write(
    report: &Report,
    submissions: &[&Submission],
    rubric: Option<&Rubric>,
    out: &Path,
    terminal: &Terminal,
) -> bool {
    let records = report.shaders();
    let texts: [&dyn Fn() -> Option<String>; NAMES.len()] = [
        &|| Some(html(report, rubric, &gallery(submissions))),
        &|| Some(csv(records, rubric)),
        &|| Some(junit(records)),
        &|| Some(sarif(records)),
        &|| rubric.map(|rubric| gradescope(records, rubric)),
        &|| Some(report.json()),
    ];
    let written = NAMES
        .iter()
        .zip(texts)
        .map(|(name, text)| match contain(Part::Report, text) {
            Ok(None) => true,
            Ok(Some(text)) => terminal.write_output(out, &out.join(name), text.as_bytes()),
            Err(panic) => {
                terminal.error(format_args!("cannot write {name}: {panic}"));
                false
            }
        });
    // All are tried.
    written.fold(true, |all, one| all & one)
}
