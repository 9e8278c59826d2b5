//! The shader that paints a scene, in the course's style, holding only what the scene requires.

mod background;
mod camera;
mod disney;
mod figure;
mod film;
mod grid;
mod intersection;
mod light;
mod material;
mod motion;
mod parts;
mod path;
mod quadric;
mod sampler;
mod structure;
mod whitted;

use self::parts::Parts;
use crate::{Sampler, Scene};

/// A `ShaderToy` shader that paints the scene.
///
/// # Errors
/// What the scene uses that cannot be written yet, in the words of the scene file.
pub fn shader(scene: &Scene) -> Result<String, String> {
    if matches!(scene.film.sampler, Sampler::Stratified | Sampler::Sobol) {
        return Err("the samplers \"stratified\" and \"sobol\"".to_owned());
    }
    Ok(Parts::of(scene).text(scene))
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

fn vector([x, y, z]: [f64; 3]) -> String {
    format!("vec3({}, {}, {})", number(x), number(y), number(z))
}
