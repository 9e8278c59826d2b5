//! Where rays meet surfaces.

use super::parts::Parts;
use super::quadric;

impl Parts<'_> {
    pub(super) fn intersections(&self) -> Vec<String> {
        let mut pieces = Vec::new();
        let mut loops = String::new();
        if self.checkers {
            pieces.push(CHECKERED.to_owned());
        }
        if !self.spheres.is_empty() {
            pieces.push(INTERSECT_SPHERE.to_owned());
            loops += &self.nearest("Sphere", "spheres", "normalize(hit.point - spheres[i].center)");
        }
        if !self.planes.is_empty() {
            pieces.push(INTERSECT_PLANE.to_owned());
            let normal = "faceforward(planes[i].normal, ray.direction, planes[i].normal)";
            loops += &self.nearest("Plane", "planes", normal);
        }
        if !self.quadrics.is_empty() {
            pieces.push(quadric::INTERSECT.to_owned());
            let normal = "normalOf(quadrics[i], hit.point, ray.direction)";
            loops += &self.nearest("Quadric", "quadrics", normal);
        }
        pieces.push(format!(
            "Intersection nearestHit(Ray ray) {{\n    Intersection hit;\n    hit.t = NO_HIT;\n{loops}    return hit;\n}}\n"
        ));
        pieces
    }

    /// The loop over one kind of surfaces, which keeps the nearest hit.
    fn nearest(&self, kind: &str, all: &str, normal: &str) -> String {
        let count = all.to_uppercase();
        let color = if self.checkers {
            format!("checkered(hit.point, {all}[i].color, {all}[i].other, {all}[i].side)")
        } else {
            format!("{all}[i].color")
        };
        let model = if self.names_models() {
            format!("            hit.model = {all}[i].model;\n")
        } else {
            String::new()
        };
        format!(
            "    for (int i = 0; i < {count}; i++) {{\n        float t = intersect{kind}(ray, {all}[i]);\n        \
             if (t < hit.t) {{\n            hit.t = t;\n            hit.point = ray.origin + t * ray.direction;\n            \
             hit.normal = {normal};\n            hit.color = {color};\n{model}        }}\n    }}\n"
        )
    }
}

const CHECKERED: &str = "// Squares seen from above.
vec3 checkered(vec3 point, vec3 color, vec3 other, float side) {
    vec2 square = floor(point.xz / side);
    return mod(square.x + square.y, 2.0) < 0.5 ? color : other;
}
";

const INTERSECT_SPHERE: &str =
    "// From the point of the ray that is closest to the centre: smaller numbers, smaller errors.
float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    vec3 closest = f - b * ray.direction;
    float disc = sphere.radius * sphere.radius - dot(closest, closest);
    if (disc > 0.0) {
        float root = sqrt(disc);
        float t = -b - root;
        if (t > 0.00001) {
            return t;
        }
        t = -b + root;
        if (t > 0.00001) {
            return t;
        }
    }
    return NO_HIT;
}
";

const INTERSECT_PLANE: &str = "float intersectPlane(Ray ray, Plane plane) {
    float t = dot(plane.normal, plane.point - ray.origin) / dot(plane.normal, ray.direction);
    return t > 0.00001 ? t : NO_HIT;
}
";
