//! A batch of pixels while it runs: rows of components, scalars, masks.

use std::cell::{Cell, RefCell};

use super::number::Number;
use super::observe::Notes;
use super::story::Scribe;
use super::texture::Texture;

/// How many pixels of a row are computed together: four quads.
pub(super) const LANES: usize = 16;

/// One component of that many pixels.
pub(super) type Lanes<T> = [T; LANES];

/// Which of a batch's chunks of [`LANES`] pixels have one that is here, a bit for each; and whether all pixels are. What the mask holds of
/// other chunks means nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Here {
    pub(super) chunks: u32,
    pub(super) all: bool,
}

/// Registers and masks. Cells, since instructions read and write them by number.
pub(super) struct Batch<'a, N: Number> {
    /// How many chunks a row has.
    pub(super) width: usize,
    pub(super) floats: Vec<Cell<Lanes<N>>>,
    pub(super) words: Vec<Cell<Lanes<u32>>>,
    pub(super) float_scalars: Vec<Cell<N>>,
    pub(super) word_scalars: Vec<Cell<u32>>,
    /// All bits where the pixel is here.
    pub(super) masks: Vec<Cell<Lanes<u32>>>,
    pub(super) here: Vec<Cell<Here>>,
    pub(super) noise: N::Noise,
    pub(super) textures: &'a [Option<Texture<'a>>; 4],
    /// How many rounds of loops may still run before somebody is asked whether to go on.
    pub(super) fuel: Cell<u32>,
    pub(super) stopped: Cell<Option<Stop>>,
    pub(super) watch: &'a dyn Watch,
    /// How many rounds a pixel may run.
    pub(super) limit: u32,
    /// Loop rounds that all pixels ran.
    pub(super) rounds: Cell<u32>,
    /// Loop rounds of each pixel beside those.
    pub(super) own_rounds: Vec<Cell<Lanes<u32>>>,
    pub(super) notes: RefCell<Notes>,
    /// Who takes down what a pixel does, where that is asked for.
    pub(super) scribe: Option<Scribe<'a>>,
}

/// Why a batch ended early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stop {
    /// The loop that was running.
    pub(super) id: u32,
    /// Whether it ran too often, rather than too long.
    pub(super) too_often: bool,
}

/// Who may end a run.
pub(super) trait Watch: Sync {
    /// Whether to stop now.
    fn is_over(&self) -> bool;
}

/// So many rounds go by before somebody is asked.
pub(super) const FUEL: u32 = 1 << 12;

impl<N: Number> Batch<'_, N> {
    /// One row.
    #[inline(always)]
    pub(super) fn float_row(&self, first: u32) -> &[Cell<Lanes<N>>] {
        &self.floats[first as usize..][..self.width]
    }

    /// One row.
    #[inline(always)]
    pub(super) fn word_row(&self, first: u32) -> &[Cell<Lanes<u32>>] {
        &self.words[first as usize..][..self.width]
    }

    /// The lanes of a mask.
    #[inline(always)]
    pub(super) fn mask_row(&self, mask: u32) -> &[Cell<Lanes<u32>>] {
        &self.masks[mask as usize * self.width..][..self.width]
    }

    /// The most rounds of loops that a pixel ran.
    pub(super) fn most_rounds(&self) -> u32 {
        let own = self.own_rounds.iter().flat_map(Cell::get);
        self.rounds.get() + own.max().unwrap_or(0)
    }

    /// Takes pixels of a chunk out of a mask.
    #[inline(always)]
    pub(super) fn take_out(&self, mask: u32, chunk: usize, gone: &Lanes<u32>) {
        let row = self.mask_row(mask);
        let mut lanes = row[chunk].get();
        for lane in 0..LANES {
            lanes[lane] &= !gone[lane];
        }
        row[chunk].set(lanes);
        let here = &self.here[mask as usize];
        let Here { chunks, .. } = here.get();
        here.set(Here {
            chunks: chunks & !(u32::from(!any(&lanes)) << chunk),
            all: false,
        });
    }
}

/// Whether any bit is set.
#[inline(always)]
pub(super) fn any(lanes: &Lanes<u32>) -> bool {
    lanes.iter().fold(0, |any, lane| any | lane) != 0
}

/// How many pixels a tile is wide: two chunks.
pub(super) const COLUMNS: usize = 16;

/// The place of a lane in a batch: quads from left to right, rows of quads upwards.
pub(super) const fn place(lane: usize) -> [usize; 2] {
    let (quad, corner) = (lane / 4, lane % 4);
    let quads = COLUMNS / 2;
    [2 * (quad % quads) + corner % 2, 2 * (quad / quads) + corner / 2]
}

/// The same the other way.
pub(super) const fn lane_at([x, y]: [usize; 2]) -> usize {
    4 * (y / 2 * (COLUMNS / 2) + x / 2) + 2 * (y % 2) + x % 2
}
