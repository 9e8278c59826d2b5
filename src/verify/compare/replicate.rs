//! A stochastic shader with several sets of random numbers beside the tracer with several sets of its own.
//!
//! One picture of a shader cannot tell its noise from its mistakes; several pictures with other random numbers can. What they have in common
//! beyond the tracer's mean is bias. Four facts of them are asked for:
//!
//! - *sums*: the difference of the means over parts of the picture, against their standard deviation by both sides' own variances;
//! - *squares*: the product of two differences that have no random number in common is the bias squared on the average, whatever its
//!   sign and its pattern;
//! - *correlation*: whether neighbors use the same random numbers;
//! - *variance*: how many times that of the tracer's.

use super::EXACT_TOLERANCE;

/// So many pictures of a shader are compared, each with other random numbers; the first is the shader's own.
pub const REPLICATES: usize = 8;

/// A pixel that is random in the scene or in the shader, in the means of samples times the slope of what develops them: as far as
/// colors differ little, differences are those of colors.
#[derive(Debug, Clone)]
pub struct ReplicatedPixel {
    /// Where, x and y from the bottom left.
    pub at: [u32; 2],
    /// What it counts, by variances that none of what follows was used for.
    pub weight: [f64; 3],
    /// The tracer's mean over each of two halves of its pictures.
    pub reference: [[f64; 3]; 2],
    /// The variance of the mean of both halves.
    pub reference_variance: [f64; 3],
    /// The variance of a single picture of the tracer's.
    pub single_variance: [f64; 3],
    /// What the shader makes of it.
    pub own: [[f64; 3]; REPLICATES],
}

/// What the pictures say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replicated {
    /// By how many standard deviations the means differ where they differ most, and around which pixel.
    pub bias: (f64, [u32; 2]),
    /// Whether that is more than chance.
    pub is_biased: bool,
    /// How far the means may be apart over the whole picture.
    pub within: f64,
    /// Whether neighboring pixels use the same random numbers.
    pub is_repeated: bool,
    /// How many times the variance of the tracer's noise the shader's is.
    pub variance: f64,
    /// Whether it is the same number of times in all parts of the picture, as of a smaller number of samples.
    pub is_uniform: bool,
}

/// So many standard deviations are no chance: some hundred sums are looked at.
const SIGMA_LIMIT: f64 = 5.0;

/// The same where neighbors use the same random numbers, so that the variance of sums is told from eight pictures alone: Student's t of
/// seven degrees of freedom exceeds this once in 50,000 times.
const REPEATED_LIMIT: f64 = 10.0;

/// Means of eight pictures are not apart by more than so many times the variance of one, whoever shares its random numbers.
const BEYOND_NOISE: f64 = 4.0;

/// Means that are this much apart are the same, as far as two right formulas may be.
const SAME: f64 = 2.0 * EXACT_TOLERANCE;

/// Neighbors use the same numbers if their noise is correlated more than this in some direction; it is 0 where each has its own.
const CORRELATED: f64 = 0.25;

/// The picture is looked at whole, and in so many columns and rows, and in so many.
const BLOCKS: [u32; 3] = [1, 4, 16];

/// Fewer pixels make no sum.
const FEWEST: usize = 48;

/// The ratio of variances is the same everywhere if that of parts of the picture differs by less than this share of it, root mean square.
const UNIFORM: f64 = 0.15;

/// Noise of more than so many times the variance of the tracer's may be that of rare events: of an event of the same mean that is k times as
/// rare, the variance is k times as large. With less, the tracer's own variance tells what a pixel has not met.
pub const RARE_EVENTS: f64 = 4.0;

impl ReplicatedPixel {
    fn mean(&self, i: usize, sets: std::ops::Range<usize>) -> f64 {
        let count = sets.len() as f64;
        self.own[sets].iter().map(|own| own[i]).sum::<f64>() / count
    }

    /// The unbiased variance of what the shader makes of it.
    fn variance(&self, i: usize) -> f64 {
        let mean = self.mean(i, 0..REPLICATES);
        let squares = self.own.iter().map(|own| (own[i] - mean).powi(2));
        squares.sum::<f64>() / (REPLICATES - 1) as f64
    }

    /// The difference of the means.
    fn difference(&self, i: usize) -> f64 {
        self.mean(i, 0..REPLICATES) - f64::midpoint(self.reference[0][i], self.reference[1][i])
    }
}

/// Compares the two; `size` is the picture's.
#[must_use]
pub fn replicated(pixels: &[ReplicatedPixel], size: [u32; 2]) -> Replicated {
    let is_repeated = is_repeated(pixels);
    let (variance, is_uniform) = variances(pixels, size);
    let events = if variance > RARE_EVENTS {
        largest_events(pixels)
    } else {
        [0.0; 3]
    };
    let mut bias = (0.0, [0; 2]);
    for blocks in BLOCKS {
        let mut parts = vec![Vec::new(); (blocks * blocks) as usize];
        for pixel in pixels {
            let [column, row] = [0, 1].map(|i| pixel.at[i] * blocks / size[i]);
            parts[(row * blocks + column) as usize].push(pixel);
        }
        for part in parts.into_iter().filter(|part| part.len() >= FEWEST) {
            let sums = sum(&part, is_repeated, events);
            let most = if is_repeated {
                sums
            } else {
                sums.max(squares(&part, events))
            };
            if most > bias.0 {
                let places = part.iter().fold([0u64; 2], |sum, pixel| {
                    [0, 1].map(|i| sum[i] + u64::from(pixel.at[i]))
                });
                bias = (most, places.map(|sum| (sum / part.len() as u64) as u32));
            }
        }
    }
    let limit = if is_repeated { REPEATED_LIMIT } else { SIGMA_LIMIT };
    Replicated {
        bias,
        is_biased: bias.0 > limit || (is_repeated && is_beyond_noise(pixels)),
        within: within(pixels, limit, events),
        is_repeated,
        variance,
        is_uniform,
    }
}

/// The largest deviation of a picture from the mean of its pixel, in each component: the size of the rare events that other pixels may
/// not have met yet.
fn largest_events<'a>(pixels: impl IntoIterator<Item = &'a ReplicatedPixel>) -> [f64; 3] {
    let mut largest = [0.0f64; 3];
    for pixel in pixels {
        for (i, largest) in largest.iter_mut().enumerate() {
            let most = pixel.own.iter().map(|own| own[i]).fold(f64::MIN, f64::max);
            *largest = largest.max(most - pixel.mean(i, 0..REPLICATES));
        }
    }
    largest
}

/// A weighted sum of the differences in one component.
struct Sum {
    differences: f64,
    variance: f64,
    weight: f64,
}

impl Sum {
    /// Variances are those of the pixels, and of events of the size `event` that were not met: the mean of n pictures is short by d where
    /// n·d/event of them are missing. Their number has Poisson's distribution, so that the mean has the variance d·event/n.
    fn of<'a>(pixels: impl IntoIterator<Item = &'a ReplicatedPixel>, i: usize, event: f64) -> Self {
        let sets = REPLICATES as f64;
        let [mut sum, mut variance, mut short, mut all] = [0.0; 4];
        for pixel in pixels {
            let weight = pixel.weight[i];
            let difference = pixel.difference(i);
            sum += weight * difference;
            variance += weight * weight * (pixel.variance(i) / sets + pixel.reference_variance[i]);
            // With its sign, so that noise cancels.
            short -= weight * weight * difference;
            all += weight;
        }
        Self {
            differences: sum,
            variance: variance + short.max(0.0) * event / sets,
            weight: all,
        }
    }
}

/// How far the means may be apart, in the component in which they may be farthest; infinite where there is nothing to tell it from.
fn within(pixels: &[ReplicatedPixel], limit: f64, events: [f64; 3]) -> f64 {
    let of = |i: usize| {
        let Sum {
            differences,
            variance,
            weight,
        } = Sum::of(pixels, i, events[i]);
        SAME + differences.abs().max(limit * variance.sqrt()) / weight
    };
    let most = of(0).max(of(1)).max(of(2));
    if most.is_nan() { f64::INFINITY } else { most }
}

/// By how many standard deviations the sum of differences is too large, in the component in which it is largest.
fn sum(pixels: &[&ReplicatedPixel], is_repeated: bool, events: [f64; 3]) -> f64 {
    let of = |i: usize| {
        let Sum {
            differences,
            mut variance,
            weight,
        } = Sum::of(pixels.iter().copied(), i, events[i]);
        if is_repeated {
            let of_set = |set: usize| -> f64 {
                pixels
                    .iter()
                    .map(|pixel| pixel.weight[i] * pixel.own[set][i])
                    .sum()
            };
            let of_each: [f64; REPLICATES] = std::array::from_fn(of_set);
            let mean = of_each.iter().sum::<f64>() / REPLICATES as f64;
            let squares = of_each.iter().map(|each| (each - mean).powi(2)).sum::<f64>();
            variance = variance.max(squares / ((REPLICATES - 1) * REPLICATES) as f64);
        }
        deviations(differences.abs() - SAME * weight, variance)
    };
    of(0).max(of(1)).max(of(2))
}

/// By how many standard deviations the sum of squared biases is too large.
fn squares(pixels: &[&ReplicatedPixel], events: [f64; 3]) -> f64 {
    const HALF: usize = REPLICATES / 2;
    let [mut sum, mut variance, mut unmet] = [0.0; 3];
    for pixel in pixels {
        let mut of_pixel = 0.0;
        for (i, event) in events.iter().enumerate() {
            let one = pixel.mean(i, 0..HALF) - pixel.reference[0][i];
            let other = pixel.mean(i, HALF..REPLICATES) - pixel.reference[1][i];
            of_pixel += pixel.weight[i] * (one * other - SAME * SAME);
            if one + other < 0.0 {
                // The product of the variances of two means that are short, for three components that go together.
                unmet += 3.0 * one * other * (pixel.weight[i] * event / HALF as f64).powi(2);
            }
        }
        sum += of_pixel;
        variance += of_pixel * of_pixel;
    }
    deviations(sum, variance + unmet.max(0.0))
}

fn deviations(excess: f64, variance: f64) -> f64 {
    if excess <= 0.0 {
        0.0
    } else if variance == 0.0 {
        // Nothing random is left to explain it.
        f64::INFINITY
    } else {
        excess / variance.sqrt()
    }
}

/// Whether the noise of neighbors is correlated in some direction: what is left of a pixel without its own mean.
fn is_repeated(pixels: &[ReplicatedPixel]) -> bool {
    let places: std::collections::HashMap<[u32; 2], &ReplicatedPixel> =
        pixels.iter().map(|pixel| (pixel.at, pixel)).collect();
    let correlation = |[dx, dy]: [i32; 2]| {
        let [mut own, mut both, mut other] = [0.0; 3];
        for pixel in pixels {
            let at = [
                pixel.at[0].wrapping_add_signed(dx),
                pixel.at[1].wrapping_add_signed(dy),
            ];
            let Some(neighbor) = places.get(&at) else {
                continue;
            };
            for i in 0..3 {
                let means = [pixel, neighbor].map(|pixel| pixel.mean(i, 0..REPLICATES));
                let weight = (pixel.weight[i] * neighbor.weight[i]).sqrt();
                for (a, b) in pixel.own.iter().zip(&neighbor.own) {
                    let [a, b] = [a[i] - means[0], b[i] - means[1]];
                    own += weight * a * a;
                    both += weight * a * b;
                    other += weight * b * b;
                }
            }
        }
        both / (own * other).sqrt().max(f64::MIN_POSITIVE)
    };
    let directions = [[1, 0], [0, 1], [1, 1], [1, -1]];
    directions
        .into_iter()
        .any(|direction| correlation(direction) > CORRELATED)
}

/// Whether the means are farther apart than any noise of the scene would have them.
fn is_beyond_noise(pixels: &[ReplicatedPixel]) -> bool {
    let (mut squares, mut noise) = (0.0, 0.0);
    for pixel in pixels {
        for i in 0..3 {
            squares += pixel.weight[i] * pixel.difference(i).powi(2);
            noise += pixel.weight[i] * pixel.single_variance[i];
        }
    }
    squares > BEYOND_NOISE * noise
}

/// How many times the tracer's variance the shader's is, and whether it is so everywhere.
fn variances(pixels: &[ReplicatedPixel], size: [u32; 2]) -> (f64, bool) {
    const SIDE: u32 = 4;
    let mut parts = vec![[0.0; 2]; (SIDE * SIDE) as usize];
    for pixel in pixels {
        let [column, row] = [0, 1].map(|i| pixel.at[i] * SIDE / size[i]);
        let part = &mut parts[(row * SIDE + column) as usize];
        for i in 0..3 {
            part[0] += pixel.weight[i] * pixel.variance(i);
            part[1] += pixel.weight[i] * pixel.single_variance[i];
        }
    }
    let [own, reference] = parts
        .iter()
        .fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
    if reference == 0.0 {
        return (f64::INFINITY, false);
    }
    let ratio = own / reference;
    // Each part counts by the variance that it has.
    let spread = parts.iter().filter(|part| part[1] > 0.0).map(|part| {
        let off = part[0] / part[1] / ratio - 1.0;
        part[1] / reference * off * off
    });
    (ratio, spread.sum::<f64>().sqrt() < UNIFORM)
}

#[cfg(test)]
mod tests {
    use toyproof_image::pcg;

    use super::*;

    const SIZE: [u32; 2] = [64, 64];

    /// Twelve uniform numbers, less six: variance 1, about normal.
    fn normal(of: u32) -> f64 {
        let uniform = |i| f64::from(pcg(pcg(of) ^ i)) / f64::from(u32::MAX);
        (0..12).map(uniform).sum::<f64>() - 6.0
    }

    /// A gray picture with noise of 0.05; `own` is what the shader adds to it at a place in a set.
    fn pixels(own: impl Fn([u32; 2], u32) -> f64) -> Vec<ReplicatedPixel> {
        let pixel = |at: [u32; 2]| {
            let number = at[1] * 64 + at[0];
            let variance = 0.0025 / 8.0;
            ReplicatedPixel {
                at,
                weight: [1.0 / variance; 3],
                reference: [0, 1].map(|half| [0.5 + 0.05 / 2.0 * normal(number * 2 + half + 1_000_000); 3]),
                reference_variance: [variance; 3],
                single_variance: [0.0025; 3],
                own: std::array::from_fn(|set| [0.5 + own(at, set as u32); 3]),
            }
        };
        (0..64 * 64).map(|at| pixel([at % 64, at / 64])).collect()
    }

    fn noise([x, y]: [u32; 2], set: u32) -> f64 {
        0.05 * normal((y * 64 + x) * 16 + set + 7_000_000)
    }

    #[test]
    fn the_same_mean_is_no_bias_whatever_the_noise() {
        for times in [0.2, 1.0, 3.0] {
            let found = replicated(&pixels(|at, set| times * noise(at, set)), SIZE);
            assert!(!found.is_biased && !found.is_repeated, "{times}: {found:?}");
            assert!((found.variance / (times * times) - 1.0).abs() < 0.1, "{found:?}");
            assert!(found.is_uniform);
        }
        let uneven = |at: [u32; 2], set| noise(at, set) * if at[0] < 32 { 1.0 } else { 2.0 };
        let found = replicated(&pixels(uneven), SIZE);
        assert!(!found.is_biased && !found.is_uniform, "{found:?}");
    }

    #[test]
    fn a_bias_of_any_pattern_is_found() {
        let checkers = |[x, y]: [u32; 2]| if (x + y) % 2 == 0 { 1.0 } else { -1.0 };
        for bias in [(|_| 0.003) as fn([u32; 2]) -> f64, |[x, _]| {
            if x > 56 { 0.02 } else { 0.0 }
        }] {
            let found = replicated(&pixels(|at, set| noise(at, set) + bias(at)), SIZE);
            assert!(found.is_biased, "{found:?}");
        }
        // No sum of it is anything, and neighbors have nothing in common.
        let found = replicated(&pixels(|at, set| noise(at, set) + 0.02 * checkers(at)), SIZE);
        assert!(found.is_biased && !found.is_repeated, "{found:?}");
    }

    #[test]
    fn rare_events_that_were_not_met_are_no_bias() {
        // Two in each sixteenth of the image on the average, and none in some.
        let rare = |[x, y]: [u32; 2], set| {
            let is_met = pcg((y * 64 + x) * 16 + set + 9_000_000) < u32::MAX / 1000;
            if is_met { 10.0 - 0.01 } else { -0.01 }
        };
        let found = replicated(&pixels(rare), SIZE);
        assert!(!found.is_biased && found.variance > RARE_EVENTS, "{found:?}");
        let found = replicated(&pixels(|at, set| rare(at, set) - 0.05), SIZE);
        assert!(found.is_biased, "{found:?}");
    }

    #[test]
    fn numbers_that_neighbors_share_are_seen_in_any_direction() {
        let shared: [fn([u32; 2]) -> u32; 5] =
            [|_| 1, |[x, _]| x, |[_, y]| y, |[x, y]| x + y, |[x, y]| x + 64 - y];
        for (case, shared) in shared.into_iter().enumerate() {
            let own = |at, set| 0.05 * normal(shared(at) * 16 + set + 3_000_000);
            let found = replicated(&pixels(own), SIZE);
            assert!(found.is_repeated && !found.is_biased, "{case}: {found:?}");
        }
    }
}
