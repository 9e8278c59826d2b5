//! JSON (RFC 8259): a parser whose values keep their places, and a writer.

use std::fmt::Write;

use toyproof_diagnostic::{Code, Diagnostic, FileId, Files, Span, grouped};

use crate::node::{Member, Node, Value};

/// The maximum nesting depth; ShaderToy's JSON has seven levels.
const MAX_NESTING: usize = 64;

/// The maximum number of keys of an object; ShaderToy's JSON has at most 14.
const MAX_KEYS: usize = 256;

/// The maximum number of values of a text; ShaderToy's JSON has a few hundred.
const MAX_VALUES: usize = 100_000;

/// Parses a text.
///
/// # Errors
/// The first error of the syntax, or a key that an object has twice.
pub(crate) fn parse(files: &Files, file: FileId) -> Result<Node, Box<Diagnostic>> {
    parse_with(files, file, false)
}

/// Parses a text in which the last of several values of a key may count, as in most other parsers.
///
/// # Errors
/// The first error of the syntax.
pub(crate) fn parse_lenient(files: &Files, file: FileId) -> Result<Node, Box<Diagnostic>> {
    parse_with(files, file, true)
}

fn parse_with(files: &Files, file: FileId, is_lenient: bool) -> Result<Node, Box<Diagnostic>> {
    let text = files.get(file).text();
    let mut parser = Parser {
        text,
        file,
        at: 0,
        depth: 0,
        values: 0,
        is_lenient,
    };
    let node = parser.value()?;
    parser.skip_blanks();
    if parser.at < text.len() {
        return Err(parser.error("unexpected text after the end of the JSON", "remove it"));
    }
    Ok(node)
}

struct Parser<'t> {
    text: &'t str,
    file: FileId,
    /// The next byte.
    at: usize,
    depth: usize,
    /// The number of values so far.
    values: usize,
    /// Whether a key may have several values, of which the last counts.
    is_lenient: bool,
}

type ParseResult<T> = Result<T, Box<Diagnostic>>;

impl Parser<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn eat(&mut self, byte: u8) -> bool {
        let here = self.peek() == Some(byte);
        self.at += usize::from(here);
        here
    }

    fn skip_blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    fn span_from(&self, start: usize) -> Span {
        Span::new(self.file, start as u32, self.at as u32)
    }

    /// An error about the next character.
    fn error(&self, message: &str, help: &str) -> Box<Diagnostic> {
        let next = self.text[self.at..].chars().next();
        let end = self.at + next.map_or(0, char::len_utf8);
        let span = Span::new(self.file, self.at as u32, end as u32);
        let error = Diagnostic::new(Code::ProjectSyntax, message).at(span);
        Box::new(if next.is_none() {
            error.help("the file seems to be cut off; save it again")
        } else if help.is_empty() {
            error
        } else {
            error.help(help)
        })
    }

    fn value(&mut self) -> ParseResult<Node> {
        self.skip_blanks();
        if self.values == MAX_VALUES {
            let message = format!("more than {} values", grouped(MAX_VALUES as u64));
            return Err(self.error(&message, "ShaderToy's JSON has a few hundred"));
        }
        self.values += 1;
        let start = self.at;
        let value = match self.peek() {
            Some(b'{') => self.nested(Self::object)?,
            Some(b'[') => self.nested(Self::array)?,
            Some(b'"') => Value::String(self.string()?),
            Some(b'-' | b'0'..=b'9') => Value::Number(self.number()?),
            _ => self.word()?,
        };
        Ok(Node {
            value,
            span: Some(self.span_from(start)),
        })
    }

    fn nested(&mut self, read: impl FnOnce(&mut Self) -> ParseResult<Value>) -> ParseResult<Value> {
        if self.depth == MAX_NESTING {
            let message = format!("JSON nested more than {MAX_NESTING} levels deep");
            return Err(self.error(&message, "ShaderToy's JSON has seven levels"));
        }
        self.depth += 1;
        self.at += 1;
        let value = read(self);
        self.depth -= 1;
        value
    }

    fn object(&mut self) -> ParseResult<Value> {
        let mut members: Vec<Member> = Vec::new();
        self.skip_blanks();
        if self.eat(b'}') {
            return Ok(Value::Object(members));
        }
        loop {
            self.skip_blanks();
            let start = self.at;
            if self.peek() != Some(b'"') {
                return Err(self.error("expected a key in double quotes", "write `\"key\": value`"));
            }
            let key = self.string()?;
            let earlier = members.iter().position(|member| member.key == key);
            if let Some(earlier) = earlier.filter(|_| self.is_lenient) {
                members.remove(earlier);
            } else if earlier.is_some() {
                let error = Diagnostic::new(Code::ProjectSyntax, format!("duplicate key `{key}`"));
                return Err(error
                    .at(self.span_from(start))
                    .help("remove one of the two")
                    .into());
            }
            if members.len() == MAX_KEYS {
                let message = format!("an object with more than {MAX_KEYS} keys");
                return Err(self.error(&message, "ShaderToy's JSON has at most 14"));
            }
            self.skip_blanks();
            if !self.eat(b':') {
                return Err(self.error("expected `:` after a key", "write `\"key\": value`"));
            }
            let node = self.value()?;
            members.push(Member { key, node });
            self.skip_blanks();
            if self.eat(b'}') {
                return Ok(Value::Object(members));
            }
            if !self.eat(b',') {
                return Err(self.error("expected `,` or `}` in an object", ""));
            }
        }
    }

    fn array(&mut self) -> ParseResult<Value> {
        let mut nodes = Vec::new();
        self.skip_blanks();
        if self.eat(b']') {
            return Ok(Value::Array(nodes));
        }
        loop {
            nodes.push(self.value()?);
            self.skip_blanks();
            if self.eat(b']') {
                return Ok(Value::Array(nodes));
            }
            if !self.eat(b',') {
                return Err(self.error("expected `,` or `]` in a list", ""));
            }
        }
    }

    fn word(&mut self) -> ParseResult<Value> {
        for (word, value) in [
            ("null", Value::Null),
            ("true", Value::Bool(true)),
            ("false", Value::Bool(false)),
        ] {
            if self.text[self.at..].starts_with(word) {
                self.at += word.len();
                return Ok(value);
            }
        }
        Err(self.error("expected a JSON value", ""))
    }

    fn digits(&mut self) -> ParseResult<()> {
        if !self.peek().is_some_and(|byte| byte.is_ascii_digit()) {
            return Err(self.error("expected a digit", ""));
        }
        while self.peek().is_some_and(|byte| byte.is_ascii_digit()) {
            self.at += 1;
        }
        Ok(())
    }

    fn number(&mut self) -> ParseResult<String> {
        let start = self.at;
        self.eat(b'-');
        if !self.eat(b'0') {
            self.digits()?;
        }
        if self.eat(b'.') {
            self.digits()?;
        }
        if self.eat(b'e') || self.eat(b'E') {
            let _ = self.eat(b'+') || self.eat(b'-');
            self.digits()?;
        }
        Ok(self.text[start..self.at].to_owned())
    }

    fn string(&mut self) -> ParseResult<String> {
        self.at += 1;
        let mut text = String::new();
        loop {
            let rest = &self.text[self.at..];
            let plain = rest.find(|c| matches!(c, '"' | '\\' | '\0'..='\x1f'));
            let plain = plain.unwrap_or(rest.len());
            text.push_str(&rest[..plain]);
            self.at += plain;
            match self.peek() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(text);
                }
                Some(b'\\') => text.push(self.escape()?),
                Some(_) => {
                    let help = "write a line feed as `\\n` and a tab as `\\t`";
                    return Err(self.error("control character in a string", help));
                }
                None => return Err(self.error("missing `\"` at the end of a string", "")),
            }
        }
    }

    /// Reads an escape sequence; a surrogate pair is one character.
    fn escape(&mut self) -> ParseResult<char> {
        let start = self.at;
        self.at += 1;
        let byte = self.peek();
        self.at += usize::from(byte.is_some_and(|byte| byte.is_ascii()));
        Ok(match byte {
            Some(b'"') => '"',
            Some(b'\\') => '\\',
            Some(b'/') => '/',
            Some(b'b') => '\x08',
            Some(b'f') => '\x0c',
            Some(b'n') => '\n',
            Some(b'r') => '\r',
            Some(b't') => '\t',
            Some(b'u') => {
                let first = self.code_unit();
                let units = first.into_iter().chain(match first {
                    Some(0xd800..0xdc00) if self.text[self.at..].starts_with("\\u") => {
                        self.at += 2;
                        self.code_unit()
                    }
                    _ => None,
                });
                let Some(Ok(c)) = char::decode_utf16(units).next() else {
                    let message = "an escape sequence that is not a character";
                    let error = Diagnostic::new(Code::ProjectSyntax, message).at(self.span_from(start));
                    return Err(error
                        .help("write four hexadecimal digits, or the character itself")
                        .into());
                };
                c
            }
            _ => {
                self.at = start;
                return Err(self.error("unknown escape sequence", "write `\\\\` for a backslash"));
            }
        })
    }

    /// Reads four hexadecimal digits.
    fn code_unit(&mut self) -> Option<u16> {
        let digits = self.text.get(self.at..self.at + 4)?;
        let unit = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
        let unit = unit.then(|| u16::from_str_radix(digits, 16).ok()).flatten()?;
        self.at += 4;
        Some(unit)
    }
}

/// Formats a value with a line for each member and element.
pub(crate) fn write(node: &Node) -> String {
    let mut text = String::new();
    write_node(&mut text, node, 1);
    text.push('\n');
    text
}

/// Formats a value on one line.
pub(crate) fn write_compact(node: &Node) -> String {
    let mut text = String::new();
    write_node(&mut text, node, 0);
    text
}

/// Appends a value; `depth` counts from 1, and is 0 for a value on one line.
fn write_node(text: &mut String, node: &Node, depth: usize) {
    match &node.value {
        Value::Null => text.push_str("null"),
        Value::Bool(value) => text.push_str(if *value { "true" } else { "false" }),
        Value::Number(number) => text.push_str(number),
        Value::String(string) => write_string(text, string),
        Value::Array(nodes) => {
            write_list(text, ['[', ']'], depth, nodes, |text, node, depth| {
                write_node(text, node, depth);
            });
        }
        Value::Object(members) => {
            write_list(text, ['{', '}'], depth, members, |text, member, depth| {
                write_string(text, &member.key);
                text.push_str(": ");
                write_node(text, &member.node, depth);
            });
        }
    }
}

fn write_list<T>(
    text: &mut String,
    [open, close]: [char; 2],
    depth: usize,
    items: &[T],
    write_item: impl Fn(&mut String, &T, usize),
) {
    let new_line = |text: &mut String, depth: usize| {
        text.push('\n');
        text.extend(std::iter::repeat_n("  ", depth));
    };
    let inner = if depth == 0 { 0 } else { depth + 1 };
    text.push(open);
    for (index, item) in items.iter().enumerate() {
        if index > 0 {
            text.push(',');
        }
        if depth > 0 {
            new_line(text, depth);
        } else if index > 0 {
            text.push(' ');
        }
        write_item(text, item, inner);
    }
    if depth > 0 && !items.is_empty() {
        new_line(text, depth - 1);
    }
    text.push(close);
}

fn write_string(text: &mut String, string: &str) {
    text.push('"');
    for c in string.chars() {
        match c {
            '"' | '\\' => text.extend(['\\', c]),
            '\n' => text.push_str("\\n"),
            '\r' => text.push_str("\\r"),
            '\t' => text.push_str("\\t"),
            // Writing to a string does not fail.
            c if c.is_control() => drop(write!(text, "\\u{:04x}", u32::from(c))),
            c => text.push(c),
        }
    }
    text.push('"');
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use toyproof_diagnostic::{File, short};

    use super::*;

    fn parsed(text: &str) -> Result<Node, String> {
        let mut files = Files::default();
        let file = files.add(File::new("x.json", text));
        parse(&files, file).map_err(|error| short(&error, &files))
    }

    #[test]
    fn values_keep_their_order_their_digits_and_their_characters() {
        let text = r#"{"b": 1.50, "a": [true, null, -0, 1e+300], "\u00e9": "\ud83d\ude00\u0000\"\\\/\n"}"#;
        let node = parsed(text).unwrap();
        assert_eq!(
            write_compact(&node),
            r#"{"b": 1.50, "a": [true, null, -0, 1e+300], "é": "😀\u0000\"\\/\n"}"#
        );
        assert_eq!(parsed(&write(&node)).unwrap(), node);
        assert_eq!(
            write(&parsed("{\"a\":[1,{}]}").unwrap()),
            "{\n  \"a\": [\n    1,\n    {}\n  ]\n}\n"
        );
    }

    #[test]
    fn errors_have_a_line_and_a_column() {
        for (text, expected) in [
            ("", "1:1: error[E0507]: expected a JSON value"),
            ("{\n \"a\" 1}", "2:6: error[E0507]: expected `:` after a key"),
            (
                "{\"a\": 1,}",
                "1:9: error[E0507]: expected a key in double quotes",
            ),
            ("{\"a\": 1, \"a\": 2}", "1:10: error[E0507]: duplicate key `a`"),
            ("[1 2]", "1:4: error[E0507]: expected `,` or `]` in a list"),
            ("[01]", "1:3: error[E0507]: expected `,` or `]` in a list"),
            ("[1.]", "1:4: error[E0507]: expected a digit"),
            ("\"a\nb\"", "1:3: error[E0507]: control character in a string"),
            (
                "\"\\ud800\"",
                "1:2: error[E0507]: an escape sequence that is not a character",
            ),
            ("\"\\x\"", "1:2: error[E0507]: unknown escape sequence"),
            ("\"a", "1:3: error[E0507]: missing `\"` at the end of a string"),
            (
                "{} {}",
                "1:4: error[E0507]: unexpected text after the end of the JSON",
            ),
            ("nul", "1:1: error[E0507]: expected a JSON value"),
        ] {
            assert_eq!(parsed(text).unwrap_err(), format!("x.json:{expected}"), "{text}");
        }
        let deep = parsed(&"[".repeat(1 << 20)).unwrap_err();
        assert_eq!(
            deep,
            "x.json:1:65: error[E0507]: JSON nested more than 64 levels deep"
        );
    }

    proptest! {
        #[test]
        fn no_text_panics_and_what_is_valid_is_what_serde_json_reads(text in "[\\[\\]{}\",:0-9eE.+\\-\\\\ua-f \n]{0,40}") {
            let ours = parsed(&text);
            let theirs = serde_json::from_str::<serde_json::Value>(&text);
            match (ours, theirs) {
                (Ok(ours), Ok(theirs)) => {
                    let again: serde_json::Value = serde_json::from_str(&write(&ours)).unwrap();
                    prop_assert_eq!(again, theirs);
                }
                (Err(error), Ok(_)) => prop_assert!(error.contains("duplicate key"), "{}: {}", text, error),
                (Ok(_), Err(error)) => prop_assert!(error.to_string().contains("out of range"), "{}: {}", text, error),
                (Err(_), Err(_)) => {}
            }
        }
    }
}
