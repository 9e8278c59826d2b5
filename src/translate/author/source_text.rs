//! The author's text where the tree does not have it: the letters of swizzles, literals and macros.

use toyproof_diagnostic::{Files, Span};
use toyproof_glsl::tree::{Place, Swizzle};

use super::comment_text::is_block_comment;

/// The texts of the author's files.
pub(crate) struct SourceText<'a> {
    files: &'a Files,
}

impl<'a> SourceText<'a> {
    pub(crate) fn new(files: &'a Files) -> Self {
        Self { files }
    }

    /// The letters of a swizzle: `rgba` where the author wrote these, `xyzw` otherwise.
    pub(crate) fn letters(&self, components: Swizzle, at: Place) -> String {
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
    fn text(&self, span: Span) -> Option<&'a str> {
        self.files
            .get(span.file)
            .text()
            .get(span.start as usize..span.end as usize)
    }

    /// The macro whose entire replacement text is the literal at a place.
    pub(crate) fn macro_name(&self, at: Place) -> Option<&'a str> {
        if !at.is_expanded() {
            return None;
        }
        let text = self.files.get(at.spelling.file).text();
        let before = text.get(..at.spelling.start as usize)?.rsplit('\n').next()?;
        let after = text.get(at.spelling.end as usize..)?.lines().next();
        let after = after.unwrap_or_default().trim();
        let mut words = before.split_whitespace();
        let name = match words.next()? {
            "#define" => words.next()?,
            "#" if words.next() == Some("define") => words.next()?,
            _ => return None,
        };
        let is_whole = words.next().is_none()
            && (after.is_empty() || after.starts_with("//") || is_block_comment(after));
        let is_name = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && name.starts_with(|c: char| c.is_ascii_alphabetic());
        (is_whole && is_name).then_some(name)
    }
}
