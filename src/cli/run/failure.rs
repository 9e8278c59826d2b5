//! Why `run` renders no image.

use toyproof_diagnostic::Diagnostic;
use toyproof_eval as eval;
use toyproof_glsl as glsl;
use toyproof_gpu::Failure;
use toyproof_player::Target;
use toyproof_report as report;

use crate::cli::shader::Shader;
use crate::cli::{CliError, Exit};

/// Why there is no image.
pub(super) enum ImageFailure {
    Failed(CliError),
    /// The user interrupted the rendering.
    Interrupted,
}

impl From<CliError> for ImageFailure {
    fn from(error: CliError) -> Self {
        Self::Failed(error)
    }
}

/// Whether a shader is too large for the evaluator, so that a driver may be able to render it.
pub(super) fn is_too_large(failure: &eval::Failure) -> bool {
    use eval::Refusal::{NoMemory, TooDeep, TooLong};
    matches!(failure, eval::Failure::Refused(TooLong | TooDeep | NoMemory))
}

/// Why the driver rendered nothing.
pub(super) fn draw_error(failure: Failure, shader: &Shader) -> CliError {
    match failure {
        Failure::Invalid(diagnostics) => shader_error(diagnostics, shader),
        Failure::Refused(diagnostics) => CliError::diagnostics(diagnostics, &shader.files),
        failure => {
            let mut error = CliError::new(format_args!("{}: {failure}", shader.name));
            if failure.is_timeout() {
                error =
                    error.with_help("allow more time with --timeout, or render on the CPU with --device cpu");
            }
            if failure.is_invalid() || matches!(failure, Failure::Timeout { .. }) {
                error = error.with_exit(Exit::ShaderFault);
            }
            error
        }
    }
}

/// The errors of a shader.
pub(super) fn shader_error(diagnostics: Vec<Diagnostic>, shader: &Shader) -> CliError {
    CliError::diagnostics(diagnostics, &shader.files).with_exit(Exit::ShaderFault)
}

/// Why the evaluator rendered no image.
pub(super) fn image_failure(failure: &eval::Failure, shader: &Shader) -> ImageFailure {
    match failure {
        eval::Failure::Interrupted => ImageFailure::Interrupted,
        failure => ImageFailure::Failed(evaluation_error(failure, shader)),
    }
}

/// Why the evaluator failed.
pub(in crate::cli) fn evaluation_error(failure: &eval::Failure, shader: &Shader) -> CliError {
    pass_error(failure, None, shader)
}

/// Why the evaluator failed, and in which pass of a project.
pub(in crate::cli) fn pass_error(failure: &eval::Failure, pass: Option<Target>, shader: &Shader) -> CliError {
    let tab = pass.map_or_else(String::new, |pass| format!("{pass}: "));
    if let eval::Failure::Refused(eval::Refusal::TooSlow(overdue)) = failure {
        let mut diagnostic = glsl::overdue(*overdue);
        diagnostic.message.insert_str(0, &tab);
        return shader_error(vec![diagnostic], shader);
    }
    let position = report::failure_position(failure, &shader.files);
    let error = CliError::new(format_args!("{}: {tab}{failure}{position}", shader.name));
    match failure {
        eval::Failure::Refused(_) => error,
        eval::Failure::Timeout { .. } | eval::Failure::TimeUp => error
            .with_help("allow more time with --timeout")
            .with_exit(Exit::ShaderFault),
        _ => error.with_exit(Exit::ShaderFault),
    }
}
