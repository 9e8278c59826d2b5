//! Rendering of frames: tiles of pixels on all cores, a batch for each.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;
use thiserror::Error;
use toyproof_glsl::tree::Place;
use toyproof_image::{Frame, Image};

use crate::batch::Cancellation;
use crate::build::Refusal;
use crate::frame::{Framebuffer, UNDEFINED};
use crate::number::Number;
use crate::observe::Observations;
use crate::program::Program;
use crate::tile::FrameJob;

/// The treatment of operations that GLSL leaves undefined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UndefinedPolicy {
    /// Compute what strict GPU runs compute, and record each occurrence.
    Observed,
    /// Compute what strict GPU runs compute, without records.
    Plain,
    /// Substitute a different result: a pixel that is the same under all substitutes does not depend on
    /// undefined operations.
    Substitute(Substitute),
}

/// The result substituted for an undefined operation.
///
/// All are needed to find the dependencies: a number may be hidden by a multiplication with zero, and NaN by
/// comparisons, which are all false.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Substitute {
    /// A number.
    Number,
    /// NaN.
    NotANumber,
    /// What other implementations return for `pow`, which is the power of the absolute value, and zero for all
    /// other operations.
    OtherImplementation,
}

impl Substitute {
    /// All substitutes.
    pub const ALL: [Self; 3] = [Self::Number, Self::NotANumber, Self::OtherImplementation];
}

/// The settings for rendering a frame.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'a, N: Number> {
    /// The treatment of operations that GLSL leaves undefined.
    pub undefined: UndefinedPolicy,
    /// The seed of [`RandomRounding`](crate::RandomRounding); nothing for other number types.
    pub noise: N::Noise,
    /// The maximum number of loop iterations of a pixel, all loops together.
    pub max_iterations: u32,
    /// The time at which to give up.
    pub deadline: Option<Instant>,
    /// A flag that other threads set to interrupt the run.
    pub interrupt: Option<&'a AtomicBool>,
    /// The pixels that are needed, bottom row first; others may stay black. None means all.
    pub wanted: Option<&'a [bool]>,
    /// What executes the program. The result is the same.
    #[doc(hidden)]
    pub engine: Engine,
}

/// What executes a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[doc(hidden)]
pub enum Engine {
    /// Machine code for many pixels, handlers for few.
    #[default]
    Fastest,
    /// Handlers of instructions.
    Handlers,
    /// Machine code, where there is any.
    Native,
    /// Machine code for AVX2, although the processor may have AVX-512.
    Avx2,
}

impl<N: Number> Default for Settings<'_, N> {
    /// Records undefined operations, has no time limit, and allows more iterations than any reasonable shader
    /// runs.
    fn default() -> Self {
        Self {
            undefined: UndefinedPolicy::Observed,
            noise: N::Noise::default(),
            max_iterations: 1 << 26,
            deadline: None,
            interrupt: None,
            wanted: None,
            engine: Engine::Fastest,
        }
    }
}

/// Sample positions that are evaluated instead of the centers of all pixels: all pairs of these coordinates,
/// as in `fragCoord`. Neighbors at an even and the next odd index form a quad.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// x, from the left.
    pub columns: Vec<f64>,
    /// y, from the bottom up.
    pub rows: Vec<f64>,
}

impl Places {
    /// Returns the centers of pixels spread over a frame of this size, at most `most` columns and rows, in
    /// whole quads.
    #[must_use]
    pub fn spread(size: [u32; 2], most: [u32; 2]) -> Self {
        let along = |axis: usize| {
            let (length, most) = (size[axis], most[axis]);
            let pixels: Vec<u32> = if most >= length {
                (0..length).collect()
            } else {
                let pairs = (most / 2).max(1);
                let first = |pair| 2 * ((2 * pair + 1) * (length / 2) / (2 * pairs));
                (0..pairs)
                    .flat_map(|pair| [first(pair), first(pair) + 1])
                    .filter(|&at| at < length)
                    .collect()
            };
            pixels.into_iter().map(|at| f64::from(at) + 0.5).collect()
        };
        Self {
            columns: along(0),
            rows: along(1),
        }
    }

    /// Returns the columns and rows of the pixels that contain the positions.
    #[must_use]
    pub fn pixels(&self) -> [Vec<u32>; 2] {
        [&self.columns, &self.rows].map(|along| along.iter().map(|&at| at as u32).collect())
    }

    /// Returns width and height of the image that has a pixel for each position.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [&self.columns, &self.rows].map(|along| along.len() as u32)
    }

    /// Returns the positions moved by an offset in pixels.
    #[must_use]
    pub fn shifted(&self, [x, y]: [f64; 2]) -> Self {
        Self {
            columns: self.columns.iter().map(|column| column + x).collect(),
            rows: self.rows.iter().map(|row| row + y).collect(),
        }
    }
}

/// The reason why rendering failed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Failure {
    /// The shader cannot be compiled.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A pixel exceeded the limit of loop iterations.
    #[error("a pixel exceeded the limit of {limit} loop iterations")]
    TooOften {
        /// The limit.
        limit: u32,
        /// The loop that ran last.
        at: Place,
    },
    /// The deadline passed inside a loop.
    #[error("time limit exceeded inside a loop")]
    Timeout {
        /// The loop.
        at: Place,
    },
    /// The deadline passed between two parts of the image.
    #[error("time limit exceeded")]
    TimeUp,
    /// [`Settings::interrupt`] was set.
    #[error("interrupted")]
    Interrupted,
}

/// An image and the observations made while rendering it.
#[derive(Debug, Clone)]
pub struct Rendered<N> {
    /// The image.
    pub framebuffer: Framebuffer<N>,
    /// The observations.
    pub observations: Observations,
}

/// The limits of a run.
pub(crate) struct Limits<'a> {
    deadline: Option<Instant>,
    interrupt: Option<&'a AtomicBool>,
    /// Set by the first part that fails, so that the others end.
    failed: AtomicBool,
}

impl<'a> Limits<'a> {
    pub(crate) fn of<N: Number>(settings: &Settings<'a, N>) -> Self {
        Self {
            deadline: settings.deadline,
            interrupt: settings.interrupt,
            failed: AtomicBool::new(false),
        }
    }

    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    fn is_late(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }
}

impl Cancellation for Limits<'_> {
    fn is_cancelled(&self) -> bool {
        self.failed.load(Ordering::Relaxed) || self.is_interrupted() || self.is_late()
    }
}

/// A rendered image in f32, and its observations.
#[derive(Debug, Clone)]
pub struct RenderedF32 {
    /// The image, as the GPU's render target holds it.
    pub image: Image,
    /// Which pixels executed an operation that GLSL leaves undefined, bottom row first.
    pub undefined: Vec<bool>,
    /// The observations.
    pub observations: Observations,
}

/// The part of a frame that is evaluated.
pub enum Part<'a> {
    Rows(Range<u32>),
    Places(&'a Places),
}

impl Program {
    /// Renders a frame.
    ///
    /// # Errors
    /// If a limit is exceeded, or the shader is too large.
    pub fn render<N: Number>(
        &self,
        frame: &Frame,
        settings: &Settings<'_, N>,
    ) -> Result<Rendered<N>, Failure> {
        let mut framebuffer = Framebuffer::new(frame.size);
        let (pixels, flags) = framebuffer.parts_mut();
        let part = Part::Rows(frame.rows());
        let observations = N::fill(self, frame, part, settings, pixels, flags)?;
        Ok(Rendered {
            framebuffer,
            observations,
        })
    }

    /// Renders some rows of a frame, as of [`Frame::bands`], rounded to f32. Observations have positions in
    /// the frame; the image's coordinates are relative to the band.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_rows<N: Number>(
        &self,
        frame: &Frame,
        rows: Range<u32>,
        settings: &Settings<'_, N>,
    ) -> Result<RenderedF32, Failure> {
        let size = [frame.size[0], rows.len() as u32];
        let mut pixels = vec![[0.0; 4]; size[0] as usize * size[1] as usize];
        let mut flags = vec![0; pixels.len()];
        let part = Part::Rows(rows);
        let observations = N::fill_rounded(self, frame, part, settings, &mut pixels, &mut flags)?;
        Ok(RenderedF32 {
            image: Image::new(size[0], size[1], pixels),
            undefined: flags.into_iter().map(|flag| flag & UNDEFINED != 0).collect(),
            observations,
        })
    }

    /// Evaluates a frame at some positions only, rounded to f32: a pixel for each.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn at<N: Number>(
        &self,
        frame: &Frame,
        places: &Places,
        settings: &Settings<'_, N>,
    ) -> Result<Image, Failure> {
        let size = places.size();
        let mut pixels = vec![[0.0; 4]; size[0] as usize * size[1] as usize];
        let mut flags = vec![0; pixels.len()];
        if !pixels.is_empty() {
            let part = Part::Places(places);
            N::fill_rounded(self, frame, part, settings, &mut pixels, &mut flags)?;
        }
        Ok(Image::new(size[0], size[1], pixels))
    }

    /// Renders a part; `keep` converts the color and flags of each pixel to its stored value.
    pub(crate) fn fill<N: Number, P: Send>(
        &self,
        frame: &Frame,
        part: Part<'_>,
        settings: &Settings<'_, N>,
        pixels: &mut [P],
        flags: &mut [u8],
        keep: impl Fn([N; 4], u8) -> P + Sync,
    ) -> Result<Observations, Failure> {
        let compiled = self.code(settings.undefined)?;
        let prepared = N::prepare(compiled, frame);
        let limits = Limits::of(settings);
        let (size, start, places) = match part {
            Part::Rows(rows) => ([frame.size[0], rows.end], rows.start, None),
            Part::Places(places) => (places.size(), 0, Some(places)),
        };
        let job = FrameJob::new(compiled, &prepared, &frame.channels, &limits, settings, size).at(places);
        let failure = Mutex::new(None);
        let band = size[0] as usize * job.rows();
        let bands = pixels.par_chunks_mut(band).zip(flags.par_chunks_mut(band));
        let observed = bands.enumerate().map_init(
            || job.batch(),
            |batch, (tiles, (pixels, flags))| {
                let first = start + (tiles * job.rows()) as u32;
                let wanted = settings
                    .wanted
                    .map(|wanted| &wanted[tiles * band..][..pixels.len()]);
                let rendered = job.render_band(batch, first, (pixels, flags), wanted, &keep);
                rendered.unwrap_or_else(|error| {
                    limits.failed.store(true, Ordering::Relaxed);
                    failure
                        .lock()
                        .unwrap_or_else(PoisonError::into_inner)
                        .get_or_insert(error);
                    Observations::default()
                })
            },
        );
        let observations = observed.reduce(Observations::default, |mut all, part| {
            all.merge(&part);
            all
        });
        match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) => Err(error.failure(compiled, &limits, settings.max_iterations)),
            None => Ok(observations),
        }
    }
}
