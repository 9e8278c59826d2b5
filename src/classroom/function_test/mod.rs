//! Tests of single functions: a function is called, in float32 and in double precision, and its results are
//! compared with expected ones, or must have a property for all sampled arguments.
//!
//! ```
//! use std::time::Duration;
//!
//! use toyproof_classroom::function_test::{Precision, Subject, comment_tests};
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_glsl::{Options, check};
//!
//! let text = "// @test disk(vec2(3.0, 0.0)) == 2.0\n\
//!             // @test disk(p) == disk(-p) for p in [-2, 2]\n\
//!             float disk(vec2 p) { return length(p) - 1.0; }\n\
//!             void mainImage(out vec4 c, in vec2 p) { c = vec4(disk(p)); }\n";
//! let mut files = Files::default();
//! let file = files.add(File::new("disk.glsl", text));
//! let checked = check(&files, file, &Options::default()).unwrap();
//! let timeout = Duration::from_secs(10);
//! let subject = Subject { checked: &checked, files: &files, text, timeout };
//! for test in comment_tests(&subject).unwrap() {
//!     assert!(test.results(&subject, Precision::Both).iter().all(|result| result.is_passed()));
//! }
//! ```
//!
//! # Parts
//!
//! - `assertion`: the grammar of a test in one line, such as `|normalAt(p)| == 1 for p in [-2, 2]`, and its
//!   `tokens`.
//! - `file`: the TOML of tests, of test files and of assignments; `comment`: the tests in a shader's comments.
//! - `listed`: the listed calls of a function; `typed`: the types of an assertion; `sampled`: its values, for
//!   all samples of its variables.
//! - `evaluation`: evaluates a generated `mainImage` after the shader; `source`: maps its places to those of
//!   the author.
//! - `value`: values of any type as components, and how they are compared.
//! - `report`: the results as JSON and JUnit.

mod assertion;
mod comment;
mod evaluation;
mod file;
mod listed;
mod report;
mod sampled;
mod source;
mod tokens;
mod typed;
mod value;

use std::time::Duration;

use toyproof_diagnostic::{Deadline, Diagnostic, Files, Span};
use toyproof_glsl::tree::Function;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_report::FunctionRecord;
use toyproof_stress::function::{RoleMap, Signature, test_typical};
use toyproof_toml::Literal;

pub use self::assertion::Assertion;
pub use self::comment::comment_tests;
pub use self::file::{SUFFIX, TestFile, is_test_file};
pub(crate) use self::file::{function, is_identifier, reject_second};
pub(crate) use self::listed::Call;
pub use self::report::{RunRecord, ShaderTests, TestRecord, TestReport};
pub use self::source::Snippet;
pub(crate) use self::value::{literal_text, parts};

/// The largest difference of a component of floats, unless a test states another: expected results are
/// written with a few digits.
pub const DEFAULT_TOLERANCE: f64 = 1e-4;

/// The largest number of tests in the comments of one shader, and of listed calls of one function.
pub const MAX_TESTS: usize = 256;

/// The tests of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionTest {
    /// The function's name.
    pub name: String,
    /// The points for a function that passes all tests, ≥ 0.
    pub points: f64,
    /// The precision of the evaluation; `None` for that of the command.
    pub precision: Option<Precision>,
    /// What is evaluated before each call, such as `makeScene()`.
    pub after: Option<Snippet>,
    /// The calls of the function.
    pub cases: FunctionCases,
}

/// The number types in which a function is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Float32.
    Single,
    /// Double precision.
    Double,
    /// One after the other.
    Both,
}

/// The calls of a test.
#[derive(Debug, Clone, PartialEq)]
pub enum FunctionCases {
    /// Calls and assertions, at least one of both.
    Written {
        /// Calls with given arguments.
        listed: Vec<ListedCall>,
        /// Comparisons of expressions.
        assertions: Vec<Assertion>,
    },
    /// The rays and spheres of [`toyproof_stress`] of typical size, for a function that
    /// intersects a ray with a sphere, whatever its signature.
    Stress,
}

/// A call of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedCall {
    /// Where it is written.
    pub at: Option<Span>,
    /// The values of the parameters that are not `out`. Lists represent vectors, matrices, arrays and
    /// structures.
    pub arguments: Vec<Literal>,
    /// The expected result, if it is compared.
    pub result: Option<Literal>,
    /// The expected values of the `out` and `inout` parameters, if they are compared.
    pub outputs: Option<Vec<Literal>>,
    /// The largest difference of a component from the expected value, relative to values above 1; by
    /// default [`DEFAULT_TOLERANCE`] for floats, and 0 for integers.
    pub tolerance: Option<f64>,
}

/// A shader whose functions are tested.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The files of the shader.
    pub files: &'a Files,
    /// The text of the shader.
    pub text: &'a str,
    /// The time limit of a test.
    pub timeout: Duration,
}

impl Subject<'_> {
    fn options(&self) -> glsl::Options {
        glsl::Options {
            deadline: Deadline::after(self.timeout),
            ..self.checked.options()
        }
    }

    /// The definitions of all functions of that name.
    fn functions<'s>(&'s self, name: &'s str) -> impl Iterator<Item = &'s Function> {
        let functions = self.checked.tree.functions.iter().map(|(_, function)| function);
        functions.filter(move |function| function.name == name && function.body.is_some())
    }
}

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

impl FunctionTest {
    /// The record of a shader that does not compile.
    #[must_use]
    pub fn untested(&self) -> FunctionRecord {
        FunctionRecord::untested(&self.name, self.points, "the shader does not compile")
    }

    /// Tests the function of a shader for marks, by default in double precision.
    #[must_use]
    pub fn run(&self, subject: &Subject) -> FunctionRecord {
        let at = subject.functions(&self.name).next();
        let results = self.results(subject, Precision::Double);
        let record = match results.iter().find_map(|result| result.runs.as_ref().err()) {
            Some(error) => FunctionRecord::untested(&self.name, self.points, error.message()),
            None => self.record(&results),
        };
        FunctionRecord {
            at: at.map(|function| subject.files.position(function.at.span).into()),
            ..record
        }
    }

    /// The results of all tests of the function of a shader; `precision` is the default.
    #[must_use]
    pub fn results(&self, subject: &Subject, precision: Precision) -> Vec<TestResult> {
        let precision = self.precision.unwrap_or(precision);
        match &self.cases {
            FunctionCases::Stress => vec![TestResult {
                name: format!("{}: rays and spheres of typical size", self.name),
                at: None,
                runs: self.run_typical(subject).map_err(TestError::Shader),
            }],
            FunctionCases::Written { listed, assertions } => {
                let mut results = listed::results(self, listed, subject, precision);
                let asserted = assertions.iter();
                results.extend(asserted.map(|assertion| TestResult {
                    name: assertion.text().to_owned(),
                    at: Some(assertion.at()),
                    runs: self.check(assertion, subject, precision),
                }));
                results
            }
        }
    }

    fn check(
        &self,
        assertion: &Assertion,
        subject: &Subject,
        precision: Precision,
    ) -> Result<Vec<Run>, TestError> {
        if !self.name.is_empty() && subject.functions(&self.name).next().is_none() {
            return Err(TestError::Shader(format!("there is no function `{}`", self.name)));
        }
        sampled::check(assertion, self.after.as_ref(), subject, precision)
    }

    /// Tests a function that intersects a ray with a sphere.
    fn run_typical(&self, subject: &Subject) -> Result<Vec<Run>, String> {
        let signature = Signature::recognize(subject.checked, &self.name, &RoleMap::new());
        let signature = signature.map_err(|why| why.to_string())?;
        let tested = test_typical(subject.text, &signature, &subject.options(), subject.timeout);
        let tested = tested.map_err(|error| evaluation::not_run(&error))?;
        let wrong = tested.cases - tested.right;
        let message = match tested.mistake {
            _ if wrong == 0 => String::new(),
            Some(mistake) => format!("it {}", mistake.description),
            None => "none of the known mistakes explains it".to_owned(),
        };
        Ok(vec![Run {
            is_single: false,
            samples: tested.cases,
            wrong,
            message,
        }])
    }

    /// The record of tests that were all evaluated: each is one case, except that the rays of
    /// [`FunctionCases::Stress`] are counted.
    fn record(&self, results: &[TestResult]) -> FunctionRecord {
        let (cases, right) = match (&self.cases, results) {
            (FunctionCases::Stress, [TestResult { runs: Ok(runs), .. }]) => (
                runs.iter().map(|run| run.samples).sum(),
                runs.iter().map(|run| run.samples - run.wrong).sum(),
            ),
            _ => (
                results.len() as u64,
                results.iter().filter(|result| result.is_passed()).count() as u64,
            ),
        };
        let wrong = results.iter().find(|result| !result.is_passed());
        FunctionRecord {
            name: self.name.clone(),
            points: self.points,
            passed: right == cases,
            cases,
            right,
            message: wrong.map_or_else(String::new, TestResult::message),
            at: None,
        }
    }
}
