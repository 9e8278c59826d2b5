//! What can be folded: blocks, parentheses over several lines, comments, branches of `#if`, and regions.

use lsp_types::{FoldingRange, FoldingRangeKind};

use crate::snapshot::Snapshot;
use crate::tokens::{Token, TokenKind, Tokens};

/// The ranges of lines that can be folded, in order of their first lines.
pub(crate) fn folding_ranges(snapshot: &Snapshot) -> Vec<FoldingRange> {
    let tokens = snapshot.tokens();
    let line_of = |byte: u32| snapshot.file().line(byte as usize) as u32;
    let mut ranges = Vec::new();
    let mut add = |start: u32, end: u32, kind: Option<FoldingRangeKind>| {
        if start < end {
            ranges.push(FoldingRange {
                start_line: start,
                end_line: end,
                kind,
                ..FoldingRange::default()
            });
        }
    };
    for (open, close) in brackets(&tokens) {
        // The line of the closing bracket stays visible.
        add(line_of(open), line_of(close).saturating_sub(1), None);
    }
    for (start, end) in conditions(&tokens) {
        add(
            line_of(start),
            line_of(end).saturating_sub(1),
            Some(FoldingRangeKind::Region),
        );
    }
    let lines = tokens.comments().iter().map(|comment| CommentLines {
        start: line_of(comment.start),
        end: line_of(comment.end()),
        marker: region_marker(comment.text),
        is_line: comment.text.starts_with("//"),
        is_alone: is_alone(&tokens, comment, line_of),
    });
    let lines: Vec<CommentLines> = lines.collect();
    for (start, end) in comment_blocks(&lines) {
        add(start, end, Some(FoldingRangeKind::Comment));
    }
    for (start, end) in regions(&lines) {
        add(start, end, Some(FoldingRangeKind::Region));
    }
    ranges.sort_by_key(|range| (range.start_line, std::cmp::Reverse(range.end_line)));
    ranges.dedup_by_key(|range| (range.start_line, range.end_line));
    ranges
}

/// The bytes of brackets that belong together. Unbalanced ones have no partner.
fn brackets(tokens: &Tokens<'_>) -> Vec<(u32, u32)> {
    let mut open: Vec<&Token<'_>> = Vec::new();
    let mut open_braces = 0_usize;
    let mut pairs = Vec::new();
    let code = tokens.code().iter();
    for token in code.filter(|token| token.kind == TokenKind::Symbol && !token.is_in_directive) {
        match token.text {
            "(" => open.push(token),
            "{" => {
                open.push(token);
                open_braces += 1;
            }
            ")" if open.last().is_some_and(|last| last.is("(")) => {
                pairs.extend(open.pop().map(|last| (last.start, token.start)));
            }
            "}" if open_braces > 0 => {
                open_braces -= 1;
                while let Some(last) = open.pop() {
                    if last.is("{") {
                        pairs.push((last.start, token.start));
                        break;
                    }
                }
            }
            _ => {}
        }
    }
    pairs
}

/// The bytes of directives between which a branch of `#if` lies.
fn conditions(tokens: &Tokens<'_>) -> Vec<(u32, u32)> {
    let mut open = Vec::new();
    let mut branches = Vec::new();
    for pair in tokens.code().windows(2) {
        let [hash, name] = pair else { continue };
        if !(hash.is("#") && name.is_in_directive && hash.line == name.line) {
            continue;
        }
        match name.text {
            "if" | "ifdef" | "ifndef" => open.push(hash.start),
            "elif" | "else" | "endif" => {
                branches.extend(open.pop().map(|start| (start, hash.start)));
                if name.text != "endif" {
                    open.push(hash.start);
                }
            }
            _ => {}
        }
    }
    branches
}

struct CommentLines {
    start: u32,
    end: u32,
    marker: Option<Marker>,
    is_line: bool,
    is_alone: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Marker {
    Begin,
    End,
}

/// `// #region` and `// #endregion`, as several editors write them.
fn region_marker(comment: &str) -> Option<Marker> {
    let text = comment.strip_prefix("//")?.trim_start().trim_start_matches('#');
    match text.split_whitespace().next()? {
        "region" if comment.contains("#region") => Some(Marker::Begin),
        "endregion" if comment.contains("#endregion") => Some(Marker::End),
        _ => None,
    }
}

/// Whether no code is in front of a comment on its line.
fn is_alone(tokens: &Tokens<'_>, comment: &Token<'_>, line_of: impl Fn(u32) -> u32) -> bool {
    let before = tokens.count_before(comment.start).checked_sub(1);
    before.is_none_or(|index| line_of(tokens.code()[index].start) != line_of(comment.start))
}

/// Comments of several lines, and adjacent comments of one line each.
fn comment_blocks(comments: &[CommentLines]) -> Vec<(u32, u32)> {
    let mut blocks: Vec<(u32, u32, bool)> = Vec::new();
    for comment in comments.iter().filter(|comment| comment.marker.is_none()) {
        let joins = comment.is_line && comment.is_alone;
        match blocks.last_mut() {
            Some((_, end, true)) if joins && *end + 1 == comment.start => *end = comment.end,
            _ => blocks.push((comment.start, comment.end, joins)),
        }
    }
    blocks.into_iter().map(|(start, end, _)| (start, end)).collect()
}

fn regions(comments: &[CommentLines]) -> Vec<(u32, u32)> {
    let mut open = Vec::new();
    let mut found = Vec::new();
    for comment in comments {
        match comment.marker {
            Some(Marker::Begin) => open.push(comment.start),
            Some(Marker::End) => found.extend(open.pop().map(|start| (start, comment.start))),
            None => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::of;

    fn folded(text: &str) -> Vec<(u32, u32)> {
        let ranges = folding_ranges(&of(text)).into_iter();
        ranges.map(|range| (range.start_line, range.end_line)).collect()
    }

    #[test]
    fn blocks_and_comments_fold() {
        let text = "// a 😀\r\n// b\r\nvoid f() {\r\n  if (true) {\r\n\
            \x20   return;\r\n  }\r\n}\r\n/* c\r\nd */\r\nint a; // e\r\n// f";
        assert_eq!(folded(text), [(0, 1), (2, 5), (3, 4), (7, 8)]);
        assert_eq!(folded("vec3 a = vec3(\n  1,\n  2,\n  3\n);"), [(0, 3)]);
    }

    #[test]
    fn branches_and_regions_fold() {
        let text = "#if A\nint a;\n#ifdef B\nint b;\n#endif\n#elif C\nint c;\n#else\nint d;\n#endif";
        assert_eq!(folded(text), [(0, 4), (2, 3), (5, 6), (7, 8)]);
        let text = "// #region noise\nfloat a;\n\n//#region inner\nint b;\n//#endregion\n// #endregion";
        assert_eq!(folded(text), [(0, 6), (3, 5)]);
    }

    #[test]
    fn half_typed_text_folds_where_brackets_match() {
        assert_eq!(folded("void f() {\n  g(\n}\nvoid h() {\n\n"), [(0, 1)]);
        assert_eq!(folded("}\n)\n#endif\n#else\n// #endregion\n/* a\n b"), [(5, 6)]);
    }
}
