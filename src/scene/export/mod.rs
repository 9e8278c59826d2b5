//! Export of the shader that renders a scene, in the course's style, with only the code that the scene
//! requires.

mod expression;
mod image;
mod integrator;
mod intersection;
mod parts;
mod pattern;
mod shading;
mod slot;
mod structure;

pub use slot::{MarkedShader, Slot};
use thiserror::Error;

use self::expression::{motion_functions, vector};
use self::image::{background_function, camera_function, figure_functions, random_functions};
use self::intersection::quadric_functions;
use self::parts::{GLASS, Kind, Parts, is_emitter};
use self::shading::DISNEY_STRUCTURE;
use crate::{Requirements, Sampler, Scene};

/// A feature of a scene that exported shaders do not support.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{0} cannot be exported")]
pub struct UnsupportedFeature(pub &'static str);

/// Returns a ShaderToy shader that renders the scene.
///
/// # Errors
/// If the scene has a feature that no exported shader supports.
pub fn shader(scene: &Scene) -> Result<String, UnsupportedFeature> {
    Ok(marked_shader(scene)?.text)
}

/// Returns the same shader with the names of its parts.
///
/// # Errors
/// If the scene has a feature that no exported shader supports.
pub fn marked_shader(scene: &Scene) -> Result<MarkedShader, UnsupportedFeature> {
    if matches!(scene.film.sampler, Sampler::Stratified | Sampler::Sobol) {
        return Err(UnsupportedFeature(
            "a scene with the sampler `stratified` or `sobol`",
        ));
    }
    let title = match scene.title.lines().next() {
        None | Some("") => "A scene",
        Some(title) => title,
    };
    let template = Parts::new(scene).template(scene);
    Ok(MarkedShader::new(format!("// {title}\n\n"), &template))
}

impl Parts<'_> {
    fn template(&self, scene: &Scene) -> String {
        let moves = Requirements::new(scene).motion;
        let mut pieces = vec![self.constants(scene)];
        if !scene.objects.is_empty() {
            if self.uses(Kind::Disney) {
                pieces.push(DISNEY_STRUCTURE.to_owned());
            }
            pieces.extend(self.patterns.structure());
            pieces.push(self.structures(scene));
        }
        if scene.film.sampler != Sampler::Center {
            pieces.push(random_functions(scene.film.sampler));
        }
        if !scene.objects.is_empty() {
            pieces.extend(motion_functions(if moves { &scene.motions } else { &[] }));
            pieces.extend(quadric_functions(
                self.quadrics.iter().map(|(quadric, _)| quadric),
            ));
            pieces.push(self.scene(scene));
            pieces.extend(self.intersections(scene.film.sampler));
        }
        pieces.push(background_function(&scene.background));
        if self.is_lit() {
            pieces.extend(self.shading(scene));
        }
        pieces.extend(self.trace());
        pieces.extend(figure_functions(&scene.figures));
        pieces.push(camera_function(scene));
        pieces.push(self.main(scene));
        pieces.join("\n")
    }

    fn trace(&self) -> Vec<String> {
        if self.models.is_empty() {
            let text = "vec3 trace(vec3 origin, vec3 direction) {\n    return background(direction);\n}\n";
            return vec![text.to_owned()];
        }
        if self.traces_paths {
            self.path()
        } else {
            self.whitted()
        }
    }

    fn constants(&self, scene: &Scene) -> String {
        let mut text = "const float NO_HIT = 1.0e30;\n".to_owned();
        let mut push = |line: String| text.push_str(&line);
        if self.traces_paths || self.uses_any(&[Kind::Diffuse, Kind::Glossy, Kind::Disney]) {
            push("const float PI = 3.14159265359;\n".to_owned());
        }
        let shine = self.spheres.iter().filter(|(_, _, object)| is_emitter(object));
        let emitters = if self.traces_paths { shine.count() } else { 0 };
        let lights = if self.is_lit() { scene.lights.len() } else { 0 };
        for (what, count) in [
            ("SAMPLES", scene.film.samples as usize),
            ("SPHERES", self.spheres.len()),
            ("PLANES", self.planes.len()),
            ("QUADRICS", self.quadrics.len()),
            ("BOXES", self.boxes.len()),
            ("GRIDS", self.grids.len()),
            ("EMITTERS", emitters),
            ("LIGHTS", lights),
        ] {
            if count > usize::from(what == "SAMPLES") {
                push(format!("const int {what} = {count};\n"));
            }
        }
        if self.is_lit() {
            push(format!("const vec3 AMBIENT = {};\n", vector(scene.ambient)));
        }
        if self.traces_paths || self.uses(Kind::Mirror) || self.uses_any(&GLASS) {
            push(format!("const int MAX_DEPTH = {};\n", scene.film.max_depth));
        }
        if self.has_model_ids() {
            for (index, model) in self.models.iter().enumerate() {
                push(format!("const int {} = {index};\n", model.glsl_name()));
            }
        }
        text
    }
}
