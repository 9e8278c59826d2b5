//! Heat maps.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::{INK, PAPER, text_style, text_width};

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

/// A color for values at or above a lower bound.
#[derive(Debug, Clone)]
pub struct Band {
    /// The lower bound.
    pub min: f64,
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

const CELL_SIZE: i32 = 26;
const GAP: i32 = 16;
const FONT_SIZE: i32 = 16;
const TITLE_SIZE: i32 = 22;
/// The height of a line of text, in pixels.
const LINE_HEIGHT: i32 = 24;

impl HeatMap {
    /// Draws the map at the size that it needs. Panels are placed side by side as far as the width of the
    /// widest element allows.
    #[must_use]
    pub fn image(&self) -> Image {
        let legend: i32 = self.bands.iter().map(Band::width).sum();
        let title = text_width([&*self.title], TITLE_SIZE) + GAP;
        let widest = self.panels.iter().map(Panel::width);
        let wide = widest.chain([legend, title]).max().unwrap_or(0) + GAP;
        let (mut x, mut y, mut row) = (GAP, 5 * LINE_HEIGHT, 0);
        let mut corners = Vec::new();
        for panel in &self.panels {
            if x > GAP && x + panel.width() > wide {
                (x, y, row) = (GAP, y + row, 0);
            }
            corners.push((x, y));
            x += panel.width();
            row = row.max(panel.height());
        }
        super::rasterize(((wide + GAP) as u32, (y + row) as u32), |backend| {
            // Drawing into memory cannot fail.
            let _ = self.draw(backend, &corners);
        })
    }

    fn draw<'a>(
        &self,
        backend: BitMapBackend<'a>,
        corners: &[(i32, i32)],
    ) -> DrawResult<(), BitMapBackend<'a>> {
        let area = backend.into_drawing_area();
        area.fill(&PAPER)?;
        let title = text_style(TITLE_SIZE, INK);
        area.draw(&Text::new(self.title.as_str(), (GAP, GAP), title))?;
        let style = text_style(FONT_SIZE, INK);
        let middle = style.pos(Pos::new(HPos::Left, VPos::Center));
        let (mut x, y) = (GAP, GAP + 2 * LINE_HEIGHT);
        for band in &self.bands {
            let corners = [(x, y - 10), (x + 20, y + 6)];
            area.draw(&Rectangle::new(corners, band.color().filled()))?;
            area.draw(&Text::new(band.label.as_str(), (x + 28, y), middle.clone()))?;
            x += band.width();
        }
        for (panel, &(x, top)) in self.panels.iter().zip(corners) {
            let left = x + panel.left();
            area.draw(&Text::new(panel.title.as_str(), (left, top), style.clone()))?;
            let upper = top + LINE_HEIGHT;
            for ((name, cells), y) in panel.rows.iter().zip((upper..).step_by(CELL_SIZE as usize)) {
                let right = style.pos(Pos::new(HPos::Right, VPos::Center));
                area.draw(&Text::new(
                    name.as_str(),
                    (left - GAP / 2, y + CELL_SIZE / 2),
                    right,
                ))?;
                for (value, x) in cells.iter().zip((left..).step_by(CELL_SIZE as usize)) {
                    let band = value.and_then(|value| self.bands.iter().rev().find(|band| value >= band.min));
                    let Some(band) = band else { continue };
                    let corners = [(x, y), (x + CELL_SIZE - 2, y + CELL_SIZE - 2)];
                    area.draw(&Rectangle::new(corners, band.color().filled()))?;
                }
            }
            let below = upper + panel.rows.len() as i32 * CELL_SIZE + 6;
            let upwards = style
                .transform(FontTransform::Rotate270)
                .pos(Pos::new(HPos::Right, VPos::Center));
            for (name, x) in panel.columns.iter().zip((left..).step_by(CELL_SIZE as usize)) {
                let at = (x + CELL_SIZE / 2 - 1, below);
                area.draw(&Text::new(name.as_str(), at, upwards.clone()))?;
            }
        }
        area.present()
    }
}

impl Band {
    /// The width in the legend, in pixels.
    fn width(&self) -> i32 {
        28 + text_width([&*self.label], FONT_SIZE) + 2 * GAP
    }

    fn color(&self) -> RGBColor {
        let [r, g, b] = self.color;
        RGBColor(r, g, b)
    }
}

impl Panel {
    /// The width of the row labels, in pixels.
    fn left(&self) -> i32 {
        GAP / 2 + text_width(self.rows.iter().map(|row| &*row.0), FONT_SIZE)
    }

    fn width(&self) -> i32 {
        let cells = CELL_SIZE * self.columns.len() as i32;
        self.left() + cells.max(text_width([&*self.title], FONT_SIZE)) + 2 * GAP
    }

    fn height(&self) -> i32 {
        let columns = text_width(self.columns.iter().map(|name| &**name), FONT_SIZE);
        LINE_HEIGHT + self.rows.len() as i32 * CELL_SIZE + columns + 2 * GAP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_band_colors_and_labels() {
        let band = |min, color| Band {
            min,
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
        let legend = 20 * 16;
        let cell = (CELL_SIZE - 2) * (CELL_SIZE - 2);
        assert_eq!(count([0.0, 0.0, 1.0, 1.0]), (cell + legend) as usize);
        assert_eq!(count([1.0, 0.0, 0.0, 1.0]), (cell + legend) as usize);
        let is_ink = |[r, g, b, _]: &&[f32; 4]| r == g && g == b && *r < 0.5;
        assert!(image.pixels().iter().filter(is_ink).count() > 50);
    }
}
