//! `toyproof run` of a project: its passes over frames, from the first one or from a saved state.

use std::fmt::Display;
use std::hash::{DefaultHasher, Hash};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use toyproof_diagnostic::{grouped, path_name};
use toyproof_eval::{self as eval, Number, PassFailure, Settings, Supersampling};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{Failure, Worker};
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{Channel, Clock, Graph, Source, State, Target};
use toyproof_project::{Buffer, CompiledProject, PassKind, Rendering, Tab};
use toyproof_verify::project::playback::{CpuPlayback, DevicePlayback, PassShader, PlaybackFailure};

use super::failure::{FrameFailure, draw_error, frame_error, target_of};
use super::profile::Pass;
use super::state::{self, Owner};
use super::{Precision, RenderedImage, Runner, is_too_large, pass_error, shader_error};
use crate::cli::inputs::short_device;
use crate::cli::project::{bind_channels, pass_shader};
use crate::cli::sequence::{FrameEnd, Output, Sequence};
use crate::cli::shader::Shader;
use crate::cli::{CliError, Exit, Terminal};

/// Parses the name of a pass whose texture can be shown: `image`, `buffer-a` to `buffer-z`, or `cube-a`.
pub(in crate::cli) fn parse_pass(text: &str) -> Result<PassKind, String> {
    let buffers = (0..).map_while(Buffer::nth).map(PassKind::Buffer);
    let mut shown = buffers.chain([PassKind::Image, PassKind::CubeA]);
    let found = shown.find(|kind| Tab::Pass(*kind).name().eq_ignore_ascii_case(text));
    found.ok_or_else(|| "expected image, buffer-a to buffer-z, or cube-a".to_owned())
}

/// Reports the media of the site that are not available. `bound` are the channels of the image that the user
/// gives a texture.
pub(super) fn report_missing(
    rendering: &Rendering,
    bound: &[Option<Texture>; 4],
    name: &str,
    terminal: &Terminal,
) {
    let is_bound = |&(pass, channel): &(PassKind, usize)| pass == PassKind::Image && bound[channel].is_some();
    let missing = rendering.missing.iter();
    for missing in missing.filter(|missing| !missing.readers.iter().all(is_bound)) {
        let message = format!("{name}: {missing}");
        match missing.stand_in {
            Some(_) => terminal.note(&message),
            None => terminal.warn(message),
        }
    }
}

/// The reason for the wait is reported if at least this many frames must be rendered before the first one
/// that is shown.
const MANY_FRAMES: u64 = 60;

/// Frames in progress.
enum Playback<'a> {
    Device(DevicePlayback<'a>),
    Single(CpuPlayback<'a, f32>),
    Double(CpuPlayback<'a, f64>),
}

/// What renders the frames.
enum Renderer<'w> {
    Device(DevicePlayback<'w>),
    /// The evaluator, with the programs of the passes.
    Evaluator(Vec<Program>),
}

/// What renders the frames, and whether a driver was needed and not found.
struct Backend<'w> {
    renderer: Renderer<'w>,
    has_no_driver: bool,
}

impl Playback<'_> {
    /// Renders a frame, and returns the image of a pass.
    fn render(
        &mut self,
        clock: &Clock,
        number: i32,
        wanted: Option<Target>,
    ) -> Result<Option<Image>, FrameFailure> {
        let frame = clock.frame(number);
        let shown = |texture: Option<&Texture>| Some(Image::clone(&texture?.stack()));
        match self {
            Self::Device(playback) => {
                let wanted = wanted.as_slice();
                let mut images = playback.render(&frame, wanted).map_err(FrameFailure::Device)?;
                Ok(images.pop())
            }
            Self::Single(playback) => {
                playback.render(&frame).map_err(FrameFailure::Evaluator)?;
                Ok(shown(wanted.and_then(|target| playback.texture(target))))
            }
            Self::Double(playback) => {
                playback.render(&frame).map_err(FrameFailure::Evaluator)?;
                Ok(shown(wanted.and_then(|target| playback.texture(target))))
            }
        }
    }

    /// The state after a frame, which was rendered last.
    fn state(&mut self, clock: &Clock, number: i32) -> Result<State, Failure> {
        match self {
            Self::Device(playback) => playback.state(&clock.frame(number)),
            Self::Single(playback) => Ok(playback.state(number)),
            Self::Double(playback) => Ok(playback.state(number)),
        }
    }

    /// The device that renders: a driver, or the CPU.
    fn device(&self) -> String {
        match self {
            Self::Device(playback) => playback.device().to_owned(),
            Self::Single(_) | Self::Double(_) => "CPU".to_owned(),
        }
    }
}

/// The samples of the image, which are rendered after the passes of a frame.
struct ImageSamples<'a> {
    /// The program of the image.
    program: &'a Program,
    supersampling: Supersampling,
    /// The time limit of a frame.
    limit: Duration,
    interrupt: Option<&'a AtomicBool>,
}

impl ImageSamples<'_> {
    /// Renders the image of the frame that was rendered last, with the channels that it read.
    fn render<N: Number>(&self, frame: &Frame) -> Result<Image, eval::Failure> {
        let settings = Settings::<N> {
            deadline: Some(Instant::now() + self.limit),
            interrupt: self.interrupt,
            ..Settings::plain()
        };
        self.program
            .render_supersampled(frame, frame.rows(), &self.supersampling, &settings)
    }
}

/// The frames of a project in progress.
struct Run<'a> {
    playback: Playback<'a>,
    /// The samples of the image, if each pixel has several.
    samples: Option<ImageSamples<'a>>,
    passes: &'a PassShader<'a>,
    clock: Clock,
    target: Target,
    /// The next frame to render.
    next: i32,
    /// Whether a frame may depend on those before it: there are several passes.
    has_history: bool,
    terminal: &'a Terminal,
}

impl Run<'_> {
    /// A frame as the shown pass renders it.
    fn shown_frame(&self, number: i32) -> Frame {
        let frame = self.clock.frame(number);
        self.passes.graph.frame(self.target, &frame).into_owned()
    }

    /// The shown pass, and a frame, which was rendered last, with the channels that it read; `None` if a driver
    /// rendered it or if it is in double precision.
    fn shown_pass(&self, number: i32) -> Option<(&Checked, Frame)> {
        let Playback::Single(playback) = &self.playback else {
            return None;
        };
        let passes = self.passes.graph.passes();
        let pass = passes.iter().position(|pass| pass.target == self.target)?;
        let frame = playback.bound(pass, &self.clock.frame(number));
        Some((self.passes.checked[pass], frame))
    }

    /// All passes, and a frame, which was rendered last, with the channels that each read.
    fn profiled_passes(&self, number: i32) -> Vec<Pass<'_>> {
        let Playback::Single(playback) = &self.playback else {
            return Vec::new();
        };
        let passes = self.passes.graph.passes();
        let frame = self.clock.frame(number);
        let passes = passes.iter().zip(&self.passes.checked).enumerate();
        let passes = passes.map(|(at, (pass, checked))| Pass {
            target: pass.target,
            checked,
            frame: playback.bound(at, &frame),
            inputs: pass.inputs,
        });
        passes.collect()
    }

    /// Renders the frames up to this one, and returns the image of the shown pass in it.
    fn show(&mut self, number: i32, interrupted: &AtomicBool) -> Result<RenderedImage, FrameFailure> {
        let start = Instant::now();
        if !self.has_history {
            self.next = number;
        }
        let bar = self
            .terminal
            .bar((number - self.next).max(0) as u64 + 1, "frames");
        let played = self.play_to(number, interrupted, &bar);
        bar.finish_and_clear();
        let image = played?;
        Ok(RenderedImage {
            image: image.expect("the shown pass is rendered"),
            device: self.playback.device(),
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    fn play_to(
        &mut self,
        number: i32,
        interrupted: &AtomicBool,
        bar: &ProgressBar,
    ) -> Result<Option<Image>, FrameFailure> {
        loop {
            if interrupted.load(Ordering::Relaxed) {
                return Err(FrameFailure::Interrupted(self.next));
            }
            let wanted = (self.next == number).then_some(self.target);
            let image = match self.playback.render(&self.clock, self.next, wanted) {
                Err(FrameFailure::Evaluator(PassFailure {
                    failure: eval::Failure::Interrupted,
                    ..
                })) => return Err(FrameFailure::Interrupted(self.next)),
                result => result?,
            };
            self.next += 1;
            bar.inc(1);
            if wanted.is_some() {
                return match &self.samples {
                    None => Ok(image),
                    Some(samples) => self.supersampled(samples, number).map(Some),
                };
            }
        }
    }

    /// Renders the image of a frame, which was rendered last, with several samples in each pixel.
    fn supersampled(&self, samples: &ImageSamples<'_>, number: i32) -> Result<Image, FrameFailure> {
        let frame = self.clock.frame(number);
        // The image is the last pass.
        let pass = self.passes.graph.passes().len() - 1;
        let rendered = match &self.playback {
            Playback::Single(playback) => samples.render::<f32>(&playback.bound(pass, &frame)),
            Playback::Double(playback) => samples.render::<f64>(&playback.bound(pass, &frame)),
            Playback::Device(_) => unreachable!("samples are rendered by the evaluator"),
        };
        rendered.map_err(|failure| match failure {
            eval::Failure::Interrupted => FrameFailure::Interrupted(number),
            failure => FrameFailure::Evaluator(PassFailure { pass, failure }),
        })
    }
}

/// The frame of a project whose image reads no other pass, with the sources of its channels; `None` if there
/// are other passes.
pub(in crate::cli) fn bound(rendering: &Rendering, frame: &Frame) -> Option<Frame> {
    let [image] = rendering.graph.passes() else {
        return None;
    };
    let channels = image.inputs.map(|input| match input {
        None | Some(Source::Buffer(_)) => Channel::Unbound,
        Some(Source::Medium(number)) => Channel::Medium(number),
        Some(Source::Moving(number)) => Channel::Moving(number),
        Some(Source::Keyboard) => Channel::Keyboard,
    });
    Some(eval::bound(frame, channels, &rendering.media))
}

impl Runner<'_> {
    /// Renders a project: one frame, or each of a sequence into its file.
    pub(super) fn project(
        &mut self,
        shader: &Shader,
        passes: &CompiledProject,
        path: &Path,
    ) -> Result<Exit, CliError> {
        let output = self.args.sequence.output(path)?;
        if let Output::Sound(seconds) = output {
            return self.sound(shader, passes, seconds, path).map(|()| Exit::Success);
        }
        let kind = self.args.pass.unwrap_or(PassKind::Image);
        let rendering = self.rendering(shader, passes, kind)?;
        if self.is_banded() {
            let is_single = rendering.graph.passes().len() == 1 && self.args.state.is_none();
            self.check_banded(shader, !is_single, path)?;
        }
        if output == Output::Image
            && self.args.state.is_none()
            && let Some(frame) = bound(
                &rendering,
                &self
                    .clock_of(&rendering, self.frame.frame)
                    .frame(self.frame.frame),
            )
        {
            return self.one_image(shader, &frame, path).map(|()| Exit::Success);
        }
        // The worker is used beside this runner, which writes the images.
        let mut worker = self.worker.take();
        let exit = self.render_passes(&mut worker, shader, passes, (kind, &rendering), (output, path));
        self.worker = worker;
        exit
    }

    /// The sound of a film of a project, if it has one and the film can have it.
    fn film_sound(
        &self,
        shader: &Shader,
        passes: &CompiledProject,
        output: Output,
    ) -> Result<Option<tempfile::NamedTempFile>, CliError> {
        let Output::Film(frames, format) = output else {
            return Ok(None);
        };
        if !format.has_sound() {
            return Ok(None);
        }
        let fps = self.args.sequence.fps;
        let from = self.args.frame.start(0, fps) + f64::from(frames.first()) / fps;
        self.sound_of_film(shader, passes, (from, frames.count() as f64 / fps))
    }

    /// The inputs of all frames of a project; the one with this number has the time that the user gives.
    pub(super) fn clock_of(&self, rendering: &Rendering, number: i32) -> Clock {
        let mut clock = self.clock(number);
        clock.inputs.films = rendering.films.clone();
        clock
    }

    /// Renders the passes over frames.
    fn render_passes(
        &mut self,
        worker: &mut Option<Worker>,
        shader: &Shader,
        passes: &CompiledProject,
        (kind, rendering): (PassKind, &Rendering),
        (output, path): (Output, &Path),
    ) -> Result<Exit, CliError> {
        let scheduled = pass_shader(passes, rendering);
        let fingerprint = self.fingerprint_of_project(shader, passes);
        let sound = self.film_sound(shader, passes, output)?;
        let sound = sound.as_ref().map(tempfile::NamedTempFile::path);
        let size = rendering.graph.size(kind.target(), self.frame.size);
        let sequence = self.open_sequence((output, size), path, &fingerprint, sound)?;
        let has_history = rendering.graph.passes().len() > 1;
        let first = match (&sequence, self.args.sequence.frames()?) {
            (Some(sequence), Some(frames)) => sequence.first_missing().unwrap_or(frames.first()),
            _ => self.args.frame.number(has_history, self.args.sequence.fps),
        };
        let clock = self.clock_of(rendering, if sequence.is_some() { 0 } else { first });
        let owner = Owner::new(passes, rendering, &shader.files, &clock);
        // If all frames exist, they only remain to be encoded.
        let is_rendered = sequence
            .as_ref()
            .is_some_and(|sequence| sequence.first_missing().is_none());
        let state = if is_rendered {
            None
        } else {
            self.state(shader, &scheduled, &owner, first)?
        };
        let next = self.next(state.as_ref(), first, has_history);
        self.report_history(shader, next, first);
        // With a state, the frame in progress is finished, so that it can be written. Otherwise an interrupt
        // ends the program at once, also while a driver compiles.
        if self.args.state.is_some() {
            self.terminal
                .watch_interrupts("the frame in progress is finished first, and the state written");
        }
        let interrupted = self.terminal.interrupt_flag();
        let interrupt = self.args.state.is_none().then_some(interrupted);
        let limit = self.args.driver.explicit_timeout();
        let state = state.as_ref();
        let Backend {
            renderer,
            has_no_driver,
        } = self.backend(worker, shader, &scheduled, state, has_history)?;
        let programs;
        let mut samples = None;
        let playback = match renderer {
            Renderer::Device(playback) => Playback::Device(playback),
            Renderer::Evaluator(compiled) => {
                programs = compiled;
                let supersampling = self.supersampling.clone();
                samples = programs
                    .last()
                    .zip(supersampling)
                    .map(|(program, supersampling)| ImageSamples {
                        program,
                        supersampling,
                        limit,
                        interrupt,
                    });
                match self.args.precision {
                    Precision::F32 => {
                        let settings = Settings {
                            interrupt,
                            ..Settings::plain()
                        };
                        Playback::Single(CpuPlayback::new(&scheduled, &programs, state, limit, settings))
                    }
                    Precision::F64 => {
                        let settings = Settings {
                            interrupt,
                            ..Settings::plain()
                        };
                        Playback::Double(CpuPlayback::new(&scheduled, &programs, state, limit, settings))
                    }
                }
            }
        };
        self.terminal.detail(&format!(
            "{}: {} renders the passes",
            shader.name,
            short_device(&playback.device())
        ));
        let mut run = Run {
            playback,
            samples,
            passes: &scheduled,
            clock,
            target: kind.target(),
            next,
            has_history,
            terminal: self.terminal,
        };
        let shown = match sequence {
            None => self.one_frame(&mut run, first, shader, path, interrupted),
            Some(sequence) => self.all_frames(&mut run, sequence, (shader, output, path)),
        };
        // The state of the frames before a failed one is saved.
        let exit = shown.map_or_else(|error| self.terminal.fail(&error), |()| Exit::Success);
        let saved = self.save_state(&mut run, next, &owner);
        drop(run);
        if has_no_driver {
            *worker = None;
        }
        saved.map(|()| exit)
    }

    /// Chooses what renders the frames: the evaluator if it suffices, else the driver, and the evaluator also
    /// if no driver is found.
    fn backend<'w>(
        &self,
        worker: &'w mut Option<Worker>,
        shader: &Shader,
        scheduled: &PassShader<'_>,
        state: Option<&State>,
        has_history: bool,
    ) -> Result<Backend<'w>, CliError> {
        let limit = self.args.driver.explicit_timeout();
        let evaluates =
            worker.is_none() || self.prefers_evaluator && !(has_history && scheduled.is_filtering());
        if evaluates {
            match scheduled.programs(limit) {
                Err((_, refusal)) if worker.is_some() && is_too_large(&refusal.into()) => {}
                programs => {
                    return Ok(Backend {
                        renderer: Renderer::Evaluator(compiled_programs(programs, scheduled.graph, shader)?),
                        has_no_driver: false,
                    });
                }
            }
        }
        let opened = match worker {
            Some(worker) => self.open(worker, scheduled, state, shader)?,
            None => None,
        };
        let has_no_driver = opened.is_none();
        let renderer = if let Some(playback) = opened {
            Renderer::Device(playback)
        } else {
            let programs = scheduled.programs(limit);
            Renderer::Evaluator(compiled_programs(programs, scheduled.graph, shader)?)
        };
        Ok(Backend {
            renderer,
            has_no_driver,
        })
    }

    /// What renders a pass, with the textures that the user binds to the channels of the image.
    fn rendering(
        &self,
        shader: &Shader,
        passes: &CompiledProject,
        kind: PassKind,
    ) -> Result<Rendering, CliError> {
        if passes.project.pass(kind).is_none() {
            let error = format!("there is no {kind}");
            return Err(refusal(shader, error, "name one of its passes with --pass"));
        }
        let rendering = passes.rendering(kind);
        let mut rendering =
            rendering.map_err(|error| refusal(shader, error, "`toyproof check` compiles all its tabs"))?;
        let sizes = rendering.graph.check_sizes(self.frame.size);
        sizes.map_err(|error| refusal(shader, error, "change the size of the pass, or --size"))?;
        report_missing(&rendering, &self.frame.channels, &shader.name, self.terminal);
        bind_channels(passes, &mut rendering, &self.frame.channels);
        Ok(rendering)
    }

    /// The state to start from, if there is one, before a frame is shown.
    fn state(
        &self,
        shader: &Shader,
        passes: &PassShader<'_>,
        owner: &Owner,
        first: i32,
    ) -> Result<Option<State>, CliError> {
        let Some(file) = &self.args.state else {
            return Ok(None);
        };
        let refuse = |error: String| refusal(shader, error, "name another file with --state");
        let Some(state) = state::read(file, owner, passes.graph).map_err(refuse)? else {
            return Ok(None);
        };
        if !state.fits(passes.graph) {
            return Err(refuse(format!("{} is damaged", path_name(file))));
        }
        if state.frame >= first {
            let last = state.frame;
            return Err(refuse(format!(
                "the state is that of frame {last}, and frame {first} is earlier"
            )));
        }
        Ok(Some(state))
    }

    /// The first frame to render, so that frame `first` can be shown.
    fn next(&self, state: Option<&State>, first: i32, has_history: bool) -> i32 {
        match (state, self.args.warm_up) {
            (Some(state), _) => state.frame + 1,
            (None, _) if !has_history => first,
            (None, None) => 0,
            (None, Some(frames)) => first
                .saturating_sub(i32::try_from(frames).unwrap_or(i32::MAX))
                .max(0),
        }
    }

    /// Reports how many frames are rendered before the first one that is shown.
    fn report_history(&self, shader: &Shader, next: i32, first: i32) {
        let count = u64::from(first.abs_diff(next));
        if next < first && count >= MANY_FRAMES {
            let help = match (self.args.warm_up, &self.args.state) {
                (None, None) => {
                    "; `--warm-up N` renders only the last N of them, which suffices if buffers forget"
                }
                _ => "",
            };
            self.terminal.note(&format!(
                "{}: frame {} may depend on earlier ones: {} frames are rendered first{help}",
                shader.name,
                grouped(u64::from(first.unsigned_abs())),
                grouped(count)
            ));
        }
    }

    /// Compiles the passes for the driver; `None` if there is no driver and the evaluator takes its place.
    fn open<'w>(
        &self,
        worker: &'w mut Worker,
        shader: &PassShader<'_>,
        state: Option<&State>,
        named: &Shader,
    ) -> Result<Option<DevicePlayback<'w>>, CliError> {
        let driver = &self.args.driver;
        match DevicePlayback::open(worker, shader, state, driver.float(), driver.explicit_timeout()) {
            Ok(playback) => Ok(Some(playback)),
            Err(PlaybackFailure::Gpu(failure)) if failure.is_without_driver() && driver.may_fall_back() => {
                self.report_no_driver(&failure);
                Ok(None)
            }
            Err(PlaybackFailure::Gpu(failure)) => Err(draw_error(failure, named)),
            Err(PlaybackFailure::Overdue(overdue)) => Err(shader_error(vec![glsl::overdue(overdue)], named)),
        }
    }

    fn one_frame(
        &mut self,
        run: &mut Run<'_>,
        number: i32,
        shader: &Shader,
        path: &Path,
        interrupted: &AtomicBool,
    ) -> Result<(), CliError> {
        let rendered = run.show(number, interrupted);
        let rendered = rendered.map_err(|failure| frame_error(failure, run.passes.graph, number, shader))?;
        self.write_confirmed(&rendered, &run.shown_frame(number), &shader.name, path)?;
        if let Some((checked, frame)) = run.shown_pass(number) {
            self.write_error_map(shader, checked, &frame)?;
        }
        if self.args.profile.profile.is_some() {
            self.write_profile(shader, &run.profiled_passes(number))?;
        }
        Ok(())
    }

    fn all_frames(
        &mut self,
        run: &mut Run<'_>,
        sequence: Sequence,
        (shader, output, path): (&Shader, Output, &Path),
    ) -> Result<(), CliError> {
        let mut film = self.written_film(output, &run.clock, &shader.name, path);
        if let Some(film) = &mut film {
            film.size = run.passes.graph.size(run.target, film.size);
        }
        sequence.render(self.terminal, |number, destination, interrupted| {
            match run.show(number, interrupted) {
                Ok(rendered) => {
                    let frame = run.shown_frame(number);
                    self.put(&rendered, &frame, &shader.name, destination, film.as_mut())?;
                }
                Err(FrameFailure::Interrupted(_)) => return Ok(FrameEnd::Interrupted),
                Err(failure) => return Err(frame_error(failure, run.passes.graph, number, shader)),
            }
            Ok(FrameEnd::Written)
        })?;
        self.images.extend(film);
        Ok(())
    }

    /// A digest of everything that the frames of a sequence depend on.
    fn fingerprint_of_project(&self, shader: &Shader, passes: &CompiledProject) -> String {
        let mut hasher = DefaultHasher::new();
        for checked in &passes.checked {
            self.args.driver.float().lower(checked).text().hash(&mut hasher);
        }
        format!(
            "{:?} {:?} {:?}",
            passes.project.to_json(&shader.files),
            self.args.pass,
            self.args.warm_up
        )
        .hash(&mut hasher);
        self.fingerprint(hasher)
    }

    /// Writes the state after the last frame, if there is one and the user wants it.
    fn save_state(&self, run: &mut Run<'_>, first: i32, owner: &Owner) -> Result<(), CliError> {
        let Some(file) = self.args.state.as_ref().filter(|_| run.next > first) else {
            return Ok(());
        };
        // If there is no state, the failure of the frame has been reported.
        if let Ok(saved) = run.playback.state(&run.clock, run.next - 1) {
            state::write(file, owner, &saved)?;
            self.terminal
                .confirm(file, &format!("the buffers after frame {}", run.next - 1));
        }
        Ok(())
    }
}

/// Why a project is not rendered, and a way out.
fn refusal(shader: &Shader, error: impl Display, help: &str) -> CliError {
    CliError::new(format_args!("{}: {error}", shader.name)).with_help(help)
}

/// Unwraps the programs of the passes.
fn compiled_programs(
    result: Result<Vec<Program>, (usize, eval::Refusal)>,
    graph: &Graph,
    shader: &Shader,
) -> Result<Vec<Program>, CliError> {
    result.map_err(|(pass, refusal)| pass_error(&refusal.into(), target_of(graph, pass), shader))
}

#[cfg(test)]
mod tests {
    use toyproof_eval::Refusal;
    use toyproof_player::Pass;

    use super::*;
    use crate::cli::shader::Unusable;

    #[test]
    fn the_error_of_a_pass_names_its_tab() {
        let shader = Shader {
            name: "waves".to_owned(),
            files: Default::default(),
            content: Err(Unusable::Invalid(Vec::new())),
            lints: Default::default(),
            has_passes: true,
            is_missing: false,
        };
        let pass = |target| Pass {
            target,
            inputs: [None; 4],
        };
        let passes = vec![pass(Target::Buffer(1)), pass(Target::Image)];
        let graph = Graph::new(passes, Default::default());
        for (pass, tab) in [(0, "Buffer B"), (1, "Image")] {
            let result = compiled_programs(Err((pass, Refusal::TooLong)), &graph, &shader);
            let message = result.err().and_then(|error| error.message).unwrap();
            assert!(message.starts_with(&format!("waves: {tab}: ")), "{message}");
        }
    }
}
