//! A shader as reference: evaluated in f64 once for all shaders that are compared with it.

use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use toyproof_diagnostic::Diagnostic;
use toyproof_eval::{self as eval, Observations, Places, RandomRounding, Seed, Settings};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::Input;
use toyproof_image::{Frame, Image};
use toyproof_lint::Lints;
use toyproof_tracer::ColorRange;

use super::accepted::{AcceptedColors, point};
use super::bands::{Bands, ReferenceBand};
use super::number_type::NumberType;
use crate::bounds::{EVALUATOR_TIME_FACTOR, EXPLANATION_TIMEOUT, explanation_deadline};
use crate::compare::{Band, Pixel, Share, changed_by_rounding};
use crate::evaluator::Evaluator;
use crate::loss::NotFinite;
use crate::notes;
use crate::random::estimates::Estimates;
use crate::random::reseed::Reseeding;

/// The default tolerance of colors: half of an 8-bit level.
pub const DEFAULT_TOLERANCE: f64 = 0.5 / 255.0;

/// The largest share of a band's pixels that may be accepted because of numbers that are a matter of style.
const MAX_ACCEPTED_SHARE: f64 = 0.05;

/// A shader that others are compared with, in one frame.
#[derive(Debug)]
pub struct ShaderReference {
    pub(crate) program: Arc<Program>,
    pub(crate) frame: Frame,
    tolerance: f64,
    pub(crate) timeout: Duration,
    bands: Bands,
    /// The colors for other ray epsilons and marches.
    accepted: OnceLock<Option<AcceptedColors>>,
    /// How its random numbers can be changed, if it has any that can.
    pub(crate) reseeding: OnceLock<Option<Reseeding>>,
    /// The estimates of pixels with other random numbers, and their places.
    pub(crate) estimates: OnceLock<(Places, Option<Arc<Estimates>>)>,
}

/// The results of evaluating a reference shader.
#[derive(Debug)]
pub struct ReferenceFindings {
    /// Undefined operations, uninitialized reads and colors that are not finite, with their lines.
    pub notes: Vec<Diagnostic>,
    /// The pixels without a defined color: they depend on undefined behavior, or are NaN.
    pub undefined: Share,
}

impl ShaderReference {
    /// Evaluates a shader in a frame. Colors agree with it if no component differs by more than `tolerance`,
    /// in [0, 1]; `timeout` is the time limit of a shader's image.
    ///
    /// # Errors
    /// If the shader cannot be evaluated in time.
    pub fn new(
        checked: &Checked,
        lints: &Lints,
        frame: &Frame,
        tolerance: f64,
        timeout: Duration,
    ) -> Result<(Self, ReferenceFindings), eval::Failure> {
        let program = Arc::new(Program::within(checked, timeout * EVALUATOR_TIME_FACTOR)?);
        let reference = Self::unevaluated(program, frame, tolerance, timeout);
        let findings = reference.evaluate(lints)?;
        Ok((reference, findings))
    }

    /// The same shader in another frame; none if it cannot be evaluated there.
    pub(crate) fn in_frame(&self, frame: &Frame) -> Option<Self> {
        // It explains images, so that it must not depend on the load of the machine.
        let reference = Self::unevaluated(self.program.clone(), frame, self.tolerance, EXPLANATION_TIMEOUT);
        reference.evaluate(&Lints::default()).ok()?;
        Some(reference)
    }

    pub(crate) fn unevaluated(
        program: Arc<Program>,
        frame: &Frame,
        tolerance: f64,
        timeout: Duration,
    ) -> Self {
        Self {
            bands: Bands::new(frame),
            program,
            frame: frame.clone(),
            tolerance,
            timeout,
            accepted: OnceLock::new(),
            reseeding: OnceLock::new(),
            estimates: OnceLock::new(),
        }
    }

    /// Evaluates all bands once.
    fn evaluate(&self, lints: &Lints) -> Result<ReferenceFindings, eval::Failure> {
        let mut observed = Observations::default();
        let mut not_finite = NotFinite::default();
        let mut undefined = Share { count: 0, of: 0 };
        for rows in self.frame.bands() {
            let (band, observed_there) = self.render(&rows)?;
            not_finite.record(&band.image, rows.start);
            undefined.of += band.image.pixels().len() as u64;
            undefined.count += band.undefined.iter().filter(|&&undefined| undefined).count() as u64;
            observed.merge(&observed_there);
            self.bands.get_or_render(&rows, || band);
        }
        let mut notes = notes::notes(&observed, undefined.count > 0, lints);
        let deadline = explanation_deadline(0.0);
        notes.extend(not_finite.diagnostic(&self.program, &self.frame, deadline));
        notes.retain(|note| !lints.allows(note));
        Ok(ReferenceFindings { notes, undefined })
    }

    fn render(&self, rows: &Range<u32>) -> Result<(ReferenceBand, Observations), eval::Failure> {
        let evaluated = self.with_evaluator(|evaluator| evaluator.double(rows))?;
        let mut undefined = evaluated.undefined;
        for (undefined, color) in undefined.iter_mut().zip(evaluated.image.pixels()) {
            *undefined |= color[..3].iter().any(|part| part.is_nan());
        }
        let band = ReferenceBand {
            image: evaluated.image,
            undefined,
        };
        Ok((band, evaluated.observed))
    }

    fn with_evaluator<T>(&self, work: impl FnOnce(&Evaluator) -> T) -> T {
        let limit = self.timeout * EVALUATOR_TIME_FACTOR;
        let stop = AtomicBool::new(false);
        work(&Evaluator::new(&self.program, &self.frame, limit, &stop))
    }

    /// The shader.
    pub(crate) fn checked(&self) -> &Checked {
        self.program.checked()
    }

    pub(super) fn reads_time(&self) -> bool {
        self.checked().reads(Input::Time)
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    pub(super) fn bytes(&self) -> usize {
        self.bands.bytes()
    }

    pub(super) fn rows(&self, rows: &Range<u32>) -> Result<Arc<ReferenceBand>, eval::Failure> {
        match self.bands.get(rows) {
            Some(band) => Ok(band),
            None => self.render(rows).map(|(band, _)| Arc::new(band)),
        }
    }

    pub(super) fn pixel(&self, x: u32, y: u32) -> [f64; 3] {
        // Derivatives need the whole quad.
        let along = |at: u32| {
            [at / 2 * 2, at / 2 * 2 + 1]
                .map(|at| f64::from(at) + 0.5)
                .to_vec()
        };
        let quad = Places {
            columns: along(x),
            rows: along(y),
        };
        let evaluated = self.program.at(&self.frame, &quad, &Settings::<f64>::plain());
        evaluated.map_or([f64::NAN; 3], |image| {
            let [r, g, b, _] = image.get(x % 2, y % 2);
            [r, g, b].map(f64::from)
        })
    }

    /// The colors for other ray epsilons and marches.
    pub(super) fn accepted(&self) -> Option<&AcceptedColors> {
        self.accepted.get_or_init(|| AcceptedColors::new(self)).as_ref()
    }

    /// The colors of [`Self::accepted`], if they have been computed.
    pub(super) fn used(&self) -> Option<&AcceptedColors> {
        self.accepted.get()?.as_ref()
    }

    /// The colors of a pixel for the usual ray epsilons and other marches.
    pub(super) fn color_range(&self, x: u32, y: u32) -> ColorRange {
        if let Some(accepted) = self.accepted() {
            return *accepted.range((y * self.frame.size[0] + x) as usize);
        }
        point(self.pixel(x, y))
    }

    /// Accepts the colors that the shader has for other ray epsilons and marches, where few pixels differ;
    /// where many do, these are not the cause.
    pub(super) fn accept_epsilons(&self, rows: &Range<u32>, band: &mut Band) {
        if band.differing_share() > MAX_ACCEPTED_SHARE {
            return;
        }
        let Some(accepted) = self.accepted() else {
            return;
        };
        let width = self.frame.size[0];
        band.accept(|pixel| {
            let at = (rows.start + pixel.y) * width + pixel.x;
            accepted.range(at as usize).distance(pixel.actual.map(f64::from)) <= self.tolerance
        });
    }

    pub(super) fn tied(
        &self,
        rows: &Range<u32>,
        wanted: &[bool],
        number_type: NumberType,
        tolerance: f64,
    ) -> Vec<bool> {
        let band = match self.rows(rows) {
            Ok(band) if wanted.contains(&true) => band,
            _ => return vec![false; wanted.len()],
        };
        let seed = match number_type {
            NumberType::Double => Seed::double,
            NumberType::Single => Seed::single,
        };
        let along = |pixels: Range<u32>| pixels.map(|at| f64::from(at) + 0.5).collect();
        let places = Places {
            columns: along(0..self.frame.size[0]),
            rows: along(rows.clone()),
        };
        let step = number_type.perturbation();
        let mut tied = self.changed_by_moving(&places, &band.image, wanted, step, tolerance);
        let left: Vec<bool> = wanted
            .iter()
            .zip(&tied)
            .map(|(wanted, tied)| *wanted && !tied)
            .collect();
        let changed = self.with_evaluator(|evaluator| {
            let perturbed =
                |number, wanted: &[bool]| evaluator.perturbed(rows, seed(number), wanted).ok().flatten();
            changed_by_rounding(&band.image, &left, tolerance, perturbed)
        });
        for (tied, changed) in tied.iter_mut().zip(changed) {
            *tied |= changed;
        }
        tied
    }

    /// The number of pixels, among those at some places, in which rounding decides the color.
    pub(super) fn ill_conditioned_at(&self, places: &Places) -> u64 {
        let deadline = Some(Instant::now() + self.timeout * EVALUATOR_TIME_FACTOR);
        let settings = Settings::<f64> {
            deadline,
            ..Settings::plain()
        };
        let Ok(image) = self.program.at(&self.frame, places, &settings) else {
            return 0;
        };
        let wanted = vec![true; image.pixels().len()];
        let step = NumberType::Double.perturbation();
        let moved = self.changed_by_moving(places, &image, &wanted, step, self.tolerance);
        let left: Vec<bool> = moved.iter().map(|moved| !moved).collect();
        let rounded = changed_by_rounding(&image, &left, self.tolerance, |seed, wanted| {
            let settings = Settings::<RandomRounding> {
                noise: Seed::double(seed),
                deadline,
                wanted: Some(wanted),
                ..Settings::plain()
            };
            self.program.at(&self.frame, places, &settings).ok()
        });
        let changed = moved
            .iter()
            .zip(rounded)
            .filter(|(moved, rounded)| **moved || *rounded);
        changed.count() as u64
    }

    /// Returns those of the `wanted` pixels at some places whose color changes if the pixel moves by `step`
    /// relative to its coordinates, a few units in the last place: where an edge passes exactly through its
    /// center, even exact operations decide nothing.
    fn changed_by_moving(
        &self,
        places: &Places,
        image: &Image,
        wanted: &[bool],
        step: f64,
        tolerance: f64,
    ) -> Vec<bool> {
        let settings = Settings::<f64> {
            deadline: Some(Instant::now() + self.timeout * EVALUATOR_TIME_FACTOR),
            wanted: Some(wanted),
            ..Settings::plain()
        };
        let mut changed = vec![false; wanted.len()];
        for [dx, dy] in [[step, step], [-step, -step], [step, -step], [-step, step]] {
            let along = |places: &[f64], step: f64| places.iter().map(|at| at * (1.0 + step)).collect();
            let moved = Places {
                columns: along(&places.columns, dx),
                rows: along(&places.rows, dy),
            };
            let Ok(moved) = self.program.at(&self.frame, &moved, &settings) else {
                break;
            };
            for (at, changed) in changed.iter_mut().enumerate() {
                *changed |= wanted[at] && Pixel::at(at, image, &moved).difference() > tolerance;
            }
        }
        changed
    }
}
