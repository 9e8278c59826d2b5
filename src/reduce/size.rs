//! The size of a shader, by which candidates are compared.

use toyproof_glsl::lexemes;

use crate::outline::{file, is_word};

/// The size of a text. Sizes are compared from the first number to the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Size {
    /// The number of preprocessor directives: a macro is expanded, even if the text gets longer.
    pub directives: usize,
    /// The number of tokens, where names and keywords count twice: a number is simpler than a variable.
    pub weight: usize,
    /// The bytes of all tokens.
    pub bytes: usize,
}

impl Size {
    /// The size of a text.
    pub fn of(text: &str) -> Self {
        let (files, file) = file(text);
        let mut size = Self {
            directives: 0,
            weight: 0,
            bytes: 0,
        };
        for lexeme in lexemes(&files, file) {
            let token = files.text(lexeme.span);
            size.directives += usize::from(lexeme.is_in_directive && token == "#");
            let is_name = is_word(token) && !matches!(token, "true" | "false");
            size.weight += 1 + usize::from(is_name);
            size.bytes += token.len();
        }
        size
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simpler_texts_are_smaller() {
        assert!(Size::of("x = 0.;") < Size::of("x = y;"));
        assert!(Size::of("x = 0.;") < Size::of("x = 0.1;"));
        assert!(Size::of("x = 3. + 3.;") < Size::of("#define A 3.\nx = A;"));
        assert_eq!(Size::of("// x\nf ( );"), Size::of("f();"));
    }
}
