//! Tests whether a stochastic shader has the tracer's mean, from several replicates of each.
//!
//! One image of a shader cannot separate its noise from its errors; several replicates, each with other
//! random numbers, can. Their common deviation from the tracer's mean is bias. Four statistics are
//! computed:
//!
//! - *sums*: the difference of the means over blocks of the image, relative to its standard deviation by the
//!   variances of both sides;
//! - *squares*: the product of two differences from disjoint sets of random numbers, whose expectation is the
//!   squared bias, whatever its sign and its pattern;
//! - *correlation*: whether neighbors use the same random numbers;
//! - *variance*: the ratio of the shader's variance to the tracer's.

use super::mean_test::MEAN_TOLERANCE;

/// The number of replicates of a shader that are compared, each with other random numbers; the first is the
/// shader's own image.
pub(crate) const REPLICATES: usize = 8;

/// A pixel that is random in the scene or in the shader. Values are means of samples times the slope of the
/// tone map, so that small differences are differences of colors.
#[derive(Debug, Clone)]
pub(crate) struct ReplicatedPixel {
    /// x and y, from the bottom left.
    pub(crate) at: [u32; 2],
    /// The weight, from variances estimated without any of the values below.
    pub(crate) weight: [f64; 3],
    /// The tracer's mean over each half of its sets of random numbers.
    pub(crate) reference: [[f64; 3]; 2],
    /// The variance of the mean of both halves.
    pub(crate) reference_variance: [f64; 3],
    /// The variance of the tracer with one set of random numbers.
    pub(crate) single_variance: [f64; 3],
    /// The shader's values, one for each replicate.
    pub(crate) own: [[f64; 3]; REPLICATES],
}

/// The result of comparing the replicates of a shader with the tracer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplicateTest {
    /// The most significant difference of the means.
    pub bias: Bias,
    /// Whether the difference is significant.
    pub is_biased: bool,
    /// The upper bound of the difference of the means over the whole image.
    pub within: f64,
    /// Whether neighboring pixels use the same random numbers.
    pub is_correlated: bool,
    /// The ratio of the variance of the shader's noise to that of the tracer's.
    pub variance: f64,
    /// Whether this ratio is the same in all parts of the image, as it is for a smaller number of samples.
    pub is_uniform: bool,
}

/// A difference of the means over a block of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bias {
    /// The significance, in standard deviations.
    pub deviations: f64,
    /// The centroid of the block's pixels.
    pub at: [u32; 2],
}

/// The significance threshold in standard deviations, for some hundred tests of sums.
const SIGMA_LIMIT: f64 = 5.0;

/// The threshold where neighbors use the same random numbers, so that the variance of sums is estimated from
/// the eight replicates alone: Student's t with seven degrees of freedom exceeds it with a probability of
/// 1/50,000.
const CORRELATED_SIGMA_LIMIT: f64 = 10.0;

/// The largest mean squared difference of the means of eight replicates that noise can explain, as a multiple
/// of the variance of one, even if all pixels share their random numbers.
const MAX_SQUARED_DIFFERENCE: f64 = 4.0;

/// Neighbors use the same random numbers if the correlation of their noise exceeds this in some direction; it
/// is 0 for independent pixels.
const MIN_CORRELATION: f64 = 0.25;

/// The numbers of columns and of rows of blocks that are tested.
const BLOCKS: [u32; 3] = [1, 4, 16];

/// The smallest number of pixels of a block that is tested.
const MIN_BLOCK_PIXELS: usize = 48;

/// The ratio of variances is uniform if the relative root mean square deviation of its values in parts of the
/// image is below this.
const MAX_RATIO_DEVIATION: f64 = 0.15;

/// The ratio of variances above which the noise may come from rare events: an event with the same mean that
/// is k times rarer has k times the variance. Below it, the tracer's own variance accounts for events that
/// did not occur in a pixel.
pub(crate) const RARE_EVENT_VARIANCE_RATIO: f64 = 4.0;

impl ReplicatedPixel {
    fn mean(&self, i: usize, sets: std::ops::Range<usize>) -> f64 {
        let count = sets.len() as f64;
        self.own[sets].iter().map(|own| own[i]).sum::<f64>() / count
    }

    /// The unbiased sample variance of the shader's values.
    fn variance(&self, i: usize) -> f64 {
        let mean = self.mean(i, 0..REPLICATES);
        let squares = self.own.iter().map(|own| (own[i] - mean).powi(2));
        squares.sum::<f64>() / (REPLICATES - 1) as f64
    }

    /// The difference between the shader's mean and the tracer's.
    fn difference(&self, i: usize) -> f64 {
        self.mean(i, 0..REPLICATES) - f64::midpoint(self.reference[0][i], self.reference[1][i])
    }
}

/// Compares the shader's replicates with the reference's means; `size` is the image's. If neighboring pixels
/// of the reference are correlated, only a bias that exceeds the noise of single pixels is significant.
pub(crate) fn compare_replicates(
    pixels: &[ReplicatedPixel],
    size: [u32; 2],
    reference_is_correlated: bool,
) -> ReplicateTest {
    let is_correlated = is_correlated(pixels) || reference_is_correlated;
    let (variance, is_uniform) = variance_ratio(pixels, size);
    let events = if variance > RARE_EVENT_VARIANCE_RATIO {
        largest_deviations(pixels)
    } else {
        [0.0; 3]
    };
    let mut bias = Bias::default();
    for blocks in BLOCKS {
        let mut parts = vec![Vec::new(); (blocks * blocks) as usize];
        for pixel in pixels {
            let [column, row] = [0, 1].map(|i| pixel.at[i] * blocks / size[i]);
            parts[(row * blocks + column) as usize].push(pixel);
        }
        for part in parts.into_iter().filter(|part| part.len() >= MIN_BLOCK_PIXELS) {
            let sums = sum_z_score(&part, is_correlated, events);
            let deviations = if is_correlated {
                sums
            } else {
                sums.max(squared_bias_z_score(&part, events))
            };
            if deviations > bias.deviations {
                let places = part.iter().fold([0u64; 2], |sum, pixel| {
                    [0, 1].map(|i| sum[i] + u64::from(pixel.at[i]))
                });
                let at = places.map(|sum| (sum / part.len() as u64) as u32);
                bias = Bias { deviations, at };
            }
        }
    }
    let limit = if is_correlated {
        CORRELATED_SIGMA_LIMIT
    } else {
        SIGMA_LIMIT
    };
    ReplicateTest {
        bias,
        is_biased: (bias.deviations > limit && !reference_is_correlated)
            || (is_correlated && exceeds_noise(pixels)),
        within: bias_bound(pixels, limit, events),
        is_correlated,
        variance,
        is_uniform,
    }
}

/// The largest deviation of a replicate from the mean of its pixel, in each component: the magnitude of the
/// rare events that may not have occurred in other pixels yet.
fn largest_deviations<'a>(pixels: impl IntoIterator<Item = &'a ReplicatedPixel>) -> [f64; 3] {
    let mut largest = [0.0f64; 3];
    for pixel in pixels {
        for (i, largest) in largest.iter_mut().enumerate() {
            let most = pixel.own.iter().map(|own| own[i]).fold(f64::MIN, f64::max);
            *largest = largest.max(most - pixel.mean(i, 0..REPLICATES));
        }
    }
    largest
}

/// The weighted sum of the differences in one component.
struct DifferenceSum {
    differences: f64,
    variance: f64,
    weight: f64,
}

impl DifferenceSum {
    /// Sums the pixels' variances, plus that of events of magnitude `event` that did not occur: if the mean
    /// of n replicates is too small by d, n·d/event of them are missing. Their number has a Poisson
    /// distribution, so the mean has the additional variance d·event/n.
    fn new<'a>(pixels: impl IntoIterator<Item = &'a ReplicatedPixel>, i: usize, event: f64) -> Self {
        let sets = REPLICATES as f64;
        let [mut sum, mut variance, mut shortfall, mut all] = [0.0; 4];
        for pixel in pixels {
            let weight = pixel.weight[i];
            let difference = pixel.difference(i);
            sum += weight * difference;
            variance += weight * weight * (pixel.variance(i) / sets + pixel.reference_variance[i]);
            // Signed, so that noise cancels.
            shortfall -= weight * weight * difference;
            all += weight;
        }
        Self {
            differences: sum,
            variance: variance + shortfall.max(0.0) * event / sets,
            weight: all,
        }
    }
}

/// The upper bound of the difference of the means, the largest of the components; infinite without any
/// weight.
fn bias_bound(pixels: &[ReplicatedPixel], limit: f64, events: [f64; 3]) -> f64 {
    let of = |i: usize| {
        let DifferenceSum {
            differences,
            variance,
            weight,
        } = DifferenceSum::new(pixels, i, events[i]);
        MEAN_TOLERANCE + differences.abs().max(limit * variance.sqrt()) / weight
    };
    let most = of(0).max(of(1)).max(of(2));
    if most.is_nan() { f64::INFINITY } else { most }
}

/// The sum of differences beyond the allowed one, in standard deviations; the largest of the components.
fn sum_z_score(pixels: &[&ReplicatedPixel], is_correlated: bool, events: [f64; 3]) -> f64 {
    let of = |i: usize| {
        let DifferenceSum {
            differences,
            mut variance,
            weight,
        } = DifferenceSum::new(pixels.iter().copied(), i, events[i]);
        if is_correlated {
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
        z_score(differences.abs() - MEAN_TOLERANCE * weight, variance)
    };
    of(0).max(of(1)).max(of(2))
}

/// The sum of squared biases, in standard deviations.
fn squared_bias_z_score(pixels: &[&ReplicatedPixel], events: [f64; 3]) -> f64 {
    const HALF: usize = REPLICATES / 2;
    let [mut sum, mut variance, mut missing_events] = [0.0; 3];
    for pixel in pixels {
        let mut of_pixel = 0.0;
        for (i, event) in events.iter().enumerate() {
            let one = pixel.mean(i, 0..HALF) - pixel.reference[0][i];
            let other = pixel.mean(i, HALF..REPLICATES) - pixel.reference[1][i];
            of_pixel += pixel.weight[i] * (one * other - MEAN_TOLERANCE * MEAN_TOLERANCE);
            if one + other < 0.0 {
                // The product of the variances of two means that are too small; the three components are
                // fully correlated.
                missing_events += 3.0 * one * other * (pixel.weight[i] * event / HALF as f64).powi(2);
            }
        }
        sum += of_pixel;
        variance += of_pixel * of_pixel;
    }
    z_score(sum, variance + missing_events.max(0.0))
}

fn z_score(excess: f64, variance: f64) -> f64 {
    if excess <= 0.0 {
        0.0
    } else if variance == 0.0 {
        // Without variance, any excess is significant.
        f64::INFINITY
    } else {
        excess / variance.sqrt()
    }
}

/// Whether the noise of neighbors is correlated in some direction.
pub(crate) fn is_correlated(pixels: &[ReplicatedPixel]) -> bool {
    neighbor_correlations(pixels)
        .into_iter()
        .any(|correlation| correlation > MIN_CORRELATION)
}

/// The correlation of the noise of neighbors, their deviation from their own means: in x, in y and along both
/// diagonals.
pub(crate) fn neighbor_correlations(pixels: &[ReplicatedPixel]) -> [f64; 4] {
    let places: std::collections::HashMap<[u32; 2], &ReplicatedPixel> =
        pixels.iter().map(|pixel| (pixel.at, pixel)).collect();
    let correlation = |[dx, dy]: [i32; 2]| {
        let [mut own, mut covariance, mut other] = [0.0; 3];
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
                    covariance += weight * a * b;
                    other += weight * b * b;
                }
            }
        }
        covariance / (own * other).sqrt().max(f64::MIN_POSITIVE)
    };
    [[1, 0], [0, 1], [1, 1], [1, -1]].map(correlation)
}

/// Whether the difference of the means is larger than the reference's noise can explain, even if pixels share
/// it.
fn exceeds_noise(pixels: &[ReplicatedPixel]) -> bool {
    let (mut squares, mut noise) = (0.0, 0.0);
    for pixel in pixels {
        for i in 0..3 {
            squares += pixel.weight[i] * pixel.difference(i).powi(2);
            noise += pixel.weight[i] * pixel.single_variance[i];
        }
    }
    squares > MAX_SQUARED_DIFFERENCE * noise
}

/// The ratio of the shader's variance to the tracer's, and whether it is uniform.
fn variance_ratio(pixels: &[ReplicatedPixel], size: [u32; 2]) -> (f64, bool) {
    const PARTS: u32 = 4;
    let mut parts = vec![[0.0; 2]; (PARTS * PARTS) as usize];
    for pixel in pixels {
        let [column, row] = [0, 1].map(|i| pixel.at[i] * PARTS / size[i]);
        let part = &mut parts[(row * PARTS + column) as usize];
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
    // Each part is weighted by the tracer's variance in it.
    let deviations = parts.iter().filter(|part| part[1] > 0.0).map(|part| {
        let deviation = part[0] / part[1] / ratio - 1.0;
        part[1] / reference * deviation * deviation
    });
    (ratio, deviations.sum::<f64>().sqrt() < MAX_RATIO_DEVIATION)
}

#[cfg(test)]
mod tests {
    use toyproof_image::pcg;

    use super::*;

    const SIZE: [u32; 2] = [64, 64];

    /// The sum of twelve uniform numbers minus six: nearly normal, with variance 1.
    fn normal(of: u32) -> f64 {
        let uniform = |i| f64::from(pcg(pcg(of) ^ i)) / f64::from(u32::MAX);
        (0..12).map(uniform).sum::<f64>() - 6.0
    }

    /// A gray image with noise of 0.05; `own` returns the number that the shader adds to a pixel in a
    /// replicate.
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
    fn the_same_mean_is_unbiased_at_any_noise_level() {
        for times in [0.2, 1.0, 3.0] {
            let found = compare_replicates(&pixels(|at, set| times * noise(at, set)), SIZE, false);
            assert!(!found.is_biased && !found.is_correlated, "{times}: {found:?}");
            assert!((found.variance / (times * times) - 1.0).abs() < 0.1, "{found:?}");
            assert!(found.is_uniform);
        }
        let uneven = |at: [u32; 2], set| noise(at, set) * if at[0] < 32 { 1.0 } else { 2.0 };
        let found = compare_replicates(&pixels(uneven), SIZE, false);
        assert!(!found.is_biased && !found.is_uniform, "{found:?}");
    }

    #[test]
    fn a_bias_of_any_pattern_is_detected() {
        let checkers = |[x, y]: [u32; 2]| if (x + y) % 2 == 0 { 1.0 } else { -1.0 };
        for bias in [(|_| 0.003) as fn([u32; 2]) -> f64, |[x, _]| {
            if x > 56 { 0.02 } else { 0.0 }
        }] {
            let found = compare_replicates(&pixels(|at, set| noise(at, set) + bias(at)), SIZE, false);
            assert!(found.is_biased, "{found:?}");
        }
        // The sum over any block is near 0, and neighbors are not correlated.
        let found = compare_replicates(
            &pixels(|at, set| noise(at, set) + 0.02 * checkers(at)),
            SIZE,
            false,
        );
        assert!(found.is_biased && !found.is_correlated, "{found:?}");
    }

    #[test]
    fn missing_rare_events_are_not_a_bias() {
        // Two events on average in each sixteenth of the image, and none in some.
        let rare = |[x, y]: [u32; 2], set| {
            let occurs = pcg((y * 64 + x) * 16 + set + 9_000_000) < u32::MAX / 1000;
            if occurs { 10.0 - 0.01 } else { -0.01 }
        };
        let found = compare_replicates(&pixels(rare), SIZE, false);
        assert!(
            !found.is_biased && found.variance > RARE_EVENT_VARIANCE_RATIO,
            "{found:?}"
        );
        let found = compare_replicates(&pixels(|at, set| rare(at, set) - 0.05), SIZE, false);
        assert!(found.is_biased, "{found:?}");
    }

    #[test]
    fn shared_random_numbers_are_detected_in_any_direction() {
        let shared: [fn([u32; 2]) -> u32; 5] =
            [|_| 1, |[x, _]| x, |[_, y]| y, |[x, y]| x + y, |[x, y]| x + 64 - y];
        for (case, shared) in shared.into_iter().enumerate() {
            let own = |at, set| 0.05 * normal(shared(at) * 16 + set + 3_000_000);
            let found = compare_replicates(&pixels(own), SIZE, false);
            assert!(found.is_correlated && !found.is_biased, "{case}: {found:?}");
        }
    }

    #[test]
    fn only_a_large_bias_is_significant_against_correlated_noise() {
        let biased = |bias: f64| {
            let pixels = pixels(move |at, set| noise(at, set) + bias);
            [false, true].map(|correlated| compare_replicates(&pixels, SIZE, correlated))
        };
        let [independent, correlated] = biased(0.05);
        assert!(independent.is_biased && !correlated.is_biased && correlated.is_correlated);
        assert!(biased(1.0)[1].is_biased);
    }
}
