//! The verdict.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{Answer, SEEN};

/// What is said of a shader, in the order of precedence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It does not compile, is no text, or is nested too deep.
    Invalid,
    /// It never ends or takes too long, also where a driver cut its loops short.
    Timeout,
    /// naga, the driver or toyproof failed.
    Error,
    /// Its mathematics is not the scene's.
    Wrong,
    /// Its mathematics is the scene's, but float32 is not enough for it.
    Unstable,
    /// It cannot be told.
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
            Self::Unstable => "unstable",
            Self::Inconclusive => "inconclusive",
            Self::Correct => "correct",
            Self::Ok => "ok",
        })
    }
}

/// A shader is wrong if more than this share of its pixels differs in f64, where only legal styles of secondary rays
/// move an answer: a ray that grazes an edge between two of these styles may see neither's colour.
pub const MAX_DIFFERING: f64 = 0.001;

/// A shader is unstable if more than this share of its pixels is seen to change with the number type, or hangs by a
/// hair in f64. Silhouettes of a well-written shader in float32 make less than a tenth of it.
pub const MAX_UNSTABLE: f64 = 0.003;

/// No verdict is given if more than this share of the pixels is left out as undefined: a checker that excuses
/// everything checks nothing.
pub const MAX_UNDEFINED: f64 = 0.05;

/// The answers to the three questions; one that was not asked is none.
#[derive(Debug, Clone, Copy)]
pub struct Answers<'a> {
    /// The shader in f64 against the tracer in f64.
    pub maths: Option<&'a Answer>,
    /// The picture in f32 against the shader in f64.
    pub rounding: Option<&'a Answer>,
    /// The GPU in f32 against the CPU in f32, in bits.
    pub toolchain: Option<&'a Answer>,
}

/// The verdict and its reason, one sentence.
#[must_use]
pub fn judge(answers: Answers) -> (Verdict, String) {
    let Answers {
        maths,
        rounding,
        toolchain,
    } = answers;
    if let Some(answer) = toolchain
        && answer.max_abs > SEEN
        && answer.share(answer.differing) > MAX_DIFFERING
        // What hangs on one undefined operation out of many may not be seen to: where most pixels do, few others prove nothing.
        && answer.differing > answer.undefined
    {
        let reason = format!(
            "{} {} not what the shader says: naga, the driver or toyproof broke it, and it is not the shader's fault",
            count(answer, answer.differing),
            plural(answer.differing, "is", "are")
        );
        return (Verdict::Error, reason);
    }
    let Some(maths) = maths else {
        return (
            Verdict::Ok,
            "the shader paints; there is no scene to compare it with".to_owned(),
        );
    };
    if maths.share(maths.differing) > MAX_DIFFERING {
        return (
            Verdict::Wrong,
            format!("{}: it is the mathematics", differing(maths)),
        );
    }
    if maths.share(maths.undefined) > MAX_UNDEFINED {
        let reason = format!(
            "in {} the shader does what GLSL leaves undefined, so that cannot be compared",
            count(maths, maths.undefined)
        );
        return (Verdict::Inconclusive, reason);
    }
    if maths.share(maths.undecided - maths.tied) > MAX_UNSTABLE {
        let reason = format!(
            "the mathematics may be right, but {} {} by a hair even in double precision: a rounding error decides",
            count(maths, maths.undecided - maths.tied),
            plural(maths.undecided - maths.tied, "hangs", "hang")
        );
        return (Verdict::Unstable, reason);
    }
    if let Some(rounding) = rounding
        && rounding.share(rounding.differing) > MAX_UNSTABLE
    {
        let reason = format!(
            "the mathematics is right, but float32 is not enough for it here: {} {} visibly another colour than in \
             double precision",
            count(rounding, rounding.differing),
            plural(rounding.differing, "is", "are")
        );
        return (Verdict::Unstable, reason);
    }
    let reason = match (maths.differing, maths.undecided + maths.undefined) {
        (0, 0) => format!("all {} pixels agree with the scene", grouped(maths.pixels)),
        (0, left) => format!(
            "all pixels agree with the scene but {} that cannot be decided",
            grouped(left)
        ),
        (differing, _) => format!(
            "{} of {} pixels {} from the scene, fewer than the {} that are allowed",
            grouped(differing),
            grouped(maths.pixels),
            plural(differing, "differs", "differ"),
            grouped((maths.pixels as f64 * MAX_DIFFERING) as u64 + 1)
        ),
    };
    let tied = match maths.tied.max(rounding.map_or(0, |rounding| rounding.tied)) {
        0 => String::new(),
        tied => format!(
            "; in {} an edge of the scene itself passes through the pixel's sample",
            grouped(tied)
        ),
    };
    (Verdict::Correct, reason + &tied)
}

/// How many pixels differ from the scene.
#[must_use]
pub fn differing(maths: &Answer) -> String {
    format!(
        "{} {} from the scene even in exact arithmetic",
        count(maths, maths.differing),
        plural(maths.differing, "differs", "differ")
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

/// The form of a word that goes with a count.
#[must_use]
pub fn plural<'a>(count: u64, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}

/// A count with its thousands apart: 230,400.
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

/// An error in few digits: 1.2e-7, or 0 where there is none.
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
    fn numbers_are_written_as_people_read_them() {
        assert_eq!(
            [0, 999, 57_600, 67_108_864].map(grouped),
            ["0", "999", "57,600", "67,108,864"]
        );
        assert_eq!(
            [0.0, -0.0, 1.25e-7, 3.0].map(magnitude),
            ["0", "0", "1.2e-7", "3.0e0"]
        );
    }

    /// Of 10,000 pixels.
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

    fn verdict(maths: [u64; 3], rounding: u64, toolchain: (u64, f64)) -> Verdict {
        let maths = answer(maths, 1.0);
        let rounding = answer([rounding, 0, 0], 1.0);
        let toolchain = answer([toolchain.0, 0, 0], toolchain.1);
        let answers = Answers {
            maths: Some(&maths),
            rounding: Some(&rounding),
            toolchain: Some(&toolchain),
        };
        judge(answers).0
    }

    #[test]
    fn the_verdict_turns_at_its_thresholds() {
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
    fn a_broken_toolchain_is_no_shaders_fault_and_lost_bits_are_no_broken_toolchain() {
        assert_eq!(verdict([5_000, 0, 0], 0, (11, 0.1)), Verdict::Error);
        assert_eq!(verdict([0; 3], 0, (10_000, 1e-6)), Verdict::Correct);
        assert_eq!(verdict([0; 3], 0, (10, 1.0)), Verdict::Correct);
        let [few, many] = [4_000, 6_000].map(|undefined| {
            let toolchain = answer([5_000, 0, undefined], 0.1);
            let answers = Answers {
                maths: None,
                rounding: None,
                toolchain: Some(&toolchain),
            };
            judge(answers).0
        });
        assert_eq!((few, many), (Verdict::Error, Verdict::Ok));
    }

    #[test]
    fn without_a_scene_a_shader_is_ok() {
        let rounding = answer([5_000, 0, 0], 1.0);
        let answers = Answers {
            maths: None,
            rounding: Some(&rounding),
            toolchain: None,
        };
        assert_eq!(judge(answers).0, Verdict::Ok);
    }

    #[test]
    fn thousands_stand_apart() {
        assert_eq!(
            [0, 999, 1000, 230_400, 1_234_567].map(grouped),
            ["0", "999", "1,000", "230,400", "1,234,567"]
        );
    }
}
