//! Rays and spheres.

#![expect(
    clippy::unnecessary_wraps,
    reason = "some axes draw cases that do not fit, and all are drawn alike"
)]

use glam::DVec3;

use super::{Case, Random, Shot, Step, number, single};
use crate::stress::exact;

pub(super) const ORIGINS: [&str; 4] = [
    "the origin inside",
    "the origin on the surface",
    "the origin one ULP inside",
    "the origin one ULP outside",
];
pub(super) const PARTS: [&str; 13] = [
    "zero coordinates",
    "zero direction",
    "zero radius",
    "negative radius",
    "denormal scene",
    "denormal direction",
    "infinite origin",
    "infinite direction",
    "infinite centre",
    "infinite radius",
    "NaN origin",
    "NaN direction",
    "NaN radius",
];

/// A ray and a sphere of ordinary size, before rounding: the ray passes the centre within 1.3 radii, in one of ten cases behind.
struct Ordinary {
    o: DVec3,
    d: DVec3,
    c: DVec3,
    r: f64,
}

impl Ordinary {
    fn new(random: &mut Random, [near, far]: [f64; 2]) -> Self {
        let r = random.between(0.5, 2.0);
        let c = random.direction() * random.between(0.0, 3.0);
        let ahead = random.direction();
        let distance = r * random.between(near, far);
        let aside = ahead.cross(random.direction()).normalize_or(DVec3::X);
        let o = c - ahead * distance;
        let target = c + aside * (r * random.between(0.0, 1.3));
        let d = (target - o).normalize();
        let behind = random.number() < 0.1;
        Self {
            o,
            d: if behind { -d } else { d },
            c,
            r,
        }
    }

    fn case(self) -> Case {
        Case::Sphere(Shot {
            o: single(self.o),
            d: single(self.d),
            c: single(self.c),
            r: self.r as f32,
        })
    }
}

const USUAL: [f64; 2] = [3.0, 10.0];

pub(super) fn scaled(random: &mut Random, step: Step) -> Option<Case> {
    let Ordinary { o, d, c, r } = Ordinary::new(random, USUAL);
    let s = number(step);
    Some(
        Ordinary {
            o: o * s,
            d,
            c: c * s,
            r: r * s,
        }
        .case(),
    )
}

pub(super) fn stretched(random: &mut Random, step: Step) -> Option<Case> {
    let ordinary = Ordinary::new(random, USUAL);
    let d = ordinary.d * number(step);
    Some(Ordinary { d, ..ordinary }.case())
}

pub(super) fn offset(random: &mut Random, step: Step) -> Option<Case> {
    let ordinary = Ordinary::new(random, USUAL);
    let shift = random.direction() * number(step);
    let (o, c) = (ordinary.o + shift, ordinary.c + shift);
    Some(Ordinary { o, c, ..ordinary }.case())
}

/// Half of the rays go along an axis, so that they meet spheres that no other direction of f32 can be aimed at.
pub(super) fn distant(random: &mut Random, step: Step) -> Option<Case> {
    let away = number(step);
    let ordinary = Ordinary::new(random, [1.05 * away, 2.0 * away]);
    if random.number() < 0.5 {
        return Some(ordinary.case());
    }
    let Ordinary { o, c, r, .. } = ordinary;
    let (aside, turn) = (r * random.between(0.0, 1.5), random.turn());
    let (sine, cosine) = libm::sincos(random.between(0.0, 6.3));
    let f = [aside * cosine, aside * sine, o.distance(c)];
    Some(Case::Sphere(Shot {
        o: turn(f).map(|x| x as f32),
        d: turn([0.0, 0.0, -1.0]).map(|x| x as f32),
        c: [0.0; 3],
        r: r as f32,
    }))
}

/// δ = (r² − h²)/r² as asked for, where h is the distance at which the ray passes the centre.
pub(super) fn grazing(random: &mut Random, step: Step) -> Option<Case> {
    let delta = number(step);
    let r = f64::from(random.between(0.5, 2.0) as f32);
    let far = f64::from((r * random.between(3.0, 10.0)) as f32);
    let shot = if delta.abs() > 3e-6 && random.number() < 0.5 {
        // Any direction: what rounding makes of it is measured below.
        let d = random.direction();
        let aside = d.cross(random.direction()).normalize_or(DVec3::X);
        let c = random.direction() * random.between(0.0, 3.0);
        Shot {
            o: single(c + aside * (r * (1.0 - delta).sqrt()) - d * far),
            d: single(d),
            c: single(c),
            r: r as f32,
        }
    } else {
        // Along an axis: h² = x² + y², x a float a little below what is wanted and y what is missing, in two parts.
        let steps = 1 + random.below(8) as u32;
        let x = f64::from(f32::from_bits(
            ((r * (1.0 - delta).sqrt()) as f32).to_bits() - steps,
        ));
        // Both squares have 48 bits and are close: the difference is exact.
        let y = ((r * r - x * x) - delta * r * r).sqrt();
        let high = f64::from(y as f32);
        let turn = random.turn();
        let place = |v| turn(v).map(|x| x as f32);
        Shot {
            o: place([x, high, far]),
            d: place([0.0, 0.0, -1.0]),
            c: place([0.0, high - y, 0.0]),
            r: r as f32,
        }
    };
    let told = exact::sphere(shot.o, shot.d, shot.c, shot.r)?.discriminant / delta;
    (told > 0.3 && told < 3.0).then_some(Case::Sphere(shot))
}

/// Around the surface. A point of it is exact: (1, 2, 2) has length 3.
pub(super) fn near(random: &mut Random, step: Step) -> Option<Case> {
    let Step::Word(word) = step else { return None };
    if word == ORIGINS[0] {
        return Some(Ordinary::new(random, [0.0, 0.9]).case());
    }
    let fine = |x: f64| (x * 262_144.0).round() / 262_144.0;
    let k = fine(random.between(1.0, 4.0));
    let f = random.turn()([k, 2.0 * k, 2.0 * k]);
    let c = random.direction().to_array().map(|x| fine(x * 3.0));
    let mut o = [0, 1, 2].map(|i| (c[i] + f[i]) as f32);
    let normal = DVec3::from_array(f).normalize();
    let i = random.below(3);
    let outward = (f[i] > 0.0) == (o[i] > 0.0);
    let bits = o[i].to_bits();
    if o[i] == 0.0 {
        return None;
    }
    o[i] = match word {
        "the origin one ULP inside" => f32::from_bits(if outward { bits - 1 } else { bits + 1 }),
        "the origin one ULP outside" => f32::from_bits(if outward { bits + 1 } else { bits - 1 }),
        _ => o[i],
    };
    let d = random.direction();
    (d.dot(normal).abs() > 0.05).then_some(Case::Sphere(Shot {
        o,
        d: single(d),
        c: c.map(|x| x as f32),
        r: (3.0 * k) as f32,
    }))
}

/// From one shell to the next, the sphere, so much of its radius away.
pub(super) fn shells(random: &mut Random, step: Step) -> Option<Case> {
    let gap = number(step);
    let r = random.between(0.5, 2.0);
    let c = random.direction() * random.between(0.0, 3.0);
    let (normal, d) = (random.direction(), random.direction());
    let outside = random.number() < 0.5;
    let (away, toward) = if outside {
        (1.0 + gap, -1.0)
    } else {
        (1.0 - gap, 1.0)
    };
    let d = if d.dot(normal) * toward < 0.0 { -d } else { d };
    let ordinary = Ordinary {
        o: c + normal * (r * away),
        d,
        c,
        r,
    };
    (d.dot(normal).abs() > 0.3).then(|| ordinary.case())
}

pub(super) fn parts(random: &mut Random, step: Step) -> Option<Case> {
    let Step::Word(word) = step else { return None };
    let Case::Sphere(mut shot) = Ordinary::new(random, USUAL).case() else {
        return None;
    };
    let i = random.below(3);
    let infinite = random.sign() as f32 * f32::INFINITY;
    match word {
        "zero coordinates" => {
            let [z, h] = [shot.r * 4.0, shot.r * random.between(0.0, 1.3) as f32];
            let turn = random.turn();
            let place = |v| turn(v).map(|x| x as f32);
            shot.o = [0.0; 3];
            shot.d = place([0.0, 0.0, -1.0]);
            shot.c = place([f64::from(h), 0.0, f64::from(-z)]);
        }
        "zero direction" => shot.d = [0.0; 3],
        "zero radius" => shot.r = 0.0,
        "negative radius" => shot.r = -shot.r,
        "denormal scene" => {
            let small = |v: [f32; 3]| v.map(|x| (f64::from(x) * 1e-40) as f32);
            (shot.o, shot.c, shot.r) = (small(shot.o), small(shot.c), small([shot.r; 3])[0]);
        }
        "denormal direction" => shot.d = shot.d.map(|x| (f64::from(x) * 1e-40) as f32),
        "infinite origin" => shot.o[i] = infinite,
        "infinite direction" => shot.d[i] = infinite,
        "infinite centre" => shot.c[i] = infinite,
        "infinite radius" => shot.r = f32::INFINITY,
        "NaN origin" => shot.o[i] = f32::NAN,
        "NaN direction" => shot.d[i] = f32::NAN,
        _ => shot.r = f32::NAN,
    }
    let touches = |met: exact::Met| met.discriminant.abs() < super::MARGIN;
    let exact = exact::sphere(shot.o, shot.d, shot.c, shot.r);
    let decided = word.starts_with("zero ") && word != "zero coordinates" || !exact.is_some_and(touches);
    decided.then_some(Case::Sphere(shot))
}
