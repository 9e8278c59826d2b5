//! The colors of a reference shader for other numbers that are a matter of style: how far off a surface its
//! rays start, how near a march comes to one, how far it goes, and in how many steps.

use toyproof_diagnostic::Span;
use toyproof_eval::{Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::Image;
use toyproof_tracer::ColorRange;

use super::bands::is_cached;
use super::shader::ShaderReference;
use super::variation::Subject;
use super::{epsilons, march};
use crate::bounds::MAX_ITERATIONS;
use crate::compare::{Pixel, Share};

/// The largest share of pixels that may change with a variation. A number on which more of the image depends
/// is not a matter of style.
const MAX_CHANGED_SHARE: f64 = 0.05;

/// The range of the colors of each pixel, bottom row first.
#[derive(Debug)]
pub(super) struct AcceptedColors {
    ranges: Vec<ColorRange>,
    march: Option<MarchDependence>,
}

/// The pixels of a reference whose color depends on how it marches along its rays.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarchDependence {
    /// The pixels that change with the number of steps, the largest distance or the length of the steps.
    pub pixels: Share,
    /// The limits of marches on which some of these pixels depend, alone or together, by the places where
    /// loops compare with them, in the order of the text.
    pub limits: Vec<Span>,
}

impl AcceptedColors {
    /// The colors of a reference for the usual ray epsilons and for other marches; `None` for a large image,
    /// and where no color depends on them.
    pub(super) fn new(reference: &ShaderReference) -> Option<Self> {
        if !is_cached(reference.frame.size) {
            return None;
        }
        let checked = reference.checked();
        let variations = [epsilons::variations(checked), march::variations(&checked.tree)].concat();
        if variations.is_empty() {
            return None;
        }
        let bands = reference.frame.bands().map(|rows| reference.rows(&rows));
        let bands = bands.map(|band| band.ok().map(|band| band.image.clone()));
        let own = Image::of_bands(bands.collect::<Option<_>>()?);
        let mut ranges: Vec<ColorRange> = own
            .pixels()
            .iter()
            .map(|&[r, g, b, _]| point([r, g, b].map(f64::from)))
            .collect();
        let mut is_varied = false;
        let mut marched = vec![false; ranges.len()];
        let mut limits: Vec<Span> = Vec::new();
        for variation in &variations {
            let Some(image) = evaluated(reference, &variation.apply(checked)) else {
                continue;
            };
            let differs = |at: usize| Pixel::at(at, &own, &image).difference() > reference.tolerance();
            let changed: Vec<usize> = (0..ranges.len()).filter(|&at| differs(at)).collect();
            if changed.is_empty() || changed.len() as f64 > MAX_CHANGED_SHARE * ranges.len() as f64 {
                continue;
            }
            is_varied = true;
            for (range, &color) in ranges.iter_mut().zip(image.pixels()) {
                extend(range, color);
            }
            if let Subject::March(varied) = &variation.subject {
                // Limits are reported if they change pixels that no earlier variation changes.
                if changed.iter().any(|&at| !marched[at]) {
                    limits.extend(varied);
                }
                for &at in &changed {
                    marched[at] = true;
                }
            }
        }
        limits.sort_unstable_by_key(|span| span.start);
        limits.dedup();
        let pixels = Share {
            count: marched.iter().filter(|&&marched| marched).count() as u64,
            of: marched.len() as u64,
        };
        let march = (pixels.count > 0).then_some(MarchDependence { pixels, limits });
        is_varied.then_some(Self { ranges, march })
    }

    pub(super) fn range(&self, at: usize) -> &ColorRange {
        &self.ranges[at]
    }

    pub(super) fn march(&self) -> Option<&MarchDependence> {
        self.march.as_ref()
    }
}

/// The range of one color.
pub(super) fn point(color: [f64; 3]) -> ColorRange {
    ColorRange {
        low: color,
        high: color,
    }
}

fn extend(range: &mut ColorRange, color: [f32; 4]) {
    // Neither the least nor the greatest of a number and NaN is NaN.
    for ((low, high), part) in range.low.iter_mut().zip(&mut range.high).zip(color) {
        *low = low.min(f64::from(part));
        *high = high.max(f64::from(part));
    }
}

/// The image of a variant of the reference; none if a pixel runs too many loop iterations.
fn evaluated(reference: &ShaderReference, varied: &Checked) -> Option<Image> {
    let settings = Settings::<f64> {
        max_iterations: MAX_ITERATIONS,
        ..Settings::plain()
    };
    let program = Program::prepared(varied, UndefinedPolicy::Plain).ok()?;
    let frame = &reference.frame;
    let rendered = program.render_rows(frame, frame.rows(), &settings);
    rendered.ok().map(|rendered| rendered.image)
}
