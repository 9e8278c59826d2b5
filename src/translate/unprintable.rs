//! Why a shader cannot be written as readable code.

use thiserror::Error;
use toyproof_diagnostic::{Diagnostic, Overdue};

/// Why a writer of readable code cannot print a shader.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Unprintable {
    /// A construct that the writer does not support, whose place is not known.
    #[error("{0} is not supported")]
    Construct(&'static str),
    /// A feature that the host does not provide, or a construct that is not supported.
    #[error("{}", .0.message)]
    Host(Box<Diagnostic>),
}

/// Why no text was printed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum WriteFailure {
    /// An unsupported construct or feature.
    #[error(transparent)]
    Unprintable(#[from] Unprintable),
    /// The deadline passed.
    #[error(transparent)]
    Overdue(#[from] Overdue),
}
