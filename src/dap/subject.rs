//! What is debugged: one pixel of a shader.

use std::time::Duration;

use toyproof_diagnostic::Files;
use toyproof_glsl::Checked;
use toyproof_image::Frame;

/// A pixel of a shader.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The name of the shader, for messages.
    pub name: String,
    /// The source files.
    pub files: Files,
    /// The shader, or a pass of a project.
    pub checked: Checked,
    /// The inputs.
    pub frame: Frame,
    /// The pixel, from the left and from the bottom, inside of the frame.
    pub pixel: [u32; 2],
    /// The color of the reference, if there is one.
    pub expected: Option<[f64; 3]>,
    /// The time limit for recording the pixel, and for evaluating the expressions of one request.
    pub timeout: Duration,
}

impl Subject {
    /// The text of the shader, with what it includes.
    pub(crate) fn text(&self) -> &str {
        let file = self.checked.tree[self.checked.main_image].at.span.file;
        self.files.get(file).text()
    }
}
