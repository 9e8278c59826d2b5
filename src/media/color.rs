//! Colors of computed media: tones of a material, and 8-bit levels.

use rayon::prelude::*;
use toyproof_image::{Image, quantize};

use crate::field::{mix, statistics};

/// A linear RGB color.
pub(crate) type Color = [f32; 3];

/// A mixture of two colors.
pub(crate) fn blend(a: Color, b: Color, t: f32) -> Color {
    [0, 1, 2].map(|i| mix(a[i], b[i], t))
}

/// A color times a number.
pub(crate) fn scaled(color: Color, factor: f32) -> Color {
    color.map(|component| component * factor)
}

/// The color at `t` of a sequence of colors at increasing positions.
pub(crate) fn ramp(stops: &[(f32, Color)], t: f32) -> Color {
    let next = stops.partition_point(|&(position, _)| position <= t);
    match (next.checked_sub(1).map(|at| stops[at]), stops.get(next)) {
        (Some((low, a)), Some(&(high, b))) => blend(a, b, (t - low) / (high - low)),
        (Some((_, only)), None) | (None, Some(&(_, only))) => only,
        (None, None) => [0.0; 3],
    }
}

/// Mean and standard deviation of each component of a image, in 8-bit levels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tone {
    pub(crate) mean: [u8; 3],
    pub(crate) deviation: [u8; 3],
}

/// An opaque image of 8-bit values with the given mean and standard deviation, from colors on any scale.
pub(crate) fn toned(side: usize, tone: Tone, color: impl Fn(usize, usize) -> Color + Sync) -> Image {
    let mut colors = vec![[0.0; 3]; side * side];
    colors.par_chunks_mut(side).enumerate().for_each(|(y, row)| {
        for (x, cell) in row.iter_mut().enumerate() {
            *cell = color(x, y);
        }
    });
    // Clamping changes the statistics, hence the repetition.
    for _ in 0..4 {
        let statistics = statistics(side, &colors, |&color| color);
        let adjustment = [0, 1, 2].map(|i| {
            let [mean, deviation] = statistics[i];
            let gain = f32::from(tone.deviation[i]) / (255.0 * deviation);
            (gain, f32::from(tone.mean[i]) / 255.0 - mean * gain)
        });
        colors.par_iter_mut().for_each(|color| {
            for (component, (gain, offset)) in color.iter_mut().zip(adjustment) {
                *component = (*component * gain + offset).clamp(0.0, 1.0);
            }
        });
    }
    let pixels = colors.par_iter().map(|&[r, g, b]| in_levels([r, g, b, 1.0]));
    Image::new(side as u32, side as u32, pixels.collect())
}

/// A color rounded to 8-bit levels.
pub(crate) fn in_levels(color: [f32; 4]) -> [f32; 4] {
    color.map(|component| f32::from(quantize(component)) / 255.0)
}

/// A image of one component, which reads as (r, 0, 0, 1), with the given mean and standard deviation.
pub(crate) fn toned_red(
    side: usize,
    mean: u8,
    deviation: u8,
    value: impl Fn(usize, usize) -> f32 + Sync,
) -> Image {
    let tone = Tone {
        mean: [mean; 3],
        deviation: [deviation; 3],
    };
    let gray = toned(side, tone, |x, y| [value(x, y); 3]);
    let pixels = gray.pixels().iter().map(|&[r, ..]| [r, 0.0, 0.0, 1.0]);
    Image::new(side as u32, side as u32, pixels.collect())
}
