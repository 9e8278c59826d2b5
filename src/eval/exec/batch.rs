//! The execution state of a batch of pixels: rows of components, scalars, and masks.

use std::cell::{Cell, RefCell};

use toyproof_image::Texture;

use crate::exec::counter::Counter;
use crate::exec::lanes::{Chunk, LANES, Lanes, any, chunks};
use crate::exec::number::Arithmetic;
use crate::exec::observe::Notes;
use crate::exec::recorder::Recorder;
use crate::exec::settings::Settings;

/// Summary of a mask: a bit for each chunk of [`LANES`] pixels that has an active pixel, and whether all
/// pixels are active.
///
/// Lanes of the mask in chunks whose bit is clear are unspecified.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(C)]
#[doc(hidden)]
pub struct Active {
    pub chunks: u32,
    pub all: bool,
}

/// Registers and masks. They are `Cell`s because instructions read and write them by index.
pub(crate) struct Batch<'a, N: Arithmetic> {
    /// The number of chunks in a row.
    pub(crate) width: usize,
    pub(crate) floats: Vec<Chunk<N>>,
    pub(crate) words: Vec<Chunk<u32>>,
    pub(crate) float_scalars: Vec<Cell<N>>,
    pub(crate) word_scalars: Vec<Cell<u32>>,
    /// All bits set where the pixel is active.
    pub(crate) masks: Vec<Chunk<u32>>,
    pub(crate) active: Vec<Cell<Active>>,
    pub(crate) noise: N::Noise,
    pub(crate) textures: &'a [Option<Texture>; 4],
    /// Loop iterations left until the limits are checked again.
    pub(crate) fuel: Cell<u32>,
    pub(crate) stopped: Cell<Option<Stop>>,
    pub(crate) cancellation: &'a dyn Cancellation,
    /// The maximum number of loop iterations of a pixel.
    pub(crate) iteration_limit: u32,
    /// Loop iterations executed by all pixels together.
    pub(crate) iterations: Cell<u32>,
    /// Additional loop iterations of each pixel.
    pub(crate) own_iterations: Vec<Chunk<u32>>,
    pub(crate) notes: RefCell<Notes>,
    /// The recorder of one pixel's execution, if a trace was requested.
    pub(crate) recorder: Option<Recorder<'a>>,
    /// What counts the executions of basic blocks, if a profile was requested.
    pub(crate) counter: Option<Counter<'a>>,
}

/// The reason why a batch ended early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stop {
    /// The loop that was running.
    pub(crate) id: u32,
    /// Whether the iteration limit was exceeded, rather than the time limit.
    pub(crate) over_limit: bool,
}

/// A source of cancellation requests.
pub(crate) trait Cancellation: Sync {
    /// Whether the run must stop.
    fn is_cancelled(&self) -> bool;
}

/// The number of loop iterations between two checks of the limits.
pub(crate) const FUEL_ITERATIONS: u32 = 1 << 12;

impl<'a, N: Arithmetic> Batch<'a, N> {
    /// Creates a batch with these numbers of rows of floats and of words and these scalars, without masks.
    pub(crate) fn new(
        width: usize,
        [float_rows, word_rows]: [usize; 2],
        (floats, words): (&[N], &[u32]),
        settings: &Settings<'_, N>,
        textures: &'a [Option<Texture>; 4],
        cancellation: &'a dyn Cancellation,
    ) -> Self {
        Self {
            width,
            floats: chunks([N::default(); LANES], float_rows * width),
            words: chunks([0; LANES], word_rows * width),
            float_scalars: floats.iter().copied().map(Cell::new).collect(),
            word_scalars: words.iter().copied().map(Cell::new).collect(),
            masks: Vec::new(),
            active: Vec::new(),
            noise: settings.noise,
            textures,
            fuel: Cell::new(FUEL_ITERATIONS),
            stopped: Cell::new(None),
            cancellation,
            iteration_limit: settings.max_iterations,
            iterations: Cell::new(0),
            own_iterations: chunks([0; LANES], width),
            notes: RefCell::default(),
            recorder: None,
            counter: None,
        }
    }

    /// Returns a row of floats.
    #[inline(always)]
    pub(crate) fn float_row(&self, first: u32) -> &[Chunk<N>] {
        &self.floats[first as usize..][..self.width]
    }

    /// Returns a row of words.
    #[inline(always)]
    pub(crate) fn word_row(&self, first: u32) -> &[Chunk<u32>] {
        &self.words[first as usize..][..self.width]
    }

    /// Returns the lanes of a mask.
    #[inline(always)]
    pub(crate) fn mask_row(&self, mask: u32) -> &[Chunk<u32>] {
        &self.masks[mask as usize * self.width..][..self.width]
    }

    /// Returns the largest number of loop iterations of any pixel.
    pub(crate) fn max_iterations(&self) -> u32 {
        let own = self.own_iterations.iter().flat_map(Chunk::get);
        self.iterations.get() + own.max().unwrap_or(0)
    }

    /// Removes pixels of a chunk from a mask.
    #[inline(always)]
    pub(crate) fn deactivate(&self, mask: u32, chunk: usize, gone: &Lanes<u32>) {
        let row = self.mask_row(mask);
        let mut lanes = row[chunk].get();
        for lane in 0..LANES {
            lanes[lane] &= !gone[lane];
        }
        row[chunk].set(lanes);
        let active = &self.active[mask as usize];
        let Active { chunks, .. } = active.get();
        active.set(Active {
            chunks: chunks & !(u32::from(!any(&lanes)) << chunk),
            all: false,
        });
    }
}
