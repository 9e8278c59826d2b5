//! The rewrites that are tried, by kind. Each kind is a function of the text; it knows nothing of the fault.

mod constant;
mod declarations;
mod expressions;
mod functions;
pub(crate) mod layout;
mod statements;
mod tokens;
mod variables;

use toyproof_glsl::tree::Tree;
use toyproof_glsl::{self as glsl, Checked};

use crate::outline::{Outline, file};
use crate::rewrite::Rewrite;

/// A text with its outline, and its tree if it compiles.
pub(crate) struct Source<'a> {
    pub(crate) outline: Outline<'a>,
    pub(crate) checked: Option<Checked>,
}

impl<'a> Source<'a> {
    pub(crate) fn new(text: &'a str, options: &glsl::Options) -> Self {
        let (files, file) = file(text);
        Self {
            outline: Outline::new(text),
            checked: glsl::check(&files, file, options).ok(),
        }
    }

    fn tree(&self) -> Option<&Tree> {
        self.checked.as_ref().map(|checked| &checked.tree)
    }
}

/// A kind of rewrites.
pub(crate) struct Kind {
    pub(crate) generator: Generator,
    /// Whether many rewrites may succeed together, so that halves of all of them are tried first.
    pub(crate) is_joint: bool,
}

/// Makes rewrites of a text.
pub(crate) enum Generator {
    /// All of a kind.
    All(fn(&Source) -> Vec<Rewrite>),
    /// Those at a level of nesting from 0; `None` beyond the last one.
    Level(fn(&Source, usize) -> Option<Vec<Rewrite>>),
}

impl Kind {
    const fn all(rewrites: fn(&Source) -> Vec<Rewrite>) -> Self {
        Self {
            generator: Generator::All(rewrites),
            is_joint: true,
        }
    }

    const fn levels(rewrites: fn(&Source, usize) -> Option<Vec<Rewrite>>) -> Self {
        Self {
            generator: Generator::Level(rewrites),
            is_joint: true,
        }
    }

    const fn single(rewrites: fn(&Source) -> Vec<Rewrite>) -> Self {
        Self {
            generator: Generator::All(rewrites),
            is_joint: false,
        }
    }

    /// The rewrites of a text at a level; `None` beyond the last one.
    pub(crate) fn rewrites(&self, source: &Source, level: usize) -> Option<Vec<Rewrite>> {
        match self.generator {
            Generator::All(rewrites) => (level == 0).then(|| rewrites(source)),
            Generator::Level(rewrites) => rewrites(source, level).filter(|_| level < MAX_LEVELS),
        }
    }
}

/// The largest number of levels of statements and of expressions: deeper ones are reached in a later round.
const MAX_LEVELS: usize = 24;

/// All kinds, in the order in which they are tried: what deletes most comes first.
pub(crate) const KINDS: &[Kind] = &[
    Kind::all(declarations::conditions),
    Kind::all(declarations::unreachable),
    Kind::all(functions::stubs),
    Kind::all(declarations::unreachable),
    Kind::all(declarations::all),
    Kind::levels(statements::deleted),
    Kind::levels(statements::unwrapped),
    Kind::all(variables::constant),
    Kind::levels(expressions::zero),
    Kind::levels(expressions::operands),
    Kind::all(functions::without_parameters),
    Kind::all(functions::without_results),
    Kind::all(functions::inlined),
    Kind::all(variables::inlined),
    Kind::all(declarations::macros),
    Kind::levels(expressions::one),
    Kind::all(expressions::short_numbers),
    Kind::single(tokens::deleted),
];
