//! Painting a frame: tiles of pixels on all cores, a batch for each.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;
use thiserror::Error;
use toyproof_glsl::tree::Place;
use toyproof_image::{Frame, Image};

use crate::batch::Watch;
use crate::build::Refusal;
use crate::framebuffer::{Painting, UNDEFINED, shown};
use crate::number::Number;
use crate::observe::Observations;
use crate::program::Program;
use crate::texture::Texture;
use crate::tile::Job;

/// What is made of operations that GLSL leaves undefined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// What strict GPU runs make of them; and they are noted.
    Observed,
    /// The same without notes.
    Plain,
    /// Something else: a pixel that is painted the same whatever it is does not depend on them.
    Otherwise(Other),
}

/// What else may come of an operation that GLSL leaves undefined. It takes both to see what depends on it: a number may be hidden by zeros that it
/// is multiplied with, and NaN by comparisons, which are all false.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Other {
    /// A number.
    Number,
    /// NaN.
    NotANumber,
}

/// How a frame is painted.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'a, N: Number> {
    /// What is made of operations that GLSL leaves undefined.
    pub variant: Variant,
    /// What perturbs the arithmetic of [`Jittered`](crate::Jittered).
    pub noise: N::Noise,
    /// How many rounds of loops a pixel may run, all loops together.
    pub rounds: u32,
    /// When to give up.
    pub deadline: Option<Instant>,
    /// Set from elsewhere to give up.
    pub interrupt: Option<&'a AtomicBool>,
    /// Which of the painting's pixels are wanted, bottom row first; others may stay black. All, if none.
    pub wanted: Option<&'a [bool]>,
}

impl<N: Number> Default for Settings<'_, N> {
    /// Observes, without limits of time; as many rounds as no sane shader runs.
    fn default() -> Self {
        Self {
            variant: Variant::Observed,
            noise: N::Noise::default(),
            rounds: 1 << 26,
            deadline: None,
            interrupt: None,
            wanted: None,
        }
    }
}

/// The places of a frame that are evaluated instead of the middles of all its pixels: all pairs of these coordinates, as `fragCoord` has
/// them. Neighbors at an even and the next odd number make a quad.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// x, from the left.
    pub columns: Vec<f64>,
    /// y, from the bottom up.
    pub rows: Vec<f64>,
}

impl Places {
    /// The middles of pixels from all over a frame of that size, so many columns and rows of them at most, in whole quads.
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

    /// The pixels that these places lie in: their columns and rows.
    #[must_use]
    pub fn pixels(&self) -> [Vec<u32>; 2] {
        [&self.columns, &self.rows].map(|along| along.iter().map(|&at| at as u32).collect())
    }

    /// Width and height of the picture that has a pixel for each place.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [&self.columns, &self.rows].map(|along| along.len() as u32)
    }

    /// The same places, moved.
    #[must_use]
    pub fn shifted(&self, [x, y]: [f64; 2]) -> Self {
        Self {
            columns: self.columns.iter().map(|column| column + x).collect(),
            rows: self.rows.iter().map(|row| row + y).collect(),
        }
    }
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Failure {
    /// The shader is too large.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A pixel ran more rounds of loops than it may.
    #[error("a pixel ran more than {rounds} rounds of loops")]
    TooOften {
        /// The limit.
        rounds: u32,
        /// The loop that ran last.
        at: Place,
    },
    /// The deadline passed in a loop.
    #[error("the time is up, and a loop still runs")]
    Timeout {
        /// The loop.
        at: Place,
    },
    /// The deadline passed between two parts of the picture.
    #[error("the time is up")]
    TimeUp,
    /// Somebody set [`Settings::interrupt`].
    #[error("interrupted")]
    Interrupted,
}

/// A picture and what was noted while it was painted.
#[derive(Debug, Clone)]
pub struct Painted<N> {
    /// The picture.
    pub painting: Painting<N>,
    /// What was noted.
    pub observations: Observations,
}

/// Whether to go on.
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

impl Watch for Limits<'_> {
    fn is_over(&self) -> bool {
        self.failed.load(Ordering::Relaxed) || self.is_interrupted() || self.is_late()
    }
}

/// The same in f32, where no more is wanted.
#[derive(Debug, Clone)]
pub struct Pictured {
    /// The picture, as the GPU's target holds it.
    pub image: Image,
    /// Which pixels met an operation that GLSL leaves undefined, bottom row first.
    pub undefined: Vec<bool>,
    /// What was noted.
    pub observations: Observations,
}

/// What of a frame is evaluated.
enum Part<'a> {
    Rows(Range<u32>),
    Places(&'a Places),
}

impl Program {
    /// Paints a frame.
    ///
    /// # Errors
    /// Why there is no picture: limits, or a shader that is too large.
    pub fn paint<N: Number>(&self, frame: &Frame, settings: &Settings<'_, N>) -> Result<Painted<N>, Failure> {
        let mut painting = Painting::new(frame.size);
        let (pixels, marks) = painting.parts_mut();
        let part = Part::Rows(frame.rows());
        let observations = self.fill(frame, part, settings, pixels, marks, |colour, _| colour)?;
        Ok(Painted {
            painting,
            observations,
        })
    }

    /// Paints some rows of a frame, as of [`Frame::bands`], rounded to f32. What is noted tells of places in the frame; the picture's
    /// own are in the band.
    ///
    /// # Errors
    /// As [`Self::paint`].
    pub fn picture<N: Number>(
        &self,
        frame: &Frame,
        rows: Range<u32>,
        settings: &Settings<'_, N>,
    ) -> Result<Pictured, Failure> {
        let size = [frame.size[0], rows.len() as u32];
        let mut pixels = vec![[0.0; 4]; size[0] as usize * size[1] as usize];
        let mut marks = vec![0; pixels.len()];
        let observations = self.fill(frame, Part::Rows(rows), settings, &mut pixels, &mut marks, shown)?;
        Ok(Pictured {
            image: Image::new(size[0], size[1], pixels),
            undefined: marks.into_iter().map(|mark| mark & UNDEFINED != 0).collect(),
            observations,
        })
    }

    /// Evaluates a frame at some places only, rounded to f32: a pixel for each.
    ///
    /// # Errors
    /// As [`Self::paint`].
    pub fn at<N: Number>(
        &self,
        frame: &Frame,
        places: &Places,
        settings: &Settings<'_, N>,
    ) -> Result<Image, Failure> {
        let size = places.size();
        let mut pixels = vec![[0.0; 4]; size[0] as usize * size[1] as usize];
        let mut marks = vec![0; pixels.len()];
        if !pixels.is_empty() {
            self.fill(
                frame,
                Part::Places(places),
                settings,
                &mut pixels,
                &mut marks,
                shown,
            )?;
        }
        Ok(Image::new(size[0], size[1], pixels))
    }

    /// Paints a part, of whose pixels what `keep` makes of colours and marks is kept.
    fn fill<N: Number, P: Send>(
        &self,
        frame: &Frame,
        part: Part<'_>,
        settings: &Settings<'_, N>,
        pixels: &mut [P],
        marks: &mut [u8],
        keep: impl Fn([N; 3], u8) -> P + Sync,
    ) -> Result<Observations, Failure> {
        let compiled = self.code(settings.variant)?;
        let prepared = N::prepare(compiled, frame);
        let textures = frame.channels.each_ref().map(|image| image.as_ref().map(Texture));
        let limits = Limits::of(settings);
        let (size, start, places) = match part {
            Part::Rows(rows) => ([frame.size[0], rows.end], rows.start, None),
            Part::Places(places) => (places.size(), 0, Some(places)),
        };
        let job = Job::new(compiled, &prepared, &textures, &limits, settings, size).at(places);
        let failure = Mutex::new(None);
        let band = size[0] as usize * job.rows();
        let bands = pixels.par_chunks_mut(band).zip(marks.par_chunks_mut(band));
        let noted = bands.enumerate().map_init(
            || (job.batch(), vec![[N::default(); 3]; band]),
            |(batch, colours), (tiles, (pixels, marks))| {
                let first = start + (tiles * job.rows()) as u32;
                let wanted = settings
                    .wanted
                    .map(|wanted| &wanted[tiles * band..][..pixels.len()]);
                let colours = &mut colours[..pixels.len()];
                match job.band(batch, first, (colours, marks), wanted) {
                    Ok(observations) => {
                        for ((pixel, &colour), &mark) in pixels.iter_mut().zip(&*colours).zip(&*marks) {
                            *pixel = keep(colour, mark);
                        }
                        observations
                    }
                    Err(why) => {
                        limits.failed.store(true, Ordering::Relaxed);
                        failure
                            .lock()
                            .unwrap_or_else(PoisonError::into_inner)
                            .get_or_insert(why);
                        Observations::default()
                    }
                }
            },
        );
        let observations = noted.reduce(Observations::default, |mut all, part| {
            all.merge(&part);
            all
        });
        match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(end) => Err(end.failure(compiled, &limits, settings.rounds)),
            None => Ok(observations),
        }
    }
}
