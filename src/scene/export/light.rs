//! Lights, and what surfaces do with them.

use super::parts::Parts;
use super::sampler::AROUND;
use crate::{Light, Scene};

impl Parts<'_> {
    pub(super) fn shading(&self, scene: &Scene) -> Vec<String> {
        let view = if self.looks_back() { ", vec3 view" } else { "" };
        if scene.lights.is_empty() {
            return vec![format!(
                "vec3 shade(Intersection hit{view}) {{\n    return hit.color * AMBIENT;\n}}\n"
            )];
        }
        let mut pieces = self.brdf();
        let shadows = Lights::which(scene, |light| light.shadow);
        let soft = Lights::which(scene, |light| light.radius > 0.0);
        let is_soft = soft != Lights::None;
        if is_soft {
            pieces.push(AROUND.to_owned());
            let point = if soft == Lights::Some { POINT } else { "" };
            pieces.push(SAMPLE_LIGHT.replace("POINT\n", point));
        }
        let (text, test) = if is_soft {
            (IN_SOFT_SHADOW, "inShadow(hit, toLight, distance)")
        } else {
            (IN_SHADOW, "inShadow(hit, lights[i].position)")
        };
        if shadows != Lights::None {
            pieces.push(text.to_owned());
        }
        let visible = match shadows {
            Lights::None => String::new(),
            Lights::Some => format!(" && !(lights[i].shadow && {test})"),
            Lights::All => format!(" && !{test}"),
        };
        let toward = if is_soft {
            "float distance;\n        vec3 toLight = sampleLight(lights[i], hit.point, distance);"
        } else {
            "vec3 toLight = normalize(lights[i].position - hit.point);"
        };
        let brdf = self.brdf_call("toLight", "view");
        pieces.push(format!(
            "vec3 shade(Intersection hit{view}) {{\n    vec3 sum = AMBIENT * hit.color;\n    \
             for (int i = 0; i < LIGHTS; i++) {{\n        {toward}\n        float cosine = dot(hit.normal, toLight);\n        \
             if (cosine > 0.0{visible}) {{\n            sum += lights[i].color * {brdf} * cosine;\n        }}\n    }}\n    \
             return sum;\n}}\n"
        ));
        pieces
    }
}

/// Which lights have a quality.
#[derive(PartialEq)]
pub(super) enum Lights {
    None,
    Some,
    All,
}

impl Lights {
    pub(super) fn which(scene: &Scene, has: impl Fn(&Light) -> bool) -> Self {
        match (scene.lights.iter().any(&has), scene.lights.iter().all(&has)) {
            (false, _) => Self::None,
            (true, false) => Self::Some,
            (true, true) => Self::All,
        }
    }
}

const IN_SHADOW: &str = "bool inShadow(Intersection hit, vec3 light) {
    vec3 origin = hit.point + 0.001 * hit.normal;
    vec3 toLight = light - origin;
    float distance = length(toLight);
    return nearestHit(Ray(origin, toLight / distance)).t < distance;
}
";

const IN_SOFT_SHADOW: &str = "bool inShadow(Intersection hit, vec3 toLight, float distance) {
    vec3 origin = hit.point + 0.001 * hit.normal;
    return nearestHit(Ray(origin, toLight)).t < distance;
}
";

/// A light without a radius among those with one.
const POINT: &str = "    if (light.radius == 0.0) {
        distance = length(light.position - point);
        return (light.position - point) / distance;
    }
";

const SAMPLE_LIGHT: &str =
    "// A direction drawn from the cone in which the light is seen, and how far the light is along it.
vec3 sampleLight(Light light, vec3 point, out float distance) {
POINT
    vec3 axis = light.position - point;
    float sine2 = light.radius * light.radius / dot(axis, axis);
    float depth = sine2 < 1.0 ? sine2 / (1.0 + sqrt(1.0 - sine2)) : 2.0;
    float u = random();
    float v = random();
    float cosine = 1.0 - u * depth;
    float chord = sqrt(max(sine2 - (1.0 - cosine * cosine), 0.0));
    distance = length(axis) * (sine2 < 1.0 ? cosine - chord : cosine + chord);
    return around(normalize(axis), cosine, v);
}
";
