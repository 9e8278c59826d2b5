//! Scatter plots on two logarithmic scales, with the Pareto front.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::{FAINT, GRAY, INK, PAPER, text_style, text_width};

/// A named point.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Must be positive.
    pub x: f64,
    /// Must be positive.
    pub y: f64,
    /// The name, which the legend lists for points on the Pareto front.
    pub name: String,
    /// The index of its group.
    pub group: usize,
    /// Whether it is on the Pareto front: no other point has both smaller x and smaller y.
    pub on_front: bool,
}

/// A scatter plot on logarithmic scales.
#[derive(Debug, Clone)]
pub struct Scatter {
    /// The title.
    pub title: String,
    /// The quantity on the x-axis, with its unit.
    pub x_title: String,
    /// The quantity on the y-axis, with its unit.
    pub y_title: String,
    /// The names of the groups; each has a color.
    pub groups: Vec<String>,
    /// The points.
    pub points: Vec<Point>,
    /// Values of y marked by horizontal lines, with their labels.
    pub reference_lines: Vec<(f64, String)>,
}

/// The relative margin at the ends of a scale: far less than a pixel.
const RANGE_MARGIN: f64 = 1e-9;
const SIZE: (u32, u32) = (1500, 960);
const FONT_SIZE: i32 = 18;
const SMALL_SIZE: i32 = 14;
const TITLE_SIZE: i32 = 26;
const LINE_HEIGHT: i32 = 26;
/// Distinguishable with color-vision deficiency: Okabe and Ito, “Color Universal Design” (2008).
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
    /// Draws the plot as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.draw(SVGBackend::with_string(&mut text, SIZE));
        text
    }

    /// Draws the plot as an image.
    #[must_use]
    pub fn image(&self) -> Image {
        super::rasterize(SIZE, |raster| {
            let _ = self.draw(raster);
        })
    }

    /// The range of powers of ten that contains all values.
    fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if !(low > 0.0 && high.is_finite() && low <= high) {
            return 0.1..1.0;
        }
        let low = libm::exp10((libm::log10(low) - 0.05).floor());
        let high = libm::exp10((libm::log10(high) + 0.15).ceil());
        // Slightly wider, so that the end ticks are labeled: plotters finds them by rounded logarithms.
        low * (1.0 - RANGE_MARGIN)..high.max(10.0 * low) * (1.0 + RANGE_MARGIN)
    }

    fn draw<B: DrawingBackend>(&self, backend: B) -> DrawResult<(), B> {
        let area = backend.into_drawing_area();
        area.fill(&PAPER)?;
        let mut front: Vec<_> = self.points.iter().filter(|point| point.on_front).collect();
        front.sort_by(|a, b| a.x.total_cmp(&b.x));
        let names = front.iter().map(|point| &point.name).chain(&self.groups);
        // Fonts of viewers of the SVG may be wider than the embedded one.
        let legend_width = 60 + text_width(names.map(String::as_str), FONT_SIZE) * 9 / 8;
        let (plot, legend) = area.split_horizontally(SIZE.0 as i32 - legend_width);
        self.draw_plot(&plot, &front)?;
        self.draw_legend(&legend, &front)?;
        area.present()
    }

    fn draw_plot<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        front: &[&Point],
    ) -> DrawResult<(), B> {
        let lines = self.reference_lines.iter().map(|line| line.0);
        let x = Self::range(self.points.iter().map(|point| point.x));
        let y = Self::range(self.points.iter().map(|point| point.y).chain(lines));
        let mut chart = ChartBuilder::on(area)
            .margin(20)
            .margin_right(
                LINE_HEIGHT + text_width(self.reference_lines.iter().map(|line| &*line.1), SMALL_SIZE),
            )
            .caption(self.title.as_str(), text_style(TITLE_SIZE, INK))
            .x_label_area_size(60)
            .y_label_area_size(80)
            .build_cartesian_2d(x.clone().log_scale(), y.clone().log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(RGBColor(245, 245, 245))
            .bold_line_style(FAINT)
            .axis_style(INK)
            .label_style(text_style(FONT_SIZE, INK))
            .axis_desc_style(text_style(FONT_SIZE, INK))
            .x_label_formatter(&|x| tick(*x))
            .y_label_formatter(&|y| tick(*y))
            .x_desc(self.x_title.as_str())
            .y_desc(self.y_title.as_str())
            .draw()?;
        for (at, _) in &self.reference_lines {
            let ends = [(x.start, *at), (x.end, *at)];
            chart.draw_series(DashedLineSeries::new(ends, 6, 6, GRAY.stroke_width(1)))?;
        }
        // Between two points of the front, nothing is better than the first.
        let corners = front.windows(2).map(|ends| (ends[1].x, ends[0].y));
        let ends = front.iter().map(|point| (point.x, point.y));
        let steps = ends
            .clone()
            .take(1)
            .chain(corners.zip(ends.skip(1)).flat_map(|(a, b)| [a, b]));
        chart.draw_series(LineSeries::new(steps, INK.stroke_width(2)))?;
        for point in &self.points {
            let size = if point.on_front { 8 } else { 5 };
            chart.draw_series([Circle::new((point.x, point.y), size, color(point.group).filled())])?;
        }
        let at_pixel = |x: f64, y: f64| chart.backend_coord(&(x, y));
        let pixels: Vec<_> = front.iter().map(|point| at_pixel(point.x, point.y)).collect();
        let lines: Vec<_> = self
            .reference_lines
            .iter()
            .map(|(at, name)| (at_pixel(x.end, *at), name))
            .collect();
        drop(chart);
        let origin = area.get_base_pixel();
        let text = |text: String, (x, y): Pixel, style: TextStyle<'static>| {
            area.draw(&Text::new(text, (x - origin.0, y - origin.1), style))
        };
        // Nothing is nearer to the lower left corner than the front, so its numbers are free of other points.
        let style = text_style(FONT_SIZE, INK).pos(Pos::new(HPos::Right, VPos::Top));
        for (range, (x, y)) in front_labels(&pixels) {
            text(range, (x - 8, y + 6), style.clone())?;
        }
        let style = text_style(SMALL_SIZE, GRAY).pos(Pos::new(HPos::Left, VPos::Center));
        for (at, name) in lines {
            text(name.clone(), (at.0 + 8, at.1), style.clone())?;
        }
        Ok(())
    }

    /// Draws the colors of the groups, and the names of the points on the front.
    fn draw_legend<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        front: &[&Point],
    ) -> DrawResult<(), B> {
        let style = text_style(FONT_SIZE, INK).pos(Pos::new(HPos::Left, VPos::Center));
        let mut y = 80;
        for (group, name) in self.groups.iter().enumerate() {
            area.draw(&Circle::new((10, y - 2), 6, color(group).filled()))?;
            area.draw(&Text::new(name.as_str(), (30, y), style.clone()))?;
            y += LINE_HEIGHT;
        }
        if front.is_empty() {
            return Ok(());
        }
        y += LINE_HEIGHT;
        area.draw(&Text::new("Pareto front", (2, y), style.clone()))?;
        for (number, point) in (1..).zip(front) {
            y += LINE_HEIGHT;
            let right = style.clone().pos(Pos::new(HPos::Right, VPos::Center));
            area.draw(&Text::new(format!("{number}"), (20, y), right))?;
            area.draw(&Text::new(point.name.as_str(), (30, y), style.clone()))?;
        }
        Ok(())
    }
}

fn color(group: usize) -> RGBColor {
    COLORS[group % COLORS.len()]
}

/// Formats a tick label: `0.01`, `100`, `10⁻⁵`.
fn tick(value: f64) -> String {
    let exponent = libm::log10(value).floor() as i32;
    let is_power = (value / libm::exp10(f64::from(exponent)) - 1.0).abs() < 1e-6;
    if (-2..=4).contains(&exponent) || !is_power {
        return format!("{}", (value * 1e6).round() / 1e6);
    }
    let superscript = |digit: char| match digit {
        '-' => '⁻',
        digit => "⁰¹²³⁴⁵⁶⁷⁸⁹"
            .chars()
            .nth(digit as usize - '0' as usize)
            .unwrap_or(digit),
    };
    let exponent: String = exponent.to_string().chars().map(superscript).collect();
    format!("10{exponent}")
}

type Pixel = (i32, i32);

/// The numbers of the points of a front, with the point that each label belongs to: neighbors whose numbers
/// would overlap share a label, such as `3–5`.
fn front_labels(front: &[Pixel]) -> Vec<(String, Pixel)> {
    let mut labels = Vec::new();
    let mut first = 0;
    for last in 0..front.len() {
        let is_near = |next: &Pixel| {
            let (x, y) = front[last];
            next.0 - x < 2 * FONT_SIZE && next.1 - y < FONT_SIZE
        };
        if front.get(last + 1).is_some_and(is_near) {
            continue;
        }
        let text = if first == last {
            format!("{}", first + 1)
        } else {
            format!("{}–{}", first + 1, last + 1)
        };
        labels.push((text, front[first]));
        first = last + 1;
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scatter() -> Scatter {
        let points = (1..=30u32).map(|i| {
            let i = f64::from(i);
            Point {
                x: 1.0 + 0.02 * i,
                y: 1e-3 / i,
                name: format!("way {i}"),
                group: 0,
                on_front: i > 28.0,
            }
        });
        Scatter {
            title: "t".to_owned(),
            x_title: "x".to_owned(),
            y_title: "y".to_owned(),
            groups: vec!["one".to_owned()],
            points: points.collect(),
            reference_lines: vec![(1e-3, "E".to_owned())],
        }
    }

    #[test]
    fn both_ends_of_the_scales_are_labeled() {
        for power in -6..3 {
            let mut scatter = scatter();
            scatter.reference_lines.clear();
            for point in &mut scatter.points {
                (point.x, point.y) = (point.x * libm::exp10(f64::from(power)), point.y * 1e3);
                point.y *= libm::exp10(f64::from(power));
            }
            let svg = scatter.svg();
            for end in [power - 2, power + 1] {
                let label = tick(libm::exp10(f64::from(end)));
                assert!(svg.contains(&format!("\n{label}\n")), "{label}");
            }
        }
    }

    #[test]
    fn svg_and_image_show_the_points() {
        let scatter = scatter();
        let svg = scatter.svg();
        assert!(
            svg.matches("<circle").count() > 30 && svg.contains("way 30") && !svg.contains("way 28"),
            "{svg}"
        );
        let image = scatter.image();
        assert_eq!(image.size(), [SIZE.0, SIZE.1]);
        let RGBColor(r, g, b) = COLORS[0];
        let blue = [r, g, b].map(|c| f32::from(c) / 255.0);
        assert!(image.pixels().iter().filter(|pixel| pixel[..3] == blue).count() > 1000);
    }

    #[test]
    fn empty_plots_are_drawn() {
        let mut scatter = scatter();
        scatter.points.clear();
        scatter.reference_lines.clear();
        assert!(scatter.svg().contains("<svg"));
    }

    #[test]
    fn ticks_are_plain_numbers_or_powers_of_ten() {
        let ticks = [1e-5, 0.01, 0.2, 1.0, 1000.0, 1e12].map(tick);
        assert_eq!(ticks, ["10⁻⁵", "0.01", "0.2", "1", "1000", "10¹²"]);
    }

    #[test]
    fn near_points_of_the_front_share_a_label() {
        let labels = front_labels(&[(0, 0), (20, 5), (100, 5), (101, 50), (105, 52), (109, 60)]);
        let labels: Vec<_> = labels.iter().map(|(text, at)| (&**text, *at)).collect();
        assert_eq!(labels, [("1–2", (0, 0)), ("3", (100, 5)), ("4–6", (101, 50))]);
    }
}
