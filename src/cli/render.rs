//! `toyproof render`

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use indicatif::ProgressBar;
use toyproof_diagnostic::{Files, path_name};
use toyproof_image::{self as image, Image};
use toyproof_scene::{self as scene, Moment, Requirements, Sampler, Scene};
use toyproof_tracer::{Real, Tracer};
use toyproof_verify::compare::{grouped, magnitude};

use super::sequence::{self, Frames, Sequence};
use super::{Exit, Terminal, inputs};
use crate::cli::files;

/// Render a scene with the reference tracer
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  toyproof render glsl/02-sphere.toml -o reference.png\n  \
                        toyproof render scene.toml -o reference.exr --size 1920x1080 --samples 64\n  \
                        toyproof render scene.toml -o reference.png --sampler sobol --max-error 0.002\n  \
                        toyproof render glsl/11-animation.toml -o frames/orrery.png --frames 0..479"
)]
pub(super) struct Args {
    /// The scene, in TOML
    scene: PathBuf,
    /// The picture: .png (8 bits) or .exr (floats)
    #[arg(short, long, value_name = "PICTURE")]
    output: PathBuf,
    /// The number type that it is traced in
    #[arg(long, value_enum, default_value_t = Precision::F64)]
    precision: Precision,
    /// Samples in each pixel [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536), allow_negative_numbers = true)]
    samples: Option<u32>,
    /// Where samples lie in a pixel, and what lights and surfaces draw [default: the scene's]
    #[arg(long, value_enum, value_name = "NAME")]
    sampler: Option<SamplerName>,
    /// Take samples until the estimated error of every tile of 16x16 pixels is below this, in [0, 1], and say how
    /// many it took; needs a sampler that draws
    #[arg(long, value_name = "ERROR", value_parser = max_error, conflicts_with = "samples", allow_negative_numbers = true)]
    max_error: Option<f64>,
    /// Width and height in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = inputs::size)]
    size: Option<[u32; 2]>,
    /// The time in seconds, where anything moves by it
    #[arg(long, value_name = "S", default_value_t = 0.0, value_parser = inputs::seconds::<f64>, allow_negative_numbers = true)]
    time: f64,
    /// The number of the frame, where anything moves by it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(i32).range(0..), allow_negative_numbers = true)]
    frame: i32,
    /// All frames from A to B, at 60 a second, each into a file with its number; a sequence that was interrupted goes
    /// on where it stopped
    #[arg(long, value_name = "A..B", value_parser = sequence::frames, conflicts_with_all = ["frame", "time"])]
    frames: Option<Frames>,
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

fn max_error(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(error) if error > 0.0 && error <= 1.0 => Ok(error),
        _ => Err("expected a number above 0 and at most 1".to_owned()),
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Precision {
    F32,
    F64,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let Some(mut scene) = load(&args.scene, terminal) else {
        return Exit::Trouble;
    };
    scene.film.size = args.size.unwrap_or(scene.film.size);
    scene.film.samples = args.samples.unwrap_or(scene.film.samples);
    scene.film.sampler = args.sampler.map_or(scene.film.sampler, Sampler::from);
    let requirements = Requirements::of(&scene);
    if !scene.film.sampler.draws()
        && (requirements.soft_shadows || requirements.path_tracing || args.max_error.is_some())
    {
        terminal.error("this needs a sampler that draws: --sampler independent, stratified or sobol");
        return Exit::Trouble;
    }
    terminal.detail(&format!("the scene requires {requirements}"));
    let mut before = Before::default();
    let made = match args.frames {
        None => {
            let moment = Moment {
                frame: args.frame,
                time: args.time,
            };
            picture(&scene, moment, &mut before, (args, &args.output), terminal)
        }
        Some(_) if args.output == Path::new("-") => {
            terminal.error(sequence::NO_FILE);
            false
        }
        Some(frames) => {
            // What the frames are of: a record of anything else is not continued.
            let what = format!("{scene:?} {:?} {:?}", args.precision, args.max_error);
            let sequence = Sequence::resume(frames, &args.output, &what, terminal);
            sequence.make(terminal, |one| {
                let moment = Moment {
                    frame: one.frame,
                    time: one.time,
                };
                picture(&scene, moment, &mut before, (args, &one.path), terminal)
            })
        }
    };
    if made { Exit::Good } else { Exit::Trouble }
}

/// The tracer of the frame before, in the type that is asked for.
#[derive(Default)]
struct Before {
    single: Option<Tracer<f32>>,
    double: Option<Tracer<f64>>,
}

/// Traces the scene at a moment and keeps the picture; tells whether it could.
fn picture(
    scene: &Scene,
    moment: Moment,
    before: &mut Before,
    (args, path): (&Args, &Path),
    terminal: &Terminal,
) -> bool {
    let start = Instant::now();
    let picture = match args.precision {
        Precision::F32 => trace(scene, moment, &mut before.single, args, terminal),
        Precision::F64 => trace(scene, moment, &mut before.double, args, terminal),
    };
    terminal.detail(&format!("traced in {:.3} s", start.elapsed().as_secs_f64()));
    match image::encode(&picture, path) {
        Ok(bytes) => terminal.write(path, &bytes),
        Err(error) => {
            terminal.error(error);
            false
        }
    }
}

/// A scene from its file; says what is wrong with it.
pub(super) fn load(path: &Path, terminal: &Terminal) -> Option<Scene> {
    if files::is_shader(path) {
        let path = path_name(path);
        terminal.error(format_args!(
            "{path} is a shader, and `render` takes a scene; paint the shader with `toyproof run {path} -o PICTURE`"
        ));
        return None;
    }
    let mut files = Files::default();
    let file = match files::read_text(path) {
        Ok(text) => files.add(text),
        Err(error) => {
            terminal.error(error);
            return None;
        }
    };
    scene::parse(&files, file)
        .map_err(|diagnostics| terminal.diagnostics(&diagnostics, &files))
        .ok()
}

/// The picture, with a bar that shows its rows.
fn trace<T: Real>(
    scene: &Scene,
    moment: Moment,
    before: &mut Option<Tracer<T>>,
    args: &Args,
    terminal: &Terminal,
) -> Image {
    let tracer = match before.take() {
        Some(before) => before.moved(scene, moment),
        None => Tracer::at(scene, moment),
    };
    let tracer = &*before.insert(tracer);
    let rows = u64::from(scene.film.size[1]);
    let bar = match args.frames {
        None => terminal.bar(rows, "tracing"),
        // The sequence has a bar of its own.
        Some(_) => ProgressBar::hidden(),
    };
    let Some(max_error) = args.max_error else {
        let picture = tracer.picture(|| bar.inc(1));
        bar.finish_and_clear();
        return picture;
    };
    let (picture, spent) = tracer.picture_within(max_error, || bar.inc(1));
    bar.finish_and_clear();
    let [most, fewest] = spent.per_pixel;
    terminal.say(&format!(
        "{} samples, {} to {} in a pixel; the largest estimated error of a tile is {}",
        grouped(spent.samples),
        grouped(u64::from(fewest)),
        grouped(u64::from(most)),
        magnitude(spent.error)
    ));
    picture
}
