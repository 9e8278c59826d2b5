//! Shadows of point lights.

use super::intersection::{DISC, TEXTBOOK};
use super::mistakes;

const LIT: &str = "if (cosine > 0.0 && …) {\n            sum";
const OCCLUDED: &str = "if (intersectSphere(ray, spheres[i]) < distance) {";
const HIDDEN: &str = "return nearestHit(Ray(origin, toLight / distance)).t < distance;";
const AWAY: &str = "vec3 toLight = light - origin;";

mistakes! {
    "no-shadows": "has no shadows", [(LIT, "if (cosine > 0.0) {\n            sum")];
    "shadow-beyond-the-light": "tests shadows beyond the light",
        [(OCCLUDED, "if (intersectSphere(ray, spheres[i]) < NO_HIT) {")],
        [(HIDDEN, "return nearestHit(Ray(origin, toLight / distance)).t < NO_HIT;")];
    "shadow-rays-short": "follows shadow rays for a length of 1 only, not as far as the light",
        [(OCCLUDED, "if (intersectSphere(ray, spheres[i]) < 1.0) {")],
        [(HIDDEN, "return nearestHit(Ray(origin, toLight / distance)).t < 1.0;")];
    "shadow-rays-away": "sends shadow rays away from the light", [(AWAY, "vec3 toLight = origin - light;")];
    "shadow-ray-not-normalised": "does not normalise shadow rays, though its formula is that for directions of length 1",
        [("toLight / distance);", "toLight);"), (DISC, TEXTBOOK)];
    "shadow-of-itself": "starts shadow rays below the surface, so that everything lies in its own shadow",
        [("hit.point + 0.001 * hit.normal;", "hit.point - 0.001 * hit.normal;")];
    "shadow-without-ambient": "leaves no ambient light in shadows",
        [(LIT, "if (cosine > 0.0 && !(…)) {\n            return vec3(0.0);\n        }\n        if (cosine > 0.0) {\n            sum")];
    "shadow-from-the-eye": "starts shadow rays at the eye",
        [("vec3 origin = hit.point + 0.001 * hit.normal;", "vec3 origin = vec3(0.0);")];
}
