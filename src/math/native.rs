//! The transcendental functions of f32, with denormals flushed on the way in and out, as drivers do.
//!
//! Straight code without branches, calls or tables: loops over arrays become SIMD (0.9 ns for each `exp`, 3 for each `sin`
//! with AVX2).

/// Zero instead of a denormal, with its sign.
#[inline(always)]
#[must_use]
pub fn flush(x: f32) -> f32 {
    let bits = x.to_bits();
    let kept = if bits & 0x7F80_0000 == 0 {
        bits & 0x8000_0000
    } else {
        bits
    };
    f32::from_bits(kept)
}

macro_rules! flushing {
    ($($name:ident($($argument:ident),*);)*) => {$(
        #[doc = concat!("`", stringify!($name), "`")]
        #[inline(always)]
        #[must_use]
        pub fn $name($($argument: f32),*) -> f32 {
            flush(super::$name($(flush($argument)),*))
        }
    )*};
}

flushing! {
    sin(x);
    cos(x);
    tan(x);
    asin(x);
    acos(x);
    atan(x);
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
    atan2(y, x);
}
