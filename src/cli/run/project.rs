//! `toyproof run` of a project: its passes over frames, from the first one or from a saved state.

use std::hash::{DefaultHasher, Hash};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::path_name;
use toyproof_eval::{self as eval, PassFailure};
use toyproof_glsl::{self as glsl, Filter};
use toyproof_gpu::{Failure, Worker};
use toyproof_image::{Image, Texture, input, output};
use toyproof_player::{Clock, Graph, State, Target};
use toyproof_project::{PassKind, Rendering, Tab};
use toyproof_verify::playback::{CpuPlayback, DevicePlayback, PassShader, PlaybackFailure};

use super::{Precision, Rendered, Runner, not_evaluated};
use crate::cli::passes::target;
use crate::cli::project::Passes;
use crate::cli::sequence::{Frames, Sequence};
use crate::cli::shader::Shader;
use crate::cli::{Exit, Terminal};

/// Parses the name of a pass whose texture can be shown: `image`, or `buffer-a` to `buffer-d`.
pub(in crate::cli) fn parse_pass(text: &str) -> Result<PassKind, String> {
    let shown = Tab::ALL.into_iter().filter_map(|tab| match tab {
        Tab::Pass(kind @ (PassKind::Image | PassKind::Buffer(_))) => Some((tab.name(), kind)),
        _ => None,
    });
    let shown: Vec<_> = shown.collect();
    let found = shown.iter().find(|(name, _)| name.eq_ignore_ascii_case(text));
    found.map(|(_, kind)| *kind).ok_or_else(|| {
        let names: Vec<_> = shown.iter().map(|(name, _)| *name).collect();
        format!("expected one of {}", names.join(", "))
    })
}

/// Reports the inputs whose media are replaced or black.
fn report_replaced(rendering: &Rendering, name: &str, terminal: &Terminal) {
    for replaced in &rendering.replaced {
        let medium = replaced.source.medium();
        let source = medium.map_or_else(
            || format!("a {}", replaced.source.source_type().name()),
            |medium| format!("“{}”", medium.name),
        );
        terminal.warn(if replaced.has_stand_in {
            format!("{name}: {source} of ShaderToy is replaced by a texture with similar values")
        } else {
            format!("{name}: {source} of ShaderToy is not available, so that its channel is black")
        });
    }
}

/// Frames in progress.
enum Playback<'a> {
    Device(DevicePlayback<'a>),
    Single(CpuPlayback<'a, f32>),
    Double(CpuPlayback<'a, f64>),
}

/// Why a frame was not rendered.
enum Stopped {
    /// The driver failed.
    Device(Failure),
    /// The evaluator failed.
    Evaluator(PassFailure),
}

impl Playback<'_> {
    /// Renders a frame, and returns what a pass rendered.
    fn render(
        &mut self,
        clock: &Clock,
        number: i32,
        wanted: Option<Target>,
    ) -> Result<Option<Image>, Stopped> {
        let frame = clock.frame(number);
        let shown = |texture: Option<&Texture>| Some((*texture?.to_single()[0]).clone());
        match self {
            Self::Device(playback) => {
                let wanted = wanted.as_slice();
                let mut images = playback.render(&frame, wanted).map_err(Stopped::Device)?;
                Ok(images.pop())
            }
            Self::Single(playback) => {
                playback.render(&frame).map_err(Stopped::Evaluator)?;
                Ok(shown(wanted.and_then(|target| playback.texture(target))))
            }
            Self::Double(playback) => {
                playback.render(&frame).map_err(Stopped::Evaluator)?;
                Ok(shown(wanted.and_then(|target| playback.texture(target))))
            }
        }
    }

    /// The state after a frame, which was rendered last.
    fn state(&mut self, clock: &Clock, number: i32) -> Result<State, Stopped> {
        match self {
            Self::Device(playback) => playback.state(&clock.frame(number)).map_err(Stopped::Device),
            Self::Single(playback) => Ok(playback.state(number)),
            Self::Double(playback) => Ok(playback.state(number)),
        }
    }

    /// What renders: a driver, or the CPU.
    fn device(&self) -> String {
        match self {
            Self::Device(playback) => playback.device().to_owned(),
            Self::Single(_) | Self::Double(_) => "CPU".to_owned(),
        }
    }
}

/// A state in its file.
#[derive(Debug, Serialize, Deserialize)]
struct SavedState {
    /// Identifies the format.
    format: String,
    graph: Graph,
    state: State,
}

const STATE_FORMAT: &str = "toyproof state 1";

/// Reads a state; none if there is no such file.
///
/// # Errors
/// Why it cannot be used.
fn read_state(path: &Path, graph: &Graph, size: [u32; 2]) -> Result<Option<State>, String> {
    let name = path_name(path);
    let bytes = match input::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(format!("cannot read {name}: {error}")),
    };
    let saved: SavedState = postcard::from_bytes(&bytes)
        .map_err(|_| format!("{name} is not a state of `toyproof run --state`"))?;
    if saved.format != STATE_FORMAT {
        return Err(format!("{name} was written by another version of toyproof"));
    }
    if saved.graph != *graph {
        return Err(format!(
            "{name} is the state of a project with other passes or inputs"
        ));
    }
    if !saved.state.fits(graph) {
        return Err(format!("{name} is damaged"));
    }
    if saved.state.size != size {
        let [width, height] = saved.state.size;
        return Err(format!(
            "{name} is the state of frames of {width}×{height} pixels"
        ));
    }
    Ok(Some(saved.state))
}

/// Writes a state as a whole.
///
/// # Errors
/// Why it cannot be written.
fn write_state(path: &Path, graph: &Graph, state: State) -> Result<(), String> {
    let saved = SavedState {
        format: STATE_FORMAT.to_owned(),
        graph: graph.clone(),
        state,
    };
    let bytes = postcard::to_stdvec(&saved).map_err(|error| error.to_string())?;
    output::write(path, &bytes).map_err(|error| format!("cannot write {error}"))
}

/// The frames of a project in progress.
struct Run<'a> {
    playback: Playback<'a>,
    clock: Clock,
    target: Target,
    /// The next frame to render.
    next: i32,
    terminal: &'a Terminal,
}

/// The frames to render.
struct Schedule {
    /// The frame to show, unless a sequence is.
    number: i32,
    /// The next frame to render.
    next: i32,
    clock: Clock,
    /// The state before that frame.
    state: Option<State>,
}

/// Why there is no image.
enum Unshown {
    Stopped(Stopped),
    /// The user interrupted the run before this frame.
    Interrupted(i32),
}

impl Run<'_> {
    /// Renders the frames up to this one, and returns what the shown pass renders in it.
    fn show(&mut self, number: i32, interrupted: &AtomicBool) -> Result<Rendered, Unshown> {
        let start = Instant::now();
        let bar = self
            .terminal
            .bar((number - self.next).max(0) as u64 + 1, "frames");
        while self.next < number {
            if interrupted.load(Ordering::Relaxed) {
                return Err(Unshown::Interrupted(self.next));
            }
            self.playback
                .render(&self.clock, self.next, None)
                .map_err(Unshown::Stopped)?;
            self.next += 1;
            bar.inc(1);
        }
        let image = self.playback.render(&self.clock, number, Some(self.target));
        let image = image.map_err(Unshown::Stopped)?;
        self.next = number + 1;
        bar.finish_and_clear();
        Ok(Rendered {
            image: image.expect("the shown pass is rendered"),
            device: self.playback.device(),
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}

impl Runner<'_> {
    /// Renders a project: one frame, or each of a sequence into its file.
    pub(super) fn project(&mut self, shader: &Shader, passes: &Passes, path: &Path) -> Exit {
        // The worker is used beside this runner, which writes the images. The next shader has the same frame.
        let (mut worker, frame) = (self.worker.take(), self.frame.clone());
        let exit = self.render_project(&mut worker, shader, passes, path);
        (self.worker, self.frame) = (worker, frame);
        exit.unwrap_or_else(|exit| exit)
    }

    fn render_project(
        &mut self,
        worker: &mut Option<Worker>,
        shader: &Shader,
        passes: &Passes,
        path: &Path,
    ) -> Result<Exit, Exit> {
        let kind = self.args.pass.unwrap_or(PassKind::Image);
        let rendering = self.rendering(shader, passes, kind)?;
        let scheduled = PassShader {
            checked: passes.checked_of(&rendering).collect(),
            graph: &rendering.graph,
            media: &rendering.media,
        };
        let schedule = self.schedule(shader, &rendering.graph)?;
        let state = schedule.state.as_ref();
        let timeout = self.args.driver.timeout();
        let opened = match worker {
            Some(worker) => self.open(worker, &scheduled, state, shader)?,
            None => None,
        };
        let falls_back = opened.is_none();
        let programs;
        let playback = if let Some(playback) = opened {
            Playback::Device(playback)
        } else {
            programs = scheduled.programs(timeout).map_err(|(_, refusal)| {
                not_evaluated(&eval::Failure::Refused(refusal), shader, self.terminal)
            })?;
            match self.args.precision {
                Precision::F32 => {
                    Playback::Single(CpuPlayback::new(&scheduled, &programs, state, timeout, None))
                }
                Precision::F64 => {
                    Playback::Double(CpuPlayback::new(&scheduled, &programs, state, timeout, None))
                }
            }
        };
        let mut run = Run {
            playback,
            clock: schedule.clock,
            target: target(kind),
            next: schedule.next,
            terminal: self.terminal,
        };
        let exit = match self.args.frames {
            None => self.one_frame(&mut run, schedule.number, shader, path),
            Some(frames) => self.all_frames(&mut run, frames, shader, passes, path),
        };
        let saved = self.save_state(&mut run, schedule.next, &rendering);
        drop(run);
        if falls_back {
            *worker = None;
        }
        Ok(exit.max(saved))
    }

    /// What renders a pass, with the textures that the user binds to the channels of the image.
    fn rendering(&self, shader: &Shader, passes: &Passes, kind: PassKind) -> Result<Rendering, Exit> {
        if passes.project.pass(kind).is_none() {
            let error = format!("there is no {kind}");
            return Err(self.refuse(shader, &error, "name one of its passes with --pass"));
        }
        let rendering = passes.rendering(kind);
        let mut rendering = rendering
            .map_err(|error| self.refuse(shader, &error, "`toyproof check` compiles all its tabs"))?;
        report_replaced(&rendering, &shader.name, self.terminal);
        for (channel, texture) in self.frame.channels.iter().enumerate() {
            if let Some(texture) = texture {
                let has_mipmaps = passes.image().sampling[channel].filter == Filter::Mipmap;
                let texture = texture.clone();
                rendering.graph.bind_to_image(channel, rendering.media.len());
                rendering.media.push(if has_mipmaps {
                    texture.with_mipmaps()
                } else {
                    texture
                });
            }
        }
        Ok(rendering)
    }

    /// The frames to render, and the state to start from.
    fn schedule(&self, shader: &Shader, graph: &Graph) -> Result<Schedule, Exit> {
        // A frame depends on earlier ones if there is a pass besides the image.
        let has_history = graph.passes().len() > 1;
        let arguments = &self.args.frame;
        let number = arguments.number(has_history, self.args.fps);
        let clock = Clock {
            inputs: self.frame.clone(),
            rate: self.args.fps,
            start: match self.args.frames {
                Some(_) => 0.0,
                None => arguments.start(number, self.args.fps),
            },
        };
        let refuse = |error: &str| self.refuse(shader, &error, "name another file with --state");
        let state = match &self.args.state {
            None => None,
            Some(file) => read_state(file, graph, clock.inputs.size).map_err(|error| refuse(&error))?,
        };
        let first = self.args.frames.map_or(number, Frames::first);
        let next = match &state {
            Some(state) if state.frame >= first => {
                let last = state.frame;
                return Err(refuse(&format!(
                    "the state is that of frame {last}, and frame {first} is earlier"
                )));
            }
            Some(state) => state.frame + 1,
            None if has_history => self.args.warm_up.map_or(0, |frames| {
                first
                    .saturating_sub(i32::try_from(frames).unwrap_or(i32::MAX))
                    .max(0)
            }),
            None => first,
        };
        Ok(Schedule {
            number,
            next,
            clock,
            state,
        })
    }

    /// Prints why a project is not rendered.
    fn refuse(&self, shader: &Shader, error: &dyn std::fmt::Display, help: &str) -> Exit {
        self.terminal.error(format_args!("{}: {error}", shader.name));
        self.terminal.help(help);
        Exit::Error
    }

    /// Compiles the passes for the driver; none if there is no driver and the evaluator takes its place.
    fn open<'w>(
        &self,
        worker: &'w mut Worker,
        shader: &PassShader<'_>,
        state: Option<&State>,
        named: &Shader,
    ) -> Result<Option<DevicePlayback<'w>>, Exit> {
        let driver = &self.args.driver;
        match DevicePlayback::open(worker, shader, state, driver.float(), driver.timeout()) {
            Ok(playback) => Ok(Some(playback)),
            Err(PlaybackFailure::Gpu(failure)) if failure.is_without_driver() && driver.may_fall_back() => {
                self.terminal
                    .warn(format_args!("{failure}; shaders are evaluated on the CPU"));
                Ok(None)
            }
            Err(PlaybackFailure::Gpu(failure)) => Err(self.draw_failed(failure, named)),
            Err(PlaybackFailure::Overdue(overdue)) => {
                self.terminal.diagnostics(&[glsl::overdue(overdue)], &named.files);
                Err(Exit::ShaderFault)
            }
        }
    }

    fn one_frame(&mut self, run: &mut Run<'_>, number: i32, shader: &Shader, path: &Path) -> Exit {
        let interrupted = self
            .terminal
            .watch_interrupts("the frame in progress is finished first");
        match run.show(number, &interrupted) {
            Ok(rendered) => {
                self.frame = run.clock.frame(number);
                self.write(&rendered, &shader.name, path, true)
            }
            Err(unshown) => self.unshown(unshown, number, shader),
        }
    }

    fn all_frames(
        &mut self,
        run: &mut Run<'_>,
        frames: Frames,
        shader: &Shader,
        passes: &Passes,
        path: &Path,
    ) -> Exit {
        let mut hasher = DefaultHasher::new();
        for checked in &passes.checked {
            self.args.driver.float().lower(checked).text().hash(&mut hasher);
        }
        format!(
            "{:?} {:?} {} {:?}",
            passes.project.to_json(&shader.files),
            self.args.pass,
            self.args.fps,
            self.args.warm_up
        )
        .hash(&mut hasher);
        let fingerprint = self.fingerprint(hasher);
        let sequence = Sequence::resume(frames, path, &fingerprint, self.terminal);
        let never = AtomicBool::new(false);
        let mut exit = Exit::Success;
        let whole = sequence.render(self.terminal, |one| {
            exit = match run.show(one.frame, &never) {
                Ok(rendered) => {
                    self.frame = run.clock.frame(one.frame);
                    self.write(&rendered, &shader.name, &one.path, false)
                }
                Err(unshown) => self.unshown(unshown, one.frame, shader),
            };
            exit == Exit::Success
        });
        if whole || exit != Exit::Success {
            exit
        } else {
            Exit::Error
        }
    }

    /// Prints why a frame is not shown.
    fn unshown(&self, unshown: Unshown, number: i32, shader: &Shader) -> Exit {
        match unshown {
            Unshown::Stopped(Stopped::Device(failure)) => self.draw_failed(failure, shader),
            Unshown::Stopped(Stopped::Evaluator(error)) => {
                not_evaluated(&error.failure, shader, self.terminal)
            }
            Unshown::Interrupted(next) => {
                self.terminal.error(format_args!(
                    "interrupted before frame {next}; frame {number} was to be shown"
                ));
                self.terminal.help(match self.args.state {
                    Some(_) => "run the same command again to go on",
                    None => "with --state FILE, the same command goes on",
                });
                Exit::Error
            }
        }
    }

    /// Writes the state after the last frame, if there is one and the user wants it.
    fn save_state(&self, run: &mut Run<'_>, first: i32, rendering: &Rendering) -> Exit {
        let Some(file) = self.args.state.as_ref().filter(|_| run.next > first) else {
            return Exit::Success;
        };
        let saved = match run.playback.state(&run.clock, run.next - 1) {
            Ok(state) => write_state(file, &rendering.graph, state),
            // The failure of the frame has been reported.
            Err(_) => return Exit::Success,
        };
        match saved {
            Ok(()) => {
                self.terminal
                    .confirm(file, &format!("the buffers after frame {}", run.next - 1));
                Exit::Success
            }
            Err(error) => {
                self.terminal.error(error);
                Exit::Error
            }
        }
    }
}
