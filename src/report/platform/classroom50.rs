//! Classroom 50: <https://github.com/foundation50/classroom50/wiki/Advanced-Autograding>
//!
//! `autograder.py` adds what only its environment states: whose submission it is, and which.

use std::io::{self, Write};

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::{Graded, Kit, Platform, PlatformFile, Task, hex, write_json};
use crate::rubric::Mark;

pub(super) static PLATFORM: Platform = Platform {
    name: "classroom50",
    advice: "publish the file toyproof, enter its address in autograder.py, and copy the folder autograder into your \
             classroom50 repository, as CLASSROOM/autograders/ASSIGNMENT",
    kit: Kit::Folder("autograder/"),
    // An autograder has at most 10 MiB.
    program: Some("toyproof"),
    files,
    // A script that fails is an error of the autograder.
    failure: "",
    results,
};

fn files(task: &Task) -> Vec<PlatformFile> {
    let hash = hex(&Sha256::digest(task.program));
    let script = include_str!("classroom50/autograder.py").replace("@SHA256@", &hash);
    vec![PlatformFile::plain("autograder/autograder.py", script)]
}

/// What autograder.py needs for `result.json`. Scores are integers, so they are hundredths of a point.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
struct Results<'a> {
    output: &'a str,
    score: u64,
    max_score: u64,
    tests: Vec<Test<'a>>,
}

#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
struct Test<'a> {
    #[serde(rename = "test-name")]
    name: &'a str,
    passed: bool,
    score: u64,
    max_score: u64,
    /// Kept, but not read.
    output: &'a str,
}

/// Writes the results: a test per mark of the shader that counts, since the score is the sum of the tests'.
fn results(graded: &Graded, out: &mut dyn Write) -> io::Result<()> {
    let [score, max_score] = graded.score().map(hundredths);
    let results = Results {
        output: &graded.text,
        score,
        max_score,
        tests: graded.counted.iter().map(Test::new).collect(),
    };
    write_json(&results, out)
}

impl<'a> Test<'a> {
    fn new(mark: &'a Mark) -> Self {
        Self {
            name: &mark.name,
            passed: mark.points == mark.of,
            score: hundredths(mark.points),
            max_score: hundredths(mark.of),
            output: &mark.why,
        }
    }
}

/// The hundredths of points; 0 of a deduction.
fn hundredths(points: f64) -> u64 {
    (100.0 * points).round().max(0.0) as u64
}

#[cfg(test)]
pub(super) mod tests {
    use serde_json::{Value, json};

    use super::super::tests::json;
    use crate::record::samples::{correct, invalid};

    /// The properties of `schemas/result-v1.schema.json` that autograder.py does not add, and `output`, which
    /// it removes.
    pub(in crate::platform) fn schema() -> Value {
        let count = json!({ "type": "integer", "minimum": 0 });
        json!({
            "type": "object",
            "additionalProperties": false,
            "required": ["output", "score", "max-score", "tests"],
            "properties": {
                "output": { "type": "string" },
                "score": count,
                "max-score": count,
                "tests": { "type": "array", "items": {
                    "type": "object",
                    "required": ["test-name", "passed", "score", "max-score"],
                    "properties": {
                        "test-name": { "type": "string", "minLength": 1 },
                        "passed": { "type": "boolean" },
                        "score": count,
                        "max-score": count,
                    },
                } },
            },
        })
    }

    #[test]
    fn scores_are_hundredths_of_points_and_add_up() {
        let results = json("classroom50", &[correct()]);
        assert_eq!(
            (&results["score"], &results["max-score"]),
            (&json!(1000), &json!(1000))
        );
        let test = json!({"test-name": "algorithm", "passed": true, "score": 600, "max-score": 600,
                          "output": results["tests"][1]["output"]});
        assert_eq!(results["tests"][1], test);
        let several = json("classroom50", &[correct(), invalid()]);
        assert_eq!(several["score"], 0);
        let tests = several["tests"].as_array().unwrap();
        assert_eq!(
            tests
                .iter()
                .map(|test| test["score"].as_u64().unwrap())
                .sum::<u64>(),
            0
        );
        assert_eq!(tests.len(), 3);
    }
}
