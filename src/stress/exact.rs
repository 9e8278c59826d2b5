//! The exact reference: ray–quadric intersection in integer arithmetic.
//!
//! Each f32 is an integer times a power of two, and so are sums and products of them. Whether a ray hits a
//! surface is the sign of such a number, computed without rounding; roots are then computed to more bits than
//! any tested type has.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

use dashu_int::IBig;
use dashu_int::ops::{Abs, BitTest, SquareRoot};

/// The precision of roots and quotients, in bits: three times that of f64, so that the remainder is far below
/// its last place.
const BITS: usize = 160;

/// The number mantissa · 2^exponent.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Dyadic {
    mantissa: IBig,
    exponent: isize,
}

impl Dyadic {
    /// Converts a float; `None` if it is infinite or NaN.
    fn new(value: f32) -> Option<Self> {
        if !value.is_finite() {
            return None;
        }
        let bits = value.to_bits();
        let (field, fraction) = ((bits >> 23) & 0xff, bits & 0x7f_ffff);
        // A denormal has the exponent of the smallest normal number, and no leading 1.
        let (mantissa, exponent) = match field {
            0 => (fraction, 1),
            _ => (fraction | 0x80_0000, field),
        };
        let mantissa = IBig::from(mantissa);
        Some(Self {
            mantissa: if value.is_sign_negative() {
                -mantissa
            } else {
                mantissa
            },
            exponent: exponent as isize - 150,
        })
    }

    fn sign(&self) -> Ordering {
        self.mantissa.cmp(&IBig::ZERO)
    }

    /// Both mantissas at the smaller exponent.
    fn aligned(&self, other: &Self) -> (IBig, IBig, isize) {
        let exponent = self.exponent.min(other.exponent);
        let shifted = |one: &Self| &one.mantissa << (one.exponent - exponent) as usize;
        (shifted(self), shifted(other), exponent)
    }

    fn bits(&self) -> usize {
        (&self.mantissa).abs().bit_len()
    }

    /// The square root of a non-negative number, rounded down to at least [`BITS`] bits.
    fn sqrt(&self) -> Self {
        let mut shift = (2 * BITS).saturating_sub(self.bits()) as isize;
        // Half of the exponent must be an integer.
        shift += (self.exponent - shift).rem_euclid(2);
        let radicand = (&self.mantissa).abs() << shift as usize;
        Self {
            mantissa: IBig::from(radicand.sqrt()),
            exponent: (self.exponent - shift) / 2,
        }
    }

    /// The quotient by a nonzero number, truncated to at least [`BITS`] bits.
    fn over(&self, other: &Self) -> Self {
        let shift = (BITS + other.bits()).saturating_sub(self.bits());
        Self {
            mantissa: (&self.mantissa << shift) / &other.mantissa,
            exponent: self.exponent - other.exponent - shift as isize,
        }
    }

    fn cmp(&self, other: &Self) -> Ordering {
        let (one, other, _) = self.aligned(other);
        one.cmp(&other)
    }

    /// The number truncated to f64, and the remainder likewise.
    fn pair(&self) -> DoubleDouble {
        let high = self.leading();
        let rest = self - &high.0;
        DoubleDouble {
            high: high.1,
            low: rest.leading().1,
        }
    }

    /// The leading 53 bits, and their value.
    fn leading(&self) -> (Self, f64) {
        let drop = self.bits().saturating_sub(53);
        let cut = (&self.mantissa).abs() >> drop;
        let negative = self.sign() == Ordering::Less;
        let exponent = self.exponent + drop as isize;
        // It has at most 53 bits: the conversion is exact.
        let size = u64::try_from(&cut).unwrap_or(u64::MAX) as f64;
        let value = libm::scalbn(size, exponent as i32);
        let (mantissa, value) = if negative { (-cut, -value) } else { (cut, value) };
        (Self { mantissa, exponent }, value)
    }
}

macro_rules! operation {
    ($trait:ident, $method:ident, $a:ident, $b:ident => $value:expr) => {
        impl $trait for &Dyadic {
            type Output = Dyadic;

            fn $method(self, other: Self) -> Dyadic {
                let ($a, $b) = (self, other);
                $value
            }
        }
    };
}

impl Neg for Dyadic {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            mantissa: -self.mantissa,
            ..self
        }
    }
}

operation!(Add, add, a, b => {
    let (a, b, exponent) = a.aligned(b);
    Dyadic { mantissa: a + b, exponent }
});
operation!(Sub, sub, a, b => {
    let (a, b, exponent) = a.aligned(b);
    Dyadic { mantissa: a - b, exponent }
});
operation!(Mul, mul, a, b => Dyadic {
    mantissa: &a.mantissa * &b.mantissa,
    exponent: a.exponent + b.exponent,
});

/// A number of about a hundred bits: the sum of two f64.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DoubleDouble {
    /// The leading 53 bits.
    pub high: f64,
    /// The next 53 bits.
    pub low: f64,
}

impl DoubleDouble {
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
fn solve(a: &Dyadic, b: &Dyadic, c: &Dyadic, disc: &Dyadic) -> Vec<Dyadic> {
    let zero = |number: &Dyadic| number.sign() == Ordering::Equal;
    if disc.sign() == Ordering::Less || (zero(a) && zero(b)) {
        return Vec::new();
    }
    if zero(a) {
        return vec![c.over(&(b + b))];
    }
    let root = disc.sqrt();
    let q = if b.sign() == Ordering::Less {
        b - &root
    } else {
        b + &root
    };
    if zero(&q) {
        return vec![q.clone(), q];
    }
    let mut roots = vec![c.over(&q), q.over(a)];
    roots.sort_by(Dyadic::cmp);
    roots
}

/// `unit` normalizes the discriminant.
fn intersect(a: &Dyadic, b: &Dyadic, c: &Dyadic, unit: &Dyadic) -> Intersection {
    let disc = &(b * b) - &(a * c);
    let roots = solve(a, b, c, &disc);
    let ahead = roots.iter().find(|t| t.sign() == Ordering::Greater);
    Intersection {
        t: ahead.map(Dyadic::pair),
        roots: roots.iter().map(Dyadic::pair).collect(),
        discriminant: if unit.sign() == Ordering::Equal {
            0.0
        } else {
            disc.over(unit).pair().high
        },
    }
}

fn vector(v: [f32; 3]) -> Option<[Dyadic; 3]> {
    let [x, y, z] = v.map(Dyadic::new);
    Some([x?, y?, z?])
}

fn dot(u: &[Dyadic; 3], v: &[Dyadic; 3]) -> Dyadic {
    &(&(&u[0] * &v[0]) + &(&u[1] * &v[1])) + &(&u[2] * &v[2])
}

/// Intersects the ray from o along d, of any length, with the sphere of center c and radius r; `None` if a
/// part is infinite or NaN.
#[must_use]
pub fn sphere(o: [f32; 3], d: [f32; 3], c: [f32; 3], r: f32) -> Option<Intersection> {
    let (o, d, c, r) = (vector(o)?, vector(d)?, vector(c)?, Dyadic::new(r)?);
    let f = [0, 1, 2].map(|i| &o[i] - &c[i]);
    let toward = [0, 1, 2].map(|i| &c[i] - &o[i]);
    let r2 = &r * &r;
    let a = dot(&d, &d);
    let unit = &a * &r2;
    Some(intersect(&a, &dot(&toward, &d), &(&dot(&f, &f) - &r2), &unit))
}

/// Intersects it with the quadric q·p² + 2 g z + k = 0, where p² is taken by component.
#[must_use]
pub fn quadric(o: [f32; 3], d: [f32; 3], q: [f32; 3], g: f32, k: f32) -> Option<Intersection> {
    let (o, d, q) = (vector(o)?, vector(d)?, vector(q)?);
    let (g, k) = (Dyadic::new(g)?, Dyadic::new(k)?);
    let weighted = |u: &[Dyadic; 3], v: &[Dyadic; 3]| dot(&[0, 1, 2].map(|i| &q[i] * &u[i]), v);
    let half = &weighted(&d, &o) + &(&g * &d[2]);
    let b = -half;
    let gz = &g * &o[2];
    let c = &(&weighted(&o, &o) + &(&gz + &gz)) + &k;
    let a = weighted(&d, &d);
    let unit = &dot(&d, &d) * &dot(&q, &q);
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
