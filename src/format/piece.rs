//! The pieces of a text: tokens, comments and whole directives, with the line breaks before them.

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::lexemes;

/// Columns of a tab in the author's text.
const TAB: usize = 4;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A keyword or a name.
    Word,
    Number,
    /// An operator or bracket, or a character that GLSL does not have.
    Punctuator,
    /// From `//` to the end of the line.
    LineComment,
    /// From `/*` to `*/`.
    BlockComment,
    /// From `#` to the end of the line, with its comments.
    Directive,
    /// Lines that are kept as they are.
    Verbatim,
}

/// A part of the text that is written as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Piece<'a> {
    pub(crate) kind: Kind,
    pub(crate) text: &'a str,
    /// The line breaks before it, up to 2: a blank line. At the begin of the text there is one.
    pub(crate) breaks: usize,
    /// The column where a comment that begins or ends a line begins in the author's text, from 0.
    pub(crate) column: usize,
    /// The byte where it begins.
    pub(crate) start: usize,
}

impl Piece<'_> {
    pub(crate) fn is(&self, text: &str) -> bool {
        self.text == text && matches!(self.kind, Kind::Word | Kind::Punctuator)
    }

    pub(crate) fn is_comment(&self) -> bool {
        matches!(self.kind, Kind::LineComment | Kind::BlockComment)
    }

    /// Whether it is a token of the shader's code.
    pub(crate) fn is_token(&self) -> bool {
        matches!(self.kind, Kind::Word | Kind::Number | Kind::Punctuator)
    }

    /// Whether it begins a line in the author's text.
    pub(crate) fn begins_line(&self) -> bool {
        self.breaks > 0
    }
}

/// The pieces of a text, whose lines end with `\n`.
pub(crate) fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut files = Files::default();
    let file = files.add(File::new("", text));
    let lexemes = lexemes(&files, file);
    let mut reader = Reader {
        text,
        at: 0,
        line: 0,
        breaks: 1,
        pieces: Vec::with_capacity(lexemes.len()),
    };
    let mut rest = &lexemes[..];
    while let Some(&first) = rest.first() {
        let start = first.span.start as usize;
        reader.gap(start);
        let of_line = rest.iter().take_while(|lexeme| {
            first.is_in_directive && lexeme.is_in_directive && lexeme.line == first.line
        });
        let count = of_line.count().max(1);
        let mut end = rest[count - 1].span.end as usize;
        let kind = if first.is_in_directive {
            end = directive_end(text, end, rest.get(count).map(|next| next.span.start as usize));
            Kind::Directive
        } else {
            kind(&text[start..end])
        };
        reader.push(kind, start, end);
        rest = &rest[count..];
    }
    reader.gap(text.len());
    reader.pieces
}

fn kind(token: &str) -> Kind {
    match token.as_bytes()[0] {
        b'a'..=b'z' | b'A'..=b'Z' | b'_' => Kind::Word,
        b'0'..=b'9' => Kind::Number,
        b'.' if token.len() > 1 => Kind::Number,
        _ => Kind::Punctuator,
    }
}

/// Where the line of a directive ends, with the comments after its last token; `next` is the next token.
fn directive_end(text: &str, mut end: usize, next: Option<usize>) -> usize {
    let limit = next.unwrap_or(text.len());
    loop {
        let mut rest = &text[end..limit];
        loop {
            let blanks = rest.trim_start_matches([' ', '\t', '\u{b}', '\u{c}']);
            let continued = blanks.strip_prefix("\\\n").unwrap_or(blanks);
            if continued.len() == rest.len() {
                break;
            }
            rest = continued;
        }
        if !rest.starts_with("//") && !rest.starts_with("/*") {
            return end;
        }
        end = limit - rest.len() + comment_length(rest);
    }
}

/// The length of the comment that a text begins with, without the end of its line.
fn comment_length(text: &str) -> usize {
    if let Some(block) = text.strip_prefix("/*") {
        return block.find("*/").map_or(text.len(), |end| end + 4);
    }
    let mut length = 0;
    for line in text.split_inclusive('\n') {
        let content = line.trim_end_matches('\n');
        length += line.len();
        // A line that ends in `\` is continued.
        if !content.ends_with('\\') {
            return length - (line.len() - content.len());
        }
    }
    length
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    /// Where the current line begins.
    line: usize,
    breaks: usize,
    pieces: Vec<Piece<'a>>,
}

impl Reader<'_> {
    /// Reads the comments and line breaks before the token at a byte.
    fn gap(&mut self, to: usize) {
        while self.at < to {
            let rest = &self.text[self.at..to];
            if rest.starts_with("//") || rest.starts_with("/*") {
                let kind = if rest.starts_with("//") {
                    Kind::LineComment
                } else {
                    Kind::BlockComment
                };
                self.push(kind, self.at, self.at + comment_length(rest));
            } else if let Some(continued) = rest.strip_prefix("\\\n") {
                self.at = to - continued.len();
            } else {
                let c = rest.chars().next().expect("the gap is not at its end");
                self.at += c.len_utf8();
                if c == '\n' {
                    self.breaks += 1;
                    self.line = self.at;
                }
            }
        }
    }

    fn push(&mut self, kind: Kind, start: usize, end: usize) {
        // Only these columns are read; finding all would take long in a long line.
        let has_column = kind == Kind::LineComment || kind == Kind::BlockComment && self.breaks > 0;
        let column = if has_column {
            width(&self.text[self.line..start])
        } else {
            0
        };
        let text = &self.text[start..end];
        // Without the blanks behind it, a `\` would continue the line.
        let trimmed = if matches!(kind, Kind::LineComment | Kind::Directive) {
            text.trim_end()
        } else {
            text
        };
        if let Some(newline) = text.rfind('\n') {
            self.line = start + newline + 1;
        }
        self.pieces.push(Piece {
            kind,
            text: if trimmed.ends_with('\\') { text } else { trimmed },
            breaks: self.breaks.min(2),
            column,
            start,
        });
        self.breaks = 0;
        self.at = end;
    }
}

/// The columns of a text of one line.
pub(crate) fn width(text: &str) -> usize {
    text.chars().fold(0, |column, c| match c {
        '\t' => (column / TAB + 1) * TAB,
        _ => column + 1,
    })
}
