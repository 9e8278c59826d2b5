//! The pages of a large report: a table of all shaders, whose rows are data that a script shows a page at a
//! time, and a page with the shaders themselves for each part.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::Range;
use std::time::SystemTime;

use serde_json::{Value, json};
use toyproof_diagnostic::grouped;
use toyproof_verify::compare::CheckSummary;

use super::names::Names;
use super::{Gallery, Page, Text, facts, head, heading, overview};
use crate::{Record, Report, Rubrics, Tally};

const SCRIPT: &str = include_str!("index.js");

/// The largest number of shaders of one page. A larger report has a table of all, and a page for each part of
/// this size.
pub const MAX_PAGE_SHADERS: usize = 500;

/// The largest number of shaders of a report whose pages contain copies of the images.
pub const MAX_SHADERS_WITH_IMAGES: usize = 10_000;

/// The folder of the parts, next to the table.
pub const PARTS: &str = "report";

/// The number of rows that are shown at a time.
const VISIBLE_ROWS: usize = 100;

/// The number of rows in one element of the page: browsers parse large elements at once.
const ROWS_OF_ELEMENT: usize = 1000;

/// A report that has a table of all shaders, and a page for each part.
#[derive(Debug)]
pub struct LargeReport<'a> {
    report: &'a Report,
    names: Names<'a>,
}

impl<'a> LargeReport<'a> {
    /// The pages of a report, which has more than [`MAX_PAGE_SHADERS`] shaders.
    #[must_use]
    pub fn new(report: &'a Report) -> Self {
        let names = Names::new(report.shaders().folder());
        Self { report, names }
    }

    /// The parts, in order.
    pub fn parts(&self) -> impl Iterator<Item = PagePart<'_>> {
        (1..=self.count()).map(|number| PagePart { whole: self, number })
    }

    /// The number of parts.
    fn count(&self) -> usize {
        self.report.shaders().len().div_ceil(MAX_PAGE_SHADERS)
    }
}

/// A part of a large report, which has a page of its own.
#[derive(Debug, Clone, Copy)]
pub struct PagePart<'a> {
    whole: &'a LargeReport<'a>,
    /// From 1.
    number: usize,
}

impl PagePart<'_> {
    /// Its number, from 1.
    #[must_use]
    pub fn number(&self) -> usize {
        self.number
    }

    /// The places of its shaders in the report.
    #[must_use]
    pub fn places(&self) -> Range<usize> {
        let start = MAX_PAGE_SHADERS * (self.number - 1);
        start..self.whole.report.shaders().len().min(start + MAX_PAGE_SHADERS)
    }

    /// Formats the page. The gallery has one exhibit for each of its shaders.
    ///
    /// # Errors
    /// The system's error: a record cannot be read.
    pub fn html(&self, rubrics: &Rubrics, gallery: &Gallery, date: SystemTime) -> io::Result<String> {
        let LargeReport { report, names } = self.whole;
        let page = Page {
            report,
            records: &super::records(report, self.places())?,
            names,
            rubrics,
            gallery,
            date,
        };
        let neighbor = |number: usize, label: &str| match number {
            1.. if number <= self.whole.count() => {
                format!("<a href=\"{}\">{label}</a>\n", part_name(number))
            }
            _ => String::new(),
        };
        let links = format!(
            "<nav aria-label=\"Pages\">\n<a href=\"../report.html\">All {} shaders</a>\n{}<span>{}</span>\n{}</nav>\n",
            grouped(report.shaders().len() as u64),
            neighbor(self.number - 1, "Previous"),
            numbers(&self.places()),
            neighbor(self.number + 1, "Next"),
        );
        Ok(page.html(&links))
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

impl LargeReport<'_> {
    /// Writes the table of all shaders.
    ///
    /// # Errors
    /// The system's error: a record cannot be read, or the table cannot be written.
    pub fn index(&self, rubrics: &Rubrics, date: SystemTime, out: &mut dyn Write) -> io::Result<()> {
        let Self { report, names } = self;
        let records = report.shaders();
        let heading = heading(names, records.len(), None);
        let tally = records.tally();
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
        let checks = ["Algorithm", "Precision", "Toolchain"].iter().zip(4..);
        let checks: Vec<_> = checks
            .map(|(name, column)| {
                format!("<th scope=\"col\" class=\"number wide\" data-sort=\"{column}\">{name}</th>")
            })
            .collect();
        write!(
            out,
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
"##,
            head = head(&heading, SCRIPT),
            facts = facts(report, records.len(), names, date),
            notice = overview::notice(&tally),
            form = overview::form(&tally),
            checks = checks.concat(),
        )?;
        for (index, record) in records.range(0..VISIBLE_ROWS.min(records.len())).enumerate() {
            out.write_all(row(index, &*record?, names, rubrics).as_bytes())?;
        }
        out.write_all(b"</tbody>\n</table>\n</section>\n<nav aria-label=\"Pages\">\n")?;
        for part in self.parts() {
            let address = format!("{PARTS}/{}", part_name(part.number));
            writeln!(out, "<a href=\"{address}\">{}</a>", numbers(&part.places()))?;
        }
        out.write_all(b"</nav>\n</main>\n")?;
        self.data(rubrics, &tally, out)?;
        writeln!(out, "<script>{SCRIPT}</script>\n</body>\n</html>")
    }

    /// Writes the rows and the settings, as data for the script.
    fn data(&self, rubrics: &Rubrics, tally: &Tally, out: &mut dyn Write) -> io::Result<()> {
        let records = self.report.shaders();
        for start in (0..records.len()).step_by(ROWS_OF_ELEMENT) {
            let end = records.len().min(start + ROWS_OF_ELEMENT);
            let rows: Vec<_> = records
                .range(start..end)
                .map(|record| Ok(values(&*record?, &self.names, rubrics).to_string()))
                .collect::<io::Result<_>>()?;
            // No text may end the element.
            let rows = rows.join(",\n").replace('<', "\\u003c");
            writeln!(
                out,
                "<script class=\"rows\" type=\"application/json\">[{rows}]</script>"
            )?;
        }
        let verdicts: BTreeMap<u8, String> = tally
            .counts()
            .map(|(verdict, _)| (verdict as u8, verdict.to_string()))
            .collect();
        let settings = json!({
            "visible": VISIBLE_ROWS,
            "page": MAX_PAGE_SHADERS,
            "parts": PARTS,
            "verdicts": verdicts,
            "hasPoints": !rubrics.is_empty(),
        });
        writeln!(
            out,
            "<script id=\"settings\" type=\"application/json\">{settings}</script>"
        )
    }
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

/// A row as data: name, verdict, points, reason, the pixels that differ in each check, and the owner.
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
    use crate::{Exhibit, Records, written};

    fn report(count: usize) -> Report {
        let record = |index: usize| Record {
            verdict: Verdict::Ok,
            reason: "</script><b> `a`".to_owned(),
            ..Record::unchecked(format!("hw/{index}<i>.glsl"))
        };
        Report::new(None, (0..count).map(record).collect::<Records>())
    }

    #[test]
    fn each_part_has_at_most_the_shaders_of_a_page() {
        let large = report(MAX_PAGE_SHADERS + 1);
        let large = LargeReport::new(&large);
        let places: Vec<_> = large.parts().map(|part| part.places()).collect();
        assert_eq!(
            places,
            [0..MAX_PAGE_SHADERS, MAX_PAGE_SHADERS..MAX_PAGE_SHADERS + 1]
        );
    }

    #[test]
    fn each_shader_is_an_article_of_its_part() {
        let report = report(MAX_PAGE_SHADERS + 2);
        let large = LargeReport::new(&report);
        let parts: Vec<_> = large.parts().collect();
        let mut gallery = Gallery::new(1);
        for _ in parts[1].places() {
            gallery.add_exhibit(Exhibit::default());
        }
        let page = parts[1].html(&Rubrics::default(), &gallery, UNIX_EPOCH).unwrap();
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
        let large = LargeReport::new(&report);
        let page = written(|out| large.index(&Rubrics::default(), UNIX_EPOCH, out));
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
