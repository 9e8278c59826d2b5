//! The explanations of diagnostic codes and of mistakes, from the pages that document them.

use std::borrow::Cow;

/// The page of diagnostics: a section for each code.
const DIAGNOSTICS: &str = include_str!("../../docs/guide/diagnostics.md");

/// The page of mistakes: a row of a table for each.
const MISTAKES: &str = include_str!("../../docs/guide/mistakes.md");

/// The start of a section.
const HEADING: &str = "\n## ";

/// The explanation of a diagnostic code or of a mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// `E` or `W` and four digits, or the name of a mistake.
    pub code: &'static str,
    /// A title of one line.
    pub title: &'static str,
    /// Markdown: the explanation, and how to fix it. Examples are in fences, each after a line `Wrong:` or
    /// `Right:`.
    pub text: Cow<'static, str>,
}

/// Returns all explanations, in the order of the pages.
pub fn explanations() -> impl Iterator<Item = Explanation> {
    diagnostics().chain(mistakes())
}

/// Returns the explanation of a code or of a mistake, in any case.
#[must_use]
pub fn explain(code: &str) -> Option<Explanation> {
    explanations().find(|explanation| explanation.code.eq_ignore_ascii_case(code))
}

/// The sections `CODE: title`.
fn diagnostics() -> impl Iterator<Item = Explanation> {
    DIAGNOSTICS.split(HEADING).skip(1).filter_map(|section| {
        let (heading, text) = section.split_once('\n')?;
        let (code, title) = heading.split_once(": ")?;
        Some(Explanation {
            code,
            title,
            text: text.trim().into(),
        })
    })
}

/// The rows `| name | mistake | how to fix it |` of all tables, with the introduction of their section.
fn mistakes() -> impl Iterator<Item = Explanation> {
    MISTAKES.split(HEADING).skip(1).flat_map(|section| {
        let introduction = section.split_once('\n').map_or("", |(_, text)| text);
        let introduction = introduction.split("\n|").next().unwrap_or_default().trim();
        section.lines().filter_map(move |line| {
            let cells: Vec<_> = line.strip_prefix('|')?.strip_suffix('|')?.split('|').collect();
            let [name, title, fix] = cells[..] else {
                return None;
            };
            let code = name.trim().strip_prefix('`')?.strip_suffix('`')?;
            Some(Explanation {
                code,
                title: title.trim(),
                text: format!("How to fix it: {}\n\n{introduction}", fix.trim())
                    .trim_end()
                    .to_owned()
                    .into(),
            })
        })
    })
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
    fn headings_are_sorted_codes() {
        let codes: Vec<_> = diagnostics().map(|explanation| explanation.code).collect();
        assert_eq!(codes.len(), DIAGNOSTICS.matches(HEADING).count());
        assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    }

    #[test]
    fn every_row_of_the_mistakes_is_explained_once() {
        let mut codes: Vec<_> = mistakes().map(|explanation| explanation.code).collect();
        let rows = MISTAKES.lines().filter(|line| line.starts_with("| `")).count();
        assert!(codes.len() == rows && rows > 100, "{} of {rows}", codes.len());
        codes.sort_unstable();
        assert!(codes.windows(2).all(|pair| pair[0] != pair[1]), "{codes:?}");
        assert!(explain("far-root").unwrap().text.starts_with("How to fix it: "));
    }
}
