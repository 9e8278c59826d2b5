//! The tokens of a text without names, numbers, layout and comments.

use std::hash::{DefaultHasher, Hash, Hasher};

/// The words that keep their meaning whatever a shader defines, except types, which have one form.
const KEYWORDS: [&str; 20] = [
    "if", "else", "for", "while", "do", "switch", "case", "default", "return", "break", "continue",
    "discard", "struct", "const", "in", "out", "inout", "true", "false", "void",
];

/// The kind of a token, without its name or number.
#[derive(Hash)]
enum Token<'a> {
    Keyword(&'a str),
    Name,
    Number,
    Sign(char),
}

/// The tokens of a text, each as a hash with its line, from 1.
#[must_use]
pub fn tokens(text: &str) -> Vec<(u64, usize)> {
    let mut tokens = Vec::new();
    let mut line = 1;
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |at| at + 2)
        } else if first.is_whitespace() {
            first.len_utf8()
        } else {
            let is_number = first.is_ascii_digit()
                || first == '.' && rest[1..].starts_with(|next: char| next.is_ascii_digit());
            let end =
                |belongs: fn(char) -> bool| rest.find(|next: char| !belongs(next)).unwrap_or(rest.len());
            let (token, length) = if is_number {
                let digits = end(|next| next.is_alphanumeric() || next == '.');
                (Token::Number, digits + exponent(&rest[..digits], &rest[digits..]))
            } else if first.is_alphanumeric() || first == '_' {
                let length = end(|next| next.is_alphanumeric() || next == '_');
                let word = &rest[..length];
                let token = if KEYWORDS.contains(&word) {
                    Token::Keyword(word)
                } else {
                    Token::Name
                };
                (token, length)
            } else {
                (Token::Sign(first), first.len_utf8())
            };
            let mut hasher = DefaultHasher::new();
            token.hash(&mut hasher);
            tokens.push((hasher.finish(), line));
            length
        };
        line += rest[..length].matches('\n').count();
        rest = &rest[length..];
    }
    tokens
}

/// The length of the signed exponent after the digits of a number, `-3` after `1e`.
fn exponent(digits: &str, rest: &str) -> usize {
    let is_open = digits.ends_with(['e', 'E']) && !digits.starts_with("0x") && rest.starts_with(['+', '-']);
    if !is_open {
        return 0;
    }
    let end = rest[1..].find(|next: char| !next.is_ascii_digit());
    1 + end.unwrap_or(rest.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_numbers_and_layout_do_not_matter() {
        let kinds = |text: &str| tokens(text).iter().map(|&(kind, _)| kind).collect::<Vec<_>>();
        assert_eq!(kinds("a = .5*b; // c"), kinds("x=\n 2.0e-1 /* y\n */ * zoom ;"));
        assert_ne!(kinds("a + b"), kinds("a - b"));
        assert_ne!(kinds("if (a)"), kinds("of (a)"));
        assert_eq!(
            tokens("a\n/*\n*/b")
                .iter()
                .map(|token| token.1)
                .collect::<Vec<_>>(),
            [1, 3]
        );
        assert!(tokens("/* open").is_empty() && tokens("// open").is_empty());
        assert_eq!(tokens("ä.").len(), 2);
    }
}
