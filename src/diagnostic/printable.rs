//! Text from strangers, made safe to show.
//!
//! The name and the text of a submission reach terminals, reports and logs. A control character in them could move the cursor, color the
//! screen or forge a line of output, and a bidirectional control could make a line read as another ("Trojan Source", CVE-2021-42574).

use std::borrow::Cow;
use std::path::Path;

/// Whether a character acts on the text around it instead of showing itself: C0 and C1 controls, the Unicode line separators, and the
/// bidirectional controls (Unicode Standard Annex 9, table 1).
fn acts(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The text on one line, with every character that acts on its surroundings escaped as in Rust: `\n`, `\u{202e}`.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, acts)
}

/// The same for a text of several lines: line feeds stay.
#[must_use]
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |character| acts(character) && character != '\n')
}

fn escaped(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_escaped(character) {
            escaped.extend(character.escape_default());
        } else {
            escaped.push(character);
        }
    }
    Cow::Owned(escaped)
}

/// A path as messages and reports show it.
#[must_use]
#[expect(
    clippy::disallowed_methods,
    reason = "the one place that formats paths for people"
)]
pub fn path_name(path: &Path) -> String {
    printable(&path.display().to_string()).into_owned()
}

/// What stands for a character that acts on its surroundings where a source line is shown: printable and of as many bytes in UTF-8, so that
/// columns stay where they are. Tabs and line ends are left to the renderer.
fn stand_in(character: char) -> char {
    match character.len_utf8() {
        1 => '?',
        2 => '\u{bf}',
        _ => char::REPLACEMENT_CHARACTER,
    }
}

/// A source text with stand-ins of the same length for the characters that act on their surroundings; none if there are none.
pub(super) fn masked(text: &str) -> Option<String> {
    let is_masked = |character: char| acts(character) && !matches!(character, '\n' | '\r' | '\t');
    let mask = |character: char| {
        if is_masked(character) {
            stand_in(character)
        } else {
            character
        }
    };
    text.contains(is_masked).then(|| text.chars().map(mask).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOSTILE: &str = "a\n\r\u{1b}[2J\u{7f}\u{85}\u{9b}31m\u{61c}\u{200f}\u{2028}\u{202e}\u{2066}z";

    #[test]
    fn nothing_in_a_name_acts_on_the_text_around_it() {
        let shown = printable(HOSTILE);
        assert_eq!(
            shown,
            "a\\n\\r\\u{1b}[2J\\u{7f}\\u{85}\\u{9b}31m\\u{61c}\\u{200f}\\u{2028}\\u{202e}\\u{2066}z"
        );
        assert!(!shown.contains(acts));
        assert!(
            matches!(printable("Grüße 你好 👩‍🎨.glsl"), Cow::Borrowed(_)),
            "other scripts stay"
        );
        assert_eq!(printable_lines("a\nb\u{9b}"), "a\nb\\u{9b}");
        assert_eq!(path_name(Path::new("x\ny")), "x\\ny");
    }

    #[test]
    fn a_masked_text_keeps_every_column() {
        let masked = masked(HOSTILE).unwrap();
        assert_eq!(masked.len(), HOSTILE.len());
        assert_eq!(masked.chars().count(), HOSTILE.chars().count());
        assert!(!masked.contains(|c| acts(c) && c != '\n' && c != '\r'));
        assert_eq!(super::masked("a\tb\r\n"), None);
    }
}
