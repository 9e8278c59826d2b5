//! The worker's side: processes jobs until its input ends.

use std::any::Any;
use std::io::{self, Read, Write};
use std::panic::{self, AssertUnwindSafe};
use std::thread;
use std::time::Instant;

use toyproof_image::Frame;
use toyproof_player::{DrawOutput, Player, Readback, State};
use toyproof_translate::backend::{Target, emit, spirv};
use toyproof_translate::naga_ir::{Shape, ValidModule};
use toyproof_translate::{FloatMode, Lowered};

use super::device::{self, Device};
use super::draw::{PreparedFrame, Program};
use super::play::{self, DevicePlayer, PassRenderer};
use super::protocol::{
    DrawJob, ForeignSpirv, Job, Output, PlayJob, PlayedPasses, Reply, Setup, ShaderArtifact, receive, send,
};
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
    device: Option<(AdapterSelector, Device)>,
    /// The passes that are played, which own the device meanwhile.
    player: Option<(AdapterSelector, DevicePlayer)>,
}

impl<W: Write> Server<W> {
    fn serve(&mut self, mut input: impl Read) -> io::Result<()> {
        // The parent closes the input when it is done.
        while let Ok(job) = receive(&mut input) {
            let result = match job {
                Job::Open(selector) => {
                    // If it fails, the next job fails again, and reports why.
                    let _ = self.catch_panics(|server| server.open(&selector).map(|()| Output::Completed));
                    continue;
                }
                Job::Probe(selector) => self.catch_panics(|server| server.probe(&selector)),
                Job::Translate(lowered, target, float) => {
                    self.catch_panics(|server| server.translate(lowered, target, float))
                }
                Job::ReadWgsl(text) => self.catch_panics(|server| server.read(text)),
                Job::Draw(draw_job) => self.catch_panics(|server| server.draw(*draw_job)),
                Job::RunSpirv(foreign) => self.catch_panics(|server| server.run(*foreign)),
                Job::RenderArtifact(artifact, frames, selector) => {
                    self.catch_panics(|server| server.render(*artifact, &frames, &selector))
                }
                Job::OpenPlayer(play_job) => self.catch_panics(|server| server.open_player(*play_job)),
                Job::RestorePlayer(state) => self.catch_panics(|server| server.restore_player(&state)),
                Job::Play(frame, wanted) => {
                    self.catch_panics(|server| server.play(frame.as_deref(), &wanted))
                }
                Job::WatchLoops(draw_job) => self.catch_panics(|server| server.watch_loops(*draw_job)),
                Job::Sandbox => Ok(Output::Sandbox(self.sandbox.clone())),
            };
            if matches!(result, Err(Failure::Device(_))) {
                self.device = None;
                self.player = None;
            }
            send(&mut self.output, &Reply::Done(result))?;
        }
        Ok(())
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

    fn probe(&mut self, selector: &AdapterSelector) -> Result<Output, Failure> {
        self.phase(Phase::Starting)?;
        device::probe(selector).map(Output::Drivers)
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

    fn draw(&mut self, draw_job: DrawJob) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let start = Instant::now();
        let DrawJob {
            lowered,
            frame,
            float,
            selector,
        } = draw_job;
        let (program, loops) = on_translator_thread(move || {
            let module = ValidModule::parse(&lowered).map_err(refused)?;
            Ok((Program::new(&module, float)?, loop_probe::has_loops(&module)))
        })?;
        let translate = start.elapsed();
        self.open(&selector)?;
        self.phase(Phase::Compiling)?;
        let start = Instant::now();
        let prepared = self.device()?.prepare(&program, &frame)?;
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

    fn run(&mut self, foreign: ForeignSpirv) -> Result<Output, Failure> {
        let ForeignSpirv {
            words,
            frame,
            float,
            selector,
        } = foreign;
        self.open(&selector)?;
        self.phase(Phase::Compiling)?;
        let program = Program::from_words(words, [Shape::D2; 4], float);
        let prepared = self.device()?.prepare(&program, &frame)?;
        self.phase(Phase::Drawing)?;
        self.render_and_send(&prepared)?;
        Ok(Output::Completed)
    }

    /// Renders a frame and sends its bands.
    fn render_and_send(&mut self, prepared: &PreparedFrame) -> Result<(), Failure> {
        let Some((_, device)) = &self.device else {
            return Err(device_lost());
        };
        let output = &mut self.output;
        device.render(prepared, |band| send_reply(&mut *output, &Reply::Band(band)))
    }

    fn read(&mut self, text: String) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        on_translator_thread(move || ValidModule::of_wgsl(&text).map_err(|error| Failure::Reread(error.0)))?;
        Ok(Output::Completed)
    }

    fn render(
        &mut self,
        artifact: ShaderArtifact,
        frames: &[Frame],
        selector: &AdapterSelector,
    ) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let upside_down = artifact.is_upside_down();
        let program = on_translator_thread(move || artifact_program(artifact))?;
        self.open(selector)?;
        let mut images = Vec::new();
        self.phase(Phase::Compiling)?;
        let compiled = self.device()?.compile(&program)?;
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

    fn open_player(&mut self, play_job: PlayJob) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let PlayJob {
            passes,
            graph,
            media,
            state,
            sampling,
            selector,
        } = play_job;
        let programs = on_translator_thread(move || match passes {
            PlayedPasses::Lowered(passes) => play::programs(&passes),
            PlayedPasses::Converted(artifacts) => artifacts.into_iter().map(artifact_program).collect(),
        })?;
        self.open(&selector)?;
        self.phase(Phase::Compiling)?;
        let (selector, device) = self.device.take().ok_or_else(device_lost)?;
        match PassRenderer::new(device, &programs, sampling, &media) {
            Ok(renderer) => {
                let name = renderer.device_name();
                self.player = Some((selector, Player::new(graph, renderer)));
                if let Some(state) = state {
                    self.restore_player(&state)?;
                }
                Ok(Output::Opened(name))
            }
            Err((device, failure)) => {
                self.device = Some((selector, device));
                Err(failure)
            }
        }
    }

    fn restore_player(&mut self, state: &State) -> Result<Output, Failure> {
        let Some((_, player)) = &mut self.player else {
            return Err(device_lost());
        };
        player.restore(state, PassRenderer::load)?;
        Ok(Output::Completed)
    }

    fn play(&mut self, frame: Option<&Frame>, wanted: &[Readback]) -> Result<Output, Failure> {
        self.phase(Phase::Drawing)?;
        let Some((_, player)) = &mut self.player else {
            return Err(device_lost());
        };
        if let Some(frame) = frame {
            player.render(frame)?;
        }
        for &texture in wanted {
            let image = play::read(player, texture)?;
            send_reply(&mut self.output, &Reply::Band(image))?;
        }
        Ok(Output::Completed)
    }

    fn watch_loops(&mut self, draw_job: DrawJob) -> Result<Output, Failure> {
        self.phase(Phase::WatchingLoops)?;
        let DrawJob {
            lowered,
            frame,
            float,
            selector,
        } = draw_job;
        let (module, iterations) = on_translator_thread(move || {
            let module = ValidModule::parse(&lowered).map_err(refused)?;
            let iterations = probe_program(&module, Probe::Iterations, float)?;
            Ok((module, iterations))
        })?;
        self.open(&selector)?;
        let device = self.device()?;
        let Some(cap) = device.loop_cap()? else {
            return Ok(Output::LoopTruncated(0));
        };
        // After an endless loop any value is possible, including a small number of iterations.
        if !loop_probe::has_infinite_loop(&module) {
            let (mut reached, mut may_reach) = (0, false);
            device.render(&device.prepare(&iterations, &frame)?, |band| {
                reached += loop_cap::count_reached(&band, cap);
                may_reach |= loop_cap::may_reach(&band, cap);
                Ok(())
            })?;
            if reached > 0 || !may_reach {
                return Ok(Output::LoopTruncated(reached));
            }
        }
        let discards = loop_probe::discards(&module);
        let open = on_translator_thread(move || probe_program(&module, Probe::OpenLoops, float))?;
        let device = self.device()?;
        let mut loop_truncated = 0;
        device.render(&device.prepare(&open, &frame)?, |band| {
            loop_truncated += loop_cap::count_truncated(&band, discards);
            Ok(())
        })?;
        Ok(Output::LoopTruncated(loop_truncated))
    }

    fn open(&mut self, selector: &AdapterSelector) -> Result<(), Failure> {
        if let Some((selector, player)) = self.player.take() {
            self.device = Some((selector, player.into_renderer().into_device()));
        }
        if self.device.as_ref().is_none_or(|(open, _)| open != selector) {
            self.phase(Phase::Starting)?;
            let device = Device::open(selector).map_err(|failure| match failure {
                Failure::Device(why) => {
                    Failure::NotStarted(format!("the Vulkan driver failed to start: {why}"))
                }
                failure => failure,
            })?;
            self.device = Some((selector.clone(), device));
        }
        Ok(())
    }

    fn device(&mut self) -> Result<&mut Device, Failure> {
        match &mut self.device {
            Some((_, device)) => Ok(device),
            None => Err(device_lost()),
        }
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
        ShaderArtifact::Words(words, channels) => (words, channels),
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
