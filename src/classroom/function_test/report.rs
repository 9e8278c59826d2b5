//! The results of tests as JSON and `JUnit`.

use std::io::{self, Write};

use serde::Serialize;
use toyproof_diagnostic::{Diagnostic, Files, Json, Span, json};
use toyproof_report::{TestCase, TestStatus, test_suite};

use super::result::{Run, TestError, TestResult};

/// The results of all shaders of a command.
#[derive(Debug, Clone, Serialize)]
pub struct TestReport {
    version: u32,
    tool: String,
    shaders: Vec<ShaderTests>,
}

/// The results of a shader.
#[derive(Debug, Clone, Serialize)]
pub struct ShaderTests {
    /// The shader's name.
    pub shader: String,
    /// The tests of the shader.
    pub tests: Vec<TestRecord>,
}

/// The result of a test.
#[derive(Debug, Clone, Serialize)]
pub struct TestRecord {
    /// The function; null if the test calls none of the shader's.
    pub function: Option<String>,
    /// The test as it is written.
    pub test: String,
    /// The file in which it is written.
    pub file: Option<String>,
    /// The line, from 1.
    pub line: Option<usize>,
    /// The column in characters, from 1.
    pub column: Option<usize>,
    /// `passed`; `failed`: a result is wrong, or the shader does not have the function; or `error`: the test
    /// is invalid.
    pub status: &'static str,
    /// The fault in one sentence; empty if there is none.
    pub message: String,
    /// The evaluation in float32; null if there was none.
    pub f32: Option<RunRecord>,
    /// The evaluation in double precision; null if there was none.
    pub f64: Option<RunRecord>,
    /// The errors of an invalid test.
    pub diagnostics: Vec<Json>,
}

/// The evaluation of a test in one number type.
#[derive(Debug, Clone, Serialize)]
pub struct RunRecord {
    /// The number of calls with different values.
    pub samples: u64,
    /// The number of wrong ones.
    pub wrong: u64,
    /// The first wrong result in one sentence; empty if there is none.
    pub message: String,
}

impl From<&Run> for RunRecord {
    fn from(run: &Run) -> Self {
        Self {
            samples: run.samples,
            wrong: run.wrong,
            message: run.message.clone(),
        }
    }
}

impl TestRecord {
    const PASSED: &'static str = "passed";
    const FAILED: &'static str = "failed";
    const ERROR: &'static str = "error";

    /// The record of the test of a function.
    #[must_use]
    pub fn new(function: &str, result: &TestResult, files: &Files) -> Self {
        let runs = result.runs.as_ref();
        let run = |is_single: bool| {
            let mut runs = runs.ok()?.iter();
            runs.find(|run| run.is_single == is_single).map(RunRecord::from)
        };
        let (status, errors) = match &result.runs {
            Ok(_) if result.is_passed() => (Self::PASSED, &[][..]),
            Ok(_) | Err(TestError::Shader(_)) => (Self::FAILED, &[][..]),
            Err(TestError::Test(errors)) => (Self::ERROR, &errors[..]),
        };
        Self {
            function: (!function.is_empty()).then(|| function.to_owned()),
            test: result.name.clone(),
            status,
            message: result.message(),
            f32: run(true),
            f64: run(false),
            diagnostics: errors.iter().map(|error| json(error, files)).collect(),
            ..Self::at(result.at, files)
        }
    }

    /// The record of a shader that does not compile, whose tests are not known.
    #[must_use]
    pub fn invalid(errors: &[Diagnostic], files: &Files) -> Self {
        Self {
            test: "the shader compiles".to_owned(),
            status: Self::FAILED,
            message: errors
                .first()
                .map_or_else(String::new, |first| first.message.clone()),
            diagnostics: errors.iter().map(|error| json(error, files)).collect(),
            ..Self::at(errors.first().and_then(|first| first.span), files)
        }
    }

    /// The record of tests that cannot be read.
    #[must_use]
    pub fn unreadable(errors: &[Diagnostic], files: &Files) -> Self {
        Self {
            test: "tests in comments".to_owned(),
            status: Self::ERROR,
            ..Self::invalid(errors, files)
        }
    }

    fn at(span: Option<Span>, files: &Files) -> Self {
        let position = span.map(|span| files.position(span));
        Self {
            function: None,
            test: String::new(),
            file: span.map(|span| files.name(span).to_owned()),
            line: position.map(|position| position.line),
            column: position.map(|position| position.column),
            status: Self::PASSED,
            message: String::new(),
            f32: None,
            f64: None,
            diagnostics: Vec::new(),
        }
    }

    /// Whether the shader passed the test.
    #[must_use]
    pub fn is_passed(&self) -> bool {
        self.status == Self::PASSED
    }

    /// Whether the test could not be made.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.status == Self::ERROR
    }

    /// The file and the line of the test.
    #[must_use]
    pub fn place(&self) -> String {
        match (&self.file, self.line) {
            (Some(file), Some(line)) => format!("{file}:{line}"),
            _ => String::new(),
        }
    }

    fn case(&self, shader: &str) -> TestCase {
        let status = match self.status {
            Self::PASSED => TestStatus::Passed,
            Self::ERROR => TestStatus::Error,
            _ => TestStatus::Failure,
        };
        let mut details = vec![self.place()];
        for (name, run) in [("float32", &self.f32), ("double precision", &self.f64)] {
            if let Some(run) = run {
                let right = run.samples - run.wrong;
                details.push(format!("{name}: right for {right} of {} values", run.samples));
                details.extend((run.wrong > 0).then(|| run.message.clone()));
            }
        }
        details.extend(self.diagnostics.iter().map(ToString::to_string));
        TestCase {
            name: self.test.clone(),
            class: match &self.function {
                Some(function) => format!("{shader}: {function}"),
                None => shader.to_owned(),
            },
            seconds: 0.0,
            status,
            kind: self.status.to_owned(),
            message: self.message.clone(),
            details: details.join("\n"),
        }
    }
}

impl TestReport {
    /// The version of the format.
    const VERSION: u32 = 1;

    /// The report on these shaders.
    #[must_use]
    pub fn new(shaders: Vec<ShaderTests>) -> Self {
        Self {
            version: Self::VERSION,
            tool: format!("toyproof {}", env!("CARGO_PKG_VERSION")),
            shaders,
        }
    }

    /// The records of all tests.
    pub fn tests(&self) -> impl Iterator<Item = &TestRecord> {
        self.shaders.iter().flat_map(|shader| &shader.tests)
    }

    /// Writes the report as JSON.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn json(&self, out: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *out, self)?;
        out.write_all(b"\n")
    }

    /// Writes the report as `JUnit`: a test case for each test.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn junit(&self, out: &mut dyn Write) -> io::Result<()> {
        let cases = self.shaders.iter().flat_map(|shader| {
            let tests = shader.tests.iter();
            tests.map(|test| test.case(&shader.shader))
        });
        test_suite("toyproof test", &cases.collect::<Vec<_>>(), out)
    }
}
