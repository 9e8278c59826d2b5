//! Texts with spans that lead back to a line and a column, and diagnostics of them: one value, rendered for a terminal,
//! for an editor and as JSON. What every analysis of a text needs, whatever the language.
//!
//! ```
//! use toyproof_diagnostic::{Diagnostic, File, Files, Span, short};
//!
//! let mut files = Files::default();
//! let file = files.add(File::new("wave.glsl", "float wave = sine(x);\n"));
//! let unknown = Diagnostic::error("E0201", "unknown function `sine`").at(Span::new(file, 13, 17));
//! assert_eq!(short(&unknown, &files), "wave.glsl:1:14: error[E0201]: unknown function `sine`");
//! ```

mod deadline;
mod file;
mod printable;
mod render;
mod span;
mod suggest;

use std::borrow::Cow;
use std::fmt;

pub use deadline::{Deadline, Overdue};
pub use file::{File, FileId, Files, Position};
pub use printable::{path_name, printable, printable_lines};
pub use render::{Json, human, json, short};
use serde::{Deserialize, Serialize};
pub use span::Span;
pub use suggest::nearest;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The work cannot be done.
    Error,
    /// The work is done; the picture may not be what the author meant.
    Warning,
    /// Worth knowing.
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

/// The longest text of a message, in bytes: messages quote shaders, one word of which may be as long as a file.
const LONGEST: usize = 1000;

/// A text on one line without control characters, or its beginning and its end.
fn one_line(text: impl Into<String>) -> String {
    shortened(printable(&text.into()).into_owned())
}

/// A text, or its beginning and its end.
fn shortened(mut text: String) -> String {
    if text.len() > LONGEST {
        let whole = text.len();
        let boundary = |from: usize| (from..whole).find(|&at| text.is_char_boundary(at));
        let [start, end] = [LONGEST * 3 / 4, whole - LONGEST / 4].map(|from| boundary(from).unwrap_or(whole));
        text.replace_range(start..end, " … ");
    }
    text
}

/// One message about an author's text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// A stable code: `E` and four digits for errors, `W` for warnings.
    pub code: Cow<'static, str>,
    /// One sentence without a full stop, in the vocabulary of the file it speaks of.
    pub message: String,
    /// Where; none when it is about the whole file or about no file.
    pub span: Option<Span>,
    /// A few words to stand at the caret.
    pub label: Option<String>,
    /// Other places that matter, each with a few words.
    pub related: Vec<(Span, String)>,
    /// What to do about it, and what else helps.
    pub notes: Vec<String>,
}

impl Diagnostic {
    /// A message of that severity.
    pub fn new(severity: Severity, code: impl Into<Cow<'static, str>>, message: impl Into<String>) -> Self {
        Self {
            severity,
            code: code.into(),
            message: one_line(message),
            span: None,
            label: None,
            related: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// An error.
    pub fn error(code: impl Into<Cow<'static, str>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message)
    }

    /// A warning.
    pub fn warning(code: impl Into<Cow<'static, str>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message)
    }

    /// The same, about that place.
    #[must_use]
    pub fn at(mut self, span: Span) -> Self {
        self.span = Some(span);
        self
    }

    /// The same, with a few words at the caret.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(one_line(label));
        self
    }

    /// The same, with another place that matters.
    #[must_use]
    pub fn related(mut self, span: Span, words: impl Into<String>) -> Self {
        self.related.push((span, one_line(words)));
        self
    }

    /// The same, with a note.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes
            .push(shortened(printable_lines(&note.into()).into_owned()));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_long_to_read_is_cut_in_the_middle() {
        let message = |text: &str| Diagnostic::error("E0001", text).message;
        assert_eq!(message(&"é".repeat(LONGEST / 2)), "é".repeat(LONGEST / 2));
        let cut = message(&format!("`{}` is too long", "é".repeat(LONGEST)));
        assert!(
            cut.starts_with("`éé") && cut.ends_with("éé` is too long"),
            "{cut}"
        );
        assert!(cut.contains(" … ") && cut.len() < LONGEST + 10, "{cut}");
        let note = Diagnostic::error("E0001", "").note("x".repeat(1 << 20));
        assert!(note.notes[0].len() < LONGEST + 10);
    }
}
