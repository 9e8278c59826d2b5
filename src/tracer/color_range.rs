//! The range of colors of a pixel over the ray epsilons that a scene accepts.

use crate::ray_epsilon::{RayEpsilon, RayEpsilons};
use crate::sampler::Sample;
use crate::tracer::Tracer;
use crate::transfer::tone_map;

/// Offsets of the representative policies, as fractions of the scene's largest offset.
const OFFSETS: [f64; 3] = [0.0, 0.1, 1.0];

/// Smallest t of the representative policies, as fractions of the scene's largest offset.
const T_MINS: [f64; 2] = [0.0, 1.0];

/// Iterates over representative policies that cover the accepted range.
fn representatives(max_offset: f64) -> impl Iterator<Item = RayEpsilon> + Clone {
    let of_offset = move |offset: f64| {
        T_MINS.map(|t_min| RayEpsilon {
            offset: offset * max_offset,
            t_min: t_min * max_offset,
            ..RayEpsilon::default()
        })
    };
    OFFSETS.into_iter().flat_map(of_offset)
}

/// Whether both kinds of secondary rays share their epsilons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EpsilonSet {
    /// All rays share them.
    Alike,
    /// Shadow rays may differ from rays that continue: six times as many combinations.
    Mixed,
}

/// The axis-aligned bounding box of a set of colors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorRange {
    /// Smallest value of each component.
    pub low: [f64; 3],
    /// Largest value of each component.
    pub high: [f64; 3],
}

impl ColorRange {
    /// The empty set of colors.
    const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// Returns the largest distance of a component of `color`, clamped to [0, 1], from the clamped range;
    /// infinite for NaN.
    pub fn distance(&self, color: [f64; 3]) -> f64 {
        let outside = |i: usize| {
            let [low, high, value] = [self.low[i], self.high[i], color[i]].map(|v| v.clamp(0.0, 1.0));
            if value.is_nan() {
                f64::INFINITY
            } else {
                (low - value).max(value - high).max(0.0)
            }
        };
        (0..3).map(outside).fold(0.0, f64::max)
    }

    fn include(&mut self, color: [f64; 3]) {
        for (i, component) in color.into_iter().enumerate() {
            self.low[i] = self.low[i].min(component);
            self.high[i] = self.high[i].max(component);
        }
    }
}

impl Tracer<f64> {
    /// Computes the range of colors of the pixel at (x, y) over the representative policies. Each sample has
    /// its own range, and the range of the mean is the mean of those: a shader uses the same policy for all
    /// samples, but the policy affects each sample differently.
    pub fn color_range(&self, x: u32, y: u32, epsilons: EpsilonSet) -> ColorRange {
        let legal = || representatives(self.max_offset);
        let mut sum = ColorRange {
            low: [0.0; 3],
            high: [0.0; 3],
        };
        let count = self.film.samples;
        for index in 0..count {
            let sample = Sample {
                pixel: [x, y],
                index,
                count,
                set: 0,
            };
            // The primary hit does not depend on the policy.
            let (primary, stream) = self.primary(self.film.sampler, sample);
            let mut range = ColorRange::EMPTY;
            for other in legal() {
                if epsilons == EpsilonSet::Alike {
                    range.include(self.radiance(primary, stream.clone(), &other).to_array());
                    continue;
                }
                for light in legal() {
                    let epsilon = RayEpsilons { light, other };
                    range.include(self.radiance(primary, stream.clone(), &epsilon).to_array());
                }
            }
            for i in 0..3 {
                sum.low[i] += range.low[i];
                sum.high[i] += range.high[i];
            }
        }
        let mean = |total: f64| tone_map(&self.film, total / f64::from(count));
        ColorRange {
            low: sum.low.map(mean),
            high: sum.high.map(mean),
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_scene as scene;

    use super::*;

    fn color_range(text: &str) -> (ColorRange, [f64; 3]) {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let tracer = Tracer::<f64>::new(&scene::parse(&files, file).unwrap());
        (tracer.color_range(0, 0, EpsilonSet::Alike), tracer.pixel(0, 0))
    }

    /// One pixel that sees a white floor 1 below the eye; `ball` may occlude the light.
    fn floor(ball: &str) -> String {
        format!(
            "[film]\nsize = [1, 1]\n[camera]\neye = [0, 0, 0]\nscreen_distance = 1\n\
             [[light]]\nposition = [0, 0, 0]\ncolor = [1, 1, 1]\n\
             [[sphere]]\ncenter = [0, 0, -11]\nradius = 10\n\
             material = {{ model = \"lambert\", color = [1, 1, 1] }}\n{ball}"
        )
    }

    #[test]
    fn color_range_is_a_point_away_from_edges() {
        let (range, exact) = color_range(&floor(""));
        assert!(range.distance(exact) == 0.0);
        assert!((0..3).all(|i| range.high[i] - range.low[i] < 1e-12), "{range:?}");
    }

    #[test]
    fn touching_surface_may_or_may_not_cast_a_shadow() {
        // The ball occludes the light at the point of the floor that the ray hits, and is nearer than the
        // offsets and the smallest t.
        let ball = "[[sphere]]\ncenter = [0.000268, 0, -0.999866]\nradius = 0.00005\n\
                    material = { model = \"mirror\", color = [1, 1, 1] }\n";
        let text = floor(ball).replace("position = [0, 0, 0]", "position = [1, 0, -0.5]");
        let (range, exact) = color_range(&text);
        assert_eq!(exact, [0.0; 3]);
        assert_eq!(range.low, [0.0; 3]);
        // Cosine of the light from a point up to 0.001 higher.
        let cosine = 0.5 / 1.25f64.sqrt();
        assert!((range.high[0] - cosine).abs() < 1e-3, "{range:?}");
    }

    #[test]
    fn distance_is_zero_inside_and_infinite_for_nan() {
        let range = ColorRange {
            low: [0.2; 3],
            high: [0.4, 0.4, 7.0],
        };
        assert_eq!(range.distance([0.3, 0.2, 1.5]), 0.0);
        assert!((range.distance([0.3, 0.1, 0.3]) - 0.1).abs() < 1e-15);
        assert_eq!(range.distance([f64::NAN, 0.3, 0.3]), f64::INFINITY);
    }
}
