//! Translates one shader, and proves the conversion with `--verify`.

use std::path::PathBuf;

use rayon::ThreadPool;
use toyproof_diagnostic::{Deadline, Diagnostic, Overdue};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::browser::{Chromium, Text};
use toyproof_gpu::{Failure, ShaderArtifact, Worker};
use toyproof_translate::backend::Target;
use toyproof_translate::wgsl::{self, Style};
use toyproof_translate::{FloatMode, Lowered};
use toyproof_verify::conversion::FRAMES;

use super::super::inputs::{DriverArgs, LanguageArgs};
use super::super::shader::{Shader, Unusable};
use super::super::{Exit, pool};
use super::proof::{NAGA, ProofStatus, prove_in_browser};
use super::{To, header, tool};
use crate::cli::files::{Input, ReadError};

/// The settings of the conversion, the same for every shader.
pub(super) struct Converter<'a> {
    pub(super) to: To,
    pub(super) float: FloatMode,
    pub(super) style: Style,
    pub(super) verify: bool,
    /// The path of Chromium; none without `--browser`.
    pub(super) browser: Option<PathBuf>,
    pub(super) language: &'a LanguageArgs,
    pub(super) driver: &'a DriverArgs,
}

/// The processes and the thread pool that a thread owns.
pub(super) struct WorkerContext {
    translator: Result<Worker, String>,
    /// Runs the conversion; none for `--on cpu`.
    pub(super) runner: Result<Option<Worker>, String>,
    pub(super) browser: Option<Chromium>,
    /// The evaluator's pool, if several threads convert.
    pub(super) pool: Option<ThreadPool>,
}

/// A converted shader.
pub(super) struct Conversion {
    pub(super) bytes: Vec<u8>,
    pub(super) status: ProofStatus,
    /// Why naga's writer was used instead of our own.
    pub(super) fallback_reason: Option<String>,
}

impl Conversion {
    /// Returns whether it is proved, or no proof was requested.
    pub(super) fn is_proved(&self) -> bool {
        !matches!(
            self.status,
            ProofStatus::Unproved(_) | ProofStatus::NotProvable(_)
        )
    }
}

/// The error of a conversion.
pub(super) enum ConvertError {
    /// Errors with their positions.
    Diagnostics(Vec<Diagnostic>, Exit),
    /// An error without a position.
    Message(String, Exit),
    /// The shader cannot be read.
    Unreadable(String),
}

impl ConvertError {
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Diagnostics(_, exit) | Self::Message(_, exit) => *exit,
            Self::Unreadable(_) => Exit::Error,
        }
    }
}

impl Converter<'_> {
    /// Creates the context for one of `threads` threads.
    pub(super) fn worker_context(&self, threads: usize) -> WorkerContext {
        let runner = self.driver.worker_for(FRAMES.len() as u32);
        WorkerContext {
            translator: self.driver.translator(),
            runner: runner.map(|runner| runner.map(Worker::with_plain_code)),
            pool: self.verify.then(|| pool::thread_pool(threads)).flatten(),
            browser: self.browser.as_ref().map(|program| {
                let patience = self.driver.timeout() * FRAMES.len() as u32;
                Chromium::new(program.clone(), patience)
            }),
        }
    }

    pub(super) fn convert(
        &self,
        context: &mut WorkerContext,
        input: &Result<Input, ReadError>,
    ) -> (Shader, Result<Conversion, ConvertError>) {
        let shader = Shader::load(input, self.language, Deadline::after(self.driver.timeout()));
        let converted = match &shader.checked {
            Ok(checked) => self.convert_checked(context, checked, &shader),
            Err(Unusable::Invalid(diagnostics)) => {
                Err(ConvertError::Diagnostics(diagnostics.clone(), Exit::ShaderFault))
            }
            Err(Unusable::Unreadable(error)) => Err(ConvertError::Unreadable(error.to_string())),
        };
        (shader, converted)
    }

    fn convert_checked(
        &self,
        context: &mut WorkerContext,
        checked: &Checked,
        shader: &Shader,
    ) -> Result<Conversion, ConvertError> {
        let Some(target) = self.to.target() else {
            let lowered = self.lower(checked)?;
            let bytes = lowered.text().as_bytes().to_vec();
            let status = if self.verify {
                let readings = vec![(NAGA.to_owned(), ShaderArtifact::Lowered(lowered))];
                self.run(context, (checked, &shader.files), readings, None)
            } else {
                ProofStatus::NotRequested
            };
            return Ok(Conversion {
                bytes,
                status,
                fallback_reason: None,
            });
        };
        if target == Target::Wgsl && self.float == FloatMode::Fast {
            let converted = self.write_wgsl(context, checked, shader)?;
            let why = match &converted {
                Err(why)
                | Ok(Conversion {
                    status: ProofStatus::Unproved(why),
                    ..
                }) => why.clone(),
                Ok(_) => return converted.map_err(|why| ConvertError::Message(why, Exit::Error)),
            };
            if self.style != Style::Plain {
                return converted.map_err(|why| ConvertError::Message(why, Exit::Error));
            }
            let other = self.convert_with_naga(context, checked, target, shader);
            return match (converted, other) {
                // Neither is proved: prefer the readable one.
                (
                    Ok(converted),
                    Err(_)
                    | Ok(Conversion {
                        status: ProofStatus::Unproved(_) | ProofStatus::NotProvable(_),
                        ..
                    }),
                ) => Ok(converted),
                (_, other) => other.map(|converted| Conversion {
                    fallback_reason: Some(why),
                    ..converted
                }),
            };
        }
        self.convert_with_naga(context, checked, target, shader)
    }

    /// Writes WGSL that keeps the author's names and comments; or the reason why that is impossible.
    fn write_wgsl(
        &self,
        context: &mut WorkerContext,
        checked: &Checked,
        shader: &Shader,
    ) -> Result<Result<Conversion, String>, ConvertError> {
        let deadline = Deadline::after(self.driver.timeout());
        match wgsl::wgsl(checked, &shader.files, self.style, &deadline) {
            Ok(text) => self.verify_wgsl(context, checked, shader, text),
            Err(wgsl::Failure::Overdue(overdue)) => Err(too_slow(overdue)),
            Err(wgsl::Failure::Unprintable(why)) => Ok(Err(format!(
                "cannot be written in the style {}: {why}",
                self.style.name()
            ))),
        }
    }

    /// Checks that naga reads that WGSL, and proves it with `--verify`; or the reason why naga rejects it.
    fn verify_wgsl(
        &self,
        context: &mut WorkerContext,
        checked: &Checked,
        shader: &Shader,
        text: String,
    ) -> Result<Result<Conversion, String>, ConvertError> {
        let hosted = self.style.hosted(&text);
        match translator(context)?.read_wgsl(&hosted.text) {
            Ok(()) => {}
            Err(failure @ Failure::Timeout { .. }) => return Err(convert_error(failure)),
            Err(Failure::Reread(why)) => return Ok(Err(why)),
            Err(failure) => return Ok(Err(failure.to_string())),
        }
        let mut bytes = text.into_bytes();
        let status = if self.verify {
            // The other styles are complete only within their hosts.
            let validated = match self.style {
                Style::Plain => tool::validate(Target::Wgsl, &bytes),
                _ => Ok(None),
            };
            match validated {
                Err(why) => ProofStatus::Unproved(why),
                Ok(validator) => {
                    let readings = vec![(NAGA.to_owned(), ShaderArtifact::Wgsl(hosted.clone()))];
                    let status = self.run(context, (checked, &shader.files), readings, validator);
                    let text = Text::Wgsl(&hosted.text);
                    prove_in_browser(context, checked, shader, status, text, hosted.upside_down)
                }
            }
        } else {
            ProofStatus::NotRequested
        };
        header::insert(&mut bytes, Target::Wgsl, &shader.name, &status);
        Ok(Ok(Conversion {
            bytes,
            status,
            fallback_reason: None,
        }))
    }

    fn lower(&self, checked: &Checked) -> Result<Lowered, ConvertError> {
        let deadline = Deadline::after(self.driver.timeout());
        let lowered = self.float.lower_within(checked, &deadline);
        lowered.map_err(too_slow)
    }

    /// Converts the shader with naga's writer.
    fn convert_with_naga(
        &self,
        context: &mut WorkerContext,
        checked: &Checked,
        target: Target,
        shader: &Shader,
    ) -> Result<Conversion, ConvertError> {
        let lowered = self.lower(checked)?;
        let mut bytes = translator(context)?
            .translate(lowered.clone(), target, self.float)
            .map_err(convert_error)?;
        let status = if self.verify {
            let status = self.prove(context, (checked, &shader.files), lowered, target, &bytes);
            let status = status.unwrap_or_else(ProofStatus::Unproved);
            let text = String::from_utf8_lossy(&bytes);
            let text = match target {
                Target::Glsl => Text::Glsl(&text),
                _ => Text::Wgsl(&text),
            };
            prove_in_browser(context, checked, shader, status, text, false)
        } else {
            ProofStatus::NotRequested
        };
        header::insert(&mut bytes, target, &shader.name, &status);
        Ok(Conversion {
            bytes,
            status,
            fallback_reason: None,
        })
    }
}

/// The translator, which is a separate process.
fn translator(context: &mut WorkerContext) -> Result<&mut Worker, ConvertError> {
    let translator = context.translator.as_mut();
    translator.map_err(|error| ConvertError::Message(error.clone(), Exit::Error))
}

fn too_slow(overdue: Overdue) -> ConvertError {
    ConvertError::Diagnostics(vec![glsl::overdue(overdue)], Exit::ShaderFault)
}

fn convert_error(failure: Failure) -> ConvertError {
    match failure {
        Failure::Invalid(diagnostics) => ConvertError::Diagnostics(diagnostics, Exit::ShaderFault),
        Failure::Refused(diagnostics) => ConvertError::Diagnostics(diagnostics, Exit::Error),
        failure => {
            let exit = if failure.is_invalid() {
                Exit::ShaderFault
            } else {
                Exit::Error
            };
            ConvertError::Message(failure.to_string(), exit)
        }
    }
}
