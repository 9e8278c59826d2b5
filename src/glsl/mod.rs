//! GLSL ES 3.00 as `ShaderToy` runs it: from an author's text to a typed tree.
//!
//! ```text
//! text ─► preprocess ─► tokens ─► parse ─(asks)─► check ─► tree
//! ```
//!
//! The parser knows the grammar and nothing else; at each construct it asks the checker, which knows scopes, types and rules, for
//! a typed node. So there is one tree, and no tree of mere syntax. Section numbers (§) are those of the GLSL ES 3.00.6
//! specification; where WebGL 2 (ANGLE) is stricter, so are we, and the place says so.

mod codes;
mod options;
mod preprocess;
mod token;
pub mod tree;

pub use codes::Code;
pub use options::Options;

use crate::diagnostic::Diagnostic;
use tree::{FunctionId, SamplerShape, Tree};

/// How deep statements, parentheses, calls, unary operators and `?:` may nest, all together. More is refused with a diagnostic; this much
/// fits a stack of 2 MB. Chains of operators, of postfix `.x` and `[i]`, of commas and of `else if` do not count.
pub const MAX_NESTING: usize = 256;

/// A shader that keeps every rule.
#[derive(Debug, Clone)]
pub struct Checked {
    /// The shader.
    pub tree: Tree,
    /// `void mainImage(out vec4, in vec2)`.
    pub main_image: FunctionId,
    /// The shapes of `iChannel0` to `iChannel3`, as asked for or told from use.
    pub channels: [SamplerShape; 4],
    /// What is legal and worth a word.
    pub warnings: Vec<Diagnostic>,
}
