//! The camera.

use super::intersection::{DISC, TEXTBOOK};
use super::mistakes;

const X: &str = "float x = fragCoord.x / iResolution.x * 2.0 - 1.0;";
const Y: &str = "(fragCoord.y / iResolution.y * 2.0 - 1.0)";
const LOOK: &str = "vec3 look(vec2 fragCoord) {";
const UNIT: &str = "normalize(vec3(x, y, …))";
const PARALLEL: &str = "vec3(0.0, 0.0, -1.0))";

mistakes! {
    "direction-not-normalised": "does not normalise the camera's directions, though its formula is that for directions of length 1",
        [(UNIT, "vec3(x, y, …)"), (DISC, TEXTBOOK)],
        [(PARALLEL, "vec3(0.0, 0.0, -2.0))"), (DISC, TEXTBOOK)];
    "no-aspect": "forgets the aspect of the picture", [(") / aspect;", ");")];
    "aspect-upside-down": "multiplies by the aspect where it should divide", [(") / aspect;", ") * aspect;")];
    "aspect-of-integers": "computes the aspect by integer division",
        [("iResolution.x / iResolution.y;", "float(int(iResolution.x) / int(iResolution.y));")];
    "place-of-integers": "computes the place on the screen by integer division",
        [
            (X, "float x = float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0;"),
            (Y, "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)")
        ],
        [(X, "float x = float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0;")],
        [(Y, "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)")];
    "upside-down": "has y upside down", [(Y, "(1.0 - fragCoord.y / iResolution.y * 2.0)")];
    "mirrored": "has x the wrong way round", [(X, "float x = 1.0 - fragCoord.x / iResolution.x * 2.0;")];
    "not-centred": "lets the screen begin at the eye's axis: from 0 to 1, not from −1 to 1",
        [(X, "float x = fragCoord.x / iResolution.x;"), (Y, "(fragCoord.y / iResolution.y)")];
    "half-screen": "has a screen from −½ to ½, not from −1 to 1",
        [(X, "float x = fragCoord.x / iResolution.x - 0.5;"), (Y, "(fragCoord.y / iResolution.y - 0.5)")];
    "pixel-corner": "looks through the corners of pixels, not their middles", [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord -= 0.5;")];
    "half-pixel-twice": "adds half a pixel to fragCoord, which has it already",
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord += 0.5;")],
        [(Y, "((fragCoord.y + 0.5) / iResolution.y * 2.0 - 1.0)")],
        [(X, "float x = (fragCoord.x + 0.5) / iResolution.x * 2.0 - 1.0;")];
    "a-pixel-aside": "is a pixel aside",
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.x += 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.x -= 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.y += 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.y -= 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord += 1.0;")];
    "screen-behind": "has the screen behind the eye", [("vec3(x, y, -…)", "vec3(x, y, …)")];
    "screen-at-1": "has the screen at distance 1, whatever the scene says", [("vec3(x, y, -…)", "vec3(x, y, -1.0)")];
    "one-ray-for-all": "sends the same ray through all pixels", [(" * vec3(x, y, 0.0), vec3(0.0, 0.0, -1.0)", " * vec3(0.0), vec3(0.0, 0.0, -1.0)")];
}
