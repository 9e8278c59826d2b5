//! Numbers, vectors and motions as expressions of a shader.

use super::slot::Slot;
use crate::{Motion, Period, Point};

pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

pub(super) fn vector([x, y, z]: [f64; 3]) -> String {
    format!("vec3({}, {}, {})", number(x), number(y), number(z))
}

/// Returns the functions that move points, or no functions if nothing moves.
pub(super) fn motion_functions(motions: &[Motion]) -> Vec<String> {
    if motions.is_empty() {
        return Vec::new();
    }
    let own = motions.iter().enumerate().map(|(index, motion)| {
        let turns = match motion.period {
            Period::Frames(frames) => format!("float(iFrame) / {}", number(frames)),
            Period::Seconds(seconds) => format!("iTime / {}", number(seconds)),
        };
        let [pivot, axis] = [motion.pivot, motion.axis].map(vector);
        let arguments = format!("{pivot}, {axis}, {turns}");
        let carried = match motion.within {
            Some(outer) => {
                let call = format!("motion{outer}(rotateAbout(p, «RotationArguments: {arguments}»))");
                match CARRIED_BY.get(outer) {
                    Some(slot) => slot.mark(&call),
                    None => call,
                }
            }
            None => format!("rotateAbout(p, {arguments})"),
        };
        format!("vec3 motion{index}(vec3 p) {{\n    return {carried};\n}}\n")
    });
    let mut pieces = vec![ROTATE.to_owned()];
    pieces.extend(own);
    pieces
}

/// The names of calls of the first motions that carry others along.
const CARRIED_BY: [Slot; 3] = [Slot::CarriedBy0, Slot::CarriedBy1, Slot::CarriedBy2];

/// Returns the expression of a point after its motion.
pub(super) fn moved_point(point: Point, motion: Option<usize>) -> String {
    match motion {
        Some(motion) => format!("motion{motion}({})", vector(point)),
        None => vector(point),
    }
}

/// Returns the expression of a direction that is rotated by the motion of a point.
pub(super) fn moved_direction(direction: Point, at: Point, motion: Option<usize>) -> String {
    let Some(motion) = motion else {
        return vector(direction);
    };
    let [direction, at] = [direction, at].map(vector);
    format!("motion{motion}({at} + {direction}) - motion{motion}({at})")
}

const ROTATE: &str = "// Rotates v about a unit axis (Rodrigues' formula).
vec3 rotate(vec3 v, vec3 axis, float angle) {
    float c = «AngleCosine: cos(angle)»;
    float s = «AngleSine: sin(angle)»;
    return «Rotation: c * v + s * «RotationCross: cross(axis, v)» + (1.0 - c) * dot(axis, v) * axis»;
}

vec3 rotateAbout(vec3 p, vec3 pivot, vec3 axis, float turns) {
    return «RotationAboutPivot: pivot + rotate(«RotatedPoint: p - pivot», axis, «RotationAngle: 6.28318530718 * fract(turns)»)»;
}
";
