//! What is wrong with a file before anyone reads it.

use toyproof_diagnostic::{Diagnostic, File, Files, Span};

use crate::cli::files::{NOT_UTF8, ReadError, TOO_LARGE};

/// The message on what a file holds, and in `files` a file to show it in.
///
/// # Errors
/// The same error, where not the content but the path or the system is at fault.
pub(crate) fn of_content(error: ReadError, files: &mut Files) -> Result<Diagnostic, ReadError> {
    let (file, message, bytes) = match error {
        ReadError::TooLarge { name } => (File::new(name, ""), TOO_LARGE, 0..0),
        ReadError::NotUtf8 { file, at } => (file, NOT_UTF8, at..at + char::REPLACEMENT_CHARACTER.len_utf8()),
        other => return Err(other),
    };
    let id = files.add(file);
    Ok(Diagnostic::error("E0500", message).at(Span::new(id, bytes.start as u32, bytes.end as u32)))
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
