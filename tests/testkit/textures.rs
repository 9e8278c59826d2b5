//! Textures of random values between −1 and 2, in every shape.

use toyproof::image::{Image, Texture, cube, pcg};

/// An image.
#[must_use]
pub fn random_image(width: u32, height: u32) -> Image {
    let value = |at: u32| 3.0 * (pcg(at) as f32 / u32::MAX as f32) - 1.0;
    let pixels = (0..width * height).map(|at| [0, 1, 2, 3].map(|component| value(4 * at + component)));
    Image::new(width, height, pixels.collect())
}

/// A cube map with faces of this side.
#[must_use]
pub fn random_cube(side: u32) -> Texture {
    Texture::cube(&random_image(side, cube::FACES * side))
}

/// A volume.
#[must_use]
pub fn random_volume([width, height, depth]: [u32; 3]) -> Texture {
    Texture::volume(random_image(width, height * depth), height)
}
