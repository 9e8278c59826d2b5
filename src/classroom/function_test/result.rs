//! The result of a test, or the reason why there is none.

use toyproof_diagnostic::{Diagnostic, Span};

/// The result of one test.
#[derive(Debug, Clone)]
pub struct TestResult {
    /// The test as it is written, or the call.
    pub name: String,
    /// Where it is written.
    pub at: Option<Span>,
    /// The evaluations, or the reason why there are none.
    pub runs: Result<Vec<Run>, TestError>,
}

/// The evaluation of a test in one number type.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Whether the number type is f32; else it is f64.
    pub is_single: bool,
    /// The number of calls with different values.
    pub samples: u64,
    /// The number of wrong ones.
    pub wrong: u64,
    /// The first wrong result in one sentence; empty if there is none.
    pub message: String,
}

/// The reason why a test has no result.
#[derive(Debug, Clone)]
pub enum TestError {
    /// The shader's fault: the function is missing, has another signature, or does not end.
    Shader(String),
    /// The test is invalid, or does not fit the shader.
    Test(Vec<Diagnostic>),
}

impl TestError {
    /// The reason in one sentence.
    #[must_use]
    pub fn message(&self) -> String {
        match self {
            Self::Shader(message) => message.clone(),
            Self::Test(diagnostics) => diagnostics
                .first()
                .map_or_else(String::new, |first| first.message.clone()),
        }
    }
}

impl TestResult {
    /// Whether the test was evaluated, and no call is wrong.
    #[must_use]
    pub fn is_passed(&self) -> bool {
        let runs = self.runs.as_ref();
        runs.is_ok_and(|runs| runs.iter().all(|run| run.wrong == 0))
    }

    /// The fault in one sentence; empty if there is none. A result that is wrong in both number types is that
    /// of f64.
    #[must_use]
    pub fn message(&self) -> String {
        let runs = match &self.runs {
            Ok(runs) => runs,
            Err(error) => return error.message(),
        };
        let wrong: Vec<_> = runs.iter().filter(|run| run.wrong > 0).collect();
        match wrong[..] {
            [only] if runs.len() > 1 && only.is_single => format!("in float32 only: {}", only.message),
            [only] if runs.len() > 1 => format!("in double precision only: {}", only.message),
            [.., run] => run.message.clone(),
            [] => String::new(),
        }
    }
}
