//! `report.sarif`: the diagnostics, for editors and code hosts (SARIF 2.1.0).

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::iter;

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::Serialize;
use toyproof_diagnostic::{self as diagnostic, Severity};
use toyproof_verify::Verdict;

use super::{Late, Record, Repair, SourceRange, terminal};

/// The characters that are not percent-encoded in a path: letters, digits, the other unreserved characters of
/// RFC 3986, and `/`.
const ENCODE_IN_PATH: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~')
    .remove(b'/');

/// The verdicts that become results: each with its title and its help text.
const VERDICTS: [(Verdict, &str, &str); 3] = [
    (
        Verdict::Wrong,
        "The shader's image differs from the reference",
        "More than 0.1 % of the pixels, or a compact region of them, differ from the reference in double precision, \
         so the algorithm is wrong. `toyproof debug SHADER --pixel X,Y` traces one of them.",
    ),
    (
        Verdict::Unstable,
        "float32 is not precise enough for the shader",
        "The algorithm is right, but in float32 more than 0.3 % of the pixels visibly differ, or are ill-conditioned. Avoid the \
         subtraction of nearly equal numbers; `toyproof debug SHADER --pixel X,Y` shows where precision is lost.",
    ),
    (
        Verdict::Timeout,
        "The shader exceeds the time limit",
        "A loop does not end, or the shader takes longer than `--timeout`. Limit the number of iterations of each loop.",
    ),
];

/// Writes the file: a result per diagnostic, and one per verdict of `VERDICTS`. An error that prevented a
/// verdict is a notification.
///
/// # Errors
/// The file cannot be written.
pub fn sarif(records: &[Record], out: &mut dyn Write) -> io::Result<()> {
    let mut rules = Rules::default();
    let mut results = Vec::new();
    for record in records {
        let diagnostics = record.diagnostics.iter();
        results.extend(diagnostics.map(|message| diagnostic_result(record, message, &mut rules)));
        if let Some((_, title, help)) = VERDICTS.iter().find(|(verdict, ..)| *verdict == record.verdict) {
            results.push(verdict_result(record, title, help, &mut rules));
        }
        if let Some(late) = record.late() {
            results.push(late_result(record, late, &mut rules));
        }
    }
    let errors = records.iter().filter(|record| record.verdict == Verdict::Error);
    let notifications: Vec<_> = errors.map(Notification::new).collect();
    let log = Log {
        schema: "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json",
        version: "2.1.0",
        runs: [Run {
            column_kind: "unicodeCodePoints",
            results,
            invocations: [Invocation {
                execution_successful: notifications.is_empty(),
                tool_execution_notifications: notifications,
            }],
            tool: Tool {
                driver: Driver {
                    name: "toyproof",
                    version: env!("CARGO_PKG_VERSION"),
                    rules: rules.rules,
                },
            },
        }],
    };
    serde_json::to_writer_pretty(&mut *out, &log)?;
    out.write_all(b"\n")
}

/// The rules that results refer to, without duplicates.
#[derive(Default)]
struct Rules {
    indices: BTreeMap<String, usize>,
    rules: Vec<Rule>,
}

impl Rules {
    /// Returns the index of a rule, adding it if it is new.
    fn index_of(&mut self, id: &str, about: Option<(&'static str, Cow<'static, str>)>) -> usize {
        if let Some(index) = self.indices.get(id) {
            return *index;
        }
        self.indices.insert(id.to_owned(), self.rules.len());
        self.rules.push(Rule {
            id: id.to_owned(),
            short_description: about.as_ref().map(|(title, _)| Message::new((*title).to_owned())),
            help: about.map(|(_, help)| Help {
                text: help.clone(),
                markdown: help,
            }),
        });
        self.rules.len() - 1
    }
}

fn diagnostic_result(record: &Record, message: &diagnostic::Json, rules: &mut Rules) -> SarifResult {
    let about = super::explain(&message.code).map(|explanation| (explanation.title, explanation.text));
    let mut lines = vec![message.message.as_str()];
    lines.extend(message.notes.iter().map(String::as_str));
    let file = message.file.as_ref().unwrap_or(&record.shader);
    SarifResult {
        rule_id: message.code.clone(),
        rule_index: rules.index_of(&message.code, about),
        level: message.severity,
        message: Message::new(lines.join("\n")),
        locations: [Location::new(file, Region::new(message))],
        fixes: message.fix.iter().map(|fix| Fix::new(file, fix)).collect(),
    }
}

fn verdict_result(
    record: &Record,
    title: &'static str,
    help: &'static str,
    rules: &mut Rules,
) -> SarifResult {
    let id = record.verdict.to_string();
    let mut lines = vec![record.reason.clone()];
    let mut answers = [&record.algorithm, &record.precision].into_iter().flatten();
    lines.extend(
        answers
            .find_map(|answer| answer.first.as_ref())
            .map(terminal::place),
    );
    lines.extend(
        record
            .mistake
            .as_ref()
            .map(|mistake| format!("{}: {}", mistake.label(), mistake.text)),
    );
    let hints = terminal::fix_lines(record).into_iter();
    lines.extend(hints.map(|(label, sentence)| format!("{label}: {sentence}")));
    let repairs = record
        .fix
        .iter()
        .flat_map(|fix| iter::once(fix).chain(&fix.alternatives));
    SarifResult {
        rule_index: rules.index_of(&id, Some((title, help.into()))),
        rule_id: id,
        level: Severity::Error,
        message: Message::new(lines.join("\n")),
        locations: [mistake_location(record)],
        fixes: repairs.filter_map(Fix::from_repair).collect(),
    }
}

/// The result for a late submission, whether its shader is right or wrong.
fn late_result(record: &Record, late: Late, rules: &mut Rules) -> SarifResult {
    const TITLE: &str = "The submission is late";
    SarifResult {
        rule_index: rules.index_of(
            "late",
            Some((
                TITLE,
                "It was submitted after the deadline of its assignment.".into(),
            )),
        ),
        rule_id: "late".to_owned(),
        level: Severity::Note,
        message: Message::new(format!("the submission is {late}")),
        locations: [Location::new(&record.shader, None)],
        fixes: Vec::new(),
    }
}

/// The first line of the fix, else the most suspicious one, else the whole file.
fn mistake_location(record: &Record) -> Location {
    match (&record.fix, record.suspects.first()) {
        (Some(fix), _) => Location::new(&fix.file, Some(fix.range.into())),
        (None, Some(suspect)) => {
            let file = suspect.file.as_ref().unwrap_or(&record.shader);
            Location::new(file, Some(suspect.range.into()))
        }
        (None, None) => Location::new(&record.shader, None),
    }
}

// The objects of the SARIF 2.1.0 schema, with the properties that are used here.

#[derive(Serialize)]
struct Log {
    #[serde(rename = "$schema")]
    schema: &'static str,
    version: &'static str,
    runs: [Run; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Run {
    column_kind: &'static str,
    results: Vec<SarifResult>,
    invocations: [Invocation; 1],
    tool: Tool,
}

#[derive(Serialize)]
struct Tool {
    driver: Driver,
}

#[derive(Serialize)]
struct Driver {
    name: &'static str,
    version: &'static str,
    rules: Vec<Rule>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Rule {
    id: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    short_description: Option<Message>,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<Help>,
}

#[derive(Serialize)]
struct Help {
    text: Cow<'static, str>,
    markdown: Cow<'static, str>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Invocation {
    execution_successful: bool,
    tool_execution_notifications: Vec<Notification>,
}

#[derive(Serialize)]
struct Notification {
    level: Severity,
    message: Message,
    locations: [Location; 1],
}

impl Notification {
    /// The error that prevented the verdict on a shader.
    fn new(record: &Record) -> Self {
        Self {
            level: Severity::Error,
            message: Message::new(record.reason.clone()),
            locations: [Location::new(&record.shader, None)],
        }
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct SarifResult {
    rule_id: String,
    rule_index: usize,
    level: Severity,
    message: Message,
    locations: [Location; 1],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    fixes: Vec<Fix>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Fix {
    description: Message,
    artifact_changes: [ArtifactChange; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ArtifactChange {
    artifact_location: ArtifactLocation,
    replacements: Vec<Replacement>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Replacement {
    deleted_region: Region,
    inserted_content: Message,
}

impl Fix {
    fn new(file: &str, fix: &diagnostic::JsonFix) -> Self {
        let deleted_region = Region {
            start_line: fix.line,
            start_column: fix.column,
            end_line: Some(fix.end_line),
            end_column: Some(fix.end_column),
        };
        let replacement = Replacement {
            deleted_region,
            inserted_content: Message::new(fix.replacement.clone()),
        };
        Self::from_replacements(file, fix.message.clone(), vec![replacement])
    }

    /// All edits of a repair; `None` if they are hidden.
    fn from_repair(repair: &Repair) -> Option<Self> {
        let replacements = repair.edits.iter().map(|edit| {
            Some(Replacement {
                deleted_region: edit.range.into(),
                inserted_content: Message::new(edit.replacement.clone()?),
            })
        });
        let replacements = replacements.collect::<Option<_>>()?;
        Some(Self::from_replacements(
            &repair.file,
            repair.sentence(),
            replacements,
        ))
    }

    fn from_replacements(file: &str, description: String, replacements: Vec<Replacement>) -> Self {
        Self {
            description: Message::new(description),
            artifact_changes: [ArtifactChange {
                artifact_location: ArtifactLocation::new(file),
                replacements,
            }],
        }
    }
}

#[derive(Serialize)]
struct Message {
    text: String,
}

impl Message {
    fn new(text: String) -> Self {
        Self { text }
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Location {
    physical_location: PhysicalLocation,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PhysicalLocation {
    artifact_location: ArtifactLocation,
    #[serde(skip_serializing_if = "Option::is_none")]
    region: Option<Region>,
}

#[derive(Serialize)]
struct ArtifactLocation {
    uri: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Region {
    start_line: usize,
    start_column: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    end_line: Option<usize>,
    /// Exclusive.
    #[serde(skip_serializing_if = "Option::is_none")]
    end_column: Option<usize>,
}

impl Region {
    /// The place of a message; `None` if it has none.
    fn new(message: &diagnostic::Json) -> Option<Self> {
        Some(Self {
            start_line: message.line?,
            start_column: message.column?,
            end_line: message.end_line,
            end_column: message.end_column,
        })
    }
}

impl From<SourceRange> for Region {
    fn from(range: SourceRange) -> Self {
        Self {
            start_line: range.line,
            start_column: range.column,
            end_line: Some(range.end_line),
            end_column: Some(range.end_column),
        }
    }
}

impl ArtifactLocation {
    fn new(file: &str) -> Self {
        let path = utf8_percent_encode(file, ENCODE_IN_PATH);
        let uri = if file.starts_with('/') {
            format!("file://{path}")
        } else {
            path.to_string()
        };
        Self { uri }
    }
}

impl Location {
    /// A location in a file, with an optional region.
    fn new(file: &str, region: Option<Region>) -> Self {
        Self {
            physical_location: PhysicalLocation {
                artifact_location: ArtifactLocation::new(file),
                region,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::record::samples::{every_verdict, invalid};
    use crate::repair::samples::{repaired, suspected};
    use crate::written;

    fn file(records: &[Record]) -> String {
        written(|out| sarif(records, out))
    }

    /// The part of the SARIF 2.1.0 schema that is used here, without additional properties.
    fn schema() -> Value {
        let message = json!({
            "type": "object", "additionalProperties": false, "required": ["text"],
            "properties": { "text": { "type": "string" } },
        });
        let level = json!({ "enum": ["none", "note", "warning", "error"] });
        let count = json!({ "type": "integer", "minimum": 1 });
        let artifact = json!({
            "type": "object", "additionalProperties": false,
            "properties": { "uri": { "type": "string", "pattern": "^(file://)?[A-Za-z0-9%/._~-]+$" } },
        });
        let region = json!({
            "type": "object", "additionalProperties": false,
            "properties": { "startLine": count, "startColumn": count, "endLine": count, "endColumn": count },
        });
        let fixes = json!({ "type": "array", "uniqueItems": true, "items": {
            "type": "object", "additionalProperties": false, "required": ["artifactChanges"],
            "properties": {
                "description": message,
                "artifactChanges": { "type": "array", "minItems": 1, "items": {
                    "type": "object", "additionalProperties": false, "required": ["artifactLocation", "replacements"],
                    "properties": {
                        "artifactLocation": artifact,
                        "replacements": { "type": "array", "minItems": 1, "items": {
                            "type": "object", "additionalProperties": false, "required": ["deletedRegion"],
                            "properties": { "deletedRegion": region, "insertedContent": message },
                        } },
                    },
                } },
            },
        } });
        let locations = json!({ "type": "array", "items": {
            "type": "object", "additionalProperties": false,
            "properties": { "physicalLocation": {
                "type": "object", "additionalProperties": false,
                "properties": {
                    "artifactLocation": artifact,
                    "region": region,
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
                "fixes": fixes,
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

    /// Validates against the complete schema that OASIS publishes, if `TOYPROOF_SARIF_SCHEMA` names its file.
    #[test]
    fn the_file_follows_the_published_schema() {
        let Some(path) = std::env::var_os("TOYPROOF_SARIF_SCHEMA") else {
            return;
        };
        // One of its patterns has an extra bracket, which not every regex engine accepts.
        let text = std::fs::read_to_string(path).unwrap().replace("{2}]?$", "{2}$");
        let schema = serde_json::from_str(&text).unwrap();
        let json = serde_json::from_str(&file(&every_verdict())).unwrap();
        let validator = jsonschema::validator_for(&schema).unwrap();
        let errors: Vec<_> = validator
            .iter_errors(&json)
            .map(|error| error.to_string())
            .collect();
        assert!(errors.is_empty(), "{errors:?}");
        assert!(!validator.is_valid(&json!({ "version": "2.1.0" })));
    }

    #[test]
    fn the_file_follows_the_schema_and_rule_indices_are_right() {
        let mut hostile = invalid();
        hostile.shader = "a b:<script>\u{e9}%.glsl".to_owned();
        hostile.diagnostics[0].file = Some("/hw/a b.glsl".to_owned());
        let mut records = every_verdict();
        records.push(hostile);
        let text = file(&records);
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
        let region = json!({ "startLine": 2, "startColumn": 3, "endLine": 2, "endColumn": 7 });
        assert_eq!(last["region"], region);
        let change = &json["runs"][0]["results"][4]["fixes"][0]["artifactChanges"][0];
        assert_eq!(change["artifactLocation"]["uri"], "file:///hw/a%20b.glsl");
        let replacement = json!({ "deletedRegion": region, "insertedContent": { "text": "near" } });
        assert_eq!(change["replacements"], json!([replacement]));
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
    fn a_wrong_shader_is_located_at_its_fix_or_its_first_suspect() {
        let json: Value = serde_json::from_str(&file(&[repaired(), suspected()])).unwrap();
        let validator = jsonschema::validator_for(&schema()).unwrap();
        assert!(validator.is_valid(&json), "{json}");
        let results = &json["runs"][0]["results"];
        let region = |at: usize| results[at]["locations"][0]["physicalLocation"]["region"].clone();
        let sum = json!({ "startLine": 2, "startColumn": 12, "endLine": 2, "endColumn": 17 });
        let number = json!({ "startLine": 4, "startColumn": 11, "endLine": 4, "endColumn": 14 });
        assert_eq!([region(0), region(1)], [sum.clone(), number.clone()]);
        let message = results[0]["message"]["text"].as_str().unwrap();
        assert!(
            message.contains("likely mistake: an operator is wrong\nfix: line 2: replace"),
            "{message}"
        );
        let fixes = results[0]["fixes"].as_array().unwrap();
        assert_eq!(fixes.len(), 2);
        let both = json!([
            { "deletedRegion": sum, "insertedContent": { "text": "" } },
            { "deletedRegion": number, "insertedContent": { "text": "2.0" } },
        ]);
        assert_eq!(fixes[1]["artifactChanges"][0]["replacements"], both);
        assert_eq!(results[1].get("fixes"), None);
    }

    #[test]
    fn names_become_uris() {
        let uri = |name| Location::new(name, None).physical_location.artifact_location.uri;
        assert_eq!(uri("hw/a-b_1.glsl"), "hw/a-b_1.glsl");
        assert_eq!(uri("a b:<\u{e9}>"), "a%20b%3A%3C%C3%A9%3E");
    }
}
