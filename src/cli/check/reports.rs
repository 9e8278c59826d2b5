//! The files that `--out` gets beside the pictures.

use std::path::Path;

use super::Args;
use super::gallery::gallery;
use super::judge::Submission;
use crate::cli::Terminal;
use crate::cli::shader::Unusable;
use crate::diagnostic::of_content;
use crate::report::{Report, Rubric, csv, gradescope, html, junit, sarif};
use crate::source::{self, Files};

/// The rubric that the arguments name, if they name one.
///
/// # Errors
/// None if it cannot be used, which has been told.
pub(super) fn rubric(args: &Args, terminal: &Terminal) -> Result<Option<Rubric>, ()> {
    let Some(path) = &args.rubric else {
        return Ok(None);
    };
    let mut files = Files::default();
    let rubric = match source::read_text(path) {
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
    let mut files = vec![
        ("report.html", html(report, rubric, &gallery(submissions))),
        ("report.csv", csv(records, rubric)),
        ("junit.xml", junit(records)),
        ("report.sarif", sarif(records)),
    ];
    if let Some(rubric) = rubric {
        files.push(("results.json", gradescope(records, rubric)));
    }
    // Last, so that who sees it sees all.
    files.push(("verdict.json", report.json()));
    let written = files
        .into_iter()
        .map(|(name, text)| terminal.write(&out.join(name), text.as_bytes()));
    // All are tried.
    written.fold(true, |all, one| all & one)
}
