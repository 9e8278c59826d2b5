//! Two pictures that were drawn by chance, by their means.
//!
//! A pixel of a renderer that draws its samples is a mean of few of them. Another renderer that draws other ones paints another
//! colour there, and the same on the average. Of each pixel the tracer tells its mean and its variance; what is left of a shader's pixel without
//! that mean is noise, if both paint the same. Two facts tell noise from a mistake: noise of many pixels sums up to little,
//! and that of a pixel says nothing of its neighbour's. How strong it is, is the shader's own business. Sums are judged by the sum of their terms' squares,
//! which asks nothing of the distribution but that it is as good as symmetric over many pixels.

/// A pixel that hangs on what is drawn. Components of colours lie in [0, 1].
#[derive(Debug, Clone, Copy)]
pub struct DrawnPixel {
    /// Where, x and y from the bottom left.
    pub at: [u32; 2],
    /// What the shader paints.
    pub painted: [f64; 3],
    /// What the scene's own draws make of it.
    pub reference: [f64; 3],
    /// What the tracer paints on the average.
    pub mean: [f64; 3],
    /// The variance of what it paints once, told from other drawings: what a pixel counts must hang on nothing that it is compared with.
    pub spread: [f64; 3],
    /// How much brighter it is if its samples are all of the drawings': a tone curve makes a mean another one.
    pub gain: [f64; 3],
}

/// What the means of two pictures say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Means {
    /// They are the same, as far as can be seen: this much apart at most, on the average over all pixels.
    Same(f64),
    /// They are not, most of all around this pixel.
    Apart([u32; 2]),
    /// There is too much noise, or there are too few pixels, to see whether they are.
    Unseen,
    /// They may be the same or not: neighbouring pixels draw the same numbers, so that their sums tell little.
    Repeated,
}

/// So many standard deviations are no chance. Some 200 sums are looked at, so that one picture in 700 would be held to be another
/// if they were normal.
const NO_CHANCE: f64 = 4.5;

/// Means that are this much apart are the same: as far as two right formulas may be, for a picture and for its mean.
const SAME: f64 = 2.0 * super::EXACT_TOLERANCE;

/// A pixel counts as if its noise were at least this, or those in which eight drawings have met a sliver by chance not once would count for nearly all.
const LEAST_NOISE: f64 = 0.01;

/// Nothing is said where means that are this much apart, two and a half levels of 8 bits, might not be seen.
const FINEST: f64 = 0.01;

/// Neighbouring pixels may draw the same numbers if the variance of what their noise has not in common is below this share of that of their
/// noise: it is 1 if each pixel draws its own.
const REPEATED: f64 = 0.75;

/// What neighbours have in common is no noise if it is more than so many times the variance of the scene's.
const BEYOND_NOISE: f64 = 4.0;

/// The shader draws the scene's numbers if its noise and the reference's are correlated more than this. It is 0.1 if they have only the mean in common
/// which both are told from.
const THE_SCENES: f64 = 0.5;

/// The picture is looked at whole, and in so many columns and rows.
const BLOCKS: u32 = 8;

/// Fewer pixels of a block make no sum.
const FEWEST: usize = 64;

/// Fewer pixels of a picture say nothing: a mistake in a part of them would not be seen.
const FEWEST_OF_ALL: usize = 4000;

/// Whether the shader draws the scene's numbers: its noise is the reference's, and its pixels are to be those of the scene.
#[must_use]
pub fn follows_scene(pairs: &[[DrawnPixel; 2]]) -> bool {
    correlation(pairs) > THE_SCENES
}

/// Compares a shader with the tracer where chance decides: pairs of neighbouring pixels of a picture of that size.
#[must_use]
pub fn means(pairs: &[[DrawnPixel; 2]], size: [u32; 2]) -> Means {
    let blocks = (0..BLOCKS * BLOCKS).map(|block| {
        let of = |pixel: &&DrawnPixel| {
            let [column, row] = [0, 1].map(|i| pixel.at[i] * BLOCKS / size[i]);
            row * BLOCKS + column == block
        };
        Sum::of(pairs.iter().flatten().filter(of))
    });
    let whole = Sum::of(pairs.iter().flatten());
    let sums = blocks.filter(|block| block.pixels >= FEWEST).chain([whole]);
    let farthest = sums.max_by(|a, b| a.deviations().total_cmp(&b.deviations()));
    let farthest = farthest.unwrap_or(whole);
    let within = whole.within();
    if farthest.deviations().max(common(pairs)) > NO_CHANCE {
        if own_noise(pairs) < REPEATED && !is_beyond_noise(pairs) {
            Means::Repeated
        } else {
            Means::Apart(farthest.middle())
        }
    } else if within > FINEST || whole.pixels < FEWEST_OF_ALL {
        Means::Unseen
    } else {
        Means::Same(within)
    }
}

impl DrawnPixel {
    /// What is left of it without its mean, in each component.
    fn noise(&self, i: usize) -> f64 {
        self.painted[i] - self.mean[i]
    }

    /// What it counts in a sum.
    fn weight(&self, i: usize) -> f64 {
        1.0 / (self.spread[i] + LEAST_NOISE * LEAST_NOISE)
    }
}

/// Terms of a sum, and how far it is from what it should be.
#[derive(Clone, Copy, Default)]
struct Score {
    sum: f64,
    squares: f64,
}

impl Score {
    fn add(&mut self, term: f64) {
        self.sum += term;
        self.squares += term * term;
    }

    /// By how many standard deviations `excess`, of it or beyond what it may be, is more than nothing.
    fn deviations(self, excess: f64) -> f64 {
        if self.squares == 0.0 {
            0.0
        } else {
            excess / self.squares.sqrt()
        }
    }
}

/// The variance of what the noise of neighbours has not in common, as a share of the shader's own. Only pixels with much noise are asked: in
/// others, who draws nothing has none.
fn own_noise(pairs: &[[DrawnPixel; 2]]) -> f64 {
    let (mut own, mut all) = (0.0, 0.0);
    for [a, b] in pairs {
        let noisy = (0..3).filter(|&i| a.spread[i].max(b.spread[i]) > LEAST_NOISE * LEAST_NOISE);
        for i in noisy {
            let weight = (a.weight(i) * b.weight(i)).sqrt();
            own += weight * (a.noise(i) - b.noise(i)).powi(2);
            all += weight * (a.noise(i).powi(2) + b.noise(i).powi(2));
        }
    }
    if all == 0.0 { 1.0 } else { own / all }
}

/// Whether what neighbours have in common is more than all noise that the scene has, whoever shares it.
fn is_beyond_noise(pairs: &[[DrawnPixel; 2]]) -> bool {
    let (mut common, mut noise) = (0.0, 0.0);
    for [a, b] in pairs {
        for i in 0..3 {
            let weight = (a.weight(i) * b.weight(i)).sqrt();
            common += weight * a.noise(i) * b.noise(i);
            noise += weight * f64::midpoint(a.spread[i], b.spread[i]);
        }
    }
    common > BEYOND_NOISE * noise
}

/// The correlation of the shader's noise and the reference's.
fn correlation(pairs: &[[DrawnPixel; 2]]) -> f64 {
    let [mut own, mut both, mut reference] = [0.0; 3];
    for pixel in pairs.iter().flatten() {
        for i in 0..3 {
            let [a, b] = [pixel.noise(i), pixel.reference[i] - pixel.mean[i]];
            let weight = pixel.weight(i);
            own += weight * a * a;
            both += weight * a * b;
            reference += weight * b * b;
        }
    }
    if both <= 0.0 {
        0.0
    } else {
        both / (own * reference).sqrt()
    }
}

/// The covariance of the noise of neighbours in its standard deviations: it has none, if nothing but chance decides.
fn common(pairs: &[[DrawnPixel; 2]]) -> f64 {
    let mut products = Score::default();
    let mut may_be = 0.0;
    for [a, b] in pairs {
        let weight = |i| (a.weight(i) * b.weight(i)).sqrt();
        products.add((0..3).map(|i| weight(i) * a.noise(i) * b.noise(i)).sum());
        let gain = |i: usize| (SAME + a.gain[i].abs()) * (SAME + b.gain[i].abs());
        may_be += (0..3).map(|i| weight(i) * gain(i)).sum::<f64>();
    }
    products.deviations(products.sum - may_be)
}

/// The noise of some pixels together.
#[derive(Clone, Copy, Default)]
struct Sum {
    pixels: usize,
    /// Of x and y.
    places: [u64; 2],
    noise: [Score; 3],
    weight: [f64; 3],
    gain: [f64; 3],
}

impl Sum {
    fn of<'a>(pixels: impl Iterator<Item = &'a DrawnPixel>) -> Self {
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
                sum.gain[i] += weight * pixel.gain[i];
            }
        }
        sum
    }

    /// How far the means are apart in the component in which they are farthest, in standard deviations, beyond what they may be.
    fn deviations(&self) -> f64 {
        let of = |i: usize| {
            let may_be = SAME * self.weight[i] + self.gain[i].abs();
            self.noise[i].deviations(self.noise[i].sum.abs() - may_be)
        };
        of(0).max(of(1)).max(of(2))
    }

    /// How far they may be apart.
    fn within(&self) -> f64 {
        let of = |i: usize| {
            let Score { sum, squares } = self.noise[i];
            sum.abs().max(NO_CHANCE * squares.sqrt()) / self.weight[i]
        };
        if self.pixels == 0 {
            1.0
        } else {
            SAME + of(0).max(of(1)).max(of(2))
        }
    }

    /// The middle of its pixels.
    fn middle(&self) -> [u32; 2] {
        self.places.map(|place| (place / self.pixels as u64) as u32)
    }
}

#[cfg(test)]
mod tests {
    use toyproof_image::pcg;

    use super::*;

    /// A picture of 64×64 whose colours rise from left to right; `noise` is of a pixel, as many standard deviations of 0.05.
    fn pairs(noise: impl Fn([u32; 2]) -> f64, mistake: f64) -> Vec<[DrawnPixel; 2]> {
        let pixel = |at: [u32; 2]| {
            let mean = 0.25 + f64::from(at[0]) / 128.0;
            DrawnPixel {
                at,
                painted: [mean + mistake + 0.05 * noise(at); 3],
                reference: [mean + 0.05 * normal(at[1] * 64 + at[0] + 4096); 3],
                mean: [mean; 3],
                spread: [0.0025; 3],
                gain: [0.0; 3],
            }
        };
        let places = (0..32 * 64).map(|at| [2 * (at % 32), at / 32]);
        places.map(|[x, y]| [pixel([x, y]), pixel([x + 1, y])]).collect()
    }

    /// Twelve uniform numbers, less six: variance 1, about normal.
    fn normal(of: u32) -> f64 {
        let uniform = |i| f64::from(pcg(pcg(of) ^ i)) / f64::from(u32::MAX);
        (0..12).map(uniform).sum::<f64>() - 6.0
    }

    fn own([x, y]: [u32; 2]) -> f64 {
        normal(y * 64 + x)
    }

    fn of(pairs: &[[DrawnPixel; 2]]) -> Means {
        means(pairs, [64, 64])
    }

    #[test]
    fn noise_of_the_same_mean_is_the_same() {
        let Means::Same(within) = of(&pairs(own, 0.0)) else {
            panic!();
        };
        // 4.5 · 0.05 / √4096, and what is the same.
        assert!((0.0035..0.0040).contains(&within), "{within}");
        assert!(
            matches!(of(&pairs(|at| 0.5 * own(at), 0.0)), Means::Same(_)),
            "less noise"
        );
        assert!(matches!(of(&pairs(own, SAME)), Means::Same(_)));
    }

    #[test]
    fn a_mistake_is_seen_through_the_noise() {
        for mistake in [0.005, -0.005] {
            assert!(matches!(of(&pairs(own, mistake)), Means::Apart(_)), "{mistake}");
        }
        // As a shadow that is too wide: brighter and darker by turns, so that nothing is left of the sum.
        let waves = |at: [u32; 2]| own(at) + if at[1] % 8 < 4 { 0.4 } else { -0.4 };
        assert!(matches!(of(&pairs(waves, 0.0)), Means::Apart(_)));
        let Means::Apart([x, y]) = of(&pairs(
            |at| own(at) + f64::from(u8::from(at[0] > 55 && at[1] < 8)),
            0.0,
        )) else {
            panic!();
        };
        assert!(x > 55 && y < 8, "({x}, {y})");
    }

    #[test]
    fn the_same_noise_everywhere_is_no_mistake() {
        assert_eq!(of(&pairs(|_| 1.0, 0.0)), Means::Repeated);
        let shared = |at: [u32; 2]| 0.9 + 0.43 * own(at);
        assert_eq!(of(&pairs(shared, 0.0)), Means::Repeated);
    }

    #[test]
    fn who_draws_the_scenes_numbers_is_not_judged_by_the_mean() {
        let scenes = |[x, y]: [u32; 2]| normal(y * 64 + x + 4096);
        assert!(follows_scene(&pairs(scenes, 0.0)));
        assert!(follows_scene(&pairs(|at| 0.8 * scenes(at) + 0.6 * own(at), 0.02)));
        assert!(!follows_scene(&pairs(own, 0.0)));
    }

    #[test]
    fn too_little_is_no_verdict() {
        let some = pairs(own, 0.0);
        assert_eq!(of(&some[..1999]), Means::Unseen);
        assert!(matches!(of(&some[..2000]), Means::Same(_)));
        assert_eq!(of(&[]), Means::Unseen);
        let coarse = some.iter().map(|pair| {
            pair.map(|pixel| DrawnPixel {
                painted: pixel.painted.map(|part| part + 4.0 * (part - pixel.mean[0])),
                spread: [25.0 * 0.0025; 3],
                ..pixel
            })
        });
        let coarse: Vec<_> = coarse.collect();
        assert_eq!(of(&coarse), Means::Unseen, "as of one sample");
    }
}
