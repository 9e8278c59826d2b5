//! The reference tracer: renders a scene in f32 or f64, and knows for each pixel the range of colors that correct shaders
//! may give it.
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
//! Recentred discriminants with stable roots, no epsilons, secondary rays do not meet the point that they start from. Camera
//! rays go in packets and others meet eight spheres at once, by the one formula of `spheres`, whose bits are the same in
//! any instruction set. [`Tracer::hull`] tells which colours a pixel has in
//! the styles that shaders may start secondary rays in, [`Tracer::is_quad_mixed`] where its quad
//! sees different things.

mod adaptive;
mod camera;
mod figure;
mod film;
mod lanes;
mod light;
mod material;
mod ray;
mod real;
mod redraw;
mod sampler;
mod seen;
mod shape;
mod spheres;
mod style;
mod styled;
#[cfg(test)]
mod tests;
mod tile;
mod world;

use std::ops::Range;

pub use adaptive::Spent;
use rayon::prelude::*;
pub use real::{Real, Vector};
pub use redraw::REDRAWN_ROWS;
pub use style::{Acne, Hull, Lamp, RayStyle, RayStyles, Styles};
pub use styled::StyleFamily;
use toyproof_image::Image;
use toyproof_scene::{self as scene, Film, Moment, Requirements, Scene};

use self::camera::Camera;
use self::figure::Figure;
use self::lanes::Level;
use self::sampler::{Draws, Sample};
use self::seen::Seen;
use self::shape::{Shape, Sphere};
use self::spheres::Spheres;
use self::style::{Exact, Style};
use self::world::World;

/// A scene in the number type that it is traced in.
#[derive(Debug)]
pub struct Tracer<T: Real> {
    film: Film,
    /// [`Scene::max_offset`]
    max_offset: f64,
    camera: Camera<T>,
    figures: Vec<Figure<T>>,
    kernel: Kernel<T>,
    /// Of the instruction set that it is traced with; all give the same bits.
    level: Level,
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
        Self::with_level(scene, moment, Level::best(), None)
    }

    /// A tracer of the same scene at another moment. It takes over what does not change: the shape of the tree.
    #[must_use]
    pub fn moved(self, scene: &Scene, moment: Moment) -> Self {
        let spheres = match self.kernel {
            Kernel::Spheres(world) => world.spheres,
            Kernel::Shapes(world) => world.spheres,
        };
        Self::with_level(scene, moment, self.level, Some(spheres))
    }

    fn with_level(scene: &Scene, moment: Moment, level: Level, before: Option<Spheres<T>>) -> Self {
        let requirements = Requirements::of(scene);
        let scene = &scene.at(moment);
        Self {
            film: scene.film,
            max_offset: scene.max_offset,
            camera: Camera::new(scene),
            figures: scene.figures.iter().map(Figure::new).collect(),
            kernel: if requirements.shapes {
                Kernel::Shapes(World::new(scene, level, before, |object| {
                    Shape::new(&object.shape)
                }))
            } else {
                Kernel::Spheres(World::new(scene, level, before, |object| match object.shape {
                    scene::Shape::Sphere { center, radius } => Sphere::new(center, radius),
                    _ => unreachable!("a scene that requires other shapes has the other kernel"),
                }))
            },
            level,
        }
    }

    /// The whole picture, unclamped; `row_done` is called once for each row, from any thread.
    pub fn picture(&self, row_done: impl Fn() + Sync) -> Image {
        self.rows(0..self.film.size[1], row_done)
    }

    /// These rows of it; `row_done` as for all.
    pub fn rows(&self, rows: Range<u32>, row_done: impl Fn() + Sync) -> Image {
        let (width, height) = (self.film.size[0], rows.len() as u32);
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; width as usize * height as usize];
        let bands = pixels
            .par_chunks_mut(width as usize * tile::SIDE as usize)
            .with_max_len(1);
        bands.enumerate().for_each(|(band, pixels)| {
            self.band(rows.start + band as u32 * tile::SIDE, pixels);
            (0..pixels.len() / width as usize).for_each(|_| row_done());
        });
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
        let place = Self::place(sample.pixel, draws.jitter());
        let seen = self.look(self.camera.screen(place));
        self.radiance(seen, draws, style)
    }

    /// Where a sample lies in the picture, in pixels from the bottom left: its jitter is the first that is drawn for it.
    fn place(pixel: [u32; 2], jitter: [T; 2]) -> [T; 2] {
        let half = T::from_f64(0.5);
        [0, 1].map(|axis| T::from_f64(f64::from(pixel[axis])) + half + jitter[axis])
    }

    /// What comes from a place on the screen.
    fn radiance(&self, seen: Seen<T>, draws: Draws, style: &impl Style<T>) -> T::Vec3 {
        match (seen, &self.kernel) {
            (Seen::Figure(figure), _) => self.figures[figure].color,
            (Seen::Scene(ray, first), Kernel::Spheres(world)) => world.radiance(ray, first, draws, style),
            (Seen::Scene(ray, first), Kernel::Shapes(world)) => world.radiance(ray, first, draws, style),
        }
    }
}
