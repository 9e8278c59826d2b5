//! What a ray sees.

use super::doubt::Doubt;
use super::real::{Real, Vector};
use super::sphere::Shape;
use crate::scene::{Background, Model, Scene};

/// A ray o + t·d, t > 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray<T: Real> {
    pub(super) origin: T::Vec3,
    /// Of length 1, up to rounding.
    pub(super) direction: T::Vec3,
    /// The sphere that the origin lies on.
    pub(super) from: Option<usize>,
}

/// A point on a surface.
struct Hit<T: Real> {
    point: T::Vec3,
    /// Outward, of length 1.
    normal: T::Vec3,
    sphere: usize,
}

impl<T: Real> Hit<T> {
    /// A secondary ray.
    fn leave(&self, direction: T::Vec3, doubt: &impl Doubt<T>) -> Ray<T> {
        Ray {
            origin: self.point + self.normal * doubt.offset(),
            direction,
            from: Some(self.sphere),
        }
    }
}

#[derive(Debug)]
struct Surface<T: Real> {
    shape: Shape<T>,
    model: Model,
    color: T::Vec3,
}

#[derive(Debug)]
struct Light<T: Real> {
    position: T::Vec3,
    color: T::Vec3,
    shadow: bool,
}

/// The scene's surfaces and lights in the number type of the tracer.
#[derive(Debug)]
pub(super) struct World<T: Real> {
    ambient: T::Vec3,
    bottom: T::Vec3,
    top: T::Vec3,
    lights: Vec<Light<T>>,
    surfaces: Vec<Surface<T>>,
}

impl<T: Real> World<T> {
    pub(super) fn new(scene: &Scene) -> Self {
        let (bottom, top) = match scene.background {
            Background::Uniform(color) => (color, color),
            Background::Gradient { bottom, top } => (bottom, top),
        };
        Self {
            ambient: T::Vec3::from_f64(scene.ambient),
            bottom: T::Vec3::from_f64(bottom),
            top: T::Vec3::from_f64(top),
            lights: scene
                .lights
                .iter()
                .map(|light| Light {
                    position: T::Vec3::from_f64(light.position),
                    color: T::Vec3::from_f64(light.color),
                    shadow: light.shadow,
                })
                .collect(),
            surfaces: scene
                .spheres
                .iter()
                .map(|sphere| Surface {
                    shape: Shape {
                        center: T::Vec3::from_f64(sphere.center),
                        radius: T::from_f64(sphere.radius),
                    },
                    model: sphere.material.model,
                    color: T::Vec3::from_f64(sphere.material.color),
                })
                .collect(),
        }
    }

    /// The radiance along a ray, of at most `max_depth` path segments.
    pub(super) fn radiance(&self, mut ray: Ray<T>, max_depth: u32, doubt: &impl Doubt<T>) -> T::Vec3 {
        let mut throughput = T::Vec3::from_f64([1.0; 3]);
        for depth in 0..max_depth {
            let Some(hit) = self.nearest(&ray, depth, doubt) else {
                return throughput * self.background(ray.direction);
            };
            let surface = &self.surfaces[hit.sphere];
            let facing = ray.direction.dot(hit.normal);
            match surface.model {
                Model::Facing => return throughput * surface.color * facing.abs(),
                Model::Lambert => return throughput * surface.color * self.light(&hit, doubt),
                Model::Mirror => {
                    throughput = throughput * surface.color;
                    let direction = ray.direction - hit.normal * (T::from_f64(2.0) * facing);
                    ray = hit.leave(direction, doubt);
                }
            }
        }
        T::Vec3::ZERO
    }

    fn intersect(&self, sphere: usize, ray: &Ray<T>, doubt: &impl Doubt<T>) -> Option<T> {
        let shape = &self.surfaces[sphere].shape;
        if ray.from == Some(sphere) {
            shape.intersect_own(ray, doubt)
        } else {
            shape.intersect(ray, doubt)
        }
    }

    fn nearest(&self, ray: &Ray<T>, depth: u32, doubt: &impl Doubt<T>) -> Option<Hit<T>> {
        let mut nearest = None;
        let mut t_nearest = T::infinity();
        for sphere in 0..self.surfaces.len() {
            if let Some(t) = self.intersect(sphere, ray, doubt)
                && t < t_nearest
            {
                t_nearest = t;
                nearest = Some(sphere);
            }
        }
        let sphere = nearest?;
        let Shape { center, radius } = self.surfaces[sphere].shape;
        let point = doubt.point(ray.origin + ray.direction * t_nearest, ray.origin, depth);
        let normal = doubt.normal((point - center) / radius, point, radius, depth);
        Some(Hit {
            point,
            normal,
            sphere,
        })
    }

    fn background(&self, direction: T::Vec3) -> T::Vec3 {
        let [_, y, _] = direction.to_array();
        let up = T::from_f64(0.5) * (T::one() + y);
        self.bottom * (T::one() - up) + self.top * up
    }

    /// Ambient light and that of every light which is seen from the surface.
    fn light(&self, hit: &Hit<T>, doubt: &impl Doubt<T>) -> T::Vec3 {
        let mut sum = self.ambient;
        for light in &self.lights {
            let to_light = light.position - hit.point;
            let cosine = hit.normal.dot(to_light.normalize());
            if cosine > T::zero() && !(light.shadow && self.occluded(hit, light, doubt)) {
                sum = sum + light.color * cosine;
            }
        }
        sum
    }

    /// Whether anything lies strictly between.
    fn occluded(&self, hit: &Hit<T>, light: &Light<T>, doubt: &impl Doubt<T>) -> bool {
        let mut ray = hit.leave(T::Vec3::ZERO, doubt);
        let to_light = light.position - ray.origin;
        let distance = to_light.dot(to_light).sqrt();
        ray.direction = to_light / distance;
        (0..self.surfaces.len())
            .any(|sphere| self.intersect(sphere, &ray, doubt).is_some_and(|t| t < distance))
    }
}
