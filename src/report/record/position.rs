//! Positions in shaders, as reports state them.

use serde::{Deserialize, Serialize};
use toyproof_diagnostic as diagnostic;

/// A position in a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl From<diagnostic::Position> for Position {
    fn from(diagnostic::Position { line, column }: diagnostic::Position) -> Self {
        Self { line, column }
    }
}
