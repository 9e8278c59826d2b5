//! Weathered surfaces: bark, rust, metal, blotches of color, and glittering dust.

use toyproof_image::{Image, pcg};

use crate::color::{Tone, blend, ramp, scaled, toned};
use crate::field::{Field, Points, hash, smoothstep, unit};

/// Pale bark with cracks and pits.
pub(crate) fn bark() -> Image {
    const SIDE: usize = 1024;
    let bends = [61, 62].map(|seed| Field::fractal(SIDE, [8, 8], seed, 0.7));
    let surface = Field::fractal(SIDE, [4, 8], 63, 0.82);
    let light = Field::fractal(SIDE, [16, 32], 64, 0.65).lit().normalized();
    let plates = Points::new([5, 12], 65);
    let pits = Points::new([48, 48], 66);
    let tone = Tone {
        mean: [142, 122, 90],
        deviation: [51, 51, 48],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let [dx, dy] = [0, 1].map(|i| 0.014 * bends[i].get(at.0, at.1));
        let (u, v) = (x as f32 / SIDE as f32, y as f32 / SIDE as f32);
        let plate = plates.nearest(u + dx, v + dy);
        let pit = pits.nearest(u + 0.4 * dx, v + 0.4 * dy);
        let height = surface.get(at.0, at.1);
        let bark = ramp(
            &[
                (-2.0, [0.28, 0.21, 0.13]),
                (0.0, [0.60, 0.51, 0.37]),
                (2.0, [0.88, 0.80, 0.63]),
            ],
            height + 0.5 * light.get(at.0, at.1) + 0.8 * (unit(plate.id) - 0.5),
        );
        let crack = 1.0 - smoothstep(0.01, 0.07, plate.second - plate.first);
        let depth = 0.8 * crack * smoothstep(-0.8, 0.4, bends[1].get(at.0, at.1));
        let is_pit = unit(pcg(pit.id)) < 0.4 + 0.3 * height;
        let hollow = if is_pit {
            1.0 - smoothstep(0.16, 0.34, pit.first)
        } else {
            0.0
        };
        scaled(bark, 1.0 - depth.max(0.6 * hollow))
    })
}

/// Orange rust full of dark holes.
pub(crate) fn pitted_rust() -> Image {
    const SIDE: usize = 1024;
    let surface = Field::fractal(SIDE, [16, 16], 71, 0.7);
    let light = surface.lit().normalized();
    let sizes = Field::fractal(SIDE, [8, 8], 72, 0.8);
    let holes = [(26, 73), (52, 74)].map(|(cells, seed)| Points::new([cells; 2], seed));
    let tone = Tone {
        mean: [105, 69, 51],
        deviation: [62, 51, 40],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let (u, v) = (x as f32 / SIDE as f32, y as f32 / SIDE as f32);
        let rust = ramp(
            &[
                (-1.6, [0.06, 0.04, 0.05]),
                (-0.4, [0.34, 0.17, 0.10]),
                (0.5, [0.58, 0.35, 0.20]),
                (1.4, [0.84, 0.68, 0.50]),
                (2.4, [1.0, 0.95, 0.86]),
            ],
            surface.get(at.0, at.1) + 0.35 * light.get(at.0, at.1),
        );
        let hole = |points: &Points| {
            let nearest = points.nearest(u, v);
            let radius = 0.22 + 0.10 * sizes.get(at.0, at.1) + 0.2 * (unit(pcg(nearest.id)) - 0.5);
            1.0 - smoothstep(radius - 0.08, radius + 0.06, nearest.first)
        };
        scaled(rust, 1.0 - 0.93 * hole(&holes[0]).max(hole(&holes[1])))
    })
}

/// Blue-gray metal with rust that runs down from above.
pub(crate) fn rusty_metal() -> Image {
    const SIDE: usize = 512;
    let plate = Field::fractal(SIDE, [4, 4], 81, 0.85);
    let grain = Field::fractal(SIDE, [128, 128], 82, 1.0);
    let runs = Field::fractal(SIDE, [8, 2], 83, 0.8);
    let stains = Field::fractal(SIDE, [4, 4], 84, 0.85);
    let tone = Tone {
        mean: [121, 118, 123],
        deviation: [17, 17, 20],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let fine = grain.get(at.0, at.1);
        let metal = scaled(
            [0.44, 0.46, 0.53],
            1.0 + 0.07 * plate.get(at.0, at.1) + 0.05 * fine,
        );
        let amount = stains.get(at.0, at.1) + 0.7 * runs.get(at.0, at.1) + 0.25 * fine;
        let rust = blend([0.55, 0.36, 0.26], [0.38, 0.27, 0.23], 0.5 + 0.3 * fine);
        blend(metal, rust, 0.75 * smoothstep(0.7, 2.2, amount))
    })
}

/// Large soft blotches of brown and blue that ran down.
pub(crate) fn blotches() -> Image {
    const SIDE: usize = 1024;
    let light = Field::fractal(SIDE, [4, 2], 91, 0.6);
    let hue = Field::fractal(SIDE, [4, 4], 92, 0.6);
    let runs = Field::fractal(SIDE, [64, 8], 93, 0.5);
    let tone = Tone {
        mean: [130, 119, 106],
        deviation: [36, 35, 35],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let shade = 0.5 + 0.16 * light.get(at.0, at.1) + 0.02 * runs.get(at.0, at.1);
        let brown = ramp(
            &[
                (0.1, [0.30, 0.18, 0.12]),
                (0.5, [0.58, 0.44, 0.34]),
                (0.9, [0.80, 0.72, 0.62]),
            ],
            shade,
        );
        let blue = ramp(
            &[
                (0.1, [0.22, 0.24, 0.28]),
                (0.5, [0.44, 0.48, 0.52]),
                (0.9, [0.72, 0.76, 0.76]),
            ],
            shade,
        );
        blend(brown, blue, smoothstep(-0.5, 1.0, hue.get(at.0, at.1)))
    })
}

/// Brown dust with golden specks and bright points, as a sky full of stars.
pub(crate) fn stars() -> Image {
    const SIDE: usize = 512;
    let dust = Field::fractal(SIDE, [8, 8], 101, 0.88);
    let clouds = Field::fractal(SIDE, [4, 4], 102, 0.75);
    let points = [(9, 104), (24, 105), (60, 106)].map(|(cells, seed)| Points::new([cells; 2], seed));
    let tone = Tone {
        mean: [85, 65, 49],
        deviation: [37, 35, 30],
    };
    toned(SIDE, tone, |x, y| {
        let at = (x as isize, y as isize);
        let (u, v) = (x as f32 / SIDE as f32, y as f32 / SIDE as f32);
        let shade = 0.5 + 0.16 * dust.get(at.0, at.1) + 0.10 * clouds.get(at.0, at.1);
        let brown = ramp(
            &[
                (0.0, [0.10, 0.07, 0.04]),
                (0.5, [0.32, 0.23, 0.15]),
                (1.0, [0.62, 0.48, 0.30]),
            ],
            shade,
        );
        // Specks of one texel; points with a glow of a few.
        let speck = unit(hash(103, x as u32, y as u32));
        let gold = 0.4 * smoothstep(0.95, 1.0, speck + 0.03 * clouds.get(at.0, at.1));
        let glow = |points: &Points, share: f32| {
            let star = points.nearest(u, v);
            let brightness = (unit(pcg(star.id)) - 1.0 + share) / share;
            let falling = 1.0 - smoothstep(0.0, 0.5, star.first);
            let distance = star.first / 0.09;
            brightness.max(0.0) * falling / (1.0 + distance * distance)
        };
        let white = glow(&points[0], 0.4) + 0.8 * glow(&points[1], 0.5) + 0.7 * glow(&points[2], 0.5);
        let lit = blend(brown, [0.90, 0.72, 0.36], gold);
        [0, 1, 2].map(|i| lit[i] + white * [1.5, 1.45, 1.35][i])
    })
}
