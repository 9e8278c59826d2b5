//! From the author's GLSL to the text that naga is fed.
//!
//! [`lower`] is the whole interface: what comes out is a [`Lowered`] text, whose every place can be asked
//! for the author's own span. Today the author's text is wrapped as it is between a prelude and a `main`.

mod outline;
mod wrap;

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::diagnostic::Diagnostic;
use crate::source::{FileId, Files, Span};

/// The deepest nesting of brackets that is translated.
pub const MAX_NESTING: usize = outline::MAX_NESTING;

/// GLSL 450 in the subset that naga parses, and the way from it back to the author's text.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Lowered {
    text: String,
    /// Where the author's text lies in it.
    author: Range<usize>,
    file: FileId,
}

impl Lowered {
    /// The text that naga is fed.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The author's span for bytes of [`Self::text`]; none for what the author did not write.
    #[must_use]
    pub fn origin(&self, bytes: Range<usize>) -> Option<Span> {
        if bytes.start < self.author.start || bytes.start >= self.author.end {
            return None;
        }
        let end = bytes.end.clamp(bytes.start, self.author.end);
        let place = |byte: usize| (byte - self.author.start) as u32;
        Some(Span::new(self.file, place(bytes.start), place(end)))
    }
}

/// Checks a shader's outline and prints what naga is fed.
///
/// # Errors
/// What is wrong with the shader, on the author's own lines.
pub fn lower(files: &Files, file: FileId) -> Result<Lowered, Vec<Diagnostic>> {
    outline::check(files, file).map_err(|diagnostic| vec![diagnostic])?;
    Ok(wrap::wrap(files.get(file).text(), file))
}
