//! Mistakes in one number: a parameter of the scene or of the shader is fitted to the wrong image, and the
//! scene or the shader with the best value is a mutant like others.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_scene::export::{MarkedShader, Slot};
use toyproof_scene::{FrameTime, Model, Projection, Scene, Shape};

use super::KnownMistake;
use super::change::place;
use crate::known::documented::{Documented, documented};
use crate::known::mutant::{Mutant, MutantSource};
use crate::known::thumbnail::{WrongImage, differs, max_unexplained};

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

/// The multiples of the default value between which the minimum is searched.
const MULTIPLES: [f64; 11] = [0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.35, 2.0, 4.0, 16.0, 64.0];

/// The iterations of the golden-section search: 25 reduce the interval to a hundred thousandth.
const SEARCH_ITERATIONS: usize = 25;

/// The smallest relative difference from the correct value of a number that is reported as wrong.
const MIN_RELATIVE_ERROR: f64 = 0.01;

/// The largest number of surfaces whose radii are fitted.
const MAX_OBJECTS: usize = 16;

/// The largest number of steps through a grid that is tried.
const MAX_STEPS: i32 = 16;

/// Returns the mutants that explain an image as well as one number can, each with the best value of its
/// number.
pub(super) fn fitted_mutants(
    scene: &Scene,
    frame_time: FrameTime,
    shader: Option<&MarkedShader>,
    wrong_image: &WrongImage,
    correct: &Image,
) -> Vec<Mutant> {
    let parameters = parameters(scene, frame_time, shader);
    let fitted = parameters.par_iter().filter_map(|parameter| {
        let value = best_value(parameter, wrong_image, correct)?;
        let is_wrong = !parameter.is_correct
            || (value - parameter.default_value).abs() > MIN_RELATIVE_ERROR * parameter.default_value;
        is_wrong
            .then(|| (parameter.source)(value))
            .flatten()
            .map(|source| Mutant::new(vec![parameter.mistake(value)], source))
    });
    let counted = shader.into_iter().flat_map(step_count_mutants);
    fitted.collect::<Vec<_>>().into_iter().chain(counted).collect()
}

/// All numbers of a scene and of its shader.
fn parameters(scene: &Scene, frame_time: FrameTime, shader: Option<&MarkedShader>) -> Vec<Parameter> {
    let mut parameters = of_scene(scene, frame_time);
    parameters.extend(shader.into_iter().flat_map(of_shader));
    parameters
}

impl Parameter {
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
    let counted = shader.into_iter().flat_map(step_count_mutants);
    fitted.chain(counted.flat_map(|mutant| mutant.mistakes)).collect()
}

/// Mutants whose loop over the cells of a grid ends too early, one for each number of steps.
fn step_count_mutants(shader: &MarkedShader) -> Vec<Mutant> {
    let mutant = |steps: i32| {
        let shader = shader.replaced(&[(Slot::GridSteps, &steps.to_string())])?;
        let mistake = KnownMistake::new(
            "too-few-grid-steps",
            format!("the grid traversal stops after {steps} cells"),
        );
        Some(Mutant::new(vec![mistake], MutantSource::Shader(shader)))
    };
    (2..=MAX_STEPS).filter_map(mutant).collect()
}

/// The distance of two images: the sum of absolute differences of components clamped to [0, 1].
fn distance(one: &Image, other: &Image) -> f64 {
    let pairs = one.pixels().iter().zip(other.pixels());
    let parts = pairs.flat_map(|(one, other)| (0..3).map(|part| [one[part], other[part]]));
    parts
        .map(|pair| {
            let [one, other] = pair.map(|part| f64::from(part).clamp(0.0, 1.0));
            (one - other).abs()
        })
        .sum()
}

/// Returns the value that minimizes the distance to the image: first among the multiples, then between the
/// neighbors of the best. `None` if the number is unrelated to too many of the wrong pixels: none of the
/// multiples changes them.
fn best_value(parameter: &Parameter, wrong_image: &WrongImage, correct: &Image) -> Option<f64> {
    let render = |value| (parameter.source)(value)?.render(wrong_image.view);
    let values = MULTIPLES.map(|multiple| parameter.default_value * multiple);
    let images = values.map(render);
    let is_out_of_reach = |&at: &usize| {
        let mut images = images.iter().flatten();
        differs(at, wrong_image.small, correct) && !images.any(|image| differs(at, image, correct))
    };
    let pixels = correct.pixels().len();
    let out_of_reach = (0..pixels).filter(is_out_of_reach).count() as u64;
    if out_of_reach > max_unexplained(wrong_image.differing, pixels) {
        return None;
    }
    let from = |image: &Image| distance(image, wrong_image.small);
    let distances = images.map(|image| image.as_ref().map_or(f64::INFINITY, from));
    let (best, _) = distances
        .iter()
        .enumerate()
        .min_by(|(_, one), (_, other)| one.total_cmp(other))?;
    let low = values[best.saturating_sub(1)];
    let high = values[(best + 1).min(values.len() - 1)];
    golden_section_search(low, high, |value| Some(from(&render(value)?)))
}

/// Returns where a function with one minimum between two numbers is least; `None` if it has no value.
fn golden_section_search(mut low: f64, mut high: f64, f: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let ratio = 0.5 * (5.0f64.sqrt() - 1.0);
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut values = [f(inner[0])?, f(inner[1])?];
    for _ in 0..SEARCH_ITERATIONS {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            values = [f(inner[0])?, values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            values = [values[1], f(inner[1])?];
        }
    }
    Some(if values[0] < values[1] { inner[0] } else { inner[1] })
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

/// Describes a wrong value, given the name of the number, the value and the scene's value.
type Describe = fn(&str, &str, &str) -> String;

/// A wrong number.
const VALUE: Describe = |what, value, expected| format!("{what} is {value}; the scene has {expected}");

/// A wrong brightness, relative to the scene's.
const BRIGHTNESS: Describe = |what, value, _| format!("{what} is {value} times as bright as the scene's");

/// A number of the scene.
struct SceneNumber {
    /// The id of the mistake of having another value.
    id: &'static str,
    /// The name of the number.
    what: String,
    describe: Describe,
    value: f64,
    set: Set,
}

impl SceneNumber {
    fn new(
        id: &'static str,
        what: impl Into<String>,
        value: f64,
        set: impl Fn(&mut Scene, f64) + Sync + 'static,
    ) -> Self {
        Self {
            id,
            what: what.into(),
            describe: VALUE,
            value,
            set: Box::new(set),
        }
    }

    /// The brightness of `what`, relative to the scene's.
    fn brightness(
        id: &'static str,
        what: impl Into<String>,
        set: impl Fn(&mut Scene, f64) + Sync + 'static,
    ) -> Self {
        Self {
            describe: BRIGHTNESS,
            ..Self::new(id, what, 1.0, set)
        }
    }

    fn parameter(self, scene: Scene, frame_time: FrameTime) -> Parameter {
        let (what, describe, expected) = (self.what, self.describe, three_digits(self.value));
        Parameter {
            id: self.id,
            description: Box::new(move |value| describe(&what, &three_digits(value), &expected)),
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
    let mut numbers = vec![of_projection(scene.camera.projection)];
    numbers.push(SceneNumber::new(
        "wrong-gamma",
        "gamma",
        scene.film.gamma,
        |scene, gamma| scene.film.gamma = gamma,
    ));
    numbers.extend(of_lights(scene));
    numbers.extend(of_objects(scene));
    let parameters = numbers
        .into_iter()
        .map(|number| number.parameter(scene.clone(), frame_time));
    parameters.collect()
}

fn of_projection(projection: Projection) -> SceneNumber {
    match projection {
        Projection::Pinhole { screen_distance } => SceneNumber::new(
            "wrong-screen-distance",
            "the screen distance",
            screen_distance,
            |scene, screen_distance| scene.camera.projection = Projection::Pinhole { screen_distance },
        ),
        Projection::Parallel { width } => SceneNumber::new(
            "wrong-projection-width",
            "the width of the parallel projection",
            width,
            |scene, width| scene.camera.projection = Projection::Parallel { width },
        ),
    }
}

fn of_lights(scene: &Scene) -> Vec<SceneNumber> {
    let mut numbers = Vec::new();
    for (index, light) in scene.lights.iter().enumerate() {
        let (color, radius) = (light.color, light.radius);
        let which = format!("the light at {}", place(light.position));
        numbers.push(SceneNumber::brightness(
            "wrong-brightness",
            which.clone(),
            move |scene, factor| {
                scene.lights[index].color = color.map(|part| factor * part);
            },
        ));
        if radius > 0.0 {
            numbers.push(SceneNumber::new(
                "wrong-light-radius",
                format!("the radius of {which}"),
                radius,
                move |scene, radius| scene.lights[index].radius = radius,
            ));
        }
    }
    let ambient = scene.ambient;
    numbers.push(SceneNumber::brightness(
        "wrong-ambient-light",
        "the ambient light",
        move |scene, factor| scene.ambient = ambient.map(|part| factor * part),
    ));
    numbers
}

fn of_objects(scene: &Scene) -> Vec<SceneNumber> {
    let mut numbers = Vec::new();
    for (index, object) in scene.objects.iter().enumerate() {
        if let Model::Glass { ior, .. } = object.material.model {
            numbers.push(SceneNumber::new(
                "wrong-ior",
                "the refractive index",
                ior,
                move |scene, new| {
                    if let Model::Glass { ior, .. } = &mut scene.objects[index].material.model {
                        *ior = new;
                    }
                },
            ));
        }
        if let Shape::Sphere { center, radius } = object.shape
            && scene.objects.len() <= MAX_OBJECTS
        {
            numbers.push(SceneNumber::new(
                "wrong-radius",
                format!("the radius of the sphere at {}", place(center)),
                radius,
                move |scene, new| {
                    if let Shape::Sphere { radius, .. } = &mut scene.objects[index].shape {
                        *radius = new;
                    }
                },
            ));
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
    let parameter =
        |(id, describe, slot, template, default_value): (_, fn(&str) -> String, _, &'static str, _)| {
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
