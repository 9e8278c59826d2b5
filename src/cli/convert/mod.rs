//! `toyproof convert`

mod batch;
mod conversion;
mod target;

use std::path::{Path, PathBuf};

use toyproof_convert::{Converter, Host};
use toyproof_diagnostic::Deadline;
use toyproof_gpu::browser::{self, THREE_VARIABLE, ThreeLibrary};
use toyproof_project::files;
use toyproof_translate::FloatMode;
use toyproof_translate::c_family::CHost;

use self::batch::{Batch, Job};
use self::conversion::Settings;
use self::target::{OutputKind, StyleName, To, check_target, host, output, target_language};
use super::inputs::{DriverArgs, Format, LanguageArgs, check_output};
use super::shader::{Shader, find};
use super::{CliError, Exit, Terminal};

/// The help after the options: examples, the interface of what is written, and the exit code.
fn hosts() -> String {
    let offsets = toyproof_image::Input::ALL.map(|input| {
        let length = input.length().map(|length| format!("[{length}]"));
        format!(
            "{}{} {}",
            input.name(),
            length.unwrap_or_default(),
            input.offset()
        )
    });
    format!(
        "\
Examples:
  toyproof convert mine.glsl > mine.wgsl
  toyproof convert mine.glsl -o mine.wgsl --verify
  toyproof convert shaders -o converted --to spv
  toyproof convert waves -o converted --verify
  toyproof convert mine.glsl -o mine.frag --style book-of-shaders
  toyproof convert waves -o waves.js --style three
  toyproof convert waves.frag -o waves.glsl --style shadertoy

Interface of the result: entry point `main`, color at location 0. Group 0, binding 0 is a uniform block of {} bytes \
(std140), with these inputs at these bytes: {} (elements of arrays have 16 bytes each). The texture of channel K is at \
binding 1+2K, its sampler at 2+2K; only those that the shader uses are declared. In WGSL, uniforms of the author are \
members of a block at binding 9, elsewhere constants. \
The passes of a project go to a folder, with graph.json, which says how they are played.

Exit code: 0 if every shader was written (with --verify: and proved), 1 if a shader is at fault, 2 for any other \
error, such as a conversion that is not proved.",
        toyproof_image::BLOCK_BYTES,
        offsets.join(", ")
    )
}

/// Convert shaders to WGSL, SPIR-V, Metal, HLSL or GLSL ES
///
/// A single shader is written to standard output unless -o is given.
#[derive(Debug, clap::Args)]
#[command(after_long_help = hosts())]
pub(super) struct Args {
    /// Shaders and projects: files, folders, or - for standard input
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// The output: a file (.wgsl .spv .metal .hlsl .frag .js .fs), a folder, or - for standard output
    #[arg(short, long, value_name = "FILE|DIR")]
    output: Option<PathBuf>,
    /// The target language [default: by the extension of the output, else wgsl]
    #[arg(long, value_enum, value_name = "LANGUAGE")]
    to: Option<To>,
    /// The host of WGSL or GLSL, which determines the entry point and the inputs
    #[arg(long, value_enum, default_value_t = StyleName::Plain)]
    style: StyleName,
    /// Run the result and compare it with the shader; write it only if all pixels are equal, bit for bit
    #[arg(long, help_heading = "Verification")]
    verify: bool,
    /// Also run the result in Chromium; its colors must be within 1/255 of the shader's
    ///
    /// WGSL runs with WebGPU, GLSL with WebGL 2, both on Chromium's software driver. The shader itself runs
    /// with WebGL 2.
    #[arg(long, requires = "verify", help_heading = "Verification")]
    browser: bool,
    /// Write the output even if verification fails; a comment in it states the failure
    #[arg(long, requires = "verify", help_heading = "Verification")]
    force: bool,
    /// The format of the results; `json` needs an output other than standard output
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output", hide_possible_values = true)]
    format: Format,
    /// The number of shaders to convert in parallel [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), allow_negative_numbers = true)]
    jobs: Option<u16>,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let inputs = find(&args.shaders, terminal);
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| files::is_folder_of_shaders(path));
    // A single input determines whether the output is a file or a folder.
    let loaded = match &inputs[..] {
        [input] if !several => {
            let deadline = Deadline::after(args.driver.timeout());
            Some(Shader::load(input, &args.language, deadline))
        }
        _ => None,
    };
    let host = host(args);
    let kind = match &loaded {
        _ if several => OutputKind::Shaders,
        Some(shader) if shader.has_passes && host.is_none() => OutputKind::Passes,
        _ => OutputKind::File,
    };
    let output = output(args, kind)?;
    let to = target_language(args, &output, kind)?;
    check_target(args, to)?;
    let browser = args.browser.then(browser::find).flatten();
    if args.browser && browser.is_none() {
        let error = CliError::new("--browser needs Chromium, which is not installed");
        return Err(error.with_help("on Debian: apt-get install chromium"));
    }
    let three = (args.browser && host == Some(Host::Three)).then(|| {
        let folder = output.parent().map(Path::to_path_buf).unwrap_or_default();
        let folders = [folder, PathBuf::new()].map(|folder| std::path::absolute(&folder).unwrap_or(folder));
        ThreeLibrary::find(&folders)
    });
    if let Some(None) = three {
        let error = CliError::new("--browser needs the npm package three, which was not found");
        return Err(error.with_help(format_args!(
            "run `npm install three` beside the output, or name the folder of the package in {THREE_VARIABLE}"
        )));
    }
    // People read converted shaders: by default they keep the author's functions.
    let float = args.driver.explicit_float().unwrap_or(FloatMode::Fast);
    args.driver.translator().and_then(|_| args.driver.worker())?;
    let settings = Settings {
        to,
        converter: Converter {
            target: to.target(),
            style: args.style.wgsl().unwrap_or_default(),
            c_host: args.style.c_family().or(match to {
                To::Hlsl => Some(CHost::Hlsl),
                To::Metal => Some(CHost::Metal),
                To::Glsl if args.style == StyleName::Plain => Some(CHost::Glsl),
                _ => None,
            }),
            dialect: args.style.dialect(),
            float,
            timeout: args.driver.timeout(),
        },
        host,
        verify: args.verify,
        browser,
        three: three.flatten(),
        language: &args.language,
        driver: &args.driver,
    };
    let jobs = Job::for_inputs(inputs, kind, &output, settings.extension());
    let originals = jobs
        .iter()
        .filter_map(|job| job.input.as_ref().ok()?.path())
        .collect();
    for file in jobs.iter().flat_map(Job::last_files) {
        check_output(&file, &originals)?;
    }
    Batch::new(args, terminal, output, several, &jobs).convert(&jobs, &settings, loaded)
}
