//! The execution state of a batch of pixels: rows of components, scalars, and masks.

use std::cell::{Cell, RefCell};

use toyproof_image::Texture;

use crate::number::Number;
use crate::observe::Notes;
use crate::trace::Recorder;

/// The number of pixels of a row that are computed together: four quads.
pub(crate) const LANES: usize = 16;

/// One component of [`LANES`] pixels.
pub(crate) type Lanes<T> = [T; LANES];

/// The storage of [`Lanes`], aligned to cache lines: of vectors that are not, half span two.
#[repr(align(64))]
pub(crate) struct Chunk<T>(Cell<Lanes<T>>);

impl<T: Copy> Chunk<T> {
    #[inline(always)]
    pub(crate) fn new(lanes: Lanes<T>) -> Self {
        Self(Cell::new(lanes))
    }

    #[inline(always)]
    pub(crate) fn get(&self) -> Lanes<T> {
        self.0.get()
    }

    #[inline(always)]
    pub(crate) fn set(&self, lanes: Lanes<T>) {
        self.0.set(lanes);
    }

    /// Returns the lanes one by one.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> &[Cell<T>] {
        let lanes: &Cell<[T]> = &self.0;
        lanes.as_slice_of_cells()
    }
}

/// Summary of a mask: a bit for each chunk of [`LANES`] pixels that has an active pixel, and whether all
/// pixels are active.
///
/// Lanes of the mask in chunks whose bit is clear are unspecified.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(C)]
pub(crate) struct Active {
    pub(crate) chunks: u32,
    pub(crate) all: bool,
}

/// Registers and masks. They are `Cell`s because instructions read and write them by index.
pub(crate) struct Batch<'a, N: Number> {
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

impl<N: Number> Batch<'_, N> {
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

/// Whether any bit is set.
#[inline(always)]
pub(crate) fn any(lanes: &Lanes<u32>) -> bool {
    lanes.iter().fold(0, |any, lane| any | lane) != 0
}

/// The width of a tile in pixels: two chunks.
pub(crate) const TILE_COLUMNS: usize = 16;

/// Returns the position of a lane in a tile: quads from left to right, rows of quads upwards.
pub(crate) const fn lane_position(lane: usize) -> [usize; 2] {
    let (quad, corner) = (lane / 4, lane % 4);
    let quads = TILE_COLUMNS / 2;
    [2 * (quad % quads) + corner % 2, 2 * (quad / quads) + corner / 2]
}

/// Returns the lane at a position in a tile; inverse of [`lane_position`].
pub(crate) const fn lane_at([x, y]: [usize; 2]) -> usize {
    4 * (y / 2 * (TILE_COLUMNS / 2) + x / 2) + 2 * (y % 2) + x % 2
}
