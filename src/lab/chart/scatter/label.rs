//! Names beside their points.

use super::{LETTERS, Point, SIZE, Scatter};

/// Left, top, right and bottom, in pixels.
type Area = [i32; 4];
type Pixel = (i32, i32);

/// Squared distances that differ by less look alike, in pixels.
const SLACK: i32 = 8;

/// A name and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Label {
    pub(super) name: String,
    /// Its end at the point's side.
    pub(super) at: Pixel,
    pub(super) point: Pixel,
}

impl Label {
    /// Whether it stands at the left of its point.
    pub(super) fn is_left(&self) -> bool {
        self.at.0 < self.point.0
    }

    fn around(&self) -> Area {
        let (x, y) = self.at;
        let width = LETTERS * self.name.chars().count() as i32;
        let left = if self.is_left() { x - width } else { x };
        [left, y - LETTERS / 2, left + width, y + LETTERS / 2]
    }
}

impl Scatter {
    /// Names beside their points, as many as have room, the best first: none covers another, a point, the front or what else is `taken`, and
    /// none stands nearer to another's point than to its own. One of the front, whose points are larger, may stand as near to both.
    pub(super) fn labels(&self, place: &impl Fn(f64, f64) -> Pixel, mut taken: Vec<Area>) -> Vec<Label> {
        let pixel = |point: &Point| place(point.x, point.y);
        let dots: Vec<Pixel> = self.points.iter().map(pixel).collect();
        taken.extend(dots.iter().map(|&dot| square(dot, 6)));
        // The legend's corner.
        taken.push([self.legend_left(), 0, SIZE.0 as i32, self.legend_bottom()]);
        let mut front: Vec<Pixel> = self.points.iter().filter(|point| point.best).map(pixel).collect();
        front.sort_unstable();
        taken.extend(front.windows(2).flat_map(|ends| along(ends[0], ends[1])));
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
                    && !taken.iter().any(|other| overlap(&around, other))
                    && !dots
                        .iter()
                        .any(|&dot| squared_distance(dot, &around) + slack < distance)
                    && !labels.iter().any(|other| {
                        let mut leader = along(own, label.at);
                        leader.any(|piece| overlap(&piece, &other.around()))
                    })
            };
            if let Some(label) = places(&point.name, own).find(is_free) {
                taken.push(label.around());
                taken.extend(along(own, label.at));
                labels.push(label);
            }
        }
        labels
    }
}

/// Where a point's name may stand, the nearest first.
fn places(name: &str, (x, y): Pixel) -> impl Iterator<Item = Label> {
    [0, -1, 1, -2, 2, -3, 3, -4, 4].into_iter().flat_map(move |row| {
        let y_of_row = y + row * (LETTERS + 4);
        let beside = [14, -14].into_iter();
        // In another row it may begin or end at the point itself.
        let above_or_below = [1, -1].into_iter().filter(move |_| row != 0);
        beside.chain(above_or_below).map(move |dx| Label {
            name: name.to_owned(),
            at: (x + dx, y_of_row),
            point: (x, y),
        })
    })
}

/// Small boxes along a line.
fn along((ax, ay): Pixel, (bx, by): Pixel) -> impl Iterator<Item = Area> {
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
    use super::super::tests::scatter;
    use super::*;

    fn place(x: f64, y: f64) -> Pixel {
        ((x * 400.0) as i32, (-libm::log10(y) * 200.0) as i32)
    }

    #[test]
    fn labels_never_overlap_and_the_best_has_its_own() {
        let labels = scatter().labels(&place, Vec::new());
        for (i, one) in labels.iter().enumerate() {
            let covers = |other: &Label| overlap(&one.around(), &other.around());
            assert!(!labels[..i].iter().any(covers), "{one:?}");
        }
        assert_eq!(labels[0].name, "way 30", "the best has its name");
        assert!((5..30).contains(&labels.len()), "{}", labels.len());
    }

    #[test]
    fn no_label_stands_nearer_to_another_point() {
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
    fn the_front_and_what_is_taken_are_left_free() {
        let mut scatter = scatter();
        for point in &mut scatter.points {
            point.best = true;
        }
        let taken = [500, 0, 620, 960];
        for label in scatter.labels(&place, vec![taken]) {
            assert!(!overlap(&label.around(), &taken), "{label:?}");
            let ends = scatter.points.windows(2);
            let mut front =
                ends.flat_map(|pair| along(place(pair[0].x, pair[0].y), place(pair[1].x, pair[1].y)));
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
