//! Glass: reflection and refraction at a smooth surface.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use toyproof_scene::Fresnel;

use super::super::lanes::{Columns, Kernel, Lanes, MOST_LANES, Wide};
use super::super::real::{Real, Vector};

#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Glass<T> {
    /// Inside over outside.
    pub(super) ior: T,
    pub(super) fresnel: Fresnel,
}

/// Rays that meet glass: the first `count` are looked at.
#[derive(Debug)]
pub(in super::super) struct Meeting<T> {
    pub(in super::super) count: usize,
    directions: Columns<T>,
    /// Outward.
    normals: Columns<T>,
    /// Direction · normal.
    facing: Each<T>,
    ior: Each<T>,
    /// 1 for Schlick's formula, 0 for Fresnel's.
    is_schlick: Each<T>,
}

type Each<T> = [T; MOST_LANES];

/// Where they go.
#[derive(Debug)]
pub(in super::super) struct Parted<T> {
    /// The shares of light that are reflected.
    pub(in super::super) shares: Each<T>,
    /// The refracted directions.
    refracted: Columns<T>,
    /// Bit i tells of ray i: reflection is total.
    totals: u32,
}

impl<T: Real> Meeting<T> {
    pub(in super::super) fn none() -> Self {
        Self {
            count: 0,
            directions: Columns::splat([T::zero(); 3]),
            normals: Columns::splat([T::zero(); 3]),
            facing: [T::zero(); MOST_LANES],
            ior: [T::one(); MOST_LANES],
            is_schlick: [T::zero(); MOST_LANES],
        }
    }

    /// One more; at most [`MOST_LANES`].
    pub(in super::super) fn add(&mut self, glass: &Glass<T>, direction: T::Vec3, normal: T::Vec3, facing: T) {
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

impl<T: Real> Parted<T> {
    /// The refracted direction of one; none where reflection is total.
    pub(in super::super) fn refracted(&self, at: usize) -> Option<T::Vec3> {
        (self.totals >> at & 1 == 0).then(|| T::Vec3::from_array(self.refracted.get(at)))
    }
}

impl<T: Real> Kernel<T> for &Meeting<T> {
    type Output = Parted<T>;

    /// By Snell's law.
    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) -> Parted<T> {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|number| Wide::splat(simd, T::from_f64(number)));
        let mut parted = Parted {
            shares: [T::zero(); MOST_LANES],
            refracted: Columns::splat([T::zero(); 3]),
            totals: 0,
        };
        let mut at = 0;
        while at < self.count {
            let (direction, outward) = (self.directions.load(simd, at), self.normals.load(simd, at));
            let (facing, ior) = (
                Wide::load(simd, &self.facing[at..]),
                Wide::load(simd, &self.ior[at..]),
            );
            // From the side that the ray is on: its index over the other's, and its normal.
            let entering = facing.less(zero);
            let eta = (one / ior).select(entering, ior);
            let normal = outward.select(entering, -outward);
            let cosine = (-facing).select(entering, facing);
            let sine2 = eta * eta * (one - cosine * cosine);
            let total = one.less_or_equal(sine2);
            let beyond = (one - sine2).sqrt();
            let across = (eta * cosine - beyond) / (eta * cosine + beyond);
            let along = (cosine - eta * beyond) / (cosine + eta * beyond);
            let fresnel = half * (across * across + along * along);
            let normal_share = (one - ior) / (one + ior);
            let f0 = normal_share * normal_share;
            let m = one - cosine.select(eta.less(one), beyond);
            let schlick = f0 + (one - f0) * (m * m * m * m * m);
            let is_schlick = zero.less(Wide::load(simd, &self.is_schlick[at..]));
            let share = schlick.select(is_schlick, fresnel);
            one.select(total, share).store(&mut parted.shares[at..]);
            let refracted = direction * eta + normal * (eta * cosine - beyond);
            parted.refracted.store(refracted, at);
            parted.totals |= simd.bits(total) << at;
            at += S::COUNT;
        }
        parted
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::super::lanes::{Level, Vectorised};
    use super::*;

    /// What becomes of a ray that comes to the plane y = 0.
    struct One {
        share: f64,
        refracted: Option<DVec3>,
    }

    fn part(ior: f64, fresnel: Fresnel, direction: DVec3) -> One {
        let mut meeting = Meeting::none();
        meeting.add(&Glass { ior, fresnel }, direction, DVec3::Y, direction.y);
        let [first, others @ ..] = &Level::all()
            .map(|level| f64::run(level, &meeting))
            .collect::<Vec<_>>()[..]
        else {
            unreachable!("every processor has one lane");
        };
        for other in others {
            assert_eq!(other.shares[0].to_bits(), first.shares[0].to_bits());
            assert_eq!(other.refracted(0), first.refracted(0));
        }
        One {
            share: first.shares[0],
            refracted: first.refracted(0),
        }
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
