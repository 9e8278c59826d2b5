//! Evaluation of a frame, or of a part of it, on all cores, in each number type.

use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
use toyproof_image::Frame;

use crate::exec::frame::target_color;
use crate::exec::isel::FrameCode;
use crate::exec::limits::{Failure, Limits};
use crate::exec::native::Executable;
use crate::exec::number::{Arithmetic, RandomRounding};
use crate::exec::observe::Observations;
use crate::exec::places::Part;
use crate::exec::recorder::{ExecutionTrace, ForcedPrefix};
use crate::exec::settings::Settings;
use crate::exec::tile::FrameJob;
use crate::exec::wide::Wide;
use crate::lower::LoweredCode;

/// Where a part of a frame is rendered to.
pub enum Pixels<'a, N> {
    /// Colors as in the GPU's render target, rounded to f32.
    Rounded(&'a mut [[f32; 4]]),
    /// Colors in the number type.
    Own(&'a mut [[N; 4]]),
}

/// Declares [`Number`], and implements it for each type: default methods would be instantiated in each crate
/// that uses them, not once in this one.
macro_rules! numbers {
    (
        $($number:ty),*;
        $($(#[$attribute:meta])* fn $name:ident($($argument:ident: $ty:ty),*) -> $result:ty $body:block)*
    ) => {
        /// A number type that a shader can be evaluated in.
        pub trait Number: Arithmetic {
            $($(#[$attribute])* fn $name($($argument: $ty),*) -> $result;)*
        }
        numbers!(@ $($number)*; {$(fn $name($($argument: $ty),*) -> $result $body)*});
    };
    (@ $($number:ty)*; $methods:tt) => {
        $(impl Number for $number $methods)*
    };
}
numbers! {
    f32, f64, RandomRounding, Wide;

    /// Selects the instructions for a frame.
    #[doc(hidden)]
    fn select(lowered: &LoweredCode, frame: &Frame) -> FrameCode<Self> {
        FrameCode::select(lowered, frame)
    }

    /// Renders a part of a frame.
    #[doc(hidden)]
    fn fill(
        executable: &Executable,
        frame: &Frame,
        part: Part<'_>,
        settings: &Settings<'_, Self>,
        pixels: Pixels<'_, Self>,
        flags: &mut [u8]
    ) -> Result<Observations, Failure> {
        match pixels {
            Pixels::Rounded(pixels) => {
                fill(executable, frame, part, settings, (pixels, flags), target_color)
            }
            Pixels::Own(pixels) => fill(executable, frame, part, settings, (pixels, flags), |color, _| color),
        }
    }

    /// Records the trace of a pixel.
    #[doc(hidden)]
    fn trace(
        lowered: &LoweredCode,
        code: &FrameCode<Self>,
        frame: &Frame,
        settings: &Settings<'_, Self>,
        pixel: [u32; 2],
        prefix: Option<ForcedPrefix<'_>>
    ) -> Result<ExecutionTrace, Failure> {
        let limits = Limits::new(settings);
        let job = FrameJob::new(lowered, code, &frame.channels, &limits, settings, frame.size);
        job.trace(pixel, prefix)
            .map_err(|end| end.failure(lowered, &limits, settings.max_iterations))
    }
}

/// Renders a part; `keep` converts the color and flags of each pixel to its stored value.
fn fill<N: Number, P: Send>(
    executable: &Executable,
    frame: &Frame,
    part: Part<'_>,
    settings: &Settings<'_, N>,
    (pixels, flags): (&mut [P], &mut [u8]),
    keep: impl Fn([N; 4], u8) -> P + Sync,
) -> Result<Observations, Failure> {
    let lowered = &executable.lowered;
    let code = N::select(lowered, frame);
    let limits = Limits::new(settings);
    let (size, start, places) = match part {
        Part::Rows(rows) => ([frame.size[0], rows.end], rows.start, None),
        Part::Places(places) => (places.size(), 0, Some(places)),
    };
    let job = FrameJob::new(lowered, &code, &frame.channels, &limits, settings, size)
        .at(places)
        .with_native(executable.native.as_deref());
    let failure = Mutex::new(None);
    let band = size[0] as usize * job.rows();
    let bands = pixels.par_chunks_mut(band).zip(flags.par_chunks_mut(band));
    let observed = bands.enumerate().map_init(
        || job.batch(),
        |batch, (tiles, (pixels, flags))| {
            let first = start + (tiles * job.rows()) as u32;
            let wanted = settings
                .wanted
                .map(|wanted| &wanted[tiles * band..][..pixels.len()]);
            let rendered = job.render_band(batch, first, (pixels, flags), wanted, &keep);
            rendered.unwrap_or_else(|error| {
                limits.failed.store(true, Ordering::Relaxed);
                failure
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .get_or_insert(error);
                Observations::default()
            })
        },
    );
    let observations = observed.reduce(Observations::default, |mut all, part| {
        all.merge(&part);
        all
    });
    match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error.failure(lowered, &limits, settings.max_iterations)),
        None => Ok(observations),
    }
}
