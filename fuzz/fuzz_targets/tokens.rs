//! Bytes as tokens, each a word of the language: mutations change programs, not spellings, and reach deeper than those of text.

#![no_main]

mod texts;

use libfuzzer_sys::fuzz_target;

/// What one byte says; bytes beyond the last begin anew. The most common stand twice in effect: names come in a few kinds
/// that fit each other often (`f` floats, `i` integers, `b` truths, `v` vectors, `m` matrices, `a` arrays, `s` structures).
#[rustfmt::skip]
const WORDS: &[&str] = &[
    ";", ";", ";", ",", "(", ")", "(", ")", "{", "}", "[", "]", "=", "=", "+", "-", "*", "/", "%", "<", ">", "<=", ">=", "==", "!=",
    "&&", "||", "^^", "!", "~", "&", "|", "^", "<<", ">>", "++", "--", "+=", "-=", "*=", "/=", "%=", "<<=", ">>=", "&=", "|=", "^=",
    "?", ":", ".x", ".y", ".xy", ".zyx", ".rgba", ".length()", ".k", ".q",
    "float", "int", "uint", "bool", "vec2", "vec3", "vec4", "ivec2", "uvec3", "bvec4", "mat2", "mat3", "mat4x3", "mat2x4", "void", "S", "float[2]", "float[]",
    "if", "else", "for", "while", "do", "switch", "case", "default:", "break;", "continue;", "return", "discard;", "struct", "const",
    "in", "out", "inout", "highp", "uniform", "layout", "precision", "flat", "sampler2D", "samplerCube", "isampler2D", "sampler3D",
    "f", "f1", "i", "i1", "u", "b", "v2", "v3", "v4", "m2", "m3", "a", "s", "g", "h", "p", "o", "fn", "fn2",
    "0", "1", "2", "7", "31", "0u", "3u", "0x7fffffff", "2147483648", "4294967295u", "0.", "1.", ".5", "1e9", "1e-9", "1e39", "0.1", "true", "false", "-1",
    "sin(", "abs(", "min(", "max(", "clamp(", "mix(", "mod(", "modf(", "pow(", "sqrt(", "fract(", "floor(", "dot(", "cross(", "length(", "normalize(",
    "inverse(", "transpose(", "outerProduct(", "matrixCompMult(", "lessThan(", "equal(", "any(", "all(", "not(", "dFdx(", "isnan(", "floatBitsToInt(",
    "packHalf2x16(", "texture(iChannel0,", "texelFetch(iChannel0,", "textureLod(iChannel1,", "textureSize(iChannel0,", "textureGrad(", "iChannel0", "iChannel3",
    "iTime", "iResolution", "iFrame", "iMouse", "iDate", "iChannelTime", "iChannelResolution", "gl_FragCoord", "gl_FragDepth",
    "\n#define F(x)", "\n#define G", "\n#undef G\n", "\n#if", "\n#ifdef G\n", "\n#else\n", "\n#endif\n", "\n#line", "\n#error", "\n#pragma", "\n#extension", "\n",
    "##", "defined", "F(", "G", "__LINE__", "//", "/*", "*/",
    "float f = 1.;", "int i = 2;", "vec3 v3 = vec3(1);", "mat2 m2 = mat2(1);", "float a[2];", "S s;", "vec2 v2;", "bool b = true;", "uint u = 1u;", "vec4 v4;",
    "struct S { float k; vec3 q[2]; };", "float fn(float f, inout vec2 v2) {", "void fn2(out int i, const in float a[2]) {", "for (int i = 0; i < 3; i++) {", "while (f < 3.) {",
    "do {", "} while (b);", "switch (i) {", "case 0:", "if (b) {", "} else {", "return f;", "return;",
];

const OPEN: &str = "void mainImage(out vec4 o, in vec2 p) {";

fuzz_target!(init: texts::spare_naga(), |bytes: &[u8]| {
    let mut text = String::new();
    // Before the first 255 the tokens stand between functions, after it in the body.
    for (index, part) in bytes.splitn(2, |&byte| byte == u8::MAX).enumerate() {
        if index == 1 {
            text.push_str(OPEN);
        }
        for &byte in part {
            text.push_str(WORDS[usize::from(byte) % WORDS.len()]);
            text.push(' ');
        }
    }
    if !text.contains(OPEN) {
        text.insert_str(0, OPEN);
    }
    text.push('}');
    texts::run(&text);
});
