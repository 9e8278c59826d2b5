//! Converts one shader, with the workers and pools of its thread.

use std::path::PathBuf;

use rayon::ThreadPool;
use toyproof_diagnostic::{Deadline, Diagnostic};
use toyproof_glsl as glsl;
use toyproof_gpu::browser::Chromium;
use toyproof_gpu::{Failure, Worker};
use toyproof_translate::wgsl::Unprintable;
use toyproof_verify::conversion::{
    Conversion, ConvertError, Converter, FRAMES, FallbackReason, Proved, Prover, Runner, Source, WgslError,
};

use super::super::inputs::{DriverArgs, LanguageArgs};
use super::super::shader::{Shader, Unusable};
use super::super::{Exit, pool};
use super::header;
use crate::cli::files::{Input, ReadError};

/// The settings of a batch, the same for every shader.
pub(super) struct Settings<'a> {
    pub(super) converter: Converter,
    pub(super) verify: bool,
    /// The path of Chromium; none without `--browser`.
    pub(super) browser: Option<PathBuf>,
    pub(super) language: &'a LanguageArgs,
    pub(super) driver: &'a DriverArgs,
}

/// The processes and the thread pool that a thread owns.
pub(super) struct WorkerContext {
    translator: Worker,
    /// Runs the conversion; none for `--device cpu`.
    runner: Option<Worker>,
    browser: Option<Chromium>,
    /// The evaluator's pool, if several threads convert.
    pool: Option<ThreadPool>,
}

/// A file to write, and what was proved of it.
pub(super) struct ConvertedFile {
    pub(super) bytes: Vec<u8>,
    pub(super) status: ProofStatus,
    /// Why naga's writer was used instead of our own.
    pub(super) fallback: Option<FallbackReason>,
}

/// The status of a conversion's proof.
pub(super) enum ProofStatus {
    /// No proof was requested.
    NotRequested,
    /// It is proved.
    Proved(Proved),
    /// It is not proved, for this reason.
    NotProved(String),
}

impl ProofStatus {
    /// Returns whether it is proved, or no proof was requested.
    pub(super) fn is_proved(&self) -> bool {
        !matches!(self, Self::NotProved(_))
    }
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
}

impl Settings<'_> {
    /// Creates the context for one of `threads` threads.
    pub(super) fn worker_context(&self, threads: usize) -> Result<WorkerContext, String> {
        let images = FRAMES.len() as u32;
        Ok(WorkerContext {
            translator: self.driver.translator()?,
            runner: self.driver.worker_for(images)?.map(Worker::with_plain_code),
            pool: self.verify.then(|| pool::thread_pool(threads)).flatten(),
            browser: self
                .browser
                .as_ref()
                .map(|program| Chromium::new(program.clone(), self.driver.timeout() * images)),
        })
    }

    pub(super) fn convert(
        &self,
        context: &mut Result<WorkerContext, String>,
        input: &Result<Input, ReadError>,
    ) -> (Shader, Result<ConvertedFile, Refusal>) {
        let shader = Shader::load(input, self.language, Deadline::after(self.driver.timeout()));
        let converted = match (&shader.checked, context) {
            (Ok(checked), Ok(context)) => {
                let source = Source {
                    checked,
                    files: &shader.files,
                };
                self.convert_checked(context, source, &shader.name)
            }
            (Ok(_), Err(error)) => Err(Refusal::Message(error.clone(), Exit::Error)),
            (Err(Unusable::Invalid(diagnostics)), _) => {
                Err(Refusal::Diagnostics(diagnostics.clone(), Exit::ShaderFault))
            }
            (Err(Unusable::Unreadable(error) | Unusable::Unrendered(error)), _) => {
                Err(Refusal::Unreadable(error.reason.clone()))
            }
        };
        (shader, converted)
    }

    fn convert_checked(
        &self,
        context: &mut WorkerContext,
        source: Source,
        name: &str,
    ) -> Result<ConvertedFile, Refusal> {
        let runner = context.runner.as_mut().filter(|_| self.verify);
        let mut prover = runner.map(|worker| Prover {
            runner: Runner::Driver(worker),
            browser: context.browser.as_mut(),
            timeout: self.driver.timeout(),
            pool: context.pool.as_ref(),
        });
        let converted = self
            .converter
            .convert(source, &mut context.translator, prover.as_mut());
        let Conversion {
            written,
            proof,
            fallback,
        } = converted.map_err(refusal)?;
        let status = match proof {
            Some(Ok(proved)) => ProofStatus::Proved(proved),
            Some(Err(unproved)) => ProofStatus::NotProved(unproved.to_string()),
            None if self.verify => ProofStatus::NotProved(
                "verification needs a Vulkan driver, which --device cpu excludes".to_owned(),
            ),
            None => ProofStatus::NotRequested,
        };
        let mut bytes = written.into_bytes();
        if let Some(target) = self.converter.target {
            header::insert(&mut bytes, target, name, &status);
        }
        Ok(ConvertedFile {
            bytes,
            status,
            fallback,
        })
    }
}

fn refusal(error: ConvertError) -> Refusal {
    match error {
        ConvertError::Overdue(overdue) => {
            Refusal::Diagnostics(vec![glsl::overdue(overdue)], Exit::ShaderFault)
        }
        ConvertError::Unwritable(WgslError::Unprintable {
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
