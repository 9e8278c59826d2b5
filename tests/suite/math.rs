//! The functions that strict shaders expand have the same bits on the driver and on the CPU.

use std::fmt::Write as _;

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::gpu::{DrawOutput, Worker};
use toyproof::image::Frame;
use toyproof::math::{self as e, Matrix, native};
use toyproof::translate::{FloatMode, lower_strict};

use crate::requirements::require_worker;

/// Width and height of an image of arguments, in pixels.
const SIZE: u32 = 256;

/// A GLSL function of one or two arguments, and our implementation.
struct Case {
    call: &'static str,
    ours: fn(f32, f32) -> f32,
}

macro_rules! cases {
    ($($call:literal = $ours:expr;)*) => {
        [$(Case { call: $call, ours: $ours },)*]
    };
}

fn cases() -> [Case; 18] {
    cases! {
        "sin(x)" = |x, _| native::sin(x);
        "cos(x)" = |x, _| native::cos(x);
        "tan(x)" = |x, _| native::tan(x);
        "asin(x)" = |x, _| native::asin(x);
        "acos(x)" = |x, _| native::acos(x);
        "atan(x)" = |x, _| native::atan(x);
        "sinh(x)" = |x, _| native::sinh(x);
        "cosh(x)" = |x, _| native::cosh(x);
        "tanh(x)" = |x, _| native::tanh(x);
        "asinh(x)" = |x, _| native::asinh(x);
        "acosh(x)" = |x, _| native::acosh(x);
        "atanh(x)" = |x, _| native::atanh(x);
        "exp(x)" = |x, _| native::exp(x);
        "exp2(x)" = |x, _| native::exp2(x);
        "log(x)" = |x, _| native::log(x);
        "log2(x)" = |x, _| native::log2(x);
        "pow(x, y)" = native::pow;
        "atan(x, y)" = native::atan2;
    }
}

/// Two arguments per pixel: random bits, and typical floats of shaders, up to some thousands.
const ARGUMENTS: &str = "uint hash(uint n) {
    n ^= n >> 16u; n *= 0x7FEB352Du; n ^= n >> 15u; n *= 0x846CA68Bu; return n ^ n >> 16u;
}
float argument(uint n) {
    uint h = hash(n);
    uint usual = ((h >> 8u & 0x87FFFFFFu) % 0x0A000000u) + 0x3A000000u | h & 0x80000000u;
    return uintBitsToFloat((n & 4u) == 0u ? h : usual);
}
float usual(uint n) {
    return argument(8u * n + 4u);
}";

fn hash(mut n: u32) -> u32 {
    n ^= n >> 16;
    n = n.wrapping_mul(0x7FEB_352D);
    n ^= n >> 15;
    n = n.wrapping_mul(0x846C_A68B);
    n ^ n >> 16
}

fn argument(n: u32) -> f32 {
    let h = hash(n);
    let usual = (((h >> 8 & 0x87FF_FFFF) % 0x0A00_0000) + 0x3A00_0000) | (h & 0x8000_0000);
    f32::from_bits(if n & 4 == 0 { h } else { usual })
}

fn shader(call: &str, first: u32) -> String {
    let mut text = ARGUMENTS.to_owned();
    let _ = write!(
        text,
        "\nvoid mainImage(out vec4 c, in vec2 p) {{
            uint n = (uint(p.x) + uint(p.y) * {SIZE}u) * 2u + {first}u;
            float x = argument(n), y = argument(n + 1u);
            vec3 a = vec3(usual(n), usual(n + 1u), usual(n + 2u));
            vec3 b = vec3(usual(n + 3u), usual(n + 4u), usual(n + 5u));
            uint bits = floatBitsToUint({call});
            c = vec4(float(bits >> 16u), float(bits & 0xFFFFu), 0, 1);
        }}"
    );
    text
}

fn draw(worker: &mut Worker, text: &str, size: u32) -> DrawOutput {
    let mut files = Files::default();
    let file = files.add(File::new("s", text));
    let frame = Frame {
        size: [size, size],
        ..Frame::default()
    };
    let checked =
        check(&files, file, &Options::default()).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"));
    worker
        .draw(lower_strict(&checked), frame, FloatMode::Strict)
        .unwrap()
}

/// Renders `call` for pixels that start at argument `first`, two per pixel.
///
/// # Panics
/// If a result differs from ours.
fn compare(worker: &mut Worker, call: &str, ours: impl Fn(u32) -> f32, first: u32) {
    let drawn = draw(worker, &shader(call, first), SIZE);
    let device = drawn.device.clone();
    for (pixel, n) in drawn.image().pixels().iter().zip((first..).step_by(2)) {
        let theirs = f32::from_bits((pixel[0] as u32) << 16 | pixel[1] as u32);
        let ours = ours(n);
        assert!(
            theirs.to_bits() == ours.to_bits() || theirs.is_nan() && ours.is_nan(),
            "{call} of {:e}, {:e} is {theirs:e} on {device}, not {ours:e}",
            argument(n),
            argument(n + 1),
        );
    }
}

#[test]
fn the_driver_and_the_cpu_compute_the_same_bits() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    // TOYPROOF_PICTURES=64 tests 4 million arguments for each function.
    let images = std::env::var("TOYPROOF_PICTURES").map_or(1, |count| count.parse().unwrap());
    for case in &cases() {
        for index in 0..images {
            let ours = |n| (case.ours)(argument(n), argument(n + 1));
            compare(&mut worker, case.call, ours, index * SIZE * SIZE * 2);
        }
    }
}

/// A GLSL expression of two 3-vectors, and our implementation.
type OfVectors = (&'static str, fn([f32; 3], [f32; 3]) -> f32);

fn rotated([x, y, z]: [f32; 3]) -> [f32; 3] {
    [z, x, y]
}

/// `mat3(a, b, a.zxy)`
fn three(a: [f32; 3], b: [f32; 3]) -> Matrix<f32> {
    Matrix::new(&[a, b, rotated(a)].concat(), 3)
}

/// `mat4(a, 1.0, b, 2.0, b.zxy, 3.0, a.zxy, 4.0)`
fn four(a: [f32; 3], b: [f32; 3]) -> Matrix<f32> {
    let columns = [(a, 1.0), (b, 2.0), (rotated(b), 3.0), (rotated(a), 4.0)];
    Matrix::new(&columns.map(|([x, y, z], w)| [x, y, z, w]).concat(), 4)
}

const OF_VECTORS: [OfVectors; 26] = [
    ("length(a)", |a, _| e::length(&a)),
    ("distance(a, b)", |a, b| e::distance(&a, &b)),
    ("dot(a, b)", |a, b| e::dot(&a, &b)),
    ("cross(a, b).y", |a, b| e::cross(a, b)[1]),
    ("normalize(a).z", |a, _| e::normalize(&a)[2]),
    ("reflect(a, b).x", |a, b| e::reflect(&a, &b)[0]),
    ("refract(a, normalize(b), 0.8).y", |a, b| {
        e::refract(&a, &e::normalize(&b), 0.8)[1]
    }),
    ("faceforward(a, b, a).x", |a, b| e::faceforward(&a, &b, &a)[0]),
    ("normalize(a.x)", |a, _| e::normalize(&a[..1])[0]),
    ("reflect(a.x, b.y)", |a, b| e::reflect(&a[..1], &b[1..2])[0]),
    ("mix(a, b, 0.3).y", |a, b| e::mix(a[1], b[1], 0.3)),
    ("mix(a, b, b.zxy).y", |a, b| e::mix(a[1], b[1], rotated(b)[1])),
    ("smoothstep(a, b, b.zxy).z", |a, b| {
        e::smoothstep(a[2], b[2], rotated(b)[2])
    }),
    ("smoothstep(-1.0, 1.0, b).z", |_, b| {
        e::smoothstep(-1.0, 1.0, b[2])
    }),
    ("mod(a, b).x", |a, b| e::modulo(a[0], b[0])),
    ("mod(a, 0.7).z", |a, _| e::modulo(a[2], 0.7)),
    ("fract(a).x", |a, _| e::fract(a[0])),
    ("radians(a).x + degrees(b).x", |a, b| {
        e::radians(a[0]) + e::degrees(b[0])
    }),
    ("inversesqrt(a * a).z", |a, _| e::inverse_sqrt(a[2] * a[2])),
    ("step(a, b).y", |a, b| e::step(a[1], b[1])),
    ("(mat3(a, b, a.zxy) * b).y", |a, b| {
        three(a, b).times_vector(&b)[1]
    }),
    ("(b * mat3(a, b, a.zxy)).z", |a, b| {
        three(a, b).vector_times(&b)[2]
    }),
    ("(mat3(a, b, a.zxy) * mat3(b, a, b.zxy))[1].z", |a, b| {
        three(a, b).times(&three(b, a)).components()[5]
    }),
    ("inverse(mat3(a, b, a.zxy))[2].y", |a, b| {
        e::inverse(&three(a, b)).components()[7]
    }),
    ("inverse(mat4(a, 1, b, 2, b.zxy, 3, a.zxy, 4))[1].z", |a, b| {
        e::inverse(&four(a, b)).components()[6]
    }),
    ("float(floatBitsToUint(a.x))", |a, _| a[0].to_bits() as f32),
];

#[test]
fn vectors_and_matrices_have_the_same_bits() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for (call, ours) in OF_VECTORS {
        let ours = |n| {
            let at = |n: u32| [0, 1, 2].map(|i| argument(8 * (n + i) + 4));
            ours(at(n), at(n + 3))
        };
        compare(&mut worker, call, ours, 0);
    }
}

#[test]
fn constants_have_the_same_bits() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for case in &cases() {
        // Arguments above 1 are outside of some domains.
        for (x, y) in [(0.7, 1.3), (2.5, -0.6)] {
            let ours = (case.ours)(x, y);
            if ours.is_nan() {
                continue;
            }
            let call = case
                .call
                .replace("(x", &format!("({x:?}"))
                .replace(", y", &format!(", {y:?}"));
            let bits = ours.to_bits();
            let text = format!(
                "const float G = {call}; const vec2 V = vec2({call});
                void mainImage(out vec4 c, in vec2 p) {{
                    const float L = {call};
                    c = vec4(floatBitsToUint(G) == {bits}u, floatBitsToUint(L) == {bits}u,
                        floatBitsToUint({call}) == {bits}u && floatBitsToUint(V.y) == {bits}u, 1);
                }}"
            );
            assert_eq!(
                draw(&mut worker, &text, 1).image().pixels()[0],
                [1.0; 4],
                "{text}"
            );
        }
    }
}
