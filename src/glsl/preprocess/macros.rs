//! What macros are, and which are there before the first line.

use std::collections::HashMap;
use std::rc::Rc;

use toyproof_diagnostic::{FileId, Span};

use super::PpToken;
use crate::token::{Symbol, TokenKind};
use crate::tree::Place;
use crate::words::Words;

/// A macro.
#[derive(Debug, Clone)]
pub(super) struct Macro {
    /// The parameters of a function macro; none for an object macro.
    pub(super) parameters: Option<Vec<Symbol>>,
    pub(super) body: Body,
    /// Where its name stands in its definition.
    pub(super) at: Place,
    /// How many of its expansions are being read: while there is one, its name stands for itself.
    pub(super) busy: usize,
    pub(super) predefined: bool,
}

/// What a macro expands to.
#[derive(Debug, Clone)]
pub(super) enum Body {
    /// The tokens of its definition; `parameter[i]` tells which parameter token `i` is.
    Tokens {
        tokens: Rc<[PpToken]>,
        parameter: Rc<[Option<usize>]>,
    },
    /// `__LINE__`.
    Line,
    /// `__FILE__`.
    File,
}

impl Macro {
    pub(super) fn new(parameters: Option<Vec<Symbol>>, body: Body, at: Place) -> Self {
        Self {
            parameters,
            body,
            at,
            busy: 0,
            predefined: false,
        }
    }

    /// What is defined before the first line: by §3.4, and `HW_PERFORMANCE` by `ShaderToy`.
    pub(super) fn predefined(file: FileId, words: &mut Words) -> HashMap<Symbol, Self> {
        let at = Place::plain(Span::new(file, 0, 0));
        let mut number = |text| {
            let token = PpToken {
                kind: TokenKind::Number(words.symbol(text)),
                at,
                spaced: false,
                frozen: false,
            };
            Body::Tokens {
                tokens: [token].into(),
                parameter: [None].into(),
            }
        };
        let (one, version) = (number("1"), number("300"));
        let all = [
            ("__LINE__", Body::Line, true),
            ("__FILE__", Body::File, true),
            ("__VERSION__", version, true),
            ("GL_ES", one.clone(), true),
            ("GL_FRAGMENT_PRECISION_HIGH", one.clone(), true),
            ("HW_PERFORMANCE", one, false),
        ];
        all.into_iter()
            .map(|(name, body, predefined)| {
                let definition = Self {
                    predefined,
                    ..Self::new(None, body, at)
                };
                (words.symbol(name), definition)
            })
            .collect()
    }
}
