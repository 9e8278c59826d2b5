//! The table of all shaders, and the form that filters its rows.

use toyproof_diagnostic::{Severity, grouped, plural};
use toyproof_verify::Verdict;
use toyproof_verify::compare::CheckSummary;

use super::index::address;
use super::names::Names;
use super::{Gallery, PageKind, Text, sentence};
use crate::{Record, Rubrics, Tally};

/// The contents of the table.
pub(super) struct Overview<'a> {
    pub(super) records: &'a [Record],
    pub(super) names: &'a Names<'a>,
    pub(super) gallery: &'a Gallery,
    pub(super) rubrics: &'a Rubrics,
    /// The page, on which names lead to articles of this page or of others.
    pub(super) kind: PageKind,
}

impl Overview<'_> {
    pub(super) fn html(&self) -> String {
        let points = if self.rubrics.is_empty() {
            ""
        } else {
            "<th scope=\"col\" rowspan=\"2\" class=\"number\" data-sort>Points</th>"
        };
        let tally = Tally::new(self.records);
        let rows = self.records.iter().enumerate();
        let rows: String = rows.map(|(index, record)| self.row(index, record)).collect();
        let checks = [
            ("t-algorithm", "Algorithm"),
            ("t-precision", "Precision"),
            ("t-toolchain", "Toolchain"),
        ];
        let checks = checks.map(|(term, name)| {
            format!("<th scope=\"col\" class=\"number wide\" data-sort data-term=\"{term}\">{name}</th>")
        });
        format!(
            r#"<section id="overview" aria-label="All shaders">
{notice}{form}<table id="shaders">
<caption>Shaders</caption>
<thead>
<tr><td rowspan="2" class="thumbnail"></td><th scope="col" rowspan="2" data-sort>Shader</th><th scope="col" rowspan="2" data-sort>Verdict</th>{points}<th scope="col" rowspan="2" class="why" data-sort>Reason</th><th scope="colgroup" colspan="3" class="group wide" data-term="t-pixels-off">Pixels off</th></tr>
<tr>{checks}</tr>
</thead>
<tbody>
{rows}</tbody>
</table>
</section>
"#,
            checks = checks.concat(),
            form = form(&tally),
            notice = notice(&tally),
        )
    }

    /// Formats a row. Cells that are not sorted by their text have a number in `data-by`.
    fn row(&self, index: usize, record: &Record) -> String {
        let points = match self.rubrics.total(record) {
            Some([points, of]) => format!("<td class=\"number\" data-by=\"{points}\">{points} of {of}</td>"),
            None if self.rubrics.is_empty() => String::new(),
            None => "<td class=\"number none\" data-by=\"-1\"></td>".to_owned(),
        };
        let verdict = record.verdict;
        let exhibit = self.gallery.exhibits().get(index);
        let image = match exhibit.and_then(|exhibit| exhibit.actual) {
            Some(image) => format!(" data-image=\"{image}\""),
            None => String::new(),
        };
        let article = match self.kind {
            PageKind::Shaders => format!("#s{index}"),
            PageKind::Index => address(index),
        };
        format!(
            "<tr data-verdict=\"{verdict}\"><td class=\"thumbnail\"{image}></td>\
             <th scope=\"row\"><a href=\"{article}\" title=\"{}\">{}</a>{}</th><td data-by=\"{}\">{}</td>{}\
             <td class=\"why\">{}</td>{}{}{}</tr>\n",
            Text(&record.shader),
            breakable(self.names.short(record)),
            student(record),
            verdict as u8,
            badge(verdict),
            points,
            why(record),
            pixels_off(record.algorithm.as_ref()),
            pixels_off(record.precision.as_ref()),
            pixels_off(record.toolchain.as_ref()),
        )
    }
}

/// The form that filters the rows, which only a script shows.
fn form(tally: &Tally) -> String {
    format!(
        r#"<form id="filter" role="search" aria-label="Filter the shaders" hidden>
<label class="search"><span>Search</span> <input type="search" name="words" autocomplete="off" placeholder="Name or reason"></label>
<fieldset>
<legend>Show verdicts</legend>
{chips}</fieldset>
<p id="shown" role="status"></p>
</form>
"#,
        chips = chips(tally)
    )
}

/// A notice of shaders that were compared with nothing.
fn notice(tally: &Tally) -> String {
    match tally.count(Verdict::Ok) {
        0 => String::new(),
        count => format!(
            "<p class=\"notice\">Nothing was compared for {} {}: no reference was given.</p>\n",
            grouped(count),
            plural(count, "shader", "shaders")
        ),
    }
}

/// The number of shaders of each verdict, the best first, as check boxes that show or hide them.
fn chips(tally: &Tally) -> String {
    let chips = tally.counts().map(|(verdict, count)| {
        format!(
            "<label class=\"chip\" data-term=\"t-{verdict}\"><input type=\"checkbox\" name=\"verdict\" value=\"{verdict}\" checked> \
             {badge} <span class=\"count\">{count}</span></label>\n",
            badge = badge(verdict),
            count = grouped(count)
        )
    });
    chips.collect()
}

fn badge(verdict: Verdict) -> String {
    format!("<span class=\"verdict {verdict}\">{verdict}</span>")
}

/// Formats the reason, and below it the likely mistake or the first error.
fn why(record: &Record) -> String {
    let mistake = record.mistake.as_ref().map(|mistake| {
        let label = if mistake.is_symptom {
            "Symptom"
        } else {
            "Likely mistake"
        };
        format!("{label}: {}", mistake.text)
    });
    let mut errors = record
        .diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.severity == Severity::Error);
    // A single error is the reason itself.
    let error = errors.next().filter(|_| errors.next().is_some());
    let more = mistake.or(error.map(|error| error.message.clone()));
    let more = more.map(|more| format!("<br><span class=\"more\">{}</span>", sentence(&more)));
    sentence(&record.reason_and_lateness()) + &more.unwrap_or_default()
}

/// Escapes a name, which may be broken after the parts of its path rather than within them.
fn breakable(name: &str) -> String {
    Text(name)
        .to_string()
        .replace('/', "/<wbr>")
        .replace('_', "_<wbr>")
}

/// The owner of a submission and its assignment, below the name of the shader.
fn student(record: &Record) -> String {
    let Some(submitted) = &record.submitted else {
        return String::new();
    };
    let assignment = submitted.assignment.iter().map(|name| format!(", {name}"));
    let owner = submitted.student.clone() + &assignment.collect::<String>();
    format!("<br><span class=\"more\">{}</span>", Text(owner))
}

/// Formats the number of pixels of a check that differ.
fn pixels_off(check: Option<&CheckSummary>) -> String {
    match check.map(|check| check.differing) {
        None => "<td class=\"number wide none\" data-by=\"-1\">not run</td>".to_owned(),
        Some(0) => "<td class=\"number wide none\" data-by=\"0\">0</td>".to_owned(),
        Some(count) => format!(
            "<td class=\"number wide\" data-by=\"{count}\">{}</td>",
            grouped(count)
        ),
    }
}
