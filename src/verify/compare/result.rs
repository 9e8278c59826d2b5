//! The result of a check, accumulated band by band.

use std::collections::HashMap;

use toyproof_image::Image;

use super::{CheckSummary, DiffLevel, PixelStatus, Regions, diff_levels};

/// The largest number of pixels that do not agree whose colors are kept.
const MAX_KEPT_COLORS: usize = 1 << 16;

/// The result of a check, and its difference image.
#[derive(Debug, Default)]
pub struct CheckResult {
    /// The counts.
    pub summary: CheckSummary,
    /// The difference level of each pixel, bottom row first.
    pub diff_levels: Vec<DiffLevel>,
    /// The status of each pixel.
    pub statuses: Vec<PixelStatus>,
    /// The shader's colors in pixels that do not agree, by pixel index.
    pub actual: HashMap<usize, [f32; 3]>,
}

impl CheckResult {
    /// Returns at most `max_count` of the differing pixels, spread over the image; of the ill-conditioned
    /// ones if none differs, and else of those in which the reference is ill-conditioned.
    #[must_use]
    pub fn sample_pixels(&self, size: [u32; 2], max_count: usize) -> Vec<[u32; 2]> {
        let statuses = [
            PixelStatus::Differs,
            PixelStatus::IllConditioned,
            PixelStatus::Tied,
        ];
        let status = statuses.into_iter().find(|status| self.statuses.contains(status));
        status.map_or_else(Vec::new, |status| self.sample(status, size, max_count))
    }

    /// Returns at most `max_count` of the pixels that agree, spread over the image.
    #[must_use]
    pub fn sample_agreeing(&self, size: [u32; 2], max_count: usize) -> Vec<[u32; 2]> {
        self.sample(PixelStatus::Agrees, size, max_count)
    }

    fn sample(&self, status: PixelStatus, size: [u32; 2], max_count: usize) -> Vec<[u32; 2]> {
        let width = size[0] as usize;
        let all = || {
            let statuses = self.statuses.iter().enumerate();
            statuses.filter(move |&(_, &own)| own == status).map(|(at, _)| at)
        };
        let mut left = all().enumerate();
        spread(all().count(), max_count)
            .filter_map(|chosen| left.find(|&(number, _)| number == chosen))
            .map(|(_, at)| [(at % width) as u32, (at / width) as u32])
            .collect()
    }

    /// The result of no band, with the memory for an image of that many pixels: growing step by step would
    /// leave unused parts behind.
    #[must_use]
    pub fn with_capacity(count: usize) -> Self {
        Self {
            diff_levels: Vec::with_capacity(count),
            statuses: Vec::with_capacity(count),
            ..Self::default()
        }
    }

    /// Adds the band above the first `height` rows.
    pub fn extend(&mut self, expected: &Image, actual: &Image, statuses: &[PixelStatus], height: u32) {
        self.summary
            .extend(&CheckSummary::new(expected, actual, statuses), height);
        self.diff_levels.extend(diff_levels(expected, actual, statuses));
        let offset = self.statuses.len();
        let differing = statuses.iter().enumerate();
        let differing = differing
            .filter(|&(_, &status)| matches!(status, PixelStatus::Differs | PixelStatus::IllConditioned));
        let capacity = MAX_KEPT_COLORS.saturating_sub(self.actual.len());
        self.actual.extend(differing.take(capacity).map(|(at, _)| {
            let [r, g, b, _] = actual.pixels()[at];
            (offset + at, [r, g, b])
        }));
        self.statuses.extend(statuses);
    }

    /// The result with the regions of its differing pixels, once all bands of an image that many pixels wide
    /// were added.
    #[must_use]
    pub fn with_regions(mut self, width: u32) -> Self {
        let regions = |status| Regions::new(status, &self.statuses, width);
        self.summary.regions = regions(PixelStatus::Differs);
        self.summary.undefined_region = regions(PixelStatus::Undefined).largest_compact;
        self
    }
}

/// At most `max_count` numbers below `all`, evenly spaced.
pub(crate) fn spread(all: usize, max_count: usize) -> impl Iterator<Item = usize> {
    let count = all.min(max_count);
    (0..count).map(move |at| (2 * at + 1) * all / (2 * count))
}
