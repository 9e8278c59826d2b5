//! `class.csv`: a row per student and a column per assignment, for spreadsheets and learning management
//! systems (RFC 4180).

use std::collections::BTreeMap;
use std::io::{self, Write};

use toyproof_diagnostic::spreadsheet_text;

use super::csv::table;
use super::{Record, Rubrics, StudentSubmission};

/// The result of a student in one assignment.
#[derive(Debug, Clone)]
struct Cell {
    /// The points; `None` without a rubric.
    points: Option<f64>,
    verdict: toyproof_verify::Verdict,
    late: String,
    /// The reason of a teacher's decision; empty without one.
    decision: String,
}

/// The table of a class.
#[derive(Debug, Default)]
pub struct ClassTable {
    /// The assignments, in the order in which they appeared.
    assignments: Vec<String>,
    /// The cells of the students, by name and number, and then by the place of the assignment.
    students: BTreeMap<(String, Option<String>), BTreeMap<usize, Cell>>,
}

impl ClassTable {
    /// Creates the table of all submissions of assignments.
    #[must_use]
    pub fn new(records: &[Record], rubrics: &Rubrics) -> Self {
        let mut table = Self::default();
        for record in records {
            table.add(record, rubrics);
        }
        table
    }

    /// Adds a shader, if it is a submission of an assignment. If a student has several shaders, the one with
    /// the fewest points counts, and else the one with the worst verdict.
    fn add(&mut self, record: &Record, rubrics: &Rubrics) {
        let Some(StudentSubmission {
            assignment: Some(assignment),
            student,
            id,
            late,
        }) = &record.submitted
        else {
            return;
        };
        let known = self.assignments.iter().position(|name| name == assignment);
        let place = known.unwrap_or_else(|| {
            self.assignments.push(assignment.clone());
            self.assignments.len() - 1
        });
        let cell = Cell {
            points: rubrics.total(record).map(|[points, _]| points),
            verdict: record.verdict,
            late: late.map(|late| late.to_string()).unwrap_or_default(),
            decision: record.decision.as_ref().map_or_else(String::new, |decision| {
                format!("{}; the check: {}", decision.reason, decision.checked_verdict)
            }),
        };
        let cells = self.students.entry((student.clone(), id.clone())).or_default();
        let other = cells.get(&place);
        let counts = other.is_none_or(|other| match cell.points.partial_cmp(&other.points) {
            Some(std::cmp::Ordering::Equal) | None => cell.verdict < other.verdict,
            Some(order) => order.is_lt(),
        });
        if counts {
            cells.insert(place, cell);
        }
    }

    /// Writes the table; its first row names the columns. An assignment without a rubric has the verdict
    /// instead of points, and one on whose shaders a teacher decided has a column for the reasons.
    ///
    /// # Errors
    /// The table cannot be written.
    pub fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut columns = vec!["student".to_owned(), "id".to_owned()];
        columns.extend(self.assignments.iter().map(|name| spreadsheet_text(name)));
        columns.push("total".to_owned());
        for assignment in &self.assignments {
            columns.extend(["verdict", "late"].map(|what| spreadsheet_text(&format!("{assignment} {what}"))));
        }
        let is_decided = |place: &usize| {
            let mut cells = self.students.values().filter_map(|cells| cells.get(place));
            cells.any(|cell| !cell.decision.is_empty())
        };
        let decided: Vec<usize> = (0..self.assignments.len()).filter(is_decided).collect();
        let reasons = decided
            .iter()
            .map(|&place| format!("{} decision", self.assignments[place]));
        columns.extend(reasons.map(|name| spreadsheet_text(&name)));
        let mut table = table(out);
        table.write_record(columns)?;
        for ((name, id), cells) in &self.students {
            let mut row = vec![
                spreadsheet_text(name),
                spreadsheet_text(id.as_deref().unwrap_or_default()),
            ];
            let cells: Vec<_> = (0..self.assignments.len())
                .map(|place| cells.get(&place))
                .collect();
            row.extend(cells.iter().map(|cell| match cell {
                None => String::new(),
                Some(Cell { points, verdict, .. }) => match points {
                    Some(points) => points.to_string(),
                    None => verdict.to_string(),
                },
            }));
            let points: Vec<f64> = cells.iter().flatten().filter_map(|cell| cell.points).collect();
            row.push(match &points[..] {
                [] => String::new(),
                points => ((100.0 * points.iter().sum::<f64>()).round() / 100.0).to_string(),
            });
            for cell in &cells {
                let verdict = cell.map(|cell| cell.verdict.to_string());
                row.push(verdict.unwrap_or_default());
                row.push(cell.map(|cell| cell.late.clone()).unwrap_or_default());
            }
            let reasons = decided
                .iter()
                .map(|&place| cells[place].map_or("", |cell| &cell.decision));
            row.extend(reasons.map(spreadsheet_text));
            table.write_record(row)?;
        }
        table.flush()
    }
}

#[cfg(test)]
mod tests {
    use toyproof_verify::Verdict;

    use super::*;
    use crate::record::samples::{correct, invalid, record};
    use crate::{Decision, Late, Rubric, written};

    fn submitted(record: Record, assignment: &str, student: &str, late: Option<u64>) -> Record {
        Record {
            submitted: Some(StudentSubmission {
                assignment: Some(assignment.to_owned()),
                student: student.to_owned(),
                id: Some("7".to_owned()),
                late: late.map(|seconds| Late {
                    seconds: Some(seconds),
                }),
            }),
            ..record
        }
    }

    #[test]
    fn each_student_has_a_row_and_each_assignment_a_column() {
        let mut rubrics = Rubrics::default();
        rubrics.add("one".to_owned(), Rubric::with_points(2.0, 6.0, 2.0));
        let records = vec![
            submitted(correct(), "one", "=Anna", Some(60)),
            submitted(correct(), "one", "Bo", None),
            submitted(invalid(), "one", "Bo", None),
            submitted(correct(), "two, three", "Bo", None),
            submitted(record(Verdict::Wrong), "two, three", "Bo", None),
            correct(),
        ];
        let table = ClassTable::new(&records, &rubrics);
        assert_eq!(
            written(|out| table.csv(out)),
            "student,id,one,\"two, three\",total,one verdict,one late,\"two, three verdict\",\"two, three late\"\r\n\
             '=Anna,7,10,,10,correct,late by 1 min,,\r\n\
             Bo,7,0,wrong,0,invalid,,wrong,\r\n"
        );
    }

    #[test]
    fn decisions_have_a_column_where_there_are_some() {
        let decision = Decision {
            verdict: Some(Verdict::Correct),
            points: None,
            reason: "=as announced".to_owned(),
        };
        let records = [
            submitted(correct(), "one", "Anna", None),
            submitted(record(Verdict::Wrong), "two", "Anna", None).with_decision(&decision),
        ];
        let table = ClassTable::new(&records, &Rubrics::default());
        assert_eq!(
            written(|out| table.csv(out)),
            "student,id,one,two,total,one verdict,one late,two verdict,two late,two decision\r\n\
             Anna,7,correct,correct,,correct,,correct,,'=as announced; the check: wrong\r\n"
        );
    }
}
