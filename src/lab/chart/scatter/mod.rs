//! Points on two logarithmic scales, with the front of those that no other beats.

mod label;

use std::ops::Range;

use plotters::prelude::*;
use plotters_backend::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::{FAINT, FONT, INK, PAPER, raster};

/// A point and its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// > 0
    pub x: f64,
    /// > 0
    pub y: f64,
    /// What stands beside it; may be empty.
    pub name: String,
    /// Which of the groups it belongs to.
    pub group: usize,
    /// Whether no other point has smaller x and y.
    pub best: bool,
}

/// Points on logarithmic scales.
#[derive(Debug, Clone)]
pub struct Scatter {
    /// What it shows.
    pub title: String,
    /// What x is, and its unit.
    pub x: String,
    /// What y is, and its unit.
    pub y: String,
    /// What the groups are; each has a colour.
    pub groups: Vec<String>,
    /// The points.
    pub points: Vec<Point>,
    /// Values of y that a line is drawn at, and their names.
    pub lines: Vec<(f64, String)>,
}

/// Of a scale's ends: far less than a pixel.
const HAIR: f64 = 1e-9;
const SIZE: (u32, u32) = (1500, 960);
const LETTERS: i32 = 16;
/// Told apart also by those who see few colours: Okabe and Ito, “Color Universal Design” (2008).
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(110, 110, 110),
];

impl Scatter {
    /// As SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let mut text = String::new();
        // Nothing can fail on a string.
        let _ = self.draw(SVGBackend::with_string(&mut text, SIZE));
        text
    }

    /// As a picture.
    #[must_use]
    pub fn image(&self) -> Image {
        raster::drawn(SIZE, |raster| {
            let _ = self.draw(raster);
        })
    }

    /// Powers of ten around all values.
    fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if !(low > 0.0 && high.is_finite() && low <= high) {
            return 0.1..1.0;
        }
        let low = libm::exp10((libm::log10(low) - 0.05).floor());
        let high = libm::exp10((libm::log10(high) + 0.15).ceil());
        // A hair wider, for the ends to have their numbers: plotters looks for those with logarithms that are rounded.
        low * (1.0 - HAIR)..high.max(10.0 * low) * (1.0 + HAIR)
    }

    fn draw<B: DrawingBackend>(&self, backend: B) -> DrawResult<(), B> {
        let area = backend.into_drawing_area();
        area.fill(&PAPER)?;
        let lines = self.lines.iter().map(|line| line.0);
        let x = Self::range(self.points.iter().map(|point| point.x));
        let mut y = Self::range(self.points.iter().map(|point| point.y).chain(lines));
        if self.is_any_under_legend(&x, &y) {
            y.end *= 10.0;
        }
        let mut chart = ChartBuilder::on(&area)
            .margin(20)
            .margin_right(40)
            .caption(self.title.as_str(), words(24, INK))
            .x_label_area_size(60)
            .y_label_area_size(110)
            .build_cartesian_2d(x.clone().log_scale(), y.clone().log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(RGBColor(245, 245, 245))
            .bold_line_style(FAINT)
            .axis_style(INK)
            .label_style(words(LETTERS, INK))
            .axis_desc_style(words(LETTERS, INK))
            .x_label_formatter(&|x| tick(*x))
            .y_label_formatter(&|y| tick(*y))
            .x_desc(self.x.as_str())
            .y_desc(self.y.as_str())
            .draw()?;
        for (at, name) in &self.lines {
            let ends = [(x.start, *at), (x.end, *at)];
            chart.draw_series(DashedLineSeries::new(ends, 6, 6, INK.mix(0.5).stroke_width(1)))?;
            let style = words(LETTERS, INK).pos(Pos::new(HPos::Left, VPos::Bottom));
            chart.draw_series([Text::new(name.clone(), (x.start, *at), style)])?;
        }
        let mut front: Vec<_> = self.points.iter().filter(|point| point.best).collect();
        front.sort_by(|a, b| a.x.total_cmp(&b.x));
        chart.draw_series(LineSeries::new(
            front.iter().map(|point| (point.x, point.y)),
            INK.stroke_width(2),
        ))?;
        for point in &self.points {
            let color = COLORS[point.group % COLORS.len()];
            let size = if point.best { 8 } else { 5 };
            chart.draw_series([Circle::new((point.x, point.y), size, color.filled())])?;
        }
        let place = |x: f64, y: f64| chart.backend_coord(&(x, y));
        let names = self.lines.iter().map(|(at, name)| {
            let (x, y) = place(x.start, *at);
            [x, y - LETTERS, x + LETTERS * name.chars().count() as i32, y]
        });
        let labels = self.labels(&place, names.collect());
        let groups = self.groups.iter().enumerate();
        let legend: Vec<_> = groups
            .map(|(i, name)| (name, COLORS[i % COLORS.len()], 40 + LETTERS * 3 / 2 * i as i32))
            .collect();
        drop(chart);
        for label in &labels {
            area.draw(&PathElement::new(
                [label.point, label.at],
                RGBColor(150, 150, 150),
            ))?;
        }
        for label in labels {
            let anchor = if label.is_left() { HPos::Right } else { HPos::Left };
            let style = words(LETTERS, INK).pos(Pos::new(anchor, VPos::Center));
            area.draw(&Text::new(label.name, label.at, style))?;
        }
        let corners = [
            (self.legend_left(), 60),
            (
                SIZE.0 as i32 - 41,
                62 + LETTERS * 3 / 2 * self.groups.len() as i32,
            ),
        ];
        area.draw(&Rectangle::new(corners, PAPER.filled()))?;
        for (name, color, y) in legend {
            let x = SIZE.0 as i32 - 50;
            area.draw(&Circle::new((x, y + 30), 6, color.filled()))?;
            let style = words(LETTERS, INK).pos(Pos::new(HPos::Right, VPos::Center));
            area.draw(&Text::new(name.as_str(), (x - 16, y + 30), style))?;
        }
        area.present()
    }

    /// Where the corner begins that the names of groups stand in.
    fn legend_left(&self) -> i32 {
        let letters = self.groups.iter().map(|name| name.chars().count() as i32).max();
        SIZE.0 as i32 - 80 - LETTERS * letters.unwrap_or(0)
    }

    /// Where it ends.
    fn legend_bottom(&self) -> i32 {
        80 + LETTERS * 3 / 2 * self.groups.len() as i32
    }

    /// Whether a point would be hidden, roughly: the axes and their words take so much of the picture's sides.
    fn is_any_under_legend(&self, x: &Range<f64>, y: &Range<f64>) -> bool {
        const LEFT: f64 = 130.0;
        const RIGHT: f64 = 40.0;
        const TOP: f64 = 50.0;
        const BOTTOM: f64 = 80.0;
        let share = |value: f64, range: &Range<f64>| {
            libm::log10(value / range.start) / libm::log10(range.end / range.start)
        };
        let [width, height] = [f64::from(SIZE.0), f64::from(SIZE.1)];
        self.points.iter().any(|point| {
            let across = LEFT + share(point.x, x) * (width - LEFT - RIGHT);
            let down = height - BOTTOM - share(point.y, y) * (height - TOP - BOTTOM);
            across > f64::from(self.legend_left()) && down < f64::from(self.legend_bottom())
        })
    }
}

/// A number on a scale, as people write it.
fn tick(value: f64) -> String {
    let digits = format!("{value:.1e}");
    digits.replace(".0e", "e")
}

fn words(size: i32, color: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&color)
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn scatter() -> Scatter {
        let points = (1..=30u32).map(|i| {
            let i = f64::from(i);
            Point {
                x: 1.0 + 0.02 * i,
                y: 1e-3 / i,
                name: format!("way {i}"),
                group: 0,
                best: i > 28.0,
            }
        });
        Scatter {
            title: "t".to_owned(),
            x: "x".to_owned(),
            y: "y".to_owned(),
            groups: vec!["one".to_owned()],
            points: points.collect(),
            lines: vec![(1e-3, "E".to_owned())],
        }
    }

    #[test]
    fn no_point_is_under_the_legend() {
        let mut scatter = scatter();
        let range = |of: fn(&Point) -> f64| Scatter::range(scatter.points.iter().map(of));
        let (x, y) = (range(|point| point.x), range(|point| point.y));
        assert!(!scatter.is_any_under_legend(&x, &y));
        (scatter.points[0].x, scatter.points[0].y) = (x.end, y.end);
        assert!(scatter.is_any_under_legend(&x, &y));
        assert!(!scatter.is_any_under_legend(&x, &(y.start..10.0 * y.end)));
    }

    #[test]
    fn both_ends_of_the_scales_have_their_numbers() {
        for power in -6..3 {
            let mut scatter = scatter();
            scatter.lines.clear();
            for point in &mut scatter.points {
                (point.x, point.y) = (point.x * libm::exp10(f64::from(power)), point.y * 1e3);
                point.y *= libm::exp10(f64::from(power));
            }
            let svg = scatter.svg();
            for end in [power - 2, power + 1] {
                assert!(svg.contains(&format!("\n1e{end}\n")), "1e{end}");
            }
        }
    }

    #[test]
    fn both_forms_show_the_points() {
        let scatter = scatter();
        let svg = scatter.svg();
        assert!(
            svg.matches("<circle").count() > 30 && svg.contains("way 30"),
            "{svg}"
        );
        let image = scatter.image();
        assert_eq!(image.size(), [SIZE.0, SIZE.1]);
        let RGBColor(r, g, b) = COLORS[0];
        let blue = [r, g, b].map(|c| f32::from(c) / 255.0);
        assert!(image.pixels().iter().filter(|pixel| pixel[..3] == blue).count() > 1000);
    }

    #[test]
    fn values_that_have_no_logarithm_do_no_harm() {
        let mut scatter = scatter();
        scatter.points.clear();
        scatter.lines.clear();
        assert!(scatter.svg().contains("<svg"));
    }
}
