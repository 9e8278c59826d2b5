//! The frame in which the image of a project is checked, with what its other passes render in it.

use std::time::Duration;

use rayon::ThreadPool;
use toyproof_eval::{self as eval, Number};
use toyproof_glsl::Filter;
use toyproof_gpu::Worker;
use toyproof_image::{FRAME_RATE, Frame, Image, Texture};
use toyproof_player::{Clock, Source, Target};
use toyproof_project::PassKind;
use toyproof_translate::FloatMode;
use toyproof_verify::Failure;
use toyproof_verify::playback::{CpuPlayback, DevicePlayback, PassShader, PlaybackFailure};

use super::project::Passes;

/// The frame in which a project is checked if the user names none: a few frames of feedback.
pub(super) const CHECKED_FRAME: i32 = 7;

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
    pub(super) pass: PassKind,
    pub(super) frame: i32,
    pub(super) pixels: usize,
}

/// Binds what the image reads in this frame: the textures that do not change, and the buffers after all
/// passes of this frame and of those before it. A shader that is checked has them in f32, so that the checks
/// of its image find what this pass does wrong, not what earlier frames amplified; a reference has them in
/// f64. Returns the first difference of the driver's passes.
///
/// # Errors
/// Why the buffers cannot be rendered.
pub(super) fn bind<N: Number>(
    passes: &Passes,
    frame: &mut Frame,
    renderers: Renderers<'_>,
) -> Result<Option<PassDifference>, Failure> {
    let rendering = passes.rendering(PassKind::Image);
    let rendering = rendering.map_err(|error| Failure::Unrendered(error.to_string()))?;
    let shader = PassShader {
        checked: passes.checked_of(&rendering).collect(),
        graph: &rendering.graph,
        media: &rendering.media,
    };
    let (timeout, pool) = (renderers.timeout, renderers.pool);
    let programs = if has_history(passes) {
        let programs = || shader.programs(timeout);
        within(pool, programs).map_err(|(_, refusal)| eval::Failure::Refused(refusal))?
    } else {
        Vec::new()
    };
    let mut playback = CpuPlayback::<N>::new(&shader, &programs, None, timeout, None);
    let mut difference = None;
    if has_history(passes) {
        let rate = f64::from(FRAME_RATE);
        let clock = Clock {
            inputs: frame.clone(),
            rate,
            start: f64::from(frame.time) - f64::from(frame.frame) / rate,
        };
        let mut device = open(renderers, &shader)?;
        // The image of the last frame is compared with more care.
        let targets: Vec<Target> = rendering.graph.passes().iter().map(|pass| pass.target).collect();
        for number in 0..=frame.frame {
            let inputs = clock.frame(number);
            within(pool, || playback.render(&inputs)).map_err(|error| error.failure)?;
            let Some(device) = device.as_mut().filter(|_| difference.is_none()) else {
                continue;
            };
            let images = device.render(&inputs, &targets).map_err(Failure::Gpu)?;
            difference = images.iter().enumerate().find_map(|(at, image)| {
                let pixels = differing(playback.texture(targets[at])?, image);
                (pixels > 0).then(|| PassDifference {
                    pass: passes.project.passes[rendering.passes[at]].kind,
                    frame: number,
                    pixels,
                })
            });
        }
    }
    let image = rendering
        .graph
        .passes()
        .iter()
        .find(|pass| pass.target == Target::Image);
    let inputs = image.map_or([None; 4], |image| image.inputs);
    for (index, (channel, input)) in frame.channels.iter_mut().zip(inputs).enumerate() {
        let has_mipmaps = passes.image().sampling[index].filter == Filter::Mipmap;
        *channel = match (channel.take(), input) {
            (Some(given), _) if has_mipmaps => Some(given.with_mipmaps()),
            (Some(given), _) => Some(given),
            (None, None) => None,
            (None, Some(Source::Medium(number))) => rendering.media.get(number).cloned(),
            (None, Some(Source::Buffer(number))) => playback.texture(Target::Buffer(number)).cloned(),
        };
    }
    Ok(difference)
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
