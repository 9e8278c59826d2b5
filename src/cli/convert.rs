//! `toyproof convert`

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::inputs::{DriverArgs, LanguageArgs};
use super::shader::{Names, Shader, Unusable, find, is_invalid, with_suffix};
use super::{Exit, Terminal};
use crate::emit::Target;
use crate::gpu::{Failure, FloatMode, Worker};

const HOSTS: &str = "\
Examples:
  toyproof convert glsl/02-sphere.glsl -o sphere.wgsl
  toyproof convert glsl -o converted --to spv

What a host feeds the result: entry point `main`, colour at location 0. Group 0, binding 0 is a block of
208 bytes (std140): iResolution at byte 0, iTime 12, iTimeDelta 16, iFrame 20, iFrameRate 24, iChannelTime[4]
32 and iChannelResolution[4] 96 (16 bytes each), iMouse 160, iDate 176, iSampleRate 192. The texture of channel
K is binding 1+2K, its sampler 2+2K; only those that the shader uses are declared.";

/// Translate shaders to WGSL, SPIR-V, Metal, HLSL or GLSL ES
#[derive(Debug, clap::Args)]
#[command(after_help = HOSTS)]
pub(super) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// A file (.wgsl .spv .metal .hlsl .frag), a folder for several, or - for standard output
    #[arg(short, long, value_name = "FILE|DIR")]
    output: PathBuf,
    /// The language; needed with a folder and with -
    #[arg(long, value_enum)]
    to: Option<To>,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum To {
    Wgsl,
    Spv,
    Metal,
    Hlsl,
    Glsl,
    /// The GLSL that naga is fed
    Lowered,
}

impl To {
    fn target(self) -> Option<Target> {
        match self {
            Self::Wgsl => Some(Target::Wgsl),
            Self::Spv => Some(Target::Spirv),
            Self::Metal => Some(Target::Msl),
            Self::Hlsl => Some(Target::Hlsl),
            Self::Glsl => Some(Target::Glsl),
            Self::Lowered => None,
        }
    }

    fn extension(self) -> &'static str {
        self.target().map_or("lowered.glsl", Target::extension)
    }

    fn of(path: &Path) -> Option<Self> {
        let target = Target::of(path)?;
        Self::value_variants()
            .iter()
            .copied()
            .find(|to| to.target() == Some(target))
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let inputs = find(&args.shaders);
    let standard = args.output == Path::new("-");
    let of_extension = (!standard && !args.output.is_dir())
        .then(|| To::of(&args.output))
        .flatten();
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| path.is_dir());
    let Some(to) = args.to.or(of_extension) else {
        terminal.error(format_args!(
            "{}: say the language with --to, or end the file's name in .wgsl, .spv, .metal, .hlsl or .frag",
            args.output.display()
        ));
        return Exit::Trouble;
    };
    if several && (standard || of_extension.is_some()) {
        terminal.error(format_args!(
            "several shaders need a folder to go to, not {}",
            args.output.display()
        ));
        return Exit::Trouble;
    }
    let one = standard || (!several && !args.output.is_dir());
    let mut worker = match args.driver.translator() {
        Ok(worker) => worker,
        Err(error) => {
            terminal.error(error);
            return Exit::Trouble;
        }
    };
    let mut names = Names::default();
    let mut exit = Exit::Good;
    for input in &inputs {
        // People read what is converted: it keeps the author's functions unless told otherwise.
        let float = args.driver.asked_float().unwrap_or(FloatMode::Fast);
        let shader = Shader::load(input, &args.language);
        let path = match (one, input) {
            (true, _) | (false, Err(_)) => args.output.clone(),
            (false, Ok(found)) => with_suffix(
                &args.output.join(names.place(&found.relative)),
                &format!(".{}", to.extension()),
            ),
        };
        exit = exit.max(match translate(shader, (to, float), &mut worker, terminal) {
            Ok(bytes) if terminal.write(&path, &bytes) => Exit::Good,
            Ok(_) => Exit::Trouble,
            Err(exit) => exit,
        });
    }
    exit
}

fn translate(
    shader: Shader,
    (to, float): (To, FloatMode),
    worker: &mut Worker,
    terminal: &Terminal,
) -> Result<Vec<u8>, Exit> {
    terminal.diagnostics(&shader.warnings, &shader.files);
    let translated = match (shader.checked.map(|checked| float.lower(&checked)), to.target()) {
        (Ok(lowered), None) => Ok(lowered.text().as_bytes().to_vec()),
        (Ok(lowered), Some(target)) => worker.translate(lowered, target, float),
        (Err(Unusable::Invalid(diagnostics)), _) => Err(Failure::Invalid(diagnostics)),
        (Err(Unusable::Trouble(error)), _) => {
            terminal.error(error);
            return Err(Exit::Trouble);
        }
    };
    translated.map_err(|failure| match failure {
        Failure::Invalid(diagnostics) => {
            terminal.diagnostics(&diagnostics, &shader.files);
            Exit::Bad
        }
        Failure::Refused(diagnostics) => {
            terminal.diagnostics(&diagnostics, &shader.files);
            Exit::Trouble
        }
        failure => {
            terminal.error(format_args!("{}: {failure}", shader.name));
            if is_invalid(&failure) {
                Exit::Bad
            } else {
                Exit::Trouble
            }
        }
    })
}
