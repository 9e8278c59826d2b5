//! A project in memory.

use toyproof_diagnostic::FileId;
use toyproof_glsl::UniformValue;

use crate::format::{Format, Wrapper};
use crate::node::Node;
use crate::pass::{Input, Pass, PassKind, Tab};
use crate::textures::LoadedMedia;

/// A project: Common, and passes with their inputs.
#[derive(Debug, Clone)]
pub struct Project {
    /// The text of Common.
    pub common: Option<FileId>,
    /// The passes in the order of the file. Buffers run in this order; Cube A runs after them, and the image
    /// last.
    pub passes: Vec<Pass>,
    /// Whether the inputs are given. Otherwise channel *n* of every pass but Sound is assumed to read the
    /// *n*th buffer, if there is one.
    pub knows_inputs: bool,
    /// The values of uniforms that the passes declare.
    pub uniforms: Vec<UniformValue>,
    /// The files of media that were read.
    pub(crate) media: LoadedMedia,
    pub(crate) document: Document,
}

/// The site's JSON without the code, as a tree.
#[derive(Debug, Clone)]
pub(crate) struct Document {
    pub(crate) root: Node,
    pub(crate) format: Format,
    pub(crate) wrapper: Wrapper,
    /// The text of each element of `renderpass`.
    pub(crate) tabs: Vec<(Tab, FileId)>,
}

impl Project {
    /// The name of the shader, if it has one.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.document.root.get("info")?.get("name")?.as_str()
    }

    /// Who made the shader and where it is, such as `"Waves" by someone, https://www.shadertoy.com/view/XsBXWt`;
    /// `None` without a name or an author.
    #[must_use]
    pub fn credit(&self) -> Option<String> {
        let text = |key: &str| self.document.root.get("info")?.get(key)?.as_str();
        let is_given = |text: &&str| !text.trim().is_empty();
        let name = text("name").filter(is_given)?;
        let author = text("username").filter(is_given)?;
        // The editor's export of a shader that has not been saved has the id -1.
        let id = text("id").filter(|id| id.len() == 6 && id.chars().all(|c| c.is_ascii_alphanumeric()));
        let place = id.map_or_else(String::new, |id| format!(", https://www.shadertoy.com/view/{id}"));
        Some(format!("\"{name}\" by {author}{place}"))
    }

    /// The pass that renders the image.
    ///
    /// # Panics
    /// Never: every project has one.
    #[must_use]
    pub fn image(&self) -> &Pass {
        self.pass(PassKind::Image).expect("every project has an image")
    }

    /// The pass of that kind, if there is one.
    #[must_use]
    pub fn pass(&self, kind: PassKind) -> Option<&Pass> {
        self.passes.iter().find(|pass| pass.kind == kind)
    }

    /// The paths of the files in the project's folder that inputs read.
    pub fn media_files(&self) -> impl Iterator<Item = &str> {
        self.inputs().filter_map(|input| input.source.file())
    }

    /// The inputs of all passes.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = &Input> {
        self.passes.iter().flat_map(|pass| pass.inputs.iter().flatten())
    }

    /// All tabs with their texts, in the order of the file.
    #[must_use]
    pub fn tabs(&self) -> &[(Tab, FileId)] {
        &self.document.tabs
    }
}
