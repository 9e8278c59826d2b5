//! Pairs of images in a report of `compare`.

use std::fmt;

use serde::Serialize;
use toyproof_diagnostic::{grouped, magnitude, plural};
use toyproof_metrics::Metric;
use toyproof_verify::compare::{Agreement, Comparison, Criteria, MaxDiffering, PairDifference};

use crate::place;

/// The result of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ImageStatus {
    /// All colors are equal as displayed.
    Equal,
    /// The differences are within the limits.
    Agrees,
    /// The differences are not within the limits.
    Differs,
    /// Only the first folder has the image.
    OnlyInA,
    /// Only the second folder has the image.
    OnlyInB,
    /// The images cannot be compared.
    Error,
}

impl ImageStatus {
    pub(super) fn agrees(self) -> bool {
        matches!(self, Self::Equal | Self::Agrees)
    }
}

/// A pair of images.
#[derive(Debug, Clone, Serialize)]
pub struct ComparedImages {
    /// The path relative to both folders; null for a single pair and for frames of shaders.
    path: Option<String>,
    /// The frame of two shaders; null for files.
    frame: Option<i32>,
    status: ImageStatus,
    /// Why the images cannot be compared; null otherwise.
    message: Option<String>,
    /// The width and the height of the compared part.
    size: Option<[u32; 2]>,
    comparison: Option<Comparison>,
    /// The value of the metric; null if none is measured, and if it is infinite.
    value: Option<f64>,
    #[serde(skip)]
    limits: Limits,
}

/// What the lines for people need.
#[derive(Debug, Clone, Default)]
struct Limits {
    agreement: Option<Agreement>,
    max_differing: Option<MaxDiffering>,
    metric: Option<(Metric, Option<f64>)>,
}

impl ComparedImages {
    /// Two images that were compared.
    #[must_use]
    pub fn new(difference: &PairDifference, criteria: &Criteria) -> Self {
        let comparison = difference.comparison.clone();
        let status = match difference.agrees {
            true if comparison.max_abs == 0.0 => ImageStatus::Equal,
            true => ImageStatus::Agrees,
            false => ImageStatus::Differs,
        };
        Self {
            size: Some(difference.size),
            comparison: Some(comparison),
            value: difference.value,
            limits: Limits {
                agreement: Some(difference.agreement),
                max_differing: criteria.max_differing,
                metric: criteria.metric.map(|metric| (metric, criteria.limit)),
            },
            ..Self::with_status(status)
        }
    }

    /// Images that cannot be compared.
    #[must_use]
    pub fn failed(message: impl fmt::Display) -> Self {
        Self {
            message: Some(message.to_string()),
            ..Self::with_status(ImageStatus::Error)
        }
    }

    /// An image that only one folder has.
    #[must_use]
    pub fn alone(is_in_first: bool) -> Self {
        Self::with_status(if is_in_first {
            ImageStatus::OnlyInA
        } else {
            ImageStatus::OnlyInB
        })
    }

    fn with_status(status: ImageStatus) -> Self {
        Self {
            path: None,
            frame: None,
            status,
            message: None,
            size: None,
            comparison: None,
            value: None,
            limits: Limits::default(),
        }
    }

    /// The pair as that of files of two folders, with their path in both.
    #[must_use]
    pub fn at_path(self, path: String) -> Self {
        Self {
            path: Some(path),
            ..self
        }
    }

    /// The pair as that of a frame of two shaders.
    #[must_use]
    pub fn in_frame(self, frame: i32) -> Self {
        Self {
            frame: Some(frame),
            ..self
        }
    }

    /// The result.
    #[must_use]
    pub fn status(&self) -> ImageStatus {
        self.status
    }

    /// Whether these are the images that the user named, not those of folders or frames.
    pub(super) fn is_whole_input(&self) -> bool {
        self.path.is_none() && self.frame.is_none()
    }

    /// Several lines: the counts, the metric, and two pixels.
    pub(super) fn details(&self) -> Vec<String> {
        let pixels = self.comparison.iter().flat_map(|comparison| {
            let named = [("first", comparison.first), ("worst", comparison.worst)];
            named.map(|(name, pixel)| Some(format!("{name} {}", place(&pixel?))))
        });
        let lines = [self.counts(), self.metric()].into_iter().chain(pixels);
        lines.flatten().collect()
    }

    /// One line: the path or the frame, the counts and the metric.
    fn line(&self) -> String {
        let name = match (&self.path, self.frame) {
            (Some(path), _) => path.clone(),
            (None, Some(frame)) => format!("frame {frame}"),
            (None, None) => String::new(),
        };
        let text = match self.status {
            ImageStatus::OnlyInA => "only in the first folder".to_owned(),
            ImageStatus::OnlyInB => "only in the second folder".to_owned(),
            _ => {
                let parts = [self.message.clone(), self.metric(), self.counts()];
                parts.into_iter().flatten().collect::<Vec<_>>().join("; ")
            }
        };
        format!("{name}: {text}")
    }

    fn counts(&self) -> Option<String> {
        let (comparison, agreement) = (self.comparison.as_ref()?, self.limits.agreement?);
        let (pixels, tolerance) = (grouped(comparison.pixels), tolerance(&agreement));
        Some(match comparison.differing {
            0 if comparison.max_abs == 0.0 => format!("all {pixels} pixels are equal"),
            0 if agreement.is_in_levels() => format!("all {pixels} pixels agree to within {tolerance}"),
            0 => format!(
                "all {pixels} pixels agree to within {}",
                magnitude(comparison.max_abs)
            ),
            differing => {
                let limit = self.limits.max_differing.map(|most| {
                    if self.status.agrees() {
                        format!(", within the limit of {most}")
                    } else {
                        format!("; the limit is {most}")
                    }
                });
                format!(
                    "{} of {pixels} pixels {} by more than {tolerance}{}; the largest difference is {:.4} ({} of 255)",
                    grouped(differing),
                    plural(differing, "differs", "differ"),
                    limit.unwrap_or_default(),
                    comparison.max_abs,
                    comparison.max_8bit
                )
            }
        })
    }

    /// The metric with its limit: `FLIP is 0.0312, within the limit of 0.05`.
    fn metric(&self) -> Option<String> {
        let ((metric, limit), value) = (self.limits.metric?, self.value?);
        let unit = if metric == Metric::Psnr { " dB" } else { "" };
        let shown = match metric {
            Metric::Psnr if value.is_infinite() => "infinite".to_owned(),
            Metric::Psnr => format!("{value:.2}{unit}"),
            _ => format!("{value:.6}"),
        };
        let limit = limit.map(|limit| {
            let relation = match (metric.accepts(value, limit), metric.is_similarity()) {
                (true, _) => "within",
                (false, true) => "below",
                (false, false) => "above",
            };
            format!(", {relation} the limit of {limit}{unit}")
        });
        Some(format!(
            "{} is {shown}{}",
            metric.title(),
            limit.unwrap_or_default()
        ))
    }
}

/// A tolerance: `one level of 255`, `2.5 levels of 255`, or `0.001` between floats.
fn tolerance(agreement: &Agreement) -> String {
    let short = |number: f64| {
        let text = format!("{number:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    if !agreement.is_in_levels() {
        return short(agreement.tolerance);
    }
    match short(agreement.tolerance * 255.0).as_str() {
        "1" => "one level of 255".to_owned(),
        levels => format!("{levels} levels of 255"),
    }
}

/// A line for each pair that does not agree, or for all, and the numbers of pairs.
pub(super) fn lines_of_several(images: &[ComparedImages], all: bool) -> Vec<String> {
    let shown = images.iter().filter(|images| all || !images.status.agrees());
    let mut lines: Vec<String> = shown.map(ComparedImages::line).collect();
    let counts = [
        (&[ImageStatus::Equal][..], ["is equal", "are equal"]),
        (&[ImageStatus::Agrees], ["agrees", "agree"]),
        (&[ImageStatus::Differs], ["differs", "differ"]),
        (
            &[ImageStatus::OnlyInA, ImageStatus::OnlyInB],
            ["has no counterpart", "have no counterpart"],
        ),
        (
            &[ImageStatus::Error],
            ["cannot be compared", "cannot be compared"],
        ),
    ];
    let counts = counts.into_iter().filter_map(|(statuses, [one, many])| {
        let matching = images.iter().filter(|images| statuses.contains(&images.status));
        let count = matching.count() as u64;
        (count > 0).then(|| format!("{} {}", grouped(count), plural(count, one, many)))
    });
    let count = images.len() as u64;
    lines.push(format!(
        "{} {}: {}",
        grouped(count),
        plural(count, "image", "images"),
        counts.collect::<Vec<_>>().join(", ")
    ));
    lines
}
