//! Keywords, reserved words and type names, and the interned texts of tokens.

use std::collections::HashMap;

use crate::dialect::{Language, Version};
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
        Varying "varying",
        Attribute "attribute",
    }
}

/// The words that §3.7 reserves.
const RESERVED: &str = "coherent volatile restrict readonly writeonly resource atomic_uint \
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

/// The keywords and types of GLSL ES 3.00 that are names in GLSL ES 1.00 (§3.7 there), and those that it
/// reserves.
const NOT_IN_ES_100: &str = "layout centroid smooth case uint uvec2 uvec3 uvec4 mat2x2 mat2x3 mat2x4 mat3x2 mat3x3 \
    mat3x4 mat4x2 mat4x3 mat4x4 sampler2DArray isampler2D isampler3D isamplerCube isampler2DArray usampler2D \
    usampler3D usamplerCube usampler2DArray samplerCubeShadow sampler2DArrayShadow";
const RESERVED_IN_ES_100: &str = "asm class union enum typedef template this packed goto switch default inline \
    noinline volatile public static extern external interface flat long short double half fixed unsigned superp \
    input output hvec2 hvec3 hvec4 dvec2 dvec3 dvec4 fvec2 fvec3 fvec4 sampler1D sampler3D sampler1DShadow \
    sampler2DShadow sampler2DRect sampler3DRect sampler2DRectShadow sizeof cast namespace using";

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
    /// The words of GLSL ES 3.00.
    fn default() -> Self {
        Self::new(Language {
            version: Version::Es300,
            is_lenient: false,
        })
    }
}

impl Interner {
    /// The words of a version. Those of desktop GLSL are nearly those of GLSL ES 3.00.
    /// If lenient, GLSL ES 1.00 has the keywords and types of GLSL ES 3.00, too.
    pub(crate) fn new(Language { version, is_lenient }: Language) -> Self {
        let mut interner = Self {
            symbols: HashMap::new(),
            texts: Vec::new(),
        };
        let lists = |words: &str, word: &str| words.split_whitespace().any(|listed| listed == word);
        let class = |word: &str, class| match version {
            _ if is_lenient => class,
            Version::Es100 if lists(NOT_IN_ES_100, word) => Word::Name,
            Version::Desktop(_) if !version.has_integer_operations() && word.starts_with("uvec") => {
                Word::Name
            }
            Version::Desktop(_) if !version.has_integer_operations() && matches!(word, "uint" | "case") => {
                Word::Name
            }
            Version::Desktop(_)
                if !version.has_integer_operations() && matches!(word, "switch" | "default") =>
            {
                Word::Reserved
            }
            Version::Es100 if lists(RESERVED_IN_ES_100, word) => Word::Reserved,
            _ => class,
        };
        for &keyword in Keyword::ALL {
            let is_old = matches!(keyword, Keyword::Varying | Keyword::Attribute);
            let word = if is_old && !version.has_old_names() {
                Word::Reserved
            } else {
                Word::Keyword(keyword)
            };
            interner.add(keyword.text(), class(keyword.text(), word));
        }
        for (name, ty) in built_in_types() {
            interner.add(&name, class(&name, Word::Type(ty)));
        }
        let reserved = if version == Version::Es100 && !is_lenient {
            RESERVED_IN_ES_100
        } else {
            RESERVED
        };
        for word in reserved.split_whitespace() {
            let is_name = version.has_name_sample() && matches!(word, "sample" | "patch");
            if !is_name && interner.find(word).is_none() {
                interner.add(word, Word::Reserved);
            }
        }
        interner
    }

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
