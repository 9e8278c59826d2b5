//! Path tracing with a fixed maximum number of segments and multiple importance sampling: direct light is
//! estimated by sampling an emitter and by sampling the BRDF, combined by the power heuristic of E. Veach and
//! L. Guibas, “Optimally Combining Sampling Techniques for Monte Carlo Rendering”, SIGGRAPH 1995. Each sample
//! has a lane.

use super::points::Points;
use super::{Emitter, World};
use crate::lanes::{Columns, Lanes, MAX_LANES, Wide, Wide3, lanes_of};
use crate::light::Cone;
use crate::material::{Frame, Model};
use crate::ray::spherical_direction;
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::sampler::{SampleStream, next_disks, next_numbers};
use crate::shape::Primitive;
use crate::spheres::{LaneHits, LaneRays, NO_SURFACE};

/// The last directions sampled from BRDFs: their densities and the origins of their rays.
#[derive(Debug, Clone, Copy)]
struct BrdfSamples<T, S: Lanes<T>> {
    density: Wide<T, S>,
    from: Wide3<T, S>,
    /// The lanes that have one. Rays from the camera and from mirrors have none, because light sampling is
    /// impossible there.
    lanes: u32,
}

struct SelectedEmitters<T, S: Lanes<T>> {
    center: Wide3<T, S>,
    radius: Wide<T, S>,
    /// Encoded by [`Real::tag`].
    surface: Wide<T, S>,
    /// Indices of emitters, each with the lanes that selected it.
    groups: [(usize, u32); MAX_LANES],
    count: usize,
}

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Traces paths along camera rays with the given first hits, in the `active` lanes. Each point with a
    /// BRDF consumes, in this order: a number (which emitter), a pair (the direction in its cone), a pair
    /// (the direction for the BRDF). Without emitters, only the last pair is consumed.
    #[inline(always)]
    pub(super) fn path<S: Lanes<T>>(
        &self,
        simd: S,
        mut rays: LaneRays<T, S>,
        mut hits: LaneHits<T, S>,
        streams: &mut [SampleStream],
        mut active: u32,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> Wide3<T, S> {
        let [zero, one, two] = [0.0, 1.0, 2.0].map(|number| Wide::splat(simd, T::from_f64(number)));
        let black = Wide3::splat(simd, [T::zero(); 3]);
        let mut sum = black;
        let mut throughput = Wide3::splat(simd, [T::one(); 3]);
        let mut last = BrdfSamples {
            density: zero,
            from: black,
            lanes: 0,
        };
        for segment in 1..=self.max_depth {
            let points = self.points(simd, &rays, &hits, active);
            let mut light = throughput.times(self.background.color(simd, rays.direction));
            let mut ended = active & !hits.bits(simd);
            let [mut mirror, mut reflective] = [0; 2];
            for (surface, lanes) in points.groups() {
                match &self.materials[surface].model {
                    Model::Emitter => {
                        let weight = self.emitter_weight(simd, surface, &last);
                        let emitted = throughput.times(points.color) * weight;
                        light = emitted.select(simd.mask(lanes), light);
                        ended |= lanes;
                    }
                    Model::Mirror => mirror |= lanes,
                    Model::Reflective(_) => reflective |= lanes,
                    // Rejected when the scene is parsed.
                    Model::Facing | Model::Glass(_) => {}
                }
            }
            sum = (sum + light).select(simd.mask(ended), sum);
            if segment == self.max_depth {
                // Light from here would need a segment more than allowed.
                break;
            }
            let mut next = rays;
            let mut scattered = 0;
            if mirror != 0 {
                let facing = rays.direction.dot(points.normal);
                let direction = rays.direction - points.normal * (two * facing);
                let mask = simd.mask(mirror);
                next.replace(mask, &points.spawn_rays(simd, direction, policy));
                throughput = throughput.times(points.color).select(mask, throughput);
            }
            if reflective != 0 {
                let frame = Frame {
                    normal: points.normal,
                    view: -rays.direction,
                };
                let direct = self.sample_emitters(simd, &points, &frame, streams, policy, reflective);
                sum = (sum + throughput.times(direct)).select(simd.mask(reflective), sum);
                let [u, v] = next_disks(simd, streams, reflective);
                let (mut axis, mut cosine, mut sine) = (points.normal, one, zero);
                for (brdf, lanes) in self.brdfs(&points, reflective) {
                    let (of_brdf, [c, s]) = brdf.sample(simd, &frame, u, lanes);
                    let mask = simd.mask(lanes);
                    axis = of_brdf.select(mask, axis);
                    (cosine, sine) = (c.select(mask, cosine), s.select(mask, sine));
                }
                let direction = spherical_direction(simd, axis, [cosine, sine, v], reflective);
                let cosine = points.normal.dot(direction);
                let scattering = self.scattering(simd, &points, &frame, direction, reflective);
                // Only rounding can produce a direction at the edge of a lobe, where the density is zero.
                let edge = cosine.less_or_equal(zero);
                let without = scattering.density.less_or_equal(zero);
                scattered = reflective & !simd.bits(edge) & !simd.bits(without);
                let mask = simd.mask(scattered);
                let more = throughput.times(scattering.value) * (cosine / scattering.density);
                throughput = more.select(mask, throughput);
                let scattered_rays = points.spawn_rays(simd, direction, policy);
                next.replace(mask, &scattered_rays);
                let at_surface = policy.for_shadow_rays().light_policy().weight_at_surface;
                last = BrdfSamples {
                    density: scattering.density,
                    from: if at_surface {
                        points.point
                    } else {
                        scattered_rays.origin
                    },
                    lanes: 0,
                };
            }
            last.lanes = scattered;
            active = mirror | scattered;
            if active == 0 {
                break;
            }
            rays = next;
            hits = self.nearest_in_lanes(simd, &rays, policy, active);
        }
        sum
    }

    /// Estimates direct light at points from emitters that are selected with uniform probability.
    #[inline(always)]
    fn sample_emitters<S: Lanes<T>>(
        &self,
        simd: S,
        points: &Points<T, S>,
        frame: &Frame<T, S>,
        streams: &mut [SampleStream],
        policy: &impl RayEpsilonPolicy<T>,
        active: u32,
    ) -> Wide3<T, S> {
        let policy = &policy.for_shadow_rays();
        let black = Wide3::splat(simd, [T::zero(); 3]);
        if self.emitters.is_empty() || policy.acne().shadowed_lights != 0 {
            return black;
        }
        let [zero, number, along] =
            [T::zero(), self.number_of_emitters(), policy.along()].map(|number| Wide::splat(simd, number));
        let emitters = self.select_emitters(simd, next_numbers(streams, active), active);
        let from = points.light_ray_origin(simd, policy);
        let cone = Cone::new(simd, emitters.center, emitters.radius, from);
        let (direction, distance) = cone.sample(simd, next_disks(simd, streams, active), active);
        let cosine = points.normal.dot(direction);
        let rays = points.spawn_rays(simd, direction, policy);
        let distance = distance - along;
        let mut visible = active & !simd.bits(cosine.less_or_equal(zero));
        if visible != 0 {
            visible &= !self.occluded_in_lanes(simd, &rays, distance, emitters.surface, policy, visible);
        }
        if visible == 0 {
            return black;
        }
        let density = cone.density(simd) / number;
        let scattering = self.scattering(simd, points, frame, direction, visible);
        let weight = power_heuristic(simd, density, scattering.density);
        let radiance = self.emitted(simd, &emitters, rays.origin + direction * distance);
        let light = radiance.times(scattering.value) * (cosine * weight / density);
        light.select(simd.mask(visible), black)
    }

    fn number_of_emitters(&self) -> T {
        T::from_f64(self.emitters.len() as f64)
    }

    /// Selects an emitter for each lane by a number in [0, 1).
    #[inline(always)]
    fn select_emitters<S: Lanes<T>>(
        &self,
        simd: S,
        numbers: [T; MAX_LANES],
        active: u32,
    ) -> SelectedEmitters<T, S> {
        let mut selected = SelectedEmitters {
            center: Wide3::splat(simd, [T::zero(); 3]),
            radius: Wide::splat(simd, T::one()),
            surface: Wide::splat(simd, T::tag(NO_SURFACE)),
            groups: [(0, 0); MAX_LANES],
            count: 0,
        };
        let number = self.number_of_emitters();
        let which = numbers.map(|u| (u * number).to_usize().unwrap_or(0).min(self.emitters.len() - 1));
        let mut rest = active;
        while rest != 0 {
            let at = which[rest.trailing_zeros() as usize % MAX_LANES];
            let lanes = lanes_of(rest)
                .filter(|&lane| which[lane] == at)
                .fold(0, |lanes, lane| lanes | 1 << lane);
            rest &= !lanes;
            let Emitter {
                surface,
                center,
                radius,
            } = &self.emitters[at];
            let mask = simd.mask(lanes);
            selected.center = Wide3::splat(simd, center.to_array()).select(mask, selected.center);
            selected.radius = Wide::splat(simd, *radius).select(mask, selected.radius);
            let tag = Wide::splat(simd, T::tag(*surface as u32));
            selected.surface = tag.select(mask, selected.surface);
            selected.groups[selected.count % MAX_LANES] = (at, lanes);
            selected.count += 1;
        }
        selected
    }

    /// Returns the radiance of the selected emitters at points of them.
    #[inline(always)]
    fn emitted<S: Lanes<T>>(
        &self,
        simd: S,
        emitters: &SelectedEmitters<T, S>,
        point: Wide3<T, S>,
    ) -> Wide3<T, S> {
        let mut radiance = Wide3::splat(simd, [T::zero(); 3]);
        for &(at, lanes) in emitters.groups.iter().take(emitters.count) {
            let Emitter {
                surface,
                center,
                radius,
            } = &self.emitters[at];
            let material = &self.materials[*surface];
            let color = if let Some(color) = material.uniform_color() {
                Wide3::splat(simd, color.to_array())
            } else {
                let points = Columns::from(point);
                let mut colors = Columns::splat([T::zero(); 3]);
                for lane in lanes_of(lanes) {
                    let point = T::Vec3::from_array(points.get(lane));
                    let color = material.color(|| [point, (point - *center) / *radius]);
                    colors.set(lane, color.to_array());
                }
                colors.load(simd, 0)
            };
            radiance = color.select(simd.mask(lanes), radiance);
        }
        radiance
    }

    /// Returns the weights of an emitter that was hit by BRDF samples.
    #[inline(always)]
    fn emitter_weight<S: Lanes<T>>(&self, simd: S, surface: usize, last: &BrdfSamples<T, S>) -> Wide<T, S> {
        let one = Wide::splat(simd, T::one());
        let Some(emitter) = self.emitters.iter().find(|emitter| emitter.surface == surface) else {
            return one;
        };
        if last.lanes == 0 {
            return one;
        }
        let center = Wide3::splat(simd, emitter.center.to_array());
        let cone = Cone::new(simd, center, Wide::splat(simd, emitter.radius), last.from);
        let number = Wide::splat(simd, self.number_of_emitters());
        let weight = power_heuristic(simd, last.density, cone.density(simd) / number);
        weight.select(simd.mask(last.lanes), one)
    }
}

/// The power heuristic, p² / (p² + q²): the weight of a sample of density p if the other technique has
/// density q.
#[inline(always)]
fn power_heuristic<T: Real, S: Lanes<T>>(simd: S, p: Wide<T, S>, q: Wide<T, S>) -> Wide<T, S> {
    let one = Wide::splat(simd, T::one());
    let ratio = q / p;
    one / (one + ratio * ratio)
}
