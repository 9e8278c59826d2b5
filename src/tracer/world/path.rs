//! Path tracing with a fixed number of segments, the light of each point estimated twice: by a direction drawn to an
//! emitter and by one drawn for the BRDF, weighted by the power heuristic of E. Veach and L. Guibas, “Optimally
//! Combining Sampling Techniques for Monte Carlo Rendering”, SIGGRAPH 1995.

use super::super::light::Cone;
use super::super::material::{Brdf, Frame, Model};
use super::super::ray::{First, Hit, Ray};
use super::super::real::{Real, Vector};
use super::super::sampler::Draws;
use super::super::shape::Primitive;
use super::super::style::Style;
use super::World;

/// The last direction that was drawn for a BRDF: its density, and where its ray starts.
type Drawn<T> = (T, <T as Real>::Vec3);

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Draws, at each point with a BRDF: which emitter (one number), a direction in its cone (a pair), a direction for
    /// the BRDF (a pair). The first are left out where nothing shines.
    pub(super) fn path(
        &self,
        mut ray: Ray<T>,
        mut first: First<T>,
        draws: &mut Draws,
        style: &impl Style<T>,
    ) -> T::Vec3 {
        let mut sum = T::Vec3::ZERO;
        let mut throughput = T::Vec3::from_f64([1.0; 3]);
        // None where no emitter could have been drawn: at the camera and at mirrors.
        let mut drawn: Option<Drawn<T>> = None;
        for segment in 1..=self.max_depth {
            let Some(hit) = self.hit(&ray, first) else {
                return sum + throughput * self.background.color(ray.direction);
            };
            let material = &self.materials[hit.surface];
            let color = material.color(hit.point);
            match &material.model {
                Model::Emitter => return sum + throughput * color * self.weight(&hit, drawn),
                Model::Mirror => {
                    let facing = ray.direction.dot(hit.normal);
                    throughput = throughput * color;
                    drawn = None;
                    ray = hit.leave(ray.direction - hit.normal * (T::from_f64(2.0) * facing), style);
                }
                // Light that is looked for here, or found from here, would have come by a segment too many.
                Model::Reflective(_) if segment == self.max_depth => return sum,
                Model::Reflective(brdf) => {
                    let frame = Frame {
                        normal: hit.normal,
                        view: -ray.direction,
                    };
                    sum = sum + throughput * self.emitted(&hit, (brdf, color), &frame, draws, style);
                    let direction = brdf.draw(&frame, draws.polar());
                    let cosine = hit.normal.dot(direction);
                    let density = brdf.density(&frame, direction);
                    // Only rounding draws a direction at the edge of a lobe, where it has no density.
                    if cosine <= T::zero() || density <= T::zero() {
                        return sum;
                    }
                    throughput = throughput * brdf.value(color, &frame, direction) * (cosine / density);
                    ray = hit.leave(direction, style);
                    let at_surface = style.of_light_rays().lamp().weighed_at_surface;
                    drawn = Some((density, if at_surface { hit.point } else { ray.origin }));
                }
                // Refused when the scene is read.
                Model::Facing | Model::Glass(_) => return sum,
            }
            if segment < self.max_depth {
                first = self.nearest(&ray, style);
            }
        }
        sum
    }

    /// The light of an emitter that is drawn, all with the same chance.
    fn emitted(
        &self,
        hit: &Hit<T>,
        (brdf, color): (&Brdf<T>, T::Vec3),
        frame: &Frame<T>,
        draws: &mut Draws,
        style: &impl Style<T>,
    ) -> T::Vec3 {
        let style = &style.of_light_rays();
        let number = T::from_f64(self.emitters.len() as f64);
        if self.emitters.is_empty() || style.acne().hidden_lights != 0 {
            return T::Vec3::ZERO;
        }
        let drawn: T = draws.number();
        let which = (drawn * number).to_usize().unwrap_or(0);
        let emitter = &self.emitters[which.min(self.emitters.len() - 1)];
        let cone = Cone::new(emitter.center, emitter.radius, hit.lit_from(style));
        let (direction, distance) = cone.draw(draws.polar());
        let cosine = hit.normal.dot(direction);
        let ray = hit.leave(direction, style);
        let distance = distance - style.along();
        if cosine <= T::zero() || self.occluded(&ray, distance, Some(emitter.surface), style) {
            return T::Vec3::ZERO;
        }
        let density = cone.density() / number;
        let weight = power_heuristic(density, brdf.density(frame, direction));
        let radiance = self.materials[emitter.surface].color(hit.point);
        radiance * brdf.value(color, frame, direction) * (cosine * weight / density)
    }

    /// The weight of an emitter that a ray has met.
    fn weight(&self, hit: &Hit<T>, drawn: Option<Drawn<T>>) -> T {
        let emitter = self
            .emitters
            .iter()
            .find(|emitter| emitter.surface == hit.surface);
        let (Some((density, from)), Some(emitter)) = (drawn, emitter) else {
            return T::one();
        };
        let cone = Cone::new(emitter.center, emitter.radius, from);
        let number = T::from_f64(self.emitters.len() as f64);
        power_heuristic(density, cone.density() / number)
    }
}

/// The weight of what has density p where the other way to draw it has density q: p² / (p² + q²).
fn power_heuristic<T: Real>(p: T, q: T) -> T {
    let ratio = q / p;
    (T::one() + ratio * ratio).recip()
}
