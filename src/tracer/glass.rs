//! Dielectrics: reflection and refraction at smooth surfaces.

use toyproof_scene::Fresnel;

use crate::lanes::{Lanes, Wide, Wide3};
use crate::real::Real;

#[derive(Debug, Clone, Copy)]
pub(super) struct Glass<T> {
    /// Index of refraction of the inside relative to the outside.
    pub(super) ior: T,
    pub(super) fresnel: Fresnel,
}

impl<T> Glass<T> {
    /// Returns whether reflectances are Schlick's approximation.
    pub(super) fn is_schlick(&self) -> bool {
        self.fresnel == Fresnel::Schlick
    }
}

/// Rays that hit glass surfaces, one per lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct GlassHits<T, S: Lanes<T>> {
    pub(super) direction: Wide3<T, S>,
    /// Outward normal.
    pub(super) normal: Wide3<T, S>,
    /// Direction · normal.
    pub(super) facing: Wide<T, S>,
    pub(super) ior: Wide<T, S>,
    /// Lanes with Schlick's approximation; the others have Fresnel's equations.
    pub(super) schlick: u32,
}

/// Reflectances and refracted directions of [`GlassHits`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Refraction<T, S: Lanes<T>> {
    /// Fraction of the light that is reflected.
    pub(super) reflectance: Wide<T, S>,
    /// The refracted direction, which is meaningless in lanes of total reflection.
    pub(super) refracted: Wide3<T, S>,
    /// Lanes of total reflection.
    pub(super) total: u32,
}

impl<T: Real, S: Lanes<T>> GlassHits<T, S> {
    /// Evaluates Snell's law and the reflectances.
    #[inline(always)]
    pub(super) fn refract(self, simd: S) -> Refraction<T, S> {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|number| Wide::splat(simd, T::from_f64(number)));
        let Self {
            direction,
            normal,
            facing,
            ior,
            schlick,
        } = self;
        // Relative to the side of the ray: its index over that of the other side, and the normal toward it.
        let entering = facing.less(zero);
        let eta = (one / ior).select(entering, ior);
        let normal = normal.select(entering, -normal);
        let cosine = (-facing).select(entering, facing);
        let sin2_refracted = eta * eta * (one - cosine * cosine);
        let total = one.less_or_equal(sin2_refracted);
        let cos_refracted = (one - sin2_refracted).sqrt();
        let perpendicular = (eta * cosine - cos_refracted) / (eta * cosine + cos_refracted);
        let parallel = (cosine - eta * cos_refracted) / (cosine + eta * cos_refracted);
        let mut reflectance = half * (perpendicular * perpendicular + parallel * parallel);
        if schlick != 0 {
            let normal_amplitude = (one - ior) / (one + ior);
            let f0 = normal_amplitude * normal_amplitude;
            let m = one - cosine.select(eta.less(one), cos_refracted);
            let approximation = f0 + (one - f0) * (m * m * m * m * m);
            reflectance = approximation.select(simd.mask(schlick), reflectance);
        }
        Refraction {
            reflectance: one.select(total, reflectance),
            refracted: direction * eta + normal * (eta * cosine - cos_refracted),
            total: simd.bits(total),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::lanes::{Columns, Kernel, Level, Vectorized};

    /// Result for one ray that hits the plane y = 0.
    struct Single {
        reflectance: f64,
        refracted: Option<DVec3>,
    }

    /// One ray, in all lanes.
    struct OneRay {
        glass: Glass<f64>,
        direction: DVec3,
    }

    impl Kernel<f64> for OneRay {
        type Output = Single;

        #[inline(always)]
        fn run<S: Lanes<f64>>(self, simd: S) -> Single {
            let hits = GlassHits {
                direction: Wide3::splat(simd, self.direction.to_array()),
                normal: Wide3::splat(simd, [0.0, 1.0, 0.0]),
                facing: Wide::splat(simd, self.direction.y),
                ior: Wide::splat(simd, self.glass.ior),
                schlick: if self.glass.is_schlick() { u32::MAX } else { 0 },
            };
            let refraction = hits.refract(simd);
            Single {
                reflectance: refraction.reflectance.to_array()[0],
                refracted: (refraction.total & 1 == 0)
                    .then(|| DVec3::from_array(Columns::from(refraction.refracted).get(0))),
            }
        }
    }

    fn refract(ior: f64, fresnel: Fresnel, direction: DVec3) -> Single {
        let glass = Glass { ior, fresnel };
        let all = Level::all().map(|level| f64::run(level, OneRay { glass, direction }));
        let mut all = all.collect::<Vec<_>>();
        let first = all.remove(0);
        for other in all {
            assert_eq!(other.reflectance.to_bits(), first.reflectance.to_bits());
            assert_eq!(other.refracted, first.refracted);
        }
        first
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
