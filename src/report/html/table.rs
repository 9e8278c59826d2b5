//! The table of all shaders, and what chooses its rows.

use toyproof_verify::compare::Answer;

use super::text::Text;
use super::verdict;
use crate::report::{Record, Rubric};

pub(super) fn table(records: &[Record], rubric: Option<&Rubric>) -> String {
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

/// Cells that are not sorted by their words have a number in `data-by`.
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
        share(record.maths.as_ref()),
        share(record.rounding.as_ref()),
        Text(&record.reason),
    )
}

/// How many of a question's pixels differ.
fn share(answer: Option<&Answer>) -> String {
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

/// How long it took; nothing where it got no further than to be stopped.
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
