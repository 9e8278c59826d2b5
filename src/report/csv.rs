//! `report.csv`: a row per shader, for spreadsheets (RFC 4180).

use std::io::{self, Write};

use toyproof_diagnostic::Severity;
use toyproof_verify::compare::CheckSummary;

use super::{Record, Records, Repair, Rubrics};

const COLUMNS: [&str; 28] = [
    "shader",
    "scene",
    "reference",
    "verdict",
    "reason",
    "mistake",
    "fix_line",
    "fix",
    "points",
    "max_points",
    "pixels",
    "algorithm_differing",
    "algorithm_ill_conditioned",
    "algorithm_undefined",
    "algorithm_max_abs",
    "precision_differing",
    "precision_max_abs",
    "toolchain_differing",
    "toolchain_max_abs",
    "differing_8bit",
    "max_8bit",
    "errors",
    "warnings",
    "seconds",
    "assignment",
    "student",
    "id",
    "late_seconds",
];

/// Writes the table; its first row names the columns. Checks that did not run are empty, and points without
/// a rubric. `fix_line` is the line of the first edit.
///
/// # Errors
/// The system's error: a record cannot be read, or the table cannot be written.
pub fn csv(records: &Records, rubrics: &Rubrics, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(line(&COLUMNS.map(str::to_owned)).as_bytes())?;
    for record in records.iter() {
        out.write_all(line(&row(&*record?, rubrics)).as_bytes())?;
    }
    Ok(())
}

/// A row with its end.
pub(super) fn line(cells: &[String]) -> String {
    let cells: Vec<_> = cells.iter().map(|cell| quote(cell)).collect();
    cells.join(",") + "\r\n"
}

/// Quotes a cell if needed.
fn quote(cell: &str) -> String {
    if cell.contains(['"', ',', '\r', '\n']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

fn row(record: &Record, rubrics: &Rubrics) -> [String; COLUMNS.len()] {
    let total = rubrics.total(record);
    let submitted = record.submitted.as_ref();
    // A submission that is late without a known time has a text here.
    let late = record.late().map(|late| match late.seconds {
        Some(seconds) => seconds.to_string(),
        None => "unknown".to_owned(),
    });
    let count = |severity| {
        let diagnostics = record.diagnostics.iter();
        diagnostics
            .filter(|diagnostic| diagnostic.severity == severity)
            .count()
            .to_string()
    };
    let number = |check: &Option<CheckSummary>, of: fn(&CheckSummary) -> u64| cell(check.as_ref().map(of));
    let max_abs = |check: &Option<CheckSummary>| cell(check.as_ref().map(|answer| answer.max_abs));
    let image = record.comparison.as_ref();
    let answers = [&record.algorithm, &record.precision];
    [
        escape_formula(&record.shader),
        escape_formula(record.scene.as_deref().unwrap_or_default()),
        escape_formula(record.reference.as_deref().unwrap_or_default()),
        record.verdict.to_string(),
        escape_formula(&record.reason),
        cell(record.mistake.as_ref().map(|mistake| &mistake.id)),
        cell(record.fix.as_ref().map(|fix| fix.range.line)),
        escape_formula(&cell(record.fix.as_ref().map(Repair::summary))),
        cell(total.map(|[points, _]| points)),
        cell(total.map(|[_, of]| of)),
        cell(answers.into_iter().flatten().map(|answer| answer.pixels).next()),
        number(&record.algorithm, |answer| answer.differing),
        number(&record.algorithm, |answer| answer.ill_conditioned),
        number(&record.algorithm, |answer| answer.undefined),
        max_abs(&record.algorithm),
        number(&record.precision, |answer| answer.differing),
        max_abs(&record.precision),
        number(&record.toolchain, |answer| answer.differing),
        max_abs(&record.toolchain),
        cell(image.map(|image| image.differing_8bit)),
        cell(image.map(|image| image.max_8bit)),
        count(Severity::Error),
        count(Severity::Warning),
        format!("{:.3}", record.seconds.total()),
        escape_formula(&cell(submitted.and_then(|one| one.assignment.as_ref()))),
        escape_formula(&cell(submitted.map(|one| &one.student))),
        escape_formula(&cell(submitted.and_then(|one| one.id.as_ref()))),
        cell(late),
    ]
}

fn cell<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Prevents a spreadsheet from reading a text as a formula, by prefixing an apostrophe.
pub(super) fn escape_formula(text: &str) -> String {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{text}")
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::record::samples::{correct, invalid};
    use crate::report::repair::samples::repaired;
    use crate::report::{Rubric, written};

    fn table(records: Vec<Record>, rubrics: &Rubrics) -> String {
        written(|out| csv(&records.into(), rubrics, out))
    }

    #[test]
    fn texts_are_quoted_and_formulas_are_escaped() {
        let mut hostile = invalid();
        hostile.shader = "=cmd|'/c calc'!A1,\"x\"\n.glsl".to_owned();
        let table = table(vec![correct(), hostile], &Rubrics::default());
        let mut lines = table.split("\r\n");
        assert_eq!(lines.next().unwrap().split(',').collect::<Vec<_>>(), COLUMNS);
        assert_eq!(
            lines.next().unwrap(),
            "correct,scene.toml,,correct,it is correct,,,,,,1000,0,0,0,0.25,0,0.25,0,0.25,,,0,0,1.500,,,,"
        );
        assert_eq!(
            lines.next().unwrap(),
            "\"'=cmd|'/c calc'!A1,\"\"x\"\"\n.glsl\",scene.toml,,invalid,it is invalid,,,,,,,,,,,,,,,,,1,0,1.500,,,,"
        );
        assert_eq!(lines.collect::<Vec<_>>(), [""]);
    }

    #[test]
    fn a_fix_has_its_line_and_its_edits() {
        let text = table(vec![repaired()], &Rubrics::default());
        assert!(
            text.contains(",wrong-operator,2,line 2: replace `b + c` with `b - c`,"),
            "{text}"
        );
    }

    #[test]
    fn a_rubric_adds_points() {
        let text = table(vec![correct()], &Some(Rubric::of(1.0, 8.0, 1.0)).into());
        assert!(text.contains(",10,10,1000,"), "{text}");
    }
}
