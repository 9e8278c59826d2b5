//! A forest: dark ground, trunks around the viewer, and a bright sky between the leaves.

use std::sync::LazyLock;

use super::{Vector, noise};
use crate::color::{Color, blend, scaled};
use crate::field::{hash, mix, smoothstep, unit};

/// Brighter than white.
const SKY: Color = [4.0, 4.2, 4.4];
const TRUNKS: u32 = 34;
const FLOOR: f32 = -0.6;

/// The color in a direction, a unit vector. Only the sky is brighter than white.
pub(crate) fn forest(direction: Vector) -> Color {
    let [x, y, z] = direction;
    let horizontal = (x * x + z * z).sqrt().max(1e-6);
    // The distance at which the ray reaches the ground, along the ground.
    let to_ground = if y < -1e-4 {
        FLOOR / y * horizontal
    } else {
        f32::INFINITY
    };
    if let Some(trunk) = nearest_trunk(x / horizontal, z / horizontal)
        && trunk.distance < to_ground
    {
        return bark(
            &trunk,
            y / horizontal * trunk.distance,
            x / horizontal,
            z / horizontal,
        );
    }
    if to_ground < 9.0 {
        let scale = to_ground / horizontal;
        return ground([x * scale, 0.0, z * scale], to_ground);
    }
    // Bushes at the horizon, leaves above, and less of them in the zenith.
    let leaves = noise(direction.map(|component| 9.0 * component), 221, 4);
    let clumps = noise(direction.map(|component| 2.5 * component), 222, 2);
    let cover = mix(0.72, 0.46, smoothstep(0.0, 0.5, y)) - mix(0.0, 0.04, smoothstep(0.6, 1.0, y));
    let shade = smoothstep(-0.05, 0.05, 0.5 * (leaves + clumps) - (1.0 - cover));
    let leaf = blend(
        [0.09, 0.10, 0.06],
        [0.30, 0.31, 0.17],
        noise(direction.map(|c| 30.0 * c), 223, 2),
    );
    blend(SKY, leaf, shade)
}

struct Trunk {
    distance: f32,
    /// The position across the trunk, −1 to 1.
    across: f32,
    id: u32,
}

/// A trunk's position on the ground and its radius.
struct Place {
    x: f32,
    z: f32,
    radius: f32,
    id: u32,
}

/// Trunks at random places of a square, but not next to the viewer.
static PLACES: LazyLock<Vec<Place>> = LazyLock::new(|| {
    let place = |at| {
        let id = hash(224, at, 0);
        let [x, z] = [hash(224, at, 1), hash(224, at, 2)].map(|random| 9.0 * (unit(random) - 0.5));
        let radius = 0.10 + 0.16 * unit(id);
        (x * x + z * z > 1.2).then_some(Place { x, z, radius, id })
    };
    (0..TRUNKS).filter_map(place).collect()
});

/// The trunk that a horizontal ray from the origin, a unit vector, meets first.
fn nearest_trunk(x: f32, z: f32) -> Option<Trunk> {
    let hits = PLACES.iter().filter_map(|place| {
        let along = place.x * x + place.z * z;
        let across = (place.x * z - place.z * x) / place.radius;
        (along > 0.0 && across.abs() < 1.0).then(|| Trunk {
            distance: along - place.radius * (1.0 - across * across).sqrt(),
            across,
            id: place.id,
        })
    });
    hits.min_by(|a, b| a.distance.total_cmp(&b.distance))
}

fn bark(trunk: &Trunk, height: f32, x: f32, z: f32) -> Color {
    let position = [x * trunk.distance * 9.0, height * 2.0, z * trunk.distance * 9.0];
    let rough = 0.5 + noise(position, 225 + trunk.id % 7, 4);
    // The sky lights the rims; air makes trunks that are far away brighter.
    let rim = 0.55 + 0.75 * trunk.across * trunk.across;
    let haze = smoothstep(1.5, 6.5, trunk.distance);
    blend(
        scaled([0.17, 0.14, 0.11], rough * rim),
        [0.50, 0.52, 0.50],
        0.45 * haze,
    )
}

fn ground(position: Vector, distance: f32) -> Color {
    let [x, _, z] = position;
    let litter = noise([x * 14.0, 0.5, z * 14.0], 226, 4);
    let patches = noise([x * 1.5, 0.5, z * 1.5], 227, 3);
    let earth = blend([0.10, 0.09, 0.07], [0.30, 0.25, 0.19], litter);
    let lit = blend(earth, [0.42, 0.40, 0.26], smoothstep(0.60, 0.75, patches));
    blend(lit, [0.44, 0.46, 0.44], 0.6 * smoothstep(2.5, 9.0, distance))
}
