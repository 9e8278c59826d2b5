//! The growth of rounding errors over the frames of a project, for programs.

use serde::{Deserialize, Serialize};
use toyproof_verify::project::growth::{Growth, GrowthCause};

/// The largest number of frames that are listed, besides the last: enough for a curve.
const MAX_LISTED: usize = 100;

/// How far float32 is from double precision, both from the first frame on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GrowthRecord {
    /// The first frame whose images visibly differ; null if none do.
    pub first_visible: Option<i32>,
    /// Why those of the last frame do; null if they do not.
    pub cause: Option<CauseName>,
    /// The number of frames in which errors double, of a chaotic shader.
    pub doubling: Option<f64>,
    /// The frames, evenly spaced if they are many, and the last.
    pub frames: Vec<GrowthFrame>,
}

/// A cause of a visible difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CauseName {
    /// One frame of a pass is imprecise.
    Step,
    /// Errors grow exponentially in any precision.
    Chaos,
    /// Errors add up.
    Accumulation,
}

/// The difference in one frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GrowthFrame {
    /// `iFrame`.
    pub frame: usize,
    /// The largest absolute difference of a component, in [0, 1].
    pub max_abs: f64,
    /// The pixels that differ visibly.
    pub differing: u64,
}

impl GrowthRecord {
    /// The record of a growth.
    #[must_use]
    pub fn new(growth: &Growth) -> Self {
        let cause = growth.visible.map(|visible| visible.cause);
        let last = growth.frames.len().saturating_sub(1);
        let step = growth.frames.len().div_ceil(MAX_LISTED).max(1);
        let frames = growth.frames.iter().enumerate();
        Self {
            first_visible: growth.first_visible,
            cause: cause.map(|cause| match cause {
                GrowthCause::Step { .. } => CauseName::Step,
                GrowthCause::Chaos { .. } => CauseName::Chaos,
                GrowthCause::Accumulation => CauseName::Accumulation,
            }),
            doubling: cause.and_then(|cause| match cause {
                GrowthCause::Chaos { doubling, .. } => Some(doubling),
                _ => None,
            }),
            frames: frames
                .filter(|(frame, _)| frame % step == 0 || *frame == last)
                .map(|(frame, error)| GrowthFrame {
                    frame,
                    max_abs: error.max_abs,
                    differing: error.differing.count,
                })
                .collect(),
        }
    }
}

/// Sample records for the tests of the formats.
#[cfg(test)]
pub(super) mod samples {
    use toyproof_verify::Share;
    use toyproof_verify::project::growth::{FrameError, VisibleGrowth};

    use super::*;

    /// A chaotic shader after that many frames.
    pub(crate) fn chaotic(frames: usize) -> GrowthRecord {
        let differing = Share { count: 500, of: 1000 };
        let error = FrameError {
            max_abs: 0.25,
            differing,
            worst: Some([1, 2]),
        };
        GrowthRecord::new(&Growth {
            frames: vec![error; frames],
            first_visible: Some(3),
            visible: Some(VisibleGrowth {
                differing,
                worst: [1, 2],
                since: 3,
                cause: GrowthCause::Chaos {
                    doubling: 1.5,
                    in_double: false,
                },
            }),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_frames_are_thinned_out_and_the_last_is_kept() {
        let of = |frames| -> Vec<_> {
            let record = samples::chaotic(frames);
            record.frames.iter().map(|one| one.frame).collect()
        };
        assert_eq!(of(3), [0, 1, 2]);
        assert_eq!(of(MAX_LISTED).len(), MAX_LISTED);
        let many = of(1000);
        assert_eq!((many[1], many[99], many[100]), (10, 990, 999));
        assert_eq!(samples::chaotic(3).doubling, Some(1.5));
    }
}
