//! A texture of noise, the same on every machine.

use super::Image;

/// The side of the noise texture, in pixels; ShaderToy's own is as large.
const SIDE: u32 = 256;

/// 256×256 pixels of independent 8-bit values in all four components.
#[must_use]
pub fn noise() -> Image {
    let pixels = (0..SIDE * SIDE)
        .map(|index| [0, 1, 2, 3].map(|component| f32::from(pcg(4 * index + component) as u8) / 255.0))
        .collect();
    Image::new(SIDE, SIDE, pixels)
}

/// The PCG hash of Jarzynski and Olano, “Hash Functions for GPU Rendering”, JCGT 9(3), 2020.
#[inline]
#[must_use]
pub fn pcg(input: u32) -> u32 {
    let state = input.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_even_and_its_components_are_independent() {
        let image = noise();
        let count = image.pixels().len() as f32;
        for i in 0..4 {
            let mean = image.pixels().iter().map(|p| p[i]).sum::<f32>() / count;
            // The mean of 65,536 even draws strays by 0.0011 at one standard deviation.
            assert!((mean - 0.5).abs() < 0.005, "{mean}");
        }
        let product = image
            .pixels()
            .iter()
            .map(|p| (p[0] - 0.5) * (p[1] - 0.5))
            .sum::<f32>()
            / count;
        assert!(product.abs() < 0.002, "{product}");
    }
}
