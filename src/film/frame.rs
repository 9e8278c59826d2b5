//! A frame as displayed.

use std::ops::Range;

use toyproof_image::{Image, quantize};

/// A frame in 8 bits for each of red, green, blue and alpha, top row first. Colors are not multiplied by
/// alpha.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct DisplayFrame {
    pub(crate) size: [u32; 2],
    pub(crate) pixels: Vec<[u8; 4]>,
}

/// A rectangle of pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub(crate) columns: Range<u32>,
    pub(crate) rows: Range<u32>,
}

impl DisplayFrame {
    /// The values of an image as it is displayed, or with its own alpha.
    pub(crate) fn new(image: &Image, keeps_alpha: bool) -> Self {
        let value = |&[r, g, b, a]: &[f32; 4]| {
            let [r, g, b] = [r, g, b].map(quantize);
            [r, g, b, if keeps_alpha { quantize(a) } else { u8::MAX }]
        };
        Self {
            size: image.size(),
            pixels: image.rows().rev().flatten().map(value).collect(),
        }
    }

    /// The rows, from the top down.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[[u8; 4]]> {
        self.pixels.chunks(self.size[0] as usize)
    }
}

/// The smallest rectangle that contains all pixels in which two images of one width differ; `None` if they
/// are equal.
pub(crate) fn changed<T: PartialEq>(before: &[T], after: &[T], width: u32) -> Option<Rectangle> {
    let width = width as usize;
    let pairs = before.chunks(width).zip(after.chunks(width));
    let mut found: Option<Rectangle> = None;
    for (row, (before, after)) in pairs.enumerate() {
        if before == after {
            continue;
        }
        let differs = |&column: &usize| before[column] != after[column];
        let first = (0..width).find(differs).unwrap_or(0) as u32;
        let end = (0..width).rfind(differs).map_or(width, |last| last + 1) as u32;
        let row = row as u32;
        match &mut found {
            None => {
                found = Some(Rectangle {
                    columns: first..end,
                    rows: row..row + 1,
                });
            }
            Some(Rectangle { columns, rows }) => {
                *columns = columns.start.min(first)..columns.end.max(end);
                rows.end = row + 1;
            }
        }
    }
    found
}

impl Rectangle {
    /// Copies the part of an image of this width.
    pub(crate) fn part<T: Copy>(&self, pixels: &[T], width: u32) -> Vec<T> {
        let row = |row: u32| {
            let first = row as usize * width as usize;
            &pixels[first + self.columns.start as usize..first + self.columns.end as usize]
        };
        self.rows.clone().flat_map(row).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_run_down_and_values_are_rounded_to_even() {
        let image = Image::new(1, 2, vec![[0.5, f32::NAN, 2.0, 0.5], [-1.0, 1.0, 0.1, 0.0]]);
        let frame = DisplayFrame::new(&image, true);
        assert_eq!(frame.pixels, [[0, 255, 26, 0], [128, 0, 255, 128]]);
        let opaque = DisplayFrame::new(&image, false);
        assert_eq!(opaque.pixels[0], [0, 255, 26, 255]);
    }

    #[test]
    fn the_changed_rectangle_contains_all_changes_and_no_more() {
        let before = [0; 20];
        let mut after = before;
        assert_eq!(changed(&before, &after, 5), None);
        (after[7], after[13]) = (1, 2);
        let rectangle = changed(&before, &after, 5).unwrap();
        assert_eq!((rectangle.columns.clone(), rectangle.rows.clone()), (2..4, 1..3));
        assert_eq!(rectangle.part(&after, 5), [1, 0, 0, 2]);
    }
}
