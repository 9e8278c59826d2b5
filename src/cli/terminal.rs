//! All output to the terminal.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Write as _};
use std::io::{self, BufWriter, Write};
use std::panic::PanicHookInfo;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use terminal_size::terminal_size_of;
use toyproof_diagnostic::{
    self as diagnostic, Code, Diagnostic, Files, Severity, path_name, without_error_numbers, wrap,
};
use toyproof_image::output;
use toyproof_verify::contain;

use super::error::{CliError, Exit};

/// The number of warnings of one code that are shown for one shader: the others are fixed in the same way.
const WARNINGS_SHOWN: usize = 3;

/// The widest line of wrapped text, in columns: longer lines are hard to read.
const MAX_WIDTH: usize = 120;

/// Prints to standard output and standard error. Colors are stripped in files, in pipes, with `--color never`
/// and where `NO_COLOR` is set; text is wrapped on terminals only.
#[derive(Debug)]
pub(super) struct Terminal {
    quiet: bool,
    verbose: bool,
    /// The progress bars, which make room for other output.
    bars: MultiProgress,
    interrupts: Interrupts,
    /// Whether writing to standard output failed.
    write_failed: AtomicBool,
    /// Whether the reader of standard output has closed it.
    closed: AtomicBool,
}

#[expect(
    clippy::unused_self,
    reason = "what is printed in any case is still the terminal's to print"
)]
impl Terminal {
    pub(super) fn new(quiet: bool, verbose: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        Self {
            quiet,
            verbose,
            bars: MultiProgress::with_draw_target(target),
            interrupts: Interrupts::default(),
            write_failed: AtomicBool::new(false),
            closed: AtomicBool::new(false),
        }
    }

    /// Whether the reader of standard output has closed it.
    pub(super) fn is_closed(&self) -> bool {
        self.closed.load(Ordering::Relaxed)
    }

    pub(super) fn is_verbose(&self) -> bool {
        self.verbose
    }

    pub(super) fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Whether writing to standard output failed.
    pub(super) fn has_failed(&self) -> bool {
        self.write_failed.load(Ordering::Relaxed)
    }

    /// The width of standard output in columns, at most [`MAX_WIDTH`]; `None` if it is not a terminal.
    pub(super) fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size_of(io::stdout())?;
        Some(usize::from(width.0).min(MAX_WIDTH))
    }

    /// Prints a result on standard output.
    pub(super) fn result(&self, text: &str) {
        // Nothing else may be printed inside `suspend`, which locks the bars.
        let written = self
            .bars
            .suspend(|| writeln!(anstream::stdout().lock(), "{text}"));
        // The command goes on, and then ends with an error.
        let _ = self.check_write(written);
    }

    /// Prints a paragraph on standard output, wrapped at the terminal's width.
    pub(super) fn paragraph(&self, text: &str) {
        self.result(&wrap("", 0, text, self.width()));
    }

    /// Writes bytes to standard output.
    pub(super) fn bytes(&self, bytes: &[u8]) -> Result<(), CliError> {
        self.stream(|stdout| stdout.write_all(bytes))
    }

    /// Writes the output of a function to standard output.
    pub(super) fn stream(
        &self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), CliError> {
        let written = self.bars.suspend(|| {
            let mut stdout = BufWriter::new(io::stdout().lock());
            write(&mut stdout).and_then(|()| stdout.flush())
        });
        self.check_write(written)
    }

    /// Reports the first failed write to standard output. A closed pipe is not an error: the reader has all
    /// it wants.
    fn check_write(&self, written: io::Result<()>) -> Result<(), CliError> {
        match written {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                if !self.write_failed.swap(true, Ordering::Relaxed) {
                    self.error(format_args!("cannot write to standard output: {error}"));
                }
                Err(CliError::silent())
            }
            Err(_) => {
                self.closed.store(true, Ordering::Relaxed);
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    /// Prints on standard error without disturbing the progress bars.
    fn message(&self, text: &str) {
        self.bars.suspend(|| {
            let _ = writeln!(anstream::stderr().lock(), "{text}");
        });
    }

    /// Prints on standard error a label, such as `error`, and a sentence.
    fn labeled(&self, label: &str, color: AnsiColor, text: impl Display) {
        let style = Style::new().fg_color(Some(color.into())).bold();
        let prefix = format!("{style}{label}{style:#}: ");
        let text = without_error_numbers(&text.to_string());
        self.message(&wrap(&prefix, label.len() + 2, &text, stderr_width()));
    }

    /// Prints a note on standard error, except with `--quiet`.
    pub(super) fn note(&self, text: &str) {
        if !self.quiet {
            self.message(&wrap("", 0, text, stderr_width()));
        }
    }

    /// Prints a detail on standard error, only with `--verbose`.
    pub(super) fn detail(&self, text: &str) {
        if self.verbose {
            self.note(text);
        }
    }

    /// Confirms on standard error that a file was written, with facts such as its size; except with
    /// `--quiet`, and for standard output.
    pub(super) fn confirm(&self, path: &Path, facts: &str) {
        if path != Path::new("-") {
            self.note(&format!("{}  {facts}", path_name(path)));
        }
    }

    /// Prints a warning on standard error.
    pub(super) fn warn(&self, text: impl Display) {
        self.labeled("warning", AnsiColor::Yellow, text);
    }

    /// Prints an error on standard error; a line `help: …` at its end is the advice.
    pub(super) fn error(&self, text: impl Display) {
        let text = text.to_string();
        match text.split_once("\nhelp: ") {
            Some((text, help)) => {
                self.labeled("error", AnsiColor::Red, text);
                self.help(help);
            }
            None => self.labeled("error", AnsiColor::Red, text),
        }
    }

    /// Prints the error of a command or of one of its inputs; returns its exit status.
    pub(super) fn fail(&self, error: &CliError) -> Exit {
        if let Some((diagnostics, files)) = &error.diagnostics {
            self.diagnostics(diagnostics, files);
        }
        if let Some(message) = &error.message {
            self.error(message);
        }
        if let Some(help) = &error.help {
            self.help(help);
        }
        error.exit
    }

    /// Prints a way out of an error on standard error.
    pub(super) fn help(&self, text: impl Display) {
        self.labeled("help", AnsiColor::Cyan, text);
    }

    /// Prints the location of a panic; its consequence is reported where it is caught.
    pub(super) fn print_panic(info: &PanicHookInfo) {
        let place = info.location().map(|at| format!(" at {at}")).unwrap_or_default();
        let message = contain::message(info.payload());
        let _ = writeln!(
            anstream::stderr().lock(),
            "panic{place}: {message} (RUST_BACKTRACE=1 shows the calls)"
        );
    }

    /// Prints diagnostics with their source lines on standard error; with `--quiet` one line each. Without
    /// `--verbose`, only the first [`WARNINGS_SHOWN`] warnings of each code are shown, and the others
    /// counted.
    pub(super) fn diagnostics(&self, diagnostics: &[Diagnostic], files: &Files) {
        let mut text = String::new();
        let mut warnings: BTreeMap<Code, usize> = BTreeMap::new();
        for diagnostic in diagnostics {
            if diagnostic.severity == Severity::Warning && !self.verbose {
                let shown = warnings.entry(diagnostic.code).or_default();
                *shown += 1;
                if *shown > WARNINGS_SHOWN {
                    continue;
                }
            }
            text += &if self.quiet {
                diagnostic::short(diagnostic, files) + "\n"
            } else {
                diagnostic::human(diagnostic, files, stderr_width(), true)
            };
        }
        for (code, count) in warnings {
            if let more @ 1.. = count.saturating_sub(WARNINGS_SHOWN) {
                let _ = writeln!(
                    text,
                    "{more} more {code}: -v shows all; `toyproof explain {code}` explains it"
                );
            }
        }
        if !text.is_empty() {
            // Excerpts are followed by an empty line.
            let end = if self.quiet { "" } else { "\n" };
            self.message(&(text.trim_end_matches('\n').to_owned() + end));
        }
    }

    /// Writes a file atomically, or standard output if the path is `-`.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), CliError> {
        if path == Path::new("-") {
            return self.bytes(bytes);
        }
        Ok(output::write(path, bytes).map_err(|error| format!("cannot write {error}"))?)
    }

    /// Writes `output` itself, or a file below it if it is a folder; no link is followed out of that folder.
    pub(super) fn write_output(&self, output: &Path, path: &Path, bytes: &[u8]) -> Result<(), CliError> {
        if path == output || !path.starts_with(output) {
            return self.write(path, bytes);
        }
        Ok(output::write_inside(output, path, bytes).map_err(|error| format!("cannot write {error}"))?)
    }

    /// Shows a progress bar with a label that names the counted items, on a terminal only.
    pub(super) fn bar(&self, steps: u64, label: &str) -> ProgressBar {
        self.handle_interrupts();
        let bar = self.bars.add(ProgressBar::new(steps));
        let template = "{prefix} {human_pos}/{human_len} {wide_bar} {rate}, ETA {eta}  {msg}";
        let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(
            style.with_key("rate", |state: &ProgressState, text: &mut dyn fmt::Write| {
                let _ = write!(text, "{:.1}/s", state.per_sec());
            }),
        );
        bar.set_prefix(label.to_owned());
        bar
    }

    /// Shows a progress bar over a share of `steps`, such as of a time budget, on a terminal only.
    pub(super) fn share_bar(&self, steps: u64, label: &str) -> ProgressBar {
        let bar = self.bar(steps, label);
        let style = ProgressStyle::with_template("{prefix} {percent} % {wide_bar} ETA {eta}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar
    }

    /// Shows a spinner with a label, on a terminal only.
    pub(super) fn spinner(&self, label: &str) -> ProgressBar {
        self.handle_interrupts();
        let spinner = self.bars.add(ProgressBar::new_spinner());
        spinner.set_message(label.to_owned());
        spinner.enable_steady_tick(Duration::from_millis(100));
        spinner
    }

    /// Returns the text as a progress bar can show it: without colors if standard error has no colors.
    pub(super) fn bar_text(&self, text: &impl Display) -> String {
        let text = text.to_string();
        match AutoStream::choice(&io::stderr()) {
            ColorChoice::Never => anstream::adapter::strip_str(&text).to_string(),
            _ => text,
        }
    }

    /// Lets the command finish what is in progress when the user interrupts it (Ctrl-C): the first interrupt
    /// prints `message` and sets the returned flag, the second exits at once.
    pub(super) fn watch_interrupts(&self, message: &'static str) -> Arc<AtomicBool> {
        // Before the handler, which ends the program without a message.
        let _ = self.interrupts.message.set(message);
        self.handle_interrupts();
        Arc::clone(&self.interrupts.flag)
    }

    /// Whether the user has interrupted the command, where it watches for this.
    pub(super) fn interrupt_flag(&self) -> &AtomicBool {
        &self.interrupts.flag
    }

    /// Handles interrupts, so that no progress bar is left behind on the terminal.
    fn handle_interrupts(&self) {
        let bars = self.bars.clone();
        let Interrupts {
            message,
            flag,
            is_handled,
        } = &self.interrupts;
        let (message, flag) = (Arc::clone(message), Arc::clone(flag));
        is_handled.get_or_init(|| {
            // If no handler can be installed, an interrupt ends the program.
            let _ = ctrlc::set_handler(move || match message.get() {
                Some(message) if !flag.swap(true, Ordering::Relaxed) => bars.suspend(|| {
                    let _ = writeln!(
                        anstream::stderr().lock(),
                        "interrupted: {message}; interrupt again to stop at once"
                    );
                }),
                _ => {
                    let _ = bars.clear();
                    let _ = writeln!(anstream::stderr().lock(), "interrupted");
                    // 128 plus the number of SIGINT, as of a program that the signal ends.
                    std::process::exit(130);
                }
            });
        });
    }
}

/// The handling of interrupts.
#[derive(Debug, Default)]
struct Interrupts {
    /// The message about the work before the program ends; not set if it ends at once.
    message: Arc<OnceLock<&'static str>>,
    /// Whether the user has interrupted the program.
    flag: Arc<AtomicBool>,
    is_handled: OnceLock<()>,
}

/// The width of standard error in columns, at most [`MAX_WIDTH`]; `None` if it is not a terminal.
fn stderr_width() -> Option<usize> {
    let (width, _) = terminal_size_of(io::stderr())?;
    Some(usize::from(width.0).min(MAX_WIDTH))
}

/// Formats the size of a file: 231 kB.
pub(super) fn file_size(bytes: usize) -> String {
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..1_000_000 => format!("{:.0} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_the_system_have_no_numbers() {
        let short = without_error_numbers;
        assert_eq!(
            short("cannot write a: File exists (os error 17)"),
            "cannot write a: File exists"
        );
        assert_eq!(short("a (os error 2), b (os error -3)!"), "a, b!");
        for same in ["", "no error", "a (os error x)", "a (os error 2"] {
            assert_eq!(short(same), same);
        }
    }
}
