//! Large memory, and accesses out of bounds.

use super::case::{Case, INVALID, OK, SLOW, body, lines, within};

pub(crate) fn cases() -> Vec<Case> {
    [arrays(), outside()].into_iter().flatten().collect()
}

fn arrays() -> Vec<Case> {
    let numbers: Vec<_> = (0..50_000).map(|at| format!("{at}.0")).collect();
    let table = format!("const float A[] = float[]({});", numbers.join(", "));
    let globals = lines(2_000, |at| format!("vec4 a{at}[64];"));
    vec![
        body(
            "an array of two thousand million",
            INVALID,
            "float a[2147483647]; c = vec4(a[int(p.x)]);",
        ),
        body(
            "an array of more than all integers",
            INVALID,
            "float a[99999999999999999999]; c = vec4(a[0]);",
        ),
        body(
            "an array of fewer than none",
            INVALID,
            "float a[3 - 5]; c = vec4(a[0]);",
        ),
        body(
            "an array whose size overflows",
            INVALID,
            "float a[65536 * 65536]; c = vec4(a[0]);",
        ),
        within(
            "structures of arrays that overflow 64 bits",
            INVALID,
            &("struct S0 { float x[65536]; };\n".to_owned()
                + &lines(4, |at| format!("struct S{} {{ S{at} s[65536]; }};", at + 1))),
            "S4 s; c = vec4(1.0);",
        ),
        body(
            "a million floats in each pixel",
            INVALID,
            "float a[1000000]; a[int(p.x)] = 1.0; c = vec4(a[int(p.y)]);",
        ),
        body(
            "sixty thousand floats in each pixel",
            SLOW,
            "float a[60000]; for (int i = 0; i < 60000; i += 997) a[i] = p.x; c = vec4(a[int(p.y) * 97]);",
        ),
        within(
            "sixty thousand matrices",
            SLOW,
            "mat4 a[60000];",
            "a[int(p.x)][0] = vec4(p, p); c = a[int(p.y)][0];",
        ),
        within(
            "four times sixty thousand matrices",
            SLOW,
            "mat4 a[60000]; mat4 b[60000]; mat4 d[60000]; mat4 e[60000];",
            "a[int(p.x)][0] = vec4(p, p); b[7] = a[3]; d[int(p.y)] = b[7]; e[1] = d[2]; c = e[int(p.y)][0];",
        ),
        within(
            "a third of a million floats in six arrays",
            SLOW,
            "float a[60000], b[60000], d[60000], e[60000], f[60000], g[60000];",
            "int i = int(p.x); a[i] = p.y; b[i] = a[7]; d[i] = b[8]; e[i] = d[9]; f[i] = e[9]; g[i] = f[9]; c = vec4(g[int(p.y)]);",
        ),
        within(
            "two thousand arrays",
            SLOW,
            &globals,
            "a7[int(p.x) % 64] = vec4(1.0); c = a7[0] + a1999[int(p.y) % 64];",
        ),
        within(
            "a table of fifty thousand",
            SLOW,
            &table,
            "c = vec4(A[int(p.x)]);",
        ),
        body(
            "an array passed by value a thousand times",
            SLOW,
            "float a[512]; float b[512]; for (int i = 0; i < 512; i++) a[i] = p.x; for (int i = 0; i < 1000; i++) { b = a; a = b; } c = vec4(b[int(p.x)]);",
        ),
    ]
}

fn outside() -> Vec<Case> {
    vec![
        body(
            "a write far outside",
            OK,
            "float a[4]; a[0] = 1.0; a[int(p.x) + 1000000000] = 1.0; c = vec4(a[0]);",
        ),
        body(
            "a read far below",
            OK,
            "float a[4]; a[0] = 1.0; c = vec4(a[-1000000000 - int(p.x)]);",
        ),
        body(
            "a vector read outside",
            OK,
            "vec4 v = vec4(1.0); c = vec4(v[int(p.x) - 1000]);",
        ),
        body(
            "a texel at the end of the world",
            OK,
            "c = texelFetch(iChannel0, ivec2(2147483647 - int(p.x), -2147483647), 2147483647);",
        ),
        body(
            "a level that there is not",
            OK,
            "c = textureLod(iChannel0, p, 1e30) + textureLod(iChannel1, p * 1e9, -1e30);",
        ),
    ]
}
