//! Errors in the syntax of TOML.

use std::ops::Range;

use toyproof_diagnostic::{Code, Diagnostic, FileId, Span};

/// Returns the diagnostic for an error of the TOML parser.
pub fn diagnostic(code: Code, error: &toml::de::Error, text: &str, file: FileId) -> Diagnostic {
    let bytes = error.span().unwrap_or_default();
    let bytes = bytes.start.min(text.len())..bytes.end.min(text.len());
    let SyntaxError { bytes, message, help } = Site::new(text, bytes).explain(error.message());
    let diagnostic = Diagnostic::new(code, message).at(Span::new(file, bytes.start as u32, bytes.end as u32));
    if help.is_empty() {
        diagnostic
    } else {
        diagnostic.help(help)
    }
}

/// An error, where it is, and advice, which may be empty.
struct SyntaxError {
    bytes: Range<usize>,
    message: String,
    help: String,
}

impl SyntaxError {
    fn new(bytes: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            bytes,
            message: message.into(),
            help: help.into(),
        }
    }
}

/// Where an error is.
struct Site<'t> {
    text: &'t str,
    /// The range that the parser marks.
    bytes: Range<usize>,
    /// The line with the mark, without white space around it.
    line: Range<usize>,
}

/// The characters that precede each item of a value.
const SEPARATORS: [char; 5] = ['=', ',', '[', '{', '('];

impl<'t> Site<'t> {
    fn new(text: &'t str, bytes: Range<usize>) -> Self {
        // An error at the end of a line is about this line.
        let start = text[..bytes.start].rfind('\n').map_or(0, |at| at + 1);
        let end = text[bytes.start..]
            .find('\n')
            .map_or(text.len(), |at| bytes.start + at);
        let line = &text[start..end];
        let indent = line.len() - line.trim_start().len();
        let end = end.max(start + indent) - (line.len() - line.trim_end().len()).min(line.len() - indent);
        Self {
            text,
            bytes,
            line: start + indent..end,
        }
    }

    fn line(&self) -> &'t str {
        &self.text[self.line.clone()]
    }

    /// The word around the mark.
    fn word(&self) -> Range<usize> {
        let is_end = |c: char| c.is_whitespace() || SEPARATORS.contains(&c) || "]})#".contains(c);
        let start = self.text[..self.bytes.start].rfind(is_end);
        let start = start.map_or(0, |at| {
            at + self.text[at..].chars().next().map_or(1, char::len_utf8)
        });
        let end = self.text[self.bytes.start..].find(is_end);
        start..end.map_or(self.text.len(), |at| self.bytes.start + at)
    }

    fn explain(self, message: &str) -> SyntaxError {
        let bytes = self.bytes.clone();
        let at = |message, help| SyntaxError::new(bytes.clone(), message, help);
        let line = self.line();
        let key = line.split(['=', ':', ' ']).next().unwrap_or_default();
        let reason = message.split(", expected").next().unwrap_or_default();
        match reason {
            "string values must be quoted" => self.unquoted(),
            "key with no value" if line.starts_with("//") || line.starts_with("/*") => {
                let help = "start a comment with `#`";
                SyntaxError::new(self.line.clone(), "unknown form of comment", help)
            }
            "key with no value" | "missing assignment between key-value pairs" => {
                let colon = line.contains(':').then_some("write `=` instead of `:`");
                let help = colon.unwrap_or("write `key = value`");
                SyntaxError::new(self.line.clone(), format!("missing `=` after `{key}`"), help)
            }
            "unexpected key or value" => self.trailing(),
            "duplicate key" => self.duplicate(),
            "unclosed table" => at("missing `]` at the end of a table header", "write `[name]`"),
            "unclosed array table" => at("missing `]]` at the end of a table header", "write `[[name]]`"),
            "unclosed array" | "missing comma between array elements" => at(
                "missing `,` or `]` in a list",
                "write a list as `[1.0, 2.0, 3.0]`",
            ),
            "unclosed inline table"
            | "missing comma between key-value pairs"
            | "extra assignment between key-value pairs" => at(
                "missing `,` or `}` in an inline table",
                "write an inline table as `{ key = value, key = value }`",
            ),
            "extra comma in array" | "extra comma in inline table" => {
                at("unexpected `,`", "remove the comma, or write a value before it")
            }
            "extra `=`" | "unexpected `=` in array" => at("unexpected `=`", "remove it"),
            "invalid basic string" | "invalid multi-line basic string" | "multi-line basic string" => at(
                "missing `\"` at the end of a string",
                "end the string on the same line",
            ),
            "invalid literal string" | "invalid multi-line literal string" => at(
                "missing `'` at the end of a string",
                "end the string on the same line",
            ),
            "missing escaped value" => at(
                "unknown escape sequence in a string",
                "write `\\\\` for a backslash",
            ),
            "unquoted keys cannot be empty" if line.starts_with('[') => {
                at("missing name in a table header", "write `[name]`")
            }
            "unquoted keys cannot be empty"
            | "invalid key-value pair"
            | "missing key for inline table element" => at("expected a key", "write `key = value`"),
            "invalid boolean" => self.word_error("is not a value", "write `true` or `false` in lower case"),
            "invalid mantissa" | "invalid fraction" => self.word_error(
                "is not a number",
                "write digits before and after the decimal point",
            ),
            "unexpected leading zero" => self.word_error("is not a number", "remove the leading zeros"),
            "invalid float"
            | "invalid exponent"
            | "redundant numeric sign"
            | "`_` may only go between digits" => self.not_a_number(),
            reason if reason.starts_with("cannot recurse") => at(
                "lists and tables are nested too deeply",
                "write them without nesting",
            ),
            "missing array opening" | "missing inline table opening" | "missing table open" => {
                at("unmatched closing bracket", "remove it")
            }
            _ => SyntaxError::new(bytes, format!("invalid TOML: {message}"), ""),
        }
    }

    /// A key or a table is given twice.
    fn duplicate(self) -> SyntaxError {
        let name = &self.text[self.bytes.clone()];
        let (message, help) = if self.line().starts_with("[[") {
            (
                format!("[[{name}]] conflicts with an earlier `{name}`"),
                format!("write every table of this name as `[[{name}]]`"),
            )
        } else if self.line().starts_with('[') {
            (
                format!("[{name}] is given twice"),
                format!("for a list of tables, write `[[{name}]]` each time; otherwise merge the two"),
            )
        } else {
            (
                format!("`{name}` is given twice"),
                "remove one of the two".to_owned(),
            )
        };
        SyntaxError::new(self.bytes, message, help)
    }

    /// The word around the mark is wrong.
    fn word_error(&self, what: &str, help: &str) -> SyntaxError {
        let word = self.word();
        let message = format!("`{}` {what}", &self.text[word.clone()]);
        SyntaxError::new(word, message, help)
    }

    fn not_a_number(&self) -> SyntaxError {
        let word = &self.text[self.word()];
        if word.ends_with(';') {
            self.word_error("is not a number", "remove the `;`")
        } else if word.starts_with(char::is_alphabetic) {
            self.word_error(
                "is not a value",
                "write a number, a string in quotes, `true` or `false`",
            )
        } else {
            self.word_error("is not a number", "write numbers as `1.0` or `1e-3`")
        }
    }

    /// A value is missing, or is a word without quotes.
    fn unquoted(&self) -> SyntaxError {
        let written = self.text[self.bytes.clone()].trim();
        let bytes = self.bytes.clone();
        let bare = written.trim_matches(['“', '”', '„', '‘', '’', '`']);
        if written.is_empty() {
            let help = "write a value after `=`, such as `1.0` or `\"text\"`";
            SyntaxError::new(bytes, "missing value", help)
        } else if written.len() > bare.len() {
            let help = format!("write straight quotes: `\"{bare}\"`");
            SyntaxError::new(bytes, format!("`{written}` is not in straight quotes"), help)
        } else if written.contains(' ') {
            let help = "write a list as `[1.0, 2.0, 3.0]`";
            SyntaxError::new(bytes, "missing `,` in a list", help)
        } else if written.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
            self.not_a_number()
        } else {
            let help = format!("write `\"{written}\"`");
            SyntaxError::new(bytes, format!("`{written}` is not in quotes"), help)
        }
    }

    /// Something follows a value or a header.
    fn trailing(&self) -> SyntaxError {
        let end = self.line.end.max(self.bytes.start);
        let rest = self.bytes.start..end;
        let line = self.line();
        let value = line.split_once('=').map_or("", |(_, value)| value.trim());
        let help = if line.starts_with('[') {
            "start a new line after the header".to_owned()
        } else if value.starts_with('(') {
            format!(
                "write a list in square brackets: `[{}]`",
                value.trim_matches(['(', ')'])
            )
        } else if value.matches(',').count() == 1 && value.replace(',', "").parse::<f64>().is_ok() {
            format!("write decimals with a point: `{}`", value.replace(',', "."))
        } else if value.contains(',') && !value.contains(['=', '[', '{']) {
            format!("write a list in square brackets: `[{value}]`")
        } else {
            "write each key on a line of its own".to_owned()
        };
        let place = if line.starts_with('[') {
            "a table header"
        } else {
            "a value"
        };
        SyntaxError::new(rest, format!("unexpected text after {place}"), help)
    }
}
