//! The surface at the first hit of a single ray.

use super::World;
use crate::lanes::{Columns, Kernel, Lanes, Wide, Wide3};
use crate::ray::{FirstHit, Ray};
use crate::real::{Real, Vector};
use crate::shape::Primitive;
use crate::spheres::{LaneHits, LaneRays, NO_SURFACE};

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Returns the normal and the color of the surface that a camera ray hits.
    pub(crate) fn surface_point(&self, ray: &Ray<T>, first: FirstHit<T>) -> [T::Vec3; 2] {
        T::run_scalar(SurfacePoint {
            world: self,
            ray,
            first,
        })
    }
}

/// Kernel for [`World::surface_point`].
struct SurfacePoint<'a, T: Real, P> {
    world: &'a World<T, P>,
    ray: &'a Ray<T>,
    first: FirstHit<T>,
}

impl<T: Real, P: Primitive<T>> Kernel<T> for SurfacePoint<'_, T, P> {
    type Output = [T::Vec3; 2];

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> [T::Vec3; 2] {
        let [t, surface] = self.first.tagged().map(|number| Wide::splat(simd, number));
        let rays = LaneRays {
            origin: Wide3::splat(simd, self.ray.origin.to_array()),
            direction: Wide3::splat(simd, self.ray.direction.to_array()),
            from: Wide::splat(simd, T::tag(NO_SURFACE)),
        };
        let points = self.world.points(simd, &rays, &LaneHits { t, surface }, 1);
        [points.normal, points.color].map(|vector| T::Vec3::from_array(Columns::from(vector).get(0)))
    }
}
