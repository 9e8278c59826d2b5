//! What of the course's words a scene needs, and the order in which they stand.

use super::{background, camera, figure, sampler, vector};
use crate::scene::{Model, Object, Point, Quadric, Sampler, Scene, Shape};

/// What of the course's words a scene needs.
pub(super) struct Parts<'a> {
    pub(super) spheres: Vec<(Point, f64, &'a Object)>,
    pub(super) planes: Vec<(Point, Point, &'a Object)>,
    pub(super) quadrics: Vec<(Quadric, &'a Object)>,
    /// Whether anything is checkered.
    pub(super) checkers: bool,
    /// The models in use, in the order in which they are first met.
    pub(super) models: Vec<Model>,
}

pub(super) fn word(model: &Model) -> Option<&'static str> {
    match model {
        Model::Facing => Some("FACING"),
        Model::Lambert => Some("LAMBERT"),
        Model::Diffuse => Some("DIFFUSE"),
        Model::Mirror => Some("MIRROR"),
        _ => None,
    }
}

impl<'a> Parts<'a> {
    pub(super) fn of(scene: &'a Scene) -> Result<Self, String> {
        let mut parts = Self {
            spheres: Vec::new(),
            planes: Vec::new(),
            quadrics: Vec::new(),
            checkers: false,
            models: Vec::new(),
        };
        for object in &scene.objects {
            let model = object.material.model;
            if word(&model).is_none() {
                return Err("the models \"disney\", \"glossy\", \"glass\" and \"emitter\"".to_owned());
            }
            parts.checkers |= object.material.checker.is_some();
            if !parts.models.contains(&model) {
                parts.models.push(model);
            }
            match object.shape {
                Shape::Sphere { center, radius } => parts.spheres.push((center, radius, object)),
                Shape::Plane { point, normal } => parts.planes.push((point, normal, object)),
                Shape::Quadric(quadric) => parts.quadrics.push((quadric, object)),
            }
        }
        Ok(parts)
    }

    pub(super) fn uses(&self, model: Model) -> bool {
        self.models.contains(&model)
    }

    pub(super) fn lit(&self) -> bool {
        self.uses(Model::Lambert) || self.uses(Model::Diffuse)
    }

    /// Where there is one model alone, nothing says which.
    pub(super) fn names_models(&self) -> bool {
        self.models.len() > 1
    }

    pub(super) fn text(&self, scene: &Scene) -> String {
        let mut pieces = vec![self.constants(scene)];
        if !scene.objects.is_empty() {
            pieces.push(self.structures(scene));
        }
        if scene.film.sampler != Sampler::Center {
            pieces.push(sampler::random(scene.film.sampler).to_owned());
        }
        if !scene.objects.is_empty() {
            pieces.push(self.scene(scene));
            pieces.extend(self.intersections());
        }
        pieces.push(background::background(&scene.background));
        if self.lit() {
            pieces.extend(self.shading(scene));
        }
        pieces.push(self.trace());
        pieces.extend(figure::functions(&scene.figures));
        pieces.push(camera::camera(scene));
        pieces.push(self.main(scene));
        pieces.join("\n")
    }

    pub(super) fn constants(&self, scene: &Scene) -> String {
        let title = match scene.title.lines().next() {
            None | Some("") => "A scene",
            Some(title) => title,
        };
        let mut text = format!("// {title}\n\nconst float NO_HIT = 1.0e30;\n");
        let mut say = |line: String| text.push_str(&line);
        if scene.film.samples > 1 {
            say(format!("const int SAMPLES = {};\n", scene.film.samples));
        }
        if !self.spheres.is_empty() {
            say(format!("const int SPHERES = {};\n", self.spheres.len()));
        }
        if !self.planes.is_empty() {
            say(format!("const int PLANES = {};\n", self.planes.len()));
        }
        if !self.quadrics.is_empty() {
            say(format!("const int QUADRICS = {};\n", self.quadrics.len()));
        }
        if self.lit() && !scene.lights.is_empty() {
            say(format!("const int LIGHTS = {};\n", scene.lights.len()));
        }
        if self.lit() {
            say(format!("const vec3 AMBIENT = {};\n", vector(scene.ambient)));
        }
        if self.uses(Model::Mirror) {
            say(format!("const int MAX_DEPTH = {};\n", scene.film.max_depth));
        }
        if self.names_models() {
            for (index, model) in self.models.iter().enumerate() {
                say(format!(
                    "const int {} = {index};\n",
                    word(model).unwrap_or_default()
                ));
            }
        }
        text
    }
}
