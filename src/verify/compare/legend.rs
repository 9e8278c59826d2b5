//! The difference image: a color for each decade of the difference, and a legend of the scale.

use font8x8::{BASIC_FONTS, UnicodeFonts};
use toyproof_image::{Rgb8Image, quantize};

use crate::compare::TOLERANCE;

/// Cool colors of the decades below the tolerance, from 1e−7 up: rounding errors.
const COOL: [[f32; 3]; 4] = [
    [0.05, 0.05, 0.2],
    [0.08, 0.12, 0.4],
    [0.1, 0.25, 0.6],
    [0.15, 0.45, 0.75],
];
/// Warm colors of the decades above it, up to 1: visible differences.
const WARM: [[f32; 3]; 3] = [[0.75, 0.55, 0.1], [0.95, 0.35, 0.1], [1.0, 0.1, 0.1]];
/// The color of an ill-conditioned pixel: it differs, but might not with another rounding of its operations.
const ILL_CONDITIONED: [f32; 3] = [0.8, 0.35, 1.0];
/// The color of an excluded pixel, which depends on undefined behavior.
const UNDEFINED: [f32; 3] = [0.3, 0.3, 0.3];
const TEXT_COLOR: [f32; 3] = [0.85, 0.85, 0.85];
const GLYPH_SIZE: u32 = 8;

/// The smallest decade that is distinguished, as a power of ten; the largest is 0.1 to 1.
const LOWEST_DECADE: i32 = -10;

/// The level of a pixel of the difference image. Small, since there are millions of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DiffLevel(u8);

impl DiffLevel {
    /// Ill-conditioned.
    pub const ILL_CONDITIONED: Self = Self(u8::MAX);
    /// Excluded.
    pub const UNDEFINED: Self = Self(u8::MAX - 1);

    /// The level of a difference ≥ 0; NaN counts as 1.
    #[must_use]
    pub fn by(difference: f32) -> Self {
        let difference = if difference.is_nan() { 1.0 } else { difference };
        let exceeded = (LOWEST_DECADE..0).take_while(|&decade| difference > 10f32.powi(decade));
        Self(exceeded.count() as u8)
    }

    /// Whether the difference is larger than that power of ten.
    fn exceeds(self, decade: i32) -> bool {
        i32::from(self.0) > decade - LOWEST_DECADE
    }
}

/// The scale of a difference image.
#[derive(Debug, Clone, Copy)]
pub struct Legend {
    /// Differences up to this are shown in cool colors; a power of ten in [1e−6, 1e−3].
    pub tolerance: f32,
}

/// The scale of visible differences: those above rounding stand out.
pub const SEEN_BY_EYE: Legend = Legend {
    tolerance: TOLERANCE as f32,
};

/// The scale of bit-exact comparisons: all differences above the last bits stand out.
pub const IN_BITS: Legend = Legend { tolerance: 1e-6 };

/// Renders the difference image of `size` from one level per pixel (bottom row first), with the legend in a
/// strip below it. The image is at least as wide as the legend requires.
#[must_use]
pub fn difference(size: [u32; 2], levels: &[DiffLevel], legend: Legend) -> Rgb8Image {
    let colors: [_; 256] = std::array::from_fn(|byte| legend.color(DiffLevel(byte as u8)).map(quantize));
    let pixels = levels.iter().map(|level| colors[usize::from(level.0)]);
    map_above(size, pixels, &legend.entries())
}

/// A map of `size` from the color of each pixel (bottom row first), with a legend in a strip below it.
pub(super) fn map_above(
    [width, height]: [u32; 2],
    pixels: impl Iterator<Item = [u8; 3]>,
    entries: &[(String, [f32; 3])],
) -> Rgb8Image {
    let columns = entries
        .iter()
        .map(|(text, _)| text.len() as u32 + 3)
        .max()
        .unwrap_or(0);
    let entry_width = columns * GLYPH_SIZE;
    let total_width = width.max(entry_width);
    let per_row = (total_width / entry_width).max(1);
    let rows = (entries.len() as u32).div_ceil(per_row);
    let line_height = GLYPH_SIZE + 4;
    let strip = rows * line_height + 4;
    let mut canvas = Canvas::new(total_width, height + strip);
    for (at, color) in (0..).zip(pixels) {
        canvas.set(at % width, strip + at / width, color);
    }
    for (index, (text, color)) in entries.iter().enumerate() {
        let index = index as u32;
        let x = (index % per_row) * entry_width + 4;
        let top = strip - 4 - (index / per_row) * line_height;
        canvas.fill(x, top - GLYPH_SIZE, GLYPH_SIZE, color.map(quantize));
        canvas.write(x + GLYPH_SIZE + 4, top, text);
    }
    canvas.finish()
}

impl Legend {
    /// The color of a level.
    fn color(self, level: DiffLevel) -> [f32; 3] {
        match level {
            DiffLevel::ILL_CONDITIONED => ILL_CONDITIONED,
            DiffLevel::UNDEFINED => UNDEFINED,
            _ => {
                let mut exceeded = self.decades().rev().filter(|&(decade, _)| level.exceeds(decade));
                exceeded.next().map_or([0.0; 3], |(_, color)| color)
            }
        }
    }

    /// The lower bound of each decade, as a power of ten, and its color, in ascending order.
    fn decades(self) -> impl DoubleEndedIterator<Item = (i32, [f32; 3])> {
        let decades = self.tolerance.log10().round() as i32;
        let cool = COOL
            .into_iter()
            .enumerate()
            .map(move |(i, color)| (decades - 4 + i as i32, color));
        let warm = WARM
            .into_iter()
            .enumerate()
            .map(move |(i, color)| (decades + i as i32, color));
        cool.chain(warm)
    }

    /// The texts of the legend and their colors; differences in ascending order.
    #[must_use]
    pub fn entries(self) -> Vec<(String, [f32; 3])> {
        let mut entries: Vec<_> = self
            .decades()
            .map(|(decade, color)| (format!("> 1e{decade}"), color))
            .collect();
        entries.push(("ill-conditioned".to_owned(), ILL_CONDITIONED));
        entries.push(("undefined".to_owned(), UNDEFINED));
        entries
    }
}

/// An image under construction; y upwards.
struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    fn new(width: u32, height: u32) -> Self {
        let pixels = vec![[0; 3]; width as usize * height as usize];
        Self {
            width,
            height,
            pixels,
        }
    }

    fn set(&mut self, x: u32, y: u32, color: [u8; 3]) {
        if x < self.width && y < self.height {
            self.pixels[y as usize * self.width as usize + x as usize] = color;
        }
    }

    /// Fills a square with its lower left corner at (x, y).
    fn fill(&mut self, x: u32, y: u32, side: u32, color: [u8; 3]) {
        for dy in 0..side {
            for dx in 0..side {
                self.set(x + dx, y + dy, color);
            }
        }
    }

    /// Writes text with its upper edge at `top`.
    fn write(&mut self, x: u32, top: u32, text: &str) {
        for (column, character) in text.chars().enumerate() {
            let rows = BASIC_FONTS.get(character).unwrap_or_default();
            for (row, bits) in rows.iter().enumerate() {
                for bit in (0..GLYPH_SIZE).filter(|bit| bits & (1 << bit) != 0) {
                    self.set(
                        x + column as u32 * GLYPH_SIZE + bit,
                        top - 1 - row as u32,
                        TEXT_COLOR.map(quantize),
                    );
                }
            }
        }
    }

    fn finish(self) -> Rgb8Image {
        Rgb8Image::new(self.width, self.height, self.pixels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEGEND: Legend = Legend { tolerance: 1e-3 };

    #[test]
    fn each_decade_has_its_color_and_equal_pixels_are_black() {
        let color = |difference| LEGEND.color(DiffLevel::by(difference));
        assert_eq!(color(0.0), [0.0; 3]);
        assert_eq!(color(1e-7), [0.0; 3]);
        assert_eq!(color(1.1e-7), COOL[0]);
        assert_eq!(color(1e-3), COOL[3], "a difference equal to the tolerance agrees");
        assert_eq!(color(1.1e-3), WARM[0]);
        assert_eq!(color(0.5), WARM[2]);
        assert_eq!(color(7.0), WARM[2]);
        assert_eq!(color(f32::NAN), WARM[2]);
        assert_eq!(LEGEND.color(DiffLevel::ILL_CONDITIONED), ILL_CONDITIONED);
        let bit_exact = Legend { tolerance: 1e-6 };
        assert_eq!(bit_exact.color(DiffLevel::by(1.1e-10)), COOL[0]);
        assert_eq!(bit_exact.color(DiffLevel::by(1.0)), WARM[2]);
    }

    #[test]
    fn the_image_is_above_a_legend_of_the_scale() {
        let levels = vec![DiffLevel::by(1.0); 4];
        let image = difference([2, 2], &levels, LEGEND);
        let [width, height] = image.size();
        assert!(width >= 64 && height > 2 + GLYPH_SIZE);
        assert_eq!(
            image.get(0, height - 1),
            WARM[2].map(quantize),
            "the upper left pixel"
        );
        assert!(
            image.pixels().contains(&TEXT_COLOR.map(quantize)),
            "text is written"
        );
        let names: Vec<_> = LEGEND.entries().into_iter().map(|(name, _)| name).collect();
        assert!(names.contains(&"> 1e-3".to_owned()), "{names:?}");
    }
}
