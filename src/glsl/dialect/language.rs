//! Versions of GLSL, and the rules in which they differ.

use crate::tree::{BuiltIn, SamplerShape};

/// A version of GLSL, as `#version` names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Version {
    /// GLSL ES 1.00, of WebGL 1.
    Es100,
    /// GLSL ES 3.00, of WebGL 2.
    Es300,
    /// GLSL ES 3.10.
    Es310,
    /// GLSL ES 3.20.
    Es320,
    /// Desktop GLSL, such as 330.
    Desktop(u16),
}

/// The first desktop version with implicit conversions from integers to floats.
const IMPLICIT_CONVERSIONS: u16 = 120;
/// The first desktop version in which a uniform may have an initializer.
const UNIFORM_DEFAULTS: u16 = 120;
/// The first desktop version in which `in` and `out` replace `varying`.
const STAGE_IO: u16 = 130;
/// The first desktop version in which integers have remainders and bits.
const INTEGER_OPERATIONS: u16 = 130;
/// The first desktop version in which an `int` becomes a `uint` where one is expected.
const UNSIGNED_CONVERSIONS: u16 = 400;
/// The first desktop version in which `sample` is a keyword.
const SAMPLE_KEYWORD: u16 = 400;
/// The first desktop version in which a `const` may have a value that is not constant.
const RUN_TIME_CONSTANTS: u16 = 420;
/// The first desktop version with `{…}` as an initializer.
const INITIALIZER_LISTS: u16 = 420;
/// The first desktop version without `texture2D` and the like.
const NO_OLD_TEXTURE_FUNCTIONS: u16 = 420;
/// The first desktop version with arrays of arrays.
const ARRAYS_OF_ARRAYS: u16 = 430;

/// The functions for one shape of textures (§8.7 of GLSL ES 1.00, with its extensions), and what replaces them.
pub(crate) const OLD_TEXTURE_FUNCTIONS: [(&str, BuiltIn, SamplerShape); 15] = [
    ("texture2D", BuiltIn::Texture, SamplerShape::D2),
    ("texture2DProj", BuiltIn::TextureProj, SamplerShape::D2),
    ("texture2DLod", BuiltIn::TextureLod, SamplerShape::D2),
    ("texture2DLodEXT", BuiltIn::TextureLod, SamplerShape::D2),
    ("texture2DProjLod", BuiltIn::TextureProjLod, SamplerShape::D2),
    ("texture2DProjLodEXT", BuiltIn::TextureProjLod, SamplerShape::D2),
    ("texture2DGradEXT", BuiltIn::TextureGrad, SamplerShape::D2),
    ("texture2DProjGradEXT", BuiltIn::TextureProjGrad, SamplerShape::D2),
    ("textureCube", BuiltIn::Texture, SamplerShape::Cube),
    ("textureCubeLod", BuiltIn::TextureLod, SamplerShape::Cube),
    ("textureCubeLodEXT", BuiltIn::TextureLod, SamplerShape::Cube),
    ("textureCubeGradEXT", BuiltIn::TextureGrad, SamplerShape::Cube),
    ("texture3D", BuiltIn::Texture, SamplerShape::D3),
    ("texture3DProj", BuiltIn::TextureProj, SamplerShape::D3),
    ("texture3DLod", BuiltIn::TextureLod, SamplerShape::D3),
];

/// The desktop versions for fragment shaders.
const DESKTOP: [u16; 12] = [110, 120, 130, 140, 150, 330, 400, 410, 420, 430, 440, 450];
/// The newest desktop version.
const NEWEST: u16 = 460;

/// The functions that GLSL ES 1.00 has (§8), apart from those of textures.
const FUNCTIONS_OF_ES_100: &str = "radians degrees sin cos tan asin acos atan pow exp log exp2 log2 sqrt \
    inversesqrt abs sign floor ceil fract mod min max clamp mix step smoothstep length distance dot cross \
    normalize faceforward reflect refract matrixCompMult lessThan lessThanEqual greaterThan \
    greaterThanEqual equal notEqual any all not";

/// A version of GLSL, and whether desktop rules hold in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Language {
    pub(crate) version: Version,
    /// Whether what desktop GLSL accepts is accepted whatever the version.
    pub(crate) is_lenient: bool,
}

impl Version {
    /// The version that `#version NUMBER PROFILE` selects; `None` if there is none for fragment shaders.
    pub(crate) fn parse(number: &str, profile: Option<&str>) -> Option<Self> {
        match (number.parse().ok()?, profile) {
            (100, None) => Some(Self::Es100),
            (300, Some("es")) => Some(Self::Es300),
            (310, Some("es")) => Some(Self::Es310),
            (320, Some("es")) => Some(Self::Es320),
            (number, profile) if DESKTOP.contains(&number) || number == NEWEST => {
                let has_profiles = number >= 150;
                let is_known =
                    profile.is_none_or(|name| has_profiles && matches!(name, "core" | "compatibility"));
                is_known.then_some(Self::Desktop(number))
            }
            _ => None,
        }
    }

    /// The name, such as “GLSL ES 1.00”.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Es100 => "GLSL ES 1.00".to_owned(),
            Self::Es300 => "GLSL ES 3.00".to_owned(),
            Self::Es310 => "GLSL ES 3.10".to_owned(),
            Self::Es320 => "GLSL ES 3.20".to_owned(),
            Self::Desktop(number) => format!("GLSL {}.{:02}", number / 100, number % 100),
        }
    }

    /// Where a shader of this version runs, for messages about its rules.
    pub(crate) fn webgl(self) -> String {
        match self {
            Self::Es100 => "WebGL 1".to_owned(),
            Self::Es300 => "WebGL 2".to_owned(),
            _ => self.name(),
        }
    }

    /// The value of `__VERSION__`.
    pub(crate) fn number(self) -> u16 {
        match self {
            Self::Es100 => 100,
            Self::Es300 => 300,
            Self::Es310 => 310,
            Self::Es320 => 320,
            Self::Desktop(number) => number,
        }
    }

    /// The line that selects it; empty for GLSL ES 1.00, which browsers assume.
    #[must_use]
    pub fn directive(self) -> String {
        let es = if self.is_es() { " es" } else { "" };
        match self {
            Self::Es100 => String::new(),
            _ => format!("#version {}{es}\n", self.number()),
        }
    }

    /// Whether it is a version of GLSL ES.
    pub(crate) fn is_es(self) -> bool {
        !matches!(self, Self::Desktop(_))
    }

    /// Whether integers have remainders, bits and functions, and `switch`.
    #[must_use]
    pub fn has_integer_operations(self) -> bool {
        match self {
            Self::Es100 => false,
            Self::Es300 | Self::Es310 | Self::Es320 => true,
            Self::Desktop(number) => number >= INTEGER_OPERATIONS,
        }
    }

    /// Whether it is desktop GLSL, of this version or a later one.
    fn is_desktop_since(self, first: u16) -> bool {
        matches!(self, Self::Desktop(number) if number >= first)
    }

    /// Whether `varying`, `gl_FragColor` and `texture2D` belong to it.
    pub(crate) fn has_old_names(self) -> bool {
        match self {
            Self::Es100 => true,
            Self::Es300 | Self::Es310 | Self::Es320 => false,
            Self::Desktop(number) => number < NO_OLD_TEXTURE_FUNCTIONS,
        }
    }

    /// Whether `sample` and `patch` are names.
    pub(crate) fn has_name_sample(self) -> bool {
        !self.is_es() && !self.is_desktop_since(SAMPLE_KEYWORD)
    }

    /// Whether a uniform may have an initializer.
    pub(crate) fn has_uniform_defaults(self) -> bool {
        self.is_desktop_since(UNIFORM_DEFAULTS)
    }

    /// Whether global variables can be `in` and `out`.
    pub(crate) fn has_stage_io(self) -> bool {
        match self {
            Self::Es100 => false,
            Self::Es300 | Self::Es310 | Self::Es320 => true,
            Self::Desktop(number) => number >= STAGE_IO,
        }
    }
}

impl Language {
    /// Whether it is GLSL ES 1.00 without the features of later versions.
    pub(crate) fn is_es_100(self) -> bool {
        self.version == Version::Es100 && !self.is_lenient
    }

    /// Whether integers have remainders, bits and functions, and `switch`.
    pub(crate) fn has_integer_operations(self) -> bool {
        self.is_lenient || self.version.has_integer_operations()
    }

    /// Whether integers become floats where these are expected.
    pub(crate) fn converts_implicitly(self) -> bool {
        self.is_lenient || self.version.is_desktop_since(IMPLICIT_CONVERSIONS)
    }

    /// Whether integers become unsigned ones where these are expected.
    pub(crate) fn converts_to_unsigned(self) -> bool {
        self.is_lenient || self.version.is_desktop_since(UNSIGNED_CONVERSIONS)
    }

    /// Whether a constant may be computed at run time, by an expression that is not constant.
    pub(crate) fn has_run_time_constants(self) -> bool {
        self.is_lenient || self.version.is_desktop_since(RUN_TIME_CONSTANTS)
    }

    /// Whether the initializer of a global variable may be computed at run time. WebGL 1 accepts what other
    /// globals and uniforms determine, although the specification does not.
    pub(crate) fn initializes_at_run_time(self) -> bool {
        self.is_desktop() || self.version == Version::Es100
    }

    /// Whether arrays may have array elements.
    pub(crate) fn has_arrays_of_arrays(self) -> bool {
        let is_es = matches!(self.version, Version::Es310 | Version::Es320);
        self.is_lenient || is_es || self.version.is_desktop_since(ARRAYS_OF_ARRAYS)
    }

    /// Whether `{…}` is an initializer.
    pub(crate) fn has_initializer_lists(self) -> bool {
        self.version.is_desktop_since(INITIALIZER_LISTS)
    }

    /// Whether it has desktop GLSL's other liberties: `?:` of arrays and structures, a lone `;`, large arrays.
    pub(crate) fn is_desktop(self) -> bool {
        self.is_lenient || !self.version.is_es()
    }

    /// Whether the author may define a function of this built-in function's name and parameters.
    pub(crate) fn may_redefine(self, function: BuiltIn) -> bool {
        self.is_desktop() || !self.has(function)
    }

    /// Whether the author may define a function of a built-in function's name with other parameters.
    pub(crate) fn may_overload(self) -> bool {
        self.is_desktop() || self.version == Version::Es100
    }

    /// The function that replaces one for a shape of textures, such as `texture2D`, and that shape.
    pub(crate) fn old_texture_function(self, name: &str) -> Option<(BuiltIn, SamplerShape)> {
        let row = OLD_TEXTURE_FUNCTIONS.iter().find(|(old, ..)| *old == name);
        row.filter(|_| self.version.has_old_names())
            .map(|&(_, function, shape)| (function, shape))
    }

    /// Whether it has a built-in function.
    pub(crate) fn has(self, function: BuiltIn) -> bool {
        if self.has_integer_operations() {
            return true;
        }
        let is_of_desktop = self.version.is_desktop_since(IMPLICIT_CONVERSIONS)
            && matches!(function, BuiltIn::Transpose | BuiltIn::OuterProduct);
        // Derivatives are an extension that every browser has.
        is_of_desktop
            || function.is_derivative()
            || FUNCTIONS_OF_ES_100.split(' ').any(|name| name == function.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_have_the_profiles_of_their_specification() {
        assert_eq!(Version::parse("100", None), Some(Version::Es100));
        assert_eq!(Version::parse("300", Some("es")), Some(Version::Es300));
        assert_eq!(Version::parse("330", Some("core")), Some(Version::Desktop(330)));
        assert_eq!(Version::parse("120", None), Some(Version::Desktop(120)));
        for (number, profile) in [
            ("300", None),
            ("120", Some("core")),
            ("331", None),
            ("330", Some("es")),
        ] {
            assert_eq!(Version::parse(number, profile), None, "{number} {profile:?}");
        }
        assert_eq!(Version::Desktop(330).name(), "GLSL 3.30");
    }

    #[test]
    fn versions_differ_in_their_rules() {
        let of = |version| Language {
            version,
            is_lenient: false,
        };
        assert!(of(Version::Desktop(330)).converts_implicitly() && !of(Version::Es300).converts_implicitly());
        assert!(!of(Version::Desktop(330)).has_arrays_of_arrays());
        assert!(!of(Version::Es100).has(BuiltIn::Round) && of(Version::Es100).has(BuiltIn::Fract));
        assert!(of(Version::Es100).may_redefine(BuiltIn::Round));
        assert!(!of(Version::Es100).may_redefine(BuiltIn::Fract));
    }
}
