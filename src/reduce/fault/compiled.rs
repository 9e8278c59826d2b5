//! Shaders and projects that compile, and what the image of a project reads in the frame that is tested.

use std::time::Duration;

use toyproof_diagnostic::{Deadline, Diagnostics, File, FileId, Files};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::Frame;
use toyproof_lint::{Lints, lint, uninitialized_reads};
use toyproof_project::{CompiledProject, PROJECT_FILE, PassKind, Project, Rendering};
use toyproof_translate::FloatMode;
use toyproof_verify::project::bind::{BoundFrame, PassDifference, Renderers, bind, clock};
use toyproof_verify::project::frames::Frames;
use toyproof_verify::project::playback::PassShader;
use toyproof_verify::{Case, Failure, FromStart};

use super::Subject;
use crate::parts::Part;

/// A project whose passes are reduced. Its parts are the texts of its passes, with Common in front of each,
/// and after them its inputs, whose texts are empty.
#[derive(Debug, Clone)]
pub struct ProjectParts {
    project: Project,
    passes: Vec<PassKind>,
    inputs: Vec<(PassKind, usize)>,
}

impl ProjectParts {
    /// The parts of a project. `text` returns the text of a pass with Common and included files, and how
    /// it is checked.
    pub fn new(
        project: &Project,
        mut text: impl FnMut(PassKind) -> (String, glsl::Options),
    ) -> (Self, Vec<Part>) {
        let passes: Vec<PassKind> = project.passes.iter().map(|pass| pass.kind).collect();
        let channels = project.passes.iter().flat_map(|pass| {
            let bound = (0..pass.inputs.len()).filter(|&channel| pass.inputs[channel].is_some());
            bound.map(|channel| (pass.kind, channel))
        });
        let inputs: Vec<_> = channels.collect();
        let texts = passes.iter().map(|&kind| {
            let (text, language) = text(kind);
            Part {
                text,
                language,
                is_required: kind == PassKind::Image,
            }
        });
        let parts = texts.chain(inputs.iter().map(|_| Part {
            text: String::new(),
            language: glsl::Options::default(),
            is_required: false,
        }));
        let parts = parts.collect();
        let project = project.clone();
        let own = Self {
            project,
            passes,
            inputs,
        };
        (own, parts)
    }

    /// The project with the texts of parts, which are added to `files`.
    pub fn project(&self, texts: &[Option<String>], files: &mut Files) -> Project {
        let passes = self.passes.iter().zip(texts).filter_map(|(&kind, text)| {
            let text = text.clone()?;
            Some((kind, files.add(File::new(kind.to_string(), text))))
        });
        let passes: Vec<(PassKind, FileId)> = passes.collect();
        let keeps = |kind, channel| {
            let input = self.inputs.iter().position(|&own| own == (kind, channel));
            input.is_some_and(|input| texts[self.passes.len() + input].is_some())
        };
        self.project.subset(&passes, keeps)
    }

    /// The files of the folder with the texts of parts, by their names.
    pub fn folder(&self, texts: &[Option<String>]) -> Vec<(String, String)> {
        let mut files = Files::default();
        let project = self.project(texts, &mut files);
        let tabs = project.tabs().iter();
        let tabs = tabs.map(|&(tab, file)| (tab.file_name(), files.get(file).text().to_owned()));
        tabs.chain([(PROJECT_FILE.to_owned(), project.to_toml())])
            .collect()
    }
}

/// A shader that compiles, or a project.
pub(super) struct Compiled {
    pub(super) files: Files,
    content: Content,
    /// The lints of a project; those of a shader are computed when they are needed.
    lints: Option<Lints>,
}

enum Content {
    Shader(Box<Checked>),
    Project(Box<CompiledProject>),
}

/// The frame that is tested.
pub(super) struct Bound {
    /// The frame with what the image reads.
    pub(super) frame: Frame,
    /// What earlier frames contribute.
    pub(super) history: Option<BoundFrame>,
}

impl Bound {
    /// The case of the image in this frame.
    pub(super) fn case<'a>(
        &'a self,
        image: &'a Checked,
        lints: &'a Lints,
        subject: &Subject<'a>,
    ) -> Case<'a> {
        let from_start = self.history.as_ref().map(|history| FromStart {
            double: &history.double,
            growth: history.growth.visible,
        });
        Case {
            expected: subject.expected,
            from_start,
            ..Case::new(image, lints, &self.frame).with_timeout(subject.timeout)
        }
    }
}

/// The longest time limit of a frame of all passes: a loop without an end is a frequent candidate.
const MAX_FRAME_TIMEOUT: Duration = Duration::from_secs(2);

impl Compiled {
    /// Compiles the text of a shader, or those of the parts of a project.
    pub(super) fn new(texts: &[Option<String>], subject: &Subject) -> Result<Self, Diagnostics> {
        let mut files = Files::default();
        let mut options = subject.language.clone();
        options.deadline = Deadline::after(subject.timeout);
        let Some(parts) = &subject.project else {
            let text = texts.first().cloned().flatten().unwrap_or_default();
            let file = files.add(File::new("shader", text));
            let checked = glsl::check(&files, file, &options)?;
            return Ok(Self {
                files,
                content: Content::Shader(Box::new(checked)),
                lints: None,
            });
        };
        let project = parts.project(texts, &mut files);
        let checked = toyproof_project::check(&project, &mut files, &options)?;
        let (compiled, lints) = CompiledProject::of_checked(project, checked);
        Ok(Self {
            files,
            content: Content::Project(Box::new(compiled)),
            lints: Some(lints),
        })
    }

    /// The tree of the shader, or of the image of a project.
    pub(super) fn image(&self) -> &Checked {
        match &self.content {
            Content::Shader(checked) => checked,
            Content::Project(project) => project.image(),
        }
    }

    /// The number of variables that are read, on some path at least, without a value.
    pub(super) fn uninitialized_reads(&self, timeout: Duration) -> usize {
        let deadline = Deadline::after(timeout);
        let reads = |checked: &Checked| uninitialized_reads(checked, &deadline);
        match &self.content {
            Content::Shader(checked) => reads(checked),
            Content::Project(project) => project.checked.iter().map(reads).sum(),
        }
    }

    /// The findings of the lints.
    pub(super) fn lints(&self, timeout: Duration) -> Lints {
        match &self.lints {
            Some(lints) => lints.clone(),
            None => lint(&self.files, self.image(), &Deadline::after(timeout)),
        }
    }

    /// The frame of a subject with what the image reads in it. A driver renders the other passes, too, if
    /// there is one.
    pub(super) fn bind(&self, subject: &Subject, driver: Option<&mut Worker>) -> Result<Bound, Failure> {
        let mut frame = subject.frame.clone();
        let Content::Project(project) = &self.content else {
            return Ok(Bound { frame, history: None });
        };
        let rendering = project
            .rendering(PassKind::Image)
            .map_err(|error| Failure::Unrendered(error.to_string()))?;
        let shader = pass_shader(project, &rendering);
        let renderers = Renderers {
            driver: driver.map(|worker| worker as _),
            float: FloatMode::Strict,
            timeout: subject.timeout.min(MAX_FRAME_TIMEOUT),
            pool: None,
        };
        let history = bind(&shader, &mut frame, false, renderers)?;
        Ok(Bound { frame, history })
    }

    /// The pass of a difference, and the frame of the difference with what the pass reads.
    pub(super) fn inputs_of(
        &self,
        subject: &Subject,
        difference: PassDifference,
    ) -> Option<(&Checked, Frame)> {
        let Content::Project(project) = &self.content else {
            return None;
        };
        let rendering = project.rendering(PassKind::Image).ok()?;
        let shader = pass_shader(project, &rendering);
        let mut passes = shader.graph.passes().iter();
        let pass = passes.position(|pass| pass.target == difference.pass)?;
        let programs = shader.programs(subject.timeout).ok()?;
        let clock = clock(&shader.with_films(&subject.frame));
        let frames = Frames {
            shader: &shader,
            programs: &programs,
            clock: &clock,
            last: difference.frame,
            timeout: subject.timeout,
            pool: None,
        };
        let mut playback = frames.start::<f32>((), frames.timeout);
        for number in 0..=frames.last {
            playback.render(&clock.frame(number)).ok()?;
        }
        let frame = playback.bound(pass, &clock.frame(frames.last));
        let checked = &project.checked[rendering.passes[pass]];
        Some((checked, frame))
    }
}

fn pass_shader<'a>(project: &'a CompiledProject, rendering: &'a Rendering) -> PassShader<'a> {
    PassShader {
        checked: project.checked_of(rendering).collect(),
        graph: &rendering.graph,
        media: &rendering.media,
        films: rendering.films.clone(),
    }
}
