//! Converts a shader or a project, with the workers and pools of its thread.

use std::path::PathBuf;

use rayon::ThreadPool;
use toyproof_convert::header::{self, Origin, ProofStatus};
use toyproof_convert::{
    self as convert, ConvertError, Converter, FRAMES, FallbackReason, Host, HostedConversion, HostedSource,
    ProjectConversion, ProjectError, ProjectSource, ProofError, Prover, Runner, Source, TargetCode,
    WriterError,
};
use toyproof_diagnostic::{Deadline, Diagnostic};
use toyproof_glsl::{self as glsl, Checked, PortError};
use toyproof_gpu::browser::{Chromium, ThreeLibrary};
use toyproof_gpu::{Failure, Worker};
use toyproof_project::files::{Input, ReadError};
use toyproof_project::{CompiledProject, PassKind};
use toyproof_translate::Unprintable;
use toyproof_translate::c_family::Title;

use super::super::inputs::{DriverArgs, LanguageArgs};
use super::super::shader::{Shader, Unusable};
use super::super::{Exit, pool};
use super::To;

/// The settings of a batch, the same for every shader.
pub(super) struct Settings<'a> {
    pub(super) to: To,
    pub(super) converter: Converter,
    /// The host whose file has all passes of a shader, if there is one.
    pub(super) host: Option<Host>,
    pub(super) verify: bool,
    /// The path of Chromium; `None` without `--browser`.
    pub(super) browser: Option<PathBuf>,
    /// three.js, for modules that run in the browser.
    pub(super) three: Option<ThreeLibrary>,
    pub(super) language: &'a LanguageArgs,
    pub(super) driver: &'a DriverArgs,
}

/// The processes and the thread pool that a thread owns.
pub(super) struct WorkerContext {
    translator: Worker,
    /// Runs the conversion; `None` without a driver.
    runner: Option<Worker>,
    /// Reads conversions that the evaluator runs, without a driver.
    reader: Option<Worker>,
    browser: Option<Chromium>,
    /// The evaluator's pool, if several threads convert.
    pool: Option<ThreadPool>,
}

/// The files to write, and their proofs.
pub(super) struct Conversion {
    pub(super) files: Vec<OutputFile>,
    pub(super) status: ProofStatus,
    /// Why naga's writer was used instead of our own.
    pub(super) fallback: Option<FallbackReason>,
}

/// A file to write.
pub(super) struct OutputFile {
    /// The name in the folder of a project; `None` for the one file of a shader.
    pub(super) name: Option<String>,
    pub(super) bytes: Vec<u8>,
}

/// Why there is no file.
pub(super) enum Refusal {
    /// Errors with their positions.
    Diagnostics(Vec<Diagnostic>, Exit),
    /// An error without a position.
    Message(String, Exit),
    /// The shader cannot be read.
    Unreadable(String),
}

impl Refusal {
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Diagnostics(_, exit) | Self::Message(_, exit) => *exit,
            Self::Unreadable(_) => Exit::Error,
        }
    }

    /// Names the pass to which a message without a position applies.
    fn in_pass(self, pass: PassKind) -> Self {
        match self {
            Self::Message(why, exit) => Self::Message(format!("{pass}: {why}"), exit),
            other => other,
        }
    }
}

impl Settings<'_> {
    /// Creates the context for one of `threads` threads.
    pub(super) fn worker_context(&self, threads: usize) -> Result<WorkerContext, String> {
        let images = FRAMES.len() as u32;
        let mut translator = self.driver.translator()?;
        if self.to != To::Lowered {
            // The process starts while the first shader is read.
            translator.warm_up(0);
        }
        let mut runner = self.driver.worker_for(images)?.map(Worker::with_plain_code);
        if self.verify
            && self.driver.may_fall_back()
            && let Some(worker) = &mut runner
            && worker.probe().is_err_and(|failure| failure.is_without_driver())
        {
            runner = None;
        }
        let is_evaluated = self.verify && runner.is_none();
        let reader = is_evaluated.then(|| self.driver.translator()).transpose()?;
        Ok(WorkerContext {
            translator,
            runner,
            reader,
            pool: self.verify.then(|| pool::thread_pool(threads)).flatten(),
            browser: self.browser.as_ref().map(|program| {
                let browser = Chromium::new(program.clone(), self.driver.timeout() * images);
                match &self.three {
                    Some(three) => browser.with_three(three.clone()),
                    None => browser,
                }
            }),
        })
    }

    pub(super) fn load(&self, input: &Result<Input, ReadError>) -> Shader {
        Shader::load(input, self.language, Deadline::after(self.driver.timeout()))
    }

    pub(super) fn convert(
        &self,
        context: &mut Result<WorkerContext, String>,
        shader: &Shader,
    ) -> Result<Conversion, Refusal> {
        let image = shader.image().map_err(|unusable| match unusable {
            Unusable::Invalid(diagnostics) => Refusal::Diagnostics(diagnostics.clone(), Exit::ShaderFault),
            Unusable::Unreadable(error) => Refusal::Unreadable(error.reason.clone()),
        })?;
        let context = context.as_mut();
        let context = context.map_err(|error| Refusal::Message(error.clone(), Exit::Error))?;
        if let Some(host) = self.host {
            return self.convert_hosted(context, shader, image, host);
        }
        match shader.project() {
            Some(project) if shader.has_passes => self.convert_project(context, shader, project),
            _ => self.convert_shader(context, shader, image),
        }
    }

    /// The process that translates, and what proves, if proofs are requested.
    fn parts<'c>(&self, context: &'c mut WorkerContext) -> (&'c mut Worker, Option<Prover<'c>>) {
        let runner = match (&mut context.runner, &mut context.reader) {
            (Some(worker), _) if self.verify => Some(Runner::Driver(worker)),
            (_, Some(reader)) => Some(Runner::Evaluator(Some(reader))),
            _ => None,
        };
        let prover = runner.map(|runner| Prover {
            runner,
            browser: context.browser.as_mut(),
            timeout: self.driver.timeout(),
            pool: context.pool.as_ref(),
        });
        (&mut context.translator, prover)
    }

    fn convert_shader(
        &self,
        context: &mut WorkerContext,
        shader: &Shader,
        checked: &Checked,
    ) -> Result<Conversion, Refusal> {
        let (translator, mut prover) = self.parts(context);
        let source = Source {
            checked,
            files: &shader.files,
        };
        let name = shader.name.as_str();
        let converted = self
            .converter
            .convert(source, Title::of_shader(name), translator, prover.as_mut());
        let convert::Conversion {
            code,
            proof,
            fallback,
        } = converted.map_err(refusal)?;
        let status = status_of(proof.map(|proof| proof.map(ProofStatus::Proved)));
        let credit = credit(shader);
        Ok(Conversion {
            files: vec![self.output_file(
                None,
                code,
                Origin {
                    name: &shader.name,
                    credit: credit.as_deref(),
                },
                &status,
            )],
            status,
            fallback,
        })
    }

    /// Converts a shader or a project into the one file of a host.
    fn convert_hosted(
        &self,
        context: &mut WorkerContext,
        shader: &Shader,
        checked: &Checked,
        host: Host,
    ) -> Result<Conversion, Refusal> {
        let (_, mut prover) = self.parts(context);
        let files = &shader.files;
        let source = match shader.project() {
            Some(project) => HostedSource::Project(ProjectSource {
                name: &shader.name,
                project,
                files,
            }),
            None => HostedSource::Shader(Source { checked, files }),
        };
        let converted = self.converter.convert_hosted(host, source, prover.as_mut());
        let HostedConversion { text, proof } = converted.map_err(|error| match error {
            ProjectError::Pass { pass, error } if shader.has_passes => refusal(error).in_pass(pass),
            ProjectError::Pass { error, .. } => refusal(error),
            error => Refusal::Message(error.to_string(), Exit::Error),
        })?;
        let status = status_of(proof);
        let credit = credit(shader);
        let bytes = header::insert_in_hosted(
            &text,
            host,
            Origin {
                name: &shader.name,
                credit: credit.as_deref(),
            },
            &status,
        );
        let bytes = bytes.into_bytes();
        Ok(Conversion {
            files: vec![OutputFile { name: None, bytes }],
            status,
            fallback: None,
        })
    }

    /// The extension of the files of shaders with one pass.
    pub(super) fn extension(&self) -> &'static str {
        self.host
            .map_or_else(|| self.converter.extension(), Host::extension)
    }

    /// Converts a project whose image reads other passes.
    fn convert_project(
        &self,
        context: &mut WorkerContext,
        shader: &Shader,
        project: &CompiledProject,
    ) -> Result<Conversion, Refusal> {
        let (translator, mut prover) = self.parts(context);
        let source = ProjectSource {
            name: &shader.name,
            project,
            files: &shader.files,
        };
        let converted = self
            .converter
            .convert_project(source, translator, prover.as_mut());
        let ProjectConversion {
            passes,
            host,
            proof,
            fallback,
        } = converted.map_err(|error| match error {
            ProjectError::Pass { pass, error } => refusal(error).in_pass(pass),
            error => Refusal::Message(error.to_string(), Exit::Error),
        })?;
        let status = status_of(proof.map(|proof| proof.map(ProofStatus::ProvedPasses)));
        let credit = project.project.credit();
        let passes = passes.into_iter().map(|pass| {
            let name = format!("{}, {}", shader.name, pass.kind);
            let origin = Origin {
                name: &name,
                credit: credit.as_deref(),
            };
            self.output_file(Some(pass.name), pass.code, origin, &status)
        });
        // It is complete when the host's files are there: its passes precede them.
        let host = host.into_iter().map(|file| OutputFile {
            name: Some(file.name.to_owned()),
            bytes: file.text.into_bytes(),
        });
        Ok(Conversion {
            files: passes.chain(host).collect(),
            status,
            fallback,
        })
    }

    /// A file with a header that names its source.
    fn output_file(
        &self,
        name: Option<String>,
        code: TargetCode,
        origin: Origin,
        status: &ProofStatus,
    ) -> OutputFile {
        let mut bytes = code.into_bytes();
        if let Some(target) = self.converter.target {
            header::insert(&mut bytes, target, origin, status);
        }
        OutputFile { name, bytes }
    }
}

/// Who made a shader of the site.
fn credit(shader: &Shader) -> Option<String> {
    shader.project()?.project.credit()
}

/// The status of a proof, if one was requested.
fn status_of(proof: Option<Result<ProofStatus, ProofError>>) -> ProofStatus {
    match proof {
        Some(Ok(proved)) => proved,
        Some(Err(unproved)) => ProofStatus::NotProved(unproved.to_string()),
        None => ProofStatus::NotRequested,
    }
}

fn refusal(error: ConvertError) -> Refusal {
    match error {
        ConvertError::Overdue(overdue) => {
            Refusal::Diagnostics(vec![glsl::overdue(overdue)], Exit::ShaderFault)
        }
        ConvertError::Port(PortError::Host(diagnostic)) => {
            Refusal::Diagnostics(vec![*diagnostic], Exit::Error)
        }
        ConvertError::Port(error) => Refusal::Message(error.to_string(), Exit::Error),
        ConvertError::Unwritable(WriterError::Unprintable {
            why: Unprintable::Host(diagnostic),
            ..
        }) => Refusal::Diagnostics(vec![*diagnostic], Exit::Error),
        ConvertError::Unwritable(error) => Refusal::Message(error.to_string(), Exit::Error),
        ConvertError::Worker(Failure::Invalid(diagnostics)) => {
            Refusal::Diagnostics(diagnostics, Exit::ShaderFault)
        }
        ConvertError::Worker(Failure::Refused(diagnostics)) => Refusal::Diagnostics(diagnostics, Exit::Error),
        ConvertError::Worker(failure) => {
            let exit = if failure.is_invalid() {
                Exit::ShaderFault
            } else {
                Exit::Error
            };
            Refusal::Message(failure.to_string(), exit)
        }
    }
}
