//! A street between houses.

use toyproof_image::Image;

use crate::color::{Tone, toned};
use crate::cube::{LONDON, normalized};
use crate::field::Field;

/// A street with houses on both sides, the sky, and a roadway.
pub(crate) fn street() -> Image {
    const SIDE: usize = 512;
    let grain = Field::fractal(SIDE, [256, 256], 141, 1.0);
    let tone = Tone {
        mean: [147, 136, 123],
        deviation: [66, 68, 66],
    };
    toned(SIDE, tone, |x, y| {
        let mut sum = [0.0; 3];
        for (dx, dy) in [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)] {
            // A view of 90° with the horizon below the middle.
            let right = (x as f32 + dx) / SIDE as f32 * 2.0 - 1.0;
            let up = (y as f32 + dy) / SIDE as f32 * 2.0 - 0.75;
            let color = LONDON.color(normalized([right, up, -1.0]));
            sum = [0, 1, 2].map(|i| sum[i] + 0.25 * color[i].min(1.0));
        }
        sum.map(|component| component * (1.0 + 0.03 * grain.get(x as isize, y as isize)))
    })
}
