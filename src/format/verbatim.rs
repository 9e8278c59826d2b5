//! `// toyproof: no-format` comments.

use crate::piece::{Kind, Piece};

/// Whether a piece is the comment.
fn is_comment(piece: &Piece<'_>) -> bool {
    let control = piece.text.strip_prefix("//").map(str::trim_start);
    let rest = control.and_then(|text| text.strip_prefix("toyproof:"));
    piece.kind == Kind::LineComment
        && rest.is_some_and(|rest| rest.split_whitespace().next() == Some("no-format"))
}

/// Whether the whole text is kept: only comments precede the comment.
pub(crate) fn is_whole(pieces: &[Piece<'_>]) -> bool {
    let first = pieces.iter().take_while(|piece| piece.is_comment());
    first.into_iter().any(is_comment)
}

/// The pieces of a text, with each statement behind such a comment as one.
pub(crate) fn with_kept<'a>(text: &'a str, pieces: Vec<Piece<'a>>) -> Vec<Piece<'a>> {
    if !pieces.iter().any(is_comment) {
        return pieces;
    }
    let mut kept = Vec::with_capacity(pieces.len());
    let mut at = 0;
    while let Some(&piece) = pieces.get(at) {
        kept.push(piece);
        at += 1;
        let mut end = statement_end(&pieces[at..]);
        if !is_comment(&piece) || !piece.begins_line() || end == 0 {
            continue;
        }
        while pieces
            .get(at + end)
            .is_some_and(|next| next.is_comment() && !next.begins_line())
        {
            end += 1;
        }
        let (first, last) = (pieces[at], pieces[at + end - 1]);
        let line = text[..first.start].rfind('\n').map_or(0, |newline| newline + 1);
        kept.push(Piece {
            kind: Kind::Verbatim,
            text: &text[line..last.start + last.text.len()],
            ..first
        });
        at += end;
    }
    kept
}

/// The number of pieces of the statement or declaration at the begin.
fn statement_end(pieces: &[Piece<'_>]) -> usize {
    let mut depth = 0_usize;
    let is_struct = pieces.first().is_some_and(|first| first.is("struct"));
    for (index, piece) in pieces.iter().enumerate() {
        match piece.text {
            _ if !piece.is_token() => continue,
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" if depth == 0 => return index,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        let next = pieces[index + 1..].iter().find(|next| next.is_token());
        let goes_on = |next: &Piece<'_>| matches!(next.text, ";" | "," | "else" | "while") || is_struct;
        if depth == 0 && (piece.text == ";" || piece.text == "}" && !next.is_some_and(goes_on)) {
            return index + 1;
        }
    }
    pieces.len()
}
