//! `toyproof render` and `toyproof export`: a scene as an image, and as a shader.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::iter;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use indicatif::ProgressBar;
use toyproof_diagnostic::{grouped, magnitude, path_name, plural};
use toyproof_image::{ExrAttributes, Frame, Image, encode_exr};
use toyproof_project::files;
use toyproof_scene::{self as scene, FrameTime, Requirements, Sampler, Scene};
use toyproof_tracer::{Backend, Layers, Tracer};
use toyproof_verify::{Expected, Quantization};

use super::inputs::{check_output, shell_word};
use super::reference::ill_conditioned;
use super::run::{Precision, default_output, encode};
use super::scenes::{parse_scene, read_scene};
use super::sequence::{
    Destination, FilmFile, FrameEnd, FrameStream, NumberedFiles, Output, Sequence, SequenceArgs,
};
use super::terminal::file_size;
use super::{CliError, Exit, Terminal, inputs, project};

/// Render a scene with the reference tracer
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof render 12-whitted -o whitted.png
  toyproof render scene.toml -o scene.exr --size 1920x1080 --samples 64
  toyproof render 09-soft-shadows --sampler sobol --max-error 0.002
  toyproof render 11-animation -o orrery.mp4 --duration 8
  toyproof render 11-animation -o frames/orrery.png --frames 0..479")]
pub(super) struct Args {
    /// The scene: a file, or a name listed by `toyproof scenes`
    scene: PathBuf,
    /// The image: .png (8 bits), .exr (floats), or - for PNG on standard output; or a film: .gif, .apng,
    /// .mp4, .webm, .y4m [default: SCENE.png in the current folder]
    #[arg(short, long, value_name = "IMAGE|FILM")]
    output: Option<PathBuf>,
    /// The number type of the tracer
    #[arg(long, value_enum, default_value_t = Precision::F64, hide_possible_values = true, value_name = "f32|f64")]
    precision: Precision,
    /// Samples per pixel [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536), allow_negative_numbers = true)]
    samples: Option<u32>,
    /// The sampler of pixels, lights and materials [default: the scene's]
    #[arg(long, value_enum, value_name = "NAME")]
    sampler: Option<SamplerName>,
    /// Take samples until the estimated error is below this, from 0 to 1
    ///
    /// The error is estimated for every tile of 16x16 pixels. This needs a stochastic sampler.
    #[arg(long, value_name = "ERROR", value_parser = parse_max_error, conflicts_with = "samples", allow_negative_numbers = true)]
    max_error: Option<f64>,
    /// Add depth, normals, albedo, object numbers and the variance of the samples to an EXR, as channels of
    /// their own
    ///
    /// The channels are Z, Normal.X to Normal.Z, Albedo.R to Albedo.B, id, and variance.R to variance.B if
    /// there are several samples. Readers of colors ignore them.
    #[arg(long, conflicts_with = "max_error")]
    layers: bool,
    /// Width and height in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = inputs::parse_size)]
    size: Option<[u32; 2]>,
    /// The time of animated scenes, in seconds; of several frames, that of frame 0
    #[arg(long, value_name = "S", default_value_t = 0.0, value_parser = inputs::parse_seconds::<f64>, allow_negative_numbers = true)]
    time: f64,
    /// The frame number of animated scenes
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(i32).range(0..), allow_negative_numbers = true)]
    frame: i32,
    #[command(flatten)]
    sequence: SequenceArgs,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SamplerName {
    Center,
    SineHash,
    Independent,
    Stratified,
    Sobol,
}

impl From<SamplerName> for Sampler {
    fn from(name: SamplerName) -> Self {
        match name {
            SamplerName::Center => Self::Center,
            SamplerName::SineHash => Self::SineHash,
            SamplerName::Independent => Self::Independent,
            SamplerName::Stratified => Self::Stratified,
            SamplerName::Sobol => Self::Sobol,
        }
    }
}

fn parse_max_error(text: &str) -> Result<f64, String> {
    inputs::parse_number(text, f64::MIN_POSITIVE..=1.0, "a number above 0 and at most 1")
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let mut scene = load_scene(&args.scene)?;
    scene.film.size = args.size.unwrap_or(scene.film.size);
    scene.film.samples = args.samples.unwrap_or(scene.film.samples);
    scene.film.sampler = args.sampler.map_or(scene.film.sampler, Sampler::from);
    let requirements = Requirements::new(&scene);
    if !scene.film.sampler.is_stochastic()
        && (requirements.soft_shadows || requirements.path_tracing || args.max_error.is_some())
    {
        let what = if args.max_error.is_some() {
            "--max-error"
        } else {
            "this scene"
        };
        let error = CliError::new(format_args!("{what} needs a stochastic sampler"));
        return Err(error.with_help("choose --sampler independent, stratified or sobol"));
    }
    terminal.detail(&format!("the scene requires {requirements}"));
    let output = args
        .output
        .clone()
        .unwrap_or_else(|| default_output(&args.scene, &args.sequence));
    if args.layers && Quantization::of_file(&output) != Some(Quantization::Float) {
        let error = CliError::new("only an EXR file has layers");
        return Err(error.with_help(format_args!(
            "write one with -o {}",
            shell_word(&path_name(&output.with_extension("exr")))
        )));
    }
    let mut previous = PreviousTracers::default();
    let Some(sequence) = open_sequence(&scene, args, &output, terminal)? else {
        let frame_time = FrameTime {
            frame: args.frame,
            time: args.time,
        };
        render_image(&scene, frame_time, &mut previous, (args, &output), terminal)?;
        return Ok(Exit::Success);
    };
    sequence.render(terminal, |number, destination, _| {
        let frame_time = FrameTime {
            frame: number,
            time: args.time + f64::from(number) / args.sequence.fps,
        };
        match destination {
            Destination::File(path) => {
                let of_args = (args, true);
                let bytes = frame_file(&scene, frame_time, &mut previous, of_args, path, terminal)?;
                terminal.write(path, &bytes)?;
            }
            Destination::Film(film) => {
                film.add(&render_frame(
                    &scene,
                    frame_time,
                    &mut previous,
                    (args, true),
                    terminal,
                ))?;
            }
        }
        Ok(FrameEnd::Written)
    })?;
    Ok(Exit::Success)
}

/// Starts the sequence of frames, if there are several, or goes on with an interrupted one.
fn open_sequence<'t>(
    scene: &Scene,
    args: &Args,
    output: &Path,
    terminal: &'t Terminal,
) -> Result<Option<Sequence<'t>>, CliError> {
    // Identifies the rendering: frames of a different scene or with other settings are ignored.
    let mut hasher = DefaultHasher::new();
    let settings = (
        &args.precision,
        args.max_error,
        args.layers,
        args.time,
        args.sequence.fps,
    );
    format!("{scene:?} {settings:?}").hash(&mut hasher);
    let fingerprint = format!("{:016x}", hasher.finish());
    let sequence = &args.sequence;
    Ok(Some(match sequence.output(output)? {
        Output::Image => return Ok(None),
        Output::Sound(_) => return Err(CliError::new("a scene has no sound")),
        Output::Files(frames) => {
            Sequence::Files(NumberedFiles::resume(frames, output, &fingerprint, terminal))
        }
        Output::Film(frames, format) => {
            let settings = sequence.film(frames, format, scene.film.size);
            let paths = (output, output);
            let film = FilmFile::start((sequence, frames), settings, paths, &fingerprint, terminal)?;
            Sequence::Film(Box::new(film))
        }
        Output::Stream(frames, format) => {
            let settings = sequence.film(frames, format, scene.film.size);
            Sequence::Stream(FrameStream::new(frames, settings, terminal)?)
        }
    }))
}

/// The tracer of the previous frame, in the requested number type.
#[derive(Default)]
struct PreviousTracers {
    single: Option<Tracer<f32>>,
    double: Option<Tracer<f64>>,
}

/// Traces the scene at a frame time.
fn render_frame(
    scene: &Scene,
    frame_time: FrameTime,
    previous: &mut PreviousTracers,
    (args, is_in_sequence): (&Args, bool),
    terminal: &Terminal,
) -> Image {
    let of_args = (args, is_in_sequence);
    match args.precision {
        Precision::F32 => trace(scene, frame_time, &mut previous.single, of_args, terminal),
        Precision::F64 => trace(scene, frame_time, &mut previous.double, of_args, terminal),
    }
}

/// Traces the scene at a frame time, and encodes the file of its image.
fn frame_file(
    scene: &Scene,
    frame_time: FrameTime,
    previous: &mut PreviousTracers,
    (args, is_in_sequence): (&Args, bool),
    path: &Path,
    terminal: &Terminal,
) -> Result<Vec<u8>, CliError> {
    let of_args = (args, is_in_sequence);
    if !args.layers {
        let image = render_frame(scene, frame_time, previous, of_args, terminal);
        return Ok(encode(&image, path, false)?);
    }
    let layers = match args.precision {
        Precision::F32 => traced_layers(scene, frame_time, &mut previous.single, is_in_sequence, terminal),
        Precision::F64 => traced_layers(scene, frame_time, &mut previous.double, is_in_sequence, terminal),
    };
    let words = std::env::args_os().skip(1);
    let words: Vec<String> = words.map(|word| shell_word(&word.to_string_lossy())).collect();
    let attributes = ExrAttributes {
        software: format!("toyproof {}", env!("CARGO_PKG_VERSION")),
        scene: path_name(&args.scene),
        command: format!("toyproof {}", words.join(" ")),
        comments: Layers::DESCRIPTION.to_owned(),
    };
    Ok(encode_exr(&layers.color, layers.channels(), &attributes, path)?)
}

/// Traces the layers of the scene at a frame time.
fn traced_layers<T: Backend>(
    scene: &Scene,
    frame_time: FrameTime,
    previous: &mut Option<Tracer<T>>,
    is_in_sequence: bool,
    terminal: &Terminal,
) -> Layers {
    let tracer = moved_tracer(scene, frame_time, previous);
    let bar = rows_bar(scene, is_in_sequence, terminal);
    let layers = tracer.render_layers(|| bar.inc(1));
    bar.finish_and_clear();
    layers
}

/// The tracer of a frame, made from that of the previous one, if there is any.
fn moved_tracer<'a, T: Backend>(
    scene: &Scene,
    frame_time: FrameTime,
    previous: &'a mut Option<Tracer<T>>,
) -> &'a Tracer<T> {
    let tracer = match previous.take() {
        Some(previous) => previous.moved(scene, frame_time),
        None => Tracer::at(scene, frame_time),
    };
    previous.insert(tracer)
}

/// The progress bar over the rows of an image; a sequence has its own.
fn rows_bar(scene: &Scene, is_in_sequence: bool, terminal: &Terminal) -> ProgressBar {
    if is_in_sequence {
        ProgressBar::hidden()
    } else {
        terminal.bar(u64::from(scene.film.size[1]), "rows")
    }
}

/// Traces the scene at a frame time, and writes and confirms the image.
fn render_image(
    scene: &Scene,
    frame_time: FrameTime,
    previous: &mut PreviousTracers,
    (args, path): (&Args, &Path),
    terminal: &Terminal,
) -> Result<(), CliError> {
    let start = Instant::now();
    let bytes = frame_file(scene, frame_time, previous, (args, false), path, terminal)?;
    terminal.write(path, &bytes)?;
    let [width, height] = scene.film.size;
    let samples = match args.max_error {
        Some(error) => format!("error below {error}"),
        None => format!(
            "{} {} per pixel",
            grouped(u64::from(scene.film.samples)),
            plural(u64::from(scene.film.samples), "sample", "samples")
        ),
    };
    let facts = format!(
        "{width}×{height}, {samples}, {}, {}, {:.1} s",
        args.precision.name(),
        file_size(bytes.len()),
        start.elapsed().as_secs_f64()
    );
    terminal.confirm(path, &facts);
    warn_if_ill_conditioned(scene, frame_time, args, terminal);
    Ok(())
}

/// Warns of pixels whose color rounding decides.
fn warn_if_ill_conditioned(scene: &Scene, frame_time: FrameTime, args: &Args, terminal: &Terminal) {
    let frame = Frame {
        size: scene.film.size,
        frame: frame_time.frame,
        time: frame_time.time as f32,
        ..Frame::default()
    };
    if let Some(conditioning) = Expected::from_scene(scene.clone(), &frame).conditioning() {
        let name = path_name(&args.scene);
        terminal.warn(ill_conditioned(&name, frame.size, &conditioning));
    }
}

/// Reads a scene, given by its file or by the name of a built-in scene.
pub(super) fn load_scene(path: &Path) -> Result<Scene, CliError> {
    if files::is_shader(path) {
        let path = path_name(path);
        let error = CliError::new(format_args!("{path} is a shader, but a scene is expected here"));
        return Err(error.with_help(format_args!("to run a shader: toyproof run {path} -o IMAGE")));
    }
    parse_scene(read_scene(path)?)
}

/// Traces the scene, with a progress bar over its rows.
fn trace<T: Backend>(
    scene: &Scene,
    frame_time: FrameTime,
    previous: &mut Option<Tracer<T>>,
    (args, is_in_sequence): (&Args, bool),
    terminal: &Terminal,
) -> Image {
    let tracer = moved_tracer(scene, frame_time, previous);
    let bar = rows_bar(scene, is_in_sequence, terminal);
    let Some(max_error) = args.max_error else {
        let start = Instant::now();
        let rendered = tracer.render(|| bar.inc(1));
        bar.finish_and_clear();
        terminal.detail(&format!("traced in {:.4} s", start.elapsed().as_secs_f64()));
        return rendered;
    };
    let (rendered, spent) = tracer.render_adaptive(max_error, || bar.inc(1));
    bar.finish_and_clear();
    let [most, fewest] = spent.per_pixel;
    terminal.note(&format!(
        "{} samples, {} to {} per pixel; the largest estimated error of a tile is {}",
        grouped(spent.samples),
        grouped(u64::from(fewest)),
        grouped(u64::from(most)),
        magnitude(spent.error)
    ));
    rendered
}

/// Write the ShaderToy shader that renders a scene, or a project as ShaderToy's JSON
///
/// The text is written to standard output unless -o is given. The shader has only what the scene requires;
/// --verbose lists what that is, and what was left out.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof export 04-many-objects -o mine.glsl
  toyproof check mine.glsl --scene 04-many-objects
  toyproof export waves -o waves.json")]
pub(super) struct ExportArgs {
    /// The scene (a file, or a name listed by `toyproof scenes`), or the project (a folder, JSON or shader)
    #[arg(value_name = "SCENE|PROJECT")]
    input: PathBuf,
    /// The shader (.glsl) or JSON (.json), or - for standard output
    #[arg(
        short,
        long,
        value_name = "SHADER|JSON",
        default_value = "-",
        hide_default_value = true
    )]
    output: PathBuf,
}

pub(super) fn export(args: &ExportArgs, terminal: &Terminal) -> Result<Exit, CliError> {
    if files::is_project(&args.input) || files::is_shader(&args.input) || files::is_json(&args.input) {
        return project::export(&args.input, &args.output, terminal);
    }
    check_output(&args.output, &iter::once(&*args.input).collect())?;
    let scene = load_scene(&args.input)?;
    let requirements = Requirements::new(&scene);
    let text = scene::export::shader(&scene);
    let text = text.map_err(|error| format!("{}: {error}", path_name(&args.input)))?;
    terminal.write(&args.output, text.as_bytes())?;
    terminal.confirm(&args.output, &file_size(text.len()));
    terminal.detail(&format!("the scene requires {requirements}"));
    terminal.detail(&format!("left out: {}", requirements.left_out().join(", ")));
    Ok(Exit::Success)
}
