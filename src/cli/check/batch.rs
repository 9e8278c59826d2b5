//! A run over all shaders of one command: their results are reported in order, while the next are checked.

use std::collections::HashSet;
use std::num::NonZero;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use toyproof_classroom::decisions::Decisions;
use toyproof_diagnostic::{Severity, grouped, path_name, plural};
use toyproof_project::files::Input;
use toyproof_report::{self as report, Detail, Earlier, Layout, Record, Report, Rubrics, Tally};
use toyproof_verify::Verdict;
use toyproof_verify::contain::{Part, contain};

use super::checker::{Checker, WorkerContext};
use super::decisions::decided;
use super::feedback;
use super::options::{BatchOptions, CheckFormat};
use super::outcome::{Log, Message, Outcome};
use super::reference::unused_scene;
use super::reports;
use super::results::{Line, Results};
use super::submission::Submission;
use crate::cli::inputs::{DriverArgs, shell_word, short_device};
use crate::cli::pool::{self, InOrder};
use crate::cli::{Exit, Terminal};

/// The largest number of shaders whose errors and warnings are shown with their source lines: more would not
/// fit on a screen.
const MAX_WITH_SOURCE: usize = 3;

/// The layout of the lines of all shaders.
fn layout(submissions: &[Submission], format: CheckFormat, terminal: &Terminal) -> Layout {
    let detail = match (terminal.is_quiet(), terminal.is_verbose()) {
        (true, _) => Detail::Short,
        (_, true) => Detail::Full,
        _ => Detail::Normal,
    };
    let names = submissions.iter().map(|submission| submission.name.as_str());
    // Each line of the short form is one diagnostic.
    let width = terminal.width().filter(|_| format == CheckFormat::Human);
    Layout {
        lists_diagnostics: submissions.len() > MAX_WITH_SOURCE,
        ..Layout::new(names, width, detail)
    }
}

/// A run over all shaders of one command.
pub(super) struct Batch<'a> {
    pub(super) options: &'a BatchOptions,
    pub(super) terminal: &'a Terminal,
    rubrics: Rubrics,
    pub(super) decisions: &'a Decisions,
    results: Option<Results>,
    /// The report that is compared with.
    earlier: Option<Earlier>,
    /// The results that wait for their turn, each with the index of its submission.
    order: InOrder<(usize, Outcome)>,
    /// The reported records, in order, without decisions.
    pub(super) records: Vec<Record>,
    /// The index of each one's submission.
    pub(super) reported: Vec<usize>,
    device: Option<String>,
    /// Whether something failed that no verdict shows.
    pub(super) failed: bool,
    pub(super) layout: Layout,
    /// The submissions that are wrong, and that no edit repairs.
    pub(super) unrepaired: HashSet<usize>,
    /// Whether errors and warnings are shown with their source lines.
    has_sources: bool,
    /// The number of warnings that were not shown.
    hidden_warnings: u64,
    start: Instant,
}

impl<'a> Batch<'a> {
    pub(super) fn new(
        options: &'a BatchOptions,
        rubrics: Rubrics,
        decisions: &'a Decisions,
        results: Option<Results>,
        earlier: Option<Earlier>,
        submissions: &[Submission],
        terminal: &'a Terminal,
    ) -> Self {
        Self {
            options,
            terminal,
            rubrics,
            decisions,
            results,
            earlier,
            order: InOrder::default(),
            records: Vec::new(),
            reported: Vec::new(),
            device: None,
            failed: false,
            layout: layout(submissions, options.format, terminal),
            unrepaired: HashSet::new(),
            has_sources: submissions.len() <= MAX_WITH_SOURCE,
            hidden_warnings: 0,
            start: Instant::now(),
        }
    }

    /// Checks the submissions, and prints the result of each.
    pub(super) fn check(&mut self, submissions: &[Submission], checkers: &[Checker], driver: &DriverArgs) {
        let stop = self
            .terminal
            .watch_interrupts("the shaders in progress are finished first");
        let bar = match submissions {
            [one] => self.terminal.spinner(&one.name),
            several => self.terminal.bar(several.len() as u64, "shaders"),
        };
        let mut tally = Tally::default();
        let mut todo = Vec::new();
        for (index, submission) in submissions.iter().enumerate() {
            if let Some(outcome) = self.known(submission) {
                bar.inc(1);
                self.take(submissions, index, outcome);
            } else {
                todo.push(index);
            }
        }
        let reused = submissions.len() - todo.len();
        if self.options.resume && reused > 0 {
            let of = submissions.len();
            self.terminal.note(&format!(
                "{} of {} {} reused from an earlier run",
                grouped(reused as u64),
                grouped(of as u64),
                plural(of as u64, "result is", "results are")
            ));
        }
        let threads = self.threads(todo.len());
        let pixels = checkers.iter().map(Checker::pixels).max().unwrap_or(0);
        pool::for_each(
            &todo,
            threads,
            &stop,
            || WorkerContext::new(driver, threads, pixels),
            |context, index| {
                let submission = &submissions[index];
                checkers[submission.task].check(context, submission)
            },
            |index, outcome| {
                tally.add(outcome.record.verdict);
                bar.inc(1);
                bar.set_message(self.terminal.bar_text(&tally));
                self.keep(&submissions[index], &outcome);
                self.take(submissions, index, outcome);
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
                self.report(submissions, index, outcome);
            }
            let why = if self.terminal.is_closed() {
                "standard output was closed"
            } else {
                "interrupted"
            };
            self.terminal.error(format_args!(
                "{why} after {} of {} shaders",
                grouped(self.records.len() as u64),
                grouped(submissions.len() as u64)
            ));
            if self.options.out.is_some() {
                self.terminal
                    .help("run the same command with --resume to check the others");
            }
            self.failed = true;
        } else if self.options.searches_again {
            self.search_again(submissions, checkers, &stop);
        }
    }

    /// The number of threads for that number of shaders.
    pub(super) fn threads(&self, shaders: usize) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
        let threads = self.options.jobs.unwrap_or_else(cores);
        threads.clamp(1, shaders.max(1))
    }

    /// Appends a record to `results.jsonl`, unless `--resume` has to check its shader again.
    fn keep(&mut self, submission: &Submission, outcome: &Outcome) {
        if let (Some(results), Some(key)) = (&mut self.results, &submission.key)
            && !outcome.log.lacks_image
        {
            let line = Line {
                key: key.clone(),
                record: outcome.record.clone(),
                device: outcome.log.device.clone(),
            };
            if let Err(error) = results.add(&line) {
                self.terminal.error(format_args!("cannot write {error}"));
                self.failed = true;
            }
        }
    }

    /// Reports the results whose turn it is, once another one has arrived.
    fn take(&mut self, submissions: &[Submission], index: usize, outcome: Outcome) {
        for (index, outcome) in self.order.take(index, (index, outcome)) {
            self.report(submissions, index, outcome);
        }
    }

    /// The result of an earlier run, if there is one.
    fn known(&self, submission: &Submission) -> Option<Outcome> {
        let line = self.results.as_ref()?.known(submission.key.as_ref()?)?;
        Some(Outcome {
            record: line.record.clone(),
            log: Log {
                device: line.device.clone(),
                ..Log::default()
            },
        })
    }

    /// Prints the messages and the result line of a shader.
    fn report(&mut self, submissions: &[Submission], index: usize, outcome: Outcome) {
        let Outcome { record, log } = outcome;
        if record.verdict == Verdict::Wrong && record.fix.is_none() {
            self.unrepaired.insert(index);
        }
        let submitted = submissions[index].submitted.clone();
        let record = Record { submitted, ..record }.redacted(self.options.teachers_hints);
        for message in &log.messages {
            self.print(message, record.verdict);
        }
        match self.options.format {
            CheckFormat::Human => match contain(Part::Summary, || self.lines(&record)) {
                Ok(lines) => self.terminal.result(&lines),
                Err(panic) => {
                    let Record { shader, verdict, .. } = &record;
                    self.terminal.result(&format!("{verdict:<12} {shader}"));
                    self.terminal.error(format_args!("{shader}: {panic}"));
                    self.failed = true;
                }
            },
            CheckFormat::Short => {
                for diagnostic in &record.diagnostics {
                    self.terminal.result(&diagnostic.to_string());
                }
            }
            CheckFormat::Json => {}
        }
        self.failed |= log.failed;
        self.device = log.device.or(self.device.take());
        self.records.push(record);
        self.reported.push(index);
    }

    /// The lines of a shader on the terminal, with the decision on it.
    pub(super) fn lines(&self, record: &Record) -> String {
        report::lines(&decided(record.clone(), self.decisions), &self.layout)
    }

    /// Prints a message. For many shaders, diagnostics are not shown with their source lines: errors are
    /// listed below their shader, and warnings are counted.
    fn print(&mut self, message: &Message, verdict: Verdict) {
        match message {
            Message::Diagnostics(diagnostics, _)
                if !self.terminal.is_verbose() && (!self.has_sources || self.terminal.is_quiet()) =>
            {
                let warnings = diagnostics.iter().filter(|one| one.severity == Severity::Warning);
                // Those of other shaders are listed.
                if verdict.is_good() || self.terminal.is_quiet() {
                    self.hidden_warnings += warnings.count() as u64;
                }
            }
            Message::Diagnostics(..) if self.options.format == CheckFormat::Short => {}
            message => message.print(self.terminal),
        }
    }

    /// Prints the summary, and writes the reports.
    pub(super) fn finish(self, submissions: &[Submission]) -> Exit {
        let Self {
            options,
            terminal,
            rubrics,
            decisions,
            records,
            reported,
            device,
            results,
            earlier,
            mut failed,
            hidden_warnings,
            start,
            ..
        } = self;
        let reported: Vec<_> = reported.into_iter().map(|index| &submissions[index]).collect();
        let records = records.into_iter().map(|record| decided(record, decisions));
        let report = Report::new(device, records.collect());
        match options.format {
            CheckFormat::Human => {
                print_summary(&report, hidden_warnings, start.elapsed(), terminal);
                if let [one] = &reported[..]
                    && report.shaders()[0].verdict == Verdict::Ok
                    && let Some(shader) = one.input.as_ref().ok().and_then(Input::path)
                    && let Some(scene) = unused_scene(shader)
                {
                    let scene = path_name(&scene);
                    terminal.warn(format_args!(
                        "{scene} was not used: it has another name than the shader"
                    ));
                    terminal.help(format_args!(
                        "compare with it with `--scene {}`",
                        shell_word(&scene)
                    ));
                }
            }
            CheckFormat::Short => {}
            CheckFormat::Json => failed |= terminal.stream(|stdout| report.json(stdout)).is_err(),
        }
        warn_without_rubric(&report, &rubrics, terminal);
        if let Some(earlier) = earlier {
            print_changes(&earlier, &report, options.format, terminal);
        }
        if let Some(out) = &options.out {
            // Before the reports are written, which would create the folder again.
            let is_there = results.as_ref().map_or(Ok(()), Results::check_place);
            let written = options.shard.is_some()
                || reports::write(&report, &reported, &rubrics, options, out, terminal)
                    & feedback::write(&report, &reported, &rubrics, options, terminal);
            match is_there {
                Ok(()) if written => terminal.note(&match options.shard {
                    None => format!("report: {}", path_name(&out.join("report.html"))),
                    Some(shard) => format!("shard {shard}: {}", path_name(out)),
                }),
                Ok(()) => failed = true,
                Err(error) => {
                    terminal.error(format_args!(
                        "results were removed while they were written: {error}; run the command again"
                    ));
                    failed = true;
                }
            }
        }
        if options.shard.is_some() {
            return if failed { Exit::Error } else { Exit::Success };
        }
        let mut records = report.shaders().iter();
        if failed || records.clone().any(|record| record.verdict == Verdict::Error) {
            Exit::Error
        } else if records.all(Record::is_passed) {
            Exit::Success
        } else {
            Exit::ShaderFault
        }
    }
}

/// Prints the tally of all shaders, and warns of shaders that were compared with nothing.
fn print_summary(report: &Report, hidden_warnings: u64, elapsed: Duration, terminal: &Terminal) {
    let records = report.shaders();
    let tally = Tally::new(records);
    let device = report
        .device()
        .map(|device| format!(", {}", short_device(device)));
    if records.len() > 1 {
        terminal.note(&format!(
            "\n{} ({:.1} s{})",
            tally.summary(),
            elapsed.as_secs_f64(),
            device.unwrap_or_default()
        ));
    }
    if hidden_warnings > 0 {
        terminal.note(&format!(
            "{} {}; -v shows them",
            grouped(hidden_warnings),
            plural(hidden_warnings, "warning", "warnings")
        ));
    }
    let without = tally.count(Verdict::Ok);
    // The reason of a single shader states it.
    if without > 0 && records.len() > 1 {
        terminal.warn(format_args!(
            "nothing was compared for {} {}: no reference was given",
            grouped(without),
            plural(without, "shader", "shaders")
        ));
        terminal.help("name a scene with --scene or a shader or image with --reference, or put NAME.toml beside NAME.glsl");
    }
}

/// Warns of decided points of shaders for which there is no rubric, so that no report has points.
fn warn_without_rubric(report: &Report, rubrics: &Rubrics, terminal: &Terminal) {
    for record in report.shaders() {
        let has_points = record
            .decision
            .as_ref()
            .is_some_and(|decision| decision.points.is_some());
        if has_points && rubrics.find(record).is_none() {
            let shader = &record.shader;
            terminal.warn(format_args!(
                "the points decided for {shader} are in no table: nothing gives points"
            ));
            terminal.help("add [rubric.algorithm] with `points = 6` to the assignment, or use --rubric");
        }
    }
}

/// Prints the verdicts that differ from those of an earlier report.
fn print_changes(earlier: &Earlier, report: &Report, format: CheckFormat, terminal: &Terminal) {
    let changes = earlier.changes(report);
    if format == CheckFormat::Human {
        terminal.note("");
        for change in &changes {
            terminal.result(&change.to_string());
        }
    }
    let count = changes.len() as u64;
    terminal.note(&format!(
        "{} {} from {}",
        grouped(count),
        plural(count, "verdict differs", "verdicts differ"),
        earlier.name()
    ));
}
