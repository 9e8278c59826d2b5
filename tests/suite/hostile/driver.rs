//! Shaders that are hard for compilers and processors.

use super::case::{Case, OK, SLOW, TIMEOUT, body, lines, within};

pub(crate) fn cases() -> Vec<Case> {
    let twice = "float f0(float x) { return fract(x * 1.3 + 0.1); }\n".to_owned()
        + &lines(30, |at| {
            format!(
                "float f{}(float x) {{ return f{at}(x) + f{at}(x + 1.0); }}",
                at + 1
            )
        });
    let sines = lines(3_000, |at| format!("x = sin(x * {at}.5) + 1.0;"));
    let alive = lines(1_500, |at| format!("vec4 a{at} = vec4(p, {at}.0, 1.0) * p.x;"))
        + "c = vec4(0.0);\n"
        + &lines(1_500, |at| format!("c += a{};", 1_499 - at));
    vec![
        within(
            "calls that double thirty times",
            TIMEOUT,
            &twice,
            "c = vec4(f30(p.x));",
        ),
        body(
            "three thousand sines",
            SLOW,
            &format!("float x = p.x; {sines} c = vec4(x);"),
        ),
        body("fifteen hundred vectors alive at once", SLOW, &alive),
        body(
            "an array in registers",
            SLOW,
            "float a[4096]; for (int i = 0; i < 4096; i++) a[i] = p.x; c = vec4(a[int(p.x)]);",
        ),
        body(
            "loops to unroll a million times",
            SLOW,
            "float a[64]; for (int i = 0; i < 64; i++) for (int j = 0; j < 128; j++) for (int k = 0; k < 128; k++) a[i] = p.x + float(j * k); c = vec4(a[int(p.x) % 64]);",
        ),
        body(
            "the smallest integer divided by -1",
            OK,
            "int a = int(p.x) * 0 - 2147483647 - 1; int b = int(p.y) * 0 - 1; c = vec4(float(a / b) + float(a % b));",
        ),
        body(
            "the smallest integer divided by -1 in a constant",
            OK,
            "const int a = (-2147483647 - 1) / -1; const int b = (-2147483647 - 1) % -1; c = vec4(float(a + b));",
        ),
        body(
            "an integer divided by zero",
            OK,
            "int z = int(p.x) * 0; c = vec4(float(7 / z) + float(7 % z) + float(7u / uint(z)));",
        ),
        body(
            "an integer divided by zero in a constant",
            OK,
            "const int a = 1 / 0; c = vec4(float(a));",
        ),
        body(
            "shifts by a thousand",
            OK,
            "int s = int(p.x) + 1000; c = vec4(float(1 << s) + float(-1 >> s) + float(1u >> uint(s)));",
        ),
        body(
            "floats too large for integers",
            OK,
            "c = vec4(float(int(1e30 * p.x)) + float(uint(-1e30 * p.x)) + float(int(sqrt(-p.x))));",
        ),
        body(
            "nothing but NaN and infinities",
            OK,
            "float z = p.x * 0.0; c = vec4(1.0 / z, z / z, log(-p.x), pow(-p.x, 0.5));",
        ),
        body(
            "no pixel is painted",
            OK,
            "if (p.x > -1.0) discard; c = vec4(1.0);",
        ),
        body(
            "derivatives of what only some pixels compute",
            OK,
            "float x = 0.0; for (int i = 0; i < int(p.x) % 5; i++) { x += dFdx(p.x * x) + fwidth(p.y); } c = vec4(x);",
        ),
        body(
            "a matrix that has no inverse",
            OK,
            "mat4 m = mat4(p.x); m[1] = m[0]; c = inverse(m) * vec4(determinant(m));",
        ),
        body(
            "arguments that are written while they are read",
            OK,
            "float x = p.x; vec3 v = vec3(x++, x *= 2.0, x--); c = vec4(v, modf(x, x));",
        ),
    ]
}
