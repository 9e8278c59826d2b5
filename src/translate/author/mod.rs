//! The author's text, where a writer of readable code needs more than the tree: comments, blank lines,
//! numbers,
//! and the macros that become constants.

mod comment;
mod literal;
mod source_text;

pub(crate) use comment::Comments;
pub(crate) use literal::{float, is_hexadecimal};
pub(crate) use source_text::{MacroConstants, SourceText};
