//! Profiles: how often each part of a shader is executed in a frame, and with how many operations.

use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
use toyproof_image::Frame;

use crate::exec::counter::Counter;
use crate::exec::isel::FrameCode;
use crate::exec::limits::{BandError, Failure, Limits};
use crate::exec::settings::Settings;
use crate::exec::tile::FrameJob;
use crate::ir::{BasicBlock, Call, CallId, Origin, Part, PartId};
use crate::lower::LoweredCode;
use crate::program::Program;

/// The operations that a shader executes in the pixels of a frame, in float32.
///
/// An operation computes one component: an addition of two `vec3` is three operations. Elementary functions,
/// such as `sin`, count as the operations that compute them in strict images, and a lookup in a texture as those
/// of its filter and one for each component of a texel. What is counted is the program as it is written, before
/// any optimization; variables, and constants and what is computed from them alone, cost nothing.
#[derive(Debug, Clone)]
pub struct Profile<'a> {
    lowered: &'a LoweredCode,
    /// The number of pixels.
    pub pixels: u64,
    /// Of the rows and columns of tiles, every which one was run: 1 for all pixels of the image.
    pub step: u32,
    /// The largest number of operations of a pixel, and the first such pixel, row by row from the bottom.
    pub largest: (u64, [u32; 2]),
    /// The number of pixels that executed each block.
    executions: Vec<u64>,
}

impl Profile<'_> {
    fn blocks(&self) -> impl Iterator<Item = (&BasicBlock, u64)> {
        self.lowered
            .profile
            .blocks
            .iter()
            .zip(self.executions.iter().copied())
    }

    /// Returns the operations of all pixels together.
    #[must_use]
    pub fn operations(&self) -> u64 {
        self.blocks().map(|(block, count)| block.cost() * count).sum()
    }

    /// Returns where operations come from, and how often they were executed; the same origin may occur more
    /// than once, also with no execution.
    pub fn origins(&self) -> impl Iterator<Item = (Origin, u64)> {
        self.blocks().flat_map(|(block, count)| {
            block
                .operations
                .iter()
                .map(move |&(origin, operations)| (origin, operations * count))
        })
    }

    /// Returns the parts of the program, each with the number of its executions.
    #[must_use]
    pub fn parts(&self) -> Vec<(Part, u64)> {
        let mut parts: Vec<_> = self.lowered.profile.parts.iter().map(|&part| (part, 0)).collect();
        for (block, count) in self.blocks() {
            for &PartId(part) in &block.parts {
                parts[part as usize].1 += count;
            }
        }
        parts
    }

    /// Returns a call of a function.
    #[must_use]
    pub fn call(&self, id: CallId) -> Call {
        self.lowered.profile.calls[id.0 as usize]
    }

    /// Returns the number of components of texels that were read of each channel.
    #[must_use]
    pub fn texels(&self) -> [u64; 4] {
        self.blocks().fold([0; 4], |sum, (block, count)| {
            std::array::from_fn(|channel| sum[channel] + block.texels[channel] * count)
        })
    }
}

/// The number of tiles that are run to predict how long all would take.
const PREDICTION_TILES: u64 = 64;

/// The number of operations beyond which only some tiles are run: about ten seconds.
const MAX_OPERATIONS: u64 = 1 << 33;

impl Program {
    /// Counts the operations of a frame, in all of its pixels, or in a grid of tiles of it if there would be too
    /// many operations. Which tiles depends on the shader and the frame alone.
    ///
    /// # Errors
    /// If a limit is exceeded, or the shader is too large.
    pub fn profile(&self, frame: &Frame, settings: &Settings<'_, f32>) -> Result<Profile<'_>, Failure> {
        let lowered = self.counting()?;
        let code = FrameCode::select(lowered, frame);
        let limits = Limits::new(settings);
        let job = FrameJob::new(lowered, &code, &frame.channels, &limits, settings, frame.size);
        let costs: Vec<u64> = lowered.profile.blocks.iter().map(BasicBlock::cost).collect();
        let run = |step| {
            let counted = count(&job, &costs, step, &limits);
            counted.map_err(|error| error.failure(lowered, &limits, settings.max_iterations))
        };
        let pixels = u64::from(frame.size[0]) * u64::from(frame.size[1]);
        let tiles = pixels / (job.tile().into_iter().product::<usize>() as u64).max(1);
        let mut step = (tiles / PREDICTION_TILES).max(1).isqrt() as u32;
        let mut counts = run(step)?;
        if step > 1 {
            let sampled: u64 = counts
                .executions
                .iter()
                .zip(&costs)
                .map(|(count, cost)| count * cost)
                .sum();
            let predicted = sampled as f64 / counts.pixels.max(1) as f64 * pixels as f64;
            let needed = (predicted / MAX_OPERATIONS as f64).sqrt().ceil().max(1.0) as u32;
            if needed < step {
                step = needed;
                counts = run(step)?;
            }
        }
        Ok(Profile {
            lowered,
            pixels: counts.pixels,
            step,
            largest: counts.largest,
            executions: counts.executions,
        })
    }
}

/// What some tiles executed.
#[derive(Debug, Clone, Default)]
struct Counts {
    pixels: u64,
    largest: (u64, [u32; 2]),
    executions: Vec<u64>,
}

impl Counts {
    fn merge(mut self, other: Self) -> Self {
        self.pixels += other.pixels;
        // Of equal counts, the pixel further down.
        let key = |(count, [x, y]): (u64, [u32; 2])| (std::cmp::Reverse(count), y, x);
        self.largest = std::cmp::min_by_key(self.largest, other.largest, |&largest| key(largest));
        if self.executions.is_empty() {
            self.executions = other.executions;
        } else {
            for (count, more) in self.executions.iter_mut().zip(other.executions) {
                *count += more;
            }
        }
        self
    }
}

/// Counts the blocks of every `step`th tile of every `step`th row of tiles.
fn count(
    job: &FrameJob<'_, f32>,
    costs: &[u64],
    step: u32,
    limits: &Limits<'_>,
) -> Result<Counts, BandError> {
    let [width, height] = job.size();
    let [columns, rows] = job.tile().map(|side| side as u32);
    // In the middle of what each tile stands for.
    let corners = move |size: u32, side: u32| {
        let first = (step / 2).min((size - 1) / side) * side;
        (first..size).step_by((side * step) as usize)
    };
    let failure = Mutex::new(None);
    let bands: Vec<u32> = corners(height, rows).collect();
    let counted = bands.into_par_iter().map(|low| {
        let mut batch = job.batch();
        batch.counter = Some(Counter::new(costs, batch.width));
        let mut counts = Counts::default();
        for left in corners(width, columns) {
            let tile = job.count(&batch, [left, low], |operations, pixel| {
                counts.pixels += 1;
                if operations > counts.largest.0 || counts.pixels == 1 {
                    counts.largest = (operations, pixel);
                }
            });
            if let Err(error) = tile {
                limits.failed.store(true, Ordering::Relaxed);
                let mut failure = failure.lock().unwrap_or_else(PoisonError::into_inner);
                failure.get_or_insert(error);
                break;
            }
        }
        counts.executions = batch.counter.map_or_else(Vec::new, Counter::into_executions);
        counts
    });
    let counts = counted.reduce_with(Counts::merge).unwrap_or_default();
    match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        None => Ok(counts),
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;
    use crate::PartKind;
    use crate::ir::{Operation, cost};

    const TEXT: &str = "float f(float x) { return x * x + 1.0; }
float g(float x) { return -x; }
void mainImage(out vec4 c, in vec2 p) {
    float s = 0.0;
    for (int i = 0; i < 3; i++)
        s += f(p.x);
    if (p.x < 2.0)
        s = sin(s);
    else if (p.x > 9.0)
        s = g(s);
    c = vec4(s, p.x < 1.0 ? s * s : 0.0, 0, 1);
    if (p.x > 8.0 && p.x < 9.0) c.r = 1.0;
}";

    /// Calls `visit` with the profile of an image of this size, and a function that returns the line of a place.
    fn profiled(text: &str, size: [u32; 2], visit: impl FnOnce(&Profile, &dyn Fn(Origin) -> usize)) {
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        let checked = toyproof_glsl::check(&files, file, &Default::default()).unwrap();
        let program = Program::new(&checked).unwrap();
        let frame = Frame {
            size,
            ..Frame::default()
        };
        let profile = program.profile(&frame, &Settings::plain()).unwrap();
        visit(&profile, &|origin| files.position(origin.at.span).line);
    }

    #[test]
    fn operations_are_those_that_one_counts_by_hand() {
        profiled(TEXT, [4, 1], |profile, line| {
            let mut lines = [0; 13];
            for (origin, count) in profile.origins() {
                lines[line(origin)] += count;
            }
            let sin = cost(Operation::Sin);
            assert!(sin > 10);
            // In each of the four pixels: three calls with two operations, four comparisons and three
            // increments, three sums, one comparison; in two pixels `sin`, in the others a comparison; one more
            // comparison, and in one pixel a product; and a comparison.
            let expected = [
                0,
                4 * 3 * 2,
                0,
                0,
                0,
                4 * (4 + 3),
                4 * 3,
                4,
                2 * sin,
                2,
                0,
                4 + 1,
                4,
            ];
            assert_eq!(lines, expected);
            assert_eq!(profile.operations(), expected.iter().sum::<u64>());
            assert_eq!(profile.pixels, 4);
            assert_eq!(profile.step, 1);
            let first = 3 * 2 + 4 + 3 + 3 + 1 + sin + 2 + 1;
            assert_eq!(profile.largest, (first, [0, 0]));
        });
    }

    #[test]
    fn the_executions_of_parts_are_counted() {
        profiled(TEXT, [4, 1], |profile, _| {
            let parts = profile.parts();
            let of = |wanted: fn(PartKind) -> bool| {
                let parts = parts.iter().filter(|(part, _)| wanted(part.kind));
                parts.map(|(_, count)| *count).collect::<Vec<_>>()
            };
            assert_eq!(of(|kind| kind == PartKind::If), [2, 0, 0]);
            assert_eq!(of(|kind| kind == PartKind::Loop), [12]);
            assert_eq!(of(|kind| matches!(kind, PartKind::Function(_))), [4, 12, 0]);
            assert_eq!(of(|kind| kind == PartKind::Yes), [1]);
            assert_eq!(of(|kind| kind == PartKind::No), [3]);
            assert_eq!(of(|kind| kind == PartKind::Right), [0]);
        });
    }

    #[test]
    fn pixels_beyond_the_edge_are_not_counted() {
        let text = "void mainImage(out vec4 c, in vec2 p) { for (float i = 0.0; i < p.y; i++) c.r += 1.0; }";
        profiled(text, [19, 37], |profile, _| {
            // y = 0.5, 1.5, …: y + 1 iterations of two sums and a comparison, and a comparison.
            let column: u64 = (0..37).map(|y| (y + 1) * 3 + 1).sum();
            assert_eq!(profile.operations(), 19 * column);
            assert_eq!(profile.largest, (37 * 3 + 1, [0, 36]));
        });
    }
}
