//! What each code means: `docs/diagnostics.md`, a section for each.

/// The page as people read it in the repository; there is no other.
const PAGE: &str = include_str!("../../docs/diagnostics.md");

/// What begins a section; `CODE: title` follows.
const HEADING: &str = "\n## ";

/// What the page says of one code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Explanation {
    /// `E` or `W` and four digits.
    pub code: &'static str,
    /// What it is about, in one line.
    pub title: &'static str,
    /// Markdown: what to know, and examples in fences, each after a line `Wrong:` or `Right:`.
    pub text: &'static str,
}

/// All explanations, in the page's order.
pub fn explanations() -> impl Iterator<Item = Explanation> {
    PAGE.split(HEADING).skip(1).filter_map(|section| {
        let (heading, text) = section.split_once('\n')?;
        let (code, title) = heading.split_once(": ")?;
        Some(Explanation {
            code,
            title,
            text: text.trim(),
        })
    })
}

/// The explanation of a code, which may be written in small letters.
#[must_use]
pub fn explain(code: &str) -> Option<Explanation> {
    explanations().find(|explanation| explanation.code.eq_ignore_ascii_case(code))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_ends_where_the_next_begins() {
        let explanation = explain("e0402").unwrap();
        assert_eq!(explanation.code, "E0402");
        assert_eq!(explanation.title, "A `const` without a value");
        assert!(
            explanation.text.ends_with("3.14159265;\n```"),
            "{}",
            explanation.text
        );
        assert_eq!(explain("E0"), None);
    }

    #[test]
    fn every_heading_is_a_code_and_they_are_in_order() {
        let codes: Vec<_> = explanations().map(|explanation| explanation.code).collect();
        assert_eq!(codes.len(), PAGE.matches(HEADING).count());
        assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    }
}
