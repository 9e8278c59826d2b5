//! Reserved words that identifiers must avoid: keywords and types of GLSL 450 in naga's lexer.

use toyproof_glsl::tree::BuiltIn;

const KEYWORDS: &str = "\
    active asm atomic_uint attribute bool break buffer case cast centroid class coherent common const \
    continue default discard do double else enum extern external false filter fixed flat float float16_t \
    for goto half highp hvec2 hvec3 hvec4 if in inline inout input int interface invariant layout long \
    lowp mediump namespace noinline noperspective out output partition patch precise precision public \
    readonly resource restrict return sample sampler samplerShadow shared short sizeof smooth static \
    struct subroutine superp switch template this true typedef uint uniform union unsigned using varying \
    void volatile while writeonly";

/// `main`, and functions that GLSL 450 or naga's front end adds to ES 3.00.
const FUNCTIONS: &str = "\
    main atomicAdd atomicAnd atomicCompSwap atomicExchange atomicMax atomicMin atomicOr atomicXor barrier \
    bitCount bitfieldExtract bitfieldInsert bitfieldReverse dFdxCoarse dFdxFine dFdyCoarse dFdyFine \
    findLSB findMSB fma frexp ftransform fwidthCoarse fwidthFine imageLoad imageSize imageStore imulExtended interpolateAtCentroid interpolateAtOffset interpolateAtSample ldexp \
    memoryBarrier noise1 noise2 noise3 noise4 packDouble2x32 packSnorm4x8 packUnorm4x8 shadow1D shadow2D \
    texture1D texture2D texture2DLod texture2DProj texture3D textureCube textureGather textureGatherOffset \
    textureGatherOffsets textureQueryLevels textureQueryLod textureSamples uaddCarry umulExtended \
    unpackDouble2x32 unpackSnorm4x8 unpackUnorm4x8 usubBorrow";

/// Whether a list of words separated by spaces contains the word.
pub(crate) fn lists(words: &str, word: &str) -> bool {
    words.split_whitespace().any(|listed| listed == word)
}

/// Whether naga or GLSL 450 reserves the word.
pub(crate) fn is_reserved(word: &str) -> bool {
    lists(KEYWORDS, word) || is_type(word) || word.starts_with("gl_") || word.contains("__")
}

/// A stem for `word` such that `{stem}_1` is not reserved.
pub(super) fn with_free_stem(word: &str) -> String {
    if is_reserved(&format!("{word}_1")) {
        let words: Vec<_> = word.split('_').filter(|part| !part.is_empty()).collect();
        if words.is_empty() {
            "toyproof_name".to_owned()
        } else {
            format!("toyproof_{}", words.join("_"))
        }
    } else {
        word.to_owned()
    }
}

/// Whether a function of that name would clash with a built-in one.
pub(crate) fn is_function(word: &str) -> bool {
    lists(FUNCTIONS, word) || BuiltIn::ALL.iter().any(|function| function.name() == word)
}

/// Whether naga's lexer treats the word as a type. It searches for `vec`, `mat`, `texture` or `image` within,
/// and ignores any text from their second occurrence.
fn is_type(word: &str) -> bool {
    let sized = |stem: &str, prefixes: &[&str], sizes: &dyn Fn(&str) -> bool| {
        let mut parts = word.split(stem);
        matches!((parts.next(), parts.next()), (Some(prefix), Some(size)) if prefixes.contains(&prefix) && sizes(size))
    };
    let is_size = |size: &str| matches!(size, "2" | "3" | "4");
    let scalars = ["", "b", "i", "u", "d", "f16"];
    let shapes = [
        "1D",
        "1DArray",
        "2D",
        "2DArray",
        "2DMS",
        "2DMSArray",
        "3D",
        "Cube",
        "CubeArray",
        "2DRect",
        "Buffer",
    ];
    sized("vec", &scalars, &is_size)
        || sized("mat", &scalars, &|size| {
            is_size(size)
                || size
                    .split_once('x')
                    .is_some_and(|(c, r)| is_size(c) && is_size(r))
        })
        || sized("texture", &["", "i", "u"], &|size| shapes.contains(&size))
        || sized("image", &["", "i", "u"], &|size| shapes.contains(&size))
        || sized("sampler", &["", "i", "u"], &|size| {
            shapes.iter().any(|shape| size.starts_with(shape))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_numbered_stem_is_reserved() {
        for word in ["_", "__", "___", "a_", "_a", "a__b", "gl_x", "vec2vec", "name"] {
            let stem = with_free_stem(word);
            for name in [&stem, &format!("{stem}_1")] {
                assert!(!is_reserved(name), "{word}: {name}");
            }
        }
    }

    #[test]
    fn listed_functions_are_not_built_in() {
        for word in FUNCTIONS.split_whitespace() {
            let is_built_in = BuiltIn::ALL.iter().any(|function| function.name() == word);
            assert!(!is_built_in, "{word}");
        }
    }

    #[test]
    fn only_words_of_desktop_glsl_are_reserved() {
        for word in [
            "sample",
            "dvec3",
            "mat2x4",
            "texture2D",
            "isampler2DArray",
            "vec2vec",
            "double",
            "a__b",
        ] {
            assert!(is_reserved(word), "{word}");
        }
        for word in [
            "vec",
            "mat",
            "material",
            "vec5",
            "texture",
            "image",
            "sampleCount",
            "f16",
            "map",
        ] {
            assert!(!is_reserved(word), "{word}");
        }
    }
}
