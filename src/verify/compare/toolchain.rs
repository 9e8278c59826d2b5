//! Was the shader run as it stands? The GPU in f32 against the CPU in f32, bit for bit.

use toyproof_image::Image;

use super::Standing;

/// Compares the bits of red, green and blue of the GPU's picture, `actual`, with the CPU's, `expected`. All NaN are
/// one: their bits mean nothing in GLSL. So are the two zeros: Vulkan leaves a zero's sign to the driver, unless `SignedZeroInfNanPreserve`
/// asks for it; llvmpipe 22.3 then keeps that of `0.0 * x`, but not of `0.0 - x`, and loses others. What a sign decides, as in `1.0 / x`, differs by more.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn toolchain(expected: &Image, actual: &Image, undefined: &[bool]) -> Vec<Standing> {
    assert_eq!(expected.size(), actual.size());
    let same = |a: f32, b: f32| a == b || (a.is_nan() && b.is_nan());
    let pixels = expected.pixels().iter().zip(actual.pixels()).zip(undefined);
    let standing = |((a, b), &undefined): ((&[f32; 4], &[f32; 4]), &bool)| {
        if undefined {
            Standing::Undefined
        } else if (0..3).all(|i| same(a[i], b[i])) {
            Standing::Agrees
        } else {
            Standing::Differs
        }
    };
    pixels.map(standing).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bit_is_a_difference_but_nans_and_zeros_are_alike() {
        let one = |red: f32| Image::new(1, 1, vec![[red, 0.0, 0.0, 1.0]]);
        let asked = |a, b| toolchain(&one(a), &one(b), &[false])[0];
        assert_eq!(asked(1.0, 1.0), Standing::Agrees);
        assert_eq!(asked(1.0, 1.0f32.next_up()), Standing::Differs);
        assert_eq!(asked(0.0, -0.0), Standing::Agrees);
        assert_eq!(asked(0.0, f32::from_bits(1)), Standing::Differs);
        assert_eq!(asked(f32::NAN, -f32::NAN), Standing::Agrees);
        assert_eq!(asked(f32::NAN, 0.0), Standing::Differs);
        assert_eq!(toolchain(&one(0.0), &one(1.0), &[true]), [Standing::Undefined]);
    }
}
