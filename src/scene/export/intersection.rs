//! Where rays meet surfaces.

use std::fmt::Write;

use super::parts::Parts;
use super::quadric;
use crate::Sampler;

impl Parts<'_> {
    pub(super) fn intersections(&self, sampler: Sampler) -> Vec<String> {
        let mut pieces = Vec::new();
        let mut loops = String::new();
        if self.checkers {
            pieces.push(CHECKERED.to_owned());
        }
        if self.has_spheres() {
            pieces.push(INTERSECT_SPHERE.to_owned());
        }
        if !self.spheres.is_empty() {
            let normal = "normalize(hit.point - spheres[i].center)";
            loops += &self.nearest("Sphere", "spheres", "spheres[i]", normal);
        }
        if !self.grids.is_empty() {
            pieces.extend(self.grid(sampler));
            loops += &self.nearest("Grid", "grids", "sphere", "normalize(hit.point - sphere.center)");
        }
        if !self.planes.is_empty() {
            pieces.push(INTERSECT_PLANE.to_owned());
            let normal = "faceforward(planes[i].normal, ray.direction, planes[i].normal)";
            loops += &self.nearest("Plane", "planes", "planes[i]", normal);
        }
        if !self.quadrics.is_empty() {
            pieces.push(quadric::INTERSECT.to_owned());
            let normal = "normalOf(quadrics[i], hit.point, ray.direction)";
            loops += &self.nearest("Quadric", "quadrics", "quadrics[i]", normal);
        }
        pieces.push(format!(
            "Intersection nearestHit(Ray ray) {{\n    Intersection hit;\n    hit.t = NO_HIT;\n{loops}    return hit;\n}}\n"
        ));
        pieces
    }

    /// The loop over one kind of surfaces, which keeps the nearest hit; `own` is the surface that was met.
    fn nearest(&self, kind: &str, all: &str, own: &str, normal: &str) -> String {
        let count = all.to_uppercase();
        let color = if self.checkers {
            format!("checkered(hit.point, {own}.color, {own}.other, {own}.side)")
        } else {
            format!("{own}.color")
        };
        let mut taken = String::new();
        for property in self.properties() {
            let _ = writeln!(taken, "            hit.{0} = {own}.{0};", property.name);
        }
        if self.traces_paths && kind == "Sphere" {
            taken += "            hit.sphere = i;\n";
        }
        let met = if kind == "Grid" {
            "        Sphere sphere;\n        float t = intersectGrid(ray, grids[i], sphere);\n".to_owned()
        } else {
            format!("        float t = intersect{kind}(ray, {own});\n")
        };
        format!(
            "    for (int i = 0; i < {count}; i++) {{\n{met}        if (t < hit.t) {{\n            hit.t = t;\n            \
             hit.point = ray.origin + t * ray.direction;\n            hit.normal = {normal};\n            \
             hit.color = {color};\n{taken}        }}\n    }}\n"
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
