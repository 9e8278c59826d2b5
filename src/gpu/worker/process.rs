//! A worker process: its start, its pipes and its end.

use std::collections::VecDeque;
use std::io::Read;
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use toyproof_diagnostic::path_name;

use crate::protocol::{Reply, Setup, receive, send};
use crate::{Failure, MAX_MEMORY_BYTES, Phase};

/// Time for a worker to exit after it has closed its pipe.
const EXIT_GRACE_PERIOD: Duration = Duration::from_millis(500);
/// Maximum number of replies in the queue: bands are large.
const MAX_QUEUED_REPLIES: usize = 1;
/// Capacity of the pipe for replies in bytes: the largest that every user may request by default.
#[cfg(target_os = "linux")]
const PIPE_BYTES: usize = 1 << 20;
/// Maximum length of the kept end of a worker's standard error, in bytes.
const MAX_STDERR_BYTES: usize = 4096;

/// Puts a process out of reach of the terminal's interrupt, so that the current shader completes.
fn detach(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(windows)]
    {
        const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
        std::os::windows::process::CommandExt::creation_flags(command, CREATE_NEW_PROCESS_GROUP);
    }
}

/// A running worker process.
#[derive(Debug)]
pub(super) struct Process {
    /// Whether the process runs Mesa's software driver without LLVM's optimizations.
    pub(super) is_plain: bool,
    child: Child,
    pub(super) requests: ChildStdin,
    pub(super) replies: Receiver<Reply>,
    stderr: JoinHandle<String>,
}

impl Process {
    /// Starts a process in the background, and sends it its setup.
    pub(super) fn spawn(mut command: Command, setup: &Setup, is_plain: bool) -> Result<Self, Failure> {
        detach(&mut command);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| {
                Failure::Worker(format!(
                    "{}: {error}",
                    path_name(Path::new(command.get_program()))
                ))
            })?;
        let missing = || Failure::Worker("no pipe to the worker".to_owned());
        let mut requests = child.stdin.take().ok_or_else(missing)?;
        let mut output = child.stdout.take().ok_or_else(missing)?;
        let errors = child.stderr.take().ok_or_else(missing)?;
        #[cfg(target_os = "linux")]
        {
            // If the system refuses, messages are read in more pieces.
            let _ = rustix::pipe::fcntl_setpipe_size(&output, PIPE_BYTES);
        }
        // The end of the replies reveals a dead worker.
        let _ = send(&mut requests, setup);
        let (sender, replies) = mpsc::sync_channel(MAX_QUEUED_REPLIES);
        thread::spawn(move || {
            while let Ok(reply) = receive(&mut output) {
                if sender.send(reply).is_err() {
                    break;
                }
            }
        });
        Ok(Self {
            is_plain,
            child,
            requests,
            replies,
            stderr: thread::spawn(move || stderr_tail(errors)),
        })
    }

    /// Ends the worker. Returns its exit status, if it exited by itself, and the end of its standard error.
    pub(super) fn end(mut self) -> (Option<ExitStatus>, String) {
        drop(self.requests);
        let deadline = Instant::now() + EXIT_GRACE_PERIOD;
        let closed = matches!(self.replies.try_recv(), Err(mpsc::TryRecvError::Disconnected));
        let mut status = None;
        while closed && status.is_none() && Instant::now() < deadline {
            status = self.child.try_wait().ok().flatten();
            thread::sleep(Duration::from_millis(2));
        }
        if status.is_none() {
            // Killing fails only for a child that has exited.
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
        (status, self.stderr.join().unwrap_or_default())
    }
}

fn stderr_tail(mut from: ChildStderr) -> String {
    let mut tail = VecDeque::new();
    let mut buffer = [0; 1024];
    while let Ok(count @ 1..) = from.read(&mut buffer) {
        tail.extend(&buffer[..count]);
        tail.drain(..tail.len().saturating_sub(MAX_STDERR_BYTES));
    }
    String::from_utf8_lossy(tail.make_contiguous()).trim().to_owned()
}

/// Classifies the end of a worker by the messages of Rust's allocator, its stack guard and LLVM.
pub(super) fn classify(phase: Phase, status: Option<ExitStatus>, stderr: &str) -> Failure {
    if stderr.contains("has overflowed its stack") {
        return Failure::StackOverflow { phase };
    }
    if stderr.contains("memory allocation of") || stderr.contains("out of memory") {
        return Failure::OutOfMemory {
            phase,
            limit_bytes: MAX_MEMORY_BYTES,
        };
    }
    Failure::Crash {
        phase,
        how: describe_exit(status, stderr),
    }
}

/// Describes how a worker ended, as part of a sentence.
fn describe_exit(status: Option<ExitStatus>, stderr: &str) -> String {
    let end = status.map_or_else(
        || "stopped responding".to_owned(),
        |status| format!("terminated ({status})"),
    );
    match stderr.lines().last() {
        Some(last) => format!("{end} with the message “{last}”"),
        None => end,
    }
}

/// The start of a worker process or, after its first reply, of its driver.
pub(super) struct Startup {
    pub(super) began: Instant,
    pub(super) deadline: Instant,
    is_driver: bool,
}

impl Startup {
    pub(super) fn new(timeout: Duration) -> Self {
        let began = Instant::now();
        Self {
            began,
            deadline: began + timeout,
            is_driver: false,
        }
    }

    pub(super) fn of_driver(timeout: Duration) -> Self {
        Self {
            is_driver: true,
            ..Self::new(timeout)
        }
    }

    pub(super) fn timeout_failure(&self, after: Duration) -> Failure {
        let what = if self.is_driver {
            "the Vulkan driver did not start"
        } else {
            "the worker process did not respond"
        };
        Failure::NotStarted(format!("{what} within {} s", after.as_secs_f64()))
    }

    pub(super) fn exit_failure(&self, status: Option<ExitStatus>, stderr: &str) -> Failure {
        let when = if self.is_driver {
            "while the Vulkan driver was starting"
        } else {
            "before its first reply"
        };
        Failure::NotStarted(format!(
            "the worker process {} {when}",
            describe_exit(status, stderr)
        ))
    }
}
