//! Stones: tiles, pebbles, lichen, slate and marble.

use toyproof_image::{Image, pcg};

use crate::color::{Color, Tone, blend, ramp, scaled, toned, toned_red};
use crate::field::{Field, Points, hash, smoothstep, unit};

/// A wall of rectangular stones of several sizes with joints between them.
pub(crate) fn rock_tiles() -> Image {
    const SIDE: usize = 512;
    let surface = Field::fractal(SIDE, [16, 16], 11, 0.9);
    let grain = Field::fractal(SIDE, [128, 128], 12, 1.0);
    let wobble = [13, 14].map(|seed| Field::fractal(SIDE, [16, 16], seed, 0.6));
    let stones = Field::new(SIDE, |x, y| {
        let [dx, dy] = [0, 1].map(|i| wobble[i].get(x as isize, y as isize) * 1.6);
        let Stone { id, inside } = stone(x as f32 + dx, y as f32 + dy);
        // The height of a stone: rough, tilted, and rounded at the joint.
        let tilt = (unit(id) - 0.5) * x as f32 * 0.04;
        smoothstep(0.0, 7.0, inside) * (9.0 + tilt + 1.6 * surface.get(x as isize, y as isize))
    });
    let light = stones.lit();
    let tone = Tone {
        mean: [153, 128, 115],
        deviation: [26, 28, 26],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let [dx, dy] = [0, 1].map(|i| wobble[i].get(at.0, at.1) * 1.6);
        let Stone { id, inside } = stone(x as f32 + dx, y as f32 + dy);
        let [sand, brown, rose] = [[0.72, 0.58, 0.45], [0.52, 0.40, 0.32], [0.66, 0.50, 0.47]];
        let own = blend(blend(sand, brown, unit(pcg(id))), rose, unit(pcg(id + 1)) * 0.7);
        let stone = scaled(
            own,
            1.0 + 0.07 * surface.get(at.0, at.1) + 0.05 * grain.get(at.0, at.1),
        );
        let joint = scaled([0.64, 0.55, 0.54], 1.0 + 0.06 * grain.get(at.0, at.1));
        let color = blend(joint, stone, smoothstep(1.5, 4.0, inside));
        scaled(color, 1.0 + (0.10 * light.get(at.0, at.1)).clamp(-0.5, 0.35))
    })
}

struct Stone {
    id: u32,
    /// The distance from the middle of the joint in texels.
    inside: f32,
}

/// The stone at a position of the wall, in texels. Rows are as high as a sixth or a twelfth of the image.
fn stone(x: f32, y: f32) -> Stone {
    /// The lower edges of the rows, and the upper edge of the last.
    const ROWS: [f32; 9] = [0.0, 44.0, 128.0, 171.0, 256.0, 341.0, 384.0, 470.0, 512.0];
    let (x, y) = (x.rem_euclid(512.0), y.rem_euclid(512.0));
    let row = ROWS.partition_point(|&edge| edge <= y).clamp(1, 8) - 1;
    let mut vertical = (y - ROWS[row]).min(ROWS[row + 1] - y);
    // Stones of a row have widths between 1/8 and 1/4 of the image.
    let count = if ROWS[row + 1] - ROWS[row] > 60.0 { 5 } else { 6 };
    let width = 512.0 / count as f32;
    let edge = |at: i32| {
        let shift = unit(hash(5, at.rem_euclid(count) as u32, row as u32)) - 0.5;
        (at as f32 + 0.6 * shift + 0.37 * row as f32) * width
    };
    let guess = (x / width - 0.37 * row as f32).floor() as i32;
    let column = (guess - 1..=guess + 2)
        .rev()
        .find(|&at| edge(at) <= x)
        .unwrap_or(guess);
    let horizontal = (x - edge(column)).min(edge(column + 1) - x);
    let mut id = hash(6, column.rem_euclid(count) as u32, row as u32);
    // Some of the high stones are two.
    if count == 5 && id.is_multiple_of(3) {
        let middle = ROWS[row] + 0.45 * (ROWS[row + 1] - ROWS[row]);
        vertical = vertical.min((y - middle).abs());
        id = pcg(id + u32::from(y > middle));
    }
    Stone {
        id,
        inside: horizontal.min(vertical),
    }
}

/// The heights of pebbles of several sizes that lie upon one another.
pub(crate) fn pebbles() -> Image {
    const SIDE: usize = 512;
    let heaps = [(6, 1.0), (9, 0.75), (14, 0.5), (22, 0.33), (36, 0.2)];
    let heaps = heaps.map(|(cells, height)| (Points::new([cells; 2], 20 + cells), height));
    let bends = [25, 26].map(|seed| Field::fractal(SIDE, [16, 16], seed, 0.5));
    let heights = Field::new(SIDE, |x, y| {
        let [dx, dy] = [0, 1].map(|i| 2.0 * bends[i].get(x as isize, y as isize));
        let (u, v) = ((x as f32 + dx) / SIDE as f32, (y as f32 + dy) / SIDE as f32);
        let layer = |(points, height): &(Points, f32)| {
            let pebble = points.nearest(u, v);
            // A part of the places is empty, so that smaller pebbles show.
            let size = 0.3 + 0.35 * unit(pcg(pebble.id));
            let is_there = unit(pcg(pebble.id + 1)) < 0.7;
            let dome = 1.0 - (pebble.first / size) * (pebble.first / size);
            let border = smoothstep(0.0, 0.4, pebble.second - pebble.first);
            if is_there && dome > 0.0 {
                height * size * (0.55 + 1.1 * dome.sqrt()) * border
            } else {
                0.0
            }
        };
        heaps.iter().map(layer).fold(0.0, f32::max)
    });
    let heights = heights.blurred(1);
    toned_red(SIDE, 94, 40, |x, y| heights.get(x as isize, y as isize))
}

/// Dark slate with horizontal ridges and spots of lichen.
pub(crate) fn lichen() -> Image {
    const SIDE: usize = 1024;
    let bends = [31, 32].map(|seed| Field::fractal(SIDE, [4, 4], seed, 0.6));
    let ridges = Field::fractal(SIDE, [2, 16], 33, 0.72).warped([&bends[0], &bends[1]], 24.0);
    let light = ridges.lit().normalized();
    let spots = Field::fractal(SIDE, [8, 8], 34, 0.75);
    let crumbs = Field::fractal(SIDE, [64, 64], 35, 0.75);
    let tone = Tone {
        mean: [80, 85, 80],
        deviation: [51, 51, 52],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let height = ridges.get(at.0, at.1);
        let shade = 0.30 + 0.08 * height + 0.10 * light.get(at.0, at.1);
        let slate = ramp(
            &[
                (0.0, [0.02, 0.03, 0.03]),
                (0.3, [0.28, 0.31, 0.30]),
                (0.7, [0.66, 0.69, 0.68]),
            ],
            shade,
        );
        let cover = smoothstep(1.0, 1.7, spots.get(at.0, at.1) + 0.45 * crumbs.get(at.0, at.1));
        let lichen: Color = if bends[0].get(at.0, at.1) > 0.6 {
            [0.62, 0.66, 0.40]
        } else {
            [0.72, 0.77, 0.73]
        };
        blend(slate, scaled(lichen, 0.8 + 0.15 * crumbs.get(at.0, at.1)), cover)
    })
}

/// A worn stone of bluish gray with brown veils.
pub(crate) fn blue_stone() -> Image {
    const SIDE: usize = 1024;
    let surface = Field::fractal(SIDE, [8, 8], 41, 0.88);
    let light = Field::fractal(SIDE, [32, 32], 42, 0.75).lit().normalized();
    let veils = Field::fractal(SIDE, [4, 4], 43, 0.85);
    let tone = Tone {
        mean: [116, 113, 110],
        deviation: [29, 29, 30],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let shade = 1.0 + 0.22 * surface.get(at.0, at.1) + 0.16 * light.get(at.0, at.1);
        let veil = smoothstep(-0.6, 1.2, veils.get(at.0, at.1));
        scaled(blend([0.40, 0.45, 0.50], [0.54, 0.47, 0.39], veil), shade)
    })
}

/// Marble of a dull rose with swirls and dark stains.
pub(crate) fn rose_marble() -> Image {
    const SIDE: usize = 1024;
    let bends = [51, 52].map(|seed| Field::fractal(SIDE, [4, 4], seed, 0.6));
    let swirls = Field::fractal(SIDE, [4, 8], 53, 0.75).warped([&bends[0], &bends[1]], 55.0);
    let light = swirls.lit().normalized();
    let grain = Field::fractal(SIDE, [64, 64], 54, 0.95);
    let stains = Field::fractal(SIDE, [4, 4], 55, 0.8);
    let tone = Tone {
        mean: [148, 117, 104],
        deviation: [31, 32, 32],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let t = 0.5 + 0.17 * swirls.get(at.0, at.1);
        let marble = ramp(
            &[
                (0.1, [0.34, 0.24, 0.20]),
                (0.45, [0.57, 0.44, 0.39]),
                (0.7, [0.68, 0.55, 0.50]),
                (0.95, [0.80, 0.69, 0.62]),
            ],
            t,
        );
        let shade = 1.0 + 0.06 * light.get(at.0, at.1) + 0.06 * grain.get(at.0, at.1);
        let stain = 0.45 * smoothstep(0.8, 1.8, stains.get(at.0, at.1) + 0.3 * grain.get(at.0, at.1));
        blend(scaled(marble, shade), [0.33, 0.25, 0.20], stain)
    })
}
