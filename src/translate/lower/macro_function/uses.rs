//! The uses of function-like macros in the text, with their arguments and definitions.

use std::cmp::Reverse;

use toyproof_diagnostic::{FileId, Files, Span};
use toyproof_glsl::{Expansions, Lexeme, lexemes};

/// The tokens of the file with the macros.
pub(super) struct Source<'a> {
    files: &'a Files,
    lexemes: Vec<Lexeme>,
}

/// A function-like macro.
pub(super) struct Definition<'a> {
    /// The macro's name in its definition.
    pub(super) name: Span,
    pub(super) parameters: Vec<Span>,
    /// The tokens of the replacement; at least one.
    pub(super) body: &'a [Lexeme],
    /// Their text.
    pub(super) replacement: Span,
}

/// A use of a function-like macro.
pub(super) struct MacroUse<'a> {
    pub(super) span: Span,
    pub(super) definition: Definition<'a>,
    /// The text of the argument for each parameter.
    pub(super) arguments: Vec<Span>,
    /// The smallest use that contains this one.
    pub(super) outer: Option<usize>,
}

impl<'a> Source<'a> {
    pub(super) fn new(files: &'a Files, file: FileId) -> Self {
        Self {
            files,
            lexemes: lexemes(files, file),
        }
    }

    pub(super) fn text(&self, span: Span) -> &'a str {
        self.files.text(span)
    }

    /// The tokens within a span.
    fn tokens(&self, span: Span) -> &[Lexeme] {
        let start = self
            .lexemes
            .partition_point(|token| token.span.start < span.start);
        let end = self.lexemes.partition_point(|token| token.span.end <= span.end);
        &self.lexemes[start..end.max(start)]
    }

    /// The uses of function-like macros outside of other macros' replacements, outer uses before inner ones.
    pub(super) fn uses(&self, expansions: &Expansions) -> Vec<MacroUse<'_>> {
        let spans = expansions.uses().filter(|&span| self.text(span).ends_with(')'));
        let mut uses: Vec<MacroUse> = spans
            .filter_map(|span| {
                let definition = self.definition(expansions.definition_at(span)?)?;
                let arguments = self.arguments(span)?;
                (arguments.len() == definition.parameters.len()).then_some(MacroUse {
                    span,
                    definition,
                    arguments,
                    outer: None,
                })
            })
            .collect();
        uses.sort_by_key(|used| (used.span.start, Reverse(used.span.end)));
        let mut open: Vec<usize> = Vec::new();
        for at in 0..uses.len() {
            while open
                .pop_if(|&mut outer| !contains(uses[outer].span, uses[at].span))
                .is_some()
            {}
            uses[at].outer = open.last().copied();
            open.push(at);
        }
        uses
    }

    /// Reads `NAME(x, y) …` after `#define`.
    fn definition(&self, extent: Span) -> Option<Definition<'_>> {
        let [name, open, rest @ ..] = self.tokens(extent) else {
            return None;
        };
        if self.text(open.span) != "(" || open.span.start != name.span.end {
            return None;
        }
        let close = rest.iter().position(|token| self.text(token.span) == ")")?;
        let parameters = rest[..close].iter().map(|token| token.span);
        let body = &rest[close + 1..];
        Some(Definition {
            name: name.span,
            parameters: parameters.filter(|&span| self.text(span) != ",").collect(),
            body,
            replacement: body.first()?.span.to(body.last()?.span),
        })
    }

    /// The texts of the arguments of a use, none of which is empty.
    fn arguments(&self, used: Span) -> Option<Vec<Span>> {
        let [_, _, inner @ .., _] = self.tokens(used) else {
            return None;
        };
        let mut arguments = Vec::new();
        let mut argument: Option<Span> = None;
        let mut depth = 0_usize;
        for token in inner {
            match self.text(token.span) {
                "(" => depth += 1,
                ")" => depth = depth.checked_sub(1)?,
                "," if depth == 0 => {
                    arguments.push(argument.take()?);
                    continue;
                }
                _ => {}
            }
            argument = Some(argument.map_or(token.span, |begun| begun.to(token.span)));
        }
        arguments.extend(argument);
        Some(arguments)
    }

    /// A span without the parentheses around it.
    pub(super) fn without_parentheses(&self, mut span: Span) -> Span {
        while let [open, .., close] = self.tokens(span)
            && self.text(open.span) == "("
            && self.text(close.span) == ")"
            && let [_, inner @ .., _] = self.tokens(span)
            && let [first, .., last] | [first @ last] = inner
        {
            span = first.span.to(last.span);
        }
        span
    }
}

pub(super) fn contains(outer: Span, inner: Span) -> bool {
    outer.file == inner.file && outer.start <= inner.start && inner.end <= outer.end
}
