//! Surfaces of second degree.

use super::{motion, number, vector};
use crate::{Quadric, QuadricKind};

pub(super) const FORM: &str =
    "// q.x x^2 + q.y y^2 + q.z z^2 + 2 g z + k = 0 for low <= z <= high, in coordinates along the axes of a quadric.
struct Form {
    vec3 q;
    float g;
    float k;
    float low;
    float high;
};
";

pub(super) const STRUCTURE: &str = "struct Quadric {
    vec3 origin;
    mat3 axes;
    Form form;
";

/// The functions that the values of those quadrics call.
pub(super) fn functions<'a>(quadrics: impl Iterator<Item = &'a Quadric>) -> Vec<String> {
    let mut pieces = Vec::new();
    for quadric in quadrics {
        let (text, _) = form(&quadric.kind);
        let frame = (!is_ellipsoid(quadric)).then_some(FRAME);
        for piece in [Some(text), frame].into_iter().flatten() {
            if !pieces.iter().any(|known| known == piece) {
                pieces.push(piece.to_owned());
            }
        }
    }
    pieces
}

/// The values of all members but those that every surface has.
pub(super) fn values(quadric: &Quadric, motion: Option<usize>) -> String {
    let axes = quadric
        .axes
        .map(|axis| motion::direction(axis, quadric.origin, motion));
    let axes = if is_ellipsoid(quadric) {
        format!("mat3({})", axes.join(", "))
    } else {
        format!("frame({})", axes[2])
    };
    let (_, form) = form(&quadric.kind);
    format!("{}, {axes}, {form}", motion::point(quadric.origin, motion))
}

fn is_ellipsoid(quadric: &Quadric) -> bool {
    matches!(quadric.kind, QuadricKind::Ellipsoid { .. })
}

/// A function that makes a form, and how it is called.
fn form(kind: &QuadricKind) -> (&'static str, String) {
    let call = |name, numbers: &[f64]| {
        let numbers: Vec<_> = numbers.iter().map(|&value| number(value)).collect();
        format!("{name}({})", numbers.join(", "))
    };
    match *kind {
        QuadricKind::Ellipsoid { radii } => (ELLIPSOID, format!("ellipsoid({})", vector(radii))),
        QuadricKind::Cylinder { radius, height } => (CYLINDER, call("cylinder", &[radius, height])),
        QuadricKind::Cone { radius, height } => (CONE, call("cone", &[radius, height])),
        QuadricKind::Paraboloid { radius, height } => (PARABOLOID, call("paraboloid", &[radius, height])),
        QuadricKind::Hyperboloid {
            waist,
            radius,
            height,
        } => (HYPERBOLOID, call("hyperboloid", &[waist, radius, height])),
    }
}

const FRAME: &str = "// Two directions at right angles to the axis, and the axis.
mat3 frame(vec3 axis) {
    vec3 x = abs(axis.z) > 0.9 ? vec3(1.0, 0.0, 0.0) : cross(axis, vec3(0.0, 0.0, 1.0));
    x = normalize(x - dot(x, axis) * axis);
    return mat3(x, cross(axis, x), axis);
}
";

const ELLIPSOID: &str = "Form ellipsoid(vec3 radii) {
    return Form(1.0 / (radii * radii), 0.0, -1.0, -NO_HIT, NO_HIT);
}
";

const CYLINDER: &str = "Form cylinder(float radius, float height) {
    return Form(vec3(1.0, 1.0, 0.0), 0.0, -radius * radius, 0.0, height);
}
";

const CONE: &str = "Form cone(float radius, float height) {
    float slope = radius / height;
    return Form(vec3(1.0, 1.0, -slope * slope), 0.0, 0.0, 0.0, height);
}
";

const PARABOLOID: &str = "Form paraboloid(float radius, float height) {
    return Form(vec3(1.0, 1.0, 0.0), -0.5 * radius * radius / height, 0.0, 0.0, height);
}
";

const HYPERBOLOID: &str = "Form hyperboloid(float waist, float radius, float height) {
    float z = 0.5 * height;
    float slope2 = (radius * radius - waist * waist) / (z * z);
    return Form(vec3(1.0, 1.0, -slope2), 0.0, -waist * waist, -z, z);
}
";

pub(super) const INTERSECT: &str =
    "// As for spheres, from the point of the ray that is closest to the origin.
float intersectQuadric(Ray ray, Quadric quadric) {
    Form form = quadric.form;
    vec3 d = ray.direction * quadric.axes;
    vec3 origin = (ray.origin - quadric.origin) * quadric.axes;
    float ahead = -dot(origin, d);
    vec3 o = origin + ahead * d;
    float a = dot(form.q * d, d);
    float b = dot(form.q * d, o) + form.g * d.z;
    float c = dot(form.q * o, o) + 2.0 * form.g * o.z + form.k;
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
    if (ahead + near > 0.00001 && z >= form.low && z <= form.high) {
        return ahead + near;
    }
    float beyond = max(t0, t1);
    z = o.z + beyond * d.z;
    if (ahead + beyond > 0.00001 && z >= form.low && z <= form.high) {
        return ahead + beyond;
    }
    return NO_HIT;
}

// What is open shows both sides.
vec3 normalOf(Quadric quadric, vec3 point, vec3 direction) {
    vec3 p = (point - quadric.origin) * quadric.axes;
    vec3 normal = normalize(quadric.axes * (quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g)));
    return quadric.form.high < NO_HIT ? faceforward(normal, direction, normal) : normal;
}
";
