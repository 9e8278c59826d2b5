//! `toyproof convert`

mod args;
mod conversion;
mod header;
mod proof;
mod tool;

use std::fmt::Write as _;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use toyproof_diagnostic::path_name;
use toyproof_gpu::browser;
use toyproof_translate::FloatMode;
use toyproof_verify::compare::{grouped, plural};

pub(super) use self::args::Args;
use self::args::{StyleName, To};
use self::conversion::{Converter, Made, Trouble};
use self::proof::Standing;
use super::inputs::may_write;
use super::names::{Names, with_suffix};
use super::pool::{self, InOrder};
use super::shader::{Shader, find};
use super::{Exit, Terminal, interrupt};
use crate::cli::files::{Found, ReadError};

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
        return Exit::Trouble;
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
        return Exit::Trouble;
    }
    if several && (standard || of_extension.is_some()) {
        terminal.error(format_args!(
            "several shaders need a folder to go to, not {}",
            path_name(&args.output)
        ));
        return Exit::Trouble;
    }
    if args.style != StyleName::Plain && to != To::Wgsl {
        terminal.error("--style is for WGSL");
        return Exit::Trouble;
    }
    if args.browser && !matches!(to, To::Wgsl | To::Glsl) {
        terminal.error("--browser is for WGSL and GLSL, which browsers run");
        return Exit::Trouble;
    }
    let browser = args.browser.then(browser::find).flatten();
    if args.browser && browser.is_none() {
        terminal.error("--browser needs Chromium, and none is installed here (apt-get install chromium)");
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
            browser,
            language: &args.language,
            driver: &args.driver,
        },
        Err(error) => {
            terminal.error(error);
            return Exit::Trouble;
        }
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
            (false, Ok(found)) => with_suffix(&args.output.join(names.place(found)), &suffix),
        };
        Job { input, path }
    });
    let jobs: Vec<Job> = jobs.collect();
    let originals = jobs
        .iter()
        .filter_map(|job| job.input.as_ref().ok()?.path())
        .collect();
    if !jobs.iter().all(|job| may_write(&job.path, &originals, terminal)) {
        return Exit::Trouble;
    }
    Batch {
        args,
        terminal,
        several,
        threads,
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

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
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
    /// So many at a time.
    threads: usize,
    exit: Exit,
    tally: Tally,
}

/// What came of a shader, and whether its file was written.
type Done = (Shader, Result<Made, Trouble>, bool);

impl Batch<'_> {
    fn convert(mut self, jobs: &[Job], converter: &Converter) -> Exit {
        let stop = interrupt::watch("finishing the shaders in hand");
        let threads = self.threads;
        let bar = match jobs {
            [one] => self.terminal.spinner(&path_name(&one.path)),
            several => self.terminal.bar(several.len() as u64, "converting"),
        };
        let mut order: InOrder<(usize, Done)> = InOrder::default();
        let todo: Vec<usize> = (0..jobs.len()).collect();
        pool::each(
            &todo,
            threads,
            &stop,
            || converter.hand(threads),
            |hand, index| converter.convert(hand, &jobs[index].input),
            |index, (shader, mut made)| {
                bar.inc(1);
                bar.suspend(|| {
                    // A file is there as soon as it can be; what is said of it waits for its turn.
                    let written = self.write(&jobs[index], &mut made);
                    for (index, done) in order.take(index, (index, (shader, made, written))) {
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

    /// Writes one if it may be written; says whether it is.
    fn write(&self, job: &Job, made: &mut Result<Made, Trouble>) -> bool {
        match made {
            Ok(made) if made.is_proved() || self.args.force => {
                let bytes = std::mem::take(&mut made.bytes);
                self.terminal.write_output(&self.args.output, &job.path, &bytes)
            }
            _ => false,
        }
    }

    /// Says what came of one.
    fn finish(&mut self, job: &Job, (shader, made, written): Done) {
        self.terminal.diagnostics(&shader.lints.warnings, &shader.files);
        self.tally.written += usize::from(written);
        let exit = match made {
            Ok(made) => self.tell_standing(job, &made, written),
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

    fn tell_standing(&mut self, job: &Job, made: &Made, written: bool) -> Exit {
        match &made.standing {
            Standing::Unasked => {}
            Standing::Proved(proof, readers) => {
                self.tally.proved += 1;
                let mut words = header::sum(proof);
                if let Some((_, shown)) = readers.browser {
                    let _ = write!(words, "; in Chromium {}", header::told(shown));
                }
                if let Some(why) = &made.instead {
                    let _ = write!(words, "; in naga's words: {why}");
                }
                self.tell("proved", job, &words);
            }
            Standing::Meant(proof) => {
                self.tally.proved += 1;
                let sum = header::sum(proof);
                self.tell(
                    "meaning proved",
                    job,
                    &format!("{sum}; nothing here reads the text itself"),
                );
            }
            Standing::Unproved(why) | Standing::Untried(why) => {
                self.tally.unproved += 1;
                let kept = if written {
                    "written all the same"
                } else {
                    "not written"
                };
                self.tell("not proved", job, &format!("{why}; {kept}"));
            }
        }
        if written && made.is_proved() {
            Exit::Good
        } else {
            Exit::Trouble
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
            .map_or_else(|_| path_name(&job.path), Found::name);
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
