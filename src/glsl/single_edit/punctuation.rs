//! Missing, additional and mistaken punctuators and operators near the errors.

use super::candidates::Candidates;
use crate::keywords::{Keyword, Word};
use crate::token::Punctuator;

/// Cost of an edit of punctuation where names or types are reported.
const COST_OUTSIDE_SYNTAX: usize = 16;

/// Number of tokens in which the begin of a statement is searched.
const MAX_STATEMENT_TOKENS: usize = 100;

/// Cost of an edit of a macro that the error uses.
const COST_IN_DIRECTIVE: usize = 10;

/// Cost of an edit that leaves a statement without effect.
const COST_WITHOUT_EFFECT: usize = 30;

/// Punctuators that are mistaken for each other.
const CONFUSED: [(&str, &[&str]); 22] = [
    (";", &[",", ":"]),
    (":", &[";", ","]),
    (",", &[";", ".", ")"]),
    (".", &[","]),
    ("=", &["==", "-", "+"]),
    ("==", &["="]),
    ("{", &["(", "["]),
    ("}", &[")", "]"]),
    ("(", &["{", "["]),
    (")", &["}", "]"]),
    ("[", &["(", "{"]),
    ("]", &[")", "}"]),
    ("<", &["(", "<="]),
    (">", &[")", ">="]),
    ("&", &["&&"]),
    ("|", &["||"]),
    ("&&", &["||"]),
    ("^", &["^^", "*"]),
    ("<<", &["<"]),
    (">>", &[">"]),
    ("++", &["+"]),
    ("--", &["-"]),
];

pub(super) fn collect(candidates: &mut Candidates) {
    for (index, distance) in candidates.near() {
        let mut cost = distance + candidates.cost(0, COST_OUTSIDE_SYNTAX);
        if candidates.source.is_in_directive(index.saturating_sub(1)) {
            cost += COST_IN_DIRECTIVE;
        }
        insertions(candidates, index, distance, cost);
        changes(candidates, index, cost);
        if candidates.is_call() && candidates.source.is(index, Punctuator::Comma) {
            candidates.remove(distance + 5, index);
        }
    }
}

/// Insertions between the token before `index` and the token at `index`, whose cost is at least `cost`, and
/// `distance` where it is likely although no grammar is violated.
fn insertions(candidates: &mut Candidates, index: usize, distance: usize, cost: usize) {
    let source = candidates.source;
    let Some(before) = index.checked_sub(1) else {
        return;
    };
    let ends_operand = source.ends_operand(before);
    let begins_operand = source.begins_operand(index);
    let ends_line = source.begins_line(index);
    let is_jump = matches!(
        source.keyword(before),
        Some(Keyword::Break | Keyword::Continue | Keyword::Discard | Keyword::Return)
    );
    let is_sign = matches!(
        source.punctuator(index),
        Some(Punctuator::Plus | Punctuator::Minus | Punctuator::LeftParen)
    );
    if source.is_in_directive(before) && ends_line {
        return;
    }
    if ends_operand || is_jump || source.is(before, Punctuator::RightBrace) {
        // `vec3 color; (1.0);` has a statement without effect.
        let added = match (ends_line, source.is(index, Punctuator::LeftParen)) {
            (true, _) => 0,
            (false, true) => COST_WITHOUT_EFFECT,
            (false, false) => 4,
        };
        candidates.insert(cost + added, index, ";");
    }
    if ends_operand {
        if begins_operand || source.word(index).is_some() {
            // `vec2(1.0 -1.0)` is the difference of two numbers.
            let cost = match (candidates.is_call() && is_sign, is_sign) {
                (true, _) => distance + 4,
                (false, true) => cost + 8,
                (false, false) => cost + 2,
            };
            candidates.insert(cost, index, ",");
        }
        if begins_operand {
            let cost = if ends_line { cost + 4 } else { cost };
            candidates.insert(cost + 12, index, " *");
            candidates.insert(cost + 13, index, " +");
            candidates.insert(cost + 14, index, " -");
        }
        if source.is_name(index) && !source.is_number(before) {
            candidates.insert(cost + 6, index, ".");
        }
        if source.is_name(before) && begins_operand {
            candidates.insert(cost + 4, index, " =");
            if before > 0 && source.is_type(before - 1) && source.is(index, Punctuator::LeftParen) {
                let constructor = format!(" = {}", source.token_text(before - 1));
                candidates.insert(cost + 3, index, &constructor);
            }
        }
        if !begins_operand || is_sign || ends_line {
            candidates.insert(cost + 3, index, ")");
            candidates.insert(cost + 5, index, "]");
        }
    } else if source.is(before, Punctuator::LeftParen) {
        candidates.insert(cost + 4, index, ")");
    }
    let begins_parameter = matches!(
        source.keyword(index),
        Some(Keyword::In | Keyword::Out | Keyword::InOut | Keyword::Const)
    );
    if begins_operand
        || begins_parameter
        || matches!(
            source.punctuator(index),
            Some(Punctuator::RightParen | Punctuator::Semicolon)
        )
    {
        let is_head = matches!(
            source.keyword(before),
            Some(Keyword::If | Keyword::For | Keyword::While | Keyword::Switch)
        );
        let is_callable = source.symbol(before).is_some() && source.keyword(before).is_none();
        let bonus = match (is_head, is_callable && !is_sign) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => 7,
        };
        candidates.insert_before(cost + bonus, index, "(");
        if source.is_name(before) {
            candidates.insert(cost + 6, index, "[");
        }
    }
    if source.follows_statement(index) {
        candidates.insert(cost + 14, index, " }");
        if begins_operand {
            candidates.insert_before(cost + 16, index, "return ");
        }
    }
    if source.is(before, Punctuator::RightParen) || matches!(source.keyword(before), Some(Keyword::Else)) {
        candidates.insert(cost + 8, index, " {");
    }
}

/// The removal and replacement of the token at `index`.
fn changes(candidates: &mut Candidates, index: usize, cost: usize) {
    let source = candidates.source;
    let Some(punctuator) = source.punctuator(index) else {
        match source.word(index) {
            Some(Word::Keyword(keyword)) if !matches!(keyword, Keyword::True | Keyword::False) => {
                candidates.remove(cost + 14, index);
            }
            Some(Word::Reserved) => candidates.remove(cost + 14, index),
            Some(Word::Type(_)) => candidates.remove(cost + 24, index),
            _ if index < source.len() => candidates.remove(cost + 45, index),
            _ => {}
        }
        return;
    };
    let is_repeated = index > 0 && source.is(index - 1, punctuator) || source.is(index + 1, punctuator);
    let is_opening = matches!(
        punctuator,
        Punctuator::LeftParen | Punctuator::LeftBracket | Punctuator::LeftBrace
    );
    let removal = match (is_repeated, is_opening) {
        (true, _) => 3,
        // An opening bracket without its partner rather lacks it.
        (false, true) => 12,
        (false, false) => 6,
    };
    candidates.remove(cost + removal, index);
    let confused = CONFUSED.iter().find(|(text, _)| *text == punctuator.text());
    // A comparison as a statement has no effect.
    let is_statement = punctuator == Punctuator::Assign && !in_parentheses(candidates, index);
    let cost = if is_statement {
        cost + COST_WITHOUT_EFFECT
    } else {
        cost
    };
    for (rank, meant) in confused.into_iter().flat_map(|(_, meant)| *meant).enumerate() {
        candidates.replace(cost + 8 + rank, index, meant);
    }
}

/// Whether the token is in parentheses of its statement.
fn in_parentheses(candidates: &Candidates, index: usize) -> bool {
    let source = candidates.source;
    let mut depth = 0_usize;
    for before in (0..index).rev().take(MAX_STATEMENT_TOKENS) {
        match source.punctuator(before) {
            Some(Punctuator::RightParen) => depth += 1,
            Some(Punctuator::LeftParen) if depth == 0 => return true,
            Some(Punctuator::LeftParen) => depth -= 1,
            Some(Punctuator::Semicolon | Punctuator::LeftBrace | Punctuator::RightBrace) => return false,
            _ => {}
        }
    }
    false
}
