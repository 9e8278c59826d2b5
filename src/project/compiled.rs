//! A project whose tabs compile.

use std::path::Path;

use toyproof_diagnostic::{Diagnostics, Files};
use toyproof_glsl::{Checked, Options};
use toyproof_lint::Lints;
use toyproof_media::MediaFolder;

use crate::check::{CheckedProject, check_with_includes};
use crate::files::{IncludeFolders, project_image};
use crate::graph::{Rendering, UnsupportedPass};
use crate::pass::PassKind;
use crate::project::Project;
use crate::textures::LoadedMedia;

/// A project whose tabs compile, with what renders its image.
#[derive(Debug)]
pub struct CompiledProject {
    /// The project.
    pub project: Project,
    /// The trees of the passes, in the order of the project.
    pub checked: Vec<Checked>,
}

impl CompiledProject {
    /// Reads the media of a project, from its folder if it has one, or from a folder of copies of the site's,
    /// and compiles all its tabs. The lints are those of the image, with the warnings about all tabs.
    ///
    /// # Errors
    /// A medium or an included file cannot be read, or one of the tabs is invalid.
    pub fn compile(
        mut project: Project,
        (folder, media): (Option<&Path>, Option<&MediaFolder>),
        includes: Option<&IncludeFolders>,
        files: &mut Files,
        options: &Options,
    ) -> Result<(Self, Lints), Diagnostics> {
        let file = |name: &str| folder.map(|folder| project_image(folder, name)).transpose();
        let read = LoadedMedia::read(project.inputs(), file, media);
        project.media = read.map_err(|errors| Diagnostics::new(errors, files))?;
        let checked = check_with_includes(&project, includes, files, options)?;
        Ok(Self::of_checked(project, checked))
    }

    /// The same project after the texts of its tabs changed in `files`.
    ///
    /// # Errors
    /// An included file cannot be read, or one of the tabs is invalid.
    pub fn recompile(
        &self,
        includes: Option<&IncludeFolders>,
        files: &mut Files,
        options: &Options,
    ) -> Result<Self, Diagnostics> {
        let checked = check_with_includes(&self.project, includes, files, options)?;
        Ok(Self::of_checked(self.project.clone(), checked).0)
    }

    /// A project with the trees of its passes. The lints are those of the image, with the warnings about all
    /// tabs.
    #[must_use]
    pub fn of_checked(project: Project, passes: CheckedProject) -> (Self, Lints) {
        let mut lints = Lints::default();
        let mut checked = Vec::with_capacity(passes.passes.len());
        for pass in passes.passes {
            if pass.kind == PassKind::Image {
                lints = pass.lints;
            }
            checked.push(pass.checked);
        }
        lints.warnings = passes.warnings;
        (Self { project, checked }, lints)
    }

    /// What renders the image and another pass. Media that are missing are those that the passes name.
    ///
    /// # Errors
    /// If a pass is needed that cannot be rendered.
    pub fn rendering(&self, also: PassKind) -> Result<Rendering, UnsupportedPass> {
        let mut rendering = self.project.rendering(&[also])?;
        let samples = |&(kind, channel): &(PassKind, usize)| {
            let mut passes = self.project.passes.iter().zip(&self.checked);
            passes.any(|(pass, checked)| pass.kind == kind && checked.names_channel(channel))
        };
        for missing in &mut rendering.missing {
            missing.readers.retain(samples);
        }
        rendering.missing.retain(|missing| !missing.readers.is_empty());
        Ok(rendering)
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

    /// The tree of the image, to change it.
    ///
    /// # Panics
    /// Never: every project has an image.
    pub fn image_mut(&mut self) -> &mut Checked {
        let mut passes = self.project.passes.iter().zip(&mut self.checked);
        let image = passes.find(|(pass, _)| pass.kind == PassKind::Image);
        image.expect("every project has an image").1
    }
}
