//! The exact reference: ray–quadric intersection without rounding.
//!
//! Each f32 is an integer times a power of two, and so are sums and products of them. Whether a ray hits a
//! surface is the sign of such a number; roots are then computed to more bits than any tested type has.

use dashu_float::round::mode::Zero;
use dashu_float::{Context, FBig};

/// A number that is computed without rounding: its precision is unlimited.
type Exact = FBig<Zero, 2>;

/// The context of roots and quotients, which are truncated to three times the bits of f64, so that the
/// remainder is far below its last place.
const TRUNCATED: Context<Zero> = Context::new(160);

/// Converts a float; `None` if it is infinite or NaN.
fn exact(value: f32) -> Option<Exact> {
    let number = Exact::try_from(value).ok()?;
    value.is_finite().then(|| unlimited(number))
}

fn unlimited(number: Exact) -> Exact {
    number.with_precision(0).value()
}

/// The quotient by a nonzero number.
fn quotient(dividend: &Exact, divisor: &Exact) -> Exact {
    let quotient = TRUNCATED.div(dividend.repr(), divisor.repr());
    unlimited(TRUNCATED.unwrap_fp(quotient))
}

/// The square root of a number that is not negative.
fn root(number: &Exact) -> Exact {
    unlimited(TRUNCATED.unwrap_fp(TRUNCATED.sqrt(number.repr())))
}

/// A number of about a hundred bits: the sum of two f64.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DoubleDouble {
    /// The leading 53 bits.
    pub high: f64,
    /// The next 53 bits.
    pub low: f64,
}

impl DoubleDouble {
    fn new(number: &Exact) -> Self {
        let high = number.to_f64().value();
        // Finite numbers of this size are f64.
        let rest = Exact::try_from(high).map_or(Exact::ZERO, |high| number - unlimited(high));
        Self {
            high,
            low: rest.to_f64().value(),
        }
    }

    /// The error of `value`, in units in the last place of a number of `digits` binary digits at this
    /// magnitude.
    #[must_use]
    pub fn ulps(self, value: f64, digits: u32) -> f64 {
        let (_, exponent) = libm::frexp(self.high);
        let unit = libm::scalbn(1.0, exponent - digits as i32);
        (((value - self.high) - self.low) / unit).abs()
    }
}

/// The intersections of a ray o + t·d with a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Intersection {
    /// The smallest t > 0.
    pub t: Option<DoubleDouble>,
    /// All t in ascending order: two, equal for a tangent ray; one if the equation is linear.
    pub roots: Vec<DoubleDouble>,
    /// The normalized discriminant: δ = (r² − squared distance of center and line) / r² for spheres, (b² − a
    /// c) / (d·d q·q) for quadrics, which have size 1.
    pub discriminant: f64,
}

/// Solves a t² − 2 b t + c = 0.
fn solve(a: &Exact, b: &Exact, c: &Exact, disc: &Exact) -> Vec<Exact> {
    let zero = Exact::ZERO;
    if *disc < zero || (*a == zero && *b == zero) {
        return Vec::new();
    }
    if *a == zero {
        return vec![quotient(c, &(b + b))];
    }
    let root = root(disc);
    let q = if *b < zero { b - root } else { b + root };
    if q == zero {
        return vec![q.clone(), q];
    }
    let mut roots = vec![quotient(c, &q), quotient(&q, a)];
    roots.sort();
    roots
}

/// `unit` normalizes the discriminant.
fn intersect(a: &Exact, b: &Exact, c: &Exact, unit: &Exact) -> Intersection {
    let disc = b * b - a * c;
    let roots = solve(a, b, c, &disc);
    let ahead = roots.iter().find(|&t| *t > Exact::ZERO);
    Intersection {
        t: ahead.map(DoubleDouble::new),
        roots: roots.iter().map(DoubleDouble::new).collect(),
        discriminant: if *unit == Exact::ZERO {
            0.0
        } else {
            quotient(&disc, unit).to_f64().value()
        },
    }
}

fn vector(v: [f32; 3]) -> Option<[Exact; 3]> {
    let [x, y, z] = v.map(exact);
    Some([x?, y?, z?])
}

fn dot(u: &[Exact; 3], v: &[Exact; 3]) -> Exact {
    &u[0] * &v[0] + &u[1] * &v[1] + &u[2] * &v[2]
}

/// Intersects the ray from o along d, of any length, with the sphere of center c and radius r; `None` if a
/// part is infinite or NaN.
#[must_use]
pub fn sphere(o: [f32; 3], d: [f32; 3], c: [f32; 3], r: f32) -> Option<Intersection> {
    let (o, d, c, r) = (vector(o)?, vector(d)?, vector(c)?, exact(r)?);
    let f = [0, 1, 2].map(|i| &o[i] - &c[i]);
    let toward = [0, 1, 2].map(|i| &c[i] - &o[i]);
    let r2 = &r * &r;
    let a = dot(&d, &d);
    let unit = &a * &r2;
    Some(intersect(&a, &dot(&toward, &d), &(dot(&f, &f) - r2), &unit))
}

/// Intersects it with the quadric q·p² + 2 g z + k = 0, where p² is taken by component.
#[must_use]
pub fn quadric(o: [f32; 3], d: [f32; 3], q: [f32; 3], g: f32, k: f32) -> Option<Intersection> {
    let (o, d, q) = (vector(o)?, vector(d)?, vector(q)?);
    let (g, k) = (exact(g)?, exact(k)?);
    let weighted = |u: &[Exact; 3], v: &[Exact; 3]| dot(&[0, 1, 2].map(|i| &q[i] * &u[i]), v);
    let b = -(weighted(&d, &o) + &g * &d[2]);
    let gz = &g * &o[2];
    let c = weighted(&o, &o) + &gz + &gz + k;
    let a = weighted(&d, &d);
    let unit = dot(&d, &d) * dot(&q, &q);
    Some(intersect(&a, &b, &c, &unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    const AHEAD: [f32; 3] = [0.0, 0.0, -1.0];

    fn highs(intersection: &Intersection) -> Vec<f64> {
        intersection.roots.iter().map(|root| root.high).collect()
    }

    #[test]
    fn sphere_intersections_match_manual_calculation() {
        // Through the center: from distance 6, with radius 1.5.
        let intersection = sphere([0.0; 3], AHEAD, [0.0, 0.0, -6.0], 1.5).unwrap();
        assert_eq!(highs(&intersection), [4.5, 7.5]);
        assert_eq!(
            (intersection.t.unwrap().high, intersection.discriminant),
            (4.5, 1.0)
        );
        // The same ray with a direction of length 2.
        let intersection = sphere([0.0; 3], [0.0, 0.0, -2.0], [0.0, 0.0, -6.0], 1.5).unwrap();
        assert_eq!(highs(&intersection), [2.25, 3.75]);
        // 3-4-5: passing the center at 3/5 of the radius, δ = 1 − 9/25.
        let intersection = sphere([3.0, 0.0, 0.0], AHEAD, [0.0, 0.0, -10.0], 5.0).unwrap();
        assert_eq!(highs(&intersection), [6.0, 14.0]);
        assert!((intersection.discriminant - 16.0 / 25.0).abs() < 1e-15);
        // Tangent, and missing by less than the squares can resolve in floating point.
        let intersection = sphere([1.0, 0.0, 0.0], AHEAD, [0.0, 0.0, -7.0], 1.0).unwrap();
        assert_eq!(
            (highs(&intersection), intersection.discriminant),
            (vec![7.0, 7.0], 0.0)
        );
        let intersection = sphere([1.0, 1e-20, 0.0], AHEAD, [0.0, 0.0, -7.0], 1.0).unwrap();
        assert_eq!(highs(&intersection), [0.0; 0]);
        assert!((intersection.discriminant / -1e-40 - 1.0).abs() < 1e-6);
        // From inside, from the surface, and away from it.
        let t = |o, d| sphere(o, d, [0.0; 3], 2.0).unwrap().t.map(|t| t.high);
        assert_eq!(t([0.0; 3], AHEAD), Some(2.0));
        assert_eq!(t([0.0, 0.0, 2.0], AHEAD), Some(4.0));
        assert_eq!(t([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(t([0.0, 0.0, 3.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(t([0.0, 0.0, 3.0], [0.0; 3]), None);
        assert_eq!(sphere([f32::NAN, 0.0, 0.0], AHEAD, [0.0; 3], 1.0), None);
        assert_eq!(sphere([0.0; 3], AHEAD, [0.0; 3], f32::INFINITY), None);
    }

    #[test]
    fn irrational_roots_have_a_hundred_bits() {
        // Passing the center at 1 with radius 3: √8, here to 33 digits.
        let intersection = sphere([1.0, 0.0, 0.0], AHEAD, [0.0, 0.0, 0.0], 3.0).unwrap();
        let t = intersection.t.unwrap();
        assert_eq!(t.high, 2.828_427_124_746_19);
        assert!((t.low - 2.507_433_435_810_044e-16).abs() < 1e-30, "{t:?}");
    }

    #[test]
    fn quadric_intersections_match_manual_calculation() {
        let along_x = [1.0, 0.0, 0.0];
        // The cylinder x² + y² = 4, across and along.
        let cylinder = |o, d| quadric(o, d, [1.0, 1.0, 0.0], 0.0, -4.0).unwrap();
        assert_eq!(highs(&cylinder([-5.0, 0.0, 9.0], along_x)), [3.0, 7.0]);
        assert_eq!(highs(&cylinder([0.5, 0.0, 9.0], AHEAD)), [0.0; 0]);
        // The cone x² + y² = z², parallel to a generator: a linear equation.
        let cone = |o, d| quadric(o, d, [1.0, 1.0, -1.0], 0.0, 0.0).unwrap();
        assert_eq!(highs(&cone([-4.0, 0.0, 0.0], [1.0, 0.0, 1.0])), [2.0]);
        // Through its apex: a double root.
        assert_eq!(highs(&cone([0.0, 0.0, 3.0], AHEAD)), [3.0, 3.0]);
        // The paraboloid x² + y² = 2 z from above, parallel to its axis.
        let bowl = quadric([2.0, 0.0, 5.0], AHEAD, [1.0, 1.0, 0.0], -1.0, 0.0).unwrap();
        assert_eq!(highs(&bowl), [3.0]);
    }

    #[test]
    fn the_smallest_and_the_largest_floats_are_exact() {
        let tiny = f32::from_bits(1);
        let intersection = sphere([0.0; 3], [0.0, 0.0, -tiny], [0.0, 0.0, -8.0 * tiny], tiny).unwrap();
        assert_eq!(highs(&intersection), [7.0, 9.0]);
        let intersection = sphere([0.0; 3], AHEAD, [0.0, 0.0, -f32::MAX], 1.0).unwrap();
        let near = intersection.roots[0];
        assert_eq!(near.high + near.low, f64::from(f32::MAX));
        assert!(near.high < f64::from(f32::MAX));
    }

    #[test]
    fn ulps_count_steps_between_floats() {
        let third = DoubleDouble {
            high: 1.0 / 3.0,
            low: 1.0 / 54_043_195_528_445_952.0,
        };
        assert!(third.ulps(1.0 / 3.0, 53) < 0.5);
        let nearest = 1.0f32 / 3.0;
        assert!(third.ulps(f64::from(nearest), 24) < 0.5);
        let next = f32::from_bits(nearest.to_bits() + 1);
        let steps = third.ulps(f64::from(next), 24);
        assert!(steps > 0.5 && steps < 1.5, "{steps}");
    }
}
