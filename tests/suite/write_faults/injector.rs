//! The program that makes system calls fail, compiled by the test.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use crate::program::{Run, output};
use crate::requirements::skip;

/// What happens to a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    /// It and all later ones that need space fail: ENOSPC.
    Full,
    /// It fails: EIO.
    Device,
    /// It is interrupted: EINTR.
    Interrupted,
    /// It writes half of its bytes.
    Short,
}

impl Fault {
    pub(super) const ALL: [Self; 4] = [Self::Full, Self::Device, Self::Interrupted, Self::Short];

    fn name(self) -> &'static str {
        match self {
            Self::Full => "enospc",
            Self::Device => "eio",
            Self::Interrupted => "eintr",
            Self::Short => "short",
        }
    }
}

/// The compiled `inject.c`.
pub(super) struct Injector {
    folder: TempDir,
}

impl Injector {
    /// Compiles it; none, with a message, where it cannot run.
    pub(super) fn new() -> Option<Self> {
        if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            skip("faults are injected on x86-64 Linux only");
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        let injector = Self { folder };
        let mut compiler = Command::new("cc");
        compiler.args(["-O1", "-o"]).arg(injector.program());
        compiler.arg(Path::new("tests/suite/write_faults/inject.c"));
        match compiler.output() {
            Err(_) => {
                skip("no C compiler (cc)");
                return None;
            }
            Ok(compiled) => assert!(
                compiled.status.success(),
                "{}",
                String::from_utf8_lossy(&compiled.stderr)
            ),
        }
        let mut probe = injector.command(injector.folder.path(), None);
        if probe.arg("/bin/true").status().unwrap().success() {
            Some(injector)
        } else {
            skip("programs cannot be traced here (ptrace)");
            None
        }
    }

    fn program(&self) -> PathBuf {
        self.folder.path().join("inject")
    }

    fn report(&self) -> PathBuf {
        self.folder.path().join("calls")
    }

    fn command(&self, below: &Path, fault: Option<(Fault, usize)>) -> Command {
        let (fault, number) = fault.unwrap_or((Fault::Device, 0));
        let mut command = Command::new(self.program());
        command.arg(below).args([fault.name(), &number.to_string()]);
        command.arg(self.report());
        command
    }

    /// Runs `toyproof` in a folder, and a fault at the call of this number, from 1. Also returns the calls that write
    /// below the folder.
    pub(super) fn run(
        &self,
        folder: &Path,
        arguments: &[&str],
        fault: Option<(Fault, usize)>,
    ) -> (Run, Vec<String>) {
        let folder = folder.canonicalize().unwrap();
        let mut command = self.command(&folder, fault);
        command.arg(env!("CARGO_BIN_EXE_toyproof")).args(arguments);
        // With one thread, the calls of two runs have the same order.
        command
            .current_dir(&folder)
            .env("RAYON_NUM_THREADS", "1")
            .env_remove("NO_COLOR");
        let run = output(&mut command);
        let calls = fs::read_to_string(self.report()).unwrap();
        (run, calls.lines().map(str::to_owned).collect())
    }
}
