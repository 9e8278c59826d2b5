//! The author's comments: those that stand directly above what is printed.

use std::collections::HashSet;

use super::super::tree::Place;
use crate::source::{FileId, Files, Span};

/// What is known of comments.
pub(super) struct Comments<'a> {
    files: &'a Files,
    /// Lines, by the byte that they begin at, that were printed.
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
        let file = at.span.file;
        let text = self.files.get(file).text();
        let Some(before) = text.get(..at.span.start as usize) else {
            return Vec::new();
        };
        let start = before.rfind('\n').map_or(0, |end| end + 1);
        let mut lines = Vec::new();
        let mut end = start;
        let mut in_block = false;
        while end > 0 {
            let begin = text[..end - 1].rfind('\n').map_or(0, |end| end + 1);
            let line = text[begin..end].trim();
            let opens = line.starts_with("/*");
            let closes = line.ends_with("*/");
            let is_comment =
                in_block || line.starts_with("//") || (opens && closes) || (closes && !line.contains("/*"));
            if !is_comment || !self.told.insert((file, begin)) {
                break;
            }
            in_block = (in_block || closes) && !opens;
            lines.push(line);
            end = begin;
        }
        if in_block {
            // What looked like a comment's end was none.
            return Vec::new();
        }
        lines.iter().rev().filter_map(|line| words(line)).collect()
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
    if line.starts_with("//") {
        return Some(line.to_owned());
    }
    let line = line.strip_prefix("/*").unwrap_or(line);
    let line = line.strip_suffix("*/").unwrap_or(line);
    let line = line.trim_matches(|c: char| c == '*' || c.is_whitespace());
    (!line.is_empty()).then(|| format!("// {line}"))
}

impl<'a> Comments<'a> {
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
