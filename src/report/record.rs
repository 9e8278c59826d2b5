//! The report as programs read it: `verdict.json`, and `--format json` on standard output.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic as diagnostic;
use toyproof_verify::compare::{Answer, Comparison, Verdict};
use toyproof_verify::mistake::Named;

/// The JSON Schema of a [`Report`].
pub const SCHEMA: &str = include_str!("verdict.schema.json");

/// All shaders of one run.
#[derive(Debug, Serialize)]
pub struct Report {
    version: u32,
    tool: String,
    /// Adapter and driver; null if nothing ran.
    device: Option<String>,
    shaders: Vec<Record>,
}

impl Report {
    /// A report of these shaders, in their order.
    #[must_use]
    pub fn new(device: Option<String>, shaders: Vec<Record>) -> Self {
        Self {
            version: 1,
            tool: format!("toyproof {}", env!("CARGO_PKG_VERSION")),
            device,
            shaders,
        }
    }

    /// Adapter and driver; none if nothing ran on any.
    pub(super) fn device(&self) -> Option<&str> {
        self.device.as_deref()
    }

    /// The shaders' records.
    #[must_use]
    pub fn shaders(&self) -> &[Record] {
        &self.shaders
    }

    /// The report as the text of `verdict.json`.
    #[must_use]
    pub fn json(&self) -> String {
        // Strings, numbers and options always serialise; serde_json writes infinite floats as null.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// What was found of one shader. Questions that were not asked are null.
#[derive(Debug, Serialize, Deserialize)]
pub struct Record {
    /// Its name, as the user gave it.
    pub shader: String,
    /// The scene's, if there is one.
    pub scene: Option<String>,
    /// The verdict.
    pub verdict: Verdict,
    /// Why, in one sentence.
    pub reason: String,
    /// The shader in f64 against the scene; null without a scene.
    pub maths: Option<Answer>,
    /// The picture in f32 against the shader in f64.
    pub rounding: Option<Answer>,
    /// The GPU's picture against the CPU's, in bits; null where no GPU painted, or it was free to do algebra.
    pub toolchain: Option<Answer>,
    /// The picture beside the reference's; null without a scene or a picture.
    pub picture: Option<Comparison>,
    /// The classic mistake, or the two, that explain a wrong picture; null if none does.
    pub mistake: Option<Mistake>,
    /// What was said of the shader and its scene.
    pub diagnostics: Vec<diagnostic::Json>,
    /// How long it took.
    pub seconds: Seconds,
}

impl Record {
    /// Of a shader of which nothing but the verdict is known.
    #[must_use]
    pub fn new(shader: String, verdict: Verdict) -> Self {
        Self {
            shader,
            scene: None,
            verdict,
            reason: String::new(),
            maths: None,
            rounding: None,
            toolchain: None,
            picture: None,
            mistake: None,
            diagnostics: Vec::new(),
            seconds: Seconds::default(),
        }
    }

    /// Why the toolchain question was not asked where others were.
    pub(super) fn toolchain_unasked(&self) -> Option<&'static str> {
        let others = self.maths.is_some() || self.rounding.is_some();
        (others && self.toolchain.is_none()).then_some(if self.seconds.gpu.is_some() {
            "since the driver was free to rearrange arithmetic"
        } else {
            "since the shader ran on the CPU and on no GPU"
        })
    }
}

/// What explains a wrong picture.
#[derive(Debug, Serialize, Deserialize)]
pub struct Mistake {
    /// Its name, as `far-root`; of two that were made at once, both: `no-aspect+gamma`.
    pub id: String,
    /// What it means, in a sentence.
    pub says: String,
}

impl Mistake {
    /// Of the mistakes that were recognised.
    #[must_use]
    pub fn new(named: &[Named]) -> Self {
        let (ids, says): (Vec<_>, Vec<_>) = named
            .iter()
            .map(|mistake| (mistake.name, mistake.says.as_ref()))
            .unzip();
        Self {
            id: ids.join("+"),
            says: format!(
                "the picture is what a tracer paints that {}",
                says.join(", and that ")
            ),
        }
    }
}

/// Times in seconds; null for what was not done.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Seconds {
    /// naga: parse, validate, write.
    pub translate: Option<f64>,
    /// The driver: compile, paint, read back.
    pub gpu: Option<f64>,
    /// The evaluator: preparing, and every picture in f32 and f64.
    pub eval: Option<f64>,
    /// The reference tracer.
    pub trace: Option<f64>,
}

impl Seconds {
    /// All of it. Some of it was at once.
    #[must_use]
    pub fn total(&self) -> f64 {
        let parts = [self.translate, self.gpu, self.eval, self.trace];
        // A sum of nothing is −0.
        parts.into_iter().flatten().fold(0.0, |sum, part| sum + part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::{every_verdict, record};

    #[test]
    fn reports_follow_the_schema_and_other_things_do_not() {
        let schema = serde_json::from_str(SCHEMA).unwrap();
        let validator = jsonschema::validator_for(&schema).unwrap();
        let black = toyproof_image::Image::new(1, 1, vec![[0.0; 4]]);
        let white = toyproof_image::Image::new(1, 1, vec![[1.0; 4]]);
        let (comparison, _) = toyproof_verify::compare::compare(&black, &white);
        let answer = Answer::new(&black, &white, &[toyproof_verify::compare::Standing::Differs]);
        let asked = Record {
            maths: Some(answer.clone()),
            rounding: Some(answer.clone()),
            toolchain: Some(answer),
            picture: Some(comparison),
            ..record(Verdict::Ok)
        };
        let mut records = every_verdict();
        records.push(asked);
        let report = Report::new(Some("x".to_owned()), records);
        let mut json: serde_json::Value = serde_json::from_str(&report.json()).unwrap();
        assert!(
            validator.is_valid(&json),
            "{:?}",
            validator.iter_errors(&json).collect::<Vec<_>>()
        );
        json["shaders"][0]["verdict"] = "splendid".into();
        assert!(!validator.is_valid(&json));
        json["shaders"][0].as_object_mut().unwrap().remove("verdict");
        assert!(!validator.is_valid(&json));
    }
}
