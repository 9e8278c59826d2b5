//! Errors of the TOML parser as diagnostics.

use toyproof_diagnostic::{Diagnostic, FileId, Files, Span};

/// What TOML, or the types that it is read into, refuse in a file.
#[must_use]
pub fn of_toml(code: &'static str, error: &::toml::de::Error, files: &Files, file: FileId) -> Diagnostic {
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
