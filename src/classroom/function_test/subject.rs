//! The shader whose functions are tested.

use std::time::Duration;

use toyproof_diagnostic::{Deadline, Files};
use toyproof_glsl::tree::Function;
use toyproof_glsl::{self as glsl, Checked};

/// A shader whose functions are tested.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The files of the shader.
    pub files: &'a Files,
    /// The text of the shader.
    pub text: &'a str,
    /// The time limit of a test.
    pub timeout: Duration,
}

impl Subject<'_> {
    pub(super) fn options(&self) -> glsl::Options {
        glsl::Options {
            // The text that runs the tests counts and packs bits.
            calls_added_main: true,
            lenient: self.checked.lenient || !self.checked.version.has_integer_operations(),
            deadline: Deadline::after(self.timeout),
            ..self.checked.options()
        }
    }

    /// The definitions of all functions of that name.
    pub(crate) fn functions<'s>(&'s self, name: &'s str) -> impl Iterator<Item = &'s Function> {
        let functions = self.checked.tree.functions.iter().map(|(_, function)| function);
        functions.filter(move |function| function.name == name && function.body.is_some())
    }
}
