//! The hints that a report gives to the author of a wrong shader.

use super::Record;

/// How much of the mistake in a wrong shader a report shows. Errors and warnings are always shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hints {
    /// Neither the likely mistake nor lines nor edits.
    None,
    /// The likely mistake, the lines of the fix or the suspect lines, and what only the reference uses.
    Line,
    /// All of that, and the edits.
    Fix,
}

impl Record {
    /// Returns the record without the parts that the author must not see, so that no format shows them.
    #[must_use]
    pub fn redacted(mut self, hints: Hints) -> Self {
        if hints < Hints::Fix
            && let Some(fix) = &mut self.fix
        {
            fix.hide_edits();
        }
        if hints < Hints::Fix
            && let Some(departure) = &mut self.departure
        {
            departure.hide_reference();
        }
        let unused = std::mem::take(&mut self.unused);
        if hints >= Hints::Line {
            self.details.extend(unused);
        } else {
            self.fix = None;
            self.suspects.clear();
            self.departure = None;
            self.is_search_cut = false;
            if self.mistake.take().is_some() {
                // The command explains the mistake.
                self.help = None;
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::samples::{repaired, suspected};
    use crate::{Report, Rubric, csv, junit, sarif, written};

    /// Every text format of a record with these hints.
    fn formats(record: Record, hints: Hints) -> Vec<String> {
        let rubric = Rubric::with_points(1.0, 8.0, 1.0);
        let report = Report::new(None, vec![record.redacted(hints)]);
        let records = report.shaders();
        vec![
            written(|out| csv(records, &Some(rubric.clone()).into(), out)),
            written(|out| junit(records, hints, out)),
            written(|out| sarif(records, out)),
            written(|out| report.json(out)),
        ]
    }

    #[test]
    fn lines_are_shown_without_edits() {
        for text in formats(repaired(), Hints::Line) {
            assert!(!text.contains("b - c") && !text.contains("2.0"), "{text}");
        }
        let junit = &formats(suspected(), Hints::Line)[1];
        assert!(junit.contains("suspect lines: 4, 2"), "{junit}");
    }

    #[test]
    fn without_hints_neither_mistakes_nor_lines_are_shown() {
        for record in [repaired, suspected] {
            for text in formats(record(), Hints::None) {
                for part in ["operator", "line 2", "4, 2", "b + c", "explain"] {
                    assert!(!text.contains(part), "{part}: {text}");
                }
            }
        }
    }

    #[test]
    fn with_all_hints_nothing_is_removed() {
        let record = repaired().redacted(Hints::Fix);
        assert_eq!(record.fix, repaired().fix);
    }
}
