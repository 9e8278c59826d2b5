//! Two mistakes at once: which pairs are worth rendering, and the shader with both.
//!
//! There are too many pairs to render all. Each mistake alone has been rendered: a pixel that one of two does
//! not change most likely has the color that the other alone gives it. If the wrong image has another
//! color, it contradicts the pair; the pairs with the fewest such pixels come first.

use toyproof_image::Image;
use toyproof_scene::FrameTime;

use crate::known::mutant::{Mutant, MutantSource};
use crate::known::thumbnail::{WrongImage, differs};

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
    /// The pixels in which two images differ.
    fn differing(one: &Image, other: &Image) -> Self {
        let mut words = vec![0; one.pixels().len().div_ceil(64)];
        for at in 0..one.pixels().len() {
            words[at / 64] |= u64::from(differs(at, one, other)) << (at % 64);
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
    fn of(mutant: &'a Mutant, wrong_image: &WrongImage, correct: &Image) -> Option<Self> {
        let image = mutant.image(wrong_image.view)?;
        Some(Self {
            mutant,
            changed: PixelSet::differing(image, correct),
            unexplained: PixelSet::differing(image, wrong_image.small),
        })
    }

    /// The number of pixels that contradict this pair.
    fn contradicted(&self, other: &Self) -> u64 {
        self.unexplained.difference_count(&other.changed) + other.unexplained.difference_count(&self.changed)
    }
}

/// Returns the pairs of mistakes that are worth rendering, the most likely first.
pub(super) fn likely<'a>(
    mutants: impl Iterator<Item = &'a Mutant>,
    wrong_image: &WrongImage,
    correct: &Image,
) -> Vec<[&'a Mutant; 2]> {
    let all: Vec<SingleEffect> = mutants
        .filter_map(|mutant| SingleEffect::of(mutant, wrong_image, correct))
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
    let limit = (wrong_image.differing as f64 * MAX_CONTRADICTED_SHARE) as u64;
    let is_likely = |&(rank, (pair, contradicted)): &(usize, ([usize; 2], u64))| {
        (rank < MAX_RANKED_PAIRS && contradicted <= limit) || pair.iter().any(|at| nearest.contains(at))
    };
    let likely = pairs.into_iter().enumerate().filter(is_likely);
    likely
        .map(|(_, (pair, _))| pair.map(|at| all[at].mutant))
        .collect()
}

/// Returns a mutant with both mistakes; `None` if they replace the same part, or both change the scene.
pub(super) fn both(pair: [&Mutant; 2], frame_time: FrameTime) -> Option<Mutant> {
    let [one, other] = pair;
    [[one, other], [other, one]]
        .into_iter()
        .find_map(|[first, second]| {
            let shader = second.edit?.apply(&first.shader(frame_time)?)?;
            // Descriptions of changes are longer, and come last.
            let order = if first.edit.is_none() {
                [second, first]
            } else {
                pair
            };
            let mistakes = order
                .into_iter()
                .flat_map(|mutant| mutant.mistakes.iter().cloned());
            Some(Mutant::new(mistakes.collect(), MutantSource::Shader(shader)))
        })
}
