//! Two mistakes at once: which pairs are worth rendering, and the shader with both.
//!
//! There are too many pairs to render all. Each mistake alone has been rendered: a pixel that one of two does
//! not change most likely has the color that the other alone gives it. If the wrong image has another
//! color, it contradicts the pair; the pairs with the fewest such pixels come first.

use crate::engine::probes::Probes;
use crate::known::mutant::Mutant;

/// The largest number of pairs that are rendered: those with the fewest contradicting pixels.
const MAX_RANKED_PAIRS: usize = 256;

/// The number of mistakes, nearest to the wrong image by themselves, that are combined with all others: where
/// a mistake shifts the image, the effect of the other is elsewhere and seems to contradict the pair.
const NEAREST_MISTAKES: usize = 6;

/// The largest share of the wrong pixels that may contradict another pair: one mistake may hide or reveal the
/// effect of the other, but seldom in more pixels.
const MAX_CONTRADICTED_SHARE: f64 = 0.5;

/// A set of pixels of an image, as bits.
#[derive(Debug)]
struct PixelSet(Vec<u64>);

impl PixelSet {
    fn new(pixels: impl Iterator<Item = bool>) -> Self {
        let mut words = Vec::new();
        for (at, is_in) in pixels.enumerate() {
            if at % 64 == 0 {
                words.push(0);
            }
            words[at / 64] |= u64::from(is_in) << (at % 64);
        }
        Self(words)
    }

    /// The number of pixels of this set that are not in the other.
    fn difference_count(&self, others: &Self) -> u64 {
        let pairs = self.0.iter().zip(&others.0);
        pairs
            .map(|(own, other)| u64::from((own & !other).count_ones()))
            .sum()
    }

    fn count(&self) -> u64 {
        self.0.iter().map(|word| u64::from(word.count_ones())).sum()
    }
}

/// The effect of a single mistake.
struct SingleEffect<'a> {
    mutant: &'a Mutant,
    /// Where its image differs from the correct one.
    changed: PixelSet,
    /// Where its image differs from the wrong one.
    unexplained: PixelSet,
}

impl<'a> SingleEffect<'a> {
    fn new(mutant: &'a Mutant, probes: &Probes) -> Option<Self> {
        let colors = mutant.colors(probes)?;
        let pixels = || probes.all.iter().zip(&colors);
        Some(Self {
            mutant,
            changed: PixelSet::new(pixels().map(|(probe, &color)| probes.is_changed(probe, color))),
            unexplained: PixelSet::new(pixels().map(|(probe, &color)| probes.is_wrong(probe, color))),
        })
    }

    /// The number of pixels that contradict this pair.
    fn contradicted(&self, other: &Self) -> u64 {
        self.unexplained.difference_count(&other.changed) + other.unexplained.difference_count(&self.changed)
    }
}

/// Returns the pairs of mistakes that are worth rendering, the most likely first.
pub(super) fn likely<'a>(mutants: impl Iterator<Item = &'a Mutant>, probes: &Probes) -> Vec<[&'a Mutant; 2]> {
    let all: Vec<SingleEffect> = mutants
        .filter_map(|mutant| SingleEffect::new(mutant, probes))
        .collect();
    let pairs = (0..all.len()).flat_map(|second| (0..second).map(move |first| [first, second]));
    let pairs = pairs.filter(|pair| {
        let [first, second] = pair.map(|at| all[at].mutant);
        first.ids().ne(second.ids())
    });
    let mut pairs: Vec<([usize; 2], u64)> = pairs
        .map(|pair| (pair, all[pair[0]].contradicted(&all[pair[1]])))
        .collect();
    pairs.sort_by_key(|&(pair, contradicted)| (contradicted, pair));
    let mut nearest: Vec<usize> = (0..all.len()).collect();
    nearest.sort_by_key(|&at| all[at].unexplained.count());
    nearest.truncate(NEAREST_MISTAKES);
    let limit = (probes.wrong() as f64 * MAX_CONTRADICTED_SHARE) as u64;
    let is_likely = |&(rank, (pair, contradicted)): &(usize, ([usize; 2], u64))| {
        (rank < MAX_RANKED_PAIRS && contradicted <= limit) || pair.iter().any(|at| nearest.contains(at))
    };
    let likely = pairs.into_iter().enumerate().filter(is_likely);
    likely
        .map(|(_, (pair, _))| pair.map(|at| all[at].mutant))
        .collect()
}
