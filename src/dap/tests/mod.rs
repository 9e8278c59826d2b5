//! Tests of the engine and of sessions.

mod engine;
mod session;

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{File, Files};
use toyproof_image::Frame;

use crate::recording::{Point, Recording};
use crate::subject::Subject;

/// A limit that only a hang exceeds.
const HANG_GUARD: Duration = Duration::from_secs(120);

/// A sphere in the style of the course: a function with early returns, `inout`, a loop and a structure.
const SPHERES: &str = "\
struct Ray {
    vec3 origin;
    vec3 direction;
};

vec3 centers[2];

float hit(Ray ray, vec3 center) {
    vec3 f = ray.origin - center;
    float b = dot(f, ray.direction);
    float disc = b * b - dot(f, f) + 1.0;
    if (disc < 0.0) return -1.0;
    return -b - sqrt(disc);
}

void closer(float t, inout float nearest) {
    if (t > 0.0 && t < nearest) {
        nearest = t;
    }
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    centers[0] = vec3(0.0, 0.0, -5.0);
    centers[1] = vec3(0.0, 0.0, -3.0);
    Ray ray = Ray(vec3(0.0), vec3(0.0, 0.0, -1.0));
    float nearest = 1000.0;
    for (int i = 0; i < 2; i++) {
        closer(hit(ray, centers[i]), nearest);
    }
    fragColor = vec4(vec3(nearest / 10.0), 1.0);
}
";

fn subject(text: &str) -> Subject {
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default());
    Subject {
        name: "a.glsl".to_owned(),
        checked: checked.unwrap_or_else(|errors| panic!("{errors}")),
        files,
        frame: Frame {
            size: [64, 36],
            ..Frame::default()
        },
        pixel: [30, 18],
        expected: None,
        timeout: HANG_GUARD,
    }
}

fn record(subject: &Subject) -> Recording {
    Recording::new(subject, Instant::now() + HANG_GUARD, &AtomicBool::new(false)).unwrap()
}

fn line(recording: &Recording, point: Point) -> usize {
    recording.line(point).map_or(0, |line| line.line)
}
