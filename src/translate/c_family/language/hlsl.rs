//! The words of HLSL and Slang.

use crate::print::keyword::lists;

/// Keywords and types of HLSL (Microsoft's “Keywords” and “Reserved Words”), of Slang, and names that FXC
/// treats as keywords in any case. Only words that GLSL allows as names matter.
const RESERVED: &str = "\
    AppendStructuredBuffer asm asm_fragment BlendState bool break Buffer ByteAddressBuffer case cbuffer \
    centroid class column_major compile compile_fragment CompileShader const ConstantBuffer continue \
    ComputeShader ConsumeStructuredBuffer default DepthStencilState DepthStencilView discard do double \
    DomainShader dword else export extern false float for fxgroup GeometryShader globallycoherent \
    groupshared half Hullshader if in inline inout InputPatch int int8_t int16_t int32_t int64_t interface \
    line lineadj linear LineStream matrix min10float min12int min16float min16int min16uint namespace nointerpolation \
    noperspective NULL out OutputPatch packoffset pass pixelfragment PixelShader point PointStream precise \
    RasterizerState RenderTargetView return register row_major RWBuffer RWByteAddressBuffer \
    RWStructuredBuffer RWTexture1D RWTexture2D RWTexture3D sample sampler SamplerState \
    SamplerComparisonState shared snorm stateblock stateblock_state static string struct switch \
    StructuredBuffer tbuffer technique technique10 technique11 texture Texture1D Texture2D Texture3D \
    Texture2DMS Texture2DArray TextureCube true typedef triangle triangleadj TriangleStream uint uint8_t \
    uint16_t uint32_t uint64_t uniform unorm unsigned vector vertexfragment VertexShader void volatile \
    while auto catch char const_cast delete dynamic_cast enum explicit friend goto long mutable new \
    operator private protected public reinterpret_cast short signed sizeof static_cast template this throw \
    try typename union using virtual extension func import let var property associatedtype where module \
    implementing __init __subscript no_diff none is as each expand";

/// The functions of HLSL.
const FUNCTIONS: &str = "\
    abort abs acos all any asdouble asfloat asin asint asuint atan atan2 ceil clamp clip cos cosh countbits \
    cross D3DCOLORtoUBYTE4 ddx ddx_coarse ddx_fine ddy ddy_coarse ddy_fine degrees determinant distance dot \
    dst errorf exp exp2 f16tof32 f32tof16 faceforward firstbithigh firstbitlow floor fma fmod frac frexp \
    fwidth isfinite isinf isnan ldexp length lerp lit log log10 log2 mad main max min modf msad4 mul noise \
    normalize pow printf radians rcp reflect refract reversebits round rsqrt saturate select sign sin sincos \
    sinh smoothstep sqrt step tan tanh tex1D tex1Dbias tex1Dlod tex2D tex2Dbias tex2Dgrad tex2Dlod tex2Dproj \
    tex3D tex3Dlod texCUBE texCUBElod transpose trunc";

/// Whether nothing may have the name.
pub(super) fn is_reserved(word: &str) -> bool {
    lists(RESERVED, word) || is_numbered_type(word) || word.starts_with("__")
}

/// Whether the name is a function's.
pub(super) fn is_function(word: &str) -> bool {
    lists(FUNCTIONS, word)
}

/// Whether the word is a vector or matrix type, such as `float3` or `half3x3`.
fn is_numbered_type(word: &str) -> bool {
    let scalars = [
        "bool",
        "int",
        "uint",
        "half",
        "float",
        "double",
        "dword",
        "min16float",
    ];
    let number = scalars.iter().find_map(|scalar| word.strip_prefix(scalar));
    let is_size = |size: &str| matches!(size, "1" | "2" | "3" | "4");
    number.is_some_and(|number| match number.split_once('x') {
        Some((rows, columns)) => is_size(rows) && is_size(columns),
        None => is_size(number),
    })
}
