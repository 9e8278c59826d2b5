//! The code fragments that a scene needs.

use super::pattern::{Patterns, is_own};
use crate::{
    Cuboid, Fresnel, Integrator, Model, Object, Point, Quadric, Scatter, ScatterObjects, Scene, Shape,
};

/// A reflection model without its parameters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Facing,
    Lambert,
    Diffuse,
    Glossy,
    Disney,
    Mirror,
    Glass,
    Schlick,
    Emitter,
}

/// The models with a BRDF.
pub(super) const REFLECTIVE: [Kind; 4] = [Kind::Lambert, Kind::Diffuse, Kind::Glossy, Kind::Disney];

/// The models that refract rays.
pub(super) const GLASS: [Kind; 2] = [Kind::Glass, Kind::Schlick];

impl Kind {
    pub(super) fn from_model(model: &Model) -> Self {
        match model {
            Model::Facing => Self::Facing,
            Model::Lambert => Self::Lambert,
            Model::Diffuse => Self::Diffuse,
            Model::Glossy { .. } => Self::Glossy,
            Model::Disney(_) => Self::Disney,
            Model::Mirror => Self::Mirror,
            Model::Glass {
                fresnel: Fresnel::Exact,
                ..
            } => Self::Glass,
            Model::Glass {
                fresnel: Fresnel::Schlick,
                ..
            } => Self::Schlick,
            Model::Emitter => Self::Emitter,
        }
    }

    /// Returns the name of the kind's constant in the shader.
    pub(super) fn glsl_name(self) -> &'static str {
        match self {
            Self::Facing => "FACING",
            Self::Lambert => "LAMBERT",
            Self::Diffuse => "DIFFUSE",
            Self::Glossy => "GLOSSY",
            Self::Disney => "DISNEY",
            Self::Mirror => "MIRROR",
            Self::Glass => "GLASS",
            Self::Schlick => "SCHLICK",
            Self::Emitter => "EMITTER",
        }
    }
}

/// The code fragments that a scene needs.
pub(super) struct Parts<'a> {
    /// Emitters come first if paths are traced.
    pub(super) spheres: Vec<(Point, f64, &'a Object)>,
    pub(super) planes: Vec<(Point, Point, &'a Object)>,
    pub(super) quadrics: Vec<(Quadric, &'a Object)>,
    pub(super) boxes: Vec<(Cuboid, &'a Object)>,
    /// Scatters without motion, and without a pattern in the coordinates of each sphere; the spheres of the
    /// others are in `spheres`.
    pub(super) grids: Vec<&'a Scatter>,
    pub(super) patterns: Patterns,
    /// The models in use, in order of their first object.
    pub(super) models: Vec<Kind>,
    pub(super) traces_paths: bool,
}

impl<'a> Parts<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let mut parts = Self {
            spheres: Vec::new(),
            planes: Vec::new(),
            quadrics: Vec::new(),
            boxes: Vec::new(),
            grids: Vec::new(),
            patterns: Patterns::new(scene),
            models: Vec::new(),
            traces_paths: scene.film.integrator == Integrator::Path,
        };
        let mut in_grids = vec![false; scene.objects.len()];
        for ScatterObjects { scatter, objects } in &scene.scatters {
            let is_emitter = parts.traces_paths && Kind::from_model(&scatter.material.model) == Kind::Emitter;
            let has_own_space = scatter.material.pattern.as_ref().is_some_and(is_own);
            if scatter.motion.is_none() && !is_emitter && !has_own_space {
                in_grids[objects.clone()].fill(true);
                parts.grids.push(scatter);
            }
        }
        for (object, in_grid) in scene.objects.iter().zip(in_grids) {
            let kind = Kind::from_model(&object.material.model);
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
                Shape::Box(cuboid) => parts.boxes.push((cuboid, object)),
            }
        }
        if parts.traces_paths {
            parts.spheres.sort_by_key(|(_, _, object)| !is_emitter(object));
        }
        parts
    }

    pub(super) fn uses(&self, model: Kind) -> bool {
        self.models.contains(&model)
    }

    pub(super) fn uses_any(&self, models: &[Kind]) -> bool {
        models.iter().any(|&model| self.uses(model))
    }

    /// Whether lights illuminate any surface.
    pub(super) fn is_lit(&self) -> bool {
        !self.traces_paths && self.uses_any(&REFLECTIVE)
    }

    /// Whether hits carry a model constant: there is more than one model.
    pub(super) fn has_model_ids(&self) -> bool {
        self.models.len() > 1
    }
}

pub(super) fn is_emitter(object: &Object) -> bool {
    Kind::from_model(&object.material.model) == Kind::Emitter
}
