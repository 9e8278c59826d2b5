//! Rounding errors over the frames of a shader whose passes read earlier frames.
//!
//! Float32 and double precision each render all frames, with their own buffers. Where their images differ
//! visibly in the end, the frames are rendered again to find out why: because one frame of float32 is
//! imprecise, because the shader is chaotic, or because small errors add up.

use toyproof_diagnostic::Code;
use toyproof_diagnostic::{Diagnostic, grouped, plural};
use toyproof_eval::{Number, PassFailure, RandomRounding, Seed, Settings};
use toyproof_image::{Frame, Texture};
use toyproof_player::{BUFFERS, Target};

use crate::bounds::explanation_deadline;
use crate::compare::{CheckSummary, SEEN, Share, precision};
use crate::failure::Failure;
use crate::limits::MAX_UNSTABLE;
use crate::loss;
use crate::pool::within;
use crate::project::buffers::BufferLints;
use crate::project::frames::Frames;
use crate::project::playback::CpuPlayback;

/// The state after the last frame, and what was found in all frames.
#[derive(Debug)]
pub struct History<'a> {
    /// In float32.
    pub single: CpuPlayback<'a, f32>,
    /// In double precision from the first frame on.
    pub double: CpuPlayback<'a, f64>,
    /// The difference of the two.
    pub growth: Growth,
    /// Warnings about the buffers.
    pub notes: Vec<Diagnostic>,
}

/// The difference between float32 and double precision, each from the first frame on.
#[derive(Debug, Clone, PartialEq)]
pub struct Growth {
    /// The images of all frames, from frame 0 on.
    pub frames: Vec<FrameError>,
    /// The first frame in which more than [`MAX_UNSTABLE`] of the pixels differ visibly.
    pub first_visible: Option<i32>,
    /// Why more than [`MAX_UNSTABLE`] of the pixels of the last frame differ visibly, if they do.
    pub visible: Option<VisibleGrowth>,
}

/// The difference of two images of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameError {
    /// The largest absolute difference of a component of colors clamped to [0, 1].
    pub max_abs: f64,
    /// The pixels that differ visibly.
    pub differing: Share,
    /// The pixel with the largest difference; `None` if no pixel differs visibly.
    pub worst: Option<[u32; 2]>,
}

/// A difference that is visible in the last frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleGrowth {
    /// The pixels of the last frame that differ visibly.
    pub differing: Share,
    /// The pixel with the largest difference.
    pub worst: [u32; 2],
    /// The first frame in which as many pixels differ visibly.
    pub since: i32,
    /// Why.
    pub cause: GrowthCause,
}

/// Why a visible difference arises over frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GrowthCause {
    /// A pass renders a visible difference in one frame, from the same buffers of the frame before.
    Step {
        /// The pass.
        target: Target,
        /// The frame.
        frame: i32,
        /// The pixels of the pass that differ.
        differing: Share,
    },
    /// Errors grow exponentially, and those of double precision as fast as those of float32.
    Chaos {
        /// The number of frames in which errors double, from the frame n to 2n between which they grow most.
        doubling: f64,
        /// Whether the last frame also differs visibly in double precision if its roundings are perturbed.
        in_double: bool,
    },
    /// Errors add up, or decide a comparison.
    Accumulation,
}

impl VisibleGrowth {
    /// The cause in a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let Share { count, of } = self.differing;
        let difference = format!(
            "{} of {} pixels {} between float32 and double precision ({:.1} %)",
            grouped(count),
            grouped(of),
            plural(count, "differs", "differ"),
            100.0 * self.differing.ratio()
        );
        match self.cause {
            GrowthCause::Step {
                target,
                frame,
                differing,
            } => format!(
                "{difference}: {target} does so in frame {frame} already, in {:.1} % of its pixels",
                100.0 * differing.ratio()
            ),
            GrowthCause::Chaos { doubling, .. } => {
                format!("{difference}: rounding errors double every {doubling:.1} frames")
            }
            GrowthCause::Accumulation => format!("{difference}: rounding errors add up over the frames"),
        }
    }

    /// The conclusions, in sentences.
    #[must_use]
    pub fn consequences(&self) -> Vec<String> {
        let mut sentences = vec![format!("the difference is visible from frame {} on", self.since)];
        if matches!(self.cause, GrowthCause::Chaos { .. }) {
            sentences.push(
                "the shader is chaotic: no precision prevents it, and GPUs that round differently render other images"
                    .to_owned(),
            );
        }
        sentences
    }

    fn diagnostic(&self) -> Diagnostic {
        let warning = Diagnostic::new(Code::VisibleGrowth, self.sentence());
        let [x, y] = self.worst;
        let hint =
            format!("`toyproof debug` with `--pixel {x},{y}` follows the difference back to where it arises");
        let warning = self.consequences().into_iter().fold(warning, Diagnostic::note);
        warning.note(hint)
    }
}

/// Renders all frames in float32 and in double precision. Calls `each` after each frame of float32.
///
/// # Errors
/// Why a frame cannot be rendered, or the error of `each`.
pub fn follow<'a>(
    frames: &Frames<'a>,
    mut each: impl FnMut(&Frame, &CpuPlayback<f32>) -> Result<(), Failure> + Send,
) -> Result<History<'a>, Failure> {
    within(frames.pool, || {
        let mut single = frames.start::<f32>((), frames.timeout);
        let mut double = frames.start::<f64>((), frames.long_timeout());
        let mut errors = Vec::new();
        let mut lints = BufferLints::new(frames.shader);
        for number in 0..=frames.last {
            let inputs = frames.clock.frame(number);
            single.render(&inputs).map_err(failure)?;
            each(&inputs, &single)?;
            double.render(&inputs).map_err(failure)?;
            lints.observe(&inputs, &single);
            errors.extend(image_error(&double, &single));
        }
        let is_visible = |error: &FrameError| error.differing.ratio() > MAX_UNSTABLE;
        let first_visible = (0..).zip(&errors).find(|(_, error)| is_visible(error));
        let first_visible = first_visible.map(|(number, _)| number);
        let mut notes = lints.diagnostics(frames);
        let mut visible = None;
        if let (Some(since), Some(last)) = (first_visible, errors.last().filter(|last| is_visible(last))) {
            let cause = match find_step(frames, since)? {
                Some((step, note)) => {
                    notes.extend(note);
                    step
                }
                None => classify(frames, distance(&double, &single, f64::INFINITY))?,
            };
            let growth = VisibleGrowth {
                differing: last.differing,
                worst: last.worst.unwrap_or_default(),
                since,
                cause,
            };
            notes.push(growth.diagnostic());
            visible = Some(growth);
        }
        let growth = Growth {
            frames: errors,
            first_visible,
            visible,
        };
        Ok(History {
            single,
            double,
            growth,
            notes,
        })
    })
}

fn failure(failure: PassFailure) -> Failure {
    failure.failure.into()
}

/// Compares the images of two playbacks, `expected` and `actual`.
fn image_error<A: Number, B: Number>(
    expected: &CpuPlayback<A>,
    actual: &CpuPlayback<B>,
) -> Option<FrameError> {
    let image = |texture: &Texture| texture.stack();
    let expected = image(expected.texture(Target::Image)?);
    let actual = image(actual.texture(Target::Image)?);
    let statuses = precision(&expected, &actual, &vec![false; expected.pixels().len()]);
    let summary = CheckSummary::new(&expected, &actual, &statuses);
    Some(FrameError {
        max_abs: summary.max_abs,
        differing: Share::differing(&summary),
        worst: summary.worst.map(|pixel| [pixel.x, pixel.y]),
    })
}

/// Searches the frames up to the first visible difference for a pass that renders a visible difference from
/// the same buffers of the frame before. Also returns the line in which it arises.
fn find_step(frames: &Frames, until: i32) -> Result<Option<(GrowthCause, Option<Diagnostic>)>, Failure> {
    let mut single = frames.start::<f32>((), frames.long_timeout());
    for number in 0..=until {
        let before = (number > 0).then(|| single.state(number - 1));
        let (shader, timeout) = (frames.shader, frames.long_timeout());
        let mut step = CpuPlayback::<f64>::new(
            shader,
            frames.programs,
            before.as_ref(),
            timeout,
            Settings::plain(),
        );
        let inputs = frames.clock.frame(number);
        single.render(&inputs).map_err(failure)?;
        step.render(&inputs).map_err(failure)?;
        for (pass, rendered) in frames.shader.graph.passes().iter().enumerate() {
            let target = rendered.target;
            let textures = step.texture(target).zip(single.texture(target));
            let Some(differing) = textures.map(|(double, single)| differing_texels(double, single)) else {
                continue;
            };
            let share = Share {
                count: differing.len() as u64,
                of: frames.shader.graph.texels(target, inputs.size),
            };
            if share.ratio() > MAX_UNSTABLE {
                let bound = single.bound(pass, &inputs);
                let deadline = explanation_deadline(0.0);
                let cause = loss::lost_digits(&frames.programs[pass], &bound, &differing, deadline);
                let step = GrowthCause::Step {
                    target,
                    frame: number,
                    differing: share,
                };
                return Ok(Some((step, cause)));
            }
        }
    }
    Ok(None)
}

/// The texels of a pass that differ visibly between float32 and double precision, as if it were shown: the
/// data of a buffer that is larger than 1 is compared by its relative difference.
fn differing_texels(double: &Texture, single: &Texture) -> Vec<[u32; 2]> {
    let width = double.size()[0];
    let differs = |(&expected, &actual): (&f64, &f64)| {
        // Equal infinities and two NaN agree.
        let is_same = expected == actual || expected.is_nan() && actual.is_nan();
        let is_near = (expected - actual).abs() <= SEEN * expected.abs().max(1.0);
        !is_same && !is_near
    };
    let [expected, actual] = [double, single].map(texels);
    let texels = (0..).zip(expected.iter().zip(&actual));
    texels
        .filter(|(_, (expected, actual))| expected.iter().zip(*actual).any(differs))
        .map(|(at, _): (u32, _)| [at % width, at / width])
        .collect()
}

/// The amplification of an error from a frame to the frame with twice its number above which growth is
/// exponential: errors that add up grow linearly, or with the square of the number of frames in a sum of
/// sums.
const EXPONENTIAL: f64 = 16.0;

/// A difference of double precision beyond which growth is not measured: where `fract` or a comparison
/// decides differently, an error jumps, whatever its cause.
const JUMP: f64 = 1.0 / 1024.0;

/// The ratio of the errors of float32 and of double precision where both are amplified equally: that of their
/// units in the last place.
const UNIT_RATIO: f64 = (1_u64 << (f64::MANTISSA_DIGITS - f32::MANTISSA_DIGITS)) as f64;

/// How much smaller the error of double precision may be for that: a rounding that is exact in one of the two
/// types gives the other a lead of a few doublings.
const UNIT_RATIO_SLACK: f64 = 16.0;

/// Whether double precision with perturbed roundings departs from double precision as float32 does, whose
/// distance in the last frame is `single_distance`.
fn classify(frames: &Frames, single_distance: f64) -> Result<GrowthCause, Failure> {
    let timeout = frames.long_timeout();
    let mut double = frames.start::<f64>((), timeout);
    let mut perturbed = frames.start::<RandomRounding>(Seed::double(1), timeout);
    let mut distances = Vec::new();
    for number in 0..=frames.last {
        let inputs = frames.clock.frame(number);
        double.render(&inputs).map_err(failure)?;
        perturbed.render(&inputs).map_err(failure)?;
        distances.push(distance(&double, &perturbed, JUMP));
    }
    let last = distance(&double, &perturbed, f64::INFINITY);
    let is_amplified_alike = last * UNIT_RATIO * UNIT_RATIO_SLACK >= single_distance;
    Ok(match doubling(&distances) {
        Some(doubling) if is_amplified_alike => {
            let error = image_error(&double, &perturbed);
            let in_double = error.is_some_and(|error| error.differing.ratio() > MAX_UNSTABLE);
            GrowthCause::Chaos { doubling, in_double }
        }
        _ => GrowthCause::Accumulation,
    })
}

/// The number of frames in which errors double, from the frame n to 2n between which they grow most; `None`
/// if they do not grow exponentially. The distance of each frame is given. Growth must last from n to 4n: the
/// error of a value that all texels read may be zero by chance until one frame, and ordinary in the next.
fn doubling(distances: &[f64]) -> Option<f64> {
    let amplification = |frame: usize| distances[2 * frame] / distances[frame];
    let is_exponential = |frame: usize| (EXPONENTIAL..f64::INFINITY).contains(&amplification(frame));
    let starts = 1..=distances.len().saturating_sub(1) / 4;
    let lasting = starts.filter(|&start| is_exponential(start) && is_exponential(2 * start));
    let frames = lasting.flat_map(|start| [start, 2 * start]);
    let fastest = frames.max_by(|&a, &b| amplification(a).total_cmp(&amplification(b)))?;
    Some(fastest as f64 / amplification(fastest).log2())
}

/// The root mean square difference of the texels of two playbacks, relative to those larger than 1, in the
/// pass in which it is largest. Differences above `most` are left out.
fn distance<A: Number, B: Number>(expected: &CpuPlayback<A>, actual: &CpuPlayback<B>, most: f64) -> f64 {
    let targets = (0..BUFFERS).map(Target::Buffer).chain([Target::Image]);
    let of_target = |target| {
        let [expected, actual] = [expected.texture(target)?, actual.texture(target)?].map(texels);
        let pairs = expected.as_flattened().iter().zip(actual.as_flattened());
        let squares = pairs.map(|(expected, actual)| {
            let difference = (expected - actual) / expected.abs().max(1.0);
            if difference.is_finite() && difference.abs() <= most {
                difference * difference
            } else {
                0.0
            }
        });
        Some((squares.sum::<f64>() / (4 * expected.len()).max(1) as f64).sqrt())
    };
    targets.filter_map(of_target).fold(0.0, f64::max)
}

/// The texels of the whole image in f64.
fn texels(texture: &Texture) -> Vec<[f64; 4]> {
    let [width, height] = texture.stack_size();
    let rows = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    rows.map(|at| texture.texel(at)).collect()
}

#[cfg(test)]
mod tests {
    fn distances(distance: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..=60).map(|frame| distance(f64::from(frame))).collect()
    }

    #[test]
    fn exponential_growth_is_told_from_sums() {
        for doubling in [0.5, 1.0, 2.5] {
            let found = super::doubling(&distances(|frame| (2e-16 * (frame / doubling).exp2()).min(1e-3)));
            // The frames between which errors grow most include one in which they no longer can.
            let ratio = found.unwrap() / doubling;
            assert!((1.0 - 1e-9..1.1).contains(&ratio), "{doubling}: {found:?}");
        }
        let sums = [
            distances(|_| 0.0),
            distances(|frame| 1e-16 * frame.sqrt()),
            distances(|frame| 1e-16 * frame),
            distances(|frame| 1e-16 * frame * frame),
            // A shared value happens to be exact until frame 3, and a texel wraps around in frame 20.
            distances(|frame| if frame < 4.0 { 1e-17 } else { 1e-12 * frame }),
            distances(|frame| if frame < 20.0 { 1e-16 * frame } else { 1e-5 }),
        ];
        for (number, sum) in sums.iter().enumerate() {
            assert_eq!(super::doubling(sum), None, "{number}");
        }
    }
}
