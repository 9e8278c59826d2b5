//! `material = { … }`

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::super::{Checker, Disney, Fresnel, Material, Model};
use super::checks::{Checks, Triple};

type Number = Option<Spanned<f64>>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
    model: Spanned<ModelName>,
    color: Triple,
    checker: Option<CheckerTable>,
    exponent: Number,
    ior: Number,
    fresnel: Option<Spanned<FresnelName>>,
    metallic: Number,
    subsurface: Number,
    specular: Number,
    specular_tint: Number,
    roughness: Number,
    anisotropic: Number,
    sheen: Number,
    sheen_tint: Number,
    clearcoat: Number,
    clearcoat_gloss: Number,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CheckerTable {
    color: Triple,
    size: Spanned<f64>,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
enum ModelName {
    Facing,
    Lambert,
    Diffuse,
    Disney,
    Glossy,
    Mirror,
    Glass,
    Emitter,
}

impl ModelName {
    fn word(self) -> &'static str {
        match self {
            Self::Facing => "facing",
            Self::Lambert => "lambert",
            Self::Diffuse => "diffuse",
            Self::Disney => "disney",
            Self::Glossy => "glossy",
            Self::Mirror => "mirror",
            Self::Glass => "glass",
            Self::Emitter => "emitter",
        }
    }
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum FresnelName {
    Exact,
    Schlick,
}

impl Table {
    /// The material, and where its model is named.
    pub(super) fn check(self, checks: &mut Checks) -> (Material, Range<usize>) {
        let place = self.model.span();
        let name = *self.model.get_ref();
        self.refuse_foreign(name, checks);
        let model = match name {
            ModelName::Facing => Model::Facing,
            ModelName::Lambert => Model::Lambert,
            ModelName::Diffuse => Model::Diffuse,
            ModelName::Disney => Model::Disney(self.disney(checks)),
            ModelName::Glossy => {
                let exponent = checks.needed("exponent", self.exponent.as_ref(), &place);
                Model::Glossy {
                    exponent: exponent.map_or(1.0, |exponent| checks.positive("exponent", exponent)),
                }
            }
            ModelName::Mirror => Model::Mirror,
            ModelName::Glass => {
                let ior = checks.needed("ior", self.ior.as_ref(), &place);
                Model::Glass {
                    ior: ior.map_or(1.5, |ior| checks.positive("ior", ior)),
                    fresnel: match self.fresnel.as_ref().map(Spanned::get_ref) {
                        None | Some(FresnelName::Exact) => Fresnel::Exact,
                        Some(FresnelName::Schlick) => Fresnel::Schlick,
                    },
                }
            }
            ModelName::Emitter => Model::Emitter,
        };
        let material = Material {
            model,
            color: checks.color("color", Some(self.color), [0.0; 3]),
            checker: self.checker.map(|checker| Checker {
                color: checks.color("color", Some(checker.color), [0.0; 3]),
                size: checks.positive("size", &checker.size),
            }),
        };
        (material, place)
    }

    /// The parameters of Burley's BRDF and their keys.
    fn parameters(&self) -> [(&'static str, &Number); 10] {
        [
            ("metallic", &self.metallic),
            ("subsurface", &self.subsurface),
            ("specular", &self.specular),
            ("specular_tint", &self.specular_tint),
            ("roughness", &self.roughness),
            ("anisotropic", &self.anisotropic),
            ("sheen", &self.sheen),
            ("sheen_tint", &self.sheen_tint),
            ("clearcoat", &self.clearcoat),
            ("clearcoat_gloss", &self.clearcoat_gloss),
        ]
    }

    fn refuse_foreign(&self, name: ModelName, checks: &mut Checks) {
        if name != ModelName::Glossy {
            checks.foreign("exponent", self.exponent.as_ref(), "glossy", name.word());
        }
        if name != ModelName::Glass {
            checks.foreign("ior", self.ior.as_ref(), "glass", name.word());
            checks.foreign("fresnel", self.fresnel.as_ref(), "glass", name.word());
        }
        if name != ModelName::Disney {
            for (key, value) in self.parameters() {
                checks.foreign(key, value.as_ref(), "disney", name.word());
            }
        }
    }

    fn disney(&self, checks: &mut Checks) -> Disney {
        let Disney {
            metallic,
            subsurface,
            specular,
            specular_tint,
            roughness,
            anisotropic,
            sheen,
            sheen_tint,
            clearcoat,
            clearcoat_gloss,
        } = Disney::default();
        let mut share =
            |what, value: &Number, default| value.as_ref().map_or(default, |value| checks.share(what, value));
        Disney {
            metallic: share("metallic", &self.metallic, metallic),
            subsurface: share("subsurface", &self.subsurface, subsurface),
            specular: share("specular", &self.specular, specular),
            specular_tint: share("specular_tint", &self.specular_tint, specular_tint),
            roughness: share("roughness", &self.roughness, roughness),
            anisotropic: share("anisotropic", &self.anisotropic, anisotropic),
            sheen: share("sheen", &self.sheen, sheen),
            sheen_tint: share("sheen_tint", &self.sheen_tint, sheen_tint),
            clearcoat: share("clearcoat", &self.clearcoat, clearcoat),
            clearcoat_gloss: share("clearcoat_gloss", &self.clearcoat_gloss, clearcoat_gloss),
        }
    }
}
