//! Growing selections: from a word over its expressions, brackets and statements to the whole text.

use lsp_types::SelectionRange;
use toyproof_diagnostic::Span;

use crate::snapshot::Snapshot;
use crate::tokens::Tokens;

/// Maximum number of brackets around a byte in which its statement is found, and of selections.
const MAX_NESTING: usize = 200;

/// The selection at a byte of the document, with the larger ones around it.
pub(crate) fn selection_range(snapshot: &Snapshot, byte: u32) -> SelectionRange {
    let tokens = snapshot.tokens();
    let length = snapshot.file().text().len() as u32;
    let byte = byte.min(length);
    let mut ranges = vec![(byte, byte), (0, length)];
    ranges.extend(token_ranges(&tokens, byte));
    ranges.extend(bracket_ranges(&tokens, byte));
    ranges.extend(expression_ranges(snapshot, byte));
    ranges.extend(tokens.declarations());
    ranges.retain(|(start, end)| (*start..=*end).contains(&byte));
    ranges.sort_by_key(|(start, end)| end - start);
    let mut chain: Vec<(u32, u32)> = Vec::new();
    for (start, end) in ranges {
        // Only what contains the one before: half-typed text may have ranges that overlap.
        let contains = chain.last().is_none_or(|&(inner, inner_end)| {
            start <= inner && inner_end <= end && (start, end) != (inner, inner_end)
        });
        if contains && (chain.len() < MAX_NESTING || (start, end) == (0, length)) {
            chain.push((start, end));
        }
    }
    let mut selection: Option<SelectionRange> = None;
    for (start, end) in chain.into_iter().rev() {
        selection = Some(SelectionRange {
            range: snapshot.document_range(start, end),
            parent: selection.map(Box::new),
        });
    }
    selection.unwrap_or_default()
}

/// The word or comment at a byte.
fn token_ranges(tokens: &Tokens<'_>, byte: u32) -> Vec<(u32, u32)> {
    let word = tokens.word_at(byte).or_else(|| tokens.at(byte));
    let word = word.map(|index| (tokens.code()[index].start, tokens.code()[index].end()));
    let comments = tokens.comments().iter();
    let around = comments.filter(|comment| comment.start <= byte && byte <= comment.end());
    word.into_iter()
        .chain(around.map(|comment| (comment.start, comment.end())))
        .collect()
}

/// The insides of the brackets around a byte, with and without them, and the statements in them.
fn bracket_ranges(tokens: &Tokens<'_>, byte: u32) -> Vec<(u32, u32)> {
    let code = tokens.code();
    let mut ranges = Vec::new();
    let mut open = Vec::new();
    let mut blocks = 0;
    for (index, token) in code.iter().enumerate() {
        match token.text {
            "(" | "[" | "{" => open.push(index),
            ")" | "]" | "}" => {
                let Some(start) = open.pop() else { continue };
                let (outer, outer_end) = (code[start].start, token.end());
                if outer <= byte && byte <= outer_end {
                    ranges.push((outer, outer_end));
                    ranges.push((code[start].end(), token.start));
                    if code[start].is("{") && blocks < MAX_NESTING {
                        blocks += 1;
                        ranges.extend(statement(tokens, (start + 1, index), byte));
                    }
                }
            }
            _ => {}
        }
    }
    ranges
}

/// The statement at a byte among the tokens of a block: up to the next `;` or `}` that ends it.
fn statement(tokens: &Tokens<'_>, (from, to): (usize, usize), byte: u32) -> Option<(u32, u32)> {
    let code = tokens.code();
    let mut start = from;
    let mut depth = 0_usize;
    for index in from..to {
        match code[index].text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 && matches!(code[index].text, ";" | "}") {
            if code[start].start <= byte && byte <= code[index].end() {
                return Some((code[start].start, code[index].end()));
            }
            start = index + 1;
        }
    }
    None
}

/// The expressions around a byte.
fn expression_ranges(snapshot: &Snapshot, byte: u32) -> Vec<(u32, u32)> {
    let Some(at) = snapshot.analyzed_byte(byte) else {
        return Vec::new();
    };
    let contains = |span: Span| span.start <= at && at <= span.end;
    let exprs = snapshot.tree().exprs.iter();
    let around = exprs.filter(|(_, expr)| contains(expr.at.span));
    around
        .filter_map(|(_, expr)| snapshot.in_document(expr.at.span))
        .map(|span| (span.start, span.end))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::marked;

    fn selections(text: &str) -> Vec<String> {
        let (snapshot, at) = marked(text);
        let mut next = Some(selection_range(&snapshot, at));
        let mut found = Vec::new();
        while let Some(selection) = next {
            let start = snapshot.encoding.byte(snapshot.file(), selection.range.start) as usize;
            let end = snapshot.encoding.byte(snapshot.file(), selection.range.end) as usize;
            found.push(snapshot.file().text()[start..end].to_owned());
            next = selection.parent.map(|parent| *parent);
        }
        found
    }

    #[test]
    fn selections_grow_over_expressions_and_statements() {
        let text = "// 😀\r\nfloat f(float x) { x += 1.; return sin(x| + 2.) * 3.; }\r\nint a;";
        let expected = [
            "",
            "x",
            "x + 2.",
            "(x + 2.)",
            "sin(x + 2.)",
            "sin(x + 2.) * 3.",
            "return sin(x + 2.) * 3.;",
            " x += 1.; return sin(x + 2.) * 3.; ",
            "{ x += 1.; return sin(x + 2.) * 3.; }",
            "float f(float x) { x += 1.; return sin(x + 2.) * 3.; }",
            &text.replace('|', ""),
        ];
        assert_eq!(selections(text), expected);
    }

    #[test]
    fn half_typed_text_has_nested_selections() {
        for text in ["f(a, (b|", "void f() { if (a|) ", "|", "/* a| ", "}|{ ) a"] {
            let found = selections(text);
            assert!(
                found.windows(2).all(|pair| pair[1].contains(&pair[0])),
                "{found:?}"
            );
        }
    }
}
