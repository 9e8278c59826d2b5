//! `report.html`: one self-contained page. A table of all shaders, which needs no script; for each shader its
//! verdict, its images, one inspected pixel, its checks, and its source with the messages; and a glossary.
//! Nothing is fetched: the page's content security policy forbids that, and any script but the page's own.
//! A large report has such a page for each part, and a page with the table of all shaders, which leads to
//! them.

mod article;
mod distribution;
mod gallery;
mod glossary;
mod index;
mod markdown;
mod names;
mod overview;
pub mod parts;
pub(super) mod profile;
mod source;

use std::fmt::{self, Display, Formatter, Write};
use std::time::{SystemTime, UNIX_EPOCH};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};
use toyproof_diagnostic::{Date, grouped, plural, printable};

use self::article::Article;
pub use self::gallery::{Exhibit, Gallery, MAX_IMAGE_BYTES, subsample};
use self::glossary::Glossary;
pub use self::index::{MAX_PAGE_SHADERS, PARTS, html_index, html_part, part_name};
use self::names::Names;
use self::overview::Overview;
use self::parts::{STYLE, VIEWER};
use self::source::SourceLimit;
use super::{Record, Report, Rubrics};

const SCRIPT: &str = concat!(include_str!("components.js"), include_str!("page.js"));
/// Runs before layout, so that the hidden articles are never laid out.
const HEAD_SCRIPT: &str = "document.documentElement.classList.add('script')";

/// Formats the page. The gallery has one exhibit per record, in the same order; `date` is when the run ended.
#[must_use]
pub fn html(report: &Report, rubrics: &Rubrics, gallery: &Gallery, date: SystemTime) -> String {
    let page = Page {
        report,
        records: report.shaders(),
        rubrics,
        gallery,
        date,
        kind: PageKind::Shaders,
    };
    page.html("")
}

/// A page with a table of shaders.
struct Page<'a> {
    report: &'a Report,
    /// The shaders of this page.
    records: &'a [Record],
    rubrics: &'a Rubrics,
    gallery: &'a Gallery,
    date: SystemTime,
    kind: PageKind,
}

/// What a page has of its shaders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PageKind {
    /// The table, and an article for each.
    Shaders,
    /// The table alone, which leads to the articles of other pages.
    Index,
}

impl Page<'_> {
    /// Formats the page, with links to other pages.
    fn html(&self, links: &str) -> String {
        let Self {
            report,
            records,
            rubrics,
            gallery,
            date,
            kind,
        } = *self;
        let names = &Names::new(report.shaders());
        let glossary = Glossary::new(if kind == PageKind::Index { &[] } else { records });
        let sources = gallery
            .exhibits()
            .iter()
            .filter_map(|exhibit| exhibit.source.as_deref());
        let limit = SourceLimit::new(sources);
        let articles = records.iter().zip(gallery.exhibits()).enumerate();
        let articles: String = articles
            .map(|(index, (record, exhibit))| {
                let article = Article {
                    record,
                    name: names.short(record),
                    exhibit,
                    rubrics,
                    glossary: &glossary,
                    limit,
                };
                article.html(index)
            })
            .collect();
        let heading = heading(names, records);
        let overview = Overview {
            records,
            names,
            gallery,
            rubrics,
            kind,
        };
        // A page with a part of the shaders says nothing about the class.
        let class = if records.len() == report.shaders().len() {
            distribution::html(records, rubrics)
        } else {
            String::new()
        };
        format!(
            r##"{head}<body{kind}>
<a class="skip" href="#main">Skip to the content</a>
<header class="page">
<h1>{heading}</h1>
{facts}{subsampling_note}<div class="tools"></div>
</header>
{links}<main id="main" tabindex="-1">
{overview}<div id="articles">
{articles}</div>
</main>
{glossary}{VIEWER}{images}<script>{SCRIPT}</script>
</body>
</html>
"##,
            head = head(&heading),
            kind = match kind {
                PageKind::Shaders => "",
                PageKind::Index => " class=\"index\"",
            },
            facts = facts(report, records.len(), names, date),
            subsampling_note = subsampling_note(gallery.step()),
            overview = overview.html() + &class,
            glossary = glossary.html(),
            images = images(gallery),
        )
    }
}

/// The start of a page, up to its body.
fn head(title: &str) -> String {
    format!(
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>{STYLE}</style>
<script>{HEAD_SCRIPT}</script>
</head>
"#,
        policy = policy(),
    )
}

/// The title of the page: the folder, else the only shader, else the number of shaders.
fn heading(names: &Names, records: &[Record]) -> String {
    let subject = match (names.folder_name(), records) {
        (_, [only]) => names.short(only).to_owned(),
        ("", _) => shaders(records.len()),
        (folder, _) => folder.to_owned(),
    };
    format!("toyproof check: {}", Text(subject))
}

fn shaders(count: usize) -> String {
    let count = count as u64;
    format!("{} {}", grouped(count), plural(count, "shader", "shaders"))
}

/// The facts about the run below the title.
fn facts(report: &Report, count: usize, names: &Names, date: SystemTime) -> String {
    let mut facts = format!("<span class=\"whole\">{}</span>", shaders(count));
    if !names.folder().is_empty() {
        let _ = write!(
            facts,
            "<span class=\"whole\">Folder: {}</span>",
            Text(names.folder())
        );
    }
    let [day, time] = utc(date);
    let _ = write!(facts, "<time datetime=\"{day}T{time}Z\">{day} {time} UTC</time>");
    if let Some(device) = report.device() {
        let _ = write!(facts, "<span>Device: {}</span>", Text(device));
    }
    let _ = write!(facts, "<span>{}</span>", Text(report.tool()));
    format!("<p class=\"facts\">{facts}</p>\n")
}

/// The day and the time, to the minute, in UTC: `2026-02-28` and `23:59`.
fn utc(date: SystemTime) -> [String; 2] {
    let seconds = date.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
    let minutes = seconds / 60 % 1_440;
    [
        Date::from_days_since_1970((seconds / 86_400) as i64).to_string(),
        format!("{:02}:{:02}", minutes / 60, minutes % 60),
    ]
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
        "<p class=\"subsampled\">Full-size images would make this page too large, so it shows one \
         pixel of every {step} by {step}. The image files beside the page have all pixels.</p>\n"
    )
}

/// The images and the legends, as data for the script: a browser decodes only the images that are viewed.
fn images(gallery: &Gallery) -> String {
    let settings = parts::settings(gallery.step());
    let images = gallery.images().iter().enumerate();
    let images: Vec<_> = images
        .map(|(index, png)| {
            let data = STANDARD.encode(png);
            format!("<script id=\"p{index}\" type=\"text/plain\">{data}</script>\n")
        })
        .collect();
    let images = images.concat();
    // The settings are numbers and our own texts, which cannot end the element.
    format!("{images}<script id=\"settings\" type=\"application/json\">{settings}</script>\n")
}

// Escaping of text for HTML, in an element or between double quotes. Characters that affect the surrounding
// text, such as bidirectional controls, are escaped too.

/// Escapes a sentence. Text between backticks is code; a number and its percent sign stay on one line.
fn sentence(text: &str) -> String {
    let parts: Vec<_> = text.split('`').map(|part| Text(part).to_string()).collect();
    if parts.len().is_multiple_of(2) {
        // The backticks are not in pairs.
        return Text(text).to_string();
    }
    let parts = parts.iter().enumerate().map(|(index, part)| {
        if index % 2 == 1 {
            format!("<code>{part}</code>")
        } else {
            part.replace(" %", "&nbsp;%")
        }
    });
    parts.collect()
}

/// Displays a value with the special characters of HTML escaped.
pub(super) struct Text<T>(pub(super) T);

impl<T: Display> Display for Text<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(EscapeWriter(f), "{}", self.0)
    }
}

struct EscapeWriter<'a, 'b>(&'a mut Formatter<'b>);

impl Write for EscapeWriter<'_, '_> {
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
    use crate::Mistake;
    use crate::record::samples::{every_verdict, invalid};
    use crate::repair::samples::repaired;

    fn page(records: Vec<Record>, gallery: &Gallery) -> String {
        let report = Report::new(Some("<device>".to_owned()), records);
        html(&report, &Rubrics::default(), gallery, UNIX_EPOCH)
    }

    #[test]
    fn no_text_becomes_markup() {
        const HOSTILE: &str = "\"'><script>hacked()</script><img src=x onerror=hacked()>";
        let mut record = invalid();
        for text in [&mut record.shader, &mut record.reason] {
            HOSTILE.clone_into(text);
        }
        (record.scene, record.help) = (Some(HOSTILE.to_owned()), Some(HOSTILE.to_owned()));
        record.reference = Some(HOSTILE.to_owned());
        record.details = vec![HOSTILE.to_owned()];
        record.mistake = Some(Mistake {
            id: HOSTILE.to_owned(),
            text: HOSTILE.to_owned(),
            is_symptom: true,
            alternatives: Vec::new(),
        });
        let mut fix = repaired().fix.unwrap();
        for text in [&mut fix.id, &mut fix.file] {
            HOSTILE.clone_into(text);
        }
        fix.text = Some(HOSTILE.to_owned());
        fix.edits[0].text = Some(HOSTILE.to_owned());
        fix.edits[0].range.line = 1;
        fix.alternatives = vec![fix.clone()];
        record.fix = Some(fix);
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
        assert!(page.matches("&lt;img src=x").count() >= 11, "the text is shown");
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
        assert!(!page(Vec::new(), &Gallery::new(1)).contains("class=\"subsampled\""));
        assert!(page(Vec::new(), &Gallery::new(3)).contains("one pixel of every 3 by 3"));
    }

    #[test]
    fn the_head_states_what_was_checked_and_when() {
        let mut records = every_verdict();
        for record in &mut records {
            record.shader.insert_str(0, "class/hw<3/");
        }
        let report = Report::new(None, records);
        let time = UNIX_EPOCH + std::time::Duration::from_secs(951_827_640);
        let page = html(&report, &Rubrics::default(), &Gallery::new(1), time);
        assert!(page.contains("<h1>toyproof check: hw&lt;3</h1>"));
        assert!(page.contains("Folder: class/hw&lt;3<"));
        assert!(page.contains("<time datetime=\"2000-02-29T12:34Z\">2000-02-29 12:34 UTC</time>"));
    }

    /// The relative luminance of a color of the style, as WCAG 2 defines it.
    fn luminance(hex: &str) -> f64 {
        let digits: Vec<_> = hex.chars().map(|digit| digit.to_digit(16).unwrap()).collect();
        let levels: Vec<_> = match digits[..] {
            [r, g, b] => vec![17 * r, 17 * g, 17 * b],
            _ => digits.chunks(2).map(|pair| 16 * pair[0] + pair[1]).collect(),
        };
        let linear = |level: u32| match f64::from(level) / 255.0 {
            low @ ..=0.04045 => low / 12.92,
            value => ((value + 0.055) / 1.055).powf(2.4),
        };
        0.2126 * linear(levels[0]) + 0.7152 * linear(levels[1]) + 0.0722 * linear(levels[2])
    }

    #[test]
    fn colors_have_the_contrast_of_wcag_aa() {
        let color = |name: &str, theme: usize| {
            let start = format!("--{name}: light-dark(");
            let (_, rest) = STYLE.split_once(&start).expect(name);
            let (both, _) = rest.split_once(')').unwrap();
            luminance(both.split(", ").nth(theme).unwrap().trim_start_matches('#'))
        };
        let texts = ["ink", "soft", "accent", "good", "bad", "odd"];
        let pairs = texts
            .into_iter()
            .flat_map(|text| ["paper", "panel", "raised"].map(|back| (text, back, 4.5)))
            .chain(["paper", "panel", "raised"].map(|back| ("edge", back, 3.0)))
            .chain([
                ("good", "good-back", 4.5),
                ("bad", "bad-back", 4.5),
                ("odd", "odd-back", 4.5),
            ])
            .chain(["ink", "soft"].map(|text| (text, "bad-back", 4.5)))
            .chain(["ink", "soft", "accent"].map(|text| (text, "odd-back", 4.5)))
            .chain([("paper", "accent", 4.5)]);
        for (text, back, least) in pairs {
            for theme in [0, 1] {
                let (a, b) = (color(text, theme), color(back, theme));
                let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                assert!(
                    contrast >= least,
                    "{text} on {back}, theme {theme}: {contrast:.2}"
                );
            }
        }
    }

    #[test]
    fn code_in_sentences_is_marked_and_escaped() {
        assert_eq!(
            sentence("`<a>` is not `b`: 5 %"),
            "<code>&lt;a&gt;</code> is not <code>b</code>: 5&nbsp;%"
        );
        assert_eq!(sentence("a ` <b>"), "a ` &lt;b&gt;");
        assert_eq!(
            sentence("</code>`</code>`"),
            "&lt;/code&gt;<code>&lt;/code&gt;</code>"
        );
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
