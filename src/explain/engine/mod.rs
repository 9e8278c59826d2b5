//! The search engine: one way to find what explains a wrong image, whether it is a known mistake, a
//! difference of the whole image, or an edit of the text.
//!
//! Hypotheses are rendered at a few [`probes`], whose colors they must have; a [`tournament`] rejects most of
//! them at the first probes, and a [`fit`] finds their numbers. What is left is confirmed on whole images
//! ([`confirm`]). Work is counted, see [`budget`], so that results do not depend on the machine.

pub(crate) mod bias;
pub(crate) mod budget;
pub(crate) mod confirm;
pub(crate) mod fit;
pub(crate) mod probes;
pub(crate) mod tournament;

use std::ops::Range;

use rayon::prelude::*;
use toyproof_image::Image;

use self::probes::Probes;

/// The numbers of a hypothesis that are searched for; most have at most one.
pub(crate) type Numbers = [f64; 3];

/// The numbers of a hypothesis that has one.
pub(crate) fn one(number: f64) -> Numbers {
    [number, 0.0, 0.0]
}

/// Colors at probes.
pub(crate) type Colors = Vec<[f64; 3]>;

/// A hypothesis, with its numbers, at some of the probes.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    /// Its place in the field; `None` for the image without any of them.
    pub(crate) hypothesis: Option<usize>,
    pub(crate) numbers: Numbers,
    pub(crate) probes: Range<usize>,
}

/// Hypotheses that are rendered side by side.
pub(crate) trait Field {
    /// The colors of each run at its probes; `None` if a limit is exceeded there.
    fn colors(&mut self, probes: &Probes, runs: &[Run]) -> Vec<Option<Colors>>;

    /// The colors of one run.
    fn run(&mut self, probes: &Probes, run: Run) -> Option<Colors> {
        self.colors(probes, &[run]).pop()?
    }
}

/// What may explain a wrong image.
pub(crate) trait Hypothesis: Sync {
    /// What is reported once it is confirmed.
    type Confirmed;

    /// Renders the probes as they are if it is true, with its numbers; `None` if that fails.
    fn colors(&self, probes: &Probes, numbers: &Numbers) -> Option<Colors>;

    /// Confirms it, with its numbers, on larger images.
    fn confirm(&self, numbers: &Numbers) -> Option<Self::Confirmed>;
}

/// Hypotheses that are rendered one by one.
impl<H: Hypothesis> Field for &[H] {
    fn colors(&mut self, probes: &Probes, runs: &[Run]) -> Vec<Option<Colors>> {
        let color = |run: &Run| self[run.hypothesis?].colors(&probes.part(run.probes.clone()), &run.numbers);
        runs.par_iter().map(color).collect()
    }
}

/// Whether two colors, clamped to [0, 1], differ by more than a tolerance.
pub(crate) fn differ(one: [f64; 3], other: [f64; 3], tolerance: f64) -> bool {
    one.into_iter().zip(other).any(|(a, b)| {
        let is_same = (a.clamp(0.0, 1.0) - b.clamp(0.0, 1.0)).abs() <= tolerance;
        !(is_same || a.is_nan() && b.is_nan())
    })
}

/// The colors of an image's pixels.
pub(crate) fn colors_of(image: &Image) -> Colors {
    image
        .pixels()
        .iter()
        .map(|&[r, g, b, _]| [r, g, b].map(f64::from))
        .collect()
}
