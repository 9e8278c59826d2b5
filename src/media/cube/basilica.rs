//! A basilica: a hall of warm stone with a vault, a dome and bright windows.

use super::{Vector, noise};
use crate::color::{Color, blend, scaled};
use crate::field::{hash, mix, smoothstep, unit};

/// Walls are at x = ±1 and z = ±`LENGTH`.
const LENGTH: f32 = 3.2;
const FLOOR: f32 = -0.55;
/// Where the vault begins, a half circle of radius 1.
const SPRING: f32 = 0.9;
const STONE: Color = [0.62, 0.36, 0.28];
/// Windows are brighter than white.
const GLASS: Color = [22.0, 20.0, 18.0];

/// The color in a direction, a unit vector. Only windows are brighter than white.
pub(crate) fn basilica([x, y, z]: Vector) -> Color {
    let (to_side, to_end) = (1.0 / x.abs().max(1e-6), LENGTH / z.abs().max(1e-6));
    let is_end = to_end < to_side;
    let hit = [x, y, z].map(|component| component * to_side.min(to_end));
    if hit[1] < FLOOR {
        return floor([x, y, z].map(|component| component * FLOOR / y));
    }
    let grain = |position: Vector| 0.78 + 0.44 * noise(position.map(|component| 9.0 * component), 211, 4);
    // The vault is the half cylinder x² + (y − SPRING)² = 1.
    let (a, b) = (x * x + y * y, y * SPRING);
    let to_vault = (b + (b * b - a * (SPRING * SPRING - 1.0)).max(0.0).sqrt()) / a.max(1e-6);
    if !is_end && hit[1] > SPRING || is_end && to_vault < to_end && y * to_vault > SPRING {
        let position = [x, y, z].map(|component| component * to_vault);
        return vault(position, grain(position));
    }
    let along = if is_end { hit[0] + 20.0 } else { hit[2] };
    scaled_wall(along, hit[1], grain(hit))
}

/// Pilasters, a cornice, and above it a row of windows with round tops.
fn scaled_wall(along: f32, height: f32, grain: f32) -> Color {
    const BAY: f32 = 0.8;
    let bay = along / BAY - (along / BAY).floor() - 0.5;
    let light = mix(0.55, 1.05, smoothstep(FLOOR, SPRING, height));
    let stone = scaled(STONE, grain * light);
    if (height - 0.30).abs() < 0.05 {
        return scaled(stone, if height > 0.30 { 1.5 } else { 0.6 });
    }
    if bay.abs() > 0.38 {
        // Flutes of a pilaster.
        let flute = (bay.abs() - 0.38) * 40.0;
        return scaled(stone, if flute - flute.floor() < 0.35 { 0.8 } else { 1.25 });
    }
    let middle = if height > 0.30 { 0.62 } else { -0.12 };
    let up = height - middle;
    let half = if up > 0.12 {
        (0.13_f32 * 0.13 - (up - 0.12) * (up - 0.12)).max(0.0).sqrt()
    } else {
        0.13
    };
    if bay.abs() * BAY < half && up > -0.16 {
        let is_lit = height > 0.30 && unit(hash(212, (along / BAY).floor() as i32 as u32, 0)) < 0.7;
        // Below, the windows are niches.
        return if is_lit {
            GLASS
        } else {
            scaled(STONE, 0.28 + 0.3 * (grain - 0.78))
        };
    }
    stone
}

/// Coffers with a bright opening in the middle.
fn vault([x, y, z]: Vector, grain: f32) -> Color {
    let from_middle = (x * x + z * z).sqrt();
    if from_middle < 0.16 {
        return GLASS;
    }
    if from_middle < 0.62 {
        // The rings and ribs of a dome, whose rim gets the light.
        let ring = from_middle * 14.0;
        let rib = noise([x / from_middle * 6.0, 0.5, z / from_middle * 6.0], 213, 1);
        let light = mix(1.5, 0.9, smoothstep(0.16, 0.62, from_middle));
        let depth = if ring - ring.floor() < 0.25 {
            0.7
        } else {
            0.9 + 0.35 * rib
        };
        return scaled([0.66, 0.44, 0.34], grain * light * depth);
    }
    if from_middle < 0.68 {
        return scaled(STONE, 1.5 * grain);
    }
    let [across, along] = [x * 3.0, z * 2.5].map(|at| (at - at.floor() - 0.5).abs());
    let coffer = smoothstep(0.30, 0.36, across.max(along));
    let gold = blend([0.24, 0.13, 0.09], [0.62, 0.40, 0.25], coffer);
    scaled(gold, grain * mix(1.1, 0.6, smoothstep(SPRING, 2.0, y)))
}

/// Polished marble: circles and squares, and reflections of the windows.
fn floor([x, _, z]: Vector) -> Color {
    let (u, v) = (x * 1.2, z * 1.2);
    let [across, along] = [u, v].map(|at| at - at.floor() - 0.5);
    let radius = (across * across + along * along).sqrt();
    let is_light = radius < 0.22 || (0.30..0.42).contains(&radius);
    let veins = 0.75 + 0.5 * noise([x * 7.0, 3.5, z * 7.0], 214, 4);
    let marble = if is_light {
        [0.74, 0.48, 0.38]
    } else {
        [0.46, 0.24, 0.18]
    };
    let gleam = smoothstep(0.62, 0.9, noise([x * 1.6, 7.5, z * 1.6], 215, 2));
    blend(scaled(marble, veins), [1.0, 0.86, 0.76], 0.5 * gleam)
}
