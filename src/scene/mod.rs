//! A scene: what the reference tracer renders. It holds what the file says, as written, in f64.
//!
//! Lengths are in scene units, colours linear RGB. The camera looks along −z, y is up.

mod camera;
mod figure;
mod file;
mod film;
mod light;
mod material;
mod motion;
mod requirements;
mod scatter;
mod shape;

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
