//! Substitutes for `ShaderToy`'s noise textures, which are not redistributable: the same on every machine,
//! with the properties that shaders rely on.

use crate::{Image, pcg};

/// A noise texture of `ShaderToy`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Noise {
    /// 256×256 pixels. Green is red moved by 37 pixels to the right and 17 downwards, and alpha is blue moved
    /// in the same way, so that one lookup gives two layers of volume noise.
    RgbaMedium,
    /// 64×64 pixels of independent components.
    RgbaSmall,
    /// 256×256 pixels of one component.
    GrayMedium,
    /// 64×64 pixels of one component.
    GraySmall,
    /// 8×8 pixels of one component: the thresholds of ordered dithering (Bayer, 1973).
    Bayer,
}

/// The number of pixels by which a component of [`Noise::RgbaMedium`] is moved to the right and downwards.
const SHIFT: [u32; 2] = [37, 17];

impl Noise {
    /// The image: 8-bit values as floats. A texture of one component is red; its alpha is 1.
    pub fn image(self) -> Image {
        let side = match self {
            Self::RgbaMedium | Self::GrayMedium => 256,
            Self::RgbaSmall | Self::GraySmall => 64,
            Self::Bayer => 8,
        };
        // Each texture has different numbers.
        let seed = (self as u32) << 24;
        let value =
            |x: u32, y: u32, component: u32| pcg(seed + 4 * ((y % side) * side + x % side) + component) as u8;
        let pixel = |x: u32, y: u32| match self {
            Self::RgbaMedium => {
                let (from_x, from_y) = (x + side - SHIFT[0], y + SHIFT[1]);
                [
                    value(x, y, 0),
                    value(from_x, from_y, 0),
                    value(x, y, 2),
                    value(from_x, from_y, 2),
                ]
            }
            Self::RgbaSmall => [0, 1, 2, 3].map(|component| value(x, y, component)),
            Self::GrayMedium | Self::GraySmall => [value(x, y, 0), 0, 0, u8::MAX],
            Self::Bayer => [4 * bayer_rank(x, side - 1 - y) as u8, 0, 0, u8::MAX],
        };
        let pixels = (0..side).flat_map(|y| (0..side).map(move |x| pixel(x, y)));
        let pixels = pixels.map(|pixel| pixel.map(|component| f32::from(component) / 255.0));
        Image::new(side, side, pixels.collect())
    }
}

/// The texture that `noise` names on the command line: [`Noise::RgbaMedium`].
pub fn noise() -> Image {
    Noise::RgbaMedium.image()
}

/// The rank of a pixel in the 8×8 matrix, 0 to 63: the bits of x ⊕ y and of y, interleaved in reverse order.
fn bayer_rank(x: u32, y: u32) -> u32 {
    let bits = (0..3).map(|bit| (((x ^ y) >> bit & 1) << 1 | (y >> bit & 1)) << (4 - 2 * bit));
    bits.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Noise; 5] = [
        Noise::RgbaMedium,
        Noise::RgbaSmall,
        Noise::GrayMedium,
        Noise::GraySmall,
        Noise::Bayer,
    ];

    /// The correlation of two components, each of one image.
    fn correlation(a: (&Image, usize), b: (&Image, usize)) -> f32 {
        let centered = |image: &Image, component: usize| -> Vec<f32> {
            image
                .pixels()
                .iter()
                .map(|pixel| pixel[component] - 0.5)
                .collect()
        };
        let (a, b) = (centered(a.0, a.1), centered(b.0, b.1));
        let product = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
    }

    #[test]
    fn components_are_uniform_and_independent() {
        for noise in [Noise::RgbaMedium, Noise::RgbaSmall] {
            let image = noise.image();
            let count = image.pixels().len() as f32;
            for i in 0..4 {
                let mean = image.pixels().iter().map(|p| p[i]).sum::<f32>() / count;
                // Uniform samples have a standard deviation of 0.29; five of their mean.
                assert!(
                    (mean - 0.5).abs() < 5.0 * 0.29 / count.sqrt(),
                    "{noise:?}: {mean}"
                );
                for j in 0..i {
                    let correlation = correlation((&image, i), (&image, j));
                    assert!(correlation.abs() < 5.0 / count.sqrt(), "{noise:?}: {correlation}");
                }
            }
        }
        let [medium, gray] = [Noise::RgbaMedium, Noise::GrayMedium].map(Noise::image);
        assert!(correlation((&medium, 0), (&gray, 0)).abs() < 0.02);
    }

    #[test]
    fn green_and_alpha_are_red_and_blue_of_another_layer() {
        let image = Noise::RgbaMedium.image();
        for (x, y) in [(0, 0), (250, 3), (219, 16), (12, 255)] {
            // As shaders write it: (37, 239) with y upwards.
            let moved = image.get((x + 37) % 256, (y + 239) % 256);
            let [red, _, blue, _] = image.get(x, y);
            assert_eq!([moved[1], moved[3]], [red, blue]);
        }
    }

    #[test]
    fn single_components_are_red() {
        for noise in [Noise::GrayMedium, Noise::GraySmall, Noise::Bayer] {
            assert!(
                noise
                    .image()
                    .pixels()
                    .iter()
                    .all(|pixel| pixel[1..] == [0.0, 0.0, 1.0])
            );
        }
    }

    #[test]
    fn the_thresholds_of_dithering_are_the_multiples_of_four() {
        let image = Noise::Bayer.image();
        let mut values: Vec<u8> = image
            .pixels()
            .iter()
            .map(|pixel| (pixel[0] * 255.0) as u8)
            .collect();
        // The first 2×2 pixels of the matrix, from the top: 0, 32, 48, 16 of 64.
        let top = [(0, 7), (1, 7), (0, 6), (1, 6)].map(|(x, y)| (image.get(x, y)[0] * 255.0).round());
        assert_eq!(top, [0.0, 128.0, 192.0, 64.0]);
        values.sort_unstable();
        assert_eq!(values, (0..64).map(|rank| 4 * rank).collect::<Vec<_>>());
    }

    #[test]
    fn sizes_are_those_of_the_site() {
        assert_eq!(ALL.map(|noise| noise.image().size()[0]), [256, 64, 256, 64, 8]);
    }
}
