//! The bands of a reference's image, each rendered once.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use toyproof_image::{Frame, Image};

/// The largest number of pixels of an image that is cached; one of 1920×1080 takes 32 MB.
const MAX_CACHED_PIXELS: u32 = 1 << 21;

/// Some rows of a reference.
#[derive(Debug, PartialEq)]
pub struct ReferenceBand {
    /// The image in f64, rounded once at the end.
    pub image: Image,
    /// The pixels without a defined color; empty if all have one.
    pub undefined: Vec<bool>,
}

/// The bands by their first rows; empty for an image that is too large.
#[derive(Debug, Default)]
pub(super) struct Bands(HashMap<u32, OnceLock<Arc<ReferenceBand>>>);

/// Whether an image of this size is cached.
pub(super) fn is_cached([width, height]: [u32; 2]) -> bool {
    width.saturating_mul(height) <= MAX_CACHED_PIXELS
}

impl Bands {
    pub(super) fn new(frame: &Frame) -> Self {
        let bands = frame.bands().filter(|_| is_cached(frame.size));
        Self(bands.map(|rows| (rows.start, OnceLock::new())).collect())
    }

    /// The memory of the bands so far, in bytes.
    pub(super) fn bytes(&self) -> usize {
        let bands = self.0.values().filter_map(OnceLock::get);
        bands
            .map(|band| size_of_val(band.image.pixels()) + band.undefined.len())
            .sum()
    }

    /// Returns a band that is already there.
    pub(super) fn get(&self, rows: &Range<u32>) -> Option<Arc<ReferenceBand>> {
        self.0.get(&rows.start)?.get().cloned()
    }

    /// Returns a band, rendering it if needed. Callers block while another thread renders it.
    pub(super) fn get_or_render(
        &self,
        rows: &Range<u32>,
        render: impl FnOnce() -> ReferenceBand,
    ) -> Arc<ReferenceBand> {
        match self.0.get(&rows.start) {
            Some(band) => Arc::clone(band.get_or_init(|| Arc::new(render()))),
            None => Arc::new(render()),
        }
    }
}
