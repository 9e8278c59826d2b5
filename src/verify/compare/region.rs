//! Connected regions of pixels, such as differing ones: a missing object is one, rays that graze edges
//! are not.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::compare::PixelStatus;

/// The side of the smallest block of pixels that is a compact region.
const MIN_SIDE: u32 = 3;

/// The regions of an image in which pixels have a status, such as differing. Pixels that share an edge or a
/// corner are connected.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Regions {
    /// The number of regions.
    pub count: u64,
    /// The largest region; of equal ones the first, bottom row first.
    pub largest: Option<Region>,
    /// The largest compact region, an area and not a line: it contains a block of 3×3 pixels, or has at least
    /// as many and fills half of its rectangle, as a small disk does.
    pub largest_compact: Option<Region>,
}

/// A connected region: its number of pixels, and the rectangle that encloses it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Region {
    /// The number of pixels.
    pub pixels: u64,
    /// The leftmost column.
    pub x: u32,
    /// The bottom row.
    pub y: u32,
    /// The number of columns.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
}

impl Region {
    /// Whether the region is as large as a small disk and fills half of its rectangle.
    fn is_disk(&self) -> bool {
        let area = u64::from(self.width) * u64::from(self.height);
        self.width.min(self.height) >= MIN_SIDE
            && self.pixels >= u64::from(MIN_SIDE * MIN_SIDE)
            && 2 * self.pixels >= area
    }

    /// The pixel in the middle of its rectangle.
    #[must_use]
    pub fn middle(&self) -> [u32; 2] {
        [self.x + self.width / 2, self.y + self.height / 2]
    }
}

impl Regions {
    /// Finds the regions of the pixels with this status in an image that many pixels wide, bottom row first.
    #[must_use]
    pub fn new(status: PixelStatus, statuses: &[PixelStatus], width: u32) -> Self {
        let mut regions = Self::default();
        let mut search = Search {
            status,
            statuses,
            width: i64::from(width),
            is_visited: vec![false; statuses.len()],
        };
        for at in 0..statuses.len() {
            if let Some((region, has_block)) = search.region(at) {
                regions.count += 1;
                let keep_larger = |largest: &mut Option<Region>| {
                    if largest.is_none_or(|largest| region.pixels > largest.pixels) {
                        *largest = Some(region);
                    }
                };
                keep_larger(&mut regions.largest);
                if has_block || region.is_disk() {
                    keep_larger(&mut regions.largest_compact);
                }
            }
        }
        regions
    }
}

/// A search for the regions of an image.
struct Search<'a> {
    status: PixelStatus,
    statuses: &'a [PixelStatus],
    width: i64,
    is_visited: Vec<bool>,
}

impl Search<'_> {
    /// The index of a pixel with the status.
    fn index(&self, [x, y]: [i64; 2]) -> Option<usize> {
        let is_inside = (0..self.width).contains(&x) && y >= 0;
        let at = is_inside.then_some((y * self.width + x) as usize)?;
        (self.statuses.get(at) == Some(&self.status)).then_some(at)
    }

    /// The region of a pixel that has the status and has not been visited, and whether it contains a block of
    /// 3×3 pixels.
    fn region(&mut self, first: usize) -> Option<(Region, bool)> {
        if self.is_visited[first] || self.statuses[first] != self.status {
            return None;
        }
        self.is_visited[first] = true;
        // First in, first out: the edge of the visited pixels is much shorter than a path through them.
        let mut left = VecDeque::from([first]);
        let mut pixels = 0;
        let (mut low, mut high) = ([i64::MAX; 2], [i64::MIN; 2]);
        let mut has_block = false;
        while let Some(at) = left.pop_front() {
            let [x, y] = [at as i64 % self.width, at as i64 / self.width];
            pixels += 1;
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
            let neighbors = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [x + dx, y + dy]));
            let mut connected = 0;
            for neighbor in neighbors {
                let Some(neighbor) = self.index(neighbor) else {
                    continue;
                };
                connected += 1;
                if !self.is_visited[neighbor] {
                    self.is_visited[neighbor] = true;
                    left.push_back(neighbor);
                }
            }
            has_block |= connected == MIN_SIDE * MIN_SIDE;
        }
        let region = Region {
            pixels,
            x: low[0] as u32,
            y: low[1] as u32,
            width: (high[0] - low[0] + 1) as u32,
            height: (high[1] - low[1] + 1) as u32,
        };
        Some((region, has_block))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The regions of an image drawn with `#` for pixels that differ, top row first.
    fn regions(rows: &[&str]) -> Regions {
        let pixels = rows.iter().rev().flat_map(|row| row.bytes());
        let statuses: Vec<_> = pixels
            .map(|byte| match byte {
                b'#' => PixelStatus::Differs,
                _ => PixelStatus::IllConditioned,
            })
            .collect();
        Regions::new(PixelStatus::Differs, &statuses, rows[0].len() as u32)
    }

    #[test]
    fn pixels_that_share_a_corner_are_connected() {
        let found = regions(&["#..#", ".#..", "...#"]);
        let largest = found.largest.unwrap();
        assert_eq!((found.count, largest.pixels), (3, 2));
        assert_eq!(
            [largest.x, largest.y, largest.width, largest.height],
            [0, 1, 2, 2]
        );
        assert_eq!(found.largest_compact, None);
        assert_eq!(regions(&["....", "...."]), Regions::default());
        // The last pixel of a row is not next to the first one of the row above.
        assert_eq!(regions(&["#...", "...#"]).count, 2);
    }

    #[test]
    fn areas_are_compact_and_lines_are_not() {
        let is_compact = |rows: &[&str]| regions(rows).largest_compact.is_some();
        assert!(is_compact(&["###", "###", "###"]));
        assert!(is_compact(&[".##.", "####", "####", ".##."]));
        // A disk at the end of a line.
        assert!(is_compact(&["###......", "#########", "###......", "........."]));
        assert!(!is_compact(&["##########", "##########"]));
        assert!(!is_compact(&["###", "#.#", "##."]));
        // The rim of a disk, and a diagonal that is two pixels wide.
        assert!(!is_compact(&[
            ".####.", "#....#", "#....#", "#....#", "#....#", ".####."
        ]));
        assert!(!is_compact(&[
            "##....", "###...", ".###..", "..###.", "...###", "....##"
        ]));
    }

    #[test]
    fn the_largest_compact_region_may_be_smaller_than_the_largest() {
        let found = regions(&["###..........", "###.#########", "###.........#"]);
        let sizes = [found.largest, found.largest_compact].map(|region| region.unwrap().pixels);
        assert_eq!((found.count, sizes), (2, [10, 9]));
        assert_eq!(found.largest_compact.unwrap().middle(), [1, 1]);
    }
}
