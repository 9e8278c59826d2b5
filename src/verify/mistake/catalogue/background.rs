//! The background.

use super::mistakes;

const HEAD: &str = "vec3 background(vec3 direction) {";
const UP: &str = "0.5 * (1.0 + direction.y)";

mistakes! {
    "black-background": "has no background", [("vec3 background(vec3 direction) {\n    return …;", "vec3 background(vec3 direction) {\n    return vec3(0.0);")];
    "background-upside-down": "has the background upside down",
        [(HEAD, "vec3 background(vec3 direction) {\n    direction.y = -direction.y;")];
    "background-by-y-alone": "mixes the background by y, which goes from −1 to 1, not from 0 to 1", [(UP, "direction.y")];
    "background-along-x": "mixes the background along x, not along y", [(UP, "0.5 * (1.0 + direction.x)")];
    "background-along-z": "mixes the background along z, not along y", [(UP, "0.5 * (1.0 + direction.z)")];
    "background-not-reflected": "does not tint the background that mirrors show",
        [("return throughput * background(ray.direction);", "return background(ray.direction);")];
    "background-of-the-first-ray": "shows in mirrors the background that the eye's own ray would see",
        [("background(ray.direction);", "background(direction);")];
}
