//! Miscompilations of naga or lavapipe: on the GPU the image is wrong without the pass that works around it,
//! and right with it.

use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::{Options, check};
use toyproof::gpu::Worker;
use toyproof::image::{Frame, Image};
use toyproof::translate::lower::{Pass, Passes, lower_with};
use toyproof::translate::{FloatMode, lower_strict};

use crate::requirements::{require_swiftshader, require_worker};

/// A miscompilation: the pass that fixes it, the text before `mainImage`, its body, and the expected `o.x`.
type Case = (Pass, &'static str, &'static str, f32);

/// `p` is (0.5, 0.5); `iTime` is 2; texel (1, 2) of `iChannel0` is 0.75, the others are 0.
static CASES: &[Case] = &[
    (
        Pass::ShortCircuit,
        "bool hit(inout float t) { t = 9.0; return true; }",
        "float t = 1.0; if (p.x > 9.0 && hit(t)) t += 1.0; o.x = t;",
        1.0,
    ),
    (
        Pass::ShortCircuit,
        "bool hit(inout float t) { t = 9.0; return true; }",
        "float t = 1.0; if (p.x < 9.0 || hit(t)) t += 1.0; o.x = t;",
        2.0,
    ),
    (
        Pass::Texels,
        "",
        "o.x = texelFetchOffset(iChannel0, ivec2(0), 0, ivec2(1, 2)).x;",
        0.75,
    ),
    (
        Pass::Indices,
        "",
        "float a[3]; a[0] = 1.0; a[1] = 2.0; a[2] = 4.0; int i = int(p.x); a[i++] += 8.0; o.x = a[0] + 16.0 * float(i);",
        25.0,
    ),
    (
        Pass::Indices,
        "",
        "vec2 v[2]; v[0] = vec2(1.0, 2.0); v[1] = vec2(4.0, 8.0); int i = int(p.x); o.x = v[i = 1][i];",
        8.0,
    ),
    (
        Pass::Indices,
        "",
        "vec2 v[2]; v[1] = vec2(4.0, 8.0); int i = int(p.x); v[i = 1][i] = 5.0; o.x = v[1].y;",
        5.0,
    ),
    (
        Pass::Indices,
        "",
        "int i = int(p.x); o.x = float(int[2](i + 4, 1)[(i = 2) & 1]);",
        4.0,
    ),
    (
        Pass::Compounds,
        "float g; float next() { g += 1.0; return g; }",
        "g = 2.0; g += next(); vec2 u = vec2(1.0); u += vec2(dot(u *= 2.0, vec2(1.0))); o.x = g + 10.0 * u.x;",
        66.0,
    ),
    (
        Pass::Remainders,
        "",
        "int i = int(p.x) - 7; o.x = float(i % 3);",
        2.0,
    ),
    (Pass::Globals, "float twice = iTime * 2.0;", "o.x = twice;", 4.0),
    (
        Pass::Uninitialized,
        "",
        "for (int i = 0; i < 3; i++) { float a; a += 1.0; o.x += a; }",
        3.0,
    ),
    (
        Pass::Uninitialized,
        "void f(out float x) { if (iTime > 5.0) x = 2.0; }",
        "float x = 1.0; f(x); o.x = x;",
        0.0,
    ),
    (
        Pass::Inequality,
        "",
        "float zero = p.x - p.y, nan = zero / zero; o.x = float(nan != nan) + 2.0 * float(notEqual(vec2(nan), p).x);",
        3.0,
    ),
    (
        Pass::DoWhile,
        "",
        "int i = 0; do { i++; if (i < 9) continue; } while (i < 3); o.x = float(i);",
        3.0,
    ),
    // The driver's arc cosine is wrong by thousands of units in the last place.
    (
        Pass::InexactFunctions,
        "",
        "o.x = floor(1e6 * acos(0.3 + 0.1 * floor(p.x)));",
        1_266_103.0,
    ),
    // Two iterations, not three.
    (
        Pass::Steps,
        "",
        "vec2 k = vec2(1.0); for (; k.x > 0.0 && p.x > 0.25; k -= 0.125) p.x -= 0.125; o.x = k.x;",
        0.75,
    ),
];

/// The passes that naga needs, or all if the case is about a strict one.
fn passes(pass: Pass) -> Passes {
    let all = Passes::required();
    if all.contains(pass) { all } else { Passes::strict() }
}

fn render(worker: &mut Worker, (pass, before, body, _): &Case, passes: Passes) -> f32 {
    let mut files = Files::default();
    let text = format!("{before}\nvoid mainImage(out vec4 o, in vec2 p) {{ o = vec4(0.0); {body} }}");
    let file = files.add(File::new("s", text));
    let checked = check(
        &files,
        file,
        &Options {
            lenient: true,
            ..Options::default()
        },
    )
    .unwrap();
    let mut texels = vec![[0.0; 4]; 16];
    texels[2 * 4 + 1] = [0.75; 4];
    let mut frame = Frame {
        size: [1, 1],
        time: 2.0,
        ..Frame::default()
    };
    frame.channels[0] = Some(Image::new(4, 4, texels).into());
    worker
        .draw(lower_with(&checked, passes), frame, FloatMode::Strict)
        .unwrap_or_else(|failure| panic!("{pass:?}: {failure}"))
        .image()
        .get(0, 0)[0]
}

#[test]
fn each_pass_fixes_its_miscompilation() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for case in CASES {
        let (pass, _, body, expected) = case;
        let with = render(&mut worker, case, passes(*pass));
        assert_eq!(with, *expected, "{pass:?}: {body}");
        let without = render(&mut worker, case, passes(*pass).without(*pass));
        assert_ne!(
            without, *expected,
            "naga or the driver is mended, {pass:?} can go: {body}"
        );
    }
}

/// naga swaps the dimensions of `float a[2][3]`; the printer writes them swapped.
#[test]
fn arrays_of_arrays_keep_their_dimensions() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let body = "float a[2][3]; for (int i = 0; i < 2; i++) for (int j = 0; j < 3; j++) a[i][j] = float(10 * i + j); \
                o.x = a[int(p.x) + 1][2] + 100.0 * float(a.length()) + 1000.0 * float(a[0].length());";
    let case = (Pass::DeadCode, "", body, 3212.0);
    assert_eq!(render(&mut worker, &case, Passes::required()), 3212.0);
}

/// Bodies whose images Mesa or `SwiftShader` gets wrong without the worker's changes of SPIR-V. `inf` is infinite in a
/// column.
const FOLDED: &[&str] = &[
    // Products and quotients of zeros that result from folding, by what may be infinite.
    "float zero = 0.0; c.x = isnan(inf * zero) ? 1.0 : 0.0;",
    "float zero = 1.0; zero -= 1.0; c.x = isnan(inf * zero) ? 1.0 : 0.0;",
    "bool no = false; c.x = isnan(inf * float(no)) ? 1.0 : 0.0;",
    "float a = 0.3; c.x = isnan(inf * floor(a)) ? 1.0 : 0.0;",
    "float a = 0.0; c.x = isnan(inf * sin(a)) ? 1.0 : 0.0;",
    "c.x = isnan(inf * step(1.0, 0.5)) ? 1.0 : 0.0;",
    "float sum = 0.0; for (int i = 0; i < 3; i++) sum += inf * float(i); c.x = isnan(sum) ? 1.0 : 0.0;",
    "vec3 ray = vec3(0, 0, -1); c.xyz = vec3(isnan(ray * inf));",
    "mat3 m = mat3(1.0); c.xyz = vec3(isnan(m * m * vec3(inf, 1.0, 2.0)));",
    "float angle = 0.0; c.xy = vec2(isnan(mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * vec2(inf, 1.0)));",
    "c.x = isnan(mix(inf, 0.5, 1.0)) ? 1.0 : 0.0;",
    "c.xyz = vec3(isnan(mix(vec3(inf), vec3(0.5), 1.0)));",
    // Denormal operands: zeros where they are computed with, and kept where they are moved.
    "float d = uintBitsToFloat(uint(p.x) + 5u); c.x = ceil(d); c.y = floor(-d); c.z = sqrt(d); c.w = float(d == 0.0);",
    "float d = uintBitsToFloat(uint(p.x) + 5u); c = vec4(d * 1e30, min(d, 1.0) * 1e30, max(d, -1.0) * 1e30, sign(d));",
    "float d = uintBitsToFloat(uint(p.x) + 5u), e = p.y > 3.0 ? d : abs(d); c.x = float(floatBitsToInt(e));",
    "float d[2]; d[0] = 1.0; d[1] = uintBitsToFloat(uint(p.x)); c.xy = vec2(d[int(p.y) & 1] * 1e38, floatBitsToInt(d[1]));",
    "float d = p.x; for (int i = 0; i < 3; i++) { if (p.y > float(i)) d = ceil(d); else d = uintBitsToFloat(7u); } c.x = d;",
    "c.xy = 2.0 * vec2(1e-38) + floor(1e-40); c.z = 1e-40 == 0.0 ? 1.0 : 2.0;",
    "float e = bool[2](true, false)[1] ? 1.0 : uintBitsToFloat(4u); c.x = e == 0.0 ? 1.0 : 2.0;",
    "float tiny = 1e-40; c.x = tiny * 1e30 * p.x; c.y = float(tiny > 0.0); c.z = float(tiny < p.x);",
    // A loop whose iterations the compiler counts as -2147483648 / -1.
    "int k = 0, i = 3; while (i-- > 0) { if (-2147483647 - 1 == k--) break; } c.x = float(k);",
    // Loops that some pixels leave earlier than others, after assignments.
    "float r = p.x; int i = 0; do { r *= 1.5; i++; if (r > 9.0) break; } while (i < 6); c = vec4(r, i, 0, 1);",
    "float r = p.x; int i = 0; do { r *= 1.5; i++; } while (i < 6 && r < 9.0); c = vec4(r, i, 0, 1);",
    "float r = p.x; int i = 0; for (;;) { r *= 1.5; if (r > 9.0) { i += 4; break; } if (++i > 5) break; } c = vec4(r, i, 0, 1);",
    "float r = p.x; while ((r = 1.5 * r) < 9.0) {} c.x = r;",
    "float m = p.y; for (int i = 0;; i++) { m = inf * 0.0; if (i >= 1) break; } c.x = isnan(m) ? 1.0 : 0.0;",
    "for (int i = 0; i < 2; i++) { float r = p.x; do { r += p.y; if (r > 5.0) break; r *= 1.5; } while (r < 8.0); c.x += r; }",
];

#[test]
fn the_driver_folds_and_loops_as_the_evaluator() {
    folds_as_the_evaluator(require_worker);
}

#[test]
fn swiftshader_folds_and_loops_as_the_evaluator() {
    folds_as_the_evaluator(require_swiftshader);
}

fn folds_as_the_evaluator(start: fn() -> Option<Worker>) {
    let Some(mut worker) = start() else {
        return;
    };
    let mut wrong = Vec::new();
    for body in FOLDED {
        let mut files = Files::default();
        let text = format!(
            "void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0); float inf = 1.0 / (p.x - 4.5); {body} }}"
        );
        let file = files.add(File::new("s", text));
        let checked = check(&files, file, &Options::default()).unwrap_or_else(|_| panic!("{body}"));
        let frame = Frame {
            size: [8, 8],
            ..Frame::default()
        };
        let own = Program::new(&checked).unwrap();
        let own = own.render::<f32>(&frame, &Settings::default()).unwrap();
        match worker.draw(lower_strict(&checked), frame, FloatMode::Strict) {
            Ok(drawn) if drawn.clone().image() == own.framebuffer.image() => {}
            Ok(_) => wrong.push(format!("differs: {body}")),
            Err(failure) => {
                wrong.push(format!("{failure}: {body}"));
                worker = start().expect("there was one before");
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
