//! The images of a page, without duplicates.

use std::collections::HashMap;

use sha2::{Digest, Sha256};
use toyproof_image::Rgb8Image;

/// The maximum size of all PNGs of a page, in bytes. Base64 adds a third, and the rest of a page for 500
/// shaders, half of it sources, is less than 4 MB, so that the page stays below 20 MB.
pub const MAX_IMAGE_BYTES: usize = 12_000_000;

/// The images and the source that are shown together with the record of a shader. Images are indices into the
/// gallery.
#[derive(Debug, Default)]
pub struct Exhibit {
    /// The shader's source text.
    pub source: Option<String>,
    /// The rendered image.
    pub actual: Option<usize>,
    /// The reference image.
    pub reference: Option<usize>,
    /// The image after the fix of a wrong shader.
    pub fixed: Option<usize>,
    /// The difference images of the checks: algorithm, precision, toolchain. `None` if all pixels agree or
    /// the check did not run.
    pub checks: [Option<usize>; 3],
    /// The first value in which a wrong shader departs from its reference, and the one that it lacks.
    pub values: [Option<usize>; 2],
}

/// All images of a page, as PNGs, and the exhibits that refer to them.
#[derive(Debug)]
pub struct Gallery {
    step: u32,
    images: Vec<Vec<u8>>,
    places: HashMap<[u8; 32], usize>,
    exhibits: Vec<Exhibit>,
    bytes: usize,
}

impl Gallery {
    /// Creates an empty gallery, whose images hold only every `step`th pixel of every `step`th row, from the
    /// bottom left.
    #[must_use]
    pub fn new(step: u32) -> Self {
        Self {
            step,
            images: Vec::new(),
            places: HashMap::new(),
            exhibits: Vec::new(),
            bytes: 0,
        }
    }

    /// Adds a PNG; returns its index, which duplicates share.
    pub fn add_image(&mut self, png: Vec<u8>) -> usize {
        let place = *self
            .places
            .entry(Sha256::digest(&png).into())
            .or_insert(self.images.len());
        if place == self.images.len() {
            self.bytes += png.len();
            self.images.push(png);
        }
        place
    }

    /// Adds the exhibit of the next shader.
    pub fn add_exhibit(&mut self, exhibit: Exhibit) {
        self.exhibits.push(exhibit);
    }

    /// The size of all PNGs in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    pub(super) fn step(&self) -> u32 {
        self.step
    }

    pub(super) fn images(&self) -> &[Vec<u8>] {
        &self.images
    }

    pub(super) fn exhibits(&self) -> &[Exhibit] {
        &self.exhibits
    }
}

/// Subsamples an image: every `step`th pixel of every `step`th row of its upper left part of the given size,
/// from that part's bottom left. Pixels are copied, not averaged.
#[must_use]
pub fn subsample(step: u32, image: &Rgb8Image, [width, height]: [u32; 2]) -> Rgb8Image {
    let [whole_width, whole_height] = image.size();
    let (width, height) = (width.min(whole_width), height.min(whole_height));
    let below = whole_height - height;
    let steps = |side| (0..side).step_by(step as usize);
    let pixels = steps(height).flat_map(|y| steps(width).map(move |x| image.get(x, below + y)));
    Rgb8Image::new(width.div_ceil(step), height.div_ceil(step), pixels.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_deduplicated() {
        let mut gallery = Gallery::new(1);
        let places = [b"one", b"two", b"one"].map(|png| gallery.add_image(png.to_vec()));
        assert_eq!((places, gallery.bytes()), ([0, 1, 0], 6));
    }

    #[test]
    fn subsampling_starts_at_the_bottom_left_above_the_legend() {
        // Red is x, green is y; the bottom row is a legend.
        let pixels = (0..4).flat_map(|y| (0..5).map(move |x| [x, y, 0]));
        let image = Rgb8Image::new(5, 4, pixels.collect());
        let thin = subsample(2, &image, [4, 3]);
        assert_eq!(thin.size(), [2, 2]);
        let places: Vec<_> = thin.pixels().iter().map(|p| (p[0], p[1])).collect();
        assert_eq!(places, [(0, 1), (2, 1), (0, 3), (2, 3)]);
    }
}
