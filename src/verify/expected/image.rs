//! An image as reference: nothing but its colors is known.

use std::ops::Range;
use std::sync::Arc;

use toyproof_image::Image;

use super::bands::ReferenceBand;
use crate::compare::{Agreement, Quantization};

/// An image that shaders are compared with.
#[derive(Debug)]
pub struct ImageReference {
    image: Image,
    tolerance: f64,
}

impl ImageReference {
    /// Creates the reference. Colors agree if no component differs by more than `tolerance`, in [0, 1],
    /// besides the rounding of the image.
    #[must_use]
    pub fn new(image: Image, quantization: Quantization, tolerance: f64) -> Self {
        let agreement = Agreement {
            tolerance,
            quantization: [quantization, Quantization::Float],
        };
        Self {
            image,
            tolerance: agreement.limit(),
        }
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.image.pixels())
    }

    pub(super) fn rows(&self, rows: &Range<u32>) -> Arc<ReferenceBand> {
        let width = self.image.size()[0];
        let pixels = &self.image.pixels()[(rows.start * width) as usize..(rows.end * width) as usize];
        Arc::new(ReferenceBand {
            image: Image::new(width, rows.len() as u32, pixels.to_vec()),
            undefined: Vec::new(),
        })
    }

    pub(super) fn pixel(&self, x: u32, y: u32) -> [f64; 3] {
        let [r, g, b, _] = self.image.get(x, y);
        [r, g, b].map(f64::from)
    }
}
