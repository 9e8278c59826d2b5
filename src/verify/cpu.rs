//! What the evaluator says of a shader: its picture in f32 and in f64, and which pixels do what GLSL leaves undefined.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::Case;
use crate::eval::{Failure, Jittered, Number, Observed, Painted, Program, Refusal, Seed, Settings};
use crate::image::Image;

/// When to give up.
#[derive(Clone, Copy)]
pub(super) struct Limits<'a> {
    /// For each picture.
    pub(super) each: Duration,
    /// Set when nobody wants the pictures any more.
    pub(super) stop: &'a AtomicBool,
}

/// Both pictures of a shader.
pub(super) struct Cpu {
    /// In f32: the same bits as a strict GPU run.
    pub(super) single: Image,
    /// In f64, rounded once at the end.
    pub(super) double: Image,
    /// Pixels that do what GLSL leaves undefined, in either.
    pub(super) undefined: Vec<bool>,
    /// What was noted in f32.
    pub(super) faults: Vec<Observed>,
    /// In how many pixels Mesa before 23 would end the loops.
    pub(super) beyond_cap: u64,
}

impl Cpu {
    /// Paints until `limits` end it.
    pub(super) fn paint(
        program: &Result<Program, Refusal>,
        case: &Case,
        limits: Limits,
    ) -> Result<Self, Failure> {
        let program = program.as_ref().map_err(|&refusal| refusal)?;
        let single = paint::<f32>(program, case, limits)?;
        let double = paint::<f64>(program, case, limits)?;
        let undefined = marks(&single).zip(marks(&double)).map(|(a, b)| a || b).collect();
        Ok(Self {
            single: single.painting.image(),
            double: double.painting.image(),
            undefined,
            faults: single.observations.faults,
            beyond_cap: single.observations.beyond_cap,
        })
    }
}

/// The picture in f64 with every operation moved by a unit in the last place or none; none if there is no time.
pub(super) fn shaken(program: &Program, case: &Case, seed: u64) -> Option<Image> {
    let settings = Settings::<Jittered> {
        observe: false,
        noise: Seed(seed),
        deadline: Some(Instant::now() + case.timeout),
        ..Settings::default()
    };
    let painted = program.paint(case.frame, &settings).ok()?;
    Some(painted.painting.image())
}

fn paint<N: Number>(program: &Program, case: &Case, limits: Limits) -> Result<Painted<N>, Failure> {
    let settings = Settings {
        deadline: Some(Instant::now() + limits.each),
        interrupt: Some(limits.stop),
        ..Settings::default()
    };
    program.paint(case.frame, &settings)
}

fn marks<N: Number>(painted: &Painted<N>) -> impl Iterator<Item = bool> {
    let [width, height] = painted.painting.size();
    (0..height).flat_map(move |y| (0..width).map(move |x| painted.painting.is_undefined(x, y)))
}
