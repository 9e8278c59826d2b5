//! The three questions, asked of one shader: the GPU, the evaluator and the tracer paint at once, and their pictures are
//! compared.

mod cause;
pub mod conversion;
mod cpu;
mod expected;
mod notes;
mod tangent;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};

use thiserror::Error;

pub use self::expected::Expected;

use self::cpu::{Cpu, Limits};
use crate::compare::{self, Answer, Answers, Comparison, MAX_UNSTABLE, Standing, Verdict};
use crate::diagnostic::Diagnostic;
use crate::eval::{self, Program};
use crate::frame::Frame;
use crate::glsl::Checked;
use crate::gpu::{self, Drawn, FloatMode, SAFE_ROUNDS, Worker};
use crate::image::{Image, Mark};
use crate::mistake::{Named, Suspects};
use crate::source::Span;

/// What is to be verified.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// What it should paint, if that is known: of that frame, and the film's size is the frame's.
    pub expected: Option<&'a Expected>,
    /// What a wrong picture is compared with, to tell what went wrong: of that scene and frame.
    pub suspects: Option<&'a Suspects>,
    /// The frame.
    pub frame: &'a Frame,
    /// How far the driver may rearrange arithmetic. If it may, the toolchain question is not asked.
    pub float: FloatMode,
    /// How long a picture may take.
    pub timeout: Duration,
}

/// What was found.
#[derive(Debug)]
pub struct Findings {
    /// The verdict.
    pub verdict: Verdict,
    /// Why, in one sentence.
    pub reason: String,
    /// Is the algorithm right? Asked where there is a scene.
    pub maths: Option<Asked>,
    /// Is float32 enough?
    pub rounding: Option<Asked>,
    /// Was the shader run as it stands? Asked where a GPU painted strictly.
    pub toolchain: Option<Asked>,
    /// The shader's picture beside the reference's.
    pub picture: Option<(Comparison, Vec<Mark>)>,
    /// What the tracer painted.
    pub reference: Option<Arc<Image>>,
    /// What the GPU painted, or the evaluator in f32 where there is none.
    pub actual: Image,
    /// What the evaluator painted in f64; none if it could not.
    pub exact: Option<Image>,
    /// How the GPU painted; none if the evaluator did.
    pub painter: Option<Painter>,
    /// What was seen on the way, with its line.
    pub notes: Vec<Diagnostic>,
    /// Where a shader loses its digits, if float32 is not enough for it and that could be found; a warning or a note says how.
    pub cause: Option<Span>,
    /// What explains a wrong picture, if that is a classic mistake, or two.
    pub mistake: Option<Vec<Named>>,
    /// How long the evaluator took, for all its pictures.
    pub eval: Duration,
    /// How long the tracer took; next to nothing where the picture was known.
    pub trace: Option<Duration>,
}

/// A GPU at work: [`Drawn`] without its picture.
#[derive(Debug, Clone)]
pub struct Painter {
    /// Adapter and driver.
    pub device: String,
    /// Time for naga to parse, validate and write.
    pub translate: Duration,
    /// Time for the driver to compile.
    pub compile: Duration,
    /// Time to paint and read back.
    pub draw: Duration,
}

/// The answer to a question, and what its picture shows.
#[derive(Debug)]
pub struct Asked {
    /// The answer.
    pub answer: Answer,
    /// A mark for each pixel, bottom row first; none if there is nothing to show, as [`Answer::is_same`] tells.
    pub marks: Vec<Mark>,
    /// How each pixel stands.
    standings: Vec<Standing>,
}

impl Asked {
    fn new(expected: &Image, actual: &Image, standings: Vec<Standing>) -> Self {
        let answer = Answer::new(expected, actual, &standings);
        let marks = if answer.is_same() {
            Vec::new()
        } else {
            compare::marks(expected, actual, &standings)
        };
        Self {
            answer,
            marks,
            standings,
        }
    }
}

/// Why there are no findings.
#[derive(Debug, Error)]
pub enum Failure {
    /// The GPU's side failed.
    #[error(transparent)]
    Gpu(#[from] gpu::Failure),
    /// There is no GPU, and the evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The driver ended loops by force in that many pixels.
    #[error("a loop was ended by force in {0} pixels")]
    CutShort(u64),
}

/// The longest that two mistakes at once are looked for in a wrong picture; there are few enough of them that it seldom takes so long.
const PATIENCE_FOR_TWO: Duration = Duration::from_secs(10);

/// The evaluator may take so many times as long as the GPU: that it is slow is not the shader's fault.
const PATIENCE: u32 = 4;
/// All its pictures may take so many times as long as one may, and whatever is asked of the shader after that has so many times.
const ALL_PICTURES: u32 = 6;
const ALL: u32 = 8;

/// Asks the three questions. Without a `worker` the evaluator paints in its stead, and the toolchain question is not asked. All together takes
/// no longer than eight times what a picture may take, beside what there is to do once for each scene.
///
/// # Errors
/// Why there is no picture of the shader.
pub fn verify(worker: Option<&mut Worker>, case: &Case) -> Result<Findings, Failure> {
    let start = Instant::now();
    let program = Program::new(case.checked);
    let stop = AtomicBool::new(false);
    let limits = Limits {
        // Where a GPU paints too, it is the one that must not take long.
        each: case.timeout * if worker.is_some() { PATIENCE } else { 1 },
        until: start + case.timeout * ALL_PICTURES,
        stop: &stop,
    };
    // They share the cores, but none waits for the others' latencies.
    let (drawn, (cpu, eval), traced) = thread::scope(|scope| {
        let (counted, rounds) = mpsc::channel();
        let cpu = scope.spawn(|| timed(|| Cpu::paint(&program, case, limits, counted)));
        let trace = |expected: &Expected| timed(|| expected.picture());
        let traced = case.expected.map(|expected| scope.spawn(move || trace(expected)));
        let drawn = worker.map(|worker| {
            let lowered = case.float.lower(case.checked);
            // A strict run goes round as often as the evaluator does, who has often counted by now. Otherwise, it is waited for no longer
            // than it would take the driver to paint again.
            let is_short = |painting| {
                rounds
                    .recv_timeout(painting)
                    .is_ok_and(|most| most <= SAFE_ROUNDS)
            };
            let watch = |painting| case.float == FloatMode::Fast || !is_short(painting);
            let drawn = worker.draw_and_watch(lowered, case.frame.clone(), case.float, watch);
            let is_usable = |drawn: &Drawn| drawn.cut_short.is_none_or(|pixels| pixels == 0);
            stop.store(!drawn.as_ref().is_ok_and(is_usable), Ordering::Relaxed);
            drawn
        });
        (drawn.transpose(), join(cpu), traced.map(join))
    });
    let (actual, painter, cpu) = match (drawn?, cpu) {
        (Some(drawn), cpu) => {
            // A loop that the evaluator saw no end of, on a driver that may have ended it by force and could not be watched.
            if let (None, Err(failure @ (eval::Failure::Timeout { .. } | eval::Failure::TooOften { .. }))) =
                (drawn.cut_short, &cpu)
            {
                return Err(failure.clone().into());
            }
            // Where the driver could not be watched in time, the evaluator has counted the rounds.
            let counted = cpu.as_ref().map_or(0, |(_, cpu)| cpu.beyond_cap);
            if let pixels @ 1.. = drawn.cut_short.unwrap_or(counted) {
                return Err(Failure::CutShort(pixels));
            }
            let (image, painter) = split(drawn);
            (image, Some(painter), cpu.map(|(single, cpu)| (Some(single), cpu)))
        }
        (None, Ok((single, cpu))) => (single, None, Ok((None, cpu))),
        (None, Err(failure)) => return Err(failure.into()),
    };
    let mut findings = Findings {
        verdict: Verdict::Ok,
        reason: String::new(),
        maths: None,
        rounding: None,
        toolchain: None,
        picture: None,
        reference: None,
        exact: None,
        actual,
        painter,
        notes: Vec::new(),
        cause: None,
        mistake: None,
        eval,
        trace: None,
    };
    if let Some((reference, trace)) = traced {
        findings.picture = Some(compare::compare(&reference, &findings.actual));
        findings.reference = Some(reference);
        findings.trace = Some(trace);
    }
    match (cpu, &program) {
        (Ok((single, cpu)), Ok(program)) => {
            findings.ask(case, start + case.timeout * ALL, &cpu, single.as_ref(), program);
            findings.exact = Some(cpu.double);
        }
        (Err(failure), _) => findings.cannot_ask(&failure),
        (_, Err(refusal)) => findings.cannot_ask(&(*refusal).into()),
    }
    Ok(findings)
}

impl Findings {
    /// `single` is the evaluator's picture in f32, where a GPU painted another.
    fn ask(&mut self, case: &Case, until: Instant, cpu: &Cpu, single: Option<&Image>, program: &Program) {
        let ask = |expected: &Image, actual: &Image, standings| Some(Asked::new(expected, actual, standings));
        if let (Some(expected), Some(reference)) = (case.expected, &self.reference) {
            let hull = |x, y, styles| expected.hull(x, y, styles);
            let derives = case.checked.takes_derivatives();
            let edge = |x, y| derives && expected.tracer().is_quad_mixed(x, y);
            let (standings, shaking) = timed(|| {
                let shaken = |seed| cpu::shaken(program, case, until, seed);
                compare::maths(reference, &cpu.double, &cpu.undefined, hull, edge, shaken)
            });
            self.eval += shaking;
            self.maths = ask(reference, &cpu.double, standings);
        }
        let standings = compare::rounding(&cpu.double, &self.actual, &cpu.undefined);
        self.rounding = ask(&cpu.double, &self.actual, standings);
        if let (Some(single), FloatMode::Strict) = (single, case.float) {
            let standings = compare::toolchain(single, &self.actual, &cpu.undefined);
            self.toolchain = ask(single, &self.actual, standings);
        }
        self.notes = notes::notes(cpu, &case.checked.warnings);
        self.notes
            .extend(cause::not_finite(program, case, until, &self.actual));
        if let Some(expected) = case.expected {
            let single = single.unwrap_or(&self.actual);
            let traps = tangent::traps(&expected.stilled(), single, &cpu.double);
            let formula = case.checked.discriminants.first();
            self.notes
                .extend(formula.and_then(|at| tangent::told(&traps, *at)));
        }
        (self.verdict, self.reason) = compare::judge(Answers {
            maths: self.maths.as_ref().map(|asked| &asked.answer),
            rounding: self.rounding.as_ref().map(|asked| &asked.answer),
            toolchain: self.toolchain.as_ref().map(|asked| &asked.answer),
        });
        if let (Verdict::Wrong, Some(suspects)) = (self.verdict, case.suspects) {
            let patience = PATIENCE_FOR_TWO.min(until.saturating_duration_since(Instant::now()));
            self.mistake = suspects.recognise(program, &cpu.double, case.frame, patience);
        }
        let rounds = |asked: &Asked| asked.answer.share(asked.answer.differing) > MAX_UNSTABLE;
        let loses = self.verdict == Verdict::Ok && self.rounding.as_ref().is_some_and(rounds);
        if self.verdict == Verdict::Unstable || loses {
            let mut questions = [&self.rounding, &self.maths].into_iter().flatten();
            let cause = questions.find_map(|asked| cause::cause(program, case, until, asked));
            self.cause = cause.as_ref().and_then(|cause| cause.span);
            let is_foreseen = case
                .checked
                .warnings
                .iter()
                .any(|warning| warning.span == self.cause);
            self.notes.extend(cause.filter(|_| !is_foreseen));
        }
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

fn split(drawn: Drawn) -> (Image, Painter) {
    let painter = Painter {
        device: drawn.device,
        translate: drawn.translate,
        compile: drawn.compile,
        draw: drawn.draw,
    };
    (drawn.image, painter)
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let value = work();
    (value, start.elapsed())
}

fn join<T>(thread: ScopedJoinHandle<T>) -> T {
    thread
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
