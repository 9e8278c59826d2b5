//! Renderers of diagnostics: for people, for editors (one line) and for programs (JSON).

use std::fmt;

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, Severity as Level};
use codespan_reporting::term::termcolor::Buffer;
use codespan_reporting::term::{self};
use serde::{Deserialize, Serialize};

use super::{Diagnostic, Severity};
use crate::{Edit, Files, Fix, Span, wrap};

/// Maximum length of a displayed source line in bytes; a longer line would bury the message.
const MAX_SHOWN_LINE_BYTES: usize = 400;

/// Renders the message with its source lines, carets, notes and help, which are wrapped at `width` columns,
/// if any; with ANSI colors if `color`.
pub fn human(diagnostic: &Diagnostic, files: &Files, width: Option<usize>, color: bool) -> String {
    let diagnostic = &diagnostic.in_origin(files);
    let level = match diagnostic.severity {
        Severity::Error => Level::Error,
        Severity::Warning => Level::Warning,
        Severity::Note => Level::Note,
    };
    let spans = diagnostic
        .span
        .into_iter()
        .chain(diagnostic.related.iter().map(|(span, _)| *span));
    if spans
        .into_iter()
        .any(|span| files.get(span.file).longest_line(span.start, span.end) > MAX_SHOWN_LINE_BYTES)
    {
        let fixes = diagnostic
            .shown_fixes()
            .map(|fix| format!("help: {}", fix.message));
        let lines = fixes.chain(footer(diagnostic, width));
        return lines.fold(short(diagnostic, files) + "\n", |text, line| {
            text + "  = " + &line + "\n"
        });
    }
    // A fix is shown at its place: at the caret if it changes the reported text.
    let mut label = diagnostic.label.as_deref();
    let mut secondary: Vec<_> = diagnostic
        .related
        .iter()
        .map(|(span, text)| (*span, &**text))
        .collect();
    for fix in diagnostic.shown_fixes() {
        match fix.span() {
            Some(span) if label.is_some() || !diagnostic.span.is_some_and(|own| own.touches(span)) => {
                secondary.push((span, &fix.message));
            }
            _ => label = Some(&fix.message),
        }
    }
    let range = |span: Span| span.start as usize..span.end as usize;
    let primary = diagnostic
        .span
        .map(|span| Label::primary(span.file, range(span)).with_message(label.unwrap_or_default()));
    let secondary = secondary
        .into_iter()
        .map(|(span, text)| Label::secondary(span.file, range(span)).with_message(text));
    let labels = primary.into_iter().chain(secondary).collect();
    let report = Report::new(level)
        .with_code(diagnostic.code.as_str())
        .with_message(&diagnostic.message)
        .with_labels(labels)
        .with_notes(footer(diagnostic, width).collect());
    let mut buffer = if color { Buffer::ansi() } else { Buffer::no_color() };
    // Writing to memory fails only for a span outside its file; the one-line form then still reports the
    // error.
    if term::emit_to_write_style(&mut buffer, &term::Config::default(), files, &report).is_err() {
        return short(diagnostic, files) + "\n";
    }
    String::from_utf8_lossy(&buffer.into_inner()).into_owned()
}

/// The columns that precede each line of a note.
const NOTE_INDENT: usize = 8;

/// The lines below the excerpt: notes, then help.
fn footer(diagnostic: &Diagnostic, width: Option<usize>) -> impl Iterator<Item = String> {
    let width = width.map(|width| width.saturating_sub(NOTE_INDENT));
    let labeled = move |label: &str, text: &str| wrap(&format!("{label}: "), label.len() + 2, text, width);
    let notes = diagnostic.notes.iter().map(move |note| labeled("note", note));
    notes.chain(diagnostic.helps.iter().map(move |help| labeled("help", help)))
}

/// Formats `file:line:column: error[E0001]: message`, which editors parse.
pub fn short(diagnostic: &Diagnostic, files: &Files) -> String {
    json(diagnostic, files).to_string()
}

/// The JSON form of a diagnostic. Lines and columns count from 1, columns in characters (Unicode scalar
/// values, not bytes or UTF-16 units). As in the Language Server Protocol, the end is exclusive: the position
/// after the last character. A missing text has equal start and end.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Json {
    /// The severity.
    pub severity: Severity,
    /// `E` or `W` and four digits.
    pub code: String,
    /// One sentence without a full stop.
    pub message: String,
    /// The name of the file, if there is one.
    pub file: Option<String>,
    /// The line of the first character.
    pub line: Option<usize>,
    /// The column of the first character.
    pub column: Option<usize>,
    /// The line of the end.
    #[serde(default)]
    pub end_line: Option<usize>,
    /// The column of the end, exclusive.
    #[serde(default)]
    pub end_column: Option<usize>,
    /// The edit of `file` that corrects the error, if there is a mechanical one.
    #[serde(default)]
    pub fix: Option<JsonFix>,
    /// Further lines: the label at the caret, the messages of fixes, notes, and help.
    pub notes: Vec<String>,
}

/// A replacement of text, with positions as in [`Json`]; an insertion has equal start and end.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct JsonFix {
    /// The advice, such as ``write `1.0` ``.
    pub message: String,
    /// The text that replaces the range.
    pub replacement: String,
    /// The line of the first replaced character.
    pub line: usize,
    /// The column of the first replaced character.
    pub column: usize,
    /// The line of the end.
    pub end_line: usize,
    /// The column of the end, exclusive.
    pub end_column: usize,
}

/// Formats `file:line:column: error[E0001]: message`, which editors parse.
impl fmt::Display for Json {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some(file), Some(line), Some(column)) = (&self.file, self.line, self.column) {
            write!(f, "{file}:{line}:{column}: ")?;
        }
        write!(f, "{}[{}]: {}", self.severity, self.code, self.message)
    }
}

/// Converts a diagnostic to its JSON form, with all spans resolved.
pub fn json(diagnostic: &Diagnostic, files: &Files) -> Json {
    let diagnostic = &diagnostic.in_origin(files);
    let name = |span: Span| files.get(span.file).name().to_owned();
    let start = diagnostic.span.map(|span| files.position(span));
    let end = diagnostic.span.map(|span| files.end_position(span));
    let fixes = diagnostic.shown_fixes().map(|fix| &fix.message);
    let label = diagnostic.label.iter();
    let lines = label
        .chain(fixes)
        .chain(&diagnostic.notes)
        .chain(&diagnostic.helps);
    Json {
        severity: diagnostic.severity,
        code: diagnostic.code.to_string(),
        message: diagnostic.message.clone(),
        file: diagnostic.span.map(name),
        line: start.map(|at| at.line),
        column: start.map(|at| at.column),
        end_line: end.map(|at| at.line),
        end_column: end.map(|at| at.column),
        fix: json_fix(diagnostic, files),
        notes: lines.cloned().collect(),
    }
}

/// Merges all edits of a diagnostic's fixes into one replacement: of the text from the first edit to the
/// last.
fn json_fix(diagnostic: &Diagnostic, files: &Files) -> Option<JsonFix> {
    let whole = diagnostic.fixes.iter().filter_map(Fix::span).reduce(Span::to)?;
    let mut edits: Vec<&Edit> = diagnostic.fixes.iter().flat_map(|fix| &fix.edits).collect();
    edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
    let mut replacement = String::new();
    let mut done = whole.start;
    for edit in edits {
        // Text that two fixes change differently has no single correction.
        if edit.span.file != whole.file || edit.span.start < done {
            return None;
        }
        replacement += files.text(Span::new(whole.file, done, edit.span.start));
        replacement += &edit.replacement;
        done = edit.span.end;
    }
    let (start, end) = (files.position(whole), files.end_position(whole));
    let messages: Vec<_> = diagnostic.fixes.iter().map(|fix| fix.message.as_str()).collect();
    Some(JsonFix {
        message: messages.join("; "),
        replacement,
        line: start.line,
        column: start.column,
        end_line: end.line,
        end_column: end.column,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Code, File};

    fn example() -> (Diagnostic, Files) {
        let mut files = Files::default();
        let id = files.add(File::new("a.glsl", "void f() {\n  é = 1;\n}\n"));
        let diagnostic = Diagnostic::new(Code::Syntax, "unknown variable `é`")
            .at(Span::new(id, 13, 15))
            .label("not declared")
            .note("names are case-sensitive")
            .help("declare it first");
        (diagnostic, files)
    }

    #[test]
    fn the_human_form_shows_the_line_a_caret_and_the_note() {
        let (diagnostic, files) = example();
        let text = human(&diagnostic, &files, None, false);
        assert!(text.contains("error[E0100]: unknown variable `é`"), "{text}");
        assert!(text.contains("a.glsl:2:3"), "{text}");
        assert!(text.contains("^ not declared"), "{text}");
        assert!(text.contains("= note: names are case-sensitive\n"), "{text}");
        assert!(text.contains("= help: declare it first\n"), "{text}");
        assert!(!text.contains('\u{1b}'));
        assert!(human(&diagnostic, &files, None, true).contains('\u{1b}'));
    }

    #[test]
    fn the_short_form_is_one_line() {
        let (diagnostic, files) = example();
        assert_eq!(
            short(&diagnostic, &files),
            "a.glsl:2:3: error[E0100]: unknown variable `é`"
        );
    }

    #[test]
    fn json_notes_include_the_label() {
        let (diagnostic, files) = example();
        assert_eq!(
            json(&diagnostic, &files).notes,
            ["not declared", "names are case-sensitive", "declare it first"]
        );
    }

    #[test]
    fn json_positions_count_characters_and_exclude_the_end() {
        let (diagnostic, files) = example();
        let json = json(&diagnostic, &files);
        assert_eq!((json.line, json.column), (Some(2), Some(3)));
        assert_eq!((json.end_line, json.end_column), (Some(2), Some(4)));
        assert_eq!(json.fix, None);
    }

    #[test]
    fn fixes_are_shown_once_and_merged_into_one_edit() {
        let mut files = Files::default();
        let id = files.add(File::new("a.glsl", "é = saturate(x);\n"));
        let span = |start, end| Span::new(id, start, end);
        let fix =
            Fix::new("write `clamp(x, 0.0, 1.0)`", span(5, 13), "clamp").and(span(15, 15), ", 0.0, 1.0");
        let diagnostic = Diagnostic::new(Code::Undeclared, "unknown function `saturate`")
            .at(span(5, 13))
            .fix(fix);
        let text = human(&diagnostic, &files, None, false);
        assert_eq!(text.matches("write `clamp(x, 0.0, 1.0)`").count(), 1, "{text}");
        assert!(text.contains("^^^^^^^^ write `clamp"), "{text}");
        let merged = JsonFix {
            message: "write `clamp(x, 0.0, 1.0)`".to_owned(),
            replacement: "clamp(x, 0.0, 1.0".to_owned(),
            line: 1,
            column: 5,
            end_line: 1,
            end_column: 15,
        };
        assert_eq!(json(&diagnostic, &files).fix, Some(merged));
        let named = Diagnostic::new(Code::Undeclared, "unknown name `a`; did you mean `b`?").at(span(13, 14));
        let named = named.fix(Fix::new("did you mean `b`?", span(13, 14), "b"));
        assert_eq!(
            human(&named, &files, None, false).matches("did you mean").count(),
            1
        );
        assert!(json(&named, &files).notes.is_empty());
        let contradictory = named
            .clone()
            .fix(Fix::new("did you mean `c`?", span(13, 14), "c"));
        assert_eq!(json(&contradictory, &files).fix, None);
    }

    #[test]
    fn too_long_lines_are_not_shown() {
        let mut files = Files::default();
        let id = files.add(File::new("a.glsl", "x".repeat(20_000)));
        let diagnostic = Diagnostic::new(Code::Syntax, "no")
            .at(Span::new(id, 9_000, 9_001))
            .help("break it");
        assert_eq!(
            human(&diagnostic, &files, None, false),
            "a.glsl:1:9001: error[E0100]: no\n  = help: break it\n"
        );
    }

    #[test]
    fn a_span_past_the_end_still_renders() {
        let (diagnostic, files) = example();
        let span = Span {
            end: 4000,
            start: 3000,
            ..diagnostic.span.unwrap()
        };
        let text = human(&diagnostic.at(span), &files, None, false);
        assert!(text.contains("unknown variable"), "{text}");
    }
}
