//! The order in which explanations of a difference are searched for, and the verdict that follows.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use toyproof_diagnostic::Diagnostic;
use toyproof_eval::Places;
use toyproof_image::Frame;
use toyproof_numerics::rewrite::{self, rewrite};
use toyproof_verify::bounds::explanation_deadline;
use toyproof_verify::compare::CheckResult;
use toyproof_verify::contain::{Panic, Part, contain};
use toyproof_verify::random::Reseeding;
use toyproof_verify::{
    Basis, CheckEvidence, Checks, MAX_UNSTABLE, Reason, Ruling, Settlement, Share, Subject, Verdict,
    Verified, cause, decide, unbound, within,
};

use crate::departure::{self, Departure};
use crate::engine::confirm::Confirmer;
use crate::known::{self, Diagnosis, Stage};
use crate::repair::{self, NoisyImage, SearchResult};
use crate::whole_image::{self, Alternative, Alternatives, Submission};
use crate::{Explanation, Options};

/// The largest number of pairs of mistakes that are searched for in a wrong image: a few seconds' work.
const MAX_PAIRS: usize = 512;

/// The size of the images on which other forms of expressions are tried, and the number of such forms, those
/// next to the cause first: all of them together are few pixels beside the image itself.
const MAX_REWRITTEN_PIXELS: f64 = 128.0 * 72.0;
const MAX_REWRITES: usize = 16;

/// The largest numbers of columns and of rows of pixels with which repairs of a stochastic shader are tried.
const NOISY_SIDE: u32 = 24;

/// Explains why an image is wrong or imprecise. The verdict is that of the checks, unless the difference is
/// permitted (`correct`), or no mistake explains it and the means or the rays of the shader do.
#[must_use]
pub fn explain(verified: &Verified, options: &Options) -> Explanation {
    let Some(subject) = verified.subject() else {
        return Explanation::without_search(decide(verified.evidence()));
    };
    within(subject.case.pool, || Search::new(subject, options).run())
}

impl Explanation {
    /// A verdict that needs no explanation.
    fn without_search(ruling: Ruling) -> Self {
        Self {
            ruling,
            permitted: None,
            cause: None,
            mistake: None,
            departure: None,
            search: None,
            tolerated_mistake: None,
            is_cut_by_time: false,
            notes: Vec::new(),
            panics: Vec::new(),
        }
    }
}

/// A search for explanations.
struct Search<'a> {
    subject: Subject<'a>,
    options: &'a Options<'a>,
    /// The end of the search, which only a hang exceeds.
    deadline: Instant,
    panics: Vec<Panic>,
}

impl<'a> Search<'a> {
    fn new(subject: Subject<'a>, options: &'a Options<'a>) -> Self {
        Self {
            subject,
            options,
            deadline: explanation_deadline(options.search.map_or(0.0, |search| search.budget)),
            panics: Vec::new(),
        }
    }

    fn run(mut self) -> Explanation {
        if let Some(permitted) = self.permitted() {
            return permitted;
        }
        let Settlement {
            ruling,
            mistake,
            reseeding,
            compares_means,
        } = self.settle();
        // From here on, the verdict is final.
        let tolerated_mistake = if compares_means {
            None
        } else {
            self.of_few_pixels(&ruling)
        };
        let departure = self.departure(&ruling);
        let search = self.repairs(&ruling, reseeding);
        let case = self.subject.case;
        let cause = self.loss_of_precision(&ruling);
        let span = cause.as_ref().and_then(|cause| cause.span);
        let mut warnings = case.lints.warnings.iter();
        let is_reported = warnings.any(|warning| warning.span == span);
        let mut notes = unbound(case.checked, case.lints, case.frame);
        notes.extend(cause.filter(|cause| !is_reported && !case.lints.allows(cause)));
        Explanation {
            cause: span,
            departure,
            mistake: mistake.filter(|mistake| is_preferred(mistake, search.as_ref())),
            search,
            tolerated_mistake,
            // What gave up because of the deadline did so after it.
            is_cut_by_time: Instant::now() >= self.deadline,
            notes,
            panics: self.panics,
            ..Explanation::without_search(ruling)
        }
    }

    /// The explanation of a shader that is right but for a permitted difference.
    fn permitted(&mut self) -> Option<Explanation> {
        let permitted = self.options.alternatives?.permitted;
        let evidence = self.subject.evidence();
        if permitted.is_empty() || decide(evidence.clone()).verdict != Verdict::Wrong {
            return None;
        }
        let (difference, found) = self.in_submission(&evidence.checks, |submission| {
            whole_image::find_permitted(submission, permitted)
        })?;
        let algorithm = found.algorithm;
        let differing = Share::differing(&algorithm);
        let mut ruling = decide(CheckEvidence {
            checks: Checks {
                algorithm: Some(algorithm.clone()),
                ..evidence.checks
            },
            ..evidence
        });
        if ruling.verdict == Verdict::Correct {
            ruling.reason = Reason::Permitted {
                difference,
                text: found.mistake.description.into_owned(),
                differing,
            };
        }
        Some(Explanation {
            permitted: Some(algorithm),
            panics: std::mem::take(&mut self.panics),
            ..Explanation::without_search(ruling)
        })
    }

    /// Settles the verdict, and searches for a mistake.
    fn settle(&mut self) -> Settlement<Diagnosis> {
        let (subject, deadline) = (self.subject, self.deadline);
        let mut settlement = subject.settle(deadline, |ruling, basis| match basis {
            Basis::Checks(checks) => self.of_checks(ruling, checks),
            Basis::Means(reseeding) => self.of_noisy_pixels(ruling, reseeding),
            Basis::SelfIntersection => Some(Diagnosis::single(known::self_intersection())),
        });
        // Pairs are searched for only if the comparison of random pixels reaches no verdict: with other
        // random numbers, two mistakes do not render the image of the pair.
        if subject.may_be_stochastic() && !settlement.compares_means && settlement.mistake.is_none() {
            settlement.mistake = self.of_scene(&settlement.ruling, Stage::Pair(MAX_PAIRS));
        }
        settlement
    }

    /// Searches for a mistake that explains every pixel, which is reported whatever random numbers the shader
    /// uses.
    fn of_checks(&mut self, ruling: &Ruling, checks: &Checks) -> Option<Diagnosis> {
        let mut mistake = self.of_scene(ruling, Stage::Single);
        mistake = self.of_whole_image(ruling, checks, mistake, whole_image::find);
        mistake = mistake.or_else(|| self.of_scene(ruling, Stage::Number));
        // A wrong number, such as a light's intensity, says more than the curve that it amounts to.
        mistake = self.of_whole_image(ruling, checks, mistake, whole_image::find_curve);
        if !self.subject.may_be_stochastic() {
            mistake = mistake.or_else(|| self.of_scene(ruling, Stage::Pair(MAX_PAIRS)));
        }
        mistake
    }

    /// Searches for the mistake that explains a wrong image, or for two.
    fn of_scene(&mut self, ruling: &Ruling, stage: Stage) -> Option<Diagnosis> {
        let hypotheses = self.options.hypotheses?;
        let Subject { program, case, .. } = self.subject;
        if ruling.verdict != Verdict::Wrong {
            return None;
        }
        self.contained(Part::Mistake, || {
            hypotheses.recognize_in(stage, program, case.frame)
        })
    }

    /// Searches for a difference that concerns the whole image, which says more than a symptom.
    fn of_whole_image(
        &mut self,
        ruling: &Ruling,
        checks: &Checks,
        known: Option<Diagnosis>,
        find: impl FnOnce(&Submission, &Alternatives) -> Option<Alternative>,
    ) -> Option<Diagnosis> {
        let is_symptom = |mistake: &Diagnosis| mistake.mistakes.iter().all(|mistake| mistake.is_symptom);
        let differs = matches!(ruling.reason, Reason::AlgorithmDiffers { .. });
        let Some(alternatives) = self.options.alternatives.filter(|_| differs) else {
            return known;
        };
        if !known.as_ref().is_none_or(is_symptom) {
            return known;
        }
        let found = self.in_submission(checks, |submission| find(submission, &alternatives));
        found.map_or(known, |found| Some(Diagnosis::single(found.mistake)))
    }

    /// Searches among hypotheses about the whole image of the shader.
    fn in_submission<T>(
        &mut self,
        checks: &Checks,
        find: impl FnOnce(&Submission) -> Option<T>,
    ) -> Option<T> {
        let (subject, deadline) = (self.subject, self.deadline);
        self.contained(Part::Mistake, || {
            let confirmer = Confirmer::new(subject, checks, deadline)?;
            find(&Submission::new(&confirmer, subject.program)?)
        })
    }

    /// Searches for the mistake of a shader whose means differ.
    fn of_noisy_pixels(&mut self, ruling: &Ruling, reseeding: Option<Reseeding>) -> Option<Diagnosis> {
        let (hypotheses, reseeding) = (self.options.hypotheses?, reseeding?);
        let (subject, deadline) = (self.subject, self.deadline);
        if ruling.verdict != Verdict::Wrong {
            return None;
        }
        self.contained(Part::Mistake, || {
            let pixels = subject.noisy_pixels(reseeding, hypotheses.places(), deadline)?;
            hypotheses.recognize_noisy(&pixels)
        })
    }

    /// Searches for the place where the values of a wrong shader depart from those of its reference.
    fn departure(&mut self, ruling: &Ruling) -> Option<Departure> {
        let Subject {
            case,
            program,
            results,
            ..
        } = self.subject;
        let (algorithm, expected) = (results.algorithm.as_ref()?, case.expected?);
        if ruling.verdict != Verdict::Wrong || ruling.reason.compares_means() {
            return None;
        }
        let (deadline, with_images) = (self.deadline, self.options.value_images);
        self.contained(Part::Mistake, || {
            departure::find(program, case.frame, expected, algorithm, with_images, deadline)
        })
    }

    /// Searches for edits that repair a wrong image, and for the lines that it depends on. `reseeding` is
    /// there if the shader's means were compared.
    fn repairs(&mut self, ruling: &Ruling, reseeding: Option<Reseeding>) -> Option<SearchResult> {
        let (subject, deadline) = (self.subject, self.deadline);
        let options = self.options.search?;
        if ruling.verdict != Verdict::Wrong {
            return None;
        }
        let image = || {
            // A shader that differs in other pixels, too, may have random numbers of its own.
            let reseeding = reseeding.or_else(|| subject.reseeding(deadline))?;
            let places = Places::spread(subject.case.frame.size, [NOISY_SIDE; 2]);
            let pixels = subject.noisy_pixels(reseeding, &places, deadline)?;
            Some(NoisyImage { pixels, places })
        };
        self.contained(Part::Repair, || {
            let checks = subject.results.checks();
            let confirmer = Confirmer::new(subject, &checks, deadline)?;
            repair::search(&confirmer, options, ruling.reason.compares_means(), &image)
        })
    }

    /// Searches for the mistake that explains the few differing pixels of a correct image.
    fn of_few_pixels(&mut self, ruling: &Ruling) -> Option<Diagnosis> {
        let hypotheses = self.options.hypotheses?;
        let subject = self.subject;
        let algorithm = subject.results.algorithm.as_ref()?;
        if ruling.verdict != Verdict::Correct || algorithm.summary.differing == 0 {
            return None;
        }
        let differing = algorithm.sample_pixels(subject.case.frame.size, usize::MAX);
        self.contained(Part::Mistake, || {
            hypotheses.explaining(subject.program, &differing)
        })
    }

    /// Searches for the line in which float32 loses precision, where it is not enough.
    fn loss_of_precision(&mut self, ruling: &Ruling) -> Option<Diagnostic> {
        let (subject, deadline) = (self.subject, self.deadline);
        let results = subject.results;
        let differs_often = |check: &CheckResult| Share::differing(&check.summary).ratio() > MAX_UNSTABLE;
        let loses_precision = match &ruling.reason {
            Reason::Agrees { imprecise, .. } => imprecise.is_some(),
            Reason::NoReference => results.precision.as_ref().is_some_and(differs_often),
            _ => false,
        };
        if ruling.verdict != Verdict::Unstable && !loses_precision {
            return None;
        }
        self.contained(Part::Cause, || {
            let mut checks = [&results.precision, &results.algorithm].into_iter().flatten();
            let found = checks.find_map(|check| cause(subject.program, subject.case.frame, deadline, check));
            found.map(|cause| match ruling.verdict {
                Verdict::Correct => cause.note("the reference loses precision at the same place"),
                _ => cause,
            })
        })
        .map(|cause| self.with_rewrite(cause))
    }

    /// Adds a form of the expressions near a loss of precision that loses fewer digits, if there is one.
    fn with_rewrite(&mut self, cause: Diagnostic) -> Diagnostic {
        let (subject, deadline) = (self.subject, self.deadline);
        let Some(search) = self.options.search.filter(|search| search.pass.is_none()) else {
            return cause;
        };
        let frame = subject.case.frame;
        let pixels = f64::from(frame.size[0]) * f64::from(frame.size[1]);
        let scale = (MAX_REWRITTEN_PIXELS / pixels).sqrt().min(1.0);
        let frame = Frame {
            size: frame.size.map(|side| (f64::from(side) * scale).ceil() as u32),
            ..frame.clone()
        };
        let rewritten = rewrite::Subject {
            checked: subject.case.checked,
            text: search.source,
            frame: &frame,
            near: cause.span,
            max_candidates: MAX_REWRITES,
        };
        let found = self.contained(Part::Repair, || {
            rewrite(rewritten, deadline, &AtomicBool::new(false))
        });
        match found.and_then(|found| found.fix) {
            Some(fix) => cause.fix(fix),
            None => cause,
        }
    }

    /// Returns a part's result, or the default if it panicked, which is recorded.
    fn contained<T: Default>(&mut self, part: Part, work: impl FnOnce() -> T) -> T {
        contain(part, work).unwrap_or_else(|panic| {
            self.panics.push(panic);
            T::default()
        })
    }
}

/// Whether known mistakes are reported beside the repairs that were found. An edit after which whole images
/// are right in all frames beats two mistakes that explain most pixels of one; a single mistake names what
/// the edit corrects.
fn is_preferred(mistake: &Diagnosis, search: Option<&SearchResult>) -> bool {
    let first = search.and_then(|search| search.repairs.first());
    let is_repaired = first.is_some_and(|repair| repair.is_complete() && repair.is_single());
    mistake.mistakes.len() == 1 || !is_repaired
}
