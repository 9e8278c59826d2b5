//! Volumes: the stand-ins, and files in the site's format.

use toyproof_image::{Image, pcg};

/// The side of the site's volumes, in texels.
const SIDE: u32 = 32;

/// The volume of noise with `channels` independent components: 8-bit values, white and even. A volume of one
/// component reads as (r, 0, 0, 1).
pub(crate) fn noise(channels: u8) -> Vec<Image> {
    let value = |at: u32, component: u32| pcg(pcg(4 * at + component) ^ (u32::from(channels) << 28)) as u8;
    let texel = |at: u32| match channels {
        1 => [f32::from(value(at, 0)) / 255.0, 0.0, 0.0, 1.0],
        _ => [0, 1, 2, 3].map(|component| f32::from(value(at, component)) / 255.0),
    };
    let slice = |z: u32| {
        let texels = (z * SIDE * SIDE..(z + 1) * SIDE * SIDE).map(texel);
        Image::new(SIDE, SIDE, texels.collect())
    };
    (0..SIDE).map(slice).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_are_even_and_independent_of_their_neighbors() {
        for channels in [1, 4] {
            let volume = noise(channels);
            let texels: Vec<_> = volume.iter().flat_map(Image::pixels).collect();
            assert_eq!(texels.len(), 32 * 32 * 32);
            let count = texels.len() as f32;
            for component in 0..usize::from(channels) {
                let value = |at: usize| texels[at % texels.len()][component] - 0.5;
                let sum = |f: &dyn Fn(usize) -> f32| (0..texels.len()).map(f).sum::<f32>() / count;
                // Five standard deviations of the mean, and of the mean product of independent numbers.
                assert!(sum(&|at| value(at)).abs() < 5.0 * 0.29 / count.sqrt());
                for next in [1, 32, 32 * 32] {
                    let product = sum(&|at| value(at) * value(at + next));
                    assert!(
                        product.abs() < 5.0 * 0.29 * 0.29 / count.sqrt(),
                        "{next}: {product}"
                    );
                }
                for other in 1..=component {
                    let product = sum(&|at| value(at) * (texels[at][component - other] - 0.5));
                    assert!(
                        product.abs() < 5.0 * 0.29 * 0.29 / count.sqrt(),
                        "{other}: {product}"
                    );
                }
            }
        }
    }
}
