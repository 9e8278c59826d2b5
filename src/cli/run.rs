//! `toyproof run`

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use toyproof_diagnostic::{Deadline, path_name};
use toyproof_eval::{self as eval, Number, Program, Settings, UndefinedPolicy};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{DrawOutput, Failure, Worker};
use toyproof_image::{self as image, Frame, Image};
use toyproof_verify::unbound;

use super::inputs::{DriverArgs, FrameArgs, LanguageArgs, may_write};
use super::names::{Names, with_suffix};
use super::sequence::{self, Frames, Sequence};
use super::shader::{Shader, Unusable, find};
use super::{Exit, Terminal};
use crate::report;

/// Run shaders and keep the pictures that they paint
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  toyproof run glsl/02-sphere.glsl -o sphere.png --time 1.5\n  \
                        toyproof run glsl -o pictures\n  \
                        toyproof run glsl/02-sphere.glsl -o sphere.exr --on cpu --precision f64\n  \
                        toyproof run glsl/11-animation.glsl -o frames/orrery.png --frames 0..479"
)]
pub(super) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// A picture (.png, .exr, or - for PNG on standard output), or a folder for several
    #[arg(short, long, value_name = "PICTURE|DIR")]
    output: PathBuf,
    /// The number type of every float; f64 runs on the CPU: the shader's mathematics without its rounding
    #[arg(long, value_enum, default_value_t = Precision::F32)]
    precision: Precision,
    /// All frames from A to B, at 60 a second, each into a file with its number; a sequence that was
    /// interrupted goes on where it stopped
    #[arg(long, value_name = "A..B", value_parser = sequence::parse_frames, conflicts_with_all = ["frame", "time"])]
    frames: Option<Frames>,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Precision {
    F32,
    F64,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let (worker, frame) = match (args.driver.worker(), args.frame.frame()) {
        (Ok(worker), Ok(frame)) => (worker, frame),
        (Err(error), _) | (_, Err(error)) => {
            terminal.error(error);
            return Exit::Error;
        }
    };
    let inputs = find(&args.shaders, terminal);
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| path.is_dir());
    let standard = args.output == Path::new("-");
    if several && (standard || args.output.extension().is_some()) {
        terminal.error(format_args!(
            "several shaders need a folder to go to, not {}",
            path_name(&args.output)
        ));
        return Exit::Error;
    }
    if standard && args.frames.is_some() {
        terminal.error(sequence::NEEDS_FILE);
        return Exit::Error;
    }
    let one = standard || (!several && !args.output.is_dir());
    let mut names = Names::new(&[".png"], &[]);
    let mut exit = Exit::Success;
    let channels = args.frame.files().map(PathBuf::as_path).collect();
    if !may_write(&args.output, &channels, terminal) {
        return Exit::Error;
    }
    let mut runner = Runner {
        args,
        terminal,
        worker: worker.filter(|_| args.precision == Precision::F32),
        frame,
    };
    for input in &inputs {
        let shader = Shader::load(input, &args.language, Deadline::after(args.driver.timeout()));
        let path = match (one, input) {
            (true, _) | (false, Err(_)) => args.output.clone(),
            (false, Ok(found)) => with_suffix(&args.output.join(names.assign(found)), ".png"),
        };
        terminal.diagnostics(&shader.lints.warnings, &shader.files);
        if let Ok(checked) = &shader.checked {
            terminal.diagnostics(&unbound(checked, &shader.lints, &runner.frame), &shader.files);
        }
        exit = exit.max(match args.frames {
            None => {
                let spinner = terminal.spinner(&shader.name);
                let rendered = runner.render(&shader);
                spinner.finish_and_clear();
                rendered.map_or_else(
                    |exit| exit,
                    |rendered| write_image(&rendered, &path, &args.output, terminal),
                )
            }
            Some(frames) => runner.sequence(&shader, frames, &path),
        });
    }
    exit
}

struct Runner<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    /// None where the evaluator renders.
    worker: Option<Worker>,
    frame: Frame,
}

impl Runner<'_> {
    /// Renders the frames of a shader, each into its file; stops at the first failure.
    fn sequence(&mut self, shader: &Shader, frames: Frames, output: &Path) -> Exit {
        let fingerprint = self.fingerprint(shader);
        let sequence = Sequence::resume(frames, output, &fingerprint, self.terminal);
        let mut exit = Exit::Success;
        let whole = sequence.render(self.terminal, |one| {
            self.frame.frame = one.frame;
            self.frame.time = one.time as f32;
            exit = match self.render(shader) {
                Ok(rendered) => write_image(&rendered, &one.path, &self.args.output, self.terminal),
                Err(exit) => exit,
            };
            exit == Exit::Success
        });
        // Otherwise the record could not be written, which has been reported.
        if whole || exit != Exit::Success {
            exit
        } else {
            Exit::Error
        }
    }

    /// A digest of everything that the frames of a sequence depend on: a record with a different one is
    /// ignored.
    fn fingerprint(&self, shader: &Shader) -> String {
        let mut hasher = DefaultHasher::new();
        if let Ok(checked) = &shader.checked {
            self.args.driver.float().lower(checked).text().hash(&mut hasher);
        }
        let any = Frame {
            frame: 0,
            time: 0.0,
            ..self.frame.clone()
        };
        postcard::to_stdvec(&any).unwrap_or_default().hash(&mut hasher);
        format!("{:?} {:?}", self.args.precision, self.args.driver).hash(&mut hasher);
        format!("{:016x}", hasher.finish())
    }

    /// Renders the shader; prints the error on failure.
    fn render(&mut self, shader: &Shader) -> Result<Image, Exit> {
        let checked = match &shader.checked {
            Ok(checked) => checked,
            Err(Unusable::Invalid(diagnostics)) => {
                self.terminal.diagnostics(diagnostics, &shader.files);
                return Err(Exit::ShaderFault);
            }
            Err(Unusable::Unreadable(error)) => {
                self.terminal.error(error);
                return Err(Exit::Error);
            }
        };
        if let Some(worker) = &mut self.worker {
            let float = self.args.driver.float();
            let deadline = Deadline::after(self.args.driver.timeout());
            let lowered = match float.lower_within(checked, &deadline) {
                Ok(lowered) => lowered,
                Err(overdue) => {
                    let overdue = [glsl::overdue(overdue)];
                    self.terminal.diagnostics(&overdue, &shader.files);
                    return Err(Exit::ShaderFault);
                }
            };
            match worker.draw(lowered, self.frame.clone(), float) {
                Err(failure) if failure.is_without_driver() && self.args.driver.may_fall_back() => {
                    self.terminal
                        .warn(format_args!("{failure}; shaders run on the CPU"));
                    self.worker = None;
                }
                result => return self.draw_result(result, shader),
            }
        }
        match self.args.precision {
            Precision::F32 => self.evaluate::<f32>(checked, shader),
            Precision::F64 => self.evaluate::<f64>(checked, shader),
        }
    }

    fn draw_result(&self, drawn: Result<DrawOutput, Failure>, shader: &Shader) -> Result<Image, Exit> {
        match drawn {
            Ok(DrawOutput {
                loop_truncated: Some(pixels @ 1..),
                ..
            }) => {
                self.terminal.error(format_args!(
                    "{}: {}",
                    shader.name,
                    report::loop_truncated(pixels)
                ));
                Err(Exit::ShaderFault)
            }
            Ok(drawn) => {
                self.report_time(&shader.name, drawn.draw.as_secs_f64(), &drawn.device);
                Ok(drawn.image())
            }
            Err(Failure::Invalid(diagnostics)) => {
                self.terminal.diagnostics(&diagnostics, &shader.files);
                Err(Exit::ShaderFault)
            }
            Err(Failure::Refused(diagnostics)) => {
                self.terminal.diagnostics(&diagnostics, &shader.files);
                Err(Exit::Error)
            }
            Err(failure) => {
                self.terminal.error(format_args!("{}: {failure}", shader.name));
                let shaders_fault = failure.is_invalid() || matches!(failure, Failure::Timeout { .. });
                Err(if shaders_fault {
                    Exit::ShaderFault
                } else {
                    Exit::Error
                })
            }
        }
    }

    fn evaluate<N: Number>(&self, checked: &Checked, shader: &Shader) -> Result<Image, Exit> {
        let start = Instant::now();
        let settings = Settings::<N> {
            undefined: UndefinedPolicy::Plain,
            deadline: Some(start + self.args.driver.timeout()),
            ..Settings::default()
        };
        let rendered = Program::within(checked, self.args.driver.timeout())
            .map_err(eval::Failure::from)
            .and_then(|program| program.render_rows(&self.frame, self.frame.rows(), &settings));
        match rendered {
            Ok(rendered) => {
                let device = format!("the CPU, in {}", std::any::type_name::<N>());
                self.report_time(&shader.name, start.elapsed().as_secs_f64(), &device);
                Ok(rendered.image)
            }
            Err(failure) => Err(not_evaluated(&failure, shader, self.terminal)),
        }
    }

    fn report_time(&self, name: &str, seconds: f64, device: &str) {
        self.terminal
            .detail(&format!("{name}: painted in {seconds:.3} s on {device}"));
    }
}

/// Prints why the evaluator failed.
pub(super) fn not_evaluated(failure: &eval::Failure, shader: &Shader, terminal: &Terminal) -> Exit {
    if let eval::Failure::Refused(eval::Refusal::TooSlow(overdue)) = failure {
        terminal.diagnostics(&[glsl::overdue(*overdue)], &shader.files);
        return Exit::ShaderFault;
    }
    let position = report::failure_position(failure, &shader.files);
    terminal.error(format_args!("{}: {failure}{position}", shader.name));
    let ours = matches!(failure, eval::Failure::Refused(_));
    if ours { Exit::Error } else { Exit::ShaderFault }
}

fn write_image(rendered: &Image, path: &Path, output: &Path, terminal: &Terminal) -> Exit {
    let format = if path == Path::new("-") {
        Path::new("-.png")
    } else {
        path
    };
    match image::encode(rendered, format) {
        Ok(bytes) if terminal.write_output(output, path, &bytes) => Exit::Success,
        Ok(_) => Exit::Error,
        Err(error) => {
            terminal.error(error);
            Exit::Error
        }
    }
}
