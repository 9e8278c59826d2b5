//! `report.csv`: a row per shader, for spreadsheets (RFC 4180).

use std::io::{self, Write};

use ::csv::{Terminator, Writer, WriterBuilder};
use toyproof_diagnostic::{Severity, spreadsheet_text};
use toyproof_verify::compare::CheckSummary;

use super::repair::in_tab;
use super::{Record, Rubrics};

const COLUMNS: [&str; 30] = [
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
    "checked_verdict",
    "decision",
];

/// Writes the table; its first row names the columns. Checks that did not run are empty, and points without
/// a rubric. `fix_line` is the line of the first edit, and `checked_verdict` the verdict before a teacher's
/// decision.
///
/// # Errors
/// The table cannot be written.
pub fn csv(records: &[Record], rubrics: &Rubrics, out: &mut dyn Write) -> io::Result<()> {
    let mut table = table(out);
    table.write_record(COLUMNS)?;
    for record in records {
        table.write_record(row(record, rubrics))?;
    }
    table.flush()
}

/// Starts a table in the format of RFC 4180.
pub(super) fn table<W: Write>(out: W) -> Writer<W> {
    WriterBuilder::new().terminator(Terminator::CRLF).from_writer(out)
}

fn row(record: &Record, rubrics: &Rubrics) -> [String; COLUMNS.len()] {
    let total = rubrics.total(record);
    let (submitted, decision) = (record.submitted.as_ref(), record.decision.as_ref());
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
        spreadsheet_text(&record.shader),
        spreadsheet_text(record.scene.as_deref().unwrap_or_default()),
        spreadsheet_text(record.reference.as_deref().unwrap_or_default()),
        record.verdict.to_string(),
        spreadsheet_text(&record.reason),
        cell(record.mistake.as_ref().map(|mistake| &mistake.id)),
        cell(record.fix.as_ref().map(|fix| fix.range.line)),
        spreadsheet_text(&cell(
            record
                .fix
                .as_ref()
                .map(|fix| in_tab(fix, &record.shader) + &fix.summary()),
        )),
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
        spreadsheet_text(&cell(submitted.and_then(|one| one.assignment.as_ref()))),
        spreadsheet_text(&cell(submitted.map(|one| &one.student))),
        spreadsheet_text(&cell(submitted.and_then(|one| one.id.as_ref()))),
        cell(late),
        cell(decision.map(|decision| decision.checked_verdict)),
        spreadsheet_text(&cell(decision.map(|decision| &decision.reason))),
    ]
}

fn cell<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::samples::{correct, invalid};
    use crate::repair::samples::repaired;
    use crate::{Rubric, written};

    fn table(records: &[Record], rubrics: &Rubrics) -> String {
        written(|out| csv(records, rubrics, out))
    }

    #[test]
    fn texts_are_quoted_and_formulas_are_escaped() {
        let mut hostile = invalid();
        hostile.shader = "=cmd|'/c calc'!A1,\"x\"\n.glsl".to_owned();
        let table = table(&[correct(), hostile], &Rubrics::default());
        let mut lines = table.split("\r\n");
        assert_eq!(lines.next().unwrap().split(',').collect::<Vec<_>>(), COLUMNS);
        assert_eq!(
            lines.next().unwrap(),
            "correct,scene.toml,,correct,it is correct,,,,,,1000,0,0,0,0.25,0,0.25,0,0.25,,,0,0,1.500,,,,,,"
        );
        assert_eq!(
            lines.next().unwrap(),
            "\"'=cmd|'/c calc'!A1,\"\"x\"\"\\n.glsl\",scene.toml,,invalid,it is invalid,,,,,,,,,,,,,,,,,1,0,1.500,,,,,,"
        );
        assert_eq!(lines.collect::<Vec<_>>(), [""]);
    }

    /// Another reader gets the cells, and no cell acts on a terminal or a spreadsheet.
    #[test]
    fn hostile_texts_stay_in_their_cells() {
        let texts = [
            "a\u{1b}[31m\u{9b}2J",
            "b\r\nforged,row",
            "c\u{202e}\u{2066}\u{2028}",
            "\u{200b}=1",
            "＝1",
            "\t=1",
            "d\",\"e",
        ];
        let records = texts.map(|text| {
            let mut record = invalid();
            record.shader = text.to_owned();
            record.reason = text.to_owned();
            record
        });
        let text = table(&records, &Rubrics::default());
        let rows: Vec<Vec<String>> = rfc4180(&text);
        assert_eq!(rows.len(), 1 + texts.len());
        for (row, text) in rows[1..].iter().zip(texts) {
            let expected = spreadsheet_text(text);
            assert_eq!(
                (row.len(), &row[0], &row[4]),
                (COLUMNS.len(), &expected, &expected)
            );
        }
        let acts = |character: char| character.is_control() && !"\r\n".contains(character);
        assert!(!text.contains(acts) && !text.replace("\r\n", "").contains(['\r', '\n']));
    }

    /// The cells of a table, by the grammar of RFC 4180.
    fn rfc4180(text: &str) -> Vec<Vec<String>> {
        let (mut rows, mut row, mut cell) = (Vec::new(), Vec::new(), String::new());
        let mut characters = text.chars().peekable();
        let mut is_quoted = false;
        while let Some(character) = characters.next() {
            match character {
                '"' if is_quoted && characters.peek() == Some(&'"') => cell.extend(characters.next()),
                '"' => is_quoted = !is_quoted,
                ',' if !is_quoted => row.push(std::mem::take(&mut cell)),
                '\r' if !is_quoted => {
                    assert_eq!(characters.next(), Some('\n'));
                    row.push(std::mem::take(&mut cell));
                    rows.push(std::mem::take(&mut row));
                }
                character => cell.push(character),
            }
        }
        assert!(row.is_empty() && cell.is_empty() && !is_quoted);
        rows
    }

    #[test]
    fn a_fix_has_its_line_and_its_edits() {
        let text = table(&[repaired()], &Rubrics::default());
        assert!(
            text.contains(",wrong-operator,2,line 2: replace `b + c` with `b - c`,"),
            "{text}"
        );
    }

    #[test]
    fn a_rubric_adds_points() {
        let text = table(&[correct()], &Some(Rubric::with_points(1.0, 8.0, 1.0)).into());
        assert!(text.contains(",10,10,1000,"), "{text}");
    }
}
