//! `report.html`: one self-contained page. A table of all shaders, which needs no script; for each shader its
//! images, one inspected pixel, and its messages. Nothing is fetched: the page's content security policy
//! forbids that, and any script but the page's own.

mod article;
mod gallery;

use std::fmt::{self, Display, Formatter, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};
use toyproof_diagnostic::printable;
use toyproof_image::quantize;
use toyproof_verify::Verdict;
use toyproof_verify::compare::{CheckSummary, IN_BITS, Legend, SEEN_BY_EYE};

pub use self::gallery::{Exhibit, Gallery, MAX_IMAGE_BYTES, subsample};
use super::{Record, Report, Rubric, plain, summary};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Runs before layout, so that the hidden articles are never laid out.
const HEAD_SCRIPT: &str = "document.documentElement.classList.add('script')";
/// The template that the script inserts into the open article.
const VIEWER: &str = include_str!("viewer.html");

/// Formats the page. The gallery has one exhibit per record, in the same order.
#[must_use]
pub fn html(report: &Report, rubric: Option<&Rubric>, gallery: &Gallery) -> String {
    let records = report.shaders();
    let summary = plain(&summary(records));
    let summary = Text(&summary);
    let device = report.device().map(|device| format!(" · {}", Text(device)));
    let articles = records.iter().zip(gallery.exhibits()).enumerate();
    let articles: String = articles
        .map(|(index, (record, exhibit))| article::article(index, record, exhibit))
        .collect();
    format!(
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>toyproof: {summary}</title>
<style>{STYLE}</style>
<script>{HEAD_SCRIPT}</script>
</head>
<body>
<header>
<h1>toyproof</h1>
<p>{summary}{device}</p>
{subsampling_note}</header>
<main>
{table}<div id="articles">
{articles}</div>
</main>
{VIEWER}{pictures}<script>{SCRIPT}</script>
</body>
</html>
"#,
        policy = policy(),
        device = device.unwrap_or_default(),
        subsampling_note = subsampling_note(gallery.step()),
        table = table(records, rubric),
        pictures = pictures(gallery),
    )
}

/// The content security policy: only the page's own style and scripts, and images embedded in the page.
fn policy() -> String {
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    format!(
        "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:; style-src {}; script-src {} {}",
        hash(STYLE),
        hash(HEAD_SCRIPT),
        hash(SCRIPT)
    )
}

fn subsampling_note(step: u32) -> String {
    if step == 1 {
        return String::new();
    }
    format!(
        "<p class=\"thinned\">Whole pictures would make this page too large: here is one pixel of every {step} by {step}. The files beside \
         the page have all.</p>\n"
    )
}

fn verdict(verdict: Verdict) -> String {
    format!("<span class=\"verdict {verdict}\">{verdict}</span>")
}

/// The images and the legends, as data for the script: a browser decodes only the images that are viewed.
fn pictures(gallery: &Gallery) -> String {
    let entries = |legend: Legend| -> Vec<_> {
        let entries = legend.entries().into_iter();
        entries
            .map(|(label, color)| (label, color.map(quantize)))
            .collect()
    };
    let settings = serde_json::json!({
        "step": gallery.step(),
        "eye": entries(SEEN_BY_EYE),
        "bits": entries(IN_BITS),
    });
    let pictures = gallery.images().iter().enumerate();
    let pictures: Vec<_> = pictures
        .map(|(index, png)| {
            let data = STANDARD.encode(png);
            format!("<script id=\"p{index}\" type=\"text/plain\">{data}</script>\n")
        })
        .collect();
    let pictures = pictures.concat();
    // The settings are numbers and our own texts, which cannot end the element.
    format!("{pictures}<script id=\"settings\" type=\"application/json\">{settings}</script>\n")
}

// The table of all shaders, and the form that filters its rows.

fn table(records: &[Record], rubric: Option<&Rubric>) -> String {
    let mut verdicts: Vec<_> = records.iter().map(|record| record.verdict).collect();
    verdicts.sort_unstable();
    verdicts.dedup();
    let choices: Vec<_> = verdicts
        .into_iter()
        .map(|one| {
            let badge = verdict(one);
            format!("<label class=\"choice\"><input type=\"checkbox\" name=\"verdict\" value=\"{one}\" checked> {badge}</label>\n")
        })
        .collect();
    let choices = choices.concat();
    let points = match rubric {
        Some(_) => "<th scope=\"col\" class=\"number\">Points</th>",
        None => "",
    };
    let rows = records.iter().enumerate();
    let rows: String = rows.map(|(index, record)| row(index, record, rubric)).collect();
    format!(
        r#"<section id="overview" aria-label="All shaders">
<form id="filter" aria-label="Filter" hidden>
<label>Search <input type="search" name="words" autocomplete="off"></label>
<fieldset>
<legend>Verdicts</legend>
{choices}</fieldset>
<p id="shown" role="status"></p>
</form>
<div class="scroll">
<table id="shaders" aria-label="Shaders">
<thead>
<tr><th scope="col">Shader</th><th scope="col">Verdict</th>{points}<th scope="col" class="number wide">Maths</th><th scope="col" class="number wide">Rounding</th><th scope="col" class="why">Why</th><th scope="col" class="number wide">Seconds</th></tr>
</thead>
<tbody>
{rows}</tbody>
</table>
</div>
</section>
"#
    )
}

/// Formats a row. Cells that are not sorted by their text have a number in `data-by`.
fn row(index: usize, record: &Record, rubric: Option<&Rubric>) -> String {
    let points = rubric.map(|rubric| {
        let marks = rubric.marks(record);
        let points = rounded(marks.iter().map(|mark| mark.points).sum());
        let of = rounded(marks.iter().map(|mark| mark.of).sum());
        format!("<td class=\"number\" data-by=\"{points}\">{points} of {of}</td>")
    });
    let seconds = seconds(record.seconds.total());
    format!(
        "<tr data-verdict=\"{}\"><th scope=\"row\"><a href=\"#s{index}\">{}</a></th><td data-by=\"{}\">{}</td>{}{}{}\
         <td class=\"why\">{}</td>{seconds}</tr>\n",
        record.verdict,
        Text(&record.shader),
        record.verdict as u8,
        verdict(record.verdict),
        points.unwrap_or_default(),
        share(record.algorithm.as_ref()),
        share(record.precision.as_ref()),
        Text(&record.reason),
    )
}

/// Formats the share of the pixels of a check that differ.
fn share(answer: Option<&CheckSummary>) -> String {
    let percent = answer.map(|answer| 100.0 * answer.share(answer.differing));
    let shown = match percent {
        None => "<span class=\"none\" title=\"not asked\">–</span>".to_owned(),
        Some(0.0) => "0 %".to_owned(),
        Some(percent) if percent < 0.01 => "&lt; 0.01 %".to_owned(),
        Some(percent) => format!("{percent:.2} %"),
    };
    let by = percent.unwrap_or(-1.0);
    format!("<td class=\"number wide\" data-by=\"{by}\">{shown}</td>")
}

/// Formats the time; a dash if nothing was measured.
fn seconds(seconds: f64) -> String {
    let shown = if seconds > 0.0 {
        format!("{seconds:.1}")
    } else {
        "<span class=\"none\" title=\"not measured\">–</span>".to_owned()
    };
    format!("<td class=\"number wide\" data-by=\"{seconds}\">{shown}</td>")
}

fn rounded(points: f64) -> f64 {
    (100.0 * points).round() / 100.0
}

// Escaping of text for HTML, in an element or between double quotes. Characters that affect the surrounding
// text, such as bidirectional controls, are escaped too.

/// Displays a value with the special characters of HTML escaped.
pub(super) struct Text<T>(pub(super) T);

impl<T: Display> Display for Text<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(Escaping(f), "{}", self.0)
    }
}

struct Escaping<'a, 'b>(&'a mut Formatter<'b>);

impl Write for Escaping<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for character in text.chars() {
            match character {
                '&' => self.0.write_str("&amp;")?,
                '<' => self.0.write_str("&lt;")?,
                '>' => self.0.write_str("&gt;")?,
                '"' => self.0.write_str("&quot;")?,
                '\'' => self.0.write_str("&#39;")?,
                '\n' | '\t' => self.0.write_char(character)?,
                other => self.0.write_str(&printable(other.encode_utf8(&mut [0; 4])))?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::record::samples::{every_verdict, invalid};

    fn page(records: Vec<Record>, gallery: &Gallery) -> String {
        html(&Report::new(Some("<device>".to_owned()), records), None, gallery)
    }

    #[test]
    fn no_text_becomes_markup() {
        const HOSTILE: &str = "\"'><script>hacked()</script><img src=x onerror=hacked()>";
        let mut record = invalid();
        for text in [&mut record.shader, &mut record.reason] {
            HOSTILE.clone_into(text);
        }
        record.scene = Some(HOSTILE.to_owned());
        let diagnostic = &mut record.diagnostics[0];
        (diagnostic.message, diagnostic.file, diagnostic.line) =
            (HOSTILE.to_owned(), Some(HOSTILE.to_owned()), Some(1));
        diagnostic.code = HOSTILE.to_owned();
        diagnostic.notes = vec![HOSTILE.to_owned()];
        let mut gallery = Gallery::new(1);
        gallery.add_exhibit(Exhibit {
            source: Some(HOSTILE.repeat(2)),
            ..Exhibit::default()
        });
        let page = page(vec![record], &gallery);
        assert!(!page.contains("<script>hacked") && !page.contains("<img") && !page.contains("<device>"));
        assert!(page.matches("&lt;img src=x").count() >= 8, "it is there, as text");
        assert_eq!(page.matches("<script").count(), 3, "settings and our own two");
    }

    #[test]
    fn a_page_of_500_shaders_stays_below_20_megabytes() {
        let mut gallery = Gallery::new(1);
        let mut records = Vec::new();
        while records.len() < 500 {
            for mut record in every_verdict() {
                let diagnostic = invalid().diagnostics.remove(0);
                record.diagnostics = vec![diagnostic; 4];
                record.shader = "a.glsl".to_owned();
                records.push(record);
                // The size that the budget leaves on average for each of 500 different images.
                let index =
                    gallery.add_image(vec![records.len() as u8; MAX_IMAGE_BYTES / 500 - records.len()]);
                gallery.add_exhibit(Exhibit {
                    source: Some("some code in a line of a shader;\n".repeat(100)),
                    actual: Some(index),
                    ..Exhibit::default()
                });
            }
        }
        let page = page(records, &gallery);
        assert!(gallery.bytes() > MAX_IMAGE_BYTES * 9 / 10);
        assert!(page.len() < 20_000_000, "{}", page.len());
    }

    #[test]
    fn subsampling_is_reported() {
        assert!(!page(Vec::new(), &Gallery::new(1)).contains("class=\"thinned\""));
        assert!(page(Vec::new(), &Gallery::new(3)).contains("one pixel of every 3 by 3"));
    }

    #[test]
    fn special_characters_of_html_are_escaped() {
        assert_eq!(
            Text("<a b=\"c\" d='e'>&\0\u{202e}\né").to_string(),
            "&lt;a b=&quot;c&quot; d=&#39;e&#39;&gt;&amp;\\u{0}\\u{202e}\né"
        );
        assert_eq!(Text(1.5).to_string(), "1.5");
    }
}
