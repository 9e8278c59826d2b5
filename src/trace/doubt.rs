//! How far a pixel may lie from the exact answer and still be right.
//!
//! The tracer answers one question exactly; a shader that asks the same question in float32, in a legal style,
//! may get another answer where the question hangs by a hair: at silhouettes and shadow edges, and wherever a
//! mirror enlarges them. [`Tracer::hull`] asks the tracer again with everything moved by a stated bound.

use super::real::{Real, Vector};
use super::sampler::{self, Sample};
use super::{Tracer, film};

/// What is moved, and how far. [`Exact`] moves nothing and costs nothing.
pub(super) trait Doubt<T: Real> {
    /// A sample's fragment coordinate, in pixels, on a side of `side` pixels.
    fn place(&self, place: T, side: u32, axis: u32) -> T;
    /// The number that the sine hash takes the fraction of.
    fn draw(&self, product: T, seed: f64, sine: T, axis: u32) -> T;
    /// A sphere's discriminant, r² less the squared distance of ray and centre; `f2` is |o − c|².
    fn discriminant(&self, disc: T, f2: T) -> T;
    /// A hit.
    fn point(&self, point: T::Vec3, origin: T::Vec3, depth: u32) -> T::Vec3;
    /// The unit normal of a hit on a sphere of that radius.
    fn normal(&self, normal: T::Vec3, point: T::Vec3, radius: T, depth: u32) -> T::Vec3;
    /// What is taken for d·d of a ray's direction.
    fn squared_length(&self, length2: T) -> T;
    /// How far along the normal a secondary ray starts off its surface, in scene units.
    fn offset(&self) -> T;
    /// Hits must lie beyond this t; that of camera rays is 0.
    fn t_min(&self, secondary: bool) -> T;
}

/// The scene as it is.
pub(super) struct Exact;

impl<T: Real> Doubt<T> for Exact {
    fn place(&self, place: T, _: u32, _: u32) -> T {
        place
    }
    fn draw(&self, product: T, _: f64, _: T, _: u32) -> T {
        product
    }
    fn discriminant(&self, disc: T, _: T) -> T {
        disc
    }
    fn point(&self, point: T::Vec3, _: T::Vec3, _: u32) -> T::Vec3 {
        point
    }
    fn normal(&self, normal: T::Vec3, _: T::Vec3, _: T, _: u32) -> T::Vec3 {
        normal
    }
    fn squared_length(&self, length2: T) -> T {
        length2
    }
    fn offset(&self) -> T {
        T::zero()
    }
    fn t_min(&self, _: bool) -> T {
        T::zero()
    }
}

/// The unit roundoff of float32.
const U: f64 = 1.0 / (1 << 24) as f64;
/// The textbook discriminant's error in units of u·|o − c|²: measured at most 8.5, bounded by 20.
const DISCRIMINANT: f64 = 20.0;
/// A hit's error in units of u times the size of its coordinates, apart from what the discriminant does to it:
/// the direction's rounding, the product and the sum; measured at most 7.
const POINT: f64 = 7.0;
/// A fragment coordinate's error in units of u times the picture's side: the sum with the jitter, and the quotient,
/// product and difference that make it a place on the screen, each rounded by at most u.
const PLACE: f64 = 4.0;

/// Starts off the surface that shaders use, in scene units, and the smallest t that they accept.
const OFFSETS: [f64; 3] = [0.0, 1e-4, 1e-3];
const T_MINS: [f64; 2] = [0.0, 1e-3];
/// Shares of the bounds. Colours are not monotonous in what is moved: a ray that the whole bound turns from a
/// hit into a miss is turned by less into one that barely hits.
const SCALES: [f64; 4] = [1.0, 0.5, 0.25, 0.125];

/// The style of secondary rays, and everything moved by a share of its bound.
struct Moved {
    offset: f64,
    t_min: f64,
    scale: f64,
    signs: Signs,
    /// Whether a ray that may hit or miss is taken to graze.
    grazes: bool,
}

#[derive(Clone, Copy)]
enum Signs {
    Plus,
    Minus,
    /// Drawn by hashing.
    Mixed(u32),
}

impl Moved {
    const NOT: Self = Self {
        offset: 0.0,
        t_min: 0.0,
        scale: 0.0,
        signs: Signs::Plus,
        grazes: false,
    };

    /// A signed share of a bound, for each role in the picture another sign.
    fn share(&self, role: u32) -> f64 {
        let positive = match self.signs {
            Signs::Plus => true,
            Signs::Minus => false,
            // Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
            Signs::Mixed(salt) => (salt * 64 + role).wrapping_mul(2_654_435_769) >> 31 == 0,
        };
        if positive { self.scale } else { -self.scale }
    }
}

/// Every style with nothing moved and with everything moved one way or the other; in the exact style all
/// shares and signs.
fn variants() -> impl Iterator<Item = Moved> {
    let styles = OFFSETS.into_iter().flat_map(|offset| {
        T_MINS.into_iter().flat_map(move |t_min| {
            let style = move |scale, signs| Moved {
                offset,
                t_min,
                scale,
                signs,
                grazes: false,
            };
            [
                style(0.0, Signs::Plus),
                style(1.0, Signs::Plus),
                style(1.0, Signs::Minus),
            ]
        })
    });
    let moves = SCALES.into_iter().zip(1..).flat_map(|(scale, salt)| {
        [
            Signs::Plus,
            Signs::Minus,
            Signs::Mixed(2 * salt),
            Signs::Mixed(2 * salt + 1),
        ]
        .into_iter()
        .zip([false, false, false, true])
        .map(move |(signs, grazes)| Moved {
            scale,
            signs,
            grazes,
            ..Moved::NOT
        })
    });
    let grazing = [Moved {
        grazes: true,
        ..Moved::NOT
    }];
    styles.chain(moves).chain(grazing)
}

impl Doubt<f64> for Moved {
    fn place(&self, place: f64, side: u32, axis: u32) -> f64 {
        place + self.share(axis) * PLACE * U * f64::from(side)
    }

    fn draw(&self, product: f64, seed: f64, sine: f64, axis: u32) -> f64 {
        product + self.share(axis) * sampler::draw_bound(seed, sine)
    }

    fn discriminant(&self, disc: f64, f2: f64) -> f64 {
        let bound = DISCRIMINANT * U * f2;
        // Between a miss and a hit lies the ray that grazes, whose colour may be like neither's.
        if self.grazes && disc.abs() <= bound {
            0.0
        } else {
            disc + self.share(2) * bound
        }
    }

    fn point(&self, point: glam::DVec3, origin: glam::DVec3, depth: u32) -> glam::DVec3 {
        let size = origin.abs().max_element().max(point.abs().max_element());
        let signs = [0, 1, 2].map(|axis| self.share(3 + 3 * (depth % 16) + axis));
        point + glam::DVec3::from_array(signs) * (POINT * U * size)
    }

    /// (P − c)/r is as far from length 1 as P from the sphere. A mirror makes the same of the ray's direction, and a
    /// shader that takes d·d for 1 goes astray by it, at every bounce by more.
    fn normal(&self, normal: glam::DVec3, point: glam::DVec3, radius: f64, depth: u32) -> glam::DVec3 {
        let share = self.share(52 + depth % 8);
        normal * (1.0 + share * POINT * U * point.abs().max_element() / radius)
    }

    fn squared_length(&self, length2: f64) -> f64 {
        if self.scale > 0.0 { 1.0 } else { length2 }
    }

    fn offset(&self) -> f64 {
        self.offset
    }

    fn t_min(&self, secondary: bool) -> f64 {
        if secondary { self.t_min } else { 0.0 }
    }
}

/// The smallest box that holds all answers, component by component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hull {
    /// The smallest of each component.
    pub low: [f64; 3],
    /// The largest of each component.
    pub high: [f64; 3],
}

impl Hull {
    /// How far `color`, clamped to [0, 1], lies outside of the clamped hull, by the component that is
    /// farthest; infinite for NaN.
    #[must_use]
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
}

impl Tracer<f64> {
    /// The colours that the pixel at (x, y) may have: with every legal style of secondary ray, and with
    /// everything moved by what float32 may move it, in each of several patterns of signs. Samples are
    /// moved one by one, so that the mean's hull is the mean of their hulls.
    ///
    /// It is no proof: signs are drawn, not exhausted, and a path that a scene enlarges by more than the bounds
    /// foresee may leave it.
    #[must_use]
    pub fn hull(&self, x: u32, y: u32) -> Hull {
        let mut sum = Hull {
            low: [0.0; 3],
            high: [0.0; 3],
        };
        let count = self.film.samples;
        for index in 0..count {
            let mut low = [f64::INFINITY; 3];
            let mut high = [f64::NEG_INFINITY; 3];
            for moved in variants() {
                let sample = Sample {
                    pixel: [x, y],
                    index,
                    count,
                    set: 0,
                };
                let color = self.sample(sample, &moved).to_array();
                for i in 0..3 {
                    low[i] = low[i].min(color[i]);
                    high[i] = high[i].max(color[i]);
                }
            }
            for i in 0..3 {
                sum.low[i] += low[i];
                sum.high[i] += high[i];
            }
        }
        let mean = |total: f64| film::develop(&self.film, total / f64::from(count));
        Hull {
            low: sum.low.map(mean),
            high: sum.high.map(mean),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;
    use crate::source::{File, Files};

    fn tracer(text: &str) -> Tracer<f64> {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        Tracer::new(&scene::parse(&files, file).unwrap())
    }

    const SPHERE: &str = "[film]\nsize = [64, 36]\n[[sphere]]\ncenter = [0, 0, -6]\nradius = 1.5\n\
                          material = { model = \"facing\", color = [1, 1, 0] }\n";

    fn width(hull: &Hull) -> f64 {
        (0..3).map(|i| hull.high[i] - hull.low[i]).fold(0.0, f64::max)
    }

    #[test]
    fn away_from_edges_the_hull_is_the_answer() {
        let tracer = tracer(SPHERE);
        let (hull, exact) = (tracer.hull(32, 18), tracer.pixel(32, 18));
        assert!(hull.distance(exact) == 0.0 && width(&hull) < 1e-4, "{hull:?}");
    }

    #[test]
    fn a_ray_that_grazes_within_the_bound_may_hit_or_miss() {
        // The pixel's ray passes 1e−6 inside the silhouette of a sphere of radius 3 at distance 6 sideways.
        let text = "[film]\nsize = [1, 1]\n[background]\ncolor = [1, 1, 1]\n[[sphere]]\ncenter = [3.0, 0, -6]\n\
                    radius = 3.000001\nmaterial = { model = \"facing\", color = [0, 0, 0] }\n";
        let hull = tracer(text).hull(0, 0);
        assert_eq!((hull.low[0], hull.high[0]), (0.0, 1.0));
        let clear = text.replace("3.000001", "2.999");
        assert_eq!(width(&tracer(&clear).hull(0, 0)), 0.0);
    }

    #[test]
    fn the_distance_is_zero_inside_and_infinite_for_nan() {
        let hull = Hull {
            low: [0.2; 3],
            high: [0.4, 0.4, 7.0],
        };
        assert_eq!(hull.distance([0.3, 0.2, 1.5]), 0.0);
        assert!((hull.distance([0.3, 0.1, 0.3]) - 0.1).abs() < 1e-15);
        assert_eq!(hull.distance([f64::NAN, 0.3, 0.3]), f64::INFINITY);
    }
}
