//! The geometric functions (§8.5), of vectors of one to four components.

use super::Number;

/// `a₀·b₀ + a₁·b₁ + …`
///
/// # Panics
/// If there are no components.
#[must_use]
pub fn dot<N: Number>(a: &[N], b: &[N]) -> N {
    let products = a.iter().zip(b).map(|(&a, &b)| a * b);
    products
        .reduce(|sum, product| sum + product)
        .expect("a vector has components")
}

/// `√dot(v, v)`; of one component its absolute value.
#[must_use]
pub fn length<N: Number>(v: &[N]) -> N {
    match *v {
        [x] => x.abs(),
        _ => dot(v, v).sqrt(),
    }
}

/// `length(a − b)`
#[must_use]
pub fn distance<N: Number>(a: &[N], b: &[N]) -> N {
    length(&each(a, b, |a, b| a - b))
}

/// `v / length(v)`
#[must_use]
pub fn normalize<N: Number>(v: &[N]) -> Vec<N> {
    let length = length(v);
    v.iter().map(|&x| x / length).collect()
}

/// `(a₁b₂ − b₁a₂, a₂b₀ − b₂a₀, a₀b₁ − b₀a₁)`
#[must_use]
pub fn cross<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - b[i] * a[j])
}

/// `n` where `dot(reference, i) < 0`, `−n` elsewhere.
#[must_use]
pub fn faceforward<N: Number>(n: &[N], i: &[N], reference: &[N]) -> Vec<N> {
    let along = dot(reference, i);
    let towards = along.less(along.literal(0.0));
    n.iter().map(|&n| N::select(towards, n, -n)).collect()
}

/// `i − 2·dot(n, i)·n`
#[must_use]
pub fn reflect<N: Number>(i: &[N], n: &[N]) -> Vec<N> {
    let along = dot(n, i);
    let twice = along.literal(2.0) * along;
    each(i, n, |i, n| i - twice * n)
}

/// `eta·i − (eta·c + √k)·n` with c = `dot(n, i)` and k = `1 − eta²·(1 − c²)`; 0 where k < 0.
#[must_use]
pub fn refract<N: Number>(i: &[N], n: &[N], eta: N) -> Vec<N> {
    let (zero, one) = (eta.literal(0.0), eta.literal(1.0));
    let cosine = dot(n, i);
    let k = one - eta * eta * (one - cosine * cosine);
    let along = eta * cosine + k.sqrt();
    each(i, n, |i, n| N::select(k.less(zero), zero, eta * i - along * n))
}

fn each<N: Number>(a: &[N], b: &[N], f: impl Fn(N, N) -> N) -> Vec<N> {
    a.iter().zip(b).map(|(&a, &b)| f(a, b)).collect()
}
