//! Decides: the verdict on a shader and its reason, a pure function of the evidence.

use std::fmt;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Code, Diagnostic};
use toyproof_eval as eval;
use toyproof_scene::Sampler;

use crate::compare::{Region, Regions, Share};
use crate::difference::Difference;
use crate::evidence::{Checks, Evidence, MeanComparison, OtherRandomNumbers, SelfIntersection};
use crate::failure::Failure;
use crate::limits::{
    MAX_BIAS_BOUND, MAX_UNDEFINED, MAX_UNSTABLE, MAX_VARIANCE_RATIO, MIN_RANDOM_PIXELS, is_different,
    is_toolchain_fault,
};
use crate::project::growth::{GrowthCause, VisibleGrowth};
use crate::random::mean_test::MeanTest;
use crate::random::replicate_test::{Bias, RARE_EVENT_VARIANCE_RATIO, REPLICATES, ReplicateTest};

/// The verdict on a shader, in the order of precedence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// No shader was submitted.
    Missing,
    /// The shader does not compile, is not text, or is nested too deeply.
    Invalid,
    /// The shader never ends or takes too long; also if a driver truncated loops.
    Timeout,
    /// The algorithm differs from the reference.
    Wrong,
    /// Nothing could be evaluated, or, without a reference, naga, the driver or toyproof failed.
    Error,
    /// The algorithm is right, but float32 is not precise enough for it.
    Unstable,
    /// Each frame is right and precise, but feedback amplifies rounding errors until images differ.
    Chaotic,
    /// The verdict cannot be decided.
    Inconclusive,
    /// The image agrees with the reference.
    Correct,
    /// The shader renders, and there is no reference to compare with.
    Ok,
}

impl Verdict {
    /// Whether there is a shader that compiles.
    #[must_use]
    pub fn is_compiled(self) -> bool {
        !matches!(self, Self::Missing | Self::Invalid)
    }

    /// The verdict on a shader some of whose media are missing: where it is compared with nothing, that it
    /// renders means little.
    #[must_use]
    pub fn with_missing_media(self) -> Self {
        match self {
            Self::Ok => Self::Inconclusive,
            verdict => verdict,
        }
    }

    /// Whether the shader has no fault.
    #[must_use]
    pub fn is_good(self) -> bool {
        matches!(self, Self::Correct | Self::Ok)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Missing => "missing",
            Self::Invalid => "invalid",
            Self::Timeout => "timeout",
            Self::Wrong => "wrong",
            Self::Error => "error",
            Self::Unstable => "unstable",
            Self::Chaotic => "chaotic",
            Self::Inconclusive => "inconclusive",
            Self::Correct => "correct",
            Self::Ok => "ok",
        })
    }
}

/// The reason of a verdict.
#[derive(Debug, Clone)]
pub enum Reason {
    /// There is no image of the shader: `invalid`, `timeout` or `error`.
    NoImage(Failure),
    /// The evaluator failed: `inconclusive`, or `ok` without a reference.
    NotEvaluated {
        /// Why the evaluator failed.
        failure: eval::Failure,
        /// Whether there is a reference to compare with.
        has_reference: bool,
    },
    /// These pixels differ from those that the shader computes on the CPU: `error`.
    ToolchainDiffers(Share),
    /// There is no reference: `ok`.
    NoReference,
    /// These pixels differ in double precision: `wrong`.
    AlgorithmDiffers {
        /// The pixels that differ.
        differing: Share,
        /// The regions of the pixels that differ.
        regions: Regions,
    },
    /// In these pixels, rounding decides whether a ray hits the surface that it starts from: `unstable`, or
    /// `wrong` if that is so in double precision too.
    SelfIntersection(SelfIntersection),
    /// These pixels depend on undefined behavior: `inconclusive`.
    Undefined(Share),
    /// In these pixels, rounding decides the color of the reference: `inconclusive`.
    ReferenceIllConditioned(Share),
    /// These pixels are ill-conditioned in double precision: `unstable`.
    IllConditioned(Share),
    /// These pixels differ visibly between float32 and double precision: `unstable`.
    Imprecise(Share),
    /// The image differs visibly between float32 and double precision because earlier frames do: `chaotic` or
    /// `unstable`, by its cause.
    Growth(VisibleGrowth),
    /// The shader agrees with its reference: `correct`.
    Agrees {
        /// The pixels that differ, which are few.
        differing: Share,
        /// The number of pixels that are ill-conditioned.
        ill_conditioned: u64,
        /// The number of pixels that depend on undefined behavior.
        undefined: u64,
        /// The largest compact region of pixels that depend on undefined behavior.
        undefined_region: Option<Region>,
        /// The number of pixels in which rounding decides the color of the reference itself, such as where an
        /// edge of a scene passes through the sample.
        tied: u64,
        /// The pixels that visibly differ between float32 and double precision, if they are many and float32 is
        /// not precise enough for the reference shader either.
        imprecise: Option<Share>,
    },
    /// Without a difference that is permitted, the shader agrees with its reference: `correct`.
    Permitted {
        /// The difference.
        difference: Difference,
        /// The mistake in this shader.
        text: String,
        /// The pixels that differ besides, which are few.
        differing: Share,
    },
    /// The shader differs from its reference only by its random numbers.
    OtherRandomNumbers {
        /// The pixels that differ.
        differing: Share,
        /// The scene's sampler; `None` for other references.
        sampler: Option<Sampler>,
        /// The result of the comparison of the means.
        means: Means,
    },
}

impl Reason {
    /// Whether the means were compared, because the shader has its own random numbers.
    #[must_use]
    pub fn compares_means(&self) -> bool {
        matches!(self, Self::OtherRandomNumbers { .. })
    }
}

/// The result of comparing the means of a shader and its reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Means {
    /// The means differ: `wrong`.
    Different {
        /// The center of the most significant difference, in pixels.
        at: [u32; 2],
        /// The significance in standard deviations, if it is known; infinite if the shader is not random.
        deviations: Option<f64>,
    },
    /// The means agree, but the shader takes fewer samples than the scene: `wrong`.
    FewerSamples {
        /// The shader's number of samples per pixel.
        own: u32,
        /// The scene's number of samples per pixel.
        scene: u32,
        /// The ratio of the variances.
        variance: f64,
    },
    /// Neighboring pixels share random numbers, so that the significance is unknown: `inconclusive`.
    Correlated,
    /// The shader is too noisy: `inconclusive`.
    TooNoisy {
        /// The ratio of the variances.
        variance: f64,
    },
    /// The samples or pixels are too few: `inconclusive`.
    Underpowered,
    /// The reference, or the shader, cannot be rendered with other random numbers: `inconclusive`.
    UnknownNoise,
    /// The means agree: `correct`.
    Same {
        /// The upper bound of the difference over the image.
        within: f64,
        /// The number of pixels that were compared.
        pixels: u64,
        /// The number of sets of random numbers that the shader was evaluated with; `None` if only its one
        /// image was compared.
        replicates: Option<usize>,
        /// The ratio of the variances, where it exceeds `MAX_VARIANCE_RATIO`.
        variance: Option<f64>,
    },
}

/// A verdict and its reason.
#[derive(Debug, Clone)]
pub struct Ruling {
    /// The verdict.
    pub verdict: Verdict,
    /// Why.
    pub reason: Reason,
}

impl Ruling {
    /// Whether the shader has a fault that a mistake may explain.
    #[must_use]
    pub fn is_fault(&self) -> bool {
        matches!(self.verdict, Verdict::Wrong | Verdict::Unstable)
    }
}

/// Returns the verdict on a shader, and its reason.
#[must_use]
pub fn decide(evidence: impl Into<Evidence>) -> Ruling {
    let (verdict, reason) = match evidence.into() {
        Evidence::NoImage(failure) => (without_image(&failure), Reason::NoImage(failure)),
        Evidence::NotEvaluated {
            failure,
            has_reference,
        } => {
            let verdict = if has_reference {
                Verdict::Inconclusive
            } else {
                Verdict::Ok
            };
            let reason = Reason::NotEvaluated {
                failure,
                has_reference,
            };
            (verdict, reason)
        }
        Evidence::Checked(evidence) => {
            let (verdict, reason) = match &evidence.random_numbers {
                Some(random_numbers) => by_means(random_numbers, &evidence.checks),
                None => by_checks(&evidence.checks, evidence.growth, evidence.imprecise_reference),
            };
            match (evidence.self_intersection, verdict) {
                (Some(cause), _) if cause.in_double => (Verdict::Wrong, Reason::SelfIntersection(cause)),
                (Some(cause), Verdict::Unstable) => (verdict, Reason::SelfIntersection(cause)),
                _ => (verdict, reason),
            }
        }
    };
    Ruling { verdict, reason }
}

/// The verdict on a shader without an image.
fn without_image(failure: &Failure) -> Verdict {
    use eval::Failure::{Interrupted, Refused, TimeUp, Timeout, TooOften};
    let is_late = |diagnostics: &[Diagnostic]| {
        let mut codes = diagnostics.iter().map(|diagnostic| diagnostic.code);
        codes.any(|code| code == Code::TooSlow)
    };
    match failure {
        Failure::Missing(_) => Verdict::Missing,
        Failure::Invalid(diagnostics) if is_late(diagnostics) => Verdict::Timeout,
        Failure::Invalid(_) => Verdict::Invalid,
        Failure::Gpu(failure) if failure.is_timeout() || is_late(failure.diagnostics()) => Verdict::Timeout,
        Failure::Gpu(failure) if failure.is_invalid() => Verdict::Invalid,
        Failure::Cpu(TooOften { .. } | Timeout { .. } | TimeUp)
        | Failure::Overdue(_)
        | Failure::LoopTruncated(_) => Verdict::Timeout,
        Failure::Unrendered(_) => Verdict::Inconclusive,
        Failure::Unreadable(_)
        | Failure::InvalidScene(_)
        | Failure::Reference(_)
        | Failure::Spool(_)
        | Failure::Gpu(_)
        | Failure::Cpu(Refused(_) | Interrupted)
        | Failure::Panic(_) => Verdict::Error,
    }
}

/// The verdict by the three checks, pixel by pixel, and by the growth of errors over frames. The precision check
/// leaves out the pixels in which the reference is imprecise too.
fn by_checks(checks: &Checks, growth: Option<VisibleGrowth>, imprecise_reference: u64) -> (Verdict, Reason) {
    let Some(algorithm) = &checks.algorithm else {
        // Without a reference, the subject is the toolchain.
        let fault = checks
            .toolchain
            .as_ref()
            .filter(|check| is_toolchain_fault(check));
        return match fault {
            Some(toolchain) => (
                Verdict::Error,
                Reason::ToolchainDiffers(Share::differing(toolchain)),
            ),
            None => (Verdict::Ok, Reason::NoReference),
        };
    };
    let differing = Share::differing(algorithm);
    if is_different(algorithm) {
        // Two right formulas differ as much where double precision is not precise enough either.
        if let Some(growth) = growth
            && matches!(growth.cause, GrowthCause::Chaos { in_double: true, .. })
        {
            return (Verdict::Chaotic, Reason::Growth(growth));
        }
        let regions = algorithm.regions;
        return (Verdict::Wrong, Reason::AlgorithmDiffers { differing, regions });
    }
    let undefined = Share::new(algorithm, algorithm.undefined);
    if undefined.ratio() > MAX_UNDEFINED {
        return (Verdict::Inconclusive, Reason::Undefined(undefined));
    }
    let tied = Share::new(algorithm, algorithm.tied);
    if tied.ratio() > MAX_UNDEFINED {
        return (Verdict::Inconclusive, Reason::ReferenceIllConditioned(tied));
    }
    let ill_conditioned = Share::new(algorithm, algorithm.ill_conditioned - algorithm.tied);
    if ill_conditioned.ratio() > MAX_UNSTABLE {
        return (Verdict::Unstable, Reason::IllConditioned(ill_conditioned));
    }
    if let Some(imprecise) = checks.precision.as_ref().map(Share::differing)
        && imprecise.ratio() > MAX_UNSTABLE
    {
        return (Verdict::Unstable, Reason::Imprecise(imprecise));
    }
    if let Some(growth) = growth {
        let verdict = match growth.cause {
            GrowthCause::Chaos { .. } => Verdict::Chaotic,
            GrowthCause::Step { .. } | GrowthCause::Accumulation => Verdict::Unstable,
        };
        return (verdict, Reason::Growth(growth));
    }
    let precision = checks.precision.as_ref();
    let tied = precision.map_or(0, |precision| precision.tied.saturating_sub(imprecise_reference));
    // With those that only the shader renders imprecisely: without a reference, all of them count.
    let imprecise =
        precision.map(|precision| Share::new(precision, precision.differing + imprecise_reference));
    let imprecise = imprecise.filter(|imprecise| imprecise_reference > 0 && imprecise.ratio() > MAX_UNSTABLE);
    let reason = Reason::Agrees {
        differing,
        ill_conditioned: algorithm.ill_conditioned,
        undefined: algorithm.undefined,
        undefined_region: algorithm.undefined_region,
        tied: algorithm.tied.max(tied),
        imprecise,
    };
    (Verdict::Correct, reason)
}

/// The verdict by the means of the random pixels, and by the checks of the others.
fn by_means(random: &OtherRandomNumbers, checks: &Checks) -> (Verdict, Reason) {
    let (verdict, means) = match random.means {
        MeanComparison::Replicates {
            test,
            pixels,
            fewer_samples,
        } => by_replicates(&test, pixels, fewer_samples, random.samples),
        MeanComparison::UnknownNoise => (Verdict::Inconclusive, Means::UnknownNoise),
        MeanComparison::OneImage { test, pixels } => match test {
            MeanTest::Different(at) => {
                let deviations = None;
                (Verdict::Wrong, Means::Different { at, deviations })
            }
            MeanTest::Underpowered => (Verdict::Inconclusive, Means::Underpowered),
            MeanTest::Correlated => (Verdict::Inconclusive, Means::Correlated),
            MeanTest::Same(within) => {
                let same = Means::Same {
                    within,
                    pixels,
                    replicates: None,
                    variance: None,
                };
                (Verdict::Correct, same)
            }
        },
    };
    if verdict == Verdict::Correct {
        // Other random numbers in float32 are not a growth of errors.
        let others = by_checks(&random.other_pixels, None, 0);
        if others.0 != Verdict::Correct {
            return others;
        }
    }
    let reason = Reason::OtherRandomNumbers {
        differing: checks
            .algorithm
            .as_ref()
            .map_or(Share { count: 0, of: 0 }, Share::differing),
        sampler: random.sampler,
        means,
    };
    (verdict, reason)
}

fn by_replicates(
    test: &ReplicateTest,
    pixels: u64,
    fewer_samples: Option<u32>,
    samples: Option<u32>,
) -> (Verdict, Means) {
    let &ReplicateTest {
        bias: Bias { deviations, at },
        within,
        variance,
        ..
    } = test;
    let is_precise = pixels >= MIN_RANDOM_PIXELS && within <= MAX_BIAS_BOUND;
    if test.is_biased {
        let deviations = Some(deviations);
        (Verdict::Wrong, Means::Different { at, deviations })
    } else if test.is_correlated {
        (Verdict::Inconclusive, Means::Correlated)
    } else if !is_precise
        && pixels >= MIN_RANDOM_PIXELS
        && variance > RARE_EVENT_VARIANCE_RATIO
        && variance.is_finite()
    {
        (Verdict::Inconclusive, Means::TooNoisy { variance })
    } else if !is_precise {
        (Verdict::Inconclusive, Means::Underpowered)
    } else if let (Some(own), Some(scene)) = (fewer_samples, samples) {
        let means = Means::FewerSamples { own, scene, variance };
        (Verdict::Wrong, means)
    } else {
        let means = Means::Same {
            within,
            pixels,
            replicates: Some(REPLICATES),
            variance: (variance > MAX_VARIANCE_RATIO).then_some(variance),
        };
        (Verdict::Correct, means)
    }
}

#[cfg(test)]
mod tests {
    use toyproof_player::DriverFailure;

    use super::*;
    use crate::compare::{CheckSummary, PixelStatus};
    use crate::evidence::CheckEvidence;

    /// The result of a check of 10,000 pixels.
    fn summary([differing, ill_conditioned, undefined]: [u64; 3], max_abs: f64) -> CheckSummary {
        CheckSummary {
            pixels: 10_000,
            differing,
            ill_conditioned,
            undefined,
            max_abs,
            ..CheckSummary::default()
        }
    }

    fn checks(algorithm: [u64; 3], precision: u64, toolchain: (u64, f64)) -> Checks {
        Checks {
            algorithm: Some(summary(algorithm, 1.0)),
            precision: Some(summary([precision, 0, 0], 1.0)),
            toolchain: Some(summary([toolchain.0, 0, 0], toolchain.1)),
        }
    }

    fn decided(evidence: CheckEvidence) -> (Verdict, Reason) {
        let Ruling { verdict, reason } = decide(evidence);
        (verdict, reason)
    }

    fn verdict(checks: Checks) -> Verdict {
        let evidence = CheckEvidence {
            checks,
            ..CheckEvidence::default()
        };
        decided(evidence).0
    }

    const SAME: (u64, f64) = (0, 0.0);

    #[test]
    fn the_verdict_changes_at_its_thresholds() {
        assert_eq!(verdict(checks([0; 3], 0, SAME)), Verdict::Correct);
        assert_eq!(verdict(checks([10, 30, 500], 30, SAME)), Verdict::Correct);
        assert_eq!(verdict(checks([11, 0, 0], 0, SAME)), Verdict::Wrong);
        assert_eq!(verdict(checks([0, 31, 0], 0, SAME)), Verdict::Unstable);
        assert_eq!(verdict(checks([0, 0, 0], 31, SAME)), Verdict::Unstable);
        assert_eq!(verdict(checks([0, 0, 501], 0, SAME)), Verdict::Inconclusive);
    }

    #[test]
    fn a_compact_region_is_a_difference_however_small() {
        let mut checks = checks([10, 0, 0], 0, SAME);
        let algorithm = checks.algorithm.as_mut().unwrap();
        let statuses: Vec<_> = (0..100)
            .map(|at| match at {
                0..3 | 20..23 | 40..43 => PixelStatus::Differs,
                _ => PixelStatus::Agrees,
            })
            .collect();
        algorithm.regions = Regions::new(PixelStatus::Differs, &statuses, 20);
        assert_eq!(verdict(checks), Verdict::Wrong);
    }

    #[test]
    fn a_wrong_shader_is_wrong_however_unstable_it_is() {
        assert_eq!(verdict(checks([11, 5_000, 501], 5_000, SAME)), Verdict::Wrong);
    }

    #[test]
    fn a_broken_toolchain_takes_no_verdict_away() {
        let broken = (10_000, 1.0);
        assert_eq!(verdict(checks([0; 3], 0, broken)), Verdict::Correct);
        assert_eq!(verdict(checks([5_000, 0, 0], 0, broken)), Verdict::Wrong);
        assert_eq!(verdict(checks([0; 3], 31, broken)), Verdict::Unstable);
        assert_eq!(verdict(checks([0, 0, 501], 0, broken)), Verdict::Inconclusive);
    }

    #[test]
    fn without_a_reference_a_broken_toolchain_is_an_error_and_lost_bits_are_not() {
        let toolchain = |differing, undefined, max_abs| {
            verdict(Checks {
                toolchain: Some(summary([differing, 0, undefined], max_abs)),
                ..Checks::default()
            })
        };
        assert_eq!(toolchain(11, 0, 0.1), Verdict::Error);
        assert_eq!(toolchain(10_000, 0, 1e-6), Verdict::Ok);
        assert_eq!(toolchain(10, 0, 1.0), Verdict::Ok);
        let [few, many] = [4_000, 6_000].map(|undefined| toolchain(5_000, undefined, 0.1));
        assert_eq!((few, many), (Verdict::Error, Verdict::Ok));
    }

    #[test]
    fn without_a_scene_a_shader_is_ok() {
        let precision = Some(summary([5_000, 0, 0], 1.0));
        let checks = Checks {
            precision,
            ..Checks::default()
        };
        assert_eq!(verdict(checks), Verdict::Ok);
    }

    #[test]
    fn edges_of_the_scene_do_not_count_against_the_shader() {
        let mut checks = checks([0, 500, 0], 0, SAME);
        checks.algorithm.as_mut().unwrap().tied = 470;
        assert_eq!(verdict(checks.clone()), Verdict::Correct);
        let algorithm = checks.algorithm.as_mut().unwrap();
        (algorithm.ill_conditioned, algorithm.tied) = (501, 501);
        assert_eq!(verdict(checks), Verdict::Inconclusive, "too few pixels are left");
    }

    #[test]
    fn a_reference_that_is_as_imprecise_hides_no_loss_of_precision() {
        // 20 pixels of the shader alone, 15 of the reference too, and 5 on an edge that passes exactly.
        let mut checks = checks([0; 3], 20, SAME);
        let precision = checks.precision.as_mut().unwrap();
        (precision.ill_conditioned, precision.tied) = (20, 20);
        let imprecise = |imprecise_reference: u64| {
            let evidence = CheckEvidence {
                checks: checks.clone(),
                imprecise_reference,
                ..CheckEvidence::default()
            };
            match decided(evidence) {
                (Verdict::Correct, Reason::Agrees { tied, imprecise, .. }) => {
                    (tied, imprecise.map(|share| share.count))
                }
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(imprecise(15), (5, Some(35)));
        assert_eq!(imprecise(10), (10, None), "no more than may be imprecise");
        assert_eq!(imprecise(0), (20, None));
    }

    #[test]
    fn self_intersection_is_wrong_only_if_double_precision_shows_it() {
        let decided = |algorithm, in_double| {
            decided(CheckEvidence {
                checks: checks(algorithm, 500, SAME),
                self_intersection: Some(SelfIntersection {
                    pixels: Share {
                        count: 500,
                        of: 10_000,
                    },
                    in_double,
                }),
                ..CheckEvidence::default()
            })
        };
        let (verdict, reason) = decided([0, 500, 0], true);
        assert_eq!(verdict, Verdict::Wrong);
        assert!(matches!(reason, Reason::SelfIntersection(_)), "{reason:?}");
        let (verdict, reason) = decided([0; 3], false);
        assert_eq!(verdict, Verdict::Unstable);
        assert!(matches!(reason, Reason::SelfIntersection(_)), "{reason:?}");
        let (verdict, reason) = decided([11, 0, 0], false);
        assert_eq!(verdict, Verdict::Wrong);
        assert!(matches!(reason, Reason::AlgorithmDiffers { .. }), "{reason:?}");
    }

    /// A shader with other random numbers than its scene; `other_pixels` are the pixels without random
    /// numbers.
    fn random(means: MeanComparison, other_pixels: Checks) -> (Verdict, Reason) {
        decided(CheckEvidence {
            checks: checks([5_000, 0, 0], 0, SAME),
            random_numbers: Some(OtherRandomNumbers {
                sampler: Some(Sampler::Sobol),
                samples: Some(16),
                means,
                other_pixels,
            }),
            ..CheckEvidence::default()
        })
    }

    const UNBIASED: ReplicateTest = ReplicateTest {
        bias: Bias {
            deviations: 1.0,
            at: [3, 4],
        },
        is_biased: false,
        within: 0.001,
        is_correlated: false,
        variance: 1.0,
        is_uniform: true,
    };

    fn replicates(test: ReplicateTest, pixels: u64, fewer_samples: Option<u32>) -> MeanComparison {
        MeanComparison::Replicates {
            test,
            pixels,
            fewer_samples,
        }
    }

    #[test]
    fn means_decide_on_other_random_numbers() {
        let of = |test, pixels, fewer| random(replicates(test, pixels, fewer), checks([0; 3], 0, SAME)).0;
        let biased = ReplicateTest {
            is_biased: true,
            ..UNBIASED
        };
        let correlated = ReplicateTest {
            is_correlated: true,
            ..UNBIASED
        };
        let vague = ReplicateTest {
            within: 0.02,
            ..UNBIASED
        };
        assert_eq!(of(UNBIASED, 1000, None), Verdict::Correct);
        assert_eq!(of(biased, 1, None), Verdict::Wrong);
        assert_eq!(of(UNBIASED, 1000, Some(4)), Verdict::Wrong);
        assert_eq!(of(correlated, 1000, None), Verdict::Inconclusive);
        assert_eq!(of(vague, 1000, None), Verdict::Inconclusive);
        assert_eq!(of(UNBIASED, 999, Some(4)), Verdict::Inconclusive);
    }

    #[test]
    fn noise_is_named_as_the_cause_only_where_it_is() {
        let noisy = ReplicateTest {
            within: 0.02,
            variance: 2.0 * RARE_EVENT_VARIANCE_RATIO,
            ..UNBIASED
        };
        let means = |test, pixels| match random(replicates(test, pixels, None), Checks::default()).1 {
            Reason::OtherRandomNumbers { means, .. } => means,
            other => panic!("{other:?}"),
        };
        assert!(matches!(means(noisy, 1000), Means::TooNoisy { .. }));
        assert_eq!(means(noisy, 999), Means::Underpowered);
        let endless = ReplicateTest {
            variance: f64::INFINITY,
            ..noisy
        };
        assert_eq!(means(endless, 1000), Means::Underpowered);
    }

    #[test]
    fn equal_means_do_not_excuse_the_other_pixels() {
        let (verdict, reason) = random(replicates(UNBIASED, 1000, None), checks([0; 3], 31, SAME));
        assert_eq!(verdict, Verdict::Unstable);
        assert!(matches!(reason, Reason::Imprecise(_)), "{reason:?}");
        let one_image = MeanComparison::OneImage {
            test: MeanTest::Different([1, 2]),
            pixels: 1000,
        };
        assert_eq!(random(one_image, checks([0; 3], 31, SAME)).0, Verdict::Wrong);
    }

    #[test]
    fn without_an_image_the_failure_decides() {
        let of = |failure| decide(Evidence::NoImage(failure)).verdict;
        let error = |code| vec![Diagnostic::new(code, "x")];
        assert_eq!(of(Failure::Missing("no shader".to_owned())), Verdict::Missing);
        assert_eq!(of(Failure::Invalid(error(Code::Redeclared))), Verdict::Invalid);
        assert_eq!(of(Failure::Invalid(error(Code::TooSlow))), Verdict::Timeout);
        assert_eq!(
            of(Failure::InvalidScene(error(Code::SceneSyntax))),
            Verdict::Error
        );
        assert_eq!(of(Failure::LoopTruncated(1)), Verdict::Timeout);
        assert_eq!(
            of(Failure::Unrendered("buffers".to_owned())),
            Verdict::Inconclusive
        );
        assert_eq!(
            of(Failure::Gpu(DriverFailure::Device(String::new()))),
            Verdict::Error
        );
        assert_eq!(of(Failure::Cpu(eval::Failure::TimeUp)), Verdict::Timeout);
    }

    #[test]
    fn a_failure_of_the_evaluator_is_inconclusive_only_if_there_is_something_to_compare_with() {
        let of = |has_reference| {
            let failure = eval::Failure::Interrupted;
            let evidence = Evidence::NotEvaluated {
                failure,
                has_reference,
            };
            decide(evidence).verdict
        };
        assert_eq!((of(true), of(false)), (Verdict::Inconclusive, Verdict::Ok));
    }
}
