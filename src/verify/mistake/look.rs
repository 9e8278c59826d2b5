//! How pictures are compared: in which size, which pixels differ, and how many of them a mistake may leave.

use rayon::prelude::*;
use toyproof_eval::{Places, Program};
use toyproof_image::{Frame, Image};
use toyproof_scene::{Integrator, Scene};

use super::suspect::{Suspect, paint};
use crate::compare::Pixel;

/// Colours that are farther apart are different. That is less than can be seen: both pictures are painted in double precision.
const SAME: f64 = 1e-3;

/// A mistake explains a picture if it leaves no more than this share of the pixels that were wrong, and of all pixels, another colour:
/// secondary rays of another style shift the edges of shadows and of what mirrors show.
const LEFT_OVER: f64 = 0.05;
const MAX_LEFT_OVER: f64 = 0.005;

/// So many times as many pixels may be left by a mistake that is looked at in other styles of secondary rays, and so many mistakes are.
const NEAR: u64 = 6;
const MOST_NEAR: usize = 8;

/// A ray meets as many surfaces in the time that one unit of work takes.
const SURFACES: usize = 8;

/// A wrong picture of few pixels.
pub(super) struct Looked<'a> {
    /// How many of them are wrong.
    pub(super) differing: u64,
    pub(super) small: &'a Image,
    pub(super) view: &'a View,
}

impl Looked<'_> {
    /// How many pixels a suspect does not explain, if those are few.
    pub(super) fn left(&self, suspect: &Suspect) -> Option<u64> {
        let left = differing(self.small, suspect.picture(self.view)?);
        (left <= left_over(self.differing, self.small.pixels().len())).then_some(left)
    }

    /// Those that leave few pixels more than they may, so that another style of secondary rays might explain these.
    pub(super) fn near<'s>(&self, suspects: impl Iterator<Item = &'s Suspect>) -> Vec<&'s Suspect> {
        let limit = NEAR * left_over(self.differing, self.small.pixels().len()).max(1);
        let near = suspects.filter_map(|suspect| {
            let left = differing(self.small, suspect.picture(self.view)?);
            (left <= limit && left < self.differing).then_some((left, suspect))
        });
        let mut near: Vec<_> = near.collect();
        near.sort_by_key(|&(left, _)| left);
        near.into_iter()
            .map(|(_, suspect)| suspect)
            .take(MOST_NEAR)
            .collect()
    }

    /// Those that explain the picture best, one of each name.
    pub(super) fn matching<'s>(&self, suspects: &'s [Suspect]) -> Vec<&'s Suspect> {
        let all = suspects.par_iter();
        let all: Vec<_> = all
            .filter_map(|suspect| Some((self.left(suspect)?, suspect)))
            .collect();
        let least = all.iter().map(|&(left, _)| left).min();
        let mut best: Vec<&Suspect> = Vec::new();
        for (left, suspect) in all {
            let is_new = best.iter().all(|other| other.names().ne(suspect.names()));
            if Some(left) == least && is_new {
                best.push(suspect);
            }
        }
        best
    }
}

/// A picture of still fewer pixels, in which most suspects are seen not to be it.
pub(super) struct Glance {
    picture: Image,
    view: View,
    /// How many pixels may be left unexplained.
    limit: u64,
}

/// A glance is so many pixels a side at most, and this share of those that are wrong in it, and a few, may be left unexplained.
const GLANCE: u32 = 24;
const GLANCED_OVER: f64 = 0.2;
const A_FEW: u64 = 2;

impl Glance {
    /// None if the shader cannot be painted.
    pub(super) fn at(student: &Program, rights: &[Suspect], view: &View) -> Option<Self> {
        let view = View::of(&view.frame, GLANCE, u64::MAX);
        let picture = paint(student, &view)?;
        let right = rights.first()?.made.paint(&view)?;
        let wrong = differing(&picture, &right);
        Some(Self {
            limit: (wrong as f64 * GLANCED_OVER) as u64 + A_FEW,
            picture,
            view,
        })
    }

    /// Whether a suspect may explain the picture.
    pub(super) fn is_worth_a_look(&self, suspect: &Suspect) -> bool {
        let painted = suspect.made.paint(&self.view);
        painted.is_some_and(|painted| differing(&self.picture, &painted) <= self.limit)
    }
}

/// How many pixels may remain unexplained.
pub(super) fn left_over(differing: u64, pixels: usize) -> u64 {
    let share = (differing as f64 * LEFT_OVER).min(pixels as f64 * MAX_LEFT_OVER);
    share.floor() as u64
}

/// How much work a pixel is.
pub(super) fn work(scene: &Scene) -> u64 {
    let rays = match scene.film.integrator {
        Integrator::Path => 2 * u64::from(scene.film.max_depth),
        Integrator::Whitted => 1,
    };
    // Of a grid, a ray meets the spheres along its way.
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
    let surfaces = surfaces.div_ceil(SURFACES).max(1) as u64;
    u64::from(scene.film.samples) * rays * surfaces
}

pub(super) fn pixels(frame: &Frame) -> u64 {
    frame.size.into_iter().map(u64::from).product()
}

/// Some pixels of a frame, in whole quads from all over it. What they show is what the frame's own picture shows there, in its own size and
/// aspect.
#[derive(Debug, Clone)]
pub(super) struct View {
    pub(super) frame: Frame,
    pub(super) places: Places,
}

impl View {
    /// So many pixels a side at most, and so many in all.
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

/// Whether two pictures are different in a pixel.
pub(super) fn differs(at: usize, one: &Image, other: &Image) -> bool {
    Pixel::at(at, one, other).difference() > SAME
}

/// In how many pixels two pictures are different.
pub(super) fn differing(one: &Image, other: &Image) -> u64 {
    let count = one.pixels().len();
    (0..count).filter(|&at| differs(at, one, other)).count() as u64
}
