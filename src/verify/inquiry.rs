//! The questions while they are asked, one band of rows after the other: whole pictures are kept only as they are shown.

use std::fmt::Write;
use std::ops::Range;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};
use std::thread;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use toyproof_eval::{self as eval, Observations, Program};
use toyproof_image::{Image, Shown};
use toyproof_scene::Scene;
use toyproof_tracer::{Hull, RayStyles, StyleFamily, Styles};
use toyproof_translate::FloatMode;

use super::cause::{self, NotFinite};
use super::cpu::{Band, Evaluator};
use super::drawn::{Found, Painted};
use super::expected::Digits;
use super::tangent::{self, Trap};
use super::{Asked, Case, Expected, Failure, Findings, PAIRS, Painter, acne, join, notes, timed};
use crate::compare::{self, Answers, Comparison, MAX_UNSTABLE, Mark, Mixed, Reference, Standing, Verdict};
use crate::contain::{Panic, Part, contain};

/// Told after each band.
#[derive(Debug, Clone, Copy)]
pub(super) struct Counted {
    /// The most rounds of loops that a pixel of it ran in f32.
    pub(super) most: u32,
    pub(super) is_last: bool,
}

/// What is known so far.
pub(super) struct Inquiry<'a> {
    case: &'a Case<'a>,
    /// Why it gave up, if it did.
    pub(super) evaluator: Result<Evaluator<'a>, eval::Failure>,
    /// When all must be answered.
    until: Instant,
    counted: Option<Sender<Counted>>,
    /// What was noted in f32.
    pub(super) noted: Observations,
    leaves_out: bool,
    maths: Asked,
    mixed: Mixed,
    rounding: Asked,
    toolchain: Option<Asked>,
    picture: Option<(Comparison, Vec<Mark>)>,
    actual: Shown,
    reference: Option<Shown>,
    not_finite: NotFinite,
    /// Spheres whose edge may come out wrong, and the picture in f64, if there are any.
    traps: Option<(Scene, Vec<Trap>, Shown)>,
    /// What may hang on what is drawn, where the scene draws its samples.
    painted: Option<Painted<'a>>,
    eval: Duration,
    trace: Duration,
}

impl<'a> Inquiry<'a> {
    pub(super) fn new(
        case: &'a Case<'a>,
        evaluator: Result<Evaluator<'a>, eval::Failure>,
        until: Instant,
        counted: Sender<Counted>,
    ) -> Self {
        let [width, height] = case.frame.size;
        let empty = || Shown::empty(width, height);
        let traps = case
            .expected
            .filter(|_| !case.lints.discriminants.is_empty())
            .map(|expected| {
                let scene = expected.stilled();
                let suspected = tangent::suspected(&scene);
                (scene, suspected, empty())
            });
        Self {
            case,
            until,
            counted: evaluator.is_ok().then_some(counted),
            evaluator,
            noted: Observations::default(),
            leaves_out: false,
            maths: Asked::default(),
            mixed: Mixed::of(u64::from(width) * u64::from(height)),
            rounding: Asked::default(),
            toolchain: None,
            picture: None,
            actual: empty(),
            reference: case.expected.map(|_| empty()),
            not_finite: NotFinite::default(),
            traps: traps.filter(|(_, suspected, _)| !suspected.is_empty()),
            painted: case
                .expected
                .and_then(|expected| Painted::new(expected.tracer(), case.frame.size)),
            eval: Duration::ZERO,
            trace: Duration::ZERO,
        }
    }

    /// Asks of all bands. A GPU paints all of them before it hands them over, one by one; if it fails, it tells so itself.
    ///
    /// # Errors
    /// Why there is no picture, where no GPU paints.
    pub(super) fn bands(&mut self, gpu: Option<&Receiver<Image>>) -> Result<(), Failure> {
        for rows in self.case.frame.bands() {
            let (band, reference) = self.paint(&rows);
            let actual = match gpu {
                None => None,
                Some(gpu) => match gpu.recv() {
                    Ok(band) => Some(band),
                    Err(_) => return Ok(()),
                },
            };
            if let (None, Err(failure)) = (gpu, &self.evaluator) {
                return Err(failure.clone().into());
            }
            self.compare(&rows, band.as_ref(), reference.as_deref(), actual.as_ref());
        }
        self.counted = None;
        Ok(())
    }

    /// What the evaluator and the tracer paint of a band, at once.
    fn paint(&mut self, rows: &Range<u32>) -> (Option<Band>, Option<Arc<Image>>) {
        let height = self.case.frame.size[1];
        let counted = |most| {
            let is_last = rows.end == height;
            if let Some(sender) = &self.counted {
                // Perhaps nobody asks.
                let _ = sender.send(Counted { most, is_last });
            }
        };
        let evaluator = &self.evaluator;
        let ((band, eval), traced) = thread::scope(|scope| {
            let trace = |expected: &Expected| timed(|| expected.rows(rows));
            let traced = self
                .case
                .expected
                .map(|expected| scope.spawn(move || trace(expected)));
            let evaluated = timed(|| match evaluator {
                Ok(evaluator) => evaluator.paint(rows, counted).map(Some),
                Err(_) => Ok(None),
            });
            (evaluated, traced.map(join))
        });
        self.eval += eval;
        let band = band.unwrap_or_else(|failure| {
            self.evaluator = Err(failure);
            // Nobody waits for more.
            self.counted = None;
            None
        });
        let reference = traced.map(|(reference, trace)| {
            self.trace += trace;
            reference
        });
        (band, reference)
    }

    /// Compares a band; `drawn` is what a GPU painted of it.
    fn compare(
        &mut self,
        rows: &Range<u32>,
        band: Option<&Band>,
        reference: Option<&Image>,
        drawn: Option<&Image>,
    ) {
        let below = rows.start;
        if let Some(actual) = drawn.or(band.map(|band| &band.single)) {
            self.actual.extend(actual);
            self.not_finite.look(actual, below);
            if let (Some(reference), Some(shown)) = (reference, &mut self.reference) {
                shown.extend(reference);
                let (comparison, marks) = compare::compare(reference, actual);
                match &mut self.picture {
                    None => self.picture = Some((comparison, marks)),
                    Some((whole, all)) => {
                        whole.extend(&comparison, below);
                        all.extend(marks);
                    }
                }
            }
        }
        let Some(band) = band else {
            return;
        };
        let actual = drawn.unwrap_or(&band.single);
        if let Some(reference) = reference {
            self.ask_maths(rows, band, reference);
            if let Some(painted) = &mut self.painted {
                painted.look(&band.double, reference, below);
            }
        }
        let mut standings = compare::rounding(&band.double, actual, &band.undefined);
        if let Some(expected) = self.case.expected {
            leave_out_tied(
                &mut standings,
                |x, y| expected.is_tied(x, below + y, Digits::Single),
                actual.size()[0],
            );
        }
        self.rounding.extend(&band.double, actual, &standings, below);
        if let (Some(drawn), FloatMode::Strict) = (drawn, self.case.float) {
            let standings = compare::toolchain(&band.single, drawn, &band.undefined);
            let asked = self.toolchain.get_or_insert_default();
            asked.extend(&band.single, drawn, &standings, below);
        }
        if let Some((_, _, double)) = &mut self.traps {
            double.extend(&band.double);
        }
        self.leaves_out |= band.undefined.contains(&true);
        self.noted.merge(&band.noted);
    }

    fn ask_maths(&mut self, rows: &Range<u32>, band: &Band, reference: &Image) {
        let (Some(expected), Ok(evaluator)) = (self.case.expected, &self.evaluator) else {
            return;
        };
        let below = rows.start;
        let from_row = FromRow {
            expected,
            below,
            derives: self.case.checked.takes_derivatives(),
        };
        let (standings, shaking) = timed(|| {
            let shaken = |seed, wanted: &[bool]| evaluator.shaken(rows, seed, wanted);
            let mixed = &mut self.mixed;
            compare::maths(reference, &band.double, &band.undefined, &from_row, mixed, shaken)
        });
        self.eval += shaking;
        self.maths.extend(reference, &band.double, &standings, below);
    }

    /// What was found, where `painter` painted.
    pub(super) fn findings(self, painter: Option<Painter>) -> Findings {
        let mut findings = Findings {
            verdict: Verdict::Ok,
            reason: String::new(),
            maths: None,
            rounding: None,
            toolchain: None,
            picture: self.picture,
            reference: self.reference,
            actual: self.actual,
            painter,
            notes: Vec::new(),
            cause: None,
            mistake: None,
            panics: Vec::new(),
            eval: self.eval,
            trace: self.case.expected.map(|_| self.trace),
        };
        match self.evaluator {
            Err(failure) => findings.cannot_ask(&failure),
            Ok(evaluator) => {
                findings.maths = self.case.expected.map(|_| self.maths);
                findings.rounding = Some(self.rounding);
                findings.toolchain = self.toolchain;
                let (case, program) = (self.case, evaluator.program());
                findings.notes = notes::notes(&self.noted, self.leaves_out, &case.lints.warnings);
                let (not_finite, traps, actual) = (self.not_finite, self.traps, &findings.actual);
                let notes = contain(Part::Notes, || {
                    let mut notes: Vec<_> = not_finite.told(program, case, self.until).into_iter().collect();
                    if let (Some((scene, traps, double)), Some(&at)) =
                        (traps, case.lints.discriminants.first())
                    {
                        let traps = tangent::shown(traps, &scene, actual, &double);
                        notes.extend(tangent::told(&traps, at));
                    }
                    notes
                });
                let notes = findings.contained(notes);
                findings.notes.extend(notes);
                findings.judge(case, program, self.until, self.painted.as_ref());
                findings.notes.retain(|note| !case.lints.allows(note));
            }
        }
        findings
    }
}

/// What a band is compared with that begins at a row.
struct FromRow<'a> {
    expected: &'a Expected,
    below: u32,
    /// Whether the shader takes derivatives.
    derives: bool,
}

impl Reference for FromRow<'_> {
    fn hull(&self, x: u32, y: u32, styles: Styles) -> Hull {
        self.expected.hull(x, self.below + y, styles)
    }
    fn families(&self) -> &[StyleFamily] {
        self.expected.families()
    }
    fn styled(&self, x: u32, y: u32, styles: &RayStyles) -> [f64; 3] {
        self.expected.styled(x, self.below + y, styles)
    }
    fn samples(&self) -> u32 {
        self.expected.tracer().samples()
    }
    fn is_across_edge(&self, x: u32, y: u32) -> bool {
        self.derives && self.expected.tracer().is_quad_mixed(x, self.below + y)
    }
    fn is_tied(&self, x: u32, y: u32) -> bool {
        self.expected.is_tied(x, self.below + y, Digits::Double)
    }
}

/// Where more pixels of a band change with the number type, no edges of the scene are to blame.
const MAX_TIED: f64 = 0.05;

/// Leaves out the pixels that change with the number type since the scene has an edge there: no shader's float32 could tell on which side of it
/// they are.
fn leave_out_tied(standings: &mut [Standing], is_tied: impl Fn(u32, u32) -> bool + Sync, width: u32) {
    let differs = |standing: &&Standing| **standing == Standing::Differs;
    let count = standings.iter().filter(differs).count();
    if count as f64 > MAX_TIED * standings.len() as f64 {
        return;
    }
    standings.par_iter_mut().enumerate().for_each(|(at, standing)| {
        let at = at as u32;
        if *standing == Standing::Differs && is_tied(at % width, at / width) {
            *standing = Standing::Tied;
        }
    });
}

impl Findings {
    fn judge(&mut self, case: &Case, program: &Program, until: Instant, painted: Option<&Painted>) {
        (self.verdict, self.reason) = compare::judge(Answers {
            maths: self.maths.as_ref().map(|asked| &asked.answer),
            rounding: self.rounding.as_ref().map(|asked| &asked.answer),
            toolchain: self.toolchain.as_ref().map(|asked| &asked.answer),
        });
        // A mistake that explains every pixel is one, whatever random numbers it uses. Two at once are searched for later: where chance
        // decides, they make another image than both together.
        self.search_for_mistake(case, program, if painted.is_some() { 0 } else { PAIRS });
        let mut is_judged = false;
        if let (Verdict::Wrong | Verdict::Unstable, None, Some(painted), Some(maths)) =
            (self.verdict, &self.mistake, painted, &self.maths)
        {
            let found = Found {
                maths,
                rounding: self.rounding.as_ref(),
                toolchain: self.toolchain.as_ref(),
            };
            if let Some(judged) = painted.judged(found, program, case, until) {
                is_judged = true;
                (self.verdict, self.reason) = (judged.verdict, judged.reason);
                self.mistake = judged.mistake;
            }
        }
        if let (Verdict::Unstable | Verdict::Wrong, None, Some(expected)) =
            (self.verdict, &self.mistake, case.expected)
            && let Some(asked) = acne::is_seen(
                expected.tracer(),
                case.frame.size,
                self.maths.as_ref(),
                self.rounding.as_ref(),
            )
        {
            self.verdict = Verdict::Wrong;
            self.reason = acne::reason(&asked.answer);
            self.mistake = Some(vec![acne::named()]);
        }
        if painted.is_some() && !is_judged {
            self.search_for_mistake(case, program, PAIRS);
        }
        if let (Verdict::Correct, Some(suspects), Some(maths)) = (self.verdict, case.suspects, &self.maths)
            && maths.answer.differing > 0
            && !is_judged
        {
            let differing = cause::some(maths, case.frame.size, usize::MAX);
            let named = contain(Part::Mistake, || suspects.explaining(program, &differing));
            if let Some(named) = self.contained(named) {
                let _ = write!(self.reason, "; they are what a tracer paints that {}", named.says);
            }
        }
        self.notes
            .extend(notes::unbound(case.checked, case.lints, case.frame));
        if let (Verdict::Wrong, None, Some(colour)) = (self.verdict, &self.mistake, self.actual.only_colour())
        {
            let [r, g, b] = colour;
            let says = match colour {
                [0, 0, 0] => "; every pixel is black".to_owned(),
                _ => format!("; every pixel has one colour, ({r}, {g}, {b}) of 255"),
            };
            self.reason.push_str(&says);
        }
        let rounds = |asked: &Asked| asked.answer.share(asked.answer.differing) > MAX_UNSTABLE;
        let loses = self.verdict == Verdict::Ok && self.rounding.as_ref().is_some_and(rounds);
        if self.verdict == Verdict::Unstable || loses {
            let cause = contain(Part::Cause, || {
                let mut questions = [&self.rounding, &self.maths].into_iter().flatten();
                questions.find_map(|asked| cause::cause(program, case, until, asked))
            });
            let cause = self.contained(cause);
            self.cause = cause.as_ref().and_then(|cause| cause.span);
            let is_foreseen = case
                .lints
                .warnings
                .iter()
                .any(|warning| warning.span == self.cause);
            self.notes.extend(cause.filter(|_| !is_foreseen));
        }
    }

    /// Looks for the mistake that explains a wrong image, or for two, of so many pairs at most.
    fn search_for_mistake(&mut self, case: &Case, program: &Program, pairs: usize) {
        if let (Verdict::Wrong, None, Some(suspects)) = (self.verdict, &self.mistake, case.suspects) {
            let named = contain(Part::Mistake, || suspects.recognise(program, case.frame, pairs));
            self.mistake = self.contained(named);
        }
    }

    /// What a part of the work found; nothing if it failed, which is noted.
    fn contained<T: Default>(&mut self, found: Result<T, Panic>) -> T {
        found.unwrap_or_else(|panic| {
            self.panics.push(panic);
            T::default()
        })
    }

    /// Without the evaluator nothing can be said of a shader but that it paints.
    fn cannot_ask(&mut self, failure: &eval::Failure) {
        if self.reference.is_some() {
            self.verdict = Verdict::Inconclusive;
            self.reason = format!("the shader could not be evaluated on the CPU: {failure}");
        } else {
            self.reason = format!("the shader paints; it could not be evaluated on the CPU: {failure}");
        }
    }
}
