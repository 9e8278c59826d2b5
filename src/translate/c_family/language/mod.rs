//! What differs between the languages: types, words and passes. Their built-in functions are in
//! [`super::builtin`].

mod hlsl;
mod msl;

use toyproof_glsl::tree::{Direction, SamplerShape, Scalar, Type};

use super::host::CHost;
use crate::lower::{Pass, Passes};
use crate::print::Vocabulary;

/// A language with the syntax of C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Language {
    /// HLSL, and Slang as far as it is HLSL.
    Hlsl,
    /// Metal Shading Language, which is C++14.
    Msl,
}

impl Language {
    /// The lowering passes for constructs that the language lacks too: those before `&&`, `||` and `?:` with
    /// side effects are lowered, and those after.
    pub(super) fn passes(self) -> (Passes, Passes) {
        let early = [Pass::Samplers, Pass::StageIo, Pass::ShortCircuit];
        let not_needed = [
            Pass::Folding,
            Pass::Booleans,
            Pass::Swizzles,
            Pass::Indices,
            Pass::Negations,
            Pass::Inequality,
            Pass::Members,
            Pass::Constants,
            Pass::Globals,
            Pass::Steps,
            Pass::DoWhile,
            Pass::DeadCode,
            Pass::Nesting,
        ];
        let own: &[Pass] = match self {
            Self::Hlsl => &[Pass::Matrices, Pass::OutArguments],
            Self::Msl => &[Pass::ShortCircuit, Pass::LoopVoids, Pass::Switches],
        };
        let late = early
            .into_iter()
            .chain(not_needed)
            .chain(own.iter().copied())
            .fold(Passes::required(), Passes::without);
        let early = early.into_iter().filter(|pass| !own.contains(pass));
        (early.fold(Passes::none(), Passes::with), late)
    }

    /// Whether `&&` and `?:` may evaluate a side that is not selected, and select no structures and arrays.
    pub(super) fn evaluates_both_sides(self) -> bool {
        match self {
            Self::Hlsl => true,
            Self::Msl => false,
        }
    }

    /// Whether arrays are values, which have a name and a list of elements anywhere.
    pub(super) fn has_array_values(self) -> bool {
        match self {
            Self::Hlsl => false,
            Self::Msl => true,
        }
    }

    /// Whether parameters for `out` and `inout` are references as in C++.
    pub(super) fn has_references(self) -> bool {
        match self {
            Self::Hlsl => false,
            Self::Msl => true,
        }
    }

    /// What begins the declaration of a constant outside functions.
    pub(super) fn global_constant(self) -> &'static str {
        match self {
            Self::Hlsl => "static const",
            Self::Msl => "constant",
        }
    }

    /// The name of a scalar, vector or matrix type.
    pub(super) fn numeric_type(self, ty: Type) -> Option<String> {
        Some(match ty {
            Type::Scalar(scalar) => scalar_name(scalar).to_owned(),
            Type::Vector(scalar, size) => format!("{}{size}", scalar_name(scalar)),
            // A matrix of GLSL is stored with its columns as rows in HLSL, so that an index selects what it
            // selects in GLSL; products exchange their sides. Metal's are those of GLSL.
            Type::Matrix { columns, rows } => format!("float{columns}x{rows}"),
            _ => return None,
        })
    }

    /// The type of a texture of a shape.
    pub(super) fn texture_type(self, shape: SamplerShape) -> &'static str {
        let [plane, array, volume, cube] = match self {
            Self::Hlsl => ["Texture2D", "Texture2DArray", "Texture3D", "TextureCube"],
            Self::Msl => [
                "texture2d<float>",
                "texture2d_array<float>",
                "texture3d<float>",
                "texturecube<float>",
            ],
        };
        match shape {
            SamplerShape::D2 => plane,
            SamplerShape::D2Array => array,
            SamplerShape::D3 => volume,
            SamplerShape::Cube => cube,
        }
    }

    /// The declaration of a parameter, of which `declared` states type and name.
    pub(super) fn parameter(self, direction: Direction, declared: &str) -> String {
        let is_out = matches!(direction, Direction::Out | Direction::InOut);
        if let (Self::Msl, true, Some((ty, name))) = (self, is_out, declared.rsplit_once(' ')) {
            return format!("thread {ty}& {name}");
        }
        let word = match direction {
            Direction::Out => "out ",
            Direction::InOut => "inout ",
            Direction::In | Direction::ConstIn => "",
        };
        format!("{word}{declared}")
    }
}

fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Bool => "bool",
        Scalar::Int => "int",
        Scalar::Uint => "uint",
        Scalar::Float => "float",
    }
}

/// The names that are not free in the files of a host.
pub(super) struct Words {
    host: CHost,
}

impl Words {
    pub(super) fn new(host: CHost) -> Self {
        Self { host }
    }
}

impl Vocabulary for Words {
    fn is_reserved(&self, word: &str) -> bool {
        let is_unitys = self.host == CHost::Unity && word.to_ascii_lowercase().starts_with("unity_");
        let is_word = match self.host.language() {
            Language::Hlsl => hlsl::is_reserved(word),
            Language::Msl => msl::is_reserved(word),
        };
        is_word || is_unitys
    }

    fn is_function(&self, word: &str) -> bool {
        match self.host.language() {
            Language::Hlsl => hlsl::is_function(word),
            Language::Msl => msl::is_function(word),
        }
    }

    fn declared(&self) -> Vec<String> {
        let declared = self.host.declared_words();
        declared.into_iter().map(str::to_owned).collect()
    }

    fn has_scopes_of_c(&self) -> bool {
        true
    }

    fn with_free_stem(&self, word: &str) -> String {
        if self.host.language() == Language::Msl {
            return msl::with_free_stem(word);
        }
        match word.trim_start_matches('_') {
            _ if !word.starts_with("__") => word.to_owned(),
            "" => "unused".to_owned(),
            stem => stem.to_owned(),
        }
    }
}
