//! The parent's side: starts the worker, enforces deadlines, and classifies failures.

mod process;

use std::path::PathBuf;
use std::process::Command;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use process::{Process, Startup, classify};
use toyproof_image::{Frame, Image, Sampling, Texture};
use toyproof_player::{DrawOutput, Driver as _, Graph, Readback, State};
use toyproof_translate::backend::Target;
use toyproof_translate::{FloatMode, Lowered};

use crate::protocol::{DrawJob, Job, Output, PassCode, PlayJob, Reply, Setup, ShaderArtifact, send};
use crate::quirks::loop_cap::SAFE_ITERATIONS;
use crate::{AdapterSelector, Driver, Failure, Phase, Sandbox, device, quirks, sandbox};

/// A worker process, started on first use and restarted after each failure.
#[derive(Debug)]
pub struct Worker {
    program: PathBuf,
    arguments: Vec<String>,
    selector: AdapterSelector,
    timeout: Duration,
    start_timeout: Duration,
    uses_driver: bool,
    all_drivers: bool,
    manifest: Option<PathBuf>,
    plain_code: PlainCode,
    running: Option<Process>,
    /// Whether a job has been completed.
    has_completed_job: bool,
    /// Why the driver did not start, if it never has. No further job waits for it.
    not_started: Option<Failure>,
}

/// The images for which Mesa's software driver compiles without LLVM's optimizations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PlainCode {
    Never,
    /// Images of at most [`MAX_PLAIN_PIXELS`].
    Small,
    Always,
}

/// Maximum number of pixels of an image that takes less time without LLVM's optimizations. Of 24 public
/// shaders at 256×144, compiling took 5.3 s with and 3.2 s without them, and rendering 1.3 and 2.2 s: both
/// are equal at 88,000 pixels.
const MAX_PLAIN_PIXELS: u64 = 320 * 240;

/// Minimum time limit for the start of a driver: a busy machine needs a second or two.
const START_TIMEOUT: Duration = Duration::from_secs(10);

/// Environment variable that controls the code generation of Mesa's software driver.
const COMPILER_FLAGS: &str = "GALLIVM_PERF";

/// The value of the result that a job has.
macro_rules! result {
    ($output:expr, $result:pat => $value:expr) => {
        match $output? {
            $result => Ok($value),
            _ => Err(Failure::Worker("unexpected reply".to_owned())),
        }
    };
}

impl Worker {
    /// Creates a worker that runs `program` with `arguments`, which must call [`crate::serve`] on its
    /// standard streams.
    pub fn new(
        program: PathBuf,
        arguments: Vec<String>,
        selector: AdapterSelector,
        timeout: Duration,
    ) -> Self {
        Self {
            program,
            arguments,
            selector,
            timeout,
            start_timeout: timeout.max(START_TIMEOUT),
            uses_driver: true,
            all_drivers: false,
            manifest: None,
            plain_code: PlainCode::Never,
            running: None,
            has_completed_job: false,
            not_started: None,
        }
    }

    /// Sets the time limit for the start of the process and its driver, which does not count against the time
    /// limit of a job.
    #[must_use]
    pub fn with_start_timeout(mut self, start_timeout: Duration) -> Self {
        self.start_timeout = start_timeout;
        self
    }

    /// Only translates and parses: no driver is looked for, and the process has no access to files.
    #[must_use]
    pub fn without_driver(mut self) -> Self {
        self.uses_driver = false;
        self
    }

    /// Loads all installed drivers, even where one is known to be enough.
    #[must_use]
    pub fn with_all_drivers(mut self) -> Self {
        self.all_drivers = true;
        self
    }

    /// Loads only the driver of this manifest, wherever it is installed.
    #[must_use]
    pub fn with_manifest(mut self, manifest: PathBuf) -> Self {
        self.manifest = Some(manifest);
        self
    }

    /// Disables LLVM's optimizations in Mesa's software driver: compiling takes half the time or less, and
    /// shaders run 1.3 to 2 times as long, with the same bits. Useful for small images.
    #[must_use]
    pub fn with_plain_code(mut self) -> Self {
        self.plain_code = PlainCode::Always;
        self
    }

    /// Like [`Self::with_plain_code`] for small images only. One that then exceeds the time limit is rendered
    /// again with optimized code.
    #[must_use]
    pub fn with_plain_code_for_small_images(mut self) -> Self {
        self.plain_code = PlainCode::Small;
        self
    }

    /// Starts the process and its driver without waiting for them, if no process is running, for images of at
    /// most `pixels`. The next job finds the driver loaded, or reports why it is not.
    pub fn warm_up(&mut self, pixels: u64) {
        if self.running.is_some() || self.not_started.is_some() {
            return;
        }
        let is_plain = self.plain_code.applies_to(Some(pixels));
        if let Ok(mut running) = self.start(is_plain)
            && (!self.uses_driver || send(&mut running.requests, &Job::Open).is_ok())
        {
            self.running = Some(running);
        }
    }

    /// Ends the process, which releases the memory of the driver. The next job starts another one.
    pub fn stop(&mut self) {
        if let Some(running) = self.running.take() {
            running.end();
        }
    }

    /// Lists the Vulkan drivers, the selected one first.
    ///
    /// # Errors
    /// [`Failure::NoDriver`] if none is usable.
    pub fn probe(&mut self) -> Result<Vec<Driver>, Failure> {
        result!(self.run(&Job::Probe), Output::Drivers(drivers) => drivers)
    }

    /// Returns how the worker process is restricted.
    ///
    /// # Errors
    /// If it does not start.
    pub fn sandbox(&mut self) -> Result<Sandbox, Failure> {
        result!(self.run(&Job::Sandbox), Output::Sandbox(sandbox) => sandbox)
    }

    /// Translates the shader to a different language.
    ///
    /// # Errors
    /// Why the translation failed.
    pub fn translate(
        &mut self,
        lowered: Lowered,
        target: Target,
        float: FloatMode,
    ) -> Result<Vec<u8>, Failure> {
        result!(self.run(&Job::Translate(lowered, target, float)), Output::Translated(bytes) => bytes)
    }

    /// Parses and validates WGSL by naga.
    ///
    /// # Errors
    /// [`Failure::Reread`] if naga rejects it; other failures if it could not be processed.
    pub fn read_wgsl(&mut self, text: &str) -> Result<(), Failure> {
        result!(self.run(&Job::ReadWgsl(text.to_owned())), Output::Completed => ())
    }

    /// Parses a converted shader by naga, and writes it as a shader of `ShaderToy`.
    ///
    /// # Errors
    /// [`Failure::Reread`] if naga rejects it; other failures if it could not be processed.
    pub fn rewrite(&mut self, artifact: ShaderArtifact) -> Result<String, Failure> {
        let job = Job::RewriteArtifact(Box::new(artifact));
        let bytes: Vec<u8> = result!(self.run(&job), Output::Translated(bytes) => bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Renders a frame of the shader. If the driver may terminate long loops, the frame is rendered again to
    /// check whether it did, under a separate deadline.
    ///
    /// # Errors
    /// Why there is no image.
    pub fn draw(&mut self, lowered: Lowered, frame: Frame, float: FloatMode) -> Result<DrawOutput, Failure> {
        self.draw_frame(lowered, frame, float, true)
    }

    /// Like [`Self::draw`] without the check of loops, for callers that know that loops are short.
    ///
    /// # Errors
    /// Why there is no image.
    pub fn draw_unwatched(
        &mut self,
        lowered: Lowered,
        frame: Frame,
        float: FloatMode,
    ) -> Result<DrawOutput, Failure> {
        self.draw_frame(lowered, frame, float, false)
    }

    fn draw_frame(
        &mut self,
        lowered: Lowered,
        frame: Frame,
        float: FloatMode,
        checks_loops: bool,
    ) -> Result<DrawOutput, Failure> {
        let mut bands = Vec::new();
        let on_band = &mut |band| bands.push(band);
        let drawn = self.draw_in_bands((lowered, float), frame, on_band, &mut |_, _| checks_loops)?;
        Ok(DrawOutput { bands, ..drawn })
    }

    /// Parses a converted shader again and renders its frames. Returns the images and the name of the device.
    /// Operations in which drivers differ are expanded to operations on which they agree, with strict
    /// arithmetic.
    ///
    /// # Errors
    /// [`Failure::Reread`] if the text is rejected; other failures if there are no images.
    pub fn render(
        &mut self,
        artifact: ShaderArtifact,
        sampling: [Sampling; 4],
        frames: Vec<Frame>,
    ) -> Result<(Vec<Image>, String), Failure> {
        let job = Job::RenderArtifact(Box::new(artifact), sampling, frames);
        result!(self.run(&job), Output::Rendered(images, device) => (images, device))
    }

    /// Compiles the passes of a shader, in the order of their graph, with the samplers of each and the
    /// textures that do not change, and continues from a state, if there is one. Returns the name of the
    /// device. [`play`](toyproof_player::Driver::play) then renders the frames, until another job follows.
    ///
    /// # Errors
    /// Why the passes cannot be rendered.
    pub fn open_player(
        &mut self,
        passes: PassCode,
        sampling: Vec<[Sampling; 4]>,
        graph: Graph,
        media: Vec<Texture>,
        state: Option<State>,
    ) -> Result<String, Failure> {
        if let PassCode::Lowered(passes) = &passes
            && let Some(diagnostic) = passes.iter().find_map(|(lowered, _)| lowered.too_deep())
        {
            return Err(Failure::Invalid(vec![diagnostic.clone()]));
        }
        let job = Job::OpenPlayer(Box::new(PlayJob {
            passes,
            sampling,
            graph,
            media,
            state,
        }));
        result!(self.run(&job), Output::Opened(device) => device)
    }

    /// Runs a job without images.
    fn run(&mut self, job: &Job) -> Result<Output, Failure> {
        self.run_in_bands(job, |_| ())
    }

    /// Runs a job and passes the bands of its image to `on_band`. After a driver has failed to start, it is
    /// not started again, unless it had completed a job.
    fn run_in_bands(&mut self, job: &Job, on_band: impl FnMut(Image)) -> Result<Output, Failure> {
        if let Some(failure) = &self.not_started {
            return Err(failure.clone());
        }
        let output = self.run_job(job, on_band);
        match &output {
            Ok(_) => self.has_completed_job = true,
            Err(failure @ Failure::NotStarted(_)) if !self.has_completed_job => {
                self.not_started = Some(failure.clone());
            }
            Err(_) => {}
        }
        output
    }

    /// Runs a job. If unoptimized code exceeds the time limit, the job runs again with optimized code.
    fn run_job(&mut self, job: &Job, mut on_band: impl FnMut(Image)) -> Result<Output, Failure> {
        let is_plain = self.plain_code.applies_to(job.pixels());
        let running = match self.running.take() {
            Some(running) if running.is_plain && !is_plain => {
                running.end();
                self.start(is_plain)?
            }
            Some(running) => running,
            None => self.start(is_plain)?,
        };
        let may_repeat = running.is_plain && self.plain_code == PlainCode::Small;
        let mut bands = 0;
        let output = self.run_on(running, job, |band| {
            bands += 1;
            on_band(band);
        });
        let is_late = matches!(
            output,
            Err(Failure::Timeout {
                phase: Phase::Drawing,
                ..
            })
        );
        if !(may_repeat && is_late && bands == 0) {
            return output;
        }
        let running = self.start(false)?;
        let output = self.run_on(running, job, on_band);
        // The next image is compiled without optimizations again.
        self.stop();
        output
    }

    /// Runs a job under a deadline. The time that `on_band` or the start of the driver takes does not count.
    fn run_on(
        &mut self,
        mut running: Process,
        job: &Job,
        mut on_band: impl FnMut(Image),
    ) -> Result<Output, Failure> {
        let mut deadline = Instant::now() + self.timeout;
        let mut start = Startup::new(self.start_timeout);
        let mut phase = Phase::Starting;
        // The end of the replies reveals a dead worker; ignore errors of sending.
        let sent = send(&mut running.requests, job);
        loop {
            let until = match phase {
                Phase::Starting => start.deadline,
                _ => deadline,
            };
            match running
                .replies
                .recv_timeout(until.saturating_duration_since(Instant::now()))
            {
                Ok(Reply::Phase(now)) => {
                    if phase == Phase::Starting {
                        deadline += start.began.elapsed();
                    }
                    if now == Phase::Starting {
                        start = Startup::of_driver(self.start_timeout);
                    }
                    phase = now;
                }
                Ok(Reply::Band(band)) => {
                    let start = Instant::now();
                    on_band(band);
                    deadline += start.elapsed();
                }
                Ok(Reply::Done(result)) => {
                    self.running = Some(running);
                    return result.map_err(with_pin_hint);
                }
                Err(RecvTimeoutError::Timeout) => {
                    running.end();
                    let after = self.timeout;
                    return Err(match phase {
                        Phase::Starting => start.timeout_failure(self.start_timeout),
                        _ => Failure::Timeout { phase, after },
                    });
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let (status, stderr) = running.end();
                    return Err(match sent {
                        Err(error) if status.is_none() => Failure::Worker(error.to_string()),
                        _ if phase == Phase::Starting => start.exit_failure(status, &stderr),
                        _ => classify(phase, status, &stderr),
                    });
                }
            }
        }
    }

    /// Returns the manifest of the default driver if no other is selected: loading it alone takes 20 ms,
    /// loading all drivers 170 ms.
    fn default_manifest(&self) -> Option<PathBuf> {
        let suffices = matches!(self.selector, AdapterSelector::Auto | AdapterSelector::Lavapipe);
        (suffices && self.uses_driver && !self.all_drivers && !device::is_pinned_by_user())
            .then(device::lavapipe_manifest)
            .flatten()
    }

    /// Starts a process. If `is_plain`, its driver compiles without optimizations, unless the user has set
    /// the compiler's flags.
    fn start(&self, is_plain: bool) -> Result<Process, Failure> {
        if self.uses_driver {
            sandbox::create_caches();
        }
        let mut command = Command::new(&self.program);
        command.args(&self.arguments);
        let default = self.default_manifest();
        if let Some(manifest) = self.manifest.as_ref().or(default.as_ref()) {
            for name in device::PIN_VARIABLES {
                command.env(name, manifest);
            }
        }
        let is_plain = is_plain && std::env::var_os(COMPILER_FLAGS).is_none();
        if is_plain {
            command.env(COMPILER_FLAGS, "nopt");
        }
        quirks::set_environment(&mut command);
        let setup = Setup {
            uses_driver: self.uses_driver,
            selector: self.selector.clone(),
        };
        // Of other drivers it is not known.
        Process::spawn(command, &setup, is_plain && default.is_some())
    }
}

impl PlainCode {
    /// Whether it applies to a job that renders an image of that many pixels, if it renders one.
    fn applies_to(self, pixels: Option<u64>) -> bool {
        match self {
            Self::Never => false,
            Self::Small => pixels.is_some_and(|pixels| pixels <= MAX_PLAIN_PIXELS),
            Self::Always => true,
        }
    }
}

impl toyproof_player::Driver for Worker {
    type Code = (Lowered, FloatMode);

    fn draw_in_bands(
        &mut self,
        (lowered, float): Self::Code,
        frame: Frame,
        on_band: &mut dyn FnMut(Image),
        checks_loops: &mut dyn FnMut(&DrawOutput, Duration) -> bool,
    ) -> Result<DrawOutput, Failure> {
        if let Some(diagnostic) = lowered.too_deep() {
            return Err(Failure::Invalid(vec![diagnostic.clone()]));
        }
        let draw_job = Box::new(DrawJob {
            lowered,
            frame,
            float,
        });
        let job = Job::Draw(draw_job);
        let start = Instant::now();
        let mut band_time = Duration::ZERO;
        let output = self.run_in_bands(&job, |band| {
            let start = Instant::now();
            on_band(band);
            band_time += start.elapsed();
        });
        let mut drawn = result!(output, Output::Drawn(drawn) => *drawn)?;
        let is_check_wanted = checks_loops(&drawn, start.elapsed().saturating_sub(band_time));
        if let (true, Job::Draw(draw_job)) = (drawn.may_truncate_loops && is_check_wanted, job) {
            // If this fails, the image is still valid.
            drawn.loop_truncated = match self.run(&Job::WatchLoops(draw_job)) {
                Ok(Output::LoopTruncated(pixels)) => Some(pixels),
                _ => None,
            };
        }
        Ok(drawn)
    }

    fn safe_iterations(&self) -> u32 {
        SAFE_ITERATIONS
    }

    fn stop(&mut self) {
        self.stop();
    }

    fn open_player(
        &mut self,
        passes: Vec<Self::Code>,
        sampling: Vec<[Sampling; 4]>,
        graph: Graph,
        media: Vec<Texture>,
        state: Option<State>,
    ) -> Result<String, Failure> {
        self.open_player(PassCode::Lowered(passes), sampling, graph, media, state)
    }

    fn restore_player(&mut self, state: State) -> Result<(), Failure> {
        result!(self.run(&Job::RestorePlayer(Box::new(state))), Output::Completed => ())
    }

    fn play(&mut self, frame: Option<&Frame>, wanted: &[Readback]) -> Result<Vec<Image>, Failure> {
        let mut images = Vec::with_capacity(wanted.len());
        let inputs = frame.map(|frame| {
            Box::new(Frame {
                channels: [const { None }; 4],
                ..frame.clone()
            })
        });
        let job = Job::Play(inputs, wanted.to_vec());
        let output = self.run_in_bands(&job, |image| images.push(image));
        result!(output, Output::Completed => images)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Adds a hint to a missing driver that the user's environment may hide.
fn with_pin_hint(failure: Failure) -> Failure {
    match failure {
        Failure::NoDriver(why) if device::is_pinned_by_user() => Failure::NoDriver(format!(
            "{why}; {} is set and hides all other drivers",
            device::PIN_VARIABLES.join(" or ")
        )),
        failure => failure,
    }
}
