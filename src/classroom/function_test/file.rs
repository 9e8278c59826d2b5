//! The TOML of tests: the tables `[[function]]` of assignments and of test files.

use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Code, Diagnostics, FileId, Files};
use toyproof_project::files;
use toyproof_report::optional_points;
use toyproof_toml::{Format, Literal, Located, Table};

use super::assertion::Assertion;
use super::source::Snippet;
use super::test::{FunctionCases, FunctionTest, ListedCall, MAX_TESTS, Precision};

/// The end of the name of a test file that lies beside its shader: `disk.test.toml` beside `disk.glsl`.
pub const SUFFIX: &str = ".test.toml";

static FORMAT: Format = Format {
    form_code: Code::TestSyntax,
    value_code: Code::TestValue,
    aliases: &[],
};

/// A file of tests.
#[derive(Debug, Clone)]
pub struct TestFile {
    /// The shader, if the file names one.
    pub shader: Option<PathBuf>,
    /// The tests, at least one.
    pub functions: Vec<FunctionTest>,
}

/// Whether a path has the name of a test file.
#[must_use]
pub fn is_test_file(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase());
    name.is_some_and(|name| name.ends_with(SUFFIX))
}

impl TestFile {
    /// Parses a test file that lies in `folder`.
    ///
    /// # Errors
    /// The first syntax error of the TOML, or all other errors.
    pub fn parse(files: &Files, file: FileId, folder: &Path) -> Result<Self, Diagnostics> {
        toyproof_toml::read(&FORMAT, files, file, |document| {
            let shader = document.optional::<String>("shader").map(|name| {
                let path = folder.join(&name.value);
                let is_project = files::is_project(&path) || files::is_json(&path);
                if !(path.is_file() || is_project) {
                    let found = document.excerpt(name.span);
                    document.reject(
                        name.span,
                        format!("there is no shader {found}"),
                        "the path is relative to the folder of this file",
                    );
                }
                path
            });
            let functions = function_tests(document);
            document.report_unknown_keys();
            if functions.is_empty() && document.is_valid() {
                document.reject(
                    document.span(),
                    "the file has no tests",
                    "add [[function]] with `name` and `tests = [\"f(1.0) == 2.0\"]`",
                );
            }
            Self { shader, functions }
        })
    }
}

/// Reads the tables of functions, one for each.
pub(crate) fn function_tests(document: &mut Table) -> Vec<FunctionTest> {
    let mut functions: Vec<FunctionTest> = Vec::new();
    document.tables("function", |table| {
        let test = function(table);
        if functions.iter().any(|other| other.name == test.name) && table.is_valid() {
            let message = format!("there are two tests of `{}`", test.name);
            table.reject(table.span(), message, "move its cases to the first test");
        }
        functions.push(test);
    });
    functions
}

const EXAMPLE_CASE: &str = "arguments = [[0.0, 0.0, 4.0], 1.5]";

/// Reads the table of a function.
fn function(table: &mut Table) -> FunctionTest {
    let name = table.required::<String>("name");
    if let Some(name) = &name
        && !is_identifier(&name.value)
    {
        table.reject_value("name", name, "must be the name of a function");
    }
    let points = optional_points(table).unwrap_or_default();
    let precisions = [
        ("f32", Precision::Single),
        ("f64", Precision::Double),
        ("both", Precision::Both),
    ];
    let precision = table.choice("precision", "precision", &precisions);
    let after = table
        .optional::<String>("after")
        .map(|after| snippet(table, &after));
    let source = table.choice("cases", "source of cases", &[("stress", ())]);
    let assertions = assertions(table);
    let mut listed = Vec::new();
    table.tables("case", |table| {
        if listed.len() == MAX_TESTS {
            let message = format!("a function has at most {MAX_TESTS} cases");
            table.reject(table.span(), message, "remove this one");
        }
        listed.push(case(table));
    });
    let cases = if let Some(source) = &source {
        if !listed.is_empty() {
            let help = "remove `cases`, or all [[function.case]]";
            table.reject(source.span, "`cases` cannot be used with [[function.case]]", help);
        } else if !assertions.is_empty() {
            let help = "remove one of the two";
            table.reject(source.span, "`cases` cannot be used with `tests`", help);
        }
        FunctionCases::Stress
    } else {
        if listed.is_empty() && assertions.is_empty() && table.is_valid() {
            let help = format!(
                "add `tests = [\"f(1.0) == 2.0\"]`, [[function.case]] with `{EXAMPLE_CASE}` and `result`, or \
                 `cases = \"stress\"`"
            );
            table.reject(table.span(), "the function has no cases", &help);
        }
        FunctionCases::Written { listed, assertions }
    };
    FunctionTest {
        name: name.map_or_else(String::new, |name| name.value),
        points,
        precision: precision.map(|precision| precision.value),
        after,
        cases,
    }
}

/// Whether a text can be the name of a function.
pub(crate) fn is_identifier(name: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    name.chars().all(is_part) && name.starts_with(|c: char| !c.is_ascii_digit())
}

/// The text of a string, with its place.
fn snippet(table: &Table, string: &Located<String>) -> Snippet {
    let mut span = string.span;
    let written = table.excerpt(span);
    let quoted = |quote: char| {
        written
            .strip_prefix(quote)
            .and_then(|rest| rest.strip_suffix(quote))
    };
    let inside = quoted('"').or_else(|| quoted('\''));
    let is_verbatim = inside == Some(string.value.as_str());
    if is_verbatim {
        span.start += 1;
        span.end -= 1;
    }
    Snippet::new(&string.value, span, is_verbatim)
}

/// Reads the tests that are written in one line each.
fn assertions(table: &mut Table) -> Vec<Assertion> {
    let mut assertions = Vec::new();
    for (index, test) in table.strings("tests").into_iter().enumerate() {
        if index == MAX_TESTS {
            let message = format!("a function has at most {MAX_TESTS} tests");
            table.reject(test.span, message, "remove this one");
            break;
        }
        match Assertion::parse(&snippet(table, &test)) {
            Ok(assertion) => assertions.push(assertion),
            Err(error) => table.reject_form(error.at, error.message, &error.help),
        }
    }
    assertions
}

fn case(table: &mut Table) -> ListedCall {
    let arguments = table.required::<Vec<Literal>>("arguments");
    if let Some(arguments) = &arguments
        && !arguments.value.iter().all(is_float)
    {
        table.reject_value(
            "arguments",
            arguments,
            "must have finite numbers that float32 can hold",
        );
    }
    let result = table.optional::<Literal>("result");
    let outputs = table.optional::<Vec<Literal>>("outputs");
    if result.is_none() && outputs.is_none() && table.is_valid() {
        let help = "add `result = 2.5`, or `outputs = [2.5]` for `out` parameters";
        table.reject(
            table.span(),
            "the case has neither a `result` nor `outputs`",
            help,
        );
    }
    let tolerance = table.optional::<f64>("tolerance");
    if let Some(tolerance) = &tolerance
        && !(0.0..f64::INFINITY).contains(&tolerance.value)
    {
        table.reject_value("tolerance", tolerance, "must be finite and at least 0");
    }
    ListedCall {
        at: Some(table.span()),
        arguments: arguments.map_or_else(Vec::new, |arguments| arguments.value),
        result: result.map(|result| result.value),
        outputs: outputs.map(|outputs| outputs.value),
        tolerance: tolerance.map(|tolerance| tolerance.value),
    }
}

fn is_float(literal: &Literal) -> bool {
    match literal {
        Literal::Number { value, .. } => (*value as f32).is_finite(),
        Literal::Boolean(_) => true,
        Literal::List(list) => list.iter().all(is_float),
    }
}
