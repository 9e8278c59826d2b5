//! The one place that prints.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::panic::PanicHookInfo;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anstyle::{AnsiColor, Style};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use toyproof_diagnostic::{self as diagnostic, Diagnostic, Files, Severity};
use toyproof_image::output;
use toyproof_verify::contain;

/// How many warnings of one code a terminal is shown for one shader.
const WARNINGS_SHOWN: usize = 3;

/// What a command says, and to whom. Colours are stripped where they are not wanted: in files, in pipes, and
/// where `NO_COLOR` is set.
#[derive(Debug)]
pub(super) struct Terminal {
    quiet: bool,
    verbose: bool,
    /// Whether standard output did not take something.
    lost: AtomicBool,
    /// Whether whoever read standard output has closed it.
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
            lost: AtomicBool::new(false),
            closed: AtomicBool::new(false),
        }
    }

    /// Whether whoever read standard output has closed it.
    pub(super) fn is_closed(&self) -> bool {
        self.closed.load(Ordering::Relaxed)
    }

    pub(super) fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// Whether standard output did not take something.
    pub(super) fn has_lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    /// A result, on standard output.
    pub(super) fn result(&self, text: &str) {
        self.out(writeln!(anstream::stdout().lock(), "{text}"));
    }

    /// Bytes that are the result, on standard output; whether it took them.
    pub(super) fn bytes(&self, bytes: &[u8]) -> bool {
        let mut stdout = io::stdout().lock();
        self.out(stdout.write_all(bytes).and_then(|()| stdout.flush()))
    }

    /// Says once that standard output took something not. A reader that closed its end has all it wants.
    fn out(&self, written: io::Result<()>) -> bool {
        match written {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                if !self.lost.swap(true, Ordering::Relaxed) {
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

    /// What helps, on standard error; not with `--quiet`.
    pub(super) fn say(&self, text: &str) {
        if !self.quiet {
            let _ = writeln!(anstream::stderr().lock(), "{text}");
        }
    }

    /// What only `--verbose` wants, on standard error.
    pub(super) fn detail(&self, text: &str) {
        if self.verbose {
            let _ = writeln!(anstream::stderr().lock(), "{text}");
        }
    }

    /// What may not be what the user meant, on standard error.
    pub(super) fn warn(&self, text: impl std::fmt::Display) {
        let style = Style::new().fg_color(Some(AnsiColor::Yellow.into())).bold();
        let _ = writeln!(anstream::stderr().lock(), "{style}warning{style:#}: {text}");
    }

    /// What went wrong, on standard error.
    pub(super) fn error(&self, text: impl std::fmt::Display) {
        let style = Style::new().fg_color(Some(AnsiColor::Red.into())).bold();
        let _ = writeln!(anstream::stderr().lock(), "{style}error{style:#}: {text}");
    }

    /// What an interrupt means, said at once.
    pub(super) fn interrupted(words: &str) {
        let _ = writeln!(
            anstream::stderr().lock(),
            "{words}; interrupt again to stop at once"
        );
    }

    /// Where a panic happened; what it cost is said by whoever contains it.
    pub(super) fn panicked(info: &PanicHookInfo) {
        let place = info.location().map(|at| format!(" at {at}")).unwrap_or_default();
        let message = contain::message(info.payload());
        let _ = writeln!(
            anstream::stderr().lock(),
            "panic{place}: {message} (RUST_BACKTRACE=1 shows the calls)"
        );
    }

    /// Diagnostics with their source lines, on standard error; with `--quiet` a line each. Of warnings with one code the first few
    /// are shown and the others counted.
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

    /// Writes a file whole, or to standard output if it is named `-`; says what went wrong.
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

    /// Writes one of the files that go to the `output` argument: to it, or below it where it is a folder, from which no link leads out.
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

    /// A bar of so many steps, on a terminal only.
    pub(super) fn bar(&self, steps: u64, what: &str) -> ProgressBar {
        let bar = self.progress(ProgressBar::with_draw_target(
            Some(steps),
            ProgressDrawTarget::stderr(),
        ));
        bar.set_style(
            ProgressStyle::with_template("{msg} {wide_bar} {percent} % {eta}")
                .unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        bar.set_message(what.to_owned());
        bar
    }

    /// A sign of life with a few words, on a terminal only.
    pub(super) fn spinner(&self, what: &str) -> ProgressBar {
        let spinner = self.progress(ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()));
        spinner.set_message(what.to_owned());
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
