//! Mistakes in the geometry: the intersection of rays with spheres, quadrics and grids, normals, and motion.

use super::{Mistake, mistakes};

const F: &str = "vec3 f = ray.origin - sphere.center;";
pub(super) const DISC: &str = "float disc = sphere.radius * sphere.radius - dot(closest, closest);";
/// The textbook's formula, for directions of length 1.
pub(super) const TEXTBOOK: &str = "float disc = b * b - dot(f, f) + sphere.radius * sphere.radius;";
const NEAR: &str = "float t = -b - root;";
const FAR: &str = "t = -b + root;";
const CLOSER: &str = "if (t < hit.t) {";
const SPHERES: &str = "for (int i = 0; i < SPHERES; i++) {\n        float t = intersectSphere";
const COLOR: &str = "hit.color = spheres[i].color;";
const NORMAL: &str = "normalize(hit.point - spheres[i].center)";

/// Intersections of rays with spheres, and the nearest hit.
pub(super) static INTERSECTIONS: &[Mistake] = mistakes! {
    "roots-not-halved": "does not divide the roots by 2a",
        [(NEAR, "float t = 2.0 * (-b - root);"), (FAR, "t = 2.0 * (-b + root);")];
    "discriminant-without-4": "forgets the 4 in b² − 4ac",
        [
            (DISC, "float disc = 4.0 * b * b - dot(f, f) + sphere.radius * sphere.radius;"),
            (NEAR, "float t = (-2.0 * b - root) / 2.0;"),
            (FAR, "t = (-2.0 * b + root) / 2.0;")
        ];
    "far-root": "takes the root where a ray leaves the sphere, not the one where it enters", [(NEAR, "float t = -b + root;")];
    "behind-the-eye": "counts what lies behind the start of a ray",
        [("float t = -b - root;\n        if (t > 0.00001) {", "float t = -b - root;\n        if (true) {")];
    "radius-not-squared": "does not square the radius",
        [(DISC, "float disc = sphere.radius - dot(closest, closest);")];
    "root-not-taken": "does not take the square root of the discriminant", [("float root = sqrt(disc);", "float root = disc;")];
    "sign-of-b": "has the wrong sign of b: the centre minus the origin, where the formula has the origin minus the centre",
        [(F, "vec3 f = sphere.center - ray.origin;")];
    "last-hit": "keeps the last sphere that a ray meets, not the nearest",
        [(CLOSER, "if (t < NO_HIT) {")],
        [
            (CLOSER, "if (t < NO_HIT) {"),
            ("hit.t = t;", "hit.t = min(t, hit.t);"),
            ("hit.point = ray.origin + t * ray.direction;", "hit.point = ray.origin + hit.t * ray.direction;")
        ];
    "first-hit": "keeps the first sphere that a ray meets, not the nearest", [(CLOSER, "if (t < NO_HIT && hit.t == NO_HIT) {")];
    "farthest-hit": "keeps the farthest sphere that a ray meets, not the nearest",
        [(CLOSER, "if (t < NO_HIT && (hit.t == NO_HIT || t > hit.t)) {")];
    "first-sphere-for-all": "takes the colour and the normal of the first sphere for all",
        [(COLOR, "hit.color = spheres[0].color;"), (NORMAL, "normalize(hit.point - spheres[0].center)")];
    "normal-of-the-first-sphere": "takes the normal of the first sphere for all",
        [(NORMAL, "normalize(hit.point - spheres[0].center)")];
    "colour-of-the-first-sphere": "takes the colour of the first sphere for all", [(COLOR, "hit.color = spheres[0].color;")];
    "colour-of-the-next-sphere": "takes the colour of the next sphere", [(COLOR, "hit.color = spheres[(i + 1) % SPHERES].color;")];
    "colour-of-the-last-sphere": "takes the colour of the last sphere for all", [(COLOR, "hit.color = spheres[SPHERES - 1].color;")];
    "loop-too-short": "ends its loop over the spheres too early: the last ones cannot be seen",
        [(SPHERES, "for (int i = 0; i < SPHERES - 1; i++) {\n        float t = intersectSphere")],
        [(SPHERES, "for (int i = 0; i < SPHERES - 2; i++) {\n        float t = intersectSphere")];
    "loop-from-1": "starts its loop over the spheres at 1: the first one cannot be seen",
        [(SPHERES, "for (int i = 1; i < SPHERES; i++) {\n        float t = intersectSphere")];
    "nearest-not-reset": "does not start from far away again when it looks for the nearest hit of the next ray",
        [
            ("Intersection nearestHit(Ray ray) {", "float nearest;\n\nIntersection nearestHit(Ray ray) {"),
            ("    Intersection hit;\n    hit.t = NO_HIT;", "    Intersection hit;\n    hit.t = nearest;"),
            ("    return hit;\n}", "    if (hit.t == nearest) {\n        hit.t = NO_HIT;\n    } else {\n        nearest = hit.t;\n    }\n    return hit;\n}"),
            ("    Ray ray = Ray(origin, direction);", "    nearest = NO_HIT;\n    Ray ray = Ray(origin, direction);")
        ];
};

const ENDS_NEAR: &str = "if (ahead + near > 0.00001 && z >= form.low && z <= form.high) {";
const ENDS_BEYOND: &str = "if (ahead + beyond > 0.00001 && z >= form.low && z <= form.high) {";
const QUADRIC_NORMAL: &str =
    "normalize(quadric.axes * (quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g)));";
const TURNED: &str = "return quadric.form.high < NO_HIT ? faceforward(normal, direction, normal) : normal;";
const SQUARE: &str = "floor(point.xz / side);";
const SUM: &str = "square.x + square.y";

/// Surfaces of second degree, and checkered ones.
pub(super) static QUADRICS: &[Mistake] = mistakes! {
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
        [(QUADRIC_NORMAL, "normalize(quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g));")];
    "normal-from-the-middle": "takes the direction from the surface's own origin for its normal",
        [(QUADRIC_NORMAL, "normalize(point - quadric.origin);")];
    "normal-without-the-linear-part": "forgets the linear part of the equation in the normal",
        [(QUADRIC_NORMAL, "normalize(quadric.axes * (quadric.form.q * p));")];
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
};

const STEPS: &str = "for (int i = 0; i < steps; i++) {";
const PLACE: &str = "radius + room * vec3(x, y, z)";
const ROOM: &str = "float room = grid.spacing - 2.0 * radius;";
const INDEX: &str = "uint(cell.x + grid.cells.x * (cell.y + grid.cells.y * cell.z))";
const SEED: &str = "drawn = grid.seed + ";

/// Grids with a sphere in each cell, and the random numbers of the spheres.
pub(super) static GRIDS: &[Mistake] = mistakes! {
    "first-cell-only": "looks into the first cell of the grid only", [(STEPS, "for (int i = 0; i < 1; i++) {")];
    "strides-without-sign": "goes through the cells in the positive direction always", [("ivec3(sign(direction))", "ivec3(1)")];
    "steps-not-of-a-cell": "takes steps of length 1 from cell to cell, not of a cell's side", [("grid.spacing / abs(direction)", "1.0 / abs(direction)")];
    "farther-wall-first": "goes on across the farther wall of a cell, not the nearer",
        [("if (next.x < next.y && next.x < next.z) {", "if (next.x > next.y && next.x > next.z) {")];
    "an-axis-forgotten": "never goes on to the cells above or below, or never to those behind",
        [("} else if (next.y < next.z) {", "} else if (false) {")],
        [("} else if (next.y < next.z) {", "} else if (true) {")];
    "cell-number-swapped": "has x and y, or y and z, exchanged in the number of a cell",
        [(INDEX, "uint(cell.y + grid.cells.y * (cell.x + grid.cells.x * cell.z))")],
        [(INDEX, "uint(cell.x + grid.cells.x * (cell.z + grid.cells.z * cell.y))")],
        [(INDEX, "uint(cell.z + grid.cells.z * (cell.y + grid.cells.y * cell.x))")];
    "another-seed": "starts from another seed",
        [(SEED, "drawn = grid.seed + 1u + ")],
        [(SEED, "drawn = grid.seed - 1u + ")],
        [(SEED, "drawn = ")],
        [(SEED, "drawn = 1u + ")];
    "in-the-middle-of-cells": "puts spheres in the middle of their cells", [(PLACE, "radius + room * 0.5")];
    "room-too-large": "gives spheres the room of the whole cell, or takes the radius away once only",
        [(ROOM, "float room = grid.spacing;")],
        [(ROOM, "float room = grid.spacing - radius;")];
    "radii-alike": "makes all spheres of the grid equally large", [("mix(grid.small, grid.large, draw())", "0.5 * (grid.small + grid.large) + 0.0 * draw()")];
    "coordinates-drawn-backwards": "draws the place from z to x, not from x to z", [(PLACE, "radius + room * vec3(z, y, x)")];
    "colours-drawn-backwards": "draws blue first and red last", [("0.8 * vec3(r, g, b)", "0.8 * vec3(b, g, r)")];
    "hash-without-its-shift": "forgets the last shift of the hash", [("return (word >> 22u) ^ word;", "return word;")];
};

/// Normals of spheres.
pub(super) static NORMALS: &[Mistake] = mistakes! {
    "normal-not-normalised": "does not normalise normals",
        [(NORMAL, "(hit.point - spheres[i].center)")],
        [(NORMAL, "(hit.point - spheres[i].center)"), (DISC, TEXTBOOK)];
    "normal-inwards": "has normals that point into the spheres", [(NORMAL, "normalize(spheres[i].center - hit.point)")];
    "normal-from-the-origin": "has normals that point away from the world's origin, not from the sphere's centre",
        [(NORMAL, "normalize(hit.point)")];
    "normal-is-the-direction": "takes the ray's direction for the normal", [(NORMAL, "-ray.direction")];
};

const TURN: &str = "6.28318530718 * fract(turns)";
const ABOUT: &str = "return pivot + rotate(p - pivot, axis, …);";

/// Motions.
pub(super) static MOTIONS: &[Mistake] = mistakes! {
    "turned-the-other-way": "turns the other way round", [("s * cross(axis, v)", "s * cross(v, axis)")];
    "rotation-without-its-last-term": "forgets the last term of Rodrigues' formula", [(" + (1.0 - c) * dot(axis, v) * axis", "")];
    "sine-and-cosine-swapped": "has sine and cosine exchanged",
        [("float c = cos(angle);", "float c = sin(angle);"), ("float s = sin(angle);", "float s = cos(angle);")];
    "angle-in-turns": "takes the number of turns for an angle in radians", [(TURN, "fract(turns)")];
    "angle-in-degrees": "takes degrees for radians", [(TURN, "360.0 * fract(turns)")];
    "half-turns": "turns by π where 2π should stand", [(TURN, "3.14159265359 * fract(turns)")];
    "about-the-origin": "turns about the world's origin, not about the pivot", [(ABOUT, "return rotate(p, axis, …);")];
    "pivot-not-added-back": "does not add the pivot back", [(ABOUT, "return rotate(p - pivot, axis, …);")];
    "pivot-not-taken-away": "does not take the pivot away before it turns", [(ABOUT, "return pivot + rotate(p, axis, …);")];
    "carried-along-first": "carries a thing along before it turns it about its own axis, where it should be after",
        [("return motion0(rotateAbout(p, …));", "return rotateAbout(motion0(p), …);")],
        [("return motion1(rotateAbout(p, …));", "return rotateAbout(motion1(p), …);")],
        [("return motion2(rotateAbout(p, …));", "return rotateAbout(motion2(p), …);")];
};
