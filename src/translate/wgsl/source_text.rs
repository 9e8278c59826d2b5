//! The author's text where the tree does not have it: the letters of swizzles, literals and macros.

use toyproof_diagnostic::{Files, Span};
use toyproof_glsl::tree::{Place, Swizzle};

/// The texts of the author's files.
pub(super) struct SourceText<'a> {
    files: &'a Files,
}

impl<'a> SourceText<'a> {
    pub(super) fn new(files: &'a Files) -> Self {
        Self { files }
    }

    /// The letters of a swizzle: `rgba` where the author wrote these, `xyzw` otherwise.
    pub(super) fn letters(&self, components: Swizzle, at: Place) -> String {
        let color: String = components
            .components()
            .iter()
            .map(|&c| char::from(b"rgba"[usize::from(c)]))
            .collect();
        let written = self.text(at.spelling).and_then(|text| text.rsplit('.').next());
        if written.is_some_and(|written| written.trim() == color) {
            color
        } else {
            components.name()
        }
    }

    /// The source text of a span.
    pub(super) fn text(&self, span: Span) -> Option<&'a str> {
        self.files
            .get(span.file)
            .text()
            .get(span.start as usize..span.end as usize)
    }

    /// Whether a place is the entire replacement text of `#define NAME`.
    pub(super) fn is_whole_macro(&self, name: &str, at: Place) -> bool {
        let text = self.files.get(at.spelling.file).text();
        let (Some(before), Some(after)) = (
            text.get(..at.spelling.start as usize),
            text.get(at.spelling.end as usize..),
        ) else {
            return false;
        };
        let before = before.rsplit('\n').next().unwrap_or_default();
        let after = after.lines().next().unwrap_or_default().trim();
        let mut words = before.split_whitespace();
        let directive = words.next().unwrap_or_default();
        let named = match directive {
            "#define" => words.next(),
            "#" => words
                .next()
                .filter(|&word| word == "define")
                .and_then(|_| words.next()),
            _ => None,
        };
        named == Some(name) && words.next().is_none() && (after.is_empty() || after.starts_with("//"))
    }
}
