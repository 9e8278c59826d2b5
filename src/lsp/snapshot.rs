//! One open document as it is now: what features read.

use std::rc::Rc;

use lsp_types::{ClientCapabilities, Location, Position, Range, Uri};
use toyproof_diagnostic::{File, FileId, Files, Span};
use toyproof_glsl::tree::{Tree, Type};
use toyproof_glsl::{Analysis, Options, ResolvedName};

use crate::encoding::{Encoding, Positions};
use crate::settings::Settings;
use crate::tokens::Tokens;
use crate::unit::{Unit, UnitText};

/// A document with what was found in it.
///
/// The *analyzed* text is what the compiler sees: of a tab, it has Common in front, and included files take
/// the places of their directives. All spans of the tree are in this text. Features take and return its
/// bytes; [`Snapshot::range`] and [`Snapshot::location`] convert them.
#[derive(Debug, Clone)]
pub(crate) struct Snapshot {
    pub(crate) uri: Uri,
    pub(crate) unit: Rc<Unit>,
    /// The index of the text in the unit.
    pub(crate) text: usize,
    /// The document among the files of the unit.
    pub(crate) document: FileId,
    pub(crate) encoding: Encoding,
    pub(crate) settings: Rc<Settings>,
    /// What the client can do.
    pub(crate) client: Rc<ClientCapabilities>,
}

impl Snapshot {
    fn unit_text(&self) -> &UnitText {
        &self.unit.texts[self.text]
    }

    pub(crate) fn files(&self) -> &Files {
        &self.unit.files
    }

    /// The document's own text.
    pub(crate) fn file(&self) -> &File {
        self.files().get(self.document)
    }

    /// The id of the analyzed text.
    pub(crate) fn analyzed(&self) -> FileId {
        self.unit_text().whole
    }

    /// The analyzed text.
    pub(crate) fn analyzed_text(&self) -> &str {
        self.files().get(self.analyzed()).text()
    }

    pub(crate) fn analysis(&self) -> &Analysis {
        &self.unit_text().analysis
    }

    pub(crate) fn tree(&self) -> &Tree {
        self.analysis().tree()
    }

    /// The options with which the text is compiled.
    pub(crate) fn options(&self) -> &Options {
        &self.unit_text().options
    }

    /// The byte of the analyzed text at a position of the document; `None` if the compiler does not see it.
    pub(crate) fn byte(&self, position: Position) -> Option<u32> {
        let byte = self.encoding.byte(self.file(), position);
        self.analyzed_byte(byte)
    }

    /// The bytes of the document that a span of the analyzed text covers; `None` if it is in another file.
    pub(crate) fn in_document(&self, span: Span) -> Option<Span> {
        let origin = self.files().origin(span);
        (origin.file == self.document).then_some(origin)
    }

    /// The byte of the analyzed text that a byte of the document is; `None` if the compiler does not see it.
    pub(crate) fn analyzed_byte(&self, byte: u32) -> Option<u32> {
        self.files().in_joined(self.analyzed(), self.document, byte)
    }

    /// The tokens of the document as they are written.
    pub(crate) fn tokens(&self) -> Tokens<'_> {
        Tokens::new(self.files(), self.document)
    }

    /// The range of a span of the analyzed text in the document; `None` if it is in another file.
    pub(crate) fn range(&self, span: Span) -> Option<Range> {
        let span = self.in_document(span)?;
        Some(self.encoding.range(self.file(), span.start, span.end))
    }

    /// The range of bytes of the document itself.
    pub(crate) fn document_range(&self, start: u32, end: u32) -> Range {
        self.encoding.range(self.file(), start, end)
    }

    /// The built-in types of the version of the text, with their names.
    pub(crate) fn types(&self) -> Vec<(String, Type)> {
        self.analysis().version.types(self.options().lenient)
    }

    /// The keywords of the version of the text.
    pub(crate) fn keywords(&self) -> Vec<&'static str> {
        self.analysis().version.keywords(self.options().lenient)
    }

    /// Converts bytes of the document itself, many of them in order.
    pub(crate) fn positions(&self) -> Positions<'_> {
        Positions::new(self.encoding, self.file())
    }

    /// The file of a span and its range there; `None` for text that is in no file, such as what a host
    /// declares.
    pub(crate) fn location(&self, span: Span) -> Option<Location> {
        let origin = self.files().origin(span);
        let range = self
            .encoding
            .range(self.files().get(origin.file), origin.start, origin.end);
        let uri = self.unit.uris.get(&origin.file)?;
        Some(Location::new(uri.clone(), range))
    }

    /// The resolved name at a byte of the analyzed text, or the one that ends there.
    pub(crate) fn name_at(&self, at: u32) -> Option<&ResolvedName> {
        let covers = |name: &&ResolvedName| {
            let span = name.at.spelling;
            span.file == self.analyzed() && span.start <= at && at <= span.end
        };
        let names = self.analysis().names.iter().filter(covers);
        // Of two adjoining names, that which begins here.
        names.max_by_key(|name| (name.at.spelling.start, name.at.span.start))
    }
}

/// Snapshots of texts in tests: `|` marks the position.
#[cfg(test)]
pub(crate) mod testing {
    use toyproof_diagnostic::File;

    use super::*;
    use crate::unit::Surroundings;

    /// The snapshot of a shader without a file, and the byte of the first `|` of its text, which is removed.
    pub(crate) fn marked(text: &str) -> (Snapshot, u32) {
        let (before, after) = text.split_once('|').expect("a mark");
        (of(&format!("{before}{after}")), before.len() as u32)
    }

    /// The snapshot of a shader without a file.
    pub(crate) fn of(text: &str) -> Snapshot {
        with(text, &Surroundings::default())
    }

    /// The snapshot of a shader that is checked leniently.
    pub(crate) fn lenient(text: &str) -> Snapshot {
        let options = Options {
            lenient: true,
            ..Options::default()
        };
        let surroundings = Surroundings {
            options,
            ..Surroundings::default()
        };
        with(text, &surroundings)
    }

    fn with(text: &str, surroundings: &Surroundings) -> Snapshot {
        let mut unit = Unit::of_shader(&File::new("a.glsl", text), None, surroundings);
        let uri = Uri("untitled:a.glsl".to_owned());
        unit.uris.insert(unit.texts[0].own, uri.clone());
        Snapshot {
            uri,
            document: unit.texts[0].own,
            unit: Rc::new(unit),
            text: 0,
            encoding: Encoding::Utf16,
            settings: Rc::default(),
            client: Rc::default(),
        }
    }
}
