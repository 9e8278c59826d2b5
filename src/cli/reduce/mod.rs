//! `toyproof reduce`

mod faults;
mod original;
mod output;

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Deadline, grouped, path_name, plural};
use toyproof_gpu::Worker;
use toyproof_image::{FRAME_RATE, Frame, FrameInputs};
use toyproof_project::files::Input;
use toyproof_reduce::fault::{CommandLine, Fault, FaultTester, Finding, Session, Subject, Wanted};
use toyproof_reduce::report::Report;
use toyproof_reduce::{Limits, PartsReduction, PartsTester as _, Progress, reduce_parts};
use toyproof_translate::lower::Pass;
use toyproof_translate::{FloatMode, NAGA_VERSION};
use toyproof_verify::Expected;
use toyproof_verify::project::bind::{accumulate, default_frame};

use self::faults::{parse_fault, parse_pass, pass_name};
use self::original::{Attempt, Original};
use self::output::{Output, is_reduced};
use super::inputs::{DriverArgs, FrameArgs, LanguageArgs, frame_flags, parse_time_limit, shell_word};
use super::reference::{GivenReference, ReferenceArgs};
use super::scenes::{parse_scene, read_scene};
use super::shader::find_one;
use super::{CliError, Exit, Terminal};

/// The sizes in which a shader is rendered, the smallest one first, if the user names none: the first one
/// counts in which it shows the fault.
const SIZES: [[u32; 2]; 4] = [[16, 9], [64, 36], [160, 90], [640, 360]];

/// The size in which a shader is compared with a reference.
const COMPARED_SIZE: [u32; 2] = [64, 36];

/// The largest number of loop iterations of a pixel: with as many in all pixels, the evaluator takes about a
/// second for 64×36 pixels.
const MAX_ITERATIONS: u32 = 1 << 16;

/// Reduce a shader or a project to the smallest one that still shows a fault
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
    /// The shader: a file, a project, or - for standard input
    shader: PathBuf,
    /// The file to write, also during the reduction, or - [default: NAME.reduced.glsl next to the shader]
    ///
    /// Of a project whose fault no pass shows alone, the result is a folder [default: NAME.reduced].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The fault: naga, driver, toolchain, verdict, verdict=NAME, error=CODE or warning=CODE
    ///
    /// With `verdict=wrong`, the wrong image stays as it is.
    #[arg(long, value_name = "FAULT", value_parser = parse_fault)]
    fault: Option<Wanted>,
    /// A command that shows the fault by its exit status; `{}` stands for the shader's file
    ///
    /// For a project, `{}` is its folder. The command runs in the shell, and not in the sandbox. The status
    /// is that for the original.
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
    let original = Original::read(args, &input)?;
    let wanted = match &args.command {
        Some(command) => Wanted::Command(CommandLine::new(command, &name_for_command(&input))?),
        None => args.fault.clone().unwrap_or(Wanted::Any),
    };
    let (frame, expected) = frame_and_expected(args, original.is_project, terminal)?;
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
        language: args.language.options(Deadline::default()),
        project: None,
        frame,
        expected: expected.as_ref(),
        float: float(args, &wanted),
        without: args.without,
        max_iterations: MAX_ITERATIONS,
        timeout: args.driver.timeout(),
        make_worker: &make_worker,
    };
    let spinner = terminal.spinner(&input.name());
    let found = original.find(&mut subject, &sizes, &wanted);
    spinner.finish_and_clear();
    let (attempt, found) = found.map_err(|error| not_found(&error, &input, &wanted))?;
    terminal.note(&match attempt.pass {
        Some(pass) => format!("fault of {pass} alone: {found}"),
        None => format!("fault: {found}"),
    });
    let output = Output::new(args, &input, attempt)?;
    let reduction = reduced(args, (attempt, &output), &subject, &found.fault, terminal)?;
    let texts = &reduction.texts;
    if !FaultTester::new(&subject, &found.fault, &attempt.texts()).show_fault(texts) {
        return Err(lost(&input, &wanted));
    }
    output.finish(attempt, texts, &input, terminal)?;
    if let Some(path) = &args.report {
        let written = if output.is_stream() {
            PathBuf::from(name_for_command(&input))
        } else {
            output.path().to_owned()
        };
        let text = report(args, &subject, &found.fault, (&written, texts))?;
        terminal.write(path, text.as_bytes())?;
    }
    let summary = summary(
        &input.name(),
        [&attempt.texts(), texts],
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

/// Reduces the texts, and writes smaller ones to the output, so that an interrupt loses nothing.
fn reduced(
    args: &Args,
    (attempt, output): (&Attempt, &Output),
    subject: &Subject,
    fault: &Fault,
    terminal: &Terminal,
) -> Result<PartsReduction, CliError> {
    let interrupted = terminal.watch_interrupts("the smallest shader so far is kept");
    let jobs = args.jobs.map(usize::from);
    let limits = Limits {
        threads: jobs.unwrap_or_else(|| thread::available_parallelism().map_or(1, NonZero::get)),
        deadline: args.time_limit.map(Deadline::after).unwrap_or_default(),
        stop: Some(&interrupted),
    };
    let original = attempt.texts();
    output.write(attempt, &original, terminal)?;
    let spinner = terminal.spinner("reducing");
    let start = Instant::now();
    let mut failed = None;
    let mut on_progress = |texts: &[Option<String>], progress: &Progress| {
        let tries = progress.tries;
        let rate = tries as f64 / start.elapsed().as_secs_f64().max(1e-3);
        spinner.set_message(format!("{}, {tries} tries, {rate:.0}/s", size(texts)));
        if progress.is_smaller {
            failed = output.write(attempt, texts, terminal).err();
        }
        if failed.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let make_tester = || FaultTester::new(subject, fault, &original);
    let reduction = reduce_parts(&attempt.parts, &limits, &make_tester, &mut on_progress);
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

/// The frame, and the reference in it. A project is tested in the frame in which it is checked.
fn frame_and_expected(
    args: &Args,
    is_project: bool,
    terminal: &Terminal,
) -> Result<(Frame, Option<Expected>), CliError> {
    let inputs = args.frame.inputs();
    let mut frame = inputs.load()?;
    let timeout = args.driver.timeout();
    if args.reference.is_given() {
        frame.size = inputs.size.unwrap_or(COMPARED_SIZE);
    }
    if let Some(given) = GivenReference::read(&args.reference, &args.language, timeout)? {
        given.resize(&mut frame, inputs.size)?;
        let expected = given.expected([&frame].into_iter(), timeout, terminal)?.pop();
        return Ok((frame, expected));
    }
    let scene = args.reference.scene.as_deref().map(read_scene).transpose()?;
    let scene = scene.map(parse_scene).transpose()?;
    if is_project && !args.frame.is_moment_given() {
        let number = default_frame(scene.as_ref());
        frame = frame.at(number, number as f32 / FRAME_RATE);
    }
    let expected = scene.map(|mut scene| {
        scene.film.size = frame.size;
        if is_project {
            accumulate(&mut scene, frame.frame);
        }
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
    (file, texts): (&Path, &[Option<String>]),
) -> Result<String, CliError> {
    let mut session = Session::new(subject);
    let finding = session.find(&fault.wanted(), texts)?;
    let tools = session.tools(&finding.fault, texts);
    let folder = subject.project.as_ref().map(|project| project.folder(texts));
    Ok(Report {
        shader: texts[0].as_deref().unwrap_or_default(),
        folder: folder.as_deref(),
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
fn summary(name: &str, texts: [&[Option<String>]; 2], tries: u64, time: Duration) -> String {
    let [before, after] = texts.map(bytes_and_lines);
    format!(
        "reduced {name}: {} → {} bytes, {} → {} {}, {} s, {} {}",
        grouped(before[0]),
        grouped(after[0]),
        grouped(before[1]),
        grouped(after[1]),
        plural(after[1], "line", "lines"),
        time.as_secs(),
        grouped(tries),
        plural(tries, "try", "tries")
    )
}

/// The size of texts together.
fn bytes_and_lines(texts: &[Option<String>]) -> [u64; 2] {
    let texts = || texts.iter().flatten();
    [
        texts().map(|text| text.len() as u64).sum(),
        texts().map(|text| text.lines().count() as u64).sum(),
    ]
}

fn size(texts: &[Option<String>]) -> String {
    let [bytes, lines] = bytes_and_lines(texts);
    format!(
        "{} bytes, {} {}",
        grouped(bytes),
        grouped(lines),
        plural(lines, "line", "lines")
    )
}

/// The name of the file or folder that a command gets.
fn name_for_command(input: &Input) -> String {
    input
        .path()
        .filter(|path| path.exists())
        .map_or_else(|| "shader.glsl".to_owned(), file_name_of)
}

fn file_name_of(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| path_name(Path::new(name)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_is_one_line() {
        let [before, after] = ["a\nb\n", "a\n"].map(|text| [Some(text.to_owned()), None]);
        let text = summary("a.glsl", [&before, &after], 1, Duration::from_millis(1500));
        assert_eq!(text, "reduced a.glsl: 4 → 2 bytes, 2 → 1 line, 1 s, 1 try");
    }
}
