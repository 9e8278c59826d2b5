//! A batch of pixels while it runs: rows of components, scalars, masks.

use std::cell::{Cell, RefCell};

use crate::number::Number;
use crate::observe::Notes;
use crate::texture::Texture;
use crate::trace::story::Scribe;

/// How many pixels of a row are computed together: four quads.
pub(crate) const LANES: usize = 16;

/// One component of that many pixels.
pub(crate) type Lanes<T> = [T; LANES];

/// Which of a batch's chunks of [`LANES`] pixels have one that is here, a bit for each; and whether all pixels are. What the mask holds of
/// other chunks means nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Here {
    pub(crate) chunks: u32,
    pub(crate) all: bool,
}

/// Registers and masks. Cells, since instructions read and write them by number.
pub(crate) struct Batch<'a, N: Number> {
    /// How many chunks a row has.
    pub(crate) width: usize,
    pub(crate) floats: Vec<Cell<Lanes<N>>>,
    pub(crate) words: Vec<Cell<Lanes<u32>>>,
    pub(crate) float_scalars: Vec<Cell<N>>,
    pub(crate) word_scalars: Vec<Cell<u32>>,
    /// All bits where the pixel is here.
    pub(crate) masks: Vec<Cell<Lanes<u32>>>,
    pub(crate) here: Vec<Cell<Here>>,
    pub(crate) noise: N::Noise,
    pub(crate) textures: &'a [Option<Texture<'a>>; 4],
    /// How many rounds of loops may still run before somebody is asked whether to go on.
    pub(crate) fuel: Cell<u32>,
    pub(crate) stopped: Cell<Option<Stop>>,
    pub(crate) watch: &'a dyn Watch,
    /// How many rounds a pixel may run.
    pub(crate) limit: u32,
    /// Loop rounds that all pixels ran.
    pub(crate) rounds: Cell<u32>,
    /// Loop rounds of each pixel beside those.
    pub(crate) own_rounds: Vec<Cell<Lanes<u32>>>,
    pub(crate) notes: RefCell<Notes>,
    /// Who takes down what a pixel does, where that is asked for.
    pub(crate) scribe: Option<Scribe<'a>>,
}

/// Why a batch ended early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stop {
    /// The loop that was running.
    pub(crate) id: u32,
    /// Whether it ran too often, rather than too long.
    pub(crate) too_often: bool,
}

/// Who may end a run.
pub(crate) trait Watch: Sync {
    /// Whether to stop now.
    fn is_over(&self) -> bool;
}

/// So many rounds go by before somebody is asked.
pub(crate) const FUEL: u32 = 1 << 12;

impl<N: Number> Batch<'_, N> {
    /// One row.
    #[inline(always)]
    pub(crate) fn float_row(&self, first: u32) -> &[Cell<Lanes<N>>] {
        &self.floats[first as usize..][..self.width]
    }

    /// One row.
    #[inline(always)]
    pub(crate) fn word_row(&self, first: u32) -> &[Cell<Lanes<u32>>] {
        &self.words[first as usize..][..self.width]
    }

    /// The lanes of a mask.
    #[inline(always)]
    pub(crate) fn mask_row(&self, mask: u32) -> &[Cell<Lanes<u32>>] {
        &self.masks[mask as usize * self.width..][..self.width]
    }

    /// The most rounds of loops that a pixel ran.
    pub(crate) fn most_rounds(&self) -> u32 {
        let own = self.own_rounds.iter().flat_map(Cell::get);
        self.rounds.get() + own.max().unwrap_or(0)
    }

    /// Takes pixels of a chunk out of a mask.
    #[inline(always)]
    pub(crate) fn take_out(&self, mask: u32, chunk: usize, gone: &Lanes<u32>) {
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
pub(crate) fn any(lanes: &Lanes<u32>) -> bool {
    lanes.iter().fold(0, |any, lane| any | lane) != 0
}

/// How many pixels a tile is wide: two chunks.
pub(crate) const COLUMNS: usize = 16;

/// The place of a lane in a batch: quads from left to right, rows of quads upwards.
pub(crate) const fn place(lane: usize) -> [usize; 2] {
    let (quad, corner) = (lane / 4, lane % 4);
    let quads = COLUMNS / 2;
    [2 * (quad % quads) + corner % 2, 2 * (quad / quads) + corner / 2]
}

/// The same the other way.
pub(crate) const fn lane_at([x, y]: [usize; 2]) -> usize {
    4 * (y / 2 * (COLUMNS / 2) + x / 2) + 2 * (y % 2) + x % 2
}
