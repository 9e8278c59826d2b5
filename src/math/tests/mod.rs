//! Tests of the functions against identities, and of the f32 and graph variants against each other.

mod accuracy;

use proptest::prelude::*;

use super::{
    ExprGraph, FloatTerm, Matrix, atan2, cross, determinant, distance, dot, exp, faceforward, fract, inverse,
    length, log, mix, modulo, native, normalize, outer_product, pow, reflect, refract, sin, smoothstep, tan,
};

/// Far above f64's rounding errors for components up to 2, far below the effect of a wrong sign or index.
const TOLERANCE: f64 = 1e-9;

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE * (1.0 + a.abs().max(b.abs()))
}

fn vector(size: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-2.0..2.0, size)
}

/// The identity matrix in column order.
fn identity(size: usize) -> Vec<f64> {
    (0..size * size)
        .map(|at| f64::from(u8::from(at % (size + 1) == 0)))
        .collect()
}

proptest! {
    #[test]
    fn an_inverse_times_its_matrix_is_the_identity((size, components) in (2..=4usize).prop_flat_map(|n| (Just(n), vector(n * n)))) {
        let m = Matrix::new(&components, size);
        let det = determinant(&m);
        prop_assume!(det.abs() > 1e-2);
        for product in [m.times(&inverse(&m)), inverse(&m).times(&m)] {
            let close = product.components().iter().zip(identity(size)).all(|(&a, b)| near(a, b));
            prop_assert!(close, "{product:?}");
        }
        // Rotating the columns changes the determinant's sign, except for three columns.
        let mut rotated = components.clone();
        rotated.rotate_left(size);
        let sign = if size == 3 { 1.0 } else { -1.0 };
        prop_assert!(near(determinant(&Matrix::new(&rotated, size)), sign * det));
    }

    #[test]
    fn products_agree_with_each_other(a in vector(6), b in vector(6), v in vector(2), w in vector(3)) {
        // A matrix of two columns of three rows, and one of three columns of two rows.
        let (m, k) = (Matrix::new(&a, 3), Matrix::new(&b, 2));
        let at_once = m.times(&k).times_vector(&w);
        let in_turn = m.times_vector(&k.times_vector(&w));
        prop_assert!(at_once.iter().zip(&in_turn).all(|(&a, &b)| near(a, b)));
        prop_assert!(near(dot(&w, &m.times_vector(&v)), dot(&m.vector_times(&w), &v)));
        let outer = outer_product(&w, &v);
        prop_assert!(outer.times_vector(&v).iter().zip(&w).all(|(&a, &w)| near(a, w * dot(&v, &v))));
    }

    #[test]
    fn a_sine_and_cosine_have_the_bits_that_they_have_alone(bits in any::<u32>(), small in -100.0_f32..100.0) {
        for x in [f32::from_bits(bits), small] {
            let (sine, cosine) = native::sin_cos(x);
            prop_assert_eq!(sine.to_bits(), native::sin(x).to_bits());
            prop_assert_eq!(cosine.to_bits(), native::cos(x).to_bits());
        }
    }

    #[test]
    fn geometric_functions_satisfy_their_identities(a in vector(3), b in vector(3)) {
        prop_assume!(length(&a) > 0.1 && length(&b) > 0.1);
        let n = normalize(&a);
        prop_assert!(near(length(&n), 1.0) && near(dot(&n, &a), length(&a)));
        prop_assert!(near(distance(&a, &b), (dot(&a, &a) - 2.0 * dot(&a, &b) + dot(&b, &b)).sqrt()));
        let c = cross([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
        prop_assert!(near(dot(&c, &a), 0.0) && near(dot(&c, &b), 0.0));
        let mirrored = reflect(&b, &n);
        prop_assert!(near(dot(&mirrored, &n), -dot(&b, &n)) && near(length(&mirrored), length(&b)));
        prop_assert!(dot(&faceforward(&n, &b, &n), &b) <= 0.0);
        // Snell's law: the tangential component is scaled by eta, and the direction keeps length 1.
        let (i, eta) = (normalize(&b), 0.75);
        let bent = refract(&i, &faceforward(&n, &i, &n), eta);
        let across = |v: &[f64]| cross([v[0], v[1], v[2]], [n[0], n[1], n[2]]);
        prop_assert!(near(length(&bent), 1.0));
        prop_assert!(across(&bent).iter().zip(across(&i)).all(|(&a, b)| near(a, eta * b)));
    }

    #[test]
    fn scalar_functions_satisfy_their_identities(x in -9.0..9.0f64, y in -9.0..9.0f64) {
        prop_assume!(y.abs() > 0.1);
        let m = modulo(x, y);
        prop_assert!(near(((x - m) / y).round(), (x - m) / y) && m / y > -TOLERANCE && m / y < 1.0 + TOLERANCE);
        prop_assert!(near(mix(x, y, 0.0), x) && near(mix(x, y, 1.0), y));
        prop_assert!(near(mix(x, y, 0.25), 0.75 * x + 0.25 * y));
        prop_assert!(near(smoothstep(0.0, 4.0, x) + smoothstep(0.0, 4.0, 4.0 - x), 1.0));
    }
}

#[test]
fn smoothstep_is_cubic() {
    assert_eq!(smoothstep(0.0, 4.0, 1.0), 0.156_25);
}

#[test]
fn refraction_beyond_the_critical_angle_is_zero() {
    assert_eq!(refract(&[0.8, -0.6], &[0.0, 1.0], 2.0), [0.0, 0.0]);
}

#[test]
fn vectors_of_one_component_work() {
    assert_eq!(length(&[-3.0_f32]), 3.0);
    assert_eq!(normalize(&[-3.0_f32]), [-1.0]);
}

#[test]
fn a_graph_computes_what_the_functions_compute() {
    let graph = ExprGraph::default();
    let (x, y) = (graph.argument(0), graph.argument(1));
    let results = [
        sin(x),
        tan(x),
        exp(x),
        log(x),
        pow(x, y),
        atan2(x, y),
        smoothstep(x, y, x),
        fract(x),
    ];
    let ids = results.map(FloatTerm::id);
    // NaN payloads are unspecified.
    let bits = |values: &[f32]| {
        values
            .iter()
            .map(|value| (!value.is_nan()).then(|| value.to_bits()))
            .collect::<Vec<_>>()
    };
    for (x, y) in [
        (0.5_f32, 2.0),
        (1e5, -0.3),
        (-3.7, 0.0),
        (f32::INFINITY, 1.0),
        (1e-30, 7.5),
    ] {
        let direct = [
            sin(x),
            tan(x),
            exp(x),
            log(x),
            pow(x, y),
            atan2(x, y),
            smoothstep(x, y, x),
            fract(x),
        ];
        assert_eq!(bits(&graph.evaluate(&ids, &[x, y])), bits(&direct), "{x} {y}");
    }
}
