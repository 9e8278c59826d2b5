//! Floats with a significand of 160 bits: the reference where f64 may be wrong.

use std::cell::RefCell;
use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_4;

use dashu_float::math::cache::ConstCache;
use dashu_float::round::mode::HalfEven;
use dashu_float::{Context, FBig, FpResult, Repr};
use dashu_int::{IBig, Sign, UBig};
use toyproof_image::{Image, Texture};
use toyproof_math::double;

use crate::exec::number::{Arithmetic, FloatFormat};

type Big = FBig<HalfEven, 2>;

const WORDS: usize = 3;

/// More than the precision, because the library's sums may have a bit more.
const STORED_BITS: usize = WORDS * u64::BITS as usize;

const CONTEXT: Context<HalfEven> = Context::new(Wide::BITS as usize);

/// Larger numbers are infinite, and those below the reciprocal are 0: far beyond the range of f64, so that
/// squares do not overflow, and close enough that angles of any size are reduced in time.
const MAX_EXPONENT: isize = 1 << 14;

/// A float with a significand of 160 bits, whose operations and functions are correctly rounded. Denormals of
/// f64 are normal numbers.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wide {
    /// 1 or −1, the sign of a finite number other than 0; any other number itself.
    class: f64,
    /// The number is ± 0.significand · 2^exponent.
    exponent: i32,
    /// From the highest word, whose highest bit is set, to the lowest.
    significand: [u64; WORDS],
}

thread_local! {
    /// The digits of π and ln 2 that were needed so far.
    static CONSTANTS: RefCell<ConstCache> = const { RefCell::new(ConstCache::new()) };
}

impl Wide {
    /// The precision: three times that of f64.
    pub const BITS: u32 = 160;

    /// 0, an infinity or NaN.
    fn special(class: f64) -> Self {
        Self {
            class,
            ..Self::default()
        }
    }

    fn new(big: Big) -> Self {
        let repr = big.into_repr();
        let class = match repr.sign() {
            Sign::Positive => 1.0,
            Sign::Negative => -1.0,
        };
        if repr.is_infinite() {
            return Self::special(class * f64::INFINITY);
        }
        let digits = repr.digits();
        let exponent = repr.exponent().saturating_add(digits as isize);
        if digits == 0 || exponent < -MAX_EXPONENT {
            return Self::special(class * 0.0);
        }
        if exponent > MAX_EXPONENT {
            return Self::special(class * f64::INFINITY);
        }
        let magnitude = repr.into_parts().0.into_parts().1;
        let bytes = (magnitude << (STORED_BITS - digits)).to_be_bytes();
        let mut significand = [0; WORDS];
        for (word, bytes) in significand.iter_mut().zip(bytes.chunks_exact(size_of::<u64>())) {
            *word = bytes.iter().fold(0, |word, &byte| word << 8 | u64::from(byte));
        }
        Self {
            class,
            exponent: exponent as i32,
            significand,
        }
    }

    /// Whether the number is finite and not 0.
    fn is_regular(self) -> bool {
        self.significand != [0; WORDS]
    }

    /// The same number; 0 for NaN.
    fn repr(self) -> Repr<2> {
        if !self.is_regular() {
            return Big::try_from(self.class).map_or(Repr::zero(), Big::into_repr);
        }
        let sign = if self.class < 0.0 {
            Sign::Negative
        } else {
            Sign::Positive
        };
        let bytes = self.significand.map(u64::to_be_bytes);
        let magnitude = UBig::from_be_bytes(bytes.as_flattened());
        Repr::new(
            IBig::from_parts(sign, magnitude),
            self.exponent as isize - STORED_BITS as isize,
        )
    }

    /// A result; `otherwise` where the library has none, as beyond a function's domain.
    fn result(result: FpResult<Big>, otherwise: f64) -> Self {
        match result {
            Ok(big) => Self::new(big.value()),
            Err(_) => Self::special(otherwise),
        }
    }

    /// Applies an operation. It is applied to the classes of numbers that are infinite or NaN, and of zeros
    /// for the sign.
    fn operate(
        self,
        other: Self,
        of_classes: f64,
        operation: fn(&Context<HalfEven>, &Repr<2>, &Repr<2>) -> FpResult<Big>,
    ) -> Self {
        if !(self.class.is_finite() && other.class.is_finite()) {
            return Self::special(of_classes);
        }
        let result = Self::result(operation(&CONTEXT, &self.repr(), &other.repr()), of_classes);
        if result.class == 0.0 {
            Self::special(0.0f64.copysign(of_classes))
        } else {
            result
        }
    }

    /// Applies a function. `double` is the same in f64, for infinities, NaN, and results that are.
    fn apply(
        self,
        double: fn(f64) -> f64,
        function: impl Fn(&Repr<2>, Option<&mut ConstCache>) -> FpResult<Big>,
    ) -> Self {
        if !self.class.is_finite() {
            return Self::special(double(self.class));
        }
        let result = CONSTANTS.with_borrow_mut(|constants| function(&self.repr(), Some(constants)));
        Self::result(result, double(self.to_f64()))
    }

    /// Rounds to an integer, which has the sign of the number.
    fn rounded(self, round: impl Fn(&Big) -> Big) -> Self {
        let is_fractional = self.is_regular() && self.exponent < Self::BITS as i32;
        if !is_fractional {
            return self;
        }
        let rounded = Self::new(round(&Big::from_repr(self.repr(), CONTEXT)));
        if rounded.class == 0.0 {
            Self::special(0.0f64.copysign(self.class))
        } else {
            rounded
        }
    }
}

impl PartialEq for Wide {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Wide {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let size = |number: &Self| (number.exponent, number.significand);
        let classes = self.class.partial_cmp(&other.class)?;
        Some(classes.then_with(|| {
            let sizes = size(self).cmp(&size(other));
            if self.class < 0.0 { sizes.reverse() } else { sizes }
        }))
    }
}

macro_rules! functions {
    ($($name:ident($double:path) = $function:expr;)*) => {$(
        fn $name<const L: usize>(x: [Self; L], (): ()) -> [Self; L] {
            x.map(|x| x.apply($double, $function))
        }
    )*};
}

impl Arithmetic for Wide {
    type Noise = ();
    const FORMAT: Option<FloatFormat> = None;

    fn from_f64(value: f64) -> Self {
        Big::try_from(value).map_or(Self::special(value), Self::new)
    }
    fn from_f32(value: f32) -> Self {
        Self::from_f64(value.into())
    }
    fn texture([width, height]: [u32; 2], texels: Vec<[Self; 4]>) -> Texture {
        let texels = texels.into_iter().map(|texel| texel.map(Self::to_f64));
        Image::new(width, height, texels.collect()).into()
    }
    fn to_f64(self) -> f64 {
        if self.is_regular() {
            self.repr().to_f64().value()
        } else {
            self.class
        }
    }
    fn to_f32(self) -> f32 {
        if self.is_regular() {
            self.repr().to_f32().value()
        } else {
            self.class as f32
        }
    }
    fn is_nan(self) -> bool {
        self.class.is_nan()
    }
    // Masks have all bits or none.
    fn blend(mask: u32, yes: Self, no: Self) -> Self {
        if mask == 0 { no } else { yes }
    }

    fn add(self, other: Self, (): ()) -> Self {
        self.operate(other, self.class + other.class, Context::add)
    }
    fn sub(self, other: Self, (): ()) -> Self {
        self.operate(other, self.class - other.class, Context::sub)
    }
    fn mul(self, other: Self, (): ()) -> Self {
        self.operate(other, self.class * other.class, Context::mul)
    }
    fn div(self, other: Self, (): ()) -> Self {
        self.operate(other, self.class / other.class, Context::div)
    }
    fn sqrt(self, (): ()) -> Self {
        self.apply(f64::sqrt, |x, _| CONTEXT.sqrt(x))
    }

    fn abs(self) -> Self {
        Self {
            class: self.class.abs(),
            ..self
        }
    }
    fn neg(self) -> Self {
        Self {
            class: -self.class,
            ..self
        }
    }
    fn floor(self) -> Self {
        self.rounded(Big::floor)
    }
    fn ceil(self) -> Self {
        self.rounded(Big::ceil)
    }
    fn trunc(self) -> Self {
        self.rounded(Big::trunc)
    }
    fn round_even(self) -> Self {
        self.rounded(|big| big.to_int().value().into())
    }

    functions! {
        sin(libm::sin) = |x, cache| CONTEXT.sin(x, cache);
        cos(libm::cos) = |x, cache| CONTEXT.cos(x, cache);
        tan(libm::tan) = |x, cache| CONTEXT.tan(x, cache);
        asin(libm::asin) = |x, cache| CONTEXT.asin(x, cache);
        acos(libm::acos) = |x, cache| CONTEXT.acos(x, cache);
        atan(libm::atan) = |x, cache| CONTEXT.atan(x, cache);
        sinh(libm::sinh) = |x, cache| CONTEXT.sinh(x, cache);
        cosh(libm::cosh) = |x, cache| CONTEXT.cosh(x, cache);
        tanh(libm::tanh) = |x, cache| CONTEXT.tanh(x, cache);
        asinh(libm::asinh) = |x, cache| CONTEXT.asinh(x, cache);
        acosh(libm::acosh) = |x, cache| CONTEXT.acosh(x, cache);
        atanh(libm::atanh) = |x, cache| CONTEXT.atanh(x, cache);
        exp(libm::exp) = |x, cache| CONTEXT.exp(x, cache);
        exp2(libm::exp2) = |x, cache| CONTEXT.powf(&Repr::new(2.into(), 0), x, cache);
        log(libm::log) = |x, cache| CONTEXT.ln(x, cache);
        log2(libm::log2) = |x, cache| CONTEXT.log2(x, cache);
    }

    fn atan2<const L: usize>(y: [Self; L], x: [Self; L], (): ()) -> [Self; L] {
        std::array::from_fn(|lane| {
            let (y, x) = (y[lane], x[lane]);
            let of_classes = libm::atan2(y.class, x.class);
            if y.is_regular() && x.is_regular() {
                let angle = |cache: &mut ConstCache| CONTEXT.atan2(&y.repr(), &x.repr(), Some(cache));
                return Self::result(CONSTANTS.with_borrow_mut(angle), of_classes);
            }
            // An axis or a diagonal: a number of eighths of a turn.
            let eighths = (of_classes / FRAC_PI_4).round();
            if of_classes == 0.0 || eighths.is_nan() {
                return Self::special(of_classes);
            }
            let pi = CONSTANTS.with_borrow_mut(|cache| CONTEXT.pi::<2>(Some(cache)).value());
            Self::new(pi).mul(Self::from_f64(eighths / 4.0), ())
        })
    }

    fn pow<const L: usize>(x: [Self; L], y: [Self; L], (): ()) -> [Self; L] {
        std::array::from_fn(|lane| {
            let (x, y) = (x[lane], y[lane]);
            let [of_doubles] = double::pow([x.to_f64()], [y.to_f64()]);
            if !(x.is_regular() && y.is_regular()) || x.class < 0.0 {
                return Self::special(of_doubles);
            }
            let power = |cache: &mut ConstCache| CONTEXT.powf(&x.repr(), &y.repr(), Some(cache));
            Self::result(CONSTANTS.with_borrow_mut(power), of_doubles)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wide(value: f64) -> Wide {
        Wide::from_f64(value)
    }

    fn one(result: [Wide; 1]) -> f64 {
        result[0].to_f64()
    }

    #[test]
    fn numbers_are_converted_exactly() {
        let values = [
            0.1,
            -7.0,
            f64::MAX,
            f64::from_bits(1),
            f64::NEG_INFINITY,
            0.0,
            -0.0,
        ];
        for value in values {
            assert_eq!(wide(value).to_f64().to_bits(), value.to_bits());
            assert_eq!(wide(value).to_f32(), value as f32);
        }
        assert!(wide(f64::NAN).is_nan() && wide(f64::NAN).to_f64().is_nan());
        // Rounding to f64 first would give 1.
        let tie = wide(1.0 + 2f64.powi(-24)).add(wide(2f64.powi(-90)), ());
        assert_eq!(tie.to_f32(), 1.0 + f32::EPSILON);
    }

    #[test]
    fn operations_keep_160_bits() {
        let tiny = wide(2f64.powi(-157));
        assert_eq!(wide(1.0).add(tiny, ()).sub(wide(1.0), ()), tiny);
        assert_eq!(
            wide(1.0).add(tiny.mul(tiny, ()), ()),
            wide(1.0),
            "314 bits are rounded"
        );
        let third = wide(1.0).div(wide(3.0), ());
        assert!(third.mul(wide(3.0), ()).sub(wide(1.0), ()).abs() < tiny);
        let root = wide(2.0).sqrt(());
        assert!(root.mul(root, ()).sub(wide(2.0), ()).abs() < tiny);
        // √2 to 33 digits.
        let (high, low) = (root.to_f64(), root.sub(wide(root.to_f64()), ()).to_f64());
        assert_eq!(high, std::f64::consts::SQRT_2);
        assert!((low + 9.667_293_313_452_913e-17).abs() < 1e-32, "{low:e}");
    }

    #[test]
    fn sums_of_numbers_far_apart_are_rounded() {
        for exponent in 100..300 {
            let small = wide(0.1 * 2f64.powi(-exponent));
            for sum in [wide(1.0).add(small, ()), wide(1.0).sub(small, ())] {
                // Half a unit in the last place of a number from 1 to 2.
                let error = sum.sub(wide(1.0), ()).abs().sub(small, ()).abs();
                assert!(error <= wide(2f64.powi(-160)), "{exponent}: {error:?}");
            }
        }
    }

    #[test]
    fn zeros_infinities_and_nan_are_those_of_ieee_754() {
        let values = [0.0, -0.0, 1.5, -1.5, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        for x in values {
            for y in values {
                let (a, b) = (wide(x), wide(y));
                let results = [a.add(b, ()), a.sub(b, ()), a.mul(b, ()), a.div(b, ())];
                for (result, expected) in results.into_iter().zip([x + y, x - y, x * y, x / y]) {
                    let result = result.to_f64();
                    let same = result.to_bits() == expected.to_bits() || result.is_nan() && expected.is_nan();
                    assert!(same, "{x} and {y}: {result}, not {expected}");
                }
                assert_eq!(a.partial_cmp(&b), x.partial_cmp(&y));
                let angle = one(Wide::atan2([a], [b], ()));
                let expected = libm::atan2(x, y);
                assert!((angle - expected).abs() < 1e-15 || angle.is_nan() && expected.is_nan());
            }
        }
        assert!(wide(-1.0).sqrt(()).is_nan() && one(Wide::asin([wide(1.5)], ())).is_nan());
        assert_eq!(one(Wide::log([wide(0.0)], ())), f64::NEG_INFINITY);
        assert_eq!(one(Wide::exp([wide(1e300)], ())), f64::INFINITY);
        assert_eq!(one(Wide::exp([wide(-1e300)], ())), 0.0);
        let huge = wide(f64::MAX);
        assert_eq!(huge.mul(huge, ()).div(huge, ()), huge, "beyond the range of f64");
    }

    #[test]
    fn integers_are_rounded_as_in_f64() {
        for x in [
            -2.5,
            -1.5,
            -0.5,
            -0.4,
            0.0,
            0.5,
            1.5,
            2.5,
            2.500_000_1,
            1e300,
            f64::INFINITY,
        ] {
            let bits = |rounded: [f64; 4]| rounded.map(f64::to_bits);
            let number = wide(x);
            let rounded = [number.floor(), number.ceil(), number.trunc(), number.round_even()];
            let expected = [x.floor(), x.ceil(), x.trunc(), x.round_ties_even()];
            assert_eq!(bits(rounded.map(Wide::to_f64)), bits(expected), "{x}");
        }
        let below = wide(3.0).sub(wide(1e-30), ());
        assert_eq!((below.floor(), below.to_f64()), (wide(2.0), 3.0));
    }

    #[test]
    fn functions_are_inverse_to_each_other_and_reduce_large_angles() {
        // Two roundings by 2⁻¹⁶⁰, which no inverse function amplifies by more than ten here.
        let tolerance = wide(2f64.powi(-153));
        let x = wide(0.7).add(wide(1e-40), ());
        let close = |[y]: [Wide; 1]| assert!(y.sub(x, ()).abs() < tolerance, "{y:?}");
        close(Wide::log(Wide::exp([x], ()), ()));
        close(Wide::log2(Wide::exp2([x], ()), ()));
        close(Wide::asin(Wide::sin([x], ()), ()));
        close(Wide::acos(Wide::cos([x], ()), ()));
        close(Wide::atan(Wide::tan([x], ()), ()));
        close(Wide::asinh(Wide::sinh([x], ()), ()));
        close(Wide::acosh(Wide::cosh([x], ()), ()));
        close(Wide::atanh(Wide::tanh([x], ()), ()));
        close(Wide::atan2(Wide::sin([x], ()), Wide::cos([x], ()), ()));
        close(Wide::pow(
            Wide::pow([x], [wide(3.0)], ()),
            [wide(1.0).div(wide(3.0), ())],
            (),
        ));
        // Published digits of sin(10²²), a common test of argument reduction.
        assert_eq!(one(Wide::sin([wide(1e22)], ())), -0.852_200_849_767_188_8);
    }
}
