//! What the evaluator says of a shader: its picture in f32 and in f64, and which pixels do what GLSL leaves undefined.

use std::cell::Cell;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof_eval::{
    Failure, Fault, Jittered, Number, Observations, Observed, Other, Pictured, Program, Seed, Settings,
    Variant,
};
use toyproof_image::Image;

use super::{Case, PATIENCE};

/// Paints a shader, one band of rows after the other.
pub(super) struct Evaluator<'a> {
    program: &'a Program,
    case: &'a Case<'a>,
    /// Set when nobody wants the pictures any more.
    stop: &'a AtomicBool,
    /// When all of them must be there.
    until: Instant,
    /// For the pictures in f32 and in f64, each with the usual choices and others.
    single: [Allowance; 2],
    double: [Allowance; 2],
    /// For all that are shaken.
    shaken: Allowance,
}

/// How long a picture may still take, all bands together.
struct Allowance(Cell<Duration>);

/// What the evaluator painted of a band.
pub(super) struct Band {
    /// In f32, with the bits of a strict GPU run.
    pub(super) single: Image,
    /// In f64, rounded once at the end.
    pub(super) double: Image,
    /// Pixels whose colour hangs on what GLSL leaves undefined, in either.
    pub(super) undefined: Vec<bool>,
    /// What was noted in f32.
    pub(super) noted: Observations,
}

/// A picture in f32, and what is known of it.
pub(super) struct Single {
    pub(super) image: Image,
    /// Pixels whose colour hangs on what GLSL leaves undefined.
    pub(super) undefined: Vec<bool>,
    /// What was noted.
    pub(super) noted: Observations,
}

impl<'a> Evaluator<'a> {
    /// Each picture may take that long, but all must be there by `until`.
    pub(super) fn new(
        program: &'a Program,
        case: &'a Case<'a>,
        each: Duration,
        until: Instant,
        stop: &'a AtomicBool,
    ) -> Self {
        let pair = || [Allowance::new(each), Allowance::new(each)];
        Self {
            program,
            case,
            stop,
            until,
            single: pair(),
            double: pair(),
            shaken: Allowance::new(case.timeout * PATIENCE),
        }
    }

    pub(super) fn program(&self) -> &'a Program {
        self.program
    }

    /// Paints some rows in f32 alone.
    pub(super) fn single(&self, rows: &Range<u32>) -> Result<Single, Failure> {
        let painted = self.picture::<f32>(rows, Variant::Observed, &self.single[0])?;
        let undefined = self.dependent::<f32>(rows, &painted, &self.single[1]);
        Ok(Single {
            image: painted.image,
            undefined,
            noted: painted.observations,
        })
    }

    /// Paints some rows; `counted` is told the most rounds of loops that a pixel ran in f32, as soon as they are known.
    pub(super) fn paint(&self, rows: &Range<u32>, counted: impl FnOnce(u32)) -> Result<Band, Failure> {
        let single = self.picture::<f32>(rows, Variant::Observed, &self.single[0])?;
        counted(single.observations.most_rounds);
        let mut undefined = self.dependent::<f32>(rows, &single, &self.single[1]);
        let double = self.picture::<f64>(rows, Variant::Observed, &self.double[0])?;
        let also = self.dependent::<f64>(rows, &double, &self.double[1]);
        for (undefined, also) in undefined.iter_mut().zip(also) {
            *undefined |= also;
        }
        Ok(Band {
            single: single.image,
            double: double.image,
            undefined,
            noted: single.observations,
        })
    }

    /// The picture in f64 with every operation moved by a unit in the last place or none, at least where it is wanted; none if there is no
    /// time.
    pub(super) fn shaken(&self, rows: &Range<u32>, seed: u64, wanted: &[bool]) -> Option<Image> {
        self.shaken.spend(self.until, |deadline| {
            let settings = Settings::<Jittered> {
                variant: Variant::Plain,
                noise: Seed(seed),
                deadline: Some(deadline),
                wanted: Some(wanted),
                ..Settings::default()
            };
            let painted = self.program.picture(self.case.frame, rows.clone(), &settings);
            painted.ok().map(|painted| painted.image)
        })
    }

    /// Of the pixels that met what GLSL leaves undefined, those that are painted otherwise where another choice is taken. Where there is no
    /// time to find out, they all may.
    fn dependent<N: Number>(&self, rows: &Range<u32>, usual: &Pictured, allowance: &Allowance) -> Vec<bool> {
        let met = usual.undefined.clone();
        let is_lonely = |observed: &Observed| observed.site.fault == Fault::LonelyDerivative;
        // No choice stands for what a derivative might be.
        if !met.contains(&true) || usual.observations.faults.iter().any(is_lonely) {
            return met;
        }
        let mut undefined = vec![false; met.len()];
        for other in [Other::Number, Other::NotANumber] {
            if undefined == met {
                break;
            }
            let Ok(other) = self.picture::<N>(rows, Variant::Otherwise(other), allowance) else {
                return met;
            };
            let pairs = usual.image.pixels().iter().zip(other.image.pixels());
            for ((undefined, met), (usual, other)) in undefined.iter_mut().zip(&met).zip(pairs) {
                *undefined |= *met && usual.map(f32::to_bits) != other.map(f32::to_bits);
            }
        }
        undefined
    }

    fn picture<N: Number>(
        &self,
        rows: &Range<u32>,
        variant: Variant,
        allowance: &Allowance,
    ) -> Result<Pictured, Failure> {
        allowance.spend(self.until, |deadline| {
            let settings = Settings::<N> {
                variant,
                deadline: Some(deadline),
                interrupt: Some(self.stop),
                ..Settings::default()
            };
            self.program.picture(self.case.frame, rows.clone(), &settings)
        })
    }
}

impl Allowance {
    fn new(time: Duration) -> Self {
        Self(Cell::new(time))
    }

    /// Does something that ends at a deadline, which is `until` at the latest; what it took is gone.
    fn spend<T>(&self, until: Instant, work: impl FnOnce(Instant) -> T) -> T {
        let start = Instant::now();
        let done = work(until.min(start + self.0.get()));
        self.0.set(self.0.get().saturating_sub(start.elapsed()));
        done
    }
}
