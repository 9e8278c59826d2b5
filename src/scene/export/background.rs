//! What a ray sees that meets nothing.

use super::vector;
use crate::{Background, Color};

pub(super) fn background(background: &Background) -> String {
    let body = match *background {
        Background::Uniform(color) => format!("    return {};\n", vector(color)),
        Background::Gradient { bottom, top } => gradient(bottom, top),
    };
    format!("vec3 background(vec3 direction) {{\n{body}}}\n")
}

fn gradient(bottom: Color, top: Color) -> String {
    format!(
        "    return mix({}, {}, 0.5 * (1.0 + direction.y));\n",
        vector(bottom),
        vector(top)
    )
}
