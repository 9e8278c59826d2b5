//! The features that a scene uses, which select its rendering kernel.

use std::fmt;

use super::{Integrator, Model, Sampler, Scene, Shape, ToneMap};

/// The maximum number of spheres that are intersected one by one.
const MAX_UNSORTED_SPHERES: usize = 128;

/// The features that a scene uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each feature is used or not")]
pub struct Requirements {
    /// Figures on the screen.
    pub figures: bool,
    /// Surfaces of any kind.
    pub surfaces: bool,
    /// Surfaces other than spheres.
    pub shapes: bool,
    /// Surfaces with a pattern.
    pub patterns: bool,
    /// A camera that is turned.
    pub turned_camera: bool,
    /// Enough spheres that an acceleration structure saves time.
    pub many_spheres: bool,
    /// Secondary rays: mirrors, glass, sampled directions.
    pub secondary_rays: bool,
    /// Rays that split in two: glass.
    pub branches: bool,
    /// Lights that cast shadows.
    pub shadows: bool,
    /// Lights with a radius.
    pub soft_shadows: bool,
    /// Directions are sampled at surfaces: [`Integrator::Path`].
    pub path_tracing: bool,
    /// More samples than the pixel center.
    pub samples: bool,
    /// A tone map or a gamma.
    pub transfer: bool,
    /// Anything moves.
    pub motion: bool,
}

impl Requirements {
    /// Determines the features that a scene uses.
    pub fn new(scene: &Scene) -> Self {
        let surface =
            |uses: fn(&Model) -> bool| scene.objects.iter().any(|object| uses(&object.material.model));
        let path_tracing = scene.film.integrator == Integrator::Path;
        let branches = surface(|model| matches!(model, Model::Glass { .. }));
        let moves = |motion: Option<usize>| motion.is_some();
        let spheres = scene
            .objects
            .iter()
            .filter(|object| matches!(object.shape, Shape::Sphere { .. }))
            .count();
        Self {
            figures: !scene.figures.is_empty(),
            surfaces: !scene.objects.is_empty(),
            shapes: spheres < scene.objects.len(),
            patterns: scene
                .objects
                .iter()
                .any(|object| object.material.pattern.is_some()),
            turned_camera: scene.camera.axes().is_some(),
            many_spheres: spheres > MAX_UNSORTED_SPHERES,
            secondary_rays: scene.film.max_depth > 1
                && (path_tracing || branches || surface(|model| *model == Model::Mirror)),
            branches,
            shadows: path_tracing || scene.lights.iter().any(|light| light.shadow),
            soft_shadows: scene.lights.iter().any(|light| light.radius > 0.0),
            path_tracing,
            samples: scene.film.samples > 1 || scene.film.sampler != Sampler::Center,
            transfer: scene.film.tone_map != ToneMap::None || scene.film.gamma != 1.0,
            motion: scene.lights.iter().any(|light| moves(light.motion))
                || scene.objects.iter().any(|object| moves(object.motion)),
        }
    }
}

/// A feature that a scene uses or not.
struct Feature {
    is_used: bool,
    name: &'static str,
    /// Why a scene does not use it.
    absence: &'static str,
}

impl Requirements {
    fn features(&self) -> [Feature; 13] {
        let feature = |is_used, name, absence| Feature {
            is_used,
            name,
            absence,
        };
        let shapes = if self.surfaces {
            "all surfaces are spheres"
        } else {
            "there is no surface"
        };
        [
            feature(self.figures, "figures", "nothing is drawn on the screen"),
            feature(self.shapes, "planes, quadrics or boxes", shapes),
            feature(self.patterns, "patterns", "no surface has one"),
            feature(self.turned_camera, "a turned camera", "it looks along -z"),
            feature(self.many_spheres, "many spheres", "they are few"),
            feature(
                self.secondary_rays,
                "secondary rays",
                "no ray goes on from a surface",
            ),
            feature(self.branches, "ray splitting at glass", "no surface is glass"),
            feature(self.shadows, "shadows", "no light casts any"),
            feature(self.soft_shadows, "soft shadows", "no light has a radius"),
            feature(self.path_tracing, "path tracing", "no direction is sampled"),
            feature(self.samples, "multiple samples", "one at the center of a pixel"),
            feature(
                self.transfer,
                "tone mapping or gamma",
                "colors are shown as they are",
            ),
            feature(self.motion, "motion", "nothing moves"),
        ]
    }

    /// Returns the features that the scene does not use, each with the reason: `shadows (no light casts any)`.
    #[must_use]
    pub fn left_out(&self) -> Vec<String> {
        let unused = self.features().into_iter().filter(|feature| !feature.is_used);
        unused
            .map(|feature| format!("{} ({})", feature.name, feature.absence))
            .collect()
    }
}

impl fmt::Display for Requirements {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let only_spheres = (self.surfaces && !self.shapes).then_some("spheres only");
        let used = self.features().into_iter().filter(|feature| feature.is_used);
        let used: Vec<_> = only_spheres
            .into_iter()
            .chain(used.map(|feature| feature.name))
            .collect();
        if used.is_empty() {
            f.write_str("only a background")
        } else {
            f.write_str(&used.join(", "))
        }
    }
}
