//! Lookups of textures for ISF, whose hosts replace `IMG_NORM_PIXEL(image, at)` and the like in the text: the
//! image is named in the lookup itself, and has neither mipmaps nor texels that are fetched.

use std::collections::{BTreeSet, HashMap};

use toyproof_diagnostic::{Code, Diagnostic, Span};

use super::Port;
use crate::dialect::{Dialect, InputValue};
use crate::port::names::Known;
use crate::token::Punctuator;
use crate::tree::{BuiltIn, Place};

/// The names that hosts of ISF declare.
pub(super) const ISF_NAMES: [&str; 13] = [
    "TIME",
    "TIMEDELTA",
    "DATE",
    "FRAMEINDEX",
    "PASSINDEX",
    "RENDERSIZE",
    "isf_FragNormCoord",
    "IMG_NORM_PIXEL",
    "IMG_PIXEL",
    "IMG_SIZE",
    "IMG_THIS_PIXEL",
    "mouse",
    "mouseDown",
];

/// A bias of the level of detail from which on the largest level is read, whatever the derivatives.
const LARGEST_LEVEL_BIAS: f64 = -16.0;

/// The lookups of a text for ISF.
#[derive(Debug, Default)]
pub(super) struct Lookups {
    /// By the index of the function's name: the text in its place, and the index of the token after it.
    names: HashMap<usize, (String, usize)>,
    /// The channels of which texels are fetched.
    pub(super) fetched: BTreeSet<u8>,
}

impl Port<'_> {
    /// Whether the text is written for ISF.
    pub(super) fn is_for_isf(&self) -> bool {
        self.to == Dialect::Isf
    }

    /// Determines how each lookup is written.
    ///
    /// # Errors
    /// ISF has no such lookup.
    pub(super) fn find_lookups(&mut self) -> Result<(), Box<Diagnostic>> {
        for index in 0..self.source.len() {
            if self.source.symbol(index).is_none() || self.is_member(index) {
                continue;
            }
            if self.is_lookup(index) {
                self.lookup(index)?;
            } else if self.channel(index).is_some()
                && !(index > 1
                    && self.source.is(index - 1, Punctuator::LeftParen)
                    && self.is_lookup(index - 2))
                && !self.is_declared_at(index)
            {
                let name = self.source.token_text(index);
                let what = format!("`{name}` outside of a lookup");
                return Err(self.without_equivalent(&what, index));
            }
        }
        Ok(())
    }

    fn is_declared_at(&self, index: usize) -> bool {
        let known = self.known.get(self.source.token_text(index));
        known.is_some_and(|(id, _)| self.is_declaration_of(*id, index))
    }

    /// The channel that a token names.
    fn channel(&self, index: usize) -> Option<u8> {
        match self.known.get(self.source.token_text(index)) {
            Some((_, Known::Input(InputValue::Texture(channel)))) => Some(*channel),
            _ => None,
        }
    }

    /// Whether a token is the name of a built-in function of textures in a call of it.
    fn is_lookup(&self, index: usize) -> bool {
        let name = self.source.token_text(index);
        let is_old = name.starts_with("texture2D");
        let is_built_in = is_old || BuiltIn::named(name).is_some_and(BuiltIn::is_texture);
        let is_own = self.own_calls.contains(&self.source.span(index).start);
        is_built_in && !is_own && self.source.is(index + 1, Punctuator::LeftParen)
    }

    fn lookup(&mut self, index: usize) -> Result<(), Box<Diagnostic>> {
        let source = self.source;
        let name = source.token_text(index);
        let Some(channel) = self.channel(index + 2) else {
            return Err(
                self.without_equivalent(&format!("`{name}` of a texture that a parameter names"), index)
            );
        };
        let Some(close) = source.partner(index + 1) else {
            return Err(self.without_equivalent(&format!("`{name}` with these arguments"), index));
        };
        let commas = self.commas(index + 2, close);
        let last = commas.last().copied().unwrap_or(close);
        let level = self.literal(last + 1, close);
        let is_largest = match (name, commas.len()) {
            ("texture" | "texture2D", 1) => true,
            ("texture" | "texture2D", 2) => {
                level.is_some_and(|bias| bias == 0.0 || bias <= LARGEST_LEVEL_BIAS)
            }
            ("textureLod" | "texture2DLod" | "texture2DLodEXT" | "texelFetch", 2) | ("textureSize", 1) => {
                level == Some(0.0)
            }
            _ => false,
        };
        if !is_largest {
            let what = format!("`{name}` that reads mipmaps, or is neither `texture` nor `texelFetch`,");
            return Err(self.without_equivalent(&what, index));
        }
        // The level of detail is left out.
        let end = source.span(close);
        if !(commas.len() == 1 && name.starts_with("texture") && name != "textureSize") {
            let level = Span::new(end.file, source.span(last).start, end.start);
            self.edits.push((level, String::new()));
        }
        let (text, next) = match name {
            "texelFetch" => {
                self.fetched_channel(channel);
                let image = Span::new(
                    end.file,
                    source.span(index + 2).start,
                    source.span(index + 4).start,
                );
                self.edits.push((image, String::new()));
                (format!("iChannel{channel}Texel"), index + 4)
            }
            "textureSize" => {
                self.edits
                    .push((Span::new(end.file, end.end, end.end), ")".to_owned()));
                ("ivec2(IMG_SIZE".to_owned(), index + 1)
            }
            _ => ("IMG_NORM_PIXEL".to_owned(), index + 1),
        };
        self.lookups.names.insert(index, (text, next));
        Ok(())
    }

    fn fetched_channel(&mut self, channel: u8) {
        self.lookups.fetched.insert(channel);
    }

    /// Edits the name of a lookup; returns the index after what is edited, if the token is one.
    pub(super) fn edit_lookup(&mut self, index: usize) -> Option<usize> {
        let (text, next) = self.lookups.names.get(&index)?.clone();
        self.edits.push((self.source.span(index), text));
        Some(next)
    }

    /// The commas between the arguments of a call, whose tokens are these.
    fn commas(&self, first: usize, close: usize) -> Vec<usize> {
        let mut depth = 0_usize;
        let mut commas = Vec::new();
        for index in first..close {
            match self.source.punctuator(index) {
                Some(Punctuator::LeftParen | Punctuator::LeftBracket) => depth += 1,
                Some(Punctuator::RightParen | Punctuator::RightBracket) => depth = depth.saturating_sub(1),
                Some(Punctuator::Comma) if depth == 0 => commas.push(index),
                _ => {}
            }
        }
        commas
    }

    /// The value of an argument that is a number.
    fn literal(&self, first: usize, close: usize) -> Option<f64> {
        let text: String = (first..close)
            .map(|index| self.source.token_text(index))
            .collect();
        text.trim_end_matches(['f', 'F']).parse().ok()
    }

    /// The functions that the lookups of texels call.
    pub(super) fn texel_functions(&self) -> String {
        let function = |channel: &u8| {
            format!(
                "// A texel, which is zero outside of the image.\n\
                 vec4 iChannel{channel}Texel(ivec2 at) {{\n    \
                 vec2 center = vec2(at) + 0.5;\n    \
                 bool isInside = center == clamp(center, vec2(0.0), IMG_SIZE(iChannel{channel}));\n    \
                 return isInside ? IMG_PIXEL(iChannel{channel}, center) : vec4(0.0);\n}}\n\n"
            )
        };
        self.lookups.fetched.iter().map(function).collect()
    }

    fn without_equivalent(&self, what: &str, index: usize) -> Box<Diagnostic> {
        let at = Place::plain(self.source.span(index));
        let error = Code::UnsupportedByTarget.at(at, format!("{what} has no equivalent in ISF"));
        Box::new(error.help("an image is read by `texture(iChannel0, …)` or `texelFetch(iChannel0, …, 0)`"))
    }
}
