//! `toyproof convert`

mod conversion;
mod header;
mod tool;

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use clap::ValueEnum;

use self::conversion::{Converter, Made, Standing, Trouble};
use super::inputs::{DriverArgs, LanguageArgs};
use super::pool::{self, InOrder};
use super::shader::{Names, Shader, find, with_suffix};
use super::{Exit, Terminal, interrupt};
use crate::compare::{grouped, plural};
use crate::emit::Target;
use crate::glsl::wgsl::Style;
use crate::gpu::FloatMode;
use crate::source::{Found, ReadError};

const HOSTS: &str = "\
Examples:
  toyproof convert glsl/02-sphere.glsl -o sphere.wgsl --verify
  toyproof convert glsl -o converted --to spv

What a host feeds the result: entry point `main`, colour at location 0. Group 0, binding 0 is a block of
208 bytes (std140): iResolution at byte 0, iTime 12, iTimeDelta 16, iFrame 20, iFrameRate 24, iChannelTime[4]
32 and iChannelResolution[4] 96 (16 bytes each), iMouse 160, iDate 176, iSampleRate 192. The texture of channel
K is binding 1+2K, its sampler 2+2K; only those that the shader uses are declared.

Exit code: 0 if every shader was written (and proved, with --verify), 1 if one is at fault, 2 if there was other
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
    /// Run what was converted and compare it with the shader, pixel by pixel; write it only if they are equal to the bit
    #[arg(long)]
    verify: bool,
    /// The kind of host that WGSL is for: entry point, bindings, direction of y
    #[arg(long, value_enum, default_value_t = StyleName::Plain)]
    style: StyleName,
    /// Write also what could not be proved; its header says so
    #[arg(long, requires = "verify")]
    force: bool,
    /// Convert so many shaders at a time [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum StyleName {
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
    if args.style != StyleName::Plain && to != To::Wgsl {
        terminal.error("--style is for WGSL");
        return Exit::Trouble;
    }
    // People read what is converted: it keeps the author's functions unless told otherwise.
    let float = args.driver.asked_float().unwrap_or(FloatMode::Fast);
    let workers = args.driver.translator().and_then(|_| args.driver.worker());
    let converter = match workers {
        Ok(_) => Converter {
            to,
            float,
            style: args.style.into(),
            verify: args.verify,
            language: &args.language,
            driver: &args.driver,
        },
        Err(error) => {
            terminal.error(error);
            return Exit::Trouble;
        }
    };
    let mut names = Names::default();
    let one = standard || (!several && !args.output.is_dir());
    let jobs = inputs.into_iter().map(|input| {
        let path = match (one, &input) {
            (true, _) | (false, Err(_)) => args.output.clone(),
            (false, Ok(found)) => with_suffix(
                &args.output.join(names.place(&found.relative)),
                &format!(".{}", to.extension()),
            ),
        };
        Job { input, path }
    });
    let jobs: Vec<Job> = jobs.collect();
    Batch {
        args,
        terminal,
        several,
        exit: Exit::Good,
        tally: Tally::default(),
    }
    .convert(&jobs, &converter)
}

/// A shader and where it goes to.
struct Job {
    input: Result<Found, ReadError>,
    path: PathBuf,
}

/// How many came to what.
#[derive(Debug, Default)]
struct Tally {
    proved: usize,
    unproved: usize,
    written: usize,
    refused: usize,
}

/// All shaders of one command.
struct Batch<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    several: bool,
    exit: Exit,
    tally: Tally,
}

/// What came of a shader.
type Done = (Shader, Result<Made, Trouble>);

impl Batch<'_> {
    fn convert(mut self, jobs: &[Job], converter: &Converter) -> Exit {
        let stop = interrupt::watch("finishing the shaders in hand");
        let threads = match self.args.jobs {
            Some(jobs) => usize::from(jobs),
            None => std::thread::available_parallelism().map_or(1, NonZero::get),
        };
        let bar = match jobs {
            [one] => self.terminal.spinner(&one.path.display().to_string()),
            several => self.terminal.bar(several.len() as u64, "converting"),
        };
        let mut order: InOrder<(usize, Done)> = InOrder::default();
        let todo: Vec<usize> = (0..jobs.len()).collect();
        pool::each(
            &todo,
            threads,
            &stop,
            || converter.hand(),
            |hand, index| converter.convert(hand, &jobs[index].input),
            |index, done| {
                bar.inc(1);
                let ready = order.take(index, (index, done));
                bar.suspend(|| {
                    for (index, done) in ready {
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
            self.exit = Exit::Trouble;
        }
        if self.several && self.args.verify {
            self.tell_tally();
        }
        self.exit
    }

    /// Says what came of one, and writes it if it may be written.
    fn finish(&mut self, job: &Job, (shader, made): Done) {
        self.terminal.diagnostics(&shader.warnings, &shader.files);
        let exit = match made {
            Ok(made) => self.write(job, &made),
            Err(trouble) => {
                self.tally.refused += 1;
                let exit = trouble.exit();
                match trouble {
                    Trouble::Told(diagnostics, _) => {
                        self.terminal.diagnostics(&diagnostics, &shader.files);
                        self.tell("refused", job, "see above");
                    }
                    Trouble::Said(why, _) => {
                        if self.args.verify {
                            self.tell("refused", job, &why);
                        } else {
                            self.terminal.error(format_args!("{}: {why}", shader.name));
                        }
                    }
                    Trouble::Unreadable(why) => self.terminal.error(why),
                }
                exit
            }
        };
        self.exit = self.exit.max(exit);
    }

    fn write(&mut self, job: &Job, made: &Made) -> Exit {
        let proved = !matches!(made.standing, Standing::Unproved(_));
        let written = (proved || self.args.force) && self.terminal.write(&job.path, &made.bytes);
        self.tally.written += usize::from(written);
        match &made.standing {
            Standing::Unasked => {}
            Standing::Proved(proof) => {
                self.tally.proved += 1;
                let instead = made.instead.as_ref();
                let instead = instead.map_or_else(String::new, |why| format!("; in naga's words: {why}"));
                self.tell("proved", job, &format!("{}{instead}", header::sum(proof)));
            }
            Standing::Meant(proof, read) => {
                self.tally.proved += 1;
                let read = read.as_deref().unwrap_or("nothing here reads the text itself");
                self.tell("meaning proved", job, &format!("{}; {read}", header::sum(proof)));
            }
            Standing::Unproved(why) => {
                self.tally.unproved += 1;
                let kept = if written {
                    "written all the same"
                } else {
                    "not written"
                };
                self.tell("not proved", job, &format!("{why}; {kept}"));
            }
        }
        match (written, proved) {
            (true, true) => Exit::Good,
            _ => Exit::Trouble,
        }
    }

    /// A line of the table of what was proved: on standard output, unless what was converted goes there.
    fn tell(&self, state: &str, job: &Job, words: &str) {
        if !self.args.verify {
            return;
        }
        let name = job
            .input
            .as_ref()
            .map_or_else(|_| job.path.display().to_string(), Found::name);
        let line = format!("{state:<15}{name}: {words}");
        self.line(&line);
    }

    fn tell_tally(&self) {
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
            self.terminal.say(line);
        } else {
            self.terminal.result(line);
        }
    }
}
