//! Planes' neighbours: surfaces of second degree, and checkered ones.

use super::mistakes;

const ENDS_NEAR: &str = "if (ahead + near > 0.00001 && z >= form.low && z <= form.high) {";
const ENDS_BEYOND: &str = "if (ahead + beyond > 0.00001 && z >= form.low && z <= form.high) {";
const NORMAL: &str = "normalize(quadric.axes * (quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g)));";
const TURNED: &str = "return quadric.form.high < NO_HIT ? faceforward(normal, direction, normal) : normal;";
const SQUARE: &str = "floor(point.xz / side);";
const SUM: &str = "square.x + square.y";

mistakes! {
    "ends-not-tested": "does not end cylinders, cones and their like",
        [(ENDS_NEAR, "if (ahead + near > 0.00001) {"), (ENDS_BEYOND, "if (ahead + beyond > 0.00001) {")];
    "only-the-nearer-root": "gives up where the nearer root lies beyond the ends, though the other may not",
        [(ENDS_BEYOND, "if (false) {")];
    "radii-not-squared": "does not square the radii of ellipsoids",
        [("1.0 / (radii * radii), 0.0, -1.0, -NO_HIT, NO_HIT", "1.0 / radii, 0.0, -1.0, -NO_HIT, NO_HIT")],
        [("1.0 / (radii * radii), 0.0, -1.0, -NO_HIT, NO_HIT", "1.0 / radii, 0.0, -1.0, -radii.z, radii.z")];
    "radii-multiplied": "multiplies by the squared radii of ellipsoids where it should divide",
        [("1.0 / (radii * radii), 0.0, -1.0, -NO_HIT, NO_HIT", "radii * radii, 0.0, -1.0, -NO_HIT, NO_HIT")],
        [("1.0 / (radii * radii), 0.0, -1.0, -NO_HIT, NO_HIT", "radii * radii, 0.0, -1.0, -radii.z, radii.z")];
    "axis-forgotten": "forgets the axes: all surfaces lie along z",
        [("return mat3(x, cross(axis, x), axis);", "return mat3(1.0);")];
    "frame-by-the-wrong-side": "multiplies by the frame from the wrong side",
        [("vec3 d = ray.direction * quadric.axes;", "vec3 d = quadric.axes * ray.direction;")],
        [
            ("vec3 d = ray.direction * quadric.axes;", "vec3 d = quadric.axes * ray.direction;"),
            ("(ray.origin - quadric.origin) * quadric.axes;", "quadric.axes * (ray.origin - quadric.origin);")
        ];
    "normal-left-in-the-frame": "leaves the normal in the surface's own coordinates",
        [(NORMAL, "normalize(quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g));")];
    "normal-from-the-middle": "takes the direction from the surface's own origin for its normal",
        [(NORMAL, "normalize(point - quadric.origin);")];
    "normal-without-the-linear-part": "forgets the linear part of the equation in the normal",
        [(NORMAL, "normalize(quadric.axes * (quadric.form.q * p));")];
    "cone-without-its-slope": "has cones of 45°, whatever their radius and height", [("-slope * slope)", "-1.0)")];
    "both-nappes": "shows both nappes of the cone",
        [("-slope * slope), 0.0, 0.0, 0.0, height", "-slope * slope), 0.0, 0.0, -height, height")];
    "paraboloid-too-wide": "has the 2 of the paraboloid's equation in the wrong place",
        [("-0.5 * radius * radius / height", "-radius * radius / height")],
        [("-0.5 * radius * radius / height", "-2.0 * radius * radius / height")];
    "hyperboloid-of-two-sheets": "has a hyperboloid of two sheets", [("0.0, -waist * waist, -z, z", "0.0, waist * waist, -z, z")];
    "quadric-normal-inwards": "shows the dark side of surfaces of second degree: their normal points away from the ray",
        [(TURNED, "return -faceforward(normal, direction, normal);")];
    "normal-not-turned": "does not turn the normal of open surfaces to the ray", [(TURNED, "return normal;")], [(TURNED, "return -normal;")];
    "not-moved-back": "moves the ray's start closer, and forgets to add that to t", [("return ahead + near;", "return near;")],
        [("return ahead + near;", "return near;"), ("return ahead + beyond;", "return beyond;")];
    "checker-in-one-direction": "has stripes for a checker", [(SUM, "square.x")], [(SUM, "square.y")];
    "checker-by-truncation": "rounds towards 0 where the checker needs floor: its squares are twice as wide at the axes",
        [(SQUARE, "trunc(point.xz / side);")];
    "checker-too-large": "has the squares of a checker twice as large", [(SQUARE, "floor(point.xz / (2.0 * side));")];
    "checker-too-small": "has the squares of a checker half as large", [(SQUARE, "floor(point.xz / (0.5 * side));")];
    "checker-multiplied": "multiplies by the squares' side where it should divide", [(SQUARE, "floor(point.xz * side);")];
    "checker-colours-swapped": "has the two colours of the checker exchanged", [("? color : other", "? other : color")];
}
