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

mod camera;
#[cfg(test)]
mod closed_forms;
mod film;
mod glass;
mod lanes;
mod light;
mod material;
mod pattern;
mod ray;
mod ray_epsilon;
mod real;
mod sampler;
mod shape;
mod spheres;
#[cfg(test)]
mod tests;
mod tile;
mod transfer;
mod world;

use std::ops::Range;

use film::AdaptiveTile;
pub use film::{RESAMPLED_ROWS, SamplingCost};
pub use ray_epsilon::{Acne, ColorRange, EpsilonFamily, EpsilonSet, LightPolicy, RayEpsilon, RayEpsilons};
use rayon::prelude::*;
pub use real::{Real, Vector};
use toyproof_image::Image;
use toyproof_scene::{self as scene, Film, FrameTime, Requirements, Scene};

use self::camera::{Camera, Figure};
use self::lanes::Level;
use self::sampler::{Sample, SampleStream};
use self::shape::{Shape, Sphere};
use self::spheres::{NumberedSphere, Spheres};
use self::world::World;
use crate::ray::PrimaryHit;
use crate::ray_epsilon::{Exact, RayEpsilonPolicy};

/// A scene converted to the number type in which it is traced.
#[derive(Debug)]
pub struct Tracer<T: Real> {
    film: Film,
    /// See [`Scene::max_offset`].
    max_offset: f64,
    camera: Camera<T>,
    figures: Vec<Figure<T>>,
    kernel: Kernel<T>,
    /// The instruction set that is used; results are the same bits in all of them.
    level: Level,
}

/// The world, specialized for scenes that consist of spheres only.
#[derive(Debug)]
enum Kernel<T: Real> {
    Spheres(World<T, Sphere<T>>),
    Shapes(World<T, Shape<T>>),
}

/// The number types that the tracer is compiled for. Its inner loops are instantiated in this crate once, not
/// in each crate that renders.
pub trait Backend: Sized {
    /// Creates a tracer, which may reuse the topology of the sphere tree of another moment.
    #[doc(hidden)]
    fn create(
        scene: &Scene,
        frame_time: FrameTime,
        level: Level,
        previous: Option<Spheres<Self>>,
    ) -> Tracer<Self>
    where
        Self: Real;

    /// Renders the row of tiles whose lowest row of pixels is `bottom`.
    #[doc(hidden)]
    fn band(tracer: &Tracer<Self>, bottom: u32, pixels: &mut [[f32; 4]])
    where
        Self: Real;

    /// Renders a pixel.
    #[doc(hidden)]
    fn pixel(tracer: &Tracer<Self>, pixel: [u32; 2]) -> [Self; 3]
    where
        Self: Real;

    /// Renders a tile with enough samples.
    #[doc(hidden)]
    fn adaptive_tile(tracer: &Tracer<Self>, corner: [u32; 2], max_error: f64) -> AdaptiveTile
    where
        Self: Real;
}

macro_rules! backends {
    ($($number:ty),*) => {$(
        impl Backend for $number {
            fn create(
                scene: &Scene,
                frame_time: FrameTime,
                level: Level,
                previous: Option<Spheres<Self>>,
            ) -> Tracer<Self> {
                Tracer::with_level(scene, frame_time, level, previous)
            }

            fn band(tracer: &Tracer<Self>, bottom: u32, pixels: &mut [[f32; 4]]) {
                tracer.band(bottom, pixels);
            }

            fn pixel(tracer: &Tracer<Self>, pixel: [u32; 2]) -> [Self; 3] {
                tracer.pixel_color(pixel)
            }

            fn adaptive_tile(tracer: &Tracer<Self>, corner: [u32; 2], max_error: f64) -> AdaptiveTile {
                tracer.adaptive_tile(corner, max_error)
            }
        }
    )*};
}
backends!(f32, f64);

impl<T: Real> Tracer<T> {
    /// Creates a tracer for the first moment of `scene`. All numbers are rounded to `T` once, here.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self::at(scene, FrameTime::default())
    }

    /// Creates a tracer for the given moment of `scene`.
    #[must_use]
    pub fn at(scene: &Scene, frame_time: FrameTime) -> Self {
        T::create(scene, frame_time, Level::best(), None)
    }

    /// Creates a tracer for a different moment of the same scene and reuses the topology of the sphere tree.
    #[must_use]
    pub fn moved(self, scene: &Scene, frame_time: FrameTime) -> Self {
        let spheres = match self.kernel {
            Kernel::Spheres(world) => world.spheres,
            Kernel::Shapes(world) => world.spheres,
        };
        T::create(scene, frame_time, self.level, Some(spheres))
    }

    fn with_level(scene: &Scene, frame_time: FrameTime, level: Level, previous: Option<Spheres<T>>) -> Self {
        let requirements = Requirements::of(scene);
        let moved = requirements.motion.then(|| scene.at(frame_time));
        let scene = moved.as_ref().unwrap_or(scene);
        let spheres = |all: &[NumberedSphere<T>]| match previous {
            Some(previous) => previous.moved(all),
            None => Spheres::new(all, requirements.many_spheres, level),
        };
        Self {
            film: scene.film,
            max_offset: scene.max_offset,
            camera: Camera::new(scene),
            figures: scene.figures.iter().map(Figure::new).collect(),
            kernel: if requirements.shapes {
                Kernel::Shapes(World::new(scene, level, spheres, |object| {
                    Shape::new(&object.shape)
                }))
            } else {
                Kernel::Spheres(World::new(scene, level, spheres, |object| match object.shape {
                    scene::Shape::Sphere { center, radius } => Sphere::new(center, radius),
                    _ => unreachable!("a scene that requires other shapes has the other kernel"),
                }))
            },
            level,
        }
    }

    /// Renders the whole image, unclamped. `row_done` is called once per row, from any thread.
    pub fn render(&self, row_done: impl Fn() + Sync) -> Image {
        self.rows(0..self.film.size[1], row_done)
    }

    /// Renders the given rows, with `row_done` as in [`Tracer::render`].
    pub fn rows(&self, rows: Range<u32>, row_done: impl Fn() + Sync) -> Image {
        let (width, height) = (self.film.size[0], rows.len() as u32);
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; width as usize * height as usize];
        let bands = pixels
            .par_chunks_mut(width as usize * tile::TILE_SIDE as usize)
            .with_max_len(1);
        bands.enumerate().for_each(|(band, pixels)| {
            T::band(self, rows.start + band as u32 * tile::TILE_SIDE, pixels);
            (0..pixels.len() / width as usize).for_each(|_| row_done());
        });
        Image::new(width, height, pixels)
    }

    /// Renders the pixel at (x, y), where y points up: the tone-mapped mean of its samples.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> [T; 3] {
        T::pixel(self, [x, y])
    }

    fn pixel_color(&self, pixel: [u32; 2]) -> [T; 3] {
        let mut sum = T::Vec3::ZERO;
        let count = self.film.samples;
        for index in 0..count {
            let sample = Sample {
                pixel,
                index,
                count,
                set: 0,
            };
            sum = sum + self.sample(sample, &Exact);
        }
        let mean = sum / T::from_f64(f64::from(count));
        mean.to_array().map(|c| transfer::tone_map(&self.film, c))
    }

    fn sample(&self, sample: Sample, policy: &impl RayEpsilonPolicy<T>) -> T::Vec3 {
        let mut stream = SampleStream::new(self.film.sampler, sample);
        let position = Self::sample_position(sample.pixel, stream.jitter());
        let primary = self.primary_hit(self.camera.screen(position));
        self.radiance(primary, stream, policy)
    }

    /// Returns the position of a sample in pixels from the bottom left. Its jitter is the first pair of
    /// random numbers that the sample consumes.
    fn sample_position(pixel: [u32; 2], jitter: [T; 2]) -> [T; 2] {
        let half = T::from_f64(0.5);
        [0, 1].map(|axis| T::from_f64(f64::from(pixel[axis])) + half + jitter[axis])
    }

    /// Computes the radiance that arrives from a primary hit.
    fn radiance(
        &self,
        primary: PrimaryHit<T>,
        stream: SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        match (primary, &self.kernel) {
            (PrimaryHit::Figure(figure), _) => self.figures[figure].color,
            (PrimaryHit::Scene(ray, first), Kernel::Spheres(world)) => {
                world.radiance(ray, first, stream, policy)
            }
            (PrimaryHit::Scene(ray, first), Kernel::Shapes(world)) => {
                world.radiance(ray, first, stream, policy)
            }
        }
    }
}
