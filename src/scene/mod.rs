//! A scene: what the reference tracer renders. It holds what the file says, as written, in f64.
//!
//! Lengths are in scene units, colours linear RGB. The camera looks along −z, y is up.

mod file;

pub use file::parse;

/// A colour, linear RGB; each component ≥ 0, nominally in [0, 1].
pub type Color = [f64; 3];
/// A point, in scene units.
pub type Point = [f64; 3];

/// Everything that the tracer needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What people call it; may be empty.
    pub title: String,
    /// Added to the light on every lambert surface.
    pub ambient: Color,
    /// How it is sampled.
    pub film: Film,
    /// Where it is seen from.
    pub camera: Camera,
    /// What a ray sees that meets nothing.
    pub background: Background,
    /// The lights.
    pub lights: Vec<Light>,
    /// The spheres.
    pub spheres: Vec<Sphere>,
}

/// How the picture is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Film {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples in each pixel, averaged; ≥ 1.
    pub samples: u32,
    /// Where in the pixel they lie.
    pub sampler: Sampler,
    /// Path segments: 1 is camera rays only.
    pub max_depth: u32,
}

/// Where in a pixel its samples lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampler {
    /// All at its centre.
    Center,
    /// Where the course's `fract(sin(seed++) * 43758.5453123)` puts them, the seed 0 at each pixel.
    SineHash,
}

/// A pinhole and the screen before it: x ∈ [−1, 1], y ∈ [−1, 1] / aspect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The pinhole.
    pub eye: Point,
    /// The screen plane lies at z = eye.z − this; > 0.
    pub screen_distance: f64,
}

/// What a ray sees that meets nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// One colour.
    Uniform(Color),
    /// `mix(bottom, top, 0.5 · (1 + d.y))`, d the ray's unit direction.
    Gradient {
        /// Straight below.
        bottom: Color,
        /// Straight above.
        top: Color,
    },
}

/// A point light without falloff.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Where it is.
    pub position: Point,
    /// Its colour.
    pub color: Color,
    /// Whether what lies strictly between it and a surface shades the surface.
    pub shadow: bool,
}

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub center: Point,
    /// Its radius, > 0.
    pub radius: f64,
    /// What it is made of.
    pub material: Material,
}

/// What a surface does with light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// How it answers.
    pub model: Model,
    /// Its colour.
    pub color: Color,
}

/// How a surface answers light. D is the ray's direction, N the outward normal, L the direction to a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// `color · |D·N|`
    Facing,
    /// `color · (ambient + Σ light · max(N·L, 0) · visibility)`
    Lambert,
    /// `color ·` the radiance along the reflected ray; black beyond the last path segment.
    Mirror,
}
