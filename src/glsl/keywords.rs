//! Keywords, reserved words and type names, and the interned texts of tokens.

use std::collections::HashMap;

use crate::token::{Symbol, named};
use crate::tree::{Sampler, SamplerShape, Scalar, Type};

named! {
    /// The keywords that are not type names (§3.7).
    Keyword {
        Const "const",
        Uniform "uniform",
        Layout "layout",
        Centroid "centroid",
        Flat "flat",
        Smooth "smooth",
        Break "break",
        Continue "continue",
        Do "do",
        For "for",
        While "while",
        Switch "switch",
        Case "case",
        Default "default",
        If "if",
        Else "else",
        In "in",
        Out "out",
        InOut "inout",
        True "true",
        False "false",
        Invariant "invariant",
        Discard "discard",
        Return "return",
        Struct "struct",
        Precision "precision",
        Highp "highp",
        Mediump "mediump",
        Lowp "lowp",
    }
}

/// The words that §3.7 reserves.
const RESERVED: &str = "attribute varying coherent volatile restrict readonly writeonly resource atomic_uint \
    noperspective patch sample subroutine common partition active asm class union enum typedef template this \
    goto inline noinline public static extern external interface long short double half fixed unsigned superp \
    input output hvec2 hvec3 hvec4 dvec2 dvec3 dvec4 fvec2 fvec3 fvec4 sampler3DRect filter image1D image2D \
    image3D imageCube iimage1D iimage2D iimage3D iimageCube uimage1D uimage2D uimage3D uimageCube image1DArray \
    image2DArray iimage1DArray iimage2DArray uimage1DArray uimage2DArray image1DShadow image2DShadow \
    image1DArrayShadow image2DArrayShadow imageBuffer iimageBuffer uimageBuffer sizeof cast namespace using \
    sampler1D sampler1DShadow sampler1DArray sampler1DArrayShadow isampler1D isampler1DArray usampler1D \
    usampler1DArray sampler2DRect sampler2DRectShadow isampler2DRect usampler2DRect samplerBuffer \
    isamplerBuffer usamplerBuffer sampler2DMS isampler2DMS usampler2DMS sampler2DMSArray isampler2DMSArray \
    usampler2DMSArray";

/// The lexical class of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Word {
    /// A keyword that is not a type name.
    Keyword(Keyword),
    /// The name of a built-in type.
    Type(Type),
    /// A reserved word.
    Reserved,
    /// Any other word: an identifier.
    Name,
}

/// Interned texts of tokens, so that tokens are small and words compare as numbers.
#[derive(Debug)]
pub(crate) struct Interner {
    symbols: HashMap<Box<str>, Symbol>,
    texts: Vec<(Box<str>, Word)>,
}

impl Default for Interner {
    fn default() -> Self {
        let mut interner = Self {
            symbols: HashMap::new(),
            texts: Vec::new(),
        };
        for &keyword in Keyword::ALL {
            interner.add(keyword.text(), Word::Keyword(keyword));
        }
        for (name, ty) in built_in_types() {
            interner.add(&name, Word::Type(ty));
        }
        for reserved in RESERVED.split_whitespace() {
            interner.add(reserved, Word::Reserved);
        }
        interner
    }
}

impl Interner {
    /// Interns a text.
    pub(crate) fn symbol(&mut self, text: &str) -> Symbol {
        match self.symbols.get(text) {
            Some(&symbol) => symbol,
            None => self.add(text, Word::Name),
        }
    }

    /// The symbol of a text that is already interned.
    pub(crate) fn find(&self, text: &str) -> Option<Symbol> {
        self.symbols.get(text).copied()
    }

    pub(crate) fn text(&self, symbol: Symbol) -> &str {
        &self.texts[symbol.0 as usize].0
    }

    /// The lexical class of a symbol's text.
    pub(crate) fn word(&self, symbol: Symbol) -> Word {
        self.texts[symbol.0 as usize].1
    }

    /// The names of the built-in types.
    pub(crate) fn types(&self) -> impl Iterator<Item = &str> {
        self.texts.iter().filter_map(|entry| match entry {
            (text, Word::Type(_)) => Some(&**text),
            _ => None,
        })
    }

    fn add(&mut self, text: &str, word: Word) -> Symbol {
        let symbol = Symbol(self.texts.len() as u32);
        self.texts.push((text.into(), word));
        self.symbols.insert(text.into(), symbol);
        symbol
    }
}

/// The built-in types with their names (§4.1).
fn built_in_types() -> Vec<(String, Type)> {
    let mut types = vec![("void".to_owned(), Type::Void)];
    for scalar in [Scalar::Bool, Scalar::Int, Scalar::Uint, Scalar::Float] {
        types.push((scalar.name().to_owned(), Type::Scalar(scalar)));
        types.extend((2..=4).map(|n| {
            (
                format!("{}vec{n}", scalar.vector_prefix()),
                Type::Vector(scalar, n),
            )
        }));
    }
    for columns in 2..=4 {
        types.push((
            format!("mat{columns}"),
            Type::Matrix {
                columns,
                rows: columns,
            },
        ));
        types.extend((2..=4).map(|rows| (format!("mat{columns}x{rows}"), Type::Matrix { columns, rows })));
    }
    let shapes = [
        SamplerShape::D2,
        SamplerShape::D3,
        SamplerShape::Cube,
        SamplerShape::D2Array,
    ];
    let texels = [Scalar::Float, Scalar::Int, Scalar::Uint];
    let plain = shapes
        .iter()
        .flat_map(|&shape| texels.map(|texel| (texel, shape, false)));
    let shadow = [SamplerShape::D2, SamplerShape::Cube, SamplerShape::D2Array];
    let samplers = plain.chain(shadow.map(|shape| (Scalar::Float, shape, true)));
    types.extend(samplers.map(|(texel, shape, shadow)| {
        let sampler = Sampler { texel, shape, shadow };
        (sampler.name(), Type::Sampler(sampler))
    }));
    types
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_classified() {
        let mut interner = Interner::default();
        let mut word = |text| {
            let symbol = interner.symbol(text);
            interner.word(symbol)
        };
        assert_eq!(word("while"), Word::Keyword(Keyword::While));
        assert_eq!(word("bvec2"), Word::Type(Type::Vector(Scalar::Bool, 2)));
        assert_eq!(word("mat2x3"), Word::Type(Type::Matrix { columns: 2, rows: 3 }));
        assert!(matches!(word("usampler2DArray"), Word::Type(Type::Sampler(_))));
        assert_eq!(word("goto"), Word::Reserved);
        assert_eq!(word("sphere"), Word::Name);
    }
}
