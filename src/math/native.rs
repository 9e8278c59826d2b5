//! Transcendental functions of f32 that flush denormal arguments and results, as drivers do.
//!
//! The code has no branches, calls or tables, so that loops over arrays are vectorized (with AVX2, 0.9 ns for
//! each `exp` and 3 ns for each `sin`).

/// Replaces a denormal by zero with the same sign.
#[inline(always)]
pub fn flush(x: f32) -> f32 {
    let bits = x.to_bits();
    let kept = if bits & 0x7F80_0000 == 0 {
        bits & 0x8000_0000
    } else {
        bits
    };
    f32::from_bits(kept)
}

/// `sin` and `cos`
#[inline(always)]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let (sine, cosine) = crate::trigonometric::sin_cos(flush(x));
    (flush(sine), flush(cosine))
}

macro_rules! flushing {
    ($module:ident: $($name:ident($($argument:ident),*);)*) => {$(
        #[doc = concat!("`", stringify!($name), "`")]
        #[inline(always)]
        pub fn $name($($argument: f32),*) -> f32 {
            flush(crate::$module::$name($(flush($argument)),*))
        }
    )*};
}

flushing! { trigonometric:
    sin(x);
    cos(x);
    tan(x);
    asin(x);
    acos(x);
    atan(x);
    atan2(y, x);
}

flushing! { exponential:
    sinh(x);
    cosh(x);
    tanh(x);
    asinh(x);
    acosh(x);
    atanh(x);
    exp(x);
    exp2(x);
    log(x);
    log2(x);
    pow(x, y);
}
