//! `CodeRunner`, a type of questions of Moodle:
//! <https://coderunner.org.nz/> (documentation, section “Combinator-template grading”)

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Value, json};

use super::{FAILED, Graded, Kit, Platform, PlatformFile, Task, write_json};
use crate::html::Text;

pub(super) static PLATFORM: Platform = Platform {
    name: "coderunner",
    advice: "paste template.py into the template of a question of the type python3, whose grader is a combinator \
             template grader, and add toyproof.zip to its support files",
    kit: Kit::Zip("toyproof.zip"),
    program: None,
    files,
    // What is not JSON, CodeRunner reports as an error of the question.
    failure: FAILED,
    results,
};

fn files(_: &Task) -> Vec<PlatformFile> {
    vec![PlatformFile::plain(
        "template.py",
        include_str!("coderunner/template.py"),
    )]
}

#[derive(Serialize)]
struct Results {
    /// The share of the points.
    fraction: f64,
    prologuehtml: String,
    /// The rows of a table; the first names the columns. `CodeRunner` escapes the cells.
    testresults: Vec<[Value; 4]>,
    epiloguehtml: String,
}

/// Writes the JSON that the template prints.
fn results(graded: &Graded, out: &mut dyn Write) -> io::Result<()> {
    let header = ["iscorrect", "Part", "Points", "Reason"].map(Value::from);
    let rows = graded.tests.iter().map(|mark| {
        let points = format!("{} of {}", mark.points, mark.of);
        let is_correct = u8::from(mark.points == mark.of);
        [
            json!(is_correct),
            json!(mark.name),
            json!(points),
            json!(mark.why),
        ]
    });
    let text = Text(&graded.text).to_string().replace('\n', "<br>");
    let results = Results {
        fraction: graded.fraction(),
        prologuehtml: format!("<p>{text}</p>"),
        testresults: [header].into_iter().chain(rows).collect(),
        epiloguehtml: graded.images.html(),
    };
    write_json(&results, out)
}

#[cfg(test)]
pub(super) mod tests {
    use serde_json::{Value, json};

    use super::super::tests::json;
    use crate::record::samples::{correct, invalid};

    /// The attributes that a combinator template grader may return; others are errors.
    pub(in crate::platform) fn schema() -> Value {
        let html = json!({ "type": "string" });
        json!({
            "type": "object",
            "additionalProperties": false,
            "required": ["fraction"],
            "properties": {
                "fraction": { "type": "number", "minimum": 0, "maximum": 1 },
                "prologuehtml": html,
                "epiloguehtml": html,
                "instructorhtml": html,
                "testresults": { "type": "array", "minItems": 1, "items": {
                    "type": "array", "minItems": 4, "maxItems": 4,
                } },
                "columnformats": { "type": "array", "items": { "enum": ["%s", "%h"] } },
                "showoutputonly": { "type": "boolean" },
                "showdifferences": { "type": "boolean" },
                "graderstate": { "type": "string" },
                "files": { "type": "object" },
            },
        })
    }

    #[test]
    fn the_fraction_is_that_of_the_points_and_texts_of_html_are_escaped() {
        let results = json("coderunner", &[correct()]);
        assert_eq!(results["fraction"], 1.0);
        assert_eq!(
            results["testresults"][0],
            json!(["iscorrect", "Part", "Points", "Reason"])
        );
        let row = results["testresults"][2].as_array().unwrap();
        assert_eq!(row[..3], [json!(1), json!("algorithm"), json!("6 of 6")]);
        let mut hostile = invalid();
        hostile.reason = "<script>".to_owned();
        let results = json("coderunner", &[hostile]);
        assert_eq!(results["fraction"], 0.0);
        assert_eq!(results["prologuehtml"], "<p>invalid: &lt;script&gt;</p>");
    }
}
