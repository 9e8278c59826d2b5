//! Unevaluated sums of two floats, for intermediate results of more than 24 bits.
//!
//! Sums and products are those of Dekker, "A floating-point technique for extending the available precision"
//! (1971), and Knuth; the product splits its factors by masking bits instead of multiplying. The results are
//! exact only if operations are not contracted or reordered.

use super::float::Float;

/// `hi + lo`. Products, quotients and roots require it to be normalized: `lo` not much more than half a unit
/// in the last place of `hi`.
#[derive(Debug, Clone, Copy)]
pub(super) struct TwoFloat<F> {
    pub(super) hi: F,
    pub(super) lo: F,
}

impl<F: Float> TwoFloat<F> {
    /// `a + b`, exact.
    #[inline(always)]
    pub(super) fn sum(a: F, b: F) -> Self {
        let hi = a + b;
        let of_b = hi - a;
        let lo = (a - (hi - of_b)) + (b - of_b);
        Self { hi, lo }
    }

    /// `a + b`, exact if |a| ≥ |b| or a has no bits below b's lowest bit.
    #[inline(always)]
    pub(super) fn ordered_sum(a: F, b: F) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    /// `a·b`, exact.
    #[inline(always)]
    pub(super) fn product(a: F, b: F) -> Self {
        let hi = a * b;
        let (a_head, b_head) = (upper_bits(a), upper_bits(b));
        let (a_tail, b_tail) = (a - a_head, b - b_head);
        let lo = ((a_head * b_head - hi) + a_head * b_tail + a_tail * b_head) + a_tail * b_tail;
        Self { hi, lo }
    }

    /// Normalizes the sum, if |hi| ≥ |lo|.
    #[inline(always)]
    pub(super) fn normalized(self) -> Self {
        Self::ordered_sum(self.hi, self.lo)
    }

    /// `self·other`, with a relative error of about 2⁻⁴⁵.
    #[inline(always)]
    pub(super) fn times(self, other: Self) -> Self {
        let product = Self::product(self.hi, other.hi);
        let cross = self.hi * other.lo + self.lo * other.hi;
        Self::ordered_sum(product.hi, product.lo + cross)
    }

    /// `self / other`, with a relative error of about 2⁻⁴⁴.
    #[inline(always)]
    pub(super) fn divided_by(self, other: Self) -> Self {
        let quotient = self.hi / other.hi;
        let back = Self::product(quotient, other.hi);
        let rest = ((self.hi - back.hi) - back.lo) + (self.lo - quotient * other.lo);
        Self::ordered_sum(quotient, rest / other.hi)
    }

    /// The square root, with a relative error of about 2⁻⁴⁴; also of 0.
    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        let root = self.hi.sqrt();
        let back = Self::product(root, root);
        let rest = ((self.hi - back.hi) - back.lo) + self.lo;
        // The added minimum changes no root but 0.
        Self::ordered_sum(root, rest / (root + (root + f32::MIN_POSITIVE)))
    }

    /// `a + self`, for a = 0 or |a| ≥ |self|.
    #[inline(always)]
    pub(super) fn add_to_larger(self, a: F) -> Self {
        let sum = Self::ordered_sum(a, self.hi);
        Self::ordered_sum(sum.hi, sum.lo + self.lo)
    }

    /// `a + self`, for any magnitudes.
    #[inline(always)]
    pub(super) fn add_to(self, a: F) -> Self {
        let sum = Self::sum(a, self.hi);
        Self::ordered_sum(sum.hi, sum.lo + self.lo)
    }

    /// `yes` if `condition` holds, otherwise `no`.
    #[inline(always)]
    pub(super) fn select(condition: F::Bool, yes: Self, no: Self) -> Self {
        Self {
            hi: F::select(condition, yes.hi, no.hi),
            lo: F::select(condition, yes.lo, no.lo),
        }
    }

    /// Adds a small number to the low part.
    #[inline(always)]
    pub(super) fn add_low(self, little: F) -> Self {
        Self {
            hi: self.hi,
            lo: self.lo + little,
        }
    }

    /// Makes a constant from an `f64`.
    #[inline(always)]
    pub(super) fn constant(beside: F, value: f64) -> Self {
        let hi = value as f32;
        Self {
            hi: beside.literal(hi.into()),
            lo: beside.literal(value - f64::from(hi)),
        }
    }

    /// Makes a sum with a zero low part.
    #[inline(always)]
    pub(super) fn from_float(hi: F) -> Self {
        Self {
            hi,
            lo: hi.literal(0.0),
        }
    }

    /// The nearest float, or its neighbor if `lo` is not normalized.
    #[inline(always)]
    pub(super) fn value(self) -> F {
        self.hi + self.lo
    }
}

/// The upper 12 bits of the significand: products of two such values are exact, and so are those with the
/// remaining bits.
#[inline(always)]
fn upper_bits<F: Float>(x: F) -> F {
    F::from_bits(x.to_bits() & 0xFFFF_F000)
}
