//! Samples traced side by side, each in a lane.

use toyproof_scene::Integrator;

use super::World;
use super::whitted::DeferredRays;
use crate::lanes::{Kernel, Lanes, Wide, Wide3};
use crate::ray::{FirstHit, Ray};
use crate::ray_epsilon::{Exact, RayEpsilonPolicy};
use crate::real::{Real, Vector};
use crate::sampler::SampleStream;
use crate::shape::Primitive;
use crate::spheres::{LaneHits, LaneRays, NO_SURFACE};

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Computes the radiance along a camera ray with the given first hit.
    pub(crate) fn radiance(
        &self,
        ray: Ray<T>,
        first: FirstHit<T>,
        mut stream: SampleStream,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> T::Vec3 {
        let [origins, directions] =
            [ray.origin, ray.direction].map(|vector| vector.to_array().map(|component| [component]));
        let [t, surface] = first.tagged().map(|number| [number]);
        let mut radiance = [[T::zero()]; 3];
        let samples = Samples {
            origins: each_slice(&origins),
            directions: each_slice(&directions),
            t: &t,
            surfaces: &surface,
            active: 1,
            streams: std::slice::from_mut(&mut stream),
            radiance: radiance.each_mut().map(|component| &mut component[..]),
        };
        T::run_scalar(Trace {
            world: self,
            samples,
            policy,
        });
        let [[r], [g], [b]] = radiance;
        T::Vec3::new(r, g, b)
    }

    /// Computes the radiance along many camera rays.
    pub(crate) fn trace(&self, samples: Samples<'_, T>) {
        T::run(
            self.level,
            Trace {
                world: self,
                samples,
                policy: &Exact,
            },
        );
    }
}

/// Samples whose camera rays have been traced, and their radiance. The number of samples is a multiple of the
/// number of lanes.
pub(crate) struct Samples<'a, T: Real> {
    pub(crate) origins: [&'a [T]; 3],
    pub(crate) directions: [&'a [T]; 3],
    /// t of the first hits, infinite for none.
    pub(crate) t: &'a [T],
    /// The surfaces of the first hits, encoded by [`Real::tag`].
    pub(crate) surfaces: &'a [T],
    /// Bit i is set if sample i is to be traced.
    pub(crate) active: u64,
    /// The random numbers of each sample.
    pub(crate) streams: &'a mut [SampleStream],
    /// Receives the components of the radiance of each active sample.
    pub(crate) radiance: [&'a mut [T]; 3],
}

pub(crate) fn each_slice<T, const N: usize>(arrays: &[[T; N]; 3]) -> [&[T]; 3] {
    arrays.each_ref().map(|array| &array[..])
}

/// Kernel that traces samples, each in a lane.
struct Trace<'a, T: Real, P, R> {
    world: &'a World<T, P>,
    samples: Samples<'a, T>,
    policy: &'a R,
}

impl<T: Real, P: Primitive<T>, R: RayEpsilonPolicy<T>> Kernel<T> for Trace<'_, T, P, R> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let Self {
            world,
            samples,
            policy,
        } = self;
        let mut radiance = samples.radiance;
        let mut deferred = DeferredRays::none();
        let mut at = 0;
        while at < samples.t.len() {
            let active = (samples.active >> at) as u32 & (u32::MAX >> (32 - S::COUNT));
            if active != 0 {
                let rays = LaneRays {
                    origin: Wide3::load_slices(simd, samples.origins.map(|of| &of[at..])),
                    direction: Wide3::load_slices(simd, samples.directions.map(|of| &of[at..])),
                    from: Wide::splat(simd, T::tag(NO_SURFACE)),
                };
                let hits = LaneHits {
                    t: Wide::load(simd, &samples.t[at..]),
                    surface: Wide::load(simd, &samples.surfaces[at..]),
                };
                let streams = &mut samples.streams[at..];
                let Wide3(r, g, b) = match world.integrator {
                    Integrator::Whitted => {
                        let state = (streams, &mut deferred);
                        world.whitted(simd, rays, hits, state, active, policy)
                    }
                    Integrator::Path => world.path(simd, rays, hits, streams, active, policy),
                };
                let mask = simd.mask(active);
                for (all, new) in radiance.iter_mut().zip([r, g, b]) {
                    let before = Wide::load(simd, &all[at..]);
                    new.select(mask, before).store(&mut all[at..]);
                }
            }
            at += S::COUNT;
        }
    }
}
