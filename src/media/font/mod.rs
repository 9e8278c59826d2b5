//! The texture of a font: 16×16 cells of 64 texels, one for each code, with real glyphs.
//!
//! What the components hold, and the codes, were measured on the site's texture:
//!
//! - red: coverage of the texel, 0 to 1
//! - green, blue: the direction of the gradient of the distance, 0.5 + 0.5·g, to the right and downwards
//! - alpha: the distance to the outline, (127 + 4·d)/255, d in texels, negative inside; 1 in empty cells
//!
//! So `alpha − 127/255`, as shaders write it, is nearly the distance in cells. Rows of codes run downwards.
//! Capital letters stand on a line 50 texels below the top of their cell, are 37 texels high, and are
//! centered.

mod outline;
mod symbol;

use rayon::prelude::*;
use toyproof_image::Image;
use ttf_parser::Face;

use self::outline::{Outline, glyph};
use crate::color::in_levels;

/// The side of a cell in texels.
const CELL: usize = 64;
/// The number of cells in a row and in a column.
const CELLS: usize = 16;

/// `DejaVu` Sans 2.37, under the license beside it; a subset of the characters of the texture, by:
/// `pyftsubset DejaVuSans.ttf --unicodes=… --no-hinting --layout-features=''
/// --drop-tables+=GPOS,GSUB,GDEF,kern,name,post`.
static DEJAVU: &[u8] = include_bytes!("DejaVuSans-subset.ttf");

/// The characters of the codes 0 to 31. A space stands for a symbol of a player, which `symbol` draws.
const SYMBOLS: &str = "  \u{25c0}\u{25cf}\u{25a0}\u{25b6}   \
    \u{2669}\u{266a}\u{266b}\u{266c}\u{266d}\u{266e}\u{266f}\
    ←↑→↓\u{2194}\u{2195}\u{2196}\u{2197}\u{2198}\u{2199}\u{21ba}\u{21bb}\u{2605}\u{263b}  ";

/// The characters of the codes 128 to 159.
const GREEK: &str = "αβγδεθλμξπρστφψωΓΔΘΛΠΣΦΨΩ∞ƒ∘∫∂∇√";

/// The character of a code. Those from 160 on are Latin-1's; the soft hyphen is empty.
fn character(code: u8) -> char {
    match code {
        0..32 => SYMBOLS.chars().nth(code.into()).unwrap_or(' '),
        128..160 => GREEK.chars().nth((code - 128).into()).unwrap_or(' '),
        173 => ' ',
        _ => code.into(),
    }
}

/// The outline of a code in its cell.
fn outline(face: &Face<'_>, code: u8) -> Outline {
    symbol::outline(code).unwrap_or_else(|| glyph(face, character(code), code < 32))
}

/// The texture.
pub(crate) fn font() -> Image {
    let face = Face::parse(DEJAVU, 0).expect("the embedded font is valid");
    let cells: Vec<Vec<[f32; 4]>> = (0..=u8::MAX)
        .into_par_iter()
        .map(|code| cell(&outline(&face, code)))
        .collect();
    let side = CELL * CELLS;
    let pixels = (0..side).rev().flat_map(|from_top| {
        let cells = &cells;
        (0..side).map(move |x| {
            let code = from_top / CELL * CELLS + x / CELL;
            cells[code][from_top % CELL * CELL + x % CELL]
        })
    });
    Image::new(side as u32, side as u32, pixels.collect())
}

/// The texels of a cell, from the top down.
fn cell(outline: &Outline) -> Vec<[f32; 4]> {
    let texel = |(distance, [x, y]): (f32, [f32; 2])| {
        in_levels([
            (0.5 - distance).clamp(0.0, 1.0),
            0.5 + 0.5 * x,
            0.5 + 0.5 * y,
            ((127.0 + 4.0 * distance) / 255.0).clamp(0.0, 1.0),
        ])
    };
    outline.distances(CELL).into_iter().map(texel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texel of a code, from the top left of its cell.
    fn texel(font: &Image, code: u8, x: u32, y: u32) -> [f32; 4] {
        let (column, row) = (u32::from(code) % 16, u32::from(code) / 16);
        font.get(64 * column + x, 1023 - (64 * row + y))
    }

    #[test]
    fn letters_stand_where_shaders_expect_them() {
        let font = font();
        let rows = |code| {
            let is_ink = |&y: &u32| (0..64).any(|x| texel(&font, code, x, y)[0] > 0.5);
            let rows: Vec<_> = (0..64).filter(is_ink).collect();
            (rows[0], rows[rows.len() - 1])
        };
        assert_eq!(rows(b'H'), (13, 49));
        assert_eq!(rows(b'x').1, 49);
        assert!(rows(b'g').1 > 55, "a descender");
        let is_empty = |code| (0..64).all(|x| (0..64).all(|y| texel(&font, code, x, y)[0] == 0.0));
        assert_eq!(
            (0..=255).filter(|&code| is_empty(code)).collect::<Vec<u8>>(),
            [32, 127, 160, 173]
        );
    }

    #[test]
    fn the_distance_is_that_of_the_stem_of_a_letter() {
        let font = font();
        let row: Vec<_> = (0..64).map(|x| texel(&font, b'I', x, 32)).collect();
        let ink: f32 = row.iter().map(|texel| texel[0]).sum();
        let center = 32.0;
        for (x, [coverage, gradient, _, alpha]) in row.into_iter().enumerate() {
            let from_center = x as f32 + 0.5 - center;
            let expected = from_center.abs() - ink / 2.0;
            let distance = (255.0 * alpha - 127.0) / 4.0;
            // Near the ends of the stem, the ends are not nearer in this row; a level is a quarter of a
            // texel.
            assert!(
                (distance - expected).abs() < 0.3,
                "{x}: {distance}, not {expected}"
            );
            assert_eq!(coverage > 0.5, expected < 0.0);
            if from_center.abs() > 1.0 {
                assert!(
                    (gradient - if from_center > 0.0 { 1.0 } else { 0.0 }).abs() < 0.01,
                    "{x}"
                );
            }
        }
    }

    #[test]
    fn every_symbol_has_a_character() {
        assert_eq!((SYMBOLS.chars().count(), GREEK.chars().count()), (32, 32));
        let face = Face::parse(DEJAVU, 0).unwrap();
        let missing = (0..=u8::MAX).filter(|&code| face.glyph_index(character(code)).is_none());
        assert_eq!(missing.collect::<Vec<_>>(), [127]);
    }
}
