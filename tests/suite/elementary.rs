//! What is spelled for strict shaders has the same bits on the driver and here.

use std::fmt::Write as _;

use toyproof::elementary::native;
use toyproof::frame::Frame;
use toyproof::glsl::{Options, check, lower_strict};
use toyproof::gpu::{FloatMode, Worker};
use toyproof::source::{File, Files};

/// Width and height of a picture of arguments.
const SIZE: u32 = 256;

/// A function of GLSL of one or two arguments, and ours.
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

/// Two arguments for each pixel: any bits, and floats that shaders meet, up to some thousands.
const ARGUMENTS: &str = "uint hash(uint n) {
    n ^= n >> 16u; n *= 0x7FEB352Du; n ^= n >> 15u; n *= 0x846CA68Bu; return n ^ n >> 16u;
}
float argument(uint n) {
    uint h = hash(n);
    uint usual = ((h >> 8u & 0x87FFFFFFu) % 0x0A000000u) + 0x3A000000u | h & 0x80000000u;
    return uintBitsToFloat((n & 4u) == 0u ? h : usual);
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
            uint bits = floatBitsToUint({call});
            c = vec4(float(bits >> 16u), float(bits & 0xFFFFu), 0, 1);
        }}"
    );
    text
}

/// How many results differ, and the first that does.
fn differing(worker: &mut Worker, case: &Case, first: u32) -> (usize, String) {
    let mut files = Files::default();
    let file = files.add(File::new(case.call, shader(case.call, first)));
    let frame = Frame {
        size: [SIZE, SIZE],
        ..Frame::default()
    };
    let checked = check(&files, file, &Options::default()).unwrap();
    let drawn = worker
        .draw(lower_strict(&checked), frame, FloatMode::Strict)
        .unwrap();
    let mut count = 0;
    let mut told = String::new();
    for (pixel, n) in drawn.image.pixels().iter().zip((first..).step_by(2)) {
        let theirs = f32::from_bits((pixel[0] as u32) << 16 | pixel[1] as u32);
        let (x, y) = (argument(n), argument(n + 1));
        let ours = (case.ours)(x, y);
        if theirs.to_bits() != ours.to_bits() && !(theirs.is_nan() && ours.is_nan()) {
            if count == 0 {
                told = format!(
                    "{} of {x:e}, {y:e} is {theirs:e} on {}, not {ours:e}",
                    case.call, drawn.device
                );
            }
            count += 1;
        }
    }
    (count, told)
}

#[test]
fn the_driver_and_we_compute_the_same_bits() {
    let Some(mut worker) = crate::support::worker() else {
        return;
    };
    // TOYPROOF_PICTURES=64 takes 4 million arguments for each function.
    let pictures = std::env::var("TOYPROOF_PICTURES").map_or(1, |count| count.parse().unwrap());
    for case in &cases() {
        for picture in 0..pictures {
            let (count, told) = differing(&mut worker, case, picture * SIZE * SIZE * 2);
            assert_eq!(count, 0, "{told}");
        }
    }
}
