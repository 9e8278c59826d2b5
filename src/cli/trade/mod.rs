//! `toyproof trade`

mod numerics;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Deadline, File, Files, path_name};
use toyproof_gpu::{AdapterSelector, Worker};
use toyproof_image as image;
use toyproof_image::Frame;
use toyproof_lab::trade::{self, FeatureSubject, Report, Source, Subject, Vary};
use toyproof_lint::Lints;
use toyproof_player::Clock;
use toyproof_project::files::{self, IncludeFolders, Input};
use toyproof_project::{PassKind, Rendering};
use toyproof_scene::{Scene, export};

use crate::cli::check::Scenes;
use crate::cli::inputs::{
    FrameArgs, LOADS_DRIVERS, LanguageArgs, STATIC_PROGRAM, parse_adapter, parse_number, parse_time_limit,
    worker,
};
use crate::cli::render::load_scene;
use crate::cli::shader::{Content, Shader, Unusable, find_one};
use crate::cli::{CliError, Exit, Terminal};

/// Measure rendering time against accuracy
///
/// Renders a scene or a shader in many configurations, and compares each image with a reference in double
/// precision. Prints the fastest configuration for each of several error limits; with -v all configurations.
///
/// The configurations are the tracer in f32 and f64, with the samplers, sample counts and depths that matter
/// for the scene, and its shader on the CPU and on GPUs, with each ray–sphere formula. The shader is the file
/// next to the scene, or the one that `toyproof export` writes.
///
/// Of a shader or a project, also other values of its parameters: the limits of its loops (steps, samples,
/// octaves), step sizes, thresholds, and the resolution. Each is named with what it saves, and with the number
/// of pixels in which that is visible.
///
/// Writes trade.csv, trade.json, and a chart: trade.svg and trade.png.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "Examples:\n  toyproof trade 03-shading -o trade\n  \
                        toyproof trade my-scene.toml -o trade --budget 60s\n  \
                        toyproof trade 09-soft-shadows --max-error 0.004 --size 160x90\n  \
                        toyproof trade mine.glsl -o trade --vary MAX_STEPS=16..256")]
pub(in crate::cli) struct Args {
    /// A scene of the course, such as 09-soft-shadows, a scene file (.toml), a shader (.glsl), or a project
    #[arg(value_name = "SCENE|SHADER")]
    subject: PathBuf,
    /// Vary a constant, a macro, a uniform, or the number in a line of the shader, or `resolution`; repeatable
    ///
    /// Values: a range such as 16..256, or a list such as 16,64,256. Without --vary, the parameters of the
    /// loops of a shader are varied.
    #[arg(long, value_name = "NAME=VALUES")]
    vary: Vec<Vary>,
    /// Instead of measuring, look for other forms of the shader's expressions that lose fewer digits in float32
    ///
    /// Tries a catalogue of identities on the pixels that the shader renders, and writes the shader with the
    /// best ones: rewritten.glsl.
    #[arg(long, conflicts_with_all = ["vary", "reference", "max_error", "mediump"])]
    rewrite: bool,
    /// Instead of measuring, look for variables that may be `mediump`: numbers of 16 bits
    ///
    /// Emulates 16 bits to the bit, and writes the shader with the qualifiers that change at most 0.1 % of the
    /// pixels visibly: mediump.glsl. GPUs that have such numbers render it in 16 bits, too.
    #[arg(long, conflicts_with_all = ["vary", "reference", "max_error"])]
    mediump: bool,
    /// Compare with this scene, or with this shader in double precision
    ///
    /// [default: the scene next to the shader, else the shader itself, with more accurate parameters where they
    /// change the image and converge]
    #[arg(long, value_name = "SCENE|SHADER")]
    reference: Option<PathBuf>,
    /// Write the results into this folder; required only for measurements of all configurations
    #[arg(short, long, value_name = "DIR", required_unless_present_any = ["max_error", "features", "rewrite", "mediump"])]
    output: Option<PathBuf>,
    /// Time limit of the whole measurement
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = parse_time_limit)]
    budget: Duration,
    /// Print only the fastest configuration whose root mean square error is at most this, from 0 to 1
    #[arg(long, value_name = "ERROR", value_parser = parse_max_error, allow_negative_numbers = true)]
    max_error: Option<f64>,
    /// Measure the price of each feature that the scene uses: the time without it and with it
    #[arg(long, conflicts_with = "max_error")]
    features: bool,
    /// GPUs to measure: `all`, `cpu` for none, `lavapipe`, or a substring of the adapter's name
    #[arg(long, value_name = "DEVICE", default_value = "all")]
    device: String,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    frame: FrameArgs,
}

fn parse_max_error(text: &str) -> Result<f64, String> {
    parse_number(text, 0.0..=1.0, "a number from 0 to 1")
}

pub(in crate::cli) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let interrupted = terminal.watch_interrupts("stopping; no files are written");
    if args.rewrite || args.mediump {
        return numerics::run(args, &interrupted, terminal);
    }
    if args.features {
        features(args, &interrupted, terminal)?;
    } else {
        print_report(&measure(args, &interrupted, terminal)?, args, terminal)?;
    }
    Ok(Exit::Success)
}

/// Measures and prints the price of each feature of a scene.
fn features(args: &Args, interrupted: &AtomicBool, terminal: &Terminal) -> Result<(), CliError> {
    if names_shader(&args.subject) {
        return Err(CliError::new("--features takes a scene").with_help("name a scene, such as 12-whitted"));
    }
    let start = Instant::now();
    let frame = args.frame.inputs().load()?;
    let (scene, frame) = fit_size(Some(load_scene(&args.subject)?), frame, args.frame.size);
    let scene = scene.expect("the scene was loaded");
    let subject = FeatureSubject {
        name: subject_name(&args.subject),
        scene: &scene,
        options: args.language.options(Deadline::after(args.budget)),
        frame: &frame,
        workers: workers(&args.device, args.budget, terminal)?,
        start,
        budget: args.budget,
    };
    let bar = terminal.share_bar(1000, "time budget");
    let report = trade::features(subject, interrupted, |share| {
        bar.set_position((1000.0 * share) as u64);
    });
    bar.finish_and_clear();
    let report = report?;
    for line in report.summary() {
        terminal.result(&line);
    }
    let Some(folder) = &args.output else {
        return Ok(());
    };
    terminal.write(&folder.join("features.csv"), report.csv().as_bytes())?;
    terminal.write(&folder.join("features.json"), report.json().as_bytes())?;
    terminal.note(&format!(
        "All prices: {}",
        path_name(&folder.join("features.csv"))
    ));
    Ok(())
}

/// Measures all methods.
fn measure(args: &Args, interrupted: &AtomicBool, terminal: &Terminal) -> Result<Report, CliError> {
    let start = Instant::now();
    let deadline = Deadline::after(args.budget);
    let frame = args.frame.inputs().load()?;
    let is_shader = names_shader(&args.subject);
    let (mut scene, shader) = if is_shader {
        let shader = Loaded::new(&args.subject, args, &deadline, terminal)?;
        (scene_for_shader(&args.subject), Some(shader))
    } else {
        let scene = load_scene(&args.subject)?;
        let shader = shader_for_scene(&args.subject, &scene, args, &deadline);
        (Some(scene), shader)
    };
    let mut reference = None;
    match &args.reference {
        Some(path) if names_shader(path) => {
            scene = None;
            reference = Some(Loaded::new(path, args, &deadline, terminal)?);
        }
        Some(path) => scene = Some(load_scene(path)?),
        None => {}
    }
    let (scene, frame) = fit_size(scene, frame, args.frame.size);
    let has_history = shader.as_ref().is_some_and(|shader| shader.shader.has_passes);
    let frame = Frame {
        frame: args.frame.number(has_history, FRAME_RATE),
        ..frame
    };
    let clock = Clock {
        start: args.frame.start(frame.frame, FRAME_RATE),
        inputs: frame.clone(),
        rate: FRAME_RATE,
    };
    let subject = Subject {
        name: subject_name(&args.subject),
        // A scene is rendered by the tracer, unless it is only the reference of a shader.
        scene: scene.as_ref(),
        shader: shader.as_ref().and_then(|shader| shader.source(&clock)),
        proposes_settings: is_shader,
        vary: args.vary.clone(),
        reference: reference.as_ref().and_then(|shader| shader.source(&clock)),
        options: args.language.options(deadline),
        frame: &frame,
        workers: workers(&args.device, args.budget, terminal)?,
        start,
        budget: args.budget,
    };
    let bar = terminal.share_bar(1000, "time budget");
    let report = trade::study(subject, interrupted, |share| {
        bar.set_position((1000.0 * share) as u64);
    });
    bar.finish_and_clear();
    Ok(report?)
}

/// Whether a path names a shader or a project, not a scene.
fn names_shader(path: &Path) -> bool {
    let is_json = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    files::is_shader(path) || path.is_dir() || is_json
}

/// The frames of a project in a second, which count from 0.
const FRAME_RATE: f64 = 60.0;

/// A shader with what a project of it needs.
struct Loaded {
    shader: Shader,
    rendering: Option<Rendering>,
    includes: Option<IncludeFolders>,
}

impl Loaded {
    /// Loads a shader or a project that must compile.
    fn new(path: &Path, args: &Args, deadline: &Deadline, terminal: &Terminal) -> Result<Self, CliError> {
        let input = find_one(path, "trade", terminal)?;
        let shader = Shader::load(&input, &args.language, deadline.clone());
        shader.require_image()?;
        let rendering = match shader.project() {
            Some(project) => {
                let rendering = project.rendering(PassKind::Image);
                Some(rendering.map_err(|error| format!("{}: the image {error}", shader.name))?)
            }
            None => None,
        };
        let includes = |input: &Input| IncludeFolders::of(input, args.language.include_folders());
        Ok(Self {
            shader,
            rendering,
            includes: input.ok().as_ref().map(includes),
        })
    }

    fn of_one_pass(shader: Shader) -> Self {
        Self {
            shader,
            rendering: None,
            includes: None,
        }
    }

    fn source<'a>(&'a self, clock: &'a Clock) -> Option<Source<'a>> {
        let files = &self.shader.files;
        match (self.shader.project(), &self.rendering) {
            (Some(project), Some(rendering)) => Some(Source::Project {
                project,
                rendering,
                files,
                includes: self.includes.as_ref(),
                clock,
            }),
            _ => self
                .shader
                .image()
                .ok()
                .map(|checked| Source::Shader { checked, files }),
        }
    }
}

/// The name of a scene or shader in reports: without folder and extension.
fn subject_name(path: &Path) -> String {
    path.file_stem()
        .map_or_else(|| path_name(path), |stem| path_name(stem.as_ref()))
}

/// Gives scene and frame one size: the flag's, else the scene's, else the default.
fn fit_size(scene: Option<Scene>, mut frame: Frame, size: Option<[u32; 2]>) -> (Option<Scene>, Frame) {
    if let (None, Some(scene)) = (size, &scene) {
        frame.size = scene.film.size;
    }
    let scene = scene.map(|mut scene| {
        scene.film.size = frame.size;
        scene
    });
    (scene, frame)
}

/// Loads the shader next to a scene, else exports the scene, if possible.
fn shader_for_scene(path: &Path, scene: &Scene, args: &Args, deadline: &Deadline) -> Option<Loaded> {
    let shader = path.with_extension("glsl");
    if shader.is_file() {
        let found = files::find(&shader).inputs;
        let shader = Shader::load(found.first()?, &args.language, deadline.clone());
        return Some(Loaded::of_one_pass(shader));
    }
    let text = export::shader(scene).ok()?;
    let mut files = Files::default();
    let file = files.add(File::new("<exported>", text));
    Some(Loaded::of_one_pass(Shader {
        name: "<exported>".to_owned(),
        content: toyproof_glsl::check(&files, file, &args.language.options(deadline.clone()))
            .map(|checked| Content::Shader(Box::new(checked)))
            .map_err(|errors| Unusable::Invalid(errors.into())),
        files,
        lints: Lints::default(),
        has_passes: false,
        is_missing: false,
    }))
}

/// Loads the scene next to a shader.
fn scene_for_shader(path: &Path) -> Option<Scene> {
    let found = files::find(path).inputs;
    let found = found.first()?.as_ref().ok()?;
    Scenes::new(None).find(found)?.scene.ok()
}

/// Creates a worker for each device that `--on` selects.
fn workers(selector: &str, budget: Duration, terminal: &Terminal) -> Result<Vec<(String, Worker)>, CliError> {
    let adapters = match selector {
        "cpu" => return Ok(Vec::new()),
        "all" if !LOADS_DRIVERS => {
            terminal.warn(format_args!("{STATIC_PROGRAM}; measuring only the CPU"));
            return Ok(Vec::new());
        }
        "all" => {
            let mut probe = worker(AdapterSelector::Auto, budget)?.with_all_drivers();
            match probe.probe() {
                Ok(drivers) => drivers.iter().map(|driver| driver.name.clone()).collect(),
                Err(failure) => {
                    terminal.warn(format_args!("{failure}; measuring only the CPU"));
                    return Ok(Vec::new());
                }
            }
        }
        name => vec![name.to_owned()],
    };
    let made = adapters.into_iter().map(|name: String| {
        let on = if name.to_lowercase().contains("llvmpipe") {
            AdapterSelector::Lavapipe
        } else {
            parse_adapter(&name)?
        };
        let short = if on == AdapterSelector::Lavapipe {
            "lavapipe".to_owned()
        } else {
            name
        };
        Ok((short, worker(on, budget)?))
    });
    made.collect()
}

fn print_report(report: &Report, args: &Args, terminal: &Terminal) -> Result<(), CliError> {
    if report.results.is_empty() {
        return Err(CliError::new(format_args!(
            "nothing was measured: {}",
            report.skipped_line()
        )));
    }
    if let Some(error) = args.max_error {
        terminal.result(&report.fastest_line(error));
        if !report.skipped.is_empty() {
            terminal.note(&report.skipped_line());
        }
    } else {
        for line in report.summary() {
            terminal.result(&line);
        }
    }
    for line in report.details() {
        terminal.detail(&line);
    }
    let Some(folder) = &args.output else {
        return Ok(());
    };
    let chart = report.chart();
    let png = image::encode(&chart.image(), "trade.png".as_ref())?;
    let files = [
        ("trade.csv", report.csv().into_bytes()),
        ("trade.json", report.json().into_bytes()),
        ("trade.svg", chart.svg().into_bytes()),
        ("trade.png", png),
    ];
    for (name, bytes) in &files {
        terminal.write(&folder.join(name), bytes)?;
    }
    let [csv, chart] = ["trade.csv", "trade.svg"].map(|name| path_name(&folder.join(name)));
    terminal.note(&format!("Chart: {chart}. All configurations: {csv}"));
    Ok(())
}
