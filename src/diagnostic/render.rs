//! A diagnostic for people, for editors (one line) and for programs (JSON).

use std::fmt;

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, Severity as Level};
use codespan_reporting::term::termcolor::Buffer;
use codespan_reporting::term::{self};
use serde::{Deserialize, Serialize};

use super::{Diagnostic, Severity};
use crate::Files;

/// The longest source line that is shown, in bytes; a longer one hides what it should show.
const MAX_LINE: usize = 400;

/// The message with the source line, a caret and its notes; with ANSI colours if `colour`.
#[must_use]
pub fn human(diagnostic: &Diagnostic, files: &Files, colour: bool) -> String {
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
        .any(|span| files.get(span.file).longest_line(span.start, span.end) > MAX_LINE)
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
        .with_notes(diagnostic.notes.clone());
    let mut buffer = if colour {
        Buffer::ansi()
    } else {
        Buffer::no_color()
    };
    // Writing to memory fails for a span outside its file only; the one-line form then still tells.
    if term::emit_to_write_style(&mut buffer, &term::Config::default(), files, &report).is_err() {
        return short(diagnostic, files) + "\n";
    }
    String::from_utf8_lossy(&buffer.into_inner()).into_owned()
}

/// `file:line:column: error[E0001]: message`, as editors read it.
#[must_use]
pub fn short(diagnostic: &Diagnostic, files: &Files) -> String {
    json(diagnostic, files).to_string()
}

/// A diagnostic as programs read it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Json {
    /// How bad it is.
    pub severity: Severity,
    /// `E` or `W` and four digits.
    pub code: String,
    /// One sentence without a full stop.
    pub message: String,
    /// The name of the file it is about, if it is about one.
    pub file: Option<String>,
    /// Counted from 1.
    pub line: Option<usize>,
    /// Counted from 1, in characters.
    pub column: Option<usize>,
    /// What to do about it, and what else helps.
    pub notes: Vec<String>,
}

/// `file:line:column: error[E0001]: message`, as editors read it.
impl fmt::Display for Json {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some(file), Some(line), Some(column)) = (&self.file, self.line, self.column) {
            write!(f, "{file}:{line}:{column}: ")?;
        }
        write!(f, "{}[{}]: {}", self.severity, self.code, self.message)
    }
}

impl Json {
    /// The line and column of an error; none of the two for one about no place.
    #[must_use]
    pub fn error_place(&self) -> Option<Option<(usize, usize)>> {
        (self.severity == Severity::Error).then(|| self.line.zip(self.column))
    }
}

/// The one JSON form of a diagnostic: place resolved, what is written beside the place put before the notes.
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
        let text = human(&diagnostic, &files, false);
        assert!(text.contains("error[E0100]: unknown variable `é`"), "{text}");
        assert!(text.contains("a.glsl:2:3"), "{text}");
        assert!(text.contains("^ not declared"), "{text}");
        assert!(text.contains("= declare it first"), "{text}");
        assert!(!text.contains('\u{1b}'));
        assert!(human(&diagnostic, &files, true).contains('\u{1b}'));
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
    fn programs_are_told_what_stands_beside_the_line() {
        let (diagnostic, files) = example();
        assert_eq!(
            json(&diagnostic, &files).notes,
            ["not declared", "declare it first"]
        );
    }

    #[test]
    fn a_line_too_long_to_show_is_named_by_its_column() {
        let mut files = Files::default();
        let id = files.add(File::new("a.glsl", "x".repeat(20_000)));
        let diagnostic = Diagnostic::error("E0100", "no")
            .at(Span::new(id, 9_000, 9_001))
            .note("break it");
        assert_eq!(
            human(&diagnostic, &files, false),
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
        let text = human(&diagnostic.at(span), &files, false);
        assert!(text.contains("unknown variable"), "{text}");
    }
}
