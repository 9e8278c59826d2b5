//! A scene in the tracer's number type, and the color of a pixel.

use toyproof_scene::{Film, FrameTime, Requirements, Sampler, Scene};

use crate::any_world::AnyWorld;
use crate::camera::{Camera, Figure};
use crate::lanes::Level;
use crate::ray::PrimaryHit;
use crate::ray_epsilon::{Exact, RayEpsilonPolicy};
use crate::real::{Real, Vector};
use crate::sampler::{Sample, SampleStream};
use crate::spheres::Spheres;
use crate::transfer::tone_map;

/// A scene converted to the number type in which it is traced.
#[derive(Debug)]
pub struct Tracer<T: Real> {
    pub(super) film: Film,
    /// See [`Scene::max_offset`].
    pub(super) max_offset: f64,
    pub(super) camera: Camera<T>,
    pub(super) figures: Vec<Figure<T>>,
    pub(super) world: AnyWorld<T>,
    /// The instruction set that is used; results are the same bits in all of them.
    pub(super) level: Level,
}

impl<T: Real> Tracer<T> {
    /// Creates a tracer for a moment of `scene`, which may reuse the topology of a sphere tree.
    pub(super) fn with_level(
        scene: &Scene,
        frame_time: FrameTime,
        level: Level,
        previous: Option<Spheres<T>>,
    ) -> Self {
        let requirements = Requirements::new(scene);
        let moved = requirements.motion.then(|| scene.at(frame_time));
        let scene = moved.as_ref().unwrap_or(scene);
        Self {
            film: scene.film,
            max_offset: scene.max_offset,
            camera: Camera::new(scene),
            figures: scene.figures.iter().map(Figure::new).collect(),
            world: AnyWorld::new(scene, level, |all| match previous {
                Some(previous) => previous.moved(all),
                None => Spheres::new(all, requirements.many_spheres, level),
            }),
            level,
        }
    }

    /// Renders a pixel: the tone-mapped mean of its samples.
    pub(super) fn pixel_color(&self, pixel: [u32; 2]) -> [T; 3] {
        let mean = Self::mean(pixel, self.film.samples, 0, |sample| self.sample(sample, &Exact));
        mean.to_array().map(|c| tone_map(&self.film, c))
    }

    /// Computes the mean of the radiances of a pixel's samples.
    pub(super) fn mean(
        pixel: [u32; 2],
        count: u32,
        set: u32,
        mut radiance: impl FnMut(Sample) -> T::Vec3,
    ) -> T::Vec3 {
        let mut sum = T::Vec3::ZERO;
        for index in 0..count {
            let sample = Sample {
                pixel,
                index,
                count,
                set,
            };
            sum = sum + radiance(sample);
        }
        sum / T::from_f64(f64::from(count))
    }

    /// Computes what the camera ray of a sample hits. The stream continues after the sample's jitter.
    pub(super) fn primary(&self, sampler: Sampler, sample: Sample) -> (PrimaryHit<T>, SampleStream) {
        let mut stream = SampleStream::new(sampler, sample);
        let position = Self::sample_position(sample.pixel, stream.jitter());
        (self.primary_hit(self.camera.screen(position)), stream)
    }

    /// Computes the radiance of a sample.
    pub(super) fn sample(&self, sample: Sample, policy: &impl RayEpsilonPolicy<T>) -> T::Vec3 {
        let (primary, stream) = self.primary(self.film.sampler, sample);
        self.radiance(primary, stream, policy)
    }

    /// Returns the position of a sample in pixels from the bottom left. Its jitter is the first pair of
    /// random numbers that the sample consumes.
    pub(super) fn sample_position(pixel: [u32; 2], jitter: [T; 2]) -> [T; 2] {
        let half = T::from_f64(0.5);
        [0, 1].map(|axis| T::from_f64(f64::from(pixel[axis])) + half + jitter[axis])
    }

    /// Computes the radiance that arrives from a primary hit.
    pub(super) fn radiance(
        &self,
        primary: PrimaryHit<T>,
        stream: SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        match primary {
            PrimaryHit::Figure(figure) => self.figures[figure].color,
            PrimaryHit::Scene(ray, first) => self.world.radiance(ray, first, stream, policy),
        }
    }
}
