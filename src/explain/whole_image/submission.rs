//! A submission whose image is compared as a whole: evaluated at other positions or with other inputs, or
//! with another expected image.

use toyproof_eval::{Places, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image};
use toyproof_verify::Expected;
use toyproof_verify::bounds::iterations_of_image;
use toyproof_verify::compare::{EXACT_TOLERANCE, PixelStatus, TOLERANCE};
use toyproof_verify::evaluator::evaluate_at;

use super::Alternative;
use crate::engine::confirm::Confirmer;
use crate::engine::probes::{Limits, Probes};
use crate::engine::tournament::passing;
use crate::engine::{Colors, Hypothesis, Numbers, colors_of};
use crate::known::KnownMistake;

/// The largest number of pixels of a compared image, which is completely in memory.
const MAX_PIXELS: u32 = 1 << 21;

/// The largest numbers of columns and rows of pixels at which hypotheses are tried.
pub(super) const PROBES: [u32; 2] = [16, 12];

/// The largest share of these pixels that may differ under a hypothesis, which is then confirmed: other ray
/// epsilons move the edges of shadows and reflections.
const MAX_PROBES_OFF: f64 = 0.05;

/// A wrong submission, with its image and the expected one in f64.
pub(crate) struct Submission<'a> {
    pub(super) confirmer: &'a Confirmer<'a>,
    program: &'a Program,
    /// The largest number of loop iterations of a pixel in other frames and at other positions.
    max_iterations: u32,
    /// The expected image, unclamped.
    pub(super) reference: Image,
    /// The shader's image, unclamped.
    pub(super) actual: Image,
    /// The pixels at which hypotheses are tried.
    pub(super) probes: Places,
}

impl<'a> Submission<'a> {
    /// Evaluates the images; `None` if they are too large.
    pub(crate) fn new(confirmer: &'a Confirmer<'a>, program: &'a Program) -> Option<Self> {
        let frame = confirmer.case.frame;
        let [width, height] = frame.size;
        if width.saturating_mul(height) > MAX_PIXELS {
            return None;
        }
        let settings = Settings::<f64> {
            undefined: UndefinedPolicy::Plain,
            ..Settings::default()
        };
        let reference = confirmer.expected.image(frame).ok()?;
        let rendered = program.render_rows(frame, frame.rows(), &settings).ok()?;
        Some(Self {
            confirmer,
            program,
            max_iterations: iterations_of_image(rendered.observations.max_iterations),
            reference,
            actual: rendered.image,
            probes: Places::spread(frame.size, PROBES),
        })
    }

    /// The colors of the shader at some places of a frame; `None` if one runs too many loop iterations.
    pub(super) fn evaluate(&self, frame: &Frame, places: &Places) -> Option<Image> {
        evaluate_at(self.program, frame, places, self.max_iterations)
    }

    pub(super) fn expected(&self) -> &'a Expected {
        self.confirmer.expected
    }

    pub(super) fn frame(&self) -> &'a Frame {
        self.confirmer.case.frame
    }

    /// The status of each pixel in the algorithm check.
    pub(super) fn statuses(&self) -> &'a [PixelStatus] {
        &self.confirmer.before.statuses
    }

    /// Width and height in pixels.
    pub(super) fn size(&self) -> [f64; 2] {
        self.frame().size.map(f64::from)
    }

    /// The tolerance of colors that are compared without the reference's ray epsilons: it is invisible.
    pub(super) fn tolerance(&self) -> f64 {
        self.expected().tolerance() - EXACT_TOLERANCE + TOLERANCE
    }

    fn limits(&self) -> Limits {
        Limits {
            tolerance: self.tolerance(),
            of_all: MAX_PROBES_OFF,
            of_wrong: f64::INFINITY,
            extra: 0,
            of_image: None,
        }
    }

    /// Whether two images at some places agree but for few pixels.
    pub(super) fn agree(&self, places: &Places, expected: &Image, actual: &Image) -> bool {
        let probes = Probes::on_grid(places, expected, actual, self.limits());
        probes.wrong() <= self.limits().most(probes.all.len(), 0)
    }

    /// Returns the first of some views in which the shader is correct, with the expected image of its own
    /// frame.
    pub(super) fn explained_by(&self, views: Vec<(View, KnownMistake)>) -> Option<Alternative> {
        let of_view = |(view, mistake)| Viewed {
            submission: self,
            view,
            mistake,
        };
        let hypotheses: Vec<Viewed> = views.into_iter().map(of_view).collect();
        let expected = pixels_of(&self.reference, &self.probes);
        let actual = pixels_of(&self.actual, &self.probes);
        let probes = Probes::on_grid(&self.probes, &expected, &actual, self.limits());
        let passing = passing(&mut &hypotheses[..], hypotheses.len(), &probes).into_iter();
        passing
            .into_iter()
            .find_map(|(at, _)| hypotheses[at].confirm(&Numbers::default()))
    }

    /// Compares all pixels of a view with the expected image of a frame.
    pub(super) fn confirmed(
        &self,
        view: &View,
        (expected, frame): (&Expected, &Frame),
        mistake: KnownMistake,
    ) -> Option<Alternative> {
        let render = |places: &Places| view.image(self, places);
        let algorithm = self.confirmer.rendered(expected, frame, render)?;
        Some(Alternative { mistake, algorithm })
    }

    /// Compares the image with another one, which a hypothesis expects; `agrees` decides for each pixel.
    pub(super) fn predicted(
        &self,
        other: &Image,
        agrees: impl Fn(usize) -> bool,
        mistake: impl FnOnce() -> KnownMistake,
    ) -> Option<Alternative> {
        let algorithm = self.confirmer.predicted(other, &self.actual, agrees)?;
        Some(Alternative {
            mistake: mistake(),
            algorithm,
        })
    }
}

/// How a shader is evaluated: for each pixel of the expected image, at another position or with other inputs.
pub(super) struct View {
    frame: Frame,
    /// From a pixel's coordinates to those at which the shader is evaluated.
    axes: [Axis; 2],
    /// Whether x is computed from the pixel's y, and y from its x.
    is_transposed: bool,
}

/// A coordinate: p → `scale · p + offset`, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    scale: f64,
    offset: f64,
}

impl Axis {
    pub(super) const SAME: Self = Self {
        scale: 1.0,
        offset: 0.0,
    };

    /// Scales about `from`, which is moved to `to`.
    pub(super) fn scaled(scale: f64, from: f64, to: f64) -> Self {
        Self {
            scale,
            offset: to - scale * from,
        }
    }

    pub(super) fn along(self, coordinates: &[f64]) -> Vec<f64> {
        coordinates
            .iter()
            .map(|at| self.scale * at + self.offset)
            .collect()
    }
}

impl View {
    /// Other inputs at the same positions.
    pub(super) fn with_inputs(frame: Frame) -> Self {
        Self {
            frame,
            axes: [Axis::SAME; 2],
            is_transposed: false,
        }
    }

    /// Other positions.
    pub(super) fn moved(frame: &Frame, axes: [Axis; 2]) -> Self {
        Self {
            axes,
            ..Self::with_inputs(frame.clone())
        }
    }

    pub(super) fn transposed(self) -> Self {
        Self {
            is_transposed: true,
            ..self
        }
    }

    /// The image of the pixels of a shader at these places; `None` if one runs too many loop iterations.
    pub(super) fn image(&self, shader: &Submission, places: &Places) -> Option<Image> {
        let [x, y] = self.axes;
        if !self.is_transposed {
            let places = Places {
                columns: x.along(&places.columns),
                rows: y.along(&places.rows),
            };
            return shader.evaluate(&self.frame, &places);
        }
        let exchanged = Places {
            columns: x.along(&places.rows),
            rows: y.along(&places.columns),
        };
        let image = shader.evaluate(&self.frame, &exchanged)?;
        let [width, height] = places.size();
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = pixels.map(|(x, y)| image.get(y, x)).collect();
        Some(Image::new(width, height, pixels))
    }
}

/// The hypothesis that a shader is right in a view.
struct Viewed<'a> {
    submission: &'a Submission<'a>,
    view: View,
    mistake: KnownMistake,
}

impl Hypothesis for Viewed<'_> {
    type Confirmed = Alternative;

    fn colors(&self, probes: &Probes, _: &Numbers) -> Option<Colors> {
        Some(colors_of(
            &self.view.image(self.submission, probes.grid.as_ref()?)?,
        ))
    }

    fn confirm(&self, _: &Numbers) -> Option<Alternative> {
        let Submission { confirmer, .. } = self.submission;
        let of_check = (confirmer.expected, confirmer.case.frame);
        self.submission
            .confirmed(&self.view, of_check, self.mistake.clone())
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
