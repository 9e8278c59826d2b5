//! Evaluates a shader in f32 and in f64, and finds the pixels that depend on undefined behavior.

use std::cell::Cell;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof_eval::{
    Failure, Fault, Number, Observations, Observed, Places, RandomRounding, RenderedF32, Seed, Settings,
    Substitute, UndefinedPolicy,
};
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image};

/// Evaluates a shader in f64 at some places of a frame; none if a pixel runs more loop iterations. The result
/// does not depend on the load of the machine: iterations are counted, and there is no deadline.
pub fn evaluate_at(program: &Program, frame: &Frame, places: &Places, max_iterations: u32) -> Option<Image> {
    let settings = Settings::<f64> {
        max_iterations,
        ..Settings::plain()
    };
    program.at(frame, places, &settings).ok()
}

/// The time limit of the evaluations that a comparison needs in addition to the images, as a multiple of an
/// image's. They decide what a pixel's difference means, so that only a hang may exceed it.
const OTHER_TIME_FACTOR: u32 = 4;
/// The same as a multiple of the time that the image in f64 took: up to [`PERTURBATIONS`] images, each of
/// which takes about eight times as long.
///
/// [`PERTURBATIONS`]: crate::compare::PERTURBATIONS
const PERTURBED_TIME_FACTOR: u32 = 64;

/// Renders a shader band by band.
pub struct Evaluator<'a> {
    program: &'a Program,
    frame: &'a Frame,
    /// The frame with what earlier frames render in double precision; `None` for a frame that does not depend
    /// on earlier ones.
    double_frame: Option<&'a Frame>,
    /// The largest number of loop iterations of a pixel.
    max_iterations: u32,
    /// Set when the images are no longer needed.
    stop: &'a AtomicBool,
    /// The time left for the image in f32.
    single: TimeBudget,
    /// The time left for the image in f64.
    double: TimeBudget,
    /// The time left for the image in f64 of what earlier frames render in f32.
    step: TimeBudget,
    /// The time left for all images with substitutes for undefined operations.
    substituted: TimeBudget,
    /// The time left for all perturbed images, without the part that depends on `double_time`.
    perturbed: TimeBudget,
    /// The time that images in f64 took.
    double_time: Cell<Duration>,
}

/// The time left for an image, all bands together.
struct TimeBudget(Cell<Duration>);

/// A band, as the evaluator renders it.
pub struct Band {
    /// The band in f32, with the bits of a strict GPU run.
    pub single: Image,
    /// The band in f64; why double precision could not be evaluated, where only float32 could.
    pub double: Result<DoubleBand, Failure>,
    /// Pixels whose color depends on undefined behavior, in f32 or in f64.
    pub undefined: Vec<bool>,
    /// Observations in f32.
    pub observed: Observations,
}

/// A band in double precision, rounded once at the end.
pub struct DoubleBand {
    /// The image.
    pub image: Image,
    /// The image of what earlier frames render in f32, where the frame depends on them.
    pub step: Option<Image>,
    /// The images with other results of undefined operations; none if these have no substitutes.
    pub substituted: Option<Vec<Image>>,
}

/// An image in one number type, with its undefined pixels and observations.
pub struct Evaluation {
    /// The image, rounded to f32.
    pub image: Image,
    /// Pixels whose color depends on undefined behavior.
    pub undefined: Vec<bool>,
    /// The images with other results of undefined operations; none if these have no substitutes.
    substituted: Option<Vec<Image>>,
    /// What was observed.
    pub observed: Observations,
}

impl<'a> Evaluator<'a> {
    /// Creates an evaluator with a time limit for an image.
    pub fn new(program: &'a Program, frame: &'a Frame, limit: Duration, stop: &'a AtomicBool) -> Self {
        Self {
            program,
            frame,
            double_frame: None,
            max_iterations: Settings::<f64>::default().max_iterations,
            stop,
            single: TimeBudget::new(limit),
            double: TimeBudget::new(limit),
            step: TimeBudget::new(limit),
            substituted: TimeBudget::new(limit * OTHER_TIME_FACTOR),
            perturbed: TimeBudget::new(limit * OTHER_TIME_FACTOR),
            double_time: Cell::new(Duration::ZERO),
        }
    }

    /// Renders another frame in f64: one with what earlier frames render in double precision.
    #[must_use]
    pub fn with_double(self, double_frame: Option<&'a Frame>) -> Self {
        Self { double_frame, ..self }
    }

    /// Fails if a pixel runs more loop iterations.
    #[must_use]
    pub fn with_max_iterations(self, max_iterations: u32) -> Self {
        Self {
            max_iterations,
            ..self
        }
    }

    /// The shader's program.
    #[must_use]
    pub fn program(&self) -> &'a Program {
        self.program
    }

    /// Renders some rows in f32 alone.
    ///
    /// # Errors
    /// If the evaluator fails or is interrupted.
    pub fn single(&self, rows: &Range<u32>) -> Result<Evaluation, Failure> {
        let rendered = self.render_as::<f32>(self.frame, rows, UndefinedPolicy::Observed, &self.single)?;
        self.with_undefined::<f32>(self.frame, rows, rendered)
    }

    /// Renders some rows in f64 alone.
    ///
    /// # Errors
    /// If the evaluator fails or is interrupted.
    pub fn double(&self, rows: &Range<u32>) -> Result<Evaluation, Failure> {
        let frame = self.double_frame.unwrap_or(self.frame);
        let start = Instant::now();
        let rendered = self.render_as::<f64>(frame, rows, UndefinedPolicy::Observed, &self.double)?;
        self.double_time.set(self.double_time.get() + start.elapsed());
        self.with_undefined::<f64>(frame, rows, rendered)
    }

    /// Renders some rows. Calls `report_iterations` with the largest number of loop iterations of a pixel in
    /// f32 as soon as it is known.
    ///
    /// # Errors
    /// If float32 cannot be evaluated, or the evaluator is interrupted.
    pub fn render(&self, rows: &Range<u32>, report_iterations: impl FnOnce(u32)) -> Result<Band, Failure> {
        let single = self.render_as::<f32>(self.frame, rows, UndefinedPolicy::Observed, &self.single)?;
        report_iterations(single.observations.max_iterations);
        let single = self.with_undefined::<f32>(self.frame, rows, single)?;
        let mut undefined = single.undefined;
        let double = match self.double_band(rows, &mut undefined) {
            Err(Failure::Interrupted) => return Err(Failure::Interrupted),
            double => double,
        };
        Ok(Band {
            single: single.image,
            double,
            undefined,
            observed: single.observed,
        })
    }

    /// Renders some rows in f64, and adds the pixels that are undefined there.
    fn double_band(&self, rows: &Range<u32>, undefined: &mut [bool]) -> Result<DoubleBand, Failure> {
        let double = self.double(rows)?;
        let step = self
            .double_frame
            .map(|_| self.render_as::<f64>(self.frame, rows, UndefinedPolicy::Plain, &self.step))
            .transpose()?;
        for (undefined, undefined_in_double) in undefined.iter_mut().zip(double.undefined) {
            *undefined |= undefined_in_double;
        }
        Ok(DoubleBand {
            image: double.image,
            step: step.map(|step| step.image),
            substituted: double.substituted,
        })
    }

    /// Renders some rows in f64 with every operation perturbed by a unit of the seed or not at all, at least
    /// in the `wanted` pixels; `None` if a loop then does not end.
    ///
    /// # Errors
    /// If it takes much longer than the image did.
    pub fn perturbed(
        &self,
        rows: &Range<u32>,
        seed: Seed,
        wanted: &[bool],
    ) -> Result<Option<Image>, Failure> {
        let extra = self.double_time.get() * PERTURBED_TIME_FACTOR;
        self.perturbed.spend(extra, |deadline| {
            let settings = Settings::<RandomRounding> {
                max_iterations: self.max_iterations,
                noise: seed,
                deadline: Some(deadline),
                wanted: Some(wanted),
                ..Settings::plain()
            };
            let frame = self.double_frame.unwrap_or(self.frame);
            let rendered = self.program.render_rows(frame, rows.clone(), &settings);
            match rendered {
                Ok(rendered) => Ok(Some(rendered.image)),
                Err(Failure::TooOften { .. }) => Ok(None),
                Err(failure) => Err(failure),
            }
        })
    }

    /// Finds the pixels with undefined operations whose color changes with the results of these; without
    /// substitutes, all of them count.
    fn with_undefined<N: Number>(
        &self,
        frame: &Frame,
        rows: &Range<u32>,
        rendered: RenderedF32,
    ) -> Result<Evaluation, Failure> {
        let candidates = rendered.undefined;
        let is_derivative = |observed: &Observed| observed.site.fault == Fault::NonUniformDerivative;
        // Derivatives have no substitute value.
        let has_substitutes = !rendered.observations.faults.iter().any(is_derivative);
        let mut substituted = has_substitutes.then(Vec::new);
        if candidates.contains(&true) && has_substitutes {
            substituted = self.with_substitutes::<N>(frame, rows)?;
        }
        let undefined = match &substituted {
            None => candidates,
            Some(images) => {
                let changes = |at: usize| {
                    let bits = |image: &Image| image.pixels()[at].map(f32::to_bits);
                    images.iter().any(|image| bits(image) != bits(&rendered.image))
                };
                let pixels = candidates.iter().enumerate();
                pixels.map(|(at, &candidate)| candidate && changes(at)).collect()
            }
        };
        Ok(Evaluation {
            image: rendered.image,
            undefined,
            substituted,
            observed: rendered.observations,
        })
    }

    /// Renders some rows with each substitute for undefined results; `None` if a loop then does not end.
    fn with_substitutes<N: Number>(
        &self,
        frame: &Frame,
        rows: &Range<u32>,
    ) -> Result<Option<Vec<Image>>, Failure> {
        let images = Substitute::ALL.into_iter().map(|substitute| {
            let policy = UndefinedPolicy::Substitute(substitute);
            let rendered = self.render_as::<N>(frame, rows, policy, &self.substituted)?;
            Ok(rendered.image)
        });
        match images.collect() {
            Ok(images) => Ok(Some(images)),
            Err(Failure::TooOften { .. }) => Ok(None),
            Err(failure) => Err(failure),
        }
    }

    fn render_as<N: Number>(
        &self,
        frame: &Frame,
        rows: &Range<u32>,
        undefined: UndefinedPolicy,
        budget: &TimeBudget,
    ) -> Result<RenderedF32, Failure> {
        budget.spend(Duration::ZERO, |deadline| {
            let settings = Settings::<N> {
                undefined,
                max_iterations: self.max_iterations,
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

    /// Runs `work` with the time left and `extra`, and subtracts the time it took.
    fn spend<T>(&self, extra: Duration, work: impl FnOnce(Instant) -> T) -> T {
        let start = Instant::now();
        let done = work(start + self.0.get() + extra);
        self.0.set(self.0.get().saturating_sub(start.elapsed()));
        done
    }
}
