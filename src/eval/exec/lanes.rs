//! Lanes: the pixels that are computed together, and where they lie in a tile.

use std::cell::Cell;
use std::iter::repeat_with;

/// The number of pixels of a row that are computed together: four quads.
pub const LANES: usize = 16;

/// One component of [`LANES`] pixels.
pub type Lanes<T> = [T; LANES];

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

/// Returns chunks with the same lanes.
pub(crate) fn chunks<T: Copy>(lanes: Lanes<T>, count: usize) -> Vec<Chunk<T>> {
    repeat_with(|| Chunk::new(lanes)).take(count).collect()
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
