//! Charts drawn by plotters, as SVG and as images.

mod heat;
mod scatter;

use std::convert::Infallible;

use font8x8::{BASIC_FONTS, UnicodeFonts};
pub use heat::{Band, HeatMap, Panel};
use plotters::style::RGBColor;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, DrawingBackend, DrawingErrorKind};
pub use scatter::{Point, Scatter};
use toyproof_image::Image;

const INK: RGBColor = RGBColor(30, 30, 30);
const FAINT: RGBColor = RGBColor(215, 215, 215);
const PAPER: RGBColor = RGBColor(255, 255, 255);
/// The family of SVG text; images use the built-in 8-pixel font.
const FONT: &str = "monospace";

// A plotters backend for images with a built-in font, so that no fonts need to be installed.

const GLYPH: i32 = 8;

/// An image being drawn; y points down, as in plotters.
struct Raster<'a> {
    size: (u32, u32),
    pixels: &'a mut [[f32; 3]],
}

/// Draws an image of the given size.
fn rasterize(size: (u32, u32), draw: impl FnOnce(Raster)) -> Image {
    let mut pixels = vec![[1.0; 3]; size.0 as usize * size.1 as usize];
    draw(Raster {
        size,
        pixels: &mut pixels,
    });
    let rows = pixels.chunks(size.0 as usize).rev();
    let pixels = rows.flat_map(|row| row.iter().map(|&[r, g, b]| [r, g, b, 1.0]));
    Image::new(size.0, size.1, pixels.collect())
}

impl Raster<'_> {
    fn blend(&mut self, (x, y): BackendCoord, color: BackendColor) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
            return;
        };
        if x >= self.size.0 || y >= self.size.1 {
            return;
        }
        let pixel = &mut self.pixels[y as usize * self.size.0 as usize + x as usize];
        let alpha = color.alpha as f32;
        let (r, g, b) = color.rgb;
        for (old, new) in pixel.iter_mut().zip([r, g, b]) {
            // Exactly the new color if alpha is 1.
            *old = alpha * (f32::from(new) / 255.0) + (1.0 - alpha) * *old;
        }
    }
}

/// The width of a font dot in pixels, for letters `size` pixels high.
fn dot(size: f64) -> i32 {
    (size / f64::from(GLYPH)).round().max(1.0) as i32
}

impl DrawingBackend for Raster<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn present(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn draw_pixel(
        &mut self,
        point: BackendCoord,
        color: BackendColor,
    ) -> Result<(), DrawingErrorKind<Infallible>> {
        self.blend(point, color);
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        at: BackendCoord,
    ) -> Result<(), DrawingErrorKind<Infallible>> {
        let dot = dot(style.size());
        let (width, height) = (text.chars().count() as i32 * GLYPH * dot, GLYPH * dot);
        let left = match style.anchor().h_pos {
            HPos::Left => 0,
            HPos::Center => -width / 2,
            HPos::Right => -width,
        };
        let top = match style.anchor().v_pos {
            VPos::Top => 0,
            VPos::Center => -height / 2,
            VPos::Bottom => -height,
        };
        for (column, character) in (0..).zip(text.chars()) {
            let rows = BASIC_FONTS.get(character).unwrap_or_default();
            for (row, bits) in (0..).zip(rows) {
                for bit in (0..GLYPH).filter(|bit| bits & (1 << bit) != 0) {
                    let (x, y) = (left + (column * GLYPH + bit) * dot, top + row * dot);
                    for (dx, dy) in (0..dot).flat_map(|dx| (0..dot).map(move |dy| (dx, dy))) {
                        let (x, y) = style.transform().transform(x + dx, y + dy);
                        self.blend((at.0 + x, at.1 + y), style.color());
                    }
                }
            }
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let side = GLYPH * dot(style.size());
        Ok(((text.chars().count() as i32 * side) as u32, side as u32))
    }
}
