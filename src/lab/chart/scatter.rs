//! Scatter plots on two logarithmic scales, with the Pareto front.

use std::ops::Range;

use plotters::prelude::*;
use plotters_backend::text_anchor::{HPos, Pos, VPos};
use toyproof_image::Image;

use super::{FAINT, FONT, INK, PAPER};

/// A point with its label.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Must be positive.
    pub x: f64,
    /// Must be positive.
    pub y: f64,
    /// The label beside it; may be empty.
    pub name: String,
    /// The index of its group.
    pub group: usize,
    /// Whether it is on the Pareto front: no other point has both smaller x and smaller y.
    pub best: bool,
}

/// A scatter plot on logarithmic scales.
#[derive(Debug, Clone)]
pub struct Scatter {
    /// The title.
    pub title: String,
    /// The quantity on the x-axis, with its unit.
    pub x: String,
    /// The quantity on the y-axis, with its unit.
    pub y: String,
    /// The names of the groups; each has a color.
    pub groups: Vec<String>,
    /// The points.
    pub points: Vec<Point>,
    /// Values of y marked by horizontal lines, with their labels.
    pub lines: Vec<(f64, String)>,
}

/// The relative margin at the ends of a scale: far less than a pixel.
const RANGE_MARGIN: f64 = 1e-9;
const SIZE: (u32, u32) = (1500, 960);
const FONT_SIZE: i32 = 16;
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
        let lines = self.lines.iter().map(|line| line.0);
        let x = Self::range(self.points.iter().map(|point| point.x));
        let mut y = Self::range(self.points.iter().map(|point| point.y).chain(lines));
        if self.is_any_under_legend(&x, &y) {
            y.end *= 10.0;
        }
        let mut chart = ChartBuilder::on(&area)
            .margin(20)
            .margin_right(40)
            .caption(self.title.as_str(), text_style(24, INK))
            .x_label_area_size(60)
            .y_label_area_size(110)
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
            .x_desc(self.x.as_str())
            .y_desc(self.y.as_str())
            .draw()?;
        for (at, name) in &self.lines {
            let ends = [(x.start, *at), (x.end, *at)];
            chart.draw_series(DashedLineSeries::new(ends, 6, 6, INK.mix(0.5).stroke_width(1)))?;
            let style = text_style(FONT_SIZE, INK).pos(Pos::new(HPos::Left, VPos::Bottom));
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
            [x, y - FONT_SIZE, x + FONT_SIZE * name.chars().count() as i32, y]
        });
        let labels = self.labels(&place, names.collect());
        let groups = self.groups.iter().enumerate();
        let legend: Vec<_> = groups
            .map(|(i, name)| (name, COLORS[i % COLORS.len()], 40 + FONT_SIZE * 3 / 2 * i as i32))
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
            let style = text_style(FONT_SIZE, INK).pos(Pos::new(anchor, VPos::Center));
            area.draw(&Text::new(label.name, label.at, style))?;
        }
        let corners = [
            (self.legend_left(), 60),
            (
                SIZE.0 as i32 - 41,
                62 + FONT_SIZE * 3 / 2 * self.groups.len() as i32,
            ),
        ];
        area.draw(&Rectangle::new(corners, PAPER.filled()))?;
        for (name, color, y) in legend {
            let x = SIZE.0 as i32 - 50;
            area.draw(&Circle::new((x, y + 30), 6, color.filled()))?;
            let style = text_style(FONT_SIZE, INK).pos(Pos::new(HPos::Right, VPos::Center));
            area.draw(&Text::new(name.as_str(), (x - 16, y + 30), style))?;
        }
        area.present()
    }

    /// The left edge of the legend, in pixels.
    fn legend_left(&self) -> i32 {
        let char_count = self.groups.iter().map(|name| name.chars().count() as i32).max();
        SIZE.0 as i32 - 80 - FONT_SIZE * char_count.unwrap_or(0)
    }

    /// The bottom edge of the legend, in pixels.
    fn legend_bottom(&self) -> i32 {
        80 + FONT_SIZE * 3 / 2 * self.groups.len() as i32
    }

    /// Whether the legend hides a point, approximately: the constants are the widths of axes and labels, in
    /// pixels.
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

/// Formats a tick label.
fn tick(value: f64) -> String {
    let digits = format!("{value:.1e}");
    digits.replace(".0e", "e")
}

fn text_style(size: i32, color: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&color)
}

// Labels of points.

/// Left, top, right and bottom, in pixels.
type Area = [i32; 4];
type Pixel = (i32, i32);

/// The tolerance for equal distances, as a difference of squared pixels.
const SLACK: i32 = 8;

/// A label and its position.
#[derive(Debug, Clone)]
struct Label {
    name: String,
    /// The end of the text next to the point.
    at: Pixel,
    point: Pixel,
}

impl Label {
    /// Whether the label is left of its point.
    fn is_left(&self) -> bool {
        self.at.0 < self.point.0
    }

    fn around(&self) -> Area {
        let (x, y) = self.at;
        let width = FONT_SIZE * self.name.chars().count() as i32;
        let left = if self.is_left() { x - width } else { x };
        [left, y - FONT_SIZE / 2, left + width, y + FONT_SIZE / 2]
    }
}

impl Scatter {
    /// Places as many labels as fit, those of the front first. A label covers no other label, point, front
    /// line or `occupied` area, and is not nearer to another point than to its own; labels of the front,
    /// whose points are larger, may be equally near to both within [`SLACK`].
    fn labels(&self, place: &impl Fn(f64, f64) -> Pixel, mut occupied: Vec<Area>) -> Vec<Label> {
        let pixel = |point: &Point| place(point.x, point.y);
        let dots: Vec<Pixel> = self.points.iter().map(pixel).collect();
        occupied.extend(dots.iter().map(|&dot| square(dot, 6)));
        // The corner of the legend.
        occupied.push([self.legend_left(), 0, SIZE.0 as i32, self.legend_bottom()]);
        let mut front: Vec<Pixel> = self.points.iter().filter(|point| point.best).map(pixel).collect();
        front.sort_unstable();
        occupied.extend(front.windows(2).flat_map(|ends| boxes_along(ends[0], ends[1])));
        let named = self.points.iter().filter(|point| !point.name.is_empty());
        let mut points: Vec<_> = named.collect();
        points.sort_by(|a, b| b.best.cmp(&a.best).then(a.y.total_cmp(&b.y)));
        let mut labels: Vec<Label> = Vec::new();
        for point in points {
            let own = pixel(point);
            let slack = if point.best { SLACK } else { 0 };
            let is_free = |label: &Label| {
                let around = label.around();
                let inside = around[0] > 140 && around[2] < SIZE.0 as i32 - 20 && around[1] > 60;
                let distance = squared_distance(own, &around);
                inside
                    && around[3] < SIZE.1 as i32 - 90
                    && !occupied.iter().any(|other| overlap(&around, other))
                    && !dots
                        .iter()
                        .any(|&dot| squared_distance(dot, &around) + slack < distance)
                    && !labels.iter().any(|other| {
                        let mut leader = boxes_along(own, label.at);
                        leader.any(|piece| overlap(&piece, &other.around()))
                    })
            };
            if let Some(label) = candidate_positions(&point.name, own).find(is_free) {
                occupied.push(label.around());
                occupied.extend(boxes_along(own, label.at));
                labels.push(label);
            }
        }
        labels
    }
}

/// Candidate positions of a point's label, nearest first.
fn candidate_positions(name: &str, (x, y): Pixel) -> impl Iterator<Item = Label> {
    [0, -1, 1, -2, 2, -3, 3, -4, 4].into_iter().flat_map(move |row| {
        let y_of_row = y + row * (FONT_SIZE + 4);
        let beside = [14, -14].into_iter();
        // In other rows, the text may begin or end at the point itself.
        let above_or_below = [1, -1].into_iter().filter(move |_| row != 0);
        beside.chain(above_or_below).map(move |dx| Label {
            name: name.to_owned(),
            at: (x + dx, y_of_row),
            point: (x, y),
        })
    })
}

/// Small boxes along a line.
fn boxes_along((ax, ay): Pixel, (bx, by): Pixel) -> impl Iterator<Item = Area> {
    let steps = ((bx - ax).abs().max((by - ay).abs()) / 4).max(1);
    (0..=steps).map(move |step| square((ax + (bx - ax) * step / steps, ay + (by - ay) * step / steps), 2))
}

fn square((x, y): Pixel, half: i32) -> Area {
    [x - half, y - half, x + half, y + half]
}

fn squared_distance((x, y): Pixel, [left, top, right, bottom]: &Area) -> i32 {
    let dx = (left - x).max(x - right).max(0);
    let dy = (top - y).max(y - bottom).max(0);
    dx * dx + dy * dy
}

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
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
    fn both_ends_of_the_scales_are_labeled() {
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
    fn svg_and_image_show_the_points() {
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
    fn empty_plots_are_drawn() {
        let mut scatter = scatter();
        scatter.points.clear();
        scatter.lines.clear();
        assert!(scatter.svg().contains("<svg"));
    }

    fn place(x: f64, y: f64) -> Pixel {
        ((x * 400.0) as i32, (-libm::log10(y) * 200.0) as i32)
    }

    #[test]
    fn labels_never_overlap_and_the_best_is_labeled() {
        let labels = scatter().labels(&place, Vec::new());
        for (i, one) in labels.iter().enumerate() {
            let covers = |other: &Label| overlap(&one.around(), &other.around());
            assert!(!labels[..i].iter().any(covers), "{one:?}");
        }
        assert_eq!(labels[0].name, "way 30", "the best has its name");
        assert!((5..30).contains(&labels.len()), "{}", labels.len());
    }

    #[test]
    fn labels_are_nearest_to_their_own_points() {
        let scatter = scatter();
        let dots: Vec<_> = scatter
            .points
            .iter()
            .map(|point| place(point.x, point.y))
            .collect();
        for label in scatter.labels(&place, Vec::new()) {
            let own = squared_distance(label.point, &label.around());
            let nearest = dots
                .iter()
                .map(|&dot| squared_distance(dot, &label.around()))
                .min();
            let slack = if scatter
                .points
                .iter()
                .any(|point| point.best && point.name == label.name)
            {
                SLACK
            } else {
                0
            };
            assert!(nearest >= Some(own - slack), "{label:?}");
        }
    }

    #[test]
    fn labels_avoid_the_front_and_occupied_areas() {
        let mut scatter = scatter();
        for point in &mut scatter.points {
            point.best = true;
        }
        let occupied = [500, 0, 620, 960];
        for label in scatter.labels(&place, vec![occupied]) {
            assert!(!overlap(&label.around(), &occupied), "{label:?}");
            let ends = scatter.points.windows(2);
            let mut front =
                ends.flat_map(|pair| boxes_along(place(pair[0].x, pair[0].y), place(pair[1].x, pair[1].y)));
            assert!(!front.any(|piece| overlap(&piece, &label.around())), "{label:?}");
        }
    }

    #[test]
    fn points_without_names_have_no_labels() {
        let mut scatter = scatter();
        let others = scatter.points.iter_mut().skip(2);
        others.for_each(|point| point.name.clear());
        assert_eq!(scatter.labels(&place, Vec::new()).len(), 2);
    }
}
