//! The results of `compare`: of images, of folders of images, and of two shaders; as JSON and as lines.

mod images;
mod shaders;
#[cfg(test)]
mod tests;

use std::io::{self, Write};

use serde::Serialize;
use toyproof_verify::compare::{Criteria, MaxDiffering, Rectangle};

pub use self::images::{ComparedImages, ImageStatus};
pub use self::shaders::{ComparedShaders, FirstDifferenceRecord, ShaderPlace};

/// The JSON Schema of a [`ComparisonReport`].
pub const COMPARISON_SCHEMA: &str = include_str!("comparison.schema.json");

/// What one run of `compare` found.
#[derive(Debug, Serialize)]
pub struct ComparisonReport {
    version: u32,
    tool: String,
    /// The first input, as the user named it.
    a: String,
    /// The second input.
    b: String,
    agree: bool,
    criteria: CriteriaRecord,
    images: Vec<ComparedImages>,
    /// Two shaders that were compared to the bit.
    shaders: Option<ComparedShaders>,
}

/// By what images were compared.
#[derive(Debug, Serialize)]
struct CriteriaRecord {
    /// In 8-bit levels; null for the default of each pair.
    tolerance: Option<f64>,
    max_differing: Option<MostRecord>,
    metric: Option<&'static str>,
    limit: Option<f64>,
    /// Left, bottom, width and height.
    region: Option<[u32; 4]>,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
enum MostRecord {
    Pixels(u64),
    Percent(f64),
}

impl CriteriaRecord {
    fn new(criteria: &Criteria) -> Self {
        let most = criteria.max_differing.map(|most| match most {
            MaxDiffering::Pixels(count) => MostRecord::Pixels(count),
            MaxDiffering::Percent(share) => MostRecord::Percent(share),
        });
        let corners = |Rectangle { x, y, width, height }: Rectangle| [x, y, width, height];
        Self {
            tolerance: criteria.tolerance.map(|tolerance| tolerance * 255.0),
            max_differing: most,
            metric: criteria.metric.map(toyproof_metrics::Metric::name),
            limit: criteria.limit,
            region: criteria.region.map(corners),
        }
    }
}

impl ComparisonReport {
    /// The version of the format.
    const VERSION: u32 = 1;

    /// The report on images: one pair, those of two folders, or the frames of two shaders.
    #[must_use]
    pub fn of_images([a, b]: [String; 2], criteria: &Criteria, images: Vec<ComparedImages>) -> Self {
        Self {
            agree: images.iter().all(|images| images.status().agrees()),
            images,
            ..Self::new([a, b], criteria)
        }
    }

    /// The report on two shaders that were compared to the bit.
    #[must_use]
    pub fn of_shaders([a, b]: [String; 2], shaders: ComparedShaders) -> Self {
        Self {
            agree: shaders.are_equal(),
            shaders: Some(shaders),
            ..Self::new([a, b], &Criteria::default())
        }
    }

    fn new([a, b]: [String; 2], criteria: &Criteria) -> Self {
        Self {
            version: Self::VERSION,
            tool: format!("toyproof {}", env!("CARGO_PKG_VERSION")),
            a,
            b,
            agree: true,
            criteria: CriteriaRecord::new(criteria),
            images: Vec::new(),
            shaders: None,
        }
    }

    /// Whether everything agrees.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.agree
    }

    /// Whether an image could not be compared.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.images
            .iter()
            .any(|images| images.status() == ImageStatus::Error)
    }

    /// Writes the report as JSON. Floats that are not finite are null.
    ///
    /// # Errors
    /// The report cannot be written.
    pub fn json(&self, out: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *out, self)?;
        out.write_all(b"\n")
    }

    /// The lines for people. Of several images, those that agree have a line only if `all` is set.
    #[must_use]
    pub fn lines(&self, all: bool) -> Vec<String> {
        if let Some(shaders) = &self.shaders {
            return shaders.lines([&self.a, &self.b]);
        }
        match &self.images[..] {
            [only] if only.is_whole_input() => only.details(),
            images => images::lines_of_several(images, all),
        }
    }
}
