//! Where macros are defined and used: diagnostics name the macro in whose expansion they are.

use std::collections::HashMap;

use toyproof_diagnostic::{Diagnostic, Files, IN_MACRO, Span};

use super::PpToken;

/// What the preprocessor did with a text: the macros and their uses, and what conditions skip.
#[derive(Debug, Clone, Default)]
pub struct Expansions {
    /// In the order of the text.
    definitions: Vec<MacroDefinition>,
    /// The index of the outermost macro that was used at a span.
    uses: HashMap<Span, usize>,
    /// The text that conditions skip, in order.
    skipped: Vec<Span>,
    /// Whether the last token was skipped.
    is_skipping: bool,
}

/// One `#define`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MacroDefinition {
    /// The name.
    pub name: String,
    /// The span of the name.
    pub at: Span,
    /// The span from the macro's name to the end of the replacement.
    pub extent: Span,
    /// The names of its parameters; `None` if it is used without parentheses.
    pub parameters: Option<Vec<String>>,
}

impl Expansions {
    /// Adds a definition, and returns its index. `body` is the rest of its line.
    pub(super) fn define(
        &mut self,
        name: &str,
        at: Span,
        parameters: Option<Vec<String>>,
        body: &[PpToken],
    ) -> usize {
        self.definitions.push(MacroDefinition {
            name: name.to_owned(),
            at,
            extent: body.last().map_or(at, |last| at.to(last.at.span)),
            parameters,
        });
        self.definitions.len() - 1
    }

    /// Adds a use. Uses at one span are nested; the first is the outermost.
    pub(super) fn add_use(&mut self, definition: usize, at: Span) {
        self.uses.entry(at).or_insert(definition);
    }

    /// Adds a token that a condition skips.
    pub(super) fn skip(&mut self, at: Span) {
        match self.skipped.last_mut() {
            Some(last) if self.is_skipping => *last = last.to(at),
            _ => self.skipped.push(at),
        }
        self.is_skipping = true;
    }

    /// Ends a part of the text that is skipped.
    pub(super) fn end_skipped(&mut self) {
        self.is_skipping = false;
    }

    /// The definitions in the order of the text.
    pub fn definitions(&self) -> &[MacroDefinition] {
        &self.definitions
    }

    /// The last definition of a name in front of a byte. Whether it is undefined again in between is not
    /// considered.
    pub fn definition_before(&self, name: &str, byte: u32) -> Option<&MacroDefinition> {
        let mut before = self.definitions.iter().rev();
        before.find(|definition| definition.at.start <= byte && definition.name == name)
    }

    /// The parts of the text that conditions skip, in order, without the directives.
    pub fn skipped(&self) -> &[Span] {
        &self.skipped
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
    fn definition(&self, diagnostic: &Diagnostic) -> Option<&MacroDefinition> {
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
