//! Mistaken types near the errors: of declarations, literals, and expressions to convert.

use std::collections::HashMap;

use toyproof_diagnostic::{Code, Diagnostics, Span};

use super::candidates::Candidates;
use crate::keywords::{Keyword, Word};
use crate::source::Source;
use crate::token::{Punctuator, Symbol};

/// Cost of a change of types where only the grammar is reported.
const COST_IN_SYNTAX: usize = 20;

/// Maximum number of declarations of one name that are changed.
const MAX_DECLARATIONS: usize = 4;

/// Number of errors whose messages are read for names of types.
const MAX_MESSAGES: usize = 4;

/// Maximum number of members of structures whose types are changed.
const MAX_MEMBERS: usize = 20;

/// Additional cost of a type that no error mentions.
const COST_UNMENTIONED: usize = 4;

/// The types that a type is mistaken for, most probable first.
const MISTAKEN: [(&str, &[&str]); 10] = [
    ("float", &["int", "vec2", "vec3", "vec4", "bool"]),
    ("int", &["float", "uint", "bool", "ivec2", "vec2", "vec3"]),
    ("bool", &["float", "int"]),
    ("vec2", &["vec3", "float", "vec4", "ivec2", "mat2"]),
    ("vec3", &["vec2", "vec4", "float", "mat3", "ivec3"]),
    ("vec4", &["vec3", "vec2", "float", "mat4"]),
    ("void", &["float", "vec3", "vec2", "vec4", "int", "bool"]),
    ("mat2", &["mat3", "vec2", "mat4"]),
    ("mat3", &["mat2", "mat4", "vec3"]),
    ("mat4", &["mat3", "mat2", "vec4"]),
];

/// The types of a declaration without one, most frequent first.
const TYPES: [&str; 12] = [
    "float", "vec3", "vec2", "int", "vec4", "void", "bool", "mat2", "mat3", "mat4", "uint", "ivec2",
];

pub(super) fn collect(candidates: &mut Candidates, errors: &Diagnostics) {
    let declarations = declarations(candidates.source);
    let mentioned = MentionedNames::new(candidates.source, errors);
    for (index, distance) in candidates.near() {
        let cost = distance + candidates.cost(COST_IN_SYNTAX, 0);
        literal(candidates, index, cost, distance);
        mentioned.change_type(candidates, index, cost + 2);
        let declared = candidates
            .source
            .symbol(index)
            .and_then(|name| declarations.get(&name));
        for (rank, &at) in declared
            .into_iter()
            .flatten()
            .rev()
            .take(MAX_DECLARATIONS)
            .enumerate()
        {
            mentioned.change_type(candidates, at, cost + 3 + rank);
            if at > 0 && candidates.source.keyword(at - 1) == Some(Keyword::Const) {
                candidates.remove(cost + 8 + rank, at - 1);
            }
        }
        convert(candidates, index, cost);
        missing_type(candidates, index, distance);
    }
    for name in &mentioned.names {
        let at = declarations.get(name).into_iter().flatten();
        for (rank, &at) in at.take(MAX_DECLARATIONS).enumerate() {
            mentioned.change_type(candidates, at, 3 + rank);
            mentioned.change_parameters(candidates, at + 2, 5 + rank);
        }
    }
    mentioned.change_members(candidates);
    if errors.iter().any(|error| error.code == Code::NoMainImage) {
        main_image(candidates, &mentioned);
    }
}

/// The names that the messages of the errors mention.
struct MentionedNames<'a> {
    /// The names of types.
    types: Vec<&'a str>,
    /// The names of the text.
    names: Vec<Symbol>,
}

impl<'a> MentionedNames<'a> {
    fn new(source: &Source, errors: &'a Diagnostics) -> Self {
        let (mut types, mut names) = (Vec::new(), Vec::new());
        for error in errors.iter().take(MAX_MESSAGES) {
            let is_other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
            for word in error.message.split(is_other) {
                let Some(symbol) = source.interner.find(word) else {
                    continue;
                };
                match source.interner.word(symbol) {
                    Word::Type(_) if !types.contains(&word) => types.push(word),
                    Word::Name if !names.contains(&symbol) => names.push(symbol),
                    _ => {}
                }
            }
        }
        Self { types, names }
    }

    /// Replaces a type by those that errors mention, and by those that it is often mistaken for.
    fn change_type(&self, candidates: &mut Candidates, index: usize, cost: usize) {
        if !candidates.source.is_type(index) {
            return;
        }
        let text = candidates.source.token_text(index);
        for (rank, meant) in self.types.iter().filter(|meant| **meant != text).enumerate() {
            candidates.replace(cost + rank, index, meant);
        }
        let mistaken = MISTAKEN.iter().find(|(mistaken, _)| *mistaken == text);
        for (rank, meant) in mistaken.into_iter().flat_map(|(_, meant)| *meant).enumerate() {
            candidates.replace(cost + COST_UNMENTIONED + rank, index, meant);
        }
    }
}

impl MentionedNames<'_> {
    /// Replaces the types in the header of a function whose `(` is at `open`.
    fn change_parameters(&self, candidates: &mut Candidates, open: usize, cost: usize) {
        if !candidates.source.is(open, Punctuator::LeftParen) {
            return;
        }
        for index in open + 1..candidates.source.partner(open).unwrap_or(open) {
            self.change_type(candidates, index, cost);
        }
    }

    /// Replaces mentioned types of members of structures, whose uses do not name the members.
    fn change_members(&self, candidates: &mut Candidates) {
        let source = candidates.source;
        let mut is_member = false;
        let mut count = 0;
        for index in 0..source.len() {
            if source.keyword(index) == Some(Keyword::Struct) {
                is_member = true;
            } else if source.is(index, Punctuator::RightBrace) {
                is_member = false;
            } else if is_member && source.is_type(index) && self.types.contains(&source.token_text(index)) {
                count += 1;
                if count <= MAX_MEMBERS {
                    self.change_type(candidates, index, 6);
                }
            }
        }
    }
}

/// The types of the declarations of each name, as token indices.
fn declarations(source: &Source) -> HashMap<Symbol, Vec<usize>> {
    let mut declarations: HashMap<_, Vec<_>> = HashMap::new();
    // The type of the declaration whose declarators follow.
    let mut of_list = None;
    for index in 0..source.len() {
        let Some(before) = index.checked_sub(1) else {
            continue;
        };
        if source.is(before, Punctuator::Semicolon) {
            of_list = None;
        }
        let Some(name) = source.symbol(index).filter(|_| source.is_name(index)) else {
            continue;
        };
        if source.is_type(before) {
            of_list = Some(before);
            declarations.entry(name).or_default().push(before);
        } else if source.is(before, Punctuator::Comma)
            && let Some(at) = of_list
        {
            declarations.entry(name).or_default().push(at);
        }
    }
    declarations
}

/// Changes a number between integer and float.
fn literal(candidates: &mut Candidates, index: usize, cost: usize, distance: usize) {
    let source = candidates.source;
    if !source.is_number(index) {
        return;
    }
    let text = source.token_text(index);
    let digits = text.trim_end_matches(['f', 'F', 'u', 'U']);
    if digits.bytes().all(|byte| byte.is_ascii_digit()) {
        candidates.replace(cost + 2, index, &format!("{digits}.0"));
    }
    if let Some((whole, _)) = digits.split_once('.') {
        candidates.replace(cost + 4, index, if whole.is_empty() { "0" } else { whole });
    }
    if digits.len() < text.len() {
        candidates.replace(cost + 3, index, digits);
    }
    // Characters that no number contains.
    let mut points = 0;
    let valid = text.bytes().take_while(|byte| {
        points += usize::from(*byte == b'.');
        points < 2 && (byte.is_ascii_digit() || *byte == b'.')
    });
    let valid = valid.count();
    if valid < text.len() {
        candidates.replace(distance + 1, index, &text[..valid]);
        let digits = text.bytes().take_while(u8::is_ascii_digit).count();
        let at = source.span(index).start + digits as u32;
        for bracket in ["]", ")"] {
            candidates.add(distance + 3, Span::new(source.file, at, at), bracket);
        }
        // A name that adjoins the number.
        let at = source.span(index).start + valid as u32;
        for separator in [";", ","] {
            candidates.add(distance + 2, Span::new(source.file, at, at), separator);
        }
    }
}

/// Converts the operand that begins at a word, or changes its swizzle.
fn convert(candidates: &mut Candidates, index: usize, cost: usize) {
    let source = candidates.source;
    let follows_dot = index > 0 && source.is(index - 1, Punctuator::Dot);
    if follows_dot && source.is_name(index) {
        return change_swizzle(candidates, index, cost + 5);
    }
    let is_declared = index > 0 && (source.is_type(index - 1) || source.is_name(index - 1));
    if !(source.is_name(index) || source.is_type(index)) || is_declared {
        return;
    }
    let end = source.operand_end(index);
    if source.is_type(index) && end == index + 1 {
        return;
    }
    let span = source.span(index).to(source.span(end - 1));
    let text = source.slice(span);
    for (rank, ty) in ["float", "int", "vec3", "vec2", "vec4"].iter().enumerate() {
        candidates.add(cost + 7 + rank, span, &format!("{ty}({text})"));
    }
    for (rank, swizzle) in [".x", ".xy", ".xyz"].iter().enumerate() {
        candidates.insert(cost + 7 + rank, end, swizzle);
    }
}

/// Changes the number of components of a swizzle.
fn change_swizzle(candidates: &mut Candidates, index: usize, cost: usize) {
    let text = candidates.source.token_text(index);
    let Some(set) = ["xyzw", "rgba", "stpq"]
        .iter()
        .find(|set| text.chars().all(|component| set.contains(component)))
    else {
        return;
    };
    let shorter = (1..text.len().min(4))
        .rev()
        .map(|length| text[..length].to_owned());
    let longer = (text.len() + 1..=4).map(|length| set[..length].to_owned());
    for (rank, swizzle) in longer.chain(shorter).enumerate() {
        candidates.replace(cost + rank, index, &swizzle);
    }
}

/// Inserts a type before the name of a declaration without one.
fn missing_type(candidates: &mut Candidates, index: usize, distance: usize) {
    let source = candidates.source;
    let is_qualifier = |keyword| {
        matches!(
            keyword,
            Keyword::Const
                | Keyword::In
                | Keyword::Out
                | Keyword::InOut
                | Keyword::Lowp
                | Keyword::Mediump
                | Keyword::Highp
        )
    };
    let begins = source.follows_statement(index)
        || source.is(index - 1, Punctuator::LeftParen)
        || source.is(index - 1, Punctuator::Comma)
        || source.keyword(index - 1).is_some_and(is_qualifier);
    let declares = matches!(
        source.punctuator(index + 1),
        Some(
            Punctuator::Assign
                | Punctuator::Comma
                | Punctuator::Semicolon
                | Punctuator::LeftParen
                | Punctuator::RightParen
                | Punctuator::LeftBracket
        )
    );
    // A parameter without a name.
    let is_empty = !source.follows_statement(index)
        && matches!(
            source.punctuator(index),
            Some(Punctuator::Comma | Punctuator::RightParen)
        );
    if !begins || !(is_empty || source.is_name(index) && declares) {
        return;
    }
    for (rank, ty) in TYPES.iter().enumerate() {
        candidates.insert_before(distance + 5 + rank, index, &format!("{ty} "));
    }
}

/// Changes the types and directions in the header of `mainImage`.
fn main_image(candidates: &mut Candidates, mentioned: &MentionedNames) {
    let source = candidates.source;
    let Some(name) = (0..source.len()).find(|&index| source.token_text(index) == "mainImage") else {
        return;
    };
    let Some(end) = source.partner(name + 1) else {
        return;
    };
    for index in name.saturating_sub(1)..end {
        if source.is_type(index) {
            mentioned.change_type(candidates, index, 3);
            candidates.replace(3, index, "void");
            candidates.insert_before(1, index, "out ");
        }
        if matches!(
            source.keyword(index),
            Some(Keyword::In | Keyword::Out | Keyword::InOut | Keyword::Const)
        ) {
            candidates.replace(1, index, "out");
            candidates.replace(2, index, "in");
        }
    }
    candidates.insert_before(2, name, "void ");
}
