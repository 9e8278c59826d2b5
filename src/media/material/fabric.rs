//! Made or grown things: wood, a weave of straw, and stones of glass.

use toyproof_image::{Image, pcg};

use crate::color::{Color, Tone, blend, ramp, scaled, toned};
use crate::field::{Field, Points, hash, smoothstep, unit};

/// Varnished wood with a horizontal grain and dark pores.
pub(crate) fn wood() -> Image {
    const SIDE: usize = 1024;
    let bends = Field::fractal(SIDE, [2, 4], 111, 0.5);
    let none = bends.map(|_| 0.0);
    let rings = Field::fractal(SIDE, [2, 32], 112, 0.8).warped([&none, &bends], 9.0);
    let fibers = Field::fractal(SIDE, [16, 256], 113, 0.9).warped([&none, &bends], 9.0);
    let pores = Field::fractal(SIDE, [32, 256], 114, 0.6).warped([&none, &bends], 9.0);
    let clouds = Field::fractal(SIDE, [4, 4], 115, 0.7);
    let tone = Tone {
        mean: [147, 80, 41],
        deviation: [23, 18, 15],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let grain = 0.5 + 0.11 * rings.get(at.0, at.1) + 0.09 * fibers.get(at.0, at.1);
        let color = ramp(
            &[
                (0.1, [0.40, 0.18, 0.08]),
                (0.5, [0.58, 0.31, 0.16]),
                (0.9, [0.74, 0.45, 0.24]),
            ],
            grain + 0.05 * clouds.get(at.0, at.1),
        );
        let pore = smoothstep(1.6, 2.4, pores.get(at.0, at.1) - 0.3 * rings.get(at.0, at.1));
        blend(color, [0.16, 0.07, 0.05], 0.8 * pore)
    })
}

/// Loosely woven straw before a dark ground.
pub(crate) fn woven_straw() -> Image {
    const SIDE: usize = 512;
    const STALKS: u32 = 300;
    let tone = Tone {
        mean: [123, 102, 78],
        deviation: [54, 49, 42],
    };
    let grain = Field::fractal(SIDE, [128, 128], 121, 1.0);
    let patches = Field::fractal(SIDE, [4, 4], 122, 0.8);
    let mut canvas = vec![0.05_f32; SIDE * SIDE];
    // Each stalk covers those before it; horizontal and vertical ones alternate.
    for stalk in 0..STALKS {
        let random = |what| unit(hash(123, stalk, what));
        let (center, half_width) = (random(0) * SIDE as f32, 0.7 + 1.3 * random(1));
        let brightness = 0.45 + 0.55 * random(2);
        let first = (random(3) * SIDE as f32) as usize;
        // Few stalks are as long as the image.
        let length = ((0.35 + random(4)) * SIDE as f32).min(SIDE as f32) as usize;
        for step in 0..length {
            let along = (first + step) % SIDE;
            let middle = center + 5.0 * wave(stalk, along as f32 / SIDE as f32);
            let reach = half_width.ceil() as isize;
            for offset in -reach..=reach {
                let across = middle.floor() as isize + offset;
                let from_middle = (across as f32 - middle) / half_width;
                if from_middle.abs() < 1.0 {
                    let across = across.rem_euclid(SIDE as isize) as usize;
                    let round = (1.0 - from_middle * from_middle).sqrt();
                    let cell = if stalk % 2 == 0 {
                        along * SIDE + across
                    } else {
                        across * SIDE + along
                    };
                    canvas[cell] = brightness * (0.35 + 0.65 * round);
                }
            }
        }
    }
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let rough = 1.0 + 0.06 * grain.get(at.0, at.1) + 0.20 * patches.get(at.0, at.1);
        ramp(
            &[
                (0.0, [0.05, 0.04, 0.03]),
                (0.5, [0.48, 0.38, 0.26]),
                (1.0, [0.92, 0.80, 0.62]),
            ],
            canvas[y * SIDE + x] * rough,
        )
    })
}

/// A smooth periodic curve in [−1, 1] over [0, 1): parabolas between eight random heights.
fn wave(seed: u32, t: f32) -> f32 {
    let at = 8.0 * t;
    let (cell, within) = (at.floor() as i32, at - at.floor());
    let height = |offset: i32| 2.0 * unit(hash(124, seed, (cell + offset).rem_euclid(8) as u32)) - 1.0;
    let smooth = within * within * (3.0 - 2.0 * within);
    height(0) + (height(1) - height(0)) * smooth
}

/// Stones of colored glass, set in dark lead.
pub(crate) fn glass_stones() -> Image {
    const SIDE: usize = 1024;
    let bends = [131, 132].map(|seed| Field::fractal(SIDE, [4, 4], seed, 0.5));
    let clouds = Field::fractal(SIDE, [8, 8], 133, 0.75);
    let glass: [Color; 5] = [
        [0.10, 0.42, 0.30],
        [0.12, 0.24, 0.46],
        [0.36, 0.34, 0.12],
        [0.16, 0.44, 0.44],
        [0.48, 0.50, 0.50],
    ];
    let stones = Points::new([7, 7], 134);
    let tone = Tone {
        mean: [63, 70, 55],
        deviation: [52, 57, 52],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let [dx, dy] = [0, 1].map(|i| 0.03 * bends[i].get(at.0, at.1));
        let stone = stones.nearest(x as f32 / SIDE as f32 + dx, y as f32 / SIDE as f32 + dy);
        let border = stone.second - stone.first;
        let own = glass[(pcg(stone.id) % 5) as usize];
        let cloud = 1.0 + 0.35 * clouds.get(at.0, at.1);
        let depth = 0.35 + 0.9 * smoothstep(0.05, 0.7, border) * unit(pcg(stone.id + 1));
        let glow = scaled(own, depth * cloud);
        // The lamp behind the glass shows at the upper left of some stones.
        let [from_x, from_y] = [stone.offset[0] + 0.12, stone.offset[1] - 0.12];
        let distance = (from_x * from_x + from_y * from_y) / 0.08;
        let lamp = smoothstep(0.45, 1.0, unit(pcg(stone.id + 2))) / (1.0 + distance * distance);
        let lit = blend(glow, [1.0, 1.0, 0.92], lamp * smoothstep(0.06, 0.3, border));
        blend([0.05, 0.05, 0.03], lit, smoothstep(0.03, 0.13, border))
    })
}
