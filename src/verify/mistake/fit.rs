//! Mistakes in one number, whose value is found by minimizing the distance to the wrong image.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_scene::{FrameTime, Model, Projection, Scene, Shape};

use super::Named;
use crate::mistake::mutant::edited;
use crate::mistake::mutant::{Mutant, MutantSource};
use crate::mistake::thumbnail::{WrongImage, differs, max_left_over};

/// A number that may be wrong.
struct Parameter {
    name: &'static str,
    /// Describes the mistake for a value.
    says: Box<dyn Fn(f64) -> String + Sync>,
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
    text: Option<&str>,
    wrong_image: &WrongImage,
    correct: &Image,
) -> Vec<Mutant> {
    let mut parameters = of_scene(scene, frame_time);
    if let Some(text) = text {
        parameters.extend(of_shader(text));
    }
    let fitted = parameters.par_iter().filter_map(|parameter| {
        let value = best_value(parameter, wrong_image, correct)?;
        let named = Named {
            name: parameter.name,
            says: (parameter.says)(value).into(),
        };
        let is_wrong = !parameter.is_correct
            || (value - parameter.default_value).abs() > MIN_RELATIVE_ERROR * parameter.default_value;
        is_wrong
            .then(|| (parameter.source)(value))
            .flatten()
            .map(|source| Mutant::new(vec![named], source))
    });
    let counted = text.into_iter().flat_map(step_count_mutants);
    fitted.collect::<Vec<_>>().into_iter().chain(counted).collect()
}

/// Mutants whose loop over the cells of a grid ends too early, one for each number of steps.
fn step_count_mutants(text: &str) -> Vec<Mutant> {
    let mutant = |steps: i32| {
        let to = format!("for (int i = 0; i < {steps}; i++) {{");
        let text = edited(text, &[("for (int i = 0; i < steps; i++) {", &to)])?;
        let named = Named {
            name: "too-few-steps",
            says: format!("goes through {steps} cells of the grid at most").into(),
        };
        Some(Mutant::new(vec![named], MutantSource::Shader(text)))
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
/// neighbors of the best. None where the number is unrelated to too many of the wrong pixels: none of the
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
    if out_of_reach > max_left_over(wrong_image.differing, pixels) {
        return None;
    }
    let from = |image: &Image| distance(image, wrong_image.small);
    let image_distances = images.map(|image| image.as_ref().map_or(f64::INFINITY, from));
    let distance = |value| Some(from(&render(value)?));
    let (at, _) = image_distances
        .iter()
        .enumerate()
        .min_by(|(_, one), (_, other)| one.total_cmp(other))?;
    let mut low = values[at.saturating_sub(1)];
    let mut high = values[(at + 1).min(values.len() - 1)];
    let ratio = 0.5 * (5.0f64.sqrt() - 1.0);
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut distances = [distance(inner[0])?, distance(inner[1])?];
    for _ in 0..SEARCH_ITERATIONS {
        if distances[0] < distances[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            distances = [distance(inner[0])?, distances[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            distances = [distances[1], distance(inner[1])?];
        }
    }
    Some(if distances[0] < distances[1] {
        inner[0]
    } else {
        inner[1]
    })
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

/// Sets a number in a scene.
type Set = Box<dyn Fn(&mut Scene, f64) + Sync>;

/// The numbers of the scene: the name of the mistake, what the number is called, its value, and how it is
/// set.
fn of_scene(scene: &Scene, frame_time: FrameTime) -> Vec<Parameter> {
    let mut numbers: Vec<(&'static str, String, f64, Set)> = Vec::new();
    let mut add =
        |name, what: &str, default_value, set: Set| numbers.push((name, what.to_owned(), default_value, set));
    match scene.camera.projection {
        Projection::Pinhole { screen_distance } => {
            let set: Set = Box::new(|scene, screen_distance| {
                scene.camera.projection = Projection::Pinhole { screen_distance };
            });
            add(
                "screen-distance",
                "the distance of the screen",
                screen_distance,
                set,
            );
        }
        Projection::Parallel { width } => {
            let set: Set = Box::new(|scene, width| scene.camera.projection = Projection::Parallel { width });
            add("width-of-the-picture", "the width of the picture", width, set);
        }
    }
    let gamma = scene.film.gamma;
    add(
        "another-gamma",
        "the gamma",
        gamma,
        Box::new(|scene, gamma| scene.film.gamma = gamma),
    );
    for (index, light) in scene.lights.iter().enumerate() {
        let color = light.color;
        let set: Set = Box::new(move |scene, factor| {
            scene.lights[index].color = color.map(|part| factor * part);
        });
        add(
            "another-brightness",
            &format!("the brightness of light {}", index + 1),
            1.0,
            set,
        );
        if light.radius > 0.0 {
            let set: Set = Box::new(move |scene, radius| scene.lights[index].radius = radius);
            add("another-light-radius", "the light's radius", light.radius, set);
        }
    }
    let ambient = scene.ambient;
    let set: Set = Box::new(move |scene, factor| scene.ambient = ambient.map(|part| factor * part));
    add(
        "another-ambient-light",
        "the brightness of the ambient light",
        1.0,
        set,
    );
    for (index, object) in scene.objects.iter().enumerate() {
        if let Model::Glass { ior, .. } = object.material.model {
            let set: Set = Box::new(move |scene, new| {
                if let Model::Glass { ior, .. } = &mut scene.objects[index].material.model {
                    *ior = new;
                }
            });
            add("another-index", "the index of refraction", ior, set);
        }
        if let Shape::Sphere { radius, .. } = object.shape
            && scene.objects.len() <= MAX_OBJECTS
        {
            let set: Set = Box::new(move |scene, new| {
                if let Shape::Sphere { radius, .. } = &mut scene.objects[index].shape {
                    *radius = new;
                }
            });
            add(
                "another-radius",
                &format!("the radius of sphere {}", index + 1),
                radius,
                set,
            );
        }
    }
    let parameter = |(name, what, default_value, set): (&'static str, String, f64, Set)| {
        let scene = scene.clone();
        Parameter {
            name,
            says: Box::new(move |value| {
                format!(
                    "has {} for {what}, which is {}",
                    three_digits(value),
                    three_digits(default_value)
                )
            }),
            default_value,
            is_correct: true,
            source: Box::new(move |value| {
                let mut scene = scene.clone();
                set(&mut scene, value);
                scene.release_changed_scatters();
                Some(MutantSource::Scene(Box::new(scene), frame_time))
            }),
        }
    };
    numbers.into_iter().map(parameter).collect()
}

/// Numbers that a shader may have but the scene does not, and where they are inserted.
fn of_shader(text: &str) -> Vec<Parameter> {
    let fall = "sum += lights[i].color * … * cosine;";
    let falls = "sum += lights[i].color * … * cosine * NUMBER / dot(lights[i].position - hit.point, lights[i].position - hit.point);";
    let of_one = "throughput *= NUMBER;";
    let all = [
        (
            "light-falls-off",
            "lets light fall off with the square of its distance, which the scene does not: by",
            (fall, falls),
            10.0,
        ),
        (
            "mirrors-of-one-colour",
            "has all mirrors reflect alike: by",
            ("throughput *= hit.color;", of_one),
            0.5,
        ),
    ];
    let parameters = all.into_iter().filter_map(|(name, says, edit, default_value)| {
        let text = edited(text, &[edit])?;
        Some(Parameter {
            name,
            says: Box::new(move |value| format!("{says} {}", three_digits(value))),
            default_value,
            is_correct: false,
            source: Box::new(move |value| {
                Some(MutantSource::Shader(
                    text.replace("NUMBER", &format!("{value:?}")),
                ))
            }),
        })
    });
    parameters.collect()
}
