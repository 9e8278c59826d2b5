//! The difference of two pictures as a picture: a colour for each decade, and a legend of the scale.

use font8x8::{BASIC_FONTS, UnicodeFonts};
use toyproof_image::{Shown, quantise};

/// Colours of the decades below the tolerance, from 1e−7 up: rounding, in cool colours.
const COOL: [[f32; 3]; 4] = [
    [0.05, 0.05, 0.2],
    [0.08, 0.12, 0.4],
    [0.1, 0.25, 0.6],
    [0.15, 0.45, 0.75],
];
/// Colours above it, up to 1: differences that are seen, in warm colours.
const WARM: [[f32; 3]; 3] = [[0.75, 0.55, 0.1], [0.95, 0.35, 0.1], [1.0, 0.1, 0.1]];
/// A pixel that differs, and might not if its operations were rounded another way.
const UNDECIDED: [f32; 3] = [0.8, 0.35, 1.0];
/// A pixel that is left out, because the shader does there what GLSL leaves undefined.
const UNDEFINED: [f32; 3] = [0.3, 0.3, 0.3];
const INK: [f32; 3] = [0.85, 0.85, 0.85];
const GLYPH: u32 = 8;

/// The smallest decade that a difference is told of, as a power of ten; the largest is 0.1 to 1.
const LOWEST: i32 = -10;

/// How a pixel of the difference picture is shown. Small, since there are millions of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark(u8);

impl Mark {
    /// As one that differs, but hangs by a hair.
    pub const UNDECIDED: Self = Self(u8::MAX);
    /// As one that is left out.
    pub const UNDEFINED: Self = Self(u8::MAX - 1);

    /// By the size of its difference, ≥ 0; NaN counts as 1.
    #[must_use]
    pub fn by(difference: f32) -> Self {
        let difference = if difference.is_nan() { 1.0 } else { difference };
        let exceeded = (LOWEST..0).take_while(|&decade| difference > 10f32.powi(decade));
        Self(exceeded.count() as u8)
    }

    /// Whether the difference is larger than that power of ten.
    fn is_beyond(self, decade: i32) -> bool {
        i32::from(self.0) > decade - LOWEST
    }
}

/// What the legend tells.
#[derive(Debug, Clone, Copy)]
pub struct Legend {
    /// Differences up to this are shown in cool colours; a power of ten in [1e−6, 1e−3].
    pub tolerance: f32,
}

/// The difference picture of `size`, one mark a pixel (bottom row first), with the legend in a strip below
/// it. The picture is at least as wide as the legend needs.
#[must_use]
pub fn difference(size: [u32; 2], marks: &[Mark], legend: Legend) -> Shown {
    let entries = legend.entries();
    let columns = entries
        .iter()
        .map(|(words, _)| words.len() as u32 + 3)
        .max()
        .unwrap_or(0);
    let cell = columns * GLYPH;
    let [width, height] = size;
    let wide = width.max(cell);
    let per_row = (wide / cell).max(1);
    let rows = (entries.len() as u32).div_ceil(per_row);
    let line = GLYPH + 4;
    let strip = rows * line + 4;
    let mut canvas = Canvas::new(wide, height + strip);
    let colours: [_; 256] = std::array::from_fn(|byte| legend.colour(Mark(byte as u8)).map(quantise));
    for (row, y) in marks.chunks(width as usize).zip(strip..) {
        for (mark, x) in row.iter().zip(0..) {
            canvas.set(x, y, colours[usize::from(mark.0)]);
        }
    }
    for (index, (words, colour)) in entries.iter().enumerate() {
        let index = index as u32;
        let x = (index % per_row) * cell + 4;
        let top = strip - 4 - (index / per_row) * line;
        canvas.fill(x, top - GLYPH, GLYPH, colour.map(quantise));
        canvas.write(x + GLYPH + 4, top, words);
    }
    canvas.finish()
}

impl Legend {
    /// What a mark is shown as.
    fn colour(self, mark: Mark) -> [f32; 3] {
        match mark {
            Mark::UNDECIDED => UNDECIDED,
            Mark::UNDEFINED => UNDEFINED,
            _ => {
                let mut reached = self.decades().rev().filter(|&(decade, _)| mark.is_beyond(decade));
                reached.next().map_or([0.0; 3], |(_, colour)| colour)
            }
        }
    }

    /// The lower bound of each decade, as a power of ten, and its colour; upwards.
    fn decades(self) -> impl DoubleEndedIterator<Item = (i32, [f32; 3])> {
        let decades = self.tolerance.log10().round() as i32;
        let cool = COOL
            .into_iter()
            .enumerate()
            .map(move |(i, colour)| (decades - 4 + i as i32, colour));
        let warm = WARM
            .into_iter()
            .enumerate()
            .map(move |(i, colour)| (decades + i as i32, colour));
        cool.chain(warm)
    }

    /// What stands beside the picture: words, and their colour; sizes upwards.
    #[must_use]
    pub fn entries(self) -> Vec<(String, [f32; 3])> {
        let mut entries: Vec<_> = self
            .decades()
            .map(|(decade, colour)| (format!("> 1e{decade}"), colour))
            .collect();
        entries.push(("undecided".to_owned(), UNDECIDED));
        entries.push(("undefined".to_owned(), UNDEFINED));
        entries
    }
}

/// A picture that is being drawn; y upwards.
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

    fn set(&mut self, x: u32, y: u32, colour: [u8; 3]) {
        if x < self.width && y < self.height {
            self.pixels[y as usize * self.width as usize + x as usize] = colour;
        }
    }

    /// A square with its lower left corner at (x, y).
    fn fill(&mut self, x: u32, y: u32, side: u32, colour: [u8; 3]) {
        for dy in 0..side {
            for dx in 0..side {
                self.set(x + dx, y + dy, colour);
            }
        }
    }

    /// Words with their upper edge at `top`.
    fn write(&mut self, x: u32, top: u32, words: &str) {
        for (column, character) in words.chars().enumerate() {
            let rows = BASIC_FONTS.get(character).unwrap_or_default();
            for (row, bits) in rows.iter().enumerate() {
                for bit in (0..GLYPH).filter(|bit| bits & (1 << bit) != 0) {
                    self.set(
                        x + column as u32 * GLYPH + bit,
                        top - 1 - row as u32,
                        INK.map(quantise),
                    );
                }
            }
        }
    }

    fn finish(self) -> Shown {
        Shown::new(self.width, self.height, self.pixels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEGEND: Legend = Legend { tolerance: 1e-3 };

    #[test]
    fn each_decade_has_its_colour_and_equal_pixels_are_black() {
        let colour = |difference| LEGEND.colour(Mark::by(difference));
        assert_eq!(colour(0.0), [0.0; 3]);
        assert_eq!(colour(1e-7), [0.0; 3]);
        assert_eq!(colour(1.1e-7), COOL[0]);
        assert_eq!(colour(1e-3), COOL[3], "what is the tolerance agrees");
        assert_eq!(colour(1.1e-3), WARM[0]);
        assert_eq!(colour(0.5), WARM[2]);
        assert_eq!(colour(7.0), WARM[2]);
        assert_eq!(colour(f32::NAN), WARM[2]);
        assert_eq!(LEGEND.colour(Mark::UNDECIDED), UNDECIDED);
        let in_bits = Legend { tolerance: 1e-6 };
        assert_eq!(in_bits.colour(Mark::by(1.1e-10)), COOL[0]);
        assert_eq!(in_bits.colour(Mark::by(1.0)), WARM[2]);
    }

    #[test]
    fn the_picture_stands_above_a_legend_that_names_the_scale() {
        let marks = vec![Mark::by(1.0); 4];
        let picture = difference([2, 2], &marks, LEGEND);
        let [width, height] = picture.size();
        assert!(width >= 64 && height > 2 + GLYPH);
        assert_eq!(
            picture.get(0, height - 1),
            WARM[2].map(quantise),
            "the upper left pixel"
        );
        assert!(picture.pixels().contains(&INK.map(quantise)), "words are written");
        let names: Vec<_> = LEGEND.entries().into_iter().map(|(name, _)| name).collect();
        assert!(names.contains(&"> 1e-3".to_owned()), "{names:?}");
    }
}
