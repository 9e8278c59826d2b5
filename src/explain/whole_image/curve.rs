//! Curves that change each color component by itself: the usual ones by their formulas, and any monotone one
//! by isotonic regression.

use toyproof_verify::compare::TOLERANCE;

/// A usual curve, from a component of the expected color to that of the shader, which is in [0, 1].
pub(super) struct Curve {
    pub(super) name: String,
    function: Box<dyn Fn(f64) -> f64 + Sync>,
}

impl Curve {
    pub(super) fn value(&self, component: f64) -> f64 {
        (self.function)(component.max(0.0)).clamp(0.0, 1.0)
    }

    /// The values for all components within a distance of this one, widened by the tolerance.
    pub(super) fn range(&self, component: f64, distance: f64) -> [f64; 2] {
        let [low, high] = [component - distance, component + distance].map(|component| self.value(component));
        [low.min(high) - TOLERANCE, low.max(high) + TOLERANCE]
    }
}

type Function = fn(f64) -> f64;

/// Tone maps.
const TONE_MAPS: [(&str, Function); 6] = [
    ("the tone map c / (1 + c)", |c| c / (1.0 + c)),
    ("the tone map 1 − exp(−c)", |c| 1.0 - (-c).exp()),
    ("the filmic curve of ACES", aces),
    ("the filmic curve of ACES with an exposure of 0.6", |c| {
        aces(0.6 * c)
    }),
    ("the filmic curve of Hable", |c| hable(2.0 * c) / hable(11.2)),
    ("the contrast curve smoothstep(0, 1, c)", smoothstep),
];

/// Narkowicz, "ACES filmic tone mapping curve", 2016.
fn aces(c: f64) -> f64 {
    c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14)
}

/// Hable, "Uncharted 2: HDR lighting", 2010, with its constants; the exposure is 2 and white 11.2.
fn hable(c: f64) -> f64 {
    (c * (0.15 * c + 0.05) + 0.004) / (c * (0.15 * c + 0.5) + 0.06) - 0.02 / 0.3
}

fn smoothstep(c: f64) -> f64 {
    let c = c.clamp(0.0, 1.0);
    c * c * (3.0 - 2.0 * c)
}

/// Encodings for a display, and their inverses.
const ENCODINGS: [(&str, Function); 7] = [
    ("gamma correction with 1/2.2", |c| c.powf(1.0 / 2.2)),
    ("the sRGB curve", srgb),
    ("gamma correction with 1/2, a square root", f64::sqrt),
    ("gamma correction with 1/2.4", |c| c.powf(1.0 / 2.4)),
    ("a power of 2.2, the inverse of gamma correction", |c| c.powf(2.2)),
    ("the inverse of the sRGB curve", inverse_srgb),
    ("a square", |c| c * c),
];

/// The number of encodings that are not inverses, which may follow a tone map.
const FORWARD_ENCODINGS: usize = 4;

/// The encoding of IEC 61966-2-1.
fn srgb(c: f64) -> f64 {
    if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    }
}

fn inverse_srgb(c: f64) -> f64 {
    if c <= 0.040_45 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// The usual curves, the simplest first.
pub(super) fn usual() -> Vec<Curve> {
    let single = ENCODINGS
        .into_iter()
        .chain(TONE_MAPS)
        .map(|(name, function)| Curve {
            name: name.to_owned(),
            function: Box::new(function),
        });
    let forward = &ENCODINGS[..FORWARD_ENCODINGS];
    let both = TONE_MAPS.into_iter().flat_map(|(tone_map, map)| {
        forward.iter().map(move |&(encoding, encode)| Curve {
            name: format!("{tone_map}, followed by {encoding}"),
            function: Box::new(move |c| encode(map(c))),
        })
    });
    single.chain(both).collect()
}

/// A nondecreasing step function that fits some points.
pub(super) struct Isotonic {
    /// x and the value there, sorted by x.
    steps: Vec<[f64; 2]>,
}

/// A block of neighboring points, whose common value is the mean of their values.
struct Block {
    sum: f64,
    count: usize,
}

impl Block {
    fn mean(&self) -> f64 {
        self.sum / self.count as f64
    }
}

impl Isotonic {
    /// Fits points [x, y] that are sorted by x, with the least squares of all nondecreasing functions: pool
    /// adjacent violators (Ayer et al., "An empirical distribution function for sampling with incomplete
    /// information", 1955).
    pub(super) fn fit(points: &[[f64; 2]]) -> Self {
        let mut blocks: Vec<Block> = Vec::new();
        for &[_, y] in points {
            let mut block = Block { sum: y, count: 1 };
            while let Some(before) = blocks.pop_if(|before| before.mean() >= block.mean()) {
                block.sum += before.sum;
                block.count += before.count;
            }
            blocks.push(block);
        }
        let values = blocks
            .iter()
            .flat_map(|block| std::iter::repeat_n(block.mean(), block.count));
        Self {
            steps: points
                .iter()
                .zip(values)
                .map(|(&[x, _], value)| [x, value])
                .collect(),
        }
    }

    /// The values of the neighbors of x, between which every nondecreasing function with these steps is.
    pub(super) fn range(&self, x: f64) -> [f64; 2] {
        let above = self.steps.partition_point(|&[own, _]| own <= x);
        let from = self.steps.partition_point(|&[own, _]| own < x);
        // If x is a step itself, the function is known.
        let low = if from < above {
            from
        } else {
            from.saturating_sub(1)
        };
        let high = if from < above { above - 1 } else { above };
        let value = |at: usize| self.steps[at.min(self.steps.len() - 1)][1];
        [value(low), value(high)]
    }

    /// The value at x: the middle of its range.
    pub(super) fn at(&self, x: f64) -> f64 {
        let [low, high] = self.range(x);
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbors_in_the_wrong_order_are_pooled() {
        let values = |points: &[f64]| -> Vec<f64> {
            let points: Vec<_> = points.iter().enumerate().map(|(x, &y)| [x as f64, y]).collect();
            Isotonic::fit(&points)
                .steps
                .iter()
                .map(|&[_, value]| value)
                .collect()
        };
        assert_eq!(values(&[1.0, 2.0, 4.0]), [1.0, 2.0, 4.0]);
        assert_eq!(values(&[1.0, 4.0, 2.0, 5.0]), [1.0, 3.0, 3.0, 5.0]);
        assert_eq!(values(&[3.0, 2.0, 1.0]), [2.0; 3]);
        let fitted = Isotonic::fit(&[[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [2.0, 4.0]]);
        assert_eq!(fitted.range(1.0), [1.0; 2]);
        assert_eq!(fitted.range(1.5), [1.0, 4.0]);
        assert_eq!([fitted.range(-1.0), fitted.range(3.0)], [[0.0; 2], [4.0; 2]]);
    }

    #[test]
    fn the_usual_curves_are_monotone_and_differ() {
        let all = usual();
        for (at, curve) in all.iter().enumerate() {
            let values: Vec<f64> = (0..=200).map(|c| curve.value(0.01 * f64::from(c))).collect();
            assert!(values.is_sorted(), "{}", curve.name);
            for other in &all[..at] {
                let difference =
                    |c| (curve.value(0.01 * f64::from(c)) - other.value(0.01 * f64::from(c))).abs();
                let most = (0..=100).map(difference).fold(0.0, f64::max);
                assert!(most > 4.0 * TOLERANCE, "{} {}", curve.name, other.name);
            }
        }
    }
}
