//! Detects rays that hit the surface they start from (“acne”). Rounding decides it in each pixel, so that it
//! resembles a lack of precision; where double precision has it too, more precision does not help.

use rayon::prelude::*;
use toyproof_scene::Sampler;
use toyproof_tracer::{RayEpsilons, Tracer};

use crate::compare::{CheckResult, PixelStatus, Share};
use crate::evidence::SelfIntersection;
use crate::limits::MAX_UNSTABLE;

/// The largest number of pixels that are examined.
const MAX_PIXELS: usize = 64;

/// The share of the examined pixels that must have the color that the tracer renders with rays that hit their
/// own surface. The share is below 1 because a ray between mirrors may do so more often than is traced.
const MIN_EXPLAINED_SHARE: f64 = 0.4;

/// The same share in double precision, where no other effect of rounding reaches it.
const MIN_EXPLAINED_SHARE_IN_DOUBLE: f64 = 0.3;

/// The smallest share of pixels that differ in float32 alone; fewer may be a lack of precision at silhouettes
/// and at the rim of glass.
const MIN_SHARE_IN_SINGLE: f64 = 0.01;

/// The tolerance of colors, in float32 too.
const COLOR_TOLERANCE: f64 = 4.0 / 255.0;

/// Returns the pixels that differ in the check in which most do because rays hit the surfaces they start
/// from, if there is one.
pub(super) fn detect(
    tracer: &Tracer<f64>,
    size: [u32; 2],
    algorithm: Option<&CheckResult>,
    precision: Option<&CheckResult>,
) -> Option<SelfIntersection> {
    let epsilons = tracer.acne();
    if epsilons.is_empty() {
        return None;
    }
    // In f64, rounding decides the color where there is acne, and not where there is another mistake.
    let decided_by_rounding =
        |check: &&CheckResult| check.summary.ill_conditioned - check.summary.tied > check.summary.differing;
    let in_double = algorithm.filter(decided_by_rounding).map(|check| Candidate {
        check,
        in_double: true,
        min_share: MAX_UNSTABLE,
        min_explained: MIN_EXPLAINED_SHARE_IN_DOUBLE,
    });
    let in_single = precision.map(|check| Candidate {
        check,
        in_double: false,
        min_share: MIN_SHARE_IN_SINGLE,
        min_explained: MIN_EXPLAINED_SHARE,
    });
    let mut candidates = in_double.into_iter().chain(in_single);
    candidates.find_map(|candidate| candidate.detect(tracer, size, &epsilons))
}

/// A check whose differences may be caused by self-intersection.
struct Candidate<'a> {
    check: &'a CheckResult,
    in_double: bool,
    /// The smallest share of differing pixels.
    min_share: f64,
    /// The smallest share of the examined pixels that self-intersection must explain.
    min_explained: f64,
}

impl Candidate<'_> {
    fn detect(
        &self,
        tracer: &Tracer<f64>,
        size: [u32; 2],
        epsilons: &[RayEpsilons],
    ) -> Option<SelfIntersection> {
        let summary = &self.check.summary;
        let count = summary.differing + summary.ill_conditioned - summary.tied;
        let differing = Share::new(summary, count);
        if differing.ratio() <= self.min_share {
            return None;
        }
        let pixels: Vec<DifferingPixel> = pixels_to_examine(self.check, size)
            .into_par_iter()
            .filter_map(|pixel| DifferingPixel::new(tracer, self.check, size, pixel))
            .collect();
        let explained = pixels.par_iter().filter(|pixel| pixel.is_acne(tracer, epsilons));
        let is_explained = explained.count() as f64 >= self.min_explained * pixels.len() as f64;
        (is_explained && !pixels.is_empty()).then_some(SelfIntersection {
            pixels: differing,
            in_double: self.in_double,
        })
    }
}

/// Returns ill-conditioned pixels spread over the image, or else differing ones, of those whose colors are
/// kept.
fn pixels_to_examine(check: &CheckResult, size: [u32; 2]) -> Vec<[u32; 2]> {
    let is_ill_conditioned = check.statuses.contains(&PixelStatus::IllConditioned);
    let status = if is_ill_conditioned {
        PixelStatus::IllConditioned
    } else {
        PixelStatus::Differs
    };
    let mut kept: Vec<usize> = check.actual.keys().copied().collect();
    kept.retain(|&at| check.statuses[at] == status);
    kept.sort_unstable();
    let step = kept.len().div_ceil(MAX_PIXELS).max(1);
    let place = |&at: &usize| [at as u32 % size[0], at as u32 / size[0]];
    kept.iter().step_by(step).map(place).collect()
}

/// A pixel that differs visibly from the scene's. Colors are clamped to [0, 1].
struct DifferingPixel {
    pixel: [u32; 2],
    /// The shader's color.
    actual: [f64; 3],
    /// The scene's color.
    exact: [f64; 3],
}

impl DifferingPixel {
    /// `None` if the pixel has the scene's color, or the shader's color is not kept.
    fn new(tracer: &Tracer<f64>, check: &CheckResult, size: [u32; 2], pixel: [u32; 2]) -> Option<Self> {
        let [x, y] = pixel;
        let actual = check.actual.get(&(y as usize * size[0] as usize + x as usize))?;
        let actual = actual.map(|part| f64::from(part).clamp(0.0, 1.0));
        let exact = tracer.pixel(x, y).map(|part| part.clamp(0.0, 1.0));
        (0..3)
            .any(|i| !is_near(actual[i], exact[i]))
            .then_some(Self { pixel, actual, exact })
    }

    /// Whether its color comes from rays that hit their own surface, in all of its samples or in some.
    fn is_acne(&self, tracer: &Tracer<f64>, epsilons: &[RayEpsilons]) -> bool {
        let Self { actual, exact, .. } = self;
        // If lights and BRDFs are also sampled, an intermediate color proves nothing.
        let is_jittered = tracer.sampler() == Some(Sampler::SineHash);
        epsilons.iter().any(|epsilons| {
            let other = tracer
                .pixel_with_epsilons(self.pixel, epsilons)
                .map(|part| part.clamp(0.0, 1.0));
            let is_mixed = |i: usize| {
                let (least, most) = (other[i].min(exact[i]), other[i].max(exact[i]));
                is_jittered && (least - COLOR_TOLERANCE..=most + COLOR_TOLERANCE).contains(&actual[i])
            };
            (0..3).all(|i| is_near(actual[i], other[i]) || is_mixed(i))
        })
    }
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= COLOR_TOLERANCE
}
