//! The scene file: TOML, with a diagnostic for every error.

mod checks;
mod film;
mod surface;
#[cfg(test)]
mod tests;

use serde::Deserialize;
use toml::Spanned;
use toyproof_diagnostic::{Diagnostics, FileId, Files};

pub use self::checks::toml_diagnostic;
use self::checks::{Checks, Triple};
use self::surface::MotionNames;
use super::{Background, Integrator, Light, Model, Object, Scattered, Scene, Shape};

/// Parses a scene.
///
/// # Errors
/// Diagnostics for the first error of the TOML syntax or schema, or for all values that are out of range.
pub fn parse(files: &Files, file: FileId) -> Result<Scene, Diagnostics> {
    let text = files.get(file).text();
    let document: Document = toml::from_str(text)
        .map_err(|error| Diagnostics::new(vec![toml_diagnostic("E0501", &error, files, file)], files))?;
    let mut checks = Checks::new(file);
    let scene = document.check(&mut checks);
    checks.finish(scene, files)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    title: String,
    ambient: Option<Triple>,
    max_offset: Option<Spanned<f64>>,
    #[serde(default)]
    film: film::FilmTable,
    #[serde(default)]
    camera: film::CameraTable,
    background: Option<Spanned<BackgroundTable>>,
    #[serde(default)]
    figure: Vec<film::FigureTable>,
    #[serde(default)]
    motion: Vec<surface::MotionTable>,
    #[serde(default)]
    light: Vec<LightTable>,
    #[serde(default)]
    sphere: Vec<surface::SphereTable>,
    #[serde(default)]
    plane: Vec<surface::PlaneTable>,
    #[serde(default)]
    ellipsoid: Vec<surface::EllipsoidTable>,
    #[serde(default)]
    cylinder: Vec<surface::CylinderTable>,
    #[serde(default)]
    cone: Vec<surface::ConeTable>,
    #[serde(default)]
    paraboloid: Vec<surface::ParaboloidTable>,
    #[serde(default)]
    hyperboloid: Vec<surface::HyperboloidTable>,
    #[serde(default)]
    scatter: Vec<surface::ScatterTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BackgroundTable {
    color: Option<Triple>,
    bottom: Option<Triple>,
    top: Option<Triple>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LightTable {
    position: Spanned<[f64; 3]>,
    color: Option<Triple>,
    shadow: Option<bool>,
    radius: Option<Spanned<f64>>,
    motion: Option<Spanned<String>>,
}

impl Document {
    fn check(self, checks: &mut Checks) -> Scene {
        let ambient = self.ambient.as_ref().map(Spanned::span);
        let max_depth = self.film.max_depth.as_ref().map(Spanned::span);
        let scene_ambient = checks.color("ambient", self.ambient, [0.0; 3]);
        let has_background = self.background.is_some();
        let film = self.film.check(checks);
        let (motions, names) = surface::check_motions(self.motion, checks);
        let mut lights = Vec::new();
        for light in self.light {
            let light_radius = light.radius.as_ref().map(Spanned::span);
            if film.integrator == Integrator::Path {
                let message =
                    "a path-traced scene is lit by surfaces whose model is \"emitter\", not by lights";
                checks.refuse(light.position.span(), message.to_owned());
            } else if let Some(light_radius) = light_radius
                && !film.sampler.draws()
            {
                checks.refuse(light_radius, needs_a_sampler("a light with a radius"));
            }
            lights.push(light.check(&names, checks));
        }
        let mut surfaces = Surfaces {
            names: &names,
            checks,
            objects: Vec::new(),
            scatters: Vec::new(),
            film,
        };
        surfaces.add(self.sphere);
        surfaces.add(self.plane);
        surfaces.add(self.ellipsoid);
        surfaces.add(self.cylinder);
        surfaces.add(self.cone);
        surfaces.add(self.paraboloid);
        surfaces.add(self.hyperboloid);
        surfaces.add_scatters(self.scatter);
        let Surfaces {
            objects, scatters, ..
        } = surfaces;
        if film.integrator == Integrator::Path
            && let Some(ambient) = ambient
        {
            let message = "a path-traced scene has no ambient light; its background is all around it";
            checks.refuse(ambient, message.to_owned());
        }
        let glass = |object: &Object| matches!(object.material.model, Model::Glass { .. });
        if film.max_depth > MAX_GLASS_DEPTH
            && let Some(max_depth) = max_depth
            && objects.iter().any(glass)
        {
            let message = format!(
                "max_depth must be at most {MAX_GLASS_DEPTH} where there is glass, which parts each ray in two"
            );
            checks.refuse(max_depth, message);
        }
        let scene = Scene {
            title: self.title,
            ambient: scene_ambient,
            max_offset: self.max_offset.map_or(DEFAULT_MAX_OFFSET, |offset| {
                checks.positive("max_offset", &offset)
            }),
            film,
            camera: self.camera.check(checks),
            background: background(self.background, checks),
            figures: self
                .figure
                .into_iter()
                .map(|figure| figure.check(checks))
                .collect(),
            lights,
            objects,
            scatters,
            motions,
        };
        if scene.objects.is_empty() && scene.figures.is_empty() && !has_background {
            checks.refuse_empty();
        }
        scene
    }
}

/// The default of `max_offset` in scene units, as in most shaders.
const DEFAULT_MAX_OFFSET: f64 = 1e-3;
/// The maximum number of path segments of a scene with glass.
const MAX_GLASS_DEPTH: u32 = 16;

fn needs_a_sampler(what: &str) -> String {
    format!("{what} needs a film whose sampler draws: \"independent\", \"stratified\" or \"sobol\"")
}

/// A table that describes surfaces.
trait Surface {
    /// Returns the surfaces, and the bytes of the file that name their model.
    fn check(self, names: &MotionNames, checks: &mut Checks) -> (Vec<Object>, std::ops::Range<usize>);
}

/// Collects surfaces and checks them against the film.
struct Surfaces<'a> {
    names: &'a MotionNames,
    checks: &'a mut Checks,
    objects: Vec<Object>,
    scatters: Vec<Scattered>,
    film: super::Film,
}

impl Surfaces<'_> {
    fn add<S: Surface>(&mut self, tables: Vec<S>) {
        for table in tables {
            let (objects, place) = table.check(self.names, self.checks);
            if let Some(object) = objects.first() {
                self.check_compatibility(object, place);
            }
            self.objects.extend(objects);
        }
    }

    fn add_scatters(&mut self, tables: Vec<surface::ScatterTable>) {
        for table in tables {
            let (scatter, place) = table.check(self.names, self.checks);
            let first = self.objects.len();
            self.objects.extend(scatter.spheres());
            if let Some(object) = self.objects.get(first).cloned() {
                self.check_compatibility(&object, place);
            }
            self.scatters.push(Scattered {
                scatter,
                objects: first..self.objects.len(),
            });
        }
    }

    /// Refuses incompatible combinations of shape, model and integrator.
    fn check_compatibility(&mut self, object: &Object, place: std::ops::Range<usize>) {
        let Object { shape, material, .. } = object;
        if matches!(material.model, Model::Glass { .. }) && !shape.is_closed() {
            let message = "glass needs an inside, and so a sphere or an ellipsoid";
            return self.checks.refuse(place, message.to_owned());
        }
        if self.film.integrator == Integrator::Whitted {
            return;
        }
        if !self.film.sampler.draws() {
            self.checks
                .refuse(place, needs_a_sampler("the integrator \"path\""));
            return;
        }
        match material.model {
            Model::Diffuse | Model::Glossy { .. } | Model::Mirror => {}
            Model::Emitter if matches!(shape, Shape::Sphere { .. }) => {}
            Model::Emitter => self.checks.refuse(place, "an emitter is a sphere".to_owned()),
            _ => {
                let message = "the integrator \"path\" knows the models \"diffuse\", \"glossy\", \"mirror\" and \"emitter\"";
                self.checks.refuse(place, message.to_owned());
            }
        }
    }
}

impl LightTable {
    fn check(self, names: &MotionNames, checks: &mut Checks) -> Light {
        Light {
            position: checks.point("position", Some(self.position), [0.0; 3]),
            color: checks.color("color", self.color, [1.0; 3]),
            shadow: self.shadow.unwrap_or(true),
            radius: self
                .radius
                .map_or(0.0, |radius| checks.positive("radius", &radius)),
            motion: names.find(self.motion, checks),
        }
    }
}

fn background(table: Option<Spanned<BackgroundTable>>, checks: &mut Checks) -> Background {
    let black = [0.0; 3];
    let Some(table) = table else {
        return Background::Uniform(black);
    };
    let bytes = table.span();
    match table.into_inner() {
        BackgroundTable {
            color,
            bottom: None,
            top: None,
        } => Background::Uniform(checks.color("color", color, black)),
        BackgroundTable {
            color: None,
            bottom: Some(bottom),
            top: Some(top),
        } => Background::Gradient {
            bottom: checks.color("bottom", Some(bottom), black),
            top: checks.color("top", Some(top), black),
        },
        _ => {
            checks.refuse(
                bytes,
                "a background has either a color, or a bottom and a top".to_owned(),
            );
            Background::Uniform(black)
        }
    }
}
