//! `toyproof stress`

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use toyproof_diagnostic::{Deadline, path_name};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::Frame;
use toyproof_lab::stress as output;
use toyproof_player::{DrawOutput, DriverFailure};
use toyproof_stress::function::{self, Role, RoleMap, Signature};
use toyproof_stress::{self as stress, Gpu, Report, Settings, formula};
use toyproof_translate::FloatMode;

use super::inputs::{DriverArgs, LanguageArgs};
use super::shader::{Shader, find_one};
use super::{CliError, Exit, Terminal};

/// Find the inputs for which ray–surface intersection fails numerically
///
/// Tests formulas for ray–sphere and ray–quadric intersection, and for the start of rays that leave a
/// surface, with extreme inputs in f32 and f64, and compares the results with 160-bit arithmetic. Prints
/// where each formula fails in f32; with -v also in f64.
///
/// With a shader, tests the shader's own function that intersects a ray with a sphere, and recognizes common
/// mistakes.
///
/// Writes stress.csv, stress.json, and heat maps as SVG and PNG.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "Examples:\n  toyproof stress -o stress\n  \
                        toyproof stress my.glsl --function intersectSphere -o stress\n  \
                        toyproof stress my.glsl --function hit --map p=origin,v=direction,ball.at=center -o stress\n\n\
                        Exit code: 0 if no mistake was found, 1 if the function makes a known mistake that its callers cannot avoid, 2 for other errors.")]
pub(super) struct Args {
    /// Shader with the function to test [default: the built-in formulas]
    shader: Option<PathBuf>,
    /// Function that intersects a ray with a sphere [default: the only one that is recognized]
    #[arg(long, value_name = "NAME", requires = "shader")]
    function: Option<String>,
    /// Roles of the function's parameters, if their names do not indicate them
    ///
    /// Inputs: origin, direction, center, radius, sphere (center and radius in a vec4), tmin, tmax. Outputs:
    /// t, second (t of the second hit), hit. The path `return` is the function's result.
    #[arg(long, value_name = "PATH=ROLE,…", value_delimiter = ',', value_parser = parse_role, requires = "shader")]
    map: Vec<(String, Role)>,
    /// Write the results into this folder
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Seed of the random cases
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = parse_seed, allow_negative_numbers = true)]
    seed: u64,
    /// Random cases per step of each tested quantity
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(1..=100_000), allow_negative_numbers = true)]
    cases: u32,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

fn parse_seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

fn parse_role(text: &str) -> Result<(String, Role), String> {
    let parsed = text.split_once('=').and_then(|(path, role)| {
        let role = Role::named(role.trim())?;
        Some((path.trim().to_owned(), role))
    });
    parsed.ok_or_else(|| {
        "expected PATH=ROLE, such as ray.origin=origin; roles: origin, direction, center, radius, sphere, tmin, tmax, t, second, hit"
            .to_owned()
    })
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let mut worker = worker(&args.driver, terminal)?;
    let mut renderer = worker
        .as_mut()
        .map(|worker| renderer(worker, args.driver.float()));
    let gpu = renderer.as_mut().map(|renderer| renderer as &mut Gpu);
    let interrupted = terminal.watch_interrupts("stopping; no files are written");
    match &args.shader {
        Some(shader) => examine(args, shader, gpu, &interrupted, terminal),
        None => study(args, gpu, &interrupted, terminal),
    }
}

impl Args {
    fn settings(&self) -> Settings {
        Settings {
            seed: self.seed,
            cases: self.cases as usize,
        }
    }
}

fn study(
    args: &Args,
    gpu: Option<&mut Gpu>,
    interrupted: &AtomicBool,
    terminal: &Terminal,
) -> Result<Exit, CliError> {
    let subjects = formula::subjects();
    let bar = terminal.bar(stress::run_count(&subjects, gpu.is_some()), "formulas tested");
    let studied = stress::study(&subjects, gpu, args.settings(), interrupted, || bar.inc(1));
    bar.finish_and_clear();
    let report = studied?;
    for line in report.summary() {
        terminal.result(&line);
    }
    for line in report.double_precision_summary() {
        terminal.detail(&line);
    }
    write_results(&report, output::json(&report), args, terminal)?;
    Ok(Exit::Success)
}

fn examine(
    args: &Args,
    path: &Path,
    gpu: Option<&mut Gpu>,
    interrupted: &AtomicBool,
    terminal: &Terminal,
) -> Result<Exit, CliError> {
    let input = find_one(path, "stress", terminal)?;
    let shader = Shader::load(&input, &args.language, Deadline::after(args.driver.timeout()));
    let checked = shader.require_single_pass()?;
    let map: RoleMap = args.map.iter().cloned().collect();
    let signature = match &args.function {
        Some(name) => Signature::recognize(checked, name, &map),
        None => Signature::only(checked, &map),
    };
    let signature = signature.map_err(|why| format!("{}: {why}", shader.name))?;
    // Those of the dialect that was recognized.
    let options = glsl::Options {
        deadline: Deadline::after(args.driver.timeout()),
        ..checked.options()
    };
    let bar = terminal.bar(2 + u64::from(gpu.is_some()), "runs");
    let (text, settings) = (shader.text(checked), args.settings());
    let examined = function::examine(text, &signature, &options, gpu, settings, interrupted, || {
        bar.inc(1);
    });
    bar.finish_and_clear();
    let findings = examined.map_err(|failure| format!("{}: {failure}", shader.name))?;
    for line in findings.summary(&signature.name) {
        terminal.result(&line);
    }
    write_results(&findings.report, output::json(&findings), args, terminal)?;
    Ok(if findings.mistake.is_some_and(|mistake| !mistake.recoverable) {
        Exit::ShaderFault
    } else {
        Exit::Success
    })
}

/// Renders the frames of subjects on the driver of a worker.
fn renderer(
    worker: &mut Worker,
    float: FloatMode,
) -> impl FnMut(&Checked, &Frame) -> Result<DrawOutput, DriverFailure> {
    move |checked, frame| worker.draw_unwatched(float.lower(checked), frame.clone(), float)
}

/// Creates a worker that has a driver; `None` if only the evaluator is available.
fn worker(driver: &DriverArgs, terminal: &Terminal) -> Result<Option<Worker>, CliError> {
    let Some(mut worker) = driver.worker()? else {
        return Ok(None);
    };
    match worker.probe() {
        Ok(_) => Ok(Some(worker)),
        Err(failure) if failure.is_without_driver() && driver.may_fall_back() => {
            terminal.warn(format_args!("{failure}; testing only the CPU"));
            Ok(None)
        }
        Err(failure) => Err(failure.into()),
    }
}

fn write_results(report: &Report, json: String, args: &Args, terminal: &Terminal) -> Result<(), CliError> {
    let mut files = vec![
        ("stress.csv".to_owned(), output::csv(report).into_bytes()),
        ("stress.json".to_owned(), json.into_bytes()),
    ];
    for (name, heat_map) in output::heat_maps(report) {
        files.push((format!("{name}.svg"), heat_map.svg().into_bytes()));
        let name = format!("{name}.png");
        let bytes = toyproof_image::encode(&heat_map.image(), name.as_ref())?;
        files.push((name, bytes));
    }
    for (name, bytes) in &files {
        terminal.write(&args.output.join(name), bytes)?;
    }
    let path = |name: &str| path_name(&args.output.join(name));
    terminal.note(&format!(
        "All figures: {}. Heat maps: {}",
        path("stress.csv"),
        path("stress-spheres.svg")
    ));
    Ok(())
}
