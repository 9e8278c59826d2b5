//! The worker's side: one job after the other until its input ends.

use std::any::Any;
use std::io::{self, Read, Write};
use std::panic::{self, AssertUnwindSafe};
use std::thread;
use std::time::Instant;

use super::device::{self, Device};
use super::protocol::{Job, Output, Reply, receive, send};
use super::{Failure, FloatMode, On, Phase, draw};
use crate::emit::{self, Target};
use crate::frame::Frame;
use crate::glsl::Lowered;
use crate::module::ValidModule;

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
        let limit = Rlimit { current: Some(MEMORY_BYTES), maximum: Some(MEMORY_BYTES) };
        // Where the system refuses, a hard limit is in force that is stricter still, or there is none to be had.
        let _ = setrlimit(Resource::As, limit);
        let _ = setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) });
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
                Job::Draw(job) => {
                    let (lowered, frame, float, on) = *job;
                    self.guarded(|server| server.draw(lowered, &frame, float, &on))
                }
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
        send(&mut self.output, &Reply::Phase(phase)).map_err(|error| Failure::Worker(error.to_string()))
    }

    fn probe(&mut self, on: &On) -> Result<Output, Failure> {
        self.phase(Phase::Starting)?;
        device::probe(on).map(Output::Drivers)
    }

    fn translate(&mut self, lowered: Lowered, target: Target, float: FloatMode) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        apart(move || {
            let module = ValidModule::parse(&lowered).map_err(Failure::Invalid)?;
            if (target, float) == (Target::Spirv, FloatMode::Strict) {
                let words = emit::spirv::words(&module).map_err(Failure::Naga)?;
                return Ok(emit::spirv::bytes(&emit::spirv::strict(&words)));
            }
            emit::emit(&module, target).map_err(Failure::Naga)
        })
        .map(Output::Translated)
    }

    fn draw(&mut self, lowered: Lowered, frame: &Frame, float: FloatMode, on: &On) -> Result<Output, Failure> {
        self.phase(Phase::Translating)?;
        let start = Instant::now();
        let shader = apart(move || Translated::new(&lowered, float))?;
        let translate = start.elapsed();
        if self.device.as_ref().is_none_or(|(open, _)| open != on) {
            self.phase(Phase::Starting)?;
            self.device = Some((on.clone(), Device::open(on)?));
        }
        self.phase(Phase::Compiling)?;
        let start = Instant::now();
        let scene = self.device()?.prepare(&shader.words, frame)?;
        let compile = start.elapsed();
        self.phase(Phase::Drawing)?;
        let start = Instant::now();
        let image = self.device()?.paint(&scene)?;
        let drawing = start.elapsed();
        let mut cut_short = 0;
        if let Some(watched) = shader.watched
            && self.device()?.loop_cap()?.is_some()
        {
            self.phase(Phase::WatchingLoops)?;
            let device = self.device()?;
            let scene = device.prepare(&watched, frame)?;
            cut_short = draw::cut_short(&device.paint(&scene)?, shader.discards);
        }
        let device = self.device()?;
        Ok(Output::Drawn(Box::new(draw::Drawn {
            image,
            device: device.name(),
            cut_short,
            translate,
            compile,
            draw: drawing,
        })))
    }

    fn device(&mut self) -> Result<&mut Device, Failure> {
        match &mut self.device {
            Some((_, device)) => Ok(device),
            None => Err(Failure::Device("the device is gone".to_owned())),
        }
    }
}

/// A shader's words, and those of the same shader with its loops watched if it has any.
struct Translated {
    words: Vec<u32>,
    watched: Option<Vec<u32>>,
    discards: bool,
}

impl Translated {
    fn new(lowered: &Lowered, float: FloatMode) -> Result<Self, Failure> {
        let module = ValidModule::parse(lowered).map_err(Failure::Invalid)?;
        let words = |module: &ValidModule| {
            let words = emit::spirv::words(module).map_err(Failure::Naga)?;
            Ok(match float {
                FloatMode::Strict => emit::spirv::strict(&words),
                FloatMode::Fast => words,
            })
        };
        let watched = if module.has_loops() {
            Some(words(&module.with_loops_watched().map_err(Failure::Naga)?)?)
        } else {
            None
        };
        Ok(Self { words: words(&module)?, watched, discards: module.discards() })
    }
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
        .unwrap_or_else(|payload| Err(Failure::Naga(format!("it panicked: {}", words_of(payload.as_ref())))))
}

fn words_of(payload: &(dyn Any + Send)) -> String {
    payload
        .downcast_ref::<String>()
        .cloned()
        .or_else(|| payload.downcast_ref::<&str>().map(|&words| words.to_owned()))
        .unwrap_or_else(|| "a panic without words".to_owned())
}
