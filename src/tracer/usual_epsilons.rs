//! The ray epsilons that authors use: families of lengths, self-intersections, and light policies.

use crate::ray_epsilon::{Acne, LightPolicy, RayEpsilon, RayEpsilons};
use crate::tracer::Tracer;
use crate::transfer::tone_map;

/// Mantissas that authors commonly write.
const USUAL_MANTISSAS: [f64; 12] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 7.5, 8.0, 9.0];
/// Number of decades below the largest offset that are tried with all mantissas.
const DENSE_DECADES: i32 = 3;
/// Number of further decades that are tried with the mantissas 1 and 5 only.
const SPARSE_DECADES: i32 = 3;

/// Maximum number of lights for which combinations of self-intersections are enumerated.
const MAX_ACNE_LIGHTS: u32 = 3;
/// Maximum number of consecutive surfaces for which combinations of self-intersections are enumerated.
const MAX_ACNE_BOUNCES: u32 = 6;

/// Epsilons that differ in one length only, in increasing order.
pub type EpsilonFamily = Vec<RayEpsilon>;

impl Tracer<f64> {
    /// Renders a pixel `[x, y]` with the given epsilons. The components are tone-mapped but not clamped.
    pub fn pixel_with_epsilons(&self, pixel: [u32; 2], epsilons: &RayEpsilons) -> [f64; 3] {
        let mean = Self::mean(pixel, self.film.samples, 0, |sample| {
            self.sample(sample, epsilons)
        });
        mean.to_array().map(|c| tone_map(&self.film, c))
    }

    /// Returns the families of epsilons that a shader of the scene may use: offsets along the normal or along
    /// the ray, smallest t, or offset and smallest t together, each with all light policies.
    pub fn epsilon_families(&self) -> Vec<EpsilonFamily> {
        let lengths = usual_lengths(self.max_offset);
        let constructors: [fn(f64) -> RayEpsilon; 4] = [
            |offset| RayEpsilon {
                offset,
                ..RayEpsilon::default()
            },
            |along| RayEpsilon {
                along,
                ..RayEpsilon::default()
            },
            |t_min| RayEpsilon {
                t_min,
                ..RayEpsilon::default()
            },
            |both| RayEpsilon {
                offset: both,
                t_min: both,
                ..RayEpsilon::default()
            },
        ];
        let light_policies = self.light_policies();
        let families = constructors.iter().flat_map(|constructor| {
            let family = |&light_policy| {
                let epsilon = |&length| RayEpsilon {
                    light_policy,
                    ..constructor(length)
                };
                lengths.iter().map(epsilon).collect()
            };
            light_policies.iter().map(family).collect::<Vec<_>>()
        });
        families.collect()
    }

    /// Returns all combinations of rays that hit their own surface and rays that do not.
    pub fn acne(&self) -> Vec<RayEpsilons> {
        let [lights, bounces] = self.world.acne_dimensions();
        let (lights, bounces) = (lights.min(MAX_ACNE_LIGHTS), bounces.min(MAX_ACNE_BOUNCES));
        let all = (0..1 << lights).flat_map(|shadowed_lights| {
            (0..1 << bounces).map(move |self_hit_bounces| Acne {
                self_hit_bounces,
                shadowed_lights,
            })
        });
        all.filter(|acne| *acne != Acne::default())
            .map(|acne| {
                RayEpsilons::alike(RayEpsilon {
                    acne,
                    ..RayEpsilon::default()
                })
            })
            .collect()
    }

    /// Returns all light policies that can make a difference in this scene.
    fn light_policies(&self) -> Vec<LightPolicy> {
        let [has_lights, aims_at_surfaces, is_weighted] = self.world.light_policy_dimensions();
        let choices = |may: bool| if may { &[false, true][..] } else { &[false] };
        let mut light_policies = Vec::new();
        for &from_ray_origin in choices(has_lights) {
            for &requires_hit in choices(aims_at_surfaces) {
                for &weight_at_surface in choices(is_weighted) {
                    light_policies.push(LightPolicy {
                        from_ray_origin,
                        requires_hit,
                        weight_at_surface,
                    });
                }
            }
        }
        light_policies
    }
}

/// Returns lengths as authors write them, from 0 to the largest offset that the scene accepts.
fn usual_lengths(max_offset: f64) -> Vec<f64> {
    let exponent = max_offset.log10().floor() as i32;
    let mut lengths = vec![0.0];
    for decade in (0..DENSE_DECADES + SPARSE_DECADES).rev() {
        let unit = 10f64.powi(exponent - decade);
        let is_dense = decade < DENSE_DECADES;
        let factors = USUAL_MANTISSAS
            .into_iter()
            .filter(|&factor| is_dense || factor == 1.0 || factor == 5.0);
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
    fn usual_lengths_are_sorted_and_include_common_epsilons() {
        for max_offset in [1e-3, 0.01, 0.004, 1.0] {
            let lengths = usual_lengths(max_offset);
            assert!(lengths.is_sorted_by(|a, b| a < b), "{lengths:?}");
            assert_eq!(lengths.last(), Some(&max_offset));
        }
        let lengths = usual_lengths(1e-3);
        for usual in [1e-6, 1e-5, 1e-4, 2e-4, 3e-4, 5e-4, 8e-4] {
            let is_listed = lengths.iter().any(|length| (length - usual).abs() < 1e-9 * usual);
            assert!(is_listed, "{usual}");
        }
    }
}
