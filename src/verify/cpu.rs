//! What the evaluator says of a shader: its picture in f32 and in f64, and which pixels do what GLSL leaves undefined.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::Case;
use crate::eval::{
    Failure, Fault, Jittered, Number, Observed, Painted, Program, Refusal, Seed, Settings, Variant,
};
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
    /// Pixels whose colour hangs on what GLSL leaves undefined, in either.
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
        let single = paint::<f32>(program, case, limits, Variant::Observed)?;
        let double = paint::<f64>(program, case, limits, Variant::Observed)?;
        let undefined = undefined(program, case, limits, &single, &double);
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
        variant: Variant::Plain,
        noise: Seed(seed),
        deadline: Some(Instant::now() + case.timeout),
        ..Settings::default()
    };
    let painted = program.paint(case.frame, &settings).ok()?;
    Some(painted.painting.image())
}

/// The pixels whose colour depends on what GLSL leaves undefined. Where it is met and there is no time to find out, they all may.
fn undefined(
    program: &Program,
    case: &Case,
    limits: Limits,
    single: &Painted<f32>,
    double: &Painted<f64>,
) -> Vec<bool> {
    let (single, double) = (
        dependent(program, case, limits, single),
        dependent(program, case, limits, double),
    );
    single.into_iter().zip(double).map(|(a, b)| a || b).collect()
}

/// Of the pixels that are marked, those that are painted otherwise where another choice is taken.
fn dependent<N: Number>(program: &Program, case: &Case, limits: Limits, painted: &Painted<N>) -> Vec<bool> {
    let marks: Vec<bool> = marks(painted).collect();
    if !marks.contains(&true) {
        return marks;
    }
    let Ok(other) = paint::<N>(program, case, limits, Variant::Otherwise) else {
        return marks;
    };
    let is_lonely = |observed: &Observed| observed.site.fault == Fault::LonelyDerivative;
    if painted.observations.faults.iter().any(is_lonely) {
        // No choice stands for what a derivative might be.
        return marks;
    }
    let (usual, other) = (painted.painting.image(), other.painting.image());
    let pairs = usual.pixels().iter().zip(other.pixels());
    let moved = pairs.map(|(usual, other)| usual.map(f32::to_bits) != other.map(f32::to_bits));
    marks
        .into_iter()
        .zip(moved)
        .map(|(marked, moved)| marked && moved)
        .collect()
}

fn paint<N: Number>(
    program: &Program,
    case: &Case,
    limits: Limits,
    variant: Variant,
) -> Result<Painted<N>, Failure> {
    let settings = Settings {
        variant,
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
