//! Tests whether two images with different random numbers have the same mean.
//!
//! A pixel of a stochastic renderer is the sample mean of a few samples. A renderer with other random numbers
//! has another color there, with the same expectation. The tracer estimates the mean and the variance of each
//! pixel. If both renderers have the same mean, a shader's pixel minus that mean is noise. Two facts separate
//! noise from a bias: the noise of many pixels averages out, and the noise of a pixel is independent of its
//! neighbor's. The shader may have any noise level. The variance of a sum is estimated by the sum of its
//! squared terms, which only assumes that the distribution over many pixels is nearly symmetric.

use crate::compare::EXACT_TOLERANCE;
use crate::limits::MAX_BIAS_BOUND;

/// A pixel whose color depends on random numbers. Color components are in [0, 1].
#[derive(Debug, Clone, Copy)]
pub(crate) struct RandomPixel {
    /// x and y, from the bottom left.
    pub(crate) at: [u32; 2],
    /// The shader's color.
    pub(crate) rendered: [f64; 3],
    /// The reference's color, with the scene's own random numbers.
    pub(crate) reference: [f64; 3],
    /// The tracer's mean over several sets of random numbers.
    pub(crate) mean: [f64; 3],
    /// The variance of the tracer's color with one set of random numbers, estimated from other sets: the
    /// weight of a pixel must be independent of the values that are compared.
    pub(crate) variance: [f64; 3],
    /// How much brighter the pixel is if the samples of all sets are averaged before the tone map: a
    /// nonlinear tone map changes the mean.
    pub(crate) tone_map_bias: [f64; 3],
}

/// The result of comparing the means of two images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeanTest {
    /// No significant difference; the upper bound of the difference, averaged over all pixels.
    Same(f64),
    /// A significant difference, most significant around this pixel.
    Different([u32; 2]),
    /// The noise is too strong or the pixels are too few to detect a difference.
    Underpowered,
    /// Undetermined: neighboring pixels use the same random numbers, so the variance of sums is unknown.
    Correlated,
}

/// The significance threshold, in standard deviations. Some 200 sums are tested, so for normal sums one image
/// in 700 would be a false positive.
const SIGMA_LIMIT: f64 = 4.5;

/// The difference of means that two correct formulas may have: twice the tolerance, once for the image and
/// once for its mean.
pub(crate) const MEAN_TOLERANCE: f64 = 2.0 * EXACT_TOLERANCE;

/// The lower bound of a pixel's standard deviation in weights. Without it, pixels in which all eight sets
/// happen to miss a small feature would have nearly all the weight.
pub(crate) const MIN_STANDARD_DEVIATION: f64 = 0.01;

/// Neighboring pixels share random numbers if the variance of their difference is below this share of the sum
/// of their variances. The ratio is 1 for independent pixels.
const MIN_INDEPENDENT_VARIANCE: f64 = 0.75;

/// The covariance of neighbors cannot come from noise if it exceeds this multiple of the variance of the
/// scene's noise.
const MAX_COVARIANCE: f64 = 4.0;

/// The shader uses the scene's random numbers if the correlation of its noise with the reference's exceeds
/// this. Independent noise has a correlation of 0.1, because the same mean is subtracted from both.
pub(crate) const MIN_SHARED_CORRELATION: f64 = 0.5;

/// The number of columns and of rows of blocks that are tested, besides the whole image.
const BLOCKS: u32 = 8;

/// The smallest number of pixels of a block that is tested.
const MIN_BLOCK_PIXELS: usize = 64;

/// The smallest number of pixels of an image: with fewer, a mistake in some of them is not detected.
const MIN_PIXELS: usize = 4000;

/// Whether the shader uses the scene's random numbers, so that its pixels must be the reference's.
pub(crate) fn uses_scene_numbers(pairs: &[[RandomPixel; 2]]) -> bool {
    correlation(pairs) > MIN_SHARED_CORRELATION
}

/// Compares the means of a shader and of the tracer, given pairs of neighboring pixels of an image of that
/// size.
pub(crate) fn means(pairs: &[[RandomPixel; 2]], size: [u32; 2]) -> MeanTest {
    let blocks = (0..BLOCKS * BLOCKS).map(|block| {
        let of = |pixel: &&RandomPixel| {
            let [column, row] = [0, 1].map(|i| pixel.at[i] * BLOCKS / size[i]);
            row * BLOCKS + column == block
        };
        WeightedSum::new(pairs.iter().flatten().filter(of))
    });
    let whole = WeightedSum::new(pairs.iter().flatten());
    let sums = blocks
        .filter(|block| block.pixels >= MIN_BLOCK_PIXELS)
        .chain([whole]);
    let most_significant = sums.max_by(|a, b| a.z_score().total_cmp(&b.z_score()));
    let most_significant = most_significant.unwrap_or(whole);
    let bias_bound = whole.bias_bound();
    if most_significant.z_score().max(neighbor_covariance(pairs)) > SIGMA_LIMIT {
        if independent_variance(pairs) < MIN_INDEPENDENT_VARIANCE && !exceeds_scene_noise(pairs) {
            MeanTest::Correlated
        } else {
            MeanTest::Different(most_significant.centroid())
        }
    } else if bias_bound > MAX_BIAS_BOUND || whole.pixels < MIN_PIXELS {
        MeanTest::Underpowered
    } else {
        MeanTest::Same(bias_bound)
    }
}

impl RandomPixel {
    /// The shader's deviation from the mean in component `i`.
    fn noise(&self, i: usize) -> f64 {
        self.rendered[i] - self.mean[i]
    }

    /// The weight of component `i` in sums: its inverse variance.
    fn weight(&self, i: usize) -> f64 {
        1.0 / (self.variance[i] + MIN_STANDARD_DEVIATION * MIN_STANDARD_DEVIATION)
    }
}

/// A sum of random terms with its estimated variance.
#[derive(Clone, Copy, Default)]
struct RandomSum {
    sum: f64,
    squares: f64,
}

impl RandomSum {
    fn add(&mut self, term: f64) {
        self.sum += term;
        self.squares += term * term;
    }

    /// The number of standard deviations of the sum that `excess` is.
    fn z_score(self, excess: f64) -> f64 {
        if self.squares == 0.0 {
            0.0
        } else {
            excess / self.squares.sqrt()
        }
    }
}

/// The variance of the difference of neighbors' noise as a share of the sum of their variances. Only pixels
/// with much noise count: in others, a shader without randomness has none.
fn independent_variance(pairs: &[[RandomPixel; 2]]) -> f64 {
    let (mut own, mut all) = (0.0, 0.0);
    for [a, b] in pairs {
        let noisy = (0..3)
            .filter(|&i| a.variance[i].max(b.variance[i]) > MIN_STANDARD_DEVIATION * MIN_STANDARD_DEVIATION);
        for i in noisy {
            let weight = (a.weight(i) * b.weight(i)).sqrt();
            own += weight * (a.noise(i) - b.noise(i)).powi(2);
            all += weight * (a.noise(i).powi(2) + b.noise(i).powi(2));
        }
    }
    if all == 0.0 { 1.0 } else { own / all }
}

/// Whether the covariance of neighbors is larger than the scene's noise can explain, even if neighbors share
/// it.
fn exceeds_scene_noise(pairs: &[[RandomPixel; 2]]) -> bool {
    let (mut covariance, mut noise) = (0.0, 0.0);
    for [a, b] in pairs {
        for i in 0..3 {
            let weight = (a.weight(i) * b.weight(i)).sqrt();
            covariance += weight * a.noise(i) * b.noise(i);
            noise += weight * f64::midpoint(a.variance[i], b.variance[i]);
        }
    }
    covariance > MAX_COVARIANCE * noise
}

/// The correlation of the shader's noise with the reference's.
fn correlation(pairs: &[[RandomPixel; 2]]) -> f64 {
    let [mut own, mut covariance, mut reference] = [0.0; 3];
    for pixel in pairs.iter().flatten() {
        for i in 0..3 {
            let [a, b] = [pixel.noise(i), pixel.reference[i] - pixel.mean[i]];
            let weight = pixel.weight(i);
            own += weight * a * a;
            covariance += weight * a * b;
            reference += weight * b * b;
        }
    }
    if covariance <= 0.0 {
        0.0
    } else {
        covariance / (own * reference).sqrt()
    }
}

/// The covariance of neighbors' noise in standard deviations. Its expectation is 0 without a bias.
fn neighbor_covariance(pairs: &[[RandomPixel; 2]]) -> f64 {
    let mut products = RandomSum::default();
    let mut allowed = 0.0;
    for [a, b] in pairs {
        let weight = |i| (a.weight(i) * b.weight(i)).sqrt();
        products.add((0..3).map(|i| weight(i) * a.noise(i) * b.noise(i)).sum());
        let allowed_product = |i: usize| {
            (MEAN_TOLERANCE + a.tone_map_bias[i].abs()) * (MEAN_TOLERANCE + b.tone_map_bias[i].abs())
        };
        allowed += (0..3).map(|i| weight(i) * allowed_product(i)).sum::<f64>();
    }
    products.z_score(products.sum - allowed)
}

/// The weighted sum of the noise of some pixels.
#[derive(Clone, Copy, Default)]
struct WeightedSum {
    pixels: usize,
    /// The sums of x and of y.
    places: [u64; 2],
    noise: [RandomSum; 3],
    weight: [f64; 3],
    tone_map_bias: [f64; 3],
}

impl WeightedSum {
    fn new<'a>(pixels: impl Iterator<Item = &'a RandomPixel>) -> Self {
        let mut sum = Self::default();
        for pixel in pixels {
            sum.pixels += 1;
            for (place, at) in sum.places.iter_mut().zip(pixel.at) {
                *place += u64::from(at);
            }
            for i in 0..3 {
                let weight = pixel.weight(i);
                sum.noise[i].add(weight * pixel.noise(i));
                sum.weight[i] += weight;
                sum.tone_map_bias[i] += weight * pixel.tone_map_bias[i];
            }
        }
        sum
    }

    /// The difference of the means beyond the allowed one, in standard deviations; the largest of the
    /// components.
    fn z_score(&self) -> f64 {
        let of = |i: usize| {
            let allowed = MEAN_TOLERANCE * self.weight[i] + self.tone_map_bias[i].abs();
            self.noise[i].z_score(self.noise[i].sum.abs() - allowed)
        };
        of(0).max(of(1)).max(of(2))
    }

    /// The upper bound of the difference of the means.
    fn bias_bound(&self) -> f64 {
        let of = |i: usize| {
            let RandomSum { sum, squares } = self.noise[i];
            sum.abs().max(SIGMA_LIMIT * squares.sqrt()) / self.weight[i]
        };
        if self.pixels == 0 {
            1.0
        } else {
            MEAN_TOLERANCE + of(0).max(of(1)).max(of(2))
        }
    }

    /// The centroid of the pixels.
    fn centroid(&self) -> [u32; 2] {
        self.places.map(|place| (place / self.pixels as u64) as u32)
    }
}

#[cfg(test)]
mod tests {
    use toyproof_image::pcg;

    use super::*;

    /// An image of 64×64 pixels whose colors rise from left to right. `noise` of a pixel is in standard
    /// deviations of 0.05.
    fn pairs(noise: impl Fn([u32; 2]) -> f64, mistake: f64) -> Vec<[RandomPixel; 2]> {
        let pixel = |at: [u32; 2]| {
            let mean = 0.25 + f64::from(at[0]) / 128.0;
            RandomPixel {
                at,
                rendered: [mean + mistake + 0.05 * noise(at); 3],
                reference: [mean + 0.05 * normal(at[1] * 64 + at[0] + 4096); 3],
                mean: [mean; 3],
                variance: [0.0025; 3],
                tone_map_bias: [0.0; 3],
            }
        };
        let places = (0..32 * 64).map(|at| [2 * (at % 32), at / 32]);
        places.map(|[x, y]| [pixel([x, y]), pixel([x + 1, y])]).collect()
    }

    /// The sum of twelve uniform numbers minus six: nearly normal, with variance 1.
    fn normal(of: u32) -> f64 {
        let uniform = |i| f64::from(pcg(pcg(of) ^ i)) / f64::from(u32::MAX);
        (0..12).map(uniform).sum::<f64>() - 6.0
    }

    fn own([x, y]: [u32; 2]) -> f64 {
        normal(y * 64 + x)
    }

    fn of(pairs: &[[RandomPixel; 2]]) -> MeanTest {
        means(pairs, [64, 64])
    }

    #[test]
    fn noise_with_the_same_mean_is_not_significant() {
        let MeanTest::Same(bias_bound) = of(&pairs(own, 0.0)) else {
            panic!();
        };
        // 4.5 · 0.05 / √4096, plus the tolerance.
        assert!((0.0035..0.0040).contains(&bias_bound), "{bias_bound}");
        assert!(
            matches!(of(&pairs(|at| 0.5 * own(at), 0.0)), MeanTest::Same(_)),
            "less noise"
        );
        assert!(matches!(of(&pairs(own, MEAN_TOLERANCE)), MeanTest::Same(_)));
    }

    #[test]
    fn a_bias_below_the_noise_level_is_detected() {
        for mistake in [0.005, -0.005] {
            assert!(
                matches!(of(&pairs(own, mistake)), MeanTest::Different(_)),
                "{mistake}"
            );
        }
        // Like a shadow that is too wide: alternately brighter and darker, so that the sum is near 0.
        let waves = |at: [u32; 2]| own(at) + if at[1] % 8 < 4 { 0.4 } else { -0.4 };
        assert!(matches!(of(&pairs(waves, 0.0)), MeanTest::Different(_)));
        let MeanTest::Different([x, y]) = of(&pairs(
            |at| own(at) + f64::from(u8::from(at[0] > 55 && at[1] < 8)),
            0.0,
        )) else {
            panic!();
        };
        assert!(x > 55 && y < 8, "({x}, {y})");
    }

    #[test]
    fn shared_noise_is_not_a_bias() {
        assert_eq!(of(&pairs(|_| 1.0, 0.0)), MeanTest::Correlated);
        let shared = |at: [u32; 2]| 0.9 + 0.43 * own(at);
        assert_eq!(of(&pairs(shared, 0.0)), MeanTest::Correlated);
    }

    #[test]
    fn a_shader_with_the_scenes_random_numbers_is_recognized() {
        let scenes = |[x, y]: [u32; 2]| normal(y * 64 + x + 4096);
        assert!(uses_scene_numbers(&pairs(scenes, 0.0)));
        assert!(uses_scene_numbers(&pairs(
            |at| 0.8 * scenes(at) + 0.6 * own(at),
            0.02
        )));
        assert!(!uses_scene_numbers(&pairs(own, 0.0)));
    }

    #[test]
    fn few_pixels_or_strong_noise_are_underpowered() {
        let some = pairs(own, 0.0);
        assert_eq!(of(&some[..1999]), MeanTest::Underpowered);
        assert!(matches!(of(&some[..2000]), MeanTest::Same(_)));
        assert_eq!(of(&[]), MeanTest::Underpowered);
        let coarse = some.iter().map(|pair| {
            pair.map(|pixel| RandomPixel {
                rendered: pixel.rendered.map(|part| part + 4.0 * (part - pixel.mean[0])),
                variance: [25.0 * 0.0025; 3],
                ..pixel
            })
        });
        let coarse: Vec<_> = coarse.collect();
        assert_eq!(of(&coarse), MeanTest::Underpowered, "noise of a single sample");
    }
}
