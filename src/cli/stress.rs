//! `toyproof stress`

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use toyproof_diagnostic::{Deadline, path_name};
use toyproof_gpu::Worker;
use toyproof_lab::stress::function::{self, Findings, Role, RoleMap, Signature};
use toyproof_lab::stress::{self, Report, Settings, formula};

use super::inputs::{DriverArgs, LanguageArgs};
use super::shader::{Shader, Unusable, find};
use super::{Exit, Terminal};

/// Find out where formulas for rays and surfaces fail: numerical stability at the extremes
///
/// Ways to intersect a ray with a sphere and with a quadric, and to start a ray from a surface, are taken to
/// their limits in f32 and in f64, and held against exact arithmetic. With a shader, that is done to a
/// function of its own. What is written: stress.csv, stress.json, and heat maps.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  toyproof stress -o stress\n  \
                        toyproof stress glsl/02-sphere.glsl --function intersectSphere -o mine\n  \
                        toyproof stress mine.glsl --function meet --map p=origin,v=direction,ball.at=center -o mine\n\n\
                        Exit code: 0; 1 if a function makes a known mistake that its callers cannot make up for; 2 if there was trouble.")]
pub(super) struct Args {
    /// A shader whose function is to be tested
    shader: Option<PathBuf>,
    /// The function: it takes a ray and a sphere, and gives t [default: the one that does]
    #[arg(long, value_name = "NAME", requires = "shader")]
    function: Option<String>,
    /// What its parameters are, where that is not clear from their names: origin, direction, center, radius,
    /// sphere (center and radius in a vec4), tmin, tmax; and of what it gives: t, second, hit. `return`
    /// is what it returns
    #[arg(long, value_name = "PATH=ROLE,…", value_delimiter = ',', value_parser = parse_role, requires = "shader")]
    map: Vec<(String, Role)>,
    /// Where the results go
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// What the cases are drawn from: the same seed draws the same
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = parse_seed, allow_negative_numbers = true)]
    seed: u64,
    /// Cases for each step of each axis
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(1..=100_000), allow_negative_numbers = true)]
    cases: u32,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

fn parse_seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("a seed is a whole number from 0 to {}", u64::MAX))
}

fn parse_role(text: &str) -> Result<(String, Role), String> {
    let parsed = text.split_once('=').and_then(|(path, role)| {
        let role = Role::named(role.trim())?;
        Some((path.trim().to_owned(), role))
    });
    parsed.ok_or_else(|| {
        "say what is what, as in ray.origin=origin; there are origin, direction, center, radius, sphere, tmin, tmax, t, second and hit"
            .to_owned()
    })
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let mut worker = match worker(&args.driver, terminal) {
        Ok(worker) => worker,
        Err(exit) => return exit,
    };
    let interrupted = terminal.watch_interrupts("stopping; nothing is written");
    match &args.shader {
        Some(shader) => examine(args, shader, worker.as_mut(), &interrupted, terminal),
        None => study(args, worker.as_mut(), &interrupted, terminal),
    }
}

impl Args {
    fn settings(&self) -> Settings {
        Settings {
            seed: self.seed,
            cases: self.cases as usize,
            float: self.driver.float(),
        }
    }
}

fn study(args: &Args, worker: Option<&mut Worker>, interrupted: &AtomicBool, terminal: &Terminal) -> Exit {
    let subjects = formula::subjects();
    let bar = terminal.bar(stress::run_count(&subjects, worker.is_some()), "stress");
    let studied = stress::study(&subjects, worker, args.settings(), interrupted, || bar.inc(1));
    bar.finish_and_clear();
    match studied {
        Ok(report) => {
            print_report(&report, terminal);
            write_results(&report, report.json(), args, terminal)
        }
        Err(failure) => {
            terminal.error(failure);
            Exit::Error
        }
    }
}

fn print_report(report: &Report, terminal: &Terminal) {
    for line in report.breakdown_lines() {
        terminal.result(&line);
    }
}

fn examine(
    args: &Args,
    path: &Path,
    worker: Option<&mut Worker>,
    interrupted: &AtomicBool,
    terminal: &Terminal,
) -> Exit {
    let found = find(&[path.to_owned()], terminal);
    let [input] = found.as_slice() else {
        terminal.error(format_args!(
            "{} holds several shaders; stress takes one",
            path_name(path)
        ));
        return Exit::Error;
    };
    let shader = Shader::load(input, &args.language, Deadline::after(args.driver.timeout()));
    let checked = match &shader.checked {
        Ok(checked) => checked,
        Err(Unusable::Invalid(diagnostics)) => {
            terminal.diagnostics(diagnostics, &shader.files);
            return Exit::ShaderFault;
        }
        Err(Unusable::Unreadable(error)) => {
            terminal.error(error);
            return Exit::Error;
        }
    };
    let map: RoleMap = args.map.iter().cloned().collect();
    let signature = match &args.function {
        Some(name) => Signature::recognize(checked, name, &map),
        None => Signature::only(checked, &map),
    };
    let signature = match signature {
        Ok(signature) => signature,
        Err(why) => {
            terminal.error(format_args!("{}: {why}", shader.name));
            return Exit::Error;
        }
    };
    let subject = function::subject(
        shader.text(checked),
        &signature,
        args.language.options(Deadline::after(args.driver.timeout())),
    );
    let bar = terminal.bar(2 + u64::from(worker.is_some()), &signature.name);
    let examined = function::examine(&subject, &signature, worker, args.settings(), interrupted, || {
        bar.inc(1);
    });
    bar.finish_and_clear();
    match examined {
        Ok(findings) => {
            print_report(&findings.report, terminal);
            print_findings(&signature, &findings, terminal);
            let kept = write_results(&findings.report, findings.json(), args, terminal);
            kept.max(if findings.mistake.is_some_and(|mistake| !mistake.recoverable) {
                Exit::ShaderFault
            } else {
                Exit::Success
            })
        }
        Err(failure) => {
            terminal.error(format_args!("{}: {failure}", shader.name));
            Exit::Error
        }
    }
}

fn print_findings(signature: &Signature, findings: &Findings, terminal: &Terminal) {
    let name = &signature.name;
    if let Some(mistake) = &findings.mistake {
        terminal.result(&format!("{name} {} ({})", mistake.description, mistake.name));
    }
    match &findings.example {
        None => terminal.result(&format!("{name} is right wherever it was asked")),
        Some(example) => {
            terminal.result(&format!("it fails at {}, for example with", example.step));
            for line in &example.assignments {
                terminal.result(&format!("    {line}"));
            }
            terminal.result(&format!(
                "where {} is right and {} came",
                example.expected, example.actual
            ));
        }
    }
}

/// Creates a worker that has a driver; none where only the evaluator is available.
fn worker(driver: &DriverArgs, terminal: &Terminal) -> Result<Option<Worker>, Exit> {
    let fail = |error: &dyn std::fmt::Display| {
        terminal.error(error);
        Exit::Error
    };
    let Some(mut worker) = driver.worker().map_err(|error| fail(&error))? else {
        return Ok(None);
    };
    match worker.probe() {
        Ok(_) => Ok(Some(worker)),
        Err(failure) if failure.is_without_driver() && driver.may_fall_back() => {
            terminal.warn(format_args!("{failure}; only the CPU is tested"));
            Ok(None)
        }
        Err(failure) => Err(fail(&failure)),
    }
}

fn write_results(report: &Report, json: String, args: &Args, terminal: &Terminal) -> Exit {
    let mut files = vec![
        ("stress.csv".to_owned(), report.csv().into_bytes()),
        ("stress.json".to_owned(), json.into_bytes()),
    ];
    for (name, heat_map) in report.heat_maps() {
        let name = format!("{name}.png");
        match toyproof_image::encode(&heat_map, name.as_ref()) {
            Ok(bytes) => files.push((name, bytes)),
            Err(error) => {
                terminal.error(error);
                return Exit::Error;
            }
        }
    }
    let kept = files
        .iter()
        .all(|(name, bytes)| terminal.write(&args.output.join(name), bytes));
    if kept { Exit::Success } else { Exit::Error }
}
