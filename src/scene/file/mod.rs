//! The scene file: TOML, with a diagnostic for every error.

mod checks;
mod film;
mod surface;
#[cfg(test)]
mod tests;

use toyproof_diagnostic::{Code, Diagnostics, FileId, Files, Span};
use toyproof_toml::{Format, Table};

use self::checks::Checks;
use self::film::{DEFAULT_CAMERA, DEFAULT_FILM, FilmTable};
use self::surface::MotionNames;
use super::{Background, Film, Integrator, Light, Model, Object, ScatterObjects, Scene, Shape};

/// Scene files.
static FORMAT: Format = Format {
    form_code: Code::SceneSyntax,
    value_code: Code::SceneValue,
    aliases: &[("centre", "center"), ("colour", "color")],
};

/// Parses a scene.
///
/// # Errors
/// Diagnostics for the first error of the TOML syntax, or for all other errors.
pub fn parse(files: &Files, file: FileId) -> Result<Scene, Diagnostics> {
    toyproof_toml::read(&FORMAT, files, file, scene)
}

/// The default of `max_offset` in scene units, as in most shaders.
const DEFAULT_MAX_OFFSET: f64 = 1e-3;
/// The maximum number of path segments of a scene with glass.
const MAX_GLASS_DEPTH: u32 = 16;

fn scene(document: &mut Table) -> Scene {
    let title = document.optional::<String>("title");
    let ambient_span = document.value_span("ambient");
    let ambient = document.color_or("ambient", [0.0; 3]);
    let max_offset = document.positive_or("max_offset", DEFAULT_MAX_OFFSET);
    let FilmTable {
        film,
        max_depth,
        integrator,
    } = document.table("film", FilmTable::read).unwrap_or(FilmTable {
        film: DEFAULT_FILM,
        max_depth: None,
        integrator: None,
    });
    let camera = document.table("camera", film::camera).unwrap_or(DEFAULT_CAMERA);
    let background = document.table("background", background);
    let figures = document.tables("figure", film::figure);
    let mut names = MotionNames::default();
    let motions = document.tables("motion", |table| surface::motion(table, &mut names));
    let lights = document.tables("light", |table| light(table, &film, &names));
    let mut surfaces = Surfaces {
        names: &names,
        film,
        objects: Vec::new(),
        scatters: Vec::new(),
    };
    for (key, shape) in surface::SHAPES {
        document.tables(key, |table| {
            let (object, model) = surface::object(table, &names, shape);
            surfaces.check_compatibility(&object, model, table);
            surfaces.objects.push(object);
        });
    }
    document.tables("scatter", |table| surfaces.add_scatter(table));
    let Surfaces {
        objects, scatters, ..
    } = surfaces;
    if film.integrator == Integrator::Path {
        if let Some(span) = ambient_span {
            let help = "remove `ambient`; the background lights the scene";
            document.reject(
                span,
                "`ambient` cannot be used with `integrator = \"path\"`",
                help,
            );
        }
        if let Some(span) = integrator
            && !film.sampler.is_stochastic()
            && !objects.is_empty()
        {
            document.reject(
                span,
                "`integrator = \"path\"` needs a stochastic sampler",
                STOCHASTIC_SAMPLERS,
            );
        }
    }
    let is_glass = |object: &Object| matches!(object.material.model, Model::Glass { .. });
    if film.max_depth > MAX_GLASS_DEPTH
        && let Some(span) = max_depth
        && objects.iter().any(is_glass)
    {
        let message = format!(
            "`max_depth` must be at most {MAX_GLASS_DEPTH} in a scene with glass, found {}",
            document.excerpt(span)
        );
        document.reject(
            span,
            message,
            "lower `max_depth`: glass splits each ray into two, so each segment doubles the time",
        );
    }
    document.report_unknown_keys();
    if document.is_valid() && objects.is_empty() && figures.is_empty() && background.is_none() {
        let help = "add a surface such as [[sphere]], a [[figure]] or a [background]";
        document.reject(document.span(), "the scene is empty", help);
    }
    Scene {
        title: title.map_or_else(String::new, |title| title.value),
        ambient,
        max_offset,
        film,
        camera,
        background: background.unwrap_or(BLACK),
        figures: figures.into_iter().flatten().collect(),
        lights,
        objects,
        scatters,
        motions,
    }
}

const STOCHASTIC_SAMPLERS: &str = "set `sampler` in [film] to `independent`, `stratified` or `sobol`";

/// Collects surfaces and checks them against the film.
struct Surfaces<'a> {
    names: &'a MotionNames,
    film: Film,
    objects: Vec<Object>,
    scatters: Vec<ScatterObjects>,
}

impl Surfaces<'_> {
    fn add_scatter(&mut self, table: &mut Table) {
        let (scatter, model) = surface::scatter(table, self.names);
        let first = self.objects.len();
        self.objects.extend(scatter.spheres());
        if let Some(object) = self.objects.get(first) {
            self.check_compatibility(object, model, table);
        }
        self.scatters.push(ScatterObjects {
            scatter,
            objects: first..self.objects.len(),
        });
    }

    /// Rejects incompatible combinations of shape, model and integrator.
    fn check_compatibility(&self, object: &Object, model: Option<Span>, table: &Table) {
        let Some(model) = model else {
            return;
        };
        let Object { shape, material, .. } = object;
        let is_sphere = matches!(shape, Shape::Sphere { .. });
        match material.model {
            Model::Glass { .. } if !shape.is_closed() => {
                table.reject(
                    model,
                    "glass needs a closed shape",
                    "use [[sphere]], [[ellipsoid]] or [[box]]",
                );
            }
            _ if self.film.integrator == Integrator::Whitted => {}
            Model::Emitter if !is_sphere => {
                let message = "with `integrator = \"path\"`, an emitter must be a sphere";
                table.reject(model, message, "use [[sphere]]");
            }
            Model::Diffuse | Model::Glossy { .. } | Model::Mirror | Model::Emitter => {}
            Model::Facing | Model::Lambert | Model::Disney(_) | Model::Glass { .. } => {
                let name = table.excerpt(model).trim_matches(['"', '\'']);
                let message = format!("model `{name}` cannot be used with `integrator = \"path\"`");
                table.reject(model, message, "use `diffuse`, `glossy`, `mirror` or `emitter`");
            }
        }
    }
}

fn light(table: &mut Table, film: &Film, names: &MotionNames) -> Light {
    let position = table.point("position");
    let color = table.color_or("color", [1.0; 3]);
    let shadow = table.optional::<bool>("shadow");
    let radius_span = table.value_span("radius");
    let radius = radius_span.map_or(0.0, |_| table.positive("radius"));
    if film.integrator == Integrator::Path {
        let help = "use a sphere whose model is `emitter`";
        table.reject(
            table.span(),
            "[[light]] cannot be used with `integrator = \"path\"`",
            help,
        );
    } else if let Some(span) = radius_span
        && !film.sampler.is_stochastic()
    {
        table.reject(
            span,
            "a light with a `radius` needs a stochastic sampler",
            STOCHASTIC_SAMPLERS,
        );
    }
    Light {
        position,
        color,
        shadow: shadow.is_none_or(|shadow| shadow.value),
        radius,
        motion: names.read("motion", table),
    }
}

const BLACK: Background = Background::Uniform([0.0; 3]);

fn background(table: &mut Table) -> Background {
    match ["color", "bottom", "top"].map(|key| table.has(key)) {
        [_, false, false] => Background::Uniform(table.color_or("color", [0.0; 3])),
        [false, true, true] => Background::Gradient {
            bottom: table.color("bottom"),
            top: table.color("top"),
        },
        _ => {
            let help = "remove `color` for a gradient, or `bottom` and `top` for a uniform background";
            table.reject(
                table.span(),
                "[background] needs either `color`, or `bottom` and `top`",
                help,
            );
            table.ignore_rest();
            BLACK
        }
    }
}
