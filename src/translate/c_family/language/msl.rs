//! The words of Metal Shading Language, versions 2.0 to 3.2.

use crate::print::keyword::lists;

/// Keywords of C++14 and of Metal, types, and macros of Metal's headers. Only words that GLSL allows as names
/// matter.
const RESERVED: &str = "\
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t class compl \
    const constexpr const_cast continue decltype default delete do double dynamic_cast else enum explicit \
    export extern false final float for friend goto if inline int long mutable namespace new noexcept not \
    not_eq nullptr operator or or_eq override private protected public register reinterpret_cast return short \
    signed sizeof static static_assert static_cast struct switch template this thread_local throw true try \
    typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq \
    kernel vertex fragment visible stitchable mesh object intersection device constant thread threadgroup \
    threadgroup_imageblock object_data ray_data as_type half bfloat uchar ushort uint ulong size_t ptrdiff_t \
    int8_t uint8_t int16_t uint16_t int32_t uint32_t int64_t uint64_t quad metal simd vec matrix packed_vec \
    array array_ref atomic atomic_int atomic_uint atomic_bool atomic_float sampler sampler_state patch_control_point \
    texture1d texture1d_array texture2d texture2d_array texture2d_ms texture3d texturecube texturecube_array \
    texture_buffer depth2d depth2d_array depth2d_ms depthcube depthcube_array imageblock numeric_limits \
    r8unorm r8snorm r16unorm r16snorm rg8unorm rg8snorm rg16unorm rg16snorm rgba8unorm rgba8snorm rgba16unorm \
    rgba16snorm srgba8unorm rgb10a2 rg11b10f rgb9e5 NULL INFINITY NAN MAXFLOAT MAXHALF MAXBFLOAT HUGE_VAL HUGE_VALF \
    HUGE_VALH HUGE_VALBF FP_ILOGB0 FP_ILOGBNAN FP_FAST_FMA FP_FAST_FMAF CHAR_BIT METAL_FUNC METAL_CONST_ARG assert \
    offsetof";

/// The functions of Metal's library, and the types and options of its samplers.
const FUNCTIONS: &str = "\
    main precise fast abs absdiff access acos acosh addsat address all any asin asinh assume atan atan2 atanh bias \
    border_color ceil clamp clz compare_func component coord copysign cos cosh cospi cross ctz determinant dfdx \
    dfdy discard_fragment distance distance_squared divide dot exp exp10 exp2 extract_bits fabs faceforward fdim \
    filter floor fma fmax fmax3 fmedian3 fmin fmin3 fmod forward fract frexp fwidth get_num_samples \
    get_sample_position gradient2d gradient3d gradientcube hadd ilogb insert_bits interpolant interpolation \
    isfinite isinf isnan isnormal isordered isunordered ldexp length length_squared level lod_clamp log log10 \
    log2 mad24 madhi madsat mag_filter max max3 max_anisotropy median3 mem_flags memory_order min min3 min_filter \
    min_lod_clamp mip_filter mix modf move mul24 mulhi nextafter normalize pack_float_to_snorm2x16 pack_float_to_snorm4x8 pack_float_to_unorm2x16 \
    pack_float_to_unorm4x8 popcount pow powr quad_broadcast quad_shuffle r_address reflect \
    refract reverse_bits rhadd rint rotate round rsqrt s_address saturate select sign signbit simdgroup_barrier \
    sin sincos sinh sinpi smoothstep sqrt step subsat swap t_address tan tanh tanpi thread_scope \
    threadgroup_barrier transpose trunc uniform unpack_snorm2x16_to_float unpack_snorm4x8_to_float \
    unpack_unorm2x16_to_float unpack_unorm4x8_to_float";

/// The prefixes of the macros for the limits of types, and their other parts.
const LIMITS: [(&str, &str); 2] = [
    (
        "FLT_ HALF_ BFLT_",
        "DIG EPSILON MANT_DIG MAX MAX_10_EXP MAX_EXP MIN MIN_10_EXP MIN_EXP RADIX TRUE_MIN",
    ),
    (
        "CHAR_ SCHAR_ UCHAR_ SHRT_ USHRT_ INT_ UINT_ LONG_ ULONG_",
        "MAX MIN",
    ),
];

/// Whether nothing may have the name.
pub(super) fn is_reserved(word: &str) -> bool {
    let is_of_implementation = word.contains("__")
        || word.starts_with('_') && word[1..].starts_with(|c: char| c.is_ascii_uppercase());
    lists(RESERVED, word) || is_of_implementation || is_numbered_type(word) || is_macro(word)
}

/// A stem for `word` such that `{stem}_1` is not reserved.
pub(super) fn with_free_stem(word: &str) -> String {
    if !is_reserved(&format!("{word}_1")) {
        return word.to_owned();
    }
    let parts: Vec<_> = word.split('_').filter(|part| !part.is_empty()).collect();
    match parts.as_slice() {
        [] => "unused".to_owned(),
        parts => parts.join("_"),
    }
}

/// Whether the name is a function's.
pub(super) fn is_function(word: &str) -> bool {
    lists(FUNCTIONS, word)
}

/// Whether the word is a constant's such as `M_PI_F`, or the limit of a type.
fn is_macro(word: &str) -> bool {
    let is_constant = word.starts_with("M_") && ["_F", "_H", "_BF"].iter().any(|end| word.ends_with(end));
    let is_limit = LIMITS.iter().any(|(prefixes, limits)| {
        let mut prefixes = prefixes.split_whitespace();
        prefixes.any(|prefix| {
            word.strip_prefix(prefix)
                .is_some_and(|limit| lists(limits, limit))
        })
    });
    is_constant || is_limit
}

/// Whether the word is a vector or matrix type, such as `float3`, `packed_half2` or `half3x3`.
fn is_numbered_type(word: &str) -> bool {
    const SCALARS: [&str; 12] = [
        "bool", "char", "uchar", "short", "ushort", "int", "uint", "long", "ulong", "half", "float", "bfloat",
    ];
    let word = word.strip_prefix("packed_").unwrap_or(word);
    let is_size = |size: &str| matches!(size, "2" | "3" | "4");
    let mut sizes = SCALARS.iter().filter_map(|scalar| word.strip_prefix(scalar));
    sizes.any(|size| match size.split_once('x') {
        Some((columns, rows)) => is_size(columns) && is_size(rows),
        None => is_size(size),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names are numbered until one is free.
    #[test]
    fn numbered_names_are_free() {
        let words =
            format!("{RESERVED} {FUNCTIONS} M_PI_F INT_MAX float3 packed_half2 _ __ _X a__b a_ _a pack_x");
        for word in words.split_whitespace() {
            let stem = with_free_stem(word);
            let name = format!("{stem}_1");
            assert!(!is_reserved(&name) && !is_function(&name), "{word}: {name}");
        }
    }
}
