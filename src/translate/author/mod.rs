//! The author's text, where a writer of readable code needs more than the tree: comments, blank lines,
//! numbers, and the macros that become constants.

mod comment;
mod comment_text;
mod literal;
mod macro_constants;
mod source_layout;
mod source_text;

pub(crate) use comment::{Comments, OuterBlock};
pub(crate) use literal::{float, is_hexadecimal};
pub(crate) use macro_constants::MacroConstants;
pub(crate) use source_text::SourceText;
