//! Dielectrics: reflection and refraction at smooth surfaces.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use toyproof_scene::Fresnel;

use crate::lanes::{Columns, Kernel, Lanes, MAX_LANES, Wide};
use crate::real::{Real, Vector};

#[derive(Debug, Clone, Copy)]
pub(super) struct Glass<T> {
    /// Index of refraction of the inside relative to the outside.
    pub(super) ior: T,
    pub(super) fresnel: Fresnel,
}

/// Rays that hit glass surfaces; the first `count` entries are valid.
#[derive(Debug)]
pub(super) struct GlassRays<T> {
    pub(super) count: usize,
    directions: Columns<T>,
    /// Outward normals.
    normals: Columns<T>,
    /// Direction · normal.
    facing: Each<T>,
    ior: Each<T>,
    /// 1 for Schlick's approximation, 0 for Fresnel's equations.
    is_schlick: Each<T>,
}

type Each<T> = [T; MAX_LANES];

/// Reflectances and refracted directions of [`GlassRays`].
#[derive(Debug)]
pub(super) struct Refraction<T> {
    /// Fraction of the light that is reflected.
    pub(super) reflectances: Each<T>,
    /// The refracted directions.
    refracted: Columns<T>,
    /// Bit i is set if ray i is totally reflected.
    total_reflections: u32,
}

impl<T: Real> GlassRays<T> {
    pub(super) fn none() -> Self {
        Self {
            count: 0,
            directions: Columns::splat([T::zero(); 3]),
            normals: Columns::splat([T::zero(); 3]),
            facing: [T::zero(); MAX_LANES],
            ior: [T::one(); MAX_LANES],
            is_schlick: [T::zero(); MAX_LANES],
        }
    }

    /// Appends a ray. There is room for [`MAX_LANES`].
    pub(super) fn push(&mut self, glass: &Glass<T>, direction: T::Vec3, normal: T::Vec3, facing: T) {
        let at = self.count;
        self.directions.set(at, direction.to_array());
        self.normals.set(at, normal.to_array());
        self.facing[at] = facing;
        self.ior[at] = glass.ior;
        if glass.fresnel == Fresnel::Schlick {
            self.is_schlick[at] = T::one();
        }
        self.count += 1;
    }
}

impl<T: Real> Refraction<T> {
    /// Returns the refracted direction of a ray, or `None` if it is totally reflected.
    pub(super) fn refracted(&self, at: usize) -> Option<T::Vec3> {
        (self.total_reflections >> at & 1 == 0).then(|| T::Vec3::from_array(self.refracted.get(at)))
    }
}

impl<T: Real> Kernel<T> for &GlassRays<T> {
    type Output = Refraction<T>;

    /// Evaluates Snell's law and the reflectances.
    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Refraction<T> {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|number| Wide::splat(simd, T::from_f64(number)));
        let mut refraction = Refraction {
            reflectances: [T::zero(); MAX_LANES],
            refracted: Columns::splat([T::zero(); 3]),
            total_reflections: 0,
        };
        let mut at = 0;
        while at < self.count {
            let (direction, outward) = (self.directions.load(simd, at), self.normals.load(simd, at));
            let (facing, ior) = (
                Wide::load(simd, &self.facing[at..]),
                Wide::load(simd, &self.ior[at..]),
            );
            // Relative to the side of the ray: its index over that of the other side, and the normal toward
            // it.
            let entering = facing.less(zero);
            let eta = (one / ior).select(entering, ior);
            let normal = outward.select(entering, -outward);
            let cosine = (-facing).select(entering, facing);
            let sin2_refracted = eta * eta * (one - cosine * cosine);
            let total = one.less_or_equal(sin2_refracted);
            let cos_refracted = (one - sin2_refracted).sqrt();
            let perpendicular = (eta * cosine - cos_refracted) / (eta * cosine + cos_refracted);
            let parallel = (cosine - eta * cos_refracted) / (cosine + eta * cos_refracted);
            let fresnel = half * (perpendicular * perpendicular + parallel * parallel);
            let normal_amplitude = (one - ior) / (one + ior);
            let f0 = normal_amplitude * normal_amplitude;
            let m = one - cosine.select(eta.less(one), cos_refracted);
            let schlick = f0 + (one - f0) * (m * m * m * m * m);
            let is_schlick = zero.less(Wide::load(simd, &self.is_schlick[at..]));
            let reflectance = schlick.select(is_schlick, fresnel);
            one.select(total, reflectance)
                .store(&mut refraction.reflectances[at..]);
            let refracted = direction * eta + normal * (eta * cosine - cos_refracted);
            refraction.refracted.store(refracted, at);
            refraction.total_reflections |= simd.bits(total) << at;
            at += S::COUNT;
        }
        refraction
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::lanes::{Level, Vectorized};

    /// Result for one ray that hits the plane y = 0.
    struct Single {
        reflectance: f64,
        refracted: Option<DVec3>,
    }

    fn refract(ior: f64, fresnel: Fresnel, direction: DVec3) -> Single {
        let mut glass_rays = GlassRays::none();
        glass_rays.push(&Glass { ior, fresnel }, direction, DVec3::Y, direction.y);
        let [first, others @ ..] = &Level::all()
            .map(|level| f64::run(level, &glass_rays))
            .collect::<Vec<_>>()[..]
        else {
            unreachable!("every processor has one lane");
        };
        for other in others {
            assert_eq!(other.reflectances[0].to_bits(), first.reflectances[0].to_bits());
            assert_eq!(other.refracted(0), first.refracted(0));
        }
        Single {
            reflectance: first.reflectances[0],
            refracted: first.refracted(0),
        }
    }

    fn down(angle: f64) -> DVec3 {
        DVec3::new(angle.sin(), -angle.cos(), 0.0)
    }

    #[test]
    fn glass_reflects_four_percent_at_normal_incidence() {
        for fresnel in [Fresnel::Exact, Fresnel::Schlick] {
            for direction in [-DVec3::Y, DVec3::Y] {
                let refraction = refract(1.5, fresnel, direction);
                assert!((refraction.reflectance - 0.04).abs() < 1e-15);
                assert!((refraction.refracted.unwrap() - direction).length() < 1e-15);
            }
        }
    }

    #[test]
    fn refraction_follows_snell_and_is_reversible() {
        for degrees in [1.0f64, 20.0, 45.0, 70.0, 89.0] {
            let d = down(degrees.to_radians());
            let refraction = refract(1.33, Fresnel::Exact, d);
            let inside = refraction.refracted.unwrap();
            assert!((inside.x * 1.33 - d.x).abs() < 1e-14 && (inside.length() - 1.0).abs() < 1e-14);
            let back = refract(1.33, Fresnel::Exact, -inside);
            assert!((back.refracted.unwrap() + d).length() < 1e-13);
            assert!(
                (back.reflectance - refraction.reflectance).abs() < 1e-13,
                "the share is the same both ways"
            );
        }
    }

    #[test]
    fn only_perpendicular_polarization_is_reflected_at_brewsters_angle() {
        let n = 1.5f64;
        let reflectance = refract(n, Fresnel::Exact, down(n.atan())).reflectance;
        let perpendicular = (1.0 - n * n) / (1.0 + n * n);
        assert!((reflectance - 0.5 * perpendicular * perpendicular).abs() < 1e-15);
    }

    #[test]
    fn reflection_is_total_beyond_the_critical_angle() {
        let critical = (1.0f64 / 1.5).asin();
        let inside = |angle: f64| {
            let refraction = refract(1.5, Fresnel::Exact, -down(angle));
            (refraction.reflectance, refraction.refracted.is_some())
        };
        assert_eq!(inside(critical + 1e-6), (1.0, false));
        let (reflectance, refracted) = inside(critical - 1e-9);
        assert!(refracted && reflectance > 0.99);
    }

    #[test]
    fn reflected_and_transmitted_energy_sum_to_one() {
        // Energy conservation: T = 1 − F, with T from Fresnel's transmission amplitudes (1823). By Stokes'
        // relations, F is the same from both sides.
        let n = 1.5f64;
        for degrees in [0.0f64, 30.0, 60.0, 85.0] {
            let d = down(degrees.to_radians());
            let refraction = refract(n, Fresnel::Exact, d);
            let (ci, ct) = (-d.y, -refraction.refracted.unwrap().y);
            let perpendicular = 2.0 * ci / (ci + n * ct);
            let parallel = 2.0 * ci / (n * ci + ct);
            let through = n * ct / ci * 0.5 * (perpendicular * perpendicular + parallel * parallel);
            assert!(
                (refraction.reflectance + through - 1.0).abs() < 1e-14,
                "{degrees}"
            );
        }
    }
}
