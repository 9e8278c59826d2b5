//! The tables of the scene file for surfaces (`[[sphere]]` and others), for their materials, and for motions.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::super::{
    Checker, Disney, Fresnel, Material, Model, Motion, Object, Period, Point, Quadric, QuadricKind, Scatter,
    Shape,
};
use super::Surface;
use super::checks::{Checks, Pair, Triple};

/// The maximum number of spheres of one scatter.
const MAX_SCATTER: u64 = 65_536;
/// The default axis: upright.
const UP: Point = [0.0, 1.0, 0.0];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereTable {
    center: Triple,
    radius: Spanned<f64>,
    material: MaterialTable,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlaneTable {
    point: Triple,
    normal: Option<Triple>,
    material: MaterialTable,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EllipsoidTable {
    center: Triple,
    radii: Triple,
    material: MaterialTable,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HyperboloidTable {
    center: Triple,
    axis: Option<Triple>,
    waist: Spanned<f64>,
    radius: Spanned<f64>,
    height: Spanned<f64>,
    material: MaterialTable,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScatterTable {
    corner: Triple,
    cells: Spanned<[u32; 3]>,
    spacing: Spanned<f64>,
    radius: Pair,
    seed: Option<u32>,
    material: MaterialTable,
    motion: Option<Spanned<String>>,
}

/// Returns one surface from its shape and the keys that all tables have.
fn object(
    shape: Shape,
    (material, motion): (MaterialTable, Option<Spanned<String>>),
    names: &MotionNames,
    checks: &mut Checks,
) -> (Vec<Object>, Range<usize>) {
    let (material, place) = material.check(checks);
    let object = Object {
        shape,
        material,
        motion: names.find(motion, checks),
    };
    (vec![object], place)
}

fn quadric(origin: (&str, Triple), axis: Option<Triple>, kind: QuadricKind, checks: &mut Checks) -> Shape {
    let axis = checks.direction("axis", axis, UP);
    let (what, origin) = origin;
    let origin = checks.point(what, Some(origin), [0.0; 3]);
    Shape::Quadric(Quadric::around(axis, origin, kind))
}

impl Surface for SphereTable {
    fn check(self, names: &MotionNames, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let shape = Shape::Sphere {
            center: checks.point("center", Some(self.center), [0.0; 3]),
            radius: checks.positive("radius", &self.radius),
        };
        object(shape, (self.material, self.motion), names, checks)
    }
}

impl Surface for PlaneTable {
    fn check(self, names: &MotionNames, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let shape = Shape::Plane {
            point: checks.point("point", Some(self.point), [0.0; 3]),
            normal: checks.direction("normal", self.normal, UP),
        };
        object(shape, (self.material, self.motion), names, checks)
    }
}

impl Surface for EllipsoidTable {
    fn check(self, names: &MotionNames, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let radii = *self.radii.get_ref();
        if !radii.iter().all(|radius| radius.is_finite() && *radius > 0.0) {
            checks.refuse(
                self.radii.span(),
                "radii must be three finite numbers above 0".to_owned(),
            );
        }
        let shape = Shape::Quadric(Quadric {
            kind: QuadricKind::Ellipsoid { radii },
            origin: checks.point("center", Some(self.center), [0.0; 3]),
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        });
        object(shape, (self.material, self.motion), names, checks)
    }
}

/// Defines tables of quadrics with a radius at one end of the axis and a height along it.
macro_rules! axial_tables {
    ($($table:ident: $kind:ident from $origin:ident;)*) => {$(
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $table {
            $origin: Triple,
            axis: Option<Triple>,
            radius: Spanned<f64>,
            height: Spanned<f64>,
            material: MaterialTable,
            motion: Option<Spanned<String>>,
        }

        impl Surface for $table {
            fn check(self, names: &MotionNames, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
                let kind = QuadricKind::$kind {
                    radius: checks.positive("radius", &self.radius),
                    height: checks.positive("height", &self.height),
                };
                let shape = quadric((stringify!($origin), self.$origin), self.axis, kind, checks);
                object(shape, (self.material, self.motion), names, checks)
            }
        }
    )*};
}

axial_tables! {
    CylinderTable: Cylinder from base;
    ConeTable: Cone from apex;
    ParaboloidTable: Paraboloid from apex;
}

impl Surface for HyperboloidTable {
    fn check(self, names: &MotionNames, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let waist = checks.positive("waist", &self.waist);
        let radius = checks.positive("radius", &self.radius);
        if waist >= radius {
            checks.refuse(self.waist.span(), "waist must be smaller than radius".to_owned());
        }
        let height = checks.positive("height", &self.height);
        let kind = QuadricKind::Hyperboloid {
            waist,
            radius,
            height,
        };
        let shape = quadric(("center", self.center), self.axis, kind, checks);
        object(shape, (self.material, self.motion), names, checks)
    }
}

impl ScatterTable {
    /// Returns the scatter, and the bytes of the file that name its model.
    pub(super) fn check(self, names: &MotionNames, checks: &mut Checks) -> (Scatter, Range<usize>) {
        let cells = *self.cells.get_ref();
        let number: u64 = cells
            .iter()
            .map(|side| u64::from(*side))
            .fold(1, u64::saturating_mul);
        if !(1..=MAX_SCATTER).contains(&number) {
            let message =
                format!("cells must be three whole numbers whose product is from 1 to {MAX_SCATTER}");
            checks.refuse(self.cells.span(), message);
        }
        let spacing = checks.positive("spacing", &self.spacing);
        let radius = *self.radius.get_ref();
        if !(radius[0] > 0.0 && radius[0] <= radius[1] && radius[1] <= 0.5 * spacing) {
            let message = "radius must be the smallest and the largest, above 0 and at most half the spacing";
            checks.refuse(self.radius.span(), message.to_owned());
        }
        let (material, place) = self.material.check(checks);
        let scatter = Scatter {
            corner: checks.point("corner", Some(self.corner), [0.0; 3]),
            cells: if number > MAX_SCATTER { [1; 3] } else { cells },
            spacing,
            radius,
            seed: self.seed.unwrap_or(0),
            material,
            motion: names.find(self.motion, checks),
        };
        (scatter, place)
    }
}

// `material = { … }`

type Number = Option<Spanned<f64>>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
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
    fn name(self) -> &'static str {
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

impl MaterialTable {
    /// Returns the material, and the bytes of the file that name its model.
    pub(super) fn check(self, checks: &mut Checks) -> (Material, Range<usize>) {
        let place = self.model.span();
        let name = *self.model.get_ref();
        self.reject_keys_of_other_models(name, checks);
        let model = match name {
            ModelName::Facing => Model::Facing,
            ModelName::Lambert => Model::Lambert,
            ModelName::Diffuse => Model::Diffuse,
            ModelName::Disney => Model::Disney(self.disney(checks)),
            ModelName::Glossy => {
                let exponent = checks.required("exponent", self.exponent.as_ref(), &place);
                Model::Glossy {
                    exponent: exponent.map_or(1.0, |exponent| checks.positive("exponent", exponent)),
                }
            }
            ModelName::Mirror => Model::Mirror,
            ModelName::Glass => {
                let ior = checks.required("ior", self.ior.as_ref(), &place);
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

    /// Returns the parameters of Burley's BRDF with their keys.
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

    fn reject_keys_of_other_models(&self, name: ModelName, checks: &mut Checks) {
        if name != ModelName::Glossy {
            checks.refuse_key("exponent", self.exponent.as_ref(), "glossy", name.name());
        }
        if name != ModelName::Glass {
            checks.refuse_key("ior", self.ior.as_ref(), "glass", name.name());
            checks.refuse_key("fresnel", self.fresnel.as_ref(), "glass", name.name());
        }
        if name != ModelName::Disney {
            for (key, value) in self.parameters() {
                checks.refuse_key(key, value.as_ref(), "disney", name.name());
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

// `[[motion]]`, and references to motions by name

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionTable {
    name: Spanned<String>,
    pivot: Option<Triple>,
    axis: Option<Triple>,
    frames: Option<Spanned<f64>>,
    seconds: Option<Spanned<f64>>,
    within: Option<Spanned<String>>,
}

/// The names of motions, in file order.
pub(super) struct MotionNames(Vec<String>);

impl MotionNames {
    /// Returns the index of the motion with that name.
    pub(super) fn find(&self, name: Option<Spanned<String>>, checks: &mut Checks) -> Option<usize> {
        let name = name?;
        let found = self.0.iter().position(|known| known == name.get_ref());
        if found.is_none() {
            let known: Vec<_> = self.0.iter().map(|known| format!("\"{known}\"")).collect();
            let known = match known.as_slice() {
                [] => "there is none before here".to_owned(),
                known => format!("expected {}", known.join(" or ")),
            };
            checks.refuse(
                name.span(),
                format!("no motion is called \"{}\": {known}", name.get_ref()),
            );
        }
        found
    }
}

pub(super) fn check_motions(tables: Vec<MotionTable>, checks: &mut Checks) -> (Vec<Motion>, MotionNames) {
    let mut names = MotionNames(Vec::new());
    let mut motions = Vec::new();
    for table in tables {
        let place = table.name.span();
        let period = match (&table.frames, &table.seconds) {
            (Some(frames), None) => Period::Frames(nonzero("frames", frames, checks)),
            (None, Some(seconds)) => Period::Seconds(nonzero("seconds", seconds, checks)),
            _ => {
                let message = "a motion takes either frames or seconds for one turn";
                checks.refuse(place.clone(), message.to_owned());
                Period::Frames(1.0)
            }
        };
        motions.push(Motion {
            pivot: checks.point("pivot", table.pivot, [0.0; 3]),
            axis: checks.direction("axis", table.axis, [0.0, 1.0, 0.0]),
            period,
            within: names.find(table.within, checks),
        });
        let name = table.name.into_inner();
        if names.0.contains(&name) {
            checks.refuse(place, format!("a second motion is called \"{name}\""));
        }
        names.0.push(name);
    }
    (motions, names)
}

fn nonzero(what: &str, value: &Spanned<f64>, checks: &mut Checks) -> f64 {
    let number = *value.get_ref();
    if !(number.is_finite() && number != 0.0) {
        checks.refuse(
            value.span(),
            format!("{what} must be a finite number other than 0, not {number}"),
        );
    }
    number
}
