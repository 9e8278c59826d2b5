//! `results.json`: marks in the format of Gradescope's autograder.
//!
//! Students see the `output`s; names are the rubric's own keys. The texts of tests are plain text. With
//! images, the output of the submission is HTML, in which all texts are escaped.

use std::fmt::Write as _;
use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use super::html::Text;
use super::{Hints, Mark, Record, Rubric, Tally, plain};
use crate::rubric::Visibility;

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

/// The images that students see next to their marks.
#[derive(Debug, Default)]
pub struct Thumbnails(Vec<ShaderThumbnails>);

/// The images of a shader.
#[derive(Debug, Default)]
struct ShaderThumbnails {
    shader: String,
    /// The images as PNGs, each with its caption.
    images: Vec<(&'static str, Vec<u8>)>,
}

impl Thumbnails {
    /// Adds the images of the next shader, each with its caption, as PNGs.
    pub fn add(&mut self, shader: String, images: Vec<(&'static str, Vec<u8>)>) {
        self.0.push(ShaderThumbnails { shader, images });
    }

    /// The size of all PNGs in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let images = self.0.iter().flat_map(|shader| &shader.images);
        images.map(|(_, png)| png.len()).sum()
    }

    /// Formats the images as HTML without a style sheet or a script.
    fn html(&self) -> String {
        let mut html = String::new();
        for ShaderThumbnails { shader, images } in self.0.iter().filter(|shader| !shader.images.is_empty()) {
            if self.0.len() > 1 {
                let _ = write!(html, "<h4>{}</h4>", Text(shader));
            }
            for (caption, png) in images {
                let data = STANDARD.encode(png);
                let _ = write!(
                    html,
                    "<figure style=\"display: inline-block; margin: 0 1em 1em 0\">\
                     <img alt=\"{caption}\" src=\"data:image/png;base64,{data}\">\
                     <figcaption>{caption}</figcaption></figure>"
                );
            }
        }
        html
    }
}

/// Writes the file, as far as the hints permit: a test per mark of the rubric. For several shaders, each name
/// starts with the shader's, and the one with the fewest points gives the score.
///
/// # Errors
/// The file cannot be written.
pub fn gradescope(
    records: &[Record],
    rubric: &Rubric,
    hints: Hints,
    thumbnails: &Thumbnails,
    out: &mut dyn Write,
) -> io::Result<()> {
    let seconds = records.iter().map(|record| record.seconds.total()).sum::<f64>();
    let points = |record| rubric.marks(record).iter().map(|mark| mark.points).sum::<f64>();
    let score = records.iter().map(points).reduce(f64::min);
    let text = match records {
        [record] => format!("{}: {}", record.verdict, record.reason),
        _ => format!(
            "{}\nSeveral shaders were submitted; the one with the fewest points counts.",
            plain(&Tally::new(records).summary())
        ),
    };
    let tests = records.iter().flat_map(|record| {
        let record = record.clone().redacted(hints);
        let marks = rubric.marks(&record).into_iter();
        marks.map(move |mark| Test::new(mark, (records.len() > 1).then_some(&record.shader)))
    });
    let images = thumbnails.html();
    let (output, output_format) = if images.is_empty() {
        (text, Format::Text)
    } else {
        let text = Text(text).to_string().replace('\n', "<br>");
        (format!("<p>{text}</p>{images}"), Format::Html)
    };
    let results = Results {
        output,
        output_format,
        visibility: rubric.visibility,
        stdout_visibility: Visibility::Hidden,
        execution_time: seconds.ceil() as u64,
        score: score.filter(|_| records.len() > 1),
        tests: tests.collect(),
    };
    serde_json::to_writer_pretty(&mut *out, &results)?;
    out.write_all(b"\n")
}

impl Test {
    /// The test of a mark, named after its shader if there are several.
    fn new(mark: Mark, shader: Option<&String>) -> Self {
        Self {
            name: match shader {
                Some(shader) => format!("{shader}: {}", mark.name),
                None => mark.name.into_owned(),
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
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::record::samples::{correct, every_verdict, invalid};
    use crate::written;

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

    fn read(records: Vec<Record>) -> Value {
        with_images(records, &Thumbnails::default())
    }

    fn with_images(records: Vec<Record>, images: &Thumbnails) -> Value {
        let (records, rubric) = (records, Rubric::with_points(2.0, 6.0, 2.0));
        let text = written(|out| gradescope(&records, &rubric, Hints::Fix, images, out));
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn the_file_follows_the_documented_schema() {
        let validator = jsonschema::validator_for(&schema()).unwrap();
        let mut json = read(every_verdict());
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
        let json = read(vec![correct()]);
        let test = &json["tests"][1];
        assert_eq!(
            (&test["name"], &test["score"], &test["max_score"], &test["status"]),
            (&json!("algorithm"), &json!(6.0), &json!(6.0), &json!("passed"))
        );
        assert_eq!(
            (&json["execution_time"], &json["score"]),
            (&json!(2), &Value::Null)
        );
        assert_eq!(read(vec![correct(), invalid()])["score"], 0.0);
        let mut hostile = invalid();
        hostile.diagnostics[0].message = "<script>".to_owned();
        let json = read(vec![hostile]);
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
        let json = with_images(vec![record], &images);
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
        let json = with_images(vec![correct(), correct()], &images);
        let output = json["output"].as_str().unwrap();
        assert!(output.contains("<h4>a&lt;b&gt;.glsl</h4>") && !output.contains("b.glsl</h4><h4>"));
        assert!(output.contains("<br>Several shaders"), "{output}");
    }
}
