//! `toyproof reduce`

use std::ffi::OsStr;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Code, Deadline, Severity, grouped, one_of, path_name, plural};
use toyproof_glsl as glsl;
use toyproof_gpu::Worker;
use toyproof_image::output::Originals;
use toyproof_image::{Frame, FrameInputs};
use toyproof_project::files::{self, Input, Texts};
use toyproof_reduce::fault::{CommandLine, Fault, FaultTester, Finding, Session, Subject, Wanted, find};
use toyproof_reduce::report::Report;
use toyproof_reduce::{Limits, Progress, Reduction, Tester as _, reduce};
use toyproof_translate::lower::Pass;
use toyproof_translate::{FloatMode, NAGA_VERSION};
use toyproof_verify::{Expected, Verdict};

use super::inputs::{
    DriverArgs, FrameArgs, LanguageArgs, check_output, frame_flags, parse_time_limit, shell_word,
};
use super::reference::{GivenReference, ReferenceArgs};
use super::scenes::{parse_scene, read_scene};
use super::shader::{Shader, find_one};
use super::{CliError, Exit, Terminal};

/// The sizes in which a shader is rendered, the smallest one first, if the user names none: the first one
/// counts in which it shows the fault.
const SIZES: [[u32; 2]; 4] = [[16, 9], [64, 36], [160, 90], [640, 360]];

/// The size in which a shader is compared with a reference.
const COMPARED_SIZE: [u32; 2] = [64, 36];

/// The largest number of loop iterations of a pixel: with as many in all pixels, the evaluator takes about a
/// second for 64×36 pixels.
const MAX_ITERATIONS: u32 = 1 << 16;

/// Reduce a shader to the smallest one that still shows a fault
///
/// A fault is an error, a warning, a refusal or panic of naga, a crash or hang of the driver, an image that
/// differs between the driver and the CPU, a verdict, or how a command ends. Without --fault or --command, it
/// is searched for.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof reduce waves.glsl
  toyproof reduce waves.glsl -o small.glsl --report issue.md
  toyproof reduce waves.glsl --fault warning=W0003
  toyproof reduce waves.glsl --command './has-fault.sh {}' --time-limit 10m")]
pub(super) struct Args {
    /// The shader: a file, or - for standard input
    shader: PathBuf,
    /// The file to write, also during the reduction, or - [default: NAME.reduced.glsl next to the shader]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The fault: naga, driver, toolchain, verdict, verdict=NAME, error=CODE or warning=CODE
    ///
    /// With `verdict=wrong`, the wrong image stays as it is.
    #[arg(long, value_name = "FAULT", value_parser = parse_fault)]
    fault: Option<Wanted>,
    /// A command that shows the fault by its exit status; `{}` stands for a file with the shader
    ///
    /// It runs in the shell, and not in the sandbox. The status is that for the original.
    #[arg(long, value_name = "COMMAND", conflicts_with = "fault")]
    command: Option<String>,
    /// Write the text of an issue for the project at fault, as Markdown
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// The number of candidates to test in parallel [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), allow_negative_numbers = true)]
    jobs: Option<u16>,
    /// The time limit of the reduction: seconds, or a number with a unit (90s, 10m) [default: none]
    ///
    /// The smallest shader so far is kept. Reducing it goes on.
    #[arg(long, value_name = "TIME", value_parser = parse_time_limit)]
    time_limit: Option<Duration>,
    /// Leave out toyproof's workaround for a fault of naga, to reduce a shader that shows it
    #[arg(long, value_name = "PASS", value_parser = parse_pass, hide_short_help = true)]
    without: Option<Pass>,
    #[command(flatten)]
    reference: ReferenceArgs,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
    #[command(flatten)]
    frame: FrameArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let start = Instant::now();
    let input = find_one(&args.shader, "reduce", terminal)?;
    let input = input.map_err(|error| CliError::new(error.to_string()))?;
    let output = args.output.clone().unwrap_or_else(|| beside(&input));
    let originals: Originals = input.path().into_iter().collect();
    // A reduction is continued in place.
    let output_to_check = Some(&output).filter(|_| !is_reduced(&input));
    for path in [output_to_check, args.report.as_ref()].into_iter().flatten() {
        check_output(path, &originals)?;
    }
    let (text, language) = read(args, &input)?;
    let wanted = match &args.command {
        Some(command) => Wanted::Command(CommandLine::new(command, &file_name(&input))?),
        None => args.fault.clone().unwrap_or(Wanted::Any),
    };
    let (frame, expected) = frame_and_expected(args, terminal)?;
    let sizes = match (&expected, args.frame.size) {
        (Some(_), _) => vec![frame.size],
        (None, Some(size)) => vec![size],
        (None, None) => SIZES.to_vec(),
    };
    // naga needs a worker even where no driver does.
    let make_worker = || -> Option<Worker> {
        let worker = args.driver.worker().ok()?;
        let worker = worker.map(Worker::with_plain_code_for_small_images);
        worker.or_else(|| args.driver.translator().ok())
    };
    let mut subject = Subject {
        language,
        frame,
        expected: expected.as_ref(),
        float: float(args, &wanted),
        without: args.without,
        max_iterations: MAX_ITERATIONS,
        timeout: args.driver.timeout(),
        make_worker: &make_worker,
    };
    let spinner = terminal.spinner(&input.name());
    let found = find(&mut subject, &sizes, &wanted, &text);
    spinner.finish_and_clear();
    let found = found.map_err(|error| not_found(&error, &input, &wanted))?;
    terminal.note(&format!("fault: {found}"));
    let reduction = reduced(args, (&text, &output), &subject, &found.fault, terminal)?;
    if !FaultTester::new(&subject, &found.fault, &text).shows_fault(&reduction.text) {
        return Err(lost(&input, &wanted));
    }
    if output == Path::new("-") {
        terminal.bytes(reduction.text.as_bytes())?;
    }
    if let Some(path) = &args.report {
        let written = if output == Path::new("-") {
            PathBuf::from(file_name(&input))
        } else {
            output
        };
        let text = report(args, &subject, &found.fault, (&written, &reduction.text))?;
        terminal.write(path, text.as_bytes())?;
    }
    let summary = summary(
        &input.name(),
        [&text, &reduction.text],
        reduction.tries,
        start.elapsed(),
    );
    if args.output.as_deref() == Some(Path::new("-")) {
        terminal.note(&summary);
    } else {
        terminal.result(&summary);
    }
    if !reduction.is_complete {
        terminal.warn("the reduction was ended before it was complete\nhelp: reduce the result to go on");
    }
    Ok(Exit::Success)
}

/// The float mode: what naga gets is shorter without the functions that strict runs expand.
fn float(args: &Args, wanted: &Wanted) -> FloatMode {
    let default = if *wanted == Wanted::Naga {
        FloatMode::Fast
    } else {
        FloatMode::Strict
    };
    args.driver.explicit_float().unwrap_or(default)
}

/// Reduces the text, and writes each smaller one to the output, so that an interrupt loses nothing.
fn reduced(
    args: &Args,
    (text, output): (&str, &Path),
    subject: &Subject,
    fault: &Fault,
    terminal: &Terminal,
) -> Result<Reduction, CliError> {
    let interrupted = terminal.watch_interrupts("the smallest shader so far is kept");
    let jobs = args.jobs.map(usize::from);
    let limits = Limits {
        threads: jobs.unwrap_or_else(|| thread::available_parallelism().map_or(1, NonZero::get)),
        deadline: args.time_limit.map(Deadline::after).unwrap_or_default(),
        stop: Some(&interrupted),
    };
    let is_file = output != Path::new("-");
    if is_file {
        terminal.write(output, text.as_bytes())?;
    }
    let spinner = terminal.spinner("reducing");
    let start = Instant::now();
    let mut failed = None;
    let mut on_progress = |progress: &Progress| {
        let rate = progress.tries as f64 / start.elapsed().as_secs_f64().max(1e-3);
        let Progress { text, tries, .. } = progress;
        spinner.set_message(format!("{}, {tries} tries, {rate:.0}/s", size(text)));
        if progress.is_smaller && is_file {
            failed = terminal.write(output, text.as_bytes()).err();
        }
        if failed.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let make_tester = || FaultTester::new(subject, fault, text);
    let reduction = reduce(text, &subject.language, &limits, &make_tester, &mut on_progress);
    spinner.finish_and_clear();
    if let Some(error) = failed {
        return Err(error);
    }
    let reduction = reduction.map_err(|error| {
        let help = "a fault that occurs at random cannot be reduced";
        CliError::new(format_args!("{error} when it is tested again")).with_help(help)
    })?;
    Ok(reduction)
}

/// The text to reduce, with includes and the common tab, and how it is checked.
fn read(args: &Args, input: &Input) -> Result<(String, glsl::Options), CliError> {
    let found = Ok(input.clone());
    let shader = Shader::load(&found, &args.language, Deadline::after(args.driver.timeout()));
    if let Some(reason) = shader.unrendered() {
        let error = CliError::new(format_args!("{}: {reason}", shader.name));
        return Err(error.with_help("reduce the text of the pass at fault alone"));
    }
    if let Ok(checked) = shader.image() {
        let options = glsl::Options {
            lenient: checked.lenient,
            ..checked.options()
        };
        return Ok((shader.text(checked).to_owned(), options));
    }
    match files::read(input) {
        Ok(Texts::Shader(file)) => Ok((file.text().to_owned(), args.language.options(Deadline::default()))),
        Ok(Texts::Project(_)) => Err(shader.require_image().err().unwrap_or_else(CliError::silent)),
        Err(error) => Err(CliError::new(format_args!(
            "{}: {}",
            error.name(),
            error.reason()
        ))),
    }
}

/// The frame, and the reference in it.
fn frame_and_expected(args: &Args, terminal: &Terminal) -> Result<(Frame, Option<Expected>), CliError> {
    let inputs = args.frame.inputs();
    let mut frame = inputs.load()?;
    if !args.reference.is_given() {
        return Ok((frame, None));
    }
    frame.size = inputs.size.unwrap_or(COMPARED_SIZE);
    let timeout = args.driver.timeout();
    if let Some(given) = GivenReference::read(&args.reference, &args.language, timeout)? {
        given.resize(&mut frame, inputs.size)?;
        let expected = given.expected([&frame].into_iter(), timeout, terminal)?.pop();
        return Ok((frame, expected));
    }
    let scene = args.reference.scene.as_deref().map(read_scene).transpose()?;
    let scene = scene.map(parse_scene).transpose()?;
    let expected = scene.map(|mut scene| {
        scene.film.size = frame.size;
        Expected::from_scene(scene, &frame)
    });
    Ok((frame, expected))
}

/// The error of a shader that does not show the fault.
fn not_found(error: &dyn std::fmt::Display, input: &Input, wanted: &Wanted) -> CliError {
    let error = CliError::new(format_args!("{}: {error}", input.name()));
    error.with_help(match wanted {
        Wanted::Any => "name the fault with --fault, or a command that shows it with --command",
        Wanted::Verdict(_) => "name the reference with --scene or --reference",
        Wanted::Command(_) => "run the command on the shader to see why",
        _ => "without --fault, a fault is searched for",
    })
}

/// The error of a reduced shader that does not show the fault any more.
fn lost(input: &Input, wanted: &Wanted) -> CliError {
    let error = CliError::new(format_args!(
        "{}: the reduced shader does not show the fault when it is tested again",
        input.name()
    ));
    error.with_help(match wanted {
        Wanted::Command(_) => {
            "commands run in parallel, so each must write files of its own, such as `{}.spv`; or use --jobs 1"
        }
        _ => "a fault that occurs at random cannot be reduced",
    })
}

/// The text of an issue about the reduced shader.
fn report(
    args: &Args,
    subject: &Subject,
    fault: &Fault,
    (file, text): (&Path, &str),
) -> Result<String, CliError> {
    let mut session = Session::new(subject);
    let finding = session.find(&fault.wanted(), text)?;
    let tools = session.tools(&finding.fault, text);
    Ok(Report {
        shader: text,
        file_name: &file_name_of(file),
        finding: &finding,
        frame: &subject.frame,
        command: &command_line(args, &finding, subject.frame.size, file),
        output: tools.output.as_deref(),
        lowered: tools.lowered.as_deref(),
        spirv: tools.spirv.as_deref(),
        device: tools.device.as_deref(),
        without: args.without.map(pass_name).as_deref(),
        naga: NAGA_VERSION,
        system: &format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
    }
    .markdown())
}

/// The command that shows the fault with toyproof.
fn command_line(args: &Args, finding: &Finding, size: [u32; 2], file: &Path) -> String {
    let name = shell_word(&path_name(file));
    let mut words = match (args.without, &finding.fault) {
        (Some(pass), fault) => {
            let kind = if matches!(fault, Fault::Naga { .. }) {
                "naga"
            } else {
                "toolchain"
            };
            let pass = pass_name(pass);
            vec![format!("toyproof reduce {name} --fault {kind} --without {pass}")]
        }
        (None, _) => vec![format!("toyproof check {name}")],
    };
    let is_rendered = !matches!(finding.fault, Fault::Naga { .. } | Fault::Diagnostic { .. });
    words.extend(frame_flags(&FrameInputs {
        size: is_rendered.then_some(size),
        ..args.frame.inputs()
    }));
    words.extend(args.reference.flags());
    words.extend(args.language.flags());
    words.join(" ")
}

/// The result in one line.
fn summary(name: &str, [before, after]: [&str; 2], tries: u64, time: Duration) -> String {
    let lines = |text: &str| text.lines().count() as u64;
    format!(
        "reduced {name}: {} → {} bytes, {} → {} {}, {} s, {} {}",
        grouped(before.len() as u64),
        grouped(after.len() as u64),
        grouped(lines(before)),
        grouped(lines(after)),
        plural(lines(after), "line", "lines"),
        time.as_secs(),
        grouped(tries),
        plural(tries, "try", "tries")
    )
}

fn size(text: &str) -> String {
    let lines = text.lines().count() as u64;
    format!(
        "{} bytes, {} {}",
        grouped(text.len() as u64),
        grouped(lines),
        plural(lines, "line", "lines")
    )
}

/// Whether a shader is the result of a reduction, by its name.
fn is_reduced(input: &Input) -> bool {
    let stem = input.path().and_then(Path::file_stem);
    stem.is_some_and(|stem| Path::new(stem).extension() == Some(OsStr::new("reduced")))
}

/// The default output.
fn beside(input: &Input) -> PathBuf {
    match input.path() {
        Some(path) if is_reduced(input) => path.to_owned(),
        Some(path) => path.with_extension("reduced.glsl"),
        None => "-".into(),
    }
}

/// The name of a file with the shader, whose extension is that of the input.
fn file_name(input: &Input) -> String {
    input
        .path()
        .filter(|path| path.is_file())
        .map_or_else(|| "shader.glsl".to_owned(), file_name_of)
}

fn file_name_of(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| path_name(Path::new(name)))
}

fn parse_fault(text: &str) -> Result<Wanted, String> {
    let expected = "expected naga, driver, toolchain, verdict, verdict=NAME, error=CODE or warning=CODE";
    let code = |code: &str, severity| {
        let code = Code::parse(&code.to_uppercase());
        code.filter(|code| code.severity() == severity)
            .map(Wanted::Diagnostic)
            .ok_or("expected the code of an error (E0123) or of a warning (W0123)".to_owned())
    };
    match text.split_once('=') {
        None => match text {
            "naga" => Ok(Wanted::Naga),
            "driver" => Ok(Wanted::Driver),
            "toolchain" => Ok(Wanted::Toolchain),
            "verdict" => Ok(Wanted::Verdict(None)),
            _ => Err(expected.to_owned()),
        },
        Some(("error", text)) => code(text, Severity::Error),
        Some(("warning", text)) => code(text, Severity::Warning),
        Some(("verdict", text)) => {
            let named = VERDICTS.into_iter().find(|verdict| verdict.to_string() == text);
            let names: Vec<_> = VERDICTS.iter().map(ToString::to_string).collect();
            named
                .map(|verdict| Wanted::Verdict(Some(verdict)))
                .ok_or_else(|| format!("expected the verdict {}", one_of(&names)))
        }
        Some(_) => Err(expected.to_owned()),
    }
}

/// The verdicts on single shaders that are a fault.
const VERDICTS: [Verdict; 5] = [
    Verdict::Invalid,
    Verdict::Timeout,
    Verdict::Wrong,
    Verdict::Unstable,
    Verdict::Inconclusive,
];

fn parse_pass(text: &str) -> Result<Pass, String> {
    let named = Pass::ALL.iter().find(|pass| pass_name(**pass) == text);
    named.copied().ok_or_else(|| {
        let names: Vec<_> = Pass::ALL.iter().map(|pass| pass_name(*pass)).collect();
        format!("expected {}", one_of(&names))
    })
}

/// The name of a pass in kebab case.
fn pass_name(pass: Pass) -> String {
    let mut name = String::new();
    for c in format!("{pass:?}").chars() {
        if c.is_ascii_uppercase() && !name.is_empty() {
            name.push('-');
        }
        name.push(c.to_ascii_lowercase());
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_parsed() {
        assert_eq!(parse_fault("naga"), Ok(Wanted::Naga));
        assert_eq!(
            parse_fault("verdict=wrong"),
            Ok(Wanted::Verdict(Some(Verdict::Wrong)))
        );
        assert_eq!(
            parse_fault("warning=w0003"),
            Ok(Wanted::Diagnostic(Code::parse("W0003").unwrap()))
        );
        for bad in [
            "error=W0003",
            "warning=E0001",
            "verdict=ok",
            "crash",
            "naga=1",
            "error=",
        ] {
            assert!(parse_fault(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn passes_have_names_in_kebab_case() {
        assert_eq!(parse_pass("short-circuit"), Ok(Pass::ShortCircuit));
        assert!(parse_pass("ShortCircuit").is_err());
    }

    #[test]
    fn the_summary_is_one_line() {
        let text = summary("a.glsl", ["a\nb\n", "a\n"], 1, Duration::from_millis(1500));
        assert_eq!(text, "reduced a.glsl: 4 → 2 bytes, 2 → 1 line, 1 s, 1 try");
    }
}
