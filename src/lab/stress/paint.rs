//! Running a subject on cases: a pixel for each, its numbers in the channels.

use thiserror::Error;
use toyproof_diagnostic::{Diagnostic, File, Files};
use toyproof_eval::{self as eval, Number, Program, Settings, Variant};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::{self as gpu, Worker};
use toyproof_image::{Frame, Image};
use toyproof_translate::FloatMode;

use super::axis::Case;
use super::formula::Subject;

/// Cases in a row of the picture.
const WIDTH: usize = 512;

/// Why a subject could not be run.
#[derive(Debug, Error)]
pub enum Failure {
    /// What was made of it does not compile.
    #[error("{}", first(.0))]
    Invalid(Vec<Diagnostic>),
    /// The evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] gpu::Failure),
    /// The user stopped it.
    #[error("interrupted")]
    Interrupted,
}

fn first(diagnostics: &[Diagnostic]) -> &str {
    diagnostics.first().map_or("", |first| &first.message)
}

/// The shader of a subject.
pub(super) fn checked(subject: &Subject) -> Result<Checked, Failure> {
    let mut files = Files::default();
    let file = files.add(File::new("<stress>", subject.text.as_str()));
    glsl::check(&files, file, &subject.options).map_err(Failure::Invalid)
}

/// The frame whose channels hold the cases.
pub(super) fn frame(cases: &[Case]) -> Frame {
    let width = cases.len().clamp(1, WIDTH);
    let height = cases.len().div_ceil(width).max(1);
    let channel = |i: usize| {
        let mut pixels: Vec<_> = cases.iter().map(|case| case.texels()[i]).collect();
        pixels.resize(width * height, [0.0; 4]);
        Some(Image::new(width as u32, height as u32, pixels))
    };
    Frame {
        size: [width as u32, height as u32],
        channels: [channel(0), channel(1), channel(2), None],
        ..Frame::default()
    }
}

/// What a shader leaves for each case: the colours of the pixels, in their order; more of them than cases.
pub(super) fn on_cpu<N: Number>(program: &Program, frame: &Frame) -> Result<Vec<[f64; 3]>, Failure> {
    let settings = Settings::<N> {
        variant: Variant::Plain,
        ..Settings::default()
    };
    let painting = program.paint(frame, &settings)?.painting;
    let [width, height] = frame.size;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Ok(places
        .map(|(x, y)| painting.get(x, y).map(Number::to_f64))
        .collect())
}

/// The same on a GPU; and its name.
pub(super) fn on_gpu(
    worker: &mut Worker,
    checked: &Checked,
    frame: &Frame,
    float: FloatMode,
) -> Result<(Vec<[f64; 3]>, String), Failure> {
    let drawn = worker.draw_unwatched(float.lower(checked), frame.clone(), float)?;
    let device = drawn.device.clone();
    let picture = drawn.image();
    let colors = picture.pixels().iter();
    let colors = colors.map(|&[r, g, b, _]| [r, g, b].map(f64::from));
    Ok((colors.collect(), device))
}
