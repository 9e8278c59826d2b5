//! What differs between the languages: types, words and passes. Their built-in functions are in
//! [`super::builtin`].

mod glsl;
mod godot;
mod hlsl;
mod msl;

use toyproof_glsl::tree::{Direction, Sampler, SamplerShape, Type};

use super::host::CHost;
use crate::lower::{Pass, Passes};
use crate::print::Vocabulary;

/// A language with the syntax of C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Language {
    /// HLSL, and Slang as far as it is HLSL.
    Hlsl,
    /// The shading language of Godot 4: GLSL with fewer constructs, and without global variables.
    Godot,
    /// GLSL ES 3.00.
    Glsl,
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
            Pass::Inequality,
            Pass::Members,
            Pass::Constants,
            Pass::Globals,
            Pass::Steps,
            Pass::DoWhile,
            Pass::Nesting,
        ];
        let own: &[Pass] = match self {
            Self::Hlsl => &[
                Pass::Matrices,
                Pass::Swizzles,
                Pass::Indices,
                Pass::Negations,
                Pass::OutArguments,
                Pass::DeadCode,
            ],
            Self::Msl => &[
                Pass::ShortCircuit,
                Pass::Swizzles,
                Pass::Indices,
                Pass::Negations,
                Pass::LoopVoids,
                Pass::DeadCode,
                Pass::Switches,
            ],
            Self::Godot => &[Pass::MissingBuiltIns],
            Self::Glsl => &[
                Pass::Samplers,
                Pass::ShortCircuit,
                Pass::MissingBuiltIns,
                Pass::Geometric,
                Pass::Texels,
                Pass::Matrices,
                Pass::Swizzles,
                Pass::Indices,
                Pass::Negations,
                Pass::OutArguments,
                Pass::Equality,
                Pass::LoopVoids,
                Pass::ElseIfs,
                Pass::DeadCode,
                Pass::Switches,
                Pass::Sequences,
            ],
        };
        let late = early
            .into_iter()
            .chain(not_needed)
            .chain(own.iter().copied())
            .fold(Passes::required(), Passes::without);
        let early = early.into_iter().filter(|pass| !own.contains(pass));
        (early.fold(Passes::none(), Passes::with), late)
    }

    /// Whether sides of `?:` with side effects must be branches: HLSL may evaluate both sides, and Godot has no
    /// `a, b` in them. Neither selects structures and arrays.
    pub(super) fn branches_for_effects(self) -> bool {
        match self {
            Self::Hlsl | Self::Godot => true,
            Self::Msl | Self::Glsl => false,
        }
    }

    /// Whether arrays are values, which have a name and a list of elements anywhere.
    pub(super) fn has_array_values(self) -> bool {
        match self {
            Self::Hlsl | Self::Godot => false,
            Self::Msl | Self::Glsl => true,
        }
    }

    /// Whether parameters for `out` and `inout` are references as in C++.
    pub(super) fn has_references(self) -> bool {
        match self {
            Self::Hlsl | Self::Godot | Self::Glsl => false,
            Self::Msl => true,
        }
    }

    /// The name of a scalar, vector or matrix type.
    pub(super) fn numeric_type(self, ty: Type) -> Option<String> {
        match self {
            Self::Hlsl | Self::Msl => {}
            Self::Godot => return godot::numeric_type(ty),
            Self::Glsl => return glsl::numeric_type(ty),
        }
        Some(match ty {
            Type::Scalar(scalar) => scalar.name().to_owned(),
            Type::Vector(scalar, size) => format!("{}{size}", scalar.name()),
            // A matrix of GLSL is stored with its columns as rows in HLSL, so that an index selects what it
            // selects in GLSL; products exchange their sides. Metal's are those of GLSL.
            Type::Matrix { columns, rows } => format!("float{columns}x{rows}"),
            _ => return None,
        })
    }

    /// Whether functions see no variables at global scope, other than constants and inputs.
    pub(super) fn passes_globals(self) -> bool {
        self == Self::Godot
    }

    /// The words that declare a constant at global scope.
    pub(super) fn constant(self) -> &'static str {
        match self {
            Self::Hlsl => "static const",
            Self::Msl => "constant",
            Self::Godot | Self::Glsl => "const",
        }
    }

    /// The type of a texture of a shape; with its sampler, if the language combines both.
    pub(super) fn texture_type(self, shape: SamplerShape) -> String {
        let [plane, array, volume, cube] = match self {
            Self::Hlsl => ["Texture2D", "Texture2DArray", "Texture3D", "TextureCube"],
            Self::Msl => [
                "texture2d<float>",
                "texture2d_array<float>",
                "texture3d<float>",
                "texturecube<float>",
            ],
            Self::Godot | Self::Glsl => return Sampler::float(shape).name(),
        };
        let name = match shape {
            SamplerShape::D2 => plane,
            SamplerShape::D2Array => array,
            SamplerShape::D3 => volume,
            SamplerShape::Cube => cube,
        };
        name.to_owned()
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
            Language::Godot => godot::is_reserved(word),
            Language::Glsl => glsl::is_reserved(word),
            Language::Msl => msl::is_reserved(word),
        };
        is_word || is_unitys
    }

    fn is_function(&self, word: &str) -> bool {
        match self.host.language() {
            Language::Hlsl => hlsl::is_function(word),
            Language::Godot => godot::is_function(word),
            Language::Glsl => glsl::is_function(word),
            Language::Msl => msl::is_function(word),
        }
    }

    fn declared(&self) -> Vec<String> {
        let declared = self.host.declared_words();
        declared.into_iter().map(str::to_owned).collect()
    }

    fn has_scopes_of_c(&self) -> bool {
        self.host.language() != Language::Glsl
    }

    fn may_hide_functions(&self) -> bool {
        true
    }

    fn keeps_constants_visible(&self) -> bool {
        self.host.language() == Language::Godot
    }

    fn with_free_stem(&self, word: &str) -> String {
        match self.host.language() {
            Language::Msl => return msl::with_free_stem(word),
            Language::Glsl | Language::Godot => return glsl::with_free_stem(word),
            Language::Hlsl => {}
        }
        match word.trim_start_matches('_') {
            _ if !word.starts_with("__") => word.to_owned(),
            "" => "unused".to_owned(),
            stem => stem.to_owned(),
        }
    }
}
