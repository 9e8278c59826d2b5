//! Volumes: the stand-ins, and files in the site's format.

use std::path::Path;

use toyproof_image::{Image, MAX_PIXELS, input, pcg};

use crate::error::MediaError;

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

/// The most texels along a side: what most drivers allow.
const MAX_SIDE: u32 = 2048;

/// Reads a volume in the site's format: the signature `BIN\0`, width, height and depth in 4 bytes each, the
/// number of components, a byte for their layout, 2 bytes for their type (0: 8 bits, 10: 32-bit floats),
/// and the texels, x first. Numbers are little-endian. The slices are returned z = 0 first.
///
/// The site takes the depth from the height, so that a volume with another one is not one that it could read.
///
/// # Errors
/// If the file is not a volume, is too large, or is shorter than its size says.
pub fn read_volume(path: &Path) -> Result<Vec<Image>, MediaError> {
    let bytes = input::read(path).map_err(|error| MediaError::new(path, error.to_string()))?;
    parse(&bytes).map_err(|problem| MediaError::new(path, problem))
}

fn parse(bytes: &[u8]) -> Result<Vec<Image>, String> {
    const HEADER_BYTES: usize = 20;
    let (header, data) = bytes
        .split_first_chunk::<HEADER_BYTES>()
        .filter(|(header, _)| header.starts_with(b"BIN\0"))
        .ok_or("the file is not a volume in ShaderToy's format, which begins with BIN")?;
    let side = |at: usize| u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    let [width, height, depth] = [4, 8, 12].map(side);
    let (components, format) = (header[16], u16::from_le_bytes([header[18], header[19]]));
    let count = u64::from(width) * u64::from(height) * u64::from(depth);
    if [width, height, depth]
        .iter()
        .any(|side| !(1..=MAX_SIDE).contains(side))
        || count > MAX_PIXELS
    {
        return Err(format!(
            "a volume of {width}×{height}×{depth} texels is empty or too large"
        ));
    }
    if depth != height {
        return Err(format!(
            "the volume is {height} texels high and {depth} deep; the site takes the depth from the height"
        ));
    }
    if !(1..=4).contains(&components) {
        return Err(format!("the volume has {components} components, not 1 to 4"));
    }
    let width_in_bytes = match format {
        0 => 1,
        10 => 4,
        _ => {
            return Err(format!(
                "the type {format} of the volume is neither 0 (8 bits) nor 10 (floats)"
            ));
        }
    };
    let texel_bytes = usize::from(components) * width_in_bytes;
    let expected = count as usize * texel_bytes;
    let data = data.get(..expected).ok_or_else(|| {
        format!(
            "the volume has {} bytes of texels, but its size needs {expected}",
            data.len()
        )
    })?;
    let texel = |bytes: &[u8]| {
        let mut texel = [0.0, 0.0, 0.0, 1.0];
        for (component, bytes) in texel.iter_mut().zip(bytes.chunks(width_in_bytes)) {
            *component = match *bytes {
                [a, b, c, d] => f32::from_le_bytes([a, b, c, d]),
                _ => f32::from(bytes[0]) / 255.0,
            };
        }
        texel
    };
    let slices = data.chunks(width as usize * height as usize * texel_bytes);
    Ok(slices
        .map(|slice| Image::new(width, height, slice.chunks(texel_bytes).map(texel).collect()))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(size: [u32; 3], components: u8, format: u16, texels: &[u8]) -> Vec<u8> {
        let mut bytes = b"BIN\0".to_vec();
        bytes.extend(size.map(u32::to_le_bytes).as_flattened());
        bytes.extend([components, 0]);
        bytes.extend(format.to_le_bytes());
        bytes.extend(texels);
        bytes
    }

    #[test]
    fn volumes_of_bytes_and_of_floats_are_read() {
        let slices = parse(&file([1, 2, 2], 1, 0, &[0, 51, 102, 255])).unwrap();
        assert_eq!(slices.len(), 2);
        assert_eq!(slices[0].get(0, 1), [0.2, 0.0, 0.0, 1.0]);
        assert_eq!(slices[1].get(0, 1), [1.0, 0.0, 0.0, 1.0]);
        let floats: Vec<u8> = [1.5_f32, -2.0, 0.25, 7.0]
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let slices = parse(&file([1, 1, 1], 4, 10, &floats)).unwrap();
        assert_eq!(slices[0].pixels(), [[1.5, -2.0, 0.25, 7.0]]);
        let slices = parse(&file([1, 1, 1], 3, 0, &[255, 51, 0])).unwrap();
        assert_eq!(slices[0].pixels(), [[1.0, 0.2, 0.0, 1.0]]);
    }

    #[test]
    fn what_is_not_a_volume_is_an_error() {
        let rejected = |bytes: &[u8], reason: &str| {
            let error = parse(bytes).unwrap_err();
            assert!(error.contains(reason), "{error}");
        };
        rejected(b"BIN", "is not a volume");
        rejected(&[7; 40], "is not a volume");
        rejected(&file([0, 1, 1], 1, 0, &[]), "empty or too large");
        rejected(&file([2048, 2048, 2048], 4, 10, &[]), "empty or too large");
        rejected(&file([u32::MAX; 3], 4, 10, &[]), "empty or too large");
        rejected(&file([1, 1, 2], 1, 0, &[0, 0]), "from the height");
        rejected(&file([1, 1, 1], 9, 0, &[0; 9]), "9 components");
        rejected(&file([1, 1, 1], 1, 5, &[0; 9]), "the type 5");
        rejected(&file([2, 2, 2], 4, 0, &[0; 31]), "needs 32");
    }

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
