//! Small programs with their expected result according to GLSL, run by the evaluator in f32 and f64, and by
//! the GPU.

use toyproof::diagnostic::{File, Files};
use toyproof::eval::{
    Failure, Fault, Number, Program, RandomRounding, Settings, Substitute, UndefinedPolicy,
};
use toyproof::glsl::{Checked, Options, check};
use toyproof::image::{Frame, Image};
use toyproof::translate::{FloatMode, lower_strict};

use crate::requirements::require_worker;

/// The text before `mainImage`, its body, and the resulting `o.x`. `p` is (0.5, 0.5); `iTime` is 2; texel (1,
/// 2) of `iChannel0` is 0.75, the others are 0.
static PROGRAMS: &[(&str, &str, f64)] = &[
    // Control.
    (
        "",
        "for (int i = 0; i < 5; i++) { if (i == 1) continue; if (i == 4) break; o.x += float(i); }",
        5.0,
    ),
    (
        "",
        "int i = 0; while (i < 3) { i++; if (float(i) < p.x + 1.0) continue; o.x += float(i); }",
        5.0,
    ),
    (
        "",
        "int i = 0; do { i++; if (i < 9) continue; } while (i < 3); o.x = float(i);",
        3.0,
    ),
    ("", "for (;;) { o.x += 1.0; if (o.x > 3.5 + p.x) break; }", 5.0),
    ("", "while (bool b = o.x < 3.0) { o.x += 1.0; }", 3.0),
    (
        "float f(int i) { switch (i) { case 0: return 1.0; case 1: case 2: return 2.0; default: break; } return 9.0; }",
        "int k = int(p.x); o.x = f(k) + 10.0 * f(k + 1) + 100.0 * f(k + 2) + 1000.0 * f(k + 3);",
        9221.0,
    ),
    (
        "",
        "for (int i = int(p.x); i < 4; i++) switch (i) { case 3: o.x += 1000.0; break; default: o.x += 100.0; case 0: o.x += 10.0; \
         if (i == 1) break; o.x += 1.0; break; case 7: o.x = 0.0; }",
        1232.0,
    ),
    (
        "",
        "switch (int(p.x)) { case 0: int a = 3; case 1: a += 1; o.x = float(a); }",
        4.0,
    ),
    (
        "float f(float x) { if (x > 0.0) { if (x > 1.0) return 2.0; } else return 3.0; return 4.0; }",
        "o.x = f(p.x) + 10.0 * f(p.x + 1.0) + 100.0 * f(p.x - 1.0);",
        324.0,
    ),
    (
        "float f(float n) { for (int i = 0; i < 9; i++) { if (float(i) > n) return float(i); } return -1.0; }",
        "o.x = f(p.x + 3.0) + 10.0 * f(99.0);",
        -6.0,
    ),
    ("", "o.x = 7.0; if (p.x < 9.0) return; o.x = 1.0;", 7.0),
    ("", "while (o.w++ < 3.0) o.x += 1.0;", 3.0),
    (
        "",
        "int a = 0; float s = 0.0; for (int k = 0; k < 3; k++, a += 2) { int a = 7; s += float(a); } o.x = float(a) + s;",
        27.0,
    ),
    // Evaluation: once, from left to right, and only as needed.
    (
        "",
        "int q[2]; q[0] = int(p.x) + 1; q[1] = 0; q[q[0] & 1] += q[0]++; o.x = float(q[0] + 10 * q[1]);",
        12.0,
    ),
    (
        "int add(int a, int b) { return a * 16 + b; } int fixed_add(const int a, int b) { return a * 16 + b; }",
        "int i = int(p.x); o.x = float(add(i, i++)); o.x += 256.0 * float(fixed_add(i, i++));",
        4368.0,
    ),
    (
        "",
        "mat2 m[2]; int i = int(p.x); m[i][(i = 1) & 1].yx = vec2(3.0, float(i)); o.x = m[0][1].y * 10.0 + m[0][1].x + m[1][1].y;",
        31.0,
    ),
    (
        "float t = 1.0; bool hit() { t = 9.0; return true; }",
        "if (p.x > 9.0 && hit()) t += 1.0; o.x = t; if (p.x < 9.0 || hit()) o.x += t;",
        2.0,
    ),
    (
        "float g; float next() { g += 1.0; return g; }",
        "g = 2.0; g += next(); vec2 u = vec2(1.0); u += vec2(dot(u *= 2.0, vec2(1.0))); o.x = g + 10.0 * u.x;",
        66.0,
    ),
    (
        "float g; float next() { g += 1.0; return g; }",
        "o.x = next() - next() * 10.0; o.x += g == 2.0 ? next() : -next();",
        -16.0,
    ),
    (
        "",
        "float a[3]; a[0] = 1.0; a[1] = 2.0; a[2] = 4.0; int i = int(p.x); a[i++] += 8.0; \
      o.x = a[0] + 16.0 * float(i);",
        25.0,
    ),
    (
        "",
        "int i = 3; int j = i++ + ++i; o.x = float(j * 10 + i); float f = 1.0; f = f-- - --f; o.x += f;",
        87.0,
    ),
    ("", "float a, b; a = b = p.x + 1.0; o.x = a + b;", 3.0),
    ("", "o.x = (o.y = 2.0, o.y * 3.0);", 6.0),
    (
        "vec2 f() { return vec2(1.0, 2.0); } float f(int i) { return float(i); }",
        "int i = int(p.x); vec2 v[2]; v[0] = vec2(1.0, 2.0); v[1] = vec2(4.0, 8.0); o.x = v[i++][i] + 10.0 * v[i][i--] + 100.0 * f()[i] \
         + 1000.0 * f(int(v[i = 1][i - 1]));",
        4182.0,
    ),
    (
        "const float five = float(uvec2(5u));",
        "const float a[2] = float[](five, five * 2.0); o.x = a[int(p.x) + 1] + a[0];",
        15.0,
    ),
    (
        "",
        "int i; float g; o.x = float((1 << (i = 31)) < 0) + 2.0 * float((i = 7, 1) << 2 == 4) + 4.0 * float(1e38 * (g = 100.0) > 3e38) \
         + 8.0 * float(i);",
        63.0,
    ),
    // Functions: copied in, copied out.
    (
        "void f(in float a, out float b, inout float c) { a += 1.0; c += a; b = a; }",
        "float x = 1.0, y = 5.0, z = 10.0; f(x, y, z); o.x = x + 10.0 * y + 100.0 * z;",
        1221.0,
    ),
    (
        "void swap(inout float a, inout float b) { float t = a; a = b; b = t; }",
        "vec2 v = vec2(1.0, 2.0); swap(v.x, v.y); float a[2]; a[0] = 3.0; a[1] = 4.0; int i = int(p.x); swap(a[i], a[i + 1]); \
      o.x = v.x + 10.0 * v.y + 100.0 * a[0] + 1000.0 * a[1];",
        3412.0,
    ),
    (
        "void f(out float x) { if (iTime > 5.0) x = 2.0; }",
        "float x = 1.0; f(x); o.x = x;",
        0.0,
    ),
    (
        "struct S { float a; vec2 b[2]; }; S make(float x) { S s; s.a = x; s.b[1] = vec2(x, 2.0 * x); return s; }",
        "S s = make(3.0); S t = s; t.b[1].y += 1.0; o.x = s.a + s.b[1].x * 10.0 + t.b[1].y * 100.0 + (s == t ? 1e4 : 0.0) + (s != t ? 1e5 : 0.0);",
        100_733.0,
    ),
    (
        "float twice = 4.0; const float a[3] = float[](1.0, 2.0, 4.0);",
        "twice *= 2.0; o.x = twice + a[int(p.x) + 2];",
        12.0,
    ),
    (
        "",
        "for (int i = 0; i < 3; i++) { float a; a += 1.0; o.x += a; }",
        3.0,
    ),
    // Values: swizzles, matrices, arrays, conversions.
    (
        "",
        "vec4 v = vec4(1.0, 2.0, 3.0, 4.0); v.zx = v.xy; v.wy += vec2(10.0); o.x = dot(v, vec4(1.0, 10.0, 100.0, 1000.0));",
        14_222.0,
    ),
    (
        "",
        "mat3 m = mat3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0); m[1].xz *= 2.0; int i = int(p.x); m[i + 2][i + 1] = 0.0; \
      o.x = dot(m * vec3(1.0, 10.0, 100.0), vec3(1.0, 2.0, 3.0)) + (vec3(1.0, 0.0, 0.0) * m).y;",
        3962.0,
    ),
    (
        "",
        "mat2x3 a = mat2x3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0); mat3x2 b = transpose(a); mat2 c = b * a; \
      o.x = c[0][0] + c[1][0] * 10.0 + c[1][1] * 100.0 + determinant(c);",
        8088.0,
    ),
    (
        "",
        "mat2 m = mat2(4.0, 2.0, 1.0, 1.0); mat2 n = inverse(m) * m; o.x = n[0][0] + n[1][1] + mat3(m)[2][2] + mat2(3.0)[1][1];",
        6.0,
    ),
    (
        "",
        "vec3 v = vec3(ivec2(3.7, -3.7), true); o.x = v.x - v.y + v.z + float(uint(7.9)) + float(bool(0.1));",
        15.0,
    ),
    (
        "",
        "vec4 v = vec4(1.0, 2.0, 3.0, 4.0); int i = int(p.x) + 2; v[i] = 9.0; v.wzyx[i - 1] += 1.0; o.x = v.z * 10.0 + v[i - 2] + v.zyx[i];",
        102.0,
    ),
    (
        "",
        "float a[2][3]; for (int i = 0; i < 2; i++) for (int j = 0; j < 3; j++) a[i][j] = float(10 * i + j); \
      o.x = a[int(p.x) + 1][2] + 100.0 * float(a.length()) + 1000.0 * float(a[0].length());",
        3212.0,
    ),
    (
        "",
        "float[3] a = float[3](1.0, 2.0, 3.0), b = a; b[int(p.x)] = 5.0; o.x = a[0] + 10.0 * b[0] + (a == b ? 100.0 : 0.0);",
        51.0,
    ),
    // Integers.
    (
        "",
        "int i = int(p.x) - 7; o.x = float(i % 3) + 10.0 * float(i / 3) + float((i >> 1) & 15) * 100.0;",
        1182.0,
    ),
    (
        "",
        "uint u = uint(p.x); u -= 1u; o.x = float(u >> 24u) + (u == ~0u ? 1000.0 : 0.0) + float((u ^ 0xF0u) & 0xFFu) * 1e4;",
        151_255.0,
    ),
    (
        "",
        "int i = 2147483647 + int(p.x + 1.0); o.x = (i < 0 ? 1.0 : 0.0) + float(abs(-5)) + float(sign(-5)) + float(clamp(9, 1, 3));",
        8.0,
    ),
    (
        "",
        "uvec3 v = uvec3(1u, 2u, 3u) * 1664525u + 1013904223u; o.x = float((v.x ^ v.y ^ v.z) & 1023u);",
        915.0,
    ),
    // Built-in functions.
    (
        "",
        "o.x = mod(-1.5, 1.0) + 10.0 * fract(2.25) + 100.0 * floor(-0.5) + sign(-3.0) + step(0.5, p.x) + trunc(-1.5);",
        -98.0,
    ),
    (
        "",
        "float w; float f = modf(-3.25, w); o.x = f + 10.0 * w + roundEven(2.5) + 100.0 * ceil(0.25);",
        71.75 - 0.0,
    ),
    (
        "",
        "o.x = length(vec3(2.0, 3.0, 6.0)) + dot(cross(vec3(1, 2, 3), vec3(4, 5, 6)), vec3(1.0, 10.0, 100.0)) + distance(1.0, -2.5);",
        -232.5,
    ),
    (
        "",
        "vec3 r = reflect(vec3(1.0, -1.0, 0.0), vec3(0.0, 1.0, 0.0)); vec3 f = faceforward(vec3(1.0), vec3(1.0), vec3(1.0)); \
      o.x = r.x + 10.0 * r.y + 100.0 * f.x;",
        -89.0,
    ),
    (
        "",
        "o.x = clamp(2.0, 0.0, 1.0) + min(1.0, 2.0) + max(vec2(1.0, 5.0), 3.0).y + mix(1.0, 3.0, 0.5) + mix(1.0, 8.0, true) + smoothstep(0.0, 2.0, 1.0);",
        17.5,
    ),
    (
        "",
        "bvec2 b = lessThan(vec2(1.0, 2.0), vec2(2.0, 1.0)); o.x = (any(b) ? 1.0 : 0.0) + (all(b) ? 10.0 : 0.0) + (not(b).y ? 100.0 : 0.0);",
        101.0,
    ),
    (
        "",
        "float zero = p.x - p.y, nan = zero / zero; o.x = float(nan != nan) + 2.0 * float(isnan(nan)) + 4.0 * float(isinf(1.0 / zero)) \
      + 8.0 * float(nan == nan) + 16.0 * float(nan < 1.0);",
        7.0,
    ),
    (
        "",
        "float zero = p.x - p.y, nan = zero / zero; o.x = min(nan, 1.0) + 10.0 * min(2.0, nan) + 100.0 * max(nan, 3.0) + 1000.0 * max(4.0, nan) \
      + 10000.0 * clamp(nan, 5.0, 6.0);",
        54_321.0,
    ),
    (
        "",
        "o.x = uintBitsToFloat(floatBitsToUint(p.x) + (1u << 23)) + float(floatBitsToInt(1.0) >> 23);",
        128.0,
    ),
    (
        "",
        "uint n = packUnorm2x16(vec2(1.0, 0.0)); o.x = float(n) + unpackSnorm2x16(packSnorm2x16(vec2(-1.0, 1.0))).x;",
        65_534.0,
    ),
    (
        "",
        "mat3 m = outerProduct(vec3(1, 2, 3), vec3(4, 5, 6)); o.x = m[1][2] + matrixCompMult(m, m)[0][0];",
        31.0,
    ),
    // Loops that can be unrolled, or not: dependent iterations, exits from nested loops, too many iterations.
    (
        "float f(int n) { for (int i = 0; i < 9; i++) { for (int j = 0; j < 3; j++) if (i * j == n) return float(10 * i + j); } return -1.0; }",
        "o.x = f(4) + 100.0 * f(9) + f(int(p.x) + 7);",
        -7.0,
    ),
    (
        "",
        "int a[4] = int[](3, 1, 2, 0), i = 0; for (int n = 0; n < 6; n++) { o.x = 10.0 * o.x + float(a[i]); a[i] ^= 1; i = a[i]; }",
        320_121.0,
    ),
    (
        "",
        "float a[3]; int n = 0; for (int i = 0; i < 3; i++) { for (int j = int(p.x); j <= i; j++) { a[j] += float(i); n++; } if (n > 2) break; } o.x = a[0] + 10.0 * a[1] + 100.0 * a[2] + 1000.0 * float(n);",
        3011.0,
    ),
    (
        "",
        "for (int i = 0; i < 3; i++) { float x; for (int j = 0; j < 9000; j++) { if (j == 8999 - i) x = float(j) + p.x; } o.x += x; }",
        26_995.5,
    ),
    (
        "",
        "int i = 0; do { switch (i) { case 1: continue; case 2: o.x += 1.0; break; default: o.x += 10.0; } o.x += 100.0; } while (i++ < 3);",
        321.0,
    ),
    (
        "",
        "for (int i = 0; i < 4; i++) { for (;;) { o.x += 1.0; if (o.x > float(i * i) + p.x) break; } if (i == 2) continue; o.x += 0.5; }",
        10.5,
    ),
    // Inputs and textures.
    (
        "",
        "o.x = iResolution.x + iTime + iResolution.z + iChannelResolution[0].y + iChannelResolution[1].x;",
        9.0,
    ),
    (
        "",
        "o.x = texelFetch(iChannel0, ivec2(1, 2), 0).x + texelFetchOffset(iChannel0, ivec2(0), 0, ivec2(1, 2)).y;",
        1.5,
    ),
    (
        "",
        "o.x = texture(iChannel0, vec2(1.5, 2.5) / 4.0).x + texture(iChannel0, vec2(1.0, 2.5) / 4.0).x + textureLod(iChannel1, p, 0.0).w \
      + texture(iChannel0, vec2(5.5, -1.5) / 4.0).x;",
        2.875,
    ),
    (
        "vec4 f(sampler2D s, vec2 at) { return texture(s, at); }",
        "o.x = f(iChannel0, vec2(1.5, 2.5) / 4.0).x + f(iChannel2, p).w + float(textureSize(iChannel0, 0).x);",
        5.75,
    ),
    (
        "vec4 f(sampler2D s, ivec2 at) { return texelFetch(s, at, 0); }",
        "o.x = f(iChannel0, ivec2(1, 2) + int(f(iChannel1, ivec2(0)).x)).x + f(iChannel0, ivec2(-1, 2)).x;",
        0.75,
    ),
    (
        "uniform sampler2D other;",
        "o.x = texelFetch(other, ivec2(1, 2), 0).x;",
        0.75,
    ),
    // Undefined behavior, as the GPU path defines it.
    (
        "",
        "float a[3]; a[2] = 5.0; int i = int(p.x) + 7; o.x = a[i] + 10.0 * a[-i];",
        55.0,
    ),
    (
        "",
        "int z = int(p.x), s = 7; o.x = float(s / z) + 10.0 * float(s % z);",
        7.0,
    ),
];

fn checked(before: &str, body: &str) -> Option<Checked> {
    let mut files = Files::default();
    let text = format!("{before}\nvoid mainImage(out vec4 o, in vec2 p) {{ o = vec4(0.0); {body} }}");
    let file = files.add(File::new("s", text));
    let lenient = Options {
        lenient: true,
        ..Options::default()
    };
    check(&files, file, &lenient).ok()
}

fn frame() -> Frame {
    let mut texels = vec![[0.0; 4]; 16];
    texels[2 * 4 + 1] = [0.75; 4];
    let mut frame = Frame {
        size: [2, 2],
        time: 2.0,
        ..Frame::default()
    };
    frame.channels[0] = Some(Image::new(4, 4, texels).into());
    frame
}

fn evaluated<N: Number>(checked: &Checked) -> f64 {
    let program = Program::new(checked).unwrap();
    let rendered = [UndefinedPolicy::Observed, UndefinedPolicy::Plain].map(|variant| {
        let settings = Settings::<N> {
            undefined: variant,
            ..Settings::default()
        };
        program.render(&frame(), &settings).unwrap().framebuffer.get(0, 0)[0].to_f64()
    });
    assert_eq!(
        rendered[0].to_bits(),
        rendered[1].to_bits(),
        "to observe changes nothing"
    );
    rendered[0]
}

#[test]
fn small_programs_evaluate_to_their_result() {
    let mut wrong = Vec::new();
    for &(before, body, expected) in PROGRAMS {
        let checked = checked(before, body).unwrap_or_else(|| panic!("{before} {body}"));
        let (single, double) = (evaluated::<f32>(&checked), evaluated::<f64>(&checked));
        let jittered = evaluated::<RandomRounding>(&checked);
        if single != expected || double != expected || (jittered - expected).abs() > 1e-6 {
            wrong.push(format!(
                "{before} {body}: {expected}: {single} {double} {jittered}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn small_programs_render_the_same_on_the_gpu() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let mut wrong = Vec::new();
    for &(before, body, expected) in PROGRAMS {
        let checked = checked(before, body).unwrap();
        match worker.draw(lower_strict(&checked), frame(), FloatMode::Strict) {
            Ok(drawn) => match f64::from(drawn.image().get(0, 0)[0]) {
                right if right == expected => {}
                rendered => wrong.push(format!("{before} {body}: {expected}: {rendered}")),
            },
            Err(failure) => wrong.push(format!("{before} {body}: {failure}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The body of `mainImage`, and the faults that its pixels encounter.
static FAULTS: &[(&str, &[Fault])] = &[
    (
        "float a[3]; o.x = a[int(p.x) + 7];",
        &[Fault::IndexOutOfBounds, Fault::NeverWritten],
    ),
    (
        "float a[3] = float[](1.0, 2.0, 3.0); o.x = a[int(p.x) + 7];",
        &[Fault::IndexOutOfBounds],
    ),
    (
        "float x; if (p.x > 9.0) x = 1.0; o.x = x;",
        &[Fault::NeverWritten],
    ),
    ("float x; if (p.x < 9.0) x = 1.0; o.x = x;", &[]),
    ("float x; x += 1.0; o.x = x;", &[Fault::NeverWritten]),
    ("vec3 v; v.xz = p; o.x = v.x + v.z;", &[]),
    ("vec3 v; v.xz = p; o.x = length(v);", &[Fault::NeverWritten]),
    ("float a[3]; a[int(p.x) + 1] = 2.0; o.x = a[1];", &[]),
    (
        "float a[3]; a[int(p.x) + 1] = 2.0; o.x = a[2];",
        &[Fault::NeverWritten],
    ),
    (
        "float t; for (int i = 0; i < int(p.x); i++) t = float(i); o.x = t;",
        &[Fault::NeverWritten],
    ),
    (
        "float t; for (int i = 0; i < 3; i++) { t = float(i); o.x += t; } o.x += t;",
        &[],
    ),
    (
        "struct S { float a; vec2 b; } s, t; s.a = 1.0; t = s; o.x = t.a;",
        &[],
    ),
    (
        "float a[3]; int i = int(p.x) + 7; if (i < 3 && a[i] > 0.0) o.x = 1.0;",
        &[],
    ),
    ("o.x = float(7 / int(p.x));", &[Fault::DivisionByZero]),
    ("o.x = float(7u % uint(p.x));", &[Fault::RemainderByZero]),
    // 0/0 is NaN, but for constants the driver may fold it to anything.
    (
        "uint k = 0u; if (p.x > 0.0) o.x = 0.0 / float(k);",
        &[Fault::ZeroByZero],
    ),
    ("float k = fract(1.0); o.x = k / 0.0;", &[Fault::ZeroByZero]),
    (
        "float z = p.x * 0.0; o.x = z / z + 1.0 / 0.0 + 1.0 / float(0u);",
        &[],
    ),
    (
        "o.x = float(textureSize(iChannel0, int(p.x) + 1).x);",
        &[Fault::NoLevel],
    ),
    ("o.x = float(textureSize(iChannel0, -1).x);", &[Fault::NoLevel]),
    ("o.x = float(textureSize(iChannel0, int(p.x)).x);", &[]),
    ("o.x = float(1 << (int(p.x) + 32));", &[Fault::ShiftTooFar]),
    ("o.x = float(1 << (int(p.x) - 1));", &[Fault::ShiftTooFar]),
    ("o.x = float(int(p.x * 1e20));", &[Fault::IntegerOverflow]),
    ("o.x = float(int(fract(p.x) * -4294967296.0));", &[]),
    (
        "o.x = float(int(fract(p.x) * -4294967808.0));",
        &[Fault::IntegerOverflow],
    ),
    ("o.x = float(uint(p.x - 2.0));", &[Fault::IntegerOverflow]),
    ("o.x = float(uint(p.x - 1.0)) + float(int(p.x - 2.0));", &[]),
    ("o.x = smoothstep(p.x, p.y, 1.0);", &[Fault::EqualEdges]),
    ("o.x = smoothstep(p.x, 0.0, 1.0);", &[Fault::ReversedEdges]),
    ("o.x = pow(p.x - 1.0, 2.0);", &[Fault::PowDomain]),
    (
        "o.x = max(p.x, sqrt(p.x - 1.0));",
        &[Fault::NotANumber, Fault::RootDomain],
    ),
    ("o.x = clamp(1.0, p.x, 0.0);", &[Fault::ReversedClamp]),
    ("o.x = log(p.x - p.y);", &[Fault::LogDomain]),
    ("o.x = acos(p.x + 1.0);", &[Fault::ArcDomain]),
    ("o.x = p.x > 0.0 ? sqrt(p.x) : sqrt(-p.x);", &[]),
    ("if (p.x > 1.0) o.x = 1.0; o.x = dFdx(p.x);", &[]),
];

/// Functions that write their `out` parameters always, or only sometimes.
const HANDED: &str = "void f(out float x) { x = 2.0; }
    void none(out float x) {}
    void through(inout float x) { none(x); }
    void lose(out vec4 v) {}
    bool hit(float p, out float t) { if (p < 20.0) return false; t = p; return true; }";

/// The body of `mainImage`, its red, and whether that depends on a value that was never written.
static HANDED_OUT: &[(&str, f64, bool)] = &[
    ("float a = 1.0; f(a); o.x = a;", 2.0, false),
    ("float a = 1.0; none(a); o.x = a;", 0.0, true),
    ("float a = 1.0; through(a); o.x = a;", 0.0, true),
    ("float a = 1.0; if (p.x > 20.0) f(a); o.x = a;", 1.0, false),
    ("float a = 1.0; if (p.x > 20.0) none(a); o.x = a;", 1.0, false),
    ("float t = 9.0; bool b = hit(p.x, t); o.x = t;", 0.0, true),
    (
        "float t = 9.0; bool b = p.y > 5.0 && hit(p.x, t); o.x = t;",
        9.0,
        false,
    ),
    ("float a[2]; a[1] = 3.0; f(a[0]); o.x = a[1];", 3.0, false),
    (
        "vec2 v[2]; f(v[1][0]); int n = 5; v[1][int(p.x)] = 1.0; o.x = float(n);",
        5.0,
        false,
    ),
    (
        "vec2 v[2]; f(v[1][0]); v[1][int(p.x)] = 1.0; o.x = v[1].x;",
        1.0,
        false,
    ),
    ("vec2 v[2]; f(v[1][0]); o.x = v[1][int(p.x) + 1];", 0.0, true),
    (
        "mat3 m = mat3(1.0); f(m[1][0]); for (int i = 0; i < 3; i++) o.x += m[1][i];",
        3.0,
        false,
    ),
    (
        "for (int i = 0; i < 3; i++) { float a[2]; a[0] = 3.0; if (i > 5) o.x += a[1]; f(a[1]); }",
        0.0,
        false,
    ),
    ("f(o.x); if (p.x > 20.0) none(o.x);", 2.0, false),
    ("lose(o); o.x += 1.0;", 1.0, true),
];

#[test]
fn unwritten_out_parameters_are_observed() {
    let frame = Frame {
        size: [1, 1],
        ..Frame::default()
    };
    let mut wrong = Vec::new();
    for &(body, red, never_written) in HANDED_OUT {
        let program = Program::new(&checked(HANDED, body).unwrap()).unwrap();
        let rendered = program.render::<f64>(&frame, &Settings::default()).unwrap();
        let faults = rendered.observations.faults.iter();
        let noted = faults
            .filter(|noted| noted.site.fault == Fault::NeverWritten)
            .count();
        let [rendered, ..] = rendered.framebuffer.get(0, 0);
        if (rendered, noted > 0) != (red, never_written) {
            wrong.push(format!("{body}: {rendered}, noted {noted} times"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn undefined_operations_are_observed_exactly_where_they_occur() {
    let mut wrong = Vec::new();
    for (body, faults) in FAULTS {
        let program = Program::new(&checked("", body).unwrap()).unwrap();
        let frame = Frame {
            size: [1, 1],
            ..Frame::default()
        };
        let rendered = program.render::<f32>(&frame, &Settings::default()).unwrap();
        let mut noted: Vec<Fault> = rendered
            .observations
            .faults
            .iter()
            .map(|noted| noted.site.fault)
            .collect();
        noted.sort();
        let mut expected = faults.to_vec();
        expected.sort();
        let undefined = faults.iter().any(|fault| fault.is_undefined());
        if noted != expected || rendered.framebuffer.is_undefined(0, 0) != undefined {
            wrong.push(format!("{body}: {noted:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Pixels of one quad that diverge: loops of different lengths, returns and discards.
#[test]
fn divergent_pixels_have_the_same_bits_as_on_the_gpu() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let bodies = [
        (
            "",
            "for (int i = 0; i < int(p.x); i++) { if (i % 3 == int(p.y) % 3) continue; if (o.x > 9.0) break; o.x += sqrt(float(i) + p.y); }",
        ),
        (
            "float f(vec2 p) { if (p.x > 9.0) return 1.0; for (int i = 0; i < 9; i++) { if (float(i) > p.y) return float(i); } return 3.0; }",
            "o.xy = vec2(f(p), f(p.yx)); o.z = f(p * 2.0 - 9.0);",
        ),
        (
            "",
            "int n = 0; for (int i = 0; i < 5; i++) for (int j = 0; j < int(p.x); j++) { n += j; if (n > int(p.y) * 4) break; } o.x = float(n);",
        ),
        (
            "",
            "float a[8]; for (int i = 0; i < 8; i++) a[i] = p.x * float(i); a[int(p.y) % 8] = -1.0; o.x = a[int(p.x) % 8] + a[(int(p.x) + 3) % 8];",
        ),
        (
            "",
            "o.xyz = vec3(dFdx(p.x * p.y), dFdy(p.x * p.y), fwidth(p.x * p.x));",
        ),
        (
            "float g; void add(float x) { if (x > 4.0) { g += x; return; } g -= 1.0; }",
            "for (int i = 0; i < 6; i++) add(mod(p.x * float(i), 9.0)); o.x = g;",
        ),
        (
            "",
            "int x = 0; for (int i = 0; i < 3; i++) { if (int(p.x + p.y) % 3 == i) { x += 1; o.x += float(x); } }",
        ),
        (
            "",
            "switch (int(p.x) % 5) { case 0: o.x = 1.0; break; case 1: o.x = 2.0; case 2: o.y = 3.0; if (p.y > 5.0) break; default: o.z = 4.0; }",
        ),
        ("", "if (p.x > 6.0 && p.y > 3.0) discard; o.x = p.x;"),
        (
            "float f(vec2 p) { for (int i = 0; i < 4; i++) { if (p.x < 5.0 * float(i)) break; for (int j = 0; j < 3; j++) { if (p.y < float(i + j)) return float(i); p.x += p.y; } } return p.x; }",
            "o.x = f(p); for (int i = 0; i < 3; i++) { if (o.x > p.y) continue; o.y += o.x * p.x - p.y; o.x += p.y - p.x * o.y; }",
        ),
        (
            "bool f(inout float x) { x += 1.0; return x > 4.0; }",
            "float x = p.x; bool b = p.y > 3.0 && f(x) || p.x > 5.0 && !f(x); o.xy = vec2(x, b);",
        ),
    ];
    let frame = Frame {
        size: [37, 11],
        ..Frame::default()
    };
    let mut wrong = Vec::new();
    for (before, body) in bodies {
        let checked = checked(before, body).unwrap_or_else(|| panic!("{body}"));
        let rendered = Program::new(&checked)
            .unwrap()
            .render::<f32>(&frame, &Settings::default())
            .unwrap();
        let drawn = worker
            .draw(lower_strict(&checked), frame.clone(), FloatMode::Strict)
            .unwrap()
            .image();
        let image = rendered.framebuffer.image();
        let places = (0..11).flat_map(|y| (0..37).map(move |x| (x, y)));
        let bits = |image: &Image, (x, y)| image.get(x, y).map(f32::to_bits);
        if let Some((x, y)) = places
            .into_iter()
            .find(|&at| bits(&image, at) != bits(&drawn, at))
        {
            let (ours, theirs) = (image.get(x, y), drawn.get(x, y));
            wrong.push(format!("({x}, {y}) of {body}: {ours:?} and {theirs:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn endless_loops_are_stopped() {
    let settings = Settings::<f32> {
        max_iterations: 1 << 16,
        ..Settings::default()
    };
    for body in [
        "for (;;) o.x += p.x;",
        "for (int i = 0; i < 3; i += 0) o.x += p.x;",
        "for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j *= 2) o.x += p.x;",
    ] {
        let program = Program::new(&checked("", body).unwrap()).unwrap();
        let failure = program.render(&frame(), &settings).unwrap_err();
        assert!(matches!(failure, Failure::TooOften { .. }), "{body}: {failure}");
    }
}

#[test]
fn iterations_of_unrolled_and_other_loops_are_counted() {
    let bodies = [
        (
            "for (int i = 0; i < 5; i++) for (int j = 0; j < 7; j++) o.x += p.x;",
            46,
        ),
        (
            "for (int i = 0; i < 5; i++) { if (i == 3) break; o.x += p.x; }",
            4,
        ),
        (
            "for (int i = 0; i < 5; i++) { if (p.x > 1.0 && i == 3) break; o.x += p.x; }",
            6,
        ),
        (
            "for (int i = 0; i < int(p.x) + 5; i++) for (int j = 0; j < 7; j++) o.x += p.x;",
            55,
        ),
        (
            "for (int i = 0; i < 9000; i++) for (int j = 0; j < 2; j++) o.x += p.x;",
            36_001,
        ),
    ];
    let frame = Frame {
        size: [2, 1],
        ..Frame::default()
    };
    for (body, rounds) in bodies {
        let program = Program::new(&checked("", body).unwrap()).unwrap();
        let rendered = program.render::<f32>(&frame, &Settings::default()).unwrap();
        assert_eq!(rendered.observations.max_iterations, rounds, "{body}");
    }
}

/// The body of `mainImage`, and whether its color depends on undefined behavior.
static OPEN: &[(&str, bool)] = &[
    (
        "float a[3] = float[](1.0, 2.0, 3.0); o.x = a[int(p.x) + 7];",
        true,
    ),
    (
        "float a[3] = float[](1.0, 2.0, 3.0); float b = a[int(p.x) - 1]; o.x = p.x < 9.0 ? 1.0 : b;",
        false,
    ),
    ("o.x = float(7 / int(p.x));", true),
    ("o.x = float(7u % uint(p.x)) * 0.0;", false),
    ("o.x = float(1 << (int(p.x) + 32));", true),
    ("o.x = float(uint(p.x - 2.0));", false),
    ("o.x = float(uint(p.x - 2.0) + 1u);", false),
    ("o.x = float(int(p.x * 1e20) / 2);", true),
    ("o.x = smoothstep(p.x, p.y, 1.0);", true),
    ("o.x = pow(p.x - 1.0, 2.0);", true),
    ("o.x = min(pow(p.x - 1.0, 2.0), 0.0) > 9.0 ? 1.0 : 0.0;", false),
    ("o.x = max(p.x, sqrt(p.x - 1.0));", true),
    ("o.x = max(p.x, sqrt(p.x - 1.0)) > 9.0 ? 1.0 : 0.0;", false),
    ("uint k = 0u; o.x = 0.0 / float(k);", true),
    ("uint k = 0u; o.x = 0.0 / float(k) > 9.0 ? 1.0 : 0.0;", false),
    ("o.x = float(textureSize(iChannel0, 3).y);", true),
    ("o.x = clamp(1.0, p.x, 0.0);", true),
    ("o.x = mix(0.0, 0.0, smoothstep(p.x, p.y, 1.0));", true),
    ("o.x = max(0.0, log(-p.x)) < 9.0 ? 1.0 : 0.0;", true),
    ("o.x = texture(iChannel0, p / (p - 0.5)).x;", true),
    ("o.x = texture(iChannel0, log(-p)).x;", true),
    ("o.x = textureLod(iChannel0, p * 1e20, 0.0).x;", true),
    ("o.x = texture(iChannel0, log(-p)).x > 9.0 ? 1.0 : 0.0;", false),
];

#[test]
fn a_different_policy_shows_pixels_that_depend_on_undefined_behavior() {
    let mut wrong = Vec::new();
    for &(body, hangs) in OPEN {
        let program = Program::new(&checked("", body).unwrap()).unwrap();
        let frame = Frame {
            size: [1, 1],
            ..Frame::default()
        };
        let render = |variant| {
            let settings = Settings::<f32> {
                undefined: variant,
                ..Settings::default()
            };
            program.render(&frame, &settings).unwrap().framebuffer
        };
        let usual = render(UndefinedPolicy::Observed);
        assert!(usual.is_undefined(0, 0), "{body}");
        let usual = usual.get(0, 0)[0];
        let others = Substitute::ALL.map(|other| render(UndefinedPolicy::Substitute(other)).get(0, 0)[0]);
        if others.iter().any(|other| usual.to_bits() != other.to_bits()) != hangs {
            wrong.push(format!("{body}: {usual} {others:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
