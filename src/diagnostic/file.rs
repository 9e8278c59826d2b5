//! Source files, byte spans, places through macros, and the mapping from bytes to lines and columns.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::text::{mask_controls, printable};

/// The id of a file in [`Files`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct FileId(u16);

/// A named text with an index of its lines.
#[derive(Debug, Clone)]
pub struct File {
    name: String,
    text: String,
    /// The text with control characters masked, if it contains any.
    display_text: Option<String>,
    line_starts: Vec<usize>,
    /// The parts of a joined file, in order.
    parts: Vec<Part>,
}

/// A part of a joined file.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// The byte of the joined file at which it starts.
    start: u32,
    /// The bytes of another file that it consists of.
    source: Span,
}

/// A position: line and column from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl File {
    /// Makes a file. `name` is used in messages (a path as the user typed it, or `<stdin>`); its control
    /// characters are escaped.
    pub fn new(name: impl AsRef<str>, text: impl Into<String>) -> Self {
        let text = text.into();
        // Lines end in LF, CR LF, or CR alone (GLSL ES 3.00.6 §3.1).
        let bytes = text.as_bytes();
        let is_end = |at: &usize| match bytes[*at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        let line_starts = std::iter::once(0)
            .chain((0..bytes.len()).filter(is_end).map(|at| at + 1))
            .collect();
        Self {
            name: printable(name.as_ref()).into_owned(),
            display_text: mask_controls(&text),
            text,
            line_starts,
            parts: Vec::new(),
        }
    }

    /// The name shown in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The line and column of a byte; bytes past the end count as the end.
    pub fn position(&self, byte: usize) -> Position {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        let line = self.line(byte);
        let start = self.line_starts[line];
        Position {
            line: line + 1,
            column: self.text[start..byte].chars().count() + 1,
        }
    }

    /// The length in bytes of the longest line that overlaps bytes `start..end`.
    pub fn longest_line(&self, start: u32, end: u32) -> usize {
        let line = |byte: u32| self.position(byte as usize).line - 1;
        (line(start)..=line(end))
            .filter_map(|index| self.line_range(index))
            .map(|range| range.len())
            .max()
            .unwrap_or(0)
    }

    /// The index of the line, from 0, in which a byte is; bytes past the end are in the last line.
    pub fn line(&self, byte: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= byte) - 1
    }

    /// The bytes of a line by its index from 0, with its line ending; `None` after the last line.
    pub fn line_range(&self, index: usize) -> Option<Range<usize>> {
        let start = *self.line_starts.get(index)?;
        let end = self
            .line_starts
            .get(index + 1)
            .copied()
            .unwrap_or(self.text.len());
        Some(start..end)
    }
}

/// The files of one command.
#[derive(Debug, Clone, Default)]
pub struct Files {
    files: Vec<File>,
}

impl Files {
    /// Adds a file and returns its id.
    ///
    /// # Panics
    /// On the 65,537th file: each shader or scene has its own `Files`.
    pub fn add(&mut self, file: File) -> FileId {
        let id = u16::try_from(self.files.len()).expect("fewer than 65,537 files in one shader");
        self.files.push(file);
        FileId(id)
    }

    /// Replaces the text of a file. Files that were joined from it before keep the old one.
    pub fn replace(&mut self, id: FileId, text: impl Into<String>) {
        let file = &mut self.files[usize::from(id.0)];
        *file = File::new(&file.name, text);
    }

    /// Whether there is more than one file.
    pub fn is_several(&self) -> bool {
        self.files.len() > 1
    }

    /// Adds a file that consists of others, each beginning on a new line. Spans in it are reported as spans
    /// of those files.
    pub fn join(&mut self, name: impl AsRef<str>, parts: &[FileId]) -> FileId {
        let whole = |&file: &FileId| Span::new(file, 0, self.get(file).text().len() as u32);
        let sources: Vec<Span> = parts.iter().map(whole).collect();
        self.join_parts(name, &sources, "\n")
    }

    /// Adds a file that consists of parts of others, with a separator between them. Spans in it are reported
    /// as spans of those files.
    pub fn join_parts(&mut self, name: impl AsRef<str>, sources: &[Span], separator: &str) -> FileId {
        let mut text = String::new();
        let mut parts = Vec::with_capacity(sources.len());
        for &source in sources {
            if !parts.is_empty() {
                text += separator;
            }
            let start = text.len() as u32;
            parts.push(Part { start, source });
            text += self.text(source);
        }
        let mut file = File::new(name, text);
        file.parts = parts;
        self.add(file)
    }

    /// The span in the file of the user: for a span in a joined file, the one in the part where it starts, up
    /// to the end of that part.
    pub fn origin(&self, span: Span) -> Span {
        let parts = &self.get(span.file).parts;
        let after = parts.partition_point(|part| part.start <= span.start);
        let Some(Part { start, source }) = after.checked_sub(1).and_then(|at| parts.get(at)) else {
            return span;
        };
        let within = |byte: u32| (source.start + (byte - start)).min(source.end);
        // A part may come from a joined file, too.
        self.origin(Span::new(source.file, within(span.start), within(span.end)))
    }

    /// The byte of a joined file at which a byte of another file first is: the inverse of
    /// [`origin`](Self::origin). `None` if the joined file does not have that byte.
    pub fn in_joined(&self, joined: FileId, file: FileId, byte: u32) -> Option<u32> {
        if joined == file {
            return Some(byte);
        }
        self.get(joined).parts.iter().find_map(|Part { start, source }| {
            let inner = self.in_joined(source.file, file, byte)?;
            (source.start..=source.end)
                .contains(&inner)
                .then(|| start + (inner - source.start))
        })
    }

    /// The files that a joined file consists of, directly or not; a file that is not joined is its own only
    /// part.
    pub fn parts(&self, joined: FileId) -> Vec<FileId> {
        let parts = &self.get(joined).parts;
        if parts.is_empty() {
            return vec![joined];
        }
        let mut found = Vec::new();
        for part in parts {
            for file in self.parts(part.source.file) {
                if !found.contains(&file) {
                    found.push(file);
                }
            }
        }
        found
    }

    /// The name of the file that a span is in.
    pub fn name(&self, span: Span) -> &str {
        self.get(self.origin(span).file).name()
    }

    /// The file with that id.
    pub fn get(&self, id: FileId) -> &File {
        &self.files[usize::from(id.0)]
    }

    /// The position at which a span begins.
    pub fn position(&self, span: Span) -> Position {
        let span = self.origin(span);
        self.get(span.file).position(span.start as usize)
    }

    /// The position after the last character of a span.
    pub fn end_position(&self, span: Span) -> Position {
        let span = self.origin(span);
        self.get(span.file).position(span.end as usize)
    }

    /// The text that a span covers.
    pub fn text(&self, span: Span) -> &str {
        &self.get(span.file).text()[span.start as usize..span.end as usize]
    }
}

/// The file database of codespan-reporting.
impl<'a> codespan_reporting::files::Files<'a> for Files {
    type FileId = FileId;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: FileId) -> Result<&'a str, codespan_reporting::files::Error> {
        Ok(self.get(id).name())
    }

    fn source(&'a self, id: FileId) -> Result<&'a str, codespan_reporting::files::Error> {
        let file = self.get(id);
        Ok(file.display_text.as_deref().unwrap_or(&file.text))
    }

    fn line_index(&'a self, id: FileId, byte: usize) -> Result<usize, codespan_reporting::files::Error> {
        Ok(self.get(id).position(byte).line - 1)
    }

    fn line_range(
        &'a self,
        id: FileId,
        index: usize,
    ) -> Result<Range<usize>, codespan_reporting::files::Error> {
        let file = self.get(id);
        file.line_range(index)
            .ok_or(codespan_reporting::files::Error::LineTooLarge {
                given: index,
                max: file.line_starts.len() - 1,
            })
    }
}

// Spans.

/// Bytes `start..end` of one file; always on character boundaries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// The first byte.
    pub start: u32,
    /// One past the last byte; equal to `start` for a point between two characters.
    pub end: u32,
}

impl Span {
    /// Bytes `start..end` of `file`.
    pub fn new(file: FileId, start: u32, end: u32) -> Self {
        debug_assert!(start <= end);
        Self { file, start, end }
    }

    /// Whether the spans overlap or adjoin.
    pub fn touches(self, other: Self) -> bool {
        self.file == other.file && self.start <= other.end && other.start <= self.end
    }

    /// The smallest span that covers both; `other` if they are of different files.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        if self.file != other.file {
            return other;
        }
        Self {
            file: self.file,
            start: self.start.min(other.start),
            end: self.end.max(other.end),
        }
    }
}

/// The place of a token or node in the source text: where it is used and where its characters are.
///
/// The two differ for text from a macro's body: then `span` is the use of the outermost macro (`F(x)` in the
/// file) and `spelling` is in the body of a `#define`. For macro arguments, which are text of the file, they
/// are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// The span in the file outside macro bodies, which diagnostics use for line numbers.
    pub span: Span,
    /// The span of the characters.
    pub spelling: Span,
}

impl Place {
    /// Makes a place of text outside of any macro.
    pub fn plain(span: Span) -> Self {
        Self { span, spelling: span }
    }

    /// The place from `self` to `other`. If it does not lie within one macro expansion, `spelling` is the
    /// same as `span`.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        let span = self.span.to(other.span);
        let spelling = if self.span == other.span && self.is_expanded() && other.is_expanded() {
            self.spelling.to(other.spelling)
        } else {
            span
        };
        Self { span, spelling }
    }

    /// Whether the characters are in the body of a macro.
    pub fn is_expanded(self) -> bool {
        self.span != self.spelling
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let file = File::new("a", "ab\né€x\n");
        let at = |needle: &str| file.position(file.text().find(needle).unwrap());
        assert_eq!(at("a"), Position { line: 1, column: 1 });
        assert_eq!(at("\n"), Position { line: 1, column: 3 });
        assert_eq!(at("€"), Position { line: 2, column: 2 });
        assert_eq!(at("x"), Position { line: 2, column: 3 });
        assert_eq!(file.position(usize::MAX), Position { line: 3, column: 1 });
    }

    #[test]
    fn all_line_endings_are_recognized() {
        let file = File::new("a", "a\r\nb\rc\n\rd");
        let lines: Vec<_> = ["a", "b", "c", "d"]
            .iter()
            .map(|needle| file.position(file.text().find(needle).unwrap()))
            .map(|place| (place.line, place.column))
            .collect();
        assert_eq!(lines, [(1, 1), (2, 1), (3, 1), (5, 1)]);
    }

    #[test]
    fn spans_in_a_joined_file_are_those_of_its_parts() {
        let mut files = Files::default();
        let [first, second] =
            [("first", "a\nbc"), ("second", "d\ne")].map(|(name, text)| files.add(File::new(name, text)));
        let joined = files.join("joined", &[first, second]);
        assert_eq!(files.get(joined).text(), "a\nbc\nd\ne");
        let at = |needle: &str| files.get(joined).text().find(needle).unwrap() as u32;
        let c = Span::new(joined, at("c"), at("c") + 1);
        assert_eq!((files.origin(c), files.text(c)), (Span::new(first, 3, 4), "c"));
        assert_eq!(files.position(c), Position { line: 2, column: 2 });
        let e = Span::new(joined, at("e"), at("e") + 1);
        assert_eq!((files.name(e), files.position(e).line), ("second", 2));
        let across = Span::new(joined, at("b"), at("e"));
        assert_eq!(files.origin(across), Span::new(first, 2, 4));
        assert_eq!(files.end_position(across), Position { line: 2, column: 3 });
        let nested = files.join_parts("nested", &[Span::new(joined, 2, 6), Span::new(first, 0, 1)], "");
        assert_eq!(files.get(nested).text(), "bc\nda");
        assert_eq!(files.origin(Span::new(nested, 0, 2)), Span::new(first, 2, 4));
        assert_eq!(files.origin(Span::new(nested, 3, 4)), Span::new(second, 0, 1));
        assert_eq!(files.origin(Span::new(nested, 4, 5)), Span::new(first, 0, 1));
        let inverse = |file, byte| files.in_joined(nested, file, byte);
        assert_eq!([inverse(first, 2), inverse(second, 0)], [Some(0), Some(3)]);
        assert_eq!([inverse(first, 0), inverse(second, 3)], [Some(4), None]);
        assert_eq!(files.parts(nested), [first, second]);
        let empty = files.join("empty", &[]);
        assert_eq!(files.origin(Span::new(empty, 0, 0)), Span::new(empty, 0, 0));
    }

    #[test]
    fn a_byte_inside_a_character_has_its_position() {
        let file = File::new("a", "€");
        assert_eq!(file.position(2), Position { line: 1, column: 1 });
    }
}
