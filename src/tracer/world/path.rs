//! Path tracing with a fixed maximum number of segments and multiple importance sampling: direct light is
//! estimated by sampling an emitter and by sampling the BRDF, combined by the power heuristic of E. Veach and
//! L. Guibas, “Optimally Combining Sampling Techniques for Monte Carlo Rendering”, SIGGRAPH 1995.

use super::World;
use crate::light::Cone;
use crate::material::{Brdf, Frame, Model};
use crate::ray::{FirstHit, Hit, Ray};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::sampler::SampleStream;
use crate::shape::Primitive;

/// The last direction sampled from a BRDF: its density and the origin of its ray.
type BrdfSample<T> = (T, <T as Real>::Vec3);

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Traces a path. Each point with a BRDF consumes, in this order: a number (which emitter), a pair (the
    /// direction in its cone), a pair (the direction for the BRDF). Without emitters, only the last pair is
    /// consumed.
    pub(super) fn path(
        &self,
        mut ray: Ray<T>,
        mut first: FirstHit<T>,
        stream: &mut SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        let mut sum = T::Vec3::ZERO;
        let mut throughput = T::Vec3::from_f64([1.0; 3]);
        // `None` where light sampling is impossible: at the camera and after mirrors.
        let mut last_sample: Option<BrdfSample<T>> = None;
        for segment in 1..=self.max_depth {
            let Some(hit) = self.hit(&ray, first) else {
                return sum + throughput * self.background.color(ray.direction);
            };
            let material = &self.materials[hit.surface];
            let color = material.color(|| [hit.point, hit.normal]);
            match &material.model {
                Model::Emitter => return sum + throughput * color * self.emitter_weight(&hit, last_sample),
                Model::Mirror => {
                    let facing = ray.direction.dot(hit.normal);
                    throughput = throughput * color;
                    last_sample = None;
                    ray = hit.spawn_ray(ray.direction - hit.normal * (T::from_f64(2.0) * facing), policy);
                }
                // Light from here would need a segment more than allowed.
                Model::Reflective(_) if segment == self.max_depth => return sum,
                Model::Reflective(brdf) => {
                    let frame = Frame {
                        normal: hit.normal,
                        view: -ray.direction,
                    };
                    sum = sum + throughput * self.sample_emitter(&hit, (brdf, color), &frame, stream, policy);
                    let direction = brdf.sample(&frame, stream.next_disk());
                    let cosine = hit.normal.dot(direction);
                    let density = brdf.density(&frame, direction);
                    // Only rounding can produce a direction at the edge of a lobe, where the density is zero.
                    if cosine <= T::zero() || density <= T::zero() {
                        return sum;
                    }
                    throughput = throughput * brdf.value(color, &frame, direction) * (cosine / density);
                    ray = hit.spawn_ray(direction, policy);
                    let at_surface = policy.for_shadow_rays().light_policy().weight_at_surface;
                    last_sample = Some((density, if at_surface { hit.point } else { ray.origin }));
                }
                // Rejected when the scene is parsed.
                Model::Facing | Model::Glass(_) => return sum,
            }
            if segment < self.max_depth {
                first = self.nearest(&ray, policy);
            }
        }
        sum
    }

    /// Estimates direct light from an emitter that is selected with uniform probability.
    fn sample_emitter(
        &self,
        hit: &Hit<T>,
        (brdf, color): (&Brdf<T>, T::Vec3),
        frame: &Frame<T>,
        stream: &mut SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        let policy = &policy.for_shadow_rays();
        let number = T::from_f64(self.emitters.len() as f64);
        if self.emitters.is_empty() || policy.acne().shadowed_lights != 0 {
            return T::Vec3::ZERO;
        }
        let u: T = stream.next_1d();
        let which = (u * number).to_usize().unwrap_or(0);
        let emitter = &self.emitters[which.min(self.emitters.len() - 1)];
        let cone = Cone::new(emitter.center, emitter.radius, hit.light_ray_origin(policy));
        let (direction, distance) = cone.sample(stream.next_disk());
        let cosine = hit.normal.dot(direction);
        let ray = hit.spawn_ray(direction, policy);
        let distance = distance - policy.along();
        if cosine <= T::zero() || self.occluded(&ray, distance, Some(emitter.surface), policy) {
            return T::Vec3::ZERO;
        }
        let density = cone.density() / number;
        let weight = power_heuristic(density, brdf.density(frame, direction));
        let radiance = self.materials[emitter.surface].color(|| {
            let point = ray.origin + direction * distance;
            [point, (point - emitter.center) / emitter.radius]
        });
        radiance * brdf.value(color, frame, direction) * (cosine * weight / density)
    }

    /// Returns the weight of an emitter that was hit by a BRDF sample.
    fn emitter_weight(&self, hit: &Hit<T>, last_sample: Option<BrdfSample<T>>) -> T {
        let emitter = self
            .emitters
            .iter()
            .find(|emitter| emitter.surface == hit.surface);
        let (Some((density, from)), Some(emitter)) = (last_sample, emitter) else {
            return T::one();
        };
        let cone = Cone::new(emitter.center, emitter.radius, from);
        let number = T::from_f64(self.emitters.len() as f64);
        power_heuristic(density, cone.density() / number)
    }
}

/// The power heuristic, p² / (p² + q²): the weight of a sample of density p if the other technique has
/// density q.
fn power_heuristic<T: Real>(p: T, q: T) -> T {
    let ratio = q / p;
    (T::one() + ratio * ratio).recip()
}
