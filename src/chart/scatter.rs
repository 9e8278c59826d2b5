//! Points on two logarithmic scales, with the front of those that no other beats.

use std::ops::Range;

use plotters::prelude::*;
use plotters_backend::text_anchor::{HPos, Pos, VPos};

use super::{FAINT, FONT, INK, PAPER, raster};
use crate::image::Image;

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

/// A name, where it stands and by which of its ends, and its point.
type Label = (String, (i32, i32), HPos, (i32, i32));

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
        low..high.max(10.0 * low)
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
        let labels = self.labels(&place);
        let groups = self.groups.iter().enumerate();
        let legend: Vec<_> = groups
            .map(|(i, name)| (name, COLORS[i % COLORS.len()], 40 + LETTERS * 3 / 2 * i as i32))
            .collect();
        drop(chart);
        for (_, at, _, from) in &labels {
            area.draw(&PathElement::new([*from, *at], RGBColor(150, 150, 150)))?;
        }
        for (name, at, anchor, _) in labels {
            let style = words(LETTERS, INK).pos(Pos::new(anchor, VPos::Center));
            area.draw(&Text::new(name, at, style))?;
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

    /// Names beside their points, as many as have room, the best first: none covers another, or a point.
    fn labels(&self, place: &impl Fn(f64, f64) -> (i32, i32)) -> Vec<Label> {
        let mut taken: Vec<[i32; 4]> = self
            .points
            .iter()
            .map(|point| {
                let (x, y) = place(point.x, point.y);
                [x - 6, y - 6, x + 6, y + 6]
            })
            .collect();
        // The legend's corner.
        taken.push([self.legend_left(), 0, SIZE.0 as i32, self.legend_bottom()]);
        let named = self.points.iter().filter(|point| !point.name.is_empty());
        let mut points: Vec<_> = named.collect();
        points.sort_by(|a, b| b.best.cmp(&a.best).then(a.y.total_cmp(&b.y)));
        let mut labels = Vec::new();
        for point in points {
            let (x, y) = place(point.x, point.y);
            let width = LETTERS * point.name.chars().count() as i32;
            let half = LETTERS / 2;
            let places = [0, -1, 1, -2, 2, -3, 3, -4, 4].into_iter().flat_map(|row| {
                let y = y + row * (LETTERS + 4);
                let right = (
                    (x + 14, y),
                    HPos::Left,
                    [x + 14, y - half, x + 14 + width, y + half],
                );
                let left = (
                    (x - 14, y),
                    HPos::Right,
                    [x - 14 - width, y - half, x - 14, y + half],
                );
                [right, left]
            });
            let is_free = |box_: &[i32; 4]| {
                let inside = box_[0] > 140 && box_[2] < SIZE.0 as i32 - 20 && box_[1] > 60;
                inside && box_[3] < SIZE.1 as i32 - 90 && !taken.iter().any(|other| overlap(box_, other))
            };
            let free = places.into_iter().find(|(_, _, box_)| is_free(box_));
            if let Some((at, anchor, box_)) = free {
                taken.push(box_);
                labels.push((point.name.clone(), at, anchor, (x, y)));
            }
        }
        labels
    }
}

/// A number on a scale, as people write it.
fn tick(value: f64) -> String {
    let digits = format!("{value:.1e}");
    digits.replace(".0e", "e")
}

fn overlap(a: &[i32; 4], b: &[i32; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn words(size: i32, color: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&color)
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
    fn labels_never_overlap_and_the_best_has_its_own() {
        let scatter = scatter();
        let place = |x: f64, y: f64| ((x * 400.0) as i32, (-libm::log10(y) * 200.0) as i32);
        let labels = scatter.labels(&place);
        let boxes: Vec<[i32; 4]> = labels
            .iter()
            .map(|(name, (x, y), anchor, _)| {
                let width = LETTERS * name.len() as i32;
                let left = if matches!(anchor, HPos::Left) {
                    *x
                } else {
                    x - width
                };
                [left, y - LETTERS / 2, left + width, y + LETTERS / 2]
            })
            .collect();
        for (i, one) in boxes.iter().enumerate() {
            assert!(boxes[..i].iter().all(|other| !overlap(one, other)));
        }
        assert_eq!(labels[0].0, "way 30", "the best has its name");
        assert!((5..30).contains(&labels.len()), "{}", labels.len());
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
    fn points_without_names_have_no_labels() {
        let mut scatter = scatter();
        scatter
            .points
            .iter_mut()
            .skip(2)
            .for_each(|point| point.name.clear());
        let labels = scatter.labels(&|x, y| ((x * 400.0) as i32, (-libm::log10(y) * 200.0) as i32));
        assert_eq!(labels.len(), 2);
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
