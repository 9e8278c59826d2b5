//! `toyproof convert`

mod conversion;
mod passes;

use std::fmt::Write as _;
use std::io::{self, IsTerminal};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use anstyle::{AnsiColor, Style as TextStyle};
use clap::ValueEnum;
use serde::Serialize;
use toyproof_convert::graph::GRAPH_FILE;
use toyproof_convert::header::{self, ProofStatus};
use toyproof_convert::{Converter, Proved};
use toyproof_diagnostic::{self as diagnostic, grouped, path_name, plural};
use toyproof_gpu::browser;
use toyproof_project::files::{self, Input, ReadError};
use toyproof_report::{Detail, Layout};
use toyproof_translate::FloatMode;
use toyproof_translate::backend::Target;
use toyproof_translate::wgsl::Style;

use self::conversion::{Conversion, Refusal, Settings};
use super::inputs::{DriverArgs, Format, LanguageArgs, check_output};
use super::names::{Names, with_suffix};
use super::pool::{self, InOrder};
use super::shader::{Shader, find};
use super::{CliError, Exit, Terminal, project};

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

Interface of the result: entry point `main`, color at location 0. Group 0, binding 0 is a uniform block of {} bytes \
(std140), with these inputs at these bytes: {} (elements of arrays have 16 bytes each). The texture of channel K is at \
binding 1+2K, its sampler at 2+2K; only those that the shader uses are declared. \
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
    /// The output: a file (.wgsl .spv .metal .hlsl .frag), a folder, or - for standard output
    #[arg(short, long, value_name = "FILE|DIR")]
    output: Option<PathBuf>,
    /// The target language [default: by the extension of the output, else wgsl]
    #[arg(long, value_enum, value_name = "LANGUAGE")]
    to: Option<To>,
    /// The host of the WGSL, which determines its entry point, bindings and direction of y
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum To {
    Wgsl,
    #[value(alias = "spirv")]
    Spv,
    #[value(alias = "msl")]
    Metal,
    Hlsl,
    Glsl,
    /// The GLSL 450 that naga reads
    Lowered,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum StyleName {
    /// A fragment shader with the bindings below; row 0 of its target is the bottom
    Plain,
    /// A `shader_main` function for the Python package wgpu-shadertoy
    WgpuShadertoy,
    /// A compute shader for compute.toys
    ComputeToys,
    /// A fragment shader for a Material2d of Bevy
    Bevy,
}

impl From<StyleName> for Style {
    fn from(name: StyleName) -> Self {
        match name {
            StyleName::Plain => Self::Plain,
            StyleName::WgpuShadertoy => Self::WgpuShadertoy,
            StyleName::ComputeToys => Self::ComputeToys,
            StyleName::Bevy => Self::Bevy,
        }
    }
}

impl To {
    pub(super) fn target(self) -> Option<Target> {
        match self {
            Self::Wgsl => Some(Target::Wgsl),
            Self::Spv => Some(Target::Spirv),
            Self::Metal => Some(Target::Msl),
            Self::Hlsl => Some(Target::Hlsl),
            Self::Glsl => Some(Target::Glsl),
            Self::Lowered => None,
        }
    }

    pub(super) fn extension(self) -> &'static str {
        self.target().map_or("lowered.glsl", Target::extension)
    }

    /// The name of the entry point.
    fn entry_point(self) -> &'static str {
        match self {
            // Metal reserves `main`.
            Self::Metal => "main_",
            _ => "main",
        }
    }

    /// Its name on the command line.
    pub(super) fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Returns whether it may be written to a file with the extension of `other`: lowered output is GLSL.
    pub(super) fn may_end_as(self, other: Self) -> bool {
        self == other || (self, other) == (Self::Lowered, Self::Glsl)
    }

    pub(super) fn of(path: &Path) -> Option<Self> {
        let target = Target::from_path(path)?;
        Self::value_variants()
            .iter()
            .copied()
            .find(|to| to.target() == Some(target))
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    let inputs = find(&args.shaders, terminal);
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| files::is_folder_of_shaders(path));
    let has_passes = |input: &Result<Input, ReadError>| input.as_ref().is_ok_and(project::has_passes);
    let written = match &inputs[..] {
        _ if several => Written::Shaders,
        [project] if has_passes(project) => Written::Passes,
        _ => Written::One,
    };
    let output = output(args, written)?;
    let to = target_language(args, &output, written)?;
    check_target(args, to)?;
    let browser = args.browser.then(browser::find).flatten();
    if args.browser && browser.is_none() {
        let error = CliError::new("--browser needs Chromium, which is not installed");
        return Err(error.with_help("on Debian: apt-get install chromium"));
    }
    // People read converted shaders: by default they keep the author's functions.
    let float = args.driver.explicit_float().unwrap_or(FloatMode::Fast);
    args.driver.translator().and_then(|_| args.driver.worker())?;
    let settings = Settings {
        to,
        converter: Converter {
            target: to.target(),
            style: args.style.into(),
            float,
            timeout: args.driver.timeout(),
        },
        verify: args.verify,
        browser,
        language: &args.language,
        driver: &args.driver,
    };
    let jobs = jobs(inputs, written, &output, to);
    let originals = jobs
        .iter()
        .filter_map(|job| job.input.as_ref().ok()?.path())
        .collect();
    for job in &jobs {
        check_output(&job.last_file(), &originals)?;
    }
    let names: Vec<_> = jobs.iter().map(Job::name).collect();
    Batch {
        args,
        terminal,
        layout: Layout::new(
            names.iter().map(String::as_str),
            terminal.width(),
            Detail::Normal,
            false,
        ),
        to,
        output,
        several,
        threads: args
            .jobs
            .map_or_else(cores, usize::from)
            .clamp(1, jobs.len().max(1)),
        exit: Exit::Success,
        tally: Tally::default(),
        rows: Vec::new(),
        start: Instant::now(),
    }
    .convert(&jobs, &settings)
}

/// Returns the output path of each input.
fn jobs(inputs: Vec<Result<Input, ReadError>>, written: Written, output: &Path, to: To) -> Vec<Job> {
    let is_output = match written {
        Written::One => !output.is_dir(),
        Written::Passes => true,
        Written::Shaders => false,
    };
    let suffix = format!(".{}", to.extension());
    let mut names = Names::new(&[&suffix], &[]);
    let jobs = inputs.into_iter().map(|input| {
        let has_passes = input.as_ref().is_ok_and(project::has_passes);
        let path = match &input {
            Ok(found) if !is_output => {
                let path = output.join(names.assign(found));
                if has_passes {
                    path
                } else {
                    with_suffix(&path, &suffix)
                }
            }
            _ => output.to_owned(),
        };
        Job {
            input,
            path,
            has_passes,
        }
    });
    jobs.collect()
}

/// Returns the language that the arguments or the extension of the output name.
///
/// # Errors
/// They disagree, or the output cannot take the results.
fn target_language(args: &Args, output: &Path, written: Written) -> Result<To, CliError> {
    let standard = output == Path::new("-");
    let several = written != Written::One;
    let of_extension = (!standard && !output.is_dir()).then(|| To::of(output)).flatten();
    let to = match (args.to, of_extension) {
        (Some(to), Some(of)) if !to.may_end_as(of) => {
            let error = CliError::new(format_args!(
                "the extension of {} means {}, but --to is {}",
                path_name(output),
                of.name(),
                to.name()
            ));
            return Err(error.with_help("leave out --to, or give the output another extension"));
        }
        (to, of) => to.or(of),
    };
    let Some(to) = to.or((standard || several || output.is_dir()).then_some(To::Wgsl)) else {
        let error = format!("cannot determine the language of {}", path_name(output));
        return Err(CliError::new(error).with_help(
            "give it an extension (.wgsl .spv .metal .hlsl .frag), or name the language with --to",
        ));
    };
    if several && (standard || of_extension.is_some()) {
        return Err(needs_folder(written, output));
    }
    if standard && to == To::Spv && io::stdout().is_terminal() {
        let error = CliError::new("SPIR-V is binary and is not written to a terminal");
        return Err(error.with_help("name a file with -o"));
    }
    if standard && args.format == Format::Json {
        let error = CliError::new("--format json needs standard output, and so does the converted shader");
        return Err(error.with_help("name a file or a folder with -o"));
    }
    Ok(to)
}

/// Checks that the options apply to the target language.
fn check_target(args: &Args, to: To) -> Result<(), &'static str> {
    if args.style != StyleName::Plain && to != To::Wgsl {
        return Err("--style applies to WGSL only");
    }
    if args.browser && !matches!(to, To::Wgsl | To::Glsl) {
        return Err("--browser applies to WGSL and GLSL, the languages that browsers run");
    }
    Ok(())
}

/// Returns the output that the arguments name, or its default, which several shaders do not have.
fn output(args: &Args, written: Written) -> Result<PathBuf, CliError> {
    match &args.output {
        Some(output) => Ok(output.clone()),
        None if written == Written::One => Ok(PathBuf::from("-")),
        None => Err(needs_folder(written, Path::new("-"))),
    }
}

/// The kind of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Written {
    /// A shader, as one file.
    One,
    /// The passes of a project.
    Passes,
    /// Several shaders or projects.
    Shaders,
}

/// A shader and its output path.
struct Job {
    input: Result<Input, ReadError>,
    /// A file, or the folder of a project with several passes.
    path: PathBuf,
    has_passes: bool,
}

impl Job {
    /// The file that is written last.
    fn last_file(&self) -> PathBuf {
        if self.has_passes {
            self.path.join(GRAPH_FILE)
        } else {
            self.path.clone()
        }
    }

    fn name(&self) -> String {
        match &self.input {
            Ok(input) => input.name(),
            Err(error) => error.name(),
        }
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}

/// The number of shaders by result.
#[derive(Debug, Default)]
struct Tally {
    proved: usize,
    unproved: usize,
    written: usize,
    refused: usize,
}

/// A run over all shaders of one command.
struct Batch<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    layout: Layout,
    to: To,
    output: PathBuf,
    several: bool,
    /// The number of shaders converted at a time.
    threads: usize,
    exit: Exit,
    tally: Tally,
    /// The results so far, for JSON.
    rows: Vec<Row>,
    start: Instant,
}

/// The result of one shader, as JSON has it.
#[derive(Debug, Serialize)]
struct Row {
    shader: String,
    /// The file; null if none was written.
    output: Option<String>,
    status: Status,
    /// The result of the proof, or why nothing was proved.
    message: String,
    diagnostics: Vec<diagnostic::Json>,
}

/// The status of a conversion.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    /// Written without a proof, because no proof was requested.
    Converted,
    Proved,
    Unproved,
    /// Not converted.
    Refused,
}

impl Status {
    /// Its name and color on the terminal.
    fn label(self) -> (&'static str, TextStyle) {
        let (label, color) = match self {
            Self::Converted => ("converted", AnsiColor::Green),
            Self::Proved => ("proved", AnsiColor::Green),
            Self::Unproved => ("unproved", AnsiColor::Yellow),
            Self::Refused => ("refused", AnsiColor::Red),
        };
        (label, TextStyle::new().fg_color(Some(color.into())).bold())
    }
}

/// A shader, its result, and whether its file was written.
type Finished = (Shader, Result<Conversion, Refusal>, bool);

impl Batch<'_> {
    fn convert(mut self, jobs: &[Job], settings: &Settings) -> Result<Exit, CliError> {
        let stop = self
            .terminal
            .watch_interrupts("the shaders in progress are finished first");
        let threads = self.threads;
        let bar = match jobs {
            [one] => self.terminal.spinner(&one.name()),
            several => self.terminal.bar(several.len() as u64, "shaders"),
        };
        let mut order: InOrder<(usize, Finished)> = InOrder::default();
        let todo: Vec<usize> = (0..jobs.len()).collect();
        pool::for_each(
            &todo,
            threads,
            &stop,
            || settings.worker_context(threads),
            |context, index| settings.convert(context, &jobs[index].input),
            |index, (shader, mut converted)| {
                bar.inc(1);
                // The file is written at once; its messages are printed in the order of the inputs.
                let written = self.write(&jobs[index], &mut converted);
                for (index, done) in order.take(index, (index, (shader, converted, written))) {
                    self.finish(&jobs[index], done);
                }
            },
        );
        bar.finish_and_clear();
        for (index, done) in order.rest() {
            self.finish(&jobs[index], done);
        }
        if stop.load(Ordering::Relaxed) {
            self.terminal.error(format_args!(
                "interrupted after {} of {} shaders",
                grouped(self.rows.len() as u64),
                grouped(jobs.len() as u64)
            ));
            self.exit = Exit::Error;
        }
        if self.args.format == Format::Json {
            // Strings, lists and options always serialize.
            let json = serde_json::to_string_pretty(&self.rows).unwrap_or_default() + "\n";
            self.terminal.bytes(json.as_bytes())?;
        } else if self.several {
            self.print_tally();
        }
        Ok(self.exit)
    }

    /// Writes a conversion if it is proved or forced; returns whether it was written.
    fn write(&self, job: &Job, converted: &mut Result<Conversion, Refusal>) -> bool {
        match converted {
            Ok(converted) if converted.status.is_proved() || self.args.force => {
                let written = std::mem::take(&mut converted.files).iter().try_for_each(|file| {
                    let inside = file.name.as_ref().map(|name| job.path.join(name));
                    let path = inside.as_ref().unwrap_or(&job.path);
                    self.terminal.write_output(&self.output, path, &file.bytes)
                });
                written.map_err(|error| self.terminal.fail(&error)).is_ok()
            }
            _ => false,
        }
    }

    /// Reports the result of one shader.
    fn finish(&mut self, job: &Job, (shader, converted, written): Finished) {
        let mut diagnostics = shader.lints.warnings;
        self.tally.written += usize::from(written);
        let (status, message, exit) = match converted {
            Ok(converted) => self.status(&converted, written),
            Err(refusal) => {
                let exit = refusal.exit();
                let message = match refusal {
                    Refusal::Diagnostics(errors, _) => {
                        let count = errors.len() as u64;
                        diagnostics.extend(errors);
                        format!("{} {}", grouped(count), plural(count, "error", "errors"))
                    }
                    Refusal::Message(why, _) | Refusal::Unreadable(why) => why,
                };
                (Status::Refused, message, exit)
            }
        };
        self.exit = self.exit.max(exit);
        // Whoever could not write the file reported why.
        let is_lost = !written && matches!(status, Status::Converted | Status::Proved);
        let message = match is_lost {
            true if message.is_empty() => "not written".to_owned(),
            true => format!("{message}; not written"),
            false => message,
        };
        match status {
            Status::Converted => {}
            Status::Proved => self.tally.proved += 1,
            Status::Unproved => self.tally.unproved += 1,
            Status::Refused => self.tally.refused += 1,
        }
        if self.args.format == Format::Human {
            self.terminal.diagnostics(&diagnostics, &shader.files);
            self.print_row(status, written, job, &message);
        }
        self.rows.push(Row {
            shader: job.name(),
            output: written.then(|| path_name(&job.path)),
            status,
            message,
            diagnostics: diagnostics
                .iter()
                .map(|one| diagnostic::json(one, &shader.files))
                .collect(),
        });
    }

    fn status(&self, converted: &Conversion, written: bool) -> (Status, String, Exit) {
        let exit = if written && converted.status.is_proved() {
            Exit::Success
        } else {
            Exit::Error
        };
        let fallback = converted.fallback.as_ref().map_or_else(String::new, |why| {
            format!("; written by naga, since toyproof's writer failed: {why}")
        });
        let (status, message) = match &converted.status {
            ProofStatus::NotRequested => (Status::Converted, String::new()),
            ProofStatus::Proved(Proved::File(proof, readers)) => {
                let mut message = header::describe_proof(proof);
                message += &header::in_chromium(readers.browser.as_ref());
                message += &fallback;
                (Status::Proved, message)
            }
            ProofStatus::Proved(Proved::Source(proof)) => {
                let mut message = header::describe_proof(proof);
                let _ = write!(message, ", up to naga's {} writer", self.to.name());
                if self.to == To::Hlsl {
                    message += "; install glslang-tools to verify the text too";
                }
                (Status::Proved, message)
            }
            ProofStatus::ProvedPasses(proof) => {
                let mut message = header::describe_passes(proof);
                message += &header::in_chromium(proof.browser.as_ref());
                if proof.readers.is_empty() {
                    let _ = write!(message, ", up to naga's {} writer", self.to.name());
                }
                message += &fallback;
                (Status::Proved, message)
            }
            ProofStatus::NotProved(why) if written => {
                (Status::Unproved, format!("{why}; written because of --force"))
            }
            ProofStatus::NotProved(why) => (
                Status::Unproved,
                format!("{why}; not written (--force writes it anyway)"),
            ),
        };
        (status, message, exit)
    }

    /// Prints the result of a shader; a shader that was only converted is confirmed by the path of its file.
    fn print_row(&self, status: Status, written: bool, job: &Job, message: &str) {
        let row = self.layout.row(status.label(), &job.name(), message);
        match status {
            // The error about the file has been reported.
            Status::Converted if !written || self.output == Path::new("-") => {}
            Status::Converted => self.terminal.note(&format!("{row} → {}", path_name(&job.path))),
            // Without a table of proofs, an error is reported alone.
            Status::Refused if !self.args.verify => self
                .terminal
                .error(format_args!("{} was not converted: {message}", job.name())),
            _ => self.print(&row),
        }
    }

    fn print_tally(&self) {
        let Tally {
            proved,
            unproved,
            written,
            refused,
        } = self.tally;
        let counts = [
            (proved, "proved".to_owned()),
            (unproved, "unproved".to_owned()),
            (refused, "refused".to_owned()),
            (written, format!("written to {}", path_name(&self.output))),
        ];
        let counts: Vec<_> = counts
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, label)| format!("{} {label}", grouped(*count as u64)))
            .collect();
        let all = self.rows.len() as u64;
        self.terminal.note(&format!(
            "\n{} {}: {} ({:.1} s)",
            grouped(all),
            plural(all, "shader", "shaders"),
            counts.join(", "),
            self.start.elapsed().as_secs_f64()
        ));
    }

    /// Prints a line: on standard output, unless the conversion goes there.
    fn print(&self, line: &str) {
        if self.output == Path::new("-") {
            self.terminal.note(line);
        } else {
            self.terminal.result(line);
        }
    }
}

/// Several files cannot be written to one.
fn needs_folder(written: Written, output: &Path) -> CliError {
    let output = if output == Path::new("-") {
        "standard output".to_owned()
    } else {
        path_name(output)
    };
    let what = match written {
        Written::Passes => "the passes of a project",
        Written::One | Written::Shaders => "several shaders",
    };
    CliError::new(format_args!("{what} cannot be written to {output}")).with_help("name a folder with -o")
}
