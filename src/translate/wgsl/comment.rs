//! The author's comments and blank lines: those that stand directly above what is printed, and comments behind it.

use std::collections::HashSet;

use toyproof_diagnostic::{FileId, Files, Span};
use toyproof_glsl::tree::{Place, Swizzle};

/// What is known of comments.
pub(super) struct Comments<'a> {
    files: &'a Files,
    /// Lines, by the byte that they begin at, whose comments were printed, and blank ones that were.
    told: HashSet<(FileId, usize)>,
}

impl<'a> Comments<'a> {
    pub(super) fn new(files: &'a Files) -> Self {
        Self {
            files,
            told: HashSet::new(),
        }
    }

    /// The comment lines directly above the line of a place, as `//` lines; each is given once.
    pub(super) fn above(&mut self, at: Place) -> Vec<String> {
        let (lines, _) = self.lines_above(at);
        let fresh = lines
            .into_iter()
            .take_while(|&(begin, _)| self.told.insert((at.span.file, begin)));
        let mut words: Vec<String> = fresh.filter_map(|(_, line)| words(line)).collect();
        words.reverse();
        words
    }

    /// Whether a blank line stands above a place, or above the comment there; each is given once.
    pub(super) fn is_apart(&mut self, at: Place) -> bool {
        let (_, blank) = self.lines_above(at);
        blank.is_some_and(|begin| self.told.insert((at.span.file, begin)))
    }

    /// The comment lines directly above the line of a place, the nearest first, by the byte that each begins at; and where the line above
    /// them begins, if it is blank.
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
            // What looked like a comment's end was none.
            lines.clear();
        }
        (lines, None)
    }

    /// The comment that ends the line of a place, if nothing but a `;` or `,` stands between; each is given once.
    pub(super) fn behind(&mut self, at: Place) -> Option<String> {
        let file = at.span.file;
        let text = self.files.get(file).text();
        let rest = text.get(at.span.end as usize..)?.lines().next()?.trim();
        let rest = rest.trim_start_matches([';', ',', ' ', '\t']);
        let is_comment =
            rest.starts_with("//") || (rest.starts_with("/*") && rest.find("*/") == Some(rest.len() - 2));
        (is_comment && self.told.insert((file, at.span.end as usize)))
            .then(|| words(rest))
            .flatten()
    }

    /// The comment that the file of a place begins with.
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
        self.told.extend(lines.iter().map(|&(begin, _)| (file, begin)));
        lines.iter().filter_map(|(_, line)| words(line)).collect()
    }
}

/// A line of a comment as one of WGSL; nothing if it held only the marks of a block.
fn words(line: &str) -> Option<String> {
    // What ends a line for WGSL (§3.1) would end the comment.
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
    /// Components by the letters of the author's: those of a colour where the author wrote these.
    pub(super) fn letters(&self, components: Swizzle, at: Place) -> String {
        let colour: String = components
            .components()
            .iter()
            .map(|&c| char::from(b"rgba"[usize::from(c)]))
            .collect();
        let written = self.text(at.spelled).and_then(|text| text.rsplit('.').next());
        if written.is_some_and(|written| written.trim() == colour) {
            colour
        } else {
            components.name()
        }
    }

    /// The author's words there.
    pub(super) fn text(&self, span: Span) -> Option<&'a str> {
        self.files
            .get(span.file)
            .text()
            .get(span.start as usize..span.end as usize)
    }

    /// Whether the spelling of a place is all that `#define NAME` stands for.
    pub(super) fn is_whole_macro(&self, name: &str, at: Place) -> bool {
        let text = self.files.get(at.spelled.file).text();
        let (Some(before), Some(after)) = (
            text.get(..at.spelled.start as usize),
            text.get(at.spelled.end as usize..),
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
