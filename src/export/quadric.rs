//! Surfaces of second degree.

use super::{number, vector};
use crate::scene::{Equation, Quadric};

pub(super) const STRUCTURE: &str =
    "// q.x x^2 + q.y y^2 + q.z z^2 + 2 g z + k = 0 for low <= z <= high, in coordinates along its own axes.
struct Quadric {
    vec3 origin;
    mat3 axes;
    vec3 q;
    float g;
    float k;
    float low;
    float high;
";

/// The values of all members but those that every surface has.
pub(super) fn values(quadric: &Quadric) -> String {
    let Equation { q, g, k, ends } = quadric.kind.equation(1.0);
    let [x, y, z] = quadric.axes.map(vector);
    let [low, high] = ends.map_or(["-NO_HIT".to_owned(), "NO_HIT".to_owned()], |ends| {
        ends.map(number)
    });
    format!(
        "{}, mat3({x}, {y}, {z}), {}, {}, {}, {low}, {high}",
        vector(quadric.origin),
        vector(q),
        number(g),
        number(k)
    )
}

pub(super) const INTERSECT: &str =
    "// As for spheres, from the point of the ray that is closest to the origin.
float intersectQuadric(Ray ray, Quadric quadric) {
    vec3 d = ray.direction * quadric.axes;
    vec3 origin = (ray.origin - quadric.origin) * quadric.axes;
    float ahead = -dot(origin, d);
    vec3 o = origin + ahead * d;
    float a = dot(quadric.q * d, d);
    float b = dot(quadric.q * d, o) + quadric.g * d.z;
    float c = dot(quadric.q * o, o) + 2.0 * quadric.g * o.z + quadric.k;
    float disc = b * b - a * c;
    if (disc < 0.0) {
        return NO_HIT;
    }
    // The root that does not cancel, and the other by their product; where a is 0 there is only that.
    float q = b > 0.0 ? -b - sqrt(disc) : -b + sqrt(disc);
    float t0 = q == 0.0 ? NO_HIT : c / q;
    float t1 = a == 0.0 ? NO_HIT : q / a;
    float near = min(t0, t1);
    float z = o.z + near * d.z;
    if (ahead + near > 0.00001 && z >= quadric.low && z <= quadric.high) {
        return ahead + near;
    }
    float beyond = max(t0, t1);
    z = o.z + beyond * d.z;
    if (ahead + beyond > 0.00001 && z >= quadric.low && z <= quadric.high) {
        return ahead + beyond;
    }
    return NO_HIT;
}

// What is open shows both sides.
vec3 normalOf(Quadric quadric, vec3 point, vec3 direction) {
    vec3 p = (point - quadric.origin) * quadric.axes;
    vec3 normal = normalize(quadric.axes * (quadric.q * p + vec3(0.0, 0.0, quadric.g)));
    return quadric.high < NO_HIT ? faceforward(normal, direction, normal) : normal;
}
";
