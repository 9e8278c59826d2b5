//! Comments of GLSL as `//` lines.

/// The lines of a comment as `//` comments, without the delimiters of a block. Of lines that do not begin with
/// `*`, the common indentation is left out.
pub(super) fn comment_lines(comment: &str) -> Vec<String> {
    let Some(block) = comment.strip_prefix("/*") else {
        return comment.lines().map(line_comment).collect();
    };
    let block = block.strip_suffix("*/").unwrap_or(block);
    let is_frame = |c: char| c == '*' || c.is_whitespace();
    let inner = || block.lines().skip(1).filter(|line| !line.trim().is_empty());
    let is_starred = inner().all(|line| line.trim_start().starts_with('*'));
    let indent_of = |line: &str| line.len() - line.trim_start().len();
    let text_of = |line: &&str| !line.trim_matches(is_frame).is_empty();
    let indent = inner().filter(text_of).map(indent_of).min().unwrap_or(0);
    let count = block.lines().count();
    let mut lines = Vec::new();
    for (number, line) in block.lines().enumerate() {
        let line = if number == 0 || is_starred {
            line.trim_start_matches(is_frame)
        } else {
            line.get(indent..).unwrap_or_default()
        };
        let line = if number + 1 == count || is_starred {
            line.trim_end_matches(is_frame)
        } else {
            line.trim_end()
        };
        lines.push(if line.is_empty() {
            String::new()
        } else {
            line_comment(&format!("// {line}"))
        });
    }
    trim_blank_lines(&mut lines);
    for line in lines.iter_mut().filter(|line| line.is_empty()) {
        line.push_str("//");
    }
    lines
}

/// Removes the first and last lines if they are empty.
pub(super) fn trim_blank_lines(lines: &mut Vec<String>) {
    let end = lines
        .iter()
        .rposition(|line| !line.is_empty())
        .map_or(0, |last| last + 1);
    lines.truncate(end);
    let begin = lines.iter().position(|line| !line.is_empty()).unwrap_or(0);
    lines.drain(..begin);
}

/// Whether a text consists of block comments, and is not empty.
pub(super) fn is_block_comment(text: &str) -> bool {
    let mut rest = text;
    while let Some(inside) = rest.strip_prefix("/*") {
        let Some((_, after)) = inside.split_once("*/") else {
            return false;
        };
        rest = after.trim_start();
    }
    rest.is_empty() && !text.is_empty()
}

/// A line of a comment that begins with `//`, or that one with a `\\` at its end continues.
fn line_comment(line: &str) -> String {
    // WGSL's line breaks (§3.1) would end the comment.
    let line = line.replace(
        |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'),
        " ",
    );
    // Preprocessors of C join a line that ends in a backslash with the next one, which is code.
    let line = line.trim_end_matches(|c: char| c == '\\' || c.is_whitespace());
    if line.starts_with("//") {
        line.to_owned()
    } else {
        format!("// {}", line.trim_start())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_become_lines() {
        for (comment, lines) in [
            ("//a", &["//a"][..]),
            ("// a \\\n  b", &["// a", "// b"]),
            ("/* a */", &["// a"]),
            ("/**/", &[]),
            ("/*/\na */", &["// /", "// a"]),
            ("/* a\n * b\n *\n * c */", &["// a", "// b", "//", "// c"]),
            ("/****\n * a\n ****/", &["// a"]),
            (
                "/*\n    x = a *\n\n        y;\n**/",
                &["// x = a *", "//", "//     y;"],
            ),
            ("/* a\u{2028}b */", &["// a b"]),
        ] {
            assert_eq!(comment_lines(comment), lines, "{comment}");
        }
    }
}
