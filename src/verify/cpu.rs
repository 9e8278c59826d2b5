//! What the evaluator says of a shader: its picture in f32 and in f64, and which pixels do what GLSL leaves undefined.

use std::sync::atomic::AtomicBool;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use super::Case;
use crate::eval::{
    Failure, Fault, Jittered, Number, Observations, Observed, Painted, Program, Refusal, Seed, Settings,
    Variant,
};
use crate::image::Image;

/// When to give up.
#[derive(Clone, Copy)]
pub(super) struct Limits<'a> {
    /// For each picture.
    pub(super) each: Duration,
    /// For all of them.
    pub(super) until: Instant,
    /// Set when nobody wants the pictures any more.
    pub(super) stop: &'a AtomicBool,
}

/// Told the most rounds of loops that a pixel ran in f32, as soon as they are known.
pub(super) type Counted = Sender<u32>;

/// What is known of a shader, beside its picture in f32.
pub(super) struct Cpu {
    /// In f64, rounded once at the end.
    pub(super) double: Image,
    /// Pixels whose colour hangs on what GLSL leaves undefined, in either.
    pub(super) undefined: Vec<bool>,
    /// What was noted in f32.
    pub(super) faults: Vec<Observed>,
    /// In how many pixels Mesa before 23 would end the loops.
    pub(super) beyond_cap: u64,
}

/// A picture in f32, and what is known of it.
pub(super) struct Single {
    pub(super) image: Image,
    /// Pixels whose colour hangs on what GLSL leaves undefined.
    pub(super) undefined: Vec<bool>,
    /// In how many pixels Mesa before 23 would end the loops.
    pub(super) beyond_cap: u64,
}

impl Single {
    /// Paints until `limits` end it, with the bits of a strict GPU run.
    pub(super) fn paint(program: &Program, case: &Case, limits: Limits) -> Result<Self, Failure> {
        let painted = paint::<f32>(program, case, limits, Variant::Observed)?;
        let beyond_cap = painted.observations.beyond_cap;
        let (image, undefined) = settled(program, case, limits, painted);
        Ok(Self {
            image,
            undefined,
            beyond_cap,
        })
    }
}

impl Cpu {
    /// Paints until `limits` end it. The picture in f32 has the bits of a strict GPU run.
    pub(super) fn paint(
        program: &Result<Program, Refusal>,
        case: &Case,
        limits: Limits,
        counted: Counted,
    ) -> Result<(Image, Self), Failure> {
        let program = program.as_ref().map_err(|&refusal| refusal)?;
        let single = paint::<f32>(program, case, limits, Variant::Observed)?;
        // Perhaps nobody asks.
        let _ = counted.send(single.observations.most_rounds);
        drop(counted);
        let Observations {
            faults, beyond_cap, ..
        } = single.observations.clone();
        let (single, mut undefined) = settled(program, case, limits, single);
        let double = paint::<f64>(program, case, limits, Variant::Observed)?;
        let (double, also) = settled(program, case, limits, double);
        for (undefined, also) in undefined.iter_mut().zip(also) {
            *undefined |= also;
        }
        let cpu = Self {
            double,
            undefined,
            faults,
            beyond_cap,
        };
        Ok((single, cpu))
    }
}

/// The picture in f64 with every operation moved by a unit in the last place or none; none if there is no time.
pub(super) fn shaken(program: &Program, case: &Case, until: Instant, seed: u64) -> Option<Image> {
    let settings = Settings::<Jittered> {
        variant: Variant::Plain,
        noise: Seed(seed),
        deadline: Some(until.min(Instant::now() + case.timeout)),
        ..Settings::default()
    };
    let painted = program.paint(case.frame, &settings).ok()?;
    Some(painted.painting.image())
}

/// A picture, and the pixels whose colour depends on what GLSL leaves undefined. Where it is met and there is no time to find out, they
/// all may. The painting itself is larger, and given up here.
fn settled<N: Number>(
    program: &Program,
    case: &Case,
    limits: Limits,
    painted: Painted<N>,
) -> (Image, Vec<bool>) {
    let image = painted.painting.image();
    let undefined = dependent(program, case, limits, &painted, &image);
    drop(painted);
    (image, undefined)
}

/// Of the pixels that are marked, those that are painted otherwise where another choice is taken.
fn dependent<N: Number>(
    program: &Program,
    case: &Case,
    limits: Limits,
    painted: &Painted<N>,
    usual: &Image,
) -> Vec<bool> {
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
    let other = other.painting.image();
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
        deadline: Some(limits.until.min(Instant::now() + limits.each)),
        interrupt: Some(limits.stop),
        ..Settings::default()
    };
    program.paint(case.frame, &settings)
}

fn marks<N: Number>(painted: &Painted<N>) -> impl Iterator<Item = bool> {
    let [width, height] = painted.painting.size();
    (0..height).flat_map(move |y| (0..width).map(move |x| painted.painting.is_undefined(x, y)))
}
