//! Ray–sphere intersection, in lanes: of one ray with several spheres, or of several rays with one.
//!
//! The recentred discriminant and the stable roots of Haines, Günther and Akenine-Möller, “Precision Improvements for
//! Ray/Sphere Intersection”, Ray Tracing Gems (2019), chapter 7: with f = o − c and b = −f·d,
//! disc = r² − |f + (b/a) d|², q = b + sign(b) √(a·disc), t₀ = (f·f − r²)/q, t₁ = q/a.
//!
//! Lengths are in units of the sphere: the power of two at or below its radius, by which dividing is exact. So spheres of any
//! size have the accuracy of one near 1.

use super::super::lanes::{Kernel, Lanes, MOST_LANES, Wide, Wide3};
use super::super::real::Real;

/// The power of two that lengths of a sphere are counted in; 1 where the radius is none that is normal.
pub(super) fn unit<T: Real>(radius: T) -> T {
    if radius.is_normal() {
        radius.power_of_two()
    } else {
        T::one()
    }
}

/// f·d, and disc, which is negative or NaN where there is no hit; `per_a` is 1/a. NaN is too far away to tell.
#[inline(always)]
pub(super) fn discriminant<T: Real, S: Lanes<T>>(
    f: Wide3<T, S>,
    d: Wide3<T, S>,
    per_a: Wide<T, S>,
    radius2: Wide<T, S>,
) -> [Wide<T, S>; 2] {
    let along = f.dot(d);
    let closest = f - d * (along * per_a);
    [along, radius2 - closest.dot(closest)]
}

/// What the roots are made of.
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
    /// The smaller t if it lies beyond `t_min`, else the larger one, wherever that lies.
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

/// Where a ray that starts on a sphere meets it again, at t = −2 d·(o − c) / a, which is not above 0 where the ray leaves it.
#[inline(always)]
pub(super) fn other_root<T: Real, S: Lanes<T>>(
    simd: S,
    along: Wide<T, S>,
    a: Wide<T, S>,
    unit: Wide<T, S>,
) -> Wide<T, S> {
    Wide::splat(simd, T::from_f64(-2.0)) * along / a * unit
}

/// One ray and one sphere.
#[derive(Debug)]
pub(in super::super) struct Meet<T> {
    pub(in super::super) origin: [T; 3],
    pub(in super::super) direction: [T; 3],
    pub(in super::super) center: [T; 3],
    pub(in super::super) radius: T,
    pub(in super::super) t_min: T,
    /// Whether the ray starts on the sphere: that start is no hit.
    pub(in super::super) is_own: bool,
}

impl<T: Real> Kernel<T> for Meet<T> {
    /// The smallest t > `t_min`.
    type Output = Option<T>;

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Option<T> {
        let unit = unit(self.radius);
        let scaled = self.radius / unit;
        let [unit, per_unit, radius2, t_min] =
            [unit, unit.recip(), scaled * scaled, self.t_min].map(|number| Wide::splat(simd, number));
        let d = Wide3::splat(simd, self.direction);
        let f = (Wide3::splat(simd, self.origin) - Wide3::splat(simd, self.center)) * per_unit;
        let a = d.dot(d);
        let mut t = [T::zero(); MOST_LANES];
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
