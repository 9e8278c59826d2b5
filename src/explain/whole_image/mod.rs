//! Finds how a whole wrong image differs from the expected one: a shader that solves its task may be
//! antialiased, mirrored or corrected for gamma, or read another input than the requested one.
//!
//! Under a hypothesis, the whole image must be correct by the same rules as any other. Most evaluate the
//! shader differently (a `View`: at other positions, or with other inputs), so that they apply to every kind
//! of reference.

mod antialiasing;
mod colors;
mod curve;
mod inputs;
mod scenes;
mod submission;
mod view;

use std::sync::LazyLock;

use toyproof_scene::Scene;
use toyproof_verify::Difference;
use toyproof_verify::compare::CheckSummary;

pub(crate) use self::scenes::DOCUMENTED as SCENES;
pub(crate) use self::submission::Submission;
use crate::known::KnownMistake;
use crate::known::documented::{Documented, documented};

/// What the guide says about each [`Difference`].
pub(crate) const DIFFERENCES: &[Documented] = documented! {
    /// Take one sample, at `fragCoord`.
    WholeImage "antialiasing": "each pixel is the mean of … samples; the reference has one, at its center";
    /// Leave out the gamma correction or the tone map, or add the one that the assignment asks for.
    WholeImage "color-curve": "the colors differ only by a color curve: …";
    /// Check the order of the components, such as `.rgb` and `.bgr`.
    WholeImage "swapped-channels": "red and blue are exchanged";
    /// Check the sign of x in the screen coordinates, and the order of factors in cross products.
    WholeImage "mirrored-x": "the image is mirrored: left and right are exchanged";
    /// In GLSL, y points upward and `fragCoord.y` is 0 at the bottom.
    WholeImage "mirrored-y": "the image is upside down: y is negated, or counted from the top";
    /// Check which of `fragCoord.x` and `fragCoord.y` becomes x, and the signs.
    WholeImage "rotated": "the image is rotated by …";
    /// Use the assignment's screen coordinates: with a width from −1 to 1, `(2.0 * fragCoord -
    /// iResolution.xy) / iResolution.x`.
    WholeImage "framing": "screen coordinates …";
    /// Without a click, `iMouse` is 0: use a default if `iMouse.z` is 0.
    WholeImage "mouse": "the image depends on `iMouse`: …";
    /// `iTime` is in seconds; `iFrame` counts frames, whose rate differs from screen to screen.
    WholeImage "time": "the number of the frame, `iFrame`, is used as the time in seconds; use `iTime`";
    /// Replace the numbers by `iResolution.x` and `iResolution.y`.
    WholeImage "fixed-resolution":
        "the image is right only in the resolution that is written in the shader, …; use `iResolution`";
};

/// The alternatives to the reference with which a wrong shader is compared.
#[derive(Debug, Clone, Copy, Default)]
pub struct Alternatives<'a> {
    /// The differences with which a shader is still correct.
    pub permitted: &'a [Difference],
    /// Other scenes that a shader may render instead of its own.
    pub scenes: Option<&'a OtherScenes>,
}

/// Scenes with their names, read on first use: correct shaders do not need them.
pub type OtherScenes = LazyLock<Vec<(String, Scene)>, Box<dyn FnOnce() -> Vec<(String, Scene)> + Send>>;

/// How a whole wrong image differs from the expected one.
#[derive(Debug)]
pub(crate) struct Alternative {
    pub(crate) mistake: KnownMistake,
    /// The algorithm check without this difference.
    pub(crate) algorithm: CheckSummary,
}

/// Returns the difference other than a color curve that explains a wrong image; `None` if no single one does.
pub(crate) fn find(submission: &Submission, alternatives: &Alternatives) -> Option<Alternative> {
    if let Some(scenes) = alternatives.scenes
        && let Some(found) = scenes::find(submission, scenes)
    {
        return Some(found);
    }
    let mut all = Difference::ALL.into_iter();
    all.find_map(|difference| match difference {
        Difference::ColorCurve => None,
        difference => of_kind(submission, difference),
    })
}

/// Returns the color curve that explains a wrong image.
pub(crate) fn find_curve(submission: &Submission, _: &Alternatives) -> Option<Alternative> {
    of_kind(submission, Difference::ColorCurve)
}

/// Returns the first of the permitted differences that explains a wrong image.
pub(crate) fn find_permitted(
    submission: &Submission,
    permitted: &[Difference],
) -> Option<(Difference, Alternative)> {
    let mut all = Difference::ALL.into_iter();
    all.find_map(|difference| {
        let is_permitted = permitted.contains(&difference);
        Some((
            difference,
            is_permitted.then(|| of_kind(submission, difference))??,
        ))
    })
}

fn of_kind(submission: &Submission, difference: Difference) -> Option<Alternative> {
    match difference {
        Difference::MirroredX | Difference::MirroredY | Difference::Rotated => {
            submission.explained_by(view::symmetries(submission, difference))
        }
        Difference::Mouse => submission.explained_by(inputs::mouse(submission)),
        Difference::Time => submission.explained_by(inputs::time(submission)),
        Difference::SwappedChannels => colors::swapped_channels(submission),
        Difference::FixedResolution => inputs::fixed_resolution(submission),
        Difference::Framing => view::framing(submission),
        Difference::Antialiasing => antialiasing::find(submission),
        Difference::ColorCurve => colors::curve(submission),
    }
}

/// Every kind of what can be reported, with an example of each computed description.
#[cfg(test)]
pub(crate) fn examples() -> Vec<KnownMistake> {
    [
        view::examples(),
        inputs::examples(),
        colors::examples(),
        antialiasing::examples(),
        scenes::examples(),
    ]
    .concat()
}
