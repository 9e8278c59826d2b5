//! The scene in the number type of the tracer, and what its rays meet.

mod path;
mod whitted;

use super::light::{Background, Light};
use super::material::{Material, Model};
use super::ray::{Hit, Ray};
use super::real::{Real, Vector};
use super::sampler::Draws;
use super::shape::Primitive;
use super::style::{Exact, Style};
use crate::scene::{Integrator, Object, Scene, Shape};

/// Surfaces and lights. `P` is the one shape that a scene requires, so that the loops over it know it.
#[derive(Debug)]
pub(super) struct World<T: Real, P> {
    integrator: Integrator,
    max_depth: u32,
    ambient: T::Vec3,
    background: Background<T>,
    lights: Vec<Light<T>>,
    shapes: Vec<P>,
    /// One for each shape.
    materials: Vec<Material<T>>,
    /// The spheres that shine.
    emitters: Vec<Emitter<T>>,
}

#[derive(Debug)]
struct Emitter<T: Real> {
    surface: usize,
    center: T::Vec3,
    radius: T,
}

impl<T: Real, P: Primitive<T>> World<T, P> {
    pub(super) fn new(scene: &Scene, shape: impl Fn(&Object) -> P) -> Self {
        let materials: Vec<_> = scene
            .objects
            .iter()
            .map(|object| Material::new(&object.material))
            .collect();
        let emitters = scene.objects.iter().zip(&materials).enumerate();
        Self {
            integrator: scene.film.integrator,
            max_depth: scene.film.max_depth,
            ambient: T::Vec3::from_f64(scene.ambient),
            background: Background::new(&scene.background),
            lights: scene.lights.iter().map(Light::new).collect(),
            shapes: scene.objects.iter().map(shape).collect(),
            emitters: emitters
                .filter_map(
                    |(surface, (object, material))| match (object.shape, &material.model) {
                        (Shape::Sphere { center, radius }, Model::Emitter) => Some(Emitter {
                            surface,
                            center: T::Vec3::from_f64(center),
                            radius: T::from_f64(radius),
                        }),
                        _ => None,
                    },
                )
                .collect(),
            materials,
        }
    }

    /// The radiance along a camera ray.
    pub(super) fn radiance(&self, ray: Ray<T>, draws: &mut Draws, style: &impl Style<T>) -> T::Vec3 {
        match self.integrator {
            Integrator::Whitted => self.whitted(ray, 0, draws, style),
            Integrator::Path => self.path(ray, draws, style),
        }
    }

    fn intersect(&self, surface: usize, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let shape = &self.shapes[surface];
        // Off its surface, a ray starts on none.
        if ray.from == Some(surface) && style.offset() == T::zero() {
            shape.intersect_own(ray, style)
        } else {
            shape.intersect(ray, style)
        }
    }

    fn nearest(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<Hit<T>> {
        let mut nearest = None;
        let mut t_nearest = T::infinity();
        for surface in 0..self.shapes.len() {
            if let Some(t) = self.intersect(surface, ray, style)
                && t < t_nearest
            {
                t_nearest = t;
                nearest = Some(surface);
            }
        }
        let surface = nearest?;
        let [point, normal] = self.shapes[surface].surface(ray, t_nearest);
        Some(Hit {
            point,
            normal,
            surface,
        })
    }

    /// The surface that a camera ray meets first.
    pub(super) fn seen(&self, ray: &Ray<T>) -> Option<usize> {
        self.nearest(ray, &Exact).map(|hit| hit.surface)
    }

    /// Whether anything but the surface `light` lies strictly between the ray's origin and `distance`.
    fn occluded(&self, ray: &Ray<T>, distance: T, light: Option<usize>, style: &impl Style<T>) -> bool {
        (0..self.shapes.len()).any(|surface| {
            light != Some(surface) && self.intersect(surface, ray, style).is_some_and(|t| t < distance)
        })
    }
}
