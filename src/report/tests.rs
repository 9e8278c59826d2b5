//! Records to try the formats with.

use toyproof_diagnostic::{self as diagnostic, File, Files, Severity};
use toyproof_verify::compare::{Answer, Verdict};

use super::*;

/// A record of that verdict, which is its name too, with nothing asked.
pub(super) fn record(verdict: Verdict) -> Record {
    Record {
        shader: verdict.to_string(),
        scene: Some("scene.toml".to_owned()),
        verdict,
        reason: format!("it is {verdict}"),
        maths: None,
        rounding: None,
        toolchain: None,
        picture: None,
        mistake: None,
        diagnostics: Vec::new(),
        seconds: Seconds {
            gpu: Some(1.0),
            eval: Some(0.5),
            ..Seconds::default()
        },
    }
}

/// An answer over 1,000 pixels: how many differ, are undecided, are undefined.
pub(super) fn question([differing, undecided, undefined]: [u64; 3]) -> Answer {
    Answer {
        pixels: 1000,
        differing,
        undecided,
        undefined,
        tied: 0,
        max_abs: 0.25,
        first: None,
        worst: None,
    }
}

pub(super) fn correct() -> Record {
    Record {
        maths: Some(question([0; 3])),
        rounding: Some(question([0; 3])),
        toolchain: Some(question([0; 3])),
        ..record(Verdict::Correct)
    }
}

pub(super) fn invalid() -> Record {
    let mut record = record(Verdict::Invalid);
    record.diagnostics.push(diagnostic::Json {
        severity: Severity::Error,
        code: "E0301".to_owned(),
        message: "unknown name".to_owned(),
        file: Some("a.glsl".to_owned()),
        line: Some(2),
        column: Some(3),
        notes: vec!["declare it".to_owned()],
    });
    record
}

/// One of each.
pub(super) fn every_verdict() -> Vec<Record> {
    let mut wrong = record(Verdict::Wrong);
    wrong.maths = Some(question([500, 0, 0]));
    let mut unstable = correct();
    (unstable.shader, unstable.verdict) = ("unstable".to_owned(), Verdict::Unstable);
    unstable.rounding = Some(question([500, 0, 0]));
    vec![
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
    /// All or nothing, for `compiles`, `maths` and `rounding`.
    pub(super) fn of(compiles: f64, maths: f64, rounding: f64) -> Self {
        let text = format!(
            "compiles.points = {compiles:?}\nmaths.points = {maths:?}\nrounding.points = {rounding:?}"
        );
        let mut files = Files::default();
        let file = files.add(File::new("r.toml", text));
        Self::parse(&files, file).unwrap()
    }
}
