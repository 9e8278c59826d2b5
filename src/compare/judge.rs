//! The verdict.

use std::fmt;

use serde::Serialize;

use super::Comparison;

/// What is said of a shader, in the order of precedence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It does not compile, is no text, or is nested too deep.
    Invalid,
    /// It never ends or takes too long, also where a driver cut its loops short.
    Timeout,
    /// naga, the driver or toyproof failed.
    Error,
    /// Its picture is not the reference's.
    Wrong,
    /// Too much of the picture hangs by a hair to tell.
    Inconclusive,
    /// Its picture is the reference's.
    Correct,
    /// It paints, and there is no scene to compare with.
    Ok,
}

impl Verdict {
    /// Whether there is nothing to complain of.
    #[must_use]
    pub fn is_good(self) -> bool {
        matches!(self, Self::Correct | Self::Ok)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Invalid => "invalid",
            Self::Timeout => "timeout",
            Self::Error => "error",
            Self::Wrong => "wrong",
            Self::Inconclusive => "inconclusive",
            Self::Correct => "correct",
            Self::Ok => "ok",
        })
    }
}

/// A shader is wrong if more than this share of its pixels differs. A whole silhouette of the course's first
/// sphere is 0.4 % of its picture, its shading far more: a mistake that is smaller cannot be told here.
pub const MAX_DIFFERING: f64 = 0.001;

/// No verdict is given if more than this share of the pixels is excused: a checker that excuses everything
/// checks nothing. The course's rungs excuse less than a tenth of it.
pub const MAX_UNDECIDED: f64 = 0.05;

/// The rule on the picture: what differs and is decided counts; the reason is one sentence.
#[must_use]
pub fn judge(comparison: &Comparison) -> (Verdict, String) {
    let share = |count: u64| count as f64 / comparison.pixels.max(1) as f64;
    let percent = |count: u64| 100.0 * share(count);
    let Comparison {
        pixels,
        differing,
        undecided,
        ..
    } = *comparison;
    if share(differing) > MAX_DIFFERING {
        let reason = format!(
            "{differing} of {pixels} pixels ({:.2} %) differ from the reference by more than float32 explains",
            percent(differing)
        );
        return (Verdict::Wrong, reason);
    }
    if share(undecided) > MAX_UNDECIDED {
        let reason = format!(
            "{undecided} of {pixels} pixels ({:.2} %) differ, but float32 cannot decide them in this scene",
            percent(undecided)
        );
        return (Verdict::Inconclusive, reason);
    }
    let reason = match (differing, undecided) {
        (0, 0) => format!("all {pixels} pixels agree with the reference"),
        (0, _) => format!("all pixels agree with the reference but {undecided} that float32 cannot decide"),
        _ => format!(
            "{differing} of {pixels} pixels differ from the reference, fewer than the {} that are allowed",
            (pixels as f64 * MAX_DIFFERING).floor()
        ),
    };
    (Verdict::Correct, reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(differing: u64, undecided: u64) -> Verdict {
        let comparison = Comparison {
            pixels: 10_000,
            differing,
            undecided,
            differing_8bit: 0,
            max_8bit: 0,
            max_abs: 0.0,
            mean_abs: 0.0,
            first: None,
            worst: None,
        };
        judge(&comparison).0
    }

    #[test]
    fn the_verdict_turns_at_its_thresholds() {
        assert_eq!(verdict(0, 0), Verdict::Correct);
        assert_eq!(verdict(10, 500), Verdict::Correct);
        assert_eq!(verdict(11, 0), Verdict::Wrong);
        assert_eq!(verdict(0, 501), Verdict::Inconclusive);
        assert_eq!(verdict(11, 501), Verdict::Wrong, "what is decided counts first");
    }
}
