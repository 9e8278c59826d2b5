//! Shading: materials, BRDFs, and lights.

use std::fmt::Write;

use super::expression::number;
use super::image::AROUND;
use super::parts::{GLASS, Kind, Parts};
use super::slot::Slot;
use crate::{Disney, Light, Material, Model, Scene};

/// A member of surfaces besides shape and color, which is copied to a hit.
pub(super) struct Property {
    pub(super) kind: &'static str,
    pub(super) name: &'static str,
    pub(super) value: fn(&Material) -> String,
}

const MODEL: Property = Property {
    kind: "int",
    name: "model",
    value: |material| Kind::from_model(&material.model).glsl_name().to_owned(),
};

const EXPONENT: Property = Property {
    kind: "float",
    name: "exponent",
    value: |material| match material.model {
        Model::Glossy { exponent } => number(exponent),
        _ => number(0.0),
    },
};

const IOR: Property = Property {
    kind: "float",
    name: "ior",
    value: |material| match material.model {
        Model::Glass { ior, .. } => number(ior),
        _ => number(1.0),
    },
};

const DISNEY: Property = Property {
    kind: "Disney",
    name: "disney",
    value: |material| match &material.model {
        Model::Disney(disney) => disney_values(disney),
        _ => disney_values(&crate::Disney::default()),
    },
};

impl Parts<'_> {
    pub(super) fn properties(&self) -> Vec<Property> {
        let all = [
            (self.has_model_ids(), MODEL),
            (self.uses(Kind::Glossy), EXPONENT),
            (self.uses_any(&GLASS), IOR),
            (self.uses(Kind::Disney), DISNEY),
        ];
        let used = all.into_iter().filter(|(is_used, _)| *is_used);
        used.map(|(_, property)| property).collect()
    }

    /// Whether a BRDF depends on the view direction.
    pub(super) fn uses_view(&self) -> bool {
        self.uses_any(&[Kind::Glossy, Kind::Disney])
    }

    /// Returns the call of the BRDF at a hit for light from `light`, seen along `view`, with the arguments
    /// that are needed.
    pub(super) fn brdf_call(&self, light: &str, view: &str) -> String {
        if self.uses_view() {
            return format!("brdf(hit, {light}, {view})");
        }
        match (self.uses(Kind::Lambert), self.uses(Kind::Diffuse)) {
            (true, true) => "brdf(hit)".to_owned(),
            (false, true) => "hit.color / PI".to_owned(),
            _ => "hit.color".to_owned(),
        }
    }

    /// Returns the name of the call of the BRDF at a hit, unless it is that of several models.
    pub(super) fn brdf_slot(&self) -> Option<Slot> {
        if self.uses_view() {
            return Some(Slot::ViewBrdf);
        }
        match (self.uses(Kind::Lambert), self.uses(Kind::Diffuse)) {
            (true, true) => None,
            (false, true) => Some(Slot::DiffuseBrdf),
            _ => Some(Slot::LambertBrdf),
        }
    }

    /// Returns the functions that the BRDF needs.
    pub(super) fn brdf(&self) -> Vec<String> {
        let mut pieces = Vec::new();
        let mut cases = Vec::new();
        let mut add = |kind, body: &str| {
            if self.uses(kind) {
                cases.push(([kind], body.to_owned()));
            }
        };
        add(Kind::Lambert, "return hit.color;");
        add(Kind::Diffuse, "return «DiffuseCase: hit.color / PI»;");
        add(
            Kind::Glossy,
            "float lobe = pow(max(dot(reflect(-view, hit.normal), light), 0.0), hit.exponent);\n\
             return hit.color * (hit.exponent + 2.0) / (2.0 * PI) * lobe;",
        );
        add(
            Kind::Disney,
            "return disney(hit.disney, hit.color, light, view, hit.normal);",
        );
        if self.uses(Kind::Disney) {
            pieces.push(DISNEY_FUNCTIONS.to_owned());
        }
        let call = self.brdf_call("vec3 light", "vec3 view");
        if call.starts_with("brdf") {
            let cases: Vec<_> = cases
                .iter()
                .map(|(kinds, body)| (&kinds[..], body.clone()))
                .collect();
            let head = call.replace("hit", "Intersection hit");
            pieces.push(format!("vec3 {head} {{\n{}}}\n", self.cases("    ", &cases)));
        }
        pieces
    }

    /// Returns the code of each case by the model of a hit. Every body leaves the function or iteration,
    /// except possibly the last, which needs no test.
    pub(super) fn cases(&self, indent: &str, cases: &[(&[Kind], String)]) -> String {
        let used: Vec<_> = cases.iter().filter(|(kinds, _)| self.uses_any(kinds)).collect();
        let mut text = String::new();
        let mut lines = |body: &str, indent: &str| {
            for line in body.lines() {
                let _ = writeln!(text, "{indent}{line}");
            }
        };
        for (at, (kinds, body)) in used.iter().enumerate() {
            if at + 1 == used.len() {
                lines(body, indent);
                break;
            }
            let tests: Vec<_> = kinds
                .iter()
                .filter(|&&kind| self.uses(kind))
                .map(|kind| format!("hit.model == {}", kind.glsl_name()))
                .collect();
            lines(&format!("if ({}) {{", tests.join(" || ")), indent);
            lines(body, &format!("{indent}    "));
            lines("}", indent);
        }
        text
    }
}

// Burley's BRDF: B. Burley, “Physically Based Shading at Disney”, SIGGRAPH 2012 course notes.

pub(super) const DISNEY_STRUCTURE: &str = "struct Disney {
    float metallic;
    float subsurface;
    float specular;
    float specularTint;
    float roughness;
    float anisotropic;
    float sheen;
    float sheenTint;
    float clearcoat;
    float clearcoatGloss;
};
";

pub(super) fn disney_values(disney: &Disney) -> String {
    let all = [
        disney.metallic,
        disney.subsurface,
        disney.specular,
        disney.specular_tint,
        disney.roughness,
        disney.anisotropic,
        disney.sheen,
        disney.sheen_tint,
        disney.clearcoat,
        disney.clearcoat_gloss,
    ];
    format!("Disney({})", all.map(number).join(", "))
}

pub(super) const DISNEY_FUNCTIONS: &str = "float square(float x) {
    return x * x;
}

// The weight (1 - cosine)^5 of Schlick's Fresnel approximation.
float schlickWeight(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return «SchlickWeight: square(square(m)) * m»;
}

// Normal distribution of the clear coat: GTR with gamma = 1, which has a long tail.
float berry(float nH, float alpha) {
    float a2 = alpha * alpha;
    return (a2 - 1.0) / (PI * log(a2) * (1.0 + (a2 - 1.0) * nH * nH));
}

// Normal distribution of the specular lobe: anisotropic GTR with gamma = 2 (GGX).
float trowbridgeReitz(float nH, float xH, float yH, float ax, float ay) {
    return 1.0 / (PI * ax * ay * square(square(xH / ax) + square(yH / ay) + nH * nH));
}

// Smith's shadowing factor for one direction, divided by twice the cosine.
float smith(float cosine, float alpha) {
    float a2 = alpha * alpha;
    float c2 = cosine * cosine;
    return 1.0 / (cosine + sqrt(a2 + c2 - a2 * c2));
}

// B. Burley, \"Physically Based Shading at Disney\" (2012).
vec3 disney(Disney m, vec3 color, vec3 light, vec3 view, vec3 normal) {
    float nL = dot(normal, light);
    float nV = dot(normal, view);
    if (nL <= 0.0 || nV <= 0.0) {
        return vec3(0.0);
    }
    vec3 middle = «HalfVector: normalize(light + view)»;
    float nH = dot(normal, middle);
    float lH = dot(light, middle);
    // The tangents: around the y axis, and toward it.
    vec3 x = normal.xz == vec2(0.0) ? vec3(0.0, 0.0, normal.y) : normalize(vec3(normal.z, 0.0, -normal.x));
    vec3 y = cross(normal, x);

    float luminance = dot(color, vec3(0.3, 0.6, 0.1));
    vec3 tint = luminance > 0.0 ? color / luminance : vec3(1.0);
    vec3 dielectric = 0.08 * m.specular * «SpecularTint: mix(vec3(1.0), tint, m.specularTint)»;
    vec3 specularColor = «SpecularColor: mix(dielectric, color, m.metallic)»;
    vec3 sheenColor = mix(vec3(1.0), tint, m.sheenTint);

    float fL = schlickWeight(nL);
    float fV = schlickWeight(nV);
    float fH = schlickWeight(«FresnelCosine: lH»);
    float retro = lH * lH * m.roughness;
    float grazing = 0.5 + 2.0 * retro;
    float diffuse = mix(1.0, grazing, fL) * mix(1.0, grazing, fV);
    float flatness = mix(1.0, retro, fL) * mix(1.0, retro, fV);
    float subsurface = 1.25 * (flatness * (1.0 / (nL + nV) - 0.5) + 0.5);
    vec3 base = «BaseOverPi: color / PI» * «DiffuseAndSubsurface: mix(diffuse, subsurface, m.subsurface)»;
    vec3 sheen = fH * m.sheen * sheenColor;

    float aspect = «Anisotropy: sqrt(1.0 - 0.9 * m.anisotropic)»;
    float ax = max(0.001, «RoughnessX: square(m.roughness)» / aspect);
    float ay = max(0.001, «RoughnessY: square(m.roughness)» * aspect);
    float d = trowbridgeReitz(nH, «HalfVectorX: dot(x, middle)», «HalfVectorY: dot(y, middle)», ax, ay);
    float alpha = square(0.5 + 0.5 * m.roughness);
    float g = «Shadowing: smith(nL, alpha) * smith(nV, alpha)»;
    vec3 f = mix(specularColor, vec3(1.0), fH);

    float coat = 0.25 * m.clearcoat * «CoatDistribution: berry(nH, mix(0.1, 0.001, m.clearcoatGloss))» * mix(0.04, 1.0, fH)
        * smith(nL, 0.25) * smith(nV, 0.25);
    return «DiffuseLobe: «BaseAndSheen: (base + sheen)» * (1.0 - m.metallic)» + «SpecularAndCoat: f * d * g + coat»;
}
";

// Lights and direct illumination.

/// The condition under which a light illuminates a point.
const LIT: &str = "«Lit: cosine > 0.0»";

fn lit_and_visible(visible: &str) -> String {
    format!("«LitAndVisible: {LIT} && «Visible: {visible}»»")
}

impl Parts<'_> {
    pub(super) fn shading(&self, scene: &Scene) -> Vec<String> {
        let view = if self.uses_view() { ", vec3 view" } else { "" };
        if scene.lights.is_empty() {
            return vec![format!(
                "vec3 shade(Intersection hit{view}) {{\n    return hit.color * AMBIENT;\n}}\n"
            )];
        }
        let mut pieces = self.brdf();
        let shadows = LightShare::which(scene, |light| light.shadow);
        let soft = LightShare::which(scene, |light| light.radius > 0.0);
        let is_soft = soft != LightShare::None;
        if is_soft {
            pieces.push(AROUND.to_owned());
            let point = if soft == LightShare::Some { POINT } else { "" };
            pieces.push(SAMPLE_LIGHT.replace("POINT\n", point));
        }
        let (text, test) = if is_soft {
            (
                IN_SOFT_SHADOW,
                "inShadow(hit, «SoftShadowDirection: toLight», distance)",
            )
        } else {
            (IN_SHADOW, "inShadow(hit, lights[i].position)")
        };
        if shadows != LightShare::None {
            pieces.push(text.to_owned());
        }
        let is_lit = match shadows {
            LightShare::None => LIT.to_owned(),
            LightShare::Some => lit_and_visible(&format!("!(lights[i].shadow && {test})")),
            LightShare::All => lit_and_visible(&format!("!{test}")),
        };
        let toward = if is_soft {
            "float distance;\n        vec3 toLight = sampleLight(lights[i], hit.point, distance);"
        } else {
            "vec3 toLight = «DirectionToLight: normalize(lights[i].position - hit.point)»;"
        };
        let brdf = self.brdf_call("toLight", "view");
        let brdf = match self.brdf_slot() {
            Some(slot) => slot.mark(&brdf),
            None => brdf,
        };
        pieces.push(format!(
            "vec3 shade(Intersection hit{view}) {{\n    vec3 sum = «AmbientTerm: AMBIENT * hit.color»;\n    \
             for (int i = 0; i < «LightCount: LIGHTS»; i++) {{\n        {toward}\n        \
             float cosine = «LightCosine: dot(hit.normal, toLight)»;\n        \
             «LightStatement: if ({is_lit}) {{\n            \
             «LightSum: sum += «LightTerm: lights[i].color * «Brdf: {brdf}» * cosine»;»\n        }}»\n    }}\n    \
             return sum;\n}}\n"
        ));
        pieces
    }
}

/// How many lights have a property.
#[derive(PartialEq)]
pub(super) enum LightShare {
    None,
    Some,
    All,
}

impl LightShare {
    pub(super) fn which(scene: &Scene, has: impl Fn(&Light) -> bool) -> Self {
        match (scene.lights.iter().any(&has), scene.lights.iter().all(&has)) {
            (false, _) => Self::None,
            (true, false) => Self::Some,
            (true, true) => Self::All,
        }
    }
}

const IN_SHADOW: &str = "bool inShadow(Intersection hit, vec3 light) {
    vec3 origin = «ShadowOrigin: hit.point + «ShadowOffset: 0.001» * hit.normal»;
    vec3 toLight = «ShadowVector: light - origin»;
    float distance = length(toLight);
    «ShadowStatement: return nearestHit(Ray(origin, «ShadowDirection: toLight / distance»)).t < «ShadowLength: distance»;»
}
";

const IN_SOFT_SHADOW: &str = "bool inShadow(Intersection hit, vec3 toLight, float distance) {
    vec3 origin = «ShadowOrigin: hit.point + «ShadowOffset: 0.001» * hit.normal»;
    «SoftShadowStatement: return nearestHit(Ray(origin, toLight)).t < «ShadowLength: distance»;»
}
";

/// The case of a point light among sphere lights.
const POINT: &str = "    if (light.radius == 0.0) {
        distance = length(light.position - point);
        return (light.position - point) / distance;
    }
";

const SAMPLE_LIGHT: &str =
    "// Samples a direction in the cone that the light subtends, and returns the distance along it.
vec3 sampleLight(Light light, vec3 point, out float distance) {
POINT
    vec3 axis = light.position - point;
    float sine2 = «LightRadiusSquared: light.radius * light.radius» / dot(axis, axis);
    float depth = sine2 < 1.0 ? sine2 / (1.0 + sqrt(1.0 - sine2)) : 2.0;
    «ConeUStatement: float u = random();»
    «ConeVStatement: float v = random();»
    float cosine = «ConeCosine: 1.0 - u * depth»;
    float chord = sqrt(max(sine2 - (1.0 - cosine * cosine), 0.0));
    distance = length(axis) * (sine2 < 1.0 ? cosine - chord : cosine + chord);
    return «LightSample: around(normalize(axis), cosine, v)»;
}
";
