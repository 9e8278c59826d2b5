//! Mistakes in one number: a parameter of the scene or of the shader is fitted to the wrong image, and the
//! scene or the shader with the best value is a mutant like others.

use std::sync::Arc;

use toyproof_scene::export::{MarkedShader, Slot};
use toyproof_scene::{FrameTime, Model, Point, Projection, Scene, Shape};

use super::KnownMistake;
use super::change::place;
use crate::engine::fit::Fit;
use crate::engine::probes::Probes;
use crate::engine::tournament::{Entrant, Values, play};
use crate::engine::{Colors, Hypothesis, Numbers};
use crate::known::documented::{Documented, documented};
use crate::known::mutant::{Mutant, MutantSource};
use crate::known::view::View;

/// What the guide says about these mistakes.
pub(super) const DOCUMENTED: &[Documented] = documented! {
    /// Allow as many steps as a ray can need: the sum of the grid's cells along x, y and z.
    Grids "too-few-grid-steps": "the grid traversal stops after … cells";
    /// Use the scene's `screen_distance`.
    Numbers "wrong-screen-distance": "the screen distance is …; the scene has …";
    /// Use the scene's `width`.
    Numbers "wrong-projection-width": "the width of the parallel projection is …; the scene has …";
    /// Use the scene's `gamma`.
    Numbers "wrong-gamma": "gamma is …; the scene has …";
    /// Use the scene's `color` of the light, and check the factors of the shading.
    Numbers "wrong-brightness": "the light at … is … times as bright as the scene's";
    /// Use the scene's `ambient`.
    Numbers "wrong-ambient-light": "the ambient light is … times as bright as the scene's";
    /// Use the scene's `radius` of the light.
    Numbers "wrong-light-radius": "the radius of the light at … is …; the scene has …";
    /// Use the scene's `ior`.
    Numbers "wrong-ior": "the refractive index is …; the scene has …";
    /// Use the scene's `radius` of the sphere.
    Numbers "wrong-radius": "the radius of the sphere at … is …; the scene has …";
    /// Use `throughput *= color` with the color of the mirror that was hit.
    Numbers "constant-mirror-color": "every mirror multiplies the throughput by … instead of its color";
};

/// A number that may be wrong.
struct Parameter {
    id: &'static str,
    /// Describes the mistake for a value.
    description: Box<dyn Fn(f64) -> String + Sync>,
    /// The value whose multiples are tried.
    default_value: f64,
    /// Whether it is the correct value.
    is_correct: bool,
    source: Box<dyn Fn(f64) -> Option<MutantSource> + Sync>,
}

/// The smallest relative difference from the correct value of a number that is reported as wrong.
const MIN_RELATIVE_ERROR: f64 = 0.01;

/// The largest number of surfaces whose radii are fitted.
const MAX_OBJECTS: usize = 16;

/// The largest number of steps through a grid that is tried.
const MAX_STEPS: i32 = 16;

/// Returns the mutants that explain some of the wrong pixels with one number, each with its value.
pub(super) fn fitted_mutants(
    scene: &Scene,
    frame_time: FrameTime,
    shader: Option<&MarkedShader>,
    probes: &Probes,
    view: &Arc<View>,
) -> Vec<Mutant> {
    let Some(probes) = probes.selection() else {
        return Vec::new();
    };
    let parameters = parameters(scene, frame_time, shader);
    let hypotheses: Vec<OneNumber> = parameters
        .iter()
        .map(|parameter| OneNumber { parameter, view })
        .collect();
    let values: Vec<Values> = parameters.iter().map(Parameter::values).collect();
    let entrants: Vec<Entrant> = values.iter().map(|values| Entrant { values, cost: 0 }).collect();
    let finalists = play(&mut &hypotheses[..], &entrants, &probes).into_iter();
    let fitted = finalists.filter_map(|finalist| hypotheses[finalist.candidate].confirm(&finalist.numbers));
    let counted = shader
        .into_iter()
        .flat_map(|shader| step_count_mutants(shader, view));
    fitted.chain(counted).collect()
}

/// The hypothesis that a number is wrong.
struct OneNumber<'a> {
    parameter: &'a Parameter,
    view: &'a Arc<View>,
}

impl Hypothesis for OneNumber<'_> {
    type Confirmed = Mutant;

    fn colors(&self, probes: &Probes, &[value, ..]: &Numbers) -> Option<Colors> {
        (self.parameter.source)(value)?.colors(&self.view.frame, probes)
    }

    /// A number that is not the correct one is a mutant, which is confirmed like others.
    fn confirm(&self, &[value, ..]: &Numbers) -> Option<Mutant> {
        let Self { parameter, view } = self;
        let correct = parameter.default_value;
        let is_wrong = !parameter.is_correct || (value - correct).abs() > MIN_RELATIVE_ERROR * correct;
        let source = is_wrong.then(|| (parameter.source)(value)).flatten()?;
        Some(Mutant::new(vec![parameter.mistake(value)], source, view))
    }
}

/// All numbers of a scene and of its shader.
fn parameters(scene: &Scene, frame_time: FrameTime, shader: Option<&MarkedShader>) -> Vec<Parameter> {
    let mut parameters = of_scene(scene, frame_time);
    parameters.extend(shader.into_iter().flat_map(of_shader));
    parameters
}

impl Parameter {
    /// Any value may be the wrong one.
    fn values(&self) -> Values {
        Values::Tried {
            values: Vec::new(),
            fit: Some((0, Fit::Multiple(self.default_value))),
        }
    }

    /// The mistake of having this value.
    fn mistake(&self, value: f64) -> KnownMistake {
        KnownMistake::new(self.id, (self.description)(value))
    }
}

/// The mistakes of a scene and of its shader, each with some value.
#[cfg(test)]
pub(super) fn examples(
    scene: &Scene,
    frame_time: FrameTime,
    shader: Option<&MarkedShader>,
) -> Vec<KnownMistake> {
    let parameters = parameters(scene, frame_time, shader);
    let fitted = parameters.iter().map(|parameter| parameter.mistake(1.25));
    let view = Arc::new(View::new(&toyproof_image::Frame::default(), 1, 1));
    let counted = shader
        .into_iter()
        .flat_map(|shader| step_count_mutants(shader, &view));
    fitted.chain(counted.flat_map(|mutant| mutant.mistakes)).collect()
}

/// Mutants whose loop over the cells of a grid ends too early, one for each number of steps.
fn step_count_mutants(shader: &MarkedShader, view: &Arc<View>) -> Vec<Mutant> {
    let mutant = |steps: i32| {
        let shader = shader.replaced(&[(Slot::GridSteps, &steps.to_string())])?;
        let mistake = KnownMistake::new(
            "too-few-grid-steps",
            format!("the grid traversal stops after {steps} cells"),
        );
        Some(Mutant::new(vec![mistake], MutantSource::Shader(shader), view))
    };
    (2..=MAX_STEPS).filter_map(mutant).collect()
}

/// Formats a value with three digits.
fn three_digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 9);
    let text = format!("{value:.0$}", digits as usize);
    match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        None => text,
    }
}

/// Sets a number of a scene.
type Set = Box<dyn Fn(&mut Scene, f64) + Sync>;

/// A number of the scene.
struct SceneNumber {
    /// The id of the mistake of having another value.
    id: &'static str,
    /// Where the object is that has it; empty for the scene's own numbers.
    place: Vec<String>,
    value: f64,
    set: Set,
}

impl SceneNumber {
    fn new(id: &'static str, value: f64, set: impl Fn(&mut Scene, f64) + Sync + 'static) -> Self {
        Self {
            id,
            place: Vec::new(),
            value,
            set: Box::new(set),
        }
    }

    fn at(self, point: Point) -> Self {
        Self {
            place: vec![place(point)],
            ..self
        }
    }

    /// The description has the place, the value, and for most numbers the scene's value.
    fn parameter(self, scene: Scene, frame_time: FrameTime) -> Parameter {
        let documented = DOCUMENTED.iter().find(|documented| documented.id == self.id);
        let (place, expected) = (self.place, three_digits(self.value));
        Parameter {
            id: self.id,
            description: Box::new(move |value| {
                let parts = [place.clone(), vec![three_digits(value), expected.clone()]].concat();
                documented.map_or_else(String::new, |documented| {
                    documented.description(&parts).into_owned()
                })
            }),
            default_value: self.value,
            is_correct: true,
            source: Box::new(move |value| {
                let mut scene = scene.clone();
                (self.set)(&mut scene, value);
                scene.release_changed_scatters();
                Some(MutantSource::Scene(Box::new(scene), frame_time))
            }),
        }
    }
}

fn of_scene(scene: &Scene, frame_time: FrameTime) -> Vec<Parameter> {
    let projection = match scene.camera.projection {
        Projection::Pinhole { screen_distance } => SceneNumber::new(
            "wrong-screen-distance",
            screen_distance,
            |scene, screen_distance| {
                scene.camera.projection = Projection::Pinhole { screen_distance };
            },
        ),
        Projection::Parallel { width } => {
            SceneNumber::new("wrong-projection-width", width, |scene, width| {
                scene.camera.projection = Projection::Parallel { width };
            })
        }
    };
    let gamma = SceneNumber::new("wrong-gamma", scene.film.gamma, |scene, gamma| {
        scene.film.gamma = gamma
    });
    let mut numbers = vec![projection, gamma];
    for (index, light) in scene.lights.iter().enumerate() {
        let (color, radius) = (light.color, light.radius);
        let brightness = SceneNumber::new("wrong-brightness", 1.0, move |scene, factor| {
            scene.lights[index].color = color.map(|part| factor * part);
        });
        let radius = (radius > 0.0).then(|| {
            let set = move |scene: &mut Scene, radius| scene.lights[index].radius = radius;
            SceneNumber::new("wrong-light-radius", radius, set)
        });
        numbers.extend(
            [Some(brightness), radius]
                .into_iter()
                .flatten()
                .map(|number| number.at(light.position)),
        );
    }
    let ambient = scene.ambient;
    numbers.push(SceneNumber::new(
        "wrong-ambient-light",
        1.0,
        move |scene, factor| {
            scene.ambient = ambient.map(|part| factor * part);
        },
    ));
    numbers.extend(of_objects(scene));
    numbers
        .into_iter()
        .map(|number| number.parameter(scene.clone(), frame_time))
        .collect()
}

fn of_objects(scene: &Scene) -> Vec<SceneNumber> {
    let mut numbers = Vec::new();
    for (index, object) in scene.objects.iter().enumerate() {
        if let Model::Glass { ior, .. } = object.material.model {
            numbers.push(SceneNumber::new("wrong-ior", ior, move |scene, new| {
                if let Model::Glass { ior, .. } = &mut scene.objects[index].material.model {
                    *ior = new;
                }
            }));
        }
        if let Shape::Sphere { center, radius } = object.shape
            && scene.objects.len() <= MAX_OBJECTS
        {
            let number = SceneNumber::new("wrong-radius", radius, move |scene, new| {
                if let Shape::Sphere { radius, .. } = &mut scene.objects[index].shape {
                    *radius = new;
                }
            });
            numbers.push(number.at(center));
        }
    }
    numbers
}

/// Numbers that a shader may have but the scene does not.
fn of_shader(shader: &MarkedShader) -> Vec<Parameter> {
    type Describe = fn(&str) -> String;
    let all: [(_, Describe, _, _, _); 2] = [
        (
            "light-falloff",
            |value| format!("light decreases as {value} / distance²; lights in the scene have no falloff"),
            Slot::LightTerm,
            "… * NUMBER / dot(lights[i].position - hit.point, lights[i].position - hit.point)",
            10.0,
        ),
        (
            "constant-mirror-color",
            |value| format!("every mirror multiplies the throughput by {value} instead of its color"),
            Slot::MirrorStatement,
            "throughput *= NUMBER;",
            0.5,
        ),
    ];
    let used = all.into_iter().filter(|(_, _, slot, ..)| shader.has(*slot));
    let parameter = |(id, describe, slot, template, default_value): (_, Describe, _, &'static str, _)| {
        let shader = shader.clone();
        Parameter {
            id,
            description: Box::new(move |value| describe(&three_digits(value))),
            default_value,
            is_correct: false,
            source: Box::new(move |value| {
                let template = template.replace("NUMBER", &format!("{value:?}"));
                shader.replaced(&[(slot, &template)]).map(MutantSource::Shader)
            }),
        }
    };
    used.map(parameter).collect()
}
