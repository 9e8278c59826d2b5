//! What is found out about a function: where it fails first, and which mistake explains the failure.

use std::sync::atomic::AtomicBool;

use serde::Serialize;
use toyproof_glsl as glsl;

use super::typical::DirectionLength;
use super::{Example, FunctionRunner, Mistake, Signature, call_shader, mistake};
use crate::axis::Kind;
use crate::formula::{Reading, Subject};
use crate::run::RunError;
use crate::study::{Gpu, Report, Settings, study};

/// The results for a function.
#[derive(Debug, Clone, Serialize)]
pub struct Findings {
    /// The simplest ray with a wrong result in f32.
    pub example: Option<Example>,
    /// The mistake that explains its results for typical rays.
    pub mistake: Option<Mistake>,
    /// Where it fails.
    #[serde(flatten)]
    pub report: Report,
}

impl Findings {
    /// The summary: the mistake, an example, then where the function fails.
    #[must_use]
    pub fn summary(&self, name: &str) -> Vec<String> {
        let mut lines = vec![match (&self.mistake, &self.example) {
            (Some(mistake), _) => format!("{name} {} ({})", mistake.description, mistake.name),
            (None, Some(_)) => {
                format!("{name} makes none of the known mistakes, but fails for extreme input")
            }
            (None, None) => format!("{name} is right for all tested input"),
        }];
        if let Some(example) = &self.example {
            lines.push(format!(
                "for example, simplified from a case with {}:",
                example.found_at
            ));
            lines.extend(example.assignments.iter().map(|line| format!("    {line}")));
            let actual = match example.actual.strip_prefix("t = ") {
                Some(t) if example.expected.starts_with("t = ") => t,
                _ => &example.actual,
            };
            lines.push(format!("  expected {}, got {actual}", example.expected));
        }
        if !self.report.breakdowns.is_empty() {
            lines.push(String::new());
            lines.extend(self.report.function_summary());
        }
        lines
    }
}

/// Tests a function of a shader on all axes, also on a GPU if there is one; calls `done` after each run.
///
/// # Errors
///
/// [`RunError`] if the function cannot be run.
pub fn examine(
    text: &str,
    signature: &Signature,
    options: &glsl::Options,
    gpu: Option<&mut Gpu>,
    settings: Settings,
    interrupt: &AtomicBool,
    done: impl Fn(),
) -> Result<Findings, RunError> {
    let (shader, shader_options) = call_shader(text, signature, options);
    let subject = Subject {
        name: signature.name.clone(),
        kind: Kind::Spheres,
        text: shader,
        in_f64: true,
        reading: Reading::Function(signature.clone()),
        options: shader_options,
    };
    let report = study(&[subject], gpu, settings, interrupt, done)?;
    let runner = FunctionRunner::new(text, signature, options, None)?;
    let convention = runner.miss_convention::<f64>()?;
    let unit = runner.typical_outcomes(DirectionLength::Unit, &convention)?;
    let any = runner.typical_outcomes(DirectionLength::Any, &convention)?;
    Ok(Findings {
        example: runner.example(settings, interrupt)?,
        mistake: mistake::recognize(&unit, &any, &convention, signature),
        report,
    })
}
