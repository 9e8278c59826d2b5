//! `toyproof check`

mod checker;
mod images;
mod reference;
mod reports;

use std::num::NonZero;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use toyproof_diagnostic::{grouped, nearest, path_name, plural};
use toyproof_verify::Verdict;
use toyproof_verify::contain::{Part, contain};

use self::checker::{Checker, Outcome, Submission, WorkerContext};
use self::images::IMAGES;
pub(super) use self::reference::References;
use self::reports::Results;
use super::inputs::{DriverArgs, Format, FrameArgs, LanguageArgs};
use super::names::Names;
use super::pool::{self, InOrder};
use super::shader::find;
use super::terminal::watch_interrupts;
use super::{Exit, Terminal};
use crate::report::{self, Explanation, Record, Report, Rubric};

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
    /// Write the pictures (reference, actual, difference), verdict.json, results.jsonl, report.html,
    /// report.csv, junit.xml and report.sarif into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Take over what an earlier run into the same folder found, where shader, scene and flags are still the
    /// same
    #[arg(long, requires = "out")]
    resume: bool,
    /// Points for each question; the marks go into results.json, as Gradescope takes them, and into
    /// report.csv
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
        return explain_code(code, terminal);
    }
    // A worker is created and dropped here, so that wrong arguments are reported before any work starts.
    let frame = match args.driver.worker().and_then(|_| args.frame.frame()) {
        Ok(frame) => frame,
        Err(error) => {
            terminal.error(error);
            return Exit::Error;
        }
    };
    let Ok(rubric) = reports::rubric(args, terminal) else {
        return Exit::Error;
    };
    let references = References::new(args.scene.as_deref());
    if !references.is_usable(terminal) {
        return Exit::Error;
    }
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
                return Exit::Error;
            }
        }
    }
    let reserved: Vec<&str> = reports::REPORT_NAMES
        .into_iter()
        .chain([reports::RESULTS_NAME])
        .collect();
    let mut names = Names::new(&IMAGES.map(|picture| picture.suffix), &reserved);
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
        records: Vec::new(),
        device: None,
        is_without_driver: false,
        failed: false,
    };
    batch.check(&submissions, &Checker::new(args, &references, frame));
    batch.finish(&submissions)
}

/// A run over all shaders of one command.
struct Batch<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    rubric: Option<Rubric>,
    results: Option<Results>,
    order: InOrder<(usize, Outcome)>,
    /// The reported records, in order, each with the index of its submission.
    records: Vec<(usize, Record)>,
    device: Option<String>,
    /// Whether no driver is usable.
    is_without_driver: bool,
    /// Whether something failed that no verdict shows.
    failed: bool,
}

impl Batch<'_> {
    fn check(&mut self, submissions: &[Submission], checker: &Checker) {
        let stop = watch_interrupts("finishing the shader in hand");
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
                    self.take(index, Outcome::known(record));
                }
                None => todo.push(index),
            }
        }
        let reused = submissions.len() - todo.len();
        if reused > 0 {
            let of = submissions.len();
            self.terminal.note(&format!(
                "{} of {} {} taken over from an earlier run",
                grouped(reused as u64),
                grouped(of as u64),
                plural(of as u64, "shader is", "shaders are")
            ));
        }
        let threads = match self.args.jobs {
            Some(jobs) => usize::from(jobs),
            None => std::thread::available_parallelism().map_or(1, NonZero::get),
        }
        .clamp(1, todo.len().max(1));
        pool::for_each(
            &todo,
            threads,
            &stop,
            || WorkerContext::new(self.args, threads),
            |context, index| checker.check(context, &submissions[index]),
            |index, outcome| {
                tally.add(outcome.record.verdict);
                bar.inc(1);
                bar.set_message(tally.to_string());
                self.keep(&submissions[index], &outcome);
                bar.suspend(|| self.take(index, outcome));
                if self.terminal.is_closed() {
                    // Nobody reads further results; the shaders in progress are finished.
                    stop.store(true, Ordering::Relaxed);
                }
            },
        );
        bar.finish_and_clear();
        let is_done = self.records.len() == submissions.len();
        if stop.load(Ordering::Relaxed) && !(self.terminal.is_closed() && is_done) {
            for (index, outcome) in std::mem::take(&mut self.order).rest() {
                self.report_outcome(index, outcome);
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
            self.failed = true;
        }
    }

    /// Appends a record to `results.jsonl`.
    fn keep(&mut self, submission: &Submission, outcome: &Outcome) {
        if let (Some(results), Some(key)) = (&mut self.results, &submission.key)
            && let Err(error) = results.add(key, &outcome.record)
        {
            self.terminal.error(format_args!("cannot write {error}"));
            self.failed = true;
        }
    }

    fn take(&mut self, index: usize, outcome: Outcome) {
        for (index, outcome) in self.order.take(index, (index, outcome)) {
            self.report_outcome(index, outcome);
        }
    }

    /// Prints the messages and the result line of a shader.
    fn report_outcome(&mut self, index: usize, outcome: Outcome) {
        for message in &outcome.messages {
            message.print(self.terminal);
        }
        if self.args.format == Format::Human {
            match contain(Part::Summary, || report::line(&outcome.record)) {
                Ok(line) => self.terminal.result(&line),
                Err(panic) => {
                    let Record { shader, verdict, .. } = &outcome.record;
                    self.terminal.result(&format!("{verdict:<12} {shader}"));
                    self.terminal.error(format_args!("{shader}: {panic}"));
                    self.failed = true;
                }
            }
        }
        self.failed |= outcome.failed;
        self.is_without_driver |= outcome.is_without_driver;
        self.device = outcome.device.or(self.device.take());
        self.records.push((index, outcome.record));
    }

    fn finish(self, submissions: &[Submission]) -> Exit {
        let Self {
            args,
            terminal,
            rubric,
            records,
            device,
            results,
            is_without_driver,
            mut failed,
            ..
        } = self;
        let (reported, records): (Vec<_>, Vec<_>) = records
            .into_iter()
            .map(|(index, record)| (&submissions[index], record))
            .unzip();
        let report = Report::new(device, records);
        if args.format == Format::Human {
            terminal.note(&report::summary(report.shaders()));
        } else {
            failed |= !terminal.bytes(report.json().as_bytes());
        }
        if let Some(out) = &args.out {
            // Before the reports are written, which would create the folder again.
            let is_there = results.as_ref().map_or(Ok(()), Results::check_place);
            let written = reports::write(&report, &reported, rubric.as_ref(), out, terminal);
            match is_there {
                Ok(()) if written => {
                    terminal.note(&format!("pictures and reports are in {}", path_name(out)));
                }
                Ok(()) => failed = true,
                Err(error) => {
                    terminal.error(format_args!(
                        "results and pictures were removed while they were written: {error}; run the command again"
                    ));
                    failed = true;
                }
            }
        }
        if is_without_driver {
            terminal.detail("`toyproof doctor` tells more of the drivers");
        }
        let verdicts = || report.shaders().iter().map(|record| record.verdict);
        if failed || verdicts().any(|verdict| verdict == Verdict::Error) {
            Exit::Error
        } else if verdicts().all(Verdict::is_good) {
            Exit::Success
        } else {
            Exit::ShaderFault
        }
    }
}

/// Prints the explanation of a diagnostic code: `toyproof check --explain CODE`.
fn explain_code(code: &str, terminal: &Terminal) -> Exit {
    let Some(Explanation { code, title, text }) = report::explain(code) else {
        let codes = report::explanations().map(|explanation| explanation.code);
        let hint = match nearest(code, codes) {
            Some(near) => format!("did you mean {near}?"),
            None => "codes are E or W and four digits, as in error[E0301]".to_owned(),
        };
        terminal.error(format_args!("there is no code {code}; {hint}"));
        return Exit::Error;
    };
    terminal.result(&format!("{code}: {title}\n\n{}", plain(text)));
    Exit::Success
}

/// Converts Markdown for a terminal: fenced code is indented instead.
fn plain(text: &str) -> String {
    let mut fenced = false;
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            fenced = !fenced;
        } else if fenced {
            lines.push(format!("    {line}"));
        } else {
            lines.push(line.to_owned());
        }
    }
    lines.join("\n")
}
