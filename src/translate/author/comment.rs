//! The author's comments and blank lines: comments directly above a place, and comments at the end of its
//! line.

use std::collections::HashSet;

use toyproof_diagnostic::{FileId, Files};
use toyproof_glsl::tree::Place;

/// Finds the author's comments and tracks which are printed.
pub(crate) struct Comments<'a> {
    files: &'a Files,
    /// What is printed: comment and blank lines by the byte where they begin, comments at the end of a line
    /// by the byte where the code before them ends.
    printed: HashSet<(FileId, usize)>,
}

impl<'a> Comments<'a> {
    pub(crate) fn new(files: &'a Files) -> Self {
        Self {
            files,
            printed: HashSet::new(),
        }
    }

    /// Returns the comment lines directly above a place's line as `//` lines, each only once.
    pub(crate) fn above(&mut self, at: Place) -> Vec<String> {
        let (lines, _) = self.lines_above(at);
        let fresh = lines
            .into_iter()
            .take_while(|&(begin, _)| self.printed.insert((at.span.file, begin)));
        let mut lines: Vec<String> = fresh.filter_map(|(_, line)| line_comment(line)).collect();
        lines.reverse();
        lines
    }

    /// Whether a blank line is above a place, or above the comment there; reported only once.
    pub(crate) fn follows_blank_line(&mut self, at: Place) -> bool {
        let (_, blank) = self.lines_above(at);
        blank.is_some_and(|begin| self.printed.insert((at.span.file, begin)))
    }

    /// Returns the comment lines directly above a place's line, nearest first, with the bytes where they
    /// begin; and where the line above them begins, if it is blank.
    fn lines_above(&self, at: Place) -> (Vec<(usize, &'a str)>, Option<usize>) {
        let text = self.files.get(at.span.file).text();
        let before = text.get(..at.span.start as usize).unwrap_or_default();
        let mut end = before.rfind('\n').map_or(0, |end| end + 1);
        let mut lines = Vec::new();
        // The number of lines below the block comment that is being read, whose end is the first line read.
        let mut block: Option<usize> = None;
        while end > 0 {
            let begin = text[..end - 1].rfind('\n').map_or(0, |end| end + 1);
            let line = text[begin..end].trim();
            if let Some(below) = block {
                let opened = line.strip_prefix("/*");
                if opened.unwrap_or(line).contains("*/") || opened.is_none() && line.contains("/*") {
                    // The block begins after code, or its apparent end is not one.
                    lines.truncate(below);
                    return (lines, None);
                }
                if opened.is_some() {
                    block = None;
                }
            } else if line.ends_with("*/") && !line.contains("/*") {
                block = Some(lines.len());
            } else if !line.starts_with("//") && !is_block_comment(line) {
                return (lines, line.is_empty().then_some(begin));
            }
            lines.push((begin, line));
            end = begin;
        }
        lines.truncate(block.unwrap_or(lines.len()));
        (lines, None)
    }

    /// Returns the comment that ends a place's line, if only `;` or `,` comes between; only once.
    pub(crate) fn trailing(&mut self, at: Place) -> Option<String> {
        let file = at.span.file;
        let text = self.files.get(file).text();
        let rest = text.get(at.span.end as usize..)?.lines().next()?.trim();
        let rest = rest.trim_start_matches([';', ',', ' ', '\t']);
        let is_comment = rest.starts_with("//") || is_block_comment(rest);
        (is_comment && self.printed.insert((file, at.span.end as usize)))
            .then(|| line_comment(rest))
            .flatten()
    }

    /// Returns the comment that the file of a place begins with.
    pub(crate) fn first(&mut self, at: Place) -> Vec<String> {
        let file = at.span.file;
        let text = self.files.get(file).text();
        let mut lines = Vec::new();
        let mut in_block = false;
        let mut begin = 0;
        for whole in text.split_inclusive('\n') {
            let line = whole.trim();
            let opened = line.strip_prefix("/*").filter(|_| !in_block);
            if !(in_block || opened.is_some() || line.starts_with("//")) {
                break;
            }
            if in_block || opened.is_some() {
                let inside = opened.unwrap_or(line);
                match inside.find("*/") {
                    Some(end) if end + 2 == inside.len() => in_block = false,
                    Some(_) => break,
                    None => in_block = true,
                }
            }
            lines.push((begin, line));
            begin += whole.len();
        }
        if in_block {
            return Vec::new();
        }
        self.printed.extend(lines.iter().map(|&(begin, _)| (file, begin)));
        lines.iter().filter_map(|(_, line)| line_comment(line)).collect()
    }
}

/// Whether a text consists of block comments, and is not empty.
fn is_block_comment(text: &str) -> bool {
    let mut rest = text;
    while let Some(inside) = rest.strip_prefix("/*") {
        let Some((_, after)) = inside.split_once("*/") else {
            return false;
        };
        rest = after.trim_start();
    }
    rest.is_empty() && !text.is_empty()
}

/// Converts a line of a comment to a `//` comment; `None` if it only has the delimiters of a block.
fn line_comment(line: &str) -> Option<String> {
    // WGSL's line breaks (§3.1) would end the comment.
    let line = line.replace(
        |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'),
        " ",
    );
    if line.starts_with("//") {
        return Some(without_continuation(&line).to_owned());
    }
    let line = line.as_str();
    let line = line.strip_prefix("/*").unwrap_or(line);
    let line = line.strip_suffix("*/").unwrap_or(line);
    let line = line.trim_matches(|c: char| c == '*' || c.is_whitespace());
    let line = without_continuation(line);
    (!line.is_empty()).then(|| format!("// {line}"))
}

/// The line without backslashes at its end: preprocessors of C join it with the next line, which is code.
fn without_continuation(line: &str) -> &str {
    line.trim_end_matches(|c: char| c == '\\' || c.is_whitespace())
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Span};

    use super::*;

    /// The file of a text, and the place of the last occurrence of some code in it.
    fn placed(text: &str, code: &str) -> (Files, Place) {
        let mut files = Files::default();
        let file = files.add(File::new("shader", text));
        let start = text.rfind(code).unwrap();
        let span = Span::new(file, start as u32, (start + code.len()) as u32);
        (files, Place::plain(span))
    }

    fn above(text: &str) -> Vec<String> {
        let (files, at) = placed(text, "float y");
        Comments::new(&files).above(at)
    }

    fn trailing(text: &str) -> Option<String> {
        let (files, at) = placed(text, "float x");
        Comments::new(&files).trailing(at)
    }

    #[test]
    fn comments_above_are_kept() {
        let text = "float x;\n// a\n/* b\n * c */\n/* d */ /* e */\n  float y;";
        assert_eq!(above(text), ["// a", "// b", "// c", "// d */ /* e"]);
        assert_eq!(above("/*/ a\nb */\nfloat y;"), ["// / a", "// b"]);
    }

    #[test]
    fn code_is_not_a_comment() {
        // A block that begins after code.
        assert!(above("/* a */\nfloat x = 1.; /* b\nc */\nfloat y;").is_empty());
        assert!(above("/* a */ float x = 1.; /* b\nc */\nfloat y;").is_empty());
        assert!(above("float x = 1.; /* b\nc */\nfloat y;").is_empty());
        // Only that block is dropped.
        let text = "/* a */\nfloat x = 1.; /* b\nc */\n// d\nfloat y;";
        assert_eq!(above(text), ["// d"]);
        // `*/` in a line comment.
        assert!(above("/* a\nb */ float x = 1.;\n// c */\nfloat y;").is_empty());
        assert!(above("/* a */ float x = 1.; /* b */\nfloat y;").is_empty());
    }

    #[test]
    fn an_opening_delimiter_does_not_close_a_comment() {
        assert_eq!(trailing("float x; /*/\nfloat z;\n*/ float y;"), None);
        assert_eq!(trailing("float x; /* a */\nfloat y;").as_deref(), Some("// a"));
        let (files, at) = placed("/*/\na */\nfloat y;", "float y");
        assert_eq!(Comments::new(&files).first(at), ["// /", "// a"]);
    }
}
