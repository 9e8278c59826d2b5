//! Lights, and what surfaces do with them.

use super::parts::Parts;
use crate::scene::{Light, Model, Scene};

impl Parts<'_> {
    pub(super) fn shading(&self, scene: &Scene) -> Vec<String> {
        let mut pieces = Vec::new();
        if scene.lights.is_empty() {
            let text = "vec3 shade(Intersection hit) {\n    return hit.color * AMBIENT;\n}\n";
            pieces.push(text.to_owned());
            return pieces;
        }
        let visible = match shadows(scene) {
            Shadows::None => "",
            Shadows::Some => " && !(lights[i].shadow && inShadow(hit, lights[i].position))",
            Shadows::All => " && !inShadow(hit, lights[i].position)",
        };
        if shadows(scene) != Shadows::None {
            pieces.push(IN_SHADOW.to_owned());
        }
        let brdf = match (self.uses(Model::Lambert), self.uses(Model::Diffuse)) {
            (true, true) => "(hit.model == LAMBERT ? 1.0 : 1.0 / 3.14159265359) * ",
            (false, true) => "1.0 / 3.14159265359 * ",
            _ => "",
        };
        pieces.push(format!(
            "vec3 shade(Intersection hit) {{\n    vec3 sum = AMBIENT;\n    for (int i = 0; i < LIGHTS; i++) {{\n        \
             float cosine = dot(hit.normal, normalize(lights[i].position - hit.point));\n        \
             if (cosine > 0.0{visible}) {{\n            sum += {brdf}lights[i].color * cosine;\n        }}\n    }}\n    \
             return hit.color * sum;\n}}\n"
        ));
        pieces
    }
}

/// Which lights cast shadows.
#[derive(PartialEq)]
pub(super) enum Shadows {
    None,
    Some,
    All,
}

pub(super) fn shadows(scene: &Scene) -> Shadows {
    let casts = |light: &Light| light.shadow;
    match (scene.lights.iter().any(casts), scene.lights.iter().all(casts)) {
        (false, _) => Shadows::None,
        (true, false) => Shadows::Some,
        (true, true) => Shadows::All,
    }
}

const IN_SHADOW: &str = "bool inShadow(Intersection hit, vec3 light) {
    vec3 origin = hit.point + 0.001 * hit.normal;
    vec3 toLight = light - origin;
    float distance = length(toLight);
    return nearestHit(Ray(origin, toLight / distance)).t < distance;
}
";
