//! Whether what differs from the scene may only be drawn otherwise.
//!
//! A shader that draws other random numbers than its scene paints another picture of the same mean. That its mean is the same is not asked, so it is
//! judged as any other; but it is told that this may be all.

use super::Asked;
use super::cause::some;
use crate::compare::EXACT_TOLERANCE;
use crate::scene::Sampler;
use crate::trace::Tracer;

/// So many of the pixels that differ are drawn anew.
const ASKED: usize = 256;

/// So often. A sliver that covers the part a of a pixel is met by a sample of a shader and by none of n that are drawn anew with a chance of
/// a·(1 − a)ⁿ, which is below 1/(e·n).
const TIMES: u32 = 16;

/// So many of them must be another colour in one of the drawings.
const MOST: f64 = 0.98;

/// To stand behind how many pixels differ: that they all lie where other draws paint another colour, if they do.
pub(super) fn told(tracer: &Tracer<f64>, maths: &Asked, size: [u32; 2]) -> Option<String> {
    let sampler = match tracer.sampler()? {
        Sampler::Center => return None,
        Sampler::SineHash => "sine-hash",
        Sampler::Independent => "independent",
        Sampler::Stratified => "stratified",
        Sampler::Sobol => "sobol",
    };
    let asked = some(maths, size, ASKED);
    let is_drawn = |&&[x, y]: &&[u32; 2]| {
        let first = tracer.redrawn(x, y, 1);
        let moves = |set| {
            let again = tracer.redrawn(x, y, set);
            (0..3).any(|i| (again[i].clamp(0.0, 1.0) - first[i].clamp(0.0, 1.0)).abs() > EXACT_TOLERANCE)
        };
        (2..=TIMES).any(moves)
    };
    let drawn = asked.iter().filter(is_drawn).count();
    (drawn as f64 >= MOST * asked.len() as f64).then(|| {
        format!(
            "only where the samples' random numbers decide: it draws others than the scene, whose sampler is `{sampler}`, or makes other use \
             of them. Pictures of different draws are not compared by their mean: draw as docs/scenes.md tells, or give the scene the \
             sampler that draws as the shader does"
        )
    })
}
