//! The verdict on a shader, and its thresholds.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::compare::{Answer, SEEN};

/// The verdict on a shader, in the order of precedence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It does not compile, is not text, or is nested too deeply.
    Invalid,
    /// It never ends or takes too long; also if a driver truncated its loops.
    Timeout,
    /// naga, the driver or toyproof failed.
    Error,
    /// Its algorithm differs from the reference.
    Wrong,
    /// Its algorithm is right, but float32 is not precise enough for it.
    Unstable,
    /// It cannot be decided.
    Inconclusive,
    /// Its image agrees with the reference.
    Correct,
    /// It renders, and there is no scene to compare with.
    Ok,
}

impl Verdict {
    /// Whether the shader has no fault.
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
            Self::Unstable => "unstable",
            Self::Inconclusive => "inconclusive",
            Self::Correct => "correct",
            Self::Ok => "ok",
        })
    }
}

/// The largest share of differing pixels in f64 of a shader that is not wrong. Only legal ray epsilons cause
/// such differences: a ray that grazes an edge between two of the tested epsilons may have the color of
/// neither.
pub const MAX_DIFFERING: f64 = 0.001;

/// The largest share of pixels that visibly change with the number type, or are ill-conditioned in f64, of a
/// shader that is not unstable. Silhouettes of a well-written shader in float32 cause less than a tenth of
/// it.
pub const MAX_UNSTABLE: f64 = 0.003;

/// The largest share of undefined pixels for which there is a verdict: a check that excludes everything
/// proves nothing.
pub const MAX_UNDEFINED: f64 = 0.05;

/// The results of the three checks; none for a check that was not run.
#[derive(Debug, Clone, Copy)]
pub struct Answers<'a> {
    /// The shader in f64 against the tracer in f64.
    pub algorithm: Option<&'a Answer>,
    /// The image in f32 against the shader in f64.
    pub precision: Option<&'a Answer>,
    /// The GPU in f32 against the CPU in f32, in bits.
    pub toolchain: Option<&'a Answer>,
}

/// Returns the verdict and its reason, one sentence.
#[must_use]
pub fn decide(answers: Answers) -> (Verdict, String) {
    let Answers {
        algorithm,
        precision,
        toolchain,
    } = answers;
    if let Some(answer) = toolchain
        && answer.max_abs > SEEN
        && answer.share(answer.differing) > MAX_DIFFERING
        // Not every pixel that depends on undefined behavior is detected: where most pixels do, a few others
        // prove nothing.
        && answer.differing > answer.undefined
    {
        let reason = format!(
            "{} {} not what the shader says: naga, the driver or toyproof broke it, and it is not the shader's fault",
            count(answer, answer.differing),
            plural(answer.differing, "is", "are")
        );
        return (Verdict::Error, reason);
    }
    let Some(algorithm) = algorithm else {
        return (
            Verdict::Ok,
            "the shader paints; there is no scene to compare it with".to_owned(),
        );
    };
    if algorithm.share(algorithm.differing) > MAX_DIFFERING {
        return (
            Verdict::Wrong,
            format!("{}: it is the mathematics", differing(algorithm)),
        );
    }
    if algorithm.share(algorithm.undefined) > MAX_UNDEFINED {
        let reason = format!(
            "in {} the shader does what GLSL leaves undefined, so that cannot be compared",
            count(algorithm, algorithm.undefined)
        );
        return (Verdict::Inconclusive, reason);
    }
    if algorithm.share(algorithm.undecided - algorithm.tied) > MAX_UNSTABLE {
        let reason = format!(
            "the mathematics may be right, but {} {} by a hair even in double precision: a rounding error decides",
            count(algorithm, algorithm.undecided - algorithm.tied),
            plural(algorithm.undecided - algorithm.tied, "hangs", "hang")
        );
        return (Verdict::Unstable, reason);
    }
    if let Some(precision) = precision
        && precision.share(precision.differing) > MAX_UNSTABLE
    {
        let reason = format!(
            "the mathematics is right, but float32 is not enough for it here: {} {} visibly another colour than in \
             double precision",
            count(precision, precision.differing),
            plural(precision.differing, "is", "are")
        );
        return (Verdict::Unstable, reason);
    }
    let reason = match (algorithm.differing, algorithm.undecided + algorithm.undefined) {
        (0, 0) => format!("all {} pixels agree with the scene", grouped(algorithm.pixels)),
        (0, left) => format!(
            "all pixels agree with the scene but {} that cannot be decided",
            grouped(left)
        ),
        (differing, _) => format!(
            "{} of {} pixels {} from the scene, fewer than the {} that are allowed",
            grouped(differing),
            grouped(algorithm.pixels),
            plural(differing, "differs", "differ"),
            grouped((algorithm.pixels as f64 * MAX_DIFFERING) as u64 + 1)
        ),
    };
    let tied = match algorithm
        .tied
        .max(precision.map_or(0, |precision| precision.tied))
    {
        0 => String::new(),
        tied => format!(
            "; in {} an edge of the scene itself passes through the pixel's sample",
            grouped(tied)
        ),
    };
    (Verdict::Correct, reason + &tied)
}

/// Formats how many pixels differ from the scene.
#[must_use]
pub fn differing(algorithm: &Answer) -> String {
    format!(
        "{} {} from the scene even in exact arithmetic",
        count(algorithm, algorithm.differing),
        plural(algorithm.differing, "differs", "differ")
    )
}

fn count(answer: &Answer, count: u64) -> String {
    format!(
        "{} of {} pixels ({:.2} %)",
        grouped(count),
        grouped(answer.pixels),
        100.0 * answer.share(count)
    )
}

/// The form of a word for a count.
#[must_use]
pub fn plural<'a>(count: u64, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}

/// Formats a count with separated thousands: 230,400.
#[must_use]
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Formats an error in two digits: 1.2e-7, or 0.
#[must_use]
pub fn magnitude(error: f64) -> String {
    if error == 0.0 {
        "0".to_owned()
    } else {
        format!("{error:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_formatted_for_people() {
        assert_eq!(
            [0, 999, 57_600, 67_108_864].map(grouped),
            ["0", "999", "57,600", "67,108,864"]
        );
        assert_eq!(
            [0.0, -0.0, 1.25e-7, 3.0].map(magnitude),
            ["0", "0", "1.2e-7", "3.0e0"]
        );
    }

    /// The result of a check of 10,000 pixels.
    fn answer([differing, undecided, undefined]: [u64; 3], max_abs: f64) -> Answer {
        Answer {
            pixels: 10_000,
            differing,
            undecided,
            undefined,
            tied: 0,
            max_abs,
            first: None,
            worst: None,
        }
    }

    fn verdict(algorithm: [u64; 3], precision: u64, toolchain: (u64, f64)) -> Verdict {
        let algorithm = answer(algorithm, 1.0);
        let precision = answer([precision, 0, 0], 1.0);
        let toolchain = answer([toolchain.0, 0, 0], toolchain.1);
        let answers = Answers {
            algorithm: Some(&algorithm),
            precision: Some(&precision),
            toolchain: Some(&toolchain),
        };
        decide(answers).0
    }

    #[test]
    fn the_verdict_changes_at_its_thresholds() {
        const SAME: (u64, f64) = (0, 0.0);
        assert_eq!(verdict([0; 3], 0, SAME), Verdict::Correct);
        assert_eq!(verdict([10, 30, 500], 30, SAME), Verdict::Correct);
        assert_eq!(verdict([11, 0, 0], 0, SAME), Verdict::Wrong);
        assert_eq!(verdict([0, 31, 0], 0, SAME), Verdict::Unstable);
        assert_eq!(verdict([0, 0, 0], 31, SAME), Verdict::Unstable);
        assert_eq!(verdict([0, 0, 501], 0, SAME), Verdict::Inconclusive);
    }

    #[test]
    fn a_wrong_shader_is_wrong_however_unstable_it_is() {
        assert_eq!(verdict([11, 5_000, 501], 5_000, (0, 0.0)), Verdict::Wrong);
    }

    #[test]
    fn a_broken_toolchain_is_an_error_and_lost_bits_are_not() {
        assert_eq!(verdict([5_000, 0, 0], 0, (11, 0.1)), Verdict::Error);
        assert_eq!(verdict([0; 3], 0, (10_000, 1e-6)), Verdict::Correct);
        assert_eq!(verdict([0; 3], 0, (10, 1.0)), Verdict::Correct);
        let [few, many] = [4_000, 6_000].map(|undefined| {
            let toolchain = answer([5_000, 0, undefined], 0.1);
            let answers = Answers {
                algorithm: None,
                precision: None,
                toolchain: Some(&toolchain),
            };
            decide(answers).0
        });
        assert_eq!((few, many), (Verdict::Error, Verdict::Ok));
    }

    #[test]
    fn without_a_scene_a_shader_is_ok() {
        let precision = answer([5_000, 0, 0], 1.0);
        let answers = Answers {
            algorithm: None,
            precision: Some(&precision),
            toolchain: None,
        };
        assert_eq!(decide(answers).0, Verdict::Ok);
    }

    #[test]
    fn thousands_are_separated() {
        assert_eq!(
            [0, 999, 1000, 230_400, 1_234_567].map(grouped),
            ["0", "999", "1,000", "230,400", "1,234,567"]
        );
    }
}
