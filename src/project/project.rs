//! A project in memory.

use std::collections::HashMap;

use toyproof_diagnostic::{Code, Diagnostic, FileId};
use toyproof_glsl::UniformValue;
use toyproof_image::Image;

use crate::format::{Format, Wrapper};
use crate::node::Node;
use crate::pass::{Input, Pass, PassKind, Tab};

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
    /// The images of the project's folder that were added, by their paths.
    pub(crate) images: HashMap<String, Image>,
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

    /// The inputs that read an image of the project's folder, each with the path of its file.
    pub fn image_inputs(&self) -> impl Iterator<Item = (&Input, &str)> {
        let inputs = self.passes.iter().flat_map(|pass| pass.inputs.iter().flatten());
        inputs.filter_map(|input| Some((input, input.source.file()?)))
    }

    /// Adds the images of the project's folder, which `read` reads by their paths. The image of an input that
    /// has none is black.
    ///
    /// # Errors
    /// Why images cannot be read, each at its input.
    pub fn add_images(
        &mut self,
        mut read: impl FnMut(&str) -> Result<Image, String>,
    ) -> Result<(), Vec<Diagnostic>> {
        let mut images = HashMap::new();
        let mut errors = Vec::new();
        for (input, path) in self.image_inputs() {
            if images.contains_key(path) {
                continue;
            }
            match read(path) {
                Ok(image) => {
                    images.insert(path.to_owned(), image);
                }
                Err(reason) => {
                    let error = Diagnostic::new(Code::ProjectValue, reason);
                    errors.push(match input.span {
                        Some(span) => error.at(span),
                        None => error,
                    });
                }
            }
        }
        self.images = images;
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// All tabs with their texts, in the order of the file.
    #[must_use]
    pub fn tabs(&self) -> &[(Tab, FileId)] {
        &self.document.tabs
    }
}
