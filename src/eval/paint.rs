//! Painting a frame: tiles of pixels on all cores, a batch for each.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;
use thiserror::Error;

use super::allocate::Home;
use super::batch::{Batch, FUEL, Here, LANES, Stop, Watch, middle, place};
use super::compile::Refusal;
use super::flow::Axis;
use super::handler::run;
use super::number::Number;
use super::observe::{MESA_CAP, Observations, Observed, Site, earlier};
use super::painting::{DISCARDED, Painting, UNDEFINED};
use super::program::{Prepared, Program};
use super::texture::Texture;
use crate::frame::Frame;
use crate::glsl::tree::Place;

/// How a frame is painted.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'a, N: Number> {
    /// Whether undefined operations are noted.
    pub observe: bool,
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
            observe: true,
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
struct Limits<'a> {
    deadline: Option<Instant>,
    interrupt: Option<&'a AtomicBool>,
    /// Set by the first part that fails, so that the others end.
    failed: AtomicBool,
}

impl Limits<'_> {
    fn is_interrupted(&self) -> bool {
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
        let compiled = self.code(settings.observe)?;
        let prepared = N::prepare(compiled, frame);
        let textures = frame.channels.each_ref().map(|image| image.as_ref().map(Texture));
        let limits = Limits {
            deadline: settings.deadline,
            interrupt: settings.interrupt,
            failed: AtomicBool::new(false),
        };
        let (floats, words) = prologue(&prepared, settings, &textures, &limits);
        let job = Job {
            prepared: &prepared,
            textures: &textures,
            limits: &limits,
            settings,
            floats,
            words,
            sites: &compiled.sites,
            size: frame.size,
        };
        let mut painting = Painting::new(frame.size);
        let failure = Mutex::new(None);
        let observations = {
            let (pixels, marks) = painting.parts_mut();
            let band = frame.size[0] as usize * job.tile()[1];
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
        match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(End::Late) => Err(if limits.is_interrupted() {
                Failure::Interrupted
            } else {
                Failure::TimeUp
            }),
            Some(End::Loop(stop)) => {
                let at = compiled.loop_at(stop.id);
                Err(if stop.too_often {
                    Failure::TooOften {
                        rounds: settings.rounds,
                        at,
                    }
                } else if limits.is_interrupted() {
                    Failure::Interrupted
                } else {
                    Failure::Timeout { at }
                })
            }
            None => {
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
    }
}

/// Why a band was not painted.
#[derive(Debug, Clone, Copy)]
enum End {
    Late,
    Loop(Stop),
}

/// The scalars that all batches begin with.
fn prologue<N: Number>(
    prepared: &Prepared<N>,
    settings: &Settings<'_, N>,
    textures: &[Option<Texture<'_>>; 4],
    limits: &Limits<'_>,
) -> (Vec<N>, Vec<u32>) {
    let batch = Batch {
        width: 0,
        floats: Vec::new(),
        words: Vec::new(),
        float_scalars: prepared.floats.iter().copied().map(Cell::new).collect(),
        word_scalars: prepared.words.iter().copied().map(Cell::new).collect(),
        masks: Vec::new(),
        here: Vec::new(),
        noise: settings.noise,
        textures,
        fuel: Cell::new(FUEL),
        stopped: Cell::new(None),
        watch: limits,
        limit: settings.rounds,
        rounds: Cell::new(0),
        own_rounds: Vec::new(),
        notes: RefCell::default(),
    };
    run(&batch, &prepared.prologue);
    let floats = batch.float_scalars.iter().map(Cell::get).collect();
    let words = batch.word_scalars.iter().map(Cell::get).collect();
    (floats, words)
}

struct Job<'a, N: Number> {
    prepared: &'a Prepared<N>,
    textures: &'a [Option<Texture<'a>>; 4],
    limits: &'a Limits<'a>,
    settings: &'a Settings<'a, N>,
    floats: Vec<N>,
    words: Vec<u32>,
    sites: &'a [Site],
    size: [u32; 2],
}

impl<N: Number> Job<'_, N> {
    /// Columns and rows of a tile: square where a batch is large.
    fn tile(&self) -> [usize; 2] {
        match self.prepared.width {
            1 => [LANES / 2, 2],
            width => [LANES, width],
        }
    }

    fn batch(&self) -> Batch<'_, N> {
        let prepared = self.prepared;
        let width = prepared.width;
        let mut here = vec![Here::default(); prepared.masks];
        here[0] = Here {
            chunks: u32::MAX >> (32 - width),
            all: true,
        };
        let mut masks = vec![[0; LANES]; prepared.masks * width];
        masks[..width].fill([u32::MAX; LANES]);
        Batch {
            width,
            floats: vec![Cell::new([N::default(); LANES]); prepared.float_rows * width],
            words: vec![Cell::new([0; LANES]); prepared.word_rows * width],
            float_scalars: self.floats.iter().copied().map(Cell::new).collect(),
            word_scalars: self.words.iter().copied().map(Cell::new).collect(),
            masks: masks.into_iter().map(Cell::new).collect(),
            here: here.into_iter().map(Cell::new).collect(),
            noise: self.settings.noise,
            textures: self.textures,
            fuel: Cell::new(FUEL),
            stopped: Cell::new(None),
            watch: self.limits,
            limit: self.settings.rounds,
            rounds: Cell::new(0),
            own_rounds: vec![Cell::new([0; LANES]); width],
            notes: RefCell::default(),
        }
    }

    /// Paints a row of tiles.
    fn band(
        &self,
        batch: &mut Batch<'_, N>,
        row: usize,
        pixels: &mut [[N; 3]],
        marks: &mut [u8],
    ) -> Result<Observations, End> {
        let [columns, rows] = self.tile();
        let mut observations = Observations::default();
        for left in (0..self.size[0]).step_by(columns) {
            if self.limits.is_over() {
                return Err(End::Late);
            }
            let corner = [left, (row * rows) as u32];
            self.begin(batch, corner);
            run(batch, &self.prepared.code);
            if let Some(stop) = batch.stopped.take() {
                return Err(End::Loop(stop));
            }
            self.end(batch, corner, pixels, marks, &mut observations);
        }
        Ok(observations)
    }

    /// Sets the coordinates of a tile.
    fn begin(&self, batch: &mut Batch<'_, N>, [left, low]: [u32; 2]) {
        let [columns, _] = self.tile();
        for (axis, row) in [Axis::X, Axis::Y].into_iter().zip(self.prepared.coordinates) {
            let Some(row) = row else {
                continue;
            };
            for (chunk, cell) in batch.float_row(row).iter().enumerate() {
                cell.set(std::array::from_fn(|lane| {
                    let (x, y) = place(chunk * LANES + lane, columns);
                    N::from_f64(middle(axis, (left + x, low + y)))
                }));
            }
        }
        batch.rounds.set(0);
        for rounds in &batch.own_rounds {
            rounds.set([0; LANES]);
        }
    }

    /// Keeps what a batch painted and noted, of the pixels that are in the picture.
    fn end(
        &self,
        batch: &Batch<'_, N>,
        [left, low]: [u32; 2],
        pixels: &mut [[N; 3]],
        marks: &mut [u8],
        observations: &mut Observations,
    ) {
        let [columns, _] = self.tile();
        let width = self.size[0] as usize;
        let at = |chunk: usize, lane: usize| {
            let (x, y) = place(chunk * LANES + lane, columns);
            let (x, y) = (left + x, low + y);
            (x < self.size[0] && y < self.size[1]).then_some([x, y])
        };
        let index = |[x, y]: [u32; 2]| (y - low) as usize * width + x as usize;
        for chunk in 0..batch.width {
            let colour = self.prepared.colour.map(|home| match home {
                Home::Row(row) => batch.float_row(row)[chunk].get(),
                Home::Scalar(scalar) => [batch.float_scalars[scalar as usize].get(); LANES],
            });
            let discarded = match self.prepared.discarded {
                Home::Row(row) => batch.word_row(row)[chunk].get(),
                Home::Scalar(scalar) => [batch.word_scalars[scalar as usize].get(); LANES],
            };
            let own_rounds = batch.own_rounds[chunk].get();
            for lane in 0..LANES {
                let Some(pixel) = at(chunk, lane) else {
                    continue;
                };
                pixels[index(pixel)] = colour.map(|component| component[lane]);
                if discarded[lane] != 0 {
                    marks[index(pixel)] |= DISCARDED;
                }
                let rounds = batch.rounds.get() + own_rounds[lane];
                observations.most_rounds = observations.most_rounds.max(rounds);
                observations.beyond_cap += u64::from(rounds > MESA_CAP);
            }
        }
        let sites = std::mem::take(&mut batch.notes.borrow_mut().sites);
        let mut noted = BTreeMap::new();
        for (id, chunks) in sites {
            let site = self.sites[id.0 as usize];
            for (chunk, bits) in chunks.into_iter().enumerate() {
                let lanes = (0..LANES).filter(|lane| bits >> lane & 1 != 0);
                for pixel in lanes.filter_map(|lane| at(chunk, lane)) {
                    if site.fault.is_undefined() {
                        marks[index(pixel)] |= UNDEFINED;
                    }
                    let fault = noted.entry(id).or_insert(Observed {
                        site,
                        pixels: 0,
                        first: pixel,
                    });
                    fault.pixels += 1;
                    fault.first = earlier(fault.first, pixel);
                }
            }
        }
        observations.merge(Observations {
            faults: noted.into_values().collect(),
            ..Observations::default()
        });
    }
}
