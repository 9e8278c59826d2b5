//! Positions of the protocol: lines from 0, and columns in units of UTF-16 or UTF-8, as client and server
//! agreed.

use lsp_types::{Position, PositionEncodingKind, Range, TextDocumentContentChangeEvent};
use toyproof_diagnostic::File;

/// The unit of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Encoding {
    /// Bytes.
    Utf8,
    /// What every client supports.
    #[default]
    Utf16,
}

impl Encoding {
    /// The encoding of a client that offers these: bytes, if it can.
    pub(crate) fn negotiated(offered: &[PositionEncodingKind]) -> Self {
        if offered.contains(&PositionEncodingKind::UTF8) {
            Self::Utf8
        } else {
            Self::Utf16
        }
    }

    pub(crate) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
        }
    }

    /// The length of a text in units.
    pub(crate) fn length(self, text: &str) -> u32 {
        let length = match self {
            Self::Utf8 => text.len(),
            Self::Utf16 => text.chars().map(char::len_utf16).sum(),
        };
        length as u32
    }

    /// The position of a byte; bytes past the end count as the end, those inside a character as its start.
    pub(crate) fn position(self, file: &File, byte: u32) -> Position {
        let mut byte = (byte as usize).min(file.text().len());
        while !file.text().is_char_boundary(byte) {
            byte -= 1;
        }
        let line = file.line(byte);
        let start = file.line_range(line).map_or(0, |range| range.start);
        Position::new(line as u32, self.length(&file.text()[start..byte]))
    }

    /// The positions of bytes `start..end`.
    pub(crate) fn range(self, file: &File, start: u32, end: u32) -> Range {
        Range::new(self.position(file, start), self.position(file, end))
    }

    /// The byte at a position. A column past the end of its line counts as the end of the line, a line past
    /// the end of the text as the end of the text, and a column inside a character as its start.
    pub(crate) fn byte(self, file: &File, position: Position) -> u32 {
        let Some(range) = file.line_range(position.line as usize) else {
            return file.text().len() as u32;
        };
        let line = file.text()[range.clone()].trim_end_matches(['\r', '\n']);
        let mut units = 0;
        for (at, character) in line.char_indices() {
            units += self.length(character.encode_utf8(&mut [0; 4]));
            if units > position.character {
                return (range.start + at) as u32;
            }
        }
        (range.start + line.len()) as u32
    }

    /// Applies the changes of a notification in their order, and returns the new text.
    pub(crate) fn changed(self, file: &File, changes: Vec<TextDocumentContentChangeEvent>) -> File {
        let mut file = file.clone();
        for change in changes {
            let text = match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(whole) => whole.text,
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(part) => {
                    let start = self.byte(&file, part.range.start) as usize;
                    let end = self.byte(&file, part.range.end) as usize;
                    let mut text = file.text().to_owned();
                    text.replace_range(start..end.max(start), &part.text);
                    text
                }
            };
            file = File::new(file.name(), text);
        }
        file
    }
}

/// Converts bytes of one file, in time proportional to the text between them if they are in order.
#[derive(Debug)]
pub(crate) struct Positions<'f> {
    encoding: Encoding,
    file: &'f File,
    /// The last byte that was converted, and its position.
    last: (u32, Position),
}

impl<'f> Positions<'f> {
    pub(crate) fn new(encoding: Encoding, file: &'f File) -> Self {
        Self {
            encoding,
            file,
            last: (0, Position::new(0, 0)),
        }
    }

    /// The position of a byte, see [`Encoding::position`].
    pub(crate) fn at(&mut self, byte: u32) -> Position {
        let (before, position) = self.last;
        let is_same_line = self.file.line(byte as usize) == position.line as usize;
        let between = self.file.text().get(before as usize..byte as usize);
        let next = match between.filter(|_| is_same_line) {
            Some(between) => {
                let character = position.character + self.encoding.length(between);
                Position::new(position.line, character)
            }
            None => self.encoding.position(self.file, byte),
        };
        self.last = (byte, next);
        next
    }

    /// The positions of bytes `start..end`.
    pub(crate) fn range(&mut self, start: u32, end: u32) -> Range {
        let start = self.at(start);
        Range::new(start, self.at(end))
    }
}

#[cfg(test)]
mod tests {
    use lsp_types::TextDocumentContentChangePartial;

    use super::*;

    #[test]
    fn columns_count_units_of_the_encoding() {
        let file = File::new("a", "a😀b\r\né\rx\n");
        let at = |needle: char| file.text().find(needle).unwrap() as u32;
        let both = |needle| [Encoding::Utf8, Encoding::Utf16].map(|one| one.position(&file, at(needle)));
        assert_eq!(both('b'), [Position::new(0, 5), Position::new(0, 3)]);
        assert_eq!(both('x'), [Position::new(2, 0), Position::new(2, 0)]);
        for encoding in [Encoding::Utf8, Encoding::Utf16] {
            for (byte, _) in file.text().char_indices() {
                let position = encoding.position(&file, byte as u32);
                let is_end = file.text()[byte..].starts_with(['\r', '\n']);
                assert!(is_end || encoding.byte(&file, position) == byte as u32, "{byte}");
            }
        }
    }

    #[test]
    fn positions_in_any_order_are_those_of_each_byte() {
        let file = File::new("a", "a😀b\r\né\rx\n\nlast 😀 line");
        let end = file.text().len() as u32;
        let all: Vec<u32> = (0..=end + 2)
            .chain((0..end).rev())
            .chain([3, 30, 4, 9, 9])
            .collect();
        let mut positions = Positions::new(Encoding::Utf16, &file);
        for byte in all {
            assert_eq!(
                positions.at(byte),
                Encoding::Utf16.position(&file, byte),
                "{byte}"
            );
        }
    }

    #[test]
    fn positions_outside_of_the_text_are_its_ends() {
        let file = File::new("a", "ab\r\n😀");
        let byte = |line, column| Encoding::Utf16.byte(&file, Position::new(line, column));
        assert_eq!([byte(0, 9), byte(1, 1), byte(1, 9), byte(7, 0)], [2, 4, 8, 8]);
    }

    #[test]
    fn changes_apply_in_their_order() {
        let change = |start: (u32, u32), end: (u32, u32), text: &str| {
            let range = Range::new(Position::new(start.0, start.1), Position::new(end.0, end.1));
            TextDocumentContentChangePartial::new(range, None, text.to_owned()).into()
        };
        let file = File::new("a", "one\ntwo\n");
        let changes = vec![
            change((0, 3), (1, 0), ""),
            change((0, 0), (0, 3), "😀"),
            change((0, 2), (0, 2), "-"),
        ];
        assert_eq!(Encoding::Utf16.changed(&file, changes).text(), "😀-two\n");
    }
}
