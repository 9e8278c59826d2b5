//! Where rays meet surfaces.

use std::fmt::Write;

use super::parts::Parts;

impl Parts<'_> {
    pub(super) fn intersections(&self) -> Vec<String> {
        let mut pieces = Vec::new();
        let model = |owner: &str| {
            if self.names_models() {
                format!("            hit.model = {owner}[i].model;\n")
            } else {
                String::new()
            }
        };
        let mut loops = String::new();
        if !self.spheres.is_empty() {
            pieces.push(INTERSECT_SPHERE.to_owned());
            let _ = write!(
                loops,
                "    for (int i = 0; i < SPHERES; i++) {{\n        float t = intersectSphere(ray, spheres[i]);\n        \
                 if (t < hit.t) {{\n            hit.t = t;\n            hit.point = ray.origin + t * ray.direction;\n            \
                 hit.normal = normalize(hit.point - spheres[i].center);\n            hit.color = spheres[i].color;\n{}        }}\n    }}\n",
                model("spheres")
            );
        }
        if !self.planes.is_empty() {
            pieces.push(INTERSECT_PLANE.to_owned());
            let _ = write!(
                loops,
                "    for (int i = 0; i < PLANES; i++) {{\n        float t = intersectPlane(ray, planes[i]);\n        \
                 if (t < hit.t) {{\n            hit.t = t;\n            hit.point = ray.origin + t * ray.direction;\n            \
                 hit.normal = faceforward(planes[i].normal, ray.direction, planes[i].normal);\n            \
                 hit.color = planes[i].color;\n{}        }}\n    }}\n",
                model("planes")
            );
        }
        pieces.push(format!(
            "Intersection nearestHit(Ray ray) {{\n    Intersection hit;\n    hit.t = NO_HIT;\n{loops}    return hit;\n}}\n"
        ));
        pieces
    }
}

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
