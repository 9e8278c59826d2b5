//! What was said of a shader, in its lines.

use toyproof_diagnostic::Json;

use super::text::Text;

/// How many messages a page has of one shader.
const SHOWN: usize = 50;
/// How many lines there are before and after the one that is spoken of.
const AROUND: usize = 2;
/// How many characters of a line are shown.
const WIDTH: usize = 200;

/// The messages, those about `file` in the lines of its text.
pub(super) fn messages(told: &[Json], file: &str, source: Option<&str>) -> String {
    if told.is_empty() {
        return String::new();
    }
    let lines: Vec<_> = source.map_or_else(Vec::new, |text| text.lines().collect());
    let shown: Vec<_> = told
        .iter()
        .take(SHOWN)
        .map(|one| format!("<li>{}</li>\n", message(one, file, &lines)))
        .collect();
    let shown = shown.concat();
    let more = match told.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!("<p>and {more} more</p>\n"),
    };
    format!("<h3>Messages</h3>\n<ol class=\"messages\">\n{shown}</ol>\n{more}")
}

fn message(told: &Json, file: &str, lines: &[&str]) -> String {
    let Json { severity, code, .. } = told;
    let mut place = String::new();
    let mut code_lines = String::new();
    if let (Some(own), Some(line), Some(column)) = (&told.file, told.line, told.column) {
        place = format!(" <span class=\"place\">{}:{line}:{column}</span>", Text(own));
        if own == file && (1..=lines.len()).contains(&line) {
            let excerpt = excerpt(lines, line, column);
            code_lines =
                format!("<pre tabindex=\"0\" aria-label=\"line {line}\"><code>{excerpt}</code></pre>");
        }
    }
    let notes = told
        .notes
        .iter()
        .map(|note| format!("<p class=\"note\">{}</p>", Text(note)));
    format!(
        "<p><strong class=\"{severity}\">{severity} {}</strong> {}{place}</p>{code_lines}{}",
        Text(code),
        Text(&told.message),
        notes.collect::<String>()
    )
}

/// The lines around a place, each with its number; what is spoken of is marked.
fn excerpt(lines: &[&str], line: usize, column: usize) -> String {
    let first = line.saturating_sub(AROUND).max(1);
    let last = (line + AROUND).min(lines.len());
    let digits = last.to_string().len();
    let shown = (first..=last).map(|number| {
        let text = lines[number - 1];
        let text = if number == line {
            marked(text, column)
        } else {
            Text(text.chars().take(WIDTH).collect::<String>()).to_string()
        };
        format!("<span class=\"line-number\">{number:digits$} </span>{text}\n")
    });
    shown.collect()
}

/// A line with the word that begins in that column marked; of a long line, what is around it.
fn marked(line: &str, column: usize) -> String {
    let start = column.saturating_sub(1);
    let skipped = start.saturating_sub(WIDTH / 2);
    let before: String = line.chars().take(start).skip(skipped).collect();
    let is_word = |c: &char| c.is_alphanumeric() || *c == '_';
    let rest = || line.chars().skip(start);
    let length = rest().take(WIDTH).take_while(is_word).count().max(1);
    let mut word: String = rest().take(length).collect();
    if word.is_empty() {
        word.push(' ');
    }
    let after: String = rest().skip(length).take(WIDTH / 2).collect();
    let cut = if skipped > 0 { "…" } else { "" };
    format!("{cut}{}<mark>{}</mark>{}", Text(before), Text(word), Text(after))
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::Severity;

    use super::*;

    fn told(line: usize, column: usize) -> Json {
        Json {
            severity: Severity::Error,
            code: "E0301".to_owned(),
            message: "no <i>".to_owned(),
            file: Some("a".to_owned()),
            line: Some(line),
            column: Some(column),
            notes: Vec::new(),
        }
    }

    #[test]
    fn the_word_is_marked_in_its_line_and_nothing_is_markup() {
        let text = "one\n<script>\n  é_1 < 2;\nfour\nfive\nsix";
        let page = messages(&[told(3, 3)], "a", Some(text));
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
    fn places_that_are_not_in_the_text_and_long_lines_do_no_harm() {
        let shown = |line, column, text| messages(&[told(line, column)], "a", Some(text));
        assert!(!shown(9, 1, "one").contains("<code>"));
        assert!(shown(1, 99, "one").contains("<mark> </mark>"));
        let long = "x".repeat(1_000_000);
        assert!(shown(1, 500_000, &long).len() < 1500);
        let many = vec![told(1, 1); 60];
        assert!(messages(&many, "b", Some("one")).contains("and 10 more"));
    }
}
