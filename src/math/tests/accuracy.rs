//! Measures the errors of the functions, and checks that flushing denormals changes no result.
//!
//! The reference is libm in f64, with an error of at most about one unit in the last place of f64, which is
//! 2⁻²⁹ of an f32's.

use std::ops::{Add, Div, Mul, Neg, Sub};

use proptest::prelude::*;
use rayon::prelude::*;

use crate as math;
use crate::native::{self, flush};
use crate::{Float, Number, Word};

/// A function of one argument, its reference, and its error limit.
struct Case {
    name: &'static str,
    native: fn(f32) -> f32,
    flushing: fn(Flushing) -> Flushing,
    exact: fn(f64) -> f64,
    /// The largest error, in units in the last place of an f32 next to the exact value.
    limit: f64,
    /// The bits of an argument with that error.
    worst: u32,
}

macro_rules! cases {
    ($($name:ident = $exact:path, $limit:literal, $worst:literal;)*) => {
        [$(Case {
            name: stringify!($name),
            native: native::$name,
            flushing: math::$name::<Flushing>,
            exact: $exact,
            limit: $limit,
            worst: $worst,
        },)*]
    };
}

/// The largest errors among every 97th float where the function is neither constant nor its argument, and
/// among every 97th of all floats from the 48th on. Other floats may have slightly larger errors; the limits
/// allow a few hundredths for them.
fn cases() -> [Case; 16] {
    cases! {
        sin = libm::sin, 0.82, 0x73C3_51C2;
        cos = libm::cos, 0.83, 0x5D2A_15B6;
        tan = libm::tan, 1.05, 0x690C_E90A;
        asin = libm::asin, 0.76, 0x3F06_CAB0;
        acos = libm::acos, 0.69, 0x3F0B_54A0;
        atan = libm::atan, 1.26, 0x3F83_1B16;
        sinh = libm::sinh, 0.79, 0x3F5A_2B84;
        cosh = libm::cosh, 0.88, 0x3D57_6DFD;
        tanh = libm::tanh, 0.64, 0x3EFC_8F0A;
        asinh = libm::asinh, 1.21, 0x3F05_1C29;
        acosh = acosh, 0.84, 0x3F87_A5A0;
        atanh = libm::atanh, 0.88, 0x3E2D_5777;
        exp = libm::exp, 0.72, 0x41DB_5663;
        exp2 = libm::exp2, 0.82, 0xBFB9_39F4;
        log = libm::log, 0.84, 0x3F33_58AB;
        log2 = libm::log2, 0.54, 0x3F38_EA1D;
    }
}

/// libm's acosh, which returns finite values far below 1.
fn acosh(x: f64) -> f64 {
    if x < 1.0 { f64::NAN } else { libm::acosh(x) }
}

/// The error in units in the last place of an f32 next to the exact value. If that value is at most the
/// smallest normal float, zero and that float count as exact.
fn error(computed: f32, exact: f64) -> f64 {
    let rounded = exact as f32;
    if exact.is_nan() || rounded.is_infinite() || computed.is_infinite() {
        let same = computed == rounded || computed.is_nan() && exact.is_nan();
        return if same { 0.0 } else { f64::INFINITY };
    }
    let smallest = f64::from(f32::MIN_POSITIVE);
    if exact.abs() <= smallest && (computed == 0.0 || computed.abs() == f32::MIN_POSITIVE) {
        return 0.0;
    }
    let exponent = libm::ilogb(exact.abs().max(smallest));
    let error = (f64::from(computed) - exact).abs() / libm::ldexp(1.0, exponent - 23);
    if error.is_nan() { f64::INFINITY } else { error }
}

fn same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

impl Case {
    /// The error at one argument.
    ///
    /// # Panics
    /// If the result differs when every operation flushes denormals.
    fn error(&self, x: f32) -> f64 {
        let x = flush(x);
        let computed = (self.native)(x);
        let flushed = (self.flushing)(Flushing::new(x)).get();
        let name = self.name;
        assert!(
            same(computed, flushed),
            "{name}({x:e}) is {computed:e}, or {flushed:e} with denormals flushed"
        );
        error(computed, (self.exact)(f64::from(x)))
    }

    /// The largest error among every `stride`th float from `first` on, and its argument.
    fn largest_error(&self, stride: usize, first: usize) -> (f64, f32) {
        let arguments = (0..(1_usize << 32) / stride).into_par_iter();
        let errors = arguments.map(|index| {
            let x = f32::from_bits((index * stride + first) as u32);
            (self.error(x), x)
        });
        errors.reduce(|| (0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
    }
}

#[test]
#[expect(clippy::print_stderr, reason = "a sweep prints its results")]
fn no_error_is_larger_than_its_limit_and_no_limit_than_its_error() {
    // TOYPROOF_STRIDE=1 tests all floats, which takes 20 core minutes for each function (with `cargo test
    // --release`).
    let number = |name, usual| std::env::var(name).map_or(usual, |number| number.parse().unwrap());
    let (stride, start) = (number("TOYPROOF_STRIDE", 8191), number("TOYPROOF_FIRST", 0));
    for case in &cases() {
        let at_worst = case.error(f32::from_bits(case.worst));
        let Case { name, limit, .. } = case;
        assert!(
            at_worst > limit - 0.05,
            "{name}: {limit} is more than {at_worst}, the error where it is largest"
        );
        let (error, x) = case.largest_error(stride, start);
        eprintln!("{name}: {error:.4} at {x:e} ({:08x})", x.to_bits());
        assert!(
            error <= *limit,
            "{name}: the error is {error} at {x:e} ({:08x})",
            x.to_bits()
        );
    }
}

/// Arguments at the ends of ranges and at the switches between formulas.
const EDGE_CASES: [f32; 32] = [
    0.0,
    1e-40,
    f32::MIN_POSITIVE,
    1.000_1 * f32::MIN_POSITIVE,
    1e-30,
    1e-4,
    2.441_406_2e-4,
    0.3,
    0.35,
    0.5,
    std::f32::consts::FRAC_PI_4,
    0.999_999_94,
    1.0,
    1.000_000_1,
    std::f32::consts::SQRT_2,
    std::f32::consts::FRAC_PI_2,
    2.0,
    3.0,
    std::f32::consts::PI,
    10.0,
    87.336_54,
    88.722_83,
    88.722_84,
    89.5,
    126.0,
    128.0,
    16_384.0,
    16_777_216.0,
    1e10,
    1e30,
    f32::MAX,
    f32::INFINITY,
];

fn signed_edge_cases() -> impl Iterator<Item = f32> + Clone {
    EDGE_CASES.into_iter().flat_map(|x| [x, -x]).chain([f32::NAN])
}

#[test]
fn edge_cases_are_as_in_c() {
    for case in &cases() {
        for x in signed_edge_cases() {
            let error = case.error(x);
            assert!(error <= case.limit, "{}({x:e}): {error}", case.name);
            let (computed, exact) = ((case.native)(x), (case.exact)(f64::from(flush(x))));
            let zero = computed == 0.0 && exact == 0.0;
            assert!(
                !zero || computed.is_sign_negative() == exact.is_sign_negative(),
                "{}({x:e}) is {computed:e}",
                case.name
            );
        }
    }
}

/// The largest error for millions of random arguments, in units in the last place.
const POW_LIMIT: f64 = 0.85;
/// A hundred million pairs with quotients between 0.5 and 0.5463, where the rounding of the quotient matters
/// most, have errors of up to 1.67.
const ATAN2_LIMIT: f64 = 1.75;

/// The error of `pow`; 0 for x < 0, where the function is undefined.
fn pow_error(x: f32, y: f32) -> f64 {
    let (x, y) = (flush(x), flush(y));
    let computed = native::pow(x, y);
    let flushed = math::pow(Flushing::new(x), Flushing::new(y)).get();
    assert!(
        same(computed, flushed),
        "pow({x:e}, {y:e}) is {computed:e}, or {flushed:e} with denormals flushed"
    );
    if x < 0.0 && y != 0.0 {
        assert!(computed.is_nan(), "pow({x:e}, {y:e}) is {computed:e}");
        return 0.0;
    }
    // −0 counts as 0.
    error(computed, libm::pow(f64::from(x.abs()), f64::from(y)))
}

fn atan2_error(y: f32, x: f32) -> f64 {
    let (x, y) = (flush(x), flush(y));
    let computed = native::atan2(y, x);
    let flushed = math::atan2(Flushing::new(y), Flushing::new(x)).get();
    assert!(
        same(computed, flushed),
        "atan({y:e}, {x:e}) is {computed:e}, or {flushed:e} with denormals flushed"
    );
    error(computed, libm::atan2(f64::from(y), f64::from(x)))
}

#[test]
fn edge_cases_of_two_arguments_are_as_in_c() {
    for x in signed_edge_cases() {
        for y in signed_edge_cases() {
            let error = pow_error(x, y);
            assert!(error <= POW_LIMIT, "pow({x:e}, {y:e}): {error}");
            let error = atan2_error(x, y);
            assert!(error <= ATAN2_LIMIT, "atan({x:e}, {y:e}): {error}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]

    #[test]
    fn pow_is_accurate(x in any::<u32>(), y in any::<u32>()) {
        // Any bits, and results over the full range of floats.
        let (x, y) = (f32::from_bits(x), f32::from_bits(y));
        prop_assert!(pow_error(x, y) <= POW_LIMIT);
        let reach = 128.0 / libm::log2f(x.abs());
        let y = (f64::from(y.to_bits()) / f64::from(1_u32 << 31) - 1.0) as f32 * reach;
        prop_assert!(pow_error(x.abs(), y) <= POW_LIMIT, "pow({}, {})", x.abs(), y);
    }

    #[test]
    fn atan2_is_accurate(y in any::<u32>(), x in any::<u32>(), near in -1e3f32..1e3, close in -1e3f32..1e3) {
        prop_assert!(atan2_error(f32::from_bits(y), f32::from_bits(x)) <= ATAN2_LIMIT);
        prop_assert!(atan2_error(near, close) <= ATAN2_LIMIT, "atan({}, {})", near, close);
    }
}

// A number type for tests: f32 with denormal operands and results of every operation flushed.

#[derive(Debug, Clone, Copy)]
struct Flushing(f32);

fn flush_subnormal(x: f32) -> f32 {
    if x.is_subnormal() { 0.0_f32.copysign(x) } else { x }
}

impl Flushing {
    fn new(x: f32) -> Self {
        Self(flush_subnormal(x))
    }

    fn get(self) -> f32 {
        flush_subnormal(self.0)
    }
}

macro_rules! operators {
    ($($operator:ident $name:ident;)*) => {$(
        impl $operator for Flushing {
            type Output = Self;

            fn $name(self, other: Self) -> Self {
                Self::new(self.get().$name(other.get()))
            }
        }

        impl $operator<f32> for Flushing {
            type Output = Self;

            fn $name(self, other: f32) -> Self {
                self.$name(Self(other))
            }
        }
    )*};
}

operators! {
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

impl Neg for Flushing {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.0)
    }
}

impl Number for Flushing {
    type Bool = bool;

    fn literal(self, value: f64) -> Self {
        Self(value as f32)
    }

    fn sqrt(self) -> Self {
        Self::new(self.get().sqrt())
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn floor(self) -> Self {
        Self(self.get().floor())
    }

    fn less(self, other: Self) -> bool {
        self.get() < other.get()
    }

    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }
}

impl Float for Flushing {
    type Bits = Word;

    fn to_bits(self) -> Word {
        Word(self.0.to_bits())
    }

    fn from_bits(bits: Word) -> Self {
        Self(f32::from_bits(bits.0))
    }

    fn from_signed(bits: Word) -> Self {
        Self(bits.0.cast_signed() as f32)
    }
}
