//! `toyproof trade`

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Deadline, File, Files, path_name};
use toyproof_gpu::{AdapterSelector, Worker};
use toyproof_image as image;
use toyproof_image::Frame;
use toyproof_lab::trade::{self, Report, Subject};
use toyproof_lint::Lints;
use toyproof_project::files;
use toyproof_scene::{Scene, export};

use super::check::Scenes;
use super::inputs::{
    FrameArgs, LOADS_DRIVERS, LanguageArgs, STATIC_PROGRAM, parse_adapter, parse_number, parse_time_limit,
    worker,
};
use super::render::load_scene;
use super::shader::{Content, Shader, Unusable, find_one};
use super::{CliError, Exit, Terminal};

/// Measure rendering time against accuracy
///
/// Renders a scene or a shader in many configurations, and compares each image with a reference in double
/// precision. Prints the fastest configuration for each of several error limits; with -v all configurations.
///
/// The configurations are the tracer in f32 and f64, with the samplers, sample counts and depths that matter
/// for the scene, and its shader on the CPU and on GPUs, with each ray–sphere formula. The shader is the file
/// next to the scene, or the one that `toyproof export` writes.
///
/// Writes trade.csv, trade.json, and a chart: trade.svg and trade.png.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "Examples:\n  toyproof trade 03-shading -o trade\n  \
                        toyproof trade my-scene.toml -o trade --budget 60s\n  \
                        toyproof trade 09-soft-shadows --max-error 0.004 --size 160x90")]
pub(super) struct Args {
    /// A scene of the course, such as 09-soft-shadows, a scene file (.toml), or a shader (.glsl)
    #[arg(value_name = "SCENE|SHADER")]
    subject: PathBuf,
    /// Write the results into this folder; required without --max-error
    #[arg(short, long, value_name = "DIR", required_unless_present = "max_error")]
    output: Option<PathBuf>,
    /// Time limit of the whole measurement
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = parse_time_limit)]
    budget: Duration,
    /// Print only the fastest configuration whose root mean square error is at most this, from 0 to 1
    #[arg(long, value_name = "ERROR", value_parser = parse_max_error, allow_negative_numbers = true)]
    max_error: Option<f64>,
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

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let interrupted = terminal.watch_interrupts("stopping; no files are written");
    print_report(&measure(args, &interrupted, terminal)?, args, terminal)?;
    Ok(Exit::Success)
}

/// Measures all methods.
fn measure(args: &Args, interrupted: &AtomicBool, terminal: &Terminal) -> Result<Report, CliError> {
    let start = Instant::now();
    let deadline = Deadline::after(args.budget);
    let frame = args.frame.inputs().load()?;
    let (scene, shader) = if files::is_shader(&args.subject) {
        let input = find_one(&args.subject, "trade", terminal)?;
        let shader = Shader::load(&input, &args.language, deadline.clone());
        shader.require_single_pass()?;
        (scene_for_shader(&args.subject), Some(shader))
    } else {
        let scene = load_scene(&args.subject)?;
        let shader = shader_for_scene(&args.subject, &scene, args, &deadline);
        (Some(scene), shader)
    };
    let (scene, frame) = fit_size(scene, frame, args.frame.size);
    let checked = shader
        .as_ref()
        .and_then(|shader| Some((shader, shader.single_pass()?)));
    let subject = Subject {
        name: subject_name(&args.subject),
        scene: scene.as_ref(),
        shader: checked.map(|(shader, checked)| (shader.text(checked), checked)),
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
fn shader_for_scene(path: &Path, scene: &Scene, args: &Args, deadline: &Deadline) -> Option<Shader> {
    let shader = path.with_extension("glsl");
    if shader.is_file() {
        let found = files::find(&shader).inputs;
        return Some(Shader::load(found.first()?, &args.language, deadline.clone()));
    }
    let text = export::shader(scene).ok()?;
    let mut files = Files::default();
    let file = files.add(File::new("<exported>", text));
    Some(Shader {
        name: "<exported>".to_owned(),
        content: toyproof_glsl::check(&files, file, &args.language.options(deadline.clone()))
            .map(|checked| Content::Shader(Box::new(checked)))
            .map_err(|errors| Unusable::Invalid(errors.into())),
        files,
        lints: Lints::default(),
        has_passes: false,
        is_missing: false,
    })
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
