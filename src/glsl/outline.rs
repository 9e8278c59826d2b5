//! A shader's outline, read before it is parsed: its brackets and its `mainImage`.

use crate::diagnostic::Diagnostic;
use crate::source::{FileId, Files, Span};

/// Deeper brackets overflow the stack of the parsers behind us.
pub(super) const MAX_NESTING: usize = 256;

/// Refuses what can be told from the outline alone.
pub(super) fn check(files: &Files, file: FileId) -> Result<(), Diagnostic> {
    let text = files.get(file).text();
    if text.trim().is_empty() {
        return Err(Diagnostic::error("E0002", "the file is empty")
            .at(Span::new(file, 0, 0))
            .note(MAIN_IMAGE));
    }
    let mut open: Vec<(char, Span)> = Vec::new();
    let mut defines_main_image = false;
    let mut conditional = false;
    for token in tokens(text) {
        let span = |len: usize| Span::new(file, token.at as u32, (token.at + len) as u32);
        match token.kind {
            Kind::UnclosedComment => {
                return Err(Diagnostic::error("E0003", "this comment is never closed")
                    .at(span(2))
                    .note("close it with `*/`"));
            }
            Kind::Word(word) => {
                defines_main_image |= word == "mainImage";
                conditional |= matches!(word, "#if" | "#ifdef" | "#ifndef");
            }
            Kind::Open(bracket) => {
                open.push((bracket, span(1)));
                if open.len() > MAX_NESTING {
                    return Err(Diagnostic::error("E0004", "nested too deep")
                        .at(span(1))
                        .label(format!("more than {MAX_NESTING} brackets are open here"))
                        .note("move an inner part into a function or a variable"));
                }
            }
            // Branches of the preprocessor may hold half a pair each; what they come to is the parser's to say.
            Kind::Close(_) if conditional => {
                open.pop();
            }
            Kind::Close(bracket) => match open.pop() {
                Some((opening, _)) if closes(opening, bracket) => {}
                Some((opening, at)) => {
                    return Err(
                        Diagnostic::error("E0003", format!("`{opening}` is closed by `{bracket}`"))
                            .at(span(1))
                            .related(at, format!("this `{opening}` is still open")),
                    );
                }
                None => {
                    return Err(Diagnostic::error(
                        "E0003",
                        format!("nothing is open that this `{bracket}` closes"),
                    )
                    .at(span(1)));
                }
            },
        }
    }
    if let (false, Some((bracket, at))) = (conditional, open.pop()) {
        return Err(
            Diagnostic::error("E0003", format!("this `{bracket}` is never closed"))
                .at(at)
                .note("the file ends before its partner"),
        );
    }
    if !defines_main_image {
        return Err(
            Diagnostic::error("E0002", "the shader has no function `mainImage`")
                .at(Span::new(file, 0, 0))
                .note(MAIN_IMAGE),
        );
    }
    Ok(())
}

const MAIN_IMAGE: &str =
    "ShaderToy calls `void mainImage(out vec4 fragColor, in vec2 fragCoord)` for each pixel";

fn closes(opening: char, closing: char) -> bool {
    matches!((opening, closing), ('(', ')') | ('[', ']') | ('{', '}'))
}

struct Token<'a> {
    at: usize,
    kind: Kind<'a>,
}

enum Kind<'a> {
    /// An identifier, a keyword, a number, or a directive with its `#`.
    Word(&'a str),
    Open(char),
    Close(char),
    UnclosedComment,
}

/// Words and brackets outside comments.
fn tokens(text: &str) -> impl Iterator<Item = Token<'_>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        loop {
            let rest = &text[at..];
            let character = rest.chars().next()?;
            let start = at;
            if rest.starts_with("//") {
                at += rest.find('\n').unwrap_or(rest.len());
                continue;
            }
            if let Some(comment) = rest.strip_prefix("/*") {
                let Some(end) = comment.find("*/") else {
                    at = text.len();
                    return Some(Token {
                        at: start,
                        kind: Kind::UnclosedComment,
                    });
                };
                at += end + 4;
                continue;
            }
            at += character.len_utf8();
            let kind = match character {
                '(' | '[' | '{' => Kind::Open(character),
                ')' | ']' | '}' => Kind::Close(character),
                '#' | '_' | 'a'..='z' | 'A'..='Z' | '0'..='9' => {
                    let tail = &text[at..];
                    at += tail
                        .find(|c: char| c != '_' && !c.is_ascii_alphanumeric())
                        .unwrap_or(tail.len());
                    Kind::Word(&text[start..at])
                }
                _ => continue,
            };
            return Some(Token { at: start, kind });
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::short;
    use crate::source::File;

    fn verdict(text: &str) -> String {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        check(&files, file).map_or_else(|diagnostic| short(&diagnostic, &files), |()| String::new())
    }

    const MAIN: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0.0, 1.0); }";

    #[test]
    fn a_whole_shader_passes() {
        assert_eq!(verdict(MAIN), "");
        assert_eq!(verdict(&format!("// ( {{\n/* [ */{MAIN}")), "");
    }

    #[test]
    fn each_break_of_the_outline_has_its_own_message_and_place() {
        for (text, expected) in [
            (" \n", "s:1:1: error[E0002]: the file is empty"),
            (
                "// mainImage\nfloat f;",
                "s:1:1: error[E0002]: the shader has no function `mainImage`",
            ),
            (
                "void mainImage() {\n  if (a) {\n}",
                "s:1:18: error[E0003]: this `{` is never closed",
            ),
            (
                "void mainImage() {}\n}",
                "s:2:1: error[E0003]: nothing is open that this `}` closes",
            ),
            (
                "void mainImage() { f(1]; }",
                "s:1:23: error[E0003]: `(` is closed by `]`",
            ),
            (
                "void mainImage() {} /* x",
                "s:1:21: error[E0003]: this comment is never closed",
            ),
        ] {
            assert_eq!(verdict(text), expected);
        }
    }

    #[test]
    fn half_pairs_in_branches_of_the_preprocessor_are_left_to_the_parser() {
        let text = "#ifdef A\nvoid mainImage(out vec4 c, in vec2 p) {\n#else\nvoid mainImage(out vec4 c, vec2 p) {\n#endif\n}";
        assert_eq!(verdict(text), "");
    }

    #[test]
    fn deep_nesting_is_an_error_at_any_depth() {
        let deep = format!("void mainImage() {{ float x = {}1.0; }}", "(".repeat(20_000));
        assert!(verdict(&deep).contains("nested too deep"));
    }
}
