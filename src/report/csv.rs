//! `report.csv`: a row for each shader, for spreadsheets (RFC 4180).

use toyproof_diagnostic::Severity;
use toyproof_verify::compare::Answer;

use super::{Mark, Record, Rubric};

const COLUMNS: [&str; 21] = [
    "shader",
    "scene",
    "verdict",
    "reason",
    "mistake",
    "points",
    "max_points",
    "pixels",
    "maths_differing",
    "maths_undecided",
    "maths_undefined",
    "maths_max_abs",
    "rounding_differing",
    "rounding_max_abs",
    "toolchain_differing",
    "toolchain_max_abs",
    "differing_8bit",
    "max_8bit",
    "errors",
    "warnings",
    "seconds",
];

/// The table, its first row the names of its columns. What was not asked, and points where there is no rubric, are empty.
#[must_use]
pub fn csv(records: &[Record], rubric: Option<&Rubric>) -> String {
    let rows = records.iter().map(|record| row(record, rubric));
    let rows = [COLUMNS.map(str::to_owned)].into_iter().chain(rows);
    rows.map(|row| row.map(|cell| quoted(&cell)).join(",") + "\r\n")
        .collect()
}

/// A cell as it stands between commas.
fn quoted(cell: &str) -> String {
    if cell.contains(['"', ',', '\r', '\n']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

fn row(record: &Record, rubric: Option<&Rubric>) -> [String; COLUMNS.len()] {
    let marks = rubric.map(|rubric| rubric.marks(record));
    let sum = |of: fn(&Mark) -> f64| {
        let points = marks.as_ref().map(|marks| marks.iter().map(of).sum::<f64>());
        told(points.map(|points| (100.0 * points).round() / 100.0))
    };
    let count = |severity| {
        let told = record.diagnostics.iter();
        told.filter(|told| told.severity == severity).count().to_string()
    };
    let number = |question: &Option<Answer>, of: fn(&Answer) -> u64| told(question.as_ref().map(of));
    let max_abs = |question: &Option<Answer>| told(question.as_ref().map(|answer| answer.max_abs));
    let picture = record.picture.as_ref();
    let answers = [&record.maths, &record.rounding];
    [
        text(&record.shader),
        text(record.scene.as_deref().unwrap_or_default()),
        record.verdict.to_string(),
        text(&record.reason),
        told(record.mistake.as_ref().map(|mistake| &mistake.id)),
        sum(|mark| mark.points),
        sum(|mark| mark.of),
        told(answers.into_iter().flatten().map(|answer| answer.pixels).next()),
        number(&record.maths, |answer| answer.differing),
        number(&record.maths, |answer| answer.undecided),
        number(&record.maths, |answer| answer.undefined),
        max_abs(&record.maths),
        number(&record.rounding, |answer| answer.differing),
        max_abs(&record.rounding),
        number(&record.toolchain, |answer| answer.differing),
        max_abs(&record.toolchain),
        told(picture.map(|picture| picture.differing_8bit)),
        told(picture.map(|picture| picture.max_8bit)),
        count(Severity::Error),
        count(Severity::Warning),
        format!("{:.3}", record.seconds.total()),
    ]
}

fn told<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// A text that no spreadsheet takes for a formula: one that begins like one gets an apostrophe before it.
fn text(text: &str) -> String {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{text}")
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::{correct, invalid};

    #[test]
    fn texts_are_quoted_and_formulas_are_texts() {
        let mut hostile = invalid();
        hostile.shader = "=cmd|'/c calc'!A1,\"x\"\n.glsl".to_owned();
        let table = csv(&[correct(), hostile], None);
        let mut lines = table.split("\r\n");
        assert_eq!(lines.next().unwrap().split(',').collect::<Vec<_>>(), COLUMNS);
        assert_eq!(
            lines.next().unwrap(),
            "correct,scene.toml,correct,it is correct,,,,1000,0,0,0,0.25,0,0.25,0,0.25,,,0,0,1.500"
        );
        assert_eq!(
            lines.next().unwrap(),
            "\"'=cmd|'/c calc'!A1,\"\"x\"\"\n.glsl\",scene.toml,invalid,it is invalid,,,,,,,,,,,,,,,1,0,1.500"
        );
        assert_eq!(lines.collect::<Vec<_>>(), [""]);
    }

    #[test]
    fn with_a_rubric_there_are_points() {
        let text = csv(&[correct()], Some(&Rubric::of(1.0, 8.0, 1.0)));
        assert!(text.contains(",10,10,1000,"), "{text}");
    }
}
