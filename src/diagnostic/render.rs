//! Renderers of diagnostics: for people, for editors (one line) and for programs (JSON).

use std::fmt;

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, Severity as Level};
use codespan_reporting::term::termcolor::Buffer;
use codespan_reporting::term::{self};
use serde::{Deserialize, Serialize};

use super::{Diagnostic, Severity};
use crate::{Files, wrap};

/// Maximum length of a displayed source line in bytes; a longer line would bury the message.
const MAX_SHOWN_LINE_BYTES: usize = 400;

/// Renders the message with its source line, a caret and notes, which are wrapped at `width` columns, if any;
/// with ANSI colors if `color`.
#[must_use]
pub fn human(diagnostic: &Diagnostic, files: &Files, width: Option<usize>, color: bool) -> String {
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
        let notes = diagnostic.notes.iter().map(|note| format!("  = {note}\n"));
        return short(diagnostic, files) + "\n" + &notes.collect::<String>();
    }
    let mut labels = Vec::new();
    if let Some(span) = diagnostic.span {
        let words = diagnostic.label.clone().unwrap_or_default();
        labels.push(Label::primary(span.file, span.start as usize..span.end as usize).with_message(words));
    }
    for (span, words) in &diagnostic.related {
        labels.push(Label::secondary(span.file, span.start as usize..span.end as usize).with_message(words));
    }
    let report = Report::new(level)
        .with_code(diagnostic.code.as_ref())
        .with_message(&diagnostic.message)
        .with_labels(labels)
        .with_notes(
            diagnostic
                .notes
                .iter()
                .map(|note| wrap_note(note, width))
                .collect(),
        );
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

fn wrap_note(note: &str, width: Option<usize>) -> String {
    let width = width.map(|width| width.saturating_sub(NOTE_INDENT));
    let lines = note.lines().map(|line| wrap("", 0, line, width));
    lines.collect::<Vec<_>>().join("\n")
}

/// Formats `file:line:column: error[E0001]: message`, which editors parse.
#[must_use]
pub fn short(diagnostic: &Diagnostic, files: &Files) -> String {
    json(diagnostic, files).to_string()
}

/// The JSON form of a diagnostic.
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
    /// Line, from 1.
    pub line: Option<usize>,
    /// Column in characters, from 1.
    pub column: Option<usize>,
    /// Notes and suggestions.
    pub notes: Vec<String>,
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

impl Json {
    /// The line and column of an error (the inner option is none for an error without a span); none for other
    /// severities.
    #[must_use]
    pub fn error_place(&self) -> Option<Option<(usize, usize)>> {
        (self.severity == Severity::Error).then(|| self.line.zip(self.column))
    }
}

/// Converts a diagnostic to its JSON form: the span is resolved, and the label becomes the first note.
#[must_use]
pub fn json(diagnostic: &Diagnostic, files: &Files) -> Json {
    let place = diagnostic
        .span
        .map(|span| (files.get(span.file).name(), files.position(span)));
    Json {
        severity: diagnostic.severity,
        code: diagnostic.code.to_string(),
        message: diagnostic.message.clone(),
        file: place.map(|(name, _)| name.to_owned()),
        line: place.map(|(_, at)| at.line),
        column: place.map(|(_, at)| at.column),
        notes: diagnostic
            .label
            .iter()
            .chain(&diagnostic.notes)
            .cloned()
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{File, Span};

    fn example() -> (Diagnostic, Files) {
        let mut files = Files::default();
        let id = files.add(File::new("a.glsl", "void f() {\n  é = 1;\n}\n"));
        let diagnostic = Diagnostic::error("E0100", "unknown variable `é`")
            .at(Span::new(id, 13, 15))
            .label("not declared")
            .note("declare it first");
        (diagnostic, files)
    }

    #[test]
    fn the_human_form_shows_the_line_a_caret_and_the_note() {
        let (diagnostic, files) = example();
        let text = human(&diagnostic, &files, None, false);
        assert!(text.contains("error[E0100]: unknown variable `é`"), "{text}");
        assert!(text.contains("a.glsl:2:3"), "{text}");
        assert!(text.contains("^ not declared"), "{text}");
        assert!(text.contains("= declare it first"), "{text}");
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
            ["not declared", "declare it first"]
        );
    }

    #[test]
    fn too_long_lines_are_not_shown() {
        let mut files = Files::default();
        let id = files.add(File::new("a.glsl", "x".repeat(20_000)));
        let diagnostic = Diagnostic::error("E0100", "no")
            .at(Span::new(id, 9_000, 9_001))
            .note("break it");
        assert_eq!(
            human(&diagnostic, &files, None, false),
            "a.glsl:1:9001: error[E0100]: no\n  = break it\n"
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
