//! Reports of the findings, for people and for programs: one file per format, each a function of the records.

mod csv;
mod gradescope;
mod html;
mod junit;
mod reason;
mod record;
mod rubric;
mod sarif;
mod terminal;
mod trace;

pub use csv::csv;
pub use gradescope::gradescope;
pub use html::{Exhibit, Gallery, MAX_IMAGE_BYTES, html, subsample};
pub use junit::junit;
pub use reason::{failure_position, loop_truncated, reason};
pub use record::{Mistake, Record, Report, SCHEMA, Seconds};
pub use rubric::{Mark, Rubric, Visibility};
pub use sarif::sarif;
pub use terminal::{Tally, line, place, summary};
use terminal::{details, plain};
pub use trace::{PixelTrace, TracedPixel};

// The explanation of each diagnostic code: a section of `docs/guide/diagnostics.md`.

/// The page; this is its only copy.
const PAGE: &str = include_str!("../../docs/guide/diagnostics.md");

/// The start of a section; `CODE: title` follows.
const HEADING: &str = "\n## ";

/// The explanation of one diagnostic code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Explanation {
    /// `E` or `W` and four digits.
    pub code: &'static str,
    /// A title of one line.
    pub title: &'static str,
    /// Markdown: the explanation, and examples in fences, each after a line `Wrong:` or `Right:`.
    pub text: &'static str,
}

/// Returns all explanations, in the page's order.
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

/// Returns the explanation of a code, in any case.
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
    fn headings_are_sorted_codes() {
        let codes: Vec<_> = explanations().map(|explanation| explanation.code).collect();
        assert_eq!(codes.len(), PAGE.matches(HEADING).count());
        assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    }
}
