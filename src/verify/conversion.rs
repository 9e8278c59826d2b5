//! Is a converted shader what its author wrote? What was written is read again, run, and compared with the shader itself.
//!
//! The file keeps `sin` and the like, whose last bits WGSL and its relatives leave to whoever runs them. So the proof puts
//! definitions of our own in their place, the evaluator's, into what naga read; everything else is the file's. No tolerance is then needed:
//! a conversion is proved if every pixel has the evaluator's bits.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use toyproof_eval::{self as eval, Observed, Program};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::SamplerShape;
use toyproof_gpu::{self as gpu, Worker, Written};
use toyproof_image::{self as image, Frame, Image};
use toyproof_lint::Lints;
use toyproof_translate::FloatMode;

use super::cpu::{Evaluator, Single};
use super::{ALL, Case, Failure, PATIENCE, join, within};
use crate::compare::{self, Answer};

/// What came of running a converted shader.
#[derive(Debug, Clone)]
pub struct Proof {
    /// One comparison for each frame.
    pub answers: Vec<Answer>,
    /// Who painted.
    pub device: String,
    /// What it was compared with.
    pub against: Against,
    /// For each frame, which pixels hang on what GLSL leaves undefined.
    pub undefined_at: Vec<Vec<bool>>,
    /// Of the operations that GLSL leaves undefined, the one that most pixels of a frame met.
    pub undefined_by: Option<Observed>,
}

/// What a conversion is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Against {
    /// The evaluator's picture in f32.
    Evaluator,
    /// What the same driver paints of the shader itself, strictly: filters of textures differ from the evaluator's by 2e−7.
    StrictRun,
}

impl Proof {
    /// Whether every pixel has the same bits, and some are not left out.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.undefined() < self.pixels() && self.differing() == 0
    }

    /// Pixels of all frames.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        self.answers.iter().map(|answer| answer.pixels).sum()
    }

    /// Pixels that are not the same.
    #[must_use]
    pub fn differing(&self) -> u64 {
        self.answers.iter().map(|answer| answer.differing).sum()
    }

    /// Pixels that hang on what GLSL leaves undefined.
    #[must_use]
    pub fn undefined(&self) -> u64 {
        self.answers.iter().map(|answer| answer.undefined).sum()
    }
}

/// A frame that conversions are compared in.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `iTime`, in seconds.
    pub time: f32,
    frame: i32,
    mouse: [f32; 4],
    date: [f32; 4],
}

/// The frames that conversions are compared in: several times, sizes, mice and dates.
pub const FRAMES: [Moment; 3] = [
    Moment {
        size: [160, 90],
        time: 0.0,
        frame: 0,
        mouse: [0.0; 4],
        date: [0.0; 4],
    },
    Moment {
        size: [128, 128],
        time: 1.3,
        frame: 78,
        mouse: [37.0, 81.0, 37.0, 81.0],
        date: [2026.0, 4.0, 17.0, 43_200.0],
    },
    Moment {
        size: [90, 160],
        time: 10.7,
        frame: 642,
        mouse: [41.5, 30.5, -12.0, -5.0],
        date: [2026.0, 11.0, 2.0, 3_661.5],
    },
];

/// The frames for a shader, with noise in each of its channels that is flat.
#[must_use]
pub fn frames(checked: &Checked) -> Vec<Frame> {
    let channels = if checked.reads_textures() {
        checked
            .channels
            .map(|shape| (shape == SamplerShape::D2).then(image::noise))
    } else {
        [const { None }; 4]
    };
    let of = |moment: Moment| Frame {
        size: moment.size,
        time: moment.time,
        frame: moment.frame,
        mouse: moment.mouse,
        date: moment.date,
        channels: channels.clone(),
    };
    FRAMES.map(of).to_vec()
}

/// Runs each reading of what was written in each of the frames and compares it with the shader: a proof for each. The evaluator runs in
/// `pool`, if there is one: in the pool that all share, a slow shader's evaluator would have all of its rows painted before another's.
///
/// # Errors
/// Why one of them, or the shader itself, has no pictures.
pub fn prove(
    worker: &mut Worker,
    checked: &Checked,
    readings: Vec<Written>,
    frames: &[Frame],
    timeout: Duration,
    pool: Option<&ThreadPool>,
) -> Result<Vec<Proof>, Failure> {
    let stop = AtomicBool::new(false);
    let singles = || evaluate(checked, frames, timeout, &stop);
    let (painted, singles) = thread::scope(|scope| {
        let cpu = scope.spawn(|| within(pool, singles));
        let paint = |written| worker.paint(written, frames.to_vec());
        let painted: Result<Vec<_>, _> = readings.into_iter().map(paint).collect();
        stop.store(painted.is_err(), Ordering::Relaxed);
        (painted, join(cpu))
    });
    let painted = painted?;
    let singles = singles?;
    if let pixels @ 1.. = singles.iter().map(|single| single.noted.beyond_cap).sum::<u64>() {
        return Err(Failure::CutShort(pixels));
    }
    let (against, expected) = if checked.reads_textures() {
        let mut run = |frame: &Frame| {
            let lowered = FloatMode::Strict.lower(checked);
            let drawn = worker.draw_unwatched(lowered, frame.clone(), FloatMode::Strict)?;
            Ok(drawn.image())
        };
        let images: Result<Vec<Image>, gpu::Failure> = frames.iter().map(&mut run).collect();
        (Against::StrictRun, images?)
    } else {
        let images = singles.iter().map(|single| single.image.clone());
        (Against::Evaluator, images.collect())
    };
    let faults = singles.iter().flat_map(|single| &single.noted.faults);
    let undefined = faults.filter(|observed| observed.site.fault.is_undefined());
    let undefined_by = undefined.max_by_key(|observed| observed.pixels).copied();
    let proof = |(images, device): (Vec<Image>, String)| {
        let pictures = expected.iter().zip(&images).zip(&singles);
        let answers = pictures.map(|((expected, painted), single)| {
            let standings = compare::toolchain(expected, painted, &single.undefined);
            Answer::new(expected, painted, &standings)
        });
        Proof {
            answers: answers.collect(),
            device,
            against,
            undefined_at: singles.iter().map(|single| single.undefined.clone()).collect(),
            undefined_by,
        }
    };
    Ok(painted.into_iter().map(proof).collect())
}

/// What came of painting a conversion and its original by the same means, whose functions have last bits of their own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown {
    /// Pixels that were compared.
    pub pixels: u64,
    /// Pixels in which a colour, as shown, differs by more than 1/255.
    pub differing: u64,
    /// The largest difference of a colour as shown, between 0 and 1.
    pub max: f32,
}

impl Shown {
    /// Compares pictures of the same frames, but for the pixels that are left out.
    #[must_use]
    pub fn of(original: &[Image], converted: &[Image], left_out: &[Vec<bool>]) -> Self {
        let mut shown = Self {
            pixels: 0,
            differing: 0,
            max: 0.0,
        };
        for ((original, converted), left_out) in original.iter().zip(converted).zip(left_out) {
            let pixels = original.pixels().iter().zip(converted.pixels()).zip(left_out);
            for ((a, b), _) in pixels.filter(|(_, left_out)| !**left_out) {
                let apart = (0..3).map(|i| apart(a[i], b[i])).fold(0.0, f32::max);
                shown.pixels += 1;
                shown.differing += u64::from(apart > STEP);
                shown.max = shown.max.max(apart);
            }
        }
        shown
    }
}

/// The smallest difference that a screen shows, and as far as the last bits of two right programs may take a colour.
const STEP: f32 = 1.0 / 255.0;

/// How far two components are apart on a screen. One that is no number is like another, and as far from all others as can be.
fn apart(a: f32, b: f32) -> f32 {
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (a.clamp(0.0, 1.0) - b.clamp(0.0, 1.0)).abs(),
        _ => 1.0,
    }
}

fn evaluate(
    checked: &Checked,
    frames: &[Frame],
    timeout: Duration,
    stop: &AtomicBool,
) -> Result<Vec<Single>, eval::Failure> {
    let program = Program::new(checked)?;
    let single = |frame: &Frame| {
        let case = Case {
            checked,
            lints: &Lints::default(),
            expected: None,
            suspects: None,
            frame,
            float: FloatMode::Strict,
            timeout,
            pool: None,
        };
        let until = Instant::now() + timeout * ALL;
        Evaluator::new(&program, &case, timeout * PATIENCE, until, stop).single(&frame.rows())
    };
    frames.iter().map(single).collect()
}
