//! Reads the shader that the page shows, its frame and its reference, and describes them for the page.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use serde_json::{Value, json};
use toyproof_diagnostic::{self as diagnostic, Deadline, plural};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{Scalar, Type};
use toyproof_image::{FRAME_RATE, Frame, FrameInputs, UniformValue, input};
use toyproof_project::files::{self, Input, ReadError};
use toyproof_project::{PassKind, Tab};
use toyproof_report::{DialectRecord, FrameResult, Record, page};
use toyproof_verify::project::bind::default_frame;
use toyproof_watch::{Build, Studio};

use super::Args;
use super::reference::{References, WatchedReference};
use super::verdict::check;
use super::watched::Watched;
use crate::cli::check::{assignment_beside, image, read_assignment};
use crate::cli::inputs::{LanguageArgs, resized};
use crate::cli::reference::ReferenceArgs;
use crate::cli::shader::{Shader, find_one};
use crate::cli::{CliError, Terminal};

/// Reads, renders and checks the shader that the arguments name.
pub(super) struct ShaderStudio {
    args: Args,
    /// Prints nothing: the page has the messages.
    terminal: Terminal,
    /// The images of references, which most saves leave unchanged.
    references: Arc<Mutex<References>>,
}

/// A shader as it was read, with its frame and its reference.
pub(super) struct Loaded {
    pub(super) shader: Shader,
    pub(super) input: Result<Input, ReadError>,
    /// The inputs with which the page starts, and the textures of channels.
    pub(super) frame: Frame,
    pub(super) language: LanguageArgs,
    pub(super) reference: Option<WatchedReference>,
}

impl ShaderStudio {
    /// Checks the arguments: the shader itself may have any errors, which the page shows.
    pub(super) fn new(args: Args) -> Result<Self, CliError> {
        let studio = Self {
            args,
            terminal: Terminal::new(true, false),
            references: Arc::default(),
        };
        let input = find_one(&studio.args.input, "watch", &studio.terminal)?;
        if let Err(error) = input
            && !studio.args.input.exists()
        {
            return Err(error.into());
        }
        studio.requirements()?;
        Ok(studio)
    }

    /// The frame, the language and the reference that the arguments or the assignment give.
    fn requirements(&self) -> Result<Requirements, CliError> {
        let args = &self.args;
        let input = find_one(&args.input, "watch", &self.terminal)?;
        let beside = || {
            let found = input.as_ref().ok().filter(|_| !args.reference.is_given());
            found.and_then(assignment_beside)
        };
        let assignment = match args.assignment.clone().or_else(beside) {
            Some(path) => Some(read_assignment(&path)?.1),
            None => None,
        };
        let inputs = match &assignment {
            Some(assignment) if !args.frame.is_given() => {
                resized(&assignment.frames, args.frame.size).swap_remove(0)
            }
            _ => args.frame.inputs(),
        };
        let of_assignment = assignment.as_ref().map(|assignment| &assignment.uniforms[..]);
        let language = args.language.with_uniforms(&inputs.uniforms);
        Ok(Requirements {
            has_assignment: assignment.is_some(),
            is_moment_given: args.frame.is_moment_given() || assignment.is_some(),
            language: language.with_uniforms(of_assignment.unwrap_or_default()),
            reference: match &assignment {
                Some(assignment) => ReferenceArgs::of(assignment),
                None => args.reference.clone(),
            },
            input,
            inputs,
        })
    }

    /// Reads everything. A reference that cannot be read is an error of its own.
    fn load(&self) -> Result<(Loaded, Option<CliError>), CliError> {
        let Requirements {
            input,
            inputs,
            language,
            reference,
            is_moment_given,
            ..
        } = self.requirements()?;
        let timeout = self.args.timeout;
        let mut frame = inputs.load()?;
        let found = WatchedReference::read(&reference, &input, &language, timeout);
        let (reference, error) = match found {
            Ok(reference) => (reference, None),
            Err(error) => (None, Some(error)),
        };
        if let Some(size) = reference.as_ref().and_then(WatchedReference::size)
            && inputs.size.is_none()
        {
            frame.size = size;
        }
        let shader = Shader::load(&input, &language, Deadline::after(timeout));
        if shader.has_passes && !is_moment_given {
            // As `check` does.
            let number = default_frame(reference.as_ref().and_then(WatchedReference::scene));
            frame = frame.at(number, number as f32 / FRAME_RATE);
        }
        let loaded = Loaded {
            shader,
            input,
            frame,
            language,
            reference,
        };
        Ok((loaded, error))
    }
}

/// What the arguments and the assignment determine.
struct Requirements {
    input: Result<Input, ReadError>,
    inputs: FrameInputs,
    language: LanguageArgs,
    reference: ReferenceArgs,
    is_moment_given: bool,
    has_assignment: bool,
}

impl Studio for ShaderStudio {
    fn build(&self) -> Build {
        let (loaded, mut files) = input::recorded(|| self.load());
        // A project may get other tabs, and a file that is missing may be created.
        let input = &self.args.input;
        let folder = if input.is_dir() {
            Some(input.as_path())
        } else {
            input.parent()
        };
        files.extend(folder.map(|folder| Path::new(".").join(folder)));
        files.push(input.clone());
        let (loaded, error) = match loaded {
            Ok(loaded) => loaded,
            Err(error) => {
                return Build {
                    shader: None,
                    status: json!({"name": diagnostic::path_name(input), "failure": full_text(&error)}),
                    files,
                };
            }
        };
        let mut status = status(&loaded);
        if let Some(error) = error {
            status["referenceFailure"] = full_text(&error).into();
        }
        if let Err(failure) = image(&loaded.shader) {
            let shader = &loaded.shader;
            let diagnostics = failure.diagnostics();
            let diagnostics = shader.lints.warnings.iter().chain(&diagnostics);
            let record = Record::new(FrameResult {
                shader: &shader.name,
                scene: None,
                reference: None,
                dialect: None,
                findings: Err(&failure),
                files: &shader.files,
                diagnostics: diagnostics
                    .map(|one| diagnostic::json(one, &shader.files))
                    .collect(),
                growth: None,
                missing_media: None,
                unused: None,
            });
            status["article"] = article(&record, source(&loaded.input).as_deref());
            return Build {
                shader: None,
                status,
                files,
            };
        }
        let watched = Watched::new(loaded, self.args.timeout, Arc::clone(&self.references));
        Build {
            shader: Some(Box::new(watched)),
            status,
            files,
        }
    }

    fn check(&self, stop: &AtomicBool) -> Option<Value> {
        let has_assignment = self.requirements().is_ok_and(|found| found.has_assignment);
        check(&self.args, has_assignment, stop)
    }
}

/// An error with all its messages, without colors.
fn full_text(error: &CliError) -> String {
    let help = error.help.as_ref().map(|help| format!("; help: {help}"));
    error.in_one_line() + &help.unwrap_or_default()
}

/// The text of an input that has only one.
pub(super) fn source(input: &Result<Input, ReadError>) -> Option<String> {
    let texts = files::read(input.as_ref().ok()?).ok()?;
    match texts.files()[..] {
        [file] => Some(file.text().to_owned()),
        _ => None,
    }
}

/// The article of a record on the page, with its glossary.
pub(super) fn article(record: &Record, source: Option<&str>) -> Value {
    let [article, glossary] = page::article(record, source);
    json!({"html": article, "glossary": glossary, "verdict": record.verdict.to_string()})
}

/// What the page shows of a version besides images.
fn status(loaded: &Loaded) -> Value {
    let Loaded {
        shader,
        frame,
        reference,
        ..
    } = loaded;
    let passes = match shader.project() {
        Some(project) => {
            let passes = project.project.passes.iter().map(|pass| pass.kind);
            passes
                .filter(|kind| *kind != PassKind::Sound)
                .map(pass_name)
                .collect()
        }
        None => vec![pass_name(PassKind::Image)],
    };
    let warnings = shader.lints.warnings.len() as u64;
    let warnings = (warnings > 0).then(|| format!("{warnings} {}", plural(warnings, "warning", "warnings")));
    json!({
        "name": shader.name,
        "dialect": shader.image().ok().map(|checked| DialectRecord::new(checked).title()),
        "passes": passes,
        "hasHistory": shader.has_passes,
        "uniforms": shader.image().map(|checked| uniforms(checked, &loaded.language)).unwrap_or_default(),
        "warnings": warnings,
        "frame": {
            "size": frame.size, "time": frame.time, "frame": frame.frame, "mouse": frame.mouse,
        },
        "reference": reference.as_ref().map(|reference| json!({
            "name": reference.name(), "isAnimated": reference.is_animated(), "size": reference.fixed_size(),
        })),
        "settings": page::settings(1),
    })
}

/// The name of a pass in a view.
fn pass_name(kind: PassKind) -> String {
    Tab::Pass(kind).name().to_owned()
}

/// The uniforms that the page can change: those that no host sets, with at most four components.
fn uniforms(checked: &Checked, language: &LanguageArgs) -> Vec<Value> {
    let declared = checked.declared_uniforms();
    let changeable = declared.filter_map(|(name, ty, value)| {
        let (scalar, count) = match ty {
            Type::Scalar(scalar) => (scalar, 1),
            Type::Vector(scalar, size) => (scalar, usize::from(size)),
            _ => return None,
        };
        let given = language
            .uniform
            .iter()
            .find(|given: &&UniformValue| given.name == name);
        let value = given.map(|given| &given.components[..]).or(value)?;
        let mut components = value.to_vec();
        // One value is that of all components.
        components.resize(count, if let [only] = components[..] { only } else { 0.0 });
        let kind = match scalar {
            Scalar::Float => "float",
            Scalar::Int | Scalar::Uint => "int",
            Scalar::Bool => "bool",
        };
        Some(json!({"name": name, "kind": kind, "components": components}))
    });
    changeable.collect()
}
