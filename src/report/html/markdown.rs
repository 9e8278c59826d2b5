//! The subset of Markdown of the explanations: paragraphs, fenced and indented code, lists, tables as text,
//! inline code and strong emphasis. All text is escaped.

use std::fmt::Write as _;

use super::Text;

/// Converts Markdown to HTML.
pub(super) fn html(text: &str) -> String {
    let mut blocks = Blocks::default();
    let mut fence: Option<Vec<&str>> = None;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            if let Some(lines) = fence.take() {
                blocks.html += &code(&lines.join("\n"));
            } else {
                blocks.end();
                fence = Some(Vec::new());
            }
        } else if let Some(lines) = &mut fence {
            lines.push(line);
        } else {
            blocks.add(line);
        }
    }
    blocks.end();
    if let Some(lines) = fence {
        blocks.html += &code(&lines.join("\n"));
    }
    blocks.html
}

/// The kind of the block that a line belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Paragraph,
    List,
    /// Indented code, or a table.
    Preformatted,
}

/// The blocks so far, and the one that has not ended.
#[derive(Default)]
struct Blocks<'a> {
    html: String,
    open: Option<(Kind, Vec<&'a str>)>,
}

impl<'a> Blocks<'a> {
    fn add(&mut self, line: &'a str) {
        if line.trim().is_empty() {
            return self.end();
        }
        let item = line.strip_prefix("- ").or_else(|| line.strip_prefix("* "));
        let open = self.open.as_ref().map(|(kind, _)| *kind);
        let kind = match (open, item) {
            (_, Some(_)) => Kind::List,
            // Lines that continue an item or a paragraph may be indented.
            (Some(kind @ (Kind::List | Kind::Paragraph)), None) if !line.starts_with('|') => kind,
            _ if line.starts_with('|') || line.starts_with("    ") => Kind::Preformatted,
            _ => Kind::Paragraph,
        };
        if open != Some(kind) {
            self.end();
        }
        let (_, lines) = self.open.get_or_insert((kind, Vec::new()));
        lines.push(line);
    }

    fn end(&mut self) {
        let block = match self.open.take() {
            None => String::new(),
            Some((Kind::Paragraph, lines)) => format!("<p>{}</p>\n", inline(&lines.join("\n"))),
            Some((Kind::Preformatted, lines)) => code(&lines.join("\n")),
            Some((Kind::List, lines)) => {
                let text = format!("\n{}", lines.join("\n")).replace("\n* ", "\n- ");
                let items = text.split("\n- ").skip(1);
                let items = items.map(|item| format!("<li>{}</li>\n", inline(item)));
                let items = items.collect::<Vec<_>>().concat();
                format!("<ul>\n{items}</ul>\n")
            }
        };
        self.html.push_str(&block);
    }
}

fn code(text: &str) -> String {
    format!("<pre tabindex=\"0\"><code>{}</code></pre>\n", Text(text))
}

/// Converts inline code, strong emphasis and links; only the text of a link remains.
fn inline(text: &str) -> String {
    let mut html = String::new();
    for (index, part) in text.split('`').enumerate() {
        if index % 2 == 1 {
            let _ = write!(html, "<code>{}</code>", Text(part));
        } else {
            html += &strong(&Text(without_links(part)).to_string());
        }
    }
    html
}

fn strong(text: &str) -> String {
    let mut parts = text.split("**");
    let mut html = parts.next().unwrap_or_default().to_owned();
    for (index, part) in parts.enumerate() {
        html += if index % 2 == 0 { "<strong>" } else { "</strong>" };
        html += part;
    }
    html
}

/// Replaces `[text](address)` by its text: the page must not refer to other files.
fn without_links(text: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("](")
        && let Some((start, label)) = before.rsplit_once('[')
        && let Some((_, end)) = after.split_once(')')
    {
        kept += start;
        kept += label;
        rest = end;
    }
    kept + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_inline_markup_are_converted_and_escaped() {
        assert_eq!(
            html(
                "Use `a < b`,\n**not** <b>.\n\nWrong:\n\n```glsl\nx <\n\ny\n```\n- one\n  more\n- [two](x.md)\n\n| a |\n|---|\n"
            ),
            "<p>Use <code>a &lt; b</code>,\n<strong>not</strong> &lt;b&gt;.</p>\n<p>Wrong:</p>\n\
             <pre tabindex=\"0\"><code>x &lt;\n\ny</code></pre>\n<ul>\n<li>one\n  more</li>\n<li>two</li>\n</ul>\n\
             <pre tabindex=\"0\"><code>| a |\n|---|</code></pre>\n"
        );
        assert_eq!(
            html("```\nunclosed"),
            "<pre tabindex=\"0\"><code>unclosed</code></pre>\n"
        );
    }

    #[test]
    fn all_explanations_have_balanced_markup() {
        for explanation in crate::explanations() {
            let html = html(&explanation.text);
            for tag in ["p", "ul", "li", "pre", "code", "strong"] {
                let [starts, ends] =
                    [format!("<{tag}"), format!("</{tag}>")].map(|tag| html.matches(&tag).count());
                let starts = starts
                    - if tag == "p" {
                        html.matches("<pre").count()
                    } else {
                        0
                    };
                assert_eq!(starts, ends, "{tag} in {}: {html}", explanation.code);
            }
        }
    }
}
