//! The reference that `--reference` names: a shader or an image, the same for all shaders of a command.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use sha2::{Digest, Sha256};
use toyproof_classroom::assignment::{Assignment, Reference};
use toyproof_diagnostic::{Deadline, Diagnostic, all_of, grouped, path_name, plural};
use toyproof_glsl::Checked;
use toyproof_image::{self as image, Frame, Image, input};
use toyproof_project::PassKind;
use toyproof_project::files::{self, Input, InputSource};
use toyproof_report as report;
use toyproof_verify::project::bind::bind_reference;
use toyproof_verify::{
    Conditioning, DEFAULT_TOLERANCE, Expected, ImageReference, MAX_UNDEFINED, MarchDependence, Quantization,
    ShaderReference, Share, unbound,
};

use super::inputs::{LanguageArgs, parse_number, shell_word};
use super::project::{pass_shader, rendering};
use super::shader::{Shader, Unusable};
use super::{CliError, Terminal};

/// What shaders are compared with.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct ReferenceArgs {
    /// The scene to compare with: a file, or a name listed by `toyproof scenes`
    #[arg(long, value_name = "SCENE", conflicts_with = "reference")]
    pub(super) scene: Option<PathBuf>,
    /// The shader (.glsl) or image (.png, .exr) to compare with, instead of a scene
    ///
    /// A shader is evaluated in double precision, once for all shaders and with the same inputs as theirs. An
    /// image also sets the size.
    #[arg(long, value_name = "SHADER|IMAGE")]
    pub(super) reference: Option<PathBuf>,
    /// The largest difference of a color from --reference, in 8-bit levels [default: 0.5; for PNG: 1]
    #[arg(long, value_name = "LEVELS", value_parser = parse_tolerance, requires = "reference", allow_negative_numbers = true)]
    tolerance: Option<f64>,
}

/// Parses a tolerance in 8-bit levels.
pub(super) fn parse_tolerance(text: &str) -> Result<f64, String> {
    parse_number(
        text,
        0.0..=255.0,
        "a number of 8-bit levels from 0 to 255, such as 0.5",
    )
}

impl ReferenceArgs {
    /// The reference of an assignment.
    pub(super) fn of(assignment: &Assignment) -> Self {
        let (scene, reference, tolerance) = match &assignment.reference {
            Reference::Scene(scene) => (Some(scene.clone()), None, None),
            Reference::Given { path, tolerance } => (None, Some(path.clone()), *tolerance),
        };
        Self {
            scene,
            reference,
            tolerance,
        }
    }

    /// A shader or an image as reference.
    pub(super) fn given(path: PathBuf) -> Self {
        Self {
            scene: None,
            reference: Some(path),
            tolerance: None,
        }
    }

    /// Whether a flag names the reference.
    pub(super) fn is_given(&self) -> bool {
        self.scene.is_some() || self.reference.is_some()
    }

    /// The flags that name the same reference, for a command that the user may run.
    pub(super) fn flags(&self) -> Vec<String> {
        let named = [("--scene", &self.scene), ("--reference", &self.reference)];
        let named = named
            .into_iter()
            .filter_map(|(flag, path)| Some(format!("{flag} {}", shell_word(&path_name(path.as_ref()?)))));
        let tolerance = self.tolerance.map(|levels| format!("--tolerance {levels}"));
        named.chain(tolerance).collect()
    }

    /// The tolerance of colors in [0, 1], if it is given.
    fn tolerance(&self) -> Option<f64> {
        self.tolerance.map(|levels| levels / 255.0)
    }
}

/// A shader or an image that `--reference` names.
pub(super) struct GivenReference {
    pub(super) name: String,
    content: Content,
    tolerance: f64,
    /// A hash of everything that a comparison with it depends on.
    pub(super) hash: [u8; 32],
}

enum Content {
    /// The shader, and its tree.
    Shader(Box<Shader>, Box<Checked>),
    Image(Image, Quantization),
}

impl GivenReference {
    /// Reads the reference that `--reference` names, if any.
    pub(super) fn read(
        args: &ReferenceArgs,
        language: &LanguageArgs,
        timeout: Duration,
    ) -> Result<Option<Self>, CliError> {
        let Some(path) = &args.reference else {
            return Ok(None);
        };
        let (content, bytes) = read(path, language, timeout)?;
        let default = match content {
            Content::Image(_, Quantization::EightBit) => Quantization::EIGHT_BIT_TOLERANCE,
            Content::Image(_, Quantization::Float) | Content::Shader(..) => DEFAULT_TOLERANCE,
        };
        let tolerance = args.tolerance().unwrap_or(default);
        let mut hash = Sha256::new();
        hash.update(tolerance.to_le_bytes());
        hash.update(bytes);
        Ok(Some(Self {
            name: path_name(path),
            content,
            tolerance,
            hash: hash.finalize().into(),
        }))
    }

    /// The tolerance of colors in [0, 1].
    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The shader, if it is one.
    pub(super) fn shader(&self) -> Option<(&Shader, &Checked)> {
        match &self.content {
            Content::Shader(shader, checked) => Some((shader, checked)),
            Content::Image(..) => None,
        }
    }

    /// The image, if it is one.
    pub(super) fn image(&self) -> Option<&Image> {
        match &self.content {
            Content::Image(image, _) => Some(image),
            Content::Shader(..) => None,
        }
    }

    /// Gives the frame the size of an image.
    ///
    /// # Errors
    /// If `--size` gives another one.
    pub(super) fn resize(&self, frame: &mut Frame, size: Option<[u32; 2]>) -> Result<(), CliError> {
        let Some(image) = self.image() else {
            return Ok(());
        };
        if let Some([w, h]) = size.filter(|&size| size != image.size()) {
            let ([width, height], name) = (image.size(), &self.name);
            let error = CliError::new(format_args!(
                "{name} has {width}×{height} pixels, and the given size is {w}x{h}; only images of equal size can be \
                 compared"
            ));
            return Err(error.with_help("leave the size out"));
        }
        frame.size = image.size();
        Ok(())
    }

    /// Renders the reference in some frames, which have the size of an image, and reports its warnings.
    ///
    /// # Errors
    /// Shaders cannot be compared with it.
    pub(super) fn expected<'f>(
        &self,
        frames: impl Iterator<Item = &'f Frame>,
        timeout: Duration,
        terminal: &Terminal,
    ) -> Result<Vec<Expected>, CliError> {
        let mut evaluation = Evaluation {
            name: &self.name,
            tolerance: self.tolerance,
            timeout,
            reported: Vec::new(),
        };
        let expected = frames.map(|frame| match &self.content {
            Content::Image(image, quantization) => {
                let image = ImageReference::new(image.clone(), *quantization, self.tolerance);
                Ok(Expected::Image(image))
            }
            Content::Shader(shader, checked) => evaluation.run(shader, checked, frame, terminal),
        });
        expected.collect()
    }
}

impl GivenReference {
    /// Describes how much the image depends on how a shader marches along its rays.
    pub(super) fn march_warning(&self, dependence: &MarchDependence) -> Option<String> {
        let (shader, _) = self.shader()?;
        let mut limits: Vec<&str> = dependence
            .limits
            .iter()
            .map(|&at| shader.files.text(at))
            .collect();
        let mut seen = HashSet::new();
        limits.retain(|limit| seen.insert(*limit));
        let help = match limits[..] {
            [] => "give students the length of the steps",
            [_] => "give students this number",
            _ => "give students these numbers",
        };
        let quoted = limits.iter().map(|limit| format!("`{limit}`"));
        let on: Vec<String> = quoted.chain(["the length of the steps".to_owned()]).collect();
        let on = all_of(&on);
        let Share { count, of } = dependence.pixels;
        Some(format!(
            "the march along the rays of {} decides the color of {} of {} {}: they depend on {on}; colors for other \
             numbers are accepted there\nhelp: {help}",
            self.name,
            grouped(count),
            grouped(of),
            plural(of, "pixel", "pixels"),
        ))
    }
}

/// The evaluation of a reference shader in one frame after the other.
struct Evaluation<'a> {
    name: &'a str,
    tolerance: f64,
    timeout: Duration,
    /// The diagnostics that have been reported for earlier frames.
    reported: Vec<Diagnostic>,
}

impl Evaluation<'_> {
    /// Evaluates the shader in a frame, and reports its undefined operations.
    fn run(
        &mut self,
        shader: &Shader,
        checked: &Checked,
        frame: &Frame,
        terminal: &Terminal,
    ) -> Result<Expected, CliError> {
        let name = self.name;
        let spinner = terminal.spinner(name);
        let mut frame = frame.clone();
        let bound = shader.project().map_or(Ok(()), |passes| {
            let rendering = rendering(passes, PassKind::Image, frame.size)?;
            bind_reference(&pass_shader(passes, &rendering), &mut frame, self.timeout)
        });
        bound.map_err(|failure| {
            format!(
                "the passes of the reference {name} cannot be evaluated: {failure}; no shader was checked"
            )
        })?;
        let frame = &frame;
        let evaluated = ShaderReference::new(checked, &shader.lints, frame, self.tolerance, self.timeout);
        spinner.finish_and_clear();
        let (reference, findings) = evaluated.map_err(|failure| {
            let position = report::failure_position(&failure, &shader.files);
            format!("the reference {name} cannot be evaluated: {failure}{position}; no shader was checked")
        })?;
        let notes = [
            shader.lints.warnings.clone(),
            unbound(checked, &shader.lints, frame),
            findings.notes,
        ];
        for mut notes in notes {
            notes.retain(|note| !self.reported.contains(note));
            terminal.diagnostics(&notes, &shader.files);
            self.reported.extend(notes);
        }
        let undefined = findings.undefined;
        let share = format!(
            "the reference {name} has no defined color in {} of {} pixels ({:.1} %)",
            grouped(undefined.count),
            grouped(undefined.of),
            100.0 * undefined.ratio()
        );
        if undefined.ratio() > MAX_UNDEFINED {
            let error = CliError::new(format_args!("{share}; no shader was checked"));
            return Err(error.with_help("correct the reference, or check another frame"));
        }
        if undefined.count > 0 {
            terminal.warn(format_args!("{share}; they are left out of the comparison"));
        }
        let expected = Expected::Shader(Box::new(reference));
        if let Some(conditioning) = expected.conditioning() {
            terminal.warn(ill_conditioned(name, frame.size, &conditioning));
        }
        Ok(expected)
    }
}

/// Describes an ill-conditioned reference.
pub(super) fn ill_conditioned(name: &str, [width, height]: [u32; 2], conditioning: &Conditioning) -> String {
    let help = match &conditioning.edit {
        Some(edit) => format!("{edit}, or choose another --size"),
        None => "choose another --size".to_owned(),
    };
    format!(
        "{name} is ill-conditioned at {width}×{height}: rounding decides the color of about {:.1} % of its pixels, such as \
         where an edge passes exactly through the sample point; no shader fails because of these\nhelp: {help}",
        100.0 * conditioning.ill_conditioned.ratio()
    )
}

/// Reads a shader or an image, by its extension, and the bytes that identify its content.
fn read(path: &Path, language: &LanguageArgs, timeout: Duration) -> Result<(Content, Vec<u8>), CliError> {
    let name = path_name(path);
    let extension = path.extension().and_then(OsStr::to_str).map(str::to_lowercase);
    match extension.as_deref() {
        _ if files::is_folder_of_shaders(path) => {
            return Err(CliError::new(format_args!(
                "{name} is a folder; `--reference` takes a single shader or an image"
            )));
        }
        Some("toml") => {
            let error = CliError::new(format_args!("{name} is a scene"));
            return Err(error.with_help("name it with --scene instead of --reference"));
        }
        Some("jpg" | "jpeg" | "gif" | "bmp" | "webp" | "tga" | "tif" | "tiff" | "hdr") => {
            return Err(CliError::new(format_args!(
                "{name}: images are read from .png and .exr files only"
            )));
        }
        _ => {}
    }
    if let Some(quantization) = Quantization::of_file(path) {
        let image = image::read(path)?;
        let bytes = input::read(path).map_err(|error| format!("{name}: {error}"))?;
        return Ok((Content::Image(image, quantization), bytes));
    }
    let input = Input {
        source: InputSource::File(path.to_owned()),
        relative: path.into(),
        folder: None,
    };
    let shader = Shader::load(&Ok(input), language, Deadline::after(timeout));
    if let Err(Unusable::Invalid(diagnostics)) = &shader.content {
        let error = CliError::diagnostics(diagnostics.clone(), &shader.files);
        return Err(error.with_message(format_args!(
            "the reference {name} is invalid; no shader was checked"
        )));
    }
    let checked = Box::new(shader.require_image()?.clone());
    let bytes = match shader.project().filter(|_| shader.has_passes) {
        Some(project) => project.project.to_json(&shader.files).into_bytes(),
        None => shader.text(&checked).as_bytes().to_vec(),
    };
    Ok((Content::Shader(Box::new(shader), checked), bytes))
}
