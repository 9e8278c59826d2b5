//! The glossary: the terms of the page, and the explanations of the codes and mistakes that occur on it.

use std::collections::{BTreeMap, BTreeSet};
use std::iter;

use super::{Text, markdown, sentence};
use crate::explanation::TERMS;
use crate::{Explanation, Record, explanations};

/// The explanations of the codes and mistakes that occur.
pub(super) struct Glossary(BTreeMap<&'static str, Explanation>);

impl Glossary {
    pub(super) fn new(records: &[Record]) -> Self {
        let diagnostics = records.iter().flat_map(|record| &record.diagnostics);
        let mistakes = records.iter().filter_map(|record| record.mistake.as_ref());
        let mistakes = mistakes.flat_map(|mistake| {
            let alternatives = mistake.alternatives.iter().map(|other| other.id.as_str());
            mistake_ids(&mistake.id).chain(alternatives.flat_map(mistake_ids))
        });
        let repairs = records.iter().filter_map(|record| record.fix.as_ref());
        let repairs = repairs.flat_map(|fix| iter::once(fix).chain(&fix.alternatives));
        let used: BTreeSet<&str> = diagnostics
            .map(|diagnostic| diagnostic.code.as_str())
            .chain(mistakes)
            .chain(repairs.map(|repair| repair.id.as_str()))
            .collect();
        let explanations = explanations().filter(|explanation| used.contains(explanation.code));
        Self(
            explanations
                .map(|explanation| (explanation.code, explanation))
                .collect(),
        )
    }

    /// Formats a code as a link to its explanation, if there is one.
    pub(super) fn link(&self, code: &str) -> String {
        match self.0.get(code) {
            Some(Explanation { code, .. }) => link(&format!("x-{code}"), code),
            None => Text(code).to_string(),
        }
    }

    /// Formats links to the explanations of a mistake, which may be several.
    pub(super) fn mistake_links(&self, id: &str) -> Option<String> {
        let known = mistake_ids(id).filter(|id| self.0.contains_key(id));
        let links: Vec<_> = known.map(|id| self.link(id)).collect();
        (!links.is_empty()).then(|| links.join(", "))
    }

    /// Formats the section.
    pub(super) fn html(&self) -> String {
        let terms: String = TERMS
            .iter()
            .map(|(id, term, definition)| {
                format!("<div class=\"entry\" id=\"t-{id}\"><dt>{term}</dt><dd id=\"t-{id}-text\">{}</dd></div>\n", sentence(definition))
            })
            .collect::<Vec<_>>()
            .concat();
        let explanations: String = self
            .0
            .values()
            .map(|Explanation { code, title, text }| {
                format!(
                    "<details class=\"entry\" id=\"x-{code}\">\n<summary><code>{code}</code> \
                     <span id=\"x-{code}-text\">{}</span></summary>\n{}</details>\n",
                    sentence(title),
                    markdown::html(text)
                )
            })
            .collect::<Vec<_>>()
            .concat();
        let explanations = if explanations.is_empty() {
            explanations
        } else {
            format!("<div class=\"explanations\">\n<h3>Mistakes and messages</h3>\n{explanations}</div>\n")
        };
        format!(
            "<section id=\"glossary\" aria-labelledby=\"glossary-heading\">\n<h2 id=\"glossary-heading\">Glossary</h2>\n\
             {explanations}<h3>Terms</h3>\n<dl class=\"terms\">\n{terms}</dl>\n</section>\n"
        )
    }
}

/// The names of the mistakes that are combined in `id`.
fn mistake_ids(id: &str) -> impl Iterator<Item = &str> {
    id.split('+')
}

/// Formats a link to an entry, which the script also shows as a tooltip.
fn link(id: &str, text: &str) -> String {
    let text = Text(text);
    format!("<a class=\"term\" href=\"#{id}\" data-term=\"{id}\" aria-describedby=\"{id}-text\">{text}</a>")
}

/// Formats a term as a link to its definition.
pub(super) fn term(id: &str, text: &str) -> String {
    link(&format!("t-{id}"), text)
}

#[cfg(test)]
mod tests {
    use toyproof_verify::Verdict;

    use super::*;
    use crate::record::samples::{every_verdict, invalid};
    use crate::repair::samples::repaired;
    use crate::{Alternative, Mistake};

    #[test]
    fn every_verdict_is_defined() {
        for record in every_verdict() {
            let verdict = record.verdict.to_string();
            assert!(TERMS.iter().any(|(id, ..)| *id == verdict), "{verdict}");
        }
    }

    #[test]
    fn the_codes_and_mistakes_that_occur_are_explained() {
        let mut record = invalid();
        record.verdict = Verdict::Wrong;
        // Any explained code does for a mistake.
        record.mistake = Some(Mistake {
            id: "E0100+E0200".to_owned(),
            text: String::new(),
            is_symptom: false,
            alternatives: vec![Alternative {
                id: "E0101".to_owned(),
                text: String::new(),
            }],
        });
        let glossary = Glossary::new(&[record]);
        let html = glossary.html();
        for code in ["E0301", "E0100", "E0200", "E0101"] {
            assert!(html.contains(&format!("id=\"x-{code}\"")), "{code}");
        }
        assert!(!html.contains("id=\"x-E0302\""));
        let fixed = Glossary::new(&[repaired()]).html();
        for id in ["wrong-operator", "two-mistakes"] {
            assert!(fixed.contains(&format!("id=\"x-{id}\"")), "{id}");
        }
        let links = glossary.mistake_links("E0100+E0200").unwrap();
        assert_eq!(links.matches("<a ").count(), 2);
        assert_eq!(glossary.mistake_links("<b>"), None);
        assert_eq!(glossary.link("<b>"), "&lt;b&gt;");
    }
}
