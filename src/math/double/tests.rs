//! Compares the functions with libm's.

use proptest::prelude::*;

use super::{cos, exp, log, pow, sin, sin_cos};

type Function = (fn([f64; 8]) -> [f64; 8], fn(f64) -> f64);

const TRIGONOMETRIC: [Function; 2] = [(sin, libm::sin), (cos, libm::cos)];
const EXPONENTIAL: [Function; 2] = [(exp, libm::exp), (log, libm::log)];

/// Arguments at the limits of the paths.
const SPECIAL: [f64; 40] = [
    0.0,
    -0.0,
    f64::MIN_POSITIVE,
    -f64::MIN_POSITIVE,
    1e-310,
    -1e-310,
    5e-324,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::MAX,
    f64::MIN,
    1.0,
    -1.0,
    0.999_999_999_999_999_9,
    1.000_000_000_000_000_2,
    2.0,
    0.5,
    -0.5,
    -2.0,
    3.0,
    1e-9,
    -1e-9,
    1e-300,
    1e300,
    709.0,
    709.782_712_893_384,
    709.79,
    -708.4,
    -745.2,
    707.999,
    -707.999,
    1e22,
    -1e22,
    2_147_483_648.0,
    1_647_099.3,
    1_647_099.4,
    std::f64::consts::PI,
    std::f64::consts::FRAC_PI_2,
    std::f64::consts::LN_2,
];

fn in_lanes(x: &[f64]) -> impl Iterator<Item = [f64; 8]> {
    x.windows(8)
        .map(|window| std::array::from_fn(|lane| window[lane]))
}

fn is_same(computed: f64, expected: f64) -> bool {
    computed.to_bits() == expected.to_bits() || computed.is_nan() && expected.is_nan()
}

/// Floats with any sign and exponent, and of a size that shaders use.
fn floats() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        -20.0..20.0,
        -800.0..800.0,
        (-40.0..40.0).prop_map(f64::exp2),
        prop::sample::select(SPECIAL.to_vec()),
    ]
}

/// Angles, many of them large or almost multiples of π/2.
fn angles() -> impl Strategy<Value = f64> {
    let multiples = (any::<i32>(), 0..40_u32, -2..3_i64).prop_map(|(n, shift, units)| {
        let angle = f64::from(n >> (shift % 32)) * std::f64::consts::FRAC_PI_2;
        f64::from_bits(angle.to_bits().saturating_add_signed(units))
    });
    prop_oneof![floats(), -1e6..1e6, -1e9..1e9, multiples]
}

/// Returns the distance in units in the last place.
fn distance(computed: f64, expected: f64) -> u64 {
    if is_same(computed, expected) {
        return 0;
    }
    computed.to_bits().abs_diff(expected.to_bits())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn exponentials_and_logarithms_have_the_bits_of_libm(x in prop::array::uniform8(floats())) {
        for (function, reference) in EXPONENTIAL {
            for (computed, x) in function(x).into_iter().zip(x) {
                prop_assert!(is_same(computed, reference(x)), "{x:e}: {computed:e}, {:e}", reference(x));
            }
        }
    }

    #[test]
    fn powers_have_the_bits_of_libm(
        x in prop::array::uniform8(floats()), y in prop::array::uniform8(floats()),
    ) {
        for ((computed, x), y) in pow(x, y).into_iter().zip(x).zip(y) {
            let expected = if x < 0.0 { f64::NAN } else { libm::pow(x, y) };
            prop_assert!(is_same(computed, expected), "{x:e}^{y:e}: {computed:e}, {expected:e}");
        }
    }

    #[test]
    fn sines_and_cosines_are_within_a_unit_of_libm(x in prop::array::uniform8(angles())) {
        for (function, reference) in TRIGONOMETRIC {
            for (computed, x) in function(x).into_iter().zip(x) {
                let expected = reference(x);
                prop_assert!(distance(computed, expected) <= 1, "{x:e}: {computed:e}, {expected:e}");
                prop_assert!(computed.is_nan() || computed.abs() <= 1.0);
            }
        }
    }

    #[test]
    fn results_do_not_depend_on_other_lanes(
        x in prop::array::uniform8(angles()), y in prop::array::uniform8(floats()),
    ) {
        let [sines, cosines, exponentials, logarithms] = [sin(x), cos(x), exp(y), log(y)];
        let powers = pow(x, y);
        let pairs = sin_cos(x);
        for lane in 0..8 {
            let ([x], [y]) = ([x[lane]], [y[lane]]);
            prop_assert!(is_same(sin([x])[0], sines[lane]));
            prop_assert!(is_same(cos([x])[0], cosines[lane]));
            prop_assert!(is_same(sines[lane], pairs.0[lane]) && is_same(cosines[lane], pairs.1[lane]));
            prop_assert!(is_same(exp([y])[0], exponentials[lane]));
            prop_assert!(is_same(log([y])[0], logarithms[lane]));
            prop_assert!(is_same(pow([x], [y])[0], powers[lane]));
        }
    }
}

#[test]
fn special_arguments_are_those_of_libm() {
    for x in in_lanes(&SPECIAL) {
        for (function, reference) in EXPONENTIAL.into_iter().chain(TRIGONOMETRIC) {
            for (computed, x) in function(x).into_iter().zip(x) {
                assert!(
                    distance(computed, reference(x)) <= 1,
                    "{x:e}: {computed:e}, {:e}",
                    reference(x)
                );
            }
        }
        for y in SPECIAL {
            for (computed, x) in pow(x, [y; 8]).into_iter().zip(x) {
                let expected = if x < 0.0 { f64::NAN } else { libm::pow(x, y) };
                assert!(
                    is_same(computed, expected),
                    "{x:e}^{y:e}: {computed:e}, {expected:e}"
                );
            }
        }
    }
}

/// The f64 that is closest to a multiple of π/2 (Muller, "Elementary Functions", ch. 11), and the sines of
/// others with 60 digits, computed by mpmath.
#[test]
fn large_angles_are_reduced_exactly() {
    let closest = 6_381_956_970_095_103.0 * 797_f64.exp2();
    assert_eq!(cos([closest]), [-4.687_165_924_254_628e-19]);
    assert_eq!(sin([1e22]), [-0.852_200_849_767_188_8]);
    assert_eq!(sin([f64::MAX]), [0.004_961_954_789_184_062]);
    assert_eq!(cos([f64::MAX]), [-0.999_987_689_426_559_9]);
}

/// The bits differ from libm's where its reduction is less accurate, and for small angles, where it has a
/// separate formula.
#[test]
fn most_sines_and_cosines_have_the_bits_of_libm() {
    let angles: Vec<f64> = (0..80_000)
        .map(|i| (f64::from(i) - 40_000.0) * 0.123_456_789)
        .collect();
    for (function, reference) in TRIGONOMETRIC {
        let mut same = 0;
        for x in in_lanes(&angles).step_by(8) {
            let computed = function(x);
            same += computed
                .into_iter()
                .zip(x)
                .filter(|&(computed, x)| is_same(computed, reference(x)))
                .count();
        }
        assert!(same > 79_900, "{same}");
    }
}
