//! Why there is no image of a shader.

use thiserror::Error;
use toyproof_diagnostic::{Diagnostic, Overdue, grouped, plural};
use toyproof_eval as eval;
use toyproof_glsl as glsl;
use toyproof_player::DriverFailure;

use crate::contain::Panic;

/// Why there is no image of a shader.
#[derive(Debug, Clone, Error)]
pub enum Failure {
    /// No shader was submitted.
    #[error("{0}")]
    Missing(String),
    /// The shader, or its scene, cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// The shader is part of a project that cannot be rendered yet.
    #[error("{0}")]
    Unrendered(String),
    /// The shader does not compile.
    #[error("the shader does not compile")]
    Invalid(Vec<Diagnostic>),
    /// The scene is invalid.
    #[error("the scene is invalid")]
    InvalidScene(Vec<Diagnostic>),
    /// The reference cannot be evaluated.
    #[error("the reference cannot be evaluated: {0}")]
    Reference(eval::Failure),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] DriverFailure),
    /// There is no GPU, and the evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The shader takes too long to compile.
    #[error(transparent)]
    Overdue(#[from] Overdue),
    /// The driver truncated loops in that many pixels.
    #[error("the driver stopped a loop in {} {}", grouped(*.0), plural(*.0, "pixel", "pixels"))]
    LoopTruncated(u64),
    /// The GPU's image, which waited in a temporary file, cannot be read.
    #[error("the image cannot be read from a temporary file: {0}")]
    Spool(String),
    /// There was an internal error.
    #[error(transparent)]
    Panic(#[from] Panic),
}

impl Failure {
    /// Returns the diagnostics on the shader or its scene.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        match self {
            Self::Invalid(diagnostics) | Self::InvalidScene(diagnostics) => diagnostics.clone(),
            Self::Gpu(failure) => failure.diagnostics().to_vec(),
            Self::Overdue(overdue) => vec![glsl::overdue(*overdue)],
            _ => Vec::new(),
        }
    }
}
