//! Angle, common, geometric and matrix functions (§8.1, §8.3, §8.5, §8.6).

use std::f64::consts::PI;

use super::float::Number;

/// `x·π/180`
#[inline]
pub fn radians<N: Number>(x: N) -> N {
    x * x.literal(PI / 180.0)
}

/// `x·180/π`
#[inline]
pub fn degrees<N: Number>(x: N) -> N {
    x * x.literal(180.0 / PI)
}

/// `1 / √x`
#[inline]
pub fn inverse_sqrt<N: Number>(x: N) -> N {
    x.literal(1.0) / x.sqrt()
}

/// −1, 0 or 1; 0 for NaN.
#[inline]
pub fn sign<N: Number>(x: N) -> N {
    let zero = x.literal(0.0);
    let positive = N::select(zero.less(x), x.literal(1.0), zero);
    N::select(x.less(zero), x.literal(-1.0), positive)
}

/// `x − floor(x)`; rounds to 1 just below zero.
#[inline]
pub fn fract<N: Number>(x: N) -> N {
    x - x.floor()
}

/// `mod(x, y)`: `x − y·floor(x / y)`
#[inline]
pub fn modulo<N: Number>(x: N, y: N) -> N {
    x - y * (x / y).floor()
}

/// `min(max(x, low), high)`
#[inline]
pub fn clamp<N: Number>(x: N, low: N, high: N) -> N {
    x.max(low).min(high)
}

/// `a·(1 − t) + b·t`
#[inline]
pub fn mix<N: Number>(a: N, b: N, t: N) -> N {
    a * (t.literal(1.0) - t) + b * t
}

/// 0 if `x < edge`, otherwise 1.
#[inline]
pub fn step<N: Number>(edge: N, x: N) -> N {
    N::select(x.less(edge), x.literal(0.0), x.literal(1.0))
}

/// `t²·(3 − 2t)` with t = `clamp((x − low) / (high − low), 0, 1)`; 0 where t is NaN, as in browsers.
#[inline]
pub fn smoothstep<N: Number>(low: N, high: N, x: N) -> N {
    let t = (x - low) / (high - low);
    let (zero, one) = (x.literal(0.0), x.literal(1.0));
    let t = N::select(zero.less(t), t, zero);
    let t = N::select(t.less(one), t, one);
    t * t * (x.literal(3.0) - x.literal(2.0) * t)
}

// Geometric functions (§8.5), of vectors of one to four components.

/// `a₀·b₀ + a₁·b₁ + …`
///
/// # Panics
/// If there are no components.
pub fn dot<N: Number>(a: &[N], b: &[N]) -> N {
    let products = a.iter().zip(b).map(|(&a, &b)| a * b);
    products
        .reduce(|sum, product| sum + product)
        .expect("a vector has components")
}

/// `√dot(v, v)`; for one component, its absolute value.
pub fn length<N: Number>(v: &[N]) -> N {
    match *v {
        [x] => x.abs(),
        _ => dot(v, v).sqrt(),
    }
}

/// `length(a − b)`
pub fn distance<N: Number>(a: &[N], b: &[N]) -> N {
    length(&each(a, b, |a, b| a - b))
}

/// `v / length(v)`
pub fn normalize<N: Number>(v: &[N]) -> Vec<N> {
    let length = length(v);
    v.iter().map(|&x| x / length).collect()
}

/// `(a₁b₂ − b₁a₂, a₂b₀ − b₂a₀, a₀b₁ − b₀a₁)`
pub fn cross<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - b[i] * a[j])
}

/// `n` if `dot(reference, i) < 0`, otherwise `−n`.
pub fn faceforward<N: Number>(n: &[N], i: &[N], reference: &[N]) -> Vec<N> {
    let along = dot(reference, i);
    let towards = along.less(along.literal(0.0));
    n.iter().map(|&n| N::select(towards, n, -n)).collect()
}

/// `i − 2·dot(n, i)·n`
pub fn reflect<N: Number>(i: &[N], n: &[N]) -> Vec<N> {
    let along = dot(n, i);
    let twice = along.literal(2.0) * along;
    each(i, n, |i, n| i - twice * n)
}

/// `eta·i − (eta·c + √k)·n` with c = `dot(n, i)` and k = `1 − eta²·(1 − c²)`; 0 if k < 0.
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

// Matrices (§5.9, §8.6), in column-major order.

/// A matrix of two to four columns of two to four rows each.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix<N> {
    columns: Vec<Vec<N>>,
}

impl<N: Number> Matrix<N> {
    /// Makes a matrix from its components in column order, `rows` per column.
    ///
    /// # Panics
    /// If `rows` is 0.
    pub fn new(components: &[N], rows: usize) -> Self {
        let columns = components.chunks(rows).map(<[N]>::to_vec).collect();
        Self { columns }
    }

    /// The components in column order.
    pub fn components(&self) -> Vec<N> {
        self.columns.concat()
    }

    /// `m·v`: each component sums over the columns.
    pub fn times_vector(&self, v: &[N]) -> Vec<N> {
        let rows = self.columns.first().map_or(0, Vec::len);
        (0..rows)
            .map(|row| {
                let across: Vec<N> = self.columns.iter().map(|column| column[row]).collect();
                dot(&across, v)
            })
            .collect()
    }

    /// `v·m`: each component is the dot product with a column.
    pub fn vector_times(&self, v: &[N]) -> Vec<N> {
        self.columns.iter().map(|column| dot(v, column)).collect()
    }

    /// `m·other`: each column is `m` times the column of `other`.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let columns = other.columns.iter().map(|column| self.times_vector(column));
        Self {
            columns: columns.collect(),
        }
    }
}

/// The matrix whose column j is `c·rⱼ`.
pub fn outer_product<N: Number>(c: &[N], r: &[N]) -> Matrix<N> {
    let columns = r.iter().map(|&r| c.iter().map(|&c| c * r).collect());
    Matrix {
        columns: columns.collect(),
    }
}

/// The determinant of a square matrix.
///
/// # Panics
/// If the matrix is not square, or larger than 4×4.
pub fn determinant<N: Number>(m: &Matrix<N>) -> N {
    adjugate(m).1
}

/// The inverse of a square matrix: the adjugate divided by the determinant.
///
/// # Panics
/// If the matrix is not square, or larger than 4×4.
pub fn inverse<N: Number>(m: &Matrix<N>) -> Matrix<N> {
    let (adjugate, determinant) = adjugate(m);
    let over = |column: &Vec<N>| column.iter().map(|&x| x / determinant).collect();
    Matrix {
        columns: adjugate.columns.iter().map(over).collect(),
    }
}

/// The adjugate and the determinant.
fn adjugate<N: Number>(m: &Matrix<N>) -> (Matrix<N>, N) {
    match &m.columns[..] {
        [a, b] => {
            let columns = vec![vec![b[1], -a[1]], vec![-b[0], a[0]]];
            (Matrix { columns }, a[0] * b[1] - b[0] * a[1])
        }
        [a, b, c] => {
            let [a, b, c] = [a, b, c].map(|column| [column[0], column[1], column[2]]);
            let rows = [cross(b, c), cross(c, a), cross(a, b)];
            let columns = (0..3).map(|row| rows.iter().map(|r| r[row]).collect());
            let columns = columns.collect();
            (Matrix { columns }, dot(&a, &rows[0]))
        }
        m => adjugate_4x4(m),
    }
}

/// The adjugate and the determinant of a 4×4 matrix, from the 2×2 minors of the first two and of the last two
/// columns (Laplace expansion).
fn adjugate_4x4<N: Number>(m: &[Vec<N>]) -> (Matrix<N>, N) {
    const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    let minors = |c: usize| PAIRS.map(|(i, j)| m[c][i] * m[c + 1][j] - m[c + 1][i] * m[c][j]);
    let [s0, s1, s2, s3, s4, s5] = minors(0);
    let [c0, c1, c2, c3, c4, c5] = minors(2);
    // Cofactors along column `m[c]`, from the minors of the two columns on the other side, with alternating
    // signs.
    let four = |c: usize, [k0, k1, k2, k3, k4, k5]: [N; 6]| {
        let m = &m[c];
        [
            m[1] * k5 - m[2] * k4 + m[3] * k3,
            -m[0] * k5 + m[2] * k2 - m[3] * k1,
            m[0] * k4 - m[1] * k2 + m[3] * k0,
            -m[0] * k3 + m[1] * k1 - m[2] * k0,
        ]
    };
    let negative = |four: [N; 4]| four.map(|x| -x);
    let (s, c) = ([s0, s1, s2, s3, s4, s5], [c0, c1, c2, c3, c4, c5]);
    let rows = [four(1, c), negative(four(0, c)), four(3, s), negative(four(2, s))];
    let columns = (0..4).map(|row| rows.iter().map(|r| r[row]).collect()).collect();
    let determinant = s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
    (Matrix { columns }, determinant)
}
