//! The texts of submitted files, whatever program saved them.

use std::path::Path;

use toyproof_project::Project;
use toyproof_project::files::{MAX_BYTES, is_json, is_shader};

/// The kind of a file of a submission.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Content {
    /// A shader, or a file of a project.
    Text {
        /// The text.
        text: String,
        /// The encoding, if it is not UTF-8.
        encoding: Option<&'static str>,
        /// Whether the file's name has the extension of another kind of file.
        is_renamed: bool,
    },
    /// Something else, and why.
    Other(&'static str),
}

/// The kind of a file, by its name and its content; at most one byte more than [`MAX_BYTES`] is given. A
/// file with the extension of a shader is one, other text is one if it has a `mainImage`.
#[must_use]
pub fn content(name: &str, bytes: &[u8]) -> Content {
    let path = Path::new(name);
    let is_expected = is_shader(path) || name.eq_ignore_ascii_case("project.toml");
    if bytes.len() as u64 > MAX_BYTES {
        return Content::Other("it is larger than 1 MiB");
    }
    // A PDF may have printable characters only.
    let Some((text, encoding)) = decode(bytes).filter(|_| !bytes.starts_with(b"%PDF-")) else {
        return Content::Other("it is not text");
    };
    let is_project = || is_json(path) && Project::is_json(&text);
    if is_expected || is_project() {
        return Content::Text {
            text,
            encoding,
            is_renamed: false,
        };
    }
    let start = text.trim_start();
    let is_markup = start.starts_with("{\\rtf") || start.starts_with('<');
    match text.contains("mainImage") {
        true if is_markup => Content::Other("it is a formatted document; the shader has to be plain text"),
        true => Content::Text {
            text,
            encoding,
            is_renamed: true,
        },
        false => Content::Other("it is not a shader: it has no mainImage"),
    }
}

/// Decodes a text: by its byte order mark, else as UTF-8, else as Latin-1 as browsers read it. Returns `None`
/// for a text with control characters, and the name of the encoding unless it is UTF-8.
pub fn decode(bytes: &[u8]) -> Option<(String, Option<&'static str>)> {
    let units = |from: fn([u8; 2]) -> u16| -> String {
        let units = bytes[2..].chunks_exact(2).map(|pair| from([pair[0], pair[1]]));
        char::decode_utf16(units)
            .map(|unit| unit.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect()
    };
    let (text, encoding) = match bytes {
        [0xff, 0xfe, ..] => (units(u16::from_le_bytes), Some("UTF-16")),
        [0xfe, 0xff, ..] => (units(u16::from_be_bytes), Some("UTF-16")),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => (text.strip_prefix('\u{feff}').unwrap_or(text).to_owned(), None),
            Err(_) => (bytes.iter().map(|&byte| latin1(byte)).collect(), Some("Latin-1")),
        },
    };
    let is_binary = |character: char| character.is_control() && !"\t\n\r\u{b}\u{c}\u{1a}".contains(character);
    (!text.contains(is_binary)).then_some((text, encoding))
}

/// A character of Windows-1252, which has printable ones where Latin-1 has control characters.
/// Source: <https://encoding.spec.whatwg.org/index-windows-1252.txt>
fn latin1(byte: u8) -> char {
    const FROM_128: &str = "€\u{81}‚ƒ„…†‡ˆ‰Š‹Œ\u{8d}Ž\u{8f}\u{90}‘’“”•–—˜™š›œ\u{9d}žŸ";
    match byte {
        128..160 => FROM_128
            .chars()
            .nth(usize::from(byte - 128))
            .unwrap_or(char::REPLACEMENT_CHARACTER),
        _ => char::from(byte),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHADER: &str = "// größer\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(1); }\n";

    fn text(name: &str, bytes: &[u8]) -> (String, Option<&'static str>, bool) {
        match content(name, bytes) {
            Content::Text {
                text,
                encoding,
                is_renamed,
            } => (text, encoding, is_renamed),
            Content::Other(reason) => panic!("{name}: {reason}"),
        }
    }

    #[test]
    fn texts_are_decoded() {
        let latin1: Vec<u8> = SHADER.chars().map(|character| character as u8).collect();
        let utf16 = |order: fn(u16) -> [u8; 2]| -> Vec<u8> {
            let units = std::iter::once(0xfeff).chain(SHADER.encode_utf16());
            units.flat_map(order).collect()
        };
        for (bytes, encoding) in [
            (SHADER.into(), None),
            (format!("\u{feff}{SHADER}").into_bytes(), None),
            (latin1, Some("Latin-1")),
            (utf16(u16::to_le_bytes), Some("UTF-16")),
            (utf16(u16::to_be_bytes), Some("UTF-16")),
        ] {
            assert_eq!(text("a.glsl", &bytes), (SHADER.to_owned(), encoding, false));
        }
        assert_eq!(text("a.glsl", b"\x93\xe4\x94 \x80").0, "“ä” €");
    }

    #[test]
    fn shaders_are_recognized_by_their_names_or_their_texts() {
        assert!(!text("A.GLSL", b"void main").2);
        assert!(text("a.txt", SHADER.as_bytes()).2);
        assert!(text("shader", SHADER.as_bytes()).2);
        assert!(!text("project.toml", b"").2);
        for (name, bytes, reason) in [
            (
                "notes.txt",
                &b"see above"[..],
                "it is not a shader: it has no mainImage",
            ),
            ("a.png", b"\x89PNG\r\n\x1a\n\0", "it is not text"),
            ("a.pdf", b"%PDF-1.5 mainImage\n\x01", "it is not text"),
            ("a.pdf", b"%PDF-1.5 plain", "it is not text"),
            (
                "a.rtf",
                b"{\\rtf1 mainImage}",
                "it is a formatted document; the shader has to be plain text",
            ),
            (
                "a.html",
                b"<p>mainImage</p>",
                "it is a formatted document; the shader has to be plain text",
            ),
            ("a.json", b"{}", "it is not a shader: it has no mainImage"),
        ] {
            assert_eq!(content(name, bytes), Content::Other(reason), "{name}");
        }
        let large = vec![b' '; MAX_BYTES as usize + 1];
        assert_eq!(
            content("a.glsl", &large),
            Content::Other("it is larger than 1 MiB")
        );
    }
}
