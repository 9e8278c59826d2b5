//! Unevaluated sums of two floats, for the steps that need more than 24 bits.
//!
//! Dekker, "A floating-point technique for extending the available precision" (1971), and Knuth's sum; the product splits its
//! factors by masking bits instead of multiplying. All of it is exact only where nothing is contracted or rearranged.

use super::Float;

/// `hi + lo`. Products, quotients and roots want it normalised: `lo` not much more than half a unit in the last place of `hi`.
#[derive(Debug, Clone, Copy)]
pub(super) struct TwoFloat<F> {
    pub(super) hi: F,
    pub(super) lo: F,
}

impl<F: Float> TwoFloat<F> {
    /// `a + b`, exactly.
    #[inline(always)]
    pub(super) fn sum(a: F, b: F) -> Self {
        let hi = a + b;
        let of_b = hi - a;
        let lo = (a - (hi - of_b)) + (b - of_b);
        Self { hi, lo }
    }

    /// `a + b`, exactly if a is not smaller than b, or has no bits below b's lowest.
    #[inline(always)]
    pub(super) fn ordered_sum(a: F, b: F) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    /// `a·b`, exactly.
    #[inline(always)]
    pub(super) fn product(a: F, b: F) -> Self {
        let hi = a * b;
        let (a_head, b_head) = (head(a), head(b));
        let (a_tail, b_tail) = (a - a_head, b - b_head);
        let lo = ((a_head * b_head - hi) + a_head * b_tail + a_tail * b_head) + a_tail * b_tail;
        Self { hi, lo }
    }

    /// The same sum with a small low part; of a high part that is not the smaller.
    #[inline(always)]
    pub(super) fn normalised(self) -> Self {
        Self::ordered_sum(self.hi, self.lo)
    }

    /// `self·other`, to some 2⁻⁴⁵ of it.
    #[inline(always)]
    pub(super) fn times(self, other: Self) -> Self {
        let product = Self::product(self.hi, other.hi);
        let cross = self.hi * other.lo + self.lo * other.hi;
        Self::ordered_sum(product.hi, product.lo + cross)
    }

    /// `self / other`, to some 2⁻⁴⁴ of it.
    #[inline(always)]
    pub(super) fn over(self, other: Self) -> Self {
        let quotient = self.hi / other.hi;
        let back = Self::product(quotient, other.hi);
        let rest = ((self.hi - back.hi) - back.lo) + (self.lo - quotient * other.lo);
        Self::ordered_sum(quotient, rest / other.hi)
    }

    /// The square root, to some 2⁻⁴⁴ of it; of 0 too.
    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        let root = self.hi.sqrt();
        let back = Self::product(root, root);
        let rest = ((self.hi - back.hi) - back.lo) + self.lo;
        // What is added is nothing beside any root but 0.
        Self::ordered_sum(root, rest / (root + (root + f32::MIN_POSITIVE)))
    }

    /// `a + self`, where a is 0 or not smaller.
    #[inline(always)]
    pub(super) fn below(self, a: F) -> Self {
        let sum = Self::ordered_sum(a, self.hi);
        Self::ordered_sum(sum.hi, sum.lo + self.lo)
    }

    /// `a + self`, whichever is larger.
    #[inline(always)]
    pub(super) fn below_or_above(self, a: F) -> Self {
        let sum = Self::sum(a, self.hi);
        Self::ordered_sum(sum.hi, sum.lo + self.lo)
    }

    /// `yes` where `truth` holds, `no` elsewhere.
    #[inline(always)]
    pub(super) fn select(truth: F::Truth, yes: Self, no: Self) -> Self {
        Self {
            hi: F::select(truth, yes.hi, no.hi),
            lo: F::select(truth, yes.lo, no.lo),
        }
    }

    /// The same with more added to the low part.
    #[inline(always)]
    pub(super) fn plus(self, little: F) -> Self {
        Self {
            hi: self.hi,
            lo: self.lo + little,
        }
    }

    /// A constant.
    #[inline(always)]
    pub(super) fn constant(beside: F, value: f64) -> Self {
        let hi = value as f32;
        Self {
            hi: beside.literal(hi.into()),
            lo: beside.literal(value - f64::from(hi)),
        }
    }

    /// A float.
    #[inline(always)]
    pub(super) fn of(hi: F) -> Self {
        Self {
            hi,
            lo: hi.literal(0.0),
        }
    }

    /// The nearest float, or its neighbour where `lo` is not normalised.
    #[inline(always)]
    pub(super) fn value(self) -> F {
        self.hi + self.lo
    }
}

/// The upper 12 bits of the significand: products of two heads are exact, and so are those with tails.
#[inline(always)]
pub(super) fn head<F: Float>(x: F) -> F {
    F::from_bits(x.to_bits() & 0xFFFF_F000)
}
