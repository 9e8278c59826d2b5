//! What the shaders of a class have in common: the distribution of their points, and their commonest mistakes.

use std::collections::BTreeMap;

use toyproof_diagnostic::{grouped, plural};

use super::{Text, sentence};
use crate::{Record, Rubrics};

/// The smallest number of shaders that are summarized.
const MIN_SHADERS: usize = 5;

/// The largest number of mistakes that are listed.
const MAX_MISTAKES: usize = 8;

/// The number of ranges of points below the maximum.
const RANGES: usize = 10;

/// Formats the section; empty for a few shaders, and if there is nothing to summarize.
pub(super) fn html(records: &[Record], rubrics: &Rubrics) -> String {
    if records.len() < MIN_SHADERS {
        return String::new();
    }
    let tables = points(records, rubrics) + &mistakes(records);
    if tables.is_empty() {
        return tables;
    }
    format!("<section id=\"distribution\" aria-label=\"The class\">\n{tables}</section>\n")
}

/// The number of shaders in each range of points, and their mean and median.
fn points(records: &[Record], rubrics: &Rubrics) -> String {
    let shares = records.iter().filter_map(|record| {
        let [points, of] = rubrics.total(record)?;
        (of > 0.0).then_some((points / of).clamp(0.0, 1.0))
    });
    let mut shares: Vec<f64> = shares.collect();
    if shares.len() < MIN_SHADERS {
        return String::new();
    }
    shares.sort_by(f64::total_cmp);
    // All points are a range of their own.
    let mut counts = [0_u64; RANGES + 1];
    for share in &shares {
        counts[(share * RANGES as f64) as usize] += 1;
    }
    let most = counts.iter().max().copied().unwrap_or(1);
    let rows = counts.iter().enumerate().rev().map(|(at, count)| {
        let range = match at {
            RANGES => "100 %".to_owned(),
            _ => format!("{} to {} %", 100 * at / RANGES, 100 * (at + 1) / RANGES),
        };
        row(&range, *count, most)
    });
    let rows: String = rows.collect();
    let middle = shares.len() / 2;
    let median = match shares.len() % 2 {
        0 => 0.5 * (shares[middle - 1] + shares[middle]),
        _ => shares[middle],
    };
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    format!(
        "<table class=\"bars\">\n<caption>Points: mean {:.0} %, median {:.0} %</caption>\n<tbody>\n{rows}</tbody>\n</table>\n",
        100.0 * mean,
        100.0 * median
    )
}

/// The most frequent mistakes of wrong shaders.
fn mistakes(records: &[Record]) -> String {
    let mut counts: BTreeMap<&str, (&str, u64)> = BTreeMap::new();
    for mistake in records.iter().filter_map(|record| record.mistake.as_ref()) {
        // Its line is another one in each shader.
        let text = mistake.text.split(" (line ").next().unwrap_or_default();
        counts.entry(&mistake.id).or_insert((text, 0)).1 += 1;
    }
    let mut counts: Vec<_> = counts.into_values().filter(|(_, count)| *count > 1).collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let Some(&(_, most)) = counts.first() else {
        return String::new();
    };
    let rows = counts.iter().take(MAX_MISTAKES);
    let rows: String = rows.map(|(text, count)| row(text, *count, most)).collect();
    format!(
        "<table class=\"bars\">\n<caption>Commonest mistakes</caption>\n<tbody>\n{rows}</tbody>\n</table>\n"
    )
}

/// A row with a bar. Its first cell is no header, so that headers of rows are those of shaders.
fn row(label: &str, count: u64, most: u64) -> String {
    let shaders = plural(count, "shader", "shaders");
    let name = Text(format!("{label}: {} {shaders}", grouped(count)));
    format!(
        "<tr><td>{}</td><td><meter aria-label=\"{name}\" min=\"0\" max=\"{most}\" value=\"{count}\"></meter></td>\
         <td class=\"number\">{}</td></tr>\n",
        sentence(label),
        grouped(count)
    )
}

#[cfg(test)]
mod tests {
    use toyproof_verify::Verdict;

    use super::*;
    use crate::record::samples::{correct, record};
    use crate::{Mistake, Rubric};

    #[test]
    fn points_and_mistakes_of_a_class_are_counted() {
        let rubrics: Rubrics = Some(Rubric::with_points(1.0, 9.0, 0.0)).into();
        let mut records: Vec<Record> = (0..4).map(|_| correct()).collect();
        assert_eq!(html(&records, &rubrics), "", "too few");
        for line in [3, 12] {
            let mistake = Mistake {
                id: "missing-factor".to_owned(),
                text: format!("a factor is missing (line {line})"),
                is_symptom: false,
                alternatives: Vec::new(),
            };
            records.push(Record {
                mistake: Some(mistake),
                ..record(Verdict::Wrong)
            });
        }
        let page = html(&records, &rubrics);
        assert!(
            page.contains("<meter aria-label=\"100 %: 4 shaders\" min=\"0\" max=\"4\" value=\"4\">"),
            "{page}"
        );
        assert!(page.contains("median 100 %"), "{page}");
        let missing = "<td>a factor is missing</td><td><meter aria-label=\"a factor is missing: 2 shaders\" min=\"0\" max=\"2\"";
        assert!(html(&records, &None.into()).contains(missing), "{page}");
    }
}
