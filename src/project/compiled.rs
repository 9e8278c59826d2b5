//! A project whose tabs compile.

use toyproof_glsl::Checked;

use crate::graph::{NotRendered, Rendering};
use crate::pass::PassKind;
use crate::project::Project;

/// A project whose tabs compile, with what renders its image.
#[derive(Debug)]
pub struct CompiledProject {
    /// The project.
    pub project: Project,
    /// The trees of the passes, in the order of the project.
    pub checked: Vec<Checked>,
}

impl CompiledProject {
    /// What renders the image and another pass.
    ///
    /// # Errors
    /// If a pass is needed that cannot be rendered.
    pub fn rendering(&self, also: PassKind) -> Result<Rendering, NotRendered> {
        self.project.rendering(&[also])
    }

    /// The trees of the passes of a rendering, in its order.
    pub fn checked_of<'a>(&'a self, rendering: &'a Rendering) -> impl Iterator<Item = &'a Checked> {
        rendering.passes.iter().map(|&at| &self.checked[at])
    }

    /// The tree of the image.
    ///
    /// # Panics
    /// Never: every project has an image.
    #[must_use]
    pub fn image(&self) -> &Checked {
        let mut passes = self.project.passes.iter().zip(&self.checked);
        let image = passes.find(|(pass, _)| pass.kind == PassKind::Image);
        image.expect("every project has an image").1
    }

    /// Whether the image reads other passes, and so depends on earlier frames.
    #[must_use]
    pub fn has_history(&self) -> bool {
        !self.project.needed_by_image().is_empty()
    }
}
