//! The worker's side: one job after the other until its input ends.

use std::any::Any;
use std::io::{self, Read, Write};
use std::panic::{self, AssertUnwindSafe};
use std::thread;
use std::time::Instant;

use toyproof_image::Frame;
use toyproof_translate::backend::{Target, emit, spirv};
use toyproof_translate::naga_ir::{Probe, Shape, ValidModule};
use toyproof_translate::{FloatMode, Lowered};

use super::device::{self, Device};
use super::draw::{Program, Scene};
use super::protocol::{Foreign, Job, Output, Reply, Shot, Written, receive, send};
use super::{Failure, On, Phase, draw};

/// The most memory that a worker may map, in bytes.
pub const MEMORY_BYTES: u64 = 6 << 30;
/// naga recurses on what is nested; a thread of its own gives it room.
const TRANSLATOR_STACK: usize = 256 << 20;

/// Serves jobs until `input` ends. Call it in a process of its own: it limits the process's memory, ties its
/// life to the parent's and silences panics.
///
/// # Errors
/// If a reply cannot be written: the parent is gone.
pub fn serve(input: impl Read, output: impl Write) -> io::Result<()> {
    confine();
    panic::set_hook(Box::new(|_| {}));
    Server { output, device: None }.serve(input)
}

/// Dies with its parent, and by its own hand before it takes the machine's memory.
fn confine() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{Resource, Rlimit, Signal, set_parent_process_death_signal, setrlimit};
        let limit = Rlimit {
            current: Some(MEMORY_BYTES),
            maximum: Some(MEMORY_BYTES),
        };
        // Where the system refuses, a hard limit is in force that is stricter still, or there is none to be had.
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
    device: Option<(On, Device)>,
}

impl<W: Write> Server<W> {
    fn serve(&mut self, mut input: impl Read) -> io::Result<()> {
        // The input's end is how the parent says good-bye.
        while let Ok(job) = receive(&mut input) {
            let result = match job {
                Job::Probe(on) => self.guarded(|server| server.probe(&on)),
                Job::Translate(lowered, target, float) => {
                    self.guarded(|server| server.translate(lowered, target, float))
                }
                Job::Read(text) => self.guarded(|server| server.read(text)),
                Job::Draw(shot) => self.guarded(|server| server.draw(*shot)),
                Job::Run(foreign) => self.guarded(|server| server.run(*foreign)),
                Job::Paint(written, frames, on) => {
                    self.guarded(|server| server.paint(*written, &frames, &on))
                }
                Job::WatchLoops(shot) => self.guarded(|server| server.watch_loops(*shot)),
            };
            if matches!(result, Err(Failure::Device(_))) {
                self.device = None;
            }
            send(&mut self.output, &Reply::Done(result))?;
        }
        Ok(())
    }

    /// Panics below are wgpu's or ours: they cost the job and the device, not the worker.
    fn guarded(&mut self, job: impl FnOnce(&mut Self) -> Result<Output, Failure>) -> Result<Output, Failure> {
        panic::catch_unwind(AssertUnwindSafe(|| job(self)))
            .unwrap_or_else(|payload| Err(Failure::Device(words_of(payload.as_ref()))))
    }

    fn phase(&mut self, phase: Phase) -> Result<(), Failure> {
        say(&mut self.output, &Reply::Phase(phase))
    }

    fn probe(&mut self, on: &On) -> Result<Output, Failure> {
        self.phase(Phase::Starting)?;
        device::probe(on).map(Output::Drivers)
    }

    fn translate(&mut self, lowered: Lowered, target: Target, float: FloatMode) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        apart(move || {
            let module = ValidModule::parse(&lowered).map_err(Failure::Refused)?;
            match target {
                Target::Spirv => Ok(Program::new(&module, float)?.bytes()),
                _ => emit(&module, target).map_err(Failure::Naga),
            }
        })
        .map(Output::Translated)
    }

    fn draw(&mut self, shot: Shot) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let start = Instant::now();
        let Shot {
            lowered,
            frame,
            float,
            on,
        } = shot;
        let (program, loops) = apart(move || {
            let module = ValidModule::parse(&lowered).map_err(Failure::Refused)?;
            Ok((Program::new(&module, float)?, module.has_loops()))
        })?;
        let translate = start.elapsed();
        self.open(&on)?;
        self.phase(Phase::Compiling)?;
        let start = Instant::now();
        let scene = self.device()?.prepare(&program, &frame)?;
        let compile = start.elapsed();
        self.phase(Phase::Drawing)?;
        let start = Instant::now();
        self.send_painted(&scene)?;
        let device = self.device()?;
        Ok(Output::Drawn(Box::new(draw::Drawn {
            bands: Vec::new(),
            device: device.name(),
            may_be_cut_short: loops && device.may_end_loops(),
            cut_short: Some(0),
            translate,
            compile,
            draw: start.elapsed(),
        })))
    }

    fn run(&mut self, foreign: Foreign) -> Result<Output, Failure> {
        let Foreign {
            words,
            frame,
            float,
            on,
        } = foreign;
        self.open(&on)?;
        self.phase(Phase::Compiling)?;
        let program = Program::foreign(words, [Shape::D2; 4], float);
        let scene = self.device()?.prepare(&program, &frame)?;
        self.phase(Phase::Drawing)?;
        self.send_painted(&scene)?;
        Ok(Output::Ran)
    }

    /// Paints, and sends what comes.
    fn send_painted(&mut self, scene: &Scene) -> Result<(), Failure> {
        let Some((_, device)) = &self.device else {
            return Err(gone());
        };
        let output = &mut self.output;
        device.paint(scene, |band| say(&mut *output, &Reply::Band(band)))
    }

    fn read(&mut self, text: String) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        apart(move || ValidModule::of_wgsl(&text).map_err(Failure::Reread))?;
        Ok(Output::Ran)
    }

    fn paint(&mut self, written: Written, frames: &[Frame], on: &On) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let upside_down = matches!(&written, Written::Wgsl(hosted) if hosted.upside_down);
        let program = apart(move || {
            let module = match written {
                Written::Wgsl(hosted) => {
                    let module = ValidModule::of_wgsl(&hosted.text).map_err(Failure::Reread)?;
                    module.with_steps_last().map_err(Failure::Naga)?
                }
                Written::Lowered(lowered) => ValidModule::parse(&lowered).map_err(Failure::Refused)?,
                Written::Words(words, channels) => {
                    let words = spirv::spelled(&words).map_err(Failure::Naga)?;
                    return Ok(Program::foreign(words, channels, FloatMode::Strict));
                }
            };
            Program::new(&module.spelled().map_err(Failure::Naga)?, FloatMode::Strict)
        })?;
        self.open(on)?;
        let mut painted = Vec::new();
        self.phase(Phase::Compiling)?;
        let compiled = self.device()?.compile(&program)?;
        for frame in frames {
            self.phase(Phase::Compiling)?;
            let scene = self.device()?.stage(&compiled, frame)?;
            self.phase(Phase::Drawing)?;
            let image = self.device()?.picture(&scene)?;
            painted.push(if upside_down { image.upside_down() } else { image });
        }
        let name = self.device()?.name();
        Ok(Output::Painted(painted, name))
    }

    fn watch_loops(&mut self, shot: Shot) -> Result<Output, Failure> {
        self.phase(Phase::WatchingLoops)?;
        let Shot {
            lowered,
            frame,
            float,
            on,
        } = shot;
        let (module, iterations) = apart(move || {
            let module = ValidModule::parse(&lowered).map_err(Failure::Refused)?;
            let iterations = probed(&module, Probe::Iterations, float)?;
            Ok((module, iterations))
        })?;
        self.open(&on)?;
        let device = self.device()?;
        let Some(cap) = device.loop_cap()? else {
            return Ok(Output::CutShort(0));
        };
        // What follows an endless loop may say anything, also that there were few iterations.
        if !module.has_endless_loop() {
            let (mut reached, mut may_reach) = (0, false);
            device.paint(&device.prepare(&iterations, &frame)?, |band| {
                reached += draw::reached(&band, cap);
                may_reach |= draw::may_reach(&band, cap);
                Ok(())
            })?;
            if reached > 0 || !may_reach {
                return Ok(Output::CutShort(reached));
            }
        }
        let discards = module.discards();
        let open = apart(move || probed(&module, Probe::OpenLoops, float))?;
        let device = self.device()?;
        let mut cut_short = 0;
        device.paint(&device.prepare(&open, &frame)?, |band| {
            cut_short += draw::cut_short(&band, discards);
            Ok(())
        })?;
        Ok(Output::CutShort(cut_short))
    }

    fn open(&mut self, on: &On) -> Result<(), Failure> {
        if self.device.as_ref().is_none_or(|(open, _)| open != on) {
            self.phase(Phase::Starting)?;
            let device = Device::open(on).map_err(|failure| match failure {
                Failure::Device(why) => {
                    Failure::NotStarted(format!("the Vulkan driver does not start: {why}"))
                }
                failure => failure,
            })?;
            self.device = Some((on.clone(), device));
        }
        Ok(())
    }

    fn device(&mut self) -> Result<&mut Device, Failure> {
        match &mut self.device {
            Some((_, device)) => Ok(device),
            None => Err(gone()),
        }
    }
}

fn gone() -> Failure {
    Failure::Device("the device is gone".to_owned())
}

fn say(output: impl Write, reply: &Reply) -> Result<(), Failure> {
    send(output, reply).map_err(|error| Failure::Worker(error.to_string()))
}

fn probed(module: &ValidModule, probe: Probe, float: FloatMode) -> Result<Program, Failure> {
    Program::new(&module.probed(probe).map_err(Failure::Naga)?, float)
}

/// Runs naga on a thread with room for its recursion; its panics become failures.
fn apart<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> Result<T, Failure> {
    thread::Builder::new()
        .name("naga".to_owned())
        .stack_size(TRANSLATOR_STACK)
        .spawn(work)
        .map_err(|error| Failure::Worker(error.to_string()))?
        .join()
        .unwrap_or_else(|payload| {
            Err(Failure::Naga(format!(
                "it panicked: {}",
                words_of(payload.as_ref())
            )))
        })
}

fn words_of(payload: &(dyn Any + Send)) -> String {
    payload
        .downcast_ref::<String>()
        .cloned()
        .or_else(|| payload.downcast_ref::<&str>().map(|&words| words.to_owned()))
        .unwrap_or_else(|| "a panic without words".to_owned())
}
