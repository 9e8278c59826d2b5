//! Angles and the common functions (§8.1, §8.3), of one component.

use std::f64::consts::PI;

use super::Number;

/// `x·π/180`
#[inline]
#[must_use]
pub fn radians<N: Number>(x: N) -> N {
    x * x.literal(PI / 180.0)
}

/// `x·180/π`
#[inline]
#[must_use]
pub fn degrees<N: Number>(x: N) -> N {
    x * x.literal(180.0 / PI)
}

/// `1 / √x`
#[inline]
#[must_use]
pub fn inverse_sqrt<N: Number>(x: N) -> N {
    x.literal(1.0) / x.sqrt()
}

/// −1, 0 or 1; 0 also of NaN.
#[inline]
#[must_use]
pub fn sign<N: Number>(x: N) -> N {
    let zero = x.literal(0.0);
    let positive = N::select(zero.less(x), x.literal(1.0), zero);
    N::select(x.less(zero), x.literal(-1.0), positive)
}

/// `x − floor(x)`: 1 itself just below zero.
#[inline]
#[must_use]
pub fn fract<N: Number>(x: N) -> N {
    x - x.floor()
}

/// `mod(x, y)`: `x − y·floor(x / y)`
#[inline]
#[must_use]
pub fn modulo<N: Number>(x: N, y: N) -> N {
    x - y * (x / y).floor()
}

/// `min(max(x, low), high)`
#[inline]
#[must_use]
pub fn clamp<N: Number>(x: N, low: N, high: N) -> N {
    x.max(low).min(high)
}

/// `a·(1 − t) + b·t`
#[inline]
#[must_use]
pub fn mix<N: Number>(a: N, b: N, t: N) -> N {
    a * (t.literal(1.0) - t) + b * t
}

/// 0 where `x < edge`, 1 elsewhere.
#[inline]
#[must_use]
pub fn step<N: Number>(edge: N, x: N) -> N {
    N::select(x.less(edge), x.literal(0.0), x.literal(1.0))
}

/// `t²·(3 − 2t)` with t = `clamp((x − low) / (high − low), 0, 1)`
#[inline]
#[must_use]
pub fn smoothstep<N: Number>(low: N, high: N, x: N) -> N {
    let t = clamp((x - low) / (high - low), x.literal(0.0), x.literal(1.0));
    t * t * (x.literal(3.0) - x.literal(2.0) * t)
}
