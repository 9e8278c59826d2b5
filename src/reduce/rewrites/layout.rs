//! The layout of a text: comments, blank lines and indentation.

use toyproof_glsl::lexemes;

use crate::outline::file;

/// The number of blanks of a level of indentation.
const INDENT: usize = 4;

/// The text without comments and blank lines, indented by its braces. Lines are broken where they were, and
/// between statements that a brace separates.
pub(crate) fn tidy(text: &str) -> String {
    let (files, file) = file(text);
    let mut out = String::with_capacity(text.len());
    let mut depth = 0_usize;
    let mut parentheses = 0_usize;
    let mut begins_line = true;
    let mut previous: Option<toyproof_glsl::Lexeme> = None;
    for lexeme in lexemes(&files, file) {
        let token = files.text(lexeme.span);
        let breaks = previous.is_some_and(|previous| {
            let before = files.text(previous.span);
            if lexeme.is_in_directive || previous.is_in_directive {
                return previous.line != lexeme.line;
            }
            let ends_part = matches!(before, ";" | "{") && parentheses == 0 || before == "}" && token != ";";
            let goes_on = matches!(token, ";" | "," | ")" | "]");
            previous.line != lexeme.line && !goes_on || ends_part || token == "}" && parentheses == 0
        });
        if breaks {
            out.truncate(out.trim_end().len());
            out.push('\n');
            begins_line = true;
        }
        if !lexeme.is_in_directive && token == "}" {
            depth = depth.saturating_sub(1);
        }
        if begins_line {
            let indent = if lexeme.is_in_directive { 0 } else { depth * INDENT };
            out.extend(std::iter::repeat_n(' ', indent));
        } else if previous.is_some_and(|previous| {
            let is_apart = previous.span.end < lexeme.span.start;
            is_apart
                && !matches!(files.text(previous.span), "(" | "[")
                && !matches!(token, ")" | "]" | "," | ";")
        }) {
            out.push(' ');
        }
        out.push_str(token);
        begins_line = false;
        if !lexeme.is_in_directive {
            match token {
                "{" => depth += 1,
                "(" | "[" => parentheses += 1,
                ")" | "]" => parentheses = parentheses.saturating_sub(1),
                _ => {}
            }
        }
        previous = Some(lexeme);
    }
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layout_follows_the_braces() {
        let text = "// a\n#define A \\\n  1.\n\nvoid f( ) { for (int i = 0; i < 3; i++) { g(); }\n\n  ; if (x)\n y = A\n; }";
        let tidied = "#define A 1.\nvoid f() {\n    for (int i = 0; i < 3; i++) {\n        g();\n    };\n    if (x)\n    y = A;\n}\n";
        assert_eq!(tidy(text), tidied);
        assert_eq!(tidy(tidied), tidied);
    }
}
