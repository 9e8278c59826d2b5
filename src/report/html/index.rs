//! The pages of a large report: one with the table of all shaders, and one with the shaders themselves for
//! each part.

use std::time::SystemTime;

use toyproof_diagnostic::grouped;

use super::{Gallery, Page, PageKind};
use crate::{Report, Rubrics};

/// The largest number of shaders of one page: with their images, it stays below 20 MB, which a browser opens
/// in a second. A larger report has a page with the table of all, and a page for each part of this size.
pub const MAX_PAGE_SHADERS: usize = 500;

/// The folder of the parts, next to the table.
pub const PARTS: &str = "report";

/// Formats the table of all shaders of a large report, whose names lead to the parts.
#[must_use]
pub fn html_index(report: &Report, rubrics: &Rubrics, date: SystemTime) -> String {
    let count = report.shaders().len();
    let links = (1..=count.div_ceil(MAX_PAGE_SHADERS)).map(|number| {
        let range = numbers(number, count);
        format!("<a href=\"{PARTS}/{}\">{range}</a>\n", part_name(number))
    });
    let page = Page {
        report,
        records: report.shaders(),
        rubrics,
        gallery: &Gallery::new(1),
        date,
        kind: PageKind::Index,
    };
    page.html(&navigation(&links.collect::<String>()))
}

/// Formats the page of a part of a large report, by its number from 1. The gallery has one exhibit for each
/// of its shaders.
///
/// # Panics
/// If the report has no such part.
#[must_use]
pub fn html_part(
    report: &Report,
    number: usize,
    rubrics: &Rubrics,
    gallery: &Gallery,
    date: SystemTime,
) -> String {
    let mut parts = report.shaders().chunks(MAX_PAGE_SHADERS);
    let (count, part_count) = (report.shaders().len(), parts.len());
    let neighbor = |number: usize, label: &str| match number {
        1.. if number <= part_count => format!("<a href=\"{}\">{label}</a>\n", part_name(number)),
        _ => String::new(),
    };
    let links = format!(
        "<a href=\"../report.html\">All {} shaders</a>\n{}<span>{}</span>\n{}",
        grouped(count as u64),
        neighbor(number - 1, "Previous"),
        numbers(number, count),
        neighbor(number + 1, "Next"),
    );
    let page = Page {
        report,
        records: parts.nth(number - 1).expect("the report has this part"),
        rubrics,
        gallery,
        date,
        kind: PageKind::Shaders,
    };
    page.html(&navigation(&links))
}

fn navigation(links: &str) -> String {
    format!("<nav aria-label=\"Pages\">\n{links}</nav>\n")
}

/// The file name of a part.
#[must_use]
pub fn part_name(number: usize) -> String {
    format!("{number:04}.html")
}

/// The numbers of the shaders of a part, from 1: `501–1,000`.
fn numbers(part: usize, count: usize) -> String {
    let end = part * MAX_PAGE_SHADERS;
    let [first, last] = [end - MAX_PAGE_SHADERS + 1, end.min(count)].map(|number| grouped(number as u64));
    format!("{first}–{last}")
}

/// The article of a shader in its part, by its place in the report.
pub(super) fn address(index: usize) -> String {
    let (part, place) = (index / MAX_PAGE_SHADERS + 1, index % MAX_PAGE_SHADERS);
    format!("{PARTS}/{}#s{place}", part_name(part))
}

#[cfg(test)]
mod tests {
    use std::time::UNIX_EPOCH;

    use toyproof_verify::Verdict;

    use super::*;
    use crate::{Exhibit, Record};

    fn report(count: usize) -> Report {
        let record = |index: usize| Record {
            verdict: Verdict::Ok,
            reason: "</script><b> `a`".to_owned(),
            ..Record::unchecked(format!("hw/{index}<i>.glsl"))
        };
        Report::new(None, (0..count).map(record).collect())
    }

    #[test]
    fn each_shader_is_an_article_of_its_part() {
        let report = report(MAX_PAGE_SHADERS + 2);
        let mut gallery = Gallery::new(1);
        for _ in 0..2 {
            gallery.add_exhibit(Exhibit::default());
        }
        let page = html_part(&report, 2, &Rubrics::default(), &gallery, UNIX_EPOCH);
        assert!(page.contains("<article id=\"s1\" aria-labelledby=\"h1\" data-name=\"501&lt;i&gt;.glsl\">"));
        assert_eq!(page.matches("<article").count(), 2);
        assert!(
            page.contains("<a href=\"../report.html\">All 502 shaders</a>\n<a href=\"0001.html\">Previous")
        );
        assert!(page.contains("<span>501–502</span>") && !page.contains(">Next<"));
    }

    #[test]
    fn no_text_becomes_markup_and_every_shader_has_a_row() {
        let report = report(2 * MAX_PAGE_SHADERS + 1);
        let page = html_index(&report, &Rubrics::default(), UNIX_EPOCH);
        assert_eq!(page.matches("</script>").count(), 3, "head, settings, script");
        assert!(!page.contains("<b>") && !page.contains("<i>") && !page.contains("<article"));
        assert_eq!(page.matches("<tr data-verdict").count(), 2 * MAX_PAGE_SHADERS + 1);
        assert!(page.contains("<a href=\"report/0003.html\">1,001–1,001</a>"));
        assert!(page.contains("<a href=\"report/0002.html#s499\" title=\"hw/999&lt;i&gt;.glsl\">"));
    }
}
