//! Textures: images with their mipmaps, in single or double precision.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::Image;

/// An image that shaders sample, alone or with its mipmaps. Clones share the texels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Texture {
    /// The levels in f32, the whole image first.
    Single(Vec<Arc<Image>>),
    /// The levels in f64, the whole image first: buffers of an evaluation in double precision.
    Double(Vec<Arc<Image<f64>>>),
}

impl Texture {
    /// The number of levels, at least 1.
    pub fn levels(&self) -> u32 {
        match self {
            Self::Single(levels) => levels.len() as u32,
            Self::Double(levels) => levels.len() as u32,
        }
    }

    /// Width and height of the whole image, in texels.
    ///
    /// # Panics
    /// If there is no level.
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Single(levels) => levels[0].size(),
            Self::Double(levels) => levels[0].size(),
        }
    }

    /// Whether the texture has this size, one level, and all texels, which may be false after reading from a
    /// file.
    pub fn is_whole(&self, size: [u32; 2]) -> bool {
        match self {
            Self::Single(levels) => {
                matches!(&levels[..], [level] if level.is_whole() && level.size() == size)
            }
            Self::Double(levels) => {
                matches!(&levels[..], [level] if level.is_whole() && level.size() == size)
            }
        }
    }

    /// Each level in f32.
    pub fn to_single(&self) -> Vec<Arc<Image>> {
        match self {
            Self::Single(levels) => levels.clone(),
            Self::Double(levels) => levels.iter().map(|level| Arc::new(level.to_single())).collect(),
        }
    }

    /// The whole image in another size: the lower left part that both have, zeros elsewhere, and no
    /// mipmaps.
    #[must_use]
    pub fn cropped(&self, size: [u32; 2]) -> Self {
        match self {
            Self::Single(levels) => Self::from(levels[0].cropped(size)),
            Self::Double(levels) => Self::from(levels[0].cropped(size)),
        }
    }

    /// The texture with mipmaps down to 1×1: each texel is the mean of its part of the next larger level.
    #[must_use]
    pub fn with_mipmaps(self) -> Self {
        match self {
            Self::Single(levels) => Self::Single(mipmaps(levels, mix_as_drivers)),
            Self::Double(levels) => Self::Double(mipmaps(levels, |a, b, weight| a + (b - a) * weight)),
        }
    }
}

/// `a + (b − a)·weight` with subnormal results flushed to zero.
fn mix_as_drivers(a: f32, b: f32, weight: f64) -> f32 {
    let flushed = |x: f32| if x.is_subnormal() { 0.0_f32.copysign(x) } else { x };
    flushed(a + flushed(flushed(b - a) * weight as f32))
}

impl From<Image> for Texture {
    fn from(image: Image) -> Self {
        Self::Single(vec![Arc::new(image)])
    }
}

impl From<Image<f64>> for Texture {
    fn from(image: Image<f64>) -> Self {
        Self::Double(vec![Arc::new(image)])
    }
}

/// Adds the smaller levels to the first one.
fn mipmaps<T: Copy>(mut levels: Vec<Arc<Image<T>>>, mix: impl Fn(T, T, f64) -> T) -> Vec<Arc<Image<T>>> {
    levels.truncate(1);
    while let Some(last) = levels.last()
        && last.size() != [1, 1]
    {
        let half = last.halved(&mix);
        levels.push(Arc::new(half));
    }
    levels
}

impl Image<f64> {
    /// The image rounded to f32.
    pub fn to_single(&self) -> Image {
        let [width, height] = self.size();
        let pixels = self.pixels().iter();
        Image::new(
            width,
            height,
            pixels
                .map(|pixel| pixel.map(|component| component as f32))
                .collect(),
        )
    }
}

impl<T: Copy + Default> Image<T> {
    /// The lower left part, in this size; zeros where this image ends.
    fn cropped(&self, [width, height]: [u32; 2]) -> Self {
        let [own_width, own_height] = self.size();
        let pixel = |x, y| {
            let is_inside = x < own_width && y < own_height;
            if is_inside {
                self.get(x, y)
            } else {
                [T::default(); 4]
            }
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| pixel(x, y)));
        Self::new(width, height, pixels.collect())
    }
}

impl<T: Copy> Image<T> {
    /// The image in half the size, rounded down, but at least 1 pixel: the next mipmap. Each pixel samples
    /// this image at its center, between the nearest pixels: if the size is even, it is the mean of four.
    /// `mix(a, b, w)` is `a·(1 − w) + b·w`.
    #[must_use]
    pub fn halved(&self, mix: impl Fn(T, T, f64) -> T) -> Self {
        let [width, height] = self.size().map(|side| (side / 2).max(1));
        let columns: Vec<_> = (0..width).map(|x| between(x, width, self.size()[0])).collect();
        let rows = (0..height).map(|y| between(y, height, self.size()[1]));
        let pixels = rows.flat_map(|(low, high, up)| {
            let (mix, columns) = (&mix, &columns);
            columns.iter().map(move |&(left, right, across)| {
                let corner = |x, y| self.get(x, y);
                let [a, b, c, d] =
                    [(left, low), (right, low), (left, high), (right, high)].map(|(x, y)| corner(x, y));
                [0, 1, 2, 3].map(|i| mix(mix(a[i], b[i], across), mix(c[i], d[i], across), up))
            })
        });
        Self::new(width, height, pixels.collect())
    }
}

/// The two texels of a row of `length` whose centers enclose the center of texel `at` of a row of `half`, and
/// the weight of the second. The quotient is rounded to f32, so that it has the same bits on a GPU.
fn between(at: u32, half: u32, length: u32) -> (u32, u32, f64) {
    // The center is at (at + 1/2) · length / half − 1/2.
    let numerator = (2 * at + 1) * length - half;
    let first = numerator / (2 * half);
    let weight = (numerator % (2 * half)) as f32 / (2 * half) as f32;
    (first, (first + 1).min(length - 1), f64::from(weight))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: u32, height: u32) -> Image<f64> {
        let pixels = (0..width * height).map(|at| [f64::from(at % width), f64::from(at / width), 0.0, 1.0]);
        Image::new(width, height, pixels.collect())
    }

    #[test]
    fn mipmaps_of_powers_of_two_are_means_of_four() {
        let Texture::Double(levels) = Texture::from(ramp(4, 2)).with_mipmaps() else {
            panic!("another precision");
        };
        assert_eq!(levels[1].pixels(), [[0.5, 0.5, 0.0, 1.0], [2.5, 0.5, 0.0, 1.0]]);
        assert_eq!(levels[2].pixels(), [[1.5, 0.5, 0.0, 1.0]]);
        assert_eq!(levels.len(), 3);
    }

    #[test]
    fn a_ramp_stays_a_ramp_in_every_size() {
        for width in 1..40 {
            let half = ramp(width, 1).halved(|a, b, weight| a + (b - a) * weight);
            let size = half.size()[0];
            for x in 0..size {
                let center = (f64::from(x) + 0.5) * f64::from(width) / f64::from(size) - 0.5;
                let [value, ..] = half.get(x, 0);
                assert!(
                    (value - center).abs() < 1e-5,
                    "{width}: {value} at {x}, not {center}"
                );
            }
        }
    }

    #[test]
    fn a_texture_without_mipmaps_has_one_level() {
        let texture = Texture::from(ramp(3, 2));
        assert_eq!((texture.levels(), texture.size()), (1, [3, 2]));
        assert_eq!(texture.to_single()[0].get(2, 1), [2.0, 1.0, 0.0, 1.0]);
    }
}
