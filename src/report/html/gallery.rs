//! The pictures of a page: each once, however many shaders paint it.

use std::collections::HashMap;

use sha2::{Digest, Sha256};
use toyproof_image::Shown;

/// How many bytes of PNGs a page may hold. As text they are a third longer, and the rest of a page for 500 shaders is about 2 MB: so
/// the whole stays below 20 MB.
pub const BUDGET: usize = 13_000_000;

/// What is shown of a shader beside its record. Pictures are places in the gallery.
#[derive(Debug, Default)]
pub struct Exhibit {
    /// The shader's text.
    pub source: Option<String>,
    /// What it paints.
    pub actual: Option<usize>,
    /// What its scene looks like.
    pub reference: Option<usize>,
    /// How the questions' pixels stand: maths, rounding, toolchain. None where all agree, or it was not asked.
    pub questions: [Option<usize>; 3],
}

/// All pictures of a page, as PNGs, and what shows them.
#[derive(Debug)]
pub struct Gallery {
    step: u32,
    pictures: Vec<Vec<u8>>,
    places: HashMap<[u8; 32], usize>,
    exhibits: Vec<Exhibit>,
    bytes: usize,
}

impl Gallery {
    /// An empty one, of whose pictures only every `step`th pixel of every `step`th row is there, from the bottom left.
    #[must_use]
    pub fn new(step: u32) -> Self {
        Self {
            step,
            pictures: Vec::new(),
            places: HashMap::new(),
            exhibits: Vec::new(),
            bytes: 0,
        }
    }

    /// Takes a PNG; gives its place.
    pub fn hang(&mut self, png: Vec<u8>) -> usize {
        let place = *self
            .places
            .entry(Sha256::digest(&png).into())
            .or_insert(self.pictures.len());
        if place == self.pictures.len() {
            self.bytes += png.len();
            self.pictures.push(png);
        }
        place
    }

    /// Takes what is shown of the next shader.
    pub fn show(&mut self, exhibit: Exhibit) {
        self.exhibits.push(exhibit);
    }

    /// The bytes of all pictures.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    pub(super) fn step(&self) -> u32 {
        self.step
    }

    pub(super) fn pictures(&self) -> &[Vec<u8>] {
        &self.pictures
    }

    pub(super) fn exhibits(&self) -> &[Exhibit] {
        &self.exhibits
    }
}

/// Every `step`th pixel of every `step`th row of the picture's upper left part of that size, from that part's bottom left: pixels as they are, not
/// means of several.
#[must_use]
pub fn every(step: u32, picture: &Shown, [width, height]: [u32; 2]) -> Shown {
    let [whole_width, whole_height] = picture.size();
    let (width, height) = (width.min(whole_width), height.min(whole_height));
    let below = whole_height - height;
    let steps = |side| (0..side).step_by(step as usize);
    let pixels = steps(height).flat_map(|y| steps(width).map(move |x| picture.get(x, below + y)));
    Shown::new(width.div_ceil(step), height.div_ceil(step), pixels.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_hangs_once() {
        let mut gallery = Gallery::new(1);
        let places = [b"one", b"two", b"one"].map(|png| gallery.hang(png.to_vec()));
        assert_eq!((places, gallery.bytes()), ([0, 1, 0], 6));
    }

    #[test]
    fn thinned_pictures_begin_at_the_bottom_left_of_what_is_no_legend() {
        // Red is x, green is y; the lowest row is a legend.
        let pixels = (0..4).flat_map(|y| (0..5).map(move |x| [x, y, 0]));
        let picture = Shown::new(5, 4, pixels.collect());
        let thin = every(2, &picture, [4, 3]);
        assert_eq!(thin.size(), [2, 2]);
        let places: Vec<_> = thin.pixels().iter().map(|p| (p[0], p[1])).collect();
        assert_eq!(places, [(0, 1), (2, 1), (0, 3), (2, 3)]);
    }
}
