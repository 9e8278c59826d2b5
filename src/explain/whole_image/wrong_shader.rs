//! A wrong shader, and the rules by which a hypothesis about its image is confirmed.

use toyproof_eval::{Places, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image};
use toyproof_verify::BandReference;
use toyproof_verify::NumberType;
use toyproof_verify::bounds::iterations_of_image;
use toyproof_verify::compare::{
    self, CheckSummary, EXACT_TOLERANCE, Mixed, Pixel, PixelStatus, TOLERANCE, Undefined,
};
use toyproof_verify::evaluator::evaluate_at;
use toyproof_verify::{Case, CheckResult, Expected};
use toyproof_verify::{CheckEvidence, Checks, Verdict, decide};

use super::Alternative;
use super::view::View;
use crate::known::KnownMistake;

/// The largest number of pixels of a compared image, which is completely in memory.
const MAX_PIXELS: u32 = 1 << 21;

/// The largest numbers of columns and rows of pixels at which hypotheses are tried.
pub(super) const PROBES: [u32; 2] = [16, 12];

/// The largest share of these pixels that may differ under a hypothesis, which is then confirmed: other ray
/// epsilons move the edges of shadows and reflections.
const MAX_PROBES_OFF: f64 = 0.05;

/// The largest share of the wrong pixels that may differ under a hypothesis. An explanation that leaves more
/// is an accident where few pixels are wrong at all.
const MAX_UNEXPLAINED_SHARE: f64 = 0.05;

/// A wrong shader, with its image and the expected one in f64.
pub(crate) struct WrongShader<'a> {
    pub(super) case: &'a Case<'a>,
    program: &'a Program,
    /// The largest number of loop iterations of a pixel in other frames and at other positions.
    max_iterations: u32,
    pub(super) expected: &'a Expected,
    /// The status of each pixel in the algorithm check.
    pub(super) statuses: &'a [PixelStatus],
    /// The expected image, unclamped.
    pub(super) reference: Image,
    /// The shader's image, unclamped.
    pub(super) actual: Image,
    /// The pixels at which hypotheses are tried.
    pub(super) probes: Places,
    /// The algorithm check.
    pub(super) algorithm: &'a CheckSummary,
    checks: Checks,
}

impl<'a> WrongShader<'a> {
    /// Evaluates the images; `None` if they are too large.
    pub(crate) fn new(
        case: &'a Case<'a>,
        program: &'a Program,
        algorithm: &'a CheckResult,
        checks: &Checks,
    ) -> Option<Self> {
        let (frame, expected) = (case.frame, case.expected?);
        let [width, height] = frame.size;
        if width.saturating_mul(height) > MAX_PIXELS {
            return None;
        }
        let bands = frame
            .bands()
            .map(|rows| Some(expected.rows(&rows).ok()?.image.clone()));
        let bands: Option<Vec<Image>> = bands.collect();
        let settings = Settings::<f64> {
            undefined: UndefinedPolicy::Plain,
            ..Settings::default()
        };
        let rendered = program.render_rows(frame, frame.rows(), &settings).ok()?;
        Some(Self {
            case,
            program,
            max_iterations: iterations_of_image(rendered.observations.max_iterations),
            expected,
            statuses: &algorithm.statuses,
            reference: Image::of_bands(bands?),
            actual: rendered.image,
            probes: Places::spread(frame.size, PROBES),
            algorithm: &algorithm.summary,
            checks: checks.clone(),
        })
    }

    /// The colors of the shader at some places of a frame; `None` if one runs too many loop iterations.
    pub(super) fn evaluate(&self, frame: &Frame, places: &Places) -> Option<Image> {
        evaluate_at(self.program, frame, places, self.max_iterations)
    }

    pub(super) fn frame(&self) -> &'a Frame {
        self.case.frame
    }

    /// Width and height in pixels.
    pub(super) fn size(&self) -> [f64; 2] {
        self.frame().size.map(f64::from)
    }

    /// The tolerance of colors that are compared without the reference's ray epsilons: it is invisible.
    pub(super) fn tolerance(&self) -> f64 {
        self.expected.tolerance() - EXACT_TOLERANCE + TOLERANCE
    }

    /// The expected colors of the probes.
    pub(super) fn expected_probes(&self) -> Image {
        pixels_of(&self.reference, &self.probes)
    }

    /// Whether two images of the probes agree but for few pixels.
    pub(super) fn agree(&self, expected: &Image, actual: &Image) -> bool {
        let count = expected.pixels().len();
        let is_off = |&at: &usize| Pixel::at(at, expected, actual).difference() > self.tolerance();
        let off = (0..count).filter(is_off).count();
        off as f64 <= MAX_PROBES_OFF * count as f64
    }

    /// The shader is correct in a view of it, with the expected image of its own frame.
    pub(super) fn explained_by(
        &self,
        view: &View,
        mistake: impl FnOnce() -> KnownMistake,
    ) -> Option<Alternative> {
        let actual = view.image(self, &self.probes)?;
        let agrees = self.agree(&self.expected_probes(), &actual);
        agrees
            .then(|| self.confirmed(view, self.expected, self.frame(), mistake))
            .flatten()
    }

    /// Compares all pixels of a view with the expected image of a frame, by the rules of the algorithm check.
    pub(super) fn confirmed(
        &self,
        view: &View,
        expected: &Expected,
        frame: &Frame,
        mistake: impl FnOnce() -> KnownMistake,
    ) -> Option<Alternative> {
        let [width, height] = frame.size;
        let mut mixed = Mixed::of(u64::from(width) * u64::from(height));
        let mut check = CheckResult::default();
        for rows in frame.bands() {
            let band = expected.rows(&rows).ok()?;
            let mut places = Places::spread(frame.size, frame.size);
            places.rows = places.rows[rows.start as usize..rows.end as usize].to_vec();
            let actual = view.image(self, &places)?;
            let undefined = Undefined {
                pixels: &vec![false; actual.pixels().len()],
                substituted: Some(&[]),
                in_reference: &band.undefined,
            };
            let from_row = BandReference {
                expected,
                rows: &rows,
                number_type: NumberType::Double,
                derives: self.case.checked.takes_derivatives(),
            };
            let statuses =
                compare::algorithm(&band.image, &actual, &undefined, &from_row, &mut mixed, |_, _| {
                    None
                });
            check.extend(&band.image, &actual, &statuses, rows.start);
        }
        self.accepted(check.with_regions(width), mistake)
    }

    /// Compares the image with another one, which a hypothesis expects; `agrees` decides for each pixel that
    /// is defined.
    pub(super) fn compared(
        &self,
        other: &Image,
        agrees: impl Fn(usize) -> bool,
        mistake: impl FnOnce() -> KnownMistake,
    ) -> Option<Alternative> {
        let statuses = self
            .statuses
            .iter()
            .enumerate()
            .map(|(at, &status)| match status {
                PixelStatus::Undefined => PixelStatus::Undefined,
                _ if agrees(at) => PixelStatus::Agrees,
                PixelStatus::Agrees => PixelStatus::Differs,
                status => status,
            });
        let statuses: Vec<_> = statuses.collect();
        let mut check = CheckResult::default();
        check.extend(other, &self.actual, &statuses, 0);
        self.accepted(check.with_regions(self.frame().size[0]), mistake)
    }

    /// Accepts a hypothesis if the shader is not wrong under it, and almost no wrong pixel is left.
    fn accepted(&self, check: CheckResult, mistake: impl FnOnce() -> KnownMistake) -> Option<Alternative> {
        let algorithm = check.summary;
        let checks = Checks {
            algorithm: Some(algorithm.clone()),
            ..self.checks.clone()
        };
        let evidence = CheckEvidence {
            checks,
            ..CheckEvidence::default()
        };
        let (verdict, _) = decide(evidence.into());
        let is_right = matches!(verdict, Verdict::Correct | Verdict::Unstable);
        let is_explained =
            algorithm.differing as f64 <= MAX_UNEXPLAINED_SHARE * self.algorithm.differing as f64;
        (is_right && is_explained).then(|| Alternative {
            mistake: mistake(),
            algorithm,
        })
    }
}

/// The pixels of an image that contain the places.
pub(super) fn pixels_of(image: &Image, places: &Places) -> Image {
    let [columns, rows] = places.pixels();
    let pixels = rows
        .iter()
        .flat_map(|&y| columns.iter().map(move |&x| image.get(x, y)));
    Image::new(columns.len() as u32, rows.len() as u32, pixels.collect())
}
