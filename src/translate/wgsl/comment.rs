//! The author's comments and blank lines: comments directly above a place, and comments at the end of its
//! line.

use std::collections::HashSet;

use toyproof_diagnostic::{FileId, Files, Span};
use toyproof_glsl::tree::{Place, Swizzle};

/// Finds the author's comments and tracks which are printed.
pub(super) struct Comments<'a> {
    files: &'a Files,
    /// Printed comment and blank lines, by the byte where they begin.
    printed: HashSet<(FileId, usize)>,
}

impl<'a> Comments<'a> {
    pub(super) fn new(files: &'a Files) -> Self {
        Self {
            files,
            printed: HashSet::new(),
        }
    }

    /// Returns the comment lines directly above a place's line as `//` lines, each only once.
    pub(super) fn above(&mut self, at: Place) -> Vec<String> {
        let (lines, _) = self.lines_above(at);
        let fresh = lines
            .into_iter()
            .take_while(|&(begin, _)| self.printed.insert((at.span.file, begin)));
        let mut lines: Vec<String> = fresh.filter_map(|(_, line)| line_comment(line)).collect();
        lines.reverse();
        lines
    }

    /// Whether a blank line is above a place, or above the comment there; reported only once.
    pub(super) fn follows_blank_line(&mut self, at: Place) -> bool {
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
        let mut in_block = false;
        while end > 0 {
            let begin = text[..end - 1].rfind('\n').map_or(0, |end| end + 1);
            let line = text[begin..end].trim();
            let opens = line.starts_with("/*");
            let closes = line.ends_with("*/") && (opens || !line.contains("/*"));
            if !(in_block || closes || line.starts_with("//")) {
                return (lines, line.is_empty().then_some(begin));
            }
            in_block = (in_block || closes) && !opens;
            lines.push((begin, line));
            end = begin;
        }
        if in_block {
            // The apparent end of a comment was not one.
            lines.clear();
        }
        (lines, None)
    }

    /// Returns the comment that ends a place's line, if only `;` or `,` comes between; only once.
    pub(super) fn trailing(&mut self, at: Place) -> Option<String> {
        let file = at.span.file;
        let text = self.files.get(file).text();
        let rest = text.get(at.span.end as usize..)?.lines().next()?.trim();
        let rest = rest.trim_start_matches([';', ',', ' ', '\t']);
        let is_comment =
            rest.starts_with("//") || (rest.starts_with("/*") && rest.find("*/") == Some(rest.len() - 2));
        (is_comment && self.printed.insert((file, at.span.end as usize)))
            .then(|| line_comment(rest))
            .flatten()
    }

    /// Returns the comment that the file of a place begins with.
    pub(super) fn first(&mut self, at: Place) -> Vec<String> {
        let file = at.span.file;
        let text = self.files.get(file).text();
        let mut lines = Vec::new();
        let mut in_block = false;
        let mut begin = 0;
        for whole in text.split_inclusive('\n') {
            let line = whole.trim();
            let opens = line.starts_with("/*");
            if !(in_block || opens || line.starts_with("//")) {
                break;
            }
            if opens || in_block {
                match line.find("*/") {
                    Some(end) if end + 2 == line.len() => in_block = false,
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

/// Converts a line of a comment to a WGSL comment; `None` if it only has the delimiters of a block.
fn line_comment(line: &str) -> Option<String> {
    // WGSL's line breaks (§3.1) would end the comment.
    let line = line.replace(
        |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'),
        " ",
    );
    if line.starts_with("//") {
        return Some(line);
    }
    let line = line.as_str();
    let line = line.strip_prefix("/*").unwrap_or(line);
    let line = line.strip_suffix("*/").unwrap_or(line);
    let line = line.trim_matches(|c: char| c == '*' || c.is_whitespace());
    (!line.is_empty()).then(|| format!("// {line}"))
}

impl<'a> Comments<'a> {
    /// The letters of a swizzle: `rgba` where the author wrote these, `xyzw` otherwise.
    pub(super) fn letters(&self, components: Swizzle, at: Place) -> String {
        let color: String = components
            .components()
            .iter()
            .map(|&c| char::from(b"rgba"[usize::from(c)]))
            .collect();
        let written = self.text(at.spelling).and_then(|text| text.rsplit('.').next());
        if written.is_some_and(|written| written.trim() == color) {
            color
        } else {
            components.name()
        }
    }

    /// The source text of a span.
    pub(super) fn text(&self, span: Span) -> Option<&'a str> {
        self.files
            .get(span.file)
            .text()
            .get(span.start as usize..span.end as usize)
    }

    /// Whether a place is the entire replacement text of `#define NAME`.
    pub(super) fn is_whole_macro(&self, name: &str, at: Place) -> bool {
        let text = self.files.get(at.spelling.file).text();
        let (Some(before), Some(after)) = (
            text.get(..at.spelling.start as usize),
            text.get(at.spelling.end as usize..),
        ) else {
            return false;
        };
        let before = before.rsplit('\n').next().unwrap_or_default();
        let after = after.lines().next().unwrap_or_default().trim();
        let mut words = before.split_whitespace();
        let directive = words.next().unwrap_or_default();
        let named = match directive {
            "#define" => words.next(),
            "#" => words
                .next()
                .filter(|&word| word == "define")
                .and_then(|_| words.next()),
            _ => None,
        };
        named == Some(name) && words.next().is_none() && (after.is_empty() || after.starts_with("//"))
    }
}
