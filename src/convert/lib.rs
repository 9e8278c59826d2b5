//! Converts shaders, and proves that a conversion is equivalent to the original: the written file is read
//! again, run, and compared with the shader.
//!
//! The file calls functions such as `sin`, whose last bits WGSL and other languages leave to the
//! implementation. For the proof, the evaluator's definitions replace them in the parsed module; everything
//! else is the file's. So no tolerance is needed: a conversion is proved if every pixel has the evaluator's
//! bits.
//!
//! A [`Converter`] writes [`TargetCode`], with naga in a worker process; a [`Prover`] proves it, on a driver
//! or on the CPU. `examples/convert.rs` uses both [`toyproof_translate::wgsl`] and a prover without any
//! worker.

mod engine;
mod graph;
pub mod header;
mod hosts;
mod original;
mod passes;
mod project;
mod proof;
mod prover;
mod script;
mod tool;

#[cfg(test)]
mod tests;

use std::time::Duration;

pub use graph::GRAPH_FILE;
pub use hosts::{Host, HostedConversion, HostedSource};
pub use passes::{
    GraphContent, PASS_FRAMES, PASS_SIZES, PassComparison, PassSources, PassesProof, PixelDifference,
};
pub use project::{HostFile, PassFile, ProjectConversion, ProjectError, ProjectSource};
pub use proof::{
    FRAMES, Proof, ProofReference, Rgb8Comparison, Runner, TestFrame, compare_with_original, frames,
};
pub use prover::{ProofError, Prover, Reader, Readers, ShaderProof, browser_text};
use thiserror::Error;
pub use tool::ToolError;
use toyproof_diagnostic::{Code, Deadline, FileId, Files, Overdue};
use toyproof_glsl::{self as glsl, Checked, Dialect, PortError, UniformMode};
use toyproof_gpu::{self as gpu, Worker};
use toyproof_translate::backend::Target;
use toyproof_translate::c_family::{self, CHost, Title};
use toyproof_translate::wgsl::{self, Style};
use toyproof_translate::{FloatMode, Lowered, Unprintable, WriteFailure};

/// A shader to convert.
#[derive(Debug, Clone, Copy)]
pub struct Source<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The files that it was read from.
    pub files: &'a Files,
}

impl Source<'_> {
    /// The text that was compiled: with included files, and what a host declares.
    fn file(&self) -> FileId {
        self.checked.tree[self.checked.main_image].at.span.file
    }

    /// The author's text.
    fn text(&self) -> &str {
        self.files.get(self.file()).text()
    }
}

/// The extension of the lowered GLSL that naga parses.
const LOWERED_EXTENSION: &str = "lowered.glsl";

/// The extension of shaders with `mainImage`, which are no complete fragment shaders.
const SHADERTOY_EXTENSION: &str = "glsl";

/// The settings of a conversion.
#[derive(Debug, Clone, Copy)]
pub struct Converter {
    /// The language; `None` for the lowered GLSL that naga parses.
    pub target: Option<Target>,
    /// The kind of host that WGSL is written for.
    pub style: Style,
    /// The host that a language with the syntax of C is written for; `None` for other languages.
    pub c_host: Option<CHost>,
    /// The host that GLSL is written for, in the author's words; `None` for GLSL by naga.
    pub dialect: Option<Dialect>,
    /// Whether functions such as `sin` are expanded.
    pub float: FloatMode,
    /// The time limit of each step.
    pub timeout: Duration,
}

/// The shader with its uniforms as variables instead of their values; `None` if it reads none that has one.
fn with_uniforms(source: Source, deadline: &Deadline) -> Option<Checked> {
    if source.checked.values_read.is_empty() {
        return None;
    }
    let options = glsl::Options {
        uniform_mode: UniformMode::Kept,
        deadline: deadline.clone(),
        ..source.checked.options()
    };
    glsl::check(source.files, source.file(), &options).ok()
}

/// A shader in the target language.
#[derive(Debug, Clone)]
pub enum TargetCode {
    /// The GLSL that naga parses.
    Lowered(Lowered),
    /// WGSL for a kind of host.
    Wgsl(String, Style),
    /// GLSL for a host.
    Glsl(String, Dialect),
    /// Code of a language with the syntax of C, for a host.
    CFamily(String, CHost),
    /// A file of naga's in a language other than WGSL.
    Naga {
        /// The language.
        target: Target,
        /// The file.
        bytes: Vec<u8>,
        /// The source from which naga wrote it.
        lowered: Lowered,
    },
}

impl TargetCode {
    /// The bytes of the file.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Lowered(lowered) => lowered.text().as_bytes().to_vec(),
            Self::Wgsl(text, _) | Self::Glsl(text, _) | Self::CFamily(text, _) => text.into_bytes(),
            Self::Naga { bytes, .. } => bytes,
        }
    }
}

/// The result of a conversion.
#[derive(Debug)]
pub struct Conversion {
    /// The file.
    pub code: TargetCode,
    /// The proof; `None` if no proof was requested.
    pub proof: Option<Result<ShaderProof, ProofError>>,
    /// Why naga wrote the file, which the author recognizes less well.
    pub fallback: Option<FallbackReason>,
}

/// Why our own writer was not used.
#[derive(Debug, Error)]
pub enum FallbackReason {
    /// The writer wrote nothing.
    #[error(transparent)]
    Unwritable(WriterError),
    /// The text could not be proved, and naga's could.
    #[error(transparent)]
    Unproved(ProofError),
}

/// Why our own writer wrote nothing.
#[derive(Debug, Error)]
pub enum WriterError {
    /// The shader has a construct that it does not support.
    #[error("cannot be written in the style `{style}`: {why}")]
    Unprintable {
        /// The name of the host.
        style: &'static str,
        /// The construct.
        why: Unprintable,
    },
    /// naga rejects its text with this message.
    #[error("{0}")]
    Refused(String),
    /// The worker that reads its text failed.
    #[error(transparent)]
    Worker(gpu::Failure),
}

/// Why a shader could not be converted.
#[derive(Debug, Error)]
pub enum ConvertError {
    /// The shader takes too long to compile.
    #[error(transparent)]
    Overdue(#[from] Overdue),
    /// naga or its worker failed.
    #[error(transparent)]
    Worker(#[from] gpu::Failure),
    /// The shader cannot be written for this kind of host, and naga only writes for the plain one.
    #[error(transparent)]
    Unwritable(WriterError),
    /// The shader cannot be written for another host of GLSL.
    #[error(transparent)]
    Port(PortError),
}

impl Conversion {
    /// Writes a proof beside the file, if there is a prover.
    ///
    /// # Errors
    /// If the shader takes too long to compile.
    fn new(source: Source, code: TargetCode, prover: Option<&mut Prover>) -> Result<Self, ConvertError> {
        let proof = match prover.map(|prover| prover.prove(source, &code)) {
            Some(Err(ProofError::Overdue(overdue))) => return Err(overdue.into()),
            proof => proof,
        };
        Ok(Self {
            code,
            proof,
            fallback: None,
        })
    }

    /// Returns whether it is proved, or no proof was requested.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.proof.as_ref().is_none_or(Result::is_ok)
    }

    /// Returns whether it is not proved, and another conversion of the shader might be.
    fn is_replaceable(&self) -> bool {
        matches!(&self.proof, Some(Err(unproved)) if !unproved.is_of_shader())
    }
}

impl Converter {
    /// Converts a shader; `translator` runs naga. With a prover, the conversion is proved too. Plain WGSL,
    /// HLSL and Metal that our own writer cannot write, or that is not proved, is naga's.
    ///
    /// # Errors
    /// Returns why there is no conversion. One that is not proved is not an error.
    pub fn convert(
        &self,
        source: Source,
        title: Title,
        translator: &mut Worker,
        mut prover: Option<&mut Prover>,
    ) -> Result<Conversion, ConvertError> {
        let Some(target) = self.target else {
            let lowered = self.lower(source)?;
            return Conversion::new(source, TargetCode::Lowered(lowered), prover);
        };
        if let Some(dialect) = self.dialect {
            let written = self.port(source, dialect)?;
            return Conversion::new(source, written, prover);
        }
        if !self.prints() {
            let written = self.write_with_naga(source, target, translator)?;
            return Conversion::new(source, written, prover);
        }
        let own = match self.c_host {
            Some(host) => self.write_c(source, host, title),
            None => self.write_wgsl(source, translator),
        };
        let own = own.and_then(|written| Conversion::new(source, written, prover.as_deref_mut()));
        let is_plain = self.may_fall_back();
        let own = match own {
            Ok(own) if is_plain && own.is_replaceable() => Ok(own),
            Err(ConvertError::Unwritable(error)) if is_plain => Err(error),
            own => return own,
        };
        let other = self
            .write_with_naga(source, target, translator)
            .and_then(|written| Conversion::new(source, written, prover));
        let with_reason = |reason| {
            move |other| Conversion {
                fallback: Some(reason),
                ..other
            }
        };
        match (own, other) {
            (Err(error), other) => other.map(with_reason(FallbackReason::Unwritable(error))),
            (
                Ok(Conversion {
                    proof: Some(Err(unproved)),
                    ..
                }),
                Ok(other),
            ) if other.is_proved() || matches!(unproved, ProofError::AppleOnly(_)) => {
                Ok(with_reason(FallbackReason::Unproved(unproved))(other))
            }
            // Neither is proved: the readable one is better.
            (Ok(own), _) => Ok(own),
        }
    }

    /// The extension of files in the target language, without the dot.
    #[must_use]
    pub fn extension(&self) -> &'static str {
        match (self.dialect, self.target) {
            (Some(dialect), _) if dialect.calls_main_image() => SHADERTOY_EXTENSION,
            (_, Some(target)) => self.c_host.map_or_else(|| target.extension(), CHost::extension),
            (_, None) => LOWERED_EXTENSION,
        }
    }

    /// Whether our own writer prints the files.
    fn prints(&self) -> bool {
        let has_writer = self.target == Some(Target::Wgsl) || self.c_host.is_some();
        has_writer && self.float == FloatMode::Fast
    }

    /// Whether naga can write what our own writer cannot.
    fn may_fall_back(&self) -> bool {
        let is_plain = self.c_host.map_or(self.style == Style::Plain, CHost::is_plain);
        self.prints() && is_plain
    }

    fn lower(&self, source: Source) -> Result<Lowered, ConvertError> {
        let deadline = Deadline::after(self.timeout);
        Ok(self.float.lower_for_host(source.checked, &deadline)?)
    }

    /// Writes the shader's text for another host.
    fn port(&self, source: Source, dialect: Dialect) -> Result<TargetCode, ConvertError> {
        let deadline = Deadline::after(self.timeout);
        let refusal = |files: &Files, written: &Checked| {
            let lints = toyproof_lint::lint(files, written, &deadline);
            let mut warnings = lints.warnings.into_iter();
            warnings.find(|warning| warning.code == Code::BeyondAppendixA)
        };
        match glsl::port(source.checked, source.files, dialect, &refusal, &deadline) {
            Ok(text) => Ok(TargetCode::Glsl(text, dialect)),
            Err(PortError::Overdue(overdue)) => Err(overdue.into()),
            Err(error) => Err(ConvertError::Port(error)),
        }
    }

    /// Writes WGSL that keeps the author's names and comments, and that naga reads.
    fn write_wgsl(&self, source: Source, translator: &mut Worker) -> Result<TargetCode, ConvertError> {
        let deadline = Deadline::after(self.timeout);
        let kept = with_uniforms(source, &deadline);
        let checked = kept.as_ref().unwrap_or(source.checked);
        let text = wgsl::wgsl(checked, source.files, self.style, &deadline);
        let text = text.map_err(|failure| match failure {
            WriteFailure::Overdue(overdue) => ConvertError::Overdue(overdue),
            WriteFailure::Unprintable(why) => ConvertError::Unwritable(WriterError::Unprintable {
                style: self.style.name(),
                why,
            }),
        })?;
        match translator.read_wgsl(&self.style.hosted(&text).text) {
            Ok(()) => Ok(TargetCode::Wgsl(text, self.style)),
            Err(failure @ gpu::Failure::Timeout { .. }) => Err(failure.into()),
            Err(gpu::Failure::Reread(why)) => Err(ConvertError::Unwritable(WriterError::Refused(why))),
            Err(failure) => Err(ConvertError::Unwritable(WriterError::Worker(failure))),
        }
    }

    /// Writes code of a language with the syntax of C, which keeps the author's names and comments.
    fn write_c(&self, source: Source, host: CHost, title: Title) -> Result<TargetCode, ConvertError> {
        let deadline = Deadline::after(self.timeout);
        let text = c_family::write(source.checked, source.files, host, title, &deadline);
        match text {
            Ok(text) => Ok(TargetCode::CFamily(text, host)),
            Err(WriteFailure::Overdue(overdue)) => Err(ConvertError::Overdue(overdue)),
            Err(WriteFailure::Unprintable(why)) => Err(ConvertError::Unwritable(WriterError::Unprintable {
                style: host.name(),
                why,
            })),
        }
    }

    fn write_with_naga(
        &self,
        source: Source,
        target: Target,
        translator: &mut Worker,
    ) -> Result<TargetCode, ConvertError> {
        let lowered = self.lower(source)?;
        let bytes = translator.translate(lowered.clone(), target, self.float)?;
        Ok(match target {
            Target::Wgsl => {
                let text = String::from_utf8_lossy(&bytes).into_owned();
                TargetCode::Wgsl(text, Style::Plain)
            }
            _ => TargetCode::Naga {
                target,
                bytes,
                lowered,
            },
        })
    }
}
