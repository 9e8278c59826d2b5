//! `report.sarif`: what was said of the shaders, as editors and code hosts read it (SARIF 2.1.0).

use std::collections::BTreeMap;

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Value, json};
use toyproof_diagnostic as diagnostic;
use toyproof_verify::compare::Verdict;

use super::{Record, terminal};

/// What stands for itself in a path: letters, digits, and what RFC 3986 reserves for nothing.
const PATH: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~')
    .remove(b'/');

/// The verdicts that are results themselves: each with what it is about, and what to do.
const VERDICTS: [(Verdict, &str, &str); 3] = [
    (
        Verdict::Wrong,
        "A shader that does not paint its scene",
        "In more than 0.1 % of the pixels the shader differs from the scene even in double precision: the mathematics is another. \
         `toyproof explain SHADER --pixel X,Y` tells what it does in one of them.",
    ),
    (
        Verdict::Unstable,
        "A shader that float32 is not enough for",
        "The mathematics is right, but the picture that a GPU paints is visibly another than in double precision, or hangs on \
         rounding errors. Write the formula so that it does not subtract what is nearly equal; `toyproof explain` names the line.",
    ),
    (
        Verdict::Timeout,
        "A shader that takes too long",
        "The shader never ends, or takes longer than `--timeout`. Give each loop a bound.",
    ),
];

/// The file: a result for each diagnostic, and one for each verdict that is a result itself. What kept a shader from being judged
/// is a notification.
#[must_use]
pub fn sarif(records: &[Record]) -> String {
    let mut rules = Rules::default();
    let mut results = Vec::new();
    let mut notifications = Vec::new();
    for record in records {
        for told in &record.diagnostics {
            results.push(of_diagnostic(record, told, &mut rules));
        }
        if VERDICTS.iter().any(|(verdict, ..)| *verdict == record.verdict) {
            results.push(of_verdict(record, &mut rules));
        }
        if record.verdict == Verdict::Error {
            notifications.push(json!({
                "level": "error",
                "message": { "text": record.reason },
                "locations": [location(&record.shader, None)],
            }));
        }
    }
    let sarif = json!({
        "$schema": "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "toyproof",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules.told,
            } },
            "invocations": [{
                "executionSuccessful": notifications.is_empty(),
                "toolExecutionNotifications": notifications,
            }],
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    });
    format!("{sarif:#}\n")
}

/// The rules that results refer to, each once.
#[derive(Default)]
struct Rules {
    places: BTreeMap<String, usize>,
    told: Vec<Value>,
}

impl Rules {
    /// The place of a rule among all.
    fn place(&mut self, id: &str, rule: impl FnOnce() -> Value) -> usize {
        if let Some(place) = self.places.get(id) {
            return *place;
        }
        self.places.insert(id.to_owned(), self.told.len());
        self.told.push(rule());
        self.told.len() - 1
    }
}

fn rule(id: &str, title: &str, help: &str) -> Value {
    json!({
        "id": id,
        "shortDescription": { "text": title },
        "help": { "text": help, "markdown": help },
    })
}

fn of_diagnostic(record: &Record, told: &diagnostic::Json, rules: &mut Rules) -> Value {
    let index = rules.place(&told.code, || match super::explain(&told.code) {
        Some(explanation) => rule(&told.code, explanation.title, explanation.text),
        None => json!({ "id": told.code }),
    });
    let mut words = vec![told.message.as_str()];
    words.extend(told.notes.iter().map(String::as_str));
    json!({
        "ruleId": told.code,
        "ruleIndex": index,
        "level": told.severity,
        "message": { "text": words.join("\n") },
        "locations": [location(told.file.as_ref().unwrap_or(&record.shader), told.line.zip(told.column))],
    })
}

fn of_verdict(record: &Record, rules: &mut Rules) -> Value {
    let id = record.verdict.to_string();
    let about = VERDICTS.iter().find(|(verdict, ..)| *verdict == record.verdict);
    let index = rules.place(&id, || {
        about.map_or(Value::Null, |(_, title, help)| rule(&id, title, help))
    });
    let mut words = vec![record.reason.clone()];
    let answers = [&record.maths, &record.rounding].into_iter().flatten();
    words.extend(
        answers
            .filter_map(|answer| answer.first.as_ref())
            .map(terminal::place)
            .take(1),
    );
    json!({
        "ruleId": id,
        "ruleIndex": index,
        "level": "error",
        "message": { "text": words.join("\n") },
        "locations": [location(&record.shader, None)],
    })
}

/// A file, and the line and column in it.
fn location(file: &str, at: Option<(usize, usize)>) -> Value {
    let path = utf8_percent_encode(file, PATH);
    let uri = if file.starts_with('/') {
        format!("file://{path}")
    } else {
        path.to_string()
    };
    let mut place = json!({ "artifactLocation": { "uri": uri } });
    if let Some((line, column)) = at {
        place["region"] = json!({ "startLine": line, "startColumn": column });
    }
    json!({ "physicalLocation": place })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::{every_verdict, invalid};

    /// What SARIF 2.1.0 says of the parts that are used here, and no more.
    fn schema() -> Value {
        let message = json!({
            "type": "object", "additionalProperties": false, "required": ["text"],
            "properties": { "text": { "type": "string" } },
        });
        let level = json!({ "enum": ["none", "note", "warning", "error"] });
        let count = json!({ "type": "integer", "minimum": 1 });
        let locations = json!({ "type": "array", "items": {
            "type": "object", "additionalProperties": false,
            "properties": { "physicalLocation": {
                "type": "object", "additionalProperties": false,
                "properties": {
                    "artifactLocation": {
                        "type": "object", "additionalProperties": false,
                        "properties": { "uri": { "type": "string", "pattern": "^(file://)?[A-Za-z0-9%/._~-]+$" } },
                    },
                    "region": {
                        "type": "object", "additionalProperties": false,
                        "properties": { "startLine": count, "startColumn": count },
                    },
                },
            } },
        } });
        let rules = json!({ "type": "array", "uniqueItems": true, "items": {
            "type": "object", "additionalProperties": false, "required": ["id"],
            "properties": {
                "id": { "type": "string" },
                "shortDescription": message,
                "help": {
                    "type": "object", "additionalProperties": false, "required": ["text"],
                    "properties": { "text": { "type": "string" }, "markdown": { "type": "string" } },
                },
            },
        } });
        let driver = json!({
            "type": "object", "additionalProperties": false, "required": ["name"],
            "properties": { "name": { "type": "string" }, "version": { "type": "string" }, "rules": rules },
        });
        let results = json!({ "type": "array", "items": {
            "type": "object", "additionalProperties": false, "required": ["message"],
            "properties": {
                "ruleId": { "type": "string" },
                "ruleIndex": { "type": "integer", "minimum": 0 },
                "level": level,
                "message": message,
                "locations": locations,
            },
        } });
        let notifications = json!({ "type": "array", "items": {
            "type": "object", "additionalProperties": false, "required": ["message"],
            "properties": { "level": level, "message": message, "locations": locations },
        } });
        let invocations = json!({ "type": "array", "items": {
            "type": "object", "additionalProperties": false, "required": ["executionSuccessful"],
            "properties": {
                "executionSuccessful": { "type": "boolean" },
                "toolExecutionNotifications": notifications,
            },
        } });
        json!({
            "type": "object", "additionalProperties": false, "required": ["version", "runs"],
            "properties": {
                "$schema": { "type": "string" },
                "version": { "const": "2.1.0" },
                "runs": { "type": "array", "items": {
                    "type": "object", "additionalProperties": false, "required": ["tool"],
                    "properties": {
                        "tool": {
                            "type": "object", "additionalProperties": false, "required": ["driver"],
                            "properties": { "driver": driver },
                        },
                        "invocations": invocations,
                        "columnKind": { "enum": ["utf16CodeUnits", "unicodeCodePoints"] },
                        "results": results,
                    },
                } },
            },
        })
    }

    /// `TOYPROOF_SARIF_SCHEMA` names the whole schema, as OASIS publishes it.
    #[test]
    fn the_file_follows_the_published_schema() {
        let Some(path) = std::env::var_os("TOYPROOF_SARIF_SCHEMA") else {
            return;
        };
        // One of its patterns has a bracket too many, which not every reader of patterns takes.
        let text = std::fs::read_to_string(path).unwrap().replace("{2}]?$", "{2}$");
        let schema = serde_json::from_str(&text).unwrap();
        let json = serde_json::from_str(&sarif(&every_verdict())).unwrap();
        let validator = jsonschema::validator_for(&schema).unwrap();
        let errors: Vec<_> = validator
            .iter_errors(&json)
            .map(|error| error.to_string())
            .collect();
        assert!(errors.is_empty(), "{errors:?}");
        assert!(!validator.is_valid(&json!({ "version": "2.1.0" })));
    }

    #[test]
    fn the_file_follows_the_schema_and_rules_are_where_results_say() {
        let mut hostile = invalid();
        hostile.shader = "a b:<script>\u{e9}%.glsl".to_owned();
        hostile.diagnostics[0].file = Some("/hw/a b.glsl".to_owned());
        let mut records = every_verdict();
        records.push(hostile);
        let text = sarif(&records);
        let mut json: Value = serde_json::from_str(&text).unwrap();
        let validator = jsonschema::validator_for(&schema()).unwrap();
        let errors: Vec<_> = validator
            .iter_errors(&json)
            .map(|error| error.to_string())
            .collect();
        assert!(errors.is_empty(), "{errors:?}");
        let results = json["runs"][0]["results"].as_array().unwrap();
        let ids: Vec<_> = results.iter().map(|result| &result["ruleId"]).collect();
        assert_eq!(ids, ["E0301", "timeout", "wrong", "unstable", "E0301"]);
        for result in results {
            let index = result["ruleIndex"].as_u64().unwrap() as usize;
            let rule = &json["runs"][0]["tool"]["driver"]["rules"][index];
            assert_eq!(rule["id"], result["ruleId"]);
            assert!(rule["help"]["text"].as_str().is_some_and(|help| help.len() > 40));
        }
        let last = &json["runs"][0]["results"][4]["locations"][0]["physicalLocation"];
        assert_eq!(last["artifactLocation"]["uri"], "file:///hw/a%20b.glsl");
        assert_eq!(last["region"], json!({ "startLine": 2, "startColumn": 3 }));
        let invocation = &json["runs"][0]["invocations"][0];
        assert_eq!(invocation["executionSuccessful"], false);
        assert_eq!(
            invocation["toolExecutionNotifications"].as_array().unwrap().len(),
            1
        );
        json["runs"][0]["results"][0]["level"] = "dreadful".into();
        assert!(!validator.is_valid(&json));
    }

    #[test]
    fn names_become_uris() {
        let uri = |name| location(name, None)["physicalLocation"]["artifactLocation"]["uri"].clone();
        assert_eq!(uri("hw/a-b_1.glsl"), "hw/a-b_1.glsl");
        assert_eq!(uri("a b:<\u{e9}>"), "a%20b%3A%3C%C3%A9%3E");
    }
}
