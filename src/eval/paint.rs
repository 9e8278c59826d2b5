//! Painting a frame: tiles of pixels on all cores, a batch for each.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;
use thiserror::Error;

use super::batch::Watch;
use super::compile::Refusal;
use super::number::Number;
use super::observe::Observations;
use super::painting::Painting;
use super::program::Program;
use super::texture::Texture;
use super::tile::Job;
use crate::frame::Frame;
use crate::glsl::tree::Place;

/// What is made of operations that GLSL leaves undefined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// What strict GPU runs make of them; and they are noted.
    Observed,
    /// The same without notes.
    Plain,
    /// Something else: a pixel that is painted the same does not depend on them.
    Otherwise,
}

/// How a frame is painted.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'a, N: Number> {
    /// What is made of operations that GLSL leaves undefined.
    pub variant: Variant,
    /// What perturbs the arithmetic of [`Jittered`](super::Jittered).
    pub noise: N::Noise,
    /// How many rounds of loops a pixel may run, all loops together.
    pub rounds: u32,
    /// When to give up.
    pub deadline: Option<Instant>,
    /// Set from elsewhere to give up.
    pub interrupt: Option<&'a AtomicBool>,
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
pub(super) struct Limits<'a> {
    deadline: Option<Instant>,
    interrupt: Option<&'a AtomicBool>,
    /// Set by the first part that fails, so that the others end.
    failed: AtomicBool,
}

impl<'a> Limits<'a> {
    pub(super) fn of<N: Number>(settings: &Settings<'a, N>) -> Self {
        Self {
            deadline: settings.deadline,
            interrupt: settings.interrupt,
            failed: AtomicBool::new(false),
        }
    }

    pub(super) fn is_interrupted(&self) -> bool {
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

impl Program {
    /// Paints a frame.
    ///
    /// # Errors
    /// Why there is no picture: limits, or a shader that is too large.
    pub fn paint<N: Number>(&self, frame: &Frame, settings: &Settings<'_, N>) -> Result<Painted<N>, Failure> {
        let compiled = self.code(settings.variant)?;
        let prepared = N::prepare(compiled, frame);
        let textures = frame.channels.each_ref().map(|image| image.as_ref().map(Texture));
        let limits = Limits::of(settings);
        let job = Job::new(compiled, &prepared, &textures, &limits, settings, frame.size);
        let mut painting = Painting::new(frame.size);
        let failure = Mutex::new(None);
        let observations = {
            let (pixels, marks) = painting.parts_mut();
            let band = frame.size[0] as usize * job.rows();
            let bands = pixels
                .par_chunks_mut(band)
                .zip(marks.par_chunks_mut(band))
                .enumerate();
            let noted = bands.map_init(
                || job.batch(),
                |batch, (row, (pixels, marks))| match job.band(batch, row, pixels, marks) {
                    Ok(observations) => observations,
                    Err(why) => {
                        limits.failed.store(true, Ordering::Relaxed);
                        failure
                            .lock()
                            .unwrap_or_else(PoisonError::into_inner)
                            .get_or_insert(why);
                        Observations::default()
                    }
                },
            );
            noted.reduce(Observations::default, |mut all, part| {
                all.merge(part);
                all
            })
        };
        if let Some(end) = failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(end.failure(compiled, &limits, settings.rounds));
        }
        let mut observations = observations;
        observations
            .faults
            .sort_by_key(|fault| (fault.site.at.span.start, fault.site.fault));
        Ok(Painted {
            painting,
            observations,
        })
    }
}
