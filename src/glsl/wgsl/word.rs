//! Words of WGSL that no identifier may be (§15), or had better not be.

use super::super::tree::BuiltIn;

/// Keywords and reserved words that GLSL leaves to its authors.
const RESERVED: &[&str] = &[
    "NULL",
    "Self",
    "abstract",
    "active",
    "alias",
    "alignas",
    "alignof",
    "as",
    "asm",
    "asm_fragment",
    "async",
    "attribute",
    "auto",
    "await",
    "become",
    "binding_array",
    "cast",
    "catch",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "coherent",
    "column_major",
    "common",
    "compile",
    "compile_fragment",
    "concept",
    "const_assert",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continuing",
    "crate",
    "debugger",
    "decltype",
    "delete",
    "demote",
    "demote_to_helper",
    "diagnostic",
    "do",
    "dynamic_cast",
    "enable",
    "enum",
    "explicit",
    "export",
    "extends",
    "extern",
    "external",
    "fallthrough",
    "filter",
    "final",
    "finally",
    "fn",
    "friend",
    "from",
    "fxgroup",
    "get",
    "goto",
    "groupshared",
    "highp",
    "impl",
    "implements",
    "import",
    "inline",
    "instanceof",
    "interface",
    "layout",
    "let",
    "loop",
    "lowp",
    "macro",
    "macro_rules",
    "match",
    "mediump",
    "meta",
    "mod",
    "module",
    "move",
    "mut",
    "mutable",
    "namespace",
    "new",
    "nil",
    "noexcept",
    "noinline",
    "nointerpolation",
    "non_coherent",
    "noncoherent",
    "noperspective",
    "null",
    "nullptr",
    "of",
    "operator",
    "override",
    "package",
    "packoffset",
    "params",
    "partition",
    "pass",
    "patch",
    "pixelfragment",
    "precise",
    "precision",
    "premerge",
    "priv",
    "protected",
    "ptr",
    "pub",
    "public",
    "readonly",
    "ref",
    "regardless",
    "register",
    "reinterpret_cast",
    "require",
    "requires",
    "resource",
    "restrict",
    "self",
    "set",
    "shared",
    "sizeof",
    "smooth",
    "snorm",
    "static",
    "static_assert",
    "static_cast",
    "std",
    "subroutine",
    "super",
    "target",
    "template",
    "this",
    "thread_local",
    "throw",
    "trait",
    "try",
    "type",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "union",
    "unless",
    "unorm",
    "unsafe",
    "unsized",
    "use",
    "using",
    "var",
    "varying",
    "virtual",
    "volatile",
    "wgsl",
    "where",
    "with",
    "writeonly",
    "yield",
];

/// Types and functions that WGSL declares, and that what is printed may use.
const PREDECLARED: &[&str] = &[
    "abs",
    "acos",
    "acosh",
    "all",
    "any",
    "array",
    "asin",
    "asinh",
    "atan",
    "atan2",
    "atanh",
    "atomic",
    "bitcast",
    "bool",
    "ceil",
    "clamp",
    "cos",
    "cosh",
    "cross",
    "degrees",
    "determinant",
    "distance",
    "dot",
    "dpdx",
    "dpdy",
    "exp",
    "exp2",
    "f16",
    "f32",
    "faceForward",
    "floor",
    "fract",
    "fwidth",
    "i32",
    "inverseSqrt",
    "length",
    "log",
    "log2",
    "mat2x2f",
    "mat2x3f",
    "mat2x4f",
    "mat3x2f",
    "mat3x3f",
    "mat3x4f",
    "mat4x2f",
    "mat4x3f",
    "mat4x4f",
    "max",
    "min",
    "mix",
    "normalize",
    "pack2x16float",
    "pack2x16snorm",
    "pack2x16unorm",
    "pow",
    "radians",
    "reflect",
    "refract",
    "round",
    "sampler",
    "select",
    "sign",
    "sin",
    "sinh",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "tanh",
    "texture_2d",
    "texture_3d",
    "texture_cube",
    "textureDimensions",
    "textureLoad",
    "textureSample",
    "textureSampleBias",
    "textureSampleGrad",
    "textureSampleLevel",
    "transpose",
    "trunc",
    "u32",
    "unpack2x16float",
    "unpack2x16snorm",
    "unpack2x16unorm",
    "vec2",
    "vec2f",
    "vec2i",
    "vec2u",
    "vec3",
    "vec3f",
    "vec3i",
    "vec3u",
    "vec4",
    "vec4f",
    "vec4i",
    "vec4u",
];

/// Whether no variable, function or structure of the author may have that name.
pub(super) fn is_taken(word: &str) -> bool {
    RESERVED.binary_search(&word).is_ok()
        || PREDECLARED.contains(&word)
        || word == "_"
        || word.starts_with("__")
}

/// Whether a local variable may have the name of that function, if nobody calls it where the variable is. What is printed calls some that the
/// author did not.
pub(super) fn may_be_hidden(word: &str) -> bool {
    const PRINTED: [&str; 4] = ["all", "any", "floor", "round"];
    BuiltIn::ALL.iter().any(|function| function.name() == word) && !PRINTED.contains(&word)
}

/// The same of a member, which stands behind a dot and meets nothing.
pub(super) fn is_reserved(word: &str) -> bool {
    RESERVED.binary_search(&word).is_ok() || word == "_" || word.starts_with("__")
}

/// The word itself, or the first that is made of it and free.
pub(super) fn free(word: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let stem = word.trim_start_matches("__");
    let stem = if stem.is_empty() || stem == "_" {
        "unused"
    } else {
        stem
    };
    let numbered = (1_usize..).map(|number| format!("{stem}_{number}"));
    std::iter::once(stem.to_owned())
        .chain(numbered)
        .find(|name| !is_taken(name))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_words_are_in_order() {
        assert!(RESERVED.is_sorted());
    }

    #[test]
    fn a_word_of_wgsl_gets_a_number() {
        assert_eq!(free("loop", is_taken), "loop_1");
        assert_eq!(free("near", is_taken), "near");
        assert_eq!(free("__x", is_taken), "x");
        assert!(may_be_hidden("distance") && !may_be_hidden("select") && !may_be_hidden("floor"));
    }
}
