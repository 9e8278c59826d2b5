//! Text that knows where each of its bytes comes from.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Diagnostic, Span};

/// GLSL 450 in the subset that naga parses, and the way from it back to the author's text.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lowered {
    text: String,
    /// Where a stretch begins, and the author's words that it prints; it ends where the next begins.
    runs: Vec<(u32, Option<Span>)>,
    /// Why no driver is to run it.
    too_deep: Option<Diagnostic>,
}

impl Lowered {
    /// The text that naga is fed.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The author's words behind bytes of [`Self::text`]: the smallest span that covers all of them; none if the author
    /// wrote nothing of it.
    #[must_use]
    pub fn origin(&self, bytes: Range<usize>) -> Option<Span> {
        let first = self
            .runs
            .partition_point(|&(start, _)| start as usize <= bytes.start)
            .saturating_sub(1);
        self.runs
            .get(first..)?
            .iter()
            .take_while(|&&(start, _)| (start as usize) < bytes.end.max(bytes.start + 1))
            .filter_map(|&(_, span)| span)
            .reduce(Span::to)
    }

    /// Why no driver is to run it: it nests deeper than they count, and they would paint something else. It can be
    /// translated.
    #[must_use]
    pub fn too_deep(&self) -> Option<&Diagnostic> {
        self.too_deep.as_ref()
    }

    /// Says why no driver is to run it, if there is a reason.
    pub(super) fn refuse(&mut self, too_deep: Option<Diagnostic>) {
        self.too_deep = too_deep;
    }

    /// Adds text that prints those words of the author, or none of his.
    pub(super) fn push(&mut self, text: &str, span: Option<Span>) {
        if text.is_empty() {
            return;
        }
        if self.runs.last().is_none_or(|&(_, last)| last != span) {
            self.runs.push((self.text.len() as u32, span));
        }
        self.text.push_str(text);
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    #[test]
    fn bytes_lead_back_to_the_words_that_they_print() {
        let file = Files::default().add(File::new("a", "a+b"));
        let span = |start, end| Some(Span::new(file, start, end));
        let mut lowered = Lowered::default();
        for (text, span) in [
            ("x = ", None),
            ("a", span(0, 1)),
            (" + ", span(0, 3)),
            ("b", span(2, 3)),
            (";", None),
        ] {
            lowered.push(text, span);
        }
        assert_eq!(lowered.text(), "x = a + b;");
        assert_eq!(lowered.origin(4..5), span(0, 1));
        assert_eq!(lowered.origin(8..9), span(2, 3));
        assert_eq!(lowered.origin(4..9), span(0, 3));
        assert_eq!(lowered.origin(0..10), span(0, 3));
        assert_eq!(lowered.origin(0..2), None);
        assert_eq!(lowered.origin(99..99), None);
    }
}
