//! The parent's side: start the worker, hold it to its deadline, say what became of it.

use std::collections::VecDeque;
use std::io::Read;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, ChildStderr, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use toyproof_diagnostic::path_name;
use toyproof_image::{Frame, Image};
use toyproof_translate::backend::Target;
use toyproof_translate::{FloatMode, Lowered};

use super::protocol::{Foreign, Job, Output, Reply, Shot, Written, receive, send};
use super::{Drawn, Driver, Failure, On, Phase, driver};

/// A worker process that is started when it is first needed, and anew after each that died.
#[derive(Debug)]
pub struct Worker {
    program: PathBuf,
    arguments: Vec<String>,
    on: On,
    timeout: Duration,
    start_timeout: Duration,
    all_drivers: bool,
    manifest: Option<PathBuf>,
    compiles_plainly: bool,
    live: Option<Live>,
    /// Whether a job has been done.
    has_worked: bool,
    /// Why the driver did not start, before it ever did: no other job waits for it.
    not_started: Option<Failure>,
}

/// How long a driver may take to start, unless a shader may take longer: a busy machine needs a second or two.
const START_TIMEOUT: Duration = Duration::from_secs(10);
/// How long a worker that closed its pipe may take to end.
const GRACE: Duration = Duration::from_millis(500);
/// So many replies may wait to be heard: bands are large.
const WAITING: usize = 1;
/// What tells Mesa's software driver how its code is to be made.
const COMPILER_FLAGS: &str = "GALLIVM_PERF";
/// How much of a worker's last words is kept, in bytes.
const LAST_WORDS: usize = 4096;

impl Worker {
    /// A worker that is `program` with `arguments`, which must call [`super::serve`] on its standard streams.
    #[must_use]
    pub fn new(program: PathBuf, arguments: Vec<String>, on: On, timeout: Duration) -> Self {
        Self {
            program,
            arguments,
            on,
            timeout,
            start_timeout: timeout.max(START_TIMEOUT),
            all_drivers: false,
            manifest: None,
            compiles_plainly: false,
            live: None,
            has_worked: false,
            not_started: None,
        }
    }

    /// The same, giving the process and its driver that long to start. What a job may take does not pass meanwhile.
    #[must_use]
    pub fn with_start_timeout(mut self, start_timeout: Duration) -> Self {
        self.start_timeout = start_timeout;
        self
    }

    /// The same, loading every installed driver, also where one is known to be enough.
    #[must_use]
    pub fn with_all_drivers(mut self) -> Self {
        self.all_drivers = true;
        self
    }

    /// The same, loading the driver of that manifest and no other, wherever it is installed.
    #[must_use]
    pub fn with_manifest(mut self, manifest: PathBuf) -> Self {
        self.manifest = Some(manifest);
        self
    }

    /// The same, with code from Mesa's software driver that is made in half the time or less, and runs 1.3 to 2 times as long: LLVM
    /// does not optimise it, which changes no bits. Good for small pictures.
    #[must_use]
    pub fn with_plain_code(mut self) -> Self {
        self.compiles_plainly = true;
        self
    }

    /// The Vulkan drivers that are there; the chosen one first.
    ///
    /// # Errors
    /// [`Failure::NoDriver`] if none can be used.
    pub fn probe(&mut self) -> Result<Vec<Driver>, Failure> {
        match self.run(&Job::Probe(self.on.clone()))? {
            Output::Drivers(drivers) => Ok(drivers),
            _ => Err(out_of_turn()),
        }
    }

    /// The shader in another language.
    ///
    /// # Errors
    /// Why not.
    pub fn translate(
        &mut self,
        lowered: Lowered,
        target: Target,
        float: FloatMode,
    ) -> Result<Vec<u8>, Failure> {
        match self.run(&Job::Translate(lowered, target, float))? {
            Output::Translated(bytes) => Ok(bytes),
            _ => Err(out_of_turn()),
        }
    }

    /// Has naga read WGSL.
    ///
    /// # Errors
    /// [`Failure::Reread`] if it refuses it; else why it was not read to its end.
    pub fn read_wgsl(&mut self, text: &str) -> Result<(), Failure> {
        match self.run(&Job::Read(text.to_owned()))? {
            Output::Ran => Ok(()),
            _ => Err(out_of_turn()),
        }
    }

    /// The picture that the shader paints. Where the driver may end loops by force, the frame is painted again to
    /// see whether it did, under a deadline of its own.
    ///
    /// # Errors
    /// Why there is none.
    pub fn draw(&mut self, lowered: Lowered, frame: Frame, float: FloatMode) -> Result<Drawn, Failure> {
        self.draw_whole(lowered, frame, float, true)
    }

    /// The same without a look at its loops: somebody else knows that they are short.
    ///
    /// # Errors
    /// Why there is none.
    pub fn draw_unwatched(
        &mut self,
        lowered: Lowered,
        frame: Frame,
        float: FloatMode,
    ) -> Result<Drawn, Failure> {
        self.draw_whole(lowered, frame, float, false)
    }

    fn draw_whole(
        &mut self,
        lowered: Lowered,
        frame: Frame,
        float: FloatMode,
        watch: bool,
    ) -> Result<Drawn, Failure> {
        let mut bands = Vec::new();
        let each = |band| bands.push(band);
        let drawn = self.draw_in_bands(lowered, frame, float, each, |_, _| watch)?;
        Ok(Drawn { bands, ..drawn })
    }

    /// The same as [`Self::draw`] without a picture: `each` is given one band of it after the other, as of [`Frame::bands`], and may take its time. And the
    /// frame is painted again only if `watch` says so, shown what was drawn and told how long that took: somebody else may
    /// know that no pixel runs more than [`SAFE_ROUNDS`](super::SAFE_ROUNDS).
    ///
    /// # Errors
    /// Why there is no picture: [`Failure::Invalid`] also of a shader that nests deeper than drivers count.
    pub fn draw_in_bands(
        &mut self,
        lowered: Lowered,
        frame: Frame,
        float: FloatMode,
        mut each: impl FnMut(Image),
        watch: impl FnOnce(&Drawn, Duration) -> bool,
    ) -> Result<Drawn, Failure> {
        if let Some(told) = lowered.too_deep() {
            return Err(Failure::Invalid(vec![told.clone()]));
        }
        let shot = Box::new(Shot {
            lowered,
            frame,
            float,
            on: self.on.clone(),
        });
        let job = Job::Draw(shot);
        let start = Instant::now();
        let mut waited = Duration::ZERO;
        let output = self.run_in_bands(&job, |band| {
            let start = Instant::now();
            each(band);
            waited += start.elapsed();
        });
        let mut drawn = match output? {
            Output::Drawn(drawn) => *drawn,
            _ => return Err(out_of_turn()),
        };
        let is_to_be_watched = watch(&drawn, start.elapsed().saturating_sub(waited));
        if let (true, Job::Draw(shot)) = (drawn.may_be_cut_short && is_to_be_watched, job) {
            // Whatever stops this, the picture stands.
            drawn.cut_short = match self.run(&Job::WatchLoops(shot)) {
                Ok(Output::CutShort(pixels)) => Some(pixels),
                _ => None,
            };
        }
        Ok(drawn)
    }

    /// The picture that another compiler's SPIR-V paints: one entry point `main`, the frame's block and its two-dimensional channels at
    /// the bindings that [`toyproof_translate::backend`] tells of. For comparing compilers.
    ///
    /// # Errors
    /// Why there is none.
    pub fn run_spirv(&mut self, words: Vec<u32>, frame: Frame, float: FloatMode) -> Result<Image, Failure> {
        let foreign = Foreign {
            words,
            frame,
            float,
            on: self.on.clone(),
        };
        let mut bands = Vec::new();
        match self.run_in_bands(&Job::Run(Box::new(foreign)), |band| bands.push(band))? {
            Output::Ran => Ok(Image::of_bands(bands)),
            _ => Err(out_of_turn()),
        }
    }

    /// The pictures that a converted shader paints, read again from what was written, and who painted them. What drivers differ in is spelled
    /// in operations that they agree on, and they are held to the arithmetic as written.
    ///
    /// # Errors
    /// [`Failure::Reread`] if the text is refused; else why there are no pictures.
    pub fn paint(&mut self, written: Written, frames: Vec<Frame>) -> Result<(Vec<Image>, String), Failure> {
        match self.run(&Job::Paint(Box::new(written), frames, self.on.clone()))? {
            Output::Painted(images, device) => Ok((images, device)),
            _ => Err(out_of_turn()),
        }
    }

    /// Has a job done that gives no picture.
    fn run(&mut self, job: &Job) -> Result<Output, Failure> {
        self.run_in_bands(job, |_| ())
    }

    /// Has a job done, whose picture `each` is given. A driver that did not start is not started again, unless it had done a job.
    fn run_in_bands(&mut self, job: &Job, each: impl FnMut(Image)) -> Result<Output, Failure> {
        if let Some(failure) = &self.not_started {
            return Err(failure.clone());
        }
        let output = self.ask(job, each);
        match &output {
            Ok(_) => self.has_worked = true,
            Err(failure @ Failure::NotStarted(_)) if !self.has_worked => {
                self.not_started = Some(failure.clone());
            }
            Err(_) => {}
        }
        output
    }

    /// Has a job done, under a deadline that does not pass while `each` works or the driver starts.
    fn ask(&mut self, job: &Job, mut each: impl FnMut(Image)) -> Result<Output, Failure> {
        let mut live = match self.live.take() {
            Some(live) => live,
            None => self.start()?,
        };
        let mut deadline = Instant::now() + self.timeout;
        let mut start = Start::new(self.start_timeout);
        let mut phase = Phase::Starting;
        // A worker that died is told by its replies' end; sending is best effort.
        let sent = send(&mut live.requests, job);
        loop {
            let until = match phase {
                Phase::Starting => start.deadline,
                _ => deadline,
            };
            match live
                .replies
                .recv_timeout(until.saturating_duration_since(Instant::now()))
            {
                Ok(Reply::Phase(now)) => {
                    if phase == Phase::Starting {
                        deadline += start.began.elapsed();
                    }
                    if now == Phase::Starting {
                        start = Start::of_driver(self.start_timeout);
                    }
                    phase = now;
                }
                Ok(Reply::Band(band)) => {
                    let start = Instant::now();
                    each(band);
                    deadline += start.elapsed();
                }
                Ok(Reply::Done(result)) => {
                    self.live = Some(live);
                    return result.map_err(told_of_pins);
                }
                Err(RecvTimeoutError::Timeout) => {
                    live.end();
                    let after = self.timeout;
                    return Err(match phase {
                        Phase::Starting => start.timed_out(self.start_timeout),
                        _ => Failure::Timeout { phase, after },
                    });
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let (status, words) = live.end();
                    return Err(match sent {
                        Err(error) if status.is_none() => Failure::Worker(error.to_string()),
                        _ if phase == Phase::Starting => start.died(status, &words),
                        _ => classify(phase, status, &words),
                    });
                }
            }
        }
    }

    /// The one driver that is enough where none is asked for: loading it instead of all takes 20 ms instead of 170.
    fn usual_manifest(&self) -> Option<PathBuf> {
        let is_enough = matches!(self.on, On::Auto | On::Lavapipe);
        (is_enough && !self.all_drivers && !driver::is_pinned_by_user())
            .then(driver::lavapipe_manifest)
            .flatten()
    }

    fn start(&self) -> Result<Live, Failure> {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments);
        if let Some(manifest) = self.manifest.clone().or_else(|| self.usual_manifest()) {
            for name in driver::PINS {
                command.env(name, &manifest);
            }
        }
        if self.compiles_plainly && std::env::var_os(COMPILER_FLAGS).is_none() {
            command.env(COMPILER_FLAGS, "nopt");
        }
        if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
            command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
        }
        let mut child = command
            // Out of reach of the terminal's interrupt, so that the shader in hand is finished.
            .process_group(0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| Failure::Worker(format!("{}: {error}", path_name(&self.program))))?;
        let missing = || Failure::Worker("no pipe to the worker".to_owned());
        let requests = child.stdin.take().ok_or_else(missing)?;
        let mut output = child.stdout.take().ok_or_else(missing)?;
        let errors = child.stderr.take().ok_or_else(missing)?;
        let (sender, replies) = mpsc::sync_channel(WAITING);
        thread::spawn(move || {
            while let Ok(reply) = receive(&mut output) {
                if sender.send(reply).is_err() {
                    break;
                }
            }
        });
        Ok(Live {
            child,
            requests,
            replies,
            words: thread::spawn(move || last_words(errors)),
        })
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        if let Some(live) = self.live.take() {
            live.end();
        }
    }
}

/// A running worker.
#[derive(Debug)]
struct Live {
    child: Child,
    requests: ChildStdin,
    replies: Receiver<Reply>,
    words: JoinHandle<String>,
}

impl Live {
    /// Ends the worker; gives how it ended if it did so by itself, and its last words.
    fn end(mut self) -> (Option<ExitStatus>, String) {
        drop(self.requests);
        let deadline = Instant::now() + GRACE;
        let closed = matches!(self.replies.try_recv(), Err(mpsc::TryRecvError::Disconnected));
        let mut status = None;
        while closed && status.is_none() && Instant::now() < deadline {
            status = self.child.try_wait().ok().flatten();
            thread::sleep(Duration::from_millis(2));
        }
        if status.is_none() {
            // Killing fails only for a child that has ended.
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
        (status, self.words.join().unwrap_or_default())
    }
}

fn last_words(mut from: ChildStderr) -> String {
    let mut kept = VecDeque::new();
    let mut buffer = [0; 1024];
    while let Ok(count @ 1..) = from.read(&mut buffer) {
        kept.extend(&buffer[..count]);
        kept.drain(..kept.len().saturating_sub(LAST_WORDS));
    }
    String::from_utf8_lossy(kept.make_contiguous()).trim().to_owned()
}

/// What a worker died of. Rust's allocator, its stack guard and LLVM say so in known words.
fn classify(phase: Phase, status: Option<ExitStatus>, words: &str) -> Failure {
    if words.contains("has overflowed its stack") {
        return Failure::StackOverflow { phase };
    }
    if words.contains("memory allocation of") || words.contains("out of memory") {
        return Failure::OutOfMemory { phase };
    }
    Failure::Crash {
        phase,
        how: end_of(status, words),
    }
}

/// How a worker ended, as part of a sentence.
fn end_of(status: Option<ExitStatus>, words: &str) -> String {
    let end = status.map_or_else(
        || "stopped answering".to_owned(),
        |status| format!("died ({status})"),
    );
    match words.lines().last() {
        Some(last) => format!("{end}, saying “{last}”,"),
        None => end,
    }
}

/// A worker process or, once it has answered, its driver on the way up.
struct Start {
    began: Instant,
    deadline: Instant,
    is_driver: bool,
}

impl Start {
    fn new(timeout: Duration) -> Self {
        let began = Instant::now();
        Self {
            began,
            deadline: began + timeout,
            is_driver: false,
        }
    }

    fn of_driver(timeout: Duration) -> Self {
        Self {
            is_driver: true,
            ..Self::new(timeout)
        }
    }

    fn timed_out(&self, after: Duration) -> Failure {
        let what = if self.is_driver {
            "the Vulkan driver did not start"
        } else {
            "the worker process did not answer"
        };
        Failure::NotStarted(format!("{what} within {} s", after.as_secs_f64()))
    }

    fn died(&self, status: Option<ExitStatus>, words: &str) -> Failure {
        let when = if self.is_driver {
            "while the Vulkan driver was starting"
        } else {
            "before it answered"
        };
        Failure::NotStarted(format!("the worker process {} {when}", end_of(status, words)))
    }
}

/// A driver that is missing may only be hidden.
fn told_of_pins(failure: Failure) -> Failure {
    match failure {
        Failure::NoDriver(why) if driver::is_pinned_by_user() => Failure::NoDriver(format!(
            "{why}; {} is set, and hides all drivers but those that it names",
            driver::PINS.join(" or ")
        )),
        failure => failure,
    }
}

fn out_of_turn() -> Failure {
    Failure::Worker("it answered another question than was asked".to_owned())
}
