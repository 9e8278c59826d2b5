//! `report.html`: one page with everything in it. A table of all shaders, which needs no script; for each shader its pictures, one pixel of
//! them, and what was said of its text. Nothing is fetched: the page's own policy forbids it, as it does any script but the page's.

mod article;
mod gallery;
mod messages;
mod table;
mod text;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};
use toyproof_image::quantise;
use toyproof_verify::compare::{IN_BITS, Legend, SEEN_BY_EYE, Verdict};

pub use self::gallery::{BUDGET, Exhibit, Gallery, every};
use self::text::Text;
use super::{Report, Rubric, plain, summary};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Runs before anything is laid out, so that all articles need not be.
const FIRST: &str = "document.documentElement.classList.add('script')";
/// What the script puts into the article that is open.
const VIEWER: &str = include_str!("viewer.html");

/// The page. The gallery has an exhibit for each record, in the same order.
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
<script>{FIRST}</script>
</head>
<body>
<header>
<h1>toyproof</h1>
<p>{summary}{device}</p>
{thinned}</header>
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
        thinned = thinned(gallery.step()),
        table = table::table(records, rubric),
        pictures = pictures(gallery),
    )
}

/// Only the page's own style and script, and pictures that are in the page.
fn policy() -> String {
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    format!(
        "default-src 'none'; base-uri 'none'; form-action 'none'; img-src data:; style-src {}; script-src {} {}",
        hash(STYLE),
        hash(FIRST),
        hash(SCRIPT)
    )
}

fn thinned(step: u32) -> String {
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

/// The pictures and the legends, where only the script sees them: a browser decodes those that are looked at.
fn pictures(gallery: &Gallery) -> String {
    let entries = |legend: Legend| -> Vec<_> {
        let entries = legend.entries().into_iter();
        entries
            .map(|(words, colour)| (words, colour.map(quantise)))
            .collect()
    };
    let settings = serde_json::json!({
        "step": gallery.step(),
        "eye": entries(SEEN_BY_EYE),
        "bits": entries(IN_BITS),
    });
    let pictures = gallery.pictures().iter().enumerate();
    let pictures: Vec<_> = pictures
        .map(|(index, png)| {
            let data = STANDARD.encode(png);
            format!("<script id=\"p{index}\" type=\"text/plain\">{data}</script>\n")
        })
        .collect();
    let pictures = pictures.concat();
    // Words of ours and numbers: there is nothing in them that would end the element.
    format!("{pictures}<script id=\"settings\" type=\"application/json\">{settings}</script>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Record;
    use crate::report::tests::{every_verdict, invalid};

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
        let told = &mut record.diagnostics[0];
        (told.message, told.file, told.line) = (HOSTILE.to_owned(), Some(HOSTILE.to_owned()), Some(1));
        told.code = HOSTILE.to_owned();
        told.notes = vec![HOSTILE.to_owned()];
        let mut gallery = Gallery::new(1);
        gallery.show(Exhibit {
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
                let told = invalid().diagnostics.remove(0);
                record.diagnostics = vec![told; 4];
                record.shader = "a.glsl".to_owned();
                records.push(record);
                // Each as large as the budget lets 500 different ones be on average.
                let index = gallery.hang(vec![records.len() as u8; BUDGET / 500 - records.len()]);
                gallery.show(Exhibit {
                    source: Some("some code in a line of a shader;\n".repeat(100)),
                    actual: Some(index),
                    ..Exhibit::default()
                });
            }
        }
        let page = page(records, &gallery);
        assert!(gallery.bytes() > BUDGET * 9 / 10);
        assert!(page.len() < 20_000_000, "{}", page.len());
    }

    #[test]
    fn what_was_left_out_is_told() {
        assert!(!page(Vec::new(), &Gallery::new(1)).contains("class=\"thinned\""));
        assert!(page(Vec::new(), &Gallery::new(3)).contains("one pixel of every 3 by 3"));
    }
}
