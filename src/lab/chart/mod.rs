//! Charts: drawn once, by plotters, as SVG and as a picture.

mod heat;
mod raster;
mod scatter;

pub use heat::{Band, HeatMap, Panel};
use plotters::style::RGBColor;
pub use scatter::{Point, Scatter};

const INK: RGBColor = RGBColor(30, 30, 30);
const FAINT: RGBColor = RGBColor(215, 215, 215);
const PAPER: RGBColor = RGBColor(255, 255, 255);
/// The only fonts that are there for sure are those of a reader of SVG, and our own letters of 8 pixels.
const FONT: &str = "monospace";
