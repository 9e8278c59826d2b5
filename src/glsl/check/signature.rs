//! The signatures of the built-in functions (§8), parsed from a table in the notation of the specification.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::keywords::{Interner, Word};
use crate::tree::{BuiltIn, Sampler, SamplerShape, Scalar, Type};

/// A signature that accepts given arguments.
pub(super) struct Match {
    pub(super) result: Type,
    pub(super) parameters: Vec<Type>,
    /// The index of the argument that must be a constant expression, if any.
    pub(super) constant: Option<usize>,
}

impl BuiltIn {
    /// The built-in function with that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        NAMES.get(name).copied()
    }

    /// The type of its value for arguments of these types; `None` if no signature accepts exactly them.
    #[must_use]
    pub fn result(self, arguments: &[Type]) -> Option<Type> {
        find(self, arguments, |given, wanted| given == wanted).map(|found| found.result)
    }
}

/// The first signature of a function for whose parameters `fit(given, parameter)` holds for all arguments.
pub(super) fn find(function: BuiltIn, types: &[Type], fit: impl Fn(Type, Type) -> bool) -> Option<Match> {
    SIGNATURES.get(&function)?.iter().find_map(|signature| {
        let parameters = &signature.parameters;
        if types.len() > parameters.len() || types.len() < signature.required {
            return None;
        }
        let mut bindings = Bindings::default();
        let mut wanted = Vec::with_capacity(types.len());
        for (&given, parameter) in types.iter().zip(parameters) {
            let ty = parameter.for_argument(given, &mut bindings)?;
            if !fit(given, ty) {
                return None;
            }
            wanted.push(ty);
        }
        Some(Match {
            result: signature.result.of(&bindings)?,
            parameters: wanted,
            constant: signature.constant.filter(|&index| index < types.len()),
        })
    })
}

/// The parameters of every signature with that number of arguments, as far as the arguments determine the
/// generic types.
pub(super) fn candidates(function: BuiltIn, types: &[Type]) -> Vec<Vec<Type>> {
    let signatures = SIGNATURES.get(&function).into_iter().flatten();
    let fitting = signatures
        .filter(|signature| (signature.required..=signature.parameters.len()).contains(&types.len()));
    fitting
        .filter_map(|signature| {
            let mut bindings = Bindings::default();
            let parameters = signature.parameters.iter().zip(types);
            parameters
                .map(|(parameter, &given)| parameter.for_argument(given, &mut bindings))
                .collect()
        })
        .collect()
}

/// The numbers of arguments that a function accepts.
pub(super) fn counts(function: BuiltIn) -> Vec<usize> {
    let signatures = SIGNATURES.get(&function).into_iter().flatten();
    signatures
        .flat_map(|signature| signature.required..=signature.parameters.len())
        .collect()
}

#[derive(Debug)]
struct Signature {
    result: Pattern,
    parameters: Vec<Pattern>,
    /// The number of parameters that are not optional.
    required: usize,
    constant: Option<usize>,
}

/// A type in a signature.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pattern {
    Exactly(Type),
    /// `genType`, `genIType`, `genUType`, `genBType`.
    Gen(Scalar),
    /// `vec`, `ivec`, `uvec`, `bvec`.
    Vec(Scalar),
    /// `mat`.
    Matrix,
    /// `gsampler2D` and other generic samplers.
    Sampler(SamplerShape),
    /// `gvec4`.
    Texel,
}

/// The bindings of the generic types, which are the same throughout one signature.
#[derive(Default)]
struct Bindings {
    size: Option<u8>,
    matrix: Option<Type>,
    texel: Option<Scalar>,
}

impl Pattern {
    /// Binds the pattern's generic type to the argument's unless it is bound, and returns the parameter's
    /// type.
    fn for_argument(self, given: Type, bindings: &mut Bindings) -> Option<Type> {
        match (self, given) {
            (Self::Gen(_), Type::Scalar(_)) => bindings.size = bindings.size.or(Some(1)),
            (Self::Gen(_) | Self::Vec(_), Type::Vector(_, size)) => {
                bindings.size = bindings.size.or(Some(size));
            }
            (Self::Matrix, Type::Matrix { .. }) => bindings.matrix = bindings.matrix.or(Some(given)),
            (Self::Sampler(_), Type::Sampler(sampler)) => {
                bindings.texel = Some(sampler.texel);
            }
            _ => {}
        }
        self.of(bindings)
    }

    fn of(self, bindings: &Bindings) -> Option<Type> {
        match self {
            Self::Exactly(ty) => Some(ty),
            Self::Gen(scalar) => Some(Type::vector(scalar, bindings.size?)),
            Self::Vec(scalar) => bindings
                .size
                .filter(|&size| size > 1)
                .map(|size| Type::Vector(scalar, size)),
            Self::Matrix => bindings.matrix,
            Self::Sampler(shape) => Some(Type::Sampler(Sampler {
                texel: bindings.texel?,
                shape,
                shadow: false,
            })),
            Self::Texel => Some(Type::Vector(bindings.texel?, 4)),
        }
    }

    fn parse(word: &str, interner: &Interner) -> Option<Self> {
        Some(match word {
            "genType" => Self::Gen(Scalar::Float),
            "genIType" => Self::Gen(Scalar::Int),
            "genUType" => Self::Gen(Scalar::Uint),
            "genBType" => Self::Gen(Scalar::Bool),
            "vec" => Self::Vec(Scalar::Float),
            "ivec" => Self::Vec(Scalar::Int),
            "uvec" => Self::Vec(Scalar::Uint),
            "bvec" => Self::Vec(Scalar::Bool),
            "mat" => Self::Matrix,
            "gvec4" => Self::Texel,
            _ => match (
                word.strip_prefix('g'),
                interner.word(interner.find(word.strip_prefix('g').unwrap_or(word))?),
            ) {
                (Some(_), Word::Type(Type::Sampler(sampler))) => Self::Sampler(sampler.shape),
                (None, Word::Type(ty)) => Self::Exactly(ty),
                _ => return None,
            },
        })
    }
}

impl Signature {
    /// Parses a line of the table.
    fn parse(line: &str, interner: &Interner) -> Option<(BuiltIn, Self)> {
        let (result, rest) = line.split_once(' ')?;
        let (name, parameters) = rest.strip_suffix(')')?.split_once('(')?;
        let mut signature = Self {
            result: Pattern::parse(result, interner)?,
            parameters: Vec::new(),
            required: 0,
            constant: None,
        };
        for (index, parameter) in parameters.split(", ").enumerate() {
            let optional = parameter
                .strip_prefix('[')
                .and_then(|word| word.strip_suffix(']'));
            let constant = parameter.strip_prefix("const ");
            if constant.is_some() {
                signature.constant = Some(index);
            }
            if optional.is_none() {
                signature.required = index + 1;
            }
            let word = optional.or(constant).unwrap_or(parameter);
            signature.parameters.push(Pattern::parse(word, interner)?);
        }
        Some((BuiltIn::named(name)?, signature))
    }
}

static NAMES: LazyLock<HashMap<&str, BuiltIn>> = LazyLock::new(|| {
    BuiltIn::ALL
        .iter()
        .map(|&function| (function.name(), function))
        .collect()
});

static SIGNATURES: LazyLock<HashMap<BuiltIn, Vec<Signature>>> = LazyLock::new(|| {
    let interner = Interner::default();
    let mut signatures: HashMap<_, Vec<_>> = HashMap::new();
    for (function, signature) in lines().filter_map(|line| Signature::parse(line, &interner)) {
        signatures.entry(function).or_default().push(signature);
    }
    signatures
});

fn lines() -> impl Iterator<Item = &'static str> {
    TABLE.lines().map(str::trim).filter(|line| !line.is_empty())
}

// The table of signatures, in the order of §8.

/// One signature per line. `genType` and similar types match a scalar and its vectors, `vec` the vectors
/// alone, `mat` any matrix, `g` before `sampler` and `vec4` any of the three texel types; each has the same
/// binding throughout one signature. `[float]` is optional; `const` requires a constant expression. The first
/// line that matches applies.
const TABLE: &str = "
    genType radians(genType)
    genType degrees(genType)
    genType sin(genType)
    genType cos(genType)
    genType tan(genType)
    genType asin(genType)
    genType acos(genType)
    genType atan(genType, genType)
    genType atan(genType)
    genType sinh(genType)
    genType cosh(genType)
    genType tanh(genType)
    genType asinh(genType)
    genType acosh(genType)
    genType atanh(genType)

    genType pow(genType, genType)
    genType exp(genType)
    genType log(genType)
    genType exp2(genType)
    genType log2(genType)
    genType sqrt(genType)
    genType inversesqrt(genType)

    genType abs(genType)
    genIType abs(genIType)
    genType sign(genType)
    genIType sign(genIType)
    genType floor(genType)
    genType trunc(genType)
    genType round(genType)
    genType roundEven(genType)
    genType ceil(genType)
    genType fract(genType)
    genType mod(genType, genType)
    genType mod(genType, float)
    genType modf(genType, genType)
    genType min(genType, genType)
    genType min(genType, float)
    genIType min(genIType, genIType)
    genIType min(genIType, int)
    genUType min(genUType, genUType)
    genUType min(genUType, uint)
    genType max(genType, genType)
    genType max(genType, float)
    genIType max(genIType, genIType)
    genIType max(genIType, int)
    genUType max(genUType, genUType)
    genUType max(genUType, uint)
    genType clamp(genType, genType, genType)
    genType clamp(genType, float, float)
    genIType clamp(genIType, genIType, genIType)
    genIType clamp(genIType, int, int)
    genUType clamp(genUType, genUType, genUType)
    genUType clamp(genUType, uint, uint)
    genType mix(genType, genType, genType)
    genType mix(genType, genType, float)
    genType mix(genType, genType, genBType)
    genType step(genType, genType)
    genType step(float, genType)
    genType smoothstep(genType, genType, genType)
    genType smoothstep(float, float, genType)
    genBType isnan(genType)
    genBType isinf(genType)
    genIType floatBitsToInt(genType)
    genUType floatBitsToUint(genType)
    genType intBitsToFloat(genIType)
    genType uintBitsToFloat(genUType)

    uint packSnorm2x16(vec2)
    vec2 unpackSnorm2x16(uint)
    uint packUnorm2x16(vec2)
    vec2 unpackUnorm2x16(uint)
    uint packHalf2x16(vec2)
    vec2 unpackHalf2x16(uint)

    float length(genType)
    float distance(genType, genType)
    float dot(genType, genType)
    vec3 cross(vec3, vec3)
    genType normalize(genType)
    genType faceforward(genType, genType, genType)
    genType reflect(genType, genType)
    genType refract(genType, genType, float)

    mat matrixCompMult(mat, mat)
    mat2 outerProduct(vec2, vec2)
    mat3 outerProduct(vec3, vec3)
    mat4 outerProduct(vec4, vec4)
    mat2x3 outerProduct(vec3, vec2)
    mat3x2 outerProduct(vec2, vec3)
    mat2x4 outerProduct(vec4, vec2)
    mat4x2 outerProduct(vec2, vec4)
    mat3x4 outerProduct(vec4, vec3)
    mat4x3 outerProduct(vec3, vec4)
    mat2 transpose(mat2)
    mat3 transpose(mat3)
    mat4 transpose(mat4)
    mat2x3 transpose(mat3x2)
    mat3x2 transpose(mat2x3)
    mat2x4 transpose(mat4x2)
    mat4x2 transpose(mat2x4)
    mat3x4 transpose(mat4x3)
    mat4x3 transpose(mat3x4)
    float determinant(mat2)
    float determinant(mat3)
    float determinant(mat4)
    mat2 inverse(mat2)
    mat3 inverse(mat3)
    mat4 inverse(mat4)

    bvec lessThan(vec, vec)
    bvec lessThan(ivec, ivec)
    bvec lessThan(uvec, uvec)
    bvec lessThanEqual(vec, vec)
    bvec lessThanEqual(ivec, ivec)
    bvec lessThanEqual(uvec, uvec)
    bvec greaterThan(vec, vec)
    bvec greaterThan(ivec, ivec)
    bvec greaterThan(uvec, uvec)
    bvec greaterThanEqual(vec, vec)
    bvec greaterThanEqual(ivec, ivec)
    bvec greaterThanEqual(uvec, uvec)
    bvec equal(vec, vec)
    bvec equal(ivec, ivec)
    bvec equal(uvec, uvec)
    bvec equal(bvec, bvec)
    bvec notEqual(vec, vec)
    bvec notEqual(ivec, ivec)
    bvec notEqual(uvec, uvec)
    bvec notEqual(bvec, bvec)
    bool any(bvec)
    bool all(bvec)
    bvec not(bvec)

    ivec2 textureSize(gsampler2D, int)
    ivec3 textureSize(gsampler3D, int)
    ivec2 textureSize(gsamplerCube, int)
    ivec3 textureSize(gsampler2DArray, int)
    ivec2 textureSize(sampler2DShadow, int)
    ivec2 textureSize(samplerCubeShadow, int)
    ivec3 textureSize(sampler2DArrayShadow, int)
    gvec4 texture(gsampler2D, vec2, [float])
    gvec4 texture(gsampler3D, vec3, [float])
    gvec4 texture(gsamplerCube, vec3, [float])
    gvec4 texture(gsampler2DArray, vec3, [float])
    float texture(sampler2DShadow, vec3, [float])
    float texture(samplerCubeShadow, vec4, [float])
    float texture(sampler2DArrayShadow, vec4)
    gvec4 textureProj(gsampler2D, vec3, [float])
    gvec4 textureProj(gsampler2D, vec4, [float])
    gvec4 textureProj(gsampler3D, vec4, [float])
    float textureProj(sampler2DShadow, vec4, [float])
    gvec4 textureLod(gsampler2D, vec2, float)
    gvec4 textureLod(gsampler3D, vec3, float)
    gvec4 textureLod(gsamplerCube, vec3, float)
    gvec4 textureLod(gsampler2DArray, vec3, float)
    float textureLod(sampler2DShadow, vec3, float)
    gvec4 textureOffset(gsampler2D, vec2, const ivec2, [float])
    gvec4 textureOffset(gsampler3D, vec3, const ivec3, [float])
    gvec4 textureOffset(gsampler2DArray, vec3, const ivec2, [float])
    float textureOffset(sampler2DShadow, vec3, const ivec2, [float])
    gvec4 texelFetch(gsampler2D, ivec2, int)
    gvec4 texelFetch(gsampler3D, ivec3, int)
    gvec4 texelFetch(gsampler2DArray, ivec3, int)
    gvec4 texelFetchOffset(gsampler2D, ivec2, int, const ivec2)
    gvec4 texelFetchOffset(gsampler3D, ivec3, int, const ivec3)
    gvec4 texelFetchOffset(gsampler2DArray, ivec3, int, const ivec2)
    gvec4 textureProjOffset(gsampler2D, vec3, const ivec2, [float])
    gvec4 textureProjOffset(gsampler2D, vec4, const ivec2, [float])
    gvec4 textureProjOffset(gsampler3D, vec4, const ivec3, [float])
    float textureProjOffset(sampler2DShadow, vec4, const ivec2, [float])
    gvec4 textureLodOffset(gsampler2D, vec2, float, const ivec2)
    gvec4 textureLodOffset(gsampler3D, vec3, float, const ivec3)
    gvec4 textureLodOffset(gsampler2DArray, vec3, float, const ivec2)
    float textureLodOffset(sampler2DShadow, vec3, float, const ivec2)
    gvec4 textureProjLod(gsampler2D, vec3, float)
    gvec4 textureProjLod(gsampler2D, vec4, float)
    gvec4 textureProjLod(gsampler3D, vec4, float)
    float textureProjLod(sampler2DShadow, vec4, float)
    gvec4 textureProjLodOffset(gsampler2D, vec3, float, const ivec2)
    gvec4 textureProjLodOffset(gsampler2D, vec4, float, const ivec2)
    gvec4 textureProjLodOffset(gsampler3D, vec4, float, const ivec3)
    float textureProjLodOffset(sampler2DShadow, vec4, float, const ivec2)
    gvec4 textureGrad(gsampler2D, vec2, vec2, vec2)
    gvec4 textureGrad(gsampler3D, vec3, vec3, vec3)
    gvec4 textureGrad(gsamplerCube, vec3, vec3, vec3)
    gvec4 textureGrad(gsampler2DArray, vec3, vec2, vec2)
    float textureGrad(sampler2DShadow, vec3, vec2, vec2)
    float textureGrad(samplerCubeShadow, vec4, vec3, vec3)
    float textureGrad(sampler2DArrayShadow, vec4, vec2, vec2)
    gvec4 textureGradOffset(gsampler2D, vec2, vec2, vec2, const ivec2)
    gvec4 textureGradOffset(gsampler3D, vec3, vec3, vec3, const ivec3)
    gvec4 textureGradOffset(gsampler2DArray, vec3, vec2, vec2, const ivec2)
    float textureGradOffset(sampler2DShadow, vec3, vec2, vec2, const ivec2)
    float textureGradOffset(sampler2DArrayShadow, vec4, vec2, vec2, const ivec2)
    gvec4 textureProjGrad(gsampler2D, vec3, vec2, vec2)
    gvec4 textureProjGrad(gsampler2D, vec4, vec2, vec2)
    gvec4 textureProjGrad(gsampler3D, vec4, vec3, vec3)
    float textureProjGrad(sampler2DShadow, vec4, vec2, vec2)
    gvec4 textureProjGradOffset(gsampler2D, vec3, vec2, vec2, const ivec2)
    gvec4 textureProjGradOffset(gsampler2D, vec4, vec2, vec2, const ivec2)
    gvec4 textureProjGradOffset(gsampler3D, vec4, vec3, vec3, const ivec3)
    float textureProjGradOffset(sampler2DShadow, vec4, vec2, vec2, const ivec2)

    genType dFdx(genType)
    genType dFdy(genType)
    genType fwidth(genType)
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_parses_and_every_function_has_a_signature() {
        let read: usize = SIGNATURES.values().map(Vec::len).sum();
        assert_eq!(read, lines().count());
        for function in BuiltIn::ALL {
            assert!(SIGNATURES.contains_key(function), "{}", function.name());
        }
    }

    #[test]
    fn generic_types_bind_consistently() {
        let vec = |size| Type::vector(Scalar::Float, size);
        let result =
            |function, types: &[Type]| find(function, types, |a, b| a == b).map(|found| found.result);
        assert_eq!(result(BuiltIn::Mod, &[vec(3), vec(3)]), Some(vec(3)));
        assert_eq!(result(BuiltIn::Mod, &[vec(3), vec(1)]), Some(vec(3)));
        assert_eq!(result(BuiltIn::Mod, &[vec(3), vec(2)]), None);
        assert_eq!(result(BuiltIn::Mod, &[vec(1), vec(3)]), None);
        assert_eq!(result(BuiltIn::LessThan, &[vec(1), vec(1)]), None);
        assert_eq!(result(BuiltIn::Dot, &[vec(1), vec(1)]), Some(vec(1)));
        let isampler = Type::Sampler(Sampler {
            texel: Scalar::Int,
            ..Sampler::D2
        });
        assert_eq!(
            result(BuiltIn::Texture, &[isampler, vec(2)]),
            Some(Type::Vector(Scalar::Int, 4))
        );
        assert_eq!(
            result(BuiltIn::Texture, &[isampler, vec(2), vec(1)]),
            Some(Type::Vector(Scalar::Int, 4))
        );
        assert_eq!(result(BuiltIn::Texture, &[isampler, vec(3)]), None);
    }
}
