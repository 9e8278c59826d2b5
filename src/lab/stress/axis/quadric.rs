//! Rays and quadrics, each in coordinates of its own.

#![expect(
    clippy::unnecessary_wraps,
    reason = "some axes draw cases that do not fit, and all are drawn alike"
)]

use super::{Case, Random, Step, number};

pub(super) const RAYS: [&str; 5] = [
    "a ray along a cylinder",
    "a ray along a cone's side",
    "a ray along a paraboloid's axis",
    "a ray through a cone's apex",
    "a ray through a paraboloid's apex",
];

/// q, g and k.
type Surface = ([f32; 3], f32, f32);

const CYLINDER: Surface = ([1.0, 1.0, 0.0], 0.0, -1.0);
const CONE: Surface = ([1.0, 1.0, -1.0], 0.0, 0.0);
const HYPERBOLOID: Surface = ([1.0, 1.0, -1.0], 0.0, -1.0);
const PARABOLOID: Surface = ([1.0, 1.0, 0.0], -0.5, 0.0);
const ELLIPSOID: Surface = ([1.0, 0.25, 4.0], 0.0, -1.0);

fn case((q, g, k): Surface, o: [f64; 3], d: [f64; 3]) -> Case {
    let [o, d] = [o, d].map(|v| v.map(|x| x as f32));
    Case::Quadric { o, d, q, g, k }
}

fn place(random: &mut Random, size: f64) -> [f64; 3] {
    [0; 3].map(|_| random.between(-size, size))
}

/// Directions for which the square of t all but vanishes.
pub(super) fn flat(random: &mut Random, step: Step) -> Option<Case> {
    let aside = random.sign() * number(step).sqrt();
    let [x, y, z] = place(random, 1.0);
    let o = [x * 1.5, y * 1.5, z * 5.0];
    Some(match random.below(4) {
        0 => case(CYLINDER, o, [aside, 0.0, random.sign()]),
        1 => case(PARABOLOID, o, [0.0, aside, random.sign()]),
        2 => case(CONE, o, [1.0, aside, random.sign()]),
        _ => case(HYPERBOLOID, o, [aside, 1.0, random.sign()]),
    })
}

pub(super) fn distant(random: &mut Random, step: Step) -> Option<Case> {
    let surface = [CYLINDER, CONE, HYPERBOLOID, PARABOLOID, ELLIPSOID][random.below(5)];
    let o = random.direction() * (number(step) * random.between(2.0, 4.0));
    let target = glam::DVec3::from_array(place(random, 1.5));
    let d = (target - o).normalize();
    Some(case(surface, o.to_array(), d.to_array()))
}

pub(super) fn rays(random: &mut Random, step: Step) -> Option<Case> {
    let Step::Word(word) = step else { return None };
    let [x, y, z] = place(random, 1.0);
    let o = [x * 1.5, y * 1.5, z * 5.0];
    let along = [0.0, 0.0, random.sign()];
    // Multiples of 1/1024, so that a sum of two is exact.
    let coarse = |v: [f64; 3]| v.map(|x| (x * 1024.0).round() / 1024.0);
    Some(match word {
        "a ray along a cylinder" => case(CYLINDER, o, along),
        "a ray along a cone's side" => case(CONE, o, [3.0, 4.0 * random.sign(), 5.0]),
        "a ray along a paraboloid's axis" => case(PARABOLOID, o, along),
        "a ray through a cone's apex" => {
            let d = coarse([x, y, 2.0 * z]);
            case(CONE, d.map(|x| -4.0 * x), d)
        }
        _ => {
            let d = coarse([x, y, z]);
            case(PARABOLOID, d.map(|x| -4.0 * x), d)
        }
    })
}
