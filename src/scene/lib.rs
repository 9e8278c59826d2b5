//! Scenes that the reference tracer renders, read from TOML and kept in f64 as written, and the ShaderToy
//! shader that renders the same ([`export`]).
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//!
//! let mut files = Files::default();
//! let text = "[[sphere]]\ncenter = [0.0, 0.0, -6.0]\nradius = 1.5\n\
//!     material = { model = \"facing\", color = [1.0, 1.0, 0.0] }\n";
//! let file = files.add(File::new("sphere.toml", text));
//! let scene = toyproof_scene::parse(&files, file).unwrap();
//! let shader = toyproof_scene::export::shader(&scene).unwrap();
//! assert!(shader.contains("void mainImage"));
//! ```
//!
//! Lengths are in scene units, colors linear RGB. The camera looks along −z, y is up.
//!
//! # Parts
//!
//! - `film`, `camera`, `figure`, `shape`, `material`, `motion`: the model.
//! - `file`: the scene file, with a diagnostic for every error; `template`: a scene to begin with.
//! - `requirements`: the features that a scene uses.
//! - `perturb`: scenes whose numbers are perturbed by a few units in the last place.
//! - [`export`]: the shader that renders a scene, whose parts have names (slots).

mod camera;
pub mod export;
mod figure;
mod file;
mod film;
mod material;
mod motion;
mod perturb;
mod requirements;
mod shape;
mod template;

use std::ops::Range;

pub use camera::{Camera, Projection};
pub use figure::{Figure, Outline};
pub use file::parse;
pub use film::{Film, Integrator, MAX_SAMPLES, Sampler, ToneMap};
pub use material::{Background, Disney, Fresnel, Light, Material, Model, Pattern, PatternKind, Space};
pub use motion::{FrameTime, Motion, Period};
pub use requirements::Requirements;
pub use shape::{Cuboid, Equation, Quadric, QuadricKind, Scatter, ScatterObjects, Shape, unit};
pub use template::template;

/// A color, linear RGB; each component ≥ 0, nominally in [0, 1].
pub type Color = [f64; 3];
/// A point, in scene units.
pub type Point = [f64; 3];

/// A scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The title; may be empty.
    pub title: String,
    /// Ambient light, added to the direct light on every surface that has a BRDF.
    pub ambient: Color,
    /// The largest offset from its surface, in scene units, at which a shader of the scene may start a
    /// secondary ray, and the largest distance of hits that it may ignore; > 0. The tracer itself starts on
    /// the surface.
    pub max_offset: f64,
    /// How the image is sampled and tone-mapped.
    pub film: Film,
    /// The camera.
    pub camera: Camera,
    /// The radiance of rays that hit nothing.
    pub background: Background,
    /// Figures on the screen, in front of all surfaces, the last on top.
    pub figures: Vec<Figure>,
    /// The lights.
    pub lights: Vec<Light>,
    /// The surfaces.
    pub objects: Vec<Object>,
    /// The scatters, and which of the objects are theirs.
    pub scatters: Vec<ScatterObjects>,
    /// The motions of lights and surfaces, each alone or within an earlier one.
    pub motions: Vec<Motion>,
}

/// A surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// The shape, before any motion.
    pub shape: Shape,
    /// The material.
    pub material: Material,
    /// The index of the motion that moves it.
    pub motion: Option<usize>,
}

impl Scene {
    /// Removes the surfaces for whose index `keep` is false. A scatter that loses a sphere is no longer a
    /// grid: its other spheres become ordinary surfaces.
    pub fn retain_objects(&mut self, mut keep: impl FnMut(usize) -> bool) {
        let keep: Vec<bool> = (0..self.objects.len()).map(&mut keep).collect();
        let before = |end: usize| keep[..end].iter().filter(|&&keep| keep).count();
        self.scatters.retain_mut(|scattered| {
            let Range { start, end } = scattered.objects;
            scattered.objects = before(start)..before(end);
            scattered.objects.len() == end - start
        });
        let mut keep = keep.into_iter();
        self.objects.retain(|_| keep.next().unwrap_or(true));
    }

    /// Turns the spheres of scatters that were modified into ordinary surfaces.
    pub fn release_changed_scatters(&mut self) {
        let objects = &self.objects;
        self.scatters.retain(
            |ScatterObjects {
                 scatter,
                 objects: own,
             }| {
                objects
                    .get(own.clone())
                    .is_some_and(|own| scatter.spheres().eq(own.iter().cloned()))
            },
        );
    }

    /// Returns the scene at a time: everything is where its motion has brought it, and nothing moves any
    /// more.
    #[must_use]
    pub fn at(&self, frame_time: FrameTime) -> Self {
        let mut scene = self.clone();
        let transforms = motion::transforms(&self.motions, frame_time);
        for light in &mut scene.lights {
            if let Some(motion) = light.motion.take() {
                light.position = transforms[motion].point(light.position);
            }
        }
        for object in &mut scene.objects {
            if let Some(motion) = object.motion.take() {
                object.shape = object.shape.transformed(&transforms[motion]);
                if let Some(Pattern {
                    space: Space::Object { axes },
                    ..
                }) = &mut object.material.pattern
                {
                    *axes = axes.map(|axis| transforms[motion].direction(axis));
                }
            }
        }
        scene.motions.clear();
        scene
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    #[test]
    fn scatters_that_lose_or_change_spheres_are_released() {
        let text = "[[sphere]]\ncenter = [0, 0, -9]\nradius = 1\nmaterial = { model = \"mirror\", color = [1, 1, 1] }\n\
                    [[scatter]]\ncorner = [0, 0, -9]\ncells = [1, 1, 2]\nspacing = 1\nradius = [0.1, 0.4]\nseed = 1\n\
                    material = { model = \"mirror\", color = [1, 1, 1] }\n\
                    [[scatter]]\ncorner = [5, 0, -9]\ncells = [3, 1, 1]\nspacing = 1\nradius = [0.1, 0.4]\nseed = 2\n\
                    material = { model = \"mirror\", color = [1, 1, 1] }\n";
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let scene = parse(&files, file).unwrap();
        let ranges = |scene: &Scene| -> Vec<_> {
            let ranges = scene.scatters.iter().map(|scattered| scattered.objects.clone());
            ranges.collect()
        };
        let sphere = scene
            .objects
            .iter()
            .position(|object| object.shape == scene.objects[0].shape)
            .unwrap();
        for removed in 0..scene.objects.len() {
            let mut other = scene.clone();
            other.retain_objects(|at| at != removed);
            assert_eq!(other.objects.len(), scene.objects.len() - 1);
            let whole = ranges(&scene)
                .iter()
                .filter(|range| !range.contains(&removed))
                .count();
            assert_eq!(other.scatters.len(), whole, "{removed}");
            for ScatterObjects { scatter, objects } in &other.scatters {
                assert!(
                    scatter
                        .spheres()
                        .eq(other.objects[objects.clone()].iter().cloned()),
                    "{removed}"
                );
            }
        }
        let mut other = scene.clone();
        other.retain_objects(|_| false);
        assert!(other.objects.is_empty() && other.scatters.is_empty());
        let mut other = scene.clone();
        other.objects[sphere].material.color = [0.5; 3];
        other.release_changed_scatters();
        assert_eq!(ranges(&other), ranges(&scene), "none of theirs has changed");
        let first = ranges(&scene)[0].start;
        other.objects[first].material.color = [0.5; 3];
        other.release_changed_scatters();
        assert_eq!(ranges(&other), ranges(&scene)[1..]);
    }
}
