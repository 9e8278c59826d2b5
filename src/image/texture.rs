//! Textures: images, cube maps and volumes with their mipmaps, in single or double precision.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::Image;
use crate::cube::{FACES, with_borders, without_borders};

/// A texture that shaders sample, alone or with its mipmaps. Clones share the texels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Texture {
    shape: Shape,
    resolution: [u32; 3],
    texels: Texels,
}

/// What a texture consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Shape {
    /// One image.
    Flat,
    /// The six faces of a cube map, stacked, each with a border of the texels of its neighbors: a level of
    /// faces of n×n texels has (n + 2)×6(n + 2).
    Cube,
    /// The slices of a volume, stacked from the first one upwards.
    Volume,
}

/// The levels of a texture, the whole texture first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Texels {
    /// In f32.
    Single(Vec<Arc<Image>>),
    /// In f64: buffers of an evaluation in double precision.
    Double(Vec<Arc<Image<f64>>>),
}

/// A number that texels consist of.
pub trait Component: Copy + Default + Send + Sync + 'static {
    /// `a·(1 − weight) + b·weight`
    #[must_use]
    fn mix(a: Self, b: Self, weight: f64) -> Self;

    /// The mean of three numbers.
    #[must_use]
    fn mean(numbers: [Self; 3]) -> Self;

    /// The levels of a texture.
    fn texels(levels: Vec<Arc<Image<Self>>>) -> Texels;
}

impl Component for f32 {
    /// With the steps of a GPU, which flushes subnormal results to zero.
    fn mix(a: Self, b: Self, weight: f64) -> Self {
        flushed(a + flushed(flushed(b - a) * weight as Self))
    }

    fn mean([a, b, c]: [Self; 3]) -> Self {
        flushed((a + b + c) / 3.0)
    }

    fn texels(levels: Vec<Arc<Image<Self>>>) -> Texels {
        Texels::Single(levels)
    }
}

impl Component for f64 {
    fn mix(a: Self, b: Self, weight: f64) -> Self {
        a + (b - a) * weight
    }

    fn mean([a, b, c]: [Self; 3]) -> Self {
        (a + b + c) / 3.0
    }

    fn texels(levels: Vec<Arc<Image<Self>>>) -> Texels {
        Texels::Double(levels)
    }
}

fn flushed(x: f32) -> f32 {
    if x.is_subnormal() { 0.0_f32.copysign(x) } else { x }
}

impl Texture {
    /// A cube map of six stacked faces, in the order +X, −X, +Y, −Y, +Z, −Z. Row 0 of a face has t = 0.
    /// Its `iChannelResolution` is 0, as that of the site's cube maps.
    ///
    /// # Panics
    /// If the height is not six times the width.
    pub fn cube<T: Component>(stack: &Image<T>) -> Self {
        Self {
            shape: Shape::Cube,
            resolution: [0; 3],
            texels: T::texels(vec![Arc::new(with_borders(stack))]),
        }
    }

    /// A volume of stacked slices of this height, in texels.
    ///
    /// # Panics
    /// If the image does not consist of such slices.
    pub fn volume<T: Component>(stack: Image<T>, height: u32) -> Self {
        let [width, rows] = stack.size();
        assert!(
            rows > 0 && rows.is_multiple_of(height),
            "the slices have one height"
        );
        Self {
            shape: Shape::Volume,
            resolution: [width, height, rows / height],
            texels: T::texels(vec![Arc::new(stack)]),
        }
    }

    /// A flat texture as a texture of another's shape, whose layers it stacks.
    ///
    /// # Panics
    /// If it has not the size of the other's stack.
    #[must_use]
    pub fn shaped_as(self, other: &Self) -> Self {
        let shaped = match other.shape {
            Shape::Cube => self.into_cube(),
            shape => Self { shape, ..self },
        };
        shaped.with_resolution(other.resolution)
    }

    /// The cube map whose faces are stacked in a flat texture.
    ///
    /// # Panics
    /// As [`Self::cube`].
    #[must_use]
    pub fn into_cube(self) -> Self {
        match self.texels {
            Texels::Single(levels) => Self::cube(&levels[0]),
            Texels::Double(levels) => Self::cube(&levels[0]),
        }
    }

    /// The texture without mipmaps.
    #[must_use]
    pub fn without_mipmaps(mut self) -> Self {
        match &mut self.texels {
            Texels::Single(levels) => levels.truncate(1),
            Texels::Double(levels) => levels.truncate(1),
        }
        self
    }

    /// The texture with another `iChannelResolution`, in texels.
    #[must_use]
    pub fn with_resolution(self, resolution: [u32; 3]) -> Self {
        Self { resolution, ..self }
    }

    /// What the texture consists of.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// `iChannelResolution`, in texels.
    pub fn resolution(&self) -> [u32; 3] {
        self.resolution
    }

    /// The texels of each level, as its shape arranges them.
    pub fn texels(&self) -> &Texels {
        &self.texels
    }

    /// The number of levels, at least 1.
    pub fn levels(&self) -> u32 {
        match &self.texels {
            Texels::Single(levels) => levels.len() as u32,
            Texels::Double(levels) => levels.len() as u32,
        }
    }

    /// Width and height of the whole image, of a face or of a slice, in texels.
    ///
    /// # Panics
    /// If there is no level.
    pub fn size(&self) -> [u32; 2] {
        match self.shape {
            Shape::Flat => self.stored_size(),
            Shape::Cube => [self.stored_size()[0] - 2; 2],
            Shape::Volume => [self.resolution[0], self.resolution[1]],
        }
    }

    /// The number of images, faces or slices.
    pub fn layers(&self) -> u32 {
        match self.shape {
            Shape::Flat => 1,
            Shape::Cube => FACES,
            Shape::Volume => self.resolution[2],
        }
    }

    fn stored_size(&self) -> [u32; 2] {
        match &self.texels {
            Texels::Single(levels) => levels[0].size(),
            Texels::Double(levels) => levels[0].size(),
        }
    }

    /// Where the texel (x, y) of the stacked layers is stored. The stack of a cube map has no borders.
    pub fn stored(&self, [x, y]: [u32; 2]) -> [u32; 2] {
        match self.shape {
            Shape::Flat | Shape::Volume => [x, y],
            Shape::Cube => {
                let [side, _] = self.size();
                [x + 1, y / side * (side + 2) + y % side + 1]
            }
        }
    }

    /// Whether the texture has this size, one level, and all texels, which may be false after reading from a
    /// file.
    pub fn is_whole(&self, size: [u32; 2]) -> bool {
        let has_texels = match &self.texels {
            Texels::Single(levels) => matches!(&levels[..], [level] if level.is_whole()),
            Texels::Double(levels) => matches!(&levels[..], [level] if level.is_whole()),
        };
        let is_stack = |[width, height]: [u32; 2]| match self.shape {
            Shape::Flat => true,
            Shape::Cube => width > 2 && height == FACES * width,
            Shape::Volume => [width, height] == [size[0], size[1] * self.resolution[2]],
        };
        has_texels && is_stack(self.stored_size()) && self.size() == size
    }

    /// Each level in f32, as its shape arranges it.
    pub fn to_single(&self) -> Vec<Arc<Image>> {
        match &self.texels {
            Texels::Single(levels) => levels.clone(),
            Texels::Double(levels) => levels.iter().map(|level| Arc::new(level.to_single())).collect(),
        }
    }

    /// Each level in f32: its layers, stacked without borders.
    pub fn stacks(&self) -> Vec<Arc<Image>> {
        let levels = self.to_single();
        match self.shape {
            Shape::Flat | Shape::Volume => levels,
            Shape::Cube => levels
                .iter()
                .map(|level| Arc::new(without_borders(level)))
                .collect(),
        }
    }

    /// The first level in f32: its layers, stacked without borders.
    ///
    /// # Panics
    /// If there is no level.
    pub fn stack(&self) -> Arc<Image> {
        self.clone().without_mipmaps().stacks().swap_remove(0)
    }

    /// A texel of the first level, by its place in the stack of layers.
    ///
    /// # Panics
    /// If there is no such texel.
    pub fn texel(&self, at: [u32; 2]) -> [f64; 4] {
        let [x, y] = self.stored(at);
        match &self.texels {
            Texels::Single(levels) => levels[0].get(x, y).map(f64::from),
            Texels::Double(levels) => levels[0].get(x, y),
        }
    }

    /// The width of the stack of layers, and its height.
    ///
    /// # Panics
    /// If there is no level.
    pub fn stack_size(&self) -> [u32; 2] {
        let [width, height] = self.size();
        [width, height * self.layers()]
    }

    /// The whole image in another size: the lower left part that both have, zeros elsewhere, and no
    /// mipmaps.
    #[must_use]
    pub fn cropped(&self, size: [u32; 2]) -> Self {
        match &self.texels {
            Texels::Single(levels) => Self::from(levels[0].cropped(size)),
            Texels::Double(levels) => Self::from(levels[0].cropped(size)),
        }
    }

    /// The texture with mipmaps down to 1×1: each texel is the mean of its part of the next larger level.
    #[must_use]
    pub fn with_mipmaps(self) -> Self {
        let Self {
            shape,
            resolution,
            texels,
        } = self;
        let texels = match texels {
            Texels::Single(levels) => f32::texels(mipmaps(shape, resolution, levels)),
            Texels::Double(levels) => f64::texels(mipmaps(shape, resolution, levels)),
        };
        Self {
            shape,
            resolution,
            texels,
        }
    }
}

impl<T: Component> From<Image<T>> for Texture {
    fn from(image: Image<T>) -> Self {
        let [width, height] = image.size();
        Self {
            shape: Shape::Flat,
            resolution: [width, height, 1],
            texels: T::texels(vec![Arc::new(image)]),
        }
    }
}

/// Adds the smaller levels to the first one.
fn mipmaps<T: Component>(
    shape: Shape,
    [.., height, depth]: [u32; 3],
    mut levels: Vec<Arc<Image<T>>>,
) -> Vec<Arc<Image<T>>> {
    levels.truncate(1);
    let Some(first) = levels.first() else {
        return levels;
    };
    let mut layers = match shape {
        Shape::Flat => vec![Image::clone(first)],
        Shape::Cube => layers(&without_borders(first), first.size()[0] - 2),
        Shape::Volume => layers(first, height),
    };
    debug_assert!(shape != Shape::Volume || layers.len() == depth as usize);
    while layers[0].size() != [1, 1] || shape == Shape::Volume && layers.len() > 1 {
        layers = layers.iter().map(|layer| layer.halved(T::mix)).collect();
        if shape == Shape::Volume {
            layers = halved_depth(&layers);
        }
        let stack = stack(&layers);
        levels.push(Arc::new(match shape {
            Shape::Flat | Shape::Volume => stack,
            Shape::Cube => with_borders(&stack),
        }));
    }
    levels
}

/// The layers of a stack, of this height each.
fn layers<T: Copy>(stack: &Image<T>, height: u32) -> Vec<Image<T>> {
    let width = stack.size()[0];
    let layers = stack.pixels().chunks_exact(width as usize * height as usize);
    layers
        .map(|pixels| Image::new(width, height, pixels.to_vec()))
        .collect()
}

/// Stacks layers of one size from the bottom up.
fn stack<T: Copy>(layers: &[Image<T>]) -> Image<T> {
    let [width, height] = layers[0].size();
    let pixels = layers.iter().flat_map(|layer| layer.pixels().iter().copied());
    Image::new(width, height * layers.len() as u32, pixels.collect())
}

/// Half as many slices, at least one, as [`Image::halved`] makes half as many rows.
fn halved_depth<T: Component>(slices: &[Image<T>]) -> Vec<Image<T>> {
    let depth = slices.len() as u32;
    let half = (depth / 2).max(1);
    let slice = |at: u32| {
        let (near, far, weight) = between(at, half, depth);
        let [near, far] = [near, far].map(|slice| &slices[slice as usize]);
        let pairs = near.pixels().iter().zip(far.pixels());
        let mixed = pairs.map(|(near, far)| [0, 1, 2, 3].map(|i| T::mix(near[i], far[i], weight)));
        let [width, height] = near.size();
        Image::new(width, height, mixed.collect())
    };
    (0..half).map(slice).collect()
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
    #[must_use]
    pub fn cropped(&self, [width, height]: [u32; 2]) -> Self {
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
        let texture = Texture::from(ramp(4, 2)).with_mipmaps();
        let Texels::Double(levels) = texture.texels() else {
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

    #[test]
    fn mipmaps_of_volumes_are_means_of_eight() {
        let pixels =
            (0..4 * 4 * 4).map(|at| [f64::from(at % 4), f64::from(at / 4 % 4), f64::from(at / 16), 1.0]);
        let volume = Texture::volume(Image::new(4, 16, pixels.collect()), 4).with_mipmaps();
        assert_eq!((volume.size(), volume.layers(), volume.levels()), ([4, 4], 4, 3));
        let Texels::Double(levels) = volume.texels() else {
            panic!("another precision");
        };
        assert_eq!(
            levels[1].get(1, 2),
            [2.5, 0.5, 2.5, 1.0],
            "the first row of the second slice"
        );
        assert_eq!(levels[2].pixels(), [[1.5, 1.5, 1.5, 1.0]]);
    }

    #[test]
    fn mipmaps_of_cube_maps_stay_on_their_faces() {
        let pixels = (0..FACES * 16).map(|at| [f64::from(at / 16), f64::from(at % 4), 0.0, 1.0]);
        let cube = Texture::cube(&Image::new(4, 4 * FACES, pixels.collect())).with_mipmaps();
        assert_eq!((cube.size(), cube.layers(), cube.levels()), ([4, 4], 6, 3));
        let stacks = cube.stacks();
        assert_eq!(stacks[1].get(1, 2), [1.0, 2.5, 0.0, 1.0]);
        let last: Vec<_> = stacks[2].pixels().iter().map(|texel| texel[0]).collect();
        assert_eq!(last, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let [x, y] = cube.stored([3, 7]);
        assert_eq!(cube.to_single()[0].get(x, y), stacks[0].get(3, 7));
    }
}
