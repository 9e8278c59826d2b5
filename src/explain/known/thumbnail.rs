//! Small images of a wrong shader and of mutants, and which mutants explain the wrong image.
//!
//! A [`View`] is a selection of few pixels of a frame. A mutant explains a [`WrongImage`] of that view if the
//! two differ in few pixels. A [`Thumbnail`] has still fewer pixels; it rules out most pairs of mistakes
//! before they are rendered for a view.

use rayon::prelude::*;
use toyproof_eval::Places;
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image};
use toyproof_scene::{Integrator, Scene};
use toyproof_verify::compare::Pixel;

use crate::known::mutant::{Mutant, render};

// Views.

/// Some pixels of a frame, in whole quads spread over it. Each has the color that it has in the frame, in the
/// frame's own size and aspect ratio.
#[derive(Debug, Clone)]
pub(super) struct View {
    pub(super) frame: Frame,
    pub(super) places: Places,
}

impl View {
    /// Selects at most `side` columns and rows, and at most `all` pixels.
    pub(super) fn of(frame: &Frame, side: u32, all: u64) -> Self {
        let [width, height] = frame.size;
        let divided = |divisor: u32| {
            [width, height].map(|own| match own / divisor {
                side if divisor == 1 || side < 2 => side.max(1),
                side => side & !1,
            })
        };
        let is_small = |divisor: &u32| {
            let [width, height] = divided(*divisor);
            width.max(height) <= side && u64::from(width) * u64::from(height) <= all
        };
        let divisor = (1..=width.max(height)).find(is_small).unwrap_or(u32::MAX);
        Self {
            places: Places::spread(frame.size, divided(divisor)),
            frame: frame.clone(),
        }
    }

    pub(super) fn pixels(&self) -> u64 {
        self.places.size().into_iter().map(u64::from).product()
    }
}

/// The number of ray-surface intersections of one unit of work.
const SURFACES_PER_WORK: usize = 8;

/// The work of a pixel.
pub(super) fn cost_per_pixel(scene: &Scene) -> u64 {
    let rays = match scene.film.integrator {
        Integrator::Path => 2 * u64::from(scene.film.max_depth),
        Integrator::Whitted => 1,
    };
    // In a grid, a ray tests only the spheres along its path.
    let in_grids: usize = scene
        .scatters
        .iter()
        .map(|scattered| scattered.objects.len())
        .sum();
    let cells: u32 = scene
        .scatters
        .iter()
        .flat_map(|scattered| scattered.scatter.cells)
        .sum();
    let surfaces = scene.objects.len() - in_grids + cells as usize;
    let surfaces = surfaces.div_ceil(SURFACES_PER_WORK).max(1) as u64;
    u64::from(scene.film.samples) * rays * surfaces
}

pub(super) fn pixels(frame: &Frame) -> u64 {
    frame.size.into_iter().map(u64::from).product()
}

// Differences of images.

/// The largest difference of equal colors. It is invisible: both images are rendered in double precision.
const COLOR_TOLERANCE: f64 = 1e-3;

/// Whether two images differ in a pixel.
pub(super) fn differs(at: usize, one: &Image, other: &Image) -> bool {
    Pixel::at(at, one, other).difference() > COLOR_TOLERANCE
}

/// The number of pixels in which two images differ.
pub(super) fn differing(one: &Image, other: &Image) -> u64 {
    let count = one.pixels().len();
    (0..count).filter(|&at| differs(at, one, other)).count() as u64
}

/// The largest shares of the wrong pixels, and of all pixels, that a mistake may leave unexplained: other ray
/// epsilons shift the edges of shadows and of reflections.
const MAX_UNEXPLAINED_SHARE_OF_WRONG: f64 = 0.05;
const MAX_UNEXPLAINED_SHARE_OF_ALL: f64 = 0.005;

/// The largest number of pixels that may remain unexplained.
pub(super) fn max_unexplained(differing: u64, pixels: usize) -> u64 {
    let share =
        (differing as f64 * MAX_UNEXPLAINED_SHARE_OF_WRONG).min(pixels as f64 * MAX_UNEXPLAINED_SHARE_OF_ALL);
    share.floor() as u64
}

// The wrong image.

/// The factor by which a near miss may exceed the unexplained pixels, and the largest number of near misses
/// that are tried with other ray epsilons.
const NEAR_MISS_FACTOR: u64 = 6;
const MAX_NEAR_MISSES: usize = 8;

/// A wrong image of few pixels.
pub(super) struct WrongImage<'a> {
    /// The number of wrong pixels.
    pub(super) differing: u64,
    pub(super) small: &'a Image,
    pub(super) view: &'a View,
}

impl WrongImage<'_> {
    /// The number of pixels that a mutant does not explain, if they are few.
    pub(super) fn unexplained_pixels(&self, mutant: &Mutant) -> Option<u64> {
        let unexplained_pixels = differing(self.small, mutant.image(self.view)?);
        (unexplained_pixels <= max_unexplained(self.differing, self.small.pixels().len()))
            .then_some(unexplained_pixels)
    }

    /// Returns near misses: mutants that leave few pixels more than they may, which other ray epsilons might
    /// explain.
    pub(super) fn near_misses<'s>(&self, mutants: impl Iterator<Item = &'s Mutant>) -> Vec<&'s Mutant> {
        let limit = NEAR_MISS_FACTOR * max_unexplained(self.differing, self.small.pixels().len()).max(1);
        let near_misses = mutants.filter_map(|mutant| {
            let unexplained_pixels = differing(self.small, mutant.image(self.view)?);
            (unexplained_pixels <= limit && unexplained_pixels < self.differing)
                .then_some((unexplained_pixels, mutant))
        });
        let mut near_misses: Vec<_> = near_misses.collect();
        near_misses.sort_by_key(|&(unexplained_pixels, _)| unexplained_pixels);
        near_misses
            .into_iter()
            .map(|(_, mutant)| mutant)
            .take(MAX_NEAR_MISSES)
            .collect()
    }

    /// Returns the mutants that explain the image best, one of each id.
    pub(super) fn matching<'s>(&self, mutants: &'s [Mutant]) -> Vec<&'s Mutant> {
        let all = mutants.par_iter();
        let all: Vec<_> = all
            .filter_map(|mutant| Some((self.unexplained_pixels(mutant)?, mutant)))
            .collect();
        let least = all
            .iter()
            .map(|&(unexplained_pixels, _)| unexplained_pixels)
            .min();
        let mut best: Vec<&Mutant> = Vec::new();
        for (unexplained_pixels, mutant) in all {
            let is_new = best.iter().all(|other| other.ids().ne(mutant.ids()));
            if Some(unexplained_pixels) == least && is_new {
                best.push(mutant);
            }
        }
        best
    }
}

// Thumbnails.

/// The largest width and height of a thumbnail, and the share of its wrong pixels, plus a constant number,
/// that may be left unexplained.
const THUMBNAIL_SIDE: u32 = 24;
const THUMBNAIL_LEFT_OVER: f64 = 0.2;
const THUMBNAIL_EXTRA: u64 = 2;

/// An image of still fewer pixels, which rules out most mutants.
pub(super) struct Thumbnail {
    image: Image,
    view: View,
    /// The largest number of pixels that may be left unexplained.
    limit: u64,
}

impl Thumbnail {
    /// Renders a thumbnail of the student's shader; `None` if that fails.
    pub(super) fn render(student: &Program, correct_images: &[Mutant], view: &View) -> Option<Self> {
        let view = View::of(&view.frame, THUMBNAIL_SIDE, u64::MAX);
        let image = render(student, &view)?;
        let correct = correct_images.first()?.source.render(&view)?;
        let wrong = differing(&image, &correct);
        Some(Self {
            limit: (wrong as f64 * THUMBNAIL_LEFT_OVER) as u64 + THUMBNAIL_EXTRA,
            image,
            view,
        })
    }

    /// Whether a mutant may explain the image.
    pub(super) fn may_explain(&self, mutant: &Mutant) -> bool {
        let rendered = mutant.source.render(&self.view);
        rendered.is_some_and(|rendered| differing(&self.image, &rendered) <= self.limit)
    }
}
