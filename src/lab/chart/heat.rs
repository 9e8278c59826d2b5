//! Heat maps.

use plotters::prelude::*;
use plotters_backend::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::{FONT, INK, PAPER, Raster};

/// Tables with a color for each cell.
#[derive(Debug, Clone)]
pub struct HeatMap {
    /// The title.
    pub title: String,
    /// The colors of ranges of values, in ascending order.
    pub bands: Vec<Band>,
    /// The tables, in reading order.
    pub panels: Vec<Panel>,
}

/// A color for values at or above a bound.
#[derive(Debug, Clone)]
pub struct Band {
    /// The lower bound.
    pub above: f64,
    /// The text in the legend.
    pub label: String,
    /// Red, green and blue.
    pub color: [u8; 3],
}

/// A table.
#[derive(Debug, Clone)]
pub struct Panel {
    /// The quantity that the columns vary.
    pub title: String,
    /// The column labels.
    pub columns: Vec<String>,
    /// Row labels with values; `None` is left blank.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
}

const CELL_SIZE: i32 = 24;
const CHAR_WIDTH: i32 = 8;
const GAP: i32 = 16;
/// The height of a line of text, in pixels.
const LINE_HEIGHT: i32 = 20;

impl HeatMap {
    /// Draws the map at the size that it needs. Panels are placed side by side as far as the width of the
    /// widest element allows.
    #[must_use]
    pub fn image(&self) -> Image {
        let legend: i32 = self
            .bands
            .iter()
            .map(|band| CELL_SIZE + CHAR_WIDTH * (char_count(&band.label) + 3))
            .sum();
        let widest = self.panels.iter().map(Panel::width);
        let wide = widest
            .chain([legend, 2 * CHAR_WIDTH * char_count(&self.title)])
            .max()
            .unwrap_or(0)
            + GAP;
        let (mut x, mut y, mut row) = (0, 4 * LINE_HEIGHT, 0);
        let mut corners = Vec::new();
        for panel in &self.panels {
            if x > 0 && x + panel.width() > wide {
                (x, y, row) = (0, y + row, 0);
            }
            corners.push((x, y));
            x += panel.width();
            row = row.max(panel.height());
        }
        super::rasterize(((wide + GAP) as u32, (y + row + GAP) as u32), |raster| {
            // Drawing into memory cannot fail.
            let _ = self.draw(raster, &corners);
        })
    }

    fn draw<'a>(&self, raster: Raster<'a>, corners: &[(i32, i32)]) -> DrawResult<(), Raster<'a>> {
        let area = raster.into_drawing_area();
        area.fill(&PAPER)?;
        area.draw(&Text::new(self.title.as_str(), (GAP, GAP), text_style(16)))?;
        let mut x = GAP;
        for band in &self.bands {
            let corners = [
                (x, GAP + LINE_HEIGHT),
                (x + CELL_SIZE - 4, GAP + LINE_HEIGHT + CELL_SIZE - 8),
            ];
            area.draw(&Rectangle::new(corners, color(band).filled()))?;
            area.draw(&Text::new(
                band.label.as_str(),
                (x + CELL_SIZE + 2, GAP + LINE_HEIGHT + 4),
                text_style(8),
            ))?;
            x += CELL_SIZE + CHAR_WIDTH * (char_count(&band.label) + 3);
        }
        for (panel, &(x, top)) in self.panels.iter().zip(corners) {
            let left = x + panel.left();
            area.draw(&Text::new(panel.title.as_str(), (left, top), text_style(8)))?;
            let upper = top + LINE_HEIGHT;
            for ((name, cells), y) in panel.rows.iter().zip((upper..).step_by(CELL_SIZE as usize)) {
                let style = text_style(8).pos(Pos::new(HPos::Right, VPos::Center));
                area.draw(&Text::new(
                    name.as_str(),
                    (left - GAP / 2, y + CELL_SIZE / 2),
                    style,
                ))?;
                for (value, x) in cells.iter().zip((left..).step_by(CELL_SIZE as usize)) {
                    let band =
                        value.and_then(|value| self.bands.iter().rev().find(|band| value >= band.above));
                    let Some(band) = band else { continue };
                    let corners = [(x, y), (x + CELL_SIZE - 2, y + CELL_SIZE - 2)];
                    area.draw(&Rectangle::new(corners, color(band).filled()))?;
                }
            }
            let below = upper + panel.rows.len() as i32 * CELL_SIZE + 4;
            for (name, x) in panel.columns.iter().zip((left..).step_by(CELL_SIZE as usize)) {
                let style = text_style(8)
                    .transform(FontTransform::Rotate90)
                    .pos(Pos::new(HPos::Left, VPos::Center));
                area.draw(&Text::new(name.as_str(), (x + CELL_SIZE / 2 - 1, below), style))?;
            }
        }
        area.present()
    }
}

impl Panel {
    /// The width of the row labels, in pixels.
    fn left(&self) -> i32 {
        2 * GAP + CHAR_WIDTH * self.rows.iter().map(|row| char_count(&row.0)).max().unwrap_or(0)
    }

    fn width(&self) -> i32 {
        self.left() + (CELL_SIZE * self.columns.len() as i32).max(CHAR_WIDTH * char_count(&self.title))
    }

    fn height(&self) -> i32 {
        let names = self
            .columns
            .iter()
            .map(|name| char_count(name))
            .max()
            .unwrap_or(0);
        LINE_HEIGHT + self.rows.len() as i32 * CELL_SIZE + CHAR_WIDTH * names + 2 * GAP
    }
}

fn char_count(text: &str) -> i32 {
    text.chars().count() as i32
}

fn color(band: &Band) -> RGBColor {
    let [r, g, b] = band.color;
    RGBColor(r, g, b)
}

fn text_style(size: i32) -> TextStyle<'static> {
    (FONT, size).into_font().color(&INK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_band_colors_and_labels() {
        let band = |above, color| Band {
            above,
            label: "x".to_owned(),
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
        let legend = (CELL_SIZE - 3) * (CELL_SIZE - 7);
        let cell = (CELL_SIZE - 1) * (CELL_SIZE - 1);
        assert_eq!(count([0.0, 0.0, 1.0, 1.0]), (cell + legend) as usize);
        assert_eq!(count([1.0, 0.0, 0.0, 1.0]), (cell + legend) as usize);
        let ink = f32::from(INK.0) / 255.0;
        assert!(count([ink, ink, ink, 1.0]) > 100);
    }
}
