//! Evaluates a shader in f32 and in f64, and finds the pixels that depend on undefined behavior.

use std::cell::Cell;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof_eval::{
    Failure, Fault, Number, Observations, Observed, Places, Program, RandomRounding, RenderedF32, Seed,
    Settings, Substitute, UndefinedPolicy,
};
use toyproof_image::{Frame, Image};

/// The time limit of an image in [`evaluate_at`]. It is generous, since most take milliseconds and the result
/// must not depend on the machine's load.
const PLACES_TIMEOUT: Duration = Duration::from_secs(60);

/// Evaluates a shader in f64 at some places of a frame; none if it exceeds the time limit.
pub(super) fn evaluate_at(program: &Program, frame: &Frame, places: &Places) -> Option<Image> {
    let settings = Settings::<f64> {
        undefined: UndefinedPolicy::Plain,
        deadline: Some(Instant::now() + PLACES_TIMEOUT),
        ..Settings::default()
    };
    program.at(frame, places, &settings).ok()
}

/// Renders a shader band by band.
pub(super) struct Evaluator<'a> {
    program: &'a Program,
    frame: &'a Frame,
    /// The frame with what earlier frames render in double precision; none if it does not depend on them.
    double_frame: Option<&'a Frame>,
    /// Set when the images are no longer needed.
    stop: &'a AtomicBool,
    /// The deadline of all images.
    deadline: Instant,
    /// The time left for the images in f32 and in f64, each with the default policy for undefined behavior
    /// and with substitutes.
    single: [TimeBudget; 2],
    double: [TimeBudget; 2],
    /// The time left for the image in f64 of what earlier frames render in f32.
    step: TimeBudget,
    /// The time left for all perturbed images.
    perturbed: TimeBudget,
}

/// The time left for an image, all bands together.
struct TimeBudget(Cell<Duration>);

/// A band, as the evaluator renders it.
pub(super) struct Band {
    /// In f32, with the bits of a strict GPU run.
    pub(super) single: Image,
    /// In f64, rounded once at the end.
    pub(super) double: Image,
    /// The same of what earlier frames render in f32, where the frame depends on them.
    pub(super) step: Option<Image>,
    /// Pixels whose color depends on undefined behavior, in f32 or in f64.
    pub(super) undefined: Vec<bool>,
    /// Observations in f32.
    pub(super) observed: Observations,
}

/// An image in one number type, with its undefined pixels and observations.
pub(super) struct Evaluated {
    /// Rounded to f32.
    pub(super) image: Image,
    /// Pixels whose color depends on undefined behavior.
    pub(super) undefined: Vec<bool>,
    pub(super) observed: Observations,
}

impl<'a> Evaluator<'a> {
    /// Creates an evaluator with the time limits `each` for an image and `perturbed` for all perturbed ones,
    /// and a deadline for all.
    pub(super) fn new(
        program: &'a Program,
        frame: &'a Frame,
        [each, perturbed]: [Duration; 2],
        deadline: Instant,
        stop: &'a AtomicBool,
    ) -> Self {
        let pair = || [TimeBudget::new(each), TimeBudget::new(each)];
        Self {
            program,
            frame,
            double_frame: None,
            stop,
            deadline,
            single: pair(),
            double: pair(),
            step: TimeBudget::new(each),
            perturbed: TimeBudget::new(perturbed),
        }
    }

    /// Renders another frame in f64: one with what earlier frames render in double precision.
    pub(super) fn with_double(self, double_frame: Option<&'a Frame>) -> Self {
        Self { double_frame, ..self }
    }

    pub(super) fn program(&self) -> &'a Program {
        self.program
    }

    /// Renders some rows in f32 alone.
    pub(super) fn single(&self, rows: &Range<u32>) -> Result<Evaluated, Failure> {
        self.evaluate::<f32>(self.frame, rows, &self.single)
    }

    /// Renders some rows in f64 alone.
    pub(super) fn double(&self, rows: &Range<u32>) -> Result<Evaluated, Failure> {
        self.evaluate::<f64>(self.double_frame.unwrap_or(self.frame), rows, &self.double)
    }

    fn evaluate<N: Number>(
        &self,
        frame: &Frame,
        rows: &Range<u32>,
        [budget, substituted]: &[TimeBudget; 2],
    ) -> Result<Evaluated, Failure> {
        let rendered = self.render_as::<N>(frame, rows, UndefinedPolicy::Observed, budget)?;
        let undefined = self.undefined_pixels::<N>(frame, rows, &rendered, substituted);
        Ok(Evaluated {
            image: rendered.image,
            undefined,
            observed: rendered.observations,
        })
    }

    /// Renders some rows. Calls `report_iterations` with the largest number of loop iterations of a pixel in
    /// f32 as soon as it is known.
    pub(super) fn render(
        &self,
        rows: &Range<u32>,
        report_iterations: impl FnOnce(u32),
    ) -> Result<Band, Failure> {
        let frame = self.frame;
        let single = self.render_as::<f32>(frame, rows, UndefinedPolicy::Observed, &self.single[0])?;
        report_iterations(single.observations.max_iterations);
        let mut undefined = self.undefined_pixels::<f32>(frame, rows, &single, &self.single[1]);
        let double = self.double(rows)?;
        let step = self
            .double_frame
            .map(|_| self.render_as::<f64>(frame, rows, UndefinedPolicy::Plain, &self.step))
            .transpose()?;
        for (undefined, undefined_in_double) in undefined.iter_mut().zip(double.undefined) {
            *undefined |= undefined_in_double;
        }
        Ok(Band {
            single: single.image,
            double: double.image,
            step: step.map(|step| step.image),
            undefined,
            observed: single.observations,
        })
    }

    /// Renders some rows in f64 with every operation perturbed by a unit of the seed or not at all, at least
    /// in the `wanted` pixels; none if the time limit is exceeded.
    pub(super) fn perturbed(&self, rows: &Range<u32>, seed: Seed, wanted: &[bool]) -> Option<Image> {
        self.perturbed.spend(self.deadline, |deadline| {
            let settings = Settings::<RandomRounding> {
                undefined: UndefinedPolicy::Plain,
                noise: seed,
                deadline: Some(deadline),
                wanted: Some(wanted),
                ..Settings::default()
            };
            let frame = self.double_frame.unwrap_or(self.frame);
            let rendered = self.program.render_rows(frame, rows.clone(), &settings);
            rendered.ok().map(|rendered| rendered.image)
        })
    }

    /// Finds the pixels with undefined operations whose color changes with the result of these. If the time
    /// limit is exceeded, all of them count.
    fn undefined_pixels<N: Number>(
        &self,
        frame: &Frame,
        rows: &Range<u32>,
        default_image: &RenderedF32,
        budget: &TimeBudget,
    ) -> Vec<bool> {
        let candidates = default_image.undefined.clone();
        let is_derivative = |observed: &Observed| observed.site.fault == Fault::LonelyDerivative;
        // No substitute stands for the value of a derivative.
        if !candidates.contains(&true) || default_image.observations.faults.iter().any(is_derivative) {
            return candidates;
        }
        let mut undefined = vec![false; candidates.len()];
        for substituted in [Substitute::Number, Substitute::NotANumber] {
            if undefined == candidates {
                break;
            }
            let Ok(substituted) =
                self.render_as::<N>(frame, rows, UndefinedPolicy::Substitute(substituted), budget)
            else {
                return candidates;
            };
            let pairs = default_image
                .image
                .pixels()
                .iter()
                .zip(substituted.image.pixels());
            for ((undefined, candidate), (usual, substituted)) in
                undefined.iter_mut().zip(&candidates).zip(pairs)
            {
                *undefined |= *candidate && usual.map(f32::to_bits) != substituted.map(f32::to_bits);
            }
        }
        undefined
    }

    fn render_as<N: Number>(
        &self,
        frame: &Frame,
        rows: &Range<u32>,
        undefined: UndefinedPolicy,
        budget: &TimeBudget,
    ) -> Result<RenderedF32, Failure> {
        budget.spend(self.deadline, |deadline| {
            let settings = Settings::<N> {
                undefined,
                deadline: Some(deadline),
                interrupt: Some(self.stop),
                ..Settings::default()
            };
            self.program.render_rows(frame, rows.clone(), &settings)
        })
    }
}

impl TimeBudget {
    fn new(time: Duration) -> Self {
        Self(Cell::new(time))
    }

    /// Runs `work` with the time left, but at most until `deadline`, and subtracts the time it took.
    fn spend<T>(&self, deadline: Instant, work: impl FnOnce(Instant) -> T) -> T {
        let start = Instant::now();
        let done = work(deadline.min(start + self.0.get()));
        self.0.set(self.0.get().saturating_sub(start.elapsed()));
        done
    }
}
