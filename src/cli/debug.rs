//! `toyproof debug`

use std::path::PathBuf;
use std::time::{Duration, Instant};

use toyproof_diagnostic::Deadline;
use toyproof_eval::Failure;
use toyproof_eval_native::Program;
use toyproof_explain::departure;
use toyproof_explain::trail::follow_back;
use toyproof_glsl::Checked;
use toyproof_image::{FRAME_RATE, Frame, FrameInputs};
use toyproof_project::files::{Input, ReadError};
use toyproof_project::{CompiledProject, PassKind};
use toyproof_report as report;
use toyproof_scene::{FrameTime, Scene};
use toyproof_tracer::Tracer;
use toyproof_verify::project::bind::{accumulate, default_frame};
use toyproof_verify::{self as verify, debug};

use super::check::{Scenes, assignment_beside, read_assignment};
use super::inputs::{Format, FrameArgs, LanguageArgs, parse_time_limit, resized};
use super::project::{pass_shader, rendering};
use super::reference::{GivenReference, ReferenceArgs};
use super::run::{evaluation_error, parse_pass};
use super::shader::{Shader, find_one};
use super::{CliError, Exit, Terminal};

/// Trace one pixel of a shader line by line, in f32 beside f64
///
/// Pixel coordinates are those of ShaderToy: x from the left, y from the bottom, starting at 0.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof debug mine.glsl --pixel 320,180
  toyproof debug mine.glsl --pixel 320,180 --scene 03-shading -v
  toyproof debug mine.glsl --pixel 320,180 --reference solution.glsl
  toyproof debug mine.glsl --pixel 320,180 --assignment shadows")]
pub(super) struct Args {
    /// The shader: a file, or - for standard input
    shader: PathBuf,
    /// The pixel: x from the left, y from the bottom, starting at 0
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel, allow_hyphen_values = true)]
    pixel: [u32; 2],
    /// The pass of a project: `image`, or `buffer-a`, `buffer-b` and so on [default: image]
    #[arg(long, value_name = "PASS", value_parser = parse_pass, hide_short_help = true)]
    pass: Option<PassKind>,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// The assignment (.toml), or its folder: its reference and its first frame, unless flags name another frame
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "reference"])]
    assignment: Option<PathBuf>,
    /// The format of standard output: `human` shows what each line stores and decides (-v: every
    /// subexpression), `json` everything
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output", hide_possible_values = true)]
    format: Format,
    #[command(flatten)]
    language: LanguageArgs,
    /// The time limit: seconds, or a number with a unit (500ms, 2m)
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = parse_time_limit)]
    timeout: Duration,
    #[command(flatten)]
    frame: FrameArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let input = find_one(&args.shader, "debug", terminal)?;
    let beside = || {
        input
            .as_ref()
            .ok()
            .filter(|_| !args.reference.is_given())
            .and_then(assignment_beside)
    };
    let assignment = match args.assignment.clone().or_else(beside) {
        Some(path) => Some(read_assignment(&path)?.1),
        None => None,
    };
    let frames = assignment.as_ref().filter(|_| !args.frame.is_given());
    let inputs = match frames {
        Some(assignment) => resized(&assignment.frames, args.frame.size).swap_remove(0),
        None => args.frame.inputs(),
    };
    let uniforms = assignment.as_ref().map(|assignment| &assignment.uniforms[..]);
    let language = args.language.with_uniforms(&inputs.uniforms);
    let language = language.with_uniforms(uniforms.unwrap_or_default());
    let reference = match &assignment {
        Some(assignment) => ReferenceArgs::of(assignment),
        None => args.reference.clone(),
    };
    let given = GivenReference::read(&reference, &language, args.timeout)?;
    let (frame, scene) = frame_and_scene(&inputs, &reference, &input, given.as_ref())?;
    let shader = Shader::load(&input, &language, Deadline::after(args.timeout));
    terminal.diagnostics(&shader.lints.warnings, &shader.files);
    let kind = args.pass.unwrap_or(PassKind::Image);
    if kind == PassKind::Image {
        check_pixel(args.pixel, kind, frame.size)?;
    }
    let image = shader.require_image()?;
    if let Some(passes) = shader.project()
        && (shader.has_passes || kind != PassKind::Image)
    {
        return print_pass(args, (&shader, passes), kind, frame, scene, terminal);
    }
    if kind != PassKind::Image {
        return Err(CliError::new(format_args!(
            "{} is no project with buffers",
            shader.name
        )));
    }
    print_trace(
        args,
        (&shader, image),
        &frame,
        Reference { scene, given },
        terminal,
    )
}

/// Prints the trace of the pixel of a pass of a project, and the origin of its difference.
fn print_pass(
    args: &Args,
    (shader, passes): (&Shader, &CompiledProject),
    kind: PassKind,
    mut frame: Frame,
    scene: Option<Scene>,
    terminal: &Terminal,
) -> Result<Exit, CliError> {
    let Some(at) = passes.project.passes.iter().position(|pass| pass.kind == kind) else {
        let error = CliError::new(format_args!("{}: there is no {kind}", shader.name));
        return Err(error.with_help("name one of its passes with --pass"));
    };
    if !args.frame.is_moment_given() && args.assignment.is_none() {
        let number = default_frame(scene.as_ref());
        frame = frame.at(number, number as f32 / FRAME_RATE);
    }
    let failed = |failure| match failure {
        verify::Failure::Cpu(failure) => evaluation_error(&failure, shader),
        other => CliError::new(format_args!("{}: {other}", shader.name)),
    };
    let rendering = rendering(passes, kind, frame.size).map_err(failed)?;
    check_pixel(args.pixel, kind, rendering.graph.size(kind.target(), frame.size))?;
    let spinner = terminal.spinner(&shader.name);
    let pass_shader = pass_shader(passes, &rendering);
    let trail = follow_back(&pass_shader, kind.target(), args.pixel, &frame, args.timeout);
    spinner.finish_and_clear();
    let trail = trail.map_err(failed)?;
    let scene = scene.filter(|_| kind == PassKind::Image).map(|mut scene| {
        accumulate(&mut scene, frame.frame);
        scene
    });
    let expected = scene.map(|scene| expected_color(scene, &frame, args.pixel));
    let (trace, _) = traced(
        args,
        (shader, &passes.checked[at]),
        &trail.frame,
        expected,
        terminal,
    )?;
    print(args, &trace.after(&trail), terminal)
}

/// The source of the expected color.
struct Reference {
    scene: Option<Scene>,
    given: Option<GivenReference>,
}

/// The frame, in the size that the arguments give, else that of the reference image or of the scene; and the
/// scene, if there is one.
fn frame_and_scene(
    inputs: &FrameInputs,
    reference: &ReferenceArgs,
    input: &Result<Input, ReadError>,
    given: Option<&GivenReference>,
) -> Result<(Frame, Option<Scene>), CliError> {
    let mut frame = inputs.load()?;
    let scene = if let Some(given) = given {
        given.resize(&mut frame, inputs.size)?;
        None
    } else {
        let scenes = Scenes::new(reference.scene.as_deref());
        let found = input.as_ref().ok().and_then(|found| scenes.find(found));
        found.and_then(|found| found.scene.ok())
    };
    if let (None, Some(scene)) = (inputs.size, &scene) {
        frame.size = scene.film.size;
    }
    Ok((frame, scene))
}

/// Checks that a pixel is inside what a pass renders, of this size in pixels.
fn check_pixel([x, y]: [u32; 2], kind: PassKind, [width, height]: [u32; 2]) -> Result<(), CliError> {
    if x < width && y < height {
        return Ok(());
    }
    let image = match kind {
        PassKind::Image => "the image".to_owned(),
        buffer => buffer.to_string(),
    };
    Err(CliError::new(format_args!(
        "pixel ({x}, {y}) is outside {image} of {width}x{height} pixels; the last is ({}, {})",
        width - 1,
        height - 1
    )))
}

/// The color of the scene in a pixel, in double precision.
fn expected_color(mut scene: Scene, frame: &Frame, [x, y]: [u32; 2]) -> [f64; 3] {
    scene.film.size = frame.size;
    let time = FrameTime {
        frame: frame.frame,
        time: f64::from(frame.time),
    };
    Tracer::<f64>::at(&scene, time).pixel(x, y)
}

/// Prints the trace of the pixel next to that of a reference shader.
fn print_trace(
    args: &Args,
    shader: (&Shader, &Checked),
    frame: &Frame,
    reference: Reference,
    terminal: &Terminal,
) -> Result<Exit, CliError> {
    let Reference { scene, given } = reference;
    let [x, y] = args.pixel;
    let mut expected = scene.map(|scene| expected_color(scene, frame, args.pixel));
    if let Some(image) = given.as_ref().and_then(GivenReference::image) {
        let [r, g, b, _] = image.get(x, y);
        expected = Some([r, g, b].map(f64::from));
    }
    let solution = given.as_ref().and_then(GivenReference::shader);
    let reference = match solution {
        None => None,
        Some(shader) => {
            // Its fault is not that of the shader that is traced.
            let traced = traced(args, shader, frame, None, terminal);
            let (trace, color) = traced.map_err(|error| error.with_exit(Exit::Error))?;
            expected = color;
            Some(trace)
        }
    };
    let (trace, color) = traced(args, shader, frame, expected, terminal)?;
    let trace = trace.beside(reference);
    let departure = solution
        .filter(|_| {
            is_wrong(
                color,
                expected,
                given.as_ref().map_or(0.0, GivenReference::tolerance),
            )
        })
        .and_then(|solution| {
            let programs = [shader, solution].map(|(_, checked)| Program::within(checked, args.timeout));
            let [Ok(own), Ok(other)] = programs else {
                return None;
            };
            let deadline = Instant::now() + args.timeout;
            let departure = departure::in_pixel((&own, frame), (&other, frame), args.pixel, deadline)?;
            Some((departure, [&shader.0.files, &solution.0.files]))
        });
    let trace = match departure {
        Some((departure, files)) => trace.departing(&departure, files),
        None => trace,
    };
    print(args, &trace, terminal)
}

/// Whether a color differs from the expected one beyond the tolerance.
fn is_wrong(color: Option<[f64; 3]>, expected: Option<[f64; 3]>, tolerance: f64) -> bool {
    match (color, expected) {
        (Some(color), Some(expected)) => {
            let differs = |(own, other): (f64, f64)| {
                let difference = (own.clamp(0.0, 1.0) - other.clamp(0.0, 1.0)).abs();
                difference.is_nan() || difference > tolerance
            };
            color.into_iter().zip(expected).any(differs)
        }
        _ => false,
    }
}

fn print(args: &Args, trace: &report::PixelTrace, terminal: &Terminal) -> Result<Exit, CliError> {
    match args.format {
        Format::Json => terminal.bytes(trace.json().as_bytes())?,
        Format::Human => terminal.result(&trace.human(terminal.is_verbose())),
    }
    Ok(Exit::Success)
}

/// The trace of the pixel in one shader, and its color in f64, unless it is discarded.
fn traced(
    args: &Args,
    (shader, checked): (&Shader, &Checked),
    frame: &Frame,
    expected: Option<[f64; 3]>,
    terminal: &Terminal,
) -> Result<(report::PixelTrace, Option<[f64; 3]>), CliError> {
    let spinner = terminal.spinner(&shader.name);
    let deadline = Instant::now() + args.timeout;
    let program = Program::within(checked, args.timeout).map_err(Failure::from);
    let traced = match &program {
        Ok(program) => debug::explain(program, frame, args.pixel, Some(deadline)),
        Err(failure) => Err(failure.clone()),
    };
    spinner.finish_and_clear();
    let traced = traced.map_err(|failure| evaluation_error(&failure, shader))?;
    let subject = report::TracedPixel {
        shader: &shader.name,
        files: &shader.files,
        tree: &checked.tree,
        pixel: args.pixel,
        size: frame.size,
        expected,
    };
    Ok((report::PixelTrace::new(&subject, &traced), traced.double))
}

fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let parts = text
        .split_once(',')
        .map(|(x, y)| (x.trim().parse(), y.trim().parse()));
    match parts {
        Some((Ok(x), Ok(y))) => Ok([x, y]),
        _ => Err("expected two integers X,Y, from the left and from the bottom".to_owned()),
    }
}
