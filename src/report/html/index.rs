//! The pages of a large report: a table of all shaders, whose rows are data that a script shows a page at a
//! time, and a page with the shaders themselves for each part.

use std::collections::BTreeMap;
use std::ops::Range;
use std::time::SystemTime;

use serde_json::{Value, json};
use toyproof_diagnostic::grouped;
use toyproof_verify::compare::CheckSummary;

use super::names::Names;
use super::{Gallery, Page, Text, facts, head, heading, overview};
use crate::report::{Record, Report, Rubrics};

const SCRIPT: &str = include_str!("index.js");

/// The largest number of shaders of one page. A larger report has a table of all, and a page for each part of
/// this size.
pub const MAX_PAGE_SHADERS: usize = 500;

/// The largest number of shaders of a report whose pages have images, of which they are a second copy.
pub const MAX_SHADERS_WITH_IMAGES: usize = 10_000;

/// The folder of the parts, beside the table.
pub const PARTS: &str = "report";

/// The number of rows that are shown at a time.
const VISIBLE_ROWS: usize = 100;

/// The number of rows in one element of the page: browsers parse large elements at once.
const ROWS_OF_ELEMENT: usize = 1000;

/// A part of a large report, which has a page of its own.
#[derive(Debug, Clone, Copy)]
pub struct PagePart<'a> {
    report: &'a Report,
    /// From 1.
    number: usize,
}

impl<'a> PagePart<'a> {
    /// The parts of a report; none if it fits one page.
    pub fn all(report: &'a Report) -> impl Iterator<Item = Self> {
        (1..=count(report)).map(move |number| Self { report, number })
    }

    /// Its number, from 1.
    #[must_use]
    pub fn number(&self) -> usize {
        self.number
    }

    /// The places of its shaders in the report.
    #[must_use]
    pub fn places(&self) -> Range<usize> {
        let start = MAX_PAGE_SHADERS * (self.number - 1);
        start..self.report.shaders().len().min(start + MAX_PAGE_SHADERS)
    }

    /// Formats the page. The gallery has one exhibit for each of its shaders.
    #[must_use]
    pub fn html(&self, rubrics: &Rubrics, gallery: &Gallery, date: SystemTime) -> String {
        let all = self.report.shaders();
        let page = Page {
            report: self.report,
            records: &all[self.places()],
            names: &Names::of(all),
            rubrics,
            gallery,
            date,
        };
        let neighbor = |number: usize, label: &str| match number {
            1.. if number <= count(self.report) => {
                format!("<a href=\"{}\">{label}</a>\n", part_name(number))
            }
            _ => String::new(),
        };
        let links = format!(
            "<nav aria-label=\"Pages\">\n<a href=\"../report.html\">All {} shaders</a>\n{}<span>{}</span>\n{}</nav>\n",
            grouped(all.len() as u64),
            neighbor(self.number - 1, "Previous"),
            numbers(&self.places()),
            neighbor(self.number + 1, "Next"),
        );
        page.html(&links)
    }
}

/// The number of parts of a report; 0 if it fits one page.
fn count(report: &Report) -> usize {
    match report.shaders().len() {
        0..=MAX_PAGE_SHADERS => 0,
        shaders => shaders.div_ceil(MAX_PAGE_SHADERS),
    }
}

/// The file name of a part.
#[must_use]
pub fn part_name(number: usize) -> String {
    format!("{number:04}.html")
}

/// The numbers of shaders, from 1.
fn numbers(places: &Range<usize>) -> String {
    let [first, last] = [places.start + 1, places.end].map(|number| grouped(number as u64));
    format!("{first}–{last}")
}

/// Formats the table of all shaders of a large report.
#[must_use]
pub fn html_index(report: &Report, rubrics: &Rubrics, date: SystemTime) -> String {
    let records = report.shaders();
    let names = Names::of(records);
    let heading = heading(&names, records);
    let points = if rubrics.is_empty() {
        ""
    } else {
        "<th scope=\"col\" class=\"number\" data-sort=\"2\">Points</th>"
    };
    let images = if records.len() > MAX_SHADERS_WITH_IMAGES {
        " The pages of so many shaders have no images, which are files beside this page."
    } else {
        ""
    };
    let first = records.iter().enumerate().take(VISIBLE_ROWS);
    let first: Vec<_> = first
        .map(|(index, record)| row(index, record, &names, rubrics))
        .collect();
    let parts: Vec<_> = PagePart::all(report)
        .map(|part| {
            let address = format!("{PARTS}/{}", part_name(part.number));
            format!("<a href=\"{address}\">{}</a>\n", numbers(&part.places()))
        })
        .collect();
    format!(
        r##"{head}<body class="index">
<a class="skip" href="#main">Skip to the content</a>
<header class="page">
<h1>{heading}</h1>
{facts}</header>
<main id="main" tabindex="-1">
<section id="overview" aria-label="All shaders">
{notice}<p>The name of a shader leads to its page.{images}</p>
{form}<table id="shaders">
<caption>Shaders</caption>
<thead>
<tr><th scope="col" data-sort="0">Shader</th><th scope="col" data-sort="1">Verdict</th>{points}<th scope="col" class="why" data-sort="3">Reason</th>{checks}</tr>
</thead>
<tbody>
{first}</tbody>
</table>
</section>
<nav aria-label="Pages">
{parts}</nav>
</main>
{data}<script>{SCRIPT}</script>
</body>
</html>
"##,
        head = head(&heading, SCRIPT),
        facts = facts(report, records, &names, date),
        notice = overview::notice(records),
        form = overview::form(records),
        checks = ["Algorithm", "Precision", "Toolchain"]
            .iter()
            .zip(4..)
            .map(|(name, column)| format!(
                "<th scope=\"col\" class=\"number wide\" data-sort=\"{column}\">{name}</th>"
            ))
            .collect::<Vec<_>>()
            .concat(),
        first = first.concat(),
        parts = parts.concat(),
        data = data(records, &names, rubrics),
    )
}

/// The rows and the settings, as data for the script.
fn data(records: &[Record], names: &Names, rubrics: &Rubrics) -> String {
    let verdicts: BTreeMap<u8, String> = records
        .iter()
        .map(|record| (record.verdict as u8, record.verdict.to_string()))
        .collect();
    let settings = json!({
        "visible": VISIBLE_ROWS,
        "page": MAX_PAGE_SHADERS,
        "parts": PARTS,
        "verdicts": verdicts,
        "hasPoints": !rubrics.is_empty(),
    });
    let elements = records.chunks(ROWS_OF_ELEMENT).map(|records| {
        let rows: Vec<_> = records
            .iter()
            .map(|record| values(record, names, rubrics).to_string())
            .collect();
        // No text may end the element.
        let rows = rows.join(",\n").replace('<', "\\u003c");
        format!("<script class=\"rows\" type=\"application/json\">[{rows}]</script>\n")
    });
    let elements: Vec<_> = elements.collect();
    elements.concat() + &format!("<script id=\"settings\" type=\"application/json\">{settings}</script>\n")
}

/// The page of a shader, by its place in the report.
fn address(index: usize) -> String {
    let (part, place) = (index / MAX_PAGE_SHADERS + 1, index % MAX_PAGE_SHADERS);
    format!("{PARTS}/{}#s{place}", part_name(part))
}

/// The numbers of pixels that differ in each check.
fn differing(record: &Record) -> [Option<u64>; 3] {
    let differing = |check: &Option<CheckSummary>| check.as_ref().map(|check| check.differing);
    [&record.algorithm, &record.precision, &record.toolchain].map(differing)
}

/// A row as data: name, verdict, points, reason, the pixels that differ in each check, and whose it is.
fn values(record: &Record, names: &Names, rubrics: &Rubrics) -> Value {
    let [algorithm, precision, toolchain] = differing(record);
    let shown = |text: &str| toyproof_diagnostic::printable(text).into_owned();
    json!([
        shown(names.short(record)),
        record.verdict as u8,
        rubrics.total(record),
        shown(&record.reason_and_lateness()),
        algorithm,
        precision,
        toolchain,
        overview::owner(record).map(|owner| shown(&owner)),
    ])
}

/// A row as the page has it before its script runs.
fn row(index: usize, record: &Record, names: &Names, rubrics: &Rubrics) -> String {
    let points = match rubrics.total(record) {
        Some([points, of]) => format!("<td class=\"number\">{points} of {of}</td>"),
        None if rubrics.is_empty() => String::new(),
        None => "<td class=\"number none\"></td>".to_owned(),
    };
    let checks = differing(record).map(|count| match count {
        None => "<td class=\"number wide none\">not run</td>".to_owned(),
        Some(0) => "<td class=\"number wide none\">0</td>".to_owned(),
        Some(count) => format!("<td class=\"number wide\">{}</td>", grouped(count)),
    });
    format!(
        "<tr><th scope=\"row\"><a href=\"{}\">{}</a>{}</th><td>{}</td>{points}<td class=\"why\">{}</td>{}</tr>\n",
        address(index),
        Text(names.short(record)),
        overview::student(record),
        overview::badge(record.verdict),
        super::sentence(&record.reason_and_lateness()),
        checks.concat(),
    )
}

#[cfg(test)]
mod tests {
    use std::time::UNIX_EPOCH;

    use toyproof_verify::Verdict;

    use super::*;
    use crate::report::Exhibit;

    fn report(count: usize) -> Report {
        let record = |index: usize| Record {
            verdict: Verdict::Ok,
            reason: "</script><b> `a`".to_owned(),
            ..Record::new(format!("hw/{index}<i>.glsl"))
        };
        Report::new(None, (0..count).map(record).collect())
    }

    #[test]
    fn a_report_that_fits_one_page_has_no_parts() {
        assert_eq!(PagePart::all(&report(MAX_PAGE_SHADERS)).count(), 0);
        let large = report(MAX_PAGE_SHADERS + 1);
        let places: Vec<_> = PagePart::all(&large).map(|part| part.places()).collect();
        assert_eq!(
            places,
            [0..MAX_PAGE_SHADERS, MAX_PAGE_SHADERS..MAX_PAGE_SHADERS + 1]
        );
    }

    #[test]
    fn each_shader_is_an_article_of_its_part() {
        let report = report(MAX_PAGE_SHADERS + 2);
        let parts: Vec<_> = PagePart::all(&report).collect();
        let mut gallery = Gallery::new(1);
        for _ in parts[1].places() {
            gallery.add_exhibit(Exhibit::default());
        }
        let page = parts[1].html(&Rubrics::default(), &gallery, UNIX_EPOCH);
        assert!(page.contains("<article id=\"s1\" aria-labelledby=\"h1\" data-name=\"501&lt;i&gt;.glsl\">"));
        assert!(
            page.contains("<a href=\"../report.html\">All 502 shaders</a>\n<a href=\"0001.html\">Previous")
        );
        assert!(page.contains("<span>501–502</span>") && !page.contains(">Next<"));
        assert_eq!(address(MAX_PAGE_SHADERS + 1), "report/0002.html#s1");
    }

    #[test]
    fn no_text_becomes_markup_and_every_shader_has_a_row() {
        let report = report(2 * ROWS_OF_ELEMENT + 1);
        let page = html_index(&report, &Rubrics::default(), UNIX_EPOCH);
        assert_eq!(
            page.matches("</script>").count(),
            3 + 3,
            "head, rows, settings, script"
        );
        assert!(!page.contains("<b>") && !page.contains("<i>"));
        let rows: usize = page
            .split("<script class=\"rows\" type=\"application/json\">")
            .skip(1)
            .map(|rest| rest.split_once("</script>").unwrap().0)
            .map(|rows| serde_json::from_str::<Vec<Value>>(rows).unwrap().len())
            .sum();
        assert_eq!(rows, 2 * ROWS_OF_ELEMENT + 1);
        assert_eq!(page.matches("<tr><th scope=\"row\">").count(), VISIBLE_ROWS);
    }
}
