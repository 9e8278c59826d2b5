//! `results.json`: marks in the format of Gradescope's autograder.
//!
//! Students see the `output`s; names are the rubric's own keys. All texts are sent as plain text, so that
//! nothing in a shader is read as HTML.

use serde::Serialize;

use super::{Record, Rubric, plain, summary};
use crate::report::rubric::Visibility;

/// The output format: <https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format>
#[derive(Serialize)]
struct Results {
    output: String,
    output_format: Format,
    visibility: Visibility,
    stdout_visibility: Visibility,
    /// In seconds.
    execution_time: u64,
    /// Replaces the sum of the tests' scores.
    #[serde(skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    tests: Vec<Test>,
}

#[derive(Serialize)]
struct Test {
    name: String,
    name_format: Format,
    score: f64,
    max_score: f64,
    status: Status,
    output: String,
    output_format: Format,
}

#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Format {
    Text,
}

#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    Passed,
    Failed,
}

/// Formats the file: a test per mark of the rubric; for several shaders, each name starts with the shader's,
/// and the one with the fewest points gives the score.
#[must_use]
pub fn gradescope(records: &[Record], rubric: &Rubric) -> String {
    let tests = records.iter().flat_map(|record| {
        let marks = rubric.marks(record).into_iter();
        marks.map(move |mark| Test {
            name: match records {
                [_] => mark.name.into_owned(),
                _ => format!("{}: {}", record.shader, mark.name),
            },
            name_format: Format::Text,
            score: mark.points,
            max_score: mark.of,
            status: if mark.points == mark.of {
                Status::Passed
            } else {
                Status::Failed
            },
            output: mark.why,
            output_format: Format::Text,
        })
    });
    let results = Results {
        output: match records {
            [one] => format!("{}: {}", one.verdict, one.reason),
            several => format!(
                "{}\nSeveral shaders were submitted; the one with the fewest points counts.",
                plain(&summary(several))
            ),
        },
        output_format: Format::Text,
        visibility: rubric.visibility,
        stdout_visibility: Visibility::Hidden,
        execution_time: records
            .iter()
            .map(|record| record.seconds.total())
            .sum::<f64>()
            .ceil() as u64,
        score: lowest_score(records, rubric),
        tests: tests.collect(),
    };
    // Strings and finite numbers always serialize.
    serde_json::to_string_pretty(&results).unwrap_or_default() + "\n"
}

/// The fewest points of several shaders; none for one.
fn lowest_score(records: &[Record], rubric: &Rubric) -> Option<f64> {
    let points = |record: &Record| rubric.marks(record).iter().map(|mark| mark.points).sum();
    let scores = records.iter().map(points).filter(|_| records.len() > 1);
    scores.reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::report::record::samples::{correct, every_verdict, invalid};

    /// The documented schema, without additional properties.
    fn schema() -> Value {
        let visibility = json!({ "enum": ["hidden", "after_due_date", "after_published", "visible"] });
        let format = json!({ "enum": ["text", "html", "simple_format", "md", "ansi"] });
        json!({
            "type": "object",
            "additionalProperties": false,
            "required": ["tests"],
            "properties": {
                "score": { "type": "number" },
                "execution_time": { "type": "number", "minimum": 0 },
                "output": { "type": "string" },
                "output_format": format,
                "test_output_format": format,
                "test_name_format": format,
                "visibility": visibility,
                "stdout_visibility": visibility,
                "extra_data": { "type": "object" },
                "tests": { "type": "array", "items": {
                    "type": "object",
                    "additionalProperties": false,
                    "required": ["score", "max_score", "name", "output"],
                    "properties": {
                        "score": { "type": "number" },
                        "max_score": { "type": "number" },
                        "status": { "enum": ["passed", "failed"] },
                        "name": { "type": "string" },
                        "name_format": format,
                        "number": { "type": "string" },
                        "output": { "type": "string" },
                        "output_format": format,
                        "tags": { "type": "array", "items": { "type": "string" } },
                        "visibility": visibility,
                        "extra_data": { "type": "object" },
                    },
                } },
            },
        })
    }

    fn read(records: &[Record]) -> Value {
        serde_json::from_str(&gradescope(records, &Rubric::of(2.0, 6.0, 2.0))).unwrap()
    }

    #[test]
    fn the_file_follows_the_documented_schema() {
        let validator = jsonschema::validator_for(&schema()).unwrap();
        let mut json = read(&every_verdict());
        let errors: Vec<_> = validator
            .iter_errors(&json)
            .map(|error| error.to_string())
            .collect();
        assert!(errors.is_empty(), "{errors:?}");
        assert_eq!(json["tests"].as_array().unwrap().len(), 3 * 9);
        json["tests"][0]["points"] = 1.into();
        assert!(!validator.is_valid(&json));
    }

    #[test]
    fn a_submission_gets_its_points_and_reasons() {
        let json = read(&[correct()]);
        let test = &json["tests"][1];
        assert_eq!(
            (&test["name"], &test["score"], &test["max_score"], &test["status"]),
            (&json!("algorithm"), &json!(6.0), &json!(6.0), &json!("passed"))
        );
        assert_eq!(
            (&json["execution_time"], &json["score"]),
            (&json!(2), &Value::Null)
        );
        assert_eq!(read(&[correct(), invalid()])["score"], 0.0);
        let mut hostile = invalid();
        hostile.diagnostics[0].message = "<script>".to_owned();
        let json = read(&[hostile]);
        let test = &json["tests"][0];
        assert_eq!((&test["score"], &test["status"]), (&json!(0.0), &json!("failed")));
        assert_eq!(test["output_format"], "text");
        let output = test["output"].as_str().unwrap();
        assert!(output.contains("a.glsl:2:3: error[E0301]: <script>"), "{output}");
    }
}
