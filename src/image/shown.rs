//! A picture as a viewer sees it.

use super::{Image, quantise};

/// A picture of 8 bits for each of red, green and blue, bottom row first: a fifth of the memory of an [`Image`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
}

impl Shown {
    /// A picture from its pixels, bottom row first.
    ///
    /// # Panics
    /// If the count of pixels is not `width · height`.
    #[must_use]
    pub fn new(width: u32, height: u32, pixels: Vec<[u8; 3]>) -> Self {
        assert_eq!(pixels.len(), width as usize * height as usize);
        Self {
            width,
            height,
            pixels,
        }
    }

    /// A picture of that width without any rows, which there is room for `height` of.
    #[must_use]
    pub fn empty(width: u32, height: u32) -> Self {
        Self {
            width,
            height: 0,
            pixels: Vec::with_capacity(width as usize * height as usize),
        }
    }

    /// Puts the rows of a picture of the same width above those that are there.
    ///
    /// # Panics
    /// If the width is another.
    pub fn extend(&mut self, above: &Image) {
        let [width, height] = above.size();
        assert_eq!(width, self.width);
        self.height += height;
        let colours = above.pixels().iter().map(|&[r, g, b, _]| [r, g, b].map(quantise));
        self.pixels.extend(colours);
    }

    /// The colour that all pixels have, in 8 bits; none if they differ.
    #[must_use]
    pub fn only_colour(&self) -> Option<[u8; 3]> {
        let &first = self.pixels.first()?;
        self.pixels.iter().all(|&pixel| pixel == first).then_some(first)
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// All pixels, bottom row first.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// The pixel at (x, y), y upwards from the bottom.
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> [u8; 3] {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The rows, from the bottom up.
    #[must_use]
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[[u8; 3]]> {
        self.pixels.chunks(self.width as usize)
    }
}

impl From<&Image> for Shown {
    fn from(image: &Image) -> Self {
        let [width, height] = image.size();
        let mut shown = Self::empty(width, height);
        shown.extend(image);
        shown
    }
}

impl From<&Shown> for Image {
    fn from(shown: &Shown) -> Self {
        let float = |&[r, g, b]: &[u8; 3]| {
            let [r, g, b] = [r, g, b].map(|component| f32::from(component) / 255.0);
            [r, g, b, 1.0]
        };
        Self::new(
            shown.width,
            shown.height,
            shown.pixels.iter().map(float).collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_stand_on_one_another_and_are_quantised() {
        let band = |red| Image::new(2, 1, vec![[red, 0.5, f32::NAN, 1.0]; 2]);
        let mut shown = Shown::empty(2, 2);
        shown.extend(&band(0.0));
        assert_eq!(shown.only_colour(), Some([0, 128, 0]));
        shown.extend(&band(7.0));
        assert_eq!(shown.size(), [2, 2]);
        assert_eq!(shown.get(1, 0), [0, 128, 0]);
        assert_eq!(shown.get(0, 1), [255, 128, 0]);
        assert_eq!(shown.rows().count(), 2);
        assert_eq!(shown.only_colour(), None);
    }
}
