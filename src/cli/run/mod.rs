//! `toyproof run`

mod project;

pub(in crate::cli) use project::parse_pass;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use serde::Serialize;
use toyproof_diagnostic::{Deadline, path_name};
use toyproof_eval::{self as eval, Number, Program, Settings, UndefinedPolicy};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{DrawOutput, Failure, Worker};
use toyproof_image::{self as image, Frame, Image};
use toyproof_player::Clock;
use toyproof_project::PassKind;
use toyproof_verify::unbound;

use crate::cli::inputs::{DriverArgs, Format, FrameArgs, LanguageArgs, may_write, short_device};
use crate::cli::names::{Names, with_suffix};
use crate::cli::sequence::{self, Frames, Sequence};
use crate::cli::shader::{Shader, Unusable, find};
use crate::cli::terminal::file_size;
use crate::cli::{Exit, Terminal, files};
use crate::report;

/// Run shaders and save their images
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof run mine.glsl -o mine.png --time 1.5
  toyproof run mine.glsl -o mine.exr --precision f64
  toyproof run mine.glsl -o frames/mine.png --frames 0..479
  toyproof run shaders -o images")]
pub(in crate::cli) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// The image (.png or .exr), a folder, or - for PNG on standard output [default: NAME.png in the current
    /// folder]
    #[arg(short, long, value_name = "IMAGE|DIR")]
    output: Option<PathBuf>,
    /// The number type of floats; f64 runs on the CPU
    #[arg(long, value_enum, default_value_t = Precision::F32, hide_possible_values = true, value_name = "f32|f64")]
    precision: Precision,
    /// The format of the results; `json` needs an output other than standard output
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output", hide_possible_values = true)]
    format: Format,
    /// Render frames A to B, at 60 frames per second, into numbered files
    ///
    /// The number is inserted before the extension. The same command resumes an interrupted sequence.
    #[arg(long, value_name = "A..B", value_parser = sequence::parse_frames, conflicts_with_all = ["frame", "time"])]
    frames: Option<Frames>,
    /// The frames in a second: they determine the times of frames, `iTimeDelta` and `iFrameRate`
    #[arg(long, value_name = "N", default_value_t = 60.0, value_parser = parse_rate, hide_short_help = true)]
    fps: f64,
    /// The pass of a project to show: `image`, or `buffer-a` to `buffer-d` [default: image]
    #[arg(long, value_name = "PASS", value_parser = parse_pass, hide_short_help = true)]
    pass: Option<PassKind>,
    /// The number of frames of a project to render before the first one that is shown, instead of all
    ///
    /// For shaders whose buffers forget what was long ago. Buffers are zero at first, and what a shader does in
    /// frame 0 alone does not happen.
    #[arg(long, value_name = "N", conflicts_with = "state", hide_short_help = true)]
    warm_up: Option<u32>,
    /// The buffers of a project: read from this file, if it exists, and written to it after the last frame
    ///
    /// A later run goes on with the next frame instead of the first.
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    state: Option<PathBuf>,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

/// The number type of floats.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Precision {
    F32,
    F64,
}

impl Precision {
    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

pub(in crate::cli) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let inputs_of_frame = args.frame.inputs();
    let load = || inputs_of_frame.load().map_err(|error| error.to_string());
    let (worker, frame) = match args.driver.worker().and_then(|worker| Ok((worker, load()?))) {
        Ok(found) => found,
        Err(error) => {
            terminal.error(error);
            return Exit::Error;
        }
    };
    let inputs = find(&args.shaders, terminal);
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| files::is_folder_of_shaders(path));
    let output = match (&args.output, &inputs[..]) {
        (Some(output), _) => output.clone(),
        (None, [Ok(input)]) if !several => default_image(&input.relative),
        (None, _) => PathBuf::from("."),
    };
    let standard = output == Path::new("-");
    if several && (standard || output.extension().is_some()) {
        let output = path_name(&output);
        terminal.error(format_args!("several images cannot be written to {output}"));
        terminal.help("name a folder with -o");
        return Exit::Error;
    }
    if standard && (args.frames.is_some() || args.format == Format::Json) {
        terminal.error("standard output takes a single image, not a sequence or JSON");
        terminal.help("name a file with -o");
        return Exit::Error;
    }
    let one = standard || (!several && !output.is_dir());
    let mut names = Names::new(&[".png"], &[]);
    let mut exit = Exit::Success;
    let channels = inputs_of_frame.files().collect();
    if !may_write(&output, &channels, terminal) || (one && !has_image_extension(&output, terminal)) {
        return Exit::Error;
    }
    let mut runner = Runner {
        args,
        terminal,
        output: &output,
        worker: worker.filter(|_| args.precision == Precision::F32),
        frame,
        images: Vec::new(),
    };
    for input in &inputs {
        let shader = Shader::load(input, &args.language, Deadline::after(args.driver.timeout()));
        let path = match (one, input) {
            (true, _) | (false, Err(_)) => output.clone(),
            (false, Ok(found)) => with_suffix(&output.join(names.assign(found)), ".png"),
        };
        terminal.diagnostics(&shader.lints.warnings, &shader.files);
        if let Some(passes) = &shader.passes
            && !matches!(shader.checked, Err(Unusable::Invalid(_)))
        {
            exit = exit.max(runner.project(&shader, passes, &path));
            continue;
        }
        if let Ok(checked) = &shader.checked {
            terminal.diagnostics(&unbound(checked, &shader.lints, &runner.frame), &shader.files);
        }
        exit = exit.max(match args.frames {
            None => {
                let spinner = terminal.spinner(&shader.name);
                let rendered = runner.render(&shader);
                spinner.finish_and_clear();
                rendered.map_or_else(
                    |exit| exit,
                    |rendered| runner.write(&rendered, &shader.name, &path, true),
                )
            }
            Some(frames) => runner.sequence(&shader, frames, &path),
        });
    }
    if args.format == Format::Json {
        // Strings and numbers always serialize.
        let json = serde_json::to_string_pretty(&runner.images).unwrap_or_default() + "\n";
        terminal.bytes(json.as_bytes());
    }
    exit
}

/// Parses a number of frames in a second.
fn parse_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (0.001..=1e6).contains(rate));
    rate.ok_or_else(|| "expected a number from 0.001 to 1000000".to_owned())
}

/// The default name of an image, in the current folder.
pub(in crate::cli) fn default_image(input: &Path) -> PathBuf {
    Path::new(input.file_name().unwrap_or_default()).with_extension("png")
}

/// Returns whether images can be written to a file of this name; prints an error if not.
pub(in crate::cli) fn has_image_extension(path: &Path, terminal: &Terminal) -> bool {
    if path == Path::new("-") {
        return true;
    }
    match image::check_extension(path) {
        Ok(()) => true,
        Err(error) => {
            terminal.error(error);
            if path
                .extension()
                .is_some_and(|extension| ["gif", "mp4", "webm"].iter().any(|video| extension == *video))
            {
                terminal.help("write a sequence with --frames A..B -o NAME.png, and encode it with ffmpeg");
            }
            false
        }
    }
}

/// Encodes an image for a file, by its extension, or as PNG for standard output; prints an error on failure.
pub(in crate::cli) fn encode(image: &Image, path: &Path, terminal: &Terminal) -> Option<Vec<u8>> {
    let format = if path == Path::new("-") {
        Path::new("-.png")
    } else {
        path
    };
    image::encode(image, format)
        .map_err(|error| terminal.error(error))
        .ok()
}

/// An image that was written, as JSON has it.
#[derive(Debug, Serialize)]
struct WrittenImage {
    shader: String,
    output: String,
    size: [u32; 2],
    /// `iFrame`
    frame: i32,
    /// `iTime`, in seconds.
    time: f32,
    precision: &'static str,
    device: String,
    seconds: f64,
}

/// An image, and what rendered it.
struct Rendered {
    image: Image,
    device: String,
    seconds: f64,
}

struct Runner<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    /// The file, or the folder.
    output: &'a Path,
    /// None where the evaluator renders.
    worker: Option<Worker>,
    frame: Frame,
    /// The written images.
    images: Vec<WrittenImage>,
}

impl Runner<'_> {
    /// Renders the frames of a shader, each into its file; stops at the first failure.
    fn sequence(&mut self, shader: &Shader, frames: Frames, output: &Path) -> Exit {
        let mut hasher = DefaultHasher::new();
        if let Ok(checked) = &shader.checked {
            self.args.driver.float().lower(checked).text().hash(&mut hasher);
        }
        let fingerprint = self.fingerprint(hasher);
        let sequence = Sequence::resume(frames, output, &fingerprint, self.terminal);
        let mut exit = Exit::Success;
        let whole = sequence.render(self.terminal, |one| {
            self.frame = Clock {
                inputs: self.frame.clone(),
                rate: self.args.fps,
                start: 0.0,
            }
            .frame(one.frame);
            exit = match self.render(shader) {
                Ok(rendered) => self.write(&rendered, &shader.name, &one.path, false),
                Err(exit) => exit,
            };
            exit == Exit::Success
        });
        // Otherwise the record could not be written, which has been reported.
        if whole || exit != Exit::Success {
            exit
        } else {
            Exit::Error
        }
    }

    /// A digest of everything that the frames of a sequence depend on, beginning with that of the shader: a
    /// record with a different one is ignored.
    fn fingerprint(&self, mut hasher: DefaultHasher) -> String {
        let any = Frame {
            frame: 0,
            time: 0.0,
            ..self.frame.clone()
        };
        postcard::to_stdvec(&any).unwrap_or_default().hash(&mut hasher);
        format!(
            "{:?} {:?} {:?}",
            self.args.precision, self.args.driver, self.frame.script
        )
        .hash(&mut hasher);
        format!("{:016x}", hasher.finish())
    }

    /// Renders the shader; prints the error on failure.
    fn render(&mut self, shader: &Shader) -> Result<Rendered, Exit> {
        let checked = match &shader.checked {
            Ok(checked) => checked,
            Err(Unusable::Invalid(diagnostics)) => {
                self.terminal.diagnostics(diagnostics, &shader.files);
                return Err(Exit::ShaderFault);
            }
            Err(Unusable::Unreadable(error) | Unusable::Unrendered(error)) => {
                self.terminal.error(error);
                return Err(Exit::Error);
            }
        };
        if let Some(worker) = &mut self.worker {
            let float = self.args.driver.float();
            let deadline = Deadline::after(self.args.driver.timeout());
            let lowered = match float.lower_within(checked, &deadline) {
                Ok(lowered) => lowered,
                Err(overdue) => {
                    let overdue = [glsl::overdue(overdue)];
                    self.terminal.diagnostics(&overdue, &shader.files);
                    return Err(Exit::ShaderFault);
                }
            };
            match worker.draw(lowered, self.frame.clone(), float) {
                Err(failure) if failure.is_without_driver() && self.args.driver.may_fall_back() => {
                    self.terminal
                        .warn(format_args!("{failure}; shaders are evaluated on the CPU"));
                    self.worker = None;
                }
                result => return self.draw_result(result, shader),
            }
        }
        match self.args.precision {
            Precision::F32 => self.evaluate::<f32>(checked, shader),
            Precision::F64 => self.evaluate::<f64>(checked, shader),
        }
    }

    fn draw_result(&self, drawn: Result<DrawOutput, Failure>, shader: &Shader) -> Result<Rendered, Exit> {
        match drawn {
            Ok(DrawOutput {
                loop_truncated: Some(pixels @ 1..),
                ..
            }) => {
                self.terminal.error(format_args!(
                    "{}: {}",
                    shader.name,
                    report::loop_truncated(pixels)
                ));
                Err(Exit::ShaderFault)
            }
            Ok(drawn) => Ok(Rendered {
                seconds: drawn.draw.as_secs_f64(),
                device: drawn.device.clone(),
                image: drawn.image(),
            }),
            Err(failure) => Err(self.draw_failed(failure, shader)),
        }
    }

    /// Prints why the driver rendered nothing.
    fn draw_failed(&self, failure: Failure, shader: &Shader) -> Exit {
        match failure {
            Failure::Invalid(diagnostics) => {
                self.terminal.diagnostics(&diagnostics, &shader.files);
                Exit::ShaderFault
            }
            Failure::Refused(diagnostics) => {
                self.terminal.diagnostics(&diagnostics, &shader.files);
                Exit::Error
            }
            failure => {
                self.terminal.error(format_args!("{}: {failure}", shader.name));
                let shaders_fault = failure.is_invalid() || matches!(failure, Failure::Timeout { .. });
                if shaders_fault {
                    Exit::ShaderFault
                } else {
                    Exit::Error
                }
            }
        }
    }

    fn evaluate<N: Number>(&self, checked: &Checked, shader: &Shader) -> Result<Rendered, Exit> {
        let start = Instant::now();
        let settings = Settings::<N> {
            undefined: UndefinedPolicy::Plain,
            deadline: Some(start + self.args.driver.timeout()),
            ..Settings::default()
        };
        let rendered = Program::within(checked, self.args.driver.timeout())
            .map_err(eval::Failure::from)
            .and_then(|program| program.render_rows(&self.frame, self.frame.rows(), &settings));
        match rendered {
            Ok(rendered) => Ok(Rendered {
                image: rendered.image,
                device: "CPU".to_owned(),
                seconds: start.elapsed().as_secs_f64(),
            }),
            Err(failure) => Err(not_evaluated(&failure, shader, self.terminal)),
        }
    }

    /// Writes an image, and confirms it unless it is one of a sequence.
    fn write(&mut self, rendered: &Rendered, shader: &str, path: &Path, confirms: bool) -> Exit {
        let Some(bytes) = encode(&rendered.image, path, self.terminal) else {
            return Exit::Error;
        };
        if !self.terminal.write_output(self.output, path, &bytes) {
            return Exit::Error;
        }
        let [width, height] = rendered.image.size();
        let precision = self.args.precision.name();
        let Rendered { device, seconds, .. } = rendered;
        if confirms {
            let size = file_size(bytes.len());
            let device = short_device(device);
            let facts = format!("{width}×{height}, {precision} on {device}, {size}, {seconds:.2} s");
            self.terminal.confirm(path, &facts);
        }
        self.images.push(WrittenImage {
            shader: shader.to_owned(),
            output: path_name(path),
            size: [width, height],
            frame: self.frame.frame,
            time: self.frame.time,
            precision,
            device: device.clone(),
            seconds: *seconds,
        });
        Exit::Success
    }
}

/// Prints why the evaluator failed.
pub(in crate::cli) fn not_evaluated(failure: &eval::Failure, shader: &Shader, terminal: &Terminal) -> Exit {
    if let eval::Failure::Refused(eval::Refusal::TooSlow(overdue)) = failure {
        terminal.diagnostics(&[glsl::overdue(*overdue)], &shader.files);
        return Exit::ShaderFault;
    }
    let position = report::failure_position(failure, &shader.files);
    terminal.error(format_args!("{}: {failure}{position}", shader.name));
    let ours = matches!(failure, eval::Failure::Refused(_));
    if ours { Exit::Error } else { Exit::ShaderFault }
}
