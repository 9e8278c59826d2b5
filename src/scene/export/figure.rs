//! Figures on the screen.

use super::{number, vector};
use crate::{Figure, Outline};

fn pair([x, y]: [f64; 2]) -> String {
    format!("vec2({}, {})", number(x), number(y))
}

/// The implicit function of an outline, and how it is called at p.
fn function(outline: &Outline) -> (&'static str, String) {
    match *outline {
        Outline::Disk { center, radius } => (DISK, format!("disk(p, {}, {})", pair(center), number(radius))),
        Outline::Wave {
            height,
            amplitude,
            frequency,
        } => {
            let [height, amplitude, frequency] = [height, amplitude, frequency].map(number);
            (WAVE, format!("wave(p, {height}, {amplitude}, {frequency})"))
        }
        Outline::Heart { center, size } => (HEART, format!("heart(p, {}, {})", pair(center), number(size))),
    }
}

/// The implicit functions that are in use, inside where they are below 0.
pub(super) fn functions(figures: &[Figure]) -> Vec<String> {
    let mut pieces: Vec<String> = Vec::new();
    for figure in figures {
        let (text, _) = function(&figure.outline);
        if !pieces.iter().any(|piece| piece == text) {
            pieces.push(text.to_owned());
        }
    }
    pieces
}

/// Returns the colour of the topmost figure, if one covers (x, y).
pub(super) fn tests(figures: &[Figure]) -> String {
    if figures.is_empty() {
        return String::new();
    }
    let tests = figures.iter().rev().map(|figure| {
        let (_, call) = function(&figure.outline);
        format!(
            "    if ({call} < 0.0) {{\n        return {};\n    }}\n",
            vector(figure.color)
        )
    });
    "    vec2 p = vec2(x, y);\n".to_owned() + &tests.collect::<String>()
}

const DISK: &str = "float disk(vec2 p, vec2 center, float radius) {
    vec2 d = p - center;
    return dot(d, d) - radius * radius;
}
";

const WAVE: &str = "// Below a sine wave.
float wave(vec2 p, float height, float amplitude, float frequency) {
    return p.y - height - amplitude * sin(frequency * p.x);
}
";

const HEART: &str = "float heart(vec2 p, vec2 center, float size) {
    vec2 q = (p - center) / size;
    float ring = dot(q, q) - 1.0;
    return ring * ring * ring - q.x * q.x * q.y * q.y * q.y;
}
";
