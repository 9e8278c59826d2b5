//! One shader on the page: its verdict, its checks, its images and its messages.

use toyproof_diagnostic::{Json, grouped, magnitude};
use toyproof_verify::compare::{CheckSummary, Pixel};

use super::{Exhibit, Text, verdict};
use crate::report::Record;

pub(super) fn article(index: usize, record: &Record, exhibit: &Exhibit) -> String {
    let [algorithm, precision, toolchain] = exhibit.checks;
    let images = [
        ("actual", exhibit.actual),
        ("reference", exhibit.reference),
        ("maths", algorithm),
        ("rounding", precision),
        ("toolchain", toolchain),
    ];
    let images: String = images
        .into_iter()
        .filter_map(|(name, place)| Some(format!(" data-{name}=\"{}\"", place?)))
        .collect();
    let scene = record.scene.as_ref();
    let scene = scene.map(|scene| format!("<p class=\"scene\">Scene: {}</p>\n", Text(scene)));
    format!(
        r#"<article id="s{index}" aria-labelledby="h{index}"{images}>
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
        ("maths", &record.algorithm),
        ("rounding", &record.precision),
        ("toolchain", &record.toolchain),
    ];
    if questions.iter().all(|(_, answer)| answer.is_none()) {
        return String::new();
    }
    let rows: Vec<_> = questions
        .into_iter()
        .map(|(name, answer)| {
            let why = record.skipped_toolchain_reason().filter(|_| name == "toolchain");
            let why = why.map(|why| format!(", {why}")).unwrap_or_default();
            let cells = answer.as_ref().map_or_else(
                || format!("<td class=\"none\" colspan=\"5\">not asked{why}</td>"),
                answer_cells,
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

fn answer_cells(answer: &CheckSummary) -> String {
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
        grouped(answer.ill_conditioned),
        grouped(answer.undefined),
        magnitude(answer.max_abs),
        named.join(" ")
    )
}

/// Formats a pixel, which the script turns into a button; the numbers are floats, as compared.
fn place(name: &str, pixel: &Pixel) -> String {
    let color = |[r, g, b]: [f32; 3]| format!("{r}, {g}, {b}");
    format!(
        "<span class=\"pixel\" data-x=\"{x}\" data-y=\"{y}\" data-expected=\"{}\" data-actual=\"{}\">{name}: {x}, {y}</span>",
        color(pixel.expected),
        color(pixel.actual),
        x = pixel.x,
        y = pixel.y,
    )
}

// The messages on a shader, with excerpts of its text.

/// The maximum number of messages that are shown for one shader.
const MAX_MESSAGES: usize = 50;
/// The number of context lines before and after the reported one.
const CONTEXT_LINES: usize = 2;
/// The maximum number of characters shown of a line.
const MAX_LINE_CHARS: usize = 200;

/// Formats the messages, with excerpts for those on `file`.
fn messages(diagnostics: &[Json], file: &str, source: Option<&str>) -> String {
    if diagnostics.is_empty() {
        return String::new();
    }
    let lines: Vec<_> = source.map_or_else(Vec::new, |text| text.lines().collect());
    let shown: Vec<_> = diagnostics
        .iter()
        .take(MAX_MESSAGES)
        .map(|one| format!("<li>{}</li>\n", message(one, file, &lines)))
        .collect();
    let shown = shown.concat();
    let more = match diagnostics.len().saturating_sub(MAX_MESSAGES) {
        0 => String::new(),
        more => format!("<p>and {more} more</p>\n"),
    };
    format!("<h3>Messages</h3>\n<ol class=\"messages\">\n{shown}</ol>\n{more}")
}

fn message(diagnostic: &Json, file: &str, lines: &[&str]) -> String {
    let Json { severity, code, .. } = diagnostic;
    let mut place = String::new();
    let mut code_lines = String::new();
    if let (Some(own), Some(line), Some(column)) = (&diagnostic.file, diagnostic.line, diagnostic.column) {
        place = format!(" <span class=\"place\">{}:{line}:{column}</span>", Text(own));
        if own == file && (1..=lines.len()).contains(&line) {
            let excerpt = excerpt(lines, line, column);
            code_lines =
                format!("<pre tabindex=\"0\" aria-label=\"line {line}\"><code>{excerpt}</code></pre>");
        }
    }
    let notes = diagnostic
        .notes
        .iter()
        .map(|note| format!("<p class=\"note\">{}</p>", Text(note)));
    format!(
        "<p><strong class=\"{severity}\">{severity} {}</strong> {}{place}</p>{code_lines}{}",
        Text(code),
        Text(&diagnostic.message),
        notes.collect::<String>()
    )
}

/// Formats the lines around a position, with line numbers and the reported word marked.
fn excerpt(lines: &[&str], line: usize, column: usize) -> String {
    let first = line.saturating_sub(CONTEXT_LINES).max(1);
    let last = (line + CONTEXT_LINES).min(lines.len());
    let digits = last.to_string().len();
    let shown = (first..=last).map(|number| {
        let text = lines[number - 1];
        let text = if number == line {
            mark_word(text, column)
        } else {
            Text(text.chars().take(MAX_LINE_CHARS).collect::<String>()).to_string()
        };
        format!("<span class=\"line-number\">{number:digits$} </span>{text}\n")
    });
    shown.collect()
}

/// Marks the word that starts in a column; a long line is cut around it.
fn mark_word(line: &str, column: usize) -> String {
    let start = column.saturating_sub(1);
    let skipped = start.saturating_sub(MAX_LINE_CHARS / 2);
    let before: String = line.chars().take(start).skip(skipped).collect();
    let is_word = |c: &char| c.is_alphanumeric() || *c == '_';
    let rest = || line.chars().skip(start);
    let length = rest().take(MAX_LINE_CHARS).take_while(is_word).count().max(1);
    let mut word: String = rest().take(length).collect();
    if word.is_empty() {
        word.push(' ');
    }
    let after: String = rest().skip(length).take(MAX_LINE_CHARS / 2).collect();
    let cut = if skipped > 0 { "…" } else { "" };
    format!("{cut}{}<mark>{}</mark>{}", Text(before), Text(word), Text(after))
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::Severity;

    use super::*;

    fn message_at(line: usize, column: usize) -> Json {
        Json {
            severity: Severity::Error,
            code: "E0301".to_owned(),
            message: "no <i>".to_owned(),
            file: Some("a".to_owned()),
            line: Some(line),
            column: Some(column),
            end_line: Some(line),
            end_column: Some(column + 1),
            fix: None,
            notes: Vec::new(),
        }
    }

    #[test]
    fn the_word_is_marked_in_its_line_and_text_is_escaped() {
        let text = "one\n<script>\n  é_1 < 2;\nfour\nfive\nsix";
        let page = messages(&[message_at(3, 3)], "a", Some(text));
        let code = page
            .split_once("<code>")
            .unwrap()
            .1
            .split_once("</code>")
            .unwrap()
            .0;
        assert_eq!(
            code.replace("<span class=\"line-number\">", "")
                .replace("</span>", ""),
            "1 one\n2 &lt;script&gt;\n3   <mark>é_1</mark> &lt; 2;\n4 four\n5 five\n"
        );
        assert!(page.contains("no &lt;i&gt;"), "{page}");
    }

    #[test]
    fn invalid_positions_and_long_lines_are_harmless() {
        let shown = |line, column, text| messages(&[message_at(line, column)], "a", Some(text));
        assert!(!shown(9, 1, "one").contains("<code>"));
        assert!(shown(1, 99, "one").contains("<mark> </mark>"));
        let long = "x".repeat(1_000_000);
        assert!(shown(1, 500_000, &long).len() < 1500);
        let many = vec![message_at(1, 1); 60];
        assert!(messages(&many, "b", Some("one")).contains("and 10 more"));
    }
}
