//! Reference ray tracer: renders a scene in f32 or f64 and computes, for each pixel, the range of colors that
//! correct shaders may produce.
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_tracer::Tracer;
//!
//! let mut files = Files::default();
//! let text = "[film]\nsize = [16, 9]\n[background]\ncolor = [0.0, 0.5, 1.0]\n";
//! let file = files.add(File::new("sky.toml", text));
//! let scene = toyproof_scene::parse(&files, file).unwrap();
//! assert_eq!(Tracer::<f64>::new(&scene).pixel(3, 4), [0.0, 0.5, 1.0]);
//! ```
//!
//! Spheres are intersected by the recentered discriminant with stable roots. There are no epsilons: a
//! secondary ray does not intersect its own surface at the point where it starts. Camera rays are traced in
//! packets, and single rays are tested against eight spheres at a time; both use the same formula (module
//! `spheres`), whose results are bit-identical in every instruction set. [`Tracer::color_range`] gives the
//! colors of a pixel under all legal epsilons of secondary rays. [`Tracer::is_quad_mixed`] reports pixel
//! quads whose samples see different surfaces.
//!
//! # Parts
//!
//! - `camera`, `film`, `sampler`, `transfer`: camera rays, samples, and the color of a pixel.
//! - `shape`, `spheres`, `ray`: intersections; `material`, `pattern`, `light`, `glass`: shading.
//! - `real`: the number types; `lanes`: vectors of numbers in the best available instruction set.
//! - `layers`: depth, normals and the like, for compositors and denoisers.
//! - `tile`: renders tiles, whose camera rays are traced in packets.
//! - `world`: follows the samples of a packet from the first hit to the film, each in a lane of its own:
//!   `points` (what the lanes hit), `queries`, and the integrators `whitted` and `path`.
//! - `ray_epsilon`: the accepted offsets of secondary rays; `color_range`: the range of colors over them;
//!   `usual_epsilons`: those that authors use.
//!
//! In `spheres`, one formula serves `single_ray` (one ray and eight spheres), `packet` (64 camera rays and
//! one sphere) and `lanes` (a ray in each lane and one sphere). `tree` is a bounding volume hierarchy for
//! many spheres, which `collapse` makes of a `binary` one.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

mod adaptive;
mod any_world;
mod camera;
#[cfg(test)]
mod closed_forms;
mod color_range;
mod film;
mod glass;
mod lanes;
mod layers;
mod light;
mod material;
mod pattern;
mod primary_hit;
mod ray;
mod ray_epsilon;
mod real;
mod render;
mod sampler;
mod shape;
mod spheres;
#[cfg(test)]
mod tests;
mod tile;
mod tracer;
mod transfer;
mod usual_epsilons;
mod world;

pub use self::adaptive::SamplingCost;
pub use self::color_range::{ColorRange, EpsilonSet};
pub use self::film::RESAMPLED_ROWS;
pub use self::layers::{BACKGROUND_DEPTH, Layers};
pub use self::ray_epsilon::{Acne, LightPolicy, RayEpsilon, RayEpsilons};
pub use self::real::{Real, Vector};
pub use self::render::Backend;
pub use self::tracer::Tracer;
pub use self::usual_epsilons::EpsilonFamily;
