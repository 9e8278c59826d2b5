//! Whether two shaders compute the same bits in strict float32, over frames and passes, and where they first
//! differ. Both are evaluated on the CPU with the same inputs, from the first frame on.
//!
//! ```
//! use std::time::Duration;
//!
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_explain::equality::Pair;
//! use toyproof_image::Frame;
//! use toyproof_player::{Graph, Pass, Target};
//! use toyproof_verify::project::bind::clock;
//! use toyproof_verify::project::playback::PassShader;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut files = Files::default();
//! let mut checked = |name: &str, color: &str| {
//!     let text = format!("void mainImage(out vec4 c, in vec2 p) {{ c = {color}; }}");
//!     let file = files.add(File::new(name, &*text));
//!     toyproof_glsl::check(&files, file, &Default::default())
//! };
//! let (a, b) = (checked("a.glsl", "vec4(p.x / 8.0)")?, checked("b.glsl", "vec4(p.x * .125)")?);
//! let image = Pass { target: Target::Image, inputs: [None; 4] };
//! let graph = Graph::new(vec![image], Default::default());
//! let [a, b] = [&a, &b].map(|checked| PassShader {
//!     checked: vec![checked],
//!     graph: &graph,
//!     media: &[],
//!     films: Default::default(),
//! });
//! let pair = Pair::new([&a, &b], Duration::from_secs(60))?;
//! let clock = clock(&Frame { size: [8, 8], ..Frame::default() });
//! assert!(pair.first_difference(&clock, 0..=3, |_| {})?.is_none());
//! # Ok(())
//! # }
//! ```

use std::ops::{ControlFlow, RangeInclusive};
use std::time::{Duration, Instant};

use thiserror::Error;
use toyproof_diagnostic::Span;
use toyproof_eval::{self as eval, EventKind, PassFailure, Settings, TraceEvent};
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{Clock, Target};
use toyproof_verify::project::bind::has_history;
use toyproof_verify::project::playback::{CpuPlayback, PassShader};

use crate::departure;

/// Two compiled shaders.
#[derive(Debug)]
pub struct Pair<'a> {
    shaders: [&'a PassShader<'a>; 2],
    programs: [Vec<Program>; 2],
    timeout: Duration,
}

/// Why a shader of a pair is not rendered.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{failure}")]
pub struct PairFailure {
    /// The number of the shader: 0 or 1.
    pub shader: usize,
    /// The pass.
    pub target: Target,
    /// The reason.
    pub failure: eval::Failure,
}

/// The first difference of two shaders: of the first frame and pass in which they differ, the first pixel,
/// lowest y, then lowest x.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstDifference {
    /// The frame.
    pub frame: i32,
    /// The pass.
    pub target: Target,
    /// The pixel, from the left and from the bottom.
    pub pixel: [u32; 2],
    /// The color in each shader; its alpha is 1 in images.
    pub colors: [[f32; 4]; 2],
    /// The number of pixels of this pass and frame that differ.
    pub differing: u64,
    /// The number of its pixels.
    pub pixels: u64,
    /// Where the difference arises in each shader; `None` if that was not found within the time limit.
    pub origins: [Option<Origin>; 2],
}

/// Where a difference arises in a shader.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// The statement or expression.
    pub span: Span,
    /// The components of its value.
    pub value: Vec<f64>,
    /// Whether the other shader does not compute this value in the pixel; else, this is the last assignment.
    pub is_unknown: bool,
}

impl<'a> Pair<'a> {
    /// Compiles two shaders. `timeout` is the time limit for compiling each pass, for each frame and for the
    /// search for the origin of a difference.
    ///
    /// # Errors
    /// If a pass is too large.
    pub fn new(shaders: [&'a PassShader<'a>; 2], timeout: Duration) -> Result<Self, PairFailure> {
        let programs = |shader: usize| {
            let compiled = shaders[shader].programs(timeout);
            compiled.map_err(|(pass, refusal)| PairFailure {
                shader,
                target: shaders[shader].graph.passes()[pass].target,
                failure: refusal.into(),
            })
        };
        Ok(Self {
            programs: [programs(0)?, programs(1)?],
            shaders,
            timeout,
        })
    }

    /// The passes that both shaders have, with buffers of the same size, in the order of the first one.
    #[must_use]
    pub fn common_passes(&self) -> Vec<Target> {
        let [first, second] = [0, 1].map(|shader| self.targets(shader));
        first
            .into_iter()
            .filter(|target| second.contains(target))
            .filter(|&target| self.shaders[0].graph.is_sized_like(self.shaders[1].graph, target))
            .collect()
    }

    /// The passes that only the shader with this number has.
    #[must_use]
    pub fn other_passes(&self, shader: usize) -> Vec<Target> {
        let common = self.common_passes();
        let mut targets = self.targets(shader);
        targets.retain(|target| !common.contains(target));
        targets
    }

    fn targets(&self, shader: usize) -> Vec<Target> {
        let passes = self.shaders[shader].graph.passes();
        passes.iter().map(|pass| pass.target).collect()
    }

    /// Finds the first difference in some frames; `None` if all bits of all common passes are equal. The sign
    /// of a zero and the bits of NaN are open. `step` is called before each frame.
    ///
    /// # Errors
    /// If a pass fails.
    pub fn first_difference(
        &self,
        clock: &Clock,
        frames: RangeInclusive<i32>,
        step: impl FnMut(i32),
    ) -> Result<Option<FirstDifference>, PairFailure> {
        let targets = self.common_passes();
        let mut found = None;
        self.play(clock, frames, step, |inputs, playbacks| {
            let differences = targets
                .iter()
                .map(|&target| self.difference(inputs, target, playbacks));
            found = differences.flatten().next();
            match found {
                None => ControlFlow::Continue(()),
                Some(_) => ControlFlow::Break(()),
            }
        })?;
        Ok(found)
    }

    /// Renders the images of both shaders in some frames, and gives each pair to `compare`, with the number
    /// of the frame.
    ///
    /// # Errors
    /// If a pass fails.
    ///
    /// # Panics
    /// Never: every shader has an image.
    pub fn images(
        &self,
        clock: &Clock,
        frames: RangeInclusive<i32>,
        step: impl FnMut(i32),
        mut compare: impl FnMut(i32, [&Image; 2]) -> ControlFlow<()>,
    ) -> Result<(), PairFailure> {
        self.play(clock, frames, step, |inputs, playbacks| {
            let images = playbacks.each_ref().map(|playback| {
                let texture = playback.texture(Target::Image);
                texture.expect("the image is rendered").stack()
            });
            compare(inputs.frame, images.each_ref().map(|image| &**image))
        })
    }

    /// Renders frames until `visit` breaks; the ones before the first one, if a shader depends on them.
    fn play(
        &self,
        clock: &Clock,
        frames: RangeInclusive<i32>,
        mut step: impl FnMut(i32),
        mut visit: impl FnMut(&Frame, &[CpuPlayback<f32>; 2]) -> ControlFlow<()>,
    ) -> Result<(), PairFailure> {
        let mut playbacks = [0, 1].map(|shader| {
            let (shader, programs) = (self.shaders[shader], &self.programs[shader]);
            CpuPlayback::<f32>::new(shader, programs, None, self.timeout, Settings::plain())
        });
        let has_history = self.shaders.into_iter().any(has_history);
        let first = if has_history { 0 } else { *frames.start() };
        for number in first..=*frames.end() {
            step(number);
            let inputs = clock.frame(number);
            for (shader, playback) in playbacks.iter_mut().enumerate() {
                let rendered = playback.render(&self.shaders[shader].with_films(&inputs));
                rendered.map_err(|PassFailure { pass, failure }| PairFailure {
                    shader,
                    target: self.shaders[shader].graph.passes()[pass].target,
                    failure,
                })?;
            }
            if frames.contains(&number) && visit(&inputs, &playbacks).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// The difference of a pass in the frame that was rendered last.
    fn difference(
        &self,
        inputs: &Frame,
        target: Target,
        playbacks: &[CpuPlayback<f32>; 2],
    ) -> Option<FirstDifference> {
        let [Some(a), Some(b)] = playbacks.each_ref().map(|playback| playback.texture(target)) else {
            return None;
        };
        let [a, b] = [a, b].map(|texture: &Texture| texture.stack());
        let pairs = a.pixels().iter().zip(b.pixels());
        let is_alike = |a: f32, b: f32| a == b || a.is_nan() && b.is_nan();
        let differs =
            |(_, (a, b)): &(usize, (&[f32; 4], &[f32; 4]))| !a.iter().zip(*b).all(|(&a, &b)| is_alike(a, b));
        let mut differing = pairs.enumerate().filter(differs);
        let (at, (first, second)) = differing.next()?;
        let width = a.size()[0] as usize;
        let pixel = [(at % width) as u32, (at / width) as u32];
        Some(FirstDifference {
            frame: inputs.frame,
            target,
            pixel,
            colors: [*first, *second],
            differing: 1 + differing.count() as u64,
            pixels: a.pixels().len() as u64,
            origins: self.origins(inputs, target, pixel, playbacks),
        })
    }

    /// Where a difference in a pixel of a pass arises: the first value that the other shader does not have, or
    /// else the last assignment.
    fn origins(
        &self,
        inputs: &Frame,
        target: Target,
        pixel: [u32; 2],
        playbacks: &[CpuPlayback<f32>; 2],
    ) -> [Option<Origin>; 2] {
        let deadline = Instant::now() + self.timeout;
        let bound = [0, 1].map(|shader| {
            let pass = self.targets(shader).iter().position(|&other| other == target)?;
            Some((
                &self.programs[shader][pass],
                playbacks[shader].bound(pass, &self.shaders[shader].with_films(inputs)),
            ))
        });
        let [Some((first, first_frame)), Some((second, second_frame))] = &bound else {
            return [None, None];
        };
        let sides = [(*first, first_frame), (*second, second_frame)];
        let found = departure::in_bits(sides[1], sides[0], pixel, deadline);
        let (unknown, missing) = found.map_or((None, None), |found| (found.unknown, found.missing));
        let of_value = |(span, value)| Origin {
            span,
            value,
            is_unknown: true,
        };
        let values = [
            missing.map(|missing| of_value((missing.span, missing.value))),
            unknown.map(|unknown| of_value((unknown.span, unknown.value))),
        ];
        let mut sides = sides.into_iter();
        values.map(|value| {
            let side = sides.next()?;
            value.or_else(|| last_assignment(side, pixel, deadline))
        })
    }
}

/// The last assignment of a shader in a pixel.
fn last_assignment(
    (program, frame): (&Program, &Frame),
    pixel: [u32; 2],
    deadline: Instant,
) -> Option<Origin> {
    let settings = Settings::<f32> {
        deadline: Some(deadline),
        ..Settings::plain()
    };
    let debugger = program.pixel_debugger(frame, settings).ok()?;
    let trace = debugger.trace(pixel, None).ok()?;
    let kind = |event: &TraceEvent| debugger.schema().event(event.event).kind;
    let mut events = trace.events.iter().rev();
    let event = events.find(|event| matches!(kind(event), EventKind::Assignment(_)))?;
    Some(Origin {
        span: debugger.schema().event(event.event).at.span,
        value: departure::numbers(event),
        is_unknown: false,
    })
}
