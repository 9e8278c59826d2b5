//! `toyproof stress`

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use toyproof_diagnostic::{Deadline, Span, grouped, path_name, printable};
use toyproof_eval::Failure;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::Frame;
use toyproof_lab::{accuracy as accuracy_output, chart::HeatMap, stress as output};
use toyproof_player::{DrawOutput, DriverFailure};
use toyproof_stress::accuracy::{
    self, AccuracyError, Cause, GivenRange, Interface, Interval, Property, Request,
};
use toyproof_stress::function::{self, Role, RoleMap, Signature};
use toyproof_stress::{self as stress, Gpu, Report, RunError, Settings, formula};
use toyproof_translate::FloatMode;

use super::inputs::{DriverArgs, LanguageArgs};
use super::shader::{Shader, find_one};
use super::{CliError, Exit, Terminal};

/// Find the inputs for which a function fails numerically
///
/// With a shader, examines one of its functions: the inputs with the largest errors of float32, beside 160-bit
/// arithmetic; whether the inputs or the formula are the reason; the operation that loses the digits; NaN and
/// infinities; and properties. The ranges of the inputs are those that the shader passes to the function. In a
/// function that intersects a ray with a sphere, common mistakes are recognized.
///
/// Without one, tests formulas for ray–sphere and ray–quadric intersection, and for the start of rays that
/// leave a surface, with extreme inputs. Prints where each formula fails in f32; with -v also in f64.
///
/// Writes stress.csv, stress.json, and heat maps as SVG and PNG.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "Examples:\n  toyproof stress -o stress\n  \
                        toyproof stress my.glsl --function sdBox\n  \
                        toyproof stress my.glsl --function sdBox --range p=-2..2,b.x=0..1 -o stress\n  \
                        toyproof stress my.glsl --function normal --property unit --property 'symmetric p.x'\n  \
                        toyproof stress my.glsl --function intersectSphere -o stress\n  \
                        toyproof stress my.glsl --function hit --map p=origin,v=direction,ball.at=center -o stress\n\n\
                        Exit code: 0 if nothing is wrong, 1 if the function violates a property, or makes a known mistake that its callers cannot avoid, 2 for other errors.")]
pub(super) struct Args {
    /// Shader with the function to test [default: the built-in formulas]
    shader: Option<PathBuf>,
    /// Function to examine [default: the only one that intersects a ray with a sphere]
    #[arg(long, value_name = "NAME", requires = "shader")]
    function: Option<String>,
    /// Ranges of inputs, or of their components [default: the values that the shader passes]
    ///
    /// `unit` stands for vectors of length 1. If both ends have one sign and are far apart, the logarithm is
    /// uniformly distributed.
    #[arg(long, value_name = "NAME=LOW..HIGH,…", value_delimiter = ',', value_parser = parse_range, requires = "function", conflicts_with = "map")]
    range: Vec<GivenRange>,
    /// Property that the function should have
    ///
    /// `unit`: its length is 1. `symmetric NAME`: the sign of an input does not matter. `swap A,B`: two
    /// inputs can be exchanged. `monotone NAME`: it only rises, or only falls, with an input. `range LOW..HIGH`.
    #[arg(long, value_name = "PROPERTY", value_parser = parse_property, requires = "function", conflicts_with = "map")]
    property: Vec<Property>,
    /// Roles of the function's parameters in ray–sphere intersection, if their names do not indicate them
    ///
    /// Inputs: origin, direction, center, radius, sphere (center and radius in a vec4), tmin, tmax. Outputs:
    /// t, second (t of the second hit), hit. The path `return` is the function's result.
    #[arg(long, value_name = "PATH=ROLE,…", value_delimiter = ',', value_parser = parse_role, requires = "shader")]
    map: Vec<(String, Role)>,
    /// Write the results into this folder
    #[arg(short, long, value_name = "DIR", required_unless_present = "shader")]
    output: Option<PathBuf>,
    /// Seed of the random cases
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = parse_seed, allow_negative_numbers = true)]
    seed: u64,
    /// Random cases per step of each tested quantity, or of a function [default: 500, or 100000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), allow_negative_numbers = true)]
    cases: Option<u32>,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

/// The default of `--cases` for each step of the axes.
const STEP_CASES: u32 = 500;

/// The most cases for each step: there are hundreds of steps, whose cases are all in memory.
const MAX_STEP_CASES: u32 = 100_000;

/// The default of `--cases` for a function that is examined by itself.
const FUNCTION_CASES: u32 = 100_000;

fn parse_range(text: &str) -> Result<GivenRange, String> {
    let parsed = text.split_once('=').and_then(|(path, range)| {
        let interval = match range.trim() {
            "unit" => None,
            range => Some(Interval::parse(range)?),
        };
        Some(GivenRange {
            path: path.trim().to_owned(),
            interval,
        })
    });
    parsed.ok_or_else(|| "expected NAME=LOW..HIGH, such as p=-2..2 or p.x=0..1, or NAME=unit".to_owned())
}

fn parse_property(text: &str) -> Result<Property, String> {
    Property::parse(text).map_err(|error| error.to_string())
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
    let interrupted = terminal.watch_interrupts("stopping; no files are written");
    let Some(path) = &args.shader else {
        return with_gpu(args, terminal, |gpu| study(args, gpu, &interrupted, terminal));
    };
    let input = find_one(path, "stress", terminal)?;
    let shader = Shader::load(&input, &args.language, Deadline::after(args.driver.timeout()));
    let checked = shader.require_single_pass()?;
    match args
        .subject(checked)
        .map_err(|why| format!("{}: {why}", shader.name))?
    {
        Subject::Intersection(signature) => with_gpu(args, terminal, |gpu| {
            examine(args, (&shader, checked), &signature, gpu, &interrupted, terminal)
        }),
        Subject::Any(interface) => examine_any(args, (&shader, checked), &interface, &interrupted, terminal),
    }
}

/// A function, and how it is examined.
enum Subject {
    /// As one that intersects a ray with a sphere.
    Intersection(Signature),
    /// By itself.
    Any(Interface),
}

impl Args {
    /// The settings for the axes of ray–surface intersection.
    fn settings(&self) -> Result<Settings, String> {
        let cases = self.cases.unwrap_or(STEP_CASES);
        if cases > MAX_STEP_CASES {
            let most = grouped(u64::from(MAX_STEP_CASES));
            return Err(format!(
                "at most {most} cases per step are possible; reduce --cases"
            ));
        }
        Ok(Settings {
            seed: self.seed,
            cases: cases as usize,
        })
    }

    /// The function to examine; otherwise the reason why there is none.
    fn subject(&self, checked: &Checked) -> Result<Subject, String> {
        let map: RoleMap = self.map.iter().cloned().collect();
        let is_any = !self.range.is_empty() || !self.property.is_empty();
        let Some(name) = &self.function else {
            if map.is_empty() && Signature::all(checked, &map).is_empty() {
                let names = Interface::names(checked);
                return Err(if names.is_empty() {
                    "the shader has no function to examine".to_owned()
                } else {
                    format!("choose a function with --function: {}", names.join(", "))
                });
            }
            let only = Signature::only(checked, &map).map_err(|why| why.to_string())?;
            return Ok(Subject::Intersection(only));
        };
        match Signature::recognize(checked, name, &map) {
            Ok(signature) if !is_any => Ok(Subject::Intersection(signature)),
            Err(why) if !map.is_empty() => Err(why.to_string()),
            _ => Interface::new(checked, name)
                .map(Subject::Any)
                .map_err(|why| why.to_string()),
        }
    }
}

/// Runs with the driver of a worker, if there is one.
fn with_gpu(
    args: &Args,
    terminal: &Terminal,
    run: impl FnOnce(Option<&mut Gpu>) -> Result<Exit, CliError>,
) -> Result<Exit, CliError> {
    let mut worker = worker(&args.driver, terminal)?;
    let mut renderer = worker
        .as_mut()
        .map(|worker| renderer(worker, args.driver.float()));
    run(renderer.as_mut().map(|renderer| renderer as &mut Gpu))
}

fn study(
    args: &Args,
    gpu: Option<&mut Gpu>,
    interrupted: &AtomicBool,
    terminal: &Terminal,
) -> Result<Exit, CliError> {
    let settings = args.settings()?;
    let subjects = formula::subjects();
    let bar = terminal.bar(stress::run_count(&subjects, gpu.is_some()), "formulas tested");
    let studied = stress::study(&subjects, gpu, settings, interrupted, || bar.inc(1));
    bar.finish_and_clear();
    let report = studied?;
    for line in report.summary() {
        terminal.result(&line);
    }
    for line in report.double_precision_summary() {
        terminal.detail(&line);
    }
    write_report(&report, output::json(&report), args, terminal)?;
    Ok(Exit::Success)
}

fn examine(
    args: &Args,
    (shader, checked): (&Shader, &Checked),
    signature: &Signature,
    gpu: Option<&mut Gpu>,
    interrupted: &AtomicBool,
    terminal: &Terminal,
) -> Result<Exit, CliError> {
    // Those of the dialect that was recognized.
    let options = glsl::Options {
        deadline: Deadline::after(args.driver.timeout()),
        ..checked.options()
    };
    let bar = terminal.bar(2 + u64::from(gpu.is_some()), "runs");
    let (text, settings) = (shader.text(checked), args.settings()?);
    let examined = function::examine(text, signature, &options, gpu, settings, interrupted, || {
        bar.inc(1);
    });
    bar.finish_and_clear();
    let findings = examined.map_err(|failure| format!("{}: {failure}", shader.name))?;
    for line in findings.summary(&signature.name) {
        terminal.result(&line);
    }
    write_report(&findings.report, output::json(&findings), args, terminal)?;
    Ok(if findings.mistake.is_some_and(|mistake| !mistake.recoverable) {
        Exit::ShaderFault
    } else {
        Exit::Success
    })
}

/// Examines a function by itself.
fn examine_any(
    args: &Args,
    (shader, checked): (&Shader, &Checked),
    interface: &Interface,
    interrupted: &AtomicBool,
    terminal: &Terminal,
) -> Result<Exit, CliError> {
    let bar = terminal.bar(accuracy::step_count(args.property.len()), "steps");
    let request = Request {
        ranges: &args.range,
        properties: &args.property,
        seed: args.seed,
        cases: args.cases.unwrap_or(FUNCTION_CASES) as usize,
        timeout: Some(args.driver.timeout()),
        interrupt: interrupted,
    };
    let text = shader.text(checked);
    let examined = accuracy::examine(text, checked, interface, request, &|| bar.inc(1));
    bar.finish_and_clear();
    let report = examined.map_err(|failure| {
        let help = match failure {
            AccuracyError::Run(RunError::Cpu(Failure::Timeout { .. } | Failure::TimeUp)) => {
                "; reduce --cases, or allow more time with --timeout"
            }
            _ => "",
        };
        format!("{}: {failure}{help}", shader.name)
    })?;
    let file = checked.tree[checked.main_image].at.span.file;
    let place = |cause: &Cause| {
        let span = Span::new(file, cause.start, cause.end);
        let line = shader.files.position(span).line;
        let expression = shader
            .files
            .text(span)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        format!("line {line}: `{}`", printable(&expression))
    };
    for line in report.summary(&place) {
        terminal.result(&line);
    }
    for line in report.details() {
        terminal.detail(&line);
    }
    let table = accuracy_output::csv(&report);
    let heat_maps = accuracy_output::heat_map(&report).map(|map| ("stress-pairs", map));
    write_results(
        (table, output::json(&report)),
        heat_maps.into_iter().collect(),
        args,
        terminal,
    )?;
    Ok(if report.violates() {
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

/// Writes a table, JSON and heat maps into the folder that the user names, if any.
fn write_results(
    (table, json): (String, String),
    heat_maps: Vec<(&'static str, HeatMap)>,
    args: &Args,
    terminal: &Terminal,
) -> Result<(), CliError> {
    let Some(folder) = &args.output else {
        return Ok(());
    };
    let path = |name: &str| path_name(&folder.join(name));
    let first_map = heat_maps
        .first()
        .map(|(name, _)| format!(". Heat maps: {}", path(&format!("{name}.svg"))));
    let mut files = vec![
        ("stress.csv".to_owned(), table.into_bytes()),
        ("stress.json".to_owned(), json.into_bytes()),
    ];
    for (name, heat_map) in heat_maps {
        files.push((format!("{name}.svg"), heat_map.svg().into_bytes()));
        let name = format!("{name}.png");
        let bytes = toyproof_image::encode(&heat_map.image(), name.as_ref())?;
        files.push((name, bytes));
    }
    for (name, bytes) in &files {
        terminal.write(&folder.join(name), bytes)?;
    }
    terminal.note(&format!(
        "All figures: {}{}",
        path("stress.csv"),
        first_map.unwrap_or_default()
    ));
    Ok(())
}

/// Writes the results on the axes of ray–surface intersection.
fn write_report(report: &Report, json: String, args: &Args, terminal: &Terminal) -> Result<(), CliError> {
    write_results(
        (output::csv(report), json),
        output::heat_maps(report),
        args,
        terminal,
    )
}
