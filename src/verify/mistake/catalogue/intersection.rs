//! Where a ray meets a sphere, and which of those that it meets is nearest.

use super::mistakes;

const F: &str = "vec3 f = ray.origin - sphere.center;";
pub(super) const DISC: &str = "float disc = sphere.radius * sphere.radius - dot(closest, closest);";
/// The same for directions of length 1.
pub(super) const TEXTBOOK: &str = "float disc = b * b - dot(f, f) + sphere.radius * sphere.radius;";
const NEAR: &str = "float t = -b - root;";
const FAR: &str = "t = -b + root;";
const CLOSER: &str = "if (t < hit.t) {";
const SPHERES: &str = "for (int i = 0; i < SPHERES; i++) {\n        float t = intersectSphere";
const COLOR: &str = "hit.color = spheres[i].color;";
const NORMAL: &str = "normalize(hit.point - spheres[i].center)";

mistakes! {
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
}
