//! Tests shaders for faults, with a worker process for naga and the driver.

use std::cell::OnceCell;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use toyproof_diagnostic::{Code, Deadline, Diagnostic, Diagnostics, Files, Severity};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_gpu::quirks::with_workarounds;
use toyproof_image::{Frame, Image};
use toyproof_lint::lint;
use toyproof_player::{DriverFailure, Phase};
use toyproof_translate::backend::{Target, spirv};
use toyproof_translate::lower::{Pass, Passes, lower_within};
use toyproof_translate::{FloatMode, Lowered};
use toyproof_verify::compare::{CheckSummary, toolchain};
use toyproof_verify::contain::{Part, contain};
use toyproof_verify::evaluator::{Evaluation, Evaluator};
use toyproof_verify::{
    Case, EVALUATOR_TIME_FACTOR, Evidence, Expected, Failure, Verdict, Verified, decide, verify_within,
};

use super::command::{CommandError, CommandLine, Ending};
use super::{Fault, Finding, NotFound, Wanted, pattern};
use crate::outline::file;

/// Makes the worker process that a thread owns; `None` without a driver.
pub type WorkerFactory<'a> = dyn Fn() -> Option<Worker> + Sync + 'a;

/// What a shader is tested with.
pub struct Subject<'a> {
    /// How it is checked.
    pub language: glsl::Options,
    /// The frame that is rendered.
    pub frame: Frame,
    /// The reference, rendered in that frame.
    pub expected: Option<&'a Expected>,
    /// How far the driver may rearrange arithmetic.
    pub float: FloatMode,
    /// A workaround for a fault of naga that is left out, to show this fault.
    pub without: Option<Pass>,
    /// The largest number of loop iterations of a pixel on the CPU, so that candidates with loops without an
    /// end are rejected at once.
    pub max_iterations: u32,
    /// The time limit of a test.
    pub timeout: Duration,
    /// Makes worker processes.
    pub make_worker: &'a WorkerFactory<'a>,
}

/// The tests of one thread.
pub struct Session<'a> {
    subject: &'a Subject<'a>,
    /// The worker, once it is needed, if there is one.
    worker: OnceCell<Option<Worker>>,
    /// The folder of files for commands, once it is needed.
    folder: Option<TempDir>,
}

/// What the tools at fault get.
#[derive(Debug, Default)]
pub struct Tools {
    /// The GLSL 4.50 that naga reads.
    pub lowered: Option<String>,
    /// The SPIR-V that the driver gets, before workarounds for it.
    pub spirv: Option<Vec<u8>>,
    /// The driver.
    pub device: Option<String>,
    /// What a command prints.
    pub output: Option<String>,
}

/// A shader that compiles.
struct Compiled {
    files: Files,
    checked: Checked,
}

impl<'a> Session<'a> {
    /// A session without a process yet.
    pub fn new(subject: &'a Subject<'a>) -> Self {
        Self {
            subject,
            worker: OnceCell::new(),
            folder: None,
        }
    }

    /// Whether a text compiles.
    pub fn compiles(&self, text: &str) -> bool {
        self.compile(text).is_ok()
    }

    /// Whether a text shows a fault.
    pub fn shows(&mut self, fault: &Fault, text: &str) -> bool {
        if let Fault::Naga { target, .. } = fault {
            // Only the language of the original counts.
            let found = self
                .compile(text)
                .ok()
                .and_then(|compiled| self.naga(&compiled, *target));
            return found.is_some_and(|found| found.fault == *fault);
        }
        // A panic of toyproof itself is another fault.
        let shows = contain(Part::Shader, || match fault {
            Fault::Diagnostic {
                code,
                message,
                errors,
            } => self.has_diagnostic(text, (*code, message), errors),
            _ => self
                .find(&fault.wanted(), text)
                .is_ok_and(|found| is_same(fault, &found.fault)),
        });
        shows.unwrap_or(false)
    }

    /// Finds a fault of a text.
    ///
    /// # Errors
    /// If the text does not show it, or cannot be tested for it.
    pub fn find(&mut self, wanted: &Wanted, text: &str) -> Result<Finding, NotFound> {
        if let Wanted::Command(command) = wanted {
            let ending = self.run(command, text)?;
            let command = command.clone();
            return Ok(Finding::new(Fault::Command { command, ending }));
        }
        let compiled = match self.compile(text) {
            Ok(compiled) => compiled,
            Err(errors) => return invalid(&errors, wanted),
        };
        let found = match wanted {
            Wanted::Diagnostic(code) => self.warning(&compiled, Some(*code)),
            Wanted::Naga => self.any_naga(&compiled),
            Wanted::Driver => self.driver(&compiled)?.0,
            Wanted::Toolchain => self.toolchain(&compiled)?,
            Wanted::Verdict(verdict) => self.verdict(&compiled, *verdict),
            Wanted::Any => self.any(&compiled)?,
            Wanted::Command(_) => None,
        };
        found.ok_or_else(|| NotFound::Absent(absent(wanted)))
    }

    /// The first fault of a shader, of any kind but warnings.
    fn any(&mut self, compiled: &Compiled) -> Result<Option<Finding>, NotFound> {
        if let Some(found) = self.any_naga(compiled) {
            return Ok(Some(found));
        }
        if self.worker().is_some() {
            let (found, drawn) = self.driver(compiled)?;
            if found.is_some() {
                return Ok(found);
            }
            if let (Some(drawn), FloatMode::Strict) = (drawn, self.subject.float)
                && let Some(evaluated) = self.evaluated(compiled)
                && let Some(found) = difference(&evaluated, &drawn)
            {
                return Ok(Some(found));
            }
        }
        Ok(self.subject.expected.and_then(|_| self.verdict(compiled, None)))
    }

    /// The first warning about a text, if it compiles.
    pub fn first_warning(&mut self, text: &str) -> Option<Finding> {
        let compiled = self.compile(text).ok()?;
        self.warning(&compiled, None)
    }

    fn worker(&mut self) -> Option<&mut Worker> {
        self.worker.get_or_init(|| (self.subject.make_worker)());
        self.worker.get_mut()?.as_mut()
    }

    fn compile(&self, text: &str) -> Result<Compiled, Diagnostics> {
        let (files, file) = file(text);
        let mut options = self.subject.language.clone();
        options.deadline = Deadline::after(self.subject.timeout);
        let checked = glsl::check(&files, file, &options)?;
        Ok(Compiled { files, checked })
    }

    /// What the tools at fault get, for a report.
    pub fn tools(&mut self, fault: &Fault, text: &str) -> Tools {
        let mut tools = Tools::default();
        if let Fault::Command { command, .. } = fault {
            let folder = tempfile::tempdir().ok();
            let timeout = self.subject.timeout;
            tools.output = folder.and_then(|folder| command.output(&folder, text, timeout).ok());
            return tools;
        }
        let Some(lowered) = self.compile(text).ok().and_then(|compiled| self.lower(&compiled)) else {
            return tools;
        };
        let float = self.subject.float;
        match fault {
            Fault::Naga { .. } => tools.lowered = Some(lowered.text().to_owned()),
            Fault::Driver { .. } | Fault::Toolchain { .. } => {
                if self.subject.without.is_some() {
                    tools.lowered = Some(lowered.text().to_owned());
                }
                if let Some(worker) = self.worker() {
                    let module = worker.translate(lowered, Target::Spirv, float).ok();
                    let drivers = worker.probe().unwrap_or_default();
                    let adapter = drivers.first().map_or("", |driver| driver.name.as_str());
                    tools.spirv = module.as_deref().and_then(spirv::of_bytes).map(|words| {
                        let words = with_workarounds(&words, adapter, float);
                        words.iter().flat_map(|word| word.to_le_bytes()).collect()
                    });
                    tools.device = drivers.first().map(|driver| driver.version.clone());
                }
            }
            _ => {}
        }
        tools
    }

    fn lower(&self, compiled: &Compiled) -> Option<Lowered> {
        let passes = match self.subject.float {
            FloatMode::Strict => Passes::strict(),
            FloatMode::Fast => Passes::required(),
        };
        let passes = match self.subject.without {
            Some(pass) => passes.without(pass),
            None => passes,
        };
        lower_within(&compiled.checked, passes, &Deadline::after(self.subject.timeout)).ok()
    }

    /// naga's fault in the first language that it does not write.
    fn any_naga(&mut self, compiled: &Compiled) -> Option<Finding> {
        let targets = [
            Target::Spirv,
            Target::Wgsl,
            Target::Msl,
            Target::Hlsl,
            Target::Glsl,
        ];
        targets.into_iter().find_map(|target| self.naga(compiled, target))
    }

    /// naga's fault when it is to write a language.
    fn naga(&mut self, compiled: &Compiled, target: Target) -> Option<Finding> {
        let lowered = self.lower(compiled)?;
        let float = self.subject.float;
        let failure = self.worker()?.translate(lowered, target, float).err()?;
        let message = match &failure {
            DriverFailure::Refused(diagnostics) => diagnostics
                .first()
                .map_or_else(|| failure.to_string(), |first| first.message.clone()),
            DriverFailure::Naga(message) | DriverFailure::Reread(message) => message.clone(),
            _ if phase(&failure) == Some(Phase::Translating) => failure.to_string(),
            _ => return None,
        };
        let message = message
            .strip_prefix("naga cannot translate this: ")
            .map(str::to_owned)
            .unwrap_or(message);
        let fault = Fault::Naga {
            target,
            message: pattern(&message),
        };
        Some(Finding::new(fault).with_message(message))
    }

    /// The driver's fault, or its image.
    #[expect(clippy::type_complexity, reason = "one of both")]
    fn driver(
        &mut self,
        compiled: &Compiled,
    ) -> Result<(Option<Finding>, Option<(Image, String)>), NotFound> {
        let Some(lowered) = self.lower(compiled) else {
            return Ok((None, None));
        };
        let (frame, float) = (self.subject.frame.clone(), self.subject.float);
        let Some(worker) = self.worker() else {
            let error = "there is no driver, which the fault needs".to_owned();
            return Err(NotFound::Untested(error));
        };
        let failure = match worker.draw_unwatched(lowered, frame, float) {
            Ok(drawn) => {
                let device = drawn.device.clone();
                return Ok((None, Some((drawn.image(), device))));
            }
            Err(failure) => failure,
        };
        if failure.is_without_driver() || matches!(failure, DriverFailure::Worker(_)) {
            return Err(NotFound::Untested(failure.to_string()));
        }
        let is_of_driver = match &failure {
            DriverFailure::Device(_) => true,
            failure => phase(failure).is_some_and(|phase| phase != Phase::Translating),
        };
        let message = failure.to_string();
        let found = is_of_driver.then(|| {
            let fault = Fault::Driver {
                message: pattern(&message),
            };
            Finding::new(fault).with_message(message)
        });
        Ok((found, None))
    }

    /// The difference between the driver's image and the evaluator's, which comes first: it rejects loops
    /// without an end.
    fn toolchain(&mut self, compiled: &Compiled) -> Result<Option<Finding>, NotFound> {
        let evaluated = self
            .evaluated(compiled)
            .filter(|_| self.subject.float == FloatMode::Strict);
        let Some(evaluated) = evaluated else {
            return Ok(None);
        };
        let (_, drawn) = self.driver(compiled)?;
        Ok(drawn.and_then(|drawn| difference(&evaluated, &drawn)))
    }

    /// The image on the CPU, if it can be evaluated within the limits.
    fn evaluated(&self, compiled: &Compiled) -> Option<Evaluation> {
        let (timeout, frame) = (self.subject.timeout, &self.subject.frame);
        let program = Program::within(&compiled.checked, timeout).ok()?;
        let stop = AtomicBool::new(false);
        let evaluator = Evaluator::new(&program, frame, timeout, &stop);
        let evaluator = evaluator.with_max_iterations(self.subject.max_iterations);
        evaluator.single(&(0..frame.size[1])).ok()
    }

    /// Runs the checks on the CPU.
    fn verify<'c>(&self, case: &'c Case<'c>) -> Result<Verified<'c>, Failure> {
        let deadline = Instant::now() + case.timeout * EVALUATOR_TIME_FACTOR;
        verify_within(case, self.subject.max_iterations, deadline)
    }

    /// The verdict, if it is the wanted one, or else any that is a fault.
    fn verdict(&mut self, compiled: &Compiled, wanted: Option<Verdict>) -> Option<Finding> {
        let timeout = self.subject.timeout;
        let lints = lint(&compiled.files, &compiled.checked, &Deadline::after(timeout));
        let mut case = Case::new(&compiled.checked, &lints, &self.subject.frame).with_timeout(timeout);
        case.expected = self.subject.expected;
        let (verdict, image, pixel) = match self.verify(&case) {
            Ok(verified) => {
                let verdict = verified.ruling().verdict;
                let pixel = verified.results.algorithm.and_then(|check| check.summary.first);
                (
                    verdict,
                    (verdict == Verdict::Wrong).then_some(verified.results.actual),
                    pixel,
                )
            }
            Err(failure) => (decide(Evidence::NoImage(failure)).verdict, None, None),
        };
        let is_wanted = wanted.map_or(!verdict.is_good(), |wanted| verdict == wanted);
        is_wanted.then(|| Finding {
            pixel,
            ..Finding::new(Fault::Verdict { verdict, image })
        })
    }

    /// A warning with a code, or the first one.
    fn warning(&self, compiled: &Compiled, code: Option<Code>) -> Option<Finding> {
        let warnings = self.warnings(compiled, code);
        let found = warnings
            .iter()
            .find(|warning| code.is_none_or(|code| warning.code == code))?;
        Some(Finding::of_diagnostic(found, Vec::new()))
    }

    /// The warnings about a shader; those about its runs only where a warning with the code may be among
    /// them.
    fn warnings(&self, compiled: &Compiled, code: Option<Code>) -> Vec<Diagnostic> {
        let timeout = self.subject.timeout;
        let lints = lint(&compiled.files, &compiled.checked, &Deadline::after(timeout));
        let mut warnings = lints.warnings.clone();
        let is_of_text = |warning: &Diagnostic| code.is_none_or(|code| warning.code == code);
        if code.is_none_or(Code::is_of_runs) && !warnings.iter().any(is_of_text) {
            let mut case = Case::new(&compiled.checked, &lints, &self.subject.frame).with_timeout(timeout);
            case.expected = self.subject.expected;
            if let Ok(verified) = self.verify(&case) {
                warnings.extend(verified.results.notes);
            }
        }
        warnings.retain(|warning| warning.severity == Severity::Warning);
        warnings
    }

    /// Whether a text has an error or a warning, without errors that are not `accepted`.
    fn has_diagnostic(&self, text: &str, (code, message): (Code, &str), accepted: &[Code]) -> bool {
        let all = match self.compile(text) {
            Ok(compiled) => self.warnings(&compiled, Some(code)),
            Err(errors) => errors.into(),
        };
        let is_accepted = |one: &Diagnostic| one.severity != Severity::Error || accepted.contains(&one.code);
        let is_wanted = |one: &Diagnostic| one.code == code && pattern(&one.message) == message;
        all.iter().all(is_accepted) && all.iter().any(is_wanted)
    }

    fn run(&mut self, command: &CommandLine, text: &str) -> Result<Ending, CommandError> {
        let folder = match self.folder.take() {
            Some(folder) => folder,
            None => tempfile::tempdir()?,
        };
        let ending = command.run(&folder, text, self.subject.timeout);
        self.folder = Some(folder);
        ending
    }
}

/// The difference between two images of a shader.
fn difference(evaluated: &Evaluation, (drawn, device): &(Image, String)) -> Option<Finding> {
    let statuses = toolchain(&evaluated.image, drawn, &evaluated.undefined);
    let summary = CheckSummary::new(&evaluated.image, drawn, &statuses);
    let pixel = summary
        .worst
        .or(summary.first)
        .filter(|_| summary.differing > 0)?;
    let mut components = pixel.expected.iter().chain(&pixel.actual);
    let fault = Fault::Toolchain {
        is_finite: components.all(|component| component.is_finite()),
    };
    Some(Finding {
        pixel: Some(pixel),
        differing: Some([summary.differing, summary.pixels]),
        device: Some(device.clone()),
        ..Finding::new(fault)
    })
}

/// What the driver's process was doing when it failed.
fn phase(failure: &DriverFailure) -> Option<Phase> {
    match failure {
        DriverFailure::Timeout { phase, .. }
        | DriverFailure::OutOfMemory { phase, .. }
        | DriverFailure::StackOverflow { phase }
        | DriverFailure::Crash { phase, .. } => Some(*phase),
        _ => None,
    }
}

/// The error of a text that does not compile.
fn invalid(errors: &Diagnostics, wanted: &Wanted) -> Result<Finding, NotFound> {
    let is_error = |one: &&Diagnostic| one.severity == Severity::Error;
    let all: Vec<&Diagnostic> = errors.iter().filter(is_error).collect();
    let found = match wanted {
        Wanted::Any => all.first(),
        Wanted::Diagnostic(code) => all.iter().find(|error| error.code == *code),
        Wanted::Verdict(Some(Verdict::Invalid)) => {
            return Ok(Finding::new(Fault::Verdict {
                verdict: Verdict::Invalid,
                image: None,
            }));
        }
        _ => None,
    };
    let Some(found) = found else {
        let first = all.first().map_or("", |first| first.message.as_str());
        return Err(NotFound::Absent(format!("the shader does not compile: {first}")));
    };
    let mut codes: Vec<Code> = all.iter().map(|error| error.code).collect();
    codes.sort_unstable_by_key(|code| code.as_str());
    codes.dedup();
    Ok(Finding::of_diagnostic(found, codes))
}

/// Whether a candidate's fault is that of the original.
fn is_same(original: &Fault, candidate: &Fault) -> bool {
    match (original, candidate) {
        (
            Fault::Verdict {
                verdict,
                image: Some(image),
            },
            Fault::Verdict {
                verdict: own,
                image: Some(other),
            },
        ) => {
            let mut pixels = image
                .pixels()
                .iter()
                .flatten()
                .zip(other.pixels().iter().flatten());
            verdict == own && image.size() == other.size() && pixels.all(|(&a, &b)| a.abs_diff(b) <= 1)
        }
        _ => original == candidate,
    }
}

/// The message on a fault that was not found.
fn absent(wanted: &Wanted) -> String {
    match wanted {
        Wanted::Any => "the shader shows no fault".to_owned(),
        Wanted::Diagnostic(code) if code.severity() == Severity::Error => {
            format!("the shader compiles, without the error {code}")
        }
        Wanted::Diagnostic(code) => format!("the shader has no warning {code}"),
        Wanted::Naga => "naga translates the shader".to_owned(),
        Wanted::Driver => "the driver renders the shader".to_owned(),
        Wanted::Toolchain => "the driver and the evaluator render the same image".to_owned(),
        Wanted::Verdict(Some(verdict)) => format!("the verdict is not `{verdict}`"),
        Wanted::Verdict(None) => "the verdict shows no fault".to_owned(),
        Wanted::Command(command) => format!("`{command}` has not run"),
    }
}
