//! `toyproof run`

mod banded;
mod error_map;
mod failure;
mod profile;
mod project;
mod sound;
mod state;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use clap::ValueEnum;
use indicatif::ProgressBar;
pub(in crate::cli) use project::{bound, parse_pass};
use serde::Serialize;
use toyproof_diagnostic::{Code, Deadline, grouped, path_name, plural};
use toyproof_eval::{self as eval, Number, Settings, Supersampling, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_film::FilmSettings;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{DrawOutput, Failure, Worker};
use toyproof_image::{self as image, Frame, Image, ImageError, check_size};
use toyproof_player::{Clock, Target};
use toyproof_project::PassKind;
use toyproof_project::files;
use toyproof_report as report;
use toyproof_translate::FloatMode;
use toyproof_verify::unbound;

use self::error_map::{ErrorMapArgs, WrittenErrors};
use self::failure::{ImageFailure, draw_error, image_failure, is_too_large, shader_error};
pub(in crate::cli) use self::failure::{evaluation_error, pass_error};
use self::profile::{Pass, ProfileArgs, WrittenProfile};
use crate::cli::inputs::{
    DriverArgs, Format, FrameArgs, LanguageArgs, check_output, shell_word, short_device,
};
use crate::cli::names::{Names, with_suffix};
use crate::cli::sequence::{
    Destination, FilmFile, FrameEnd, FrameStream, NumberedFiles, Output, Sequence, SequenceArgs,
};
use crate::cli::shader::{Shader, find};
use crate::cli::terminal::file_size;
use crate::cli::{CliError, Exit, Terminal};

/// Run shaders and save their images
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof run mine.glsl -o mine.png --time 1.5
  toyproof run mine.glsl -o mine.exr --precision f64
  toyproof run mine.glsl -o mine.mp4 --duration 8 --size 1280x720
  toyproof run mine.glsl -o mine.gif --duration 2 --fps 25 --loop forever
  toyproof run mine.glsl -o frames/mine.png --frames 0..479
  toyproof run mine.glsl --profile=profile.html
  toyproof run shaders -o images")]
pub(in crate::cli) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// The image (.png or .exr), the film (.gif, .apng, .mp4, .webm, .y4m), a folder, or - for PNG on
    /// standard output [default: NAME.png in the current folder]
    ///
    /// A name without an extension is that of a folder. Films need --duration or --frames; ffmpeg writes .mp4
    /// and .webm.
    #[arg(short, long, value_name = "IMAGE|FILM|DIR")]
    output: Option<PathBuf>,
    /// The number type of floats; f64 runs on the CPU
    #[arg(long, value_enum, default_value_t = Precision::F32, hide_possible_values = true, value_name = "f32|f64")]
    precision: Precision,
    /// The format of the results; `json` needs an output other than standard output
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output", hide_possible_values = true)]
    format: Format,
    /// Samples per pixel, of which the image has the mean
    ///
    /// Supersampling with a box filter, on the CPU: the positions in a pixel are those of the
    /// (0, 2)-sequence of Sobol'. Each color is clamped to [0, 1] before the mean, except in .exr. Buffers are
    /// not supersampled.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096), hide_default_value = true)]
    samples: u32,
    /// Render a PNG in bands of rows that are written one after the other
    ///
    /// Images above the limits of drivers (16,384 pixels per side, 33 million in total) are rendered so
    /// anyway. The memory is that of a band. Runs on the CPU.
    #[arg(long, hide_short_help = true, conflicts_with_all = ["frames", "duration"])]
    tile: bool,
    /// Keep the alpha that the shader writes: in .png, .exr, .apng, .webm and rgba; ShaderToy sets it to 1
    #[arg(long, hide_short_help = true)]
    transparent: bool,
    /// The pass of a project to show: `image`, or `buffer-a`, `buffer-b` and so on [default: image]
    #[arg(long, value_name = "PASS", value_parser = parse_pass, hide_short_help = true)]
    pass: Option<PassKind>,
    /// The number of frames of a project to render before the first one that is shown, instead of all
    ///
    /// For shaders whose buffers forget what was long ago. Buffers are zero at first, and what a shader does
    /// in frame 0 alone does not happen.
    #[arg(long, value_name = "N", conflicts_with = "state", hide_short_help = true)]
    warm_up: Option<u32>,
    /// The buffers of a project: read from this file, if it exists, and written to it after the last frame
    ///
    /// A later run goes on with the next frame instead of the first.
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    state: Option<PathBuf>,
    #[command(flatten)]
    error_map: ErrorMapArgs,
    #[command(flatten)]
    profile: ProfileArgs,
    #[command(flatten)]
    sequence: SequenceArgs,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

/// The rows of an image, for each thread, between two steps of its progress bar: a multiple of a tile's
/// height.
const ROWS_PER_THREAD: u32 = 64;

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

pub(in crate::cli) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let inputs_of_frame = args.frame.inputs();
    let worker = args.driver.patient_worker()?;
    let frame = inputs_of_frame.load()?;
    let inputs = find(&args.shaders, terminal);
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| files::is_folder_of_shaders(path));
    let output = match (&args.output, &inputs[..]) {
        (Some(output), _) => output.clone(),
        (None, [Ok(input)]) if !several => default_output(&input.relative, &args.sequence),
        (None, _) => PathBuf::from("."),
    };
    let standard = output == Path::new("-");
    let is_folder = !standard && names_folder(&output);
    if several && !is_folder {
        let output = path_name(&output);
        let error = CliError::new(format_args!("several images cannot be written to {output}"));
        return Err(error.with_help("name a folder with -o"));
    }
    if standard && args.format == Format::Json {
        let error = CliError::new("standard output takes an image or frames, not JSON beside them");
        return Err(error.with_help("name a file with -o"));
    }
    let one = !several && !is_folder;
    let mut names = Names::new(&[".png"], &[]);
    let mut exit = Exit::Success;
    let channels = inputs_of_frame.files().collect();
    check_output(&output, &channels)?;
    if one {
        args.sequence.output(&output)?;
    }
    let supersampling = supersampling(args, &output)?;
    let has_error_map = args.error_map.error_map.is_some();
    if has_error_map {
        error_map::check(args, one)?;
    }
    let has_profile = args.profile.profile.is_some();
    if has_profile {
        profile::check(args, one, &output)?;
    }
    let is_evaluated = args.precision != Precision::F32 || args.samples > 1 || has_error_map || has_profile;
    let mut runner = Runner {
        args,
        terminal,
        output: &output,
        worker: worker.filter(|_| !is_evaluated),
        prefers_evaluator: args.driver.is_evaluator_equal(),
        supersampling,
        frame: &frame,
        images: Vec::new(),
    };
    for input in &inputs {
        if terminal.interrupt_flag().load(Ordering::Relaxed) {
            exit = Exit::Error;
            break;
        }
        let mut shader = Shader::load(input, &args.language, Deadline::after(args.driver.timeout()));
        if args.transparent {
            shader.keep_alpha();
        }
        runner.report_warnings(&shader);
        let path = match (one, input) {
            (true, _) | (false, Err(_)) => output.clone(),
            (false, Ok(found)) => {
                let extension = format!(".{}", args.sequence.extension());
                with_suffix(&output.join(names.assign(found)), &extension)
            }
        };
        if let Some(passes) = shader.project() {
            let ended = runner.project(&shader, passes, &path);
            exit = exit.max(ended.unwrap_or_else(|error| terminal.fail(&error)));
            continue;
        }
        if let Ok(checked) = shader.image() {
            terminal.diagnostics(&unbound(checked, &shader.lints, runner.frame), &shader.files);
        }
        let output = shader.require_image().and_then(|_| args.sequence.output(&path));
        let rendered = output.and_then(|output| match output {
            Output::Image => runner.one_image(&shader, runner.frame, &path),
            output => runner.frames(&shader, output, &path),
        });
        if let Err(error) = rendered {
            exit = exit.max(terminal.fail(&error));
        }
    }
    if args.format == Format::Json {
        // Strings and numbers always serialize.
        let json = serde_json::to_string_pretty(&runner.images).unwrap_or_default() + "\n";
        terminal.bytes(json.as_bytes())?;
    }
    Ok(exit)
}

/// The samples of each pixel, if there are several.
fn supersampling(args: &Args, output: &Path) -> Result<Option<Supersampling>, CliError> {
    if args.samples == 1 {
        return Ok(None);
    }
    check_evaluated(args, "--samples")?;
    if args.pass.is_some_and(|pass| pass != PassKind::Image) {
        return Err(CliError::new("buffers are not supersampled").with_help("leave out --samples or --pass"));
    }
    let is_exr = output
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("exr"));
    Ok(Some(Supersampling::new(args.samples, !is_exr)))
}

/// Checks that the flags allow the evaluator to render, which something needs.
fn check_evaluated(args: &Args, what: &str) -> Result<(), CliError> {
    if args.driver.may_be_evaluated() && args.driver.float() == FloatMode::Strict {
        return Ok(());
    }
    let error = CliError::new(format_args!(
        "{what} needs the evaluator on the CPU, with strict arithmetic"
    ));
    Err(error.with_help("leave out --device and --float: strict images have the same bits on every device"))
}

/// Returns whether a path names a folder, which may not exist yet.
fn names_folder(path: &Path) -> bool {
    let text = path.as_os_str().to_string_lossy();
    path.is_dir() || text.ends_with(std::path::is_separator) || path.extension().is_none()
}

/// The default name of an image or a film, in the current folder.
pub(in crate::cli) fn default_output(input: &Path, sequence: &SequenceArgs) -> PathBuf {
    Path::new(input.file_name().unwrap_or_default()).with_extension(sequence.extension())
}

/// Encodes an image for a file, by its extension, or as PNG for standard output; in PNG perhaps with alpha.
pub(in crate::cli) fn encode(image: &Image, path: &Path, keeps_alpha: bool) -> Result<Vec<u8>, ImageError> {
    let format = if path == Path::new("-") {
        Path::new("-.png")
    } else {
        path
    };
    if keeps_alpha {
        image::encode_transparent(image, format)
    } else {
        image::encode(image, format)
    }
}

/// An image or a film that was written, as JSON has it.
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
    /// The number of frames of a film, of which `frame` and `time` are those of the first one that was
    /// rendered.
    #[serde(skip_serializing_if = "Option::is_none")]
    frames: Option<u64>,
    /// How far float32 is from double precision, if that is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    errors: Option<WrittenErrors>,
    /// The profile, if it is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    profile: Option<WrittenProfile>,
}

/// An image, and what rendered it.
struct RenderedImage {
    image: Image,
    device: String,
    seconds: f64,
}

/// What rendered an image, and how long.
struct RenderedBy<'a> {
    device: &'a str,
    seconds: f64,
}

struct Runner<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    /// The file, or the folder.
    output: &'a Path,
    /// `None` if there is no driver, or the evaluator is to render.
    worker: Option<Worker>,
    /// Whether the evaluator renders shaders for which it is not slower than the driver.
    prefers_evaluator: bool,
    /// The samples of each pixel, if there are several.
    supersampling: Option<Supersampling>,
    /// The inputs of the frame that the user gives.
    frame: &'a Frame,
    /// The written images.
    images: Vec<WrittenImage>,
}

impl Runner<'_> {
    /// Reports how many warnings there are: those about the image in full, the others by their number.
    fn report_warnings(&self, shader: &Shader) {
        let warnings = shader.lints.warnings.iter().cloned();
        let (shown, counted): (Vec<_>, Vec<_>) =
            warnings.partition(|warning| self.terminal.is_verbose() || warning.code == Code::UnsetUniform);
        if !self.terminal.is_quiet() {
            self.terminal.diagnostics(&shown, &shader.files);
        }
        if let count @ 1.. = counted.len() as u64 {
            let warnings = plural(count, "warning", "warnings");
            let name = shell_word(&shader.name);
            self.terminal.note(&format!(
                "{}: {} {warnings}, which `toyproof check {name}` shows",
                shader.name,
                grouped(count)
            ));
        }
    }

    /// Whether the image is never in memory as a whole.
    fn is_banded(&self) -> bool {
        self.args.tile || image::is_banded_size(self.frame.size)
    }

    /// Renders an image into its file.
    fn one_image(&mut self, shader: &Shader, frame: &Frame, path: &Path) -> Result<(), CliError> {
        if self.is_banded() {
            return self.banded_image(shader, frame, path);
        }
        match self.render(shader, frame, None) {
            Ok(rendered) => {
                self.write_confirmed(&rendered, frame, &shader.name, path)?;
                let checked = shader.require_image()?;
                self.write_error_map(shader, checked, frame)?;
                let pass = Pass {
                    target: Target::Image,
                    checked,
                    frame: frame.clone(),
                    inputs: [None; 4],
                };
                self.write_profile(shader, &[pass])
            }
            Err(ImageFailure::Failed(error)) => Err(error),
            Err(ImageFailure::Interrupted) => Err(CliError::silent()),
        }
    }

    /// Renders the frames of a shader; stops at the first failure.
    fn frames(&mut self, shader: &Shader, output: Output, path: &Path) -> Result<(), CliError> {
        let mut hasher = DefaultHasher::new();
        if let Ok(checked) = shader.image() {
            self.args.driver.float().lower(checked).text().hash(&mut hasher);
        }
        let fingerprint = self.fingerprint(hasher);
        let Some(sequence) = self.open_sequence((output, self.frame.size), path, &fingerprint, None)? else {
            return Ok(());
        };
        let clock = self.clock(0);
        let mut film = self.written_film(output, &clock, &shader.name, path);
        sequence.render(self.terminal, |number, destination, interrupted| {
            let frame = clock.frame(number);
            match self.render(shader, &frame, Some(interrupted)) {
                Ok(rendered) => self.put(&rendered, &frame, &shader.name, destination, film.as_mut())?,
                Err(ImageFailure::Failed(error)) => return Err(error),
                Err(ImageFailure::Interrupted) => return Ok(FrameEnd::Interrupted),
            }
            Ok(FrameEnd::Written)
        })?;
        self.images.extend(film);
        Ok(())
    }

    /// A film that is going to be written, as JSON has it, if the output is one.
    fn written_film(&self, output: Output, clock: &Clock, shader: &str, path: &Path) -> Option<WrittenImage> {
        let (Output::Film(frames, _) | Output::Stream(frames, _)) = output else {
            return None;
        };
        let first = clock.frame(frames.first());
        Some(WrittenImage {
            shader: shader.to_owned(),
            output: path_name(path),
            size: first.size,
            frame: first.frame,
            time: first.time,
            precision: self.args.precision.name(),
            device: String::new(),
            seconds: 0.0,
            frames: Some(frames.count()),
            errors: None,
            profile: None,
        })
    }

    /// Takes a rendered frame to where it belongs: its file, or a film.
    fn put(
        &mut self,
        rendered: &RenderedImage,
        frame: &Frame,
        shader: &str,
        destination: Destination,
        film: Option<&mut WrittenImage>,
    ) -> Result<(), CliError> {
        if let Some(film) = film {
            film.device.clone_from(&rendered.device);
            film.seconds += rendered.seconds;
        }
        match destination {
            Destination::File(path) => self.write(rendered, frame, shader, path).map(drop),
            Destination::Film(film) => film.add(&rendered.image),
        }
    }

    /// The inputs of all frames; the one with this number has the time that the user gives.
    fn clock(&self, number: i32) -> Clock {
        Clock {
            inputs: self.frame.clone(),
            rate: self.args.sequence.fps,
            start: self.args.frame.start(number, self.args.sequence.fps),
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
            "{:?} {:?} {:?} {:?} {} {} {}",
            self.args.precision,
            self.args.driver,
            self.frame.script,
            self.supersampling,
            self.args.transparent,
            self.args.sequence.fps,
            self.args.frame.start(0, self.args.sequence.fps)
        )
        .hash(&mut hasher);
        format!("{:016x}", hasher.finish())
    }

    /// Renders a frame of the shader. The evaluator shows its progress, and ends early if the user interrupts
    /// it, unless the image is one of a sequence, whose flag is given.
    fn render(
        &mut self,
        shader: &Shader,
        frame: &Frame,
        interrupted: Option<&AtomicBool>,
    ) -> Result<RenderedImage, ImageFailure> {
        let checked = shader.require_image()?;
        if self.prefers_evaluator {
            match self.evaluate(checked, frame, interrupted) {
                Err(failure) if self.worker.is_some() && is_too_large(&failure) => {
                    self.terminal.detail(&format!(
                        "{}: {failure}; the Vulkan driver renders it",
                        shader.name
                    ));
                }
                result => return result.map_err(|failure| image_failure(&failure, shader)),
            }
        }
        if let Some(worker) = &mut self.worker {
            let float = self.args.driver.float();
            let deadline = Deadline::after(self.args.driver.explicit_timeout());
            // A driver shows no progress.
            let spinner = match interrupted {
                None => self.terminal.spinner(&shader.name),
                Some(_) => ProgressBar::hidden(),
            };
            let lowered = float
                .lower_within(checked, &deadline)
                .map_err(|overdue| shader_error(vec![glsl::overdue(overdue)], shader))?;
            let drawn = worker.draw(lowered, frame.clone(), float);
            spinner.finish_and_clear();
            match drawn {
                Err(failure) if failure.is_without_driver() && self.args.driver.may_fall_back() => {
                    self.report_no_driver(&failure);
                    self.worker = None;
                }
                result => return Ok(draw_result(result, shader)?),
            }
        }
        let evaluated = self.evaluate(checked, frame, interrupted);
        evaluated.map_err(|failure| image_failure(&failure, shader))
    }

    /// Reports that the evaluator takes the place of a driver. Strict runs have the same bits on both.
    fn report_no_driver(&self, failure: &Failure) {
        if self.args.driver.float() == FloatMode::Strict {
            self.terminal
                .detail(&format!("{failure}; shaders are evaluated on the CPU"));
        } else {
            self.terminal.warn(
                "no Vulkan driver: shaders are evaluated on the CPU, strictly (`toyproof doctor` has details)",
            );
        }
    }

    fn evaluate(
        &self,
        checked: &Checked,
        frame: &Frame,
        interrupted: Option<&AtomicBool>,
    ) -> Result<RenderedImage, eval::Failure> {
        match self.args.precision {
            Precision::F32 => self.evaluate_in::<f32>(checked, frame, interrupted),
            Precision::F64 => self.evaluate_in::<f64>(checked, frame, interrupted),
        }
    }

    fn evaluate_in<N: Number>(
        &self,
        checked: &Checked,
        frame: &Frame,
        interrupted: Option<&AtomicBool>,
    ) -> Result<RenderedImage, eval::Failure> {
        let start = Instant::now();
        let limit = self.args.driver.explicit_timeout();
        let settings = Settings::<N> {
            undefined: UndefinedPolicy::Plain,
            deadline: Some(start + limit),
            interrupt: Some(interrupted.unwrap_or(self.terminal.interrupt_flag())),
            ..Settings::default()
        };
        let height = frame.size[1];
        let bar = match interrupted {
            None => self.terminal.bar(u64::from(height), "rows"),
            // The sequence has its own progress bar.
            Some(_) => ProgressBar::hidden(),
        };
        let rows_per_band = if bar.is_hidden() {
            height
        } else {
            ROWS_PER_THREAD * rayon::current_num_threads() as u32
        };
        let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(limit))?;
        let bands = (0..height).step_by(rows_per_band as usize);
        let bands = bands.map(|first| -> Result<Image, eval::Failure> {
            let rows = first..first.saturating_add(rows_per_band).min(height);
            let count = rows.len() as u64;
            let image = match &self.supersampling {
                None => program.render_rows(frame, rows, &settings)?.image,
                Some(samples) => program.render_supersampled(frame, rows, samples, &settings)?,
            };
            bar.inc(count);
            Ok(image)
        });
        let bands = bands.collect::<Result<Vec<_>, _>>();
        bar.finish_and_clear();
        Ok(RenderedImage {
            image: Image::of_bands(bands?),
            device: "CPU".to_owned(),
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// Writes a single image, and confirms it.
    fn write_confirmed(
        &mut self,
        rendered: &RenderedImage,
        frame: &Frame,
        shader: &str,
        path: &Path,
    ) -> Result<(), CliError> {
        let size = file_size(self.write(rendered, frame, shader, path)?);
        let [width, height] = rendered.image.size();
        let precision = self.args.precision.name();
        let (device, seconds) = (short_device(&rendered.device), rendered.seconds);
        let samples = self.samples();
        let facts = format!("{width}×{height}, {samples}{precision} on {device}, {size}, {seconds:.2} s");
        self.terminal.confirm(path, &facts);
        Ok(())
    }

    /// The number of samples of a pixel, if there are several.
    fn samples(&self) -> String {
        match self.args.samples {
            1 => String::new(),
            samples => format!("{} samples per pixel, ", grouped(u64::from(samples))),
        }
    }

    /// Writes an image; returns the size of the file in bytes.
    fn write(
        &mut self,
        rendered: &RenderedImage,
        frame: &Frame,
        shader: &str,
        path: &Path,
    ) -> Result<usize, CliError> {
        let bytes = encode(&rendered.image, path, self.args.transparent)?;
        self.terminal.write_output(self.output, path, &bytes)?;
        let by = RenderedBy {
            device: &rendered.device,
            seconds: rendered.seconds,
        };
        self.record(&by, frame, shader, path);
        Ok(bytes.len())
    }

    /// Records a written image.
    fn record(&mut self, by: &RenderedBy<'_>, frame: &Frame, shader: &str, path: &Path) {
        self.images.push(WrittenImage {
            shader: shader.to_owned(),
            output: path_name(path),
            size: frame.size,
            frame: frame.frame,
            time: frame.time,
            precision: self.args.precision.name(),
            device: by.device.to_owned(),
            seconds: by.seconds,
            frames: None,
            errors: None,
            profile: None,
        });
    }
}

impl<'a> Runner<'a> {
    /// Starts the sequence of an output, or goes on with an interrupted one with the same fingerprint; `None`
    /// for a single image. The images have this size in pixels; `sound` is the file of a film's sound.
    fn open_sequence(
        &self,
        (output, size): (Output, [u32; 2]),
        path: &Path,
        fingerprint: &str,
        sound: Option<&Path>,
    ) -> Result<Option<Sequence<'a>>, CliError> {
        if output != Output::Image {
            // Frames are in memory as a whole.
            let [width, height] = size.map(u64::from);
            check_size(width, height).map_err(CliError::new)?;
        }
        let args = &self.args.sequence;
        let settings = |frames, format| FilmSettings {
            keeps_alpha: self.args.transparent,
            sound: sound.map(Path::to_owned),
            ..args.film(frames, format, size)
        };
        Ok(Some(match output {
            Output::Image => return Ok(None),
            Output::Sound(_) => {
                let error = CliError::new("only projects have a sound");
                return Err(
                    error.with_help("its tab `sound.glsl` defines `vec2 mainSound(int samp, float time)`")
                );
            }
            Output::Files(frames) => {
                Sequence::Files(NumberedFiles::resume(frames, path, fingerprint, self.terminal))
            }
            Output::Film(frames, format) => {
                let paths = (self.output, path);
                let settings = settings(frames, format);
                let film = FilmFile::start((args, frames), settings, paths, fingerprint, self.terminal)?;
                Sequence::Film(Box::new(film))
            }
            Output::Stream(frames, format) => {
                Sequence::Stream(FrameStream::new(frames, settings(frames, format), self.terminal)?)
            }
        }))
    }
}

/// The image that a driver rendered.
fn draw_result(drawn: Result<DrawOutput, Failure>, shader: &Shader) -> Result<RenderedImage, CliError> {
    let drawn = drawn.map_err(|failure| draw_error(failure, shader))?;
    if let Some(pixels @ 1..) = drawn.loop_truncated {
        let error = format!("{}: {}", shader.name, report::loop_truncated(pixels));
        return Err(CliError::new(error).with_exit(Exit::ShaderFault));
    }
    Ok(RenderedImage {
        seconds: drawn.draw.as_secs_f64(),
        device: drawn.device.clone(),
        image: drawn.image(),
    })
}
