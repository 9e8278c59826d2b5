//! Half-precision floats (IEEE 754 binary16).

/// To the nearest, ties to even; what is too large becomes infinite.
pub(super) fn to_bits(x: f32) -> u16 {
    let bits = x.to_bits();
    let sign = (bits >> 16) as u16 & 0x8000;
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return sign | 0x7e00;
    }
    // From 65,520 on, halfway past the largest.
    if magnitude >= 0x477f_f000 {
        return sign | 0x7c00;
    }
    if magnitude < 0x3880_0000 {
        // Below the smallest normal: units of 2⁻²⁴. Exact, for the scale is a power of two.
        let units = (f32::from_bits(magnitude) * 16_777_216.0).round_ties_even();
        return sign | units as u16;
    }
    let rounded = magnitude + 0xfff + (magnitude >> 13 & 1);
    sign | ((rounded - 0x3800_0000) >> 13) as u16
}

/// Exact.
pub(super) fn from_bits(half: u16) -> f32 {
    let sign = u32::from(half & 0x8000) << 16;
    let (exponent, fraction) = (u32::from(half >> 10 & 0x1f), u32::from(half & 0x3ff));
    let magnitude = match exponent {
        0 => (fraction as f32 / 16_777_216.0).to_bits(),
        31 => 0x7f80_0000 | fraction << 13,
        _ => (exponent + 112) << 23 | fraction << 13,
    };
    f32::from_bits(sign | magnitude)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_comes_back_and_what_lies_between_goes_to_the_nearest() {
        for half in 0..=u16::MAX {
            let float = from_bits(half);
            if !float.is_nan() {
                assert_eq!(to_bits(float), half, "{float}");
            }
        }
        let above_one = from_bits(0x3c01);
        assert_eq!(to_bits(f32::midpoint(1.0, above_one)), 0x3c00, "ties go to even");
        assert_eq!(to_bits(65_519.0), 0x7bff);
        assert_eq!(to_bits(65_520.0), 0x7c00);
    }
}
