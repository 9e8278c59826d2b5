//! What is seen along a ray, by way of mirrors.

use std::fmt::Write;

use super::parts::Parts;
use crate::scene::Model;

impl Parts<'_> {
    pub(super) fn trace(&self) -> String {
        if self.models.is_empty() {
            return "vec3 trace(vec3 origin, vec3 direction) {\n    return background(direction);\n}\n"
                .to_owned();
        }
        let mirrors = self.uses(Model::Mirror);
        let (throughput, indent) = if mirrors {
            ("throughput * ", "        ")
        } else {
            ("", "    ")
        };
        let mut body = format!(
            "{indent}Intersection hit = nearestHit(ray);\n{indent}if (hit.t == NO_HIT) {{\n{indent}    \
             return {throughput}background(ray.direction);\n{indent}}}\n"
        );
        let lit = format!("return {throughput}shade(hit);");
        let facing = format!("return {throughput}hit.color * abs(dot(ray.direction, hit.normal));");
        let mirror = "throughput *= hit.color;\n        vec3 side = faceforward(hit.normal, ray.direction, hit.normal);\n        \
                      ray = Ray(hit.point + 0.001 * side, reflect(ray.direction, hit.normal));";
        let mut cases: Vec<(String, &str)> = Vec::new();
        if self.uses(Model::Facing) {
            cases.push(("hit.model == FACING".to_owned(), &facing));
        }
        if self.lit() {
            let test = match (self.uses(Model::Lambert), self.uses(Model::Diffuse)) {
                (true, true) => "hit.model == LAMBERT || hit.model == DIFFUSE",
                (true, false) => "hit.model == LAMBERT",
                _ => "hit.model == DIFFUSE",
            };
            cases.push((test.to_owned(), &lit));
        }
        // What is tested last needs no test: mirrors go on, and only they do.
        let last = if mirrors {
            Some(mirror)
        } else {
            cases.pop().map(|(_, what)| what)
        };
        for (test, what) in cases {
            let _ = write!(body, "{indent}if ({test}) {{\n{indent}    {what}\n{indent}}}\n");
        }
        if let Some(last) = last {
            let _ = writeln!(body, "{indent}{last}");
        }
        if mirrors {
            body = format!(
                "    vec3 throughput = vec3(1.0);\n    for (int depth = 0; depth < MAX_DEPTH; depth++) {{\n{body}    }}\n    \
                 return vec3(0.0);\n"
            );
        }
        format!(
            "vec3 trace(vec3 origin, vec3 direction) {{\n    Ray ray = Ray(origin, direction);\n{body}}}\n"
        )
    }
}
