//! The features of an assignment: the pixels in which its reference differs from one without the feature.

use toyproof_classroom::assignment::Reference;
use toyproof_diagnostic::path_name;
use toyproof_image::{FrameInputs, Image};
use toyproof_report::FeatureRecord;
use toyproof_verify::CheckResult;
use toyproof_verify::compare::{Pixel, PixelStatus};

use super::options::CheckOptions;
use super::plan::Plan;
use super::reference::{References, expected_in, expected_of_scene};
use crate::cli::reference::ReferenceArgs;
use crate::cli::scenes::{parse_scene, read_scene};
use crate::cli::{CliError, Terminal};

/// The smallest difference of a color that a feature makes: one 8-bit level.
const VISIBLE: f64 = 1.0 / 255.0;

/// The features of an assignment.
#[derive(Default)]
pub(super) struct Features(Vec<FeaturePixels>);

struct FeaturePixels {
    name: String,
    points: f64,
    /// For each frame, whether the feature changes a pixel, bottom row first.
    masks: Vec<Vec<bool>>,
}

impl Features {
    /// Renders the references without the features in all frames.
    ///
    /// # Errors
    /// A reference cannot be rendered, or a feature changes no pixel.
    pub(super) fn new(
        plan: &Plan,
        references: &References,
        options: &CheckOptions,
        terminal: &Terminal,
    ) -> Result<Self, CliError> {
        let Some((assignment, _)) = plan
            .assignment
            .as_ref()
            .filter(|(one, _)| !one.features.is_empty())
        else {
            return Ok(Self::default());
        };
        let render = |reference: &Reference| images(reference, plan, options, terminal);
        let with = match references {
            References::Given(prepared) => prepared.images(plan)?,
            References::Scenes(_) => render(&assignment.reference)?,
        };
        let mut features = Vec::new();
        for feature in &assignment.features {
            let without = render(&feature.without)?;
            let name = path_name(feature.without.path());
            let masks: Option<Vec<Vec<bool>>> = with.iter().zip(&without).map(|(a, b)| mask(a, b)).collect();
            let masks = masks.ok_or_else(|| format!("{name} has another size than the reference"))?;
            if !masks.iter().flatten().any(|&changes| changes) {
                let error = format!(
                    "the feature {} changes no pixel: {name} is the same image",
                    feature.name
                );
                return Err(CliError::new(error).with_help("name the reference without this feature"));
            }
            features.push(FeaturePixels {
                name: feature.name.clone(),
                points: feature.points,
                masks,
            });
        }
        Ok(Self(features))
    }

    /// The count of a shader.
    pub(super) fn count(&self) -> Count<'_> {
        Count {
            features: self,
            right: vec![0; self.0.len()],
        }
    }
}

/// The pixels of the features in which a shader is right.
pub(super) struct Count<'a> {
    features: &'a Features,
    /// One number for each feature.
    right: Vec<u64>,
}

impl Count<'_> {
    /// Adds the frame with this index.
    pub(super) fn add(&mut self, index: usize, algorithm: Option<&CheckResult>) {
        let is_right =
            |status: &PixelStatus| !matches!(status, PixelStatus::Differs | PixelStatus::Undefined);
        let statuses = algorithm.map_or(&[][..], |check| &check.statuses);
        for (right, feature) in self.right.iter_mut().zip(&self.features.0) {
            let pixels = feature.masks[index].iter().zip(statuses);
            *right += pixels
                .filter(|(changes, status)| **changes && is_right(status))
                .count() as u64;
        }
    }

    /// The records. A frame that was not added has no right pixel.
    pub(super) fn records(self) -> Vec<FeatureRecord> {
        let features = self.features.0.iter().zip(self.right);
        let records = features.map(|(feature, right)| FeatureRecord {
            name: feature.name.clone(),
            points: feature.points,
            pixels: feature.masks.iter().flatten().filter(|&&changes| changes).count() as u64,
            right,
        });
        records.collect()
    }
}

/// The images of a reference in all frames of a plan.
fn images(
    reference: &Reference,
    plan: &Plan,
    options: &CheckOptions,
    terminal: &Terminal,
) -> Result<Vec<Image>, CliError> {
    let mut frames = plan.frames.clone();
    let expected = match reference {
        Reference::Scene(path) => {
            let scene = parse_scene(read_scene(path)?)?;
            expected_of_scene(&scene, &mut frames)
        }
        Reference::Given { path, .. } => {
            let args = ReferenceArgs::given(path.clone());
            let language = |frame: &FrameInputs| plan.language(&options.language, frame);
            let timeout = options.driver.timeout();
            let rendered = expected_in(&args, &mut frames, language, timeout, terminal)?;
            rendered.expect("a path is given").1
        }
    };
    let images = expected
        .iter()
        .zip(&frames)
        .map(|(expected, planned)| expected.image(&planned.frame));
    Ok(images.collect::<Result<_, _>>()?)
}

/// Whether two images differ visibly, for each pixel; `None` if they differ in size.
fn mask(with: &Image, without: &Image) -> Option<Vec<bool>> {
    let pixels = with.pixels().len();
    let changes = |index| Pixel::at(index, with, without).difference() > VISIBLE;
    (with.size() == without.size()).then(|| (0..pixels).map(changes).collect())
}
