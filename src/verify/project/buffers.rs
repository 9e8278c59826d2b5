//! Warnings about the contents of the buffers of a shader over its frames.

use std::time::Instant;

use toyproof_diagnostic::{Code, Diagnostic, Span, grouped, plural};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprKind, Input, VariableKind};
use toyproof_image::Frame;
use toyproof_player::{BUFFERS, Source, Target};

use crate::debug::explain;
use crate::project::frames::Frames;
use crate::project::playback::{CpuPlayback, PassShader};

/// The contents of the buffers in the frames so far, in float32.
pub(super) struct BufferLints<'a> {
    shader: &'a PassShader<'a>,
    buffers: [BufferTexels; BUFFERS],
    first_nan: Option<FirstNan>,
}

/// The texels of a buffer.
#[derive(Debug, Clone, Copy)]
struct BufferTexels {
    /// Whether all texels were zero in all frames.
    are_zero: bool,
    /// The number of texels that have a NaN in the last frame.
    nan: u64,
}

/// The first NaN.
struct FirstNan {
    pass: usize,
    /// The frame as the pass read it.
    inputs: Frame,
    /// The number of texels with a NaN.
    texels: u64,
    /// The first texel with a NaN.
    at: [u32; 2],
}

impl<'a> BufferLints<'a> {
    /// Before the first frame.
    pub(super) fn new(shader: &'a PassShader<'a>) -> Self {
        let buffer = BufferTexels {
            are_zero: true,
            nan: 0,
        };
        Self {
            shader,
            buffers: [buffer; BUFFERS],
            first_nan: None,
        }
    }

    /// Records the contents of the buffers after a frame.
    pub(super) fn observe(&mut self, inputs: &Frame, playback: &CpuPlayback<f32>) {
        for (pass, rendered) in self.shader.graph.passes().iter().enumerate() {
            let Target::Buffer(number) = rendered.target else {
                continue;
            };
            let Some(texture) = playback.texture(rendered.target) else {
                continue;
            };
            let stack = texture.stack();
            let texels = stack.pixels();
            let buffer = &mut self.buffers[number];
            buffer.are_zero &= texels.iter().all(|texel| *texel == [0.0; 4]);
            let has_nan = |texel: &[f32; 4]| texel.iter().any(|value| value.is_nan());
            buffer.nan = texels.iter().filter(|texel| has_nan(texel)).count() as u64;
            if buffer.nan > 0 && self.first_nan.is_none() {
                let width = stack.size()[0];
                let first = texels.iter().position(has_nan).unwrap_or_default() as u32;
                self.first_nan = Some(FirstNan {
                    pass,
                    inputs: playback.bound(pass, inputs),
                    texels: buffer.nan,
                    at: [first % width, first / width],
                });
            }
        }
    }

    /// The warnings after the last frame.
    pub(super) fn diagnostics(&self, frames: &Frames) -> Vec<Diagnostic> {
        let mut warnings: Vec<_> = self.nan(frames).into_iter().collect();
        // The frame after the first is the first that could read what another wrote.
        if frames.last > 0 {
            warnings.extend(self.never_initialized(frames.last));
        }
        warnings
    }

    /// Reports the origin of the first NaN, if any are left: NaN in a buffer that is read again spreads.
    fn nan(&self, frames: &Frames) -> Option<Diagnostic> {
        let first = self.first_nan.as_ref()?;
        let (number, buffer) = (0..).zip(&self.buffers).find(|(_, buffer)| buffer.nan > 0)?;
        let deadline = Instant::now() + frames.long_timeout();
        let explained = explain(
            &frames.programs[first.pass],
            &first.inputs,
            first.at,
            Some(deadline),
        );
        let span = explained.ok().and_then(|explained| {
            let step = &explained.steps[explained.not_finite?];
            Some(explained.schema.event(step.event).at.span)
        });
        let pixels = |count| format!("{} {}", grouped(count), plural(count, "pixel", "pixels"));
        let [x, y] = first.at;
        let message = format!(
            "{} of {} {} NaN in frame {}, first ({x}, {y})",
            pixels(first.texels),
            self.shader.graph.passes()[first.pass].target,
            plural(first.texels, "becomes", "become"),
            first.inputs.frame
        );
        let warning = Diagnostic::new(Code::NanInBuffer, message).note(format!(
            "NaN spreads to whatever reads it: in frame {}, {} of {} are NaN",
            frames.last,
            pixels(buffer.nan),
            Target::Buffer(number)
        ));
        Some(match span {
            Some(span) => warning.at(span),
            None => warning,
        })
    }

    /// Reports buffers that read themselves and stay zero: nothing gives them a first value.
    fn never_initialized(&self, last: i32) -> impl Iterator<Item = Diagnostic> {
        let passes = self.shader.graph.passes().iter().zip(&self.shader.checked);
        passes.filter_map(move |(pass, checked)| {
            let Target::Buffer(number) = pass.target else {
                return None;
            };
            // The mouse, the keyboard and other media may give a value in other frames.
            let is_driven = checked.reads(Input::Mouse)
                || pass.inputs.iter().any(|input| {
                    matches!(
                        input,
                        Some(Source::Medium(_) | Source::Moving(_) | Source::Keyboard)
                    )
                });
            if !self.buffers[number].are_zero || is_driven {
                return None;
            }
            let own = |&channel: &usize| pass.inputs[channel] == Some(Source::Buffer(number));
            let span = (0..4)
                .filter(own)
                .find_map(|channel| first_use(checked, channel))?;
            let message = format!(
                "{} reads itself, but is zero in all frames up to {last}",
                pass.target
            );
            Some(
                Diagnostic::new(Code::NeverInitialized, message)
                    .at(span)
                    .note("buffers are zero before the first frame")
                    .help("write initial values where `iFrame == 0`"),
            )
        })
    }
}

/// The first use of a channel.
fn first_use(checked: &Checked, channel: usize) -> Option<Span> {
    let tree = &checked.tree;
    tree.exprs.iter().find_map(|(_, expr)| match expr.kind {
        ExprKind::Variable(variable) if tree[variable].kind == VariableKind::Channel(channel as u8) => {
            Some(expr.at.span)
        }
        _ => None,
    })
}
