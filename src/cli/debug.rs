//! `toyproof debug`

use std::path::PathBuf;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Deadline, Diagnostic};
use toyproof_eval::Failure;
use toyproof_eval_native::Program;
use toyproof_explain::departure;
use toyproof_explain::trail::{Trail, follow_back};
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
    let read = PixelInput::read(args, terminal)?;
    terminal.diagnostics(&read.shader.lints.warnings, &read.shader.files);
    match read.pass(args, terminal)? {
        Some(pass) => {
            let subject = (&read.shader, pass.checked);
            let (trace, _) = traced(args, subject, &pass.trail.frame, pass.expected, terminal)?;
            print(args, &trace.after(&pass.trail), terminal)
        }
        None => print_trace(args, &read, terminal),
    }
}

/// What the arguments name.
struct PixelInput {
    shader: Shader,
    frame: Frame,
    /// The scene that is the reference, if there is one.
    scene: Option<Scene>,
    /// The shader or the image that is the reference, if there is one.
    given: Option<GivenReference>,
}

/// A pass of a project whose pixel is traced.
struct PassInput<'a> {
    checked: &'a Checked,
    /// The origin of the difference of its pixel, with the inputs of the pass.
    trail: Trail,
    expected: Option<[f64; 3]>,
}

impl PixelInput {
    fn read(args: &Args, terminal: &Terminal) -> Result<Self, CliError> {
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
        Ok(Self {
            shader: Shader::load(&input, &language, Deadline::after(args.timeout)),
            frame,
            scene,
            given,
        })
    }

    /// The pass that is traced, if the image depends on passes, or another one is named.
    fn pass(&self, args: &Args, terminal: &Terminal) -> Result<Option<PassInput<'_>>, CliError> {
        let shader = &self.shader;
        let kind = args.pass.unwrap_or(PassKind::Image);
        if kind == PassKind::Image {
            check_pixel(args.pixel, kind, self.frame.size)?;
        }
        shader.require_image()?;
        let needs_passes = shader.has_passes || kind != PassKind::Image;
        match shader.project().filter(|_| needs_passes) {
            Some(passes) => self.pass_of(passes, kind, args, terminal).map(Some),
            None if kind == PassKind::Image => Ok(None),
            None => Err(CliError::new(format_args!(
                "{} is no project with buffers",
                shader.name
            ))),
        }
    }

    fn pass_of<'a>(
        &'a self,
        passes: &'a CompiledProject,
        kind: PassKind,
        args: &Args,
        terminal: &Terminal,
    ) -> Result<PassInput<'a>, CliError> {
        let shader = &self.shader;
        let mut frame = self.frame.clone();
        let Some(at) = passes.project.passes.iter().position(|pass| pass.kind == kind) else {
            let error = CliError::new(format_args!("{}: there is no {kind}", shader.name));
            return Err(error.with_help("name one of its passes with --pass"));
        };
        if !args.frame.is_moment_given() && args.assignment.is_none() {
            let number = default_frame(self.scene.as_ref());
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
        let scene = self.scene.clone().filter(|_| kind == PassKind::Image);
        let expected = scene.map(|mut scene| {
            accumulate(&mut scene, frame.frame);
            expected_color(scene, &frame, args.pixel)
        });
        Ok(PassInput {
            checked: &passes.checked[at],
            trail,
            expected,
        })
    }

    /// The color of a scene or an image in the pixel.
    fn expected(&self, pixel: [u32; 2]) -> Option<[f64; 3]> {
        if let Some(image) = self.given.as_ref().and_then(GivenReference::image) {
            let [r, g, b, _] = image.get(pixel[0], pixel[1]);
            return Some([r, g, b].map(f64::from));
        }
        let scene = self.scene.clone();
        scene.map(|scene| expected_color(scene, &self.frame, pixel))
    }
}

/// The pixel that the arguments name for a debugger, and the warnings about its shader.
pub(super) fn subject(
    args: &Args,
    terminal: &Terminal,
) -> Result<(toyproof_dap::Subject, Vec<Diagnostic>), CliError> {
    let read = PixelInput::read(args, terminal)?;
    let (checked, frame, expected) = if let Some(pass) = read.pass(args, terminal)? {
        (pass.checked.clone(), pass.trail.frame, pass.expected)
    } else {
        let expected = match read.given.as_ref().and_then(GivenReference::shader) {
            Some(solution) => traced(args, solution, &read.frame, None, terminal)?.1,
            None => read.expected(args.pixel),
        };
        (read.shader.require_image()?.clone(), read.frame.clone(), expected)
    };
    let subject = toyproof_dap::Subject {
        name: read.shader.name,
        files: read.shader.files,
        checked,
        frame,
        pixel: args.pixel,
        expected,
        timeout: args.timeout,
    };
    Ok((subject, read.shader.lints.warnings))
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
pub(super) fn check_pixel(
    [x, y]: [u32; 2],
    kind: PassKind,
    [width, height]: [u32; 2],
) -> Result<(), CliError> {
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
pub(super) fn expected_color(mut scene: Scene, frame: &Frame, [x, y]: [u32; 2]) -> [f64; 3] {
    scene.film.size = frame.size;
    let time = FrameTime {
        frame: frame.frame,
        time: f64::from(frame.time),
    };
    Tracer::<f64>::at(&scene, time).pixel(x, y)
}

/// Prints the trace of the pixel next to that of a reference shader.
fn print_trace(args: &Args, read: &PixelInput, terminal: &Terminal) -> Result<Exit, CliError> {
    let (frame, given) = (&read.frame, &read.given);
    let shader = (&read.shader, read.shader.require_image()?);
    let mut expected = read.expected(args.pixel);
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
    shader: (&Shader, &Checked),
    frame: &Frame,
    expected: Option<[f64; 3]>,
    terminal: &Terminal,
) -> Result<(report::PixelTrace, Option<[f64; 3]>), CliError> {
    let spinner = terminal.spinner(&shader.0.name);
    let traced = trace_pixel(shader, frame, args.pixel, expected, args.timeout);
    spinner.finish_and_clear();
    traced
}

/// Traces a pixel of a shader; also returns its color in f64, unless it is discarded.
pub(super) fn trace_pixel(
    (shader, checked): (&Shader, &Checked),
    frame: &Frame,
    pixel: [u32; 2],
    expected: Option<[f64; 3]>,
    timeout: Duration,
) -> Result<(report::PixelTrace, Option<[f64; 3]>), CliError> {
    let deadline = Instant::now() + timeout;
    let program = Program::within(checked, timeout).map_err(Failure::from);
    let traced = match &program {
        Ok(program) => debug::explain(program, frame, pixel, Some(deadline)),
        Err(failure) => Err(failure.clone()),
    };
    let traced = traced.map_err(|failure| evaluation_error(&failure, shader))?;
    let subject = report::TracedPixel {
        shader: &shader.name,
        files: &shader.files,
        tree: &checked.tree,
        pixel,
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
