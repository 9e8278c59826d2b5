//! Why `run` renders no image.

use toyproof_diagnostic::Diagnostic;
use toyproof_eval::{self as eval, PassFailure};
use toyproof_glsl as glsl;
use toyproof_gpu::Failure;
use toyproof_player::{Graph, Target};
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

/// Why there is no image of a frame.
pub(super) enum FrameFailure {
    /// The driver failed.
    Device(Failure),
    /// The evaluator failed.
    Evaluator(PassFailure),
    /// The user interrupted the run before this frame.
    Interrupted(i32),
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

/// The error of a frame that is not shown.
pub(super) fn frame_error(failure: FrameFailure, graph: &Graph, number: i32, shader: &Shader) -> CliError {
    match failure {
        FrameFailure::Device(failure) => draw_error(failure, shader),
        FrameFailure::Evaluator(PassFailure { pass, failure }) => {
            pass_error(&failure, target_of(graph, pass), shader)
        }
        FrameFailure::Interrupted(next) => {
            let error = format!("interrupted before frame {next}; frame {number} was to be shown");
            CliError::new(error).with_help("run the same command again to go on")
        }
    }
}

/// What the pass with this number renders, which has the name of its tab.
pub(super) fn target_of(graph: &Graph, pass: usize) -> Option<Target> {
    graph.passes().get(pass).map(|pass| pass.target)
}
