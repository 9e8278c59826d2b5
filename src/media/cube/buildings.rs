//! A court between houses under a bright sky: the gallery, and with other colors a street of London.

use super::{Vector, noise};
use crate::color::{Color, blend, scaled};
use crate::field::{hash, mix, smoothstep, unit};

/// A court whose long walls are at x = ±1 and whose short walls are at z = ±`length`, seen from the origin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Court {
    length: f32,
    /// The height of the floor, negative.
    floor: f32,
    /// The height of the roofs.
    top: f32,
    wall: Color,
    window: Color,
    paving: Color,
    /// The side of a paving stone; 0 for a road.
    slab: f32,
    /// Brighter than white.
    sky: Color,
}

/// The court of a gallery, in gray stone.
pub(crate) const GALLERY: Court = Court {
    length: 6.0,
    floor: -0.45,
    top: 1.55,
    wall: [0.56, 0.53, 0.54],
    window: [0.13, 0.12, 0.14],
    paving: [0.43, 0.41, 0.41],
    slab: 0.24,
    sky: [3.4, 3.4, 3.6],
};

/// A street between houses of pale stone.
pub(crate) const LONDON: Court = Court {
    length: 9.0,
    floor: -0.30,
    top: 1.70,
    wall: [0.66, 0.58, 0.48],
    window: [0.16, 0.14, 0.13],
    paving: [0.50, 0.48, 0.46],
    slab: 0.0,
    sky: [1.6, 1.6, 1.5],
};

impl Court {
    /// The color in a direction, a unit vector. Only the sky is brighter than white.
    pub(crate) fn color(&self, [x, y, z]: Vector) -> Color {
        let (to_side, to_end) = (1.0 / x.abs().max(1e-6), self.length / z.abs().max(1e-6));
        let is_end = to_end < to_side;
        let distance = to_side.min(to_end);
        let hit = [x, y, z].map(|component| component * distance);
        let along = if is_end { hit[0] + 40.0 } else { hit[2] };
        let wall = (u32::from(is_end) << 1) + u32::from(if is_end { z > 0.0 } else { x > 0.0 });
        if hit[1] < self.floor {
            return self.ground([x, y, z].map(|component| component * self.floor / y));
        }
        // The houses of a wall differ in height.
        let house = hash(201, wall, (along / 1.5).floor() as i32 as u32);
        let top = self.top + 0.3 * unit(house);
        if hit[1] > top {
            let cloud = 0.8 + 0.4 * noise([4.0 * x, 6.0 * y, 4.0 * z], 202, 3);
            return scaled(self.sky, cloud);
        }
        let facade = self.facade(along, hit[1], top, house);
        let grain = 0.86 + 0.28 * noise(hit.map(|component| 14.0 * component), 203, 3);
        // Air makes what is far away brighter; the light comes from above.
        let haze = 0.45 * smoothstep(1.0, 8.0, distance);
        let light = mix(0.62, 1.12, smoothstep(self.floor, top, hit[1]));
        blend(scaled(facade, grain * light), [0.75; 3], haze)
    }

    /// The front of a house: an arcade, storeys with windows, and cornices between them.
    fn facade(&self, along: f32, height: f32, top: f32, house: u32) -> Color {
        const BAY: f32 = 0.42;
        const STOREY: f32 = 0.46;
        let own = scaled(self.wall, 0.86 + 0.28 * unit(house));
        let bay = (along / BAY) - (along / BAY).floor() - 0.5;
        let above = height - self.floor;
        let storey = (above / STOREY).floor();
        let within = above / STOREY - storey;
        if top - height < 0.07 || within > 0.93 {
            return scaled(own, 1.25);
        }
        if within > 0.88 {
            return scaled(own, 0.55);
        }
        if storey < 1.0 {
            // Arches between pillars.
            let half = if within > 0.55 {
                let up = (within - 0.55) / 0.3;
                0.34 * (1.0 - up * up).max(0.0).sqrt()
            } else {
                0.34
            };
            return if bay.abs() < half {
                scaled(self.window, 0.7)
            } else {
                own
            };
        }
        let (across, up) = (bay.abs() / 0.21, (within - 0.47).abs() / 0.30);
        let edge = across.max(up);
        if edge < 0.86 {
            // Panes mirror the sky a little.
            let is_bar = bay.abs() < 0.012 || (within - 0.55).abs() < 0.012;
            let pane = scaled(self.window, 1.0 + 0.9 * smoothstep(0.2, 0.8, within));
            if is_bar { own } else { pane }
        } else if edge < 1.12 {
            scaled(own, 1.2)
        } else {
            own
        }
    }

    fn ground(&self, [x, _, z]: Vector) -> Color {
        let distance = (x * x + z * z).sqrt();
        let rough = 0.80 + 0.40 * noise([9.0 * x, 0.5, 9.0 * z], 204, 4);
        let stone = if self.slab > 0.0 {
            // Slabs in a diagonal pattern.
            let [across, along] = [(x + z) / self.slab, (x - z) / self.slab];
            let own = unit(hash(
                205,
                across.floor() as i32 as u32,
                along.floor() as i32 as u32,
            ));
            let joint = [across, along]
                .map(|at| (at - at.floor() - 0.5).abs())
                .into_iter()
                .fold(0.0, f32::max);
            let depth = 1.0 - 0.35 * smoothstep(0.44, 0.48, joint);
            scaled(self.paving, (0.85 + 0.3 * own) * depth)
        } else if x.abs() > 0.62 {
            // Sidewalks with a curb.
            scaled(self.paving, if x.abs() < 0.65 { 0.6 } else { 1.25 })
        } else {
            let is_line = x.abs() < 0.012 && (z * 1.4) - (z * 1.4).floor() < 0.5;
            scaled(self.paving, if is_line { 1.6 } else { 0.9 })
        };
        blend(
            scaled(stone, rough),
            [0.62; 3],
            0.35 * smoothstep(1.0, 7.0, distance),
        )
    }
}
