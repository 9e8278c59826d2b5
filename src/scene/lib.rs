//! Scenes that the reference tracer renders, read from TOML and kept in f64 as written, and the ShaderToy shader that
//! renders the same ([`export`]).
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
//! Lengths are in scene units, colours linear RGB. The camera looks along −z, y is up.

mod camera;
pub mod export;
mod figure;
mod file;
mod film;
mod light;
mod material;
mod motion;
mod perturb;
mod requirements;
mod scatter;
mod shape;
mod toml;

use std::ops::Range;

pub use camera::{Camera, Projection};
pub use figure::{Figure, Outline};
pub use file::parse;
pub use film::{Film, Integrator, Sampler, ToneMap};
pub use light::{Background, Light};
pub use material::{Checker, Disney, Fresnel, Material, Model};
pub use motion::{Moment, Motion, Period};
pub use requirements::Requirements;
pub use scatter::{Scatter, Scattered, unit};
pub use shape::{Equation, Quadric, QuadricKind, Shape};
pub use toml::of_toml;

/// A colour, linear RGB; each component ≥ 0, nominally in [0, 1].
pub type Color = [f64; 3];
/// A point, in scene units.
pub type Point = [f64; 3];

/// Everything that the tracer needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What people call it; may be empty.
    pub title: String,
    /// Light from everywhere, added to that of the lights on every surface that has a BRDF.
    pub ambient: Color,
    /// How far off its surface, in scene units, a shader of the scene may start a secondary ray, and how near a hit it may
    /// leave out; > 0. The tracer itself starts on the surface.
    pub max_offset: f64,
    /// How it is sampled and developed.
    pub film: Film,
    /// Where it is seen from.
    pub camera: Camera,
    /// What a ray sees that meets nothing.
    pub background: Background,
    /// What is painted on the screen itself, the last on top.
    pub figures: Vec<Figure>,
    /// The lights.
    pub lights: Vec<Light>,
    /// The surfaces.
    pub objects: Vec<Object>,
    /// Which of them come of a scatter.
    pub scatters: Vec<Scattered>,
    /// How lights and surfaces move, each within an earlier one or none.
    pub motions: Vec<Motion>,
}

/// A surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Its shape, where it is when nothing has moved.
    pub shape: Shape,
    /// What it is made of.
    pub material: Material,
    /// Which of the scene's motions moves it.
    pub motion: Option<usize>,
}

impl Scene {
    /// Removes the surfaces for whose place `stays` is false. A scatter that loses a sphere is a grid no longer: those that it has
    /// left are surfaces like any other.
    pub fn retain_objects(&mut self, mut stays: impl FnMut(usize) -> bool) {
        let stays: Vec<bool> = (0..self.objects.len()).map(&mut stays).collect();
        let before = |end: usize| stays[..end].iter().filter(|&&stays| stays).count();
        self.scatters.retain_mut(|scattered| {
            let Range { start, end } = scattered.objects;
            scattered.objects = before(start)..before(end);
            scattered.objects.len() == end - start
        });
        let mut stays = stays.into_iter();
        self.objects.retain(|_| stays.next().unwrap_or(true));
    }

    /// Makes surfaces like any other of the spheres of scatters that are no longer what the scatter says: somebody has changed them.
    pub fn release_changed_scatters(&mut self) {
        let objects = &self.objects;
        self.scatters.retain(
            |Scattered {
                 scatter,
                 objects: own,
             }| {
                objects
                    .get(own.clone())
                    .is_some_and(|own| scatter.spheres().eq(own.iter().cloned()))
            },
        );
    }

    /// The scene at that moment: all that moves is where it is then, and nothing moves any more.
    #[must_use]
    pub fn at(&self, moment: Moment) -> Self {
        let mut scene = self.clone();
        let places = motion::places(&self.motions, moment);
        for light in &mut scene.lights {
            if let Some(motion) = light.motion.take() {
                light.position = places[motion].point(light.position);
            }
        }
        for object in &mut scene.objects {
            if let Some(motion) = object.motion.take() {
                object.shape = object.shape.moved(&places[motion]);
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
    fn scatters_keep_their_spheres_or_are_none_any_more() {
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
            for Scattered { scatter, objects } in &other.scatters {
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
