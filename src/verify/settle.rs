//! The final verdict: which tests a fault calls for, and where a verdict may still change.
//!
//! Only this module, [`decide`](mod@crate::decide) and the places it names decide on verdicts:
//!
//! 1. [`decide`] maps evidence to a verdict and its reason, as a pure function.
//! 2. [`Subject::settle`] completes the evidence on a shader that was evaluated. The verdict by the three
//!    checks is final unless it is a fault that no mistake explains: then the means are compared, if random
//!    numbers may be the cause, and self-intersection is tested for.
//! 3. A difference that is permitted is evidence of its own: the same checks, and the algorithm check without
//!    that difference.
//! 4. A denied warning is evidence too: the shader is invalid, so that there is no image.
//! 5. Without all of its media, that a project renders means little: [`Verdict::with_missing_media`].
//!
//! [`Verdict::with_missing_media`]: crate::Verdict::with_missing_media

use std::time::Instant;

use crate::decide::{Reason, Ruling, Verdict, decide};
use crate::evidence::{CheckEvidence, Checks, SelfIntersection};
use crate::expected::Expected;
use crate::random::Reseeding;
use crate::random::stochastic::MeansEvidence;
use crate::self_intersection;
use crate::verified::Subject;

/// What a verdict is based on while it is being settled.
#[derive(Debug, Clone, Copy)]
pub enum Basis<'a> {
    /// The three checks.
    Checks(&'a Checks),
    /// The comparison of means, and how the shader's random numbers were changed for it, if they were.
    Means(Option<Reseeding>),
    /// The test for self-intersection, which it explains.
    SelfIntersection,
}

/// A final verdict, and what led to it.
#[derive(Debug)]
pub struct Settlement<M> {
    /// The verdict and its reason.
    pub ruling: Ruling,
    /// The mistake that explains it, if one is known.
    pub mistake: Option<M>,
    /// Whether the means were compared.
    pub compares_means: bool,
    /// How the shader's random numbers were changed for that, if they were.
    pub reseeding: Option<Reseeding>,
}

impl<M> Settlement<M> {
    /// Whether there is a fault, and no mistake is known that explains it.
    fn is_unexplained(&self) -> bool {
        self.ruling.is_fault() && self.mistake.is_none()
    }
}

impl Subject<'_> {
    /// Settles the verdict. `explain` searches for the mistake behind a verdict on some basis; it is called
    /// with all verdicts, faults or not. The deadline is only there against a hang.
    pub fn settle<M>(
        &self,
        deadline: Instant,
        mut explain: impl FnMut(&Ruling, Basis<'_>) -> Option<M>,
    ) -> Settlement<M> {
        let mut evidence = self.evidence();
        let ruling = decide(evidence.clone());
        let mut settlement = Settlement {
            mistake: explain(&ruling, Basis::Checks(&evidence.checks)),
            ruling,
            compares_means: false,
            reseeding: None,
        };
        if settlement.is_unexplained()
            && let Some(means) = self.compare_means(&evidence, deadline)
        {
            evidence.random_numbers = Some(means.random_numbers);
            let ruling = decide(evidence.clone());
            settlement = Settlement {
                mistake: explain(&ruling, Basis::Means(means.reseeding)),
                ruling,
                compares_means: true,
                reseeding: means.reseeding,
            };
        }
        if settlement.is_unexplained() {
            evidence.self_intersection = self.self_intersection();
            settlement.ruling = decide(evidence);
            if matches!(settlement.ruling.reason, Reason::SelfIntersection(_)) {
                settlement.mistake = explain(&settlement.ruling, Basis::SelfIntersection);
            }
        }
        settlement
    }

    /// Compares the means of a shader that differs only in pixels that depend on random numbers; `None` if it
    /// differs in others, or if nothing is random.
    fn compare_means(&self, evidence: &CheckEvidence, deadline: Instant) -> Option<MeansEvidence> {
        let (stochastic, algorithm) = (self.stochastic?, self.results.algorithm.as_ref()?);
        let shader = self.replicated_shader(deadline)?;
        let mut means = stochastic.compare_means(shader, algorithm, &evidence.checks)?;
        // The precision of the pixels that do not depend on random numbers costs samples of the scene, and
        // counts only where everything else agrees.
        if let Some(precision) = &self.results.precision {
            let ruling = decide(CheckEvidence {
                random_numbers: Some(means.random_numbers.clone()),
                ..evidence.clone()
            });
            if ruling.verdict == Verdict::Correct {
                means.random_numbers.other_pixels.precision =
                    Some(stochastic.precision_of_others(algorithm, precision));
            }
        }
        Some(means)
    }

    /// Returns the pixels that differ because rays hit the surfaces they start from, if enough do.
    fn self_intersection(&self) -> Option<SelfIntersection> {
        let tracer = self.case.expected.and_then(Expected::tracer)?;
        let [algorithm, precision] = [&self.results.algorithm, &self.results.precision].map(Option::as_ref);
        self_intersection::detect(tracer, self.case.frame.size, algorithm, precision)
    }
}
