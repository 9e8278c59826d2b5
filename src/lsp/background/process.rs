//! Processes with a limit of time, which are ended when they are no longer needed.

use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

/// The most bytes that are read of what a process prints: a check prints kilobytes, a trace megabytes.
const MAX_OUTPUT_BYTES: u64 = 64 << 20;

/// What a process printed.
#[derive(Debug)]
pub(crate) enum Output {
    /// Standard output, and the last line of standard error.
    Finished {
        /// Standard output.
        out: Vec<u8>,
        /// What standard error says last, if anything.
        error: Option<String>,
    },
    /// The time limit was exceeded.
    TimedOut,
}

/// A running process. It is ended when the value is dropped.
#[derive(Debug)]
pub(crate) struct Job {
    child: Arc<Mutex<Child>>,
}

impl Drop for Job {
    fn drop(&mut self) {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        // It may have ended already.
        let _ = child.kill();
        let _ = child.wait();
    }
}

impl Job {
    /// Starts a process. `done` is called from another thread with what it printed.
    ///
    /// # Errors
    /// The process cannot be started.
    pub(crate) fn start(
        mut command: Command,
        limit: Duration,
        done: impl FnOnce(Output) + Send + 'static,
    ) -> std::io::Result<Self> {
        command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn()?;
        let (out, error) = (child.stdout.take(), child.stderr.take());
        let child = Arc::new(Mutex::new(child));
        let running = child.clone();
        let (finished, waiting) = mpsc::channel();
        let error = thread::spawn(move || error.map(read_all).unwrap_or_default());
        thread::spawn(move || {
            // Nobody waits after the time limit.
            let _ = finished.send(out.map(read_all).unwrap_or_default());
        });
        thread::spawn(move || {
            let Ok(out) = waiting.recv_timeout(limit) else {
                let _ = running.lock().unwrap_or_else(PoisonError::into_inner).kill();
                return done(Output::TimedOut);
            };
            let error = error.join().unwrap_or_default();
            let error = String::from_utf8_lossy(&error);
            let last = error.lines().rfind(|line| !line.trim().is_empty());
            let error = last.map(str::to_owned);
            done(Output::Finished { out, error });
        });
        Ok(Self { child })
    }
}

fn read_all(stream: impl Read) -> Vec<u8> {
    let mut bytes = Vec::new();
    // What was read before an error counts.
    let _ = stream.take(MAX_OUTPUT_BYTES).read_to_end(&mut bytes);
    bytes
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    /// A process that runs a script of the shell, and what it printed.
    fn run(script: &str, limit: Duration) -> Output {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        let (send, receive) = mpsc::channel();
        let job = Job::start(command, limit, move |output| send.send(output).unwrap()).unwrap();
        let output = receive.recv().unwrap();
        drop(job);
        output
    }

    #[test]
    fn what_a_process_prints_is_read() {
        let Output::Finished { out, error } = run("echo out; echo first >&2; echo last >&2", Duration::MAX)
        else {
            panic!("it ends")
        };
        assert_eq!((out, error.as_deref()), (b"out\n".to_vec(), Some("last")));
    }

    #[test]
    fn a_process_that_takes_too_long_is_ended() {
        assert!(matches!(
            run("exec sleep 1000", Duration::from_millis(10)),
            Output::TimedOut
        ));
    }

    #[test]
    fn a_job_that_is_dropped_ends_its_process() {
        let mut command = Command::new("sleep");
        command.arg("1000");
        let (send, receive) = mpsc::channel();
        let job = Job::start(command, Duration::MAX, move |output| send.send(output).unwrap()).unwrap();
        drop(job);
        assert!(matches!(receive.recv().unwrap(), Output::Finished { .. }));
    }
}
