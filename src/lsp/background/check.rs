//! The check after a save: its verdict as a code lens, the likely mistake as a diagnostic, and the edit after
//! which the shader is right as a quick fix.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use lsp_types::{
    CodeLens, Command as LspCommand, Diagnostic as LspDiagnostic, DiagnosticSeverity, Message, Position,
    Range, Uri,
};
use serde::Deserialize;
use serde_json::Value;
use toyproof_diagnostic::{File, plural};
use toyproof_project::files::is_project;

use super::{Job, Output};
use crate::diagnostics::SOURCE;
use crate::encoding::Encoding;
use crate::settings::CheckSettings;

/// The command of the code lens, which checks a document again.
pub(crate) const CHECK_COMMAND: &str = "toyproof.check";

/// A finished check.
#[derive(Debug)]
pub(crate) struct CheckResult {
    pub(crate) uri: Uri,
    /// The number of the check.
    number: u64,
    output: Output,
}

/// The checks of all documents.
#[derive(Debug, Default)]
pub(crate) struct Checks {
    number: u64,
    documents: BTreeMap<String, Checked>,
}

/// The check of a document.
#[derive(Debug)]
struct Checked {
    number: u64,
    state: State,
    /// The text that was checked.
    text: File,
}

#[derive(Debug)]
enum State {
    Running(#[expect(dead_code, reason = "its process ends when it is dropped")] Job),
    Finished(Box<Record>),
    Failed(String),
}

/// What is read of `verdict.json`.
#[derive(Debug, Deserialize)]
struct Report {
    shaders: Vec<Record>,
}

/// What is read of the findings on a shader.
#[derive(Debug, Deserialize)]
struct Record {
    verdict: String,
    reason: String,
    #[serde(default)]
    details: Vec<String>,
    mistake: Option<Mistake>,
    fix: Option<Repair>,
    #[serde(default)]
    suspects: Vec<Suspect>,
    cause: Option<Place>,
}

#[derive(Debug, Deserialize)]
struct Mistake {
    id: String,
    text: String,
    is_symptom: bool,
}

#[derive(Debug, Deserialize)]
struct Repair {
    file: String,
    text: Option<String>,
    #[serde(flatten)]
    range: TextRange,
    edits: Vec<RepairEdit>,
}

#[derive(Debug, Deserialize)]
struct RepairEdit {
    #[serde(flatten)]
    range: TextRange,
    replacement: Option<String>,
}

#[derive(Debug, Deserialize)]
struct Suspect {
    file: Option<String>,
    #[serde(flatten)]
    range: TextRange,
}

/// Lines and columns from 1, columns in characters.
#[derive(Debug, Clone, Copy, Deserialize)]
struct TextRange {
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
}

#[derive(Debug, Clone, Copy, Deserialize)]
struct Place {
    line: usize,
    column: usize,
}

/// A quick fix that a check found.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct FoundFix {
    pub(crate) title: String,
    /// The replaced bytes of the document, sorted, and what replaces them.
    pub(crate) edits: Vec<(std::ops::Range<u32>, String)>,
}

/// Whether there is something to compare a shader with: the settings name it, or it lies beside the shader,
/// where `check` finds it.
pub(crate) fn has_reference(path: &Path, settings: &CheckSettings) -> bool {
    let beside = || {
        let folder = path.parent()?;
        let is_there = path.with_extension("toml").is_file() || folder.join("assignment.toml").is_file();
        Some(is_there)
    };
    settings.scene.is_some()
        || settings.reference.is_some()
        || settings.assignment.is_some()
        || beside().unwrap_or(false)
}

/// The command that checks a file, or the project of which it is a tab.
fn command(executable: &Path, folder: &Path, path: &Path, settings: &CheckSettings) -> Command {
    let parent = path.parent().unwrap_or(path);
    let input = if is_project(parent) { parent } else { path };
    let mut command = Command::new(executable);
    command.current_dir(folder).arg("check").arg(input);
    // The evaluator decides the verdict, and needs no driver.
    command.args(["--format", "json", "--device", "cpu", "--color", "never"]);
    settings.add_reference(&mut command);
    command.args(["--hints", settings.hints()]);
    command
}

impl Checks {
    /// Starts the check of a saved document. An earlier one that runs is ended.
    pub(crate) fn start(
        &mut self,
        executable: &Path,
        folder: &Path,
        document: (&Uri, &Path, &File),
        settings: &CheckSettings,
        done: impl FnOnce(CheckResult) + Send + 'static,
    ) {
        let (uri, path, text) = document;
        self.number += 1;
        let number = self.number;
        let result = uri.clone();
        let started = Job::start(
            command(executable, folder, path, settings),
            settings.timeout,
            move |output| {
                done(CheckResult {
                    uri: result,
                    number,
                    output,
                });
            },
        );
        let state = match started {
            Ok(job) => State::Running(job),
            Err(error) => State::Failed(format!("the check cannot be started: {error}")),
        };
        let text = text.clone();
        self.documents
            .insert(uri.0.clone(), Checked { number, state, text });
    }

    /// Takes over a result, unless a later check has been started. Returns whether it counts.
    pub(crate) fn finish(&mut self, result: CheckResult) -> bool {
        let Some(checked) = self.documents.get_mut(&result.uri.0) else {
            return false;
        };
        if checked.number != result.number {
            return false;
        }
        checked.state = match result.output {
            Output::TimedOut => State::Failed("the check exceeded the time limit of the settings".to_owned()),
            Output::Finished { out, error } => match serde_json::from_slice::<Report>(&out) {
                Ok(Report { mut shaders }) if !shaders.is_empty() => {
                    State::Finished(Box::new(shaders.swap_remove(0)))
                }
                _ => State::Failed(error.unwrap_or_else(|| "the check printed no verdict".to_owned())),
            },
        };
        true
    }

    /// Ends the check of a document that is closed.
    pub(crate) fn forget(&mut self, uri: &Uri) {
        self.documents.remove(&uri.0);
    }

    /// The verdict as a code lens at a byte of the document's text.
    pub(crate) fn lens(&self, uri: &Uri, text: &File, at: Position) -> Option<CodeLens> {
        let checked = self.documents.get(&uri.0)?;
        let title = match &checked.state {
            State::Running(_) => "toyproof: checking…".to_owned(),
            State::Failed(reason) => format!("toyproof: {reason}"),
            State::Finished(record) => {
                let stale = if checked.text.text() == text.text() {
                    ""
                } else {
                    " (when last saved)"
                };
                format!("toyproof: {}{stale}: {}", record.verdict, record.reason)
            }
        };
        let arguments = Some(vec![Value::String(uri.0.clone())]);
        let tooltip = match &checked.state {
            State::Finished(record) if !record.details.is_empty() => Some(record.details.join("\n")),
            _ => None,
        };
        let command = LspCommand {
            title,
            tooltip,
            command: CHECK_COMMAND.to_owned(),
            arguments,
        };
        Some(CodeLens::new(Range::new(at, at), Some(command), None))
    }

    /// The finding on a document, as long as its text is what was checked.
    fn current(&self, uri: &Uri, text: &File) -> Option<&Record> {
        let checked = self.documents.get(&uri.0)?;
        match &checked.state {
            State::Finished(record) if checked.text.text() == text.text() => Some(record),
            _ => None,
        }
    }

    /// The likely mistake as a diagnostic on its line.
    pub(crate) fn diagnostic(&self, uri: &Uri, text: &File, encoding: Encoding) -> Option<LspDiagnostic> {
        let record = self.current(uri, text)?;
        let mistake = record.mistake.as_ref();
        let fix = record.fix.as_ref();
        if mistake.is_none() && fix.is_none() {
            return None;
        }
        let what = match mistake {
            Some(mistake) if mistake.is_symptom => format!("{}\nsymptom: {}", record.reason, mistake.text),
            Some(mistake) => format!("{}\nlikely mistake: {}", record.reason, mistake.text),
            None => record.reason.clone(),
        };
        let advice = fix
            .and_then(|fix| fix.text.as_ref())
            .map(|text| format!("\nhelp: {text}"));
        Some(LspDiagnostic {
            range: record.place(text, encoding),
            severity: Some(DiagnosticSeverity::Warning),
            code: mistake.map(|mistake| lsp_types::Code::String(mistake.id.clone())),
            code_description: None,
            source: Some(format!("{SOURCE} check")),
            message: Message::String(what + &advice.unwrap_or_default()),
            tags: None,
            related_information: None,
            data: None,
        })
    }

    /// The edits after which the shader is right, if the hints permit them.
    pub(crate) fn fix(&self, uri: &Uri, text: &File) -> Option<FoundFix> {
        let fix = self.current(uri, text)?.fix.as_ref()?;
        if !names(&fix.file, text) {
            return None;
        }
        let mut edits = Vec::with_capacity(fix.edits.len());
        for edit in &fix.edits {
            edits.push((edit.range.bytes(text), edit.replacement.clone()?));
        }
        edits.sort_by_key(|(bytes, _)| (bytes.start, bytes.end));
        let count = edits.len() as u64;
        let title = match &fix.text {
            Some(text) => format!("Correct the image: {text}"),
            None => format!("Correct the image by {count} {}", plural(count, "edit", "edits")),
        };
        Some(FoundFix { title, edits })
    }
}

impl Record {
    /// Where the mistake is: at the fix, else at the cause, else at the first suspect line, else at the
    /// first line.
    fn place(&self, text: &File, encoding: Encoding) -> Range {
        let fix = self
            .fix
            .as_ref()
            .filter(|fix| names(&fix.file, text))
            .map(|fix| fix.range);
        let cause = self.cause.map(|Place { line, column }| TextRange {
            line,
            column,
            end_line: line,
            end_column: usize::MAX,
        });
        let mut suspects = self.suspects.iter();
        let suspect = suspects.find(|suspect| suspect.file.as_ref().is_none_or(|file| names(file, text)));
        let suspect = suspect.map(|suspect| suspect.range);
        let first = TextRange {
            line: 1,
            column: 1,
            end_line: 1,
            end_column: usize::MAX,
        };
        let bytes = fix.or(cause).or(suspect).unwrap_or(first).bytes(text);
        encoding.range(text, bytes.start, bytes.end)
    }
}

/// Whether a record's name of a file, as it was given or below a project's folder, is that of a text.
fn names(file: &str, text: &File) -> bool {
    PathBuf::from(file)
        .file_name()
        .is_some_and(|name| *name == *text.name())
}

impl TextRange {
    fn bytes(self, text: &File) -> std::ops::Range<u32> {
        let start = byte(text, self.line, self.column);
        let end = byte(text, self.end_line, self.end_column);
        start..end.max(start)
    }
}

/// The byte at a line and a column, both from 1, the column in characters; at most the end of the line.
fn byte(text: &File, line: usize, column: usize) -> u32 {
    let Some(range) = text.line_range(line.saturating_sub(1)) else {
        return text.text().len() as u32;
    };
    let content = text.text()[range.clone()].trim_end_matches(['\r', '\n']);
    let before = content.char_indices().nth(column.saturating_sub(1));
    (range.start + before.map_or(content.len(), |(at, _)| at)) as u32
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const TEXT: &str = "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(p.x + p.y);\n}\n";

    /// Checks whose only result is a report.
    fn checks(report: &Value) -> (Checks, Uri, File) {
        let (uri, text) = (Uri("file:///a.glsl".to_owned()), File::new("a.glsl", TEXT));
        let mut checks = Checks::default();
        let state = State::Failed(String::new());
        let checked = Checked {
            number: 1,
            state,
            text: text.clone(),
        };
        checks.documents.insert(uri.0.clone(), checked);
        let out = serde_json::to_vec(report).unwrap();
        let output = Output::Finished { out, error: None };
        assert!(checks.finish(CheckResult {
            uri: uri.clone(),
            number: 1,
            output
        }));
        (checks, uri, text)
    }

    fn wrong() -> Value {
        let range = json!({"line": 2, "column": 18, "end_line": 2, "end_column": 19});
        let mut edit = json!({"replacement": "-", "text": "replace `+` with `-`"});
        edit.as_object_mut()
            .unwrap()
            .extend(range.as_object().unwrap().clone());
        let mut fix = json!({"id": "wrong-operator", "file": "shaders/a.glsl", "edits": [edit]});
        fix.as_object_mut()
            .unwrap()
            .extend(edit.as_object().unwrap().clone());
        json!({"shaders": [{
            "verdict": "wrong", "reason": "12 % of the pixels differ", "details": ["by much"],
            "mistake": {"id": "wrong-operator", "text": "an operator is wrong", "is_symptom": false},
            "fix": fix, "cause": null,
        }]})
    }

    #[test]
    fn a_verdict_is_a_lens_a_diagnostic_and_a_fix() {
        let (checks, uri, text) = checks(&wrong());
        let lens = checks.lens(&uri, &text, Position::new(0, 0)).unwrap();
        assert_eq!(
            lens.command.unwrap().title,
            "toyproof: wrong: 12 % of the pixels differ"
        );
        let diagnostic = checks.diagnostic(&uri, &text, Encoding::Utf16).unwrap();
        assert_eq!(
            diagnostic.range,
            Range::new(Position::new(1, 17), Position::new(1, 18))
        );
        let message =
            "12 % of the pixels differ\nlikely mistake: an operator is wrong\nhelp: replace `+` with `-`";
        assert_eq!(diagnostic.message, Message::String(message.to_owned()));
        let fix = checks.fix(&uri, &text).unwrap();
        assert_eq!(fix.title, "Correct the image: replace `+` with `-`");
        assert_eq!(crate::edits::apply(TEXT, &fix.edits), TEXT.replace('+', "-"));
    }

    #[test]
    fn an_edited_text_has_only_the_verdict_of_the_saved_one() {
        let (checks, uri, _) = checks(&wrong());
        let edited = File::new("a.glsl", TEXT.replace("p.x", "p.y"));
        let lens = checks.lens(&uri, &edited, Position::new(0, 0)).unwrap();
        let title = lens.command.unwrap().title;
        assert_eq!(
            title,
            "toyproof: wrong (when last saved): 12 % of the pixels differ"
        );
        assert_eq!(checks.diagnostic(&uri, &edited, Encoding::Utf16), None);
        assert_eq!(checks.fix(&uri, &edited), None);
    }

    #[test]
    fn edits_that_hints_hide_are_no_fix() {
        let mut report = wrong();
        let fix = report.pointer_mut("/shaders/0/fix").unwrap();
        fix["text"] = Value::Null;
        fix["edits"][0]["replacement"] = Value::Null;
        let (checks, uri, text) = checks(&report);
        assert_eq!(checks.fix(&uri, &text), None);
        let diagnostic = checks.diagnostic(&uri, &text, Encoding::Utf16).unwrap();
        assert_eq!(diagnostic.range.start.line, 1);
        let Message::String(message) = diagnostic.message else {
            panic!("not plain")
        };
        assert!(!message.contains("replace"), "{message}");
    }

    #[test]
    fn only_the_last_check_counts() {
        let (mut checks, uri, text) = checks(&wrong());
        let output = Output::TimedOut;
        assert!(!checks.finish(CheckResult {
            uri: uri.clone(),
            number: 0,
            output
        }));
        assert!(checks.fix(&uri, &text).is_some());
        let output = Output::Finished {
            out: b"no JSON".to_vec(),
            error: Some("error: no such file".to_owned()),
        };
        assert!(checks.finish(CheckResult {
            uri: uri.clone(),
            number: 1,
            output
        }));
        let lens = checks.lens(&uri, &text, Position::new(0, 0)).unwrap();
        assert_eq!(lens.command.unwrap().title, "toyproof: error: no such file");
        checks.forget(&uri);
        assert!(checks.lens(&uri, &text, Position::new(0, 0)).is_none());
    }
}
