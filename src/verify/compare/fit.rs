//! Which of the legal styles of secondary rays a shader has, told from some of the pixels in which it differs.

use rayon::prelude::*;
use toyproof_tracer::{RayStyle, RayStyles};

use super::maths::Reference;
use super::{EXACT_TOLERANCE, Pixel};

/// So many pixels are compared with every style, and fewer of several samples, but so many at least.
const ASKED: usize = 32;
const LEAST_ASKED: usize = 8;

/// So many samples are taken at most to look at pixels one by one.
const WORK: usize = 3_000_000;

/// A style that explains less than this share of them is not the shader's.
const LEAST_SHARE: f64 = 0.1;

/// Rays that look for a light and the others are fitted in turn, so often.
const TURNS: u32 = 2;

/// A style, and what is known of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted {
    pub(super) styles: RayStyles,
}

/// The styles that explain most of some pixels, if any explain some; `before` are those that explained earlier ones.
pub(super) fn fitted(
    reference: &impl Reference,
    differing: &[Pixel],
    before: Option<Fitted>,
) -> Option<Fitted> {
    let most = (ASKED / reference.samples() as usize).max(LEAST_ASKED);
    let count = differing.len().min(most);
    let pixel = |at| differing[(2 * at + 1) * differing.len() / (2 * count)];
    let asked: Vec<Pixel> = (0..count).map(pixel).collect();
    let explained = |styles: &RayStyles| {
        let is_explained = |pixel: &&Pixel| is_in(reference, pixel, styles);
        asked.iter().filter(is_explained).count()
    };
    let mut best = before.map(|before| (explained(&before.styles), before.styles));
    if best.is_some_and(|(most, _)| most == count) {
        return before;
    }
    let improve = |best: &mut Option<(usize, RayStyles)>, make: &dyn Fn(RayStyle, RayStyles) -> RayStyles| {
        let (most, styles) = best.unwrap_or_default();
        let all: Vec<RayStyles> = reference
            .families()
            .iter()
            .flatten()
            .map(|&style| make(style, styles))
            .collect();
        let found = all.par_iter().map(explained).collect::<Vec<_>>();
        // Of styles that explain as many, the first.
        let found = found.into_iter().zip(all).rev().max_by_key(|&(found, _)| found);
        if let Some((found, styles)) = found
            && found > most
        {
            *best = Some((found, styles));
        }
        best.is_some_and(|(most, _)| most == count)
    };
    let is_explained = improve(&mut best, &|style, _| RayStyles::alike(style));
    // What no style explains anything of is no matter of style.
    if !is_explained && best.is_some() {
        for _ in 0..TURNS {
            let light = |light, styles| RayStyles { light, ..styles };
            let other = |other, styles| RayStyles { other, ..styles };
            if improve(&mut best, &light) || improve(&mut best, &other) {
                break;
            }
        }
    }
    let (most, styles) = best?;
    (most as f64 >= LEAST_SHARE * count as f64).then_some(Fitted { styles })
}

/// Whether a pixel is what the reference is in these styles.
pub(super) fn is_in(reference: &impl Reference, pixel: &Pixel, styles: &RayStyles) -> bool {
    let color = reference.styled(pixel.x, pixel.y, styles);
    (0..3).all(|i| {
        let [own, other] = [f64::from(pixel.actual[i]), color[i]].map(|part| part.clamp(0.0, 1.0));
        (own - other).abs() <= EXACT_TOLERANCE
    })
}

/// Whether so many pixels may be looked at one by one.
pub(super) fn is_affordable(reference: &impl Reference, pixels: usize) -> bool {
    let styles: usize = reference.families().iter().map(Vec::len).sum();
    pixels * styles * reference.samples() as usize <= WORK
}

/// Whether a pixel lies between what the reference is in two neighboring styles of a family: as a function of an offset, a color is
/// not monotonic where glass is seen at a grazing angle.
pub(super) fn is_in_any(reference: &impl Reference, pixel: &Pixel) -> bool {
    reference.families().iter().any(|family| {
        let colors = family
            .iter()
            .map(|&style| reference.styled(pixel.x, pixel.y, &RayStyles::alike(style)));
        let colors: Vec<_> = colors
            .map(|color| color.map(|part| part.clamp(0.0, 1.0)))
            .collect();
        colors.windows(2).any(|pair| {
            (0..3).all(|i| {
                let own = f64::from(pixel.actual[i]).clamp(0.0, 1.0);
                let [low, high] = [pair[0][i].min(pair[1][i]), pair[0][i].max(pair[1][i])];
                low - EXACT_TOLERANCE <= own && own <= high + EXACT_TOLERANCE
            })
        })
    })
}
