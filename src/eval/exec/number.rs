//! The number types that a shader is evaluated in.

use std::fmt::Debug;
use std::ops::Neg;

use toyproof_image::{Image, Texture};
use toyproof_math::double;
use toyproof_math::native::{self, flush};

/// Applies a function to the numbers in each lane. A macro, since a function or a closure is a call in the
/// loop if it is large.
macro_rules! each {
    ($function:expr, $($x:expr),+) => {{
        let mut results = [Default::default(); L];
        for lane in 0..L {
            results[lane] = $function($($x[lane]),+);
        }
        results
    }};
}

/// A floating-point format of the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[doc(hidden)]
pub enum FloatFormat {
    /// 32 bits.
    Single,
    /// 64 bits.
    Double,
}

macro_rules! define_number {
    (
        $($exact:ident: $exact_double:path, $exact_single:path, $doc:literal;)*
        ---
        $($method:ident: $double:path, $single:path;)*
    ) => {
        /// The operations of a number type: f32 with denormals flushed and the expanded functions of
        /// [`toyproof_math`], as in strict shaders; f64 with functions as accurate as libm's; or f64 with
        /// random rounding.
        pub trait Arithmetic: Copy + Debug + Default + PartialOrd + Send + Sync + 'static {
            /// An additional operand of each rounded operation: the seed of random rounding, or nothing.
            type Noise: Copy + Debug + Default + Send + Sync;

            /// The format whose machine code has the bits of these operations; none if they are not the
            /// processor's.
            #[doc(hidden)]
            const FORMAT: Option<FloatFormat>;

            /// Converts to the nearest number of this type.
            #[must_use]
            fn from_f64(value: f64) -> Self;
            /// Converts from f32, exactly.
            #[must_use]
            fn from_f32(value: f32) -> Self;
            /// A texture with these texels, bottom row first, in the precision of this type.
            #[must_use]
            fn texture(size: [u32; 2], texels: Vec<[Self; 4]>) -> Texture;
            /// Converts to f64, exactly.
            fn to_f64(self) -> f64;
            /// Converts to the nearest f32.
            fn to_f32(self) -> f32;
            /// Whether the number is NaN.
            fn is_nan(self) -> bool;
            /// Returns `yes` where the bits of the mask are set, `no` where they are clear, bit by bit.
            #[must_use]
            fn blend(mask: u32, yes: Self, no: Self) -> Self;

            /// `self + other`
            #[must_use]
            fn add(self, other: Self, noise: Self::Noise) -> Self;
            /// `self − other`
            #[must_use]
            fn sub(self, other: Self, noise: Self::Noise) -> Self;
            /// `self · other`
            #[must_use]
            fn mul(self, other: Self, noise: Self::Noise) -> Self;
            /// `self / other`
            #[must_use]
            fn div(self, other: Self, noise: Self::Noise) -> Self;
            /// √self
            #[must_use]
            fn sqrt(self, noise: Self::Noise) -> Self;
            $(
                #[doc = $doc]
                #[must_use]
                fn $exact(self) -> Self;
            )*
            $(
                #[doc = concat!("`", stringify!($method), "` of each number")]
                #[must_use]
                fn $method<const L: usize>(x: [Self; L], noise: Self::Noise) -> [Self; L];
            )*
            /// Returns sines and cosines, with the bits that they have alone.
            #[must_use]
            fn sin_cos<const L: usize>(x: [Self; L], noise: Self::Noise) -> ([Self; L], [Self; L]) {
                (Self::sin(x, noise), Self::cos(x, noise))
            }
            /// Returns the angles of the points (x, y), in radians.
            #[must_use]
            fn atan2<const L: usize>(y: [Self; L], x: [Self; L], noise: Self::Noise) -> [Self; L];
            /// Returns x to the power of y for each pair; NaN for a negative base.
            #[must_use]
            fn pow<const L: usize>(x: [Self; L], y: [Self; L], noise: Self::Noise) -> [Self; L];
        }

        impl Arithmetic for f32 {
            type Noise = ();
            const FORMAT: Option<FloatFormat> = Some(FloatFormat::Single);

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as f32
            }
            #[inline(always)]
            fn from_f32(value: f32) -> Self {
                value
            }
            fn texture([width, height]: [u32; 2], texels: Vec<[Self; 4]>) -> Texture {
                Image::new(width, height, texels).into()
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn to_f32(self) -> f32 {
                self
            }
            #[inline(always)]
            fn add(self, other: Self, (): ()) -> Self {
                flush(self + other)
            }
            #[inline(always)]
            fn sub(self, other: Self, (): ()) -> Self {
                flush(self - other)
            }
            #[inline(always)]
            fn mul(self, other: Self, (): ()) -> Self {
                flush(self * other)
            }
            #[inline(always)]
            fn div(self, other: Self, (): ()) -> Self {
                flush(self / other)
            }
            // The root of a normal number is normal: no flush is needed.
            #[inline(always)]
            fn sqrt(self, (): ()) -> Self {
                f32::sqrt(self)
            }
            bits!(f32, i32);
            $(
                #[inline(always)]
                fn $exact(self) -> Self {
                    $exact_single(self)
                }
            )*
            $(
                #[inline(always)]
                fn $method<const L: usize>(x: [Self; L], (): ()) -> [Self; L] {
                    each!($single, x)
                }
            )*
            #[inline(always)]
            fn sin_cos<const L: usize>(x: [Self; L], (): ()) -> ([Self; L], [Self; L]) {
                let (mut sin, mut cos) = ([0.0; L], [0.0; L]);
                for lane in 0..L {
                    (sin[lane], cos[lane]) = native::sin_cos(x[lane]);
                }
                (sin, cos)
            }
            #[inline(always)]
            fn atan2<const L: usize>(y: [Self; L], x: [Self; L], (): ()) -> [Self; L] {
                each!(native::atan2, y, x)
            }
            #[inline(always)]
            fn pow<const L: usize>(x: [Self; L], y: [Self; L], (): ()) -> [Self; L] {
                each!(native::pow, x, y)
            }
        }

        impl Arithmetic for f64 {
            type Noise = ();
            const FORMAT: Option<FloatFormat> = Some(FloatFormat::Double);

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value
            }
            #[inline(always)]
            fn from_f32(value: f32) -> Self {
                f64::from(value)
            }
            fn texture([width, height]: [u32; 2], texels: Vec<[Self; 4]>) -> Texture {
                Image::new(width, height, texels).into()
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self
            }
            #[inline(always)]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[inline(always)]
            fn add(self, other: Self, (): ()) -> Self {
                self + other
            }
            #[inline(always)]
            fn sub(self, other: Self, (): ()) -> Self {
                self - other
            }
            #[inline(always)]
            fn mul(self, other: Self, (): ()) -> Self {
                self * other
            }
            #[inline(always)]
            fn div(self, other: Self, (): ()) -> Self {
                self / other
            }
            #[inline(always)]
            fn sqrt(self, (): ()) -> Self {
                f64::sqrt(self)
            }
            bits!(f64, i64);
            $(
                #[inline(always)]
                fn $exact(self) -> Self {
                    $exact_double(self)
                }
            )*
            $(
                #[inline(always)]
                fn $method<const L: usize>(x: [Self; L], (): ()) -> [Self; L] {
                    $double(x)
                }
            )*
            #[inline(always)]
            fn sin_cos<const L: usize>(x: [Self; L], (): ()) -> ([Self; L], [Self; L]) {
                double::sin_cos(x)
            }
            #[inline(always)]
            fn atan2<const L: usize>(y: [Self; L], x: [Self; L], (): ()) -> [Self; L] {
                each!(libm::atan2, y, x)
            }
            #[inline(always)]
            fn pow<const L: usize>(x: [Self; L], y: [Self; L], (): ()) -> [Self; L] {
                double::pow(x, y)
            }
        }

        impl Arithmetic for RandomRounding {
            type Noise = Seed;
            const FORMAT: Option<FloatFormat> = None;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                Self(value)
            }
            #[inline(always)]
            fn from_f32(value: f32) -> Self {
                Self(f64::from(value))
            }
            fn texture([width, height]: [u32; 2], texels: Vec<[Self; 4]>) -> Texture {
                let texels = texels.into_iter().map(|texel| texel.map(Self::to_f64));
                Image::new(width, height, texels.collect()).into()
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.0
            }
            #[inline(always)]
            fn to_f32(self) -> f32 {
                self.0 as f32
            }
            #[inline(always)]
            fn is_nan(self) -> bool {
                self.0.is_nan()
            }
            #[inline(always)]
            fn blend(mask: u32, yes: Self, no: Self) -> Self {
                Self(f64::blend(mask, yes.0, no.0))
            }
            #[inline(always)]
            fn add(self, other: Self, seed: Seed) -> Self {
                let sum = self.0 + other.0;
                // Knuth's two-sum: the exact error of the sum.
                let part = sum - self.0;
                let error = (self.0 - (sum - part)) + (other.0 - part);
                seed.round_randomly_unless(sum, error == 0.0)
            }
            #[inline(always)]
            fn sub(self, other: Self, seed: Seed) -> Self {
                self.add(other.neg(), seed)
            }
            #[inline(always)]
            fn mul(self, other: Self, seed: Seed) -> Self {
                let product = self.0 * other.0;
                seed.round_randomly_unless(product, self.0.mul_add(other.0, -product) == 0.0)
            }
            #[inline(always)]
            fn div(self, other: Self, seed: Seed) -> Self {
                let quotient = self.0 / other.0;
                seed.round_randomly_unless(quotient, quotient.mul_add(other.0, -self.0) == 0.0)
            }
            #[inline(always)]
            fn sqrt(self, seed: Seed) -> Self {
                let root = self.0.sqrt();
                seed.round_randomly_unless(root, root.mul_add(root, -self.0) == 0.0)
            }
            $(
                #[inline(always)]
                fn $exact(self) -> Self {
                    Self($exact_double(self.0))
                }
            )*
            $(
                #[inline(always)]
                fn $method<const L: usize>(x: [Self; L], seed: Seed) -> [Self; L] {
                    seed.round_unless_whole($double(Self::values(x)))
                }
            )*
            #[inline(always)]
            fn atan2<const L: usize>(y: [Self; L], x: [Self; L], seed: Seed) -> [Self; L] {
                let (y, x) = (Self::values(y), Self::values(x));
                seed.round_unless_whole(each!(libm::atan2, y, x))
            }
            #[inline(always)]
            fn pow<const L: usize>(x: [Self; L], y: [Self; L], seed: Seed) -> [Self; L] {
                seed.round_unless_whole(double::pow(Self::values(x), Self::values(y)))
            }
        }
    };
}

macro_rules! bits {
    ($float:ident, $signed:ident) => {
        #[inline(always)]
        fn blend(mask: u32, yes: Self, no: Self) -> Self {
            let mask = $signed::from(mask.cast_signed()).cast_unsigned();
            $float::from_bits((yes.to_bits() & mask) | (no.to_bits() & !mask))
        }
        #[inline(always)]
        fn is_nan(self) -> bool {
            $float::is_nan(self)
        }
    };
}

/// libm's functions for several arguments.
mod libm_lanes {
    macro_rules! in_lanes {
        ($($name:ident)*) => {$(
            #[inline(always)]
            pub(super) fn $name<const L: usize>(x: [f64; L]) -> [f64; L] {
                each!(libm::$name, x)
            }
        )*};
    }
    in_lanes!(tan asin acos atan sinh cosh tanh asinh acosh atanh exp2 log2);
}

define_number! {
    abs: f64::abs, f32::abs, "Returns the absolute value.";
    neg: Neg::neg, Neg::neg, "`−self`";
    floor: f64::floor, f32::floor, "Rounds down.";
    ceil: f64::ceil, f32::ceil, "Rounds up.";
    trunc: f64::trunc, f32::trunc, "Rounds toward zero.";
    round_even: f64::round_ties_even, f32::round_ties_even, "Rounds to the nearest integer, ties to even.";
    ---
    sin: double::sin, native::sin;
    cos: double::cos, native::cos;
    tan: libm_lanes::tan, native::tan;
    asin: libm_lanes::asin, native::asin;
    acos: libm_lanes::acos, native::acos;
    atan: libm_lanes::atan, native::atan;
    sinh: libm_lanes::sinh, native::sinh;
    cosh: libm_lanes::cosh, native::cosh;
    tanh: libm_lanes::tanh, native::tanh;
    asinh: libm_lanes::asinh, native::asinh;
    acosh: libm_lanes::acosh, native::acosh;
    atanh: libm_lanes::atanh, native::atanh;
    exp: double::exp, native::exp;
    exp2: libm_lanes::exp2, native::exp2;
    log: double::log, native::log;
    log2: libm_lanes::log2, native::log2;
}

/// An f64 whose every inexact result is moved by −1, 0 or +1 units in the last place, of f64 or of f32.
///
/// This is the random rounding of CADNA (Vignes, “Discrete Stochastic Arithmetic”, Numerical Algorithms 37,
/// 2004) and Verrou. Exact results stay exact, or float loop counters would miscount.
#[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd)]
pub struct RandomRounding(pub f64);

impl RandomRounding {
    #[inline(always)]
    fn values<const L: usize>(numbers: [Self; L]) -> [f64; L] {
        each!(Self::to_f64, numbers)
    }
}

/// The number of bits that the significand of f64 has more than that of f32.
const EXTRA_BITS: u32 = f64::MANTISSA_DIGITS - f32::MANTISSA_DIGITS;

/// The seed of a perturbation: the same seed gives the same image.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Seed {
    number: u64,
    /// The unit by which results are moved, as a power of two of f64's unit in the last place.
    unit: u32,
}

impl Seed {
    /// A perturbation by units in the last place of f64.
    #[must_use]
    pub fn double(number: u64) -> Self {
        Self { number, unit: 0 }
    }

    /// A perturbation by units in the last place of f32: what rounding to f32 may change (Parker, “Monte
    /// Carlo Arithmetic”, 1997, calls it a virtual precision).
    #[must_use]
    pub fn single(number: u64) -> Self {
        Self {
            number,
            unit: EXTRA_BITS,
        }
    }

    /// Rounds the results of a function; integers are exact.
    #[inline(always)]
    fn round_unless_whole<const L: usize>(self, values: [f64; L]) -> [RandomRounding; L] {
        let mut rounded = [RandomRounding::default(); L];
        for lane in 0..L {
            let value = values[lane];
            rounded[lane] = self.round_randomly_unless(value, value.fract() == 0.0);
        }
        rounded
    }

    #[inline(always)]
    fn round_randomly_unless(self, value: f64, is_exact: bool) -> RandomRounding {
        let bits = value.to_bits();
        // Two iterations of xor-folding and 32×32-bit multiplication, which vectorize.
        let seed = self.number.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32;
        let mut hash = low(bits ^ bits >> 32 ^ seed) * 0x9e37_79b9;
        hash = low(hash ^ hash >> 32) * 0x85eb_ca6b;
        // −1, 0 and +1 with equal probability: the third of the 32-bit range that the hash lies in. The upper
        // half of a product is not uniform by itself: it never exceeds the factor.
        let third = (low(hash ^ hash >> 32) * 3) >> 32;
        let step = third.wrapping_sub(1) << self.unit;
        let moved = f64::from_bits(bits.wrapping_add(step));
        let size = value.abs();
        let unchanged = is_exact || !(size > f64::MIN_POSITIVE && size < f64::MAX);
        RandomRounding(if unchanged { value } else { moved })
    }
}

/// Returns the lower 32 bits.
#[inline(always)]
fn low(word: u64) -> u64 {
    word & 0xffff_ffff
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn denormals_are_flushed_to_signed_zeros() {
        let half = f32::MIN_POSITIVE;
        assert_eq!(Arithmetic::mul(half, 0.5, ()).to_bits(), 0);
        assert_eq!(Arithmetic::mul(-half, 0.5, ()).to_bits(), 0x8000_0000);
        assert_eq!(Arithmetic::add(half, 0.0, ()), half);
        assert!(Arithmetic::add(f32::NAN, 0.0, ()).is_nan());
    }

    #[test]
    fn random_rounding_moves_only_inexact_results_by_at_most_one_ulp() {
        let [third, three] = [1.0 / 3.0, 3.0].map(RandomRounding);
        let mut seen = [0; 3];
        for seed in 0..3_000 {
            let moved = Arithmetic::add(third, RandomRounding(0.7), Seed::double(seed)).0;
            let step = moved.to_bits() as i64 - (1.0f64 / 3.0 + 0.7).to_bits() as i64;
            seen[(step + 1) as usize] += 1;
            assert_eq!(Arithmetic::add(three, three, Seed::double(seed)).0, 6.0);
            assert_eq!(
                Arithmetic::div(RandomRounding(6.0), three, Seed::double(seed)).0,
                2.0
            );
            assert_eq!(Arithmetic::sqrt(RandomRounding(9.0), Seed::double(seed)).0, 3.0);
        }
        assert!(seen.iter().all(|&count| count > 800), "{seen:?}");
    }

    #[test]
    fn random_rounding_in_single_precision_moves_results_by_an_ulp_of_f32() {
        let (third, sum) = (RandomRounding(1.0 / 3.0), 1.0f64 / 3.0 + 0.7);
        let moved =
            (0..100).map(|seed| Arithmetic::add(third, RandomRounding(0.7), Seed::single(seed)).0 - sum);
        let largest = moved.fold(0.0, |largest: f64, moved| largest.max(moved.abs()));
        assert_eq!(largest, f64::from(f32::EPSILON));
    }
}
