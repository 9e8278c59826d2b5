//! The tokens and comments of a document as they are written, and what surrounds a byte: of half-typed text,
//! the tree has less than that.

use toyproof_diagnostic::{FileId, Files};
use toyproof_glsl::lexemes;

/// Maximum number of tokens that are searched for the begin of a call or of an operand.
const MAX_SEARCHED_TOKENS: usize = 2000;

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// A keyword or name.
    Word,
    /// Text that begins like a number.
    Number,
    /// An operator or bracket, or a character that GLSL does not have.
    Symbol,
    /// `// …` or `/* … */`.
    Comment,
}

/// A token or comment of a document.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Token<'t> {
    pub(crate) kind: TokenKind,
    pub(crate) text: &'t str,
    /// The first byte in the document.
    pub(crate) start: u32,
    /// Whether it is part of a preprocessor directive.
    pub(crate) is_in_directive: bool,
    /// The number of the lexer's line, in which lines that a `\` continues are one. Of a comment, that of the
    /// token in front.
    pub(crate) line: usize,
}

impl Token<'_> {
    /// One past the last byte.
    pub(crate) fn end(&self) -> u32 {
        self.start + self.text.len() as u32
    }

    /// Whether it is that word or symbol.
    pub(crate) fn is(&self, text: &str) -> bool {
        self.kind != TokenKind::Comment && self.text == text
    }
}

/// The tokens of a document. Indices are those of the tokens without comments.
#[derive(Debug)]
pub(crate) struct Tokens<'t> {
    code: Vec<Token<'t>>,
    comments: Vec<Token<'t>>,
}

/// A call whose parentheses surround a byte.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OpenCall {
    /// The index of the token of the function's name.
    pub(crate) name: usize,
    /// The index of the `(`.
    pub(crate) open: usize,
    /// The index of the first token of each argument up to the byte; at least one.
    pub(crate) arguments: Vec<usize>,
}

impl<'t> Tokens<'t> {
    pub(crate) fn new(files: &'t Files, file: FileId) -> Self {
        let text = files.get(file).text();
        let (mut code, mut comments) = (Vec::new(), Vec::new());
        let (mut end, mut line, mut is_in_directive) = (0, 0, false);
        for lexeme in lexemes(files, file) {
            add_comments(
                text,
                end,
                lexeme.span.start,
                (line, is_in_directive),
                &mut comments,
            );
            (end, line, is_in_directive) = (lexeme.span.end, lexeme.line, lexeme.is_in_directive);
            let text = text
                .get(lexeme.span.start as usize..end as usize)
                .unwrap_or_default();
            code.push(Token {
                kind: kind(text),
                text,
                start: lexeme.span.start,
                is_in_directive,
                line,
            });
        }
        add_comments(
            text,
            end,
            text.len() as u32,
            (line, is_in_directive),
            &mut comments,
        );
        Self { code, comments }
    }

    /// The tokens without comments.
    pub(crate) fn code(&self) -> &[Token<'t>] {
        &self.code
    }

    /// The comments in order.
    pub(crate) fn comments(&self) -> &[Token<'t>] {
        &self.comments
    }

    /// The number of tokens that begin before a byte.
    pub(crate) fn count_before(&self, byte: u32) -> usize {
        self.code.partition_point(|token| token.start < byte)
    }

    /// The index of the word or number that contains a byte or ends there.
    pub(crate) fn word_at(&self, byte: u32) -> Option<usize> {
        let is_word = |&index: &usize| {
            let token = self.code.get(index)?;
            (token.kind == TokenKind::Word && token.start <= byte && byte <= token.end()).then_some(index)
        };
        let after = self.code.partition_point(|token| token.start <= byte);
        [after.checked_sub(1), after.checked_sub(2)]
            .into_iter()
            .flatten()
            .find_map(|index| is_word(&index))
    }

    /// The index of the token that contains a byte.
    pub(crate) fn at(&self, byte: u32) -> Option<usize> {
        let after = self.code.partition_point(|token| token.start <= byte);
        let index = after.checked_sub(1)?;
        (byte < self.code[index].end()).then_some(index)
    }

    /// Whether a byte is in a comment; the end of a `// …` belongs to it.
    pub(crate) fn is_in_comment(&self, byte: u32) -> bool {
        let after = self.comments.partition_point(|comment| comment.start < byte);
        let before = after.checked_sub(1).and_then(|index| self.comments.get(index));
        before.is_some_and(|comment| {
            byte < comment.end()
                || (byte == comment.end()
                    && (comment.text.starts_with("//") || !comment.text.ends_with("*/")))
        })
    }

    /// The innermost call whose parentheses are open before a byte.
    pub(crate) fn open_call(&self, byte: u32) -> Option<OpenCall> {
        let end = self.count_before(byte);
        let mut arguments = vec![end];
        let mut depth = 0_usize;
        for index in (0..end).rev().take(MAX_SEARCHED_TOKENS) {
            let token = self.code[index];
            if !self.same_directive(index, end) {
                return None;
            }
            match token.text {
                ")" | "]" => depth += 1,
                "(" if depth == 0 => {
                    let name = index.checked_sub(1)?;
                    arguments.push(index + 1);
                    arguments.reverse();
                    arguments.pop();
                    let is_callable = self.code[name].kind == TokenKind::Word
                        && !matches!(self.code[name].text, "if" | "for" | "while" | "switch" | "return");
                    if is_callable {
                        return Some(OpenCall {
                            name,
                            open: index,
                            arguments,
                        });
                    }
                    // Parentheses of an expression: the call may be around them.
                    arguments = vec![index];
                }
                "[" if depth == 0 => arguments = vec![index],
                "(" | "[" => depth = depth.saturating_sub(1),
                "," if depth == 0 => arguments.push(index + 1),
                ";" | "{" | "}" => return None,
                _ => {}
            }
        }
        None
    }

    /// Whether the name of a call is in fact one that is declared: behind a type.
    pub(crate) fn is_declared(&self, name: usize) -> bool {
        let before = name.checked_sub(1).map(|index| self.code[index]);
        before.is_some_and(|before| {
            before.kind == TokenKind::Word && !before.is_in_directive && !is_statement_word(before.text)
        })
    }

    /// Whether the tokens from `index` up to `end` are of one directive, or of none.
    fn same_directive(&self, index: usize, end: usize) -> bool {
        let (Some(token), Some(last)) = (self.code.get(index), end.checked_sub(1).map(|at| self.code[at]))
        else {
            return false;
        };
        token.is_in_directive == last.is_in_directive && (!token.is_in_directive || token.line == last.line)
    }

    /// The byte at which the operand begins that ends with the token at `last`: a name or number with its
    /// members, indices and arguments, or parentheses.
    pub(crate) fn operand_start(&self, last: usize) -> Option<u32> {
        let mut index = last;
        loop {
            let token = self.code.get(index)?;
            match token.text {
                ")" | "]" => {
                    index = self.opening(index)?;
                    let is_parenthesis = self.code[index].text == "(";
                    let before = index.checked_sub(1).map(|before| self.code[before]);
                    match before {
                        Some(before)
                            if before.kind == TokenKind::Word && !is_statement_word(before.text)
                                || matches!(before.text, ")" | "]") =>
                        {
                            index -= 1;
                            if before.kind != TokenKind::Word {
                                continue;
                            }
                        }
                        _ if is_parenthesis => return Some(self.code[index].start),
                        _ => return None,
                    }
                }
                _ if token.kind == TokenKind::Symbol => return None,
                _ => {}
            }
            match index.checked_sub(1).map(|before| self.code[before].text) {
                Some(".") => index = index.checked_sub(2)?,
                _ => return Some(self.code[index].start),
            }
        }
    }

    /// The index of the bracket that the one at `close` closes.
    pub(crate) fn opening(&self, close: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for index in (0..=close).rev().take(MAX_SEARCHED_TOKENS) {
            match self.code[index].text {
                ")" | "]" => depth += 1,
                "(" | "[" => depth = depth.checked_sub(1)?,
                ";" | "{" | "}" => return None,
                _ => {}
            }
            if depth == 0 {
                return Some(index);
            }
        }
        None
    }
}

impl Tokens<'_> {
    /// The bytes of the declarations at global scope. Each ends at a `;` outside of braces, or at a `}` that
    /// no declarator follows.
    pub(crate) fn declarations(&self) -> Vec<(u32, u32)> {
        let mut found = Vec::new();
        let mut depth = 0_usize;
        // The begin of the declaration, whether it is one of a structure, and how many braces were closed.
        let mut open: Option<(u32, bool, usize)> = None;
        let code: Vec<&Token<'_>> = self.code.iter().filter(|token| !token.is_in_directive).collect();
        for (index, token) in code.iter().enumerate() {
            let (start, is_structure, closed) = open.get_or_insert((token.start, token.is("struct"), 0));
            match token.text {
                "{" => depth += 1,
                "}" => {
                    depth = depth.saturating_sub(1);
                    *closed += usize::from(depth == 0);
                }
                _ => {}
            }
            let next = code.get(index + 1);
            let continues = next.is_some_and(|next| {
                let is_name = next.kind == TokenKind::Word && *is_structure && *closed == 1;
                matches!(next.text, ";" | "," | "[") || is_name
            });
            let ends = match token.text {
                ";" => depth == 0,
                "}" => depth == 0 && !continues,
                _ => false,
            };
            if ends || next.is_none() {
                found.push((*start, token.end()));
                open = None;
            }
        }
        found
    }
}

fn is_statement_word(word: &str) -> bool {
    matches!(
        word,
        "if" | "for" | "while" | "switch" | "return" | "else" | "do" | "case"
    )
}

fn kind(text: &str) -> TokenKind {
    match text.bytes().next() {
        Some(b'0'..=b'9') => TokenKind::Number,
        Some(b'.') if text.len() > 1 => TokenKind::Number,
        Some(byte) if byte == b'_' || byte.is_ascii_alphabetic() => TokenKind::Word,
        _ => TokenKind::Symbol,
    }
}

/// Adds the comments between two tokens.
fn add_comments<'t>(
    text: &'t str,
    start: u32,
    end: u32,
    (line, is_in_directive): (usize, bool),
    comments: &mut Vec<Token<'t>>,
) {
    let mut at = start as usize;
    let end = end as usize;
    while let Some(gap) = text.get(at..end)
        && let Some(slash) = gap.find('/')
    {
        let rest = &gap[slash..];
        let length = if rest.starts_with("//") {
            line_comment_length(rest)
        } else if let Some(inner) = rest.strip_prefix("/*") {
            inner.find("*/").map_or(rest.len(), |close| close + "/**/".len())
        } else {
            at += slash + 1;
            continue;
        };
        comments.push(Token {
            kind: TokenKind::Comment,
            text: &rest[..length],
            start: (at + slash) as u32,
            is_in_directive,
            line,
        });
        at += slash + length;
    }
}

/// The length of a `// …`, without the end of its line; a `\` continues it on the next one.
fn line_comment_length(text: &str) -> usize {
    let mut from = 0;
    while let Some(found) = text[from..].find('\n') {
        let line = text[..from + found].trim_end_matches('\r');
        if !line.ends_with('\\') {
            return line.len();
        }
        from += found + 1;
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::File;

    use super::*;

    /// The text without `|`, and the byte at which it was.
    fn marked(text: &str) -> (Files, FileId, u32) {
        let at = text.find('|').unwrap();
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text.replacen('|', "", 1)));
        (files, file, at as u32)
    }

    fn call(text: &str) -> String {
        let (files, file, at) = marked(text);
        let tokens = Tokens::new(&files, file);
        let Some(call) = tokens.open_call(at) else {
            return "none".to_owned();
        };
        format!("{} {}", tokens.code()[call.name].text, call.arguments.len() - 1)
    }

    #[test]
    fn the_innermost_open_call_is_found() {
        assert_eq!(call("c = mix(a, |"), "mix 1");
        assert_eq!(call("c = mix(a, f(b), (c, 1|"), "mix 2");
        assert_eq!(call("c = mix(a[1], vec3(1, 2, |), c);"), "vec3 2");
        assert_eq!(call("c = mix(a[b, |"), "mix 0");
        assert_eq!(call("c = sin(x); y = |"), "none");
        assert_eq!(call("if (a |"), "none");
        assert_eq!(call("f(a,\n#define G(x) sin(x, |\n b)"), "sin 1");
        assert_eq!(call("f(|"), "f 0");
        assert_eq!(call("f(a,|"), "f 1");
    }

    #[test]
    fn comments_lie_between_tokens() {
        let text = "a /* b */ / c // d \\\n e\r\nf /**/ // 😀\n/* open";
        let (files, file, at) = marked(&format!("{text}|"));
        let tokens = Tokens::new(&files, file);
        let comments: Vec<_> = tokens.comments().iter().map(|comment| comment.text).collect();
        assert_eq!(comments, ["/* b */", "// d \\\n e", "/**/", "// 😀", "/* open"]);
        assert!(tokens.is_in_comment(at) && tokens.is_in_comment(4) && !tokens.is_in_comment(2));
        assert!(!tokens.is_in_comment(9), "after a closed comment");
    }

    #[test]
    fn operands_begin_with_their_first_name() {
        let start = |text: &str| {
            let (files, file, at) = marked(text);
            let tokens = Tokens::new(&files, file);
            let start = tokens.operand_start(tokens.count_before(at) - 1)?;
            Some(files.get(file).text()[start as usize..at as usize].to_owned())
        };
        assert_eq!(start("x + a.b[i + 1].c|").as_deref(), Some("a.b[i + 1].c"));
        assert_eq!(start("x = -f(a, b)(c)|").as_deref(), Some("f(a, b)(c)"));
        assert_eq!(start("return (a + b)|").as_deref(), Some("(a + b)"));
        assert_eq!(start("a + |"), None);
        assert_eq!(start("x = ; )|"), None);
    }
}
