//! `PrairieLearn`: <https://docs.prairielearn.com/externalGrading/>
//!
//! The elements of the page escape all texts but the errors of the format, which are therefore fixed.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::json;
use sha2::{Digest, Sha256};

use super::{Graded, Kit, Platform, PlatformFile, Task, hex, write_json};

pub(super) static PLATFORM: Platform = Platform {
    name: "prairielearn",
    advice: "copy its files into a new folder in questions of your course, and describe the task in question.html",
    kit: Kit::Folder("tests/"),
    program: None,
    files,
    failure: "{\"gradable\": false, \"format_errors\": \
              [\"The autograder failed, so your submission was not graded. Please inform your teacher.\"]}\n",
    results,
};

/// The image in which submissions are graded: any with a C library of 2018 or later.
const IMAGE: &str = "debian:bookworm-slim";

/// The seconds after which a submission is no longer graded, above the limits of toyproof.
const TIMEOUT: u32 = 300;

fn files(task: &Task) -> Vec<PlatformFile> {
    let info = json!({
        "uuid": uuid(task.name),
        "title": task.name,
        "topic": "Shaders",
        "type": "v3",
        "singleVariant": true,
        "gradingMethod": "External",
        "externalGradingOptions": {
            "enabled": true,
            "image": IMAGE,
            "entrypoint": "/grade/tests/run.sh",
            "timeout": TIMEOUT,
        },
    });
    vec![
        PlatformFile::plain("info.json", format!("{info:#}\n")),
        PlatformFile::plain("question.html", include_str!("prairielearn/question.html")),
        PlatformFile::executable("tests/run.sh", include_str!("prairielearn/run.sh")),
    ]
}

/// An identifier that stays the same when the autograder is made again: a UUID of version 8 (RFC 9562).
fn uuid(name: &str) -> String {
    let hash = Sha256::digest(format!("toyproof\0{name}"));
    let mut bytes: [u8; 16] = std::array::from_fn(|at| hash[at]);
    bytes[6] = bytes[6] & 0x0f | 0x80;
    bytes[8] = bytes[8] & 0x3f | 0x80;
    let digits = hex(&bytes);
    let ends = [0, 8, 12, 16, 20, 32];
    let parts: Vec<_> = ends.windows(2).map(|pair| &digits[pair[0]..pair[1]]).collect();
    parts.join("-")
}

#[derive(Serialize)]
struct Results<'a> {
    /// Whether the submission counts as an attempt.
    gradable: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    format_errors: Vec<&'static str>,
    /// In [0, 1].
    score: f64,
    output: &'a str,
    images: Vec<Image>,
    tests: Vec<Test<'a>>,
}

#[derive(Serialize)]
struct Image {
    label: String,
    url: String,
}

#[derive(Serialize)]
struct Test<'a> {
    name: &'a str,
    points: f64,
    max_points: f64,
    message: &'a str,
}

/// Writes `results.json`. A shader that does not compile does not count as an attempt, as the platform
/// recommends.
fn results(graded: &Graded, out: &mut dyn Write) -> io::Result<()> {
    let images = graded.images.urls().into_iter();
    let results = Results {
        gradable: graded.is_checked,
        format_errors: if graded.is_checked {
            Vec::new()
        } else {
            vec!["There is no shader that can be graded. The reason is below."]
        },
        score: graded.fraction(),
        output: &graded.text,
        images: images.map(|(label, url)| Image { label, url }).collect(),
        tests: graded
            .tests
            .iter()
            .map(|mark| Test {
                name: &mark.name,
                points: mark.points,
                max_points: mark.of,
                message: &mark.why,
            })
            .collect(),
    };
    write_json(&results, out)
}

#[cfg(test)]
pub(super) mod tests {
    use serde_json::{Value, json};
    use toyproof_verify::Verdict;

    use super::super::tests::json;
    use super::*;
    use crate::record::samples::{correct, invalid, record};

    /// The results as the page documents them, and the keys that its elements read.
    pub(in crate::platform) fn schema() -> Value {
        let image = json!({
            "type": "object",
            "required": ["url"],
            "properties": { "url": { "type": "string", "pattern": "^data:image/png;base64," },
                            "label": { "type": "string" } },
        });
        json!({
            "type": "object",
            "properties": {
                "gradable": { "type": "boolean" },
                "format_errors": { "type": "array", "items": { "type": "string", "pattern": "^[^<>&]*$" } },
                "score": { "type": "number", "minimum": 0, "maximum": 1 },
                "message": { "type": "string" },
                "output": { "type": "string" },
                "images": { "type": "array", "items": image },
                "tests": { "type": "array", "items": {
                    "type": "object",
                    "required": ["name", "points", "max_points"],
                    "properties": {
                        "name": { "type": "string" },
                        "description": { "type": "string" },
                        "points": { "type": "number" },
                        "max_points": { "type": "number" },
                        "message": { "type": "string" },
                        "output": { "type": "string" },
                        "images": { "type": "array", "items": image },
                    },
                } },
            },
            // Only a result that is not gradable may be without a score.
            "required": ["gradable"],
            "if": { "properties": { "gradable": { "const": true } } },
            "then": { "required": ["score"] },
            "else": { "required": ["format_errors"] },
        })
    }

    #[test]
    fn only_a_shader_that_compiles_is_an_attempt() {
        let results = json("prairielearn", &[correct()]);
        assert_eq!(
            (&results["gradable"], &results["score"]),
            (&json!(true), &json!(1.0))
        );
        assert_eq!(results["images"][0]["label"], "your image");
        assert_eq!(results["tests"][1]["points"], 6.0);
        for (verdict, gradable) in [
            (Verdict::Wrong, true),
            (Verdict::Timeout, true),
            (Verdict::Missing, false),
            (Verdict::Error, false),
        ] {
            assert_eq!(
                json("prairielearn", &[record(verdict)])["gradable"],
                gradable,
                "{verdict}"
            );
        }
        let results = json("prairielearn", &[correct(), invalid()]);
        assert_eq!(
            (&results["gradable"], &results["score"]),
            (&json!(false), &json!(0.0))
        );
        let validator = jsonschema::validator_for(&schema()).unwrap();
        let mut without = json("prairielearn", &[correct()]);
        without.as_object_mut().unwrap().remove("score");
        assert!(!validator.is_valid(&without));
    }

    /// `infoQuestion.json`, the schema of the platform, with the properties that are used.
    #[test]
    fn info_follows_the_documented_schema() {
        let schema = json!({
            "type": "object",
            "additionalProperties": false,
            "required": ["uuid", "type", "title", "topic"],
            "properties": {
                "uuid": { "type": "string", "pattern":
                    "^[0-9a-fA-F]{8}-[0-9a-fA-F]{4}-[0-9a-fA-F]{4}-[0-9a-fA-F]{4}-[0-9a-fA-F]{12}$" },
                "type": { "enum": ["v3"] },
                "title": { "type": "string" },
                "topic": { "type": "string" },
                "singleVariant": { "type": "boolean" },
                "gradingMethod": { "enum": ["Internal", "External", "Manual"] },
                "externalGradingOptions": {
                    "type": "object",
                    "additionalProperties": false,
                    "required": ["image", "entrypoint"],
                    "properties": {
                        "enabled": { "type": "boolean" },
                        "image": { "type": "string" },
                        "entrypoint": { "type": "string" },
                        "timeout": { "type": "integer", "maximum": 600 },
                    },
                },
            },
        });
        let info = |name| {
            let files = PLATFORM.files(&Task { name, program: &[] });
            serde_json::from_str::<Value>(&files[0].text).unwrap()
        };
        let json = info("soft \"shadows\"");
        assert!(
            jsonschema::validator_for(&schema).unwrap().is_valid(&json),
            "{json:#}"
        );
        assert_ne!(json["uuid"], info("shadows")["uuid"]);
    }
}
