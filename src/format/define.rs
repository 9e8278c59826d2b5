//! Long lines of macro definitions, which are continued by `\`.

use crate::line::{Line, MAX_COLUMNS};
use crate::macros::directive;
use crate::piece::{Kind, Piece, pieces};
use crate::spacing::Role;

/// The tokens and comments of a directive, without blanks and line continuations.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    let after_hash = &text[1..];
    let tokens = pieces(after_hash).into_iter();
    tokens.map(|piece| piece.text.replace("\\\n", "")).collect()
}

/// A directive with lines that fit, where they can be broken; others stay as they are written.
pub(crate) fn wrapped(text: &str) -> String {
    let is_long = |line: &str| {
        let code = line.split("//").next().unwrap_or_default();
        code.trim_end().chars().count() > MAX_COLUMNS
    };
    if !text.lines().any(is_long) || directive(text).0 != "define" || text.contains("/*") {
        return text.to_owned();
    }
    let mut out = Vec::new();
    for line in text.split("\\\n") {
        if !is_long(line) || line.contains('\n') {
            out.push(line.trim_end().to_owned());
        } else {
            wrap(line, &mut out);
        }
    }
    out.join(" \\\n")
}

/// Breaks a line of a definition between the tokens of the replacement.
fn wrap(text: &str, out: &mut Vec<String>) {
    // What is before the first blank behind the name, with its parameters, stays as it is.
    let indent = text.len() - text.trim_start().len();
    let begin = if text.trim_start().starts_with('#') {
        let name = text.find("define").map_or(0, |at| at + "define".len());
        let name = name + (text[name..].len() - text[name..].trim_start().len());
        let end = text[name..].find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        let end = end.map_or(text.len(), |end| name + end);
        if text[end..].starts_with('(') {
            text[end..].find(')').map_or(text.len(), |close| end + close + 1)
        } else {
            end
        }
    } else {
        indent
    };
    let (head, replacement) = text.split_at(begin);
    let mut line = Line::new(false);
    line.max_columns -= " \\".len();
    line.level = indent / 4;
    if !head.trim().is_empty() {
        let head = Piece {
            kind: Kind::Verbatim,
            text: head.trim_end(),
            breaks: 0,
            column: 0,
            start: 0,
        };
        line.push(head, Role::Other);
    }
    for piece in pieces(replacement) {
        let role = line.role(&piece);
        line.push(piece, role);
    }
    let mut written = Vec::new();
    line.write(&mut written);
    let lines = written.into_iter().map(|line| match line.comment {
        Some(comment) => format!("{} {}", line.code, comment.text),
        None => line.code,
    });
    out.extend(lines);
}
