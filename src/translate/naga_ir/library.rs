//! Functions that compute what drivers differ in, `sin` and the like and products of matrices, in operations that they agree on: those
//! of strict shaders (`crate::lower_strict`), made by a shader that calls each.

use std::fmt::Write as _;

use toyproof_diagnostic::{File, Files};
use toyproof_glsl as glsl;

use super::ValidModule;

/// What stands for an operation: GLSL that computes it of `a`, `b` and `c`, with the types of those and of its value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Need {
    pub(crate) value: String,
    pub(crate) types: Vec<String>,
    pub(crate) result: String,
}

impl Need {
    /// The index of a need in the order of a list, which it is added to unless it is there.
    pub(crate) fn among(self, needs: &mut Vec<Self>) -> usize {
        needs.iter().position(|known| *known == self).unwrap_or_else(|| {
            needs.push(self);
            needs.len() - 1
        })
    }
}

const MAIN_IMAGE: &str = "mainImage";
pub(crate) const PREFIX: &str = "toyproof_need_";

/// Which need a function of the library stands for.
pub(crate) fn need(function: &str) -> Option<usize> {
    function.strip_prefix(PREFIX)?.parse().ok()
}

/// Whether a function is only there to call the others.
pub(crate) fn is_surroundings(function: &str) -> bool {
    function == MAIN_IMAGE || function == "main"
}

/// A shader that computes all that is needed, a function for each, in strict form.
///
/// # Errors
/// What is wrong with it, in one line.
pub(crate) fn library(needs: &[Need]) -> Result<ValidModule, String> {
    let mut text = String::new();
    let mut uses = String::new();
    for (index, need) in needs.iter().enumerate() {
        let parameters: Vec<_> = need
            .types
            .iter()
            .zip(["a", "b", "c"])
            .map(|(ty, name)| format!("{ty} {name}"))
            .collect();
        let arguments: Vec<_> = need.types.iter().map(|ty| format!("{ty}(p.x)")).collect();
        let Need { value, result, .. } = need;
        let _ = writeln!(
            text,
            "{result} {PREFIX}{index}({}) {{ return {value}; }}",
            parameters.join(", ")
        );
        let _ = writeln!(
            uses,
            "{result} v{index} = {PREFIX}{index}({});",
            arguments.join(", ")
        );
    }
    let _ = writeln!(text, "void {MAIN_IMAGE}(out vec4 c, in vec2 p) {{\n{uses}}}");
    let mut files = Files::default();
    let file = files.add(File::new("<library>", &text));
    let first = |errors: Vec<toyproof_diagnostic::Diagnostic>| {
        let first = errors.into_iter().next();
        first.map_or_else(String::new, |error| error.message)
    };
    let checked = glsl::check(&files, file, &glsl::Options::default()).map_err(first)?;
    ValidModule::parse(&crate::lower_strict(&checked)).map_err(first)
}
