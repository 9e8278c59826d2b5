//! All output to the terminal.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::panic::PanicHookInfo;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anstyle::{AnsiColor, Style};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use toyproof_diagnostic::{self as diagnostic, Diagnostic, Files, Severity};
use toyproof_image::output;
use toyproof_verify::contain;

/// The number of warnings of one code that are shown for one shader.
const WARNINGS_SHOWN: usize = 3;

/// Prints to standard output and standard error. Colors are stripped in files, in pipes, and where `NO_COLOR`
/// is set.
#[derive(Debug)]
pub(super) struct Terminal {
    quiet: bool,
    verbose: bool,
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
        Self {
            quiet,
            verbose,
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

    /// Whether writing to standard output failed.
    pub(super) fn has_failed(&self) -> bool {
        self.write_failed.load(Ordering::Relaxed)
    }

    /// Prints a result on standard output.
    pub(super) fn result(&self, text: &str) {
        self.check_write(writeln!(anstream::stdout().lock(), "{text}"));
    }

    /// Writes bytes to standard output; returns whether that succeeded.
    pub(super) fn bytes(&self, bytes: &[u8]) -> bool {
        let mut stdout = io::stdout().lock();
        self.check_write(stdout.write_all(bytes).and_then(|()| stdout.flush()))
    }

    /// Reports the first failed write to standard output. A closed pipe is not an error: the reader has all
    /// it wants.
    fn check_write(&self, written: io::Result<()>) -> bool {
        match written {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                if !self.write_failed.swap(true, Ordering::Relaxed) {
                    self.error(format_args!("cannot write to standard output: {error}"));
                }
                false
            }
            Err(_) => {
                self.closed.store(true, Ordering::Relaxed);
                true
            }
            Ok(()) => true,
        }
    }

    /// Prints a note on standard error, except with `--quiet`.
    pub(super) fn note(&self, text: &str) {
        if !self.quiet {
            let _ = writeln!(anstream::stderr().lock(), "{text}");
        }
    }

    /// Prints a detail on standard error, only with `--verbose`.
    pub(super) fn detail(&self, text: &str) {
        if self.verbose {
            let _ = writeln!(anstream::stderr().lock(), "{text}");
        }
    }

    /// Prints a warning on standard error.
    pub(super) fn warn(&self, text: impl std::fmt::Display) {
        let style = Style::new().fg_color(Some(AnsiColor::Yellow.into())).bold();
        let _ = writeln!(anstream::stderr().lock(), "{style}warning{style:#}: {text}");
    }

    /// Prints an error on standard error.
    pub(super) fn error(&self, text: impl std::fmt::Display) {
        let style = Style::new().fg_color(Some(AnsiColor::Red.into())).bold();
        let _ = writeln!(anstream::stderr().lock(), "{style}error{style:#}: {text}");
    }

    /// Prints how the program reacts to an interrupt.
    pub(super) fn print_interrupt(message: &str) {
        let _ = writeln!(
            anstream::stderr().lock(),
            "{message}; interrupt again to stop at once"
        );
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
        let mut stderr = anstream::stderr().lock();
        let mut warnings: BTreeMap<&str, usize> = BTreeMap::new();
        for diagnostic in diagnostics {
            if diagnostic.severity == Severity::Warning && !self.verbose {
                let shown = warnings.entry(&diagnostic.code).or_default();
                *shown += 1;
                if *shown > WARNINGS_SHOWN {
                    continue;
                }
            }
            let _ = if self.quiet {
                writeln!(stderr, "{}", diagnostic::short(diagnostic, files))
            } else {
                write!(stderr, "{}", diagnostic::human(diagnostic, files, true))
            };
        }
        for (code, count) in warnings {
            if let more @ 1.. = count.saturating_sub(WARNINGS_SHOWN) {
                let _ = writeln!(
                    stderr,
                    "{more} more of {code}: --verbose shows them, `toyproof check --explain {code}` tells of it"
                );
            }
        }
    }

    /// Writes a file atomically, or standard output if the path is `-`; prints the error and returns false on
    /// failure.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> bool {
        if path == Path::new("-") {
            return self.bytes(bytes);
        }
        let written = output::write(path, bytes);
        if let Err(error) = &written {
            self.error(format_args!("cannot write {error}"));
        }
        written.is_ok()
    }

    /// Writes `output` itself, or a file below it if it is a folder; no link is followed out of that folder.
    pub(super) fn write_output(&self, output: &Path, path: &Path, bytes: &[u8]) -> bool {
        if path == output || !path.starts_with(output) {
            return self.write(path, bytes);
        }
        let written = output::write_inside(output, path, bytes);
        if let Err(error) = &written {
            self.error(format_args!("cannot write {error}"));
        }
        written.is_ok()
    }

    /// Shows a progress bar, on a terminal only.
    pub(super) fn bar(&self, steps: u64, label: &str) -> ProgressBar {
        let bar = self.progress(ProgressBar::with_draw_target(
            Some(steps),
            ProgressDrawTarget::stderr(),
        ));
        bar.set_style(
            ProgressStyle::with_template("{msg} {wide_bar} {percent} % {eta}")
                .unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        bar.set_message(label.to_owned());
        bar
    }

    /// Shows a spinner with a label, on a terminal only.
    pub(super) fn spinner(&self, label: &str) -> ProgressBar {
        let spinner = self.progress(ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()));
        spinner.set_message(label.to_owned());
        spinner.enable_steady_tick(Duration::from_millis(100));
        spinner
    }

    fn progress(&self, bar: ProgressBar) -> ProgressBar {
        if self.quiet {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        bar
    }
}

/// Handles interrupts (Ctrl-C): the first prints `message` and sets the returned flag, the second exits at
/// once.
pub(super) fn watch_interrupts(message: &'static str) -> Arc<AtomicBool> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // If no handler can be installed, an interrupt ends the program.
    let _ = ctrlc::set_handler(move || {
        Terminal::print_interrupt(message);
        if flag.swap(true, Ordering::Relaxed) {
            #[expect(clippy::exit, reason = "the user asked twice")]
            std::process::exit(130);
        }
    });
    interrupted
}
