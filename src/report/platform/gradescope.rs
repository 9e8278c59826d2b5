//! Gradescope: <https://gradescope-autograders.readthedocs.io/en/latest/specs/>
//!
//! Students see the `output`s; names are the rubric's own keys. The texts of tests are plain text. With
//! images, the output of the submission is HTML, in which all texts are escaped.

use std::io::{self, Write};

use serde::Serialize;

use super::{Graded, Kit, Platform, PlatformFile, Task, write_json};
use crate::html::Text;
use crate::rubric::{Mark, Visibility};

pub(super) static PLATFORM: Platform = Platform {
    name: "gradescope",
    advice: "upload it on Gradescope, under Configure Autograder",
    kit: Kit::Folder(""),
    program: None,
    files,
    failure: "{\"output\": \"The autograder failed, so your submission was not graded. Please inform your teacher.\", \
              \"tests\": []}\n",
    results,
};

fn files(_: &Task) -> Vec<PlatformFile> {
    vec![
        PlatformFile::executable("setup.sh", include_str!("gradescope/setup.sh")),
        PlatformFile::executable("run_autograder", include_str!("gradescope/run_autograder.sh")),
    ]
}

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
    Html,
}

#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    Passed,
    Failed,
}

/// Writes `results.json`: a test per mark.
fn results(graded: &Graded, out: &mut dyn Write) -> io::Result<()> {
    let images = graded.images.html();
    let (output, output_format) = if images.is_empty() {
        (graded.text.clone(), Format::Text)
    } else {
        let text = Text(&graded.text).to_string().replace('\n', "<br>");
        (format!("<p>{text}</p>{images}"), Format::Html)
    };
    let [score, _] = graded.score();
    let results = Results {
        output,
        output_format,
        visibility: graded.visibility,
        stdout_visibility: Visibility::Hidden,
        execution_time: graded.seconds.ceil() as u64,
        score: graded.are_several.then_some(score),
        tests: graded.tests.iter().map(Test::new).collect(),
    };
    write_json(&results, out)
}

impl Test {
    fn new(mark: &Mark) -> Self {
        Self {
            name: mark.name.clone().into_owned(),
            name_format: Format::Text,
            score: mark.points,
            max_score: mark.of,
            status: if mark.points == mark.of {
                Status::Passed
            } else {
                Status::Failed
            },
            output: mark.why.clone(),
            output_format: Format::Text,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use serde_json::{Value, json};

    use super::super::tests::results;
    use crate::record::samples::{correct, every_verdict, invalid};
    use crate::{Hints, Record, Thumbnails};

    /// The documented schema, without additional properties.
    pub(in crate::platform) fn schema() -> Value {
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
        with_images(records, &Thumbnails::default())
    }

    fn with_images(records: &[Record], images: &Thumbnails) -> Value {
        serde_json::from_str(&results("gradescope", records, Hints::Fix, images)).unwrap()
    }

    #[test]
    fn every_shader_has_its_tests_and_no_test_has_another_key() {
        let mut json = read(&every_verdict());
        assert_eq!(json["tests"].as_array().unwrap().len(), 3 * 9);
        json["tests"][0]["points"] = 1.into();
        assert!(!jsonschema::validator_for(&schema()).unwrap().is_valid(&json));
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

    #[test]
    fn images_are_shown_in_html_whose_texts_are_escaped() {
        let validator = jsonschema::validator_for(&schema()).unwrap();
        let mut images = Thumbnails::default();
        images.add("a<b>.glsl".to_owned(), vec![("your image", b"png".to_vec())]);
        let mut record = correct();
        record.reason = "<script>".to_owned();
        let json = with_images(&[record], &images);
        assert!(validator.is_valid(&json));
        assert_eq!(json["output_format"], "html");
        let output = json["output"].as_str().unwrap();
        assert!(
            output.starts_with("<p>correct: &lt;script&gt;</p><figure"),
            "{output}"
        );
        assert!(output.contains("src=\"data:image/png;base64,cG5n\""), "{output}");
        assert_eq!(images.bytes(), 3);

        images.add("b.glsl".to_owned(), Vec::new());
        let json = with_images(&[correct(), correct()], &images);
        let output = json["output"].as_str().unwrap();
        assert!(output.contains("<h4>a&lt;b&gt;.glsl</h4>") && !output.contains("b.glsl</h4><h4>"));
        assert!(output.contains("<br>Several shaders"), "{output}");
    }
}
