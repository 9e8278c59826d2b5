//! The frame in which the image of a project is checked, with what its other passes render in it.

use std::time::Duration;

use rayon::ThreadPool;
use toyproof_diagnostic::Diagnostic;
use toyproof_eval::{self as eval, Program};
use toyproof_glsl::Filter;
use toyproof_gpu::Worker;
use toyproof_image::{FRAME_RATE, Frame, Image, Texture};
use toyproof_player::{Clock, Source, Target};
use toyproof_project::{PassKind, Rendering};
use toyproof_scene::{MAX_SAMPLES, Sampler, Scene};
use toyproof_translate::FloatMode;
use toyproof_verify::growth::{Frames, Growth, follow};
use toyproof_verify::playback::{CpuPlayback, DevicePlayback, PassShader, PlaybackFailure};
use toyproof_verify::trail::{Trail, trail};
use toyproof_verify::{Failure, driver_failure, is_replaceable};

use super::project::Passes;

/// The frame in which a project is checked if nothing suggests another: a few frames of feedback.
const CHECKED_FRAME: i32 = 7;

/// Whether the image depends on earlier frames: it reads other passes.
pub(super) fn has_history(passes: &Passes) -> bool {
    !passes.project.needed_by_image().is_empty()
}

/// What renders the passes of a project.
pub(super) struct Renderers<'a> {
    /// The driver, whose passes are compared with those of the evaluator in strict runs.
    pub(super) worker: Option<&'a mut Worker>,
    pub(super) float: FloatMode,
    /// The time limit of each frame.
    pub(super) timeout: Duration,
    pub(super) pool: Option<&'a ThreadPool>,
}

/// The first pass that the driver renders differently from the evaluator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PassDifference {
    pub(super) pass: Target,
    pub(super) frame: i32,
    pub(super) pixels: usize,
}

/// What the frames before one contribute to its image.
#[derive(Debug)]
pub(super) struct BoundFrame {
    /// The frame with what its channels read after double precision in all frames.
    pub(super) double: Frame,
    /// How far float32 is from that.
    pub(super) growth: Growth,
    /// Warnings about the buffers, and about a driver that failed.
    pub(super) notes: Vec<Diagnostic>,
    /// The first difference of the driver's passes.
    pub(super) difference: Option<PassDifference>,
}

/// A project that renders its image.
struct Subject<'a> {
    passes: &'a Passes,
    rendering: &'a Rendering,
    shader: PassShader<'a>,
    programs: Vec<Program>,
}

/// Binds what the image of a shader reads in this frame: the textures that do not change, and the buffers
/// after all passes of this frame and of those before it, in float32. Returns what the frames before it
/// contribute, if the image depends on them. A driver that fails is left out if there is a reference, as in the check
/// of the image.
///
/// # Errors
/// Why the buffers cannot be rendered.
pub(super) fn bind(
    passes: &Passes,
    frame: &mut Frame,
    has_reference: bool,
    renderers: Renderers<'_>,
) -> Result<Option<BoundFrame>, Failure> {
    let (timeout, pool) = (renderers.timeout, renderers.pool);
    let rendering = rendering(passes, PassKind::Image)?;
    let subject = Subject::new(passes, &rendering, timeout, pool)?;
    if !has_history(passes) {
        *frame = subject.bound(frame, |_| None);
        return Ok(None);
    }
    let clock = clock(frame);
    let mut failed = None;
    let mut leave_out = |failure: Failure| match &failure {
        Failure::Gpu(gpu) if is_replaceable(gpu, has_reference) => {
            failed = Some(driver_failure(&failure));
            Ok(())
        }
        _ => Err(failure),
    };
    let mut device = match open(renderers, &subject.shader) {
        Ok(device) => device,
        Err(failure) => {
            leave_out(failure)?;
            None
        }
    };
    // The image of the last frame is compared with more care.
    let targets: Vec<Target> = rendering.graph.passes().iter().map(|pass| pass.target).collect();
    let mut difference = None;
    let frames = Frames {
        shader: &subject.shader,
        programs: &subject.programs,
        clock: &clock,
        last: frame.frame,
        timeout,
        pool,
    };
    let history = follow(&frames, |inputs, playback| {
        let Some(driver) = device.as_mut().filter(|_| difference.is_none()) else {
            return Ok(());
        };
        let images = match driver.render(inputs, &targets) {
            Ok(images) => images,
            Err(failure) => {
                device = None;
                return leave_out(Failure::Gpu(failure));
            }
        };
        difference = images.iter().zip(&targets).find_map(|(image, &pass)| {
            let pixels = differing(playback.texture(pass)?, image);
            (pixels > 0).then_some(PassDifference {
                pass,
                frame: inputs.frame,
                pixels,
            })
        });
        Ok(())
    })?;
    let double = subject.bound(frame, |buffer| {
        history.double.texture(Target::Buffer(buffer)).cloned()
    });
    *frame = subject.bound(frame, |buffer| {
        history.single.texture(Target::Buffer(buffer)).cloned()
    });
    let mut notes = history.notes;
    notes.extend(failed);
    Ok(Some(BoundFrame {
        double,
        growth: history.growth,
        notes,
        difference,
    }))
}

/// Binds what the image of a reference reads in this frame, in double precision.
///
/// # Errors
/// Why the buffers cannot be rendered.
pub(super) fn bind_reference(passes: &Passes, frame: &mut Frame, timeout: Duration) -> Result<(), Failure> {
    let rendering = rendering(passes, PassKind::Image)?;
    let subject = Subject::new(passes, &rendering, timeout, None)?;
    let mut playback = CpuPlayback::<f64>::new(&subject.shader, &subject.programs, None, timeout, None);
    if has_history(passes) {
        let clock = clock(frame);
        for number in 0..=frame.frame {
            let rendered = playback.render(&clock.frame(number));
            rendered.map_err(|error| error.failure)?;
        }
    }
    *frame = subject.bound(frame, |buffer| playback.texture(Target::Buffer(buffer)).cloned());
    Ok(())
}

/// Follows the difference between float32 and double precision in a pixel of a pass back through passes and
/// frames.
///
/// # Errors
/// Why the passes cannot be rendered.
pub(super) fn follow_back(
    passes: &Passes,
    kind: PassKind,
    pixel: [u32; 2],
    frame: &Frame,
    timeout: Duration,
) -> Result<Trail, Failure> {
    let rendering = rendering(passes, kind)?;
    let subject = Subject::new(passes, &rendering, timeout, None)?;
    let frames = Frames {
        shader: &subject.shader,
        programs: &subject.programs,
        clock: &clock(frame),
        last: frame.frame,
        timeout,
        pool: None,
    };
    trail(&frames, target(kind), pixel)
}

/// The target of a pass that is rendered.
pub(super) fn target(kind: PassKind) -> Target {
    match kind {
        PassKind::Buffer(buffer) => Target::Buffer(buffer as usize),
        _ => Target::Image,
    }
}

/// The frame in which a project is compared with a scene, or with nothing, if the user names none.
pub(super) fn default_frame(scene: Option<&Scene>) -> i32 {
    let samples = scene.and_then(accumulated_samples);
    samples.map_or(CHECKED_FRAME, |samples| samples as i32 - 1)
}

/// The number of samples of a stochastic scene that a project may take one by one, a frame for each.
fn accumulated_samples(scene: &Scene) -> Option<u32> {
    let film = &scene.film;
    // The grid of stratified samples depends on their number.
    let is_sequence = film.sampler.is_stochastic() && film.sampler != Sampler::Stratified;
    is_sequence.then_some(film.samples)
}

/// Gives a scene the number of samples that a project has accumulated in a frame.
pub(super) fn accumulate(scene: &mut Scene, frame: i32) {
    if accumulated_samples(scene).is_some() {
        scene.film.samples = (frame as u32).saturating_add(1).min(MAX_SAMPLES);
    }
}

/// What renders a pass.
fn rendering(passes: &Passes, kind: PassKind) -> Result<Rendering, Failure> {
    let rendering = passes.rendering(kind);
    rendering.map_err(|error| Failure::Unrendered(error.to_string()))
}

/// The inputs of the frames up to this one, at the site's rate.
fn clock(frame: &Frame) -> Clock {
    let rate = f64::from(FRAME_RATE);
    Clock {
        inputs: frame.clone(),
        rate,
        start: f64::from(frame.time) - f64::from(frame.frame) / rate,
    }
}

impl<'a> Subject<'a> {
    /// Compiles the passes that the image depends on; none if it depends on no other.
    fn new(
        passes: &'a Passes,
        rendering: &'a Rendering,
        timeout: Duration,
        pool: Option<&ThreadPool>,
    ) -> Result<Self, Failure> {
        let shader = PassShader {
            checked: passes.checked_of(rendering).collect(),
            graph: &rendering.graph,
            media: &rendering.media,
        };
        let programs = if rendering.graph.passes().len() > 1 {
            let programs = || shader.programs(timeout);
            within(pool, programs).map_err(|(_, refusal)| eval::Failure::Refused(refusal))?
        } else {
            Vec::new()
        };
        Ok(Self {
            passes,
            rendering,
            shader,
            programs,
        })
    }

    /// The frame with the channels of the image, where `buffer` returns the texture of a buffer.
    fn bound(&self, frame: &Frame, buffer: impl Fn(usize) -> Option<Texture>) -> Frame {
        let graph = self.shader.graph;
        let image = graph.passes().iter().find(|pass| pass.target == Target::Image);
        let inputs = image.map_or([None; 4], |image| image.inputs);
        let mut bound = frame.clone();
        for (index, (channel, input)) in bound.channels.iter_mut().zip(inputs).enumerate() {
            let has_mipmaps = self.passes.image().sampling[index].filter == Filter::Mipmap;
            *channel = match (channel.take(), input) {
                (Some(given), _) if has_mipmaps => Some(given.with_mipmaps()),
                (Some(given), _) => Some(given),
                (None, None) => None,
                (None, Some(Source::Medium(number))) => self.rendering.media.get(number).cloned(),
                (None, Some(Source::Buffer(number))) => buffer(number),
                (None, Some(Source::Keyboard)) => Some(frame.keys.texture()),
            };
        }
        bound
    }
}

/// Compiles the passes for the driver in a strict run; none without a driver, which the check of the image
/// reports.
fn open<'a>(
    renderers: Renderers<'a>,
    shader: &PassShader<'_>,
) -> Result<Option<DevicePlayback<'a>>, Failure> {
    let Renderers {
        worker: Some(worker),
        float: float @ FloatMode::Strict,
        timeout,
        ..
    } = renderers
    else {
        return Ok(None);
    };
    match DevicePlayback::open(worker, shader, None, float, timeout) {
        Ok(playback) => Ok(Some(playback)),
        Err(PlaybackFailure::Gpu(failure)) if failure.is_without_driver() => Ok(None),
        Err(PlaybackFailure::Gpu(failure)) => Err(Failure::Gpu(failure)),
        Err(PlaybackFailure::Overdue(overdue)) => Err(Failure::Overdue(overdue)),
    }
}

/// The number of pixels whose bits differ. The sign of a zero and the bits of NaN are open.
fn differing(own: &Texture, other: &Image) -> usize {
    let own = own.to_single();
    let is_open = |a: f32, b: f32| a == b || a.is_nan() && b.is_nan();
    let differs = |(a, b): &(&[f32; 4], &[f32; 4])| !a.iter().zip(*b).all(|(&a, &b)| is_open(a, b));
    own[0].pixels().iter().zip(other.pixels()).filter(differs).count()
}

fn within<T: Send>(pool: Option<&ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}
