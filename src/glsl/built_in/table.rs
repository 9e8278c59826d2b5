//! The table of the built-in functions, in the order of §8.

use std::cmp::Ordering;

use toyproof_math::{self as math, FloatTerm, Matrix};

use super::ConstantFunction::{Booleans, Float, Float2, OfMatrix, OfVectors, Scalars};
use super::Definition::{Binary, Glsl, Ternary, Unary, Vectors};
use super::Wgsl::{Bitcast, Missing, Named, Operator, Special, Splat};
use super::{Row, constant, core, ext};
use crate::tree::{BinaryOp, Value};

fn cross<'a>(a: &[FloatTerm<'a>], b: &[FloatTerm<'a>]) -> Vec<FloatTerm<'a>> {
    math::cross([a[0], a[1], a[2]], [b[0], b[1], b[2]]).to_vec()
}

fn square<'a>(components: &[FloatTerm<'a>]) -> Matrix<FloatTerm<'a>> {
    Matrix::new(components, components.len().isqrt())
}

// Functions of `math`, for terms of any lifetime.
macro_rules! unary {
    ($function:ident) => {
        Unary(|x| math::$function(x))
    };
}
macro_rules! binary {
    ($function:ident) => {
        Binary(|x, y| math::$function(x, y))
    };
}
macro_rules! ternary {
    ($function:ident) => {
        Ternary(|x, y, z| math::$function(x, y, z))
    };
}

macro_rules! built_ins {
    ($($variant:ident [$signature:literal $(, $more:literal)* $(,)?] { $($field:ident: $value:expr),* $(,)? },)*) => {
        /// A built-in function: all overloads of one name.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum BuiltIn {
            $(#[doc = concat!("`", $signature, "`")] $variant,)*
        }

        impl BuiltIn {
            /// All built-in functions.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            pub(super) fn row(self) -> &'static Row {
                match self {
                    $(Self::$variant => const {
                        &Row {
                            $($field: $value,)*
                            ..Row::new(&[$signature $(, $more)*])
                        }
                    },)*
                }
            }
        }
    };
}

built_ins! {
    // §8.1 Angle and trigonometry
    Radians ["genType radians(genType)"] {
        constant: Float(f64::to_radians),
        exact: &[ext("Radians", unary!(radians))],
    },
    Degrees ["genType degrees(genType)"] {
        constant: Float(f64::to_degrees),
        exact: &[ext("Degrees", unary!(degrees))],
    },
    Sin ["genType sin(genType)"] { constant: Float(libm::sin), exact: &[ext("Sin", unary!(sin))] },
    Cos ["genType cos(genType)"] { constant: Float(libm::cos), exact: &[ext("Cos", unary!(cos))] },
    Tan ["genType tan(genType)"] { constant: Float(libm::tan), exact: &[ext("Tan", unary!(tan))] },
    Asin ["genType asin(genType)"] { constant: Float(libm::asin), exact: &[ext("Asin", unary!(asin))] },
    Acos ["genType acos(genType)"] { constant: Float(libm::acos), exact: &[ext("Acos", unary!(acos))] },
    Atan ["genType atan(genType, genType)", "genType atan(genType)"] {
        constant: Scalars(constant::atan),
        wgsl: Special,
        exact: &[ext("Atan", unary!(atan)), ext("Atan2", binary!(atan2))],
    },
    Sinh ["genType sinh(genType)"] { constant: Float(libm::sinh), exact: &[ext("Sinh", unary!(sinh))] },
    Cosh ["genType cosh(genType)"] { constant: Float(libm::cosh), exact: &[ext("Cosh", unary!(cosh))] },
    Tanh ["genType tanh(genType)"] { constant: Float(libm::tanh), exact: &[ext("Tanh", unary!(tanh))] },
    Asinh ["genType asinh(genType)"] { constant: Float(libm::asinh), exact: &[ext("Asinh", unary!(asinh))] },
    Acosh ["genType acosh(genType)"] { constant: Float(libm::acosh), exact: &[ext("Acosh", unary!(acosh))] },
    Atanh ["genType atanh(genType)"] { constant: Float(libm::atanh), exact: &[ext("Atanh", unary!(atanh))] },
    // §8.2 Exponential
    Pow ["genType pow(genType, genType)"] {
        constant: Scalars(constant::pow),
        exact: &[ext("Pow", binary!(pow))],
    },
    Exp ["genType exp(genType)"] { constant: Float(libm::exp), exact: &[ext("Exp", unary!(exp))] },
    Log ["genType log(genType)"] { constant: Float(libm::log), exact: &[ext("Log", unary!(log))] },
    Exp2 ["genType exp2(genType)"] { constant: Float(libm::exp2), exact: &[ext("Exp2", unary!(exp2))] },
    Log2 ["genType log2(genType)"] { constant: Float(libm::log2), exact: &[ext("Log2", unary!(log2))] },
    Sqrt ["genType sqrt(genType)"] { constant: Float(f64::sqrt) },
    InverseSqrt ["genType inversesqrt(genType)"] {
        constant: Float(|x| 1.0 / x.sqrt()),
        wgsl: Named("inverseSqrt"),
        exact: &[ext("InverseSqrt", unary!(inverse_sqrt))],
    },
    // §8.3 Common
    Abs ["genType abs(genType)", "genIType abs(genIType)"] { constant: Scalars(constant::abs) },
    Sign ["genType sign(genType)", "genIType sign(genIType)"] { constant: Scalars(constant::sign) },
    Floor ["genType floor(genType)"] { constant: Float(f64::floor) },
    Trunc ["genType trunc(genType)"] { constant: Float(f64::trunc) },
    Round ["genType round(genType)"] { constant: Float(f64::round) },
    RoundEven ["genType roundEven(genType)"] { constant: Float(f64::round_ties_even), wgsl: Named("round") },
    Ceil ["genType ceil(genType)"] { constant: Float(f64::ceil) },
    Fract ["genType fract(genType)"] {
        constant: Float(|x| x - x.floor()),
        exact: &[ext("Fract", unary!(fract))],
    },
    Mod ["genType mod(genType, genType)", "genType mod(genType, float)"] {
        constant: Float2(|x, y| x - y * (x / y).floor()),
        wgsl: Special,
        exact: &[core("FMod", binary!(modulo))],
    },
    Modf ["genType modf(genType, genType)"] { wgsl: Missing },
    Min [
        "genType min(genType, genType)",
        "genType min(genType, float)",
        "genIType min(genIType, genIType)",
        "genIType min(genIType, int)",
        "genUType min(genUType, genUType)",
        "genUType min(genUType, uint)",
    ] { constant: Scalars(constant::min), wgsl: Splat },
    Max [
        "genType max(genType, genType)",
        "genType max(genType, float)",
        "genIType max(genIType, genIType)",
        "genIType max(genIType, int)",
        "genUType max(genUType, genUType)",
        "genUType max(genUType, uint)",
    ] { constant: Scalars(constant::max), wgsl: Splat },
    Clamp [
        "genType clamp(genType, genType, genType)",
        "genType clamp(genType, float, float)",
        "genIType clamp(genIType, genIType, genIType)",
        "genIType clamp(genIType, int, int)",
        "genUType clamp(genUType, genUType, genUType)",
        "genUType clamp(genUType, uint, uint)",
    ] { constant: Scalars(constant::clamp), wgsl: Splat },
    Mix [
        "genType mix(genType, genType, genType)",
        "genType mix(genType, genType, float)",
        "genType mix(genType, genType, genBType)",
    ] { constant: Scalars(constant::mix), wgsl: Special, exact: &[ext("FMix", ternary!(mix))] },
    Step ["genType step(genType, genType)", "genType step(float, genType)"] {
        constant: Float2(|edge, x| f64::from(u8::from(x >= edge))),
        wgsl: Splat,
        exact: &[ext("Step", binary!(step))],
    },
    Smoothstep [
        "genType smoothstep(genType, genType, genType)",
        "genType smoothstep(float, float, genType)",
    ] {
        constant: Scalars(constant::smoothstep),
        wgsl: Splat,
        exact: &[ext("SmoothStep", ternary!(smoothstep))],
    },
    IsNan ["genBType isnan(genType)"] {
        constant: Scalars(|x| Some(Value::Bool(constant::float(x)?.is_nan()))),
        wgsl: Missing,
    },
    IsInf ["genBType isinf(genType)"] {
        constant: Scalars(|x| Some(Value::Bool(constant::float(x)?.is_infinite()))),
        wgsl: Missing,
    },
    FloatBitsToInt ["genIType floatBitsToInt(genType)"] {
        constant: Scalars(|x| Some(Value::Int((constant::float(x)? as f32).to_bits().cast_signed()))),
        wgsl: Bitcast,
    },
    FloatBitsToUint ["genUType floatBitsToUint(genType)"] {
        constant: Scalars(|x| Some(Value::Uint((constant::float(x)? as f32).to_bits()))),
        wgsl: Bitcast,
    },
    IntBitsToFloat ["genType intBitsToFloat(genIType)"] {
        constant: Scalars(constant::bits_to_float),
        wgsl: Bitcast,
    },
    UintBitsToFloat ["genType uintBitsToFloat(genUType)"] {
        constant: Scalars(constant::bits_to_float),
        wgsl: Bitcast,
    },
    // §8.4 Floating-point pack and unpack
    PackSnorm2x16 ["uint packSnorm2x16(vec2)"] { wgsl: Named("pack2x16snorm") },
    UnpackSnorm2x16 ["vec2 unpackSnorm2x16(uint)"] {
        wgsl: Named("unpack2x16snorm"),
        exact: &[ext("UnpackSnorm2x16", Glsl(
            "return vec2(max(float(int(toyproof_a << 16u) >> 16u) / 32767.0, -1.0), \
            max(float(int(toyproof_a) >> 16u) / 32767.0, -1.0));",
        ))],
    },
    PackUnorm2x16 ["uint packUnorm2x16(vec2)"] { wgsl: Named("pack2x16unorm") },
    UnpackUnorm2x16 ["vec2 unpackUnorm2x16(uint)"] {
        wgsl: Named("unpack2x16unorm"),
        exact: &[ext("UnpackUnorm2x16", Glsl(
            "return vec2(float(int(toyproof_a & 65535u)) / 65535.0, float(int(toyproof_a >> 16u)) / 65535.0);",
        ))],
    },
    PackHalf2x16 ["uint packHalf2x16(vec2)"] { wgsl: Named("pack2x16float") },
    UnpackHalf2x16 ["vec2 unpackHalf2x16(uint)"] {
        wgsl: Named("unpack2x16float"),
        exact: &[ext("UnpackHalf2x16", Glsl(
            "return vec2(unpackHalf2x16(toyproof_a).x, unpackHalf2x16(toyproof_a >> 16u).x);",
        ))],
    },
    // §8.5 Geometric
    Length ["float length(genType)"] {
        constant: OfVectors(constant::length),
        exact: &[ext("Length", Vectors(|a| vec![math::length(&a[0])]))],
    },
    Distance ["float distance(genType, genType)"] {
        constant: OfVectors(constant::distance),
        exact: &[ext("Distance", Vectors(|a| vec![math::distance(&a[0], &a[1])]))],
    },
    Dot ["float dot(genType, genType)"] {
        constant: OfVectors(constant::dot_product),
        exact: &[core("Dot", Vectors(|a| vec![math::dot(&a[0], &a[1])]))],
    },
    Cross ["vec3 cross(vec3, vec3)"] {
        constant: OfVectors(constant::cross),
        exact: &[ext("Cross", Vectors(|a| cross(&a[0], &a[1])))],
    },
    Normalize ["genType normalize(genType)"] {
        constant: OfVectors(constant::normalize),
        exact: &[ext("Normalize", Vectors(|a| math::normalize(&a[0])))],
    },
    Faceforward ["genType faceforward(genType, genType, genType)"] {
        constant: OfVectors(constant::faceforward),
        wgsl: Named("faceForward"),
        exact: &[ext("FaceForward", Vectors(|a| math::faceforward(&a[0], &a[1], &a[2])))],
    },
    Reflect ["genType reflect(genType, genType)"] {
        constant: OfVectors(constant::reflect),
        exact: &[ext("Reflect", Vectors(|a| math::reflect(&a[0], &a[1])))],
    },
    Refract ["genType refract(genType, genType, float)"] {
        constant: OfVectors(constant::refract),
        exact: &[ext("Refract", Vectors(|a| math::refract(&a[0], &a[1], a[2][0])))],
    },
    // §8.6 Matrix
    MatrixCompMult ["mat matrixCompMult(mat, mat)"] { constant: Float2(|a, b| a * b), wgsl: Missing },
    OuterProduct [
        "mat2 outerProduct(vec2, vec2)",
        "mat3 outerProduct(vec3, vec3)",
        "mat4 outerProduct(vec4, vec4)",
        "mat2x3 outerProduct(vec3, vec2)",
        "mat3x2 outerProduct(vec2, vec3)",
        "mat2x4 outerProduct(vec4, vec2)",
        "mat4x2 outerProduct(vec2, vec4)",
        "mat3x4 outerProduct(vec4, vec3)",
        "mat4x3 outerProduct(vec3, vec4)",
    ] { constant: OfVectors(constant::outer_product), wgsl: Missing },
    Transpose [
        "mat2 transpose(mat2)",
        "mat3 transpose(mat3)",
        "mat4 transpose(mat4)",
        "mat2x3 transpose(mat3x2)",
        "mat3x2 transpose(mat2x3)",
        "mat2x4 transpose(mat4x2)",
        "mat4x2 transpose(mat2x4)",
        "mat3x4 transpose(mat4x3)",
        "mat4x3 transpose(mat3x4)",
    ] { constant: OfMatrix(constant::transpose) },
    Determinant ["float determinant(mat2)", "float determinant(mat3)", "float determinant(mat4)"] {
        constant: OfMatrix(|m, rows| vec![math::determinant(&math::Matrix::new(m, rows))]),
        exact: &[ext("Determinant", Vectors(|a| vec![math::determinant(&square(&a[0]))]))],
    },
    Inverse ["mat2 inverse(mat2)", "mat3 inverse(mat3)", "mat4 inverse(mat4)"] {
        constant: OfMatrix(|m, rows| math::inverse(&math::Matrix::new(m, rows)).components()),
        wgsl: Missing,
        exact: &[ext("MatrixInverse", Vectors(|a| math::inverse(&square(&a[0])).components()))],
    },
    // §8.7 Vector relational
    LessThan [
        "bvec lessThan(vec, vec)",
        "bvec lessThan(ivec, ivec)",
        "bvec lessThan(uvec, uvec)",
    ] { constant: Scalars(|x| constant::compare(x, Ordering::is_lt)), wgsl: Operator(BinaryOp::Less) },
    LessThanEqual [
        "bvec lessThanEqual(vec, vec)",
        "bvec lessThanEqual(ivec, ivec)",
        "bvec lessThanEqual(uvec, uvec)",
    ] { constant: Scalars(|x| constant::compare(x, Ordering::is_le)), wgsl: Operator(BinaryOp::LessEqual) },
    GreaterThan [
        "bvec greaterThan(vec, vec)",
        "bvec greaterThan(ivec, ivec)",
        "bvec greaterThan(uvec, uvec)",
    ] { constant: Scalars(|x| constant::compare(x, Ordering::is_gt)), wgsl: Operator(BinaryOp::Greater) },
    GreaterThanEqual [
        "bvec greaterThanEqual(vec, vec)",
        "bvec greaterThanEqual(ivec, ivec)",
        "bvec greaterThanEqual(uvec, uvec)",
    ] {
        constant: Scalars(|x| constant::compare(x, Ordering::is_ge)),
        wgsl: Operator(BinaryOp::GreaterEqual),
    },
    Equal [
        "bvec equal(vec, vec)",
        "bvec equal(ivec, ivec)",
        "bvec equal(uvec, uvec)",
        "bvec equal(bvec, bvec)",
    ] { constant: Scalars(|x| constant::equal(x, true)), wgsl: Operator(BinaryOp::Equal) },
    NotEqual [
        "bvec notEqual(vec, vec)",
        "bvec notEqual(ivec, ivec)",
        "bvec notEqual(uvec, uvec)",
        "bvec notEqual(bvec, bvec)",
    ] { constant: Scalars(|x| constant::equal(x, false)), wgsl: Operator(BinaryOp::NotEqual) },
    Any ["bool any(bvec)"] { constant: Booleans(|all| all.contains(&true)) },
    All ["bool all(bvec)"] { constant: Booleans(|all| !all.contains(&false)) },
    Not ["bvec not(bvec)"] { constant: Scalars(constant::not), wgsl: Special },
    // §8.8 Texture lookup: all functions from here to the next section, as `BuiltIn::is_texture` assumes.
    TextureSize [
        "ivec2 textureSize(gsampler2D, int)",
        "ivec3 textureSize(gsampler3D, int)",
        "ivec2 textureSize(gsamplerCube, int)",
        "ivec3 textureSize(gsampler2DArray, int)",
        "ivec2 textureSize(sampler2DShadow, int)",
        "ivec2 textureSize(samplerCubeShadow, int)",
        "ivec3 textureSize(sampler2DArrayShadow, int)",
    ] {},
    Texture [
        "gvec4 texture(gsampler2D, vec2, [float])",
        "gvec4 texture(gsampler3D, vec3, [float])",
        "gvec4 texture(gsamplerCube, vec3, [float])",
        "gvec4 texture(gsampler2DArray, vec3, [float])",
        "float texture(sampler2DShadow, vec3, [float])",
        "float texture(samplerCubeShadow, vec4, [float])",
        "float texture(sampler2DArrayShadow, vec4)",
    ] {},
    TextureProj [
        "gvec4 textureProj(gsampler2D, vec3, [float])",
        "gvec4 textureProj(gsampler2D, vec4, [float])",
        "gvec4 textureProj(gsampler3D, vec4, [float])",
        "float textureProj(sampler2DShadow, vec4, [float])",
    ] {},
    TextureLod [
        "gvec4 textureLod(gsampler2D, vec2, float)",
        "gvec4 textureLod(gsampler3D, vec3, float)",
        "gvec4 textureLod(gsamplerCube, vec3, float)",
        "gvec4 textureLod(gsampler2DArray, vec3, float)",
        "float textureLod(sampler2DShadow, vec3, float)",
    ] {},
    TextureOffset [
        "gvec4 textureOffset(gsampler2D, vec2, const ivec2, [float])",
        "gvec4 textureOffset(gsampler3D, vec3, const ivec3, [float])",
        "gvec4 textureOffset(gsampler2DArray, vec3, const ivec2, [float])",
        "float textureOffset(sampler2DShadow, vec3, const ivec2, [float])",
    ] {},
    TexelFetch [
        "gvec4 texelFetch(gsampler2D, ivec2, int)",
        "gvec4 texelFetch(gsampler3D, ivec3, int)",
        "gvec4 texelFetch(gsampler2DArray, ivec3, int)",
    ] {},
    TexelFetchOffset [
        "gvec4 texelFetchOffset(gsampler2D, ivec2, int, const ivec2)",
        "gvec4 texelFetchOffset(gsampler3D, ivec3, int, const ivec3)",
        "gvec4 texelFetchOffset(gsampler2DArray, ivec3, int, const ivec2)",
    ] {},
    TextureProjOffset [
        "gvec4 textureProjOffset(gsampler2D, vec3, const ivec2, [float])",
        "gvec4 textureProjOffset(gsampler2D, vec4, const ivec2, [float])",
        "gvec4 textureProjOffset(gsampler3D, vec4, const ivec3, [float])",
        "float textureProjOffset(sampler2DShadow, vec4, const ivec2, [float])",
    ] {},
    TextureLodOffset [
        "gvec4 textureLodOffset(gsampler2D, vec2, float, const ivec2)",
        "gvec4 textureLodOffset(gsampler3D, vec3, float, const ivec3)",
        "gvec4 textureLodOffset(gsampler2DArray, vec3, float, const ivec2)",
        "float textureLodOffset(sampler2DShadow, vec3, float, const ivec2)",
    ] {},
    TextureProjLod [
        "gvec4 textureProjLod(gsampler2D, vec3, float)",
        "gvec4 textureProjLod(gsampler2D, vec4, float)",
        "gvec4 textureProjLod(gsampler3D, vec4, float)",
        "float textureProjLod(sampler2DShadow, vec4, float)",
    ] {},
    TextureProjLodOffset [
        "gvec4 textureProjLodOffset(gsampler2D, vec3, float, const ivec2)",
        "gvec4 textureProjLodOffset(gsampler2D, vec4, float, const ivec2)",
        "gvec4 textureProjLodOffset(gsampler3D, vec4, float, const ivec3)",
        "float textureProjLodOffset(sampler2DShadow, vec4, float, const ivec2)",
    ] {},
    TextureGrad [
        "gvec4 textureGrad(gsampler2D, vec2, vec2, vec2)",
        "gvec4 textureGrad(gsampler3D, vec3, vec3, vec3)",
        "gvec4 textureGrad(gsamplerCube, vec3, vec3, vec3)",
        "gvec4 textureGrad(gsampler2DArray, vec3, vec2, vec2)",
        "float textureGrad(sampler2DShadow, vec3, vec2, vec2)",
        "float textureGrad(samplerCubeShadow, vec4, vec3, vec3)",
        "float textureGrad(sampler2DArrayShadow, vec4, vec2, vec2)",
    ] {},
    TextureGradOffset [
        "gvec4 textureGradOffset(gsampler2D, vec2, vec2, vec2, const ivec2)",
        "gvec4 textureGradOffset(gsampler3D, vec3, vec3, vec3, const ivec3)",
        "gvec4 textureGradOffset(gsampler2DArray, vec3, vec2, vec2, const ivec2)",
        "float textureGradOffset(sampler2DShadow, vec3, vec2, vec2, const ivec2)",
        "float textureGradOffset(sampler2DArrayShadow, vec4, vec2, vec2, const ivec2)",
    ] {},
    TextureProjGrad [
        "gvec4 textureProjGrad(gsampler2D, vec3, vec2, vec2)",
        "gvec4 textureProjGrad(gsampler2D, vec4, vec2, vec2)",
        "gvec4 textureProjGrad(gsampler3D, vec4, vec3, vec3)",
        "float textureProjGrad(sampler2DShadow, vec4, vec2, vec2)",
    ] {},
    TextureProjGradOffset [
        "gvec4 textureProjGradOffset(gsampler2D, vec3, vec2, vec2, const ivec2)",
        "gvec4 textureProjGradOffset(gsampler2D, vec4, vec2, vec2, const ivec2)",
        "gvec4 textureProjGradOffset(gsampler3D, vec4, vec3, vec3, const ivec3)",
        "float textureProjGradOffset(sampler2DShadow, vec4, vec2, vec2, const ivec2)",
    ] {},
    // §8.9 Fragment processing
    DFdx ["genType dFdx(genType)"] { constant: Float(|_| 0.0), wgsl: Named("dpdx") },
    DFdy ["genType dFdy(genType)"] { constant: Float(|_| 0.0), wgsl: Special },
    Fwidth ["genType fwidth(genType)"] { constant: Float(|_| 0.0) },
}
