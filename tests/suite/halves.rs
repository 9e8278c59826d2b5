//! Floats of 16 bits: the emulation, and the same shaders on a driver that has such floats.

use std::process::Command;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::{Failure, Worker};
use toyproof::image::{Frame, Image};
use toyproof::numerics::mixed::{MixedPrecision, mixed_precision};
use toyproof::translate::FloatMode;
use toyproof::translate::backend::spirv::{bytes, narrowed, words};
use toyproof::translate::naga_ir::ValidModule;

use crate::requirements::{require_folder, require_program, require_worker, skip};

/// Operations that IEEE 754 defines, in loops, functions, macros and all kinds of assignments.
const OPERATIONS: &str = "\
#define AVERAGE(a, b) (0.5 * ((a) + (b)))
const float SCALE = 0.3;
float shade = 0.1;
float logistic(float x) { return 3.7 * x * (1.0 - x); }
vec3 turned(vec3 v) { vec3 w = v.yzx; w.z *= 0.9; w[1] += 0.01; return w; }
void mainImage(out vec4 c, in vec2 p) {
    vec2 uv = p / 64.0;
    float x = uv.x, y = 0.0;
    vec3 v = vec3(uv, 0.25);
    for (int i = 0; i < 6; i++) {
        x = logistic(x);
        y += AVERAGE(x, uv.y) / 6.0;
        v = turned(v) - SCALE * vec3(0.0, x, 0.0);
        x++; x -= 1.0;
    }
    shade += sqrt(max(y, 0.0)) * (y > 0.5 ? x : -y);
    c = vec4(mix(v, vec3(min(abs(x), y)), step(0.4, uv.y)), 1.0) + vec4(floor(4.0 * shade));
}";

/// Functions whose last bits are the driver's.
const FUNCTIONS: &str = "\
void mainImage(out vec4 c, in vec2 p) {
    vec2 uv = p / 64.0 + 0.01;
    vec3 a = vec3(uv, 0.5), b = normalize(a.yzx + 0.1);
    float wave = sin(3.0 * uv.x) * cos(uv.y) + tan(uv.x) * exp(-uv.y) + pow(uv.y + 0.5, 1.5);
    float angle = atan(uv.y, uv.x) + asin(uv.x) * acos(uv.y) + log2(1.0 + uv.x) + inversesqrt(1.0 + uv.y);
    float lengths = length(cross(a, b)) + distance(a, b) + dot(reflect(a, b), refract(b, a, 0.9));
    c = vec4(0.5 + 0.1 * wave, 0.1 * angle, 0.2 * lengths * smoothstep(0.0, 1.0, uv.x), 1.0);
}";

fn checked(text: &str) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("s", text));
    check(&files, file, &Options::default()).unwrap()
}

fn frame() -> Frame {
    Frame {
        size: [64, 36],
        ..Frame::default()
    }
}

fn found(text: &str) -> MixedPrecision {
    let deadline = Instant::now() + Duration::from_secs(60);
    mixed_precision(&checked(text), text, &frame(), deadline, &AtomicBool::new(false)).unwrap()
}

/// The driver's image in strict arithmetic, computed in 16 bits; `None` if the device has no such floats.
fn drawn(worker: &mut Worker, shader: &Checked) -> Option<Image> {
    let lowered = FloatMode::Strict.lower(shader).narrowed();
    match worker.draw(lowered, frame(), FloatMode::Strict) {
        Err(Failure::NoDriver(why)) => {
            skip(&why);
            None
        }
        drawn => Some(drawn.unwrap().image()),
    }
}

fn differing_pixels(one: &Image, other: &Image) -> usize {
    let bits = |image: &Image| -> Vec<_> {
        let pixels = image.pixels().iter();
        pixels.map(|pixel| pixel.map(f32::to_bits)).collect()
    };
    let pairs = bits(one).into_iter().zip(bits(other));
    pairs.filter(|(one, other)| one != other).count()
}

/// Strict arithmetic: every operation of IEEE 754 has one result, in 16 bits, too.
#[test]
fn the_driver_computes_the_bits_of_the_emulation() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for text in [OPERATIONS, FUNCTIONS] {
        let found = found(text);
        assert!(
            found.found * 2 > found.tried,
            "{:?} of {}",
            found.names,
            found.tried
        );
        let Some(image) = drawn(&mut worker, &found.emulated) else {
            return;
        };
        assert_eq!(differing_pixels(&found.image, &image), 0);
        // The numbers are not those of 32 bits.
        let single = worker.draw(
            FloatMode::Strict.lower(&checked(text)),
            frame(),
            FloatMode::Strict,
        );
        assert!(differing_pixels(&image, &single.unwrap().image()) > 1000);
    }
}

#[test]
fn modules_of_sixteen_bits_are_valid() {
    if !require_program("spirv-val") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("half.spv");
    for text in [OPERATIONS, FUNCTIONS] {
        for float in [FloatMode::Strict, FloatMode::Fast] {
            let module = ValidModule::parse(&float.lower(&found(text).emulated)).unwrap();
            let plain = words(&module).unwrap();
            let narrow = narrowed(&plain);
            assert_ne!(narrow, plain);
            std::fs::write(&path, bytes(&narrow)).unwrap();
            let run = Command::new("spirv-val")
                .args(["--target-env", "vulkan1.1"])
                .arg(&path)
                .output();
            let run = run.unwrap();
            assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
        }
    }
}

#[test]
#[ignore = "takes minutes, and a folder of shaders that TOYPROOF_SHADERS names"]
fn other_shaders_have_the_bits_of_the_emulation() {
    let (Some(folder), Some(mut worker)) = (require_folder("TOYPROOF_SHADERS"), require_worker()) else {
        return;
    };
    let mut differing = Vec::new();
    for entry in walkdir::WalkDir::new(folder).sort_by_file_name() {
        let entry = entry.unwrap();
        let text = std::fs::read_to_string(entry.path()).unwrap_or_default();
        let mut files = Files::default();
        let file = files.add(File::new("s", &text));
        let Ok(checked) = check(&files, file, &Options::default()) else {
            continue;
        };
        let deadline = Instant::now() + Duration::from_secs(10);
        let found = mixed_precision(&checked, &text, &frame(), deadline, &AtomicBool::new(false));
        let Some(found) = found else { continue };
        let lowered = FloatMode::Strict.lower(&found.emulated).narrowed();
        let line = match worker.draw(lowered, frame(), FloatMode::Strict) {
            Ok(drawn) => {
                let count = differing_pixels(&found.image, &drawn.image());
                if count > 0 {
                    differing.push(entry.path().to_owned());
                }
                format!("{count} pixels differ")
            }
            Err(failure) => failure.to_string(),
        };
        eprintln!(
            "{}: {} of {}, {line}",
            entry.path().display(),
            found.found,
            found.tried
        );
    }
    assert!(differing.is_empty(), "{differing:?}");
}
