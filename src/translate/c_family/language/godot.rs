//! The words and types of Godot's shading language (“Shading language” and “Canvas item shaders” in the Godot
//! documentation).

use toyproof_glsl::tree::Type;

use super::glsl;
use crate::print::keyword::lists;

/// Keywords, render modes, and the variables and constants that exist without a declaration in some function
/// of a shader.
const RESERVED: &str = "\
    void bool bvec2 bvec3 bvec4 int ivec2 ivec3 ivec4 uint uvec2 uvec3 uvec4 float vec2 vec3 vec4 mat2 mat3 \
    mat4 sampler2D isampler2D usampler2D sampler2DArray isampler2DArray usampler2DArray sampler3D isampler3D \
    usampler3D samplerCube samplerCubeArray samplerExternalOES flat smooth const struct lowp mediump highp if \
    else for while do switch case default break continue return discard uniform varying in out inout \
    render_mode stencil_mode instance global group_uniforms shader_type source_color color_conversion_disabled \
    hint_enum hint_range hint_anisotropy hint_normal \
    hint_depth_texture hint_screen_texture hint_normal_roughness_texture hint_default_black \
    hint_default_white hint_default_transparent hint_roughness_normal hint_roughness_r hint_roughness_g \
    hint_roughness_b hint_roughness_a hint_roughness_gray instance_index filter_nearest filter_linear \
    filter_nearest_mipmap filter_linear_mipmap filter_nearest_mipmap_anisotropic \
    filter_linear_mipmap_anisotropic repeat_enable repeat_disable true false vertex fragment light start \
    process TIME PI TAU E FRAGCOORD UV COLOR TEXTURE TEXTURE_PIXEL_SIZE NORMAL NORMAL_MAP NORMAL_MAP_DEPTH \
    NORMAL_TEXTURE SPECULAR_SHININESS SPECULAR_SHININESS_TEXTURE SCREEN_UV SCREEN_PIXEL_SIZE SCREEN_MATRIX \
    POINT_COORD POINT_SIZE AT_LIGHT_PASS VERTEX VERTEX_ID INSTANCE_ID INSTANCE_CUSTOM MODEL_MATRIX CANVAS_MATRIX \
    LIGHT LIGHT_COLOR LIGHT_ENERGY LIGHT_POSITION LIGHT_DIRECTION LIGHT_IS_DIRECTIONAL LIGHT_VERTEX SHADOW_VERTEX \
    SHADOW_MODULATE REGION_RECT CUSTOM0 CUSTOM1 OUTPUT_IS_SRGB CLIP_SPACE_FAR CURRENT_RENDERER \
    RENDERER_COMPATIBILITY RENDERER_MOBILE RENDERER_FORWARD_PLUS";

/// The functions that GLSL ES 3.00 does not have.
const FUNCTIONS: &str = "\
    textureProj textureProjLod textureProjGrad textureQueryLod textureQueryLevels textureGather dFdxCoarse \
    dFdxFine dFdyCoarse dFdyFine fwidthCoarse fwidthFine bitCount bitfieldExtract bitfieldInsert \
    bitfieldReverse findLSB findMSB umulExtended imulExtended uaddCarry usubBorrow ldexp frexp fma \
    packUnorm4x8 packSnorm4x8 unpackUnorm4x8 unpackSnorm4x8";

/// Whether nothing may have the name.
pub(super) fn is_reserved(word: &str) -> bool {
    lists(RESERVED, word) || glsl::is_reserved(word)
}

/// Whether the name is a function's.
pub(super) fn is_function(word: &str) -> bool {
    lists(FUNCTIONS, word) || glsl::is_function(word)
}

/// The name of a scalar, vector or matrix type. Matrices are square.
pub(super) fn numeric_type(ty: Type) -> Option<String> {
    match ty {
        Type::Matrix { columns, rows } if columns != rows => None,
        Type::Sampler(_) => None,
        _ => glsl::numeric_type(ty),
    }
}
