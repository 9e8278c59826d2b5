//! The worker's side: processes jobs until its input ends.

use std::any::Any;
use std::io::{self, Read, Write};
use std::panic::{self, AssertUnwindSafe};
use std::thread;
use std::time::Instant;

use toyproof_image::{Frame, Sampling};
use toyproof_player::{DrawOutput, Player, Readback, State};
use toyproof_translate::backend::{Target, emit, spirv};
use toyproof_translate::naga_ir::{Shape, ValidModule};
use toyproof_translate::{FloatMode, Lowered};

use super::device::{self, Device};
use super::draw::{PreparedFrame, Program};
use super::play::{self, DevicePlayer, PassRenderer};
use super::protocol::{DrawJob, Job, Output, PassCode, PlayJob, Reply, Setup, ShaderArtifact, receive, send};
use super::quirks::loop_probe::{self, Probe};
use super::quirks::{LOOP_CAP, loop_cap, loop_steps};
use super::sandbox::{self, Sandbox};
use super::{AdapterSelector, Failure, Phase, naga_failed, refused};

/// Maximum size of a worker's address space in bytes.
pub const MAX_MEMORY_BYTES: u64 = 6 << 30;
/// Stack size for naga, which is recursive, in bytes.
const TRANSLATOR_STACK_BYTES: usize = 256 << 20;
/// Stack size of the thread that calls the driver, in bytes: the default of a main thread on Linux.
const STACK_BYTES: usize = 8 << 20;

/// Serves jobs until `input` ends. Call it in a separate process that does nothing else, before it starts
/// threads: it limits the process's memory, its access to files and its system calls, ties its lifetime to
/// the parent's, and silences panics.
///
/// # Errors
/// If a reply cannot be written, since the parent is gone.
pub fn serve(mut input: impl Read + Send, output: impl Write + Send) -> io::Result<()> {
    limit_process();
    let Ok(setup) = receive::<Setup>(&mut input) else {
        return Ok(());
    };
    let sandbox = sandbox::enter(setup.uses_driver);
    panic::set_hook(Box::new(|_| {}));
    let mut server = Server {
        output,
        sandbox,
        selector: setup.selector,
        device: None,
        player: None,
    };
    // Drivers compile shaders on this stack, so its size must not depend on the limit that the shell sets.
    thread::scope(|scope| {
        let serving = thread::Builder::new().stack_size(STACK_BYTES);
        let serving = serving.spawn_scoped(scope, move || server.serve(input))?;
        serving
            .join()
            .unwrap_or_else(|_| Err(io::ErrorKind::Other.into()))
    })
}

/// Limits the process's memory and lets it die with its parent.
fn limit_process() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{Resource, Rlimit, Signal, set_parent_process_death_signal, setrlimit};
        let limit = Rlimit {
            current: Some(MAX_MEMORY_BYTES),
            maximum: Some(MAX_MEMORY_BYTES),
        };
        // If the system refuses, a stricter hard limit is in force, or none is available.
        let _ = setrlimit(Resource::As, limit);
        let _ = setrlimit(
            Resource::Core,
            Rlimit {
                current: Some(0),
                maximum: Some(0),
            },
        );
        let _ = set_parent_process_death_signal(Some(Signal::KILL));
    }
}

struct Server<W> {
    output: W,
    sandbox: Sandbox,
    selector: AdapterSelector,
    device: Option<Device>,
    /// The passes that are played, which own the device meanwhile.
    player: Option<DevicePlayer>,
}

impl<W: Write> Server<W> {
    fn serve(&mut self, mut input: impl Read) -> io::Result<()> {
        // The parent closes the input when it is done.
        while let Ok(job) = receive(&mut input) {
            let is_silent = matches!(job, Job::Open);
            let result = self.catch_panics(|server| server.run(job));
            // If it fails to open the device, the next job fails again, and reports why.
            if is_silent {
                continue;
            }
            if matches!(result, Err(Failure::Device(_))) {
                self.device = None;
                self.player = None;
            }
            send(&mut self.output, &Reply::Done(result))?;
        }
        Ok(())
    }

    fn run(&mut self, job: Job) -> Result<Output, Failure> {
        match job {
            Job::Open => self.open().map(|()| Output::Completed),
            Job::Probe => self.probe(),
            Job::Translate(lowered, target, float) => self.translate(lowered, target, float),
            Job::ReadWgsl(text) => self.read(text),
            Job::RewriteArtifact(artifact) => self.rewrite(*artifact),
            Job::Draw(job) => self.draw(*job),
            Job::RenderArtifact(artifact, sampling, frames) => self.render(*artifact, sampling, &frames),
            Job::OpenPlayer(job) => self.open_player(*job),
            Job::RestorePlayer(state) => self.restore_player(&state),
            Job::Play(frame, wanted) => self.play(frame.as_deref(), &wanted),
            Job::WatchLoops(job) => self.watch_loops(*job),
            Job::Sandbox => Ok(Output::Sandbox(self.sandbox.clone())),
        }
    }

    /// Converts panics, of wgpu or our own code, into failures: they affect the job and the device, not the
    /// worker.
    fn catch_panics(
        &mut self,
        job: impl FnOnce(&mut Self) -> Result<Output, Failure>,
    ) -> Result<Output, Failure> {
        panic::catch_unwind(AssertUnwindSafe(|| job(self)))
            .unwrap_or_else(|payload| Err(Failure::Device(panic_message(payload.as_ref()))))
    }

    fn phase(&mut self, phase: Phase) -> Result<(), Failure> {
        send_reply(&mut self.output, &Reply::Phase(phase))
    }

    fn probe(&mut self) -> Result<Output, Failure> {
        self.phase(Phase::Starting)?;
        device::probe(&self.selector).map(Output::Drivers)
    }

    fn translate(&mut self, lowered: Lowered, target: Target, float: FloatMode) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        on_translator_thread(move || {
            let module = ValidModule::parse(&lowered).map_err(refused)?;
            match target {
                Target::Spirv => Ok(Program::new(&module, float)?.bytes()),
                _ => emit(&module, target).map_err(naga_failed),
            }
        })
        .map(Output::Translated)
    }

    fn draw(&mut self, job: DrawJob) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let start = Instant::now();
        let (program, loops) = on_translator_thread(move || {
            let (program, module) = Program::of(&job.lowered, job.float)?;
            Ok((program, loop_probe::has_loops(&module)))
        })?;
        let translate = start.elapsed();
        self.open()?;
        self.phase(Phase::Compiling)?;
        let start = Instant::now();
        let prepared = self.device()?.prepare(&program, &job.frame)?;
        let compile = start.elapsed();
        self.phase(Phase::Drawing)?;
        let start = Instant::now();
        self.render_and_send(&prepared)?;
        let device = self.device()?;
        Ok(Output::Drawn(Box::new(DrawOutput {
            bands: Vec::new(),
            device: device.name(),
            may_truncate_loops: loops && device.has(&LOOP_CAP),
            loop_truncated: Some(0),
            translate,
            compile,
            draw: start.elapsed(),
        })))
    }

    /// Renders a frame and sends its bands.
    fn render_and_send(&mut self, prepared: &PreparedFrame) -> Result<(), Failure> {
        let device = self.device.as_ref().ok_or_else(device_lost)?;
        let output = &mut self.output;
        device.render(prepared, |band| send_reply(&mut *output, &Reply::Band(band)))
    }

    fn read(&mut self, text: String) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        on_translator_thread(move || ValidModule::of_wgsl(&text).map_err(|error| Failure::Reread(error.0)))?;
        Ok(Output::Completed)
    }

    fn rewrite(&mut self, artifact: ShaderArtifact) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let text = on_translator_thread(move || artifact.as_shadertoy())?;
        Ok(Output::Translated(text.into_bytes()))
    }

    fn render(
        &mut self,
        artifact: ShaderArtifact,
        sampling: [Sampling; 4],
        frames: &[Frame],
    ) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let upside_down = artifact.is_upside_down();
        let program = on_translator_thread(move || artifact_program(artifact))?;
        self.open()?;
        let mut images = Vec::new();
        self.phase(Phase::Compiling)?;
        let compiled = self.device()?.compile(&program.with_sampling(sampling))?;
        for frame in frames {
            self.phase(Phase::Compiling)?;
            let prepared = self.device()?.stage(&compiled, frame)?;
            self.phase(Phase::Drawing)?;
            let image = self.device()?.render_image(&prepared)?;
            images.push(if upside_down { image.upside_down() } else { image });
        }
        let name = self.device()?.name();
        Ok(Output::Rendered(images, name))
    }

    fn open_player(&mut self, job: PlayJob) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let programs = on_translator_thread(move || match job.passes {
            PassCode::Lowered(passes) => play::programs(&passes),
            PassCode::Converted(artifacts) => artifacts.into_iter().map(artifact_program).collect(),
        })?;
        self.open()?;
        self.phase(Phase::Compiling)?;
        let device = self.device.take().ok_or_else(device_lost)?;
        match PassRenderer::new(device, &programs, job.sampling, &job.media) {
            Ok(renderer) => {
                let name = renderer.device_name();
                self.player = Some(Player::new(job.graph, renderer));
                if let Some(state) = job.state {
                    self.restore_player(&state)?;
                }
                Ok(Output::Opened(name))
            }
            Err((device, failure)) => {
                self.device = Some(device);
                Err(failure)
            }
        }
    }

    fn restore_player(&mut self, state: &State) -> Result<Output, Failure> {
        let player = self.player.as_mut().ok_or_else(device_lost)?;
        player.restore(state, PassRenderer::load)?;
        Ok(Output::Completed)
    }

    fn play(&mut self, frame: Option<&Frame>, wanted: &[Readback]) -> Result<Output, Failure> {
        self.phase(Phase::Drawing)?;
        let player = self.player.as_mut().ok_or_else(device_lost)?;
        if let Some(frame) = frame {
            player.render(frame)?;
        }
        for &texture in wanted {
            let image = play::read(player, texture)?;
            send_reply(&mut self.output, &Reply::Band(image))?;
        }
        Ok(Output::Completed)
    }

    fn watch_loops(&mut self, job: DrawJob) -> Result<Output, Failure> {
        self.phase(Phase::WatchingLoops)?;
        let sampling = job.lowered.sampling();
        let (module, iterations) = on_translator_thread(move || {
            let module = ValidModule::parse(&job.lowered).map_err(refused)?;
            let iterations = probe_program(&module, Probe::Iterations, job.float)?;
            Ok((module, iterations.with_sampling(sampling)))
        })?;
        self.open()?;
        let device = self.device()?;
        let Some(cap) = device.loop_cap()? else {
            return Ok(Output::LoopTruncated(0));
        };
        // After an endless loop any value is possible, including a small number of iterations.
        if !loop_probe::has_infinite_loop(&module) {
            let (mut reached, mut may_reach) = (0, false);
            device.render(&device.prepare(&iterations, &job.frame)?, |band| {
                reached += loop_cap::count_reached(&band, cap);
                may_reach |= loop_cap::may_reach(&band, cap);
                Ok(())
            })?;
            if reached > 0 || !may_reach {
                return Ok(Output::LoopTruncated(reached));
            }
        }
        let discards = loop_probe::discards(&module);
        let open = on_translator_thread(move || probe_program(&module, Probe::OpenLoops, job.float))?;
        let open = open.with_sampling(sampling);
        let device = self.device()?;
        let mut loop_truncated = 0;
        device.render(&device.prepare(&open, &job.frame)?, |band| {
            loop_truncated += loop_cap::count_truncated(&band, discards);
            Ok(())
        })?;
        Ok(Output::LoopTruncated(loop_truncated))
    }

    fn open(&mut self) -> Result<(), Failure> {
        if let Some(player) = self.player.take() {
            self.device = Some(player.into_renderer().into_device());
        }
        if self.device.is_none() {
            self.phase(Phase::Starting)?;
            let device = Device::open(&self.selector).map_err(|failure| match failure {
                Failure::Device(why) => {
                    Failure::NotStarted(format!("the Vulkan driver failed to start: {why}"))
                }
                failure => failure,
            })?;
            self.device = Some(device);
        }
        Ok(())
    }

    fn device(&mut self) -> Result<&mut Device, Failure> {
        self.device.as_mut().ok_or_else(device_lost)
    }
}

/// The program of a converted shader, with operations in which drivers differ expanded.
fn artifact_program(artifact: ShaderArtifact) -> Result<Program, Failure> {
    let (words, channels) = match artifact {
        ShaderArtifact::Wgsl(hosted) => {
            let module = ValidModule::of_wgsl(&hosted.text).map_err(|error| Failure::Reread(error.0))?;
            words_and_channels(&loop_steps::with_steps_last(&module).map_err(naga_failed)?)?
        }
        ShaderArtifact::Lowered(lowered) => {
            words_and_channels(&ValidModule::parse(&lowered).map_err(refused)?)?
        }
        ShaderArtifact::Words { words, channels, .. } => (words, channels),
    };
    let words = spirv::expanded(&words).map_err(naga_failed)?;
    Ok(Program::from_words(words, channels, FloatMode::Strict))
}

/// The SPIR-V words of a module and the shapes of its textures.
fn words_and_channels(module: &ValidModule) -> Result<(Vec<u32>, [Shape; 4]), Failure> {
    let words = spirv::words(module).map_err(naga_failed)?;
    Ok((words, module.channels()))
}

fn device_lost() -> Failure {
    Failure::Device("the device was lost".to_owned())
}

fn send_reply(output: impl Write, reply: &Reply) -> Result<(), Failure> {
    send(output, reply).map_err(|error| Failure::Worker(error.to_string()))
}

fn probe_program(module: &ValidModule, probe: Probe, float: FloatMode) -> Result<Program, Failure> {
    Program::new(&loop_probe::probed(module, probe).map_err(naga_failed)?, float)
}

/// Runs naga on a thread with a large stack. Panics become failures.
fn on_translator_thread<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> Result<T, Failure> {
    thread::Builder::new()
        .name("naga".to_owned())
        .stack_size(TRANSLATOR_STACK_BYTES)
        .spawn(work)
        .map_err(|error| Failure::Worker(error.to_string()))?
        .join()
        .unwrap_or_else(|payload| {
            Err(Failure::Naga(format!(
                "panic: {}",
                panic_message(payload.as_ref())
            )))
        })
}

fn panic_message(payload: &(dyn Any + Send)) -> String {
    payload
        .downcast_ref::<String>()
        .cloned()
        .or_else(|| payload.downcast_ref::<&str>().map(|&words| words.to_owned()))
        .unwrap_or_else(|| "panic without a message".to_owned())
}
