//! `toyproof run`

use std::path::{Path, PathBuf};

use super::check::cut_short;
use super::inputs::{DriverArgs, FrameArgs};
use super::shader::{Names, Shader, Unusable, find, is_invalid, with_suffix};
use super::{Exit, Terminal};
use crate::gpu::{Drawn, Failure};
use crate::image;

/// Run shaders and keep the pictures that they paint
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  toyproof run glsl/02-sphere.glsl -o sphere.png --time 1.5\n  \
                        toyproof run glsl -o pictures"
)]
pub(super) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// A picture (.png, .exr, or - for PNG on standard output), or a folder for several
    #[arg(short, long, value_name = "PICTURE|DIR")]
    output: PathBuf,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let (mut worker, frame) = match (args.driver.worker(), args.frame.frame()) {
        (Ok(worker), Ok(frame)) => (worker, frame),
        (Err(error), _) | (_, Err(error)) => {
            terminal.error(error);
            return Exit::Trouble;
        }
    };
    let inputs = find(&args.shaders);
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| path.is_dir());
    let standard = args.output == Path::new("-");
    if several && (standard || args.output.extension().is_some()) {
        terminal.error(format_args!(
            "several shaders need a folder to go to, not {}",
            args.output.display()
        ));
        return Exit::Trouble;
    }
    let one = standard || (!several && !args.output.is_dir());
    let mut names = Names::default();
    let mut exit = Exit::Good;
    for input in &inputs {
        let shader = Shader::load(input, &args.driver, args.driver.float());
        let path = match (one, input) {
            (true, _) | (false, Err(_)) => args.output.clone(),
            (false, Ok(found)) => with_suffix(&args.output.join(names.place(&found.relative)), ".png"),
        };
        let spinner = terminal.spinner(&shader.name);
        terminal.diagnostics(&shader.warnings, &shader.files);
        let outcome = match shader.lowered {
            Ok(lowered) => worker.draw(lowered, frame.clone(), args.driver.float()),
            Err(Unusable::Invalid(diagnostics)) => Err(Failure::Invalid(diagnostics)),
            Err(Unusable::Trouble(error)) => {
                spinner.finish_and_clear();
                terminal.error(error);
                exit = exit.max(Exit::Trouble);
                continue;
            }
        };
        spinner.finish_and_clear();
        exit = exit.max(match outcome {
            Ok(Drawn {
                cut_short: Some(pixels @ 1..),
                ..
            }) => {
                terminal.error(format_args!("{}: {}", shader.name, cut_short(pixels)));
                Exit::Bad
            }
            Ok(drawn) => {
                terminal.detail(&format!(
                    "{}: painted in {:.3} s on {}",
                    shader.name,
                    drawn.draw.as_secs_f64(),
                    drawn.device
                ));
                keep(&drawn.image, &path, terminal)
            }
            Err(Failure::Invalid(diagnostics)) => {
                terminal.diagnostics(&diagnostics, &shader.files);
                Exit::Bad
            }
            Err(Failure::Refused(diagnostics)) => {
                terminal.diagnostics(&diagnostics, &shader.files);
                Exit::Trouble
            }
            Err(failure) => {
                terminal.error(format_args!("{}: {failure}", shader.name));
                let shaders_fault = is_invalid(&failure) || matches!(failure, Failure::Timeout { .. });
                if shaders_fault { Exit::Bad } else { Exit::Trouble }
            }
        });
    }
    exit
}

fn keep(picture: &image::Image, path: &Path, terminal: &Terminal) -> Exit {
    let format = if path == Path::new("-") {
        Path::new("-.png")
    } else {
        path
    };
    match image::encode(picture, format) {
        Ok(bytes) if terminal.write(path, &bytes) => Exit::Good,
        Ok(_) => Exit::Trouble,
        Err(error) => {
            terminal.error(error);
            Exit::Trouble
        }
    }
}
