//! Light from the lights, by way of mirrors and glass: T. Whitted, “An Improved Illumination Model for Shaded
//! Display”, CACM 23(6), 1980.

use super::super::light::{Cone, Light};
use super::super::material::{Brdf, Frame, Model};
use super::super::ray::{Hit, Ray};
use super::super::real::{Real, Vector};
use super::super::sampler::Draws;
use super::super::shape::Primitive;
use super::super::style::Style;
use super::{First, World};

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// The radiance along a ray whose path has `depth` segments before it, and which meets that first.
    pub(super) fn whitted(
        &self,
        mut ray: Ray<T>,
        mut first: First<T>,
        depth: u32,
        draws: &mut Draws,
        style: &impl Style<T>,
    ) -> T::Vec3 {
        let mut sum = T::Vec3::ZERO;
        let mut throughput = T::Vec3::from_f64([1.0; 3]);
        for after in depth + 1..=self.max_depth {
            let Some(hit) = self.hit(&ray, first) else {
                return sum + throughput * self.background.color(ray.direction);
            };
            let material = &self.materials[hit.surface];
            let color = throughput * material.color(hit.point);
            let facing = ray.direction.dot(hit.normal);
            let reflected = || ray.direction - hit.normal * (T::from_f64(2.0) * facing);
            match &material.model {
                Model::Facing => return sum + color * facing.abs(),
                Model::Emitter => return sum + color,
                Model::Reflective(brdf) => {
                    let color = material.color(hit.point);
                    let lit = self.lit(&hit, (brdf, color), -ray.direction, draws, style);
                    return sum + throughput * lit;
                }
                Model::Mirror => {
                    throughput = color;
                    ray = hit.leave(reflected(), style);
                }
                Model::Glass(glass) => {
                    let parted = glass.part(ray.direction, hit.normal, facing);
                    let mirrored = hit.leave(reflected(), style);
                    if let Some(refracted) = parted.refracted {
                        if after < self.max_depth {
                            let first = self.nearest(&mirrored, style);
                            let seen = self.whitted(mirrored, first, after, draws, style);
                            sum = sum + color * parted.share * seen;
                        }
                        throughput = color * (T::one() - parted.share);
                        ray = hit.leave(refracted, style);
                    } else {
                        throughput = color;
                        ray = mirrored;
                    }
                }
            }
            if after < self.max_depth {
                first = self.nearest(&ray, style);
            }
        }
        sum
    }

    /// Ambient light and that of every light which is seen from the surface.
    fn lit(
        &self,
        hit: &Hit<T>,
        (brdf, color): (&Brdf<T>, T::Vec3),
        view: T::Vec3,
        draws: &mut Draws,
        style: &impl Style<T>,
    ) -> T::Vec3 {
        let style = &style.of_light_rays();
        let frame = Frame {
            normal: hit.normal,
            view,
        };
        let mut sum = color * self.ambient;
        for light in &self.lights {
            let (direction, ray, distance) = toward(hit, light, draws, style);
            let cosine = hit.normal.dot(direction);
            if cosine > T::zero() && !(light.shadow && self.occluded(&ray, distance, None, style)) {
                sum = sum + light.color * brdf.value(color, &frame, direction) * cosine;
            }
        }
        sum
    }
}

/// The direction to a light from a point, the shadow ray, and how far it goes.
fn toward<T: Real>(
    hit: &Hit<T>,
    light: &Light<T>,
    draws: &mut Draws,
    style: &impl Style<T>,
) -> (T::Vec3, Ray<T>, T) {
    if light.radius > T::zero() {
        let cone = Cone::new(light.position, light.radius, hit.point);
        let (direction, distance) = cone.draw(draws.polar());
        return (direction, hit.leave(direction, style), distance);
    }
    let direction = (light.position - hit.point).normalize();
    let mut ray = hit.leave(direction, style);
    let to_light = light.position - ray.origin;
    let distance = to_light.length();
    ray.direction = to_light / distance;
    (direction, ray, distance)
}
