//! Glass: reflection and refraction at a smooth surface.

use super::super::real::Real;
use crate::scene::Fresnel;

#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Glass<T> {
    /// Inside over outside.
    pub(super) ior: T,
    pub(super) fresnel: Fresnel,
}

/// Where a ray goes that meets glass.
#[derive(Debug)]
pub(in super::super) struct Parted<T: Real> {
    /// The share of light that is reflected.
    pub(in super::super) share: T,
    /// The refracted direction; none where reflection is total.
    pub(in super::super) refracted: Option<T::Vec3>,
}

impl<T: Real> Glass<T> {
    /// By Snell's law; `facing` is d·N with the outward normal.
    pub(in super::super) fn part(&self, direction: T::Vec3, normal: T::Vec3, facing: T) -> Parted<T> {
        let one = T::one();
        // From the side that the ray is on: its index over the other's, and its normal.
        let entering = facing < T::zero();
        let (eta, normal, cosine) = if entering {
            (self.ior.recip(), normal, -facing)
        } else {
            (self.ior, -normal, facing)
        };
        let sine2 = eta * eta * (one - cosine * cosine);
        if sine2 >= one {
            return Parted {
                share: one,
                refracted: None,
            };
        }
        let beyond = (one - sine2).sqrt();
        let half = T::from_f64(0.5);
        let share = match self.fresnel {
            Fresnel::Exact => {
                let across = (eta * cosine - beyond) / (eta * cosine + beyond);
                let along = (cosine - eta * beyond) / (cosine + eta * beyond);
                half * (across * across + along * along)
            }
            Fresnel::Schlick => {
                let normal_share = (one - self.ior) / (one + self.ior);
                let f0 = normal_share * normal_share;
                let m = one - if eta < one { cosine } else { beyond };
                f0 + (one - f0) * (m * m * m * m * m)
            }
        };
        Parted {
            share,
            refracted: Some(direction * eta + normal * (eta * cosine - beyond)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn part(ior: f64, fresnel: Fresnel, direction: DVec3) -> Parted<f64> {
        Glass { ior, fresnel }.part(direction, DVec3::Y, direction.y)
    }

    fn down(angle: f64) -> DVec3 {
        DVec3::new(angle.sin(), -angle.cos(), 0.0)
    }

    #[test]
    fn at_normal_incidence_glass_reflects_four_percent_either_way() {
        for fresnel in [Fresnel::Exact, Fresnel::Schlick] {
            for direction in [-DVec3::Y, DVec3::Y] {
                let parted = part(1.5, fresnel, direction);
                assert!((parted.share - 0.04).abs() < 1e-15);
                assert!((parted.refracted.unwrap() - direction).length() < 1e-15);
            }
        }
    }

    #[test]
    fn sines_are_as_the_indices_and_the_refracted_ray_finds_its_way_back() {
        for degrees in [1.0f64, 20.0, 45.0, 70.0, 89.0] {
            let d = down(degrees.to_radians());
            let parted = part(1.33, Fresnel::Exact, d);
            let inside = parted.refracted.unwrap();
            assert!((inside.x * 1.33 - d.x).abs() < 1e-14 && (inside.length() - 1.0).abs() < 1e-14);
            let back = part(1.33, Fresnel::Exact, -inside);
            assert!((back.refracted.unwrap() + d).length() < 1e-13);
            assert!(
                (back.share - parted.share).abs() < 1e-13,
                "the share is the same both ways"
            );
        }
    }

    #[test]
    fn along_brewsters_angle_only_light_across_the_plane_is_reflected() {
        let n = 1.5f64;
        let share = part(n, Fresnel::Exact, down(n.atan())).share;
        let across = (1.0 - n * n) / (1.0 + n * n);
        assert!((share - 0.5 * across * across).abs() < 1e-15);
    }

    #[test]
    fn beyond_the_critical_angle_all_is_reflected_and_the_share_rises_to_it() {
        let critical = (1.0f64 / 1.5).asin();
        let inside = |angle: f64| {
            let parted = part(1.5, Fresnel::Exact, -down(angle));
            (parted.share, parted.refracted.is_some())
        };
        assert_eq!(inside(critical + 1e-6), (1.0, false));
        let (share, refracted) = inside(critical - 1e-9);
        assert!(refracted && share > 0.99);
    }

    #[test]
    fn energy_is_conserved_across_the_interface() {
        // Stokes: what is not reflected at one side leaves, by the same factor, at the other: T = 1 − F both ways,
        // with T from the transmitted amplitudes (Fresnel 1823).
        let n = 1.5f64;
        for degrees in [0.0f64, 30.0, 60.0, 85.0] {
            let d = down(degrees.to_radians());
            let parted = part(n, Fresnel::Exact, d);
            let (ci, ct) = (-d.y, -parted.refracted.unwrap().y);
            let across = 2.0 * ci / (ci + n * ct);
            let along = 2.0 * ci / (n * ci + ct);
            let through = n * ct / ci * 0.5 * (across * across + along * along);
            assert!((parted.share + through - 1.0).abs() < 1e-14, "{degrees}");
        }
    }
}
