//! A small animated figure in a row of frames.

use toyproof_image::Image;

use crate::color::in_levels;

/// Columns of a frame; shaders select one as `40.0/256.0`.
const FRAME: i32 = 40;
/// The last 16 of the 256 columns are empty.
const FRAMES: i32 = 6;

/// A running cat in six frames of 40×32 texels, from left to right. Around it is white of alpha 0.
pub(crate) fn running_cat() -> Image {
    let pixels = (0..32).flat_map(|y| {
        (0..256).map(move |x| {
            let (frame, x) = (x / FRAME, x % FRAME);
            let color = if frame < FRAMES { texel(frame, x, y) } else { None };
            in_levels(color.map_or([1.0, 1.0, 1.0, 0.0], |[r, g, b]| [r, g, b, 1.0]))
        })
    });
    Image::new(256, 32, pixels.collect())
}

/// The color of a frame at a texel, with an outline of one texel around the cat.
fn texel(frame: i32, x: i32, y: i32) -> Option<[f32; 3]> {
    part(frame, x, y).or_else(|| {
        let around = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        let is_outline = around
            .iter()
            .any(|(dx, dy)| part(frame, x + dx, y + dy).is_some());
        is_outline.then_some([0.08, 0.06, 0.06])
    })
}

/// The color of the cat at a texel.
fn part(frame: i32, x: i32, y: i32) -> Option<[f32; 3]> {
    const FUR: [f32; 3] = [0.93, 0.56, 0.22];
    const STRIPE: [f32; 3] = [0.72, 0.36, 0.12];
    const PALE: [f32; 3] = [0.99, 0.86, 0.68];
    const DARK: [f32; 3] = [0.10, 0.08, 0.10];
    let frame = frame as usize;
    // The body rises when the legs are together.
    let y = y - [0, 1, 1, 0, 1, 1][frame];
    let swing = [3, 1, -2, -3, -1, 2][frame];
    let is_in = |center: [i32; 2], radii: [i32; 2]| {
        let [dx, dy] = [x - center[0], y - center[1]];
        dx * dx * radii[1] * radii[1] + dy * dy * radii[0] * radii[0]
            <= radii[0] * radii[0] * radii[1] * radii[1]
    };
    if [(29, 19), (33, 19)].contains(&(x, y)) || (x, y) == (31, 16) {
        return Some(DARK);
    }
    if is_in([31, 16], [3, 2]) {
        return Some(PALE);
    }
    let is_ear = |left: i32| (23..28).contains(&y) && (x - left).abs() <= 27 - y && (x - left).abs() <= 2;
    if is_in([30, 18], [6, 6]) || is_ear(26) || is_ear(34) {
        return Some(FUR);
    }
    if is_in([18, 14], [10, 6]) {
        let is_stripe = y > 13 && (x + y / 3) % 5 == 0;
        return Some(if y < 10 {
            PALE
        } else if is_stripe {
            STRIPE
        } else {
            FUR
        });
    }
    let legs = [(11, swing), (14, -swing), (23, swing), (26, -swing)];
    let is_leg = legs.iter().any(|&(hip, swing)| {
        // A leg leans by its swing over its height of seven texels.
        let at = hip + swing * (10 - y) / 7;
        (3..10).contains(&y) && (x - at) * 2 >= -2 && (x - at) * 2 < 4
    });
    if is_leg {
        return Some(if y < 5 { PALE } else { FUR });
    }
    let tail = [1, 2, 1, 0, -1, 0][frame];
    let bend = 17 + (9 - x) * (4 + tail) / 7;
    ((2..10).contains(&x) && (y - bend).abs() <= 1).then_some(if x < 4 { PALE } else { STRIPE })
}
