//! Converts the inputs of a command on several threads, writes the results, and reports them in the order of
//! the inputs.

use std::fmt::Write as _;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::Instant;

use anstyle::{AnsiColor, Style as TextStyle};
use serde::Serialize;
use toyproof_convert::header::{self, ProofStatus};
use toyproof_convert::{FallbackReason, GRAPH_FILE, ProofError, ShaderProof};
use toyproof_diagnostic::{self as diagnostic, grouped, path_name, plural};
use toyproof_project::files::{Input, ReadError};
use toyproof_report::{Detail, Layout};

use super::Args;
use super::conversion::{Conversion, Refusal, Settings};
use super::target::{OutputKind, To};
use crate::cli::inputs::Format;
use crate::cli::names::{Names, with_suffix};
use crate::cli::pool::{self, InOrder};
use crate::cli::shader::Shader;
use crate::cli::{CliError, Exit, Terminal};

/// An input and its output path.
pub(super) struct Job {
    pub(super) input: Result<Input, ReadError>,
    /// A file, or the folder of a project with several passes.
    path: PathBuf,
    /// What is appended to the path of a file.
    suffix: String,
    /// Whether the input is a project with several passes, if that is known before the conversion.
    has_passes: Option<bool>,
}

impl Job {
    /// The jobs for all inputs of a command.
    pub(super) fn for_inputs(
        inputs: Vec<Result<Input, ReadError>>,
        kind: OutputKind,
        output: &Path,
        extension: &str,
    ) -> Vec<Self> {
        let is_output = match kind {
            OutputKind::File => !output.is_dir() && !output.as_os_str().as_encoded_bytes().ends_with(b"/"),
            OutputKind::Passes => true,
            OutputKind::Shaders => false,
        };
        let suffix = format!(".{extension}");
        let mut names = Names::new(&[&suffix], &[]);
        let jobs = inputs.into_iter().map(|input| {
            let (path, suffix) = match &input {
                Ok(found) if !is_output => (output.join(names.assign(found)), suffix.clone()),
                _ => (output.to_owned(), String::new()),
            };
            Self {
                input,
                path,
                suffix,
                has_passes: (kind != OutputKind::Shaders).then_some(kind == OutputKind::Passes),
            }
        });
        jobs.collect()
    }

    /// The output path: a file, or a folder if it `has_passes`.
    fn path(&self, has_passes: bool) -> PathBuf {
        if has_passes {
            self.path.clone()
        } else {
            with_suffix(&self.path, &self.suffix)
        }
    }

    /// The files that may be written last.
    pub(super) fn last_files(&self) -> impl Iterator<Item = PathBuf> {
        let file = (self.has_passes != Some(true)).then(|| self.path(false));
        let graph = (self.has_passes != Some(false)).then(|| self.path(true).join(GRAPH_FILE));
        file.into_iter().chain(graph)
    }

    pub(super) fn name(&self) -> String {
        match &self.input {
            Ok(input) => input.name(),
            Err(error) => error.name(),
        }
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}

/// A run over all shaders of one command.
pub(super) struct Batch<'a> {
    args: &'a Args,
    terminal: &'a Terminal,
    layout: Layout,
    output: PathBuf,
    several: bool,
    /// The number of shaders converted at a time.
    threads: usize,
    exit: Exit,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
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
    /// The name and color on the terminal.
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

/// The result of a job.
struct JobResult {
    shader: Shader,
    converted: Result<Conversion, Refusal>,
    /// The output path, if it was written.
    written: Option<PathBuf>,
}

impl<'a> Batch<'a> {
    pub(super) fn new(
        args: &'a Args,
        terminal: &'a Terminal,
        output: PathBuf,
        several: bool,
        jobs: &[Job],
    ) -> Self {
        let names: Vec<_> = jobs.iter().map(Job::name).collect();
        Self {
            args,
            terminal,
            layout: Layout::new(names.iter().map(String::as_str), terminal.width(), Detail::Normal),
            output,
            several,
            threads: args
                .jobs
                .map_or_else(cores, usize::from)
                .clamp(1, jobs.len().max(1)),
            exit: Exit::Success,
            rows: Vec::new(),
            start: Instant::now(),
        }
    }

    /// Converts all inputs; `loaded` is the first one, if it has been loaded.
    pub(super) fn convert(
        mut self,
        jobs: &[Job],
        settings: &Settings,
        loaded: Option<Shader>,
    ) -> Result<Exit, CliError> {
        let stop = self
            .terminal
            .watch_interrupts("the shaders in progress are finished first");
        let threads = self.threads;
        let bar = match jobs {
            [one] => self.terminal.spinner(&one.name()),
            several => self.terminal.bar(several.len() as u64, "shaders"),
        };
        let loaded = Mutex::new(loaded);
        let mut order: InOrder<(usize, JobResult)> = InOrder::default();
        let todo: Vec<usize> = (0..jobs.len()).collect();
        pool::for_each(
            &todo,
            threads,
            &stop,
            || settings.worker_context(threads),
            |context, index| {
                let loaded = loaded.lock().ok().and_then(|mut loaded| loaded.take());
                let shader = loaded.unwrap_or_else(|| settings.load(&jobs[index].input));
                let converted = settings.convert(context, &shader);
                (shader, converted)
            },
            |index, (shader, mut converted)| {
                bar.inc(1);
                // The file is written at once; its messages are printed in the order of the inputs.
                let written = self.write(
                    &jobs[index].path(shader.has_passes && settings.host.is_none()),
                    &mut converted,
                );
                let result = JobResult {
                    shader,
                    converted,
                    written,
                };
                for (index, result) in order.take(index, (index, result)) {
                    self.finish(&jobs[index], result, settings.to);
                }
            },
        );
        bar.finish_and_clear();
        for (index, result) in order.rest() {
            self.finish(&jobs[index], result, settings.to);
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

    /// Writes a conversion if it is proved or forced; returns its path if it was written.
    fn write(&self, path: &Path, converted: &mut Result<Conversion, Refusal>) -> Option<PathBuf> {
        let converted = converted.as_mut().ok()?;
        if !converted.status.is_proved() && !self.args.force {
            return None;
        }
        let written = std::mem::take(&mut converted.files).iter().try_for_each(|file| {
            let inside = file.name.as_ref().map(|name| path.join(name));
            let path = inside.as_deref().unwrap_or(path);
            self.terminal.write_output(&self.output, path, &file.bytes)
        });
        match written {
            Ok(()) => Some(path.to_owned()),
            Err(error) => {
                self.terminal.fail(&error);
                None
            }
        }
    }

    /// Reports the result of one shader.
    fn finish(&mut self, job: &Job, result: JobResult, to: To) {
        let JobResult {
            shader,
            converted,
            written,
        } = result;
        let mut diagnostics = shader.lints.warnings;
        let (status, message, exit) = match converted {
            Ok(converted) => {
                let is_success = written.is_some() && converted.status.is_proved();
                let exit = if is_success { Exit::Success } else { Exit::Error };
                let (status, message) = describe(&converted, written.is_some(), to);
                (status, message, exit)
            }
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
        let is_lost = written.is_none() && matches!(status, Status::Converted | Status::Proved);
        let message = match is_lost {
            true if message.is_empty() => "not written".to_owned(),
            true => format!("{message}; not written"),
            false => message,
        };
        if self.args.format == Format::Human {
            self.terminal.diagnostics(&diagnostics, &shader.files);
            self.print_row(status, &job.name(), written.as_deref(), &message);
        }
        self.rows.push(Row {
            shader: job.name(),
            output: written.as_deref().map(path_name),
            status,
            message,
            diagnostics: diagnostics
                .iter()
                .map(|one| diagnostic::json(one, &shader.files))
                .collect(),
        });
    }

    /// Prints the result of a shader; a shader that was only converted is confirmed by the path of its file.
    fn print_row(&self, status: Status, name: &str, written: Option<&Path>, message: &str) {
        let row = self.layout.row(status.label(), name, message);
        match (status, written) {
            (Status::Converted, Some(path)) if self.output != Path::new("-") => {
                self.terminal.note(&format!("{row} → {}", path_name(path)));
            }
            // The error about the file has been reported.
            (Status::Converted, _) => {}
            // Without a table of proofs, an error is reported alone.
            (Status::Refused, _) if !self.args.verify => self
                .terminal
                .error(format_args!("{name} was not converted: {message}")),
            _ => self.print(&row),
        }
    }

    fn print_tally(&self) {
        let count = |status: Status| self.rows.iter().filter(|row| row.status == status).count();
        let written = self.rows.iter().filter(|row| row.output.is_some()).count();
        let counts = [
            (count(Status::Proved), "proved".to_owned()),
            (count(Status::Unproved), "unproved".to_owned()),
            (count(Status::Refused), "refused".to_owned()),
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

/// The status of a conversion, and what is to be reported about it.
fn describe(converted: &Conversion, is_written: bool, to: To) -> (Status, String) {
    let fallback = converted.fallback.as_ref().map_or_else(String::new, |why| {
        format!("; written by naga, since toyproof's writer failed: {why}")
    });
    let not_read = format!(", up to naga's {} writer", to.name());
    match &converted.status {
        ProofStatus::NotRequested => (Status::Converted, String::new()),
        ProofStatus::Proved(ShaderProof::File(proof, readers)) => {
            let mut message = header::describe_proof(proof);
            message += &header::in_chromium(readers.browser.as_ref());
            (Status::Proved, message + &fallback)
        }
        ProofStatus::Proved(ShaderProof::Source(proof)) => {
            let mut message = header::describe_proof(proof) + &not_read;
            if to == To::Hlsl {
                message += "; install glslang-tools to verify the text too";
            }
            match &converted.fallback {
                Some(FallbackReason::Unproved(why @ ProofError::AppleOnly(_))) => {
                    let _ = write!(message, "; written by naga, since {why}");
                }
                Some(FallbackReason::Unwritable(_)) => message += &fallback,
                _ => {}
            }
            (Status::Proved, message)
        }
        ProofStatus::ProvedPasses(proof) => {
            let mut message = header::describe_passes(proof);
            message += &header::in_chromium(proof.browser.as_ref());
            if proof.readers.is_empty() {
                message += &not_read;
            }
            (Status::Proved, message + &fallback)
        }
        ProofStatus::NotProved(why) if is_written => {
            (Status::Unproved, format!("{why}; written because of --force"))
        }
        ProofStatus::NotProved(why) => (
            Status::Unproved,
            format!("{why}; not written (--force writes it anyway)"),
        ),
    }
}
