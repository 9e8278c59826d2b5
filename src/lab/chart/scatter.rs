//! Scatter plots on two logarithmic scales, with the Pareto front.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::{FAINT, GRAY, INK, PAPER, text_style, text_width, tick};

/// A named point.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Must be positive.
    pub x: f64,
    /// Must not be negative; zero has a separate line below the scale.
    pub y: f64,
    /// The name, which the legend lists for points on the Pareto front.
    pub name: String,
    /// The index of the point's group.
    pub group: usize,
    /// Whether the point is on the Pareto front: no other point has both smaller x and smaller y.
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

// Sizes in pixels.

const SIZE: (u32, u32) = (1280, 760);
const FONT_SIZE: i32 = 19;
const TITLE_SIZE: i32 = 26;
const TICK_LENGTH: i32 = 5;
const LINE_HEIGHT: i32 = 26;

/// The colors of groups, distinguishable with color-vision deficiency: Okabe and Ito, “Color Universal
/// Design” (2008).
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
        let x = Scale::new(self.points.iter().map(|point| point.x), false);
        let has_zero = self.points.iter().any(|point| point.y <= 0.0);
        let y = Scale::new(self.points.iter().map(|point| point.y).chain(lines), has_zero);
        let label_width = text_width(self.reference_lines.iter().map(|line| &*line.1), FONT_SIZE);
        let mut chart = ChartBuilder::on(area)
            .margin(20)
            .margin_right(LINE_HEIGHT + label_width)
            .caption(self.title.as_str(), text_style(TITLE_SIZE, INK))
            .x_label_area_size(70)
            .y_label_area_size(95)
            .build_cartesian_2d(x.range.clone().log_scale(), y.range.clone().log_scale())?;
        let [x_ends, y_ends] = [&x, &y].map(|scale| (scale.range.start, scale.range.end));
        for (at, style) in x.grid() {
            chart.draw_series(LineSeries::new([(at, y_ends.0), (at, y_ends.1)], style))?;
        }
        for (at, style) in y.grid() {
            chart.draw_series(LineSeries::new([(x_ends.0, at), (x_ends.1, at)], style))?;
        }
        let frame = [(x_ends.0, y_ends.1), (x_ends.0, y_ends.0), (x_ends.1, y_ends.0)];
        chart.draw_series(LineSeries::new(frame, INK.stroke_width(1)))?;
        for (at, _) in &self.reference_lines {
            let ends = [(x_ends.0, *at), (x_ends.1, *at)];
            chart.draw_series(DashedLineSeries::new(ends, 6, 6, GRAY.stroke_width(1)))?;
        }
        let front: Vec<Point> = front.iter().map(|&point| y.place(point)).collect();
        // Between two points of the front, nothing is better than the first.
        let corners = front.windows(2).map(|ends| (ends[1].x, ends[0].y));
        let ends = front.iter().map(|point| (point.x, point.y));
        let steps = ends
            .clone()
            .take(1)
            .chain(corners.zip(ends.skip(1)).flat_map(|(a, b)| [a, b]));
        chart.draw_series(LineSeries::new(steps, INK.stroke_width(2)))?;
        // Points on the front last, above all others.
        let (above, below): (Vec<Point>, Vec<Point>) = self
            .points
            .iter()
            .map(|point| y.place(point))
            .partition(|point| point.on_front);
        for point in below.iter().chain(&above) {
            let size = if point.on_front { 8 } else { 5 };
            chart.draw_series([Circle::new((point.x, point.y), size, color(point.group).filled())])?;
        }
        let at_pixel = |x: f64, y: f64| chart.backend_coord(&(x, y));
        let pixels: Vec<_> = front.iter().map(|point| at_pixel(point.x, point.y)).collect();
        let lines: Vec<_> = self
            .reference_lines
            .iter()
            .map(|(at, name)| (at_pixel(x_ends.1, *at), name))
            .collect();
        let x_ticks: Vec<_> = x
            .ticks()
            .into_iter()
            .map(|(at, name)| (at_pixel(at, y_ends.0), name))
            .collect();
        let y_ticks: Vec<_> = y
            .ticks()
            .into_iter()
            .map(|(at, name)| (at_pixel(x_ends.0, at), name))
            .collect();
        let corners = [at_pixel(x_ends.0, y_ends.0), at_pixel(x_ends.1, y_ends.1)];
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
        let style = text_style(FONT_SIZE, GRAY).pos(Pos::new(HPos::Left, VPos::Center));
        for (at, name) in lines {
            text(name.clone(), (at.0 + 8, at.1), style.clone())?;
        }
        let below = text_style(FONT_SIZE, INK).pos(Pos::new(HPos::Center, VPos::Top));
        for ((x, y), name) in x_ticks {
            text(name, (x, y + TICK_LENGTH), below.clone())?;
        }
        let left = text_style(FONT_SIZE, INK).pos(Pos::new(HPos::Right, VPos::Center));
        for ((x, y), name) in y_ticks {
            text(name, (x - TICK_LENGTH, y), left.clone())?;
        }
        let [(x0, y0), (x1, y1)] = corners;
        text(self.x_title.clone(), (i32::midpoint(x0, x1), y0 + 34), below)?;
        let upwards = text_style(FONT_SIZE, INK)
            .transform(FontTransform::Rotate270)
            .pos(Pos::new(HPos::Center, VPos::Center));
        text(
            self.y_title.clone(),
            (origin.0 + 28, i32::midpoint(y0, y1)),
            upwards,
        )
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

/// A logarithmic scale that is slightly wider than its values.
struct Scale {
    range: Range<f64>,
    /// Where zero is drawn, below all other values.
    zero: Option<f64>,
}

/// The most decades of a scale with ticks at 1, 2 and 5 times powers of ten; up to one decade also has 3 and
/// 7.
const MAX_DECADES_WITH_FINE_TICKS: f64 = 2.6;
/// The minimum number of decades of a scale, so that nearly equal values look nearly equal.
const MIN_DECADES: f64 = 0.8;
/// The part of a scale that is empty at each end.
const MARGIN: f64 = 0.06;

impl Scale {
    /// A scale for positive values; others are ignored. `has_zero`: whether zero also has a place.
    fn new(values: impl Iterator<Item = f64>, has_zero: bool) -> Self {
        let positive = values.filter(|value| *value > 0.0 && value.is_finite());
        let logarithms = positive.map(libm::log10);
        let (low, high) = logarithms.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = if low <= high { (low, high) } else { (-1.0, 0.0) };
        let missing = (MIN_DECADES - (high - low)).max(0.0);
        let (mut low, mut high) = (low - missing / 2.0, high + missing / 2.0);
        let margin = MARGIN * (high - low);
        let zero = has_zero.then(|| {
            low -= 2.0 * margin;
            libm::exp10(low)
        });
        low -= margin;
        high += margin;
        Self {
            range: libm::exp10(low)..libm::exp10(high),
            zero,
        }
    }

    /// The point with a positive y.
    fn place(&self, point: &Point) -> Point {
        let y = match self.zero {
            Some(zero) if point.y <= 0.0 => zero,
            _ => point.y,
        };
        Point { y, ..point.clone() }
    }

    fn decades(&self) -> f64 {
        libm::log10(self.range.end / self.range.start)
    }

    /// The least value above zero.
    fn least(&self) -> f64 {
        self.zero.map_or(self.range.start, |zero| {
            zero * libm::exp10(MARGIN * self.decades())
        })
    }

    /// The multiples 1 to 9 of powers of ten in the range, with the multiplier and the exponent.
    fn multiples(&self) -> impl Iterator<Item = (f64, u32, i32)> {
        let [first, last] = [self.range.start, self.range.end].map(|end| libm::log10(end).floor() as i32);
        let all = (first..=last).flat_map(|exponent| (1..10).map(move |digit| (digit, exponent)));
        let values = all.map(|(digit, exponent)| {
            (
                f64::from(digit) * libm::exp10(f64::from(exponent)),
                digit,
                exponent,
            )
        });
        let ends = self.least()..self.range.end;
        values.filter(move |(value, ..)| ends.contains(value))
    }

    /// The grid lines with their styles: powers of ten are darker.
    fn grid(&self) -> Vec<(f64, ShapeStyle)> {
        let light = RGBColor(240, 240, 240).stroke_width(1);
        let lines = self.multiples().map(|(value, digit, _)| {
            let style = if digit == 1 { FAINT.stroke_width(1) } else { light };
            (value, style)
        });
        let zero = self.zero.map(|zero| (zero, FAINT.stroke_width(1)));
        lines.chain(zero).collect()
    }

    /// The labeled values, and zero.
    fn ticks(&self) -> Vec<(f64, String)> {
        let decades = self.decades();
        let step = (decades / 10.0).ceil().max(1.0) as i32;
        let is_labeled = |digit: u32, exponent: i32| match digit {
            1 => exponent % step == 0,
            2 | 5 => decades <= MAX_DECADES_WITH_FINE_TICKS,
            3 | 7 => decades <= 1.0,
            _ => false,
        };
        let ticks = self
            .multiples()
            .filter(|(_, digit, exponent)| is_labeled(*digit, *exponent));
        let ticks = ticks.map(|(value, ..)| (value, tick(value)));
        let zero = self.zero.map(|zero| (zero, "0".to_owned()));
        ticks.chain(zero).collect()
    }
}

fn color(group: usize) -> RGBColor {
    COLORS[group % COLORS.len()]
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
                name: format!("configuration {i}"),
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
    fn scales_have_labels_and_a_place_for_zero() {
        let labels = |values: &[f64], has_zero| {
            let scale = Scale::new(values.iter().copied(), has_zero);
            assert!(
                values
                    .iter()
                    .all(|value| *value <= 0.0 || scale.range.contains(value))
            );
            scale
                .ticks()
                .into_iter()
                .map(|(_, name)| name)
                .collect::<Vec<_>>()
        };
        assert_eq!(
            labels(&[0.6, 80.0], false),
            ["0.5", "1", "2", "5", "10", "20", "50", "100"]
        );
        assert_eq!(
            labels(&[3e-8, 0.0, 1e-2], true),
            ["10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "0.001", "0.01", "0"]
        );
        assert!(labels(&[2.0], false).len() >= 2);
    }

    #[test]
    fn svg_and_image_show_the_points() {
        let scatter = scatter();
        let svg = scatter.svg();
        assert!(
            svg.matches("<circle").count() > 30
                && svg.contains("configuration 30")
                && !svg.contains("configuration 28"),
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
        let ticks = [1e-5, 2e-5, 0.01, 0.2, 1.0, 1000.0, 1e12].map(tick);
        assert_eq!(ticks, ["10⁻⁵", "2·10⁻⁵", "0.01", "0.2", "1", "1000", "10¹²"]);
    }

    #[test]
    fn near_points_of_the_front_share_a_label() {
        let labels = front_labels(&[(0, 0), (20, 5), (100, 5), (101, 50), (105, 52), (109, 60)]);
        let labels: Vec<_> = labels.iter().map(|(text, at)| (&**text, *at)).collect();
        assert_eq!(labels, [("1–2", (0, 0)), ("3", (100, 5)), ("4–6", (101, 50))]);
    }
}
