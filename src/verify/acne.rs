//! Rays that meet the surface that they start from: “acne”. Rounding decides in each pixel whether they do, so that it looks like a lack
//! of digits; but no number of digits helps, and it is a mistake.

use rayon::prelude::*;
use toyproof_scene::Sampler;
use toyproof_tracer::{RayStyles, Tracer};

use super::Asked;
use crate::compare::{Answer, MAX_UNSTABLE, Standing, grouped};
use crate::mistake::Named;

/// So many pixels are looked at.
const ASKED: usize = 64;

/// So large a share of them must be what the tracer makes of rays that meet their own surface: where mirrors see each other, a ray may do so
/// more often than is looked at. In double precision nothing else that rounding decides is seen in so many pixels.
const MOST: f64 = 0.4;
const MOST_IN_DOUBLE: f64 = 0.3;

/// In float32 alone, fewer pixels than this may be a lack of digits at edges and at the rim of glass.
const LEAST_IN_SINGLE: f64 = 0.01;

/// Colors that are no farther apart are the same: of float32, too.
const SAME: f64 = 4.0 / 255.0;

/// The check in which pixels differ since rays meet the surfaces that they start from, if most that differ do so for this reason.
pub(super) fn is_seen<'a>(
    tracer: &Tracer<f64>,
    size: [u32; 2],
    maths: Option<&'a Asked>,
    rounding: Option<&'a Asked>,
) -> Option<&'a Asked> {
    let styles = tracer.acne();
    if styles.is_empty() {
        return None;
    }
    // In f64, rounding decides where it is acne, and not where it is another mistake.
    let decided_by_rounding =
        |asked: &&Asked| asked.answer.undecided - asked.answer.tied > asked.answer.differing;
    let maths = maths.into_iter().filter(decided_by_rounding);
    let maths = maths.map(|asked| (asked, MAX_UNSTABLE, MOST_IN_DOUBLE));
    let rounding = rounding.into_iter().map(|asked| (asked, LEAST_IN_SINGLE, MOST));
    let seen = maths.chain(rounding).find(|&(asked, least, most)| {
        let answer = &asked.answer;
        let count = answer.differing + answer.undecided - answer.tied;
        if answer.share(count) <= least {
            return false;
        }
        let pixels: Vec<Visible> = all(asked, size)
            .into_par_iter()
            .filter_map(|pixel| Visible::at(tracer, asked, size, pixel))
            .collect();
        let explained = pixels.par_iter().filter(|pixel| pixel.is_acne(tracer, &styles));
        explained.count() as f64 >= most * pixels.len() as f64 && !pixels.is_empty()
    });
    seen.map(|(asked, ..)| asked)
}

/// Pixels from all over the picture that rounding decides, or that differ if there are none, of those whose colors are kept.
fn all(asked: &Asked, size: [u32; 2]) -> Vec<[u32; 2]> {
    let is_undecided = asked.standings.contains(&Standing::Undecided);
    let told = if is_undecided {
        Standing::Undecided
    } else {
        Standing::Differs
    };
    let mut kept: Vec<usize> = asked.actual.keys().copied().collect();
    kept.retain(|&at| asked.standings[at] == told);
    kept.sort_unstable();
    let step = kept.len().div_ceil(ASKED).max(1);
    let place = |&at: &usize| [at as u32 % size[0], at as u32 / size[0]];
    kept.iter().step_by(step).map(place).collect()
}

/// A pixel that visibly differs from the scene's. Colors are clamped to [0, 1].
struct Visible {
    pixel: [u32; 2],
    own: [f64; 3],
    exact: [f64; 3],
}

impl Visible {
    /// None if the pixel has the scene's color, or its own is not kept.
    fn at(tracer: &Tracer<f64>, asked: &Asked, size: [u32; 2], pixel: [u32; 2]) -> Option<Self> {
        let [x, y] = pixel;
        let own = asked.actual.get(&(y as usize * size[0] as usize + x as usize))?;
        let own = own.map(|part| f64::from(part).clamp(0.0, 1.0));
        let exact = tracer.pixel(x, y).map(|part| part.clamp(0.0, 1.0));
        (0..3)
            .any(|i| !is_near(own[i], exact[i]))
            .then_some(Self { pixel, own, exact })
    }

    /// Whether its color comes of rays that meet their own surface: in all of its samples, or in some of them.
    fn is_acne(&self, tracer: &Tracer<f64>, styles: &[RayStyles]) -> bool {
        let Self { own, exact, .. } = self;
        // Where lights and BRDFs are sampled, too, a color between the two says nothing.
        let is_jittered = tracer.sampler() == Some(Sampler::SineHash);
        styles.iter().any(|styles| {
            let other = tracer.styled(self.pixel, styles).map(|part| part.clamp(0.0, 1.0));
            let is_mixed = |i: usize| {
                let (least, most) = (other[i].min(exact[i]), other[i].max(exact[i]));
                is_jittered && (least - SAME..=most + SAME).contains(&own[i])
            };
            (0..3).all(|i| is_near(own[i], other[i]) || is_mixed(i))
        })
    }
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME
}

/// Why the shader is wrong.
pub(super) fn reason(answer: &Answer) -> String {
    let count = answer.differing + answer.undecided - answer.tied;
    format!(
        "in {} of {} pixels rounding decides whether a ray meets the surface that it starts from",
        grouped(count),
        grouped(answer.pixels)
    )
}

/// The mistake.
pub(super) fn named() -> Named {
    Named {
        name: "self-intersection",
        says: "lets rays meet the surface that they start from: start them a little off it, or do not count hits that are too near".into(),
    }
}
