//! Random cases for the steps of each axis: spheres, quadrics, and secondary rays.

#![expect(
    clippy::unnecessary_wraps,
    reason = "all samplers have the same signature, and some never reject a sample"
)]

use glam::DVec3;

use crate::case::{Case, Label, MARGIN, RaySphere, Step};
use crate::exact::Intersection;
use crate::random::Random;

pub(crate) const SPHERE_ORIGINS: [Label; 4] = [
    Label::OriginInside,
    Label::OriginOnSurface,
    Label::OriginUlpInside,
    Label::OriginUlpOutside,
];
pub(crate) const DEGENERATE_PARTS: [Label; 13] = [
    Label::ZeroCoordinates,
    Label::ZeroDirection,
    Label::ZeroRadius,
    Label::NegativeRadius,
    Label::DenormalScene,
    Label::DenormalDirection,
    Label::InfiniteOrigin,
    Label::InfiniteDirection,
    Label::InfiniteCenter,
    Label::InfiniteRadius,
    Label::NanOrigin,
    Label::NanDirection,
    Label::NanRadius,
];

/// A ray and a sphere of typical size, before rounding: the ray's line passes within 1.3 radii of the center;
/// one ray of ten points away from it.
struct TypicalCase {
    o: DVec3,
    d: DVec3,
    c: DVec3,
    r: f64,
}

impl TypicalCase {
    fn new(random: &mut Random, [near, far]: [f64; 2]) -> Self {
        let r = random.between(0.5, 2.0);
        let c = random.direction() * random.between(0.0, 3.0);
        let ahead = random.direction();
        let distance = r * random.between(near, far);
        let aside = ahead.cross(random.direction()).normalize_or(DVec3::X);
        let o = c - ahead * distance;
        let target = c + aside * (r * random.between(0.0, 1.3));
        let d = (target - o).normalize();
        let behind = random.unit() < 0.1;
        Self {
            o,
            d: if behind { -d } else { d },
            c,
            r,
        }
    }

    fn ray_sphere(&self) -> RaySphere {
        RaySphere::rounded(self.o, self.d, self.c, self.r)
    }

    fn case(&self) -> Case {
        Case::Sphere(self.ray_sphere())
    }
}

const TYPICAL_DISTANCE_RADII: [f64; 2] = [3.0, 10.0];

pub(crate) fn scaled_sphere(random: &mut Random, step: Step) -> Option<Case> {
    let TypicalCase { o, d, c, r } = TypicalCase::new(random, TYPICAL_DISTANCE_RADII);
    let s = step.value();
    Some(Case::Sphere(RaySphere::rounded(o * s, d, c * s, r * s)))
}

pub(crate) fn stretched_direction(random: &mut Random, step: Step) -> Option<Case> {
    let typical = TypicalCase::new(random, TYPICAL_DISTANCE_RADII);
    let d = typical.d * step.value();
    Some(TypicalCase { d, ..typical }.case())
}

pub(crate) fn offset_sphere(random: &mut Random, step: Step) -> Option<Case> {
    let typical = TypicalCase::new(random, TYPICAL_DISTANCE_RADII);
    let shift = random.direction() * step.value();
    let (o, c) = (typical.o + shift, typical.c + shift);
    Some(TypicalCase { o, c, ..typical }.case())
}

/// Half of the rays are parallel to an axis: other f32 directions cannot be aimed accurately enough at a
/// distant sphere.
pub(crate) fn distant_sphere(random: &mut Random, step: Step) -> Option<Case> {
    let away = step.value();
    let typical = TypicalCase::new(random, [1.05 * away, 2.0 * away]);
    if random.unit() < 0.5 {
        return Some(typical.case());
    }
    let TypicalCase { o, c, r, .. } = typical;
    let (aside, turn) = (r * random.between(0.0, 1.5), random.rotation());
    let (sine, cosine) = libm::sincos(random.between(0.0, 6.3));
    let f = [aside * cosine, aside * sine, o.distance(c)];
    Some(Case::Sphere(RaySphere {
        o: turn(f).map(|x| x as f32),
        d: turn([0.0, 0.0, -1.0]).map(|x| x as f32),
        c: [0.0; 3],
        r: r as f32,
    }))
}

/// δ = (r² − h²)/r² is the step's value, where h is the distance of the ray's line from the center.
pub(crate) fn grazing_sphere(random: &mut Random, step: Step) -> Option<Case> {
    let delta = step.value();
    let r = f64::from(random.between(0.5, 2.0) as f32);
    let far = f64::from((r * random.between(3.0, 10.0)) as f32);
    let ray_sphere = if delta.abs() > 3e-6 && random.unit() < 0.5 {
        // Any direction: the δ after rounding is checked below.
        let d = random.direction();
        let aside = d.cross(random.direction()).normalize_or(DVec3::X);
        let c = random.direction() * random.between(0.0, 3.0);
        let o = c + aside * (r * (1.0 - delta).sqrt()) - d * far;
        RaySphere::rounded(o, d, c, r)
    } else {
        // Parallel to an axis: h² = x² + y², where x is a float slightly below h, and y is the remainder,
        // split into two floats.
        let steps = 1 + random.below(8) as u32;
        let x = f64::from(f32::from_bits(
            ((r * (1.0 - delta).sqrt()) as f32).to_bits() - steps,
        ));
        // Both squares have 48 bits and are close: the difference is exact.
        let y = ((r * r - x * x) - delta * r * r).sqrt();
        let high = f64::from(y as f32);
        let turn = random.rotation();
        let to_position = |v| turn(v).map(|x| x as f32);
        RaySphere {
            o: to_position([x, high, far]),
            d: to_position([0.0, 0.0, -1.0]),
            c: to_position([0.0, high - y, 0.0]),
            r: r as f32,
        }
    };
    let delta_ratio = ray_sphere.intersection()?.discriminant / delta;
    (delta_ratio > 0.3 && delta_ratio < 3.0).then_some(Case::Sphere(ray_sphere))
}

/// Origins near the surface. Points of it are exact: (1, 2, 2) has length 3.
pub(crate) fn origin_near_sphere(random: &mut Random, step: Step) -> Option<Case> {
    let Step::Label(label) = step else { return None };
    if label == Label::OriginInside {
        return Some(TypicalCase::new(random, [0.0, 0.9]).case());
    }
    let quantize = |x: f64| (x * 262_144.0).round() / 262_144.0;
    let k = quantize(random.between(1.0, 4.0));
    let f = random.rotation()([k, 2.0 * k, 2.0 * k]);
    let c = random.direction().to_array().map(|x| quantize(x * 3.0));
    let mut o = [0, 1, 2].map(|i| (c[i] + f[i]) as f32);
    let normal = DVec3::from_array(f).normalize();
    let i = random.below(3);
    let outward = (f[i] > 0.0) == (o[i] > 0.0);
    let bits = o[i].to_bits();
    if o[i] == 0.0 {
        return None;
    }
    o[i] = match label {
        Label::OriginUlpInside => f32::from_bits(if outward { bits - 1 } else { bits + 1 }),
        Label::OriginUlpOutside => f32::from_bits(if outward { bits + 1 } else { bits - 1 }),
        _ => o[i],
    };
    let d = random.direction();
    (d.dot(normal).abs() > 0.05).then_some(Case::Sphere(RaySphere {
        o,
        d: d.to_array().map(|x| x as f32),
        c: c.map(|x| x as f32),
        r: (3.0 * k) as f32,
    }))
}

/// Origins on a concentric shell at a relative distance of the step's value from the sphere's surface.
pub(crate) fn concentric_shells(random: &mut Random, step: Step) -> Option<Case> {
    let gap = step.value();
    let r = random.between(0.5, 2.0);
    let c = random.direction() * random.between(0.0, 3.0);
    let (normal, d) = (random.direction(), random.direction());
    let outside = random.unit() < 0.5;
    let (away, toward) = if outside {
        (1.0 + gap, -1.0)
    } else {
        (1.0 - gap, 1.0)
    };
    let d = if d.dot(normal) * toward < 0.0 { -d } else { d };
    let typical = TypicalCase {
        o: c + normal * (r * away),
        d,
        c,
        r,
    };
    (d.dot(normal).abs() > 0.3).then(|| typical.case())
}

pub(crate) fn degenerate_sphere(random: &mut Random, step: Step) -> Option<Case> {
    let Step::Label(label) = step else { return None };
    let mut ray_sphere = TypicalCase::new(random, TYPICAL_DISTANCE_RADII).ray_sphere();
    let i = random.below(3);
    let infinite = random.sign() as f32 * f32::INFINITY;
    match label {
        Label::ZeroCoordinates => {
            let [z, h] = [ray_sphere.r * 4.0, ray_sphere.r * random.between(0.0, 1.3) as f32];
            let turn = random.rotation();
            let to_position = |v| turn(v).map(|x| x as f32);
            ray_sphere.o = [0.0; 3];
            ray_sphere.d = to_position([0.0, 0.0, -1.0]);
            ray_sphere.c = to_position([f64::from(h), 0.0, f64::from(-z)]);
        }
        Label::ZeroDirection => ray_sphere.d = [0.0; 3],
        Label::ZeroRadius => ray_sphere.r = 0.0,
        Label::NegativeRadius => ray_sphere.r = -ray_sphere.r,
        Label::DenormalScene => {
            let small = |v: [f32; 3]| v.map(|x| (f64::from(x) * 1e-40) as f32);
            (ray_sphere.o, ray_sphere.c, ray_sphere.r) = (
                small(ray_sphere.o),
                small(ray_sphere.c),
                small([ray_sphere.r; 3])[0],
            );
        }
        Label::DenormalDirection => ray_sphere.d = ray_sphere.d.map(|x| (f64::from(x) * 1e-40) as f32),
        Label::InfiniteOrigin => ray_sphere.o[i] = infinite,
        Label::InfiniteDirection => ray_sphere.d[i] = infinite,
        Label::InfiniteCenter => ray_sphere.c[i] = infinite,
        Label::InfiniteRadius => ray_sphere.r = f32::INFINITY,
        Label::NanOrigin => ray_sphere.o[i] = f32::NAN,
        Label::NanDirection => ray_sphere.d[i] = f32::NAN,
        _ => ray_sphere.r = f32::NAN,
    }
    let is_grazing = |intersection: Intersection| intersection.discriminant.abs() < MARGIN;
    let is_well_conditioned = matches!(label, Label::ZeroDirection | Label::ZeroRadius)
        || !ray_sphere.intersection().is_some_and(is_grazing);
    is_well_conditioned.then_some(Case::Sphere(ray_sphere))
}

// Rays and quadrics, each in its local coordinates.

pub(crate) const SPECIAL_QUADRIC_RAYS: [Label; 5] = [
    Label::AlongCylinder,
    Label::AlongConeSide,
    Label::AlongParaboloidAxis,
    Label::ThroughConeApex,
    Label::ThroughParaboloidApex,
];

/// The quadric q·p² + 2 g z + k = 0.
#[derive(Clone, Copy)]
struct Quadric {
    q: [f32; 3],
    g: f32,
    k: f32,
}

impl Quadric {
    const fn new(q: [f32; 3], g: f32, k: f32) -> Self {
        Self { q, g, k }
    }
}

const CYLINDER: Quadric = Quadric::new([1.0, 1.0, 0.0], 0.0, -1.0);
const CONE: Quadric = Quadric::new([1.0, 1.0, -1.0], 0.0, 0.0);
const HYPERBOLOID: Quadric = Quadric::new([1.0, 1.0, -1.0], 0.0, -1.0);
const PARABOLOID: Quadric = Quadric::new([1.0, 1.0, 0.0], -0.5, 0.0);
const ELLIPSOID: Quadric = Quadric::new([1.0, 0.25, 4.0], 0.0, -1.0);

fn quadric_case(Quadric { q, g, k }: Quadric, o: [f64; 3], d: [f64; 3]) -> Case {
    let [o, d] = [o, d].map(|v| v.map(|x| x as f32));
    Case::Quadric { o, d, q, g, k }
}

fn point_in_cube(random: &mut Random, size: f64) -> [f64; 3] {
    [0; 3].map(|_| random.between(-size, size))
}

/// Directions for which the coefficient of t² is nearly 0.
pub(crate) fn nearly_linear_quadric(random: &mut Random, step: Step) -> Option<Case> {
    let aside = random.sign() * step.value().sqrt();
    let [x, y, z] = point_in_cube(random, 1.0);
    let o = [x * 1.5, y * 1.5, z * 5.0];
    Some(match random.below(4) {
        0 => quadric_case(CYLINDER, o, [aside, 0.0, random.sign()]),
        1 => quadric_case(PARABOLOID, o, [0.0, aside, random.sign()]),
        2 => quadric_case(CONE, o, [1.0, aside, random.sign()]),
        _ => quadric_case(HYPERBOLOID, o, [aside, 1.0, random.sign()]),
    })
}

pub(crate) fn distant_quadric(random: &mut Random, step: Step) -> Option<Case> {
    let surface = [CYLINDER, CONE, HYPERBOLOID, PARABOLOID, ELLIPSOID][random.below(5)];
    let o = random.direction() * (step.value() * random.between(2.0, 4.0));
    let target = DVec3::from_array(point_in_cube(random, 1.5));
    let d = (target - o).normalize();
    Some(quadric_case(surface, o.to_array(), d.to_array()))
}

pub(crate) fn special_quadric_ray(random: &mut Random, step: Step) -> Option<Case> {
    let Step::Label(label) = step else { return None };
    let [x, y, z] = point_in_cube(random, 1.0);
    let o = [x * 1.5, y * 1.5, z * 5.0];
    let along = [0.0, 0.0, random.sign()];
    // Multiples of 1/1024, so that sums of two are exact.
    let coarse = |v: [f64; 3]| v.map(|x| (x * 1024.0).round() / 1024.0);
    Some(match label {
        Label::AlongCylinder => quadric_case(CYLINDER, o, along),
        Label::AlongConeSide => quadric_case(CONE, o, [3.0, 4.0 * random.sign(), 5.0]),
        Label::AlongParaboloidAxis => quadric_case(PARABOLOID, o, along),
        Label::ThroughConeApex => {
            let d = coarse([x, y, 2.0 * z]);
            quadric_case(CONE, d.map(|x| -4.0 * x), d)
        }
        _ => {
            let d = coarse([x, y, z]);
            quadric_case(PARABOLOID, d.map(|x| -4.0 * x), d)
        }
    })
}

// Secondary rays that leave a sphere at the hit of a first ray.

fn primary_ray(random: &mut Random, step: Step) -> Option<RaySphere> {
    let Step::Label(label) = step else { return None };
    let (scale, r) = match label {
        Label::Scale1 => (1.0, random.between(0.5, 2.0)),
        Label::Scale1000 => (1e3, random.between(0.5, 2.0)),
        _ => (1.0, 1000.0),
    };
    let (c, normal) = (random.direction() * (3.0 * r), random.direction());
    let above = random.between(1.0, 10.0);
    let (o, target) = if r < 100.0 {
        let o = c + normal * (r + above);
        (o, c + random.direction() * (r * 0.9))
    } else {
        // The viewer stands on the ground and looks down, steeply or at a shallow angle.
        let o = c + normal * (r + above);
        let aside = normal.cross(random.direction()) * (above * random.log_between(0.3, 10.0));
        (o, c + normal * r + aside)
    };
    let d = (target - o).normalize();
    Some(RaySphere::rounded(o * scale, d, c * scale, r * scale))
}

pub(crate) fn mirrored_ray(random: &mut Random, step: Step) -> Option<Case> {
    Some(Case::Secondary {
        first: primary_ray(random, step)?,
        cosine: 0.0,
    })
}

/// Secondary rays between 0.1 and 6 degrees above the surface.
pub(crate) fn grazing_secondary_ray(random: &mut Random, step: Step) -> Option<Case> {
    Some(Case::Secondary {
        first: primary_ray(random, step)?,
        cosine: random.log_between(2e-3, 0.1) as f32,
    })
}
