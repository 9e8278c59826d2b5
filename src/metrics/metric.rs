//! The metrics, and what their values mean.

use thiserror::Error;
use toyproof_image::Image;

use crate::map::ErrorMap;
use crate::{flip, squared_error, ssim};

/// A measure of the difference of two images.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// The root of the mean squared difference of red, green and blue; 0 for equal images, at most 1.
    Rmse,
    /// The peak signal-to-noise ratio in decibels, −20·log₁₀ of [`Metric::Rmse`]; infinite for equal images.
    Psnr,
    /// The mean structural similarity (Wang et al., 2004) of red, green and blue; 1 for equal images, at
    /// least −1.
    Ssim,
    /// The mean of FLIP (Andersson et al., 2020); 0 for equal images, at most 1.
    Flip,
    /// The mean of HDR-FLIP (Andersson et al., 2021), with components ≥ 0 in linear light, not clamped; 0 for
    /// equal images, at most 1.
    HdrFlip,
}

/// The value of a metric for two images.
#[derive(Debug, Clone)]
pub struct Measurement {
    /// The metric.
    pub metric: Metric,
    /// The value, in the metric's unit and range.
    pub value: f64,
    /// The error of each pixel; `None` for RMSE and PSNR, whose errors are the differences of components.
    pub map: Option<ErrorMap>,
}

/// Why two images have no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum MetricError {
    /// The sizes of the images.
    #[error("the images have {}×{} and {}×{} pixels; only images of equal size can be compared", .0[0], .0[1], .1[0], .1[1])]
    Sizes([u32; 2], [u32; 2]),
    /// No window of SSIM fits into the image.
    #[error("SSIM needs at least {side}×{side} pixels, and the image has {}×{}", .0[0], .0[1], side = ssim::WINDOW)]
    TooSmall([u32; 2]),
}

impl Metric {
    /// All metrics.
    pub const ALL: [Self; 5] = [Self::Rmse, Self::Psnr, Self::Ssim, Self::Flip, Self::HdrFlip];

    /// The name in lower case, as a command or a report has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rmse => "rmse",
            Self::Psnr => "psnr",
            Self::Ssim => "ssim",
            Self::Flip => "flip",
            Self::HdrFlip => "hdr-flip",
        }
    }

    /// The name in a sentence.
    pub fn title(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE",
            Self::Psnr => "PSNR",
            Self::Ssim => "SSIM",
            Self::Flip => "FLIP",
            Self::HdrFlip => "HDR-FLIP",
        }
    }

    /// Whether larger values mean more similar images.
    pub fn is_similarity(self) -> bool {
        matches!(self, Self::Psnr | Self::Ssim)
    }

    /// Whether a value is within a limit: not above that of an error, and not below that of a similarity.
    pub fn accepts(self, value: f64, limit: f64) -> bool {
        if self.is_similarity() {
            value >= limit
        } else {
            value <= limit
        }
    }

    /// The values that a limit may have: from the strictest for errors and the loosest for similarities on.
    pub fn limits(self) -> std::ops::RangeInclusive<f64> {
        match self {
            Self::Rmse | Self::Flip | Self::HdrFlip => 0.0..=1.0,
            // One level of one component of one pixel of the largest image is 123 dB.
            Self::Psnr => 0.0..=200.0,
            Self::Ssim => -1.0..=1.0,
        }
    }
}

/// Measures how much `actual` differs from `reference`.
///
/// # Errors
/// If the sizes differ, or the images are too small for the metric.
pub fn measure(metric: Metric, reference: &Image, actual: &Image) -> Result<Measurement, MetricError> {
    let [size, other] = [reference.size(), actual.size()];
    if size != other {
        return Err(MetricError::Sizes(size, other));
    }
    let (value, map) = match metric {
        Metric::Rmse => (squared_error::mean(reference, actual).sqrt(), None),
        Metric::Psnr => (-10.0 * squared_error::mean(reference, actual).log10(), None),
        Metric::Ssim => {
            if size.iter().any(|&side| side < ssim::WINDOW) {
                return Err(MetricError::TooSmall(size));
            }
            let (similarity, map) = ssim::compare(reference, actual);
            (similarity, Some(map))
        }
        Metric::Flip => with_mean(flip::displayed(reference, actual)),
        Metric::HdrFlip => with_mean(flip::high_dynamic_range(reference, actual)),
    };
    Ok(Measurement { metric, value, map })
}

fn with_mean(map: ErrorMap) -> (f64, Option<ErrorMap>) {
    (map.mean(), Some(map))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_images::{distorted, textured};

    #[test]
    fn equal_images_have_the_best_value_and_others_a_worse_one() {
        let (image, other) = (textured(40, 30), distorted(40, 30));
        for (metric, best) in [
            (Metric::Rmse, 0.0),
            (Metric::Psnr, f64::INFINITY),
            (Metric::Ssim, 1.0),
            (Metric::Flip, 0.0),
            (Metric::HdrFlip, 0.0),
        ] {
            let value = |other: &Image| measure(metric, &image, other).unwrap().value;
            assert_eq!(value(&image), best, "{metric:?}");
            assert!(
                metric.accepts(best, best) && !metric.accepts(value(&other), best),
                "{metric:?}"
            );
        }
    }

    #[test]
    fn images_that_cannot_be_compared_have_a_reason() {
        let error = measure(Metric::Flip, &textured(3, 4), &textured(4, 3)).unwrap_err();
        assert!(error.to_string().contains("3×4 and 4×3"), "{error}");
        let error = measure(Metric::Ssim, &textured(64, 10), &textured(64, 10)).unwrap_err();
        assert!(error.to_string().contains("at least 11×11"), "{error}");
        // The other metrics take any size.
        assert_eq!(
            measure(Metric::Flip, &textured(1, 1), &textured(1, 1))
                .unwrap()
                .value,
            0.0
        );
    }
}
