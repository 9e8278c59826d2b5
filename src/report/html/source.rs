//! The source of a shader with line numbers: the lines of messages and of the fix are marked, each with its
//! messages below it, and lines far from them are folded.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use toyproof_diagnostic::{Json, grouped, plural};

use super::glossary::Glossary;
use super::{Text, sentence};
use crate::{Record, SourceRange};

/// The maximum number of messages that are shown for one shader: the first ones cause most of the others.
const MAX_MESSAGES: usize = 50;
/// The number of context lines before and after a marked one.
const CONTEXT_LINES: usize = 3;
/// The number of lines from which a part is folded.
const MIN_FOLDED: usize = 4;
/// The number of lines up to which a source without marks is shown at once.
const MAX_UNFOLDED: usize = 24;
/// The maximum number of characters shown of a marked line.
const MAX_LINE_CHARS: usize = 200;

/// The maximum size of all sources of a page, in bytes.
const MAX_SOURCE_BYTES: usize = 2_000_000;

/// The size up to which the page has the whole source of a shader; of a longer one it has only the lines
/// around the marked ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct SourceLimit(usize);

impl SourceLimit {
    /// The limit for a page with these sources.
    pub(super) fn new<'a>(sources: impl IntoIterator<Item = &'a str>) -> Self {
        // Escaping makes most characters of a shader no longer.
        let sizes: Vec<_> = sources.into_iter().map(str::len).collect();
        if sizes.iter().sum::<usize>() <= MAX_SOURCE_BYTES {
            Self(usize::MAX)
        } else {
            Self(MAX_SOURCE_BYTES / sizes.len())
        }
    }
}

/// The marks of a line: the column and the length of the first, and the messages.
struct LineMark {
    column: usize,
    /// In characters; `None` for the word that starts in the column.
    length: Option<usize>,
    /// The class of the line: a severity, or what else is reported there.
    class: String,
    messages: Vec<String>,
}

impl LineMark {
    fn new(column: usize, length: Option<usize>, class: impl Into<String>) -> Self {
        Self {
            column,
            length,
            class: class.into(),
            messages: Vec::new(),
        }
    }
}

/// The marked lines of a shader, by their numbers.
type Marks = BTreeMap<usize, LineMark>;

/// Formats the source of a shader, and its messages.
pub(super) fn source(
    record: &Record,
    source: Option<&str>,
    limit: SourceLimit,
    glossary: &Glossary,
) -> String {
    let lines: Vec<_> = source.map_or_else(Vec::new, |text| text.lines().collect());
    let mut marks = Marks::new();
    let mut others = Vec::new();
    for diagnostic in record.diagnostics.iter().take(MAX_MESSAGES) {
        match diagnostic.line.zip(diagnostic.column) {
            Some((line, column))
                if diagnostic.file.as_ref() == Some(&record.shader) && (1..=lines.len()).contains(&line) =>
            {
                let marked = marks
                    .entry(line)
                    .or_insert_with(|| LineMark::new(column, None, diagnostic.severity.to_string()));
                marked
                    .messages
                    .push(message(diagnostic, &format!("{line}:{column}"), glossary));
            }
            at => {
                let place = match (&diagnostic.file, at) {
                    (Some(file), Some((line, column))) => format!("{file}:{line}:{column}"),
                    (file, _) => file.clone().unwrap_or_default(),
                };
                others.push(format!("<li>{}</li>\n", message(diagnostic, &place, glossary)));
            }
        }
    }
    if let Some(cause) = record
        .cause
        .filter(|cause| (1..=lines.len()).contains(&cause.line))
    {
        marks.entry(cause.line).or_insert_with(|| LineMark {
            messages: vec![format!(
                "<div class=\"message cause\"><p><strong>likely cause</strong> <span class=\"place\">{}:{}</span></p></div>",
                cause.line, cause.column
            )],
            ..LineMark::new(cause.column, None, "cause")
        });
    }
    mark_fix(record, lines.len(), &mut marks);
    let mut html = String::new();
    if !others.is_empty() {
        let _ = write!(
            html,
            "<h3>Messages</h3>\n<ul class=\"messages\">\n{}</ul>\n",
            others.concat()
        );
    }
    if !lines.is_empty() {
        let is_whole = source.is_none_or(|text| text.len() <= limit.0);
        let _ = write!(
            html,
            "<h3>Source</h3>\n<div class=\"source\" tabindex=\"0\" role=\"region\" aria-label=\"Source\">\n<div>\n{}</div>\n</div>\n",
            listing(&lines, &marks, is_whole)
        );
    }
    if let more @ 1.. = record.diagnostics.len().saturating_sub(MAX_MESSAGES) {
        let _ = writeln!(
            html,
            "<p>and {} more {}</p>",
            grouped(more as u64),
            plural(more as u64, "message", "messages")
        );
    }
    html
}

/// Marks the lines of the fix, else the suspect lines.
fn mark_fix(record: &Record, line_count: usize, marks: &mut Marks) {
    let mut mark = |range: SourceRange, class: &str, text: String| {
        let SourceRange { line, column, .. } = range;
        if !(1..=line_count).contains(&line) {
            return;
        }
        let length = if range.end_line == line {
            range.end_column.saturating_sub(column)
        } else {
            MAX_LINE_CHARS
        };
        let marked = marks
            .entry(line)
            .or_insert_with(|| LineMark::new(column, Some(length), class));
        marked.messages.push(format!(
            "<div class=\"message {class}\"><p>{text} <span class=\"place\">{line}:{column}</span></p></div>"
        ));
    };
    match &record.fix {
        Some(fix) if fix.file == record.shader => {
            for edit in &fix.edits {
                let text = edit.text.as_deref().unwrap_or("an edit of this line");
                mark(
                    edit.range,
                    "fix",
                    format!("<strong>fix:</strong> {}", sentence(text)),
                );
            }
        }
        Some(_) => {}
        None => {
            for suspect in &record.suspects {
                mark(
                    suspect.range,
                    "suspect",
                    "<strong>suspect line</strong>".to_owned(),
                );
            }
        }
    }
}

fn message(diagnostic: &Json, place: &str, glossary: &Glossary) -> String {
    let Json { severity, code, .. } = diagnostic;
    let notes = diagnostic.notes.iter();
    let notes = notes.map(|note| format!("<p class=\"note\">{}</p>", sentence(note)));
    let notes = notes.collect::<Vec<_>>().concat();
    format!(
        "<div class=\"message {severity}\"><p><strong>{severity} {}:</strong> {} <span class=\"place\">{}</span></p>{notes}</div>",
        glossary.link(code),
        sentence(&diagnostic.message),
        Text(place)
    )
}

/// Formats all lines: marked ones with their messages, those around them, and the others folded.
fn listing(lines: &[&str], marks: &Marks, is_whole: bool) -> String {
    let mut html = String::new();
    // The first line that is not formatted yet.
    let mut next = 1;
    for (&line, marked) in marks {
        let from = line.saturating_sub(CONTEXT_LINES).max(next);
        html += &unmarked(lines, next, from, is_whole);
        html += &plain_lines(lines, from, line);
        let _ = write!(
            html,
            "<pre class=\"marked {class}\"><code><span class=\"line\" data-line=\"{line}\">{}</span></code></pre>\n{}\n",
            mark_text(lines[line - 1], marked.column, marked.length),
            marked.messages.concat(),
            class = marked.class,
        );
        let following = marks
            .range(line + 1..)
            .next()
            .map_or(lines.len() + 1, |(&line, _)| line);
        next = (line + 1 + CONTEXT_LINES).min(following).min(lines.len() + 1);
        html += &plain_lines(lines, line + 1, next);
    }
    html + &unmarked(lines, next, lines.len() + 1, is_whole)
}

/// Formats the lines from `start` up to `end`, exclusive, which are far from marked ones.
fn unmarked(lines: &[&str], start: usize, end: usize, is_whole: bool) -> String {
    let count = end - start;
    if count < MIN_FOLDED && is_whole {
        return plain_lines(lines, start, end);
    }
    let title = match count {
        1 => format!("Line {start}"),
        _ => format!("Lines {start}–{}", end - 1),
    };
    if !is_whole {
        return match count {
            0 => String::new(),
            _ => format!("<p class=\"fold\">{title} are left out to keep this page small</p>\n"),
        };
    }
    let open = if count == lines.len() && count <= MAX_UNFOLDED {
        " open"
    } else {
        ""
    };
    format!(
        "<details{open}><summary class=\"fold\">{title}</summary>\n{}</details>\n",
        plain_lines(lines, start, end)
    )
}

/// Formats lines, which the script numbers: markup for each line would make the page twice as large.
fn plain_lines(lines: &[&str], start: usize, end: usize) -> String {
    if start == end {
        return String::new();
    }
    let text = lines[start - 1..end - 1].join("\n");
    // The parser of HTML drops a line feed at the start.
    format!("<pre data-first=\"{start}\"><code>{}</code></pre>\n", Text(text))
}

/// Marks the text that starts in a column: the given number of characters, else a word. A long line is cut
/// around it.
fn mark_text(line: &str, column: usize, length: Option<usize>) -> String {
    let start = column.saturating_sub(1);
    let skipped = start.saturating_sub(MAX_LINE_CHARS / 2);
    let before: String = line.chars().take(start).skip(skipped).collect();
    let is_word = |c: &char| c.is_alphanumeric() || *c == '_';
    let rest = || line.chars().skip(start);
    let word_length = || rest().take(MAX_LINE_CHARS).take_while(is_word).count();
    let length = length.unwrap_or_else(word_length).clamp(1, MAX_LINE_CHARS);
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
    use toyproof_verify::Verdict;

    use super::*;
    use crate::Position;
    use crate::record::samples::record;
    use crate::repair::samples::{SOURCE, repaired, suspected};

    fn message_at(line: usize, column: usize) -> Json {
        Json {
            severity: Severity::Error,
            code: "E0301".to_owned(),
            message: "no <i>".to_owned(),
            file: Some("invalid".to_owned()),
            line: Some(line),
            column: Some(column),
            end_line: Some(line),
            end_column: Some(column + 1),
            fix: None,
            notes: Vec::new(),
        }
    }

    fn html(diagnostics: Vec<Json>, text: &str) -> String {
        let mut record = record(Verdict::Invalid);
        record.diagnostics = diagnostics;
        source(&record, Some(text), SourceLimit::new([text]), &Glossary::new(&[]))
    }

    /// The text of the page without markup.
    fn text(html: &str) -> String {
        let mut parts = html.split('<');
        let mut text = parts.next().unwrap_or_default().to_owned();
        text.extend(parts.filter_map(|part| Some(part.split_once('>')?.1)));
        text
    }

    #[test]
    fn the_word_is_marked_in_its_line_and_text_is_escaped() {
        let html = html(
            vec![message_at(3, 3)],
            "one\n<script>\n  é_1 < 2;\nfour\nfive\nsix",
        );
        assert!(
            html.contains("data-line=\"3\">  <mark>é_1</mark> &lt; 2;</span>"),
            "{html}"
        );
        assert!(html.contains("no &lt;i&gt;"), "{html}");
        let positions =
            ["&lt;script&gt;", "é_1", "error E0301:", "four\nfive\nsix"].map(|part| text(&html).find(part));
        assert!(positions.is_sorted() && positions[0].is_some(), "{html}");
        assert!(!html.contains("<details"), "{html}");
    }

    #[test]
    fn lines_far_from_marks_are_folded_and_none_is_lost() {
        let lines: Vec<_> = (1..=40).map(|line| format!("line{line};")).collect();
        let html = html(
            vec![message_at(20, 1), message_at(22, 1), message_at(22, 5)],
            &lines.join("\n"),
        );
        let folds: Vec<_> = html.split("<summary class=\"fold\">").skip(1).collect();
        let titles: Vec<_> = folds.iter().map(|fold| fold.split('<').next().unwrap()).collect();
        assert_eq!(titles, ["Lines 1–16", "Lines 26–40"]);
        let text = text(&html);
        for line in &lines {
            assert_eq!(text.matches(line).count(), 1, "{line}");
        }
        assert_eq!(html.matches("class=\"message error\"").count(), 3);
    }

    #[test]
    fn the_likely_cause_is_marked() {
        let mut record = record(Verdict::Timeout);
        record.cause = Some(Position { line: 2, column: 1 });
        let html = source(&record, Some("a\nb"), SourceLimit::new([]), &Glossary::new(&[]));
        assert!(
            html.contains("<mark>b</mark>") && html.contains("likely cause"),
            "{html}"
        );
    }

    #[test]
    fn the_fix_or_the_suspect_lines_are_marked_with_their_whole_text() {
        let shown = |record: &Record| source(record, Some(SOURCE), SourceLimit::new([]), &Glossary::new(&[]));
        let fixed = shown(&repaired());
        assert!(
            fixed.contains("<pre class=\"marked fix\"><code><span class=\"line\" data-line=\"2\">    return <mark>b + c</mark>;"),
            "{fixed}"
        );
        assert!(
            fixed.contains(
                "fix:</strong> replace <code>b + c</code> with <code>b - c</code> <span class=\"place\">2:12"
            ),
            "{fixed}"
        );
        assert_eq!(fixed.matches("<mark>").count(), 1);
        let suspected = shown(&suspected());
        assert_eq!(suspected.matches("<pre class=\"marked suspect\">").count(), 2);
        assert_eq!(suspected.matches("suspect line</strong>").count(), 2);
        let mut other_file = repaired();
        other_file.fix.as_mut().unwrap().file = "common.glsl".to_owned();
        assert!(!shown(&other_file).contains("<mark>"));
        let mut outside = repaired();
        outside.fix.as_mut().unwrap().edits[0].range.line = 99;
        assert!(!shown(&outside).contains("<mark>"));
    }

    #[test]
    fn of_sources_that_are_too_large_only_excerpts_are_shown() {
        let text = "float x;\n".repeat(400_000);
        let html = html(vec![message_at(5, 1)], &text);
        assert!(html.len() < 2_000, "{}", html.len());
        assert!(html.contains("Lines 9–400000 are left out"), "{html}");
    }

    #[test]
    fn invalid_positions_and_long_lines_are_harmless() {
        assert!(!html(vec![message_at(9, 1)], "one").contains("<mark>"));
        assert!(html(vec![message_at(1, 99)], "one").contains("<mark> </mark>"));
        let long = "x".repeat(1_000_000);
        assert!(html(vec![message_at(1, 500_000)], &long).len() < 1500);
        let many = html(vec![message_at(1, 1); 60], "one");
        assert!(many.contains("and 10 more messages"));
    }
}
