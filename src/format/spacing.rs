//! Which tokens a space separates.

use crate::piece::{Kind, Piece};

/// What a token is in its statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// An operator before its operand.
    Prefix,
    /// `++` or `--` behind its operand.
    Postfix,
    /// An operator between operands, also `?` and `:`.
    Binary,
    /// An assignment, also that of an initializer.
    Assignment,
    /// The `:` of a label.
    Label,
    /// A bracket of an expression, of parameters or of an initializer list.
    Open,
    Close,
    /// The `)` of the head of a statement, behind which the statement begins.
    CloseHead,
    /// A brace of a block that is written on one line.
    OpenBlock,
    CloseBlock,
    /// A name, a number or other punctuation.
    Other,
}

/// The role of an operator; `None` for what is no operator.
pub(crate) fn operator(text: &str, follows_operand: bool) -> Option<Role> {
    let role = match text {
        "+" | "-" if !follows_operand => Role::Prefix,
        "++" | "--" if follows_operand => Role::Postfix,
        "!" | "~" | "++" | "--" => Role::Prefix,
        "=" | "+=" | "-=" | "*=" | "/=" | "%=" | "<<=" | ">>=" | "&=" | "|=" | "^=" => Role::Assignment,
        _ if precedence(text).is_some() => Role::Binary,
        _ => return None,
    };
    Some(role)
}

/// How early a binary operator is applied, from 1: lines are better broken at those that are applied late.
pub(crate) fn precedence(operator: &str) -> Option<usize> {
    const LEVELS: [&[&str]; 11] = [
        &["?", ":"],
        &["||"],
        &["^^"],
        &["&&"],
        &["|"],
        &["^"],
        &["&"],
        &["==", "!="],
        &["<", ">", "<=", ">=", "<<", ">>"],
        &["+", "-"],
        &["*", "/", "%"],
    ];
    let level = LEVELS.iter().position(|operators| operators.contains(&operator));
    level.map(|level| level + 1)
}

/// Whether a word is no operand: `-` behind it is a sign.
pub(crate) fn precedes_operand(word: &str) -> bool {
    matches!(word, "return" | "case" | "else" | "do")
}

/// Whether a space is before a piece, behind the one before it.
pub(crate) fn space(before: (&Piece<'_>, Role), piece: (&Piece<'_>, Role)) -> bool {
    wants_space(before, piece) || merge(before.0, piece.0)
}

fn wants_space((before, before_role): (&Piece<'_>, Role), (piece, role): (&Piece<'_>, Role)) -> bool {
    if matches!(piece.text, "," | ";") || matches!(role, Role::Close | Role::CloseHead) {
        return false;
    }
    if before_role == Role::Open {
        return false;
    }
    if piece.is_comment() || before.is_comment() {
        return true;
    }
    match (piece.text, role) {
        (_, Role::Label | Role::Postfix) | (".", _) => false,
        ("(", Role::Open) if before.kind == Kind::Word => {
            precedes_operand(before.text) || matches!(before.text, "if" | "for" | "while" | "switch")
        }
        ("[", Role::Open) => before.kind != Kind::Word && before_role != Role::Close,
        ("(", Role::Open) => !matches!(before_role, Role::Close | Role::Prefix),
        _ => before_role != Role::Prefix && before.text != ".",
    }
}

/// Whether two pieces without a space between them would be read as other tokens.
fn merge(before: &Piece<'_>, piece: &Piece<'_>) -> bool {
    const LONGER: [&str; 24] = [
        "++", "--", "<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "^^", "+=", "-=", "*=", "/=", "%=", "&=",
        "|=", "^=", "//", "/*", "##", "->", "::",
    ];
    let (Some(last), Some(first)) = (before.text.chars().next_back(), piece.text.chars().next()) else {
        return false;
    };
    let is_part_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if before.kind == Kind::Number {
        return is_part_of_word(first)
            || matches!(first, '.' | '+' | '-') && (first == '.' || last == 'e' || last == 'E');
    }
    if is_part_of_word(last) {
        return is_part_of_word(first);
    }
    if last == '.' {
        return first.is_ascii_digit();
    }
    let both = [last, first].iter().collect::<String>();
    LONGER.contains(&&*both)
}
