//! What surfaces are made of, and how they answer light.

use std::fmt::Write;

use super::parts::Parts;
use super::{disney, number};
use crate::{Fresnel, Material, Model};

/// A model without its numbers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Facing,
    Lambert,
    Diffuse,
    Glossy,
    Disney,
    Mirror,
    Glass,
    Schlick,
    Emitter,
}

/// Those with a BRDF.
pub(super) const REFLECTIVE: [Kind; 4] = [Kind::Lambert, Kind::Diffuse, Kind::Glossy, Kind::Disney];
pub(super) const GLASS: [Kind; 2] = [Kind::Glass, Kind::Schlick];

impl Kind {
    pub(super) fn of(model: &Model) -> Self {
        match model {
            Model::Facing => Self::Facing,
            Model::Lambert => Self::Lambert,
            Model::Diffuse => Self::Diffuse,
            Model::Glossy { .. } => Self::Glossy,
            Model::Disney(_) => Self::Disney,
            Model::Mirror => Self::Mirror,
            Model::Glass {
                fresnel: Fresnel::Exact,
                ..
            } => Self::Glass,
            Model::Glass {
                fresnel: Fresnel::Schlick,
                ..
            } => Self::Schlick,
            Model::Emitter => Self::Emitter,
        }
    }

    /// What it is called in the shader.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Facing => "FACING",
            Self::Lambert => "LAMBERT",
            Self::Diffuse => "DIFFUSE",
            Self::Glossy => "GLOSSY",
            Self::Disney => "DISNEY",
            Self::Mirror => "MIRROR",
            Self::Glass => "GLASS",
            Self::Schlick => "SCHLICK",
            Self::Emitter => "EMITTER",
        }
    }
}

/// What a surface has beside its shape and colour, and a hit takes over from it.
pub(super) struct Property {
    pub(super) kind: &'static str,
    pub(super) name: &'static str,
    pub(super) value: fn(&Material) -> String,
}

const MODEL: Property = Property {
    kind: "int",
    name: "model",
    value: |material| Kind::of(&material.model).word().to_owned(),
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
        Model::Disney(disney) => disney::values(disney),
        _ => disney::values(&crate::Disney::default()),
    },
};

impl Parts<'_> {
    pub(super) fn properties(&self) -> Vec<Property> {
        let all = [
            (self.names_models(), MODEL),
            (self.uses(Kind::Glossy), EXPONENT),
            (self.uses_any(&GLASS), IOR),
            (self.uses(Kind::Disney), DISNEY),
        ];
        let used = all.into_iter().filter(|(is_used, _)| *is_used);
        used.map(|(_, property)| property).collect()
    }

    /// Whether it matters for a BRDF where it is seen from.
    pub(super) fn looks_back(&self) -> bool {
        self.uses_any(&[Kind::Glossy, Kind::Disney])
    }

    /// The BRDF at a hit for light from `light`, seen along `view`, where those are needed.
    pub(super) fn brdf_call(&self, light: &str, view: &str) -> String {
        if self.looks_back() {
            return format!("brdf(hit, {light}, {view})");
        }
        match (self.uses(Kind::Lambert), self.uses(Kind::Diffuse)) {
            (true, true) => "brdf(hit)".to_owned(),
            (false, true) => "hit.color / PI".to_owned(),
            _ => "hit.color".to_owned(),
        }
    }

    /// The functions that it calls.
    pub(super) fn brdf(&self) -> Vec<String> {
        let mut pieces = Vec::new();
        let mut cases = Vec::new();
        let mut add = |kind, body: &str| {
            if self.uses(kind) {
                cases.push(([kind], body.to_owned()));
            }
        };
        add(Kind::Lambert, "return hit.color;");
        add(Kind::Diffuse, "return hit.color / PI;");
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
            pieces.push(disney::FUNCTIONS.to_owned());
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

    /// What is done at a hit by its model. Each of the bodies leaves, but perhaps the last, which needs no test.
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
                .map(|kind| format!("hit.model == {}", kind.word()))
                .collect();
            lines(&format!("if ({}) {{", tests.join(" || ")), indent);
            lines(body, &format!("{indent}    "));
            lines("}", indent);
        }
        text
    }
}
