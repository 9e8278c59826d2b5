//! The texts that a command line names: files, folders and standard input.

mod content;
mod find;
mod search;

pub(super) use content::of_content;
pub(super) use find::{Found, FoundIn, NOT_UTF8, ReadError, TOO_LARGE, find, is_shader, read, read_text};
pub(super) use search::Skipped;
