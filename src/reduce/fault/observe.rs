//! Tests shaders for faults, with a worker process for naga and the driver.

use std::cell::OnceCell;
use std::mem;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use toyproof_diagnostic::{Code, Deadline, Diagnostic, Diagnostics, Severity};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_gpu::quirks::with_workarounds;
use toyproof_image::{Frame, Image};
use toyproof_player::{DriverFailure, Phase, Target};
use toyproof_translate::backend::{self, spirv};
use toyproof_translate::lower::{Pass, Passes, lower_within};
use toyproof_translate::{FloatMode, Lowered};
use toyproof_verify::compare::{CheckSummary, toolchain};
use toyproof_verify::contain::{Part, contain};
use toyproof_verify::evaluator::{Evaluation, Evaluator};
use toyproof_verify::project::bind::PassDifference;
use toyproof_verify::{
    Case, EVALUATOR_TIME_FACTOR, Evidence, Expected, Failure, Verdict, Verified, decide, verify_within,
};

use super::command::{CommandError, CommandInput, CommandLine, Ending};
use super::compiled::{Compiled, ProjectParts};
use super::{Fault, Finding, NotFound, Wanted, pattern};

/// Makes the worker process that a thread owns; `None` without a driver.
pub type WorkerFactory<'a> = dyn Fn() -> Option<Worker> + Sync + 'a;

/// What a shader is tested with.
pub struct Subject<'a> {
    /// How it is checked.
    pub language: glsl::Options,
    /// The project whose parts are tested; `None` if one text is the shader.
    pub project: Option<ProjectParts>,
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

/// The languages that naga is expected to write for every shader: its writer of GLSL refuses what its version of
/// the language lacks.
const NAGA_TARGETS: [backend::Target; 4] = [
    backend::Target::Spirv,
    backend::Target::Wgsl,
    backend::Target::Msl,
    backend::Target::Hlsl,
];

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

/// What the driver renders.
struct Drawn {
    image: Image,
    device: String,
    /// The first pass of a project that differs before the image.
    earlier: Option<PassDifference>,
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

    /// Whether the texts compile.
    pub fn compiles(&self, texts: &[Option<String>]) -> bool {
        self.compile(texts).is_ok()
    }

    /// The number of variables that are read without a value, if the texts compile.
    pub fn uninitialized_reads(&self, texts: &[Option<String>]) -> Option<usize> {
        let compiled = self.compile(texts).ok()?;
        Some(compiled.uninitialized_reads(self.subject.timeout))
    }

    /// Whether the texts show a fault: one text of a shader, or those of the parts of a project.
    pub fn shows(&mut self, fault: &Fault, texts: &[Option<String>]) -> bool {
        if let Fault::Naga { target, .. } = fault {
            // Only the language of the original counts.
            let found = self
                .compile(texts)
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
            } => self.has_diagnostic(texts, (*code, message), errors),
            _ => self
                .find(&fault.wanted(), texts)
                .is_ok_and(|found| is_same(fault, &found.fault)),
        });
        shows.unwrap_or(false)
    }

    /// Finds a fault of texts.
    ///
    /// # Errors
    /// If the texts do not show it, or cannot be tested for it.
    pub fn find(&mut self, wanted: &Wanted, texts: &[Option<String>]) -> Result<Finding, NotFound> {
        if let Wanted::Command(command) = wanted {
            let ending = self.run(command, texts)?;
            let command = command.clone();
            return Ok(Finding::new(Fault::Command { command, ending }));
        }
        let compiled = match self.compile(texts) {
            Ok(compiled) => compiled,
            Err(errors) => return invalid(&errors, wanted),
        };
        let found = match wanted {
            Wanted::Diagnostic(code) => self.warning(&compiled, Some(*code)),
            Wanted::Naga => self
                .any_naga(&compiled, &NAGA_TARGETS)
                .or_else(|| self.naga(&compiled, backend::Target::Glsl)),
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
        if let Some(found) = self.any_naga(compiled, &NAGA_TARGETS) {
            return Ok(Some(found));
        }
        if self.worker().is_some() {
            let (found, drawn) = self.driver(compiled)?;
            if found.is_some() {
                return Ok(found);
            }
            if let (Some(drawn), FloatMode::Strict) = (drawn, self.subject.float)
                && let Some(found) = self.difference(compiled, drawn)
            {
                return Ok(Some(found));
            }
        }
        Ok(self.subject.expected.and_then(|_| self.verdict(compiled, None)))
    }

    /// The first warning about texts, if they compile.
    pub fn first_warning(&mut self, texts: &[Option<String>]) -> Option<Finding> {
        let compiled = self.compile(texts).ok()?;
        self.warning(&compiled, None)
    }

    fn worker(&mut self) -> Option<&mut Worker> {
        self.worker.get_or_init(|| (self.subject.make_worker)());
        self.worker.get_mut()?.as_mut()
    }

    fn compile(&self, texts: &[Option<String>]) -> Result<Compiled, Diagnostics> {
        Compiled::new(texts, self.subject)
    }

    /// What the tools at fault get, for a report.
    pub fn tools(&mut self, fault: &Fault, texts: &[Option<String>]) -> Tools {
        let mut tools = Tools::default();
        if let Fault::Command { command, .. } = fault {
            let folder = tempfile::tempdir().ok();
            let timeout = self.subject.timeout;
            let input = self.command_input(texts);
            tools.output = folder.and_then(|folder| command.output(&folder, &input, timeout).ok());
            return tools;
        }
        if self.subject.project.is_some() {
            tools.device = self.worker().and_then(|worker| {
                let drivers = worker.probe().unwrap_or_default();
                drivers.first().map(|driver| driver.version.clone())
            });
            return tools;
        }
        let Some(lowered) = self
            .compile(texts)
            .ok()
            .and_then(|compiled| self.lower(compiled.image()))
        else {
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
                    let module = worker.translate(lowered, backend::Target::Spirv, float).ok();
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

    fn lower(&self, checked: &Checked) -> Option<Lowered> {
        let passes = match self.subject.float {
            FloatMode::Strict => Passes::strict(),
            FloatMode::Fast => Passes::required(),
        };
        let passes = match self.subject.without {
            Some(pass) => passes.without(pass),
            None => passes,
        };
        lower_within(checked, passes, &Deadline::after(self.subject.timeout)).ok()
    }

    /// naga's fault in the first of some languages that it does not write.
    fn any_naga(&mut self, compiled: &Compiled, targets: &[backend::Target]) -> Option<Finding> {
        targets.iter().find_map(|&target| self.naga(compiled, target))
    }

    /// naga's fault when it is to write a language.
    fn naga(&mut self, compiled: &Compiled, target: backend::Target) -> Option<Finding> {
        let lowered = self.lower(compiled.image())?;
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
    fn driver(&mut self, compiled: &Compiled) -> Result<(Option<Finding>, Option<Drawn>), NotFound> {
        let Some(lowered) = self.lower(compiled.image()) else {
            return Ok((None, None));
        };
        let subject = self.subject;
        let Some(worker) = self.worker() else {
            let error = "there is no driver, which the fault needs".to_owned();
            return Err(NotFound::Untested(error));
        };
        let drawn = match compiled.bind(subject, Some(worker)) {
            Ok(bound) => worker
                .draw_unwatched(lowered, bound.frame, subject.float)
                .map(|drawn| Drawn {
                    device: drawn.device.clone(),
                    image: drawn.image(),
                    earlier: bound.history.and_then(|history| history.difference),
                }),
            Err(Failure::Gpu(failure)) => Err(failure),
            Err(_) => return Ok((None, None)),
        };
        let failure = match drawn {
            Ok(drawn) => return Ok((None, Some(drawn))),
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

    /// The difference between the driver and the evaluator, which comes first: it rejects loops without an end.
    fn toolchain(&mut self, compiled: &Compiled) -> Result<Option<Finding>, NotFound> {
        if self.subject.float != FloatMode::Strict || self.evaluated_image(compiled).is_none() {
            return Ok(None);
        }
        let (_, drawn) = self.driver(compiled)?;
        Ok(drawn.and_then(|drawn| self.difference(compiled, drawn)))
    }

    /// The difference of what the driver renders to the evaluator's image.
    fn difference(&mut self, compiled: &Compiled, drawn: Drawn) -> Option<Finding> {
        let Some(earlier) = drawn.earlier else {
            let evaluated = self.evaluated_image(compiled)?;
            return difference(Target::Image, &evaluated, &drawn.image, drawn.device);
        };
        // What the pass reads is the same for both, since it is the first that differs.
        let (checked, frame) = compiled.inputs_of(self.subject, earlier)?;
        let evaluated = self.evaluated(checked, &frame)?;
        let (lowered, float) = (self.lower(checked)?, self.subject.float);
        let drawn = self.worker()?.draw_unwatched(lowered, frame, float).ok()?;
        let device = drawn.device.clone();
        difference(earlier.pass, &evaluated, &drawn.image(), device)
    }

    /// The image on the CPU, if it can be evaluated within the limits.
    fn evaluated_image(&self, compiled: &Compiled) -> Option<Evaluation> {
        let bound = compiled.bind(self.subject, None).ok()?;
        self.evaluated(compiled.image(), &bound.frame)
    }

    fn evaluated(&self, checked: &Checked, frame: &Frame) -> Option<Evaluation> {
        let timeout = self.subject.timeout;
        let program = Program::within(checked, timeout).ok()?;
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
        let lints = compiled.lints(self.subject.timeout);
        let bound = compiled.bind(self.subject, None);
        let verified = bound.as_ref().map_err(Clone::clone).and_then(|bound| {
            let case = bound.case(compiled.image(), &lints, self.subject);
            let verified = self.verify(&case)?;
            let verdict = verified.ruling().verdict;
            let pixel = verified.results.algorithm.and_then(|check| check.summary.first);
            let image = (verdict == Verdict::Wrong).then_some(verified.results.actual);
            Ok((verdict, image, pixel))
        });
        let (verdict, image, pixel) =
            verified.unwrap_or_else(|failure| (decide(Evidence::NoImage(failure)).verdict, None, None));
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
        let lints = compiled.lints(self.subject.timeout);
        let mut warnings = lints.warnings.clone();
        let is_of_text = |warning: &Diagnostic| code.is_none_or(|code| warning.code == code);
        if code.is_none_or(Code::is_of_runs)
            && !warnings.iter().any(is_of_text)
            && let Ok(mut bound) = compiled.bind(self.subject, None)
        {
            let notes = bound
                .history
                .as_mut()
                .map(|history| mem::take(&mut history.notes));
            warnings.extend(notes.unwrap_or_default());
            if let Ok(verified) = self.verify(&bound.case(compiled.image(), &lints, self.subject)) {
                warnings.extend(verified.results.notes);
            }
        }
        warnings.retain(|warning| warning.severity == Severity::Warning);
        warnings
    }

    /// Whether texts have an error or a warning, without errors that are not `accepted`.
    fn has_diagnostic(
        &self,
        texts: &[Option<String>],
        (code, message): (Code, &str),
        accepted: &[Code],
    ) -> bool {
        let all = match self.compile(texts) {
            Ok(compiled) => self.warnings(&compiled, Some(code)),
            Err(errors) => errors.into(),
        };
        let is_accepted = |one: &Diagnostic| one.severity != Severity::Error || accepted.contains(&one.code);
        let is_wanted = |one: &Diagnostic| one.code == code && pattern(&one.message) == message;
        all.iter().all(is_accepted) && all.iter().any(is_wanted)
    }

    fn run(&mut self, command: &CommandLine, texts: &[Option<String>]) -> Result<Ending, CommandError> {
        let folder = match self.folder.take() {
            Some(folder) => folder,
            None => tempfile::tempdir()?,
        };
        let ending = command.run(&folder, &self.command_input(texts), self.subject.timeout);
        self.folder = Some(folder);
        ending
    }

    /// What a command gets.
    fn command_input(&self, texts: &[Option<String>]) -> CommandInput {
        match &self.subject.project {
            Some(parts) => CommandInput::Folder(parts.folder(texts)),
            None => CommandInput::File(texts.first().cloned().flatten().unwrap_or_default()),
        }
    }
}

/// The difference between two images of a pass.
fn difference(pass: Target, evaluated: &Evaluation, drawn: &Image, device: String) -> Option<Finding> {
    let statuses = toolchain(&evaluated.image, drawn, &evaluated.undefined);
    let summary = CheckSummary::new(&evaluated.image, drawn, &statuses);
    let pixel = summary
        .worst
        .or(summary.first)
        .filter(|_| summary.differing > 0)?;
    let mut components = pixel.expected.iter().chain(&pixel.actual);
    let fault = Fault::Toolchain {
        pass,
        is_finite: components.all(|component| component.is_finite()),
    };
    Some(Finding {
        pixel: Some(pixel),
        differing: Some([summary.differing, summary.pixels]),
        device: Some(device),
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
