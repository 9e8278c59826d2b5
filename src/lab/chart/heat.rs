//! Tables as colours.

use plotters::prelude::*;
use plotters_backend::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::raster::{self, Raster};
use super::{FONT, INK, PAPER};

/// Tables with a colour for each cell.
#[derive(Debug, Clone)]
pub struct HeatMap {
    /// What it shows.
    pub title: String,
    /// What colours mean: values upwards.
    pub bands: Vec<Band>,
    /// One below the other.
    pub panels: Vec<Panel>,
}

/// A colour, for values above a bound.
#[derive(Debug, Clone)]
pub struct Band {
    /// The bound.
    pub above: f64,
    /// What the legend says.
    pub says: String,
    /// Red, green, blue.
    pub color: [u8; 3],
}

/// One table.
#[derive(Debug, Clone)]
pub struct Panel {
    /// What its columns are of.
    pub title: String,
    /// What each column is.
    pub columns: Vec<String>,
    /// What each row is, and its values; none is left blank.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
}

const CELL: i32 = 24;
const LETTER: i32 = 8;
const GAP: i32 = 16;
/// Room for words, in pixels.
const LINE: i32 = 20;

impl HeatMap {
    /// The picture; as large as it needs to be. Panels stand side by side as far as the widest of them lets them.
    #[must_use]
    pub fn image(&self) -> Image {
        let legend: i32 = self
            .bands
            .iter()
            .map(|band| CELL + LETTER * (letters(&band.says) + 3))
            .sum();
        let widest = self.panels.iter().map(Panel::width);
        let wide = widest
            .chain([legend, 2 * LETTER * letters(&self.title)])
            .max()
            .unwrap_or(0)
            + GAP;
        let (mut x, mut y, mut row) = (0, 4 * LINE, 0);
        let mut corners = Vec::new();
        for panel in &self.panels {
            if x > 0 && x + panel.width() > wide {
                (x, y, row) = (0, y + row, 0);
            }
            corners.push((x, y));
            x += panel.width();
            row = row.max(panel.height());
        }
        raster::drawn(((wide + GAP) as u32, (y + row + GAP) as u32), |raster| {
            // Nothing can fail on pixels of our own.
            let _ = self.draw(raster, &corners);
        })
    }

    fn draw<'a>(&self, raster: Raster<'a>, corners: &[(i32, i32)]) -> DrawResult<(), Raster<'a>> {
        let area = raster.into_drawing_area();
        area.fill(&PAPER)?;
        area.draw(&Text::new(self.title.as_str(), (GAP, GAP), words(16)))?;
        let mut x = GAP;
        for band in &self.bands {
            let corners = [(x, GAP + LINE), (x + CELL - 4, GAP + LINE + CELL - 8)];
            area.draw(&Rectangle::new(corners, color(band).filled()))?;
            area.draw(&Text::new(
                band.says.as_str(),
                (x + CELL + 2, GAP + LINE + 4),
                words(8),
            ))?;
            x += CELL + LETTER * (letters(&band.says) + 3);
        }
        for (panel, &(x, top)) in self.panels.iter().zip(corners) {
            let left = x + panel.left();
            area.draw(&Text::new(panel.title.as_str(), (left, top), words(8)))?;
            let upper = top + LINE;
            for ((name, cells), y) in panel.rows.iter().zip((upper..).step_by(CELL as usize)) {
                let style = words(8).pos(Pos::new(HPos::Right, VPos::Center));
                area.draw(&Text::new(name.as_str(), (left - GAP / 2, y + CELL / 2), style))?;
                for (value, x) in cells.iter().zip((left..).step_by(CELL as usize)) {
                    let band =
                        value.and_then(|value| self.bands.iter().rev().find(|band| value >= band.above));
                    let Some(band) = band else { continue };
                    let corners = [(x, y), (x + CELL - 2, y + CELL - 2)];
                    area.draw(&Rectangle::new(corners, color(band).filled()))?;
                }
            }
            let below = upper + panel.rows.len() as i32 * CELL + 4;
            for (name, x) in panel.columns.iter().zip((left..).step_by(CELL as usize)) {
                let style = words(8)
                    .transform(FontTransform::Rotate90)
                    .pos(Pos::new(HPos::Left, VPos::Center));
                area.draw(&Text::new(name.as_str(), (x + CELL / 2 - 1, below), style))?;
            }
        }
        area.present()
    }
}

impl Panel {
    /// Room for the names of rows.
    fn left(&self) -> i32 {
        2 * GAP + LETTER * self.rows.iter().map(|row| letters(&row.0)).max().unwrap_or(0)
    }

    fn width(&self) -> i32 {
        self.left() + (CELL * self.columns.len() as i32).max(LETTER * letters(&self.title))
    }

    fn height(&self) -> i32 {
        let names = self.columns.iter().map(|name| letters(name)).max().unwrap_or(0);
        LINE + self.rows.len() as i32 * CELL + LETTER * names + 2 * GAP
    }
}

fn letters(text: &str) -> i32 {
    text.chars().count() as i32
}

fn color(band: &Band) -> RGBColor {
    let [r, g, b] = band.color;
    RGBColor(r, g, b)
}

fn words(size: i32) -> TextStyle<'static> {
    (FONT, size).into_font().color(&INK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_has_the_colour_of_its_band_and_names_are_written() {
        let band = |above, color| Band {
            above,
            says: "x".to_owned(),
            color,
        };
        let map = HeatMap {
            title: "t".to_owned(),
            bands: vec![band(0.0, [0, 0, 255]), band(0.5, [255, 0, 0])],
            panels: vec![Panel {
                title: "p".to_owned(),
                columns: vec!["1e-30".to_owned(), "2".to_owned(), "3".to_owned()],
                rows: vec![("row".to_owned(), vec![Some(0.2), Some(0.5), None])],
            }],
        };
        let image = map.image();
        let count = |color: [f32; 4]| image.pixels().iter().filter(|&&pixel| pixel == color).count();
        let legend = (CELL - 3) * (CELL - 7);
        let cell = (CELL - 1) * (CELL - 1);
        assert_eq!(count([0.0, 0.0, 1.0, 1.0]), (cell + legend) as usize);
        assert_eq!(count([1.0, 0.0, 0.0, 1.0]), (cell + legend) as usize);
        let ink = f32::from(INK.0) / 255.0;
        assert!(count([ink, ink, ink, 1.0]) > 100);
    }
}
