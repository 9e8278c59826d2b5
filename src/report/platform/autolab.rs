//! Autolab: <https://docs.autolabproject.com/lab/>
//!
//! Standard output is shown to students. Its last line has the points of each problem, and the line before
//! it what is shown as a table: <https://docs.autolabproject.com/features/#formatted-feedback>

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::{FAILED, Graded, Kit, Platform, PlatformFile, Task};

pub(super) static PLATFORM: Platform = Platform {
    name: "autolab",
    advice: "upload autograde-Makefile and autograde.tar as the autograder of an assessment, whose problems have the \
             names and the points of the assignment",
    kit: Kit::Tar("autograde.tar"),
    program: None,
    files,
    // Without scores in the last line, Autolab reports that the autograder failed.
    failure: FAILED,
    results,
};

fn files(_: &Task) -> Vec<PlatformFile> {
    let makefile = include_str!("autolab/autograde-Makefile");
    vec![PlatformFile::plain("autograde-Makefile", makefile)]
}

/// Writes the marks as text, and the two lines.
fn results(graded: &Graded, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}", graded.text)?;
    for mark in &graded.tests {
        writeln!(out, "\n{}: {} of {}", mark.name, mark.points, mark.of)?;
        for line in mark.why.lines() {
            writeln!(out, "  {line}")?;
        }
    }
    let mut shown = Map::new();
    let mut scores = Map::new();
    for mark in &graded.counted {
        let passed = mark.points == mark.of;
        let mut test = json!({ "passed": passed });
        if !passed {
            test["hint"] = mark.why.clone().into();
        }
        shown.insert(mark.name.to_string(), test);
        scores.insert(mark.name.to_string(), mark.points.into());
    }
    let presentation = json!({ "_presentation": "semantic", "stages": ["Points"], "Points": shown });
    writeln!(
        out,
        "\n{presentation}\n{}",
        json!({ "scores": Value::from(scores) })
    )
}

#[cfg(test)]
pub(super) mod tests {
    use serde_json::{Value, json};

    use super::super::tests::results;
    use crate::record::samples::{correct, invalid};
    use crate::{Hints, Thumbnails};

    /// The last two lines.
    pub(in crate::platform) fn schema() -> Value {
        let test = json!({
            "type": "object",
            "required": ["passed"],
            "properties": { "passed": { "type": "boolean" }, "hint": { "type": "string" } },
        });
        let presentation = json!({
            "type": "object",
            "required": ["_presentation", "stages", "Points"],
            "properties": {
                "_presentation": { "const": "semantic" },
                "stages": { "const": ["Points"] },
                "Points": { "type": "object", "required": ["compiles", "algorithm", "precision"],
                            "properties": { "compiles": test, "algorithm": test, "precision": test } },
            },
        });
        let scores = json!({
            "type": "object",
            "required": ["scores"],
            "properties": { "scores": {
                "type": "object",
                "required": ["compiles", "algorithm", "precision"],
                "additionalProperties": { "type": "number" },
            } },
        });
        json!({ "type": "array", "prefixItems": [presentation, scores], "minItems": 2, "maxItems": 2 })
    }

    #[test]
    fn the_last_line_has_the_points_of_the_shader_that_counts() {
        let text = |records: &[_]| results("autolab", records, Hints::Fix, &Thumbnails::default());
        let right = text(&[correct()]);
        assert_eq!(
            right.lines().last().unwrap(),
            "{\"scores\":{\"algorithm\":6.0,\"compiles\":2.0,\"precision\":2.0}}"
        );
        assert!(
            right.starts_with("correct: it is correct\n\ncompiles: 2 of 2\n  the shader compiles\n"),
            "{right}"
        );
        let several = text(&[correct(), invalid()]);
        assert!(several.contains("invalid: compiles: 0 of 2"), "{several}");
        assert_eq!(
            several.lines().last().unwrap(),
            "{\"scores\":{\"algorithm\":0.0,\"compiles\":0.0,\"precision\":0.0}}"
        );
    }
}
