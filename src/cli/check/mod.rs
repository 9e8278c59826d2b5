//! `toyproof check`

mod checker;
mod donors;
mod images;
mod merge;
mod plan;
mod reference;
mod reports;
mod shard;

use std::collections::HashSet;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use toyproof_diagnostic::{Severity, grouped, path_name, plural};
use toyproof_verify::Verdict;
use toyproof_verify::alternative::Difference;
use toyproof_verify::contain::{Part, contain};
use toyproof_verify::repair::DEFAULT_BUDGET;

use self::checker::{Checker, Message, Outcome, Submission, WorkerContext};
use self::images::IMAGES;
pub(super) use self::merge::{MergeArgs, merge};
use self::plan::Plan;
pub(super) use self::plan::read_assignment;
use self::reference::References;
pub(super) use self::reference::Scenes;
use self::reports::{Line, Results};
use self::shard::{Manifest, Shard};
use super::collect::{ClassPart, Owners, class_parts};
use super::inputs::short_device;
use super::inputs::{DriverArgs, FrameArgs, LanguageArgs};
use super::names::Names;
use super::pool::{self, InOrder};
use super::reference::ReferenceArgs;
use super::shader::find;
use super::{Exit, Terminal};
use crate::report::{self, Detail, Earlier, Hints, Layout, Record, Report, Rubrics};

/// Check shaders against a reference, and give a verdict on each
///
/// The reference of a shader is the scene that --scene names, or the shader or image that --reference names,
/// else that of the assignment, else the .toml file beside the shader. A shader without one is `ok` if it
/// renders: nothing is compared.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof scenes --write course && toyproof check course --out report
  toyproof check homework --scene 02-sphere --out marks --rubric rubric.toml
  toyproof check homework --reference solution.glsl --out marks
  toyproof check homework --assignment shadows/assignment.toml --out marks
  toyproof check mine.glsl --scene scene.toml --format json
  toyproof check moodle.zip --class class.toml --out marks

Exit code: 0 if every shader is correct or ok, 1 if one is not, 2 for any other error.
With --shard: 0 if the shard is complete, else 2.")]
pub(super) struct Args {
    /// Shaders: files, folders, or - for standard input; with --class, downloads
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// The assignment (.toml): reference, frames and points [default: assignment.toml in the shaders' folder]
    ///
    /// A shader must be right in all frames. Flags of a frame (--size, --time, --mouse and so on) replace the
    /// frames of the assignment by that one, and --rubric replaces its points.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "reference"])]
    assignment: Option<PathBuf>,
    /// The class (.toml): the patterns, deadlines and rubrics of several assignments, which are all checked
    ///
    /// The shaders are downloads of Moodle or Canvas, which are collected into the folder `submissions` of
    /// --out, or what `toyproof collect --class` wrote. Every student has a row for each assignment, and
    /// class.csv has the points of all.
    #[arg(long, value_name = "FILE", requires = "out",
          conflicts_with_all = ["scene", "reference", "assignment", "rubric"])]
    class: Option<PathBuf>,
    /// Differences from the reference with which a shader is still correct, such as antialiasing,color-curve
    ///
    /// They are those of the section “Right, but not as asked” of the guide's page on mistakes, by their ids.
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    permit: Vec<Difference>,
    /// Write images and reports into this folder
    ///
    /// For each shader: the images NAME-actual.png, NAME-reference.png, NAME-difference.png,
    /// NAME-algorithm.png, NAME-precision.png and NAME-toolchain.png where a check finds differences, and
    /// NAME-fixed.png where a fix was found. For all: report.html, report.csv, verdict.json, junit.xml and
    /// report.sarif; with --class, class.csv.
    #[arg(short, long, value_name = "DIR", help_heading = "Reports")]
    out: Option<PathBuf>,
    /// Reuse results of an earlier run into the same folder
    ///
    /// A result is reused if shader, reference and flags are unchanged. The earlier run may have been
    /// interrupted.
    #[arg(long, requires = "out", help_heading = "Reports")]
    resume: bool,
    /// Check only part K of N of the shaders, in a folder of its own; `toyproof merge` writes the report of
    /// all
    ///
    /// Each shader is in one of the N parts, which depends on the contents of all shaders. The parts take
    /// about equally long. They may be checked at any time, in any order and on several machines; with
    /// --resume, a part that was interrupted continues.
    #[arg(long, value_name = "K/N", requires = "out", help_heading = "Reports")]
    shard: Option<Shard>,
    /// List the verdicts that differ from an earlier report: a folder that --out wrote, or its verdict.json
    #[arg(long, value_name = "OLD", conflicts_with = "shard", help_heading = "Reports")]
    compare: Option<PathBuf>,
    /// A rubric (.toml): points for compiling and for each check, for report.csv and Gradescope's
    /// results.json
    #[arg(long, value_name = "RUBRIC.toml", requires = "out", help_heading = "Reports")]
    rubric: Option<PathBuf>,
    /// What reports show of the mistake in a wrong shader [default: line for students' reports, else fix]
    ///
    /// Students' reports are junit.xml and Gradescope's results.json. If this option is given, it applies to
    /// all reports and to the terminal. results.jsonl, which --resume reads, always has everything.
    #[arg(long, value_enum, value_name = "HINTS", help_heading = "Reports")]
    hints: Option<HintLevel>,
    /// The format of standard output
    #[arg(long, value_enum, default_value_t = CheckFormat::Human, help_heading = "Output")]
    format: CheckFormat,
    /// The number of shaders to check in parallel [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), allow_negative_numbers = true)]
    jobs: Option<u16>,
    /// How long to search for a fix of a wrong shader; 0 turns the search off
    ///
    /// The search tries edits of the shader until its image is the expected one. Where several shaders are
    /// checked, a second search tries expressions of the correct ones. A unit is about a second of one core.
    /// Work is counted, not timed, so that the result is the same on every machine.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_BUDGET, value_parser = parse_search, allow_negative_numbers = true)]
    search: f64,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    language: LanguageArgs,
    #[command(flatten)]
    driver: DriverArgs,
}

/// The format of standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum CheckFormat {
    /// A verdict for each shader, with an explanation
    Human,
    /// A line `file:line:column: error[E0100]: message` for each diagnostic, for editors
    Short,
    /// verdict.json
    Json,
}

/// What reports show of the mistake in a wrong shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum HintLevel {
    /// Nothing
    None,
    /// The likely mistake, and the line of the fix or the suspect lines
    Line,
    /// Also the edit
    Fix,
}

impl From<HintLevel> for Hints {
    fn from(level: HintLevel) -> Self {
        match level {
            HintLevel::None => Self::None,
            HintLevel::Line => Self::Line,
            HintLevel::Fix => Self::Fix,
        }
    }
}

impl Args {
    /// The hints in reports for teachers.
    fn teachers_hints(&self) -> Hints {
        self.hints.map_or(Hints::Fix, Hints::from)
    }

    /// The hints in reports for students.
    fn students_hints(&self) -> Hints {
        self.hints.map_or(Hints::Line, Hints::from)
    }
}

/// The largest value of `--search`: an hour for each shader.
const MAX_SEARCH: f64 = 3600.0;

fn parse_search(text: &str) -> Result<f64, String> {
    let search = text.parse().ok();
    search
        .filter(|search| (0.0..=MAX_SEARCH).contains(search))
        .ok_or_else(|| format!("expected a number from 0 to {MAX_SEARCH}, in seconds of one core"))
}

/// The largest number of shaders whose errors and warnings are shown with their source lines.
const MAX_WITH_SOURCE: usize = 3;

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    // A worker is created and dropped here, so that wrong arguments are reported before any work starts.
    if let Err(error) = args.driver.worker() {
        terminal.error(error);
        return Exit::Error;
    }
    let Ok(earlier) = earlier(args.compare.as_deref(), terminal) else {
        return Exit::Error;
    };
    let build = match (&args.out, args.shard) {
        (None, _) => None,
        (Some(_), None) => checker::build(),
        (Some(_), Some(_)) => match shard::program() {
            Ok(program) => Some(program),
            Err(error) => {
                terminal.error(format_args!("the program's own file cannot be read: {error}"));
                return Exit::Error;
            }
        },
    };
    let Ok(mut work) = Work::new(args, build.as_deref(), terminal) else {
        return Exit::Error;
    };
    let mut results = None;
    if let Some(out) = &args.out {
        let opened = match (args.shard, build) {
            (Some(shard), Some(program)) => work.select(args, shard, program, out),
            _ => Ok(()),
        };
        match opened
            .and_then(|()| Results::open(out, args.resume).map_err(|error| format!("cannot write {error}")))
        {
            Ok(opened) => {
                if let broken @ 1.. = opened.broken as u64 {
                    terminal.warn(format_args!(
                        "{} {} of results.jsonl cannot be read; {} checked again",
                        grouped(broken),
                        plural(broken, "line", "lines"),
                        plural(broken, "its shader is", "their shaders are"),
                    ));
                }
                results = Some(opened);
            }
            Err(error) => {
                terminal.error(error);
                return Exit::Error;
            }
        }
    }
    work.check(args, results, earlier, terminal)
}

/// Reads the report that `--compare` names, if any.
///
/// # Errors
/// It is unusable; what is wrong with it has been printed.
fn earlier(path: Option<&Path>, terminal: &Terminal) -> Result<Option<Earlier>, ()> {
    let Some(path) = path else {
        return Ok(None);
    };
    let file = if path.is_dir() {
        path.join("verdict.json")
    } else {
        path.to_owned()
    };
    let name = path_name(&file);
    let text = std::fs::read_to_string(&file).map_err(|error| error.to_string());
    let earlier = text.and_then(|text| Earlier::parse(name.clone(), &text));
    earlier
        .map(Some)
        .map_err(|error| terminal.error(format_args!("{name} cannot be compared with: {error}")))
}

/// All that one command checks.
struct Work {
    /// At least one; one for each assignment of a class.
    tasks: Vec<Task>,
    rubrics: Rubrics,
    submissions: Vec<Submission>,
}

/// What some of the shaders are checked against.
struct Task {
    plan: Plan,
    references: References,
}

/// The shaders of one assignment, and what they are checked against; without a class, all shaders.
struct TaskInputs {
    /// The name of the assignment in a class.
    name: Option<String>,
    shaders: Vec<PathBuf>,
    assignment: Option<PathBuf>,
    rubric: Option<PathBuf>,
}

impl TaskInputs {
    fn of_arguments(args: &Args) -> Self {
        Self {
            name: None,
            shaders: args.shaders.clone(),
            assignment: args.assignment.clone(),
            rubric: args.rubric.clone(),
        }
    }

    fn of_class(part: ClassPart) -> Self {
        Self {
            name: Some(part.name),
            shaders: vec![part.folder],
            assignment: Some(part.assignment),
            rubric: part.rubric,
        }
    }
}

/// The folder of `--out` with the submissions of a class that were collected from downloads.
const SUBMISSIONS: &str = "submissions";

impl Work {
    /// Reads what the arguments name. With the `build` that checks them, submissions have keys.
    ///
    /// # Errors
    /// Something is unusable; what is wrong with it has been printed.
    fn new(args: &Args, build: Option<&str>, terminal: &Terminal) -> Result<Self, ()> {
        let collected = args.out.as_ref().map(|out| out.join(SUBMISSIONS));
        let parts = match &args.class {
            Some(class) => {
                let to = collected.as_deref().filter(|_| args.shard.is_none());
                class_parts(&args.shaders, class, to, terminal)?
                    .into_iter()
                    .map(TaskInputs::of_class)
                    .collect()
            }
            None => vec![TaskInputs::of_arguments(args)],
        };
        let reserved: Vec<&str> = reports::REPORT_NAMES
            .into_iter()
            .chain([reports::RESULTS_NAME, shard::MANIFEST_NAME, SUBMISSIONS])
            .collect();
        let mut names = Names::new(&IMAGES.map(|kind| kind.suffix), &reserved);
        let mut work = Self {
            tasks: Vec::new(),
            rubrics: Rubrics::default(),
            submissions: Vec::new(),
        };
        for part in parts {
            let mut plan = Plan::new(args, &part, terminal)?;
            let references = References::new(args, &mut plan, terminal)?;
            let mut inputs = find(&part.shaders, terminal);
            let owners = Owners::read(&part.shaders, &mut inputs).map_err(|error| terminal.error(error))?;
            match (&part.name, plan.rubric.take()) {
                (None, rubric) => work.rubrics = rubric.into(),
                (Some(name), rubric) => {
                    rubric
                        .into_iter()
                        .for_each(|rubric| work.rubrics.add(name.clone(), rubric));
                }
            }
            for mut input in inputs {
                if let (Ok(input), Some(name)) = (&mut input, &part.name) {
                    input.relative = Path::new(name).join(&input.relative);
                }
                let submitted = owners.of(&input).cloned();
                let submission = Submission::new(input, args, &plan, &references, &mut names, build);
                work.submissions.push(Submission {
                    task: work.tasks.len(),
                    submitted,
                    ..submission
                });
            }
            work.tasks.push(Task { plan, references });
        }
        Ok(work)
    }

    /// Keeps the submissions of a shard, and describes it in its folder.
    fn select(&mut self, args: &Args, shard: Shard, program: String, out: &Path) -> Result<(), String> {
        if args.shaders.iter().any(|shader| shader == Path::new("-")) {
            return Err(
                "--shard cannot be used with standard input, which only one shard could read".to_owned(),
            );
        }
        let manifest = Manifest {
            program,
            inputs: shard::inputs(&self.submissions),
            shard,
            arguments: shard::arguments()?,
        };
        let mut numbers = shard::assign(&self.submissions, shard.of).into_iter();
        self.submissions.retain(|_| numbers.next() == Some(shard.number));
        manifest.write(out).map_err(|error| error.to_string())
    }

    fn check(
        mut self,
        args: &Args,
        results: Option<Results>,
        earlier: Option<Earlier>,
        terminal: &Terminal,
    ) -> Exit {
        let submissions = &self.submissions;
        let mut batch = Batch {
            args,
            terminal,
            rubrics: std::mem::take(&mut self.rubrics),
            results,
            earlier,
            order: InOrder::default(),
            records: Vec::new(),
            device: None,
            failed: false,
            layout: layout(submissions, args.format, terminal),
            unrepaired: HashSet::new(),
            has_sources: submissions.len() <= MAX_WITH_SOURCE,
            hidden_warnings: 0,
            start: Instant::now(),
        };
        let tasks = self.tasks.iter();
        let checkers = tasks.map(|task| Checker::new(args, &task.plan, &task.references));
        batch.check(submissions, &checkers.collect::<Vec<_>>());
        batch.finish(submissions)
    }
}

/// The layout of the lines of all shaders.
fn layout(submissions: &[Submission], format: CheckFormat, terminal: &Terminal) -> Layout {
    let detail = match (terminal.is_quiet(), terminal.is_verbose()) {
        (true, _) => Detail::Short,
        (_, true) => Detail::Full,
        _ => Detail::Normal,
    };
    let names = submissions.iter().map(|submission| submission.name.as_str());
    let lists_diagnostics = submissions.len() > MAX_WITH_SOURCE;
    // Each line of the short form is one diagnostic.
    let width = terminal.width().filter(|_| format == CheckFormat::Human);
    Layout::new(names, width, detail, lists_diagnostics)
}

/// A run over all shaders of one command.
struct Batch<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    rubrics: Rubrics,
    results: Option<Results>,
    /// The report that is compared with.
    earlier: Option<Earlier>,
    order: InOrder<(usize, Outcome)>,
    /// The reported records, in order, each with the index of its submission.
    records: Vec<(usize, Record)>,
    device: Option<String>,
    /// Whether something failed that no verdict shows.
    failed: bool,
    layout: Layout,
    /// The submissions that are wrong, and that no edit repairs.
    unrepaired: HashSet<usize>,
    /// Whether errors and warnings are shown with their source lines.
    has_sources: bool,
    /// The number of warnings that were not shown.
    hidden_warnings: u64,
    start: Instant,
}

impl Batch<'_> {
    fn check(&mut self, submissions: &[Submission], checkers: &[Checker]) {
        let stop = self
            .terminal
            .watch_interrupts("the shaders in progress are finished first");
        let bar = match submissions {
            [one] => self.terminal.spinner(&one.name),
            several => self.terminal.bar(several.len() as u64, "shaders"),
        };
        let mut tally = report::Tally::default();
        let mut todo = Vec::new();
        for (index, submission) in submissions.iter().enumerate() {
            let key = submission.key.as_deref();
            let known = key.and_then(|key| self.results.as_ref()?.known(key));
            match known {
                Some(Line { record, device, .. }) => {
                    tally.add(record.verdict);
                    bar.inc(1);
                    let mut known = Outcome::known(record);
                    known.device = device;
                    self.take(submissions, index, known);
                }
                None => todo.push(index),
            }
        }
        self.results.as_mut().map(Results::forget);
        let reused = submissions.len() - todo.len();
        if self.args.resume && reused > 0 {
            let of = submissions.len();
            self.terminal.note(&format!(
                "{} of {} {} reused from an earlier run",
                grouped(reused as u64),
                grouped(of as u64),
                plural(of as u64, "result is", "results are")
            ));
        }
        let threads = self.threads(todo.len());
        pool::for_each(
            &todo,
            threads,
            &stop,
            || WorkerContext::new(self.args, threads),
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
                self.report_outcome(submissions, index, outcome);
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
            if self.args.out.is_some() {
                self.terminal
                    .help("run the same command with --resume to check the others");
            }
            self.failed = true;
        } else if self.args.search > 0.0 && self.args.shard.is_none() {
            // What repairs a shader may be in another shard; `merge` searches.
            self.search_again(submissions, checkers, &stop);
        }
    }

    /// The number of threads for that number of shaders.
    fn threads(&self, shaders: usize) -> usize {
        let threads = match self.args.jobs {
            Some(jobs) => usize::from(jobs),
            None => std::thread::available_parallelism().map_or(1, NonZero::get),
        };
        threads.clamp(1, shaders.max(1))
    }

    /// Appends a record to `results.jsonl`.
    fn keep(&mut self, submission: &Submission, outcome: &Outcome) {
        if let (Some(results), Some(key)) = (&mut self.results, &submission.key)
            && let Err(error) = results.add(key, &outcome.record, outcome.device.as_deref())
        {
            self.terminal.error(format_args!("cannot write {error}"));
            self.failed = true;
        }
    }

    fn take(&mut self, submissions: &[Submission], index: usize, outcome: Outcome) {
        for (index, outcome) in self.order.take(index, (index, outcome)) {
            self.report_outcome(submissions, index, outcome);
        }
    }

    /// Prints the messages and the result line of a shader.
    fn report_outcome(&mut self, submissions: &[Submission], index: usize, mut outcome: Outcome) {
        outcome.record.submitted.clone_from(&submissions[index].submitted);
        if outcome.record.verdict == Verdict::Wrong && outcome.record.fix.is_none() {
            self.unrepaired.insert(index);
        }
        outcome.record.redact(self.args.teachers_hints());
        for message in &outcome.messages {
            self.print(message, outcome.record.verdict);
        }
        match self.args.format {
            CheckFormat::Human => {
                match contain(Part::Summary, || report::lines(&outcome.record, &self.layout)) {
                    Ok(lines) => self.terminal.result(&lines),
                    Err(panic) => {
                        let Record { shader, verdict, .. } = &outcome.record;
                        self.terminal.result(&format!("{verdict:<12} {shader}"));
                        self.terminal.error(format_args!("{shader}: {panic}"));
                        self.failed = true;
                    }
                }
            }
            CheckFormat::Short => {
                for diagnostic in &outcome.record.diagnostics {
                    self.terminal.result(&diagnostic.to_string());
                }
            }
            CheckFormat::Json => {}
        }
        self.failed |= outcome.failed;
        self.device = outcome.device.or(self.device.take());
        self.records.push((index, outcome.record));
    }

    /// Prints a message. Of many shaders, diagnostics are not shown with their source lines: errors are
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
            Message::Diagnostics(..) if self.args.format == CheckFormat::Short => {}
            message => message.print(self.terminal),
        }
    }

    fn finish(self, submissions: &[Submission]) -> Exit {
        let Self {
            args,
            terminal,
            rubrics,
            records,
            device,
            results,
            earlier,
            mut failed,
            hidden_warnings,
            start,
            ..
        } = self;
        let (reported, records): (Vec<_>, Vec<_>) = records
            .into_iter()
            .map(|(index, record)| (&submissions[index], record))
            .unzip();
        let report = Report::new(device, records);
        match args.format {
            CheckFormat::Human => print_summary(&report, hidden_warnings, start.elapsed(), terminal),
            CheckFormat::Short => {}
            CheckFormat::Json => failed |= !terminal.bytes(report.json().as_bytes()),
        }
        if let Some(earlier) = earlier {
            print_changes(&earlier, &report, args.format, terminal);
        }
        if let Some(out) = &args.out {
            // Before the reports are written, which would create the folder again.
            let is_there = results.as_ref().map_or(Ok(()), Results::check_place);
            let written = args.shard.is_some()
                || reports::write(&report, &reported, &rubrics, args.students_hints(), out, terminal);
            match is_there {
                Ok(()) if written => terminal.note(&match args.shard {
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
        if args.shard.is_some() {
            return if failed { Exit::Error } else { Exit::Success };
        }
        let verdicts = || report.shaders().iter().map(|record| record.verdict);
        if failed || verdicts().any(|verdict| verdict == Verdict::Error) {
            Exit::Error
        } else if report.shaders().iter().all(Record::is_passed) {
            Exit::Success
        } else {
            Exit::ShaderFault
        }
    }
}

/// Prints the tally of all shaders, and warns of shaders that were compared with nothing.
fn print_summary(report: &Report, hidden_warnings: u64, elapsed: Duration, terminal: &Terminal) {
    let records = report.shaders();
    let device = report
        .device()
        .map(|device| format!(", {}", short_device(device)));
    if records.len() > 1 {
        terminal.note(&format!(
            "\n{} ({:.1} s{})",
            report::summary(records),
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
    let without = records
        .iter()
        .filter(|record| record.verdict == Verdict::Ok)
        .count() as u64;
    // Of a single shader, its reason says so.
    if without > 0 && records.len() > 1 {
        terminal.warn(format_args!(
            "nothing was compared for {} {}: no reference was given",
            grouped(without),
            plural(without, "shader", "shaders")
        ));
        terminal.help("name a scene with --scene or a shader or image with --reference, or put NAME.toml beside NAME.glsl");
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

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    use super::*;

    fn args(flags: &[&str]) -> Result<Args, clap::Error> {
        let command = Args::augment_args(clap::Command::new("check"));
        let arguments = ["check", "a.glsl"].iter().chain(flags);
        command
            .try_get_matches_from(arguments)
            .and_then(|matches| Args::from_arg_matches(&matches))
    }

    #[test]
    fn students_see_lines_and_teachers_edits_unless_hints_are_given() {
        for (flags, expected) in [
            (&[][..], [Hints::Fix, Hints::Line]),
            (&["--hints", "none"], [Hints::None; 2]),
            (&["--hints", "line"], [Hints::Line; 2]),
            (&["--hints", "fix"], [Hints::Fix; 2]),
        ] {
            let args = args(flags).unwrap();
            assert_eq!(
                [args.teachers_hints(), args.students_hints()],
                expected,
                "{flags:?}"
            );
        }
    }

    #[test]
    fn the_search_has_a_limit() {
        assert!(args(&[]).unwrap().search > 0.0);
        for (text, expected) in [("0", 0.0), ("0.5", 0.5), ("3600", 3600.0)] {
            let search = args(&["--search", text]).unwrap().search;
            assert!((search - expected).abs() < f64::EPSILON, "{text}: {search}");
        }
        for text in ["-1", "NaN", "inf", "3601", "2s"] {
            let error = args(&["--search", text]).unwrap_err().to_string();
            assert!(
                error.contains("expected a number from 0 to 3600"),
                "{text}: {error}"
            );
        }
    }
}
