//! Shapes at every scale, in the manner of pbrt's tests of shapes: coordinates are drawn log-uniformly.

use dashu_ratio::RBig;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use toyproof_image::pcg;
use toyproof_scene::{self as scene, QuadricKind, unit};

use super::super::ray::{Hit, Ray};
use super::super::real::{Real, Vector};
use super::super::style::Exact;
use super::{Plane, Primitive, Quadric, Shape, Sphere};

/// Numbers drawn by hashing, the same in every run.
struct Random(u32);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = pcg(self.0);
        // 48 bits, so that f64's are not all round ones.
        let high = unit(self.0);
        self.0 = pcg(self.0);
        high + unit(self.0) / f64::from(1 << 24)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.number()
    }

    /// ± 10^x, x between the two.
    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        let sign = if self.number() < 0.5 { -1.0 } else { 1.0 };
        sign * 10f64.powf(self.between(low, high))
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::from_array([0; 3].map(|_| self.between(-1.0, 1.0)));
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    fn place(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.log_uniform(low, high)))
    }
}

fn toward<T: Real>(origin: DVec3, target: DVec3) -> Ray<T> {
    Ray {
        origin: T::Vec3::from_f64(origin.to_array()),
        direction: (T::Vec3::from_f64(target.to_array()) - T::Vec3::from_f64(origin.to_array())).normalize(),
        from: None,
    }
}

fn double<T: Real>(v: T::Vec3) -> DVec3 {
    DVec3::from_array(v.to_array().map(Real::to_f64))
}

/// A shape of any kind around a point, of about that size.
fn shape(random: &mut Random, center: DVec3, size: f64) -> scene::Shape {
    let center = center.to_array();
    let axis = random.direction().to_array();
    let (radius, height) = (size * random.between(0.5, 1.0), size * random.between(0.5, 1.0));
    let around = |kind| scene::Shape::Quadric(scene::Quadric::around(axis, center, kind));
    match (random.number() * 7.0) as u32 {
        0 => scene::Shape::Sphere { center, radius },
        1 => scene::Shape::Plane {
            point: center,
            normal: axis,
        },
        2 => around(QuadricKind::Ellipsoid {
            radii: [radius, height, size],
        }),
        3 => around(QuadricKind::Cylinder { radius, height }),
        4 => around(QuadricKind::Cone { radius, height }),
        5 => around(QuadricKind::Paraboloid { radius, height }),
        _ => around(QuadricKind::Hyperboloid {
            waist: 0.5 * radius,
            radius,
            height,
        }),
    }
}

/// A ray from a surface to anywhere on the side that it leaves to never meets a convex surface again.
fn self_hits<T: Real>(seeds: u32, sizes: [f64; 2], offsets: [f64; 2]) -> (u32, u32) {
    let (mut rays, mut hits) = (0, 0);
    for seed in 0..seeds {
        let random = &mut Random(seed);
        let size = random.log_uniform(sizes[0], sizes[1]).abs();
        let center = random.place(offsets[0], offsets[1]);
        let convex = [
            scene::Shape::Sphere {
                center: center.to_array(),
                radius: size,
            },
            scene::Shape::Quadric(scene::Quadric::around(
                random.direction().to_array(),
                center.to_array(),
                QuadricKind::Ellipsoid {
                    radii: [size, 0.5 * size, 0.25 * size],
                },
            )),
        ];
        let shape = Shape::<T>::new(&convex[(random.number() * 2.0) as usize]);
        let distance = size * random.log_uniform(0.5, 2.0).abs();
        let ray = toward::<T>(center + random.direction() * distance, center);
        let Some(t) = shape.intersect(&ray, &Exact) else {
            continue;
        };
        let [point, normal] = shape.surface(&ray, t);
        let hit = Hit {
            point,
            normal,
            surface: 0,
        };
        for _ in 0..8 {
            let direction = random.direction();
            let normal = double::<T>(normal).normalize();
            let outward = normal.dot(direction);
            // Grazing rays as well: down to 1e−6 of the normal.
            let tilt = random.log_uniform(-6.0, 0.0).abs();
            let out = direction - normal * (outward - tilt);
            let leaving = hit.leave(T::Vec3::from_f64(out.normalize().to_array()), &Exact);
            rays += 1;
            hits += u32::from(shape.intersect_own(&leaving, &Exact).is_some());
        }
    }
    (rays, hits)
}

#[test]
fn no_ray_that_leaves_a_convex_surface_meets_it_again() {
    // Radius 10^±6, origin offset 10^±8; in float32, whose coordinates hold fewer digits, near the origin.
    let (rays, hits) = self_hits::<f64>(140_000, [-6.0, 6.0], [-8.0, 8.0]);
    assert!(rays > 1_000_000, "only {rays} rays");
    let (_, single) = self_hits::<f32>(20_000, [-6.0, 6.0], [-8.0, -6.0]);
    assert_eq!((hits, single), (0, 0), "of {rays} rays");
}

/// What a ray finds that leaves one sphere for another which nearly touches it.
#[test]
fn no_neighbour_is_lost_beyond_the_rounding_of_its_own_place() {
    let (mut rays, mut lost) = (0, 0);
    for seed in 0..100_000 {
        let random = &mut Random(seed);
        let radius = random.log_uniform(-6.0, 6.0).abs();
        let center = random.place(-8.0, 8.0);
        let out = random.direction();
        // The gap is 64 units in the last place of the largest coordinate, or 1e−12 of the radius.
        let gap = (64.0 * f64::EPSILON * (center.abs().max_element() + radius)).max(1e-12 * radius);
        let other = random.between(0.1, 10.0) * radius;
        let neighbour = Sphere::<f64>::new((center + out * (radius + gap + other)).to_array(), other);
        let own = Sphere::<f64>::new(center.to_array(), radius);
        let ray = toward::<f64>(center + out * (radius + 0.5 * gap), center);
        let Some(t) = own.intersect(&ray, &Exact) else {
            continue;
        };
        let [point, normal] = own.surface(&ray, t);
        let hit = Hit {
            point,
            normal,
            surface: 0,
        };
        rays += 1;
        lost += u32::from(neighbour.intersect(&hit.leave(out, &Exact), &Exact).is_none());
    }
    assert!(rays > 50_000);
    assert_eq!(lost, 0);
}

/// Every shape is met where it is, from anywhere and at any size: the hit lies on it up to rounding.
fn residuals<T: Real>(seeds: u32, sizes: [f64; 2], room: f64) -> u32 {
    let mut met = 0;
    for seed in 0..seeds {
        let random = &mut Random(seed);
        let size = random.log_uniform(sizes[0], sizes[1]).abs();
        let center = random.direction() * (size * random.between(0.0, 3.0));
        let described = shape(random, center, size);
        let shape = Shape::<T>::new(&described);
        let eye = center + random.direction() * (size * random.between(1.5, 10.0));
        let ray = toward::<T>(eye, center + random.direction() * (0.3 * size));
        let Some(t) = shape.intersect(&ray, &Exact) else {
            continue;
        };
        met += 1;
        let [point, normal] = shape.surface(&ray, t);
        // Off the surface, in units of the size, to first order: f / |∇f|.
        let off = distance(&described, double::<T>(point)) / size;
        assert!(off < room, "seed {seed}: {described:?} is missed by {off:.1e}");
        assert!((double::<T>(normal).length() - 1.0).abs() < room, "seed {seed}");
    }
    met
}

/// The distance of a point from an unbounded surface, to first order.
fn distance(shape: &scene::Shape, point: DVec3) -> f64 {
    match shape {
        scene::Shape::Sphere { center, radius } => {
            (point.distance(DVec3::from_array(*center)) - radius).abs()
        }
        scene::Shape::Plane { point: on, normal } => DVec3::from_array(*normal)
            .dot(point - DVec3::from_array(*on))
            .abs(),
        scene::Shape::Quadric(quadric) => {
            let p = point - DVec3::from_array(quadric.origin);
            let [x, y, z] = quadric.axes.map(|axis| DVec3::from_array(axis).dot(p));
            let rho = x.hypot(y);
            let (f, slope) = match quadric.kind {
                QuadricKind::Ellipsoid { radii: [a, b, c] } => {
                    let gradient = DVec3::new(x / a / a, y / b / b, z / c / c);
                    let f = (x / a).powi(2) + (y / b).powi(2) + (z / c).powi(2) - 1.0;
                    return (f / (2.0 * gradient.length())).abs();
                }
                QuadricKind::Cylinder { radius, .. } => (rho - radius, 0.0),
                QuadricKind::Cone { radius, height } => (rho - radius / height * z.abs(), radius / height),
                QuadricKind::Paraboloid { radius, height } => {
                    let s = radius * (radius / height);
                    ((rho * rho - s * z) / (2.0 * rho).hypot(s), 0.0)
                }
                QuadricKind::Hyperboloid {
                    waist,
                    radius,
                    height,
                } => {
                    let s = (radius * radius - waist * waist) / (0.25 * height * height);
                    (
                        (rho * rho - waist * waist - s * z * z) / (2.0 * rho).hypot(2.0 * s * z),
                        0.0,
                    )
                }
            };
            f.abs() / slope.hypot(1.0)
        }
    }
}

#[test]
fn every_shape_is_met_where_it_is_at_every_size() {
    let met = [
        residuals::<f64>(20_000, [-30.0, 30.0], 1e-11),
        residuals::<f32>(20_000, [-30.0, 30.0], 2e-3),
    ];
    assert!(met.iter().all(|met| *met > 10_000), "{met:?}");
}

#[test]
fn a_ray_along_a_cylinder_and_a_ray_in_a_plane_meet_nothing() {
    let kind = QuadricKind::Cylinder {
        radius: 1.0,
        height: 2.0,
    };
    let cylinder = Quadric::<f64>::new(&scene::Quadric::around([0.0, 1.0, 0.0], [0.0; 3], kind));
    let plane = Plane::<f64>::new([0.0; 3], [1.0, 0.0, 0.0]);
    for x in [0.0, 0.5, 1.0, 2.0] {
        let ray = toward::<f64>(DVec3::new(x, -5.0, 0.0), DVec3::new(x, 5.0, 0.0));
        assert_eq!(cylinder.intersect(&ray, &Exact), None, "{x}");
        assert_eq!(plane.intersect(&ray, &Exact), None, "{x}");
    }
    // Nearly along it: the root that stays.
    let ray = toward::<f64>(DVec3::new(0.0, -1e9, 0.0), DVec3::new(1.0, 1.0, 0.0));
    let t = cylinder.intersect(&ray, &Exact).unwrap();
    assert!((t - 1e9 - 1.0).abs() < 1e-5, "{t}");
}

#[test]
fn a_ray_along_the_axis_of_a_paraboloid_meets_its_apex_once() {
    let kind = QuadricKind::Paraboloid {
        radius: 1.0,
        height: 1.0,
    };
    let quadric = scene::Quadric::around([0.0, 0.0, 1.0], [0.0, 0.0, -6.0], kind);
    let bowl = Quadric::<f64>::new(&quadric);
    let ray = toward::<f64>(DVec3::ZERO, DVec3::NEG_Z);
    assert_eq!(bowl.intersect(&ray, &Exact), Some(6.0));
}

/// Exactly: whether the line through `o` along `d`, whatever its length, meets the sphere, and whether ahead; and
/// δ = (r² − squared distance) / r².
fn exact(o: [f32; 3], d: [f32; 3], c: [f32; 3], r: f32) -> (bool, f64) {
    let exact = |x: f32| RBig::try_from(x).unwrap();
    let dot = |a: &[RBig; 3], b: &[RBig; 3]| &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2];
    let d = d.map(exact);
    let f = [0, 1, 2].map(|i| exact(o[i]) - exact(c[i]));
    let (a, b, r) = (dot(&d, &d), dot(&d, &f), exact(r));
    let r2 = &r * &r;
    let outside = dot(&f, &f) - &r2;
    let disc = &b * &b - &a * &outside;
    let delta = (&disc / (&a * r2)).to_f64().value();
    let ahead = b < RBig::ZERO || outside < RBig::ZERO;
    (disc >= RBig::ZERO && ahead, delta)
}

#[test]
fn hit_or_miss_is_exact_but_within_a_stated_distance_from_tangency() {
    let mut decided = 0u32;
    for seed in 0..60_000 {
        let random = &mut Random(seed);
        let single = |v: DVec3| v.to_array().map(|x| x as f32);
        let r = random.log_uniform(-4.0, 4.0).abs() as f32;
        let c = single(random.place(-4.0, 4.0));
        let distance = f64::from(r) * random.log_uniform(-1.0, 6.0).abs();
        let center = DVec3::from_array(c.map(f64::from));
        let o = single(center + random.direction() * distance);
        let origin = DVec3::from_array(o.map(f64::from));
        // Close to the silhouette: the target is r away from the centre, more or less by down to 1e−14.
        let across = (center - origin).cross(random.direction()).normalize_or(DVec3::X);
        let aside = f64::from(r) * (1.0 + random.log_uniform(-14.0, 0.0));
        let d = single(center + across * aside - origin);
        let direction = DVec3::from_array(d.map(f64::from));
        if direction == DVec3::ZERO || origin.distance(center) < f64::from(r) * 1.001 {
            continue;
        }
        let (hits, delta) = exact(o, d, c, r);
        let ratio = origin.distance(center) / f64::from(r);
        if delta.abs() <= 64.0 * f64::EPSILON / 2.0 * (ratio + 1.0) {
            continue;
        }
        decided += 1;
        let sphere = Sphere::<f64>::new(c.map(f64::from), f64::from(r));
        let ray = Ray {
            origin,
            // Of any length: the intersection asks for none, and normalising would round.
            direction,
            from: None,
        };
        let told = sphere.intersect(&ray, &Exact).is_some();
        assert_eq!(told, hits, "seed {seed}: δ = {delta:.1e}, L/r = {ratio:.1e}");
    }
    assert!(decided > 40_000);
}

/// A ray and a sphere that it may meet.
fn meeting() -> impl Strategy<Value = ([f64; 3], [f64; 3], [f64; 3], f64)> {
    let coordinate = || prop::array::uniform3(-10.0..10.0f64);
    (coordinate(), coordinate(), coordinate(), 0.1..5.0f64)
}

fn t(o: DVec3, target: DVec3, c: DVec3, r: f64) -> Option<f64> {
    let ray = toward::<f64>(o, target);
    Sphere::<f64>::new(c.to_array(), r).intersect(&ray, &Exact)
}

/// Whether the question hangs by a hair.
fn grazes(o: DVec3, target: DVec3, c: DVec3, r: f64) -> bool {
    let d = (target - o).normalize_or_zero();
    let f = o - c;
    let off = (f - d * f.dot(d)).length() / r;
    d == DVec3::ZERO || (off - 1.0).abs() < 1e-6 || (f.length() / r - 1.0).abs() < 1e-6
}

fn agree(a: Option<f64>, b: Option<f64>, factor: f64) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a * factor - b).abs() <= 1e-9 * b.abs().max(factor),
        (a, b) => a == b,
    }
}

proptest! {
    #[test]
    fn t_scales_with_the_scene((o, target, c, r) in meeting(), exponent in -30.0..30.0f64) {
        let [o, target, c] = [o, target, c].map(DVec3::from_array);
        prop_assume!(!grazes(o, target, c, r));
        let s = 10f64.powf(exponent);
        prop_assert!(agree(t(o, target, c, r), t(o * s, target * s, c * s, r * s), s));
        // By a power of two, to the bit.
        let s = 2f64.powi(exponent as i32);
        prop_assert_eq!(t(o, target, c, r).map(|t| t * s), t(o * s, target * s, c * s, r * s));
    }

    #[test]
    fn t_stays_when_the_scene_is_moved_turned_or_its_axes_swapped(
        (o, target, c, r) in meeting(),
        shift in prop::array::uniform3(-100.0..100.0f64),
        axis in prop::array::uniform3(0.1..1.0f64),
        angle in 0.0..std::f64::consts::TAU,
    ) {
        let [o, target, c] = [o, target, c].map(DVec3::from_array);
        prop_assume!(!grazes(o, target, c, r));
        let before = t(o, target, c, r);
        let shift = DVec3::from_array(shift);
        prop_assert!(agree(before, t(o + shift, target + shift, c + shift, r), 1.0));
        let turn = DQuat::from_axis_angle(DVec3::from_array(axis).normalize(), angle);
        prop_assert!(agree(before, t(turn * o, turn * target, turn * c, r), 1.0));
        let swap = |v: DVec3| DVec3::new(v.y, v.z, v.x);
        prop_assert!(agree(before, t(swap(o), swap(target), swap(c), r), 1.0));
    }

    #[test]
    fn a_sphere_is_an_ellipsoid_of_equal_radii((o, target, c, r) in meeting()) {
        let [o, target, c] = [o, target, c].map(DVec3::from_array);
        prop_assume!(!grazes(o, target, c, r));
        let kind = QuadricKind::Ellipsoid { radii: [r; 3] };
        let ellipsoid = Quadric::<f64>::new(&scene::Quadric::around([0.0, 1.0, 0.0], c.to_array(), kind));
        let other = ellipsoid.intersect(&toward::<f64>(o, target), &Exact);
        prop_assert!(agree(t(o, target, c, r), other, 1.0), "{:?} {:?}", t(o, target, c, r), other);
    }
}
