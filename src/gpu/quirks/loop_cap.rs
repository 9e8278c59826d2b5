//! The number of iterations after which a driver silently terminates the loops of a pixel, and the
//! pixels whose loops it terminated: see [`LOOP_CAP`](super::LOOP_CAP).

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{File, Files};
use toyproof_glsl as glsl;
use toyproof_image::{Frame, Image};
use toyproof_translate::FloatMode;
use toyproof_translate::naga_ir::ValidModule;

use super::super::device::Device;
use super::super::draw::{CLEAR_COLOR, Program};
use super::super::{Failure, refused};

/// Whether a driver terminates the loops of an invocation after a number of iterations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LoopCap {
    /// No termination within this number of iterations.
    NoneUpTo(u32),
    /// Termination after this number of iterations.
    After(u32),
}

/// Number of iterations within which the loop cap is searched.
const PROBED_ITERATIONS: u32 = 70_000;

/// Maximum number of pixels that llvmpipe runs together, on the widest processors. It counts their iterations
/// as one.
const MAX_LAVAPIPE_LANES: u32 = 16;

/// Number of iterations, over all loops of a pixel, up to which no driver terminates it: Mesa before 23
/// allows 65,535 for all pixels that it runs together.
pub const SAFE_ITERATIONS: u32 = 65_535 / MAX_LAVAPIPE_LANES;

/// A shader for one pixel with `iFrame` iterations, whose output is the number of iterations that the driver
/// ran.
const LOOP_COUNT_SHADER: &str = "void mainImage(out vec4 c, in vec2 p) {
    float count = 0.0;
    for (int i = 0; i < iFrame; i++) count += 1.0;
    c = vec4(count);
}";

/// Measures whether the driver terminates long loops.
pub(crate) fn measure(device: &Device) -> Result<LoopCap, Failure> {
    let mut files = Files::default();
    let file = files.add(File::new("<loop cap>", LOOP_COUNT_SHADER));
    let checked = glsl::check(&files, file, &glsl::Options::default())
        .map_err(|errors| Failure::Invalid(errors.into()))?;
    let lowered = toyproof_translate::lower(&checked);
    let module = ValidModule::parse(&lowered).map_err(refused)?;
    let program = Program::new(&module, FloatMode::Strict)?;
    let frame = Frame {
        size: [1, 1],
        frame: PROBED_ITERATIONS as i32,
        ..Frame::default()
    };
    let count = device.render_image(&device.prepare(&program, &frame)?)?.get(0, 0)[0] as u32;
    Ok(if count < PROBED_ITERATIONS {
        LoopCap::After(count)
    } else {
        LoopCap::NoneUpTo(count)
    })
}

/// Returns whether a driver that stops after `cap` iterations may have stopped any pixel of an image whose
/// alpha is the number of iterations plus 1. An alpha that is not a valid count is suspect too.
pub(crate) fn may_reach(iterations: &Image, cap: u32) -> bool {
    let counts = 1.0..cap as f32 / MAX_LAVAPIPE_LANES as f32;
    let is_suspect = |alpha: f32| !counts.contains(&alpha) || alpha.fract() != 0.0;
    iterations.pixels().iter().any(|pixel| is_suspect(pixel[3]))
}

/// Counts the pixels of such an image that ran all iterations that the driver allows.
pub(crate) fn count_reached(iterations: &Image, cap: u32) -> u64 {
    iterations
        .pixels()
        .iter()
        .filter(|pixel| pixel[3] > cap as f32)
        .count() as u64
}

/// Counts the pixels of an image of the open-loops probe in which a loop was terminated. A pixel that nothing
/// was written to counts too, unless the shader discards: code after an endless loop may never be reached.
pub(crate) fn count_truncated(watched: &Image, discards: bool) -> u64 {
    let cleared = CLEAR_COLOR.a as f32;
    let is_truncated = |alpha: f32| alpha < cleared || (alpha <= cleared && !discards);
    watched
        .pixels()
        .iter()
        .filter(|pixel| is_truncated(pixel[3]))
        .count() as u64
}
