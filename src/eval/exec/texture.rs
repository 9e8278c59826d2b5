//! Texels of textures, in any precision.

use std::sync::Arc;

use toyproof_glsl::tree::SamplerShape;
use toyproof_image::{Image, Shape, Texels, Texture, cube};

use crate::exec::number::Arithmetic;

/// The textures of channels that have the shapes which a shader declares; others count as unbound. An unbound
/// cube map is black.
pub(crate) fn fitting(shapes: [SamplerShape; 4], channels: &[Option<Texture>; 4]) -> [Option<Texture>; 4] {
    std::array::from_fn(|channel| {
        let texture = channels[channel].as_ref();
        let of_shape = |shape| texture.filter(|texture| texture.shape() == shape).cloned();
        match shapes[channel] {
            SamplerShape::D2 => of_shape(Shape::Flat),
            SamplerShape::D3 => of_shape(Shape::Volume),
            SamplerShape::Cube => of_shape(Shape::Cube).or_else(|| {
                let faces = vec![[0.0_f32, 0.0, 0.0, 1.0]; cube::FACES as usize];
                Some(Texture::cube(&Image::new(1, cube::FACES, faces)))
            }),
            SamplerShape::D2Array => None,
        }
    })
}

/// The width, height or depth of a texture in texels; 1 if there is none.
pub(crate) fn extent(texture: Option<&Texture>, axis: u8) -> u32 {
    texture.map_or(1, |texture| {
        let [width, height] = texture.size();
        [width, height, texture.layers()][usize::from(axis)]
    })
}

/// A component of a texel; none beyond the texture, and in levels that do not exist. There it is 0, as in
/// browsers.
#[inline(always)]
pub(crate) fn fetch<T: Copy>(
    levels: &[Arc<Image<T>>],
    [x, y]: [u32; 2],
    level: u32,
    component: usize,
) -> Option<T> {
    let image = levels.get(level as usize)?;
    let [width, height] = image.size();
    // The texel is not copied as a whole: this is called for each component.
    (x < width && y < height).then(|| image.pixels()[y as usize * width as usize + x as usize][component & 3])
}

/// A component of a texel of an unbound channel: one texel of opaque black.
pub(crate) fn unbound<N: Arithmetic>(at: [u32; 2], level: u32, component: usize) -> N {
    N::from_f64(f64::from(u8::from(at == [0, 0] && level == 0 && component == 3)))
}

/// A component of a texel of the first level, in the stack of layers.
pub(crate) fn texel<N: Arithmetic>(texture: &Texture, at: [u32; 2], component: usize) -> N {
    let [x, y] = texture.stored(at);
    match texture.texels() {
        Texels::Single(levels) => N::from_f32(levels[0].get(x, y)[component]),
        Texels::Double(levels) => N::from_f64(levels[0].get(x, y)[component]),
    }
}

#[cfg(test)]
mod tests {
    use toyproof_image::Image;

    use super::*;

    #[test]
    fn texels_beyond_a_texture_are_zero() {
        let image = Image::new(2, 1, vec![[1.0_f32; 4], [2.0; 4]]);
        let texture = Texture::from(image).with_mipmaps();
        let Texels::Single(levels) = texture.texels() else {
            panic!("images hold floats");
        };
        let at = |x: i32, y: i32, level: i32| {
            fetch(levels, [x, y].map(i32::cast_unsigned), level.cast_unsigned(), 2).unwrap_or_default()
        };
        assert_eq!([at(0, 0, 0), at(1, 0, 0), at(0, 0, 1)], [1.0, 2.0, 1.5]);
        assert_eq!(
            [
                at(2, 0, 0),
                at(-1, 0, 0),
                at(0, 1, 0),
                at(1, 0, 1),
                at(0, 0, 2),
                at(0, 0, -1)
            ],
            [0.0; 6]
        );
    }
}
