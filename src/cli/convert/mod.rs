//! `toyproof convert`

mod conversion;
mod header;

use std::fmt::Write as _;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use clap::ValueEnum;
use toyproof_diagnostic::{grouped, path_name, plural};
use toyproof_gpu::browser;
use toyproof_translate::FloatMode;
use toyproof_translate::backend::Target;
use toyproof_translate::wgsl::Style;
use toyproof_verify::conversion::{Converter, Proved};

use self::conversion::{ConvertedFile, ProofStatus, Refusal, Settings};
use super::inputs::{DriverArgs, LanguageArgs, may_write};
use super::names::{Names, with_suffix};
use super::pool::{self, InOrder};
use super::shader::{Shader, find};
use super::terminal::watch_interrupts;
use super::{Exit, Terminal};
use crate::cli::files::{Input, ReadError};

const HOSTS: &str = "\
Examples:
  toyproof convert glsl/02-sphere.glsl -o sphere.wgsl --verify
  toyproof convert glsl -o converted --to spv

What a host feeds the result: entry point `main`, colour at location 0. Group 0, binding 0 is a block of 208 bytes \
(std140): iResolution at byte 0, iTime 12, iTimeDelta 16, iFrame 20, iFrameRate 24, iChannelTime[4] 32 and \
iChannelResolution[4] 96 (16 bytes each), iMouse 160, iDate 176, iSampleRate 192. The texture of channel K is \
binding 1+2K, its sampler 2+2K; only those that the shader uses are declared.

Exit code: 0 if every shader was written (and proved, with --verify), 1 if one is at fault, 2 if there was other \
trouble, as where a conversion is not proved.";

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
    /// Run what was converted and compare it with the shader, pixel by pixel; write it only if they are
    /// equal to the bit
    #[arg(long)]
    verify: bool,
    /// Have Chromium paint it too: WGSL with WebGPU, or GLSL with WebGL 2, beside the shader itself with
    /// WebGL 2, on its software driver; as shown, no color may differ by more than 1/255
    #[arg(long, requires = "verify")]
    browser: bool,
    /// The kind of host that WGSL is for: entry point, bindings, direction of y
    #[arg(long, value_enum, default_value_t = StyleName::Plain)]
    style: StyleName,
    /// Write also what could not be proved; its header says so
    #[arg(long, requires = "verify")]
    force: bool,
    /// Convert so many shaders at a time [default: as many as there are cores]
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
    Spv,
    Metal,
    Hlsl,
    Glsl,
    /// The GLSL that naga is fed
    Lowered,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum StyleName {
    /// A fragment shader with the bindings below; row 0 of its target is the bottom
    Plain,
    /// `shader_main` for the Python package of that name
    WgpuShadertoy,
    /// A compute shader for compute.toys
    ComputeToys,
    /// A Material2d of Bevy
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

    /// Its name on the command line.
    pub(super) fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Returns whether it may be written to a file with the extension of `other`: what naga is fed is GLSL.
    pub(super) fn may_end_as(self, other: Self) -> bool {
        self == other || (self, other) == (Self::Lowered, Self::Glsl)
    }

    pub(super) fn of(path: &Path) -> Option<Self> {
        let target = Target::of(path)?;
        Self::value_variants()
            .iter()
            .copied()
            .find(|to| to.target() == Some(target))
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let inputs = find(&args.shaders, terminal);
    let standard = args.output == Path::new("-");
    let of_extension = (!standard && !args.output.is_dir())
        .then(|| To::of(&args.output))
        .flatten();
    let several = inputs.len() > 1 || args.shaders.iter().any(|path| path.is_dir());
    let Some(to) = args.to.or(of_extension) else {
        terminal.error(format_args!(
            "{}: say the language with --to, or end the file's name in .wgsl, .spv, .metal, .hlsl or .frag",
            path_name(&args.output)
        ));
        return Exit::Error;
    };
    if let Some(of) = of_extension
        && !to.may_end_as(of)
    {
        terminal.error(format_args!(
            "{} ends as {} does, and --to says {}; leave --to out, or give the file another ending",
            path_name(&args.output),
            of.name(),
            to.name()
        ));
        return Exit::Error;
    }
    if several && (standard || of_extension.is_some()) {
        terminal.error(format_args!(
            "several shaders need a folder to go to, not {}",
            path_name(&args.output)
        ));
        return Exit::Error;
    }
    if args.style != StyleName::Plain && to != To::Wgsl {
        terminal.error("--style is for WGSL");
        return Exit::Error;
    }
    if args.browser && !matches!(to, To::Wgsl | To::Glsl) {
        terminal.error("--browser is for WGSL and GLSL, which browsers run");
        return Exit::Error;
    }
    let browser = args.browser.then(browser::find).flatten();
    if args.browser && browser.is_none() {
        terminal.error("--browser needs Chromium, and none is installed here (apt-get install chromium)");
        return Exit::Error;
    }
    // People read converted shaders: by default they keep the author's functions.
    let float = args.driver.explicit_float().unwrap_or(FloatMode::Fast);
    let workers = args.driver.translator().and_then(|_| args.driver.worker());
    if let Err(error) = workers {
        terminal.error(error);
        return Exit::Error;
    }
    let settings = Settings {
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
    let threads = args
        .jobs
        .map_or_else(cores, usize::from)
        .clamp(1, inputs.len().max(1));
    let one = standard || (!several && !args.output.is_dir());
    let suffix = format!(".{}", to.extension());
    let mut names = Names::new(&[&suffix], &[]);
    let jobs = inputs.into_iter().map(|input| {
        let path = match (one, &input) {
            (true, _) | (false, Err(_)) => args.output.clone(),
            (false, Ok(found)) => with_suffix(&args.output.join(names.assign(found)), &suffix),
        };
        Job { input, path }
    });
    let jobs: Vec<Job> = jobs.collect();
    let originals = jobs
        .iter()
        .filter_map(|job| job.input.as_ref().ok()?.path())
        .collect();
    if !jobs.iter().all(|job| may_write(&job.path, &originals, terminal)) {
        return Exit::Error;
    }
    Batch {
        args,
        terminal,
        several,
        threads,
        exit: Exit::Success,
        tally: Tally::default(),
    }
    .convert(&jobs, &settings)
}

/// A shader and its output path.
struct Job {
    input: Result<Input, ReadError>,
    path: PathBuf,
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
    several: bool,
    /// The number of shaders converted at a time.
    threads: usize,
    exit: Exit,
    tally: Tally,
}

/// A shader, its result, and whether its file was written.
type Finished = (Shader, Result<ConvertedFile, Refusal>, bool);

impl Batch<'_> {
    fn convert(mut self, jobs: &[Job], settings: &Settings) -> Exit {
        let stop = watch_interrupts("finishing the shaders in hand");
        let threads = self.threads;
        let bar = match jobs {
            [one] => self.terminal.spinner(&path_name(&one.path)),
            several => self.terminal.bar(several.len() as u64, "converting"),
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
                bar.suspend(|| {
                    // The file is written at once; its messages wait for their turn.
                    let written = self.write(&jobs[index], &mut converted);
                    for (index, done) in order.take(index, (index, (shader, converted, written))) {
                        self.finish(&jobs[index], done);
                    }
                });
            },
        );
        bar.finish_and_clear();
        for (index, done) in order.rest() {
            self.finish(&jobs[index], done);
        }
        if stop.load(Ordering::Relaxed) {
            self.terminal.error("interrupted; what was done is kept");
            self.exit = Exit::Error;
        }
        if self.several && self.args.verify {
            self.print_tally();
        }
        self.exit
    }

    /// Writes a conversion if it is proved or forced; returns whether it was written.
    fn write(&self, job: &Job, converted: &mut Result<ConvertedFile, Refusal>) -> bool {
        match converted {
            Ok(converted) if converted.status.is_proved() || self.args.force => {
                let bytes = std::mem::take(&mut converted.bytes);
                self.terminal.write_output(&self.args.output, &job.path, &bytes)
            }
            _ => false,
        }
    }

    /// Reports the result of one shader.
    fn finish(&mut self, job: &Job, (shader, converted, written): Finished) {
        self.terminal.diagnostics(&shader.lints.warnings, &shader.files);
        self.tally.written += usize::from(written);
        let exit = match converted {
            Ok(converted) => self.report_status(job, &converted, written),
            Err(refusal) => {
                self.tally.refused += 1;
                let exit = refusal.exit();
                match refusal {
                    Refusal::Diagnostics(diagnostics, _) => {
                        self.terminal.diagnostics(&diagnostics, &shader.files);
                        self.print_row("refused", job, "see above");
                    }
                    Refusal::Message(why, _) => {
                        if self.args.verify {
                            self.print_row("refused", job, &why);
                        } else {
                            self.terminal.error(format_args!("{}: {why}", shader.name));
                        }
                    }
                    Refusal::Unreadable(why) => self.terminal.error(why),
                }
                exit
            }
        };
        self.exit = self.exit.max(exit);
    }

    fn report_status(&mut self, job: &Job, converted: &ConvertedFile, written: bool) -> Exit {
        match &converted.status {
            ProofStatus::NotRequested => {}
            ProofStatus::Proved(Proved::File(proof, readers)) => {
                self.tally.proved += 1;
                let mut message = header::describe_proof(proof);
                if let Some((_, shown)) = readers.browser {
                    let _ = write!(message, "; in Chromium {}", header::describe_browser(shown));
                }
                if let Some(why) = &converted.fallback {
                    let _ = write!(message, "; in naga's words: {why}");
                }
                self.print_row("proved", job, &message);
            }
            ProofStatus::Proved(Proved::Source(proof)) => {
                self.tally.proved += 1;
                let equal = header::describe_proof(proof);
                self.print_row(
                    "meaning proved",
                    job,
                    &format!("{equal}; nothing here reads the text itself"),
                );
            }
            ProofStatus::NotProved(why) => {
                self.tally.unproved += 1;
                let kept = if written {
                    "written all the same"
                } else {
                    "not written"
                };
                self.print_row("not proved", job, &format!("{why}; {kept}"));
            }
        }
        if written && converted.status.is_proved() {
            Exit::Success
        } else {
            Exit::Error
        }
    }

    /// Prints a line of the proof table: on standard output, unless the conversion goes there.
    fn print_row(&self, state: &str, job: &Job, message: &str) {
        if !self.args.verify {
            return;
        }
        let name = job
            .input
            .as_ref()
            .map_or_else(|_| path_name(&job.path), Input::name);
        let line = format!("{state:<15}{name}: {message}");
        self.line(&line);
    }

    fn print_tally(&self) {
        let Tally {
            proved,
            unproved,
            written,
            refused,
        } = self.tally;
        let all = proved + unproved + refused;
        let counts = [all, proved, unproved, refused, written].map(|count| grouped(count as u64));
        let [all_, proved, unproved, refused, written] = counts;
        self.line(&format!(
            "{all_} {}: {proved} proved, {unproved} not proved, {refused} refused; {written} written",
            plural(all as u64, "shader", "shaders")
        ));
    }

    fn line(&self, line: &str) {
        if self.args.output == Path::new("-") {
            self.terminal.note(line);
        } else {
            self.terminal.result(line);
        }
    }
}
