//! Mistakes in one number: whatever it is, it is found by bringing the picture as near as it comes.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_scene::{Model, Moment, Projection, Scene, Shape};

use super::Named;
use super::edit::edited;
use super::look::{Looked, differs, left_over};
use super::suspect::{Made, Suspect};

/// A number that may be another.
struct Knob {
    name: &'static str,
    /// What is said of a value.
    says: Box<dyn Fn(f64) -> String + Sync>,
    /// What others are tried as multiples of.
    usual: f64,
    /// Whether that is what it should be.
    is_right: bool,
    made: Box<dyn Fn(f64) -> Option<Made> + Sync>,
}

/// The multiples of the usual value between which the best one is looked for.
const MULTIPLES: [f64; 11] = [0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.35, 2.0, 4.0, 16.0, 64.0];

/// Each step brings the ends nearer to each other by the golden ratio: 25 leave a hundred thousandth.
const STEPS: usize = 25;

/// A number that is nearer to the right one than this share of it is not said to be another.
const OTHER: f64 = 0.01;

/// With more surfaces than this, their radii are left as they are.
const MAX_OBJECTS: usize = 16;

/// As many steps through a grid are tried.
const MAX_STEPS: i32 = 16;

/// All that explain a picture as well as one number can, each with the number that does it best.
pub(super) fn suspects(
    scene: &Scene,
    moment: Moment,
    text: Option<&str>,
    looked_at: &Looked,
    right: &Image,
) -> Vec<Suspect> {
    let mut knobs = of_scene(scene, moment);
    if let Some(text) = text {
        knobs.extend(of_shader(text));
    }
    let fitted = knobs.par_iter().filter_map(|knob| {
        let value = best(knob, looked_at, right)?;
        let named = Named {
            name: knob.name,
            says: (knob.says)(value).into(),
        };
        let is_other = !knob.is_right || (value - knob.usual).abs() > OTHER * knob.usual;
        is_other
            .then(|| (knob.made)(value))
            .flatten()
            .map(|made| Suspect::new(vec![named], made))
    });
    let counted = text.into_iter().flat_map(counts);
    fitted.collect::<Vec<_>>().into_iter().chain(counted).collect()
}

/// A loop over the cells of a grid that ends too early, at each number of steps.
fn counts(text: &str) -> Vec<Suspect> {
    let suspect = |steps: i32| {
        let to = format!("for (int i = 0; i < {steps}; i++) {{");
        let text = edited(text, &[("for (int i = 0; i < steps; i++) {", &to)])?;
        let named = Named {
            name: "too-few-steps",
            says: format!("goes through {steps} cells of the grid at most").into(),
        };
        Some(Suspect::new(vec![named], Made::Shader(text)))
    };
    (2..=MAX_STEPS).filter_map(suspect).collect()
}

/// How far apart two pictures are, as they are shown.
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

/// The value that comes nearest to the picture: among the multiples first, then between the neighbours of the best. None where the number has
/// nothing to do with too many of the wrong pixels: none of the multiples changes them.
fn best(knob: &Knob, looked_at: &Looked, right: &Image) -> Option<f64> {
    let painted = |value| (knob.made)(value)?.paint(looked_at.view);
    let values = MULTIPLES.map(|multiple| knob.usual * multiple);
    let pictures = values.map(painted);
    let is_out_of_reach = |&at: &usize| {
        let mut pictures = pictures.iter().flatten();
        differs(at, looked_at.small, right) && !pictures.any(|picture| differs(at, picture, right))
    };
    let pixels = right.pixels().len();
    let out_of_reach = (0..pixels).filter(is_out_of_reach).count() as u64;
    if out_of_reach > left_over(looked_at.differing, pixels) {
        return None;
    }
    let from = |picture: &Image| distance(picture, looked_at.small);
    let tried = pictures.map(|picture| picture.as_ref().map_or(f64::INFINITY, from));
    let distance = |value| Some(from(&painted(value)?));
    let (at, _) = tried
        .iter()
        .enumerate()
        .min_by(|(_, one), (_, other)| one.total_cmp(other))?;
    let mut low = values[at.saturating_sub(1)];
    let mut high = values[(at + 1).min(values.len() - 1)];
    let ratio = 0.5 * (5.0f64.sqrt() - 1.0);
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut found = [distance(inner[0])?, distance(inner[1])?];
    for _ in 0..STEPS {
        if found[0] < found[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            found = [distance(inner[0])?, found[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            found = [found[1], distance(inner[1])?];
        }
    }
    Some(if found[0] < found[1] { inner[0] } else { inner[1] })
}

/// To three digits.
fn told(value: f64) -> String {
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

/// How a number is set in a scene.
type Set = Box<dyn Fn(&mut Scene, f64) + Sync>;

/// Numbers that the scene holds: a name, what they are called, what they are, and how they are set.
fn of_scene(scene: &Scene, moment: Moment) -> Vec<Knob> {
    let mut numbers: Vec<(&'static str, String, f64, Set)> = Vec::new();
    let mut add = |name, what: &str, usual, set: Set| numbers.push((name, what.to_owned(), usual, set));
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
    let knob = |(name, what, usual, set): (&'static str, String, f64, Set)| {
        let scene = scene.clone();
        Knob {
            name,
            says: Box::new(move |value| format!("has {} for {what}, which is {}", told(value), told(usual))),
            usual,
            is_right: true,
            made: Box::new(move |value| {
                let mut scene = scene.clone();
                set(&mut scene, value);
                scene.release_changed_scatters();
                Some(Made::Scene(Box::new(scene), moment))
            }),
        }
    };
    numbers.into_iter().map(knob).collect()
}

/// Numbers that the scene has not, and a shader may: where they come in.
fn of_shader(text: &str) -> Vec<Knob> {
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
    let knobs = all.into_iter().filter_map(|(name, says, edit, usual)| {
        let text = edited(text, &[edit])?;
        Some(Knob {
            name,
            says: Box::new(move |value| format!("{says} {}", told(value))),
            usual,
            is_right: false,
            made: Box::new(move |value| Some(Made::Shader(text.replace("NUMBER", &format!("{value:?}"))))),
        })
    });
    knobs.collect()
}
