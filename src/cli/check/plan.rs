//! The requirements on shaders: those that the arguments name, or an assignment.

use std::path::{Path, PathBuf};

use toyproof_classroom::assignment::{Assignment, FILE_NAME, is_assignment};
use toyproof_diagnostic::path_name;
use toyproof_glsl::UniformValue;
use toyproof_image::{Frame, FrameInputs};
use toyproof_project::files::{self, Input, OutsideLink};
use toyproof_report::Rubric;
use toyproof_verify::Difference;

use super::options::{PlanOptions, TaskInputs};
use crate::cli::inputs::{LanguageArgs, resized};
use crate::cli::reference::ReferenceArgs;
use crate::cli::shader::parse_named;
use crate::cli::{CliError, Terminal};

/// The requirements on shaders.
pub(super) struct Plan {
    /// The reference.
    pub(super) reference: ReferenceArgs,
    /// The frames, at least one.
    pub(super) frames: Vec<PlannedFrame>,
    /// The differences from the reference that do not make a shader wrong.
    pub(super) permitted: Vec<Difference>,
    pub(super) rubric: Option<Rubric>,
    /// The values of uniforms.
    pub(super) uniforms: Vec<UniformValue>,
    /// The assignment and its text, if there is one.
    pub(super) assignment: Option<(Assignment, String)>,
    /// The file of the assignment.
    pub(super) assignment_file: Option<PathBuf>,
}

/// A frame in which shaders are checked.
#[derive(Clone)]
pub(in crate::cli) struct PlannedFrame {
    pub(in crate::cli) inputs: FrameInputs,
    /// The inputs with loaded channels, in their size or the default one; a scene or a reference image may
    /// set another size.
    pub(in crate::cli) frame: Frame,
}

impl Plan {
    /// The options of the language for a frame: the user's values of uniforms, else those of the frame, else
    /// those of the assignment.
    pub(super) fn language(&self, given: &LanguageArgs, frame: &FrameInputs) -> LanguageArgs {
        given.with_uniforms(&frame.uniforms).with_uniforms(&self.uniforms)
    }

    /// Reads the plan: the assignment that the task names, else, without a reference among the options, the
    /// one in the folder of all shaders; else the options alone.
    pub(super) fn new(
        options: &PlanOptions,
        task: &TaskInputs,
        terminal: &Terminal,
    ) -> Result<Self, CliError> {
        let rubric = task.rubric.as_ref().map(|path| parse_named(path, Rubric::parse));
        let rubric = rubric.transpose()?;
        let assignment = match &task.assignment {
            Some(path) => Some(assignment_file(path)?),
            None if options.reference.is_given() => None,
            None => common_assignment(&task.shaders)?,
        };
        let mut plan = Self {
            reference: options.reference.clone(),
            frames: Vec::new(),
            permitted: options.permitted.clone(),
            rubric,
            uniforms: Vec::new(),
            assignment: None,
            assignment_file: None,
        };
        let mut frames = vec![options.frame.clone()];
        if let Some(path) = assignment {
            let (assignment, text) = parse_assignment(&path)?;
            terminal.detail(&format!("assignment: {}", path_name(&path)));
            if !options.is_frame_given {
                frames = resized(&assignment.frames, options.frame.size);
            }
            plan.reference = ReferenceArgs::of(&assignment);
            plan.permitted.extend(&assignment.permitted);
            plan.uniforms.clone_from(&assignment.uniforms);
            plan.rubric = plan.rubric.or_else(|| assignment.rubric.clone());
            plan.assignment = Some((assignment, text));
            plan.assignment_file = Some(path);
        }
        for inputs in frames {
            let frame = inputs.load()?;
            plan.frames.push(PlannedFrame { inputs, frame });
        }
        Ok(plan)
    }
}

/// Reads the assignment that an argument names, and returns its file.
pub(in crate::cli) fn read_assignment(path: &Path) -> Result<(PathBuf, Assignment), CliError> {
    let file = assignment_file(path)?;
    let (assignment, _) = parse_assignment(&file)?;
    Ok((file, assignment))
}

/// The file of the assignment that `--assignment` names, by its file or its folder.
fn assignment_file(path: &Path) -> Result<PathBuf, CliError> {
    let file = if path.is_dir() {
        path.join(FILE_NAME)
    } else {
        path.to_owned()
    };
    if file.is_file() {
        return Ok(file);
    }
    let error = CliError::new(format_args!("there is no assignment {}", path_name(&file)));
    Err(error.with_help("`toyproof new assignment` creates one"))
}

/// The assignment next to a shader, `NAME.toml` of `NAME.glsl`, unless that is a link that leads out of the
/// folder.
pub(in crate::cli) fn assignment_beside(found: &Input) -> Option<PathBuf> {
    let shader = found.path()?;
    let beside = shader.with_extension("toml");
    let folder = found.folder.as_deref().or(shader.parent())?;
    let is_usable = beside.is_file() && OutsideLink::find(&beside, folder).is_none();
    let text = is_usable.then(|| files::read_text(&beside).ok())??;
    is_assignment(text.text()).then_some(beside)
}

/// The assignment in the folder of all shaders. Folders of submissions are searched for shaders, but an
/// assignment in one of them is not used: its author is a student.
fn common_assignment(shaders: &[PathBuf]) -> Result<Option<PathBuf>, CliError> {
    let mut found: Option<PathBuf> = None;
    let mut without = None;
    for shader in shaders {
        let folder = if shader.is_dir() {
            shader
        } else {
            shader.parent().unwrap_or(Path::new(""))
        };
        let path = folder.join(FILE_NAME);
        if shader == Path::new("-") || !path.is_file() {
            without = Some(shader);
            continue;
        }
        if let Some(skipped) = OutsideLink::find(&path, folder) {
            return Err(CliError::new(format_args!(
                "the assignment cannot be used: {skipped}"
            )));
        }
        match &found {
            Some(other) if *other != path => {
                let [first, second] = [other, &path].map(|path| path_name(path));
                let error = CliError::new(format_args!(
                    "there are several assignments: {first} and {second}"
                ));
                return Err(
                    error.with_help("name one with --assignment, or check their shaders one after the other")
                );
            }
            _ => found = Some(path),
        }
    }
    match (&found, without) {
        (Some(path), Some(shader)) => {
            let [path, shader] = [path, shader].map(|path| path_name(path));
            let error = format!("{path} is not the assignment of {shader}, which is elsewhere");
            Err(CliError::new(error)
                .with_help("name it with --assignment, or check the shaders one after the other"))
        }
        _ => Ok(found),
    }
}

/// Reads an assignment. Also returns its text.
fn parse_assignment(path: &Path) -> Result<(Assignment, String), CliError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    parse_named(path, |files, file| {
        let assignment = Assignment::parse(files, file, folder)?;
        Ok((assignment, files.get(file).text().to_owned()))
    })
}
