//! `toyproof new pack`: what students get of an assignment.

use std::path::{Path, PathBuf};
use std::time::Duration;

use toyproof_classroom::assignment::{Assignment, Reference};
use toyproof_classroom::autograder::assignment_name;
use toyproof_classroom::collect::naming::is_archive;
use toyproof_classroom::function_test::Subject;
use toyproof_classroom::pack::{PackFiles, PackedFrame, STARTER, pack, pack_textures};
use toyproof_diagnostic::{Deadline, File, Files, path_name};
use toyproof_glsl as glsl;
use toyproof_image::FrameInputs;
use toyproof_project::archive::{self, Mode};
use toyproof_scene as scene;
use toyproof_verify::{Difference, Expected};

use super::{quoted, refuse_existing, thumbnail};
use crate::cli::check::{PlannedFrame, expected_in, expected_of_scene, read_assignment};
use crate::cli::inputs::{LanguageArgs, frame_flags, parse_time_limit};
use crate::cli::reference::ReferenceArgs;
use crate::cli::scenes::{parse_scene, read_scene};
use crate::cli::{CliError, Terminal};

#[derive(Debug, clap::Args)]
pub(super) struct PackArgs {
    /// The assignment (.toml), or its folder
    assignment: PathBuf,
    /// The folder or the archive (.zip) to create
    #[arg(short, long, value_name = "DIR|FILE.zip")]
    output: PathBuf,
    /// The time limit for one image: seconds, or a number with a unit (500ms, 2m)
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = parse_time_limit)]
    timeout: Duration,
    #[command(flatten)]
    language: LanguageArgs,
}

/// Creates the files for students. Everything is rendered before the first file is written.
pub(super) fn new_pack(args: &PackArgs, terminal: &Terminal) -> Result<(), CliError> {
    refuse_existing(&args.output)?;
    let (path, assignment) = read_assignment(&args.assignment)?;
    let mut inputs = assignment.frames.clone();
    for inputs in &mut inputs {
        let of_frame = args.language.with_uniforms(&inputs.uniforms);
        inputs.uniforms = of_frame.with_uniforms(&assignment.uniforms).uniform;
    }
    let loaded = inputs.iter().map(FrameInputs::load);
    let loaded = loaded.collect::<Result<Vec<_>, _>>()?;
    let mut files = pack_textures(&mut inputs)?;
    let frames = inputs.into_iter().zip(loaded);
    let name = assignment_name(&path);
    let task = Task {
        args,
        assignment: &assignment,
        name: &name,
        frames: frames
            .map(|(inputs, frame)| PlannedFrame { inputs, frame })
            .collect(),
    };
    files.extend(match &assignment.reference {
        Reference::Scene(path) => task.of_scene(path)?,
        Reference::Given { .. } => task.of_given(terminal)?,
    });
    write(&args.output, &files, terminal)?;
    terminal.note(&format!("created {}:", path_name(&args.output)));
    for (file, _) in &files {
        terminal.note(&format!("  {file}"));
    }
    if !is_archive(&args.output) {
        terminal.note(&format!(
            "next:\n  toyproof check {} --assignment {}",
            quoted(&path_name(&args.output.join(STARTER))),
            quoted(&path_name(&path))
        ));
    }
    Ok(())
}

/// Writes the files into a folder or an archive.
fn write(output: &Path, files: &PackFiles, terminal: &Terminal) -> Result<(), CliError> {
    if is_archive(output) {
        let entries = files.iter();
        let entries: Vec<_> = entries
            .map(|(name, bytes)| (name.as_str(), Mode::Plain, &bytes[..]))
            .collect();
        let archive = archive::pack(&entries).map_err(|error| error.to_string())?;
        return terminal.write(output, &archive);
    }
    for (name, bytes) in files {
        terminal.write(&output.join(name), bytes)?;
    }
    Ok(())
}

/// An assignment whose pack is made.
struct Task<'a> {
    args: &'a PackArgs,
    assignment: &'a Assignment,
    name: &'a str,
    /// The frames, with the values of all uniforms. The textures of their inputs are files of the pack.
    frames: Vec<PlannedFrame>,
}

impl Task<'_> {
    /// The files for a reference that is a shader or an image.
    fn of_given(mut self, terminal: &Terminal) -> Result<PackFiles, CliError> {
        let timeout = self.args.timeout;
        let reference = ReferenceArgs::of(self.assignment);
        let language = |frame: &FrameInputs| self.args.language.with_uniforms(&frame.uniforms);
        let expected = expected_in(&reference, &mut self.frames, language, timeout, terminal)?;
        let (given, expected) = expected.ok_or_else(CliError::silent)?;
        let subject = given.shader().map(|(shader, checked)| Subject {
            checked,
            files: &shader.files,
            text: shader.text(checked),
            timeout,
        });
        self.files(&expected, subject.as_ref())
    }

    /// The files for a reference that is a scene. The signatures are those of the exported shader.
    fn of_scene(mut self, path: &Path) -> Result<PackFiles, CliError> {
        let scene = parse_scene(read_scene(path)?)?;
        let expected = expected_of_scene(&scene, &mut self.frames);
        let text = scene::export::shader(&scene).unwrap_or_default();
        let mut files = Files::default();
        let file = files.add(File::new(STARTER, text.as_str()));
        let options = glsl::Options {
            deadline: Deadline::after(self.args.timeout),
            ..glsl::Options::default()
        };
        let checked = glsl::check(&files, file, &options).ok();
        let subject = checked.as_ref().map(|checked| Subject {
            checked,
            files: &files,
            text: &text,
            timeout: self.args.timeout,
        });
        self.files(&expected, subject.as_ref())
    }

    fn files(self, expected: &[Expected], reference: Option<&Subject>) -> Result<PackFiles, CliError> {
        let mut frames = Vec::new();
        for (index, (expected, planned)) in expected.iter().zip(self.frames).enumerate() {
            let (image, png) = thumbnail(index, expected, &planned.frame)?;
            frames.push(PackedFrame {
                inputs: planned.inputs,
                size: planned.frame.size,
                image,
                png,
            });
        }
        let commands = commands(&self.args.language, self.assignment, &frames);
        Ok(pack(self.name, self.assignment, reference, frames, &commands))
    }
}

/// The commands that check the shader of a student in each frame, and test its functions.
fn commands(language: &LanguageArgs, assignment: &Assignment, frames: &[PackedFrame]) -> Vec<String> {
    let ids: Vec<_> = assignment.permitted.iter().copied().map(Difference::id).collect();
    let permit = (!ids.is_empty()).then(|| format!("--permit {}", ids.join(",")));
    // Those of each frame are among its inputs.
    let mut without_uniforms = language.clone();
    without_uniforms.uniform.clear();
    let common: Vec<String> = without_uniforms.flags().into_iter().chain(permit).collect();
    let check = frames.iter().map(|frame| {
        // The image has the size.
        let inputs = FrameInputs {
            size: None,
            ..frame.inputs.clone()
        };
        let mut command = vec![format!("toyproof check {STARTER} --reference {}", frame.image)];
        command.extend(frame_flags(&inputs));
        command.extend(common.iter().cloned());
        command.join(" ")
    });
    let test = (!assignment.functions.is_empty()).then(|| {
        let flags = language.with_uniforms(&assignment.uniforms).flags().into_iter();
        let command = std::iter::once(format!("toyproof test {STARTER}")).chain(flags);
        command.collect::<Vec<_>>().join(" ")
    });
    check.chain(test).collect()
}
