//! What is wrong with a file before anyone reads it.

use super::Diagnostic;
use crate::source::{File, FileId, Files, NOT_UTF8, ReadError, Span, TOO_LARGE};

/// The message on what a file holds, and in `files` a file to show it in.
///
/// # Errors
/// The same error, where not the content but the path or the system is at fault.
pub fn of_content(error: ReadError, files: &mut Files) -> Result<Diagnostic, ReadError> {
    let (file, message, bytes) = match error {
        ReadError::TooLarge { name } => (File::new(name, ""), TOO_LARGE, 0..0),
        ReadError::NotUtf8 { file, at } => (file, NOT_UTF8, at..at + char::REPLACEMENT_CHARACTER.len_utf8()),
        other => return Err(other),
    };
    let id = files.add(file);
    Ok(Diagnostic::error("E0500", message).at(Span::new(id, bytes.start as u32, bytes.end as u32)))
}

/// What TOML, or the types that it is read into, refuse in a file.
#[must_use]
pub fn of_toml(code: &'static str, error: &toml::de::Error, files: &Files, file: FileId) -> Diagnostic {
    let lines: Vec<_> = error.message().lines().map(str::trim).collect();
    let bytes = error.span().unwrap_or_default();
    let span = Span::new(file, bytes.start as u32, bytes.end.max(bytes.start) as u32);
    let message = header(error.message(), files.text(span)).unwrap_or_else(|| {
        let words = RUST_WORDS.iter();
        words.fold(lines.join("; "), |message, (rust, toml)| {
            message.replace(rust, toml)
        })
    });
    Diagnostic::error(code, message).at(span)
}

/// What Rust calls things, and what they are in TOML.
const RUST_WORDS: [(&str, &str); 4] = [
    ("invalid type: map", "invalid type: a table"),
    ("expected f64", "expected a number"),
    ("expected i64", "expected a whole number"),
    ("expected a sequence", "expected a list"),
];

/// What is said of a table whose header is that of one of several, or the other way round.
fn header(message: &str, written: &str) -> Option<String> {
    let is_table = message.starts_with("invalid type: map, expected ");
    let name = written.trim().trim_matches(['[', ']']);
    if !is_table || !written.starts_with('[') {
        None
    } else if written.starts_with("[[") {
        Some(format!("there is only one such table: write `[{name}]`"))
    } else {
        Some(format!("there may be several such tables: write `[[{name}]]`"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_byte_that_is_not_utf8_is_shown_as_its_stand_in() {
        let mut files = Files::default();
        let error = ReadError::NotUtf8 {
            file: File::new("x", "ok\nab\u{fffd}c"),
            at: 5,
        };
        let diagnostic = of_content(error, &mut files).unwrap();
        assert_eq!(files.text(diagnostic.span.unwrap()), "\u{fffd}");
        assert!(of_content(ReadError::Missing("y".into()), &mut files).is_err());
    }
}
