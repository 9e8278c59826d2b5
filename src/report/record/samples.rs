//! Sample records for the tests of the formats.

use toyproof_diagnostic::{self as diagnostic, Code, File, Files, Severity};
use toyproof_verify::Verdict;
use toyproof_verify::compare::CheckSummary;

use crate::{Record, Rubric, Seconds};

/// A record with this verdict, which is also its name, without checks.
pub(crate) fn record(verdict: Verdict) -> Record {
    Record {
        scene: Some("scene.toml".to_owned()),
        verdict,
        reason: format!("it is {verdict}"),
        seconds: Seconds {
            gpu: Some(1.0),
            eval: Some(0.5),
            ..Seconds::default()
        },
        ..Record::unchecked(verdict.to_string())
    }
}

/// A summary of 1,000 pixels: the numbers that differ, are ill-conditioned and are undefined.
pub(crate) fn check_summary([differing, ill_conditioned, undefined]: [u64; 3]) -> CheckSummary {
    CheckSummary {
        pixels: 1000,
        differing,
        ill_conditioned,
        undefined,
        max_abs: 0.25,
        ..CheckSummary::default()
    }
}

pub(crate) fn correct() -> Record {
    Record {
        algorithm: Some(check_summary([0; 3])),
        precision: Some(check_summary([0; 3])),
        toolchain: Some(check_summary([0; 3])),
        ..record(Verdict::Correct)
    }
}

pub(crate) fn invalid() -> Record {
    let mut record = record(Verdict::Invalid);
    record.diagnostics.push(diagnostic::Json {
        severity: Severity::Error,
        code: Code::Mismatch.to_string(),
        message: "unknown name".to_owned(),
        file: Some("a.glsl".to_owned()),
        line: Some(2),
        column: Some(3),
        end_line: Some(2),
        end_column: Some(7),
        fix: Some(diagnostic::JsonFix {
            message: "did you mean `near`?".to_owned(),
            replacement: "near".to_owned(),
            line: 2,
            column: 3,
            end_line: 2,
            end_column: 7,
        }),
        notes: vec!["declare it".to_owned()],
    });
    record
}

/// One record of each verdict.
pub(crate) fn every_verdict() -> Vec<Record> {
    let mut wrong = record(Verdict::Wrong);
    wrong.algorithm = Some(check_summary([500, 0, 0]));
    let mut unstable = correct();
    (unstable.shader, unstable.verdict) = ("unstable".to_owned(), Verdict::Unstable);
    unstable.precision = Some(check_summary([500, 0, 0]));
    vec![
        record(Verdict::Missing),
        invalid(),
        record(Verdict::Timeout),
        record(Verdict::Error),
        wrong,
        unstable,
        record(Verdict::Inconclusive),
        correct(),
        record(Verdict::Ok),
    ]
}

impl Rubric {
    /// A rubric without partial points for `compiles`, `algorithm` and `precision`.
    pub(crate) fn with_points(compiles: f64, algorithm: f64, precision: f64) -> Self {
        let text = format!(
            "compiles.points = {compiles:?}\nalgorithm.points = {algorithm:?}\nprecision.points = {precision:?}"
        );
        let mut files = Files::default();
        let file = files.add(File::new("r.toml", text));
        Self::parse(&files, file).unwrap()
    }
}
