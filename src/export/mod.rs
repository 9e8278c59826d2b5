//! The shader that paints a scene, in the course's style, holding only what the scene requires.

mod background;
mod camera;
mod figure;
mod film;
mod intersection;
mod light;
mod parts;
mod path;
mod quadric;
mod sampler;
mod structure;

use self::parts::Parts;
use crate::scene::{Integrator, Requirements, Sampler, Scene};

/// A `ShaderToy` shader that paints the scene.
///
/// # Errors
/// What the scene uses that cannot be written yet, in the words of the scene file.
pub fn shader(scene: &Scene) -> Result<String, String> {
    let requirements = Requirements::of(scene);
    let film = &scene.film;
    if requirements.motion {
        return Err("motion".to_owned());
    }
    if film.integrator == Integrator::Path {
        return Err("the integrator \"path\"".to_owned());
    }
    if requirements.soft_shadows {
        return Err("a light with a radius".to_owned());
    }
    if matches!(film.sampler, Sampler::Stratified | Sampler::Sobol) {
        return Err("the samplers \"stratified\" and \"sobol\"".to_owned());
    }
    let parts = Parts::of(scene)?;
    Ok(parts.text(scene))
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

fn vector([x, y, z]: [f64; 3]) -> String {
    format!("vec3({}, {}, {})", number(x), number(y), number(z))
}
