//! `toyproof check`

mod gallery;
mod judge;
mod pictures;
mod reference;
mod reports;
mod results;
mod scenes;
mod stopped;

use std::num::NonZero;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use toyproof_diagnostic::path_name;
use toyproof_gpu::INSTALL_HINT;
use toyproof_verify::compare::{Verdict, grouped, plural};
use toyproof_verify::contain::{Part, contain};

use self::judge::{Hand, Judge, Judged, Submission};
use self::pictures::PICTURES;
pub(super) use self::reference::References;
use self::results::Results;
use super::inputs::{DriverArgs, Format, FrameArgs, LanguageArgs};
use super::names::Names;
use super::pool::{self, InOrder};
use super::shader::find;
use super::{Exit, Terminal, codes, interrupt};
use crate::report::{self, Record, Report, Rubric};

/// Compare what shaders paint with the reference tracer, and give a verdict on each
///
/// The scene of a shader is the one that --scene names, else the .toml beside it. A shader without a scene is
/// `ok` if it paints.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  toyproof check glsl --out out\n  \
                        toyproof check homework.glsl --scene glsl/02-sphere.toml --format json\n\n\
                        Exit code: 0 if every shader is correct or ok, 1 if one is not, 2 if there was other trouble.")]
pub(super) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required_unless_present = "explain")]
    shaders: Vec<PathBuf>,
    /// Say what a code such as E0301 means, with examples, and do nothing else
    #[arg(long, value_name = "CODE", exclusive = true)]
    explain: Option<String>,
    /// The scene of all these shaders
    #[arg(long, value_name = "SCENE.toml")]
    scene: Option<PathBuf>,
    /// Write the pictures (reference, actual, difference), verdict.json, results.jsonl, report.html, report.csv, junit.xml and
    /// report.sarif into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Take over what an earlier run into the same folder found, where shader, scene and flags are still the same
    #[arg(long, requires = "out")]
    resume: bool,
    /// Points for each question; the marks go into results.json, as Gradescope takes them, and into report.csv
    #[arg(long, value_name = "RUBRIC.toml", requires = "out")]
    rubric: Option<PathBuf>,
    /// Check so many shaders at a time [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), allow_negative_numbers = true)]
    jobs: Option<u16>,
    /// What goes to standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    format: Format,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    if let Some(code) = &args.explain {
        return codes::run(code, terminal);
    }
    // The arguments are asked for a worker once here, so that what is wrong with them is told before anything is done.
    let frame = match args.driver.worker().and_then(|_| args.frame.frame()) {
        Ok(frame) => frame,
        Err(error) => {
            terminal.error(error);
            return Exit::Trouble;
        }
    };
    let Ok(rubric) = reports::rubric(args, terminal) else {
        return Exit::Trouble;
    };
    let mut results = None;
    if let Some(out) = &args.out {
        match Results::open(out, args.resume) {
            Ok(opened) => {
                if let broken @ 1.. = opened.broken as u64 {
                    terminal.warn(format_args!(
                        "{} {} of results.jsonl cannot be read and {} skipped: what {} of is checked again",
                        grouped(broken),
                        plural(broken, "line", "lines"),
                        plural(broken, "was", "were"),
                        plural(broken, "it told", "they told"),
                    ));
                }
                results = Some(opened);
            }
            Err(error) => {
                terminal.error(format_args!("cannot write {error}"));
                return Exit::Trouble;
            }
        }
    }
    let reserved: Vec<&str> = reports::NAMES.into_iter().chain([results::NAME]).collect();
    let mut names = Names::new(&PICTURES.map(|picture| picture.suffix), &reserved);
    let references = References::new(args.scene.as_deref());
    let submissions: Vec<Submission> = find(&args.shaders, terminal)
        .into_iter()
        .map(|input| Submission::new(input, args, &references, &mut names))
        .collect();
    let mut batch = Batch {
        args,
        terminal,
        rubric,
        results,
        order: InOrder::default(),
        told: Vec::new(),
        device: None,
        trouble: false,
    };
    batch.check(&submissions, &Judge::new(args, &references, frame));
    batch.finish(&submissions)
}

/// What a driver that ended loops by force means for a shader.
pub(super) fn cut_short(pixels: u64) -> String {
    format!(
        "a loop never ends, or runs longer than this driver allows: it was ended by force in {} {} \
         (Mesa before 23 stops at 65,535 iterations)",
        grouped(pixels),
        plural(pixels, "pixel", "pixels")
    )
}

/// All shaders of one command.
struct Batch<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    rubric: Option<Rubric>,
    results: Option<Results>,
    order: InOrder<(usize, Judged)>,
    /// The records that have been told of, in order, each with the place of its submission.
    told: Vec<(usize, Record)>,
    device: Option<String>,
    /// Something failed that no verdict tells.
    trouble: bool,
}

impl Batch<'_> {
    fn check(&mut self, submissions: &[Submission], judge: &Judge) {
        let stop = interrupt::watch("finishing the shader in hand");
        let bar = match submissions {
            [one] => self.terminal.spinner(&one.name),
            several => self.terminal.bar(several.len() as u64, "checking"),
        };
        let mut tally = report::Tally::default();
        let mut todo = Vec::new();
        for (index, submission) in submissions.iter().enumerate() {
            let key = submission.key.as_deref();
            let known = key.and_then(|key| self.results.as_mut()?.known(key));
            match known {
                Some(record) => {
                    tally.add(record.verdict);
                    bar.inc(1);
                    self.take(index, Judged::known(record));
                }
                None => todo.push(index),
            }
        }
        let taken_over = submissions.len() - todo.len();
        if taken_over > 0 {
            let of = submissions.len();
            self.terminal.say(&format!(
                "{} of {} {} taken over from an earlier run",
                grouped(taken_over as u64),
                grouped(of as u64),
                plural(of as u64, "shader is", "shaders are")
            ));
        }
        let threads = match self.args.jobs {
            Some(jobs) => usize::from(jobs),
            None => std::thread::available_parallelism().map_or(1, NonZero::get),
        }
        .clamp(1, todo.len().max(1));
        pool::each(
            &todo,
            threads,
            &stop,
            || Hand::new(self.args, threads),
            |hand, index| judge.judge(hand, &submissions[index]),
            |index, judged| {
                tally.add(judged.record.verdict);
                bar.inc(1);
                bar.set_message(tally.to_string());
                self.keep(&submissions[index], &judged);
                bar.suspend(|| self.take(index, judged));
                if self.terminal.is_closed() {
                    // Nobody reads what comes; the shaders in hand are finished.
                    stop.store(true, Ordering::Relaxed);
                }
            },
        );
        bar.finish_and_clear();
        let is_done = self.told.len() == submissions.len();
        if stop.load(Ordering::Relaxed) && !(self.terminal.is_closed() && is_done) {
            for (index, judged) in std::mem::take(&mut self.order).rest() {
                self.tell(index, judged);
            }
            let how = match self.args.out {
                Some(_) => "; the same command with --resume goes on",
                None => "",
            };
            let why = if self.terminal.is_closed() {
                "standard output was closed"
            } else {
                "interrupted"
            };
            self.terminal
                .error(format_args!("{why}; what was done is kept{how}"));
            self.trouble = true;
        }
    }

    /// Adds a record to the file of results.
    fn keep(&mut self, submission: &Submission, judged: &Judged) {
        if let (Some(results), Some(key)) = (&mut self.results, &submission.key)
            && let Err(error) = results.add(key, &judged.record)
        {
            self.terminal.error(format_args!("cannot write {error}"));
            self.trouble = true;
        }
    }

    fn take(&mut self, index: usize, judged: Judged) {
        for (index, judged) in self.order.take(index, (index, judged)) {
            self.tell(index, judged);
        }
    }

    /// Says what was found of a shader.
    fn tell(&mut self, index: usize, judged: Judged) {
        for said in &judged.said {
            said.say(self.terminal);
        }
        if self.args.format == Format::Human {
            match contain(Part::Summary, || report::line(&judged.record)) {
                Ok(line) => self.terminal.result(&line),
                Err(panic) => {
                    let Record { shader, verdict, .. } = &judged.record;
                    self.terminal.result(&format!("{verdict:<12} {shader}"));
                    self.terminal.error(format_args!("{shader}: {panic}"));
                    self.trouble = true;
                }
            }
        }
        self.trouble |= judged.trouble;
        self.device = judged.device.or(self.device.take());
        self.told.push((index, judged.record));
    }

    fn finish(self, submissions: &[Submission]) -> Exit {
        let Self {
            args,
            terminal,
            rubric,
            told,
            device,
            results,
            mut trouble,
            ..
        } = self;
        let (told_of, told): (Vec<_>, Vec<_>) = told
            .into_iter()
            .map(|(index, record)| (&submissions[index], record))
            .unzip();
        let no_driver = told.iter().any(|record| record.reason.contains(INSTALL_HINT));
        let report = Report::new(device, told);
        if args.format == Format::Human {
            terminal.say(&report::summary(report.shaders()));
        } else {
            trouble |= !terminal.bytes(report.json().as_bytes());
        }
        if let Some(out) = &args.out {
            // Before the reports, which would make the folder anew.
            let is_there = results.as_ref().map_or(Ok(()), Results::check_place);
            let written = reports::write(&report, &told_of, rubric.as_ref(), out, terminal);
            match is_there {
                Ok(()) if written => {
                    terminal.say(&format!("pictures and reports are in {}", path_name(out)));
                }
                Ok(()) => trouble = true,
                Err(error) => {
                    terminal.error(format_args!(
                        "results and pictures were removed while they were written: {error}; run the command again"
                    ));
                    trouble = true;
                }
            }
        }
        if no_driver {
            terminal.detail("`toyproof doctor` tells more of the drivers");
        }
        let verdicts = || report.shaders().iter().map(|record| record.verdict);
        if trouble || verdicts().any(|verdict| verdict == Verdict::Error) {
            Exit::Trouble
        } else if verdicts().all(Verdict::is_good) {
            Exit::Good
        } else {
            Exit::Bad
        }
    }
}
