//! Two mistakes at once: those of all pairs that are worth painting. A pixel that one of them does not change by itself is, most likely,
//! what the other makes of it; so where that is not what the wrong picture shows, the pair is contradicted, and nothing need be painted to see it.

use toyproof_image::Image;
use toyproof_scene::Moment;

use super::look::{Looked, differs};
use super::suspect::{Made, Suspect};

/// So many pairs are looked at, those first that fewest pixels contradict.
const MOST: usize = 256;

/// Where a mistake moves the picture, what another does shows elsewhere, and seems to contradict it. So the mistakes that come nearest by
/// themselves are looked at with all others: so many.
const PROMISING: usize = 6;

/// Any other pair that more than this share of the wrong pixels contradicts is not painted: one mistake may hide what the other does, or bring it
/// to light, but seldom more than that.
const CONTRADICTED: f64 = 0.5;

/// Pixels of a picture, a bit for each.
#[derive(Debug)]
struct Pixels(Vec<u64>);

impl Pixels {
    /// Those in which two pictures differ.
    fn differing(one: &Image, other: &Image) -> Self {
        let mut words = vec![0; one.pixels().len().div_ceil(64)];
        for at in 0..one.pixels().len() {
            words[at / 64] |= u64::from(differs(at, one, other)) << (at % 64);
        }
        Self(words)
    }

    /// How many are among these and not among the others.
    fn without(&self, others: &Self) -> u64 {
        let pairs = self.0.iter().zip(&others.0);
        pairs
            .map(|(own, other)| u64::from((own & !other).count_ones()))
            .sum()
    }

    fn count(&self) -> u64 {
        self.0.iter().map(|word| u64::from(word.count_ones())).sum()
    }
}

/// What a mistake does by itself.
struct Alone<'a> {
    suspect: &'a Suspect,
    /// Where the picture is not the right one.
    changed: Pixels,
    /// Where it is not the one that is looked at.
    unexplained: Pixels,
}

impl<'a> Alone<'a> {
    fn of(suspect: &'a Suspect, looked_at: &Looked, right: &Image) -> Option<Self> {
        let picture = suspect.picture(looked_at.view)?;
        Some(Self {
            suspect,
            changed: Pixels::differing(picture, right),
            unexplained: Pixels::differing(picture, looked_at.small),
        })
    }

    /// How many pixels say that it is not these two.
    fn contradicted(&self, other: &Self) -> u64 {
        self.unexplained.without(&other.changed) + other.unexplained.without(&self.changed)
    }
}

/// Pairs of mistakes, without their pictures: the most likely first.
pub(super) fn likely<'a>(
    suspects: impl Iterator<Item = &'a Suspect>,
    looked_at: &Looked,
    right: &Image,
) -> Vec<[&'a Suspect; 2]> {
    let all: Vec<Alone> = suspects
        .filter_map(|suspect| Alone::of(suspect, looked_at, right))
        .collect();
    let pairs = (0..all.len()).flat_map(|second| (0..second).map(move |first| [first, second]));
    let pairs = pairs.filter(|pair| {
        let [first, second] = pair.map(|at| all[at].suspect);
        first.names().ne(second.names())
    });
    let mut pairs: Vec<([usize; 2], u64)> = pairs
        .map(|pair| (pair, all[pair[0]].contradicted(&all[pair[1]])))
        .collect();
    pairs.sort_by_key(|&(pair, contradicted)| (contradicted, pair));
    let mut nearest: Vec<usize> = (0..all.len()).collect();
    nearest.sort_by_key(|&at| all[at].unexplained.count());
    nearest.truncate(PROMISING);
    let limit = (looked_at.differing as f64 * CONTRADICTED) as u64;
    let is_likely = |&(rank, (pair, contradicted)): &(usize, ([usize; 2], u64))| {
        (rank < MOST && contradicted <= limit) || pair.iter().any(|at| nearest.contains(at))
    };
    let likely = pairs.into_iter().enumerate().filter(is_likely);
    likely
        .map(|(_, (pair, _))| pair.map(|at| all[at].suspect))
        .collect()
}

/// A tracer with both mistakes; none where they touch the same words, or both are of the scene.
pub(super) fn both(pair: [&Suspect; 2], moment: Moment) -> Option<Suspect> {
    let [one, other] = pair;
    [[one, other], [other, one]]
        .into_iter()
        .find_map(|[first, second]| {
            let text = second.edit?.made_in(&first.text(moment)?)?;
            // What is said of changes is longer, and comes last.
            let order = if first.edit.is_none() {
                [second, first]
            } else {
                pair
            };
            let mistakes = order
                .into_iter()
                .flat_map(|suspect| suspect.mistakes.iter().cloned());
            Some(Suspect::new(mistakes.collect(), Made::Shader(text)))
        })
}
