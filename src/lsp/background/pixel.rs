//! The values of a pixel as inlay hints: what each line computes, in f32, and in f64 where they part.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use lsp_types::{InlayHint, Label, Position, Range, Tooltip, Uri};
use serde::Deserialize;
use serde_json::Value;
use toyproof_diagnostic::File;
use toyproof_project::files::is_project;

use super::{Job, Output};
use crate::encoding::Encoding;
use crate::settings::CheckSettings;

/// The time limit of a trace.
const TIME_LIMIT: Duration = Duration::from_secs(30);

/// The most characters of a hint.
const MAX_HINT_CHARS: usize = 80;

/// The most values in the tooltip of a hint.
const MAX_TOOLTIP_VALUES: usize = 24;

/// The values of a pixel, or why there are none.
#[derive(Debug)]
pub(crate) struct PixelValues {
    pub(crate) uri: Uri,
    number: u64,
    output: Output,
}

/// The pixels whose values are shown, one for each document.
#[derive(Debug, Default)]
pub(crate) struct Pixels {
    number: u64,
    documents: BTreeMap<String, Traced>,
}

/// The pixel of a document.
#[derive(Debug)]
struct Traced {
    number: u64,
    pixel: [u32; 2],
    /// The text that was traced.
    text: File,
    /// The process that traces; `None` once it has ended.
    job: Option<Job>,
    /// The hints by line from 0: what is shown, and all values of the line.
    lines: BTreeMap<usize, Line>,
}

#[derive(Debug, Default)]
struct Line {
    values: Vec<String>,
}

#[derive(Debug, Deserialize)]
struct Trace {
    steps: Vec<Step>,
}

#[derive(Debug, Deserialize)]
struct Step {
    kind: String,
    #[serde(default)]
    file: Option<String>,
    line: usize,
    text: String,
    name: Option<String>,
    #[serde(default)]
    iterations: Vec<u32>,
    f32: Option<Vec<Value>>,
    f64: Option<Vec<Value>>,
    ulp: Option<f64>,
}

/// From this difference on, in units in the last place of f32, the value in f64 is shown: smaller ones are
/// rounding of one operation.
const SHOWN_ULPS: f64 = 4.0;

impl Pixels {
    /// Starts to trace a pixel of a document as it is on disk.
    pub(crate) fn start(
        &mut self,
        executable: &Path,
        folder: &Path,
        (uri, path, text): (&Uri, &Path, &File),
        pixel: [u32; 2],
        settings: &CheckSettings,
        done: impl FnOnce(PixelValues) + Send + 'static,
    ) {
        self.number += 1;
        let number = self.number;
        let parent = path.parent().unwrap_or(path);
        let mut command = Command::new(executable);
        command.current_dir(folder).arg("debug");
        if is_project(parent) {
            command.arg(parent);
            // The tab of a pass has its name; Common is seen in the image.
            let pass = path.file_stem().filter(|name| *name != "common");
            command.arg("--pass").arg(pass.unwrap_or("image".as_ref()));
        } else {
            command.arg(path);
        }
        let [x, y] = pixel;
        command.args([
            "--pixel",
            &format!("{x},{y}"),
            "--format",
            "json",
            "--color",
            "never",
        ]);
        settings.add_reference(&mut command);
        let result = uri.clone();
        let job = Job::start(command, TIME_LIMIT, move |output| {
            done(PixelValues {
                uri: result,
                number,
                output,
            });
        });
        let traced = Traced {
            number,
            pixel,
            text: text.clone(),
            job: job.ok(),
            lines: BTreeMap::new(),
        };
        self.documents.insert(uri.0.clone(), traced);
    }

    /// Takes over the values of a pixel, unless another one has been chosen meanwhile.
    ///
    /// # Errors
    /// Why there are no values.
    pub(crate) fn finish(&mut self, values: PixelValues) -> Result<(), String> {
        let Some(traced) = self.documents.get_mut(&values.uri.0) else {
            return Ok(());
        };
        if traced.number != values.number {
            return Ok(());
        }
        traced.job = None;
        let (out, error) = match values.output {
            Output::TimedOut => return Err("the trace of the pixel exceeded its time limit".to_owned()),
            Output::Finished { out, error } => (out, error),
        };
        let trace: Trace = serde_json::from_slice(&out)
            .map_err(|_| error.unwrap_or_else(|| "the pixel cannot be traced".to_owned()))?;
        traced.lines = lines(&trace, &traced.text);
        Ok(())
    }

    /// The pixel whose values are shown in a document.
    pub(crate) fn pixel(&self, uri: &Uri) -> Option<[u32; 2]> {
        self.documents.get(&uri.0).map(|traced| traced.pixel)
    }

    /// Shows no values in a document any more.
    pub(crate) fn forget(&mut self, uri: &Uri) {
        self.documents.remove(&uri.0);
    }

    /// The hints of a range of a document, as long as its text is what was traced.
    pub(crate) fn hints(&self, uri: &Uri, text: &File, range: Range, encoding: Encoding) -> Vec<InlayHint> {
        let Some(traced) = self.documents.get(&uri.0) else {
            return Vec::new();
        };
        if traced.text.text() != text.text() {
            return Vec::new();
        }
        let lines = traced
            .lines
            .range(range.start.line as usize..=(range.end.line as usize).max(range.start.line as usize));
        lines
            .filter_map(|(&line, found)| hint(found, line, text, encoding))
            .collect()
    }
}

fn hint(found: &Line, line: usize, text: &File, encoding: Encoding) -> Option<InlayHint> {
    let range = text.line_range(line)?;
    let end = range.start + text.text()[range].trim_end().len();
    let position: Position = encoding.position(text, end as u32);
    let last = found.values.last()?;
    let shown: String = if last.chars().count() > MAX_HINT_CHARS {
        last.chars().take(MAX_HINT_CHARS - 1).chain(['…']).collect()
    } else {
        last.clone()
    };
    let mut all: Vec<_> = found.values.iter().take(MAX_TOOLTIP_VALUES).cloned().collect();
    let rest = found.values.len() - all.len();
    if rest > 0 {
        all.push(format!("… {rest} more"));
    }
    Some(InlayHint {
        position,
        label: Label::String(shown),
        kind: None,
        text_edits: None,
        tooltip: (found.values.len() > 1).then(|| Tooltip::String(all.join("\n"))),
        padding_left: Some(true),
        padding_right: None,
        data: None,
    })
}

/// What each line computes: of all its steps what is stored or decided, the last one last.
fn lines(trace: &Trace, text: &File) -> BTreeMap<usize, Line> {
    let mut lines: BTreeMap<usize, Line> = BTreeMap::new();
    for step in &trace.steps {
        let is_here = step.file.as_deref().is_none_or(|file| {
            Path::new(file)
                .file_name()
                .is_some_and(|name| *name == *text.name())
        });
        if !is_here || step.kind == "subexpression" || step.kind == "statement" {
            continue;
        }
        let (single, double) = (step.f32.as_deref(), step.f64.as_deref());
        let Some(value) = single.or(double) else { continue };
        let name = match (step.kind.as_str(), &step.name) {
            ("return", _) => "return",
            (_, Some(name)) => name,
            _ => &step.text,
        };
        let parts =
            step.ulp.is_some_and(|ulps| ulps >= SHOWN_ULPS) || (single != double && step.ulp.is_none());
        let other = match double {
            Some(double) if parts && single.is_some() => format!(" (f64: {})", shown(double, DOUBLE_DIGITS)),
            None => " (f32 only)".to_owned(),
            Some(_) if single.is_none() => " (f64 only)".to_owned(),
            Some(_) => String::new(),
        };
        let iteration = step.iterations.last().map(|number| format!("[{number}] "));
        let value = format!(
            "{}{name} = {}{other}",
            iteration.unwrap_or_default(),
            shown(value, SINGLE_DIGITS)
        );
        lines
            .entry(step.line.saturating_sub(1))
            .or_default()
            .values
            .push(value);
    }
    lines
}

/// The significant digits of values in f32: those that it has.
const SINGLE_DIGITS: usize = 7;

/// The significant digits of values in f64 beside those in f32: enough to see where they part.
const DOUBLE_DIGITS: usize = 10;

/// The components of a value.
fn shown(value: &[Value], digits: usize) -> String {
    let component = |component: &Value| match component {
        Value::Number(number) => match number.as_f64().filter(|_| number.is_f64()) {
            Some(float) => number_text(float, digits),
            None => number.to_string(),
        },
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let components: Vec<_> = value.iter().map(component).collect();
    match &components[..] {
        [only] => only.clone(),
        _ => format!("({})", components.join(", ")),
    }
}

/// A float with at most that many significant digits.
fn number_text(float: f64, digits: usize) -> String {
    let magnitude = float.abs();
    if magnitude != 0.0 && !(1e-4..1e7).contains(&magnitude) {
        return format!("{float:.*e}", digits - 1);
    }
    let whole = if magnitude < 1.0 {
        0
    } else {
        magnitude.log10().floor() as usize
    };
    let text = format!("{float:.*}", digits - 1 - whole.min(digits - 1));
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const TEXT: &str = "float f(float x) {\n    return x * 2.;\n}\n\
                        void mainImage(out vec4 c, in vec2 p) {\n    float s = 0.;\n    for (int i = 0; i < 2; i++)\n        s += f(1e-9);\n    c = vec4(s);\n}\n";

    fn pixels(trace: &Value, text: &File) -> (Pixels, Uri) {
        let uri = Uri("file:///a.glsl".to_owned());
        let traced = Traced {
            number: 1,
            pixel: [1, 2],
            text: text.clone(),
            job: None,
            lines: BTreeMap::new(),
        };
        let mut pixels = Pixels::default();
        pixels.documents.insert(uri.0.clone(), traced);
        let out = serde_json::to_vec(trace).unwrap();
        let output = Output::Finished { out, error: None };
        pixels
            .finish(PixelValues {
                uri: uri.clone(),
                number: 1,
                output,
            })
            .unwrap();
        (pixels, uri)
    }

    fn step(kind: &str, line: usize, name: Option<&str>, f32: &Value, f64: &Value, more: &Value) -> Value {
        let mut step = json!({"kind": kind, "line": line, "text": "text", "name": name, "f32": f32, "f64": f64,
            "ulp": null});
        step.as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        step
    }

    #[test]
    fn lines_show_what_they_store() {
        let none = json!({});
        let trace = json!({"steps": [
            step("assignment", 5, Some("s"), &json!([0.0]), &json!([0.0]), &none),
            step("return", 2, None, &json!([2e-9]), &json!([2e-9]), &none),
            step("assignment", 7, Some("s"), &json!([2e-9]), &json!([2e-9]), &json!({"iterations": [1]})),
            step("assignment", 7, Some("s"), &json!([4e-9]), &json!([4e-9]), &json!({"iterations": [2]})),
            step("subexpression", 8, None, &json!([4e-9]), &json!([4e-9]), &none),
            step("assignment", 8, Some("c"), &json!([0.5, 1.0]), &json!([0.25, 1.0]), &json!({"ulp": 9.0})),
            step("assignment", 8, Some("d"), &json!(["NaN"]), &Value::Null, &json!({"file": "other.glsl"})),
        ]});
        let text = File::new("a.glsl", TEXT);
        let (pixels, uri) = pixels(&trace, &text);
        let all = Range::new(Position::new(0, 0), Position::new(99, 0));
        let shown: Vec<_> = pixels
            .hints(&uri, &text, all, Encoding::Utf16)
            .into_iter()
            .map(|hint| {
                let Label::String(label) = hint.label else {
                    panic!("parts")
                };
                let Some(Tooltip::String(tooltip)) = hint.tooltip else {
                    return (hint.position.line, label, String::new());
                };
                (hint.position.line, label, tooltip)
            })
            .collect();
        let of = |line, label: &str, tooltip: &str| (line, label.to_owned(), tooltip.to_owned());
        assert_eq!(
            shown,
            [
                of(1, "return = 2.000000e-9", ""),
                of(4, "s = 0", ""),
                of(
                    6,
                    "[2] s = 4.000000e-9",
                    "[1] s = 2.000000e-9\n[2] s = 4.000000e-9"
                ),
                of(7, "c = (0.5, 1) (f64: (0.25, 1))", ""),
            ]
        );
        let part = Range::new(Position::new(2, 0), Position::new(5, 0));
        assert_eq!(pixels.hints(&uri, &text, part, Encoding::Utf16).len(), 1);
        let edited = File::new("a.glsl", format!("\n{TEXT}"));
        assert!(pixels.hints(&uri, &edited, all, Encoding::Utf16).is_empty());
    }

    #[test]
    fn a_trace_that_fails_says_why() {
        let text = File::new("a.glsl", TEXT);
        let (mut pixels, uri) = pixels(&json!({"steps": []}), &text);
        let error = Some("error: pixel (1, 2) is outside the image".to_owned());
        let output = Output::Finished {
            out: Vec::new(),
            error,
        };
        let failed = pixels.finish(PixelValues {
            uri: uri.clone(),
            number: 1,
            output,
        });
        assert_eq!(failed.unwrap_err(), "error: pixel (1, 2) is outside the image");
        pixels.forget(&uri);
        assert!(
            pixels
                .finish(PixelValues {
                    uri,
                    number: 1,
                    output: Output::TimedOut
                })
                .is_ok()
        );
    }
}
