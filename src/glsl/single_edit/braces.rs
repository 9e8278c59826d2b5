//! Missing and additional braces. The errors may be far from them, but the indentation shows most of them.

use toyproof_diagnostic::Span;

use super::candidates::Candidates;
use crate::keywords::Keyword;
use crate::source::Source;
use crate::token::Punctuator;

/// Cost of a brace that the indentation does not suggest.
const COST_WITHOUT_EVIDENCE: usize = 10;

/// Maximum number of candidates of one kind.
const MAX_OF_A_KIND: usize = 40;

/// An open block.
struct OpenBlock {
    /// The index of the `{`.
    index: usize,
    /// The indentation of the line of its `{`.
    indent: usize,
}

pub(super) fn collect(candidates: &mut Candidates) {
    if !candidates.is_unbalanced() {
        return;
    }
    let source = candidates.source;
    let braces = (0..source.len()).filter_map(|index| source.punctuator(index));
    let balance: i64 = braces
        .map(|punctuator| match punctuator {
            Punctuator::LeftBrace => 1,
            Punctuator::RightBrace => -1,
            _ => 0,
        })
        .sum();
    if balance > 0 {
        missing_close(candidates);
        additional_open(candidates);
    } else if balance < 0 {
        missing_open(candidates);
        additional_close(candidates);
    }
}

/// Inserts `}` before lines that are indented no deeper than the line of an open `{`.
fn missing_close(candidates: &mut Candidates) {
    let source = candidates.source;
    let mut open: Vec<OpenBlock> = Vec::new();
    let mut count = 0;
    for index in 0..=source.len() {
        let is_else = source.keyword(index) == Some(Keyword::Else)
            && source.is(index.saturating_sub(1), Punctuator::Semicolon);
        if is_else && count < MAX_OF_A_KIND && !open.is_empty() {
            // The `}` of `} else {`, unless the `else` belongs to an `if` without braces.
            candidates.insert_before(2 + 2 * count, index, "} ");
        }
        if index == source.len() || (source.begins_line(index) && is_end_of_statement(candidates, index)) {
            let is_close = source.is(index, Punctuator::RightBrace);
            let indent = source.indent(index);
            while let Some(block) = open.last() {
                let is_left = index == source.len()
                    || if is_close {
                        indent < block.indent
                    } else {
                        indent <= block.indent && block.index + 1 != index
                    };
                if !is_left || count >= MAX_OF_A_KIND {
                    break;
                }
                insert_close(candidates, 1 + 2 * count, index, block);
                count += 1;
                open.pop();
            }
        }
        match source.punctuator(index) {
            Some(Punctuator::LeftBrace) => open.push(OpenBlock {
                index,
                indent: source.indent(index),
            }),
            Some(Punctuator::RightBrace) => {
                open.pop();
            }
            _ => {}
        }
    }
}

/// Whether a statement or a block ends before the first token of a line that is not a label or a
/// directive.
fn is_end_of_statement(candidates: &Candidates, index: usize) -> bool {
    let source = candidates.source;
    let is_label = matches!(source.keyword(index), Some(Keyword::Case | Keyword::Default));
    !is_label && !source.is_in_directive(index) && source.follows_statement(index)
}

/// Adds the insertion of the `}` of a block before a line: on a separate line, unless the block is on one
/// line.
fn insert_close(candidates: &mut Candidates, cost: usize, index: usize, block: &OpenBlock) {
    let source = candidates.source;
    // Before the directives of the lines above.
    let is_code = |before: &usize| !source.is_in_directive(*before);
    let Some(before) = (0..index).rev().find(is_code) else {
        return;
    };
    let end = source.span(before).end as usize;
    let rest = &source.text[end..];
    if source.line(before) == source.line(block.index) {
        return candidates.insert(cost, before + 1, " }");
    }
    // Past a comment at the end of the line.
    let Some(length) = rest.find('\n') else {
        return candidates.insert(cost, before + 1, "\n}");
    };
    let at = (end + length + 1) as u32;
    let line = source.span(block.index).start as usize;
    let line = source.text[..line].rfind('\n').map_or(0, |newline| newline + 1);
    let blanks = source.text[line..]
        .bytes()
        .take_while(|byte| matches!(byte, b' ' | b'\t'));
    let indentation = &source.text[line..line + blanks.count()];
    let text = format!("{indentation}}}\n");
    candidates.add(cost, Span::new(source.file, at, at), &text);
}

/// Removes a `{` that does not follow a head or a statement.
fn additional_open(candidates: &mut Candidates) {
    let source = candidates.source;
    let is_open = |index: &usize| source.is(*index, Punctuator::LeftBrace);
    let mut others = 0;
    for index in (0..source.len()).filter(is_open) {
        let is_repeated =
            index > 0 && source.is(index - 1, Punctuator::LeftBrace) && !source.begins_line(index);
        let cost = if is_repeated {
            0
        } else if index > 0 && is_end_of_head(candidates, index - 1) {
            3 * COST_WITHOUT_EVIDENCE
        } else {
            COST_WITHOUT_EVIDENCE
        };
        others += usize::from(!is_repeated);
        if is_repeated || others <= MAX_OF_A_KIND {
            candidates.remove(cost, index);
        }
    }
}

/// Inserts `{` after heads without one: first the last head with the indentation of an additional `}`.
fn missing_open(candidates: &mut Candidates) {
    let source = candidates.source;
    let mut open: Vec<OpenBlock> = Vec::new();
    let mut heads: Vec<usize> = Vec::new();
    let mut count = 0;
    for index in 0..source.len() {
        match source.punctuator(index) {
            Some(Punctuator::LeftBrace) => open.push(OpenBlock {
                index,
                indent: source.indent(index),
            }),
            Some(Punctuator::RightBrace) => {
                let indent = source.indent(index);
                if !is_additional(source, open.last(), index) {
                    open.pop();
                    continue;
                }
                let is_alike = |head: &&usize| source.indent(**head) == indent;
                if let Some(&head) = heads.iter().rev().find(is_alike) {
                    candidates.insert(3 * count, head + 1, " {");
                    count += 1;
                }
            }
            _ if is_bare_head(candidates, index) => heads.push(index),
            _ => {}
        }
    }
    for head in heads.into_iter().rev().take(MAX_OF_A_KIND) {
        let distance = candidates.distance(head + 1).unwrap_or(2 * COST_WITHOUT_EVIDENCE);
        candidates.insert(COST_WITHOUT_EVIDENCE + distance, head + 1, " {");
    }
}

/// Whether a `}` closes no block, or is indented deeper than the block that it closes.
fn is_additional(source: &Source, block: Option<&OpenBlock>, index: usize) -> bool {
    block.is_none_or(|block| source.begins_line(index) && source.indent(index) > block.indent)
}

/// Removes a `}` whose indentation differs from that of its block.
fn additional_close(candidates: &mut Candidates) {
    let source = candidates.source;
    let mut open: Vec<OpenBlock> = Vec::new();
    let mut count = 0;
    for index in 0..source.len() {
        match source.punctuator(index) {
            Some(Punctuator::LeftBrace) => open.push(OpenBlock {
                index,
                indent: source.indent(index),
            }),
            Some(Punctuator::RightBrace) if count < MAX_OF_A_KIND => {
                let is_additional = is_additional(source, open.last(), index);
                if is_additional {
                    candidates.remove(2 + 3 * count, index);
                    count += 1;
                } else {
                    open.pop();
                    if index > 0 && source.is(index - 1, Punctuator::RightBrace) {
                        candidates.remove(COST_WITHOUT_EVIDENCE + count, index);
                        count += 1;
                    }
                }
            }
            _ => {}
        }
    }
}

/// Whether a block may follow the token, but does not.
fn is_bare_head(candidates: &Candidates, index: usize) -> bool {
    let source = candidates.source;
    let has_body = matches!(
        source.punctuator(index + 1),
        Some(Punctuator::LeftBrace | Punctuator::Semicolon)
    );
    !has_body && !source.is_in_directive(index) && is_end_of_head(candidates, index)
}

/// Whether a block may follow the token: a `)` that ends the head of a statement or of a function, `else`,
/// `do`, or the name of a structure.
fn is_end_of_head(candidates: &Candidates, index: usize) -> bool {
    let source = candidates.source;
    match source.keyword(index) {
        Some(keyword) => matches!(keyword, Keyword::Else | Keyword::Do | Keyword::Struct),
        None if source.is(index, Punctuator::RightParen) => {
            source.begins_line(index + 1) || !source.is(index + 1, Punctuator::Dot)
        }
        None => source.is_name(index) && index > 0 && source.keyword(index - 1) == Some(Keyword::Struct),
    }
}
