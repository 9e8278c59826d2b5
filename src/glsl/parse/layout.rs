//! How the author laid the text out: where lines begin, and how deep they are indented. GLSL does not ask; it tells what was meant where
//! brackets do not.

use toyproof_diagnostic::File;

use crate::token::Token;

/// As wide as most editors show a tab.
const TAB: usize = 4;

/// The text behind the tokens.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout<'a> {
    text: &'a str,
}

impl<'a> Layout<'a> {
    pub(super) fn new(file: &'a File) -> Self {
        Self { text: file.text() }
    }

    /// Whether nothing but blanks stands before the token on its line.
    pub(super) fn begins_line(self, token: Token) -> bool {
        let before = &self.text.as_bytes()[..token.at.span.start as usize];
        let last = before.iter().rev().find(|byte| !matches!(byte, b' ' | b'\t'));
        matches!(last, None | Some(b'\n' | b'\r'))
    }

    /// How far the line is indented that the token stands on.
    pub(super) fn indent(self, token: Token) -> usize {
        let before = &self.text[..token.at.span.start as usize];
        let line = before.rfind('\n').map_or(0, |newline| newline + 1);
        let blanks = self.text[line..]
            .bytes()
            .take_while(|byte| matches!(byte, b' ' | b'\t'));
        blanks.fold(0, |width, byte| {
            if byte == b'\t' {
                width - width % TAB + TAB
            } else {
                width + 1
            }
        })
    }

    /// Whether a line ends between two tokens that follow each other.
    pub(super) fn line_between(self, first: Token, second: Token) -> bool {
        let gap = self
            .text
            .get(first.at.span.end as usize..second.at.span.start as usize);
        gap.is_some_and(|gap| gap.contains('\n'))
    }
}
