//! Runs a converted shader, and compares it with the original in every frame.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use rayon::ThreadPool;
use toyproof_diagnostic::{Deadline, File, Files, short};
use toyproof_eval::{self as eval, Observed, Refusal};
use toyproof_eval_native::Program;
use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{self as glsl, Checked, Dialect, Stage};
use toyproof_gpu::{ShaderArtifact, Worker};
use toyproof_image::{self as image, Frame, Image, Texture, cube};
use toyproof_translate::FloatMode;
use toyproof_verify::compare::{self, CheckSummary};
use toyproof_verify::evaluator::{Evaluation, Evaluator};
use toyproof_verify::{EVALUATOR_TIME_FACTOR, Failure, join, within};

use super::prover::ProofError;

/// The device that runs a converted shader.
#[derive(Debug)]
pub enum Runner<'a> {
    /// A Vulkan driver, in a worker process.
    Driver(&'a mut Worker),
    /// The evaluator, which runs the GLSL that naga makes of the file. naga runs in the worker process if there
    /// is one; otherwise in this process and without a time limit, so the shader should be a trusted one.
    Evaluator(Option<&'a mut Worker>),
}

/// The result of running a converted shader.
#[derive(Debug, Clone)]
pub struct Proof {
    /// One comparison for each frame.
    pub frames: Vec<CheckSummary>,
    /// The device that rendered it.
    pub device: String,
    /// The reference.
    pub against: ProofReference,
    /// The pixels of each frame that depend on undefined behavior.
    pub undefined_at: Vec<Vec<bool>>,
    /// The undefined operation that occurs in most pixels of a frame.
    pub undefined_by: Option<Observed>,
}

/// The reference of a conversion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProofReference {
    /// The evaluator's image in f32.
    Evaluator,
    /// The image of the original shader by the same driver, strictly: texture filters differ from the
    /// evaluator's by 2e−7.
    StrictRun,
}

impl Proof {
    /// Whether every pixel has the same bits, and some pixel is compared.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.undefined() < self.pixels() && self.differing() == 0
    }

    /// The number of pixels of all frames.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        self.frames.iter().map(|summary| summary.pixels).sum()
    }

    /// The number of pixels that have the same bits.
    #[must_use]
    pub fn equal(&self) -> u64 {
        self.pixels() - self.undefined() - self.differing()
    }

    /// The largest difference of a component.
    #[must_use]
    pub fn max_abs(&self) -> f64 {
        self.frames
            .iter()
            .map(|summary| summary.max_abs)
            .fold(0.0, f64::max)
    }

    /// The number of pixels that differ.
    #[must_use]
    pub fn differing(&self) -> u64 {
        self.frames.iter().map(|summary| summary.differing).sum()
    }

    /// The number of pixels that depend on undefined behavior.
    #[must_use]
    pub fn undefined(&self) -> u64 {
        self.frames.iter().map(|summary| summary.undefined).sum()
    }
}

/// A frame that conversions are compared in.
#[derive(Debug, Clone, Copy)]
pub struct TestFrame {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `iTime`, in seconds.
    pub time: f32,
    frame: i32,
    mouse: [f32; 4],
    date: [f32; 4],
}

/// The frames that conversions are compared in: several times, sizes, mice and dates.
pub const FRAMES: [TestFrame; 3] = [
    TestFrame {
        size: [160, 90],
        time: 0.0,
        frame: 0,
        mouse: [0.0; 4],
        date: [0.0; 4],
    },
    TestFrame {
        size: [128, 128],
        time: 1.3,
        frame: 78,
        mouse: [37.0, 81.0, 37.0, 81.0],
        date: [2026.0, 4.0, 17.0, 43_200.0],
    },
    TestFrame {
        size: [90, 160],
        time: 10.7,
        frame: 642,
        // As compute.toys provides it: whole pixels, and the position of the click is not known.
        mouse: [41.0, 30.0, -41.0, -30.0],
        date: [2026.0, 11.0, 2.0, 3_661.5],
    },
];

/// Returns the frames for a shader, with noise in each of its channels.
#[must_use]
pub fn frames(checked: &Checked) -> Vec<Frame> {
    let channels = if checked.reads_textures() {
        std::array::from_fn(|channel| Some(noise(checked.channels[channel], channel)))
    } else {
        [const { None }; 4]
    };
    let frame = |test_frame: TestFrame| Frame {
        size: test_frame.size,
        time: test_frame.time,
        frame: test_frame.frame,
        mouse: test_frame.mouse,
        date: test_frame.date,
        channels: channels.clone(),
        ..Frame::default()
    };
    FRAMES.map(frame).to_vec()
}

/// A texture of this shape, in which no two faces or slices are equal. The sides of a volume differ, so that
/// its axes do. Textures of other numbers have other sizes and texels, so that no two can be confused.
pub(crate) fn noise(shape: SamplerShape, number: usize) -> Texture {
    let noise = image::noise();
    let [width, height] = noise.size();
    let mut pixels = noise.pixels().to_vec();
    pixels.rotate_left(37 * (number % 256));
    let noise = Image::new(width, height, pixels);
    let less = (number % 16) as u32;
    match shape {
        SamplerShape::D2 | SamplerShape::D2Array => noise.cropped([width - less, height]).into(),
        SamplerShape::Cube => Texture::cube(&noise.cropped([32 - less, (32 - less) * cube::FACES])),
        SamplerShape::D3 => Texture::volume(noise.cropped([32 - less, 16 * 8]), 16),
    }
}

/// Renders the artifacts of a converted shader in each of the frames, and compares them with the shader: a
/// proof for each artifact. `timeout` is the time limit of an image. The evaluator runs in `pool`, if there
/// is one: in rayon's global pool, all rows of a slow shader could run before another shader's.
///
/// # Errors
/// Returns why one of them, or the shader itself, has no images.
pub fn compare_with_original(
    runner: &mut Runner,
    checked: &Checked,
    artifacts: Vec<ShaderArtifact>,
    frames: &[Frame],
    timeout: Duration,
    pool: Option<&ThreadPool>,
) -> Result<Vec<Proof>, ProofError> {
    let stop = AtomicBool::new(false);
    let singles = || evaluate(checked, frames, timeout, &stop);
    let (rendered, singles) = thread::scope(|scope| {
        let cpu = scope.spawn(|| within(pool, singles));
        let render = |artifact| runner.render((checked, artifact), frames, timeout, pool);
        let rendered: Result<Vec<_>, _> = artifacts.into_iter().map(render).collect();
        stop.store(rendered.is_err(), Ordering::Relaxed);
        (rendered, join(cpu))
    });
    let rendered = rendered?;
    let singles = singles?;
    if let pixels @ 1.. = singles
        .iter()
        .map(|single| single.observed.beyond_cap)
        .sum::<u64>()
    {
        return Err(Failure::LoopTruncated(pixels).into());
    }
    let (against, expected) = match runner {
        Runner::Driver(worker) if checked.reads_textures() => (
            ProofReference::StrictRun,
            strict_images(worker, checked, frames, timeout)?,
        ),
        _ => {
            let images = singles.iter().map(|single| single.image.clone());
            (ProofReference::Evaluator, images.collect())
        }
    };
    let faults = singles.iter().flat_map(|single| &single.observed.faults);
    let undefined = faults.filter(|observed| observed.site.fault.is_undefined());
    let undefined_by = undefined.max_by_key(|observed| observed.pixels).copied();
    let proof = |(images, device): (Vec<Image>, String)| {
        let images = expected.iter().zip(&images).zip(&singles);
        let summaries = images.map(|((expected, rendered), single)| {
            let statuses = compare::toolchain(expected, rendered, &single.undefined);
            CheckSummary::new(expected, rendered, &statuses)
        });
        Proof {
            frames: summaries.collect(),
            device,
            against,
            undefined_at: singles.iter().map(|single| single.undefined.clone()).collect(),
            undefined_by,
        }
    };
    Ok(rendered.into_iter().map(proof).collect())
}

/// The visible differences between a conversion and its original on the same device, whose functions have
/// their own last bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rgb8Comparison {
    /// The number of pixels that were compared.
    pub pixels: u64,
    /// The number of pixels in which a color, as shown, differs by more than 1/255.
    pub differing: u64,
    /// The largest difference of a color as shown, between 0 and 1.
    pub max: f32,
}

impl Rgb8Comparison {
    /// Compares images of the same frames, except the excluded pixels.
    #[must_use]
    pub fn new(original: &[Image], converted: &[Image], excluded: &[Vec<bool>]) -> Self {
        let mut shown = Self {
            pixels: 0,
            differing: 0,
            max: 0.0,
        };
        for ((original, converted), excluded) in original.iter().zip(converted).zip(excluded) {
            let pixels = original.pixels().iter().zip(converted.pixels()).zip(excluded);
            for ((a, b), _) in pixels.filter(|(_, excluded)| !**excluded) {
                let difference = (0..3).map(|i| difference(a[i], b[i])).fold(0.0, f32::max);
                shown.pixels += 1;
                shown.differing += u64::from(difference > LEVEL);
                shown.max = shown.max.max(difference);
            }
        }
        shown
    }

    /// Includes the comparison of other frames.
    pub(super) fn add(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.differing += other.differing;
        self.max = self.max.max(other.max);
    }
}

/// The smallest difference that a screen shows; the last bits of two correct programs may change a color by
/// as much.
const LEVEL: f32 = 1.0 / 255.0;

/// The difference of two components on a screen. NaN equals NaN, and differs from all numbers by 1.
fn difference(a: f32, b: f32) -> f32 {
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (a.clamp(0.0, 1.0) - b.clamp(0.0, 1.0)).abs(),
        _ => 1.0,
    }
}

/// The name of the evaluator as a device.
pub(super) const EVALUATOR: &str = "toyproof's evaluator";

impl Runner<'_> {
    /// Renders the frames of a converted shader; returns the images and the name of the device.
    fn render(
        &mut self,
        (original, artifact): (&Checked, ShaderArtifact),
        frames: &[Frame],
        timeout: Duration,
        pool: Option<&ThreadPool>,
    ) -> Result<(Vec<Image>, String), ProofError> {
        match self {
            Self::Driver(worker) => {
                let rendered = worker.render(artifact, original.sampling, frames.to_vec());
                Ok(rendered.map_err(Failure::Gpu)?)
            }
            Self::Evaluator(_) => {
                let upside_down = artifact.is_upside_down();
                let written = self.read(artifact, original, timeout)?;
                let stop = AtomicBool::new(false);
                let singles = within(pool, || evaluate(&written, frames, timeout, &stop))?;
                let images = singles.into_iter().map(|single| {
                    if upside_down {
                        single.image.upside_down()
                    } else {
                        single.image
                    }
                });
                Ok((images.collect(), EVALUATOR.to_owned()))
            }
        }
    }

    /// Reads the artifact of a converted shader for the evaluator.
    pub(super) fn read(
        &mut self,
        artifact: ShaderArtifact,
        original: &Checked,
        timeout: Duration,
    ) -> Result<Checked, ProofError> {
        let text = match self {
            Self::Driver(worker) | Self::Evaluator(Some(worker)) => worker.rewrite(artifact),
            Self::Evaluator(None) => artifact.as_shadertoy(),
        };
        read_shadertoy(&text.map_err(Failure::Gpu)?, original, original.stage, timeout)
    }
}

/// Reads a converted shader, as `ShaderToy` would run it with the original's textures, with our own front end.
pub(super) fn read_shadertoy(
    text: &str,
    original: &Checked,
    stage: Stage,
    timeout: Duration,
) -> Result<Checked, ProofError> {
    let options = glsl::Options {
        stage,
        channels: original.channels.map(Some),
        sampling: original.sampling,
        ..glsl::Options::default()
    };
    read(text, options, timeout)
}

/// Reads a shader that was written for another host, with the original's textures and values of uniforms.
pub(super) fn read_glsl(
    text: &str,
    original: &Checked,
    dialect: Dialect,
    timeout: Duration,
) -> Result<Checked, ProofError> {
    let options = glsl::Options {
        dialect: Some(dialect),
        lenient: false,
        ..original.options()
    };
    read(text, options, timeout)
}

fn read(text: &str, options: glsl::Options, timeout: Duration) -> Result<Checked, ProofError> {
    let mut files = Files::default();
    let file = files.add(File::new("written", text));
    let options = glsl::Options {
        deadline: Deadline::after(timeout),
        ..options
    };
    glsl::check(&files, file, &options).map_err(|errors| {
        if let Err(overdue) = options.deadline.check() {
            return ProofError::Overdue(overdue);
        }
        let first = errors.first().map(|error| short(error, &files));
        ProofError::FrontEnd(first.unwrap_or_default())
    })
}

/// The original, rendered strictly by the same driver.
fn strict_images(
    worker: &mut Worker,
    checked: &Checked,
    frames: &[Frame],
    timeout: Duration,
) -> Result<Vec<Image>, Failure> {
    let lowered = FloatMode::Strict.lower_for_host(checked, &Deadline::after(timeout))?;
    let image = |frame: &Frame| -> Result<Image, Failure> {
        let drawn = worker.draw_unwatched(lowered.clone(), frame.clone(), FloatMode::Strict)?;
        Ok(drawn.image())
    };
    frames.iter().map(image).collect()
}

/// Why there is no program for the evaluator.
pub(super) fn refused(refusal: Refusal) -> Failure {
    match refusal {
        Refusal::TooSlow(overdue) => Failure::Overdue(overdue),
        refusal => Failure::Cpu(eval::Failure::from(refusal)),
    }
}

/// Evaluates the shader in every frame.
pub(super) fn evaluate(
    checked: &Checked,
    frames: &[Frame],
    timeout: Duration,
    stop: &AtomicBool,
) -> Result<Vec<Evaluation>, Failure> {
    let program = Program::within(checked, timeout * EVALUATOR_TIME_FACTOR).map_err(refused)?;
    let single = |frame: &Frame| -> Result<Evaluation, Failure> {
        let evaluator = Evaluator::new(&program, frame, timeout * EVALUATOR_TIME_FACTOR, stop);
        Ok(evaluator.single(&frame.rows())?)
    };
    frames.iter().map(single).collect()
}
