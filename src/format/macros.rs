//! What the macros of a text stand for, as far as the shape of statements depends on it.

use std::collections::HashMap;

use crate::piece::{Kind, Piece, pieces};

/// What a use of a macro at the begin of a statement is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// The head of a statement, such as `for (…)`.
    Head,
    /// A whole statement or declaration: no `;` has to follow.
    Statement,
}

/// A macro whose use is more than an expression.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Macro {
    pub(crate) form: Form,
    pub(crate) has_parameters: bool,
}

/// The macros that a text defines; of several definitions of a name, the first.
pub(crate) fn macros<'a>(all: &[Piece<'a>]) -> HashMap<&'a str, Macro> {
    let mut macros = HashMap::new();
    let directives = all.iter().filter(|piece| piece.kind == Kind::Directive);
    for (name, found) in directives.filter_map(|piece| read(piece.text)) {
        macros.entry(name).or_insert(found);
    }
    macros
}

/// The name of a directive, such as `define`, and the rest of its line.
pub(crate) fn directive(text: &str) -> (&str, &str) {
    let text = text[1..].trim_start();
    text.split_at(
        text.find(|c: char| !c.is_ascii_alphanumeric())
            .unwrap_or(text.len()),
    )
}

fn read(text: &str) -> Option<(&str, Macro)> {
    let ("define", rest) = directive(text) else {
        return None;
    };
    let rest = rest.trim_start();
    let (name, rest) = rest.split_at(rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_')?);
    let has_parameters = rest.starts_with('(');
    let replacement = if has_parameters {
        rest.split_once(')')?.1
    } else {
        rest
    };
    let tokens = pieces(replacement);
    let mut tokens = tokens.iter().filter(|piece| piece.is_token());
    let first = tokens.next()?.text;
    let last = tokens.next_back().map_or(first, |piece| piece.text);
    let form = match (first, last) {
        (_, ";" | "}") => Form::Statement,
        ("if" | "for" | "while", ")") | (_, "else") => Form::Head,
        _ => return None,
    };
    let found = Macro { form, has_parameters };
    Some((name, found))
}
