//! Runs a subject on the evaluator: one pixel per case, whose numbers are in the channels.

use std::time::{Duration, Instant};

use thiserror::Error;
use toyproof_diagnostic::{Diagnostic, File, Files};
use toyproof_eval::{self as eval, Arithmetic, Number, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::DriverFailure;

use crate::case::Case;

/// The width of the image, in cases: no device limits it, and images of many cases are nearly square.
const FRAME_WIDTH: usize = 512;

/// The reason why a subject could not be run.
#[derive(Debug, Error)]
pub enum RunError {
    /// The shader made for the subject does not compile.
    #[error("{}", first_message(.0))]
    Invalid(Vec<Diagnostic>),
    /// The evaluator failed.
    #[error(transparent)]
    Cpu(#[from] eval::Failure),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] DriverFailure),
    /// The user interrupted the run.
    #[error("interrupted")]
    Interrupted,
}

fn first_message(diagnostics: &[Diagnostic]) -> &str {
    diagnostics.first().map_or("", |first| &first.message)
}

/// A compiled shader that is run on the evaluator.
#[derive(Debug)]
pub struct ShaderRunner {
    pub(crate) checked: Checked,
    pub(crate) program: Program,
    pub(crate) deadline: Option<Instant>,
}

impl ShaderRunner {
    /// Compiles a shader. `timeout`: the time limit of its compilation, and of all of its runs together.
    ///
    /// # Errors
    ///
    /// If the shader is invalid, or cannot be compiled in time.
    pub fn new(text: &str, options: &glsl::Options, timeout: Option<Duration>) -> Result<Self, RunError> {
        let mut files = Files::default();
        let file = files.add(File::new("<stress>", text));
        let checked =
            glsl::check(&files, file, options).map_err(|errors| RunError::Invalid(errors.into()))?;
        let program = Program::prepared_within(&checked, UndefinedPolicy::Plain, timeout);
        Ok(Self {
            checked,
            program: program.map_err(eval::Failure::from)?,
            deadline: timeout.map(|timeout| Instant::now() + timeout),
        })
    }

    /// Runs the shader, and returns the colors of all pixels, row by row from the bottom.
    ///
    /// # Errors
    ///
    /// If the evaluator fails, or the time is up.
    pub fn colors<N: Number>(&self, frame: &Frame) -> Result<Vec<[f64; 3]>, RunError> {
        self.colors_with::<N>(frame, N::Noise::default(), self.deadline)
    }

    /// The same with a seed of random rounding, which other number types ignore, and another deadline.
    pub(crate) fn colors_with<N: Number>(
        &self,
        frame: &Frame,
        noise: N::Noise,
        deadline: Option<Instant>,
    ) -> Result<Vec<[f64; 3]>, RunError> {
        let settings = eval::Settings::<N> {
            undefined: UndefinedPolicy::Plain,
            noise,
            deadline,
            ..eval::Settings::default()
        };
        let framebuffer = self.program.render(frame, &settings)?.framebuffer;
        let [width, height] = frame.size;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let colors = places.map(|(x, y)| framebuffer.get(x, y).map(Arithmetic::to_f64));
        Ok(colors.collect())
    }
}

/// A frame whose channels hold the cases: one per pixel, then padding.
pub(crate) fn case_frame(cases: &[Case]) -> Frame {
    let width = cases.len().clamp(1, FRAME_WIDTH);
    let height = cases.len().div_ceil(width).max(1);
    let channel = |i: usize| {
        let mut pixels: Vec<_> = cases.iter().map(|case| case.texels()[i]).collect();
        pixels.resize(width * height, [0.0; 4]);
        Texture::from(Image::new(width as u32, height as u32, pixels))
    };
    Frame {
        size: [width as u32, height as u32],
        channels: [0, 1, 2, 3].map(|at| (at < 3).then(|| channel(at))),
        ..Frame::default()
    }
}
