//! All that there is to say of one shader.

use toyproof_verify::compare::{Answer, Pixel, grouped, magnitude};

use super::messages::messages;
use super::text::Text;
use super::{Exhibit, verdict};
use crate::report::Record;

pub(super) fn article(index: usize, record: &Record, exhibit: &Exhibit) -> String {
    let [maths, rounding, toolchain] = exhibit.questions;
    let pictures = [
        ("actual", exhibit.actual),
        ("reference", exhibit.reference),
        ("maths", maths),
        ("rounding", rounding),
        ("toolchain", toolchain),
    ];
    let pictures: String = pictures
        .into_iter()
        .filter_map(|(name, place)| Some(format!(" data-{name}=\"{}\"", place?)))
        .collect();
    let scene = record.scene.as_ref();
    let scene = scene.map(|scene| format!("<p class=\"scene\">Scene: {}</p>\n", Text(scene)));
    format!(
        r#"<article id="s{index}" aria-labelledby="h{index}"{pictures}>
<h2 id="h{index}" tabindex="-1">{name}</h2>
<p>{verdict} {reason}</p>
{scene}<div class="pictures"></div>
{questions}{messages}</article>
"#,
        name = Text(&record.shader),
        verdict = verdict(record.verdict),
        reason = Text(&record.reason),
        scene = scene.unwrap_or_default(),
        questions = questions(record),
        messages = messages(&record.diagnostics, &record.shader, exhibit.source.as_deref()),
    )
}

fn questions(record: &Record) -> String {
    let questions = [
        ("maths", &record.maths),
        ("rounding", &record.rounding),
        ("toolchain", &record.toolchain),
    ];
    if questions.iter().all(|(_, answer)| answer.is_none()) {
        return String::new();
    }
    let rows: Vec<_> = questions
        .into_iter()
        .map(|(name, answer)| {
            let why = record.toolchain_unasked().filter(|_| name == "toolchain");
            let why = why.map(|why| format!(", {why}")).unwrap_or_default();
            let cells = answer.as_ref().map_or_else(
                || format!("<td class=\"none\" colspan=\"5\">not asked{why}</td>"),
                answered,
            );
            format!("<tr data-question=\"{name}\"><th scope=\"row\">{name}</th>{cells}</tr>\n")
        })
        .collect();
    let rows = rows.concat();
    format!(
        r#"<div class="scroll">
<table class="questions" aria-label="The three questions">
<thead>
<tr><th scope="col">Question</th><th scope="col" class="number">Differ</th><th scope="col" class="number">Undecided</th><th scope="col" class="number">Undefined</th><th scope="col" class="number">At most by</th><th scope="col">Look at</th></tr>
</thead>
<tbody>
{rows}</tbody>
</table>
</div>
"#
    )
}

fn answered(answer: &Answer) -> String {
    let first = answer.first.as_ref().filter(|_| answer.first != answer.worst);
    let named = [("worst", answer.worst.as_ref()), ("first", first)];
    let named: Vec<_> = named
        .into_iter()
        .filter_map(|(name, pixel)| Some(place(name, pixel?)))
        .collect();
    format!(
        "<td class=\"number\">{} of {}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>\
         <td>{}</td>",
        grouped(answer.differing),
        grouped(answer.pixels),
        grouped(answer.undecided),
        grouped(answer.undefined),
        magnitude(answer.max_abs),
        named.join(" ")
    )
}

/// A pixel, which the script makes a button of; the numbers are floats, as they were compared.
fn place(name: &str, pixel: &Pixel) -> String {
    let colour = |[r, g, b]: [f32; 3]| format!("{r}, {g}, {b}");
    format!(
        "<span class=\"pixel\" data-x=\"{x}\" data-y=\"{y}\" data-expected=\"{}\" data-actual=\"{}\">{name}: {x}, {y}</span>",
        colour(pixel.expected),
        colour(pixel.actual),
        x = pixel.x,
        y = pixel.y,
    )
}
