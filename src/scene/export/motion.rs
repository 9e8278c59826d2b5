//! How things move.

use super::{number, vector};
use crate::{Motion, Period, Point};

/// The functions that move points; none where nothing moves.
pub(super) fn functions(motions: &[Motion]) -> Vec<String> {
    if motions.is_empty() {
        return Vec::new();
    }
    let own = motions.iter().enumerate().map(|(index, motion)| {
        let turns = match motion.period {
            Period::Frames(frames) => format!("float(iFrame) / {}", number(frames)),
            Period::Seconds(seconds) => format!("iTime / {}", number(seconds)),
        };
        let [pivot, axis] = [motion.pivot, motion.axis].map(vector);
        let turned = format!("rotateAbout(p, {pivot}, {axis}, {turns})");
        let carried = match motion.within {
            Some(outer) => format!("motion{outer}({turned})"),
            None => turned,
        };
        format!("vec3 motion{index}(vec3 p) {{\n    return {carried};\n}}\n")
    });
    let mut pieces = vec![ROTATE.to_owned()];
    pieces.extend(own);
    pieces
}

/// A point where its motion has brought it.
pub(super) fn point(point: Point, motion: Option<usize>) -> String {
    match motion {
        Some(motion) => format!("motion{motion}({})", vector(point)),
        None => vector(point),
    }
}

/// A direction that turns with the things at a point.
pub(super) fn direction(direction: Point, at: Point, motion: Option<usize>) -> String {
    let Some(motion) = motion else {
        return vector(direction);
    };
    let [direction, at] = [direction, at].map(vector);
    format!("motion{motion}({at} + {direction}) - motion{motion}({at})")
}

const ROTATE: &str = "// Rodrigues' formula: v turned about a unit axis.
vec3 rotate(vec3 v, vec3 axis, float angle) {
    float c = cos(angle);
    float s = sin(angle);
    return c * v + s * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;
}

vec3 rotateAbout(vec3 p, vec3 pivot, vec3 axis, float turns) {
    return pivot + rotate(p - pivot, axis, 6.28318530718 * fract(turns));
}
";
