//! Outlines of glyphs as line segments, and distances to them.

use ttf_parser::{Face, OutlineBuilder};

/// The height of capital letters, in texels.
const CAPITAL_HEIGHT: f32 = 37.0;
/// The line on which letters stand, in texels from the top of the cell.
const BASELINE: f32 = 50.0;
/// The factor by which glyphs are narrower than the font's, and the distance by which their outlines are
/// moved outwards, in texels. With both, letters have the width and the stems of the site's font.
const NARROWER: f32 = 0.80;
const BOLDER: f32 = 0.55;
/// The number of segments of a curve.
const SEGMENTS: u8 = 4;

/// A point in texels from the top left of a cell, y downwards.
type Point = [f32; 2];

/// A closed outline, whose inside has a winding number other than 0.
#[derive(Debug, Clone, Default)]
pub(super) struct Outline {
    segments: Vec<[Point; 2]>,
    /// The distance by which the outline is moved outwards.
    offset: f32,
}

impl Outline {
    /// Adds a closed polygon.
    pub(super) fn add(&mut self, polygon: &[Point]) {
        let next = polygon.iter().cycle().skip(1);
        self.segments
            .extend(polygon.iter().zip(next).map(|(&a, &b)| [a, b]));
    }

    /// For each texel of a square cell, from the top down: the distance of its center to the outline,
    /// negative inside, and the direction in which it grows fastest. Without segments, the distance is
    /// infinite and the direction zero.
    pub(super) fn distances(&self, cell: usize) -> Vec<(f32, [f32; 2])> {
        /// The side of the blocks of texels that consider the same segments.
        const BLOCK: usize = 8;
        let mut distances = vec![(f32::INFINITY, [0.0; 2]); cell * cell];
        let windings: Vec<_> = (0..cell).map(|y| self.windings(y as f32 + 0.5)).collect();
        for block in 0..(cell / BLOCK) * (cell / BLOCK) {
            let (left, top) = (block % (cell / BLOCK) * BLOCK, block / (cell / BLOCK) * BLOCK);
            let half = BLOCK as f32 / 2.0;
            let near = self.near(
                [left as f32 + half, top as f32 + half],
                half * std::f32::consts::SQRT_2,
            );
            for (y, x) in (top..top + BLOCK).flat_map(|y| (left..left + BLOCK).map(move |x| (y, x))) {
                let center = [x as f32 + 0.5, y as f32 + 0.5];
                let mut nearest = ([0.0; 2], f32::INFINITY);
                for &segment in &near {
                    let vector = to_point(segment, center);
                    if squared(vector) < nearest.1 {
                        nearest = (vector, squared(vector));
                    }
                }
                if nearest.1 == f32::INFINITY {
                    continue;
                }
                let ([dx, dy], length) = (nearest.0, nearest.1.sqrt());
                let winding: i32 = windings[y]
                    .iter()
                    .filter(|(at, _)| *at > center[0])
                    .map(|(_, sign)| sign)
                    .sum();
                let sign = if winding == 0 { 1.0 } else { -1.0 };
                let gradient = if length > 0.0 {
                    [dx, dy].map(|d| sign * d / length)
                } else {
                    [0.0; 2]
                };
                distances[y * cell + x] = (sign * length - self.offset, gradient);
            }
        }
        distances
    }

    /// The segments that may be the nearest to a point within `radius` of a center.
    fn near(&self, center: Point, radius: f32) -> Vec<[Point; 2]> {
        let of_center = |segment: &[Point; 2]| squared(to_point(*segment, center)).sqrt();
        let distances: Vec<_> = self.segments.iter().map(of_center).collect();
        let least = distances.iter().copied().fold(f32::INFINITY, f32::min);
        // A hundredth of a texel is more than the distances are rounded by.
        let most = least + 2.0 * radius + 0.01;
        let segments = self.segments.iter().zip(distances);
        segments
            .filter(|(_, distance)| *distance <= most)
            .map(|(segment, _)| *segment)
            .collect()
    }

    /// Where the outline crosses a row, and how each crossing changes the winding number of points to its
    /// left.
    fn windings(&self, y: f32) -> Vec<(f32, i32)> {
        let crossing = |&[[ax, ay], [bx, by]]: &[Point; 2]| {
            let sign = i32::from(by > y) - i32::from(ay > y);
            (sign != 0).then(|| (ax + (bx - ax) * ((y - ay) / (by - ay)), sign))
        };
        self.segments.iter().filter_map(crossing).collect()
    }
}

/// The vector from the nearest point of a segment to a point.
fn to_point([[ax, ay], [bx, by]]: [Point; 2], [x, y]: Point) -> [f32; 2] {
    let ([px, py], [dx, dy]) = ([x - ax, y - ay], [bx - ax, by - ay]);
    let along = ((px * dx + py * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    [px - along * dx, py - along * dy]
}

fn squared([x, y]: [f32; 2]) -> f32 {
    x * x + y * y
}

/// The outline of a character: on the line of letters, or in the middle of the cell for symbols.
pub(super) fn glyph(face: &Face<'_>, character: char, is_centered: bool) -> Outline {
    let mut pen = Pen::default();
    let outlined = face
        .glyph_index(character)
        .and_then(|glyph| face.outline_glyph(glyph, &mut pen));
    let Some(bounds) = outlined else {
        return Outline::default();
    };
    let capital = face.capital_height().map_or(1493.0, f32::from);
    // The moved outline is higher by twice its offset.
    let scale = (CAPITAL_HEIGHT - 2.0 * BOLDER) / capital;
    let middle = |low: i16, high: i16| 0.5 * (f32::from(low) + f32::from(high));
    let center = middle(bounds.x_min, bounds.x_max);
    let (narrower, base, bolder) = if is_centered {
        (1.0, 31.5 + scale * middle(bounds.y_min, bounds.y_max), 0.0)
    } else {
        (NARROWER, BASELINE - BOLDER, BOLDER)
    };
    let mut outline = Outline {
        offset: bolder,
        ..Outline::default()
    };
    for contour in pen.contours {
        let place = |&[x, y]: &Point| [32.0 + narrower * scale * (x - center), base - scale * y];
        outline.add(&contour.iter().map(place).collect::<Vec<_>>());
    }
    outline
}

/// Collects the contours of a glyph as polygons, in the font's units.
#[derive(Default)]
struct Pen {
    contours: Vec<Vec<Point>>,
}

impl Pen {
    fn push(&mut self, point: Point) {
        let contour = self.contours.last_mut().expect("a contour begins with a move");
        // Segments of length 0 have no direction.
        if contour.last() != Some(&point) {
            contour.push(point);
        }
    }

    fn last(&self) -> Point {
        self.contours
            .last()
            .and_then(|contour| contour.last())
            .copied()
            .unwrap_or_default()
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.contours.push(vec![[x, y]]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.push([x, y]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let start = self.last();
        for step in 1..=SEGMENTS {
            let t = f32::from(step) / f32::from(SEGMENTS);
            let weights = [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
            let at = |a, b, c| weights[0] * a + weights[1] * b + weights[2] * c;
            self.push([at(start[0], x1, x), at(start[1], y1, y)]);
        }
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let start = self.last();
        for step in 1..=SEGMENTS {
            let t = f32::from(step) / f32::from(SEGMENTS);
            let s = 1.0 - t;
            let weights = [s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t];
            let at = |a, b, c, d| weights[0] * a + weights[1] * b + weights[2] * c + weights[3] * d;
            self.push([at(start[0], x1, x2, x), at(start[1], y1, y2, y)]);
        }
    }

    fn close(&mut self) {
        if let Some(contour) = self.contours.last_mut()
            && contour.len() > 1
            && contour.first() == contour.last()
        {
            contour.pop();
        }
    }
}
