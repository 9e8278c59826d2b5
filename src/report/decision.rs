//! A teacher's decision on a shader, which replaces the verdict of the check, its points or both.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::plural;
use toyproof_verify::Verdict;

use super::{Hints, Record};

/// A teacher's decision on a shader.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// The verdict; `None` if that of the check stands.
    pub verdict: Option<Verdict>,
    /// The points; `None` if they follow from the verdict.
    pub points: Option<f64>,
    /// The reason, for the author of the shader.
    pub reason: String,
}

/// A decision, and what it replaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DecisionRecord {
    /// The decided verdict; null if that of the check stands.
    pub verdict: Option<Verdict>,
    /// The decided points; null if they follow from the verdict.
    pub points: Option<f64>,
    /// The teacher's reason.
    pub reason: String,
    /// The verdict of the check.
    pub checked_verdict: Verdict,
    /// The reason of the check's verdict.
    pub checked_reason: String,
}

impl Record {
    /// Returns the record with a decision: the verdict, the points, and a reason that states both verdicts. A
    /// shader that is decided to be right has no mistake and no fix.
    #[must_use]
    pub fn with_decision(self, decision: &Decision) -> Self {
        let Decision {
            verdict,
            points,
            reason,
        } = decision;
        let mut record = match verdict {
            Some(verdict) if verdict.is_good() => Self {
                help: None,
                ..self.redacted(Hints::None)
            },
            _ => self,
        };
        let (checked_verdict, checked_reason) = (record.verdict, record.reason);
        record.verdict = verdict.unwrap_or(checked_verdict);
        record.reason = match (verdict, points) {
            (None, Some(points)) => {
                let noun = plural(if *points == 1.0 { 1 } else { 2 }, "point", "points");
                format!("{checked_reason}; {points} {noun} decided by the teacher: {reason}")
            }
            _ => format!(
                "decided by the teacher: {reason}; the verdict of the check was {checked_verdict}: \
                 {checked_reason}"
            ),
        };
        record.decision = Some(DecisionRecord {
            verdict: *verdict,
            points: *points,
            reason: reason.clone(),
            checked_verdict,
            checked_reason,
        });
        record
    }

    /// The verdict that a teacher decided instead of that of the check, if any.
    pub(super) fn decided_verdict(&self) -> Option<Verdict> {
        self.decision.as_ref()?.verdict
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::samples::repaired;
    use crate::{FunctionRecord, Report, Rubric, Rubrics, csv, junit, sarif, written};

    fn decided(verdict: Option<Verdict>, points: Option<f64>) -> Record {
        repaired().with_decision(&Decision {
            verdict,
            points,
            reason: "the sheet <was> wrong".to_owned(),
        })
    }

    #[test]
    fn every_format_has_the_decided_verdict_the_original_one_and_the_reason() {
        let rubrics = Rubrics::from(Some(Rubric::with_points(1.0, 8.0, 1.0)));
        let report = Report::new(None, vec![decided(Some(Verdict::Correct), Some(7.5))]);
        let records = report.shaders();
        let table = written(|out| csv(records, &rubrics, out));
        assert!(
            table.contains(",correct,decided by the teacher: the sheet <was> wrong"),
            "{table}"
        );
        assert!(table.contains(",7.5,10,"), "{table}");
        assert!(table.ends_with(",wrong,the sheet <was> wrong\r\n"), "{table}");
        let tests = written(|out| junit(records, Hints::Fix, out));
        assert!(
            tests.contains("failures=\"0\"") && tests.contains("sheet &lt;was&gt; wrong"),
            "{tests}"
        );
        let json = written(|out| report.json(out));
        assert!(json.contains("\"checked_verdict\": \"wrong\""), "{json}");
        assert!(!json.contains("b - c"), "a right shader needs no fix: {json}");
        assert!(!written(|out| sarif(records, out)).contains("\"ruleId\": \"wrong\""));
    }

    #[test]
    fn a_verdict_gives_the_points_of_the_checks_and_points_are_final() {
        let rubrics = Rubrics::from(Some(Rubric::with_points(1.0, 8.0, 1.0)));
        for (verdict, points, expected) in [
            (None, None, 1.0),
            (Some(Verdict::Correct), None, 10.0),
            (Some(Verdict::Unstable), None, 9.0),
            (Some(Verdict::Wrong), None, 1.0),
            (Some(Verdict::Invalid), None, 0.0),
            (Some(Verdict::Correct), Some(4.0), 4.0),
            (None, Some(12.0), 12.0),
        ] {
            let total = rubrics.total(&decided(verdict, points));
            assert_eq!(total, Some([expected, 10.0]), "{verdict:?} {points:?}");
        }
    }

    #[test]
    fn points_leave_the_verdict_as_it_is() {
        let record = decided(None, Some(1.0));
        assert_eq!(record.verdict, Verdict::Wrong);
        assert!(record.fix.is_some() && !record.is_passed());
        assert_eq!(
            record.reason,
            "it is wrong; 1 point decided by the teacher: the sheet <was> wrong"
        );
    }

    #[test]
    fn a_decided_verdict_counts_whatever_the_functions_return() {
        let mut record = decided(Some(Verdict::Correct), None);
        record.functions = vec![FunctionRecord::untested("f", 1.0, "it is missing")];
        assert!(record.is_passed());
        record.decision = None;
        assert!(!record.is_passed());
    }
}
