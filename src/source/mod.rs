//! What the author wrote: files, and spans that lead back to a line and a column.
//!
//! Every later stage speaks of the author's text through [`Span`]s; only a renderer turns one into a
//! line and a column, by asking [`Files`].

mod file;
mod find;
mod printable;
mod search;
mod span;

pub use file::{File, FileId, Files, Position};
pub use find::{
    EXTENSIONS, Found, FoundIn, MAX_BYTES, NOT_UTF8, ReadError, TOO_LARGE, find, is_shader, read, read_text,
};
pub use printable::{path_name, printable, printable_lines};
pub use search::{Search, Skipped};
pub use span::Span;
