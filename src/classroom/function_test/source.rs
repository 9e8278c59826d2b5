//! Texts that tests are written in, and generated texts that contain them: diagnostics on a generated text
//! are reported at the author's.

use toyproof_diagnostic::{Diagnostic, Span};

use super::subject::Subject;

/// A part of a text that the author of a test wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Snippet {
    text: String,
    at: Span,
    /// Whether the file has the text letter for letter, so that parts of it have places of their own.
    is_verbatim: bool,
}

impl Snippet {
    /// A text that stands at this place. `is_verbatim`: whether the file has it letter for letter, not with
    /// escape sequences, for example.
    #[must_use]
    pub fn new(text: impl Into<String>, at: Span, is_verbatim: bool) -> Self {
        Self {
            text: text.into(),
            at,
            is_verbatim,
        }
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The place.
    #[must_use]
    pub fn at(&self) -> Span {
        self.at
    }

    /// The part between two bytes, without white space around it.
    #[must_use]
    pub(super) fn part(&self, start: usize, end: usize) -> Self {
        let text = &self.text[start..end.max(start)];
        let start = start + text.len() - text.trim_start().len();
        let text = text.trim();
        Self {
            text: text.to_owned(),
            at: self.place(start, start + text.len()),
            is_verbatim: self.is_verbatim,
        }
    }

    /// The place of a part between two bytes.
    pub(super) fn place(&self, start: usize, end: usize) -> Span {
        if self.is_verbatim {
            let place = |byte: usize| self.at.start + byte as u32;
            Span::new(self.at.file, place(start), place(end))
        } else {
            self.at
        }
    }
}

/// A generated text with snippets in it.
#[derive(Debug, Clone, Default)]
pub(super) struct GeneratedText {
    text: String,
    /// The snippets, each with the byte at which it starts, in order.
    snippets: Vec<(usize, Snippet)>,
}

impl GeneratedText {
    pub(super) fn push(&mut self, text: &str) {
        self.text += text;
    }

    pub(super) fn push_snippet(&mut self, snippet: &Snippet) {
        self.snippets.push((self.text.len(), snippet.clone()));
        self.text += &snippet.text;
    }

    /// Adds all of another text.
    pub(super) fn append(&mut self, other: &Self) {
        let start = self.text.len();
        self.text += &other.text;
        let snippets = other.snippets.iter();
        self.snippets
            .extend(snippets.map(|(at, snippet)| (start + at, snippet.clone())));
    }

    /// The shader with this text after it, which defines [`ADDED_MAIN`](toyproof_glsl::ADDED_MAIN).
    pub(super) fn after_shader(&self, subject: &Subject) -> Self {
        let text = format!("{}\n{}", subject.text, self.text);
        let start = text.len() - self.text.len();
        let file = subject.checked.tree[subject.checked.main_image].at.span.file;
        let span = Span::new(file, 0, subject.text.len() as u32);
        let of_shader = (0, Snippet::new(subject.text, span, true));
        let snippets = self.snippets.iter();
        let moved = snippets.map(|(at, snippet)| (start + at, snippet.clone()));
        Self {
            snippets: std::iter::once(of_shader).chain(moved).collect(),
            text,
        }
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// The place of the author's text that a span of this one is in; `None` for generated text.
    fn origin(&self, span: Span) -> Option<Span> {
        let (from, to) = (span.start as usize, span.end as usize);
        let after = self.snippets.partition_point(|(at, _)| *at <= from);
        let (at, snippet) = self.snippets.get(after.checked_sub(1)?)?;
        let end = at + snippet.text.len();
        (from <= end).then(|| snippet.place(from - at, to.min(end).max(from) - at))
    }

    /// Diagnostics on this text as diagnostics on the author's; those in generated text are about the test
    /// at `otherwise`.
    pub(super) fn diagnostics(&self, found: Vec<Diagnostic>, otherwise: Span) -> Vec<Diagnostic> {
        let moved = found.into_iter().map(|mut diagnostic| {
            let at = diagnostic.span.and_then(|span| self.origin(span));
            diagnostic.span = Some(at.unwrap_or(otherwise));
            let related = std::mem::take(&mut diagnostic.related).into_iter();
            diagnostic.related = related
                .filter_map(|(span, text)| Some((self.origin(span)?, text)))
                .collect();
            diagnostic.fixes.retain_mut(|fix| {
                fix.edits.iter_mut().all(|edit| match self.origin(edit.span) {
                    Some(span) => {
                        edit.span = span;
                        true
                    }
                    None => false,
                })
            });
            diagnostic
        });
        moved.collect()
    }
}
