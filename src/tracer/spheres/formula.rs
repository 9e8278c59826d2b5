//! Ray–sphere intersection in lanes: one ray and several spheres, or several rays and one sphere.
//!
//! The recentered discriminant and the stable roots of Haines, Günther and Akenine-Möller, “Precision
//! Improvements for Ray/Sphere Intersection”, Ray Tracing Gems (2019), chapter 7: with f = o − c and b =
//! −f·d, disc = r² − |f + (b/a) d|², q = b + sign(b) √(a·disc), t₀ = (f·f − r²)/q, t₁ = q/a.
//!
//! Lengths are in units of the sphere: the largest power of two not above its radius, by which division is
//! exact. So the accuracy is the same for spheres of any size.

use crate::lanes::{Kernel, Lanes, MAX_LANES, Wide, Wide3};
use crate::real::Real;

/// Number of spheres in a block and of boxes in a node.
pub(super) const BLOCK_SIZE: usize = 8;
pub(super) type Eight<T> = [T; BLOCK_SIZE];

/// The index that stands for no surface.
pub(crate) const NO_SURFACE: u32 = u32::MAX;

/// A sphere: its center, radius, and index among the surfaces of the scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NumberedSphere<T> {
    pub(crate) center: [T; 3],
    pub(crate) radius: T,
    pub(crate) number: u32,
}

/// Returns the unit of length of a sphere, a power of two; 1 if the radius is not a normal number.
pub(super) fn unit<T: Real>(radius: T) -> T {
    if radius.is_normal() {
        radius.power_of_two()
    } else {
        T::one()
    }
}

/// Returns f·d and the discriminant, which is negative or NaN if there is no hit; `inverse_a` is 1/a. NaN
/// means that the sphere is too far away for the number type.
#[inline(always)]
pub(super) fn discriminant<T: Real, S: Lanes<T>>(
    f: Wide3<T, S>,
    d: Wide3<T, S>,
    inverse_a: Wide<T, S>,
    radius2: Wide<T, S>,
) -> [Wide<T, S>; 2] {
    let along = f.dot(d);
    let closest = f - d * (along * inverse_a);
    [along, radius2 - closest.dot(closest)]
}

/// The quantities from which roots are computed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Roots<T, S: Lanes<T>> {
    /// f·d
    pub(super) along: Wide<T, S>,
    pub(super) disc: Wide<T, S>,
    pub(super) a: Wide<T, S>,
    /// f·f − r²
    pub(super) c: Wide<T, S>,
    pub(super) unit: Wide<T, S>,
}

impl<T: Real, S: Lanes<T>> Roots<T, S> {
    /// Returns the smaller root if it is beyond `t_min`, else the larger one, wherever it is.
    #[inline(always)]
    pub(super) fn beyond(self, simd: S, t_min: Wide<T, S>) -> Wide<T, S> {
        let b = -self.along;
        let sign = b.and(Wide::splat(simd, -T::zero()));
        let q = b + (self.a * self.disc).sqrt().or(sign);
        let (one, other) = (self.c / q, q / self.a);
        let in_order = one.less(other);
        let near = one.select(in_order, other) * self.unit;
        let far = other.select(in_order, one) * self.unit;
        near.select(t_min.less(near), far)
    }
}

/// Returns the second root for a ray that starts on the sphere, t = −2 d·(o − c) / a. It is not positive if
/// the ray leaves the sphere.
#[inline(always)]
pub(super) fn other_root<T: Real, S: Lanes<T>>(
    simd: S,
    along: Wide<T, S>,
    a: Wide<T, S>,
    unit: Wide<T, S>,
) -> Wide<T, S> {
    Wide::splat(simd, T::from_f64(-2.0)) * along / a * unit
}

/// Kernel that intersects one ray with one sphere.
#[derive(Debug)]
pub(crate) struct IntersectSphere<T> {
    pub(crate) origin: [T; 3],
    pub(crate) direction: [T; 3],
    pub(crate) center: [T; 3],
    pub(crate) radius: T,
    pub(crate) t_min: T,
    /// Whether the ray starts on the sphere; its start is not a hit.
    pub(crate) is_own: bool,
}

impl<T: Real> Kernel<T> for IntersectSphere<T> {
    /// The smallest t > `t_min`, if any.
    type Output = Option<T>;

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Option<T> {
        let unit = unit(self.radius);
        let scaled = self.radius / unit;
        let [unit, inverse_unit, radius2, t_min] =
            [unit, unit.recip(), scaled * scaled, self.t_min].map(|number| Wide::splat(simd, number));
        let d = Wide3::splat(simd, self.direction);
        let f = (Wide3::splat(simd, self.origin) - Wide3::splat(simd, self.center)) * inverse_unit;
        let a = d.dot(d);
        let mut t = [T::zero(); MAX_LANES];
        if self.is_own {
            other_root(simd, f.dot(d), a, unit).store(&mut t);
            return (t[0] > self.t_min).then_some(t[0]);
        }
        let [along, disc] = discriminant(f, d, Wide::splat(simd, T::one()) / a, radius2);
        if simd.bits(Wide::splat(simd, T::zero()).less_or_equal(disc)) == 0 {
            return None;
        }
        let roots = Roots {
            along,
            disc,
            a,
            c: f.dot(f) - radius2,
            unit,
        };
        roots.beyond(simd, t_min).store(&mut t);
        (t[0] > self.t_min).then_some(t[0])
    }
}
