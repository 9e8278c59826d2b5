//! One shader on the page: its verdict, the likely mistake, the fix, its images, its checks and its source.

use std::fmt::Write as _;

use toyproof_diagnostic::{color_difference, grouped};
use toyproof_verify::compare::{CheckSummary, Pixel};

use super::glossary::{Glossary, term};
use super::source::{SourceLimit, source};
use super::{Exhibit, Text, sentence};
use crate::departure::DepartureKind;
use crate::repair::{in_tab, suspect_lines};
use crate::terminal::{CUT_BY_TIME, CUT_SEARCH};
use crate::{Departure, Mistake, Record, Repair, Rubrics};

/// The contents of the article of a shader.
pub(super) struct Article<'a> {
    pub(super) record: &'a Record,
    /// The short name.
    pub(super) name: &'a str,
    pub(super) exhibit: &'a Exhibit,
    pub(super) rubrics: &'a Rubrics,
    pub(super) glossary: &'a Glossary,
    pub(super) limit: SourceLimit,
}

/// The checks, each of which is a term of the glossary.
const CHECKS: [&str; 3] = ["algorithm", "precision", "toolchain"];

impl Article<'_> {
    pub(super) fn html(&self, index: usize) -> String {
        let Self { record, name, .. } = self;
        let verdict = record.verdict.to_string();
        format!(
            r#"<article id="s{index}" aria-labelledby="h{index}" data-name="{name}"{images}>
<h2 id="h{index}" tabindex="-1">{name}</h2>
{facts}<p class="result"><span class="verdict {verdict}">{verdict_term}</span> {reason}</p>
{details}{mistake}{fix}{help}<div class="images"></div>
{assigned}{frames}{checks}{source}</article>
"#,
            name = Text(name),
            images = self.images(),
            facts = self.facts(),
            verdict_term = term(&verdict, &verdict),
            reason = sentence(&record.reason),
            details = details(&record.details),
            mistake = record
                .mistake
                .as_ref()
                .map(|mistake| self.mistake(mistake))
                .unwrap_or_default(),
            fix = self.fix(),
            help = record.help.as_deref().map(command).unwrap_or_default(),
            assigned = assigned(record),
            frames = frames(record),
            checks = checks(record),
            source = source(record, self.exhibit.source.as_deref(), self.limit, self.glossary),
        )
    }

    /// The attributes that refer to the images.
    fn images(&self) -> String {
        let [algorithm, precision, toolchain] = self.exhibit.checks;
        let departure = self
            .record
            .departure
            .as_ref()
            .filter(|_| self.record.fix.is_none());
        let [own, missing] = self.exhibit.values;
        let images = [
            ("actual", self.exhibit.actual),
            ("reference", self.exhibit.reference),
            ("fixed", self.exhibit.fixed.filter(|_| self.record.fix.is_some())),
            ("algorithm", algorithm),
            ("precision", precision),
            ("toolchain", toolchain),
            (
                "value",
                own.filter(|_| departure.is_some_and(|found| found.unknown.is_some())),
            ),
            (
                "reference-value",
                missing.filter(|_| departure.is_some_and(|found| found.missing.is_some())),
            ),
        ];
        let images = images.into_iter();
        images
            .filter_map(|(name, place)| Some(format!(" data-{name}=\"{}\"", place?)))
            .collect()
    }

    /// The facts about the shader below its name.
    fn facts(&self) -> String {
        let Record {
            shader,
            scene,
            reference,
            seconds,
            submitted,
            ..
        } = self.record;
        let mut facts = String::new();
        if shader != self.name {
            let _ = write!(facts, "<span>File: {}</span>", Text(shader));
        }
        for (kind, name) in [("Scene", scene), ("Reference", reference)] {
            if let Some(name) = name {
                let _ = write!(facts, "<span>{kind}: {}</span>", Text(name));
            }
        }
        if let Some(submitted) = submitted {
            let _ = write!(facts, "<span>Student: {}</span>", Text(&submitted.student));
            if let Some(assignment) = &submitted.assignment {
                let _ = write!(facts, "<span>Assignment: {}</span>", Text(assignment));
            }
            if let Some(late) = submitted.late {
                let _ = write!(facts, "<span>Submitted {late}</span>");
            }
        }
        let seconds = seconds.total();
        if seconds > 0.0 {
            let _ = write!(facts, "<span>Time: {seconds:.2} s</span>");
        }
        facts += &points(self.rubrics, self.record);
        if facts.is_empty() {
            return facts;
        }
        format!("<p class=\"facts\">{facts}</p>\n")
    }

    /// The likely mistake with links to its explanation; with alternatives, a ranked list. A symptom is not
    /// one of the mistakes: they cause it.
    fn mistake(&self, mistake: &Mistake) -> String {
        let explained = |id: &str, text: &str| sentence(text) + &self.explanation(id);
        let first = explained(&mistake.id, &mistake.text);
        let others = mistake.alternatives.iter();
        let mut ranked: Vec<_> = others.map(|other| explained(&other.id, &other.text)).collect();
        let mut html = String::new();
        if mistake.is_symptom {
            let _ = writeln!(
                html,
                "<p><strong>{}:</strong> {first}</p>",
                term("symptom", "Symptom")
            );
        } else if ranked.is_empty() {
            let _ = writeln!(html, "<p><strong>Likely mistake:</strong> {first}</p>");
        } else {
            ranked.insert(0, first);
        }
        if !ranked.is_empty() {
            let ranked = ranked.iter().map(|one| format!("<li>{one}</li>\n"));
            let ranked = ranked.collect::<Vec<_>>().concat();
            let _ = write!(
                html,
                "<p><strong>Possible mistakes</strong>, the most likely first:</p>\n<ol>\n{ranked}</ol>\n"
            );
        }
        format!("<div class=\"mistake\">\n{html}</div>\n")
    }

    /// The links to the explanation of a mistake, after its sentence; empty if there is none.
    fn explanation(&self, id: &str) -> String {
        let links = self.glossary.mistake_links(id);
        let span = links.map(|links| format!(" <span class=\"explanation\">Explanation: {links}</span>"));
        span.unwrap_or_default()
    }

    /// The fix with its alternatives, else where the shader departs from the reference, and the suspect lines.
    fn fix(&self) -> String {
        let Record {
            fix,
            departure,
            suspects,
            is_search_cut,
            is_cut_by_time,
            ..
        } = self.record;
        let mut html = String::new();
        if let Some(fix) = fix {
            // The explanation of the likely mistake is next to it.
            let mistake = self.record.mistake.as_ref().map(|mistake| mistake.id.as_str());
            let explained = |repair: &Repair, text: &str| {
                let new = Some(repair.id.as_str()).filter(|id| Some(*id) != mistake);
                sentence(text) + &new.map(|id| self.explanation(id)).unwrap_or_default()
            };
            let first = explained(fix, &(in_tab(fix, &self.record.shader) + &fix.sentence()));
            let _ = writeln!(html, "<p><strong>{}:</strong> {first}</p>", term("fix", "Fix"));
            for other in &fix.alternatives {
                let other = explained(other, &(in_tab(other, &self.record.shader) + &other.summary()));
                let _ = writeln!(html, "<p><strong>Or:</strong> {other}</p>");
            }
        }
        let departure = departure.iter().filter(|_| fix.is_none());
        for (kind, text) in departure.flat_map(Departure::sentences) {
            let label = match kind {
                DepartureKind::FirstDifference => "First difference",
                DepartureKind::MissingValue => "Missing value",
            };
            let _ = writeln!(html, "<p><strong>{label}:</strong> {}</p>", sentence(&text));
        }
        if fix.is_none()
            && let Some((_, lines)) = suspect_lines(suspects)
        {
            let label = match suspects[..] {
                [_] => "Suspect line",
                _ => "Suspect lines",
            };
            let label = term("suspect-lines", label);
            let _ = writeln!(html, "<p><strong>{label}:</strong> {lines}</p>");
            if *is_search_cut {
                let _ = writeln!(html, "<p>{}</p>", sentence(CUT_SEARCH));
            }
        }
        if *is_cut_by_time {
            let _ = writeln!(html, "<p>{}</p>", sentence(CUT_BY_TIME));
        }
        if html.is_empty() {
            return html;
        }
        format!("<div class=\"repair\">\n{html}</div>\n")
    }
}

fn details(details: &[String]) -> String {
    if details.is_empty() {
        return String::new();
    }
    let details = details
        .iter()
        .map(|detail| format!("<li>{}</li>\n", sentence(detail)));
    format!("<ul class=\"details\">\n{}</ul>\n", details.collect::<String>())
}

/// The violated rules and the tested functions of an assignment.
fn assigned(record: &Record) -> String {
    let faults = record.faults().into_iter();
    let right = record.right_functions().map(|sentence| ("function", sentence));
    let items = faults.chain(right);
    let items = items.map(|(label, text)| format!("<li>{}</li>\n", sentence(&format!("{label}: {text}"))));
    let items = items.collect::<Vec<_>>().concat();
    if items.is_empty() {
        return items;
    }
    format!("<h3>Rules and functions</h3>\n<ul class=\"assigned\">\n{items}</ul>\n")
}

/// The list of the frames in which the shader was checked, if there are several; the images show the first
/// with the shader's verdict.
fn frames(record: &Record) -> String {
    let Some(frames @ [_, _, ..]) = record.frames.as_deref() else {
        return String::new();
    };
    let shown = record.shown_frame();
    let items = frames.iter().enumerate().map(|(index, frame)| {
        let verdict = frame.verdict.to_string();
        let shown = if index == shown { " (shown here)" } else { "" };
        format!(
            "<li><span class=\"verdict {verdict}\">{verdict_term}</span> {label}{shown}: {reason}</li>\n",
            verdict_term = term(&verdict, &verdict),
            label = Text(&frame.label()),
            reason = sentence(&frame.reason),
        )
    });
    format!(
        "<h3>Frames</h3>\n<ol class=\"frames\">\n{}</ol>\n",
        items.collect::<Vec<_>>().concat()
    )
}

/// The command that shows more; the script adds a button that copies it.
fn command(command: &str) -> String {
    format!(
        "<p class=\"command\"><span>More:</span> <code>{}</code></p>\n",
        Text(command)
    )
}

/// The points, in total and of each check.
fn points(rubrics: &Rubrics, record: &Record) -> String {
    let (Some(rubric), Some([points, of])) = (rubrics.find(record), rubrics.total(record)) else {
        return String::new();
    };
    let marks = rubric.marks(record).into_iter();
    let marks: Vec<_> = marks
        .map(|mark| match mark.of {
            // Deductions have no maximum.
            0.0 => format!("{} {}", Text(&mark.name), mark.points),
            of => format!("{} {} of {of}", Text(&mark.name), mark.points),
        })
        .collect();
    format!("<span>Points: {points} of {of} ({})</span>", marks.join(", "))
}

/// The table of the three checks; empty if none ran.
fn checks(record: &Record) -> String {
    let summaries = [&record.algorithm, &record.precision, &record.toolchain];
    if summaries.iter().all(|summary| summary.is_none()) {
        return String::new();
    }
    let rows = CHECKS
        .into_iter()
        .zip(summaries)
        .map(|(name, summary)| {
            let cells = if let Some(summary) = summary {
                check_cells(summary)
            } else {
                let why = record.skipped_toolchain_reason().filter(|_| name == "toolchain");
                format!(
                    "<td class=\"none\" colspan=\"5\">{}</td>",
                    why.unwrap_or("not run")
                )
            };
            format!(
                "<tr data-check=\"{name}\"><th scope=\"row\">{}</th>{cells}</tr>\n",
                term(name, name)
            )
        })
        .collect::<Vec<_>>()
        .concat();
    let number = |id: &str, text: &str| format!("<th scope=\"col\" class=\"number\">{}</th>", term(id, text));
    format!(
        r#"<div class="scroll" tabindex="0" role="region" aria-label="Checks">
<table class="checks">
<caption>Checks</caption>
<thead>
<tr><th scope="col">Check</th>{}{}{}{}<th scope="col">Inspect</th></tr>
</thead>
<tbody>
{rows}</tbody>
</table>
</div>
"#,
        number("pixels-off", "Pixels off"),
        number("ill-conditioned", "Ill-conditioned"),
        number("undefined", "Undefined"),
        number("largest", "Largest difference"),
    )
}

fn check_cells(check: &CheckSummary) -> String {
    let first = check.first.as_ref().filter(|_| check.first != check.worst);
    let named = [("worst", check.worst.as_ref()), ("first", first)];
    let named: Vec<_> = named
        .into_iter()
        .filter_map(|(name, pixel)| Some(place(name, pixel?)))
        .collect();
    let off = match check.differing {
        0 => "0".to_owned(),
        differing => format!("{} of {}", grouped(differing), grouped(check.pixels)),
    };
    // On a narrow screen there is no header, and the cells name their columns.
    let number =
        |name: &str, number: &str| format!("<td class=\"number\" data-name=\"{name}\">{number}</td>");
    [
        number("Pixels off", &off),
        number("Ill-conditioned", &grouped(check.ill_conditioned)),
        number("Undefined", &grouped(check.undefined)),
        number("Largest difference", &color_difference(check.max_abs)),
        format!("<td>{}</td>", named.join(" ")),
    ]
    .concat()
}

/// Formats a pixel, which the script turns into a button; the numbers are floats, as compared.
fn place(name: &str, pixel: &Pixel) -> String {
    let color = |[r, g, b]: [f32; 3]| format!("{r}, {g}, {b}");
    format!(
        "<span class=\"pixel\" data-x=\"{x}\" data-y=\"{y}\" data-expected=\"{}\" data-actual=\"{}\">{name} ({x}, {y})</span>",
        color(pixel.expected),
        color(pixel.actual),
        x = pixel.x,
        y = pixel.y,
    )
}

#[cfg(test)]
mod tests {
    use toyproof_verify::Verdict;

    use super::*;
    use crate::record::samples::{check_summary, correct, record};
    use crate::repair::samples::{SOURCE, repaired, suspected};
    use crate::{Alternative, FunctionRecord, Hints, MissingValue, Rubric, SourceRange, UnknownValue};

    fn article(record: &Record) -> String {
        let article = Article {
            record,
            name: &record.shader,
            exhibit: &Exhibit::default(),
            rubrics: &Rubrics::default(),
            glossary: &Glossary::new(std::slice::from_ref(record)),
            limit: SourceLimit::new([]),
        };
        article.html(0)
    }

    #[test]
    fn mistakes_are_ranked_and_symptoms_are_labeled() {
        let mut wrong = record(Verdict::Wrong);
        wrong.mistake = Some(Mistake {
            // Any explained code does for a mistake.
            id: "E0301".to_owned(),
            text: "<first>".to_owned(),
            is_symptom: false,
            alternatives: Vec::new(),
        });
        let html = article(&wrong);
        assert!(
            html.contains("<strong>Likely mistake:</strong> &lt;first&gt; <span"),
            "{html}"
        );
        assert!(html.contains("href=\"#x-E0301\""), "{html}");
        wrong.mistake.as_mut().unwrap().alternatives.push(Alternative {
            id: "unexplained".to_owned(),
            text: "second".to_owned(),
        });
        let html = article(&wrong);
        assert!(html.contains("<ol>\n<li>&lt;first&gt;"), "{html}");
        assert!(html.contains("<li>second</li>\n</ol>"), "{html}");
        wrong.mistake.as_mut().unwrap().is_symptom = true;
        let html = article(&wrong);
        assert!(
            html.contains("href=\"#t-symptom\"") && html.contains("</strong> &lt;first&gt;"),
            "{html}"
        );
        assert!(html.contains("<ol>\n<li>second</li>\n</ol>"), "{html}");
    }

    /// The article of a shader whose source and fixed image are shown.
    fn article_with_source(record: &Record) -> String {
        let exhibit = Exhibit {
            source: Some(SOURCE.to_owned()),
            fixed: Some(7),
            ..Exhibit::default()
        };
        let article = Article {
            record,
            name: &record.shader,
            exhibit: &exhibit,
            rubrics: &Rubrics::default(),
            glossary: &Glossary::new(std::slice::from_ref(record)),
            limit: SourceLimit::new([SOURCE]),
        };
        article.html(0)
    }

    #[test]
    fn a_fix_is_shown_with_its_image_and_its_line() {
        let html = article_with_source(&repaired());
        assert!(
            html.contains(
                "line 2: replace <code>b + c</code> with <code>b - c</code>; then all 14,400 pixels agree"
            ),
            "{html}"
        );
        assert!(html.contains("<strong>Or:</strong> line 2: remove"), "{html}");
        assert_eq!(html.matches("href=\"#x-wrong-operator\"").count(), 1, "{html}");
        assert_eq!(html.matches("href=\"#x-two-mistakes\"").count(), 1, "{html}");
        assert!(html.contains("data-fixed=\"7\""), "{html}");
        assert!(html.contains("return <mark>b + c</mark>;"), "{html}");
        assert!(!html.contains("Suspect"), "{html}");
    }

    #[test]
    fn suspect_lines_are_shown_without_a_fix() {
        let html = article_with_source(&suspected());
        assert!(html.contains("Suspect lines</a>:</strong> 4, 2</p>"), "{html}");
        assert!(html.contains("= <mark>1.0</mark>;"), "{html}");
        assert!(!html.contains("data-fixed"), "{html}");
    }

    #[test]
    fn hints_hide_the_fix() {
        let hidden = repaired().redacted(Hints::Line);
        let html = article_with_source(&hidden);
        assert!(
            html.contains("an edit of line 2") && !html.contains("b - c"),
            "{html}"
        );
        let html = article_with_source(&hidden.redacted(Hints::None));
        assert!(!html.contains("data-fixed") && !html.contains("<mark>"), "{html}");
    }

    #[test]
    fn departures_are_labeled() {
        let mut wrong = record(Verdict::Wrong);
        wrong.departure = Some(Departure {
            unknown: Some(UnknownValue {
                range: SourceRange {
                    line: 2,
                    column: 1,
                    end_line: 2,
                    end_column: 6,
                },
                text: "`b + c`".to_owned(),
                called_at: None,
                value: vec![Some(1.0)],
                x: 3,
                y: 4,
            }),
            missing: Some(MissingValue {
                line: None,
                reference_line: 7,
                text: "`b - c`".to_owned(),
                value: vec![Some(2.0)],
                x: 3,
                y: 4,
            }),
        });
        let html = article(&wrong);
        assert!(
            html.contains("<strong>First difference:</strong> line 2: "),
            "{html}"
        );
        assert!(
            html.contains("<strong>Missing value:</strong> <code>b - c</code>"),
            "{html}"
        );
    }

    #[test]
    fn names_of_marks_are_escaped() {
        let mut record = correct();
        record.functions = vec![FunctionRecord::untested("<f>", 2.0, "")];
        let html = points(&Rubrics::from(Some(Rubric::default())), &record);
        assert!(html.contains("&lt;f&gt; 0 of 2"), "{html}");
    }

    #[test]
    fn checks_count_pixels() {
        assert!(!article(&record(Verdict::Invalid)).contains("class=\"checks\""));
        let mut record = correct();
        record.algorithm = Some(check_summary([1_000, 0, 0]));
        (record.toolchain, record.seconds.gpu) = (None, None);
        let html = article(&record);
        assert!(
            html.contains("data-name=\"Pixels off\">1,000 of 1,000</td>"),
            "{html}"
        );
        assert!(html.contains("no GPU rendered the shader"), "{html}");
    }
}
