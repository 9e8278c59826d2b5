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
//! - `test`: the tests of a function; `subject`: the shader; `result`: the result of a test.
//! - `assertion`: the grammar of a test in one line, such as `|normalAt(p)| == 1 for p in [-2, 2]`, and its
//!   `tokens`.
//! - `file`: the TOML of tests, of test files and of assignments; `comment`: the tests in a shader's comments.
//! - `text`: the text of a test file.
//! - `listed`: the listed calls of a function; `typed`: the types of an assertion; `sampled`: its values, for
//!   all samples of its variables.
//! - `evaluation`: evaluates a generated function after the shader; `source`: maps its places to those of
//!   the author.
//! - `value`: values of any type as components, and how they are compared.
//! - `report`: the results as JSON and `JUnit`.

mod assertion;
mod comment;
mod evaluation;
mod file;
mod listed;
mod report;
mod result;
mod sampled;
mod source;
mod subject;
mod test;
mod text;
mod tokens;
mod typed;
mod value;

use toyproof_report::FunctionRecord;
use toyproof_stress::function::{RoleMap, Signature, test_typical};

pub use self::assertion::Assertion;
pub use self::comment::comment_tests;
pub use self::file::{SUFFIX, TestFile, is_test_file};
pub(crate) use self::file::{function_tests, is_identifier};
pub(crate) use self::listed::Call;
pub use self::report::{RunRecord, ShaderTests, TestRecord, TestReport};
pub use self::result::{Run, TestError, TestResult};
pub use self::source::Snippet;
pub use self::subject::Subject;
pub use self::test::{DEFAULT_TOLERANCE, FunctionCases, FunctionTest, ListedCall, MAX_TESTS, Precision};
pub(crate) use self::text::test_file;
pub(crate) use self::value::{literal_text, parts};

impl FunctionTest {
    /// The names in the tests, which may be those of functions.
    pub(crate) fn names(&self) -> Vec<&str> {
        let is_part = |character: char| character.is_ascii_alphanumeric() || character == '_';
        let after = self.after.iter().flat_map(move |after| {
            let words = after.text().split(move |character| !is_part(character));
            words.filter(|word| is_identifier(word))
        });
        let assertions: &[Assertion] = match &self.cases {
            FunctionCases::Written { assertions, .. } => assertions,
            FunctionCases::Stress => &[],
        };
        assertions
            .iter()
            .flat_map(Assertion::names)
            .chain(after)
            .collect()
    }

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
