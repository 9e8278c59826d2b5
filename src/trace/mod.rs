//! The reference tracer: what a scene looks like, in f32 or f64.
//!
//! It is written for correctness: recentred discriminants with stable roots, no epsilons, secondary rays
//! do not meet the point that they start from. [`Tracer::hull`] tells which colours a pixel has in
//! the styles that shaders may start secondary rays in, [`Tracer::is_quad_mixed`] where its quad
//! sees different things.

mod adaptive;
mod camera;
mod figure;
mod film;
mod light;
mod material;
mod ray;
mod real;
mod sampler;
mod seen;
mod shape;
mod style;
#[cfg(test)]
mod tests;
mod world;

use rayon::prelude::*;

pub use adaptive::Spent;
pub use real::{Real, Vector};
pub use style::{Hull, Styles};

use self::camera::Camera;
use self::figure::Figure;
use self::sampler::{Draws, Sample};
use self::shape::{Shape, Sphere};
use self::style::{Exact, Style};
use self::world::World;
use crate::image::Image;
use crate::scene::{self, Film, Moment, Requirements, Scene};

/// A scene in the number type that it is traced in.
#[derive(Debug)]
pub struct Tracer<T: Real> {
    film: Film,
    /// [`Scene::max_offset`]
    max_offset: f64,
    camera: Camera<T>,
    figures: Vec<Figure<T>>,
    kernel: Kernel<T>,
}

/// What a scene requires of the loops over its surfaces.
#[derive(Debug)]
enum Kernel<T: Real> {
    Spheres(World<T, Sphere<T>>),
    Shapes(World<T, Shape<T>>),
}

impl<T: Real> Tracer<T> {
    /// A tracer of `scene` before anything has moved; its numbers are rounded to `T` once, here.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self::at(scene, Moment::default())
    }

    /// A tracer of `scene` at that moment.
    #[must_use]
    pub fn at(scene: &Scene, moment: Moment) -> Self {
        let requirements = Requirements::of(scene);
        let scene = &scene.at(moment);
        Self {
            film: scene.film,
            max_offset: scene.max_offset,
            camera: Camera::new(scene),
            figures: scene.figures.iter().map(Figure::new).collect(),
            kernel: if requirements.shapes {
                Kernel::Shapes(World::new(scene, |object| Shape::new(&object.shape)))
            } else {
                Kernel::Spheres(World::new(scene, |object| match object.shape {
                    scene::Shape::Sphere { center, radius } => Sphere::new(center, radius),
                    _ => unreachable!("a scene that requires other shapes has the other kernel"),
                }))
            },
        }
    }

    /// The whole picture, unclamped; `row_done` is called once for each row, from any thread.
    pub fn picture(&self, row_done: impl Fn() + Sync) -> Image {
        let [width, height] = self.film.size;
        let pixels = (0..height)
            .into_par_iter()
            .flat_map_iter(|y| {
                let row: Vec<_> = (0..width)
                    .map(|x| {
                        let [r, g, b] = self.pixel(x, y).map(|c| c.to_f64() as f32);
                        [r, g, b, 1.0]
                    })
                    .collect();
                row_done();
                row
            })
            .collect();
        Image::new(width, height, pixels)
    }

    /// The colour of the pixel at (x, y), y upwards: the mean of its samples, developed.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> [T; 3] {
        let mut sum = T::Vec3::ZERO;
        let count = self.film.samples;
        for index in 0..count {
            let sample = Sample {
                pixel: [x, y],
                index,
                count,
                set: 0,
            };
            sum = sum + self.sample(sample, &Exact);
        }
        let mean = sum / T::from_f64(f64::from(count));
        mean.to_array().map(|c| film::develop(&self.film, c))
    }

    fn sample(&self, sample: Sample, style: &impl Style<T>) -> T::Vec3 {
        let mut draws = Draws::new(self.film.sampler, sample);
        let place = Self::place(sample, &mut draws);
        self.radiance(place, &mut draws, style)
    }

    /// Where a sample lies in the picture, in pixels from the bottom left: the first that is drawn for it.
    fn place(sample: Sample, draws: &mut Draws) -> [T; 2] {
        let jitter = draws.jitter();
        let half = T::from_f64(0.5);
        [0, 1].map(|axis| T::from_f64(f64::from(sample.pixel[axis])) + half + jitter[axis])
    }

    /// What comes from a place of the picture.
    fn radiance(&self, [x, y]: [T; 2], draws: &mut Draws, style: &impl Style<T>) -> T::Vec3 {
        let screen = self.camera.screen(x, y);
        if let Some(figure) = figure::topmost(&self.figures, screen) {
            return self.figures[figure].color;
        }
        let ray = self.camera.ray(screen);
        match &self.kernel {
            Kernel::Spheres(world) => world.radiance(ray, draws, style),
            Kernel::Shapes(world) => world.radiance(ray, draws, style),
        }
    }
}
