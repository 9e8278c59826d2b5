//! Two pictures, pixel by pixel, and what their difference means.

mod judge;
mod tolerance;

use rayon::prelude::*;
use serde::Serialize;

pub use judge::{MAX_DIFFERING, MAX_UNDECIDED, Verdict, judge};
pub use tolerance::TOLERANCE;

use crate::image::{Image, Mark, quantise};
use crate::trace::Hull;

/// What two pictures differ by. Colours are compared clamped to [0, 1]; NaN equals NaN, and differs from
/// everything else by 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Pixels in the picture.
    pub pixels: u64,
    /// Pixels in which some component differs by more than [`TOLERANCE`], and that are decided.
    pub differing: u64,
    /// Pixels that differ by more than that, but within what the reference may itself be in float32.
    pub undecided: u64,
    /// Pixels that differ when both are rounded to 8 bits.
    pub differing_8bit: u64,
    /// The largest difference in 8-bit levels.
    pub max_8bit: u8,
    /// The largest absolute difference of a component, in [0, 1].
    pub max_abs: f64,
    /// The mean absolute difference over all components.
    pub mean_abs: f64,
    /// The first differing pixel: lowest y, then lowest x; if none differs, the first undecided.
    pub first: Option<Pixel>,
    /// The pixel with the largest difference among those.
    pub worst: Option<Pixel>,
}

/// One pixel in both pictures, RGB as it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pixel {
    /// From the left, from 0.
    pub x: u32,
    /// From the bottom, from 0.
    pub y: u32,
    /// In the reference.
    pub expected: [f32; 3],
    /// In the picture that is judged.
    pub actual: [f32; 3],
}

/// How a pixel stands to its reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Standing {
    Agrees,
    Undecided,
    Differs,
}

/// Compares `actual` with `reference`, which have the same size. `hull` gives the colours that the reference may
/// have at (x, y); it is asked only where the two differ.
///
/// Also gives what the difference picture shows for each pixel.
///
/// # Panics
/// If the sizes differ.
pub fn compare(
    reference: &Image,
    actual: &Image,
    hull: Option<&(dyn Fn(u32, u32) -> Hull + Sync)>,
) -> (Comparison, Vec<Mark>) {
    assert_eq!(reference.size(), actual.size());
    let [width, height] = reference.size();
    let standings: Vec<(Standing, f64)> = (0..height)
        .into_par_iter()
        .flat_map_iter(|y| {
            (0..width).map(move |x| {
                let (expected, actual) = (rgb(reference, x, y), rgb(actual, x, y));
                let difference = difference(expected, actual);
                let standing = if difference <= TOLERANCE {
                    Standing::Agrees
                } else if hull.is_some_and(|hull| hull(x, y).distance(actual.map(f64::from)) <= TOLERANCE) {
                    Standing::Undecided
                } else {
                    Standing::Differs
                };
                (standing, difference)
            })
        })
        .collect();
    let place = |index: usize| {
        let (x, y) = (index as u32 % width, index as u32 / width);
        Pixel {
            x,
            y,
            expected: rgb(reference, x, y),
            actual: rgb(actual, x, y),
        }
    };
    let count = |standing| standings.iter().filter(|(s, _)| *s == standing).count() as u64;
    let differing = count(Standing::Differs);
    let told = if differing > 0 {
        Standing::Differs
    } else {
        Standing::Undecided
    };
    let mut told = standings.iter().enumerate().filter(|(_, (s, _))| *s == told);
    let first = told.clone().next();
    let worst = told
        .by_ref()
        .max_by(|(i, (_, a)), (j, (_, b))| a.total_cmp(b).then(j.cmp(i)));
    let levels = (0..standings.len()).map(|index| {
        let pixel = place(index);
        let levels = |i: usize| quantise(pixel.expected[i]).abs_diff(quantise(pixel.actual[i]));
        levels(0).max(levels(1)).max(levels(2))
    });
    let (differing_8bit, max_8bit) = levels.fold((0, 0), |(count, max), level| {
        (count + u64::from(level > 0), max.max(level))
    });
    let comparison = Comparison {
        pixels: standings.len() as u64,
        differing,
        undecided: count(Standing::Undecided),
        differing_8bit,
        max_8bit,
        max_abs: standings.iter().map(|(_, d)| *d).fold(0.0, f64::max),
        mean_abs: mean_absolute(reference, actual),
        first: first.map(|(index, _)| place(index)),
        worst: worst.map(|(index, _)| place(index)),
    };
    let marks = standings
        .into_iter()
        .map(|(standing, difference)| match standing {
            Standing::Undecided => Mark::Undecided,
            Standing::Agrees | Standing::Differs => Mark::By(difference as f32),
        })
        .collect();
    (comparison, marks)
}

fn rgb(image: &Image, x: u32, y: u32) -> [f32; 3] {
    let [r, g, b, _] = image.get(x, y);
    [r, g, b]
}

/// The largest difference of a component.
fn difference(a: [f32; 3], b: [f32; 3]) -> f64 {
    (0..3)
        .map(|i| component_difference(a[i], b[i]))
        .fold(0.0, f64::max)
}

fn component_difference(a: f32, b: f32) -> f64 {
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (f64::from(a).clamp(0.0, 1.0) - f64::from(b).clamp(0.0, 1.0)).abs(),
        _ => 1.0,
    }
}

fn mean_absolute(a: &Image, b: &Image) -> f64 {
    let components = |image: &Image| -> Vec<f32> {
        image
            .pixels()
            .iter()
            .flat_map(|&[r, g, b, _]| [r, g, b])
            .collect()
    };
    let (a, b) = (components(a), components(b));
    let sum: f64 = a.iter().zip(&b).map(|(&a, &b)| component_difference(a, b)).sum();
    sum / a.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(pixels: &[[f32; 3]]) -> Image {
        let pixels: Vec<_> = pixels.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
        Image::new(pixels.len() as u32 / 2, 2, pixels)
    }

    #[test]
    fn equal_pictures_differ_in_nothing() {
        let a = image(&[[0.1, 0.2, 0.3], [f32::NAN, 2.0, -1.0], [0.0; 3], [1.0; 3]]);
        let b = image(&[[0.1, 0.2, 0.3], [f32::NAN, 7.0, -0.0], [0.0; 3], [1.0; 3]]);
        let (comparison, _) = compare(&a, &b, None);
        assert_eq!(
            (
                comparison.differing,
                comparison.max_abs,
                comparison.differing_8bit
            ),
            (0, 0.0, 0)
        );
        assert_eq!((comparison.first, comparison.worst), (None, None));
    }

    #[test]
    fn first_and_worst_are_found_from_the_bottom_left() {
        let a = image(&[[0.0; 3]; 4]);
        let b = image(&[[0.0; 3], [0.0, 0.1, 0.0], [0.9, 0.0, 0.0], [0.9, 0.0, 0.0]]);
        let (comparison, marks) = compare(&a, &b, None);
        let at = |pixel: Option<Pixel>| pixel.map(|pixel| (pixel.x, pixel.y));
        assert_eq!(comparison.differing, 3);
        assert_eq!(at(comparison.first), Some((1, 0)));
        assert_eq!(at(comparison.worst), Some((0, 1)), "the first of equals");
        assert_eq!(comparison.max_8bit, 230);
        assert!((comparison.mean_abs - 1.9 / 12.0).abs() < 1e-7);
        assert_eq!(marks[0], Mark::By(0.0));
    }

    #[test]
    fn a_pixel_within_the_hull_is_undecided_and_one_outside_differs() {
        let a = image(&[[0.0; 3]; 2]);
        let b = image(&[[0.5; 3], [0.8; 3]]);
        let hull = |_, _| Hull {
            low: [0.0; 3],
            high: [0.6; 3],
        };
        let (comparison, marks) = compare(&a, &b, Some(&hull));
        assert_eq!((comparison.undecided, comparison.differing), (1, 1));
        assert_eq!(marks[0], Mark::Undecided);
        assert_eq!(comparison.first.map(|pixel| pixel.y), Some(1));
    }

    #[test]
    fn nan_differs_from_every_number() {
        let (comparison, _) = compare(&image(&[[0.0; 3]; 2]), &image(&[[f32::NAN; 3], [0.0; 3]]), None);
        assert_eq!((comparison.differing, comparison.max_abs), (1, 1.0));
    }
}
