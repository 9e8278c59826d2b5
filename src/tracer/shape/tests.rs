//! Shapes at all scales, after pbrt's shape tests: coordinates are log-uniformly distributed.

use std::f64::consts::TAU;

use dashu_ratio::RBig;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use toyproof_image::pcg;
use toyproof_scene::{self as scene, QuadricKind, unit};

use super::{Cuboid, Plane, Primitive, Quadric, Shape, Sphere};
use crate::ray::Ray;
use crate::ray_epsilon::Exact;
use crate::real::{Real, Vector};

/// Reproducible random numbers, by hashing.
struct Random(u32);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = pcg(self.0);
        // 48 bits, so that the low bits of f64 are used too.
        let high = unit(self.0);
        self.0 = pcg(self.0);
        high + unit(self.0) / f64::from(1 << 24)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.number()
    }

    /// Returns ±10^x, with x uniform between `low` and `high`.
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

fn to_dvec3<T: Real>(v: T::Vec3) -> DVec3 {
    DVec3::from_array(v.to_array().map(Real::to_f64))
}

/// Returns a random shape of about the given size around a point.
fn shape(random: &mut Random, center: DVec3, size: f64) -> scene::Shape {
    let center = center.to_array();
    let axis = random.direction().to_array();
    let (radius, height) = (size * random.between(0.5, 1.0), size * random.between(0.5, 1.0));
    let around = |kind| scene::Shape::Quadric(scene::Quadric::around(axis, center, kind));
    match (random.number() * 8.0) as u32 {
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
        6 => cuboid(random, center, [2.0 * radius, height, size]),
        _ => around(QuadricKind::Hyperboloid {
            waist: 0.5 * radius,
            radius,
            height,
        }),
    }
}

/// Returns a box in a random orientation, or along the axes of the scene.
fn cuboid(random: &mut Random, center: [f64; 3], size: [f64; 3]) -> scene::Shape {
    let rotation = if random.number() < 0.5 {
        DQuat::IDENTITY
    } else {
        DQuat::from_axis_angle(random.direction(), random.between(0.0, TAU))
    };
    let axes = DVec3::AXES.map(|axis| (rotation * axis).to_array());
    scene::Shape::Box(scene::Cuboid { center, size, axes })
}

/// Counts rays that leave a convex surface, and those of them that hit it again.
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
            cuboid(random, center.to_array(), [size, 0.5 * size, 1.5 * size]),
        ];
        let shape = Shape::<T>::new(&convex[(random.number() * 3.0) as usize]);
        let distance = size * random.log_uniform(0.5, 2.0).abs();
        let ray = toward::<T>(center + random.direction() * distance, center);
        let Some(t) = shape.intersect(&ray, &Exact) else {
            continue;
        };
        let [point, normal] = shape.surface(&ray, t);
        for _ in 0..8 {
            let direction = random.direction();
            let normal = to_dvec3::<T>(normal).normalize();
            let outward = normal.dot(direction);
            // Include grazing rays: cosines to the normal down to 1e−6.
            let tilt = random.log_uniform(-6.0, 0.0).abs();
            let out = direction - normal * (outward - tilt);
            let leaving = leave::<T>(point, T::Vec3::from_f64(out.normalize().to_array()));
            rays += 1;
            hits += u32::from(shape.intersect_own(&leaving, &Exact).is_some());
        }
    }
    (rays, hits)
}

/// The ray that leaves a point of a surface exactly there.
fn leave<T: Real>(point: T::Vec3, direction: T::Vec3) -> Ray<T> {
    Ray {
        origin: point,
        direction,
        from: Some(0),
    }
}

#[test]
fn rays_leaving_a_convex_surface_do_not_hit_it_again() {
    // Radius 10^±6, origin offset 10^±8; in f32, which has fewer digits, near the origin.
    let (rays, hits) = self_hits::<f64>(140_000, [-6.0, 6.0], [-8.0, 8.0]);
    assert!(rays > 1_000_000, "only {rays} rays");
    let (_, single) = self_hits::<f32>(20_000, [-6.0, 6.0], [-8.0, -6.0]);
    assert_eq!((hits, single), (0, 0), "of {rays} rays");
}

/// A ray that leaves one sphere for another one that nearly touches it hits that one.
#[test]
fn nearly_touching_neighbors_are_hit() {
    let (mut rays, mut lost) = (0, 0);
    for seed in 0..100_000 {
        let random = &mut Random(seed);
        let radius = random.log_uniform(-6.0, 6.0).abs();
        let center = random.place(-8.0, 8.0);
        let out = random.direction();
        // The gap is 64 ULPs of the largest coordinate, or 1e−12 of the radius.
        let gap = (64.0 * f64::EPSILON * (center.abs().max_element() + radius)).max(1e-12 * radius);
        let other = random.between(0.1, 10.0) * radius;
        let neighbor = Sphere::<f64>::new((center + out * (radius + gap + other)).to_array(), other);
        let own = Sphere::<f64>::new(center.to_array(), radius);
        let ray = toward::<f64>(center + out * (radius + 0.5 * gap), center);
        let Some(t) = own.intersect(&ray, &Exact) else {
            continue;
        };
        let [point, _] = own.surface(&ray, t);
        rays += 1;
        lost += u32::from(neighbor.intersect(&leave::<f64>(point, out), &Exact).is_none());
    }
    assert!(rays > 50_000);
    assert_eq!(lost, 0);
}

/// Intersects random shapes from random viewpoints and checks that each hit lies on the surface up to
/// rounding. Returns the number of hits.
fn residuals<T: Real>(seeds: u32, sizes: [f64; 2], tolerance: f64) -> u32 {
    let mut hits = 0;
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
        hits += 1;
        let [point, normal] = shape.surface(&ray, t);
        // Distance from the surface, in units of the size, to first order: f / |∇f|.
        let off = distance(&described, to_dvec3::<T>(point)) / size;
        assert!(
            off < tolerance,
            "seed {seed}: {described:?} is missed by {off:.1e}"
        );
        assert!(
            (to_dvec3::<T>(normal).length() - 1.0).abs() < tolerance,
            "seed {seed}"
        );
    }
    hits
}

/// Computes the distance of a point from the unbounded surface, to first order.
fn distance(shape: &scene::Shape, point: DVec3) -> f64 {
    match shape {
        scene::Shape::Sphere { center, radius } => {
            (point.distance(DVec3::from_array(*center)) - radius).abs()
        }
        scene::Shape::Plane { point: on, normal } => DVec3::from_array(*normal)
            .dot(point - DVec3::from_array(*on))
            .abs(),
        scene::Shape::Box(cuboid) => {
            let p = point - DVec3::from_array(cuboid.center);
            let depths = [0, 1, 2].map(|i| {
                let along = DVec3::from_array(cuboid.axes[i]).dot(p);
                (0.5 * cuboid.size[i] - along.abs()).abs()
            });
            depths.into_iter().fold(f64::INFINITY, f64::min)
        }
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
fn hits_lie_on_the_shape_at_every_scale() {
    let hits = [
        residuals::<f64>(20_000, [-30.0, 30.0], 1e-11),
        residuals::<f32>(20_000, [-30.0, 30.0], 2e-3),
    ];
    assert!(hits.iter().all(|hits| *hits > 10_000), "{hits:?}");
}

/// A box of 2×4×6 around the origin.
fn block() -> Cuboid<f64> {
    Cuboid::new(&scene::Cuboid {
        center: [0.0; 3],
        size: [2.0, 4.0, 6.0],
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    })
}

fn along(origin: [f64; 3], direction: [f64; 3]) -> Ray<f64> {
    Ray {
        origin: DVec3::from_array(origin),
        direction: DVec3::from_array(direction),
        from: None,
    }
}

#[test]
fn rays_hit_boxes_from_outside_and_from_inside() {
    let block = block();
    let hit = |origin, direction| block.intersect(&along(origin, direction), &Exact);
    assert_eq!(hit([0.5, 0.5, 9.0], [0.0, 0.0, -1.0]), Some(6.0));
    assert_eq!(hit([0.5, 0.5, 1.0], [0.0, 0.0, -1.0]), Some(4.0));
    assert_eq!(hit([0.5, 0.5, 9.0], [0.0, 0.0, 1.0]), None);
    // Components of 0 with either sign, inside and outside of the other slabs.
    for zero in [0.0, -0.0] {
        assert_eq!(hit([-5.0, 1.9, 2.9], [1.0, zero, zero]), Some(4.0));
        assert_eq!(hit([-5.0, 2.1, 2.9], [1.0, zero, zero]), None);
        // In the plane of a face, and along an edge.
        assert_eq!(hit([-5.0, 2.0, 0.0], [1.0, zero, zero]), None);
        assert_eq!(hit([-5.0, -2.0, 3.0], [1.0, zero, zero]), None);
        assert_eq!(hit([1.0, 0.0, 0.0], [zero, 1.0, zero]), None);
    }
    // Diagonally, through the middle of an edge and past it.
    assert_eq!(hit([-3.0, 0.0, 0.0], [1.0, 1.0, 0.0]), None);
    assert_eq!(hit([-3.0, -0.5, 0.0], [1.0, 1.0, 0.0]), Some(2.0));
    // Almost parallel to a slab: t is large, but finite.
    let tiny = 2f64.powi(-900);
    assert_eq!(hit([0.0; 3], [tiny, 0.0, 0.0]), Some(tiny.recip()));
    assert_eq!(hit([0.0; 3], [2f64.powi(-1030), 0.0, 0.0]), None);
}

#[test]
fn rays_that_start_on_a_box_hit_another_face_or_none() {
    let block = block();
    let hit = |origin, direction| block.intersect_own(&along(origin, direction), &Exact);
    assert_eq!(hit([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), Some(2.0));
    assert_eq!(hit([1.0, 0.0, 0.0], [-0.5, 1.0, 0.0]), Some(2.0));
    assert_eq!(hit([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), None);
    assert_eq!(hit([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), None);
    assert_eq!(hit([1.0, 0.0, 0.0], [1e-9, -1.0, 0.0]), None);
    // Rounding has put the start outside or inside by a little.
    for x in [1.0 - 1e-12, 1.0 + 1e-12] {
        assert!(hit([x, 0.0, 0.0], [-1.0, 0.0, 0.0]).is_some_and(|t| (t - 2.0).abs() < 1e-11));
        assert_eq!(hit([x, 0.0, 0.0], [1.0, 0.0, 0.0]), None);
    }
}

#[test]
fn normals_of_boxes_point_outward_on_each_face() {
    let block = block();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut direction = [0.0; 3];
            direction[axis] = -side;
            let outside = along([0.1, 0.2, 0.3].map(|c| c - 0.5), direction);
            let origin = outside.origin - outside.direction * 20.0;
            let ray = Ray { origin, ..outside };
            let t = block.intersect(&ray, &Exact).unwrap();
            let [_, normal] = block.surface(&ray, t);
            assert_eq!(normal, -ray.direction);
        }
    }
}

#[test]
fn rays_parallel_to_cylinder_or_plane_miss() {
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
    // Nearly parallel: one root remains finite.
    let ray = toward::<f64>(DVec3::new(0.0, -1e9, 0.0), DVec3::new(1.0, 1.0, 0.0));
    let t = cylinder.intersect(&ray, &Exact).unwrap();
    assert!((t - 1e9 - 1.0).abs() < 1e-5, "{t}");
}

#[test]
fn ray_along_paraboloid_axis_hits_the_apex_once() {
    let kind = QuadricKind::Paraboloid {
        radius: 1.0,
        height: 1.0,
    };
    let quadric = scene::Quadric::around([0.0, 0.0, 1.0], [0.0, 0.0, -6.0], kind);
    let bowl = Quadric::<f64>::new(&quadric);
    let ray = toward::<f64>(DVec3::ZERO, DVec3::NEG_Z);
    assert_eq!(bowl.intersect(&ray, &Exact), Some(6.0));
}

/// Computes in rational arithmetic whether the line through `o` along `d`, of any length, hits the sphere
/// ahead, and δ = (r² − squared distance) / r².
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
fn hit_or_miss_is_exact_except_near_tangency() {
    let mut well_conditioned = 0u32;
    for seed in 0..60_000 {
        let random = &mut Random(seed);
        let single = |v: DVec3| v.to_array().map(|x| x as f32);
        let r = random.log_uniform(-4.0, 4.0).abs() as f32;
        let c = single(random.place(-4.0, 4.0));
        let distance = f64::from(r) * random.log_uniform(-1.0, 6.0).abs();
        let center = DVec3::from_array(c.map(f64::from));
        let o = single(center + random.direction() * distance);
        let origin = DVec3::from_array(o.map(f64::from));
        // Close to the silhouette: the target is at a distance of r from the center, up to a relative
        // difference of 1e−14.
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
        well_conditioned += 1;
        let sphere = Sphere::<f64>::new(c.map(f64::from), f64::from(r));
        let ray = Ray {
            origin,
            // Not normalized: the intersection does not need it, and normalizing would round.
            direction,
            from: None,
        };
        let is_hit = sphere.intersect(&ray, &Exact).is_some();
        assert_eq!(is_hit, hits, "seed {seed}: δ = {delta:.1e}, L/r = {ratio:.1e}");
    }
    assert!(well_conditioned > 40_000);
}

/// A ray and a sphere that it may hit.
fn ray_and_sphere() -> impl Strategy<Value = ([f64; 3], [f64; 3], [f64; 3], f64)> {
    let coordinate = || prop::array::uniform3(-10.0..10.0f64);
    (coordinate(), coordinate(), coordinate(), 0.1..5.0f64)
}

fn t(o: DVec3, target: DVec3, c: DVec3, r: f64) -> Option<f64> {
    let ray = toward::<f64>(o, target);
    Sphere::<f64>::new(c.to_array(), r).intersect(&ray, &Exact)
}

/// Returns whether hit or miss is ill-conditioned.
fn is_ill_conditioned(o: DVec3, target: DVec3, c: DVec3, r: f64) -> bool {
    let d = (target - o).normalize_or_zero();
    let f = o - c;
    let off = (f - d * f.dot(d)).length() / r;
    d == DVec3::ZERO || (off - 1.0).abs() < 1e-6 || (f.length() / r - 1.0).abs() < 1e-6
}

fn nearly_equal(a: Option<f64>, b: Option<f64>, factor: f64) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a * factor - b).abs() <= 1e-9 * b.abs().max(factor),
        (a, b) => a == b,
    }
}

proptest! {
    #[test]
    fn t_scales_with_the_scene((o, target, c, r) in ray_and_sphere(), exponent in -30.0..30.0f64) {
        let [o, target, c] = [o, target, c].map(DVec3::from_array);
        prop_assume!(!is_ill_conditioned(o, target, c, r));
        let s = 10f64.powf(exponent);
        prop_assert!(nearly_equal(t(o, target, c, r), t(o * s, target * s, c * s, r * s), s));
        // Bit-identical when scaled by a power of two.
        let s = 2f64.powi(exponent as i32);
        prop_assert_eq!(t(o, target, c, r).map(|t| t * s), t(o * s, target * s, c * s, r * s));
    }

    #[test]
    fn t_is_invariant_under_rigid_motions_and_axis_swaps(
        (o, target, c, r) in ray_and_sphere(),
        shift in prop::array::uniform3(-100.0..100.0f64),
        axis in prop::array::uniform3(0.1..1.0f64),
        angle in 0.0..TAU,
    ) {
        let [o, target, c] = [o, target, c].map(DVec3::from_array);
        prop_assume!(!is_ill_conditioned(o, target, c, r));
        let before = t(o, target, c, r);
        let shift = DVec3::from_array(shift);
        prop_assert!(nearly_equal(before, t(o + shift, target + shift, c + shift, r), 1.0));
        let turn = DQuat::from_axis_angle(DVec3::from_array(axis).normalize(), angle);
        prop_assert!(nearly_equal(before, t(turn * o, turn * target, turn * c, r), 1.0));
        let swap = |v: DVec3| DVec3::new(v.y, v.z, v.x);
        prop_assert!(nearly_equal(before, t(swap(o), swap(target), swap(c), r), 1.0));
    }

    #[test]
    fn sphere_equals_ellipsoid_of_equal_radii((o, target, c, r) in ray_and_sphere()) {
        let [o, target, c] = [o, target, c].map(DVec3::from_array);
        prop_assume!(!is_ill_conditioned(o, target, c, r));
        let kind = QuadricKind::Ellipsoid { radii: [r; 3] };
        let ellipsoid = Quadric::<f64>::new(&scene::Quadric::around([0.0, 1.0, 0.0], c.to_array(), kind));
        let other = ellipsoid.intersect(&toward::<f64>(o, target), &Exact);
        prop_assert!(nearly_equal(t(o, target, c, r), other, 1.0), "{:?} {:?}", t(o, target, c, r), other);
    }
}
