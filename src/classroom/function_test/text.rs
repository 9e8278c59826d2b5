//! The text of a test file, without the comments and the points of the file that the tests come from.

use std::fmt::Write as _;

use toyproof_toml::Literal;

use super::literal_text;
use super::test::{FunctionCases, FunctionTest, Precision};

/// The text of a test file with these tests, which are evaluated in double precision unless they choose.
#[must_use]
pub(crate) fn test_file(functions: &[FunctionTest]) -> String {
    let tables: Vec<_> = functions.iter().map(table).collect();
    tables.join("\n")
}

fn table(test: &FunctionTest) -> String {
    let precision = match test.precision {
        Some(Precision::Single) => "f32",
        Some(Precision::Both) => "both",
        Some(Precision::Double) | None => "f64",
    };
    let mut table = format!(
        "[[function]]\nname = {}\nprecision = \"{precision}\"\n",
        string(&test.name)
    );
    if let Some(after) = &test.after {
        let _ = writeln!(table, "after = {}", string(after.text()));
    }
    let (listed, assertions) = match &test.cases {
        FunctionCases::Stress => {
            table += "cases = \"stress\"\n";
            return table;
        }
        FunctionCases::Written { listed, assertions } => (listed, assertions),
    };
    if !assertions.is_empty() {
        let tests = assertions.iter();
        let tests: Vec<_> = tests
            .map(|test| format!("    {},", string(test.text())))
            .collect();
        let _ = writeln!(table, "tests = [\n{}\n]", tests.join("\n"));
    }
    let list = |literals: &[Literal]| {
        let texts: Vec<_> = literals.iter().map(literal_text).collect();
        format!("[{}]", texts.join(", "))
    };
    for call in listed {
        let _ = write!(
            table,
            "\n[[function.case]]\narguments = {}\n",
            list(&call.arguments)
        );
        if let Some(result) = &call.result {
            let _ = writeln!(table, "result = {}", literal_text(result));
        }
        if let Some(outputs) = &call.outputs {
            let _ = writeln!(table, "outputs = {}", list(outputs));
        }
        if let Some(tolerance) = call.tolerance {
            let _ = writeln!(table, "tolerance = {tolerance:?}");
        }
    }
    table
}

/// A basic string of TOML, whose escape sequences are those of JSON.
fn string(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use toyproof_diagnostic::{File, Files};

    use super::super::TestFile;
    use super::*;

    fn parse(text: &str) -> Vec<FunctionTest> {
        let mut files = Files::default();
        let file = files.add(File::new("a.test.toml", text));
        TestFile::parse(&files, file, Path::new(""))
            .unwrap_or_else(|errors| panic!("{errors}\n{text}"))
            .functions
    }

    #[test]
    fn the_text_has_all_tests_and_no_comments() {
        let written = "# The solution subtracts the radius.\n[[function]]\nname = \"f\"\npoints = 3\nafter = \"a()\"\n\
                       tests = [\"f(1.0) == 2.0\", 'f(p) in [0, 1] for p in [-2, 2]']\n\
                       [[function.case]]\narguments = [[1, 2.5], true]\nresult = [0.0, 1.0]\ntolerance = 1e-3\n\
                       [[function.case]]\narguments = []\noutputs = [[1, 2], -3]\n\
                       [[function]]\nname = \"hit\"\ncases = \"stress\"\nprecision = \"f32\"\n";
        let text = test_file(&parse(written));
        assert!(!text.contains('#') && !text.contains("points"), "{text}");
        assert_eq!(test_file(&parse(&text)), text);
        for part in [
            "    \"f(p) in [0, 1] for p in [-2, 2]\",\n",
            "arguments = [[1, 2.5], true]\nresult = [0.0, 1.0]\ntolerance = 0.001\n",
            "outputs = [[1, 2], -3]\n",
            "after = \"a()\"\n",
            "cases = \"stress\"\n",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }
}
