//! Where a scene is seen from.

use super::{figure, number, vector};
use crate::{Projection, Scene};

/// What is seen at a place of the picture: a figure on the screen, or what the ray meets.
pub(super) fn camera(scene: &Scene) -> String {
    let eye = vector(scene.camera.eye);
    let ray = match scene.camera.projection {
        Projection::Pinhole { screen_distance } => {
            format!(
                "trace({eye}, normalize(vec3(x, y, {})))",
                number(-screen_distance)
            )
        }
        Projection::Parallel { width } => format!(
            "trace({eye} + {} * vec3(x, y, 0.0), vec3(0.0, 0.0, -1.0))",
            number(0.5 * width)
        ),
    };
    let figures = figure::tests(&scene.figures);
    format!(
        "vec3 look(vec2 fragCoord) {{\n    float aspect = iResolution.x / iResolution.y;\n    \
         float x = fragCoord.x / iResolution.x * 2.0 - 1.0;\n    \
         float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;\n{figures}    return {ray};\n}}\n"
    )
}
