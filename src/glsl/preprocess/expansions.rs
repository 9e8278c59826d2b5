//! Where macros are defined and used: diagnostics name the macro in whose expansion they are.

use std::collections::HashMap;

use toyproof_diagnostic::{Diagnostic, Files, IN_MACRO, Span};

use super::PpToken;

/// The macros of a text, and their uses.
#[derive(Debug, Clone, Default)]
pub struct Expansions {
    /// In the order of the text.
    definitions: Vec<Definition>,
    /// The index of the outermost macro that was used at a span.
    uses: HashMap<Span, usize>,
}

/// One `#define`.
#[derive(Debug, Clone)]
struct Definition {
    name: String,
    /// The span from the macro's name to the end of the replacement.
    extent: Span,
}

impl Expansions {
    /// Adds a definition, and returns its index. `body` is the rest of its line.
    pub(super) fn define(&mut self, name: &str, at: Span, body: &[PpToken]) -> usize {
        self.definitions.push(Definition {
            name: name.to_owned(),
            extent: body.last().map_or(at, |last| at.to(last.at.span)),
        });
        self.definitions.len() - 1
    }

    /// Adds a use. Uses at one span are nested; the first is the outermost.
    pub(super) fn add_use(&mut self, definition: usize, at: Span) {
        self.uses.entry(at).or_insert(definition);
    }

    /// The spans at which macros are used, in any order.
    pub fn uses(&self) -> impl Iterator<Item = Span> + '_ {
        self.uses.keys().copied()
    }

    /// The definition of the outermost macro that is used at a span, from its name to the end of the
    /// replacement.
    pub fn definition_at(&self, used: Span) -> Option<Span> {
        self.uses
            .get(&used)
            .map(|&definition| self.definitions[definition].extent)
    }

    /// The macro that a diagnostic concerns: the one that contains its text, or else the one that is used at
    /// its place, such as where an operator of the macro joins an argument with text of the macro.
    fn definition(&self, diagnostic: &Diagnostic) -> Option<&Definition> {
        let in_macro = diagnostic
            .related
            .iter()
            .find(|(_, text)| text.starts_with(IN_MACRO));
        let Some((spelling, _)) = in_macro else {
            return self.definitions.get(*self.uses.get(&diagnostic.span?)?);
        };
        let after = self
            .definitions
            .partition_point(|definition| definition.extent.start <= spelling.start);
        let definition = &self.definitions[after.checked_sub(1)?];
        (spelling.end <= definition.extent.end).then_some(definition)
    }

    /// The diagnostic with the name of the macro in whose expansion it is, and with the file and the line of
    /// its definition.
    pub fn named(&self, mut diagnostic: Diagnostic, files: &Files) -> Diagnostic {
        let Some(definition) = self.definition(&diagnostic) else {
            return diagnostic;
        };
        let note = format!(
            "in the expansion of the macro `{}`, defined at {}:{}",
            definition.name,
            files.name(definition.extent),
            files.position(definition.extent).line
        );
        if !diagnostic.notes.contains(&note) {
            diagnostic.notes.insert(0, note);
        }
        diagnostic
    }
}
