//! Images of 8-bit display values.

use crate::{Image, quantize};

/// An image with 8 bits for each of red, green and blue, bottom row first. It takes a fifth of the memory of
/// an [`Image`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rgb8Image {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
}

impl Rgb8Image {
    /// Makes an image from its pixels, bottom row first.
    ///
    /// # Panics
    /// If the number of pixels is not `width · height`.
    pub fn new(width: u32, height: u32, pixels: Vec<[u8; 3]>) -> Self {
        assert_eq!(pixels.len(), width as usize * height as usize);
        Self {
            width,
            height,
            pixels,
        }
    }

    /// Makes an image without rows, with capacity for `height` rows.
    pub fn empty(width: u32, height: u32) -> Self {
        Self {
            width,
            height: 0,
            pixels: Vec::with_capacity(width as usize * height as usize),
        }
    }

    /// Appends the rows of an image of the same width above the existing ones.
    ///
    /// # Panics
    /// If the widths differ.
    pub fn extend(&mut self, above: &Image) {
        let [width, height] = above.size();
        assert_eq!(width, self.width);
        self.height += height;
        let colors = above.pixels().iter().map(|&[r, g, b, _]| [r, g, b].map(quantize));
        self.pixels.extend(colors);
    }

    /// The common color of all pixels; `None` if they differ.
    pub fn only_color(&self) -> Option<[u8; 3]> {
        let &first = self.pixels.first()?;
        self.pixels.iter().all(|&pixel| pixel == first).then_some(first)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// All pixels, bottom row first.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// The pixel at (x, y), y upwards from the bottom.
    pub fn get(&self, x: u32, y: u32) -> [u8; 3] {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The rows, from the bottom up.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[[u8; 3]]> + Clone {
        self.pixels.chunks(self.width as usize)
    }
}

impl From<&Image> for Rgb8Image {
    fn from(image: &Image) -> Self {
        let [width, height] = image.size();
        let mut rgb = Self::empty(width, height);
        rgb.extend(image);
        rgb
    }
}

impl From<&Rgb8Image> for Image {
    fn from(rgb: &Rgb8Image) -> Self {
        let float = |&[r, g, b]: &[u8; 3]| {
            let [r, g, b] = [r, g, b].map(|component| f32::from(component) / 255.0);
            [r, g, b, 1.0]
        };
        Self::new(rgb.width, rgb.height, rgb.pixels.iter().map(float).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_stacked_and_quantized() {
        let band = |red| Image::new(2, 1, vec![[red, 0.5, f32::NAN, 1.0]; 2]);
        let mut rgb = Rgb8Image::empty(2, 2);
        rgb.extend(&band(0.0));
        assert_eq!(rgb.only_color(), Some([0, 128, 0]));
        rgb.extend(&band(7.0));
        assert_eq!(rgb.size(), [2, 2]);
        assert_eq!(rgb.get(1, 0), [0, 128, 0]);
        assert_eq!(rgb.get(0, 1), [255, 128, 0]);
        assert_eq!(rgb.rows().count(), 2);
        assert_eq!(rgb.only_color(), None);
    }
}
