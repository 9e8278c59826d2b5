//! Heat maps.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::{GRAY, INK, PAPER, text_style, text_width};

/// Tables with a color for each cell.
#[derive(Debug, Clone)]
pub struct HeatMap {
    /// The title.
    pub title: String,
    /// The quantity that the colors show, with its unit.
    pub legend: String,
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
    /// The title.
    pub title: String,
    /// The quantity that the columns vary, with its unit.
    pub x_title: String,
    /// The column labels.
    pub columns: Vec<String>,
    /// Row labels with values; `None` is left blank.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
}

const CELL_SIZE: i32 = 26;
const GAP: i32 = 16;
const FONT_SIZE: i32 = 17;
const PANEL_TITLE_SIZE: i32 = 19;
const TITLE_SIZE: i32 = 25;
/// The height of a line of text, in pixels.
const LINE_HEIGHT: i32 = 24;

/// The top of the panels: below the title, the legend's title and the legend.
const PANELS_TOP: i32 = 5 * LINE_HEIGHT + GAP;
/// The gap between column labels and the title below them: measured widths of rotated text are too small.
const X_TITLE_GAP: i32 = 14;
/// All panels are placed in one row up to this width.
const MAX_SINGLE_ROW_WIDTH: i32 = 1320;

impl HeatMap {
    /// Draws the map as SVG, at the size that it needs.
    #[must_use]
    pub fn svg(&self) -> String {
        let (size, corners) = self.layout();
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.draw(SVGBackend::with_string(&mut text, size), &corners);
        text
    }

    /// Draws the map as an image, at the size that it needs.
    #[must_use]
    pub fn image(&self) -> Image {
        let (size, corners) = self.layout();
        super::rasterize(size, |backend| {
            // Drawing into memory cannot fail.
            let _ = self.draw(backend, &corners);
        })
    }

    /// The size, and the upper left corners of the panels: each is in the first row that has room for it.
    /// The widest element determines the width, unless all panels fit in one row.
    fn layout(&self) -> ((u32, u32), Vec<(i32, i32)>) {
        let legend: i32 = self.bands.iter().map(Band::width).sum();
        let titles = [(&self.title, TITLE_SIZE), (&self.legend, FONT_SIZE)];
        let titles = titles.map(|(title, size)| text_width([title.as_str()], size) + GAP);
        let widths = self.panels.iter().map(Panel::width);
        let single_row = Some(widths.clone().sum()).filter(|width| *width <= MAX_SINGLE_ROW_WIDTH);
        let width = widths
            .chain([legend])
            .chain(single_row)
            .chain(titles)
            .max()
            .unwrap_or(0)
            + GAP;
        // The width and height of each row.
        let mut rows: Vec<(i32, i32)> = Vec::new();
        let mut places = Vec::new();
        for panel in &self.panels {
            let free = rows.iter().position(|row| row.0 + panel.width() <= width);
            let row = free.unwrap_or_else(|| {
                rows.push((GAP, 0));
                rows.len() - 1
            });
            places.push((row, rows[row].0));
            rows[row] = (rows[row].0 + panel.width(), rows[row].1.max(panel.height()));
        }
        let top = |row: usize| PANELS_TOP + rows[..row].iter().map(|row| row.1).sum::<i32>();
        let corners = places.into_iter().map(|(row, x)| (x, top(row))).collect();
        (((width + GAP) as u32, top(rows.len()) as u32), corners)
    }

    fn draw<B: DrawingBackend>(&self, backend: B, corners: &[(i32, i32)]) -> DrawResult<(), B> {
        let area = backend.into_drawing_area();
        area.fill(&PAPER)?;
        let title = text_style(TITLE_SIZE, INK);
        area.draw(&Text::new(self.title.as_str(), (GAP, GAP), title))?;
        let style = text_style(FONT_SIZE, INK);
        let middle = style.pos(Pos::new(HPos::Left, VPos::Center));
        let (mut x, y) = (GAP, GAP + 2 * LINE_HEIGHT);
        area.draw(&Text::new(self.legend.as_str(), (x, y), middle.clone()))?;
        let y = y + LINE_HEIGHT;
        for band in &self.bands {
            let corners = [(x, y - 8), (x + 20, y + 8)];
            area.draw(&Rectangle::new(corners, band.color().filled()))?;
            area.draw(&Text::new(band.label.as_str(), (x + 28, y), middle.clone()))?;
            x += band.width();
        }
        for (panel, &corner) in self.panels.iter().zip(corners) {
            self.draw_panel(&area, panel, corner)?;
        }
        area.present()
    }

    fn draw_panel<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        panel: &Panel,
        (x, top): (i32, i32),
    ) -> DrawResult<(), B> {
        let style = text_style(FONT_SIZE, INK);
        let left = x + panel.left();
        let title = text_style(PANEL_TITLE_SIZE, INK);
        area.draw(&Text::new(panel.title.as_str(), (left, top), title))?;
        let upper = top + LINE_HEIGHT + 4;
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
        let x_title = text_style(FONT_SIZE, GRAY);
        let at = (left, below + panel.column_label_height() + X_TITLE_GAP);
        area.draw(&Text::new(panel.x_title.as_str(), at, x_title))
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
        let title = text_width([&*self.title], PANEL_TITLE_SIZE);
        let x_title = text_width([&*self.x_title], FONT_SIZE);
        self.left() + cells.max(title).max(x_title) + 2 * GAP
    }

    /// The height of the rotated column labels, in pixels.
    fn column_label_height(&self) -> i32 {
        text_width(self.columns.iter().map(|name| &**name), FONT_SIZE)
    }

    fn height(&self) -> i32 {
        let rows = self.rows.len() as i32 * CELL_SIZE;
        2 * LINE_HEIGHT + X_TITLE_GAP + rows + self.column_label_height() + 2 * GAP
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
            legend: "l".to_owned(),
            bands: vec![band(0.0, [0, 0, 255]), band(0.5, [255, 0, 0])],
            panels: vec![Panel {
                title: "p".to_owned(),
                x_title: "x".to_owned(),
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
        assert_eq!(map.svg().matches("#0000FF").count(), 2);
        let is_ink = |[r, g, b, _]: &&[f32; 4]| r == g && g == b && *r < 0.5;
        assert!(image.pixels().iter().filter(is_ink).count() > 50);
    }
}
