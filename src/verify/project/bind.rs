//! The frame in which the image of a project is checked, with what its other passes render in it.

use std::time::Duration;

use rayon::ThreadPool;
use toyproof_diagnostic::Diagnostic;
use toyproof_eval::{self as eval, Settings};
use toyproof_eval_native::Program;
use toyproof_glsl::Filter;
use toyproof_image::{FRAME_RATE, Frame, Image, Texture};
use toyproof_player::{Clock, Source, Target};
use toyproof_scene::{MAX_SAMPLES, Sampler, Scene};
use toyproof_translate::FloatMode;

use super::frames::Frames;
use super::growth::{Growth, follow};
use super::playback::{CpuPlayback, DevicePlayback, PassShader, PlaybackFailure};
use crate::driver::{Driver, is_replaceable};
use crate::failure::Failure;
use crate::notes::driver_failure;
use crate::pool::within;

/// The frame in which a project is checked if nothing suggests another: a few frames of feedback.
const CHECKED_FRAME: i32 = 7;

/// What renders the passes of a project.
#[derive(Debug)]
pub struct Renderers<'a> {
    /// The driver, whose passes are compared with those of the evaluator in strict runs.
    pub driver: Option<&'a mut Driver>,
    /// How far the driver may rearrange arithmetic.
    pub float: FloatMode,
    /// The time limit of each frame.
    pub timeout: Duration,
    /// The evaluator's pool; rayon's global pool if `None`.
    pub pool: Option<&'a ThreadPool>,
}

/// The first pass that the driver renders differently from the evaluator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PassDifference {
    /// What the pass renders.
    pub pass: Target,
    /// The frame.
    pub frame: i32,
    /// The number of pixels that differ.
    pub pixels: usize,
}

/// A frame with the contributions of earlier frames.
#[derive(Debug)]
pub struct BoundFrame {
    /// The frame with what its channels read after double precision in all frames.
    pub double: Frame,
    /// How far float32 is from that.
    pub growth: Growth,
    /// Warnings about the buffers, and about a driver that failed.
    pub notes: Vec<Diagnostic>,
    /// The first difference of the driver's passes.
    pub difference: Option<PassDifference>,
}

/// Binds the inputs of the image of a shader in this frame: the textures that do not change, and the buffers
/// after all passes of this frame and of those before it, in float32. Returns what the frames before it
/// contribute, if the image depends on them. A driver that fails is left out if there is a reference, as in
/// the check of the image.
///
/// # Errors
/// Why the buffers cannot be rendered.
pub fn bind(
    shader: &PassShader,
    frame: &mut Frame,
    has_reference: bool,
    renderers: Renderers<'_>,
) -> Result<Option<BoundFrame>, Failure> {
    let (timeout, pool) = (renderers.timeout, renderers.pool);
    *frame = shader.with_films(frame);
    if !has_history(shader) {
        *frame = bound(shader, frame, |_| None);
        return Ok(None);
    }
    let programs = programs(shader, timeout, pool)?;
    let clock = clock(frame);
    let mut failed = None;
    let mut leave_out = |failure: Failure| match &failure {
        Failure::Gpu(gpu) if is_replaceable(gpu, has_reference) => {
            failed = Some(driver_failure(&failure));
            Ok(())
        }
        _ => Err(failure),
    };
    let mut device = match open(renderers, shader) {
        Ok(device) => device,
        Err(failure) => {
            leave_out(failure)?;
            None
        }
    };
    // The image of the last frame is compared with more care.
    let targets: Vec<Target> = shader.graph.passes().iter().map(|pass| pass.target).collect();
    let mut difference = None;
    let frames = Frames {
        shader,
        programs: &programs,
        clock: &clock,
        last: frame.frame,
        timeout,
        pool,
    };
    let history = follow(&frames, |inputs, playback| {
        let Some(playing) = device.as_mut().filter(|_| difference.is_none()) else {
            return Ok(());
        };
        let images = match playing.render(inputs, &targets) {
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
    let double = bound(shader, frame, |buffer| {
        history.double.texture(Target::Buffer(buffer)).cloned()
    });
    *frame = bound(shader, frame, |buffer| {
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

/// Binds the inputs of the image of a reference in this frame, in double precision.
///
/// # Errors
/// Why the buffers cannot be rendered.
pub fn bind_reference(shader: &PassShader, frame: &mut Frame, timeout: Duration) -> Result<(), Failure> {
    let programs = programs(shader, timeout, None)?;
    let mut playback = CpuPlayback::<f64>::new(shader, &programs, None, timeout, Settings::plain());
    *frame = shader.with_films(frame);
    if has_history(shader) {
        let clock = clock(frame);
        for number in 0..=frame.frame {
            let rendered = playback.render(&clock.frame(number));
            rendered.map_err(|error| error.failure)?;
        }
    }
    *frame = bound(shader, frame, |buffer| {
        playback.texture(Target::Buffer(buffer)).cloned()
    });
    Ok(())
}

/// The frame in which a project is compared with a scene, or with nothing, if the user names none.
#[must_use]
pub fn default_frame(scene: Option<&Scene>) -> i32 {
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
pub fn accumulate(scene: &mut Scene, frame: i32) {
    if accumulated_samples(scene).is_some() {
        scene.film.samples = (frame as u32).saturating_add(1).min(MAX_SAMPLES);
    }
}

/// The inputs of the frames up to this one, at the site's rate.
#[must_use]
pub fn clock(frame: &Frame) -> Clock {
    let rate = f64::from(FRAME_RATE);
    Clock {
        inputs: frame.clone(),
        rate,
        start: f64::from(frame.time) - f64::from(frame.frame) / rate,
    }
}

/// Whether the image depends on other passes, and so on earlier frames.
#[must_use]
pub fn has_history(shader: &PassShader) -> bool {
    shader.graph.passes().len() > 1
}

/// Compiles the passes; none if the image depends on no other.
///
/// # Errors
/// Why a pass is too large.
pub fn programs(
    shader: &PassShader,
    timeout: Duration,
    pool: Option<&ThreadPool>,
) -> Result<Vec<Program>, Failure> {
    if !has_history(shader) {
        return Ok(Vec::new());
    }
    let programs = within(pool, || shader.programs(timeout));
    Ok(programs.map_err(|(_, refusal)| eval::Failure::Refused(refusal))?)
}

/// The frame with the channels of the image, where `buffer` returns the texture of a buffer.
fn bound(shader: &PassShader, frame: &Frame, buffer: impl Fn(usize) -> Option<Texture>) -> Frame {
    let mut bound = frame.clone();
    let mut passes = shader.graph.passes().iter().zip(&shader.checked);
    let Some((pass, image)) = passes.find(|(pass, _)| pass.target == Target::Image) else {
        return bound;
    };
    for (index, (channel, input)) in bound.channels.iter_mut().zip(pass.inputs).enumerate() {
        let has_mipmaps = image.sampling[index].filter == Filter::Mipmap;
        *channel = match (channel.take(), input) {
            (Some(given), _) if has_mipmaps => Some(given.with_mipmaps()),
            (Some(given), _) => Some(given),
            (None, None) => None,
            (None, Some(Source::Medium(number))) => shader.media.get(number).cloned(),
            (None, Some(Source::Buffer(number))) => buffer(number),
            (None, Some(Source::Moving(number))) => frame.moving.get(number).map(|(texture, time)| {
                bound.channel_times[index] = *time;
                texture.clone()
            }),
            (None, Some(Source::Keyboard)) => Some(frame.keys.texture()),
        };
    }
    bound
}

/// Compiles the passes for the driver in a strict run; `None` without a driver, which the check of the image
/// reports.
fn open<'a>(
    renderers: Renderers<'a>,
    shader: &PassShader<'_>,
) -> Result<Option<DevicePlayback<'a>>, Failure> {
    let Renderers {
        driver: Some(driver),
        float: float @ FloatMode::Strict,
        timeout,
        ..
    } = renderers
    else {
        return Ok(None);
    };
    match DevicePlayback::open(driver, shader, None, float, timeout) {
        Ok(playback) => Ok(Some(playback)),
        Err(PlaybackFailure::Gpu(failure)) if failure.is_without_driver() => Ok(None),
        Err(PlaybackFailure::Gpu(failure)) => Err(Failure::Gpu(failure)),
        Err(PlaybackFailure::Overdue(overdue)) => Err(Failure::Overdue(overdue)),
    }
}

/// The number of pixels whose bits differ. The sign of a zero and the bits of NaN are open.
fn differing(evaluated: &Texture, rendered: &Image) -> usize {
    let evaluated = evaluated.stack();
    let is_open = |a: f32, b: f32| a == b || a.is_nan() && b.is_nan();
    let differs = |(a, b): &(&[f32; 4], &[f32; 4])| !a.iter().zip(*b).all(|(&a, &b)| is_open(a, b));
    let pairs = evaluated.pixels().iter().zip(rendered.pixels());
    pairs.filter(differs).count()
}
