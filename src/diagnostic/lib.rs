//! Diagnostics about spans of source files: one value, rendered for a terminal, for an editor and as JSON.
//! [`Code`] is the table of all kinds of diagnostics of the program, with their explanations.
//!
//! ```
//! use toyproof_diagnostic::{Code, Diagnostic, File, Files, Span, short};
//!
//! let mut files = Files::default();
//! let file = files.add(File::new("wave.glsl", "float wave = sine(x);\n"));
//! let unknown = Diagnostic::new(Code::Undeclared, "unknown function `sine`").at(Span::new(file, 13, 17));
//! assert_eq!(short(&unknown, &files), "wave.glsl:1:14: error[E0200]: unknown function `sine`");
//! ```
//!
//! # Parts
//!
//! - `file`: files, spans, lines and columns; joined files, whose spans are reported in their parts.
//! - `render`: a diagnostic for people, for editors (one line) and as JSON.
//! - `text`: escaping of untrusted names and texts, suggestions, numbers in sentences.
//! - `layout`: display width, wrapping and aligned columns.
//! - `deadline`: [`Deadline`], which loops over a shader poll, and which rarely reads the clock.

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;

mod code;
mod date;
mod deadline;
mod file;
mod layout;
mod render;
mod text;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use self::code::{Code, IN_MACRO};
pub use self::date::Date;
pub use self::deadline::{Deadline, Overdue};
pub use self::file::{File, FileId, Files, Place, Position, Span};
pub use self::layout::{columns, display_width, wrap};
pub use self::render::{Json, JsonFix, human, json, short};
pub use self::text::{
    all_of, color_difference, grouped, magnitude, nearest, one_of, path_name, plural, printable,
    printable_lines, similar, spreadsheet_text, without_error_numbers,
};

/// The severity of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The operation failed.
    Error,
    /// The operation succeeded, but the image may not be what the author intended.
    Warning,
    /// Additional information.
    Note,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        })
    }
}

/// Maximum length of a message in bytes: messages quote shaders, in which one word may be as long as the
/// file.
const MAX_MESSAGE_BYTES: usize = 1000;

/// The text on one line, with control characters escaped, truncated in the middle if too long.
fn one_line(text: impl Into<String>) -> String {
    truncate_middle(printable(&text.into()).into_owned())
}

/// The text with control characters except line feeds escaped, truncated in the middle if too long.
fn several_lines(text: &str) -> String {
    truncate_middle(printable_lines(text).into_owned())
}

/// The text, truncated in the middle if too long.
fn truncate_middle(mut text: String) -> String {
    if text.len() > MAX_MESSAGE_BYTES {
        let whole = text.len();
        let boundary = |from: usize| (from..whole).find(|&at| text.is_char_boundary(at));
        let [start, end] = [MAX_MESSAGE_BYTES * 3 / 4, whole - MAX_MESSAGE_BYTES / 4]
            .map(|from| boundary(from).unwrap_or(whole));
        text.replace_range(start..end, " … ");
    }
    text
}

/// An edit of the source text that a diagnostic proposes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Edit {
    /// The text to replace; empty for an insertion.
    pub span: Span,
    /// The replacement.
    pub replacement: String,
}

/// A mechanical correction of the error that a diagnostic reports.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fix {
    /// The advice, such as ``write `1.0` ``.
    pub message: String,
    /// The edits, which do not overlap and apply together; at least one, all of one file.
    pub edits: Vec<Edit>,
}

impl Fix {
    /// A fix that replaces one span.
    pub fn new(message: impl Into<String>, span: Span, replacement: impl Into<String>) -> Self {
        let replacement = replacement.into();
        Self {
            message: one_line(message),
            edits: vec![Edit { span, replacement }],
        }
    }

    /// Adds an edit.
    #[must_use]
    pub fn and(mut self, span: Span, replacement: impl Into<String>) -> Self {
        let replacement = replacement.into();
        self.edits.push(Edit { span, replacement });
        self
    }

    /// The text that all edits cover.
    fn span(&self) -> Option<Span> {
        let spans = self.edits.iter().map(|edit| edit.span);
        spans.reduce(Span::to)
    }
}

/// A diagnostic about a source text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// The severity.
    pub severity: Severity,
    /// The kind, whose string form is stable: `E` and four digits for errors, `W` for warnings and notes.
    pub code: Code,
    /// One sentence without a full stop, in the terms of the file's language.
    pub message: String,
    /// The span; `None` if the diagnostic concerns a whole file or no file.
    pub span: Option<Span>,
    /// A short text at the caret.
    pub label: Option<String>,
    /// Other relevant spans, each with a short text.
    pub related: Vec<(Span, String)>,
    /// Corrections. If there are several, each corrects a part of the error.
    pub fixes: Vec<Fix>,
    /// Additional information: why it is an error, or what follows from it.
    pub notes: Vec<String>,
    /// Advice on what to do.
    pub helps: Vec<String>,
}

impl Diagnostic {
    /// Makes a diagnostic with the severity of its code.
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            severity: code.severity(),
            code,
            message: one_line(message),
            span: None,
            label: None,
            related: Vec::new(),
            fixes: Vec::new(),
            notes: Vec::new(),
            helps: Vec::new(),
        }
    }

    /// Sets the span.
    #[must_use]
    pub fn at(mut self, span: Span) -> Self {
        self.span = Some(span);
        self
    }

    /// Sets the text at the caret.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(one_line(label));
        self
    }

    /// Adds a related span.
    #[must_use]
    pub fn related(mut self, span: Span, text: impl Into<String>) -> Self {
        self.related.push((span, one_line(text)));
        self
    }

    /// Adds a fix. Its message is shown at its place, unless the diagnostic's message contains it.
    #[must_use]
    pub fn fix(mut self, fix: Fix) -> Self {
        self.fixes.push(fix);
        self
    }

    /// Adds a note.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(several_lines(&note.into()));
        self
    }

    /// Adds a line of advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.helps.push(several_lines(&help.into()));
        self
    }

    /// The diagnostic with all spans in the files of the user ([`Files::origin`]).
    #[must_use]
    pub fn in_origin(&self, files: &Files) -> Self {
        let mut moved = self.clone();
        let fixes = moved.fixes.iter_mut().flat_map(|fix| &mut fix.edits);
        let related = moved.related.iter_mut().map(|(span, _)| span);
        for span in moved
            .span
            .iter_mut()
            .chain(related)
            .chain(fixes.map(|edit| &mut edit.span))
        {
            *span = files.origin(*span);
        }
        moved
    }

    /// The fixes whose messages are not part of the diagnostic's message.
    fn shown_fixes(&self) -> impl Iterator<Item = &Fix> {
        let fixes = self.fixes.iter();
        fixes.filter(|fix| !self.message.contains(&fix.message))
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}[{}]: {}", self.severity, self.code, self.message)
    }
}

/// The diagnostics of a text with errors, as an error that `?` passes on. It displays one line for each
/// diagnostic, in the form of [`short`], and so does `Debug`, which is what `main` prints.
#[derive(Clone, PartialEq, Eq, Default)]
pub struct Diagnostics {
    diagnostics: Vec<Diagnostic>,
    text: String,
}

impl Diagnostics {
    /// Diagnostics about these files.
    pub fn new(diagnostics: Vec<Diagnostic>, files: &Files) -> Self {
        let lines: Vec<_> = diagnostics.iter().map(|one| short(one, files)).collect();
        Self {
            text: lines.join("\n"),
            diagnostics,
        }
    }
}

/// Diagnostics about texts that are not available: they are displayed without positions.
impl From<Vec<Diagnostic>> for Diagnostics {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        let lines: Vec<_> = diagnostics.iter().map(ToString::to_string).collect();
        Self {
            text: lines.join("\n"),
            diagnostics,
        }
    }
}

impl From<Diagnostics> for Vec<Diagnostic> {
    fn from(diagnostics: Diagnostics) -> Self {
        diagnostics.diagnostics
    }
}

impl std::ops::Deref for Diagnostics {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        &self.diagnostics
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.diagnostics.iter()
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.diagnostics.into_iter()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl fmt::Debug for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagnostics_are_an_error_with_positions() {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", "x\ny z"));
        let all = vec![
            Diagnostic::new(Code::UnknownCharacter, "no y").at(Span::new(file, 2, 3)),
            Diagnostic::new(Code::UnknownExtension, "no file"),
        ];
        let error: Box<dyn std::error::Error> = Diagnostics::new(all.clone(), &files).into();
        let lines = "a.glsl:2:1: error[E0001]: no y\nwarning[W0002]: no file";
        assert_eq!(
            (error.to_string(), format!("{error:?}")),
            (lines.to_owned(), lines.to_owned())
        );
        let unplaced = Diagnostics::from(all.clone()).to_string();
        assert_eq!(unplaced, "error[E0001]: no y\nwarning[W0002]: no file");
        assert_eq!(Vec::from(Diagnostics::from(all.clone())), all);
    }

    #[test]
    fn long_messages_are_truncated_in_the_middle() {
        let message = |text: &str| Diagnostic::new(Code::UnknownCharacter, text).message;
        assert_eq!(
            message(&"é".repeat(MAX_MESSAGE_BYTES / 2)),
            "é".repeat(MAX_MESSAGE_BYTES / 2)
        );
        let cut = message(&format!("`{}` is too long", "é".repeat(MAX_MESSAGE_BYTES)));
        assert!(
            cut.starts_with("`éé") && cut.ends_with("éé` is too long"),
            "{cut}"
        );
        assert!(cut.contains(" … ") && cut.len() < MAX_MESSAGE_BYTES + 10, "{cut}");
        let note = Diagnostic::new(Code::UnknownCharacter, "").note("x".repeat(1 << 20));
        assert!(note.notes[0].len() < MAX_MESSAGE_BYTES + 10);
    }
}
