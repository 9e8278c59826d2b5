//! Escaping of untrusted text for display, suggestions for misspelled names, and numbers in sentences.
//!
//! The names and texts of submissions are written to terminals, reports and logs. A control character in them
//! could move the cursor, color the screen or forge a line of output, and a bidirectional control could make
//! a line read as a different one ("Trojan Source", CVE-2021-42574).

use std::borrow::Cow;
use std::path::Path;

/// Whether a character affects the layout of the text around it: C0 and C1 controls, the Unicode line
/// separators, and the bidirectional controls (Unicode Standard Annex 9, table 1).
fn is_layout_control(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Escapes every control character (including line feeds) as in Rust: `\n`, `\u{202e}`.
pub fn printable(text: &str) -> Cow<'_, str> {
    escape(text, is_layout_control)
}

/// Like [`printable`] for a text of several lines: line feeds remain.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escape(text, |character| {
        is_layout_control(character) && character != '\n'
    })
}

fn escape(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
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

/// A text for a cell of a spreadsheet: without control characters, as from [`printable`], and with an
/// apostrophe before text that a spreadsheet reads as a formula.
pub fn spreadsheet_text(text: &str) -> String {
    let text = printable(text);
    let start = text.trim_start_matches(is_invisible);
    if start.starts_with(is_formula_start) {
        format!("'{text}")
    } else {
        text.into_owned()
    }
}

/// Whether a character at the start of a text cannot be seen.
fn is_invisible(character: char) -> bool {
    character.is_whitespace()
        || matches!(
            character,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}'
                | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{2060}'..='\u{206f}' | '\u{2800}'
                | '\u{3164}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{ffa0}' | '\u{e0000}'..='\u{e0fff}'
        )
}

/// Whether a character starts a formula: `=`, `+`, `-` or `@`, or a form of them in another width or place,
/// which some locales read in the same way.
fn is_formula_start(character: char) -> bool {
    matches!(
        character,
        '=' | '+' | '-' | '@' | '\u{207a}'..='\u{207c}' | '\u{208a}'..='\u{208c}' | '\u{2212}' | '\u{fb29}'
            | '\u{fe62}' | '\u{fe63}' | '\u{fe66}' | '\u{fe6b}' | '\u{ff0b}' | '\u{ff0d}' | '\u{ff1d}' | '\u{ff20}'
    )
}

/// Formats a path for messages and reports.
#[expect(
    clippy::disallowed_methods,
    reason = "the one place that formats paths for people"
)]
pub fn path_name(path: &Path) -> String {
    printable(&path.display().to_string()).into_owned()
}

/// The placeholder for a control character in a displayed source line: printable and of the same length in
/// UTF-8, so that columns are unchanged. Tabs and line ends are left to the renderer.
fn placeholder(character: char) -> char {
    match character.len_utf8() {
        1 => '?',
        2 => '\u{bf}',
        _ => char::REPLACEMENT_CHARACTER,
    }
}

/// Replaces the control characters of a source text with placeholders of the same length; `None` if there
/// are none.
pub(super) fn mask_controls(text: &str) -> Option<String> {
    let is_masked =
        |character: char| is_layout_control(character) && !matches!(character, '\n' | '\r' | '\t');
    let mask = |character: char| {
        if is_masked(character) {
            placeholder(character)
        } else {
            character
        }
    };
    text.contains(is_masked).then(|| text.chars().map(mask).collect())
}

// Suggestions for misspelled names.

/// Maximum length of names for which similar ones are searched.
const MAX_COMPARED_LETTERS: usize = 64;

/// The candidate that a name most likely misspells, if any is likely; the first of equally likely ones. The
/// distance is the number of swapped, missing, added and changed letters, up to a third of the name. Case
/// hardly counts: `smoothStep` is `smoothstep`.
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    // Names of up to two letters get no suggestion but another case.
    let limit = name.chars().count() / 3;
    similar(name, candidates)
        .filter(|&(distance, _)| distance <= limit)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// The candidates that differ from a name by at most a third of its letters, or by one letter, with their
/// distances as in [`nearest`].
pub fn similar<'c>(
    name: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> impl Iterator<Item = (usize, &'c str)> {
    let length = name.chars().count();
    let limit = (length / 3).max(1);
    let lower = name.to_lowercase();
    candidates.into_iter().filter_map(move |candidate| {
        let distance = match candidate {
            // Such long names are not typed by hand, and the distance takes quadratic time.
            _ if length > MAX_COMPARED_LETTERS => return None,
            _ if candidate == name || candidate.is_empty() => return None,
            _ if length.abs_diff(candidate.len()) > limit => return None,
            _ if candidate.eq_ignore_ascii_case(name) => 0,
            _ => strsim::osa_distance(&lower, &candidate.to_lowercase()),
        };
        (distance <= limit).then_some((distance, candidate))
    })
}

/// Returns the form of a word for a count.
pub fn plural<'a>(count: u64, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}

/// Lists items for a sentence: “a”, “a and b”, “a, b and c”.
#[must_use]
pub fn all_of(items: &[impl AsRef<str>]) -> String {
    join(items, "and")
}

/// Lists alternatives for a sentence: “a”, “a or b”, “a, b or c”.
#[must_use]
pub fn one_of(items: &[impl AsRef<str>]) -> String {
    join(items, "or")
}

fn join(items: &[impl AsRef<str>], conjunction: &str) -> String {
    let items: Vec<&str> = items.iter().map(AsRef::as_ref).collect();
    match &items[..] {
        [first @ .., last] if !first.is_empty() => format!("{} {conjunction} {last}", first.join(", ")),
        items => items.concat(),
    }
}

/// Formats a count with separated thousands: 230,400.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Formats an error in two digits: 1.2e-7, or 0.
pub fn magnitude(error: f64) -> String {
    if error == 0.0 {
        "0".to_owned()
    } else {
        format!("{error:.1e}")
    }
}

/// Formats a difference of color components from 0 to 1: 0.580, 1.2e-7, or 0.
pub fn color_difference(difference: f64) -> String {
    if difference >= 0.001 {
        format!("{difference:.3}")
    } else {
        magnitude(difference)
    }
}

/// A message without the numbers that the system gives its errors: "File exists (os error 17)".
pub fn without_error_numbers(text: &str) -> String {
    let mut parts = text.split(" (os error ");
    let mut short = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once(')') {
            Some((number, rest)) if number.parse::<i32>().is_ok() => short.push_str(rest),
            _ => short.extend([" (os error ", part]),
        }
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOSTILE: &str = "a\n\r\u{1b}[2J\u{7f}\u{85}\u{9b}31m\u{61c}\u{200f}\u{2028}\u{202e}\u{2066}z";

    #[test]
    fn lists_have_a_conjunction_before_the_last_item() {
        let names = ["a", "b", "c"];
        let lists = [0, 1, 2, 3].map(|count| all_of(&names[..count]));
        assert_eq!(lists, ["", "a", "a and b", "a, b and c"]);
        assert_eq!(one_of(&names), "a, b or c");
    }

    #[test]
    fn control_characters_in_names_are_escaped() {
        let shown = printable(HOSTILE);
        assert_eq!(
            shown,
            "a\\n\\r\\u{1b}[2J\\u{7f}\\u{85}\\u{9b}31m\\u{61c}\\u{200f}\\u{2028}\\u{202e}\\u{2066}z"
        );
        assert!(!shown.contains(is_layout_control));
        assert!(
            matches!(printable("Grüße 你好 👩‍🎨.glsl"), Cow::Borrowed(_)),
            "other scripts stay"
        );
        assert_eq!(printable_lines("a\nb\u{9b}"), "a\nb\\u{9b}");
        assert_eq!(path_name(Path::new("x\ny")), "x\\ny");
    }

    #[test]
    fn masking_preserves_columns() {
        let masked = mask_controls(HOSTILE).unwrap();
        assert_eq!(masked.len(), HOSTILE.len());
        assert_eq!(masked.chars().count(), HOSTILE.chars().count());
        assert!(!masked.contains(|c| is_layout_control(c) && c != '\n' && c != '\r'));
        assert_eq!(super::mask_controls("a\tb\r\n"), None);
    }

    #[test]
    fn misspellings_are_found_and_other_words_are_not() {
        let names = [
            "smoothstep",
            "normalize",
            "fract",
            "dot",
            "iResolution",
            "x",
            "mix",
        ];
        for (written, meant) in [
            ("smoothStep", Some("smoothstep")),
            ("normalise", Some("normalize")),
            ("noramlize", Some("normalize")),
            ("frac", Some("fract")),
            ("dto", Some("dot")),
            ("iresolution", Some("iResolution")),
            ("y", None),
            ("colour", None),
            ("max", Some("mix")),
            ("dot", None),
            ("", None),
        ] {
            assert_eq!(nearest(written, names), meant, "{written}");
        }
        assert_eq!(nearest(&"x".repeat(100_000), names), None);
    }

    #[test]
    fn spreadsheets_read_texts_as_texts() {
        for (text, expected) in [
            ("Anna", "Anna"),
            ("a=b", "a=b"),
            ("=1", "'=1"),
            (" \u{200b}\u{a0}＝1", "' \u{200b}\u{a0}＝1"),
            ("－2", "'－2"),
            ("\u{feff}@a", "'\u{feff}@a"),
            ("\u{fe0f}+1", "'\u{fe0f}+1"),
            ("\t=1", "\\t=1"),
            ("\u{202e}=1", "\\u{202e}=1"),
            ("a\r\n=1\u{1b}[2J\u{9b}", "a\\r\\n=1\\u{1b}[2J\\u{9b}"),
            ("", ""),
        ] {
            assert_eq!(spreadsheet_text(text), expected, "{text:?}");
        }
    }

    #[test]
    fn numbers_are_formatted_for_people() {
        assert_eq!(
            [0, 999, 1000, 57_600, 230_400, 1_234_567, 67_108_864].map(grouped),
            [
                "0",
                "999",
                "1,000",
                "57,600",
                "230,400",
                "1,234,567",
                "67,108,864"
            ]
        );
        assert_eq!(
            [0.0, -0.0, 1.25e-7, 3.0].map(magnitude),
            ["0", "0", "1.2e-7", "3.0e0"]
        );
        assert_eq!(
            [0.0, 1.0, 0.58, 2.5e-4].map(color_difference),
            ["0", "1.000", "0.580", "2.5e-4"]
        );
    }
}
