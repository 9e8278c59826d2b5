//! Charts drawn by plotters, as SVG and as images.

mod heat;
mod scatter;

use std::sync::Once;

pub use heat::{Band, HeatMap, Panel};
use plotters::prelude::*;
use plotters::style::register_font;
pub use scatter::{Point, Scatter};
use toyproof_image::Image;

const INK: RGBColor = RGBColor(30, 30, 30);
const GRAY: RGBColor = RGBColor(110, 110, 110);
const FAINT: RGBColor = RGBColor(215, 215, 215);
const PAPER: RGBColor = RGBColor(255, 255, 255);
/// The font family: in SVG the viewer's own, in images the embedded font.
const FONT: &str = "sans-serif";
/// Roboto 2.138 by Google, under the Apache License 2.0; a subset (Latin, Greek, Cyrillic and symbols)
/// without hinting: `pyftsubset Roboto-Regular.ttf --unicodes=U+0020-024F,U+0370-052F,U+2000-22FF --no-hinting
/// --drop-tables+=GSUB,GPOS,GDEF --notdef-outline`.
static ROBOTO: &[u8] = include_bytes!("Roboto-Regular.ttf");

/// A style for text of the given size in pixels. All text must use it: it registers the font.
fn text_style(size: i32, color: RGBColor) -> TextStyle<'static> {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(|| {
        let registered = register_font(FONT, FontStyle::Normal, ROBOTO);
        debug_assert!(registered.is_ok(), "the embedded font is valid");
    });
    (FONT, size).into_font().color(&color)
}

/// The width of the widest text, in pixels.
fn text_width<'a>(texts: impl IntoIterator<Item = &'a str>, size: i32) -> i32 {
    let font = text_style(size, INK).font;
    let width = |text: &str| font.box_size(text).map_or(0, |(width, _)| width as i32);
    texts.into_iter().map(width).max().unwrap_or(0)
}

/// Formats a tick label: `0.01`, `100`, `10⁻⁵`, `2·10⁻⁵`.
pub(crate) fn tick(value: f64) -> String {
    // Powers of ten have rounded logarithms, which may be just below an integer.
    let exponent = libm::log10(value * (1.0 + 1e-9)).floor() as i32;
    let mantissa = value / libm::exp10(f64::from(exponent));
    if (-3..=3).contains(&exponent) {
        return format!("{}", (value * 1e6).round() / 1e6);
    }
    let superscript = |digit: char| match digit {
        '-' => '⁻',
        digit => "⁰¹²³⁴⁵⁶⁷⁸⁹"
            .chars()
            .nth(digit as usize - '0' as usize)
            .unwrap_or(digit),
    };
    let power: String = exponent.to_string().chars().map(superscript).collect();
    if (mantissa - 1.0).abs() < 1e-6 {
        format!("10{power}")
    } else {
        format!("{}·10{power}", (mantissa * 1e3).round() / 1e3)
    }
}

/// The text with its first letter in uppercase.
pub(crate) fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Draws an image of the given size.
fn rasterize(size: (u32, u32), draw: impl FnOnce(BitMapBackend)) -> Image {
    let (width, height) = (size.0 as usize, size.1 as usize);
    let mut bytes = vec![255; 3 * width * height];
    draw(BitMapBackend::with_buffer(&mut bytes, size));
    // Plotters' rows run downwards, an image's upwards.
    let rows = bytes.chunks(3 * width).rev();
    let pixels = rows.flat_map(|row| row.chunks(3));
    let pixels = pixels.map(|rgb| [rgb[0], rgb[1], rgb[2], 255].map(|byte| f32::from(byte) / 255.0));
    Image::new(size.0, size.1, pixels.collect())
}
