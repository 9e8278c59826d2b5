//! The tokens of a test in one line.

use std::ops::Range;

use toyproof_diagnostic::Span;

use super::source::Snippet;

/// An error in the syntax of a test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SyntaxError {
    pub(super) at: Span,
    pub(super) message: String,
    pub(super) help: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    Number,
    /// All from an opening bracket to the closing one.
    Group,
    Operator,
}

#[derive(Debug, Clone)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) range: Range<usize>,
}

/// The operators of more than one character.
const OPERATORS: [&str; 13] = [
    "<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "^^", "++", "--", "+-", "±",
];

/// Splits a text into tokens; `inside`: those in brackets, too, instead of groups.
pub(super) fn tokens(snippet: &Snippet, inside: bool) -> Result<Vec<Token>, SyntaxError> {
    let text = snippet.text();
    let error = |range: Range<usize>, message: String, help: &str| SyntaxError {
        at: snippet.place(range.start, range.end),
        message,
        help: help.to_owned(),
    };
    let mut tokens = Vec::new();
    // The opening brackets, with their places.
    let mut open: Vec<(char, usize)> = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let start = at;
        let rest = &text[start..];
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let starts_number =
            c.is_ascii_digit() || (c == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit()));
        let kind = if c.is_whitespace() && c != '\n' && c != '\r' {
            at += c.len_utf8();
            continue;
        } else if starts_number {
            at += number_length(rest);
            Kind::Number
        } else if is_word(c) {
            at += rest.find(|c| !is_word(c)).unwrap_or(rest.len());
            Kind::Word
        } else if "([{".contains(c) {
            open.push((c, start));
            at += 1;
            continue;
        } else if ")]}".contains(c) {
            at += 1;
            let wanted = match c {
                ')' => '(',
                ']' => '[',
                _ => '{',
            };
            match open.pop() {
                Some((found, from)) if found == wanted => {
                    if open.is_empty() && !inside {
                        tokens.push(Token {
                            kind: Kind::Group,
                            range: from..at,
                        });
                    }
                }
                _ => {
                    let message = format!("`{c}` closes no bracket");
                    return Err(error(
                        start..at,
                        message,
                        "remove it, or open the bracket before it",
                    ));
                }
            }
            continue;
        } else if ";\\#\"'@$`\n\r".contains(c) {
            let message = match c {
                '\n' | '\r' => "a test is one line".to_owned(),
                _ => format!("unexpected `{c}` in a test"),
            };
            let help = "a test compares GLSL expressions, such as `f(1.0) == 2.0`";
            return Err(error(start..start + c.len_utf8(), message, help));
        } else {
            let known = OPERATORS.iter().find(|operator| rest.starts_with(**operator));
            at += known.map_or(c.len_utf8(), |operator| operator.len());
            Kind::Operator
        };
        if open.is_empty() || inside {
            tokens.push(Token {
                kind,
                range: start..at,
            });
        }
    }
    match open.pop() {
        Some((c, from)) => {
            let message = format!("`{c}` is not closed");
            Err(error(from..from + 1, message, "add the closing bracket"))
        }
        None => Ok(tokens),
    }
}

/// The length of the number that a text begins with.
fn number_length(text: &str) -> usize {
    let is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    let mut before = ' ';
    let ends = |&(_, c): &(usize, char)| {
        let is_sign = "+-".contains(c) && "eE".contains(before) && !is_hexadecimal;
        before = c;
        !(c.is_ascii_alphanumeric() || c == '.' || is_sign)
    };
    text.char_indices().find(ends).map_or(text.len(), |(at, _)| at)
}
