//! Words of GLSL in a text, and texts in which some are replaced.

use std::collections::{HashMap, HashSet};

/// A part of a text.
enum Part<'a> {
    /// A word; whether it follows a dot, and so names a member or components.
    Word(&'a str, bool),
    /// What is between words, with comments and numbers.
    Other(&'a str),
}

/// The words of a text, and what is between them.
fn parts(text: &str) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    let mut rest = text;
    let mut follows_dot = false;
    while let Some(first) = rest.chars().next() {
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(comment) = rest.strip_prefix("/*") {
            comment.find("*/").map_or(rest.len(), |end| end + 4)
        } else if first.is_ascii_digit() {
            rest.find(|c: char| !is_part(c) && c != '.').unwrap_or(rest.len())
        } else if is_part(first) {
            rest.find(|c: char| !is_part(c)).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (part, after) = rest.split_at(length);
        if is_part(first) && !first.is_ascii_digit() {
            parts.push(Part::Word(part, follows_dot));
        } else {
            parts.push(Part::Other(part));
        }
        if !first.is_whitespace() {
            follows_dot = part == ".";
        }
        rest = after;
    }
    parts
}

/// The words of a text, without those in comments.
pub(super) fn words(text: &str) -> HashSet<&str> {
    let parts = parts(text).into_iter();
    let words = parts.filter_map(|part| match part {
        Part::Word(word, _) => Some(word),
        Part::Other(_) => None,
    });
    words.collect()
}

/// A text with other words in place of some. Members are replaced like variables, with which they may share a
/// macro, but not components.
pub(super) fn replaced(text: &str, replacements: &HashMap<String, String>) -> String {
    let is_swizzle = |word: &str| word.len() <= 4 && word.chars().all(|c| "xyzwrgbastpq".contains(c));
    let part = |part: &Part| match *part {
        Part::Word(word, is_member) if !(is_member && is_swizzle(word)) => replacements
            .get(word)
            .map_or_else(|| word.to_owned(), String::clone),
        Part::Word(text, _) | Part::Other(text) => text.to_owned(),
    };
    parts(text).iter().map(part).collect()
}

/// The names of the macros that a text defines.
pub(super) fn macros(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let directive = line.trim_start().strip_prefix('#')?;
        let name = directive.trim_start().strip_prefix("define")?.trim_start();
        let end = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        Some(&name[..end.unwrap_or(name.len())])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_replaced_outside_of_comments_and_components() {
        let of = |pairs: &[(&str, &str)]| {
            let owned = pairs
                .iter()
                .map(|(from, to)| ((*from).to_owned(), (*to).to_owned()));
            owned.collect::<HashMap<_, _>>()
        };
        let text = "float x = a.x + b . x + 1.0e3; // x\n/* x */ s.size = size(x1);";
        let expected = "float y = a.x + b . x + 1.0e3; // x\n/* x */ s.area = area(x1);";
        assert_eq!(
            replaced(text, &of(&[("x", "y"), ("size", "area"), ("e3", "z")])),
            expected
        );
        assert!(words(text).contains("x1") && !words("// x").contains("x"));
        let defined: Vec<_> = macros("#define A(x) x\n  # define B 1\n#undef C\n#define D").collect();
        assert_eq!(defined, ["A", "B", "D"]);
    }
}
