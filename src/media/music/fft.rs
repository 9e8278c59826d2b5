//! The discrete Fourier transform of 2048 numbers, with the same bits on every machine.

use std::sync::LazyLock;

use toyproof_math::double;

/// The number of points.
pub(super) const SIZE: usize = 2048;

/// `e^(−2πi·k/SIZE)` for k < SIZE/2, as real and imaginary parts.
static ROOTS: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| {
    let root = |k: usize| {
        let ([sine], [cosine]) = double::sin_cos([std::f64::consts::TAU * k as f64 / SIZE as f64]);
        [cosine, -sine]
    };
    (0..SIZE / 2).map(root).collect()
});

/// The transform of real numbers, Σ x[n]·e^(−2πi·kn/SIZE), by the algorithm of Cooley and Tukey (1965).
pub(super) fn transform(numbers: &[f64; SIZE]) -> Vec<[f64; 2]> {
    let bits = SIZE.trailing_zeros();
    let mut values: Vec<[f64; 2]> = (0..SIZE)
        .map(|at| [numbers[at.reverse_bits() >> (usize::BITS - bits)], 0.0])
        .collect();
    let mut half = 1;
    while half < SIZE {
        for block in values.chunks_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for (at, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let [cosine, sine] = ROOTS[at * (SIZE / 2 / half)];
                let turned = [b[0] * cosine - b[1] * sine, b[0] * sine + b[1] * cosine];
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        half *= 2;
    }
    values
}

#[cfg(test)]
mod tests {
    use toyproof_image::pcg;

    use super::*;

    #[test]
    fn the_transform_is_the_sum_that_defines_it() {
        let numbers: [f64; SIZE] =
            std::array::from_fn(|at| f64::from(pcg(at as u32)) / f64::from(u32::MAX) - 0.5);
        let transformed = transform(&numbers);
        for k in [0, 1, 2, 700, 1024, 1025, 2047] {
            let mut sum = [0.0; 2];
            for (n, x) in numbers.iter().enumerate() {
                let turns = (k * n % SIZE) as f64 / SIZE as f64;
                let (sine, cosine) = (std::f64::consts::TAU * turns).sin_cos();
                sum = [sum[0] + x * cosine, sum[1] - x * sine];
            }
            let difference = (0..2)
                .map(|i| (sum[i] - transformed[k][i]).abs())
                .fold(0.0, f64::max);
            // 2048 roundings of sums of up to about 40.
            assert!(difference < 1e-11, "{k}: {difference}");
        }
    }
}
