//! Two images, compared by what a user asks for: a tolerance, a number of pixels, a metric.

use toyproof_diagnostic::grouped;
use toyproof_image::{Image, Rgb8Image};
use toyproof_metrics::{ErrorMap, Metric, MetricError, measure};

use super::images::compare_within;
use super::{Agreement, Comparison, DiffLevel, Pixel, Quantization, SEEN_BY_EYE, difference};

/// By what two images are compared.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Criteria {
    /// The largest difference of a component of colors that agree, in [0, 1]; `None` for the default of
    /// [`Agreement::of_images`].
    pub tolerance: Option<f64>,
    /// The largest number of differing pixels; `None` if a limit of the metric takes its place, else for no
    /// pixel.
    pub max_differing: Option<MaxDiffering>,
    /// The metric that is measured.
    pub metric: Option<Metric>,
    /// The limit of the metric.
    pub limit: Option<f64>,
    /// The part of the images that is compared.
    pub region: Option<Rectangle>,
}

/// The largest number of differing pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MaxDiffering {
    /// A number of pixels.
    Pixels(u64),
    /// A share of the pixels, in percent.
    Percent(f64),
}

impl MaxDiffering {
    fn accepts(self, differing: u64, pixels: u64) -> bool {
        match self {
            Self::Pixels(most) => differing <= most,
            Self::Percent(most) => 100.0 * differing as f64 <= most * pixels as f64,
        }
    }
}

/// A rectangle of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rectangle {
    /// The left column, from 0.
    pub x: u32,
    /// The bottom row, from 0.
    pub y: u32,
    /// The number of columns.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
}

/// Why two images cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PairError {
    /// The sizes differ, or the images are too small for the metric.
    #[error(transparent)]
    Metric(#[from] MetricError),
    /// The region is not a part of the images.
    #[error(
        "the region of {}×{} pixels at ({}, {}) is not within the image of {}×{}",
        .region.width, .region.height, .region.x, .region.y, .size[0], .size[1]
    )]
    Region {
        /// The region.
        region: Rectangle,
        /// The size of the images.
        size: [u32; 2],
    },
}

/// How two images differ.
#[derive(Debug)]
pub struct PairDifference {
    /// The width and height of the compared part.
    pub size: [u32; 2],
    /// When colors agree.
    pub agreement: Agreement,
    /// The comparison pixel by pixel.
    pub comparison: Comparison,
    /// The value of the metric, if one is measured.
    pub value: Option<f64>,
    /// Whether the images are within the limits.
    pub agrees: bool,
    levels: Vec<DiffLevel>,
    map: Option<ErrorMap>,
}

/// Compares two images.
///
/// # Errors
/// If their sizes differ, or a part of them is asked for that does not exist or is too small.
pub fn compare_pair(
    [reference, actual]: [&Image; 2],
    quantization: [Quantization; 2],
    criteria: &Criteria,
) -> Result<PairDifference, PairError> {
    let [size, other] = [reference.size(), actual.size()];
    if size != other {
        return Err(MetricError::Sizes(size, other).into());
    }
    let parts;
    let [reference, actual] = match criteria.region {
        None => [reference, actual],
        Some(region) => {
            let part = |image: &Image| image.part([region.x, region.y], [region.width, region.height]);
            let outside = PairError::Region { region, size };
            parts = [part(reference).ok_or(outside)?, part(actual).ok_or(outside)?];
            parts.each_ref()
        }
    };
    let default = Agreement::of_images(quantization);
    let agreement = Agreement {
        tolerance: criteria.tolerance.unwrap_or(default.tolerance),
        ..default
    };
    let (mut comparison, levels) = compare_within(reference, actual, &agreement);
    let measured = criteria.metric.map(|metric| measure(metric, reference, actual));
    let measured = measured.transpose()?;
    let value = measured.as_ref().map(|measured| measured.value);
    let by_metric = measured.as_ref().zip(criteria.limit);
    let by_metric = by_metric.map(|(measured, limit)| measured.metric.accepts(measured.value, limit));
    let most = match (criteria.max_differing, by_metric) {
        (None, Some(_)) => None,
        (most, _) => Some(most.unwrap_or(MaxDiffering::Pixels(0))),
    };
    let by_pixels = most.is_none_or(|most| most.accepts(comparison.differing, comparison.pixels));
    if let Some(Rectangle { x, y, .. }) = criteria.region {
        let moved = |pixel: Option<Pixel>| {
            pixel.map(|pixel| Pixel {
                x: pixel.x + x,
                y: pixel.y + y,
                ..pixel
            })
        };
        comparison.first = moved(comparison.first);
        comparison.worst = moved(comparison.worst);
    }
    Ok(PairDifference {
        size: reference.size(),
        agreement,
        comparison,
        value,
        agrees: by_pixels && by_metric.unwrap_or(true),
        levels,
        map: measured.and_then(|measured| measured.map),
    })
}

impl PairDifference {
    /// The image of the differences: the map of the metric in the colors of magma if it has one, else a color
    /// for each decade.
    #[must_use]
    pub fn image(&self) -> Rgb8Image {
        match &self.map {
            Some(map) => map.magma(),
            None => difference(self.size, &self.levels, SEEN_BY_EYE),
        }
    }
}

impl std::fmt::Display for MaxDiffering {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Pixels(count) => f.write_str(&grouped(*count)),
            Self::Percent(share) => write!(f, "{share} %"),
        }
    }
}
