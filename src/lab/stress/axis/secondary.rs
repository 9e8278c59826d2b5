//! Rays that leave a sphere where another met it.

use super::{Case, Random, Shot, Step, single};

fn first(random: &mut Random, step: Step) -> Option<Shot> {
    let Step::Word(word) = step else { return None };
    let (scale, r) = match word {
        "scale 1" => (1.0, random.between(0.5, 2.0)),
        "scale 1e3" => (1e3, random.between(0.5, 2.0)),
        _ => (1.0, 1000.0),
    };
    let (c, normal) = (random.direction() * (3.0 * r), random.direction());
    let above = random.between(1.0, 10.0);
    let (o, target) = if r < 100.0 {
        let o = c + normal * (r + above);
        (o, c + random.direction() * (r * 0.9))
    } else {
        // Standing on the ground and looking down, a little or much.
        let o = c + normal * (r + above);
        let aside = normal.cross(random.direction()) * (above * random.log_between(0.3, 10.0));
        (o, c + normal * r + aside)
    };
    Some(Shot {
        o: single(o * scale),
        d: single((target - o).normalize()),
        c: single(c * scale),
        r: (r * scale) as f32,
    })
}

pub(super) fn mirrored(random: &mut Random, step: Step) -> Option<Case> {
    Some(Case::Secondary {
        first: first(random, step)?,
        cosine: 0.0,
    })
}

/// Between 0.1 and 6 degrees above the surface.
pub(super) fn grazing(random: &mut Random, step: Step) -> Option<Case> {
    Some(Case::Secondary {
        first: first(random, step)?,
        cosine: random.log_between(2e-3, 0.1) as f32,
    })
}
