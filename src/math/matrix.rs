//! Matrices (§5.9, §8.6), column by column.

use super::Number;
use super::geometric::{cross, dot};

/// A matrix of two to four columns of two to four rows each.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix<N> {
    columns: Vec<Vec<N>>,
}

impl<N: Number> Matrix<N> {
    /// Of its components, one column after the other, `rows` each.
    ///
    /// # Panics
    /// If `rows` is 0.
    #[must_use]
    pub fn new(components: &[N], rows: usize) -> Self {
        let columns = components.chunks(rows).map(<[N]>::to_vec).collect();
        Self { columns }
    }

    /// The components, one column after the other.
    #[must_use]
    pub fn components(&self) -> Vec<N> {
        self.columns.concat()
    }

    /// `m·v`: each component sums over the columns.
    #[must_use]
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
    #[must_use]
    pub fn vector_times(&self, v: &[N]) -> Vec<N> {
        self.columns.iter().map(|column| dot(v, column)).collect()
    }

    /// `m·other`: its columns are `m` times those of `other`.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let columns = other.columns.iter().map(|column| self.times_vector(column));
        Self {
            columns: columns.collect(),
        }
    }
}

/// The matrix whose column j is `c·rⱼ`.
#[must_use]
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
#[must_use]
pub fn determinant<N: Number>(m: &Matrix<N>) -> N {
    adjugate(m).1
}

/// The adjugate over the determinant, of a square matrix.
///
/// # Panics
/// If the matrix is not square, or larger than 4×4.
#[must_use]
pub fn inverse<N: Number>(m: &Matrix<N>) -> Matrix<N> {
    let (adjugate, determinant) = adjugate(m);
    let over = |column: &Vec<N>| column.iter().map(|&x| x / determinant).collect();
    Matrix {
        columns: adjugate.columns.iter().map(over).collect(),
    }
}

/// The adjugate, and the determinant.
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
        m => adjugate_of_four(m),
    }
}

/// By the 2×2 minors of the first two and of the last two columns (Laplace).
fn adjugate_of_four<N: Number>(m: &[Vec<N>]) -> (Matrix<N>, N) {
    const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    let minors = |c: usize| PAIRS.map(|(i, j)| m[c][i] * m[c + 1][j] - m[c + 1][i] * m[c][j]);
    let [s0, s1, s2, s3, s4, s5] = minors(0);
    let [c0, c1, c2, c3, c4, c5] = minors(2);
    // Cofactors along column `m[c]`, of minors of the two columns on the other side, with alternating signs.
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
