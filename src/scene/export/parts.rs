//! What of the course's words a scene needs, and the order in which they stand.

use super::material::{GLASS, Kind, REFLECTIVE};
use super::{background, camera, disney, figure, motion, quadric, sampler, vector};
use crate::{Integrator, Object, Point, Quadric, Requirements, Sampler, Scatter, Scattered, Scene, Shape};

/// What of the course's words a scene needs.
pub(super) struct Parts<'a> {
    /// Where light is drawn from emitters, they come first.
    pub(super) spheres: Vec<(Point, f64, &'a Object)>,
    pub(super) planes: Vec<(Point, Point, &'a Object)>,
    pub(super) quadrics: Vec<(Quadric, &'a Object)>,
    /// Scatters that rest; the spheres of others stand among the rest.
    pub(super) grids: Vec<&'a Scatter>,
    /// Whether anything is checkered.
    pub(super) checkers: bool,
    /// The models in use, in the order in which they are first met.
    pub(super) models: Vec<Kind>,
    pub(super) traces_paths: bool,
}

impl<'a> Parts<'a> {
    pub(super) fn of(scene: &'a Scene) -> Self {
        let mut parts = Self {
            spheres: Vec::new(),
            planes: Vec::new(),
            quadrics: Vec::new(),
            grids: Vec::new(),
            checkers: false,
            models: Vec::new(),
            traces_paths: scene.film.integrator == Integrator::Path,
        };
        let mut in_grids = vec![false; scene.objects.len()];
        for Scattered { scatter, objects } in &scene.scatters {
            let shines = parts.traces_paths && Kind::of(&scatter.material.model) == Kind::Emitter;
            if scatter.motion.is_none() && !shines {
                in_grids[objects.clone()].fill(true);
                parts.grids.push(scatter);
            }
        }
        for (object, in_grid) in scene.objects.iter().zip(in_grids) {
            let kind = Kind::of(&object.material.model);
            parts.checkers |= object.material.checker.is_some();
            if !parts.models.contains(&kind) {
                parts.models.push(kind);
            }
            if in_grid {
                continue;
            }
            match object.shape {
                Shape::Sphere { center, radius } => parts.spheres.push((center, radius, object)),
                Shape::Plane { point, normal } => parts.planes.push((point, normal, object)),
                Shape::Quadric(quadric) => parts.quadrics.push((quadric, object)),
            }
        }
        if parts.traces_paths {
            parts.spheres.sort_by_key(|(_, _, object)| !shines(object));
        }
        parts
    }

    pub(super) fn uses(&self, model: Kind) -> bool {
        self.models.contains(&model)
    }

    pub(super) fn uses_any(&self, models: &[Kind]) -> bool {
        models.iter().any(|&model| self.uses(model))
    }

    /// Whether lights fall on anything.
    pub(super) fn lit(&self) -> bool {
        !self.traces_paths && self.uses_any(&REFLECTIVE)
    }

    /// Where there is one model alone, nothing says which.
    pub(super) fn names_models(&self) -> bool {
        self.models.len() > 1
    }

    pub(super) fn text(&self, scene: &Scene) -> String {
        let moves = Requirements::of(scene).motion;
        let mut pieces = vec![self.constants(scene)];
        if !scene.objects.is_empty() {
            if self.uses(Kind::Disney) {
                pieces.push(disney::STRUCTURE.to_owned());
            }
            pieces.push(self.structures(scene));
        }
        if scene.film.sampler != Sampler::Center {
            pieces.push(sampler::random(scene.film.sampler));
        }
        if !scene.objects.is_empty() {
            pieces.extend(motion::functions(if moves { &scene.motions } else { &[] }));
            pieces.extend(quadric::functions(
                self.quadrics.iter().map(|(quadric, _)| quadric),
            ));
            pieces.push(self.scene(scene));
            pieces.extend(self.intersections(scene.film.sampler));
        }
        pieces.push(background::background(&scene.background));
        if self.lit() {
            pieces.extend(self.shading(scene));
        }
        pieces.extend(self.trace());
        pieces.extend(figure::functions(&scene.figures));
        pieces.push(camera::camera(scene));
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
        let title = match scene.title.lines().next() {
            None | Some("") => "A scene",
            Some(title) => title,
        };
        let mut text = format!("// {title}\n\nconst float NO_HIT = 1.0e30;\n");
        let mut say = |line: String| text.push_str(&line);
        if self.traces_paths || self.uses_any(&[Kind::Diffuse, Kind::Glossy, Kind::Disney]) {
            say("const float PI = 3.14159265359;\n".to_owned());
        }
        let shine = self.spheres.iter().filter(|(_, _, object)| shines(object));
        let emitters = if self.traces_paths { shine.count() } else { 0 };
        let lights = if self.lit() { scene.lights.len() } else { 0 };
        for (what, count) in [
            ("SAMPLES", scene.film.samples as usize),
            ("SPHERES", self.spheres.len()),
            ("PLANES", self.planes.len()),
            ("QUADRICS", self.quadrics.len()),
            ("GRIDS", self.grids.len()),
            ("EMITTERS", emitters),
            ("LIGHTS", lights),
        ] {
            if count > usize::from(what == "SAMPLES") {
                say(format!("const int {what} = {count};\n"));
            }
        }
        if self.lit() {
            say(format!("const vec3 AMBIENT = {};\n", vector(scene.ambient)));
        }
        if self.traces_paths || self.uses(Kind::Mirror) || self.uses_any(&GLASS) {
            say(format!("const int MAX_DEPTH = {};\n", scene.film.max_depth));
        }
        if self.names_models() {
            for (index, model) in self.models.iter().enumerate() {
                say(format!("const int {} = {index};\n", model.word()));
            }
        }
        text
    }
}

fn shines(object: &Object) -> bool {
    Kind::of(&object.material.model) == Kind::Emitter
}
