//! Names from other languages and other GLSL versions, and what to write instead.

use toyproof_diagnostic::{Diagnostic, Fix, Span};

use crate::tree::Place;

/// `LANGUAGE: NAME = replacement`, one per line. A plain word after `=` is a GLSL name.
const TABLE: &str = "
    HLSL: half = float
    HLSL: half2 = vec2
    HLSL: half3 = vec3
    HLSL: half4 = vec4
    HLSL: fixed = float
    HLSL: fixed2 = vec2
    HLSL: fixed3 = vec3
    HLSL: fixed4 = vec4
    HLSL: float1 = float
    HLSL: float2 = vec2
    HLSL: float3 = vec3
    HLSL: float4 = vec4
    HLSL: int2 = ivec2
    HLSL: int3 = ivec3
    HLSL: int4 = ivec4
    HLSL: uint2 = uvec2
    HLSL: uint3 = uvec3
    HLSL: uint4 = uvec4
    HLSL: bool2 = bvec2
    HLSL: bool3 = bvec3
    HLSL: bool4 = bvec4
    HLSL: float2x2 = mat2
    HLSL: float3x3 = mat3
    HLSL: float4x4 = mat4
    HLSL: Texture2D = sampler2D
    HLSL: lerp = mix
    HLSL: frac = fract
    HLSL: rsqrt = inversesqrt
    HLSL: ddx = dFdx
    HLSL: ddy = dFdy
    HLSL: tex2D = texture
    HLSL: tex2Dlod = textureLod
    HLSL: tex2Dgrad = textureGrad
    HLSL: texCUBE = texture
    HLSL: asint = floatBitsToInt
    HLSL: asuint = floatBitsToUint
    HLSL: asfloat = intBitsToFloat
    HLSL: saturate = `clamp(x, 0.0, 1.0)`
    HLSL: atan2 = `atan(y, x)`
    HLSL: fmod = `mod(x, y)`, whose result has the sign of `y`
    HLSL: mul = `a * b`
    HLSL: mad = `a * b + c`
    HLSL: rcp = `1.0 / x`
    HLSL: log10 = `log(x) / log(10.0)`
    HLSL: clip = `if (x < 0.0) discard;`
    HLSL: sincos = `sin` and `cos`
    GLSL ES 1.00: texture2D = texture
    GLSL ES 1.00: texture2DLod = textureLod
    GLSL ES 1.00: texture2DLodEXT = textureLod
    GLSL ES 1.00: texture2DGradEXT = textureGrad
    GLSL ES 1.00: texture2DProj = textureProj
    GLSL ES 1.00: textureCube = texture
    GLSL ES 1.00: textureCubeLod = textureLod
    GLSL ES 1.00: textureCubeLodEXT = textureLod
    GLSL ES 1.00: gl_FragColor = the first parameter of `mainImage`
    GLSL ES 1.00: gl_FragData = the first parameter of `mainImage`
    GLSL ES 1.00: varying = `in`, although ShaderToy provides no inputs besides its uniforms
    GLSL ES 1.00: attribute = `in`, although ShaderToy provides no vertex attributes
    desktop GLSL: double = float
    desktop GLSL: dvec2 = vec2
    desktop GLSL: dvec3 = vec3
    desktop GLSL: dvec4 = vec4
    desktop GLSL: dmat3 = mat3
    desktop GLSL: dmat4 = mat4
    desktop GLSL: sampler1D = sampler2D
    desktop GLSL: texture1D = texture
    desktop GLSL: texture3D = texture
    desktop GLSL: dFdxFine = dFdx
    desktop GLSL: dFdyFine = dFdy
    desktop GLSL: dFdxCoarse = dFdx
    desktop GLSL: dFdyCoarse = dFdy
    desktop GLSL: fma = `a * b + c`
    C: fabs = abs
    C: fabsf = abs
    C: fmin = min
    C: fmax = max
    C: sqrtf = sqrt
    C: powf = pow
    C: sinf = sin
    C: cosf = cos
    C: tanf = tan
    C: floorf = floor
    C: ceilf = ceil
    C: expf = exp
    C: logf = log
    C: fmodf = `mod(x, y)`, whose result has the sign of `y`
    C: atan2f = `atan(y, x)`
    C: cbrt = `pow(x, 1.0 / 3.0)`, for `x` ≥ 0
    C: unsigned = uint
    C: long = int
    C: short = int
    C: boolean = bool
    C: M_PI = `3.14159265`
    early ShaderToy: iGlobalTime = iTime
    other hosts: time = iTime
    other hosts: u_time = iTime
    other hosts: resolution = iResolution
    other hosts: u_resolution = iResolution
    other hosts: mouse = iMouse
    other hosts: u_mouse = iMouse
    other hosts: frame = iFrame
    other languages: and = `&&`
    other languages: or = `||`
    other languages: elif = `else if`
    other languages: elseif = `else if`
    other languages: elsif = `else if`
    other languages: then = `{ … }` after `if (condition)`
    other languages: var = a type, such as `float` or `vec3`
    other languages: let = a type, such as `float` or `vec3`
    other languages: auto = a type, such as `float` or `vec3`
    other languages: random = a hash function: GLSL has no random numbers
    other languages: rand = a hash function: GLSL has no random numbers
    other languages: Vector2 = vec2
    other languages: Vector3 = vec3
    other languages: Vector4 = vec4
    other languages: vec2f = vec2
    other languages: vec3f = vec3
    other languages: vec4f = vec4
    other languages: f32 = float
    other languages: i32 = int
    other languages: u32 = uint
";

/// A name from a different language.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foreign {
    language: &'static str,
    name: &'static str,
    /// The replacement, with backquotes, or a GLSL name alone.
    replacement: &'static str,
}

impl Foreign {
    /// Looks up a foreign name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        rows().find(|row| row.name == name)
    }

    /// The equivalent GLSL name, if there is one.
    pub(crate) fn glsl_equivalent(self) -> Option<&'static str> {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        self.replacement.chars().all(is_word).then_some(self.replacement)
    }

    /// Adds to a diagnostic what to write instead of the name, as a fix if the replacement is mechanical.
    /// `call_end` is the end of the arguments if the name is called.
    pub(crate) fn advise(self, diagnostic: Diagnostic, at: Place, call_end: Option<Span>) -> Diagnostic {
        let advice = format!("use {}", self.replacement());
        match self.edits(call_end.is_some()) {
            Some((name, None)) => diagnostic.fix(Fix::new(advice, at.spelling, name)),
            Some((name, Some(arguments))) => match call_end {
                Some(end) => diagnostic.fix(Fix::new(advice, at.spelling, name).and(end, arguments)),
                None => diagnostic.label(advice),
            },
            None => diagnostic.label(advice),
        }
    }

    /// The text that replaces the name, and the text to add after the last argument of a call.
    fn edits(self, is_called: bool) -> Option<(&'static str, Option<String>)> {
        if let Some(name) = self.glsl_equivalent() {
            return Some((name, None));
        }
        let code = self.replacement.strip_prefix('`')?.split('`').next()?;
        let Some((name, parameters)) = code.strip_suffix(')').and_then(|code| code.split_once('(')) else {
            // A token, or several: not an expression of operands.
            let is_mechanical = code == "else if" || !code.contains([' ', '{']);
            let is_all = self.replacement.len() == code.len() + 2;
            return (is_mechanical && is_all).then_some((code, None));
        };
        // Parameters have one letter; further arguments are constants, which the call lacks.
        let is_word = name.bytes().all(|byte| byte.is_ascii_alphanumeric());
        let constants: Vec<_> = parameters.split(", ").filter(|part| part.len() > 1).collect();
        let added = (!constants.is_empty()).then(|| format!(", {}", constants.join(", ")));
        (is_word && is_called && !parameters.contains('(')).then_some((name, added))
    }

    /// The replacement, quoted for a message.
    pub(crate) fn replacement(self) -> String {
        match self.glsl_equivalent() {
            Some(name) => format!("`{name}`"),
            None => self.replacement.to_owned(),
        }
    }

    /// A note on the name's origin.
    pub(crate) fn note(self) -> String {
        match self.language {
            "other languages" | "other hosts" => format!("`{}` is not part of GLSL", self.name),
            language => format!("`{}` is from {language}", self.name),
        }
    }
}

fn rows() -> impl Iterator<Item = Foreign> {
    TABLE.lines().filter_map(|line| {
        let (language, rest) = line.trim().split_once(": ")?;
        let (name, replacement) = rest.split_once(" = ")?;
        Some(Foreign {
            language,
            name,
            replacement,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keywords::{Interner, Word};
    use crate::tree::BuiltIn;

    #[test]
    fn every_row_parses_and_no_name_is_a_glsl_name() {
        let interner = Interner::default();
        let is_ours = |name: &str| {
            let word = interner.find(name).map(|symbol| interner.word(symbol));
            matches!(word, Some(Word::Type(_) | Word::Keyword(_))) || BuiltIn::named(name).is_some()
        };
        let lines = TABLE.lines().filter(|line| !line.trim().is_empty());
        assert_eq!(rows().count(), lines.count());
        for row in rows() {
            assert!(!is_ours(row.name), "{}", row.name);
            if let Some((name, _)) = row.edits(true) {
                let is_name = is_ours(name) || name.starts_with('i') || name == "3.14159265";
                assert!(is_name || ["&&", "||", "else if"].contains(&name), "{name}");
            }
            if let Some(glsl_equivalent) = row.glsl_equivalent() {
                assert!(
                    is_ours(glsl_equivalent) || glsl_equivalent.starts_with('i'),
                    "{glsl_equivalent}"
                );
            }
        }
    }
}
