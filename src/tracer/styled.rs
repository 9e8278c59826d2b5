//! Pixels in any one style of secondary rays, and which styles shaders have.

use toyproof_scene::Integrator;

use super::sampler::Sample;
use super::style::{Acne, Lamp, RayStyle, RayStyles};
use super::{Kernel, Tracer, film};

/// What authors write before a power of ten.
const USUAL: [f64; 12] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 7.5, 8.0, 9.0];
/// So many powers of ten below the largest offset are tried with all of these, and so many more with the first of each half.
const DECADES: i32 = 3;
const MORE_DECADES: i32 = 3;

/// Rays that meet their own surface are told apart by so many lights, and on so many surfaces one after the other.
const MOST_LIGHTS: u32 = 3;
const MOST_BOUNCES: u32 = 6;

/// Styles that differ in one length alone, in its order.
pub type StyleFamily = Vec<RayStyle>;

impl Tracer<f64> {
    /// The color of the pixel at (x, y) for a shader whose secondary rays start in these styles; components as they are developed.
    #[must_use]
    pub fn styled(&self, [x, y]: [u32; 2], styles: &RayStyles) -> [f64; 3] {
        let count = self.film.samples;
        let mut sum = glam::DVec3::ZERO;
        for index in 0..count {
            let sample = Sample {
                pixel: [x, y],
                index,
                count,
                set: 0,
            };
            sum += self.sample(sample, styles);
        }
        let mean = sum / f64::from(count);
        mean.to_array().map(|c| film::develop(&self.film, c))
    }

    /// The styles that a shader of the scene may have: offsets along the normal or along the ray, least t's, or both, each with
    /// all that a lamp may be taken for.
    #[must_use]
    pub fn style_families(&self) -> Vec<StyleFamily> {
        let lengths = usual_lengths(self.max_offset);
        let ways: [fn(f64) -> RayStyle; 4] = [
            |offset| RayStyle {
                offset,
                ..RayStyle::default()
            },
            |along| RayStyle {
                along,
                ..RayStyle::default()
            },
            |t_min| RayStyle {
                t_min,
                ..RayStyle::default()
            },
            |both| RayStyle {
                offset: both,
                t_min: both,
                ..RayStyle::default()
            },
        ];
        let lamps = self.lamps();
        let families = ways.iter().flat_map(|way| {
            let family = |&lamp| {
                let style = |&length| RayStyle { lamp, ..way(length) };
                lengths.iter().map(style).collect()
            };
            lamps.iter().map(family).collect::<Vec<_>>()
        });
        families.collect()
    }

    /// What a shader may make of a pixel whose secondary rays meet the surface that they start from: all ways in which some do and
    /// others do not.
    #[must_use]
    pub fn acne(&self) -> Vec<RayStyles> {
        let [lights, bounces] = match &self.kernel {
            Kernel::Spheres(world) => world.lights_and_bounces(),
            Kernel::Shapes(world) => world.lights_and_bounces(),
        };
        let (lights, bounces) = (lights.min(MOST_LIGHTS), bounces.min(MOST_BOUNCES));
        let all = (0..1 << lights).flat_map(|hidden_lights| {
            (0..1 << bounces).map(move |own_met| Acne {
                own_met,
                hidden_lights,
            })
        });
        all.filter(|acne| *acne != Acne::default())
            .map(|acne| {
                RayStyles::alike(RayStyle {
                    acne,
                    ..RayStyle::default()
                })
            })
            .collect()
    }

    /// What rays that look for a light may make of it.
    fn lamps(&self) -> Vec<Lamp> {
        let [looks, is_surface, is_weighed] = match &self.kernel {
            Kernel::Spheres(world) => world.looks_for_lights(),
            Kernel::Shapes(world) => world.looks_for_lights(),
        };
        let either = |may: bool| if may { &[false, true][..] } else { &[false] };
        let mut lamps = Vec::new();
        for &from_start in either(looks) {
            for &must_be_met in either(is_surface) {
                for &weighed_at_surface in either(is_weighed) {
                    lamps.push(Lamp {
                        from_start,
                        must_be_met,
                        weighed_at_surface,
                    });
                }
            }
        }
        lamps
    }
}

impl<T: super::Real, P: super::shape::Primitive<T>> super::world::World<T, P> {
    /// Whether rays look for lights, whether these are surfaces that can be met, and whether what is met by chance is weighed.
    fn looks_for_lights(&self) -> [bool; 3] {
        let paths = self.integrator == Integrator::Path;
        let [lights, own_surface] = self.lights_and_surfaces();
        let emitters = paths && self.has_emitters();
        [lights || emitters, own_surface || emitters, emitters]
    }
}

/// Lengths as authors write them, from 0 to the largest offset that the scene accepts.
fn usual_lengths(max_offset: f64) -> Vec<f64> {
    let exponent = max_offset.log10().floor() as i32;
    let mut lengths = vec![0.0];
    for decade in (0..DECADES + MORE_DECADES).rev() {
        let unit = 10f64.powi(exponent - decade);
        let all = decade < DECADES;
        let factors = USUAL
            .into_iter()
            .filter(|&factor| all || factor == 1.0 || factor == 5.0);
        lengths.extend(factors.map(|factor| factor * unit));
    }
    lengths.retain(|&length| length < max_offset);
    lengths.push(max_offset);
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_rise_to_the_largest_and_hold_what_authors_write() {
        for max_offset in [1e-3, 0.01, 0.004, 1.0] {
            let lengths = usual_lengths(max_offset);
            assert!(lengths.is_sorted_by(|a, b| a < b), "{lengths:?}");
            assert_eq!(lengths.last(), Some(&max_offset));
        }
        let lengths = usual_lengths(1e-3);
        for usual in [1e-6, 1e-5, 1e-4, 2e-4, 3e-4, 5e-4, 8e-4] {
            let is_usual = |length: &&f64| (**length - usual).abs() < 1e-9 * usual;
            assert!(lengths.iter().any(|length| is_usual(&length)), "{usual}");
        }
    }
}
