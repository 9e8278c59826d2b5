//! Positions in a text of GLSL, for edits of whole statements: the text is valid, so brackets match.

/// The line that contains a byte, without its end.
pub(super) fn line(source: &str, at: usize) -> &str {
    let at = at.min(source.len());
    let start = source[..at].rfind('\n').map_or(0, |end| end + 1);
    let end = source[at..].find('\n').map_or(source.len(), |end| at + end);
    &source[start..end]
}

/// The end of the statement that starts at a byte: after its `;` or its last `}`, and after its `else`.
pub(super) fn statement_end(source: &str, start: usize) -> Option<usize> {
    let mut scanner = Scanner {
        bytes: source.as_bytes(),
        at: start,
    };
    scanner.statement()?;
    Some(scanner.at)
}

/// The start of the body of the `if` or loop at a byte.
pub(super) fn body(source: &str, start: usize) -> Option<usize> {
    let mut scanner = Scanner {
        bytes: source.as_bytes(),
        at: start + source[start..].find('(')?,
    };
    scanner.bracket(b'(', b')')?;
    scanner.skip_blank();
    Some(scanner.at)
}

/// Whether the statement at a byte follows another one or a `{`, rather than being the body of an `if`, an
/// `else` or a loop without braces.
pub(super) fn follows_statement(source: &str, start: usize) -> bool {
    let mut rest = source[..start].trim_end();
    loop {
        if let Some(before) = rest.strip_suffix("*/") {
            rest = before.rfind("/*").map_or("", |at| &before[..at]).trim_end();
            continue;
        }
        let last = rest.rfind('\n').map_or(0, |end| end + 1);
        match rest[last..].find("//") {
            Some(comment) => rest = rest[..last + comment].trim_end(),
            None => break,
        }
    }
    rest.ends_with([';', '{', '}'])
}

struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Scanner<'_> {
    fn statement(&mut self) -> Option<()> {
        self.skip_blank();
        if self.take_word(b"if") {
            self.bracket(b'(', b')')?;
            self.statement()?;
            let end = self.at;
            self.skip_blank();
            if self.take_word(b"else") {
                return self.statement();
            }
            self.at = end;
            return Some(());
        }
        if self.take_word(b"for") || self.take_word(b"while") || self.take_word(b"switch") {
            self.bracket(b'(', b')')?;
            return self.statement();
        }
        if self.take_word(b"do") {
            self.statement()?;
        }
        if *self.bytes.get(self.at)? == b'{' {
            return self.bracket(b'{', b'}');
        }
        loop {
            self.skip_blank();
            let byte = *self.bytes.get(self.at)?;
            self.at += 1;
            match byte {
                b';' => return Some(()),
                b'{' | b'}' => return None,
                _ => {}
            }
        }
    }

    /// Skips blanks and comments.
    fn skip_blank(&mut self) {
        loop {
            let rest = &self.bytes[self.at.min(self.bytes.len())..];
            let skipped = match rest {
                [b'/', b'/', ..] => rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len()),
                [b'/', b'*', ..] => rest
                    .windows(2)
                    .skip(2)
                    .position(|pair| pair == b"*/")
                    .map_or(rest.len(), |at| at + 4),
                [byte, ..] if byte.is_ascii_whitespace() => 1,
                _ => return,
            };
            self.at += skipped;
        }
    }

    fn take_word(&mut self, word: &[u8]) -> bool {
        let rest = &self.bytes[self.at.min(self.bytes.len())..];
        let ends =
            |byte: Option<&u8>| !byte.is_some_and(|byte| byte.is_ascii_alphanumeric() || *byte == b'_');
        let found = rest.starts_with(word) && ends(rest.get(word.len()));
        self.at += if found { word.len() } else { 0 };
        found
    }

    /// Skips a bracket with its contents.
    fn bracket(&mut self, open: u8, close: u8) -> Option<()> {
        self.skip_blank();
        let mut depth = 0_u32;
        loop {
            self.skip_blank();
            let byte = *self.bytes.get(self.at)?;
            self.at += 1;
            if byte == open {
                depth += 1;
            } else if byte == close {
                depth = depth.checked_sub(1)?;
            }
            if depth == 0 {
                return (byte == close).then_some(());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_end_after_their_last_part() {
        let end = |text: &str| statement_end(text, 0).map(|end| text[..end].to_owned());
        let whole = |text: &str| assert_eq!(end(&format!("{text} rest();")).as_deref(), Some(text));
        whole("x = f(1, 2);");
        whole("if (a) { b; } else if (c) d; else { e; }");
        whole("if (a /* ) */) b;");
        whole("for (int i = 0; i < 3; i++) { x; // }\n y; }");
        whole("do { x; } while (y);");
        whole("while (x) y;");
        assert_eq!(end("iffy = 1;").as_deref(), Some("iffy = 1;"));
        assert_eq!(end("x = 1"), None);
    }

    #[test]
    fn a_body_without_braces_does_not_follow_a_statement() {
        let follows = |text: &str| follows_statement(text, text.len());
        assert!(follows("{ a; ") && follows("{ // if (x)\n") && follows("} /* ) */ "));
        assert!(!follows("if (x) ") && !follows("else\n    ") && !follows("if (x) // a;\n"));
    }

    #[test]
    fn a_body_follows_the_condition() {
        let text = "if (f(x) > (1)) // why\n  y = 2;";
        assert_eq!(body(text, 0), text.find("y ="));
        assert_eq!(body("if (x", 0), None);
    }

    #[test]
    fn a_line_has_no_end_of_line() {
        assert_eq!(line("ab\ncd\nef", 4), "cd");
        assert_eq!(line("ab", 2), "ab");
    }
}
