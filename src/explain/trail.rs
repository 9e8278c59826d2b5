//! Follows the difference between float32 and double precision in a pixel back through passes and frames, to
//! where it arises.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use toyproof_eval::{Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{Source, Target};
use toyproof_verify::Failure;
use toyproof_verify::project::bind::{clock, programs};
use toyproof_verify::project::frames::Frames;
use toyproof_verify::project::playback::PassShader;

/// A pixel of a pass on the path of a difference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hop {
    /// The pass.
    pub target: Target,
    /// The frame.
    pub frame: i32,
    /// The pixel, from the left and from the bottom.
    pub pixel: [u32; 2],
    /// The color there in float32, from the first frame on.
    pub single: [f64; 4],
    /// The color there in double precision, from the first frame on.
    pub double: [f64; 4],
}

/// The path of a difference back through passes and frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Trail {
    /// The last frame, with the inputs of the requested pass, in float32.
    pub frame: Frame,
    /// From the requested pixel back to the earliest one.
    pub hops: Vec<Hop>,
    /// Whether the trail ends early: the frame before the last hop's was not kept.
    pub is_cut: bool,
}

/// The largest total size of the textures that are kept, in bytes.
const MAX_KEPT_BYTES: usize = 1 << 30;

/// The bytes of a texel in float32 and in double precision.
const TEXEL_BYTES: usize = 16 + 32;

/// A frame that was rendered.
struct Rendered {
    number: i32,
    /// The inputs of each pass, in float32 and in double precision.
    bound: Vec<[Frame; 2]>,
    /// The texture of each pass.
    textures: Vec<[Texture; 2]>,
}

/// Renders the frames, and follows the difference in a pixel of a pass of the last frame.
///
/// # Errors
/// Why a frame cannot be rendered.
fn trace_back(frames: &Frames, target: Target, pixel: [u32; 2]) -> Result<Trail, Failure> {
    let rendered = render(frames)?;
    let passes = frames.shader.graph.passes();
    let mut hops = Vec::new();
    let first = passes.iter().position(|pass| pass.target == target);
    let requested = rendered
        .back()
        .zip(first)
        .map(|(last, pass)| last.bound[pass][0].clone());
    let frame = requested.unwrap_or_default();
    let mut at = rendered.len().checked_sub(1).zip(first);
    let mut pixel = pixel;
    while let Some((index, pass)) = at {
        let played = &rendered[index];
        let [single, double] = played.textures[pass]
            .each_ref()
            .map(|texture| texture.texel(pixel));
        hops.push(Hop {
            target: passes[pass].target,
            frame: played.number,
            pixel,
            single,
            double,
        });
        let probe = Probe {
            program: &frames.programs[pass],
            bound: &played.bound[pass],
            pixel,
            deadline: Instant::now() + frames.long_timeout(),
        };
        let Some((channel, texel)) = probe.origin(single, double, passes[pass].inputs)? else {
            return Ok(Trail {
                frame,
                hops,
                is_cut: false,
            });
        };
        let source = passes
            .iter()
            .position(|other| passes[pass].inputs[channel] == source_of(other.target));
        // A pass that runs later, or the same, was read as of the previous frame.
        at = source.and_then(|source| {
            let index = if source < pass {
                Some(index)
            } else {
                index.checked_sub(1)
            };
            Some((index?, source))
        });
        pixel = texel;
    }
    Ok(Trail {
        frame,
        hops,
        is_cut: true,
    })
}

/// Follows the difference in a pixel of a pass back through all frames up to one.
///
/// # Errors
/// Why the passes cannot be rendered.
pub fn follow_back(
    shader: &PassShader,
    target: Target,
    pixel: [u32; 2],
    frame: &Frame,
    timeout: Duration,
) -> Result<Trail, Failure> {
    let frames = Frames {
        shader,
        programs: &programs(shader, timeout, None)?,
        clock: &clock(frame),
        last: frame.frame,
        timeout,
        pool: None,
    };
    trace_back(&frames, target, pixel)
}

fn source_of(target: Target) -> Option<Source> {
    match target {
        Target::Buffer(number) => Some(Source::Buffer(number)),
        Target::Image => None,
    }
}

/// Renders all frames, and keeps the last ones.
fn render(frames: &Frames) -> Result<VecDeque<Rendered>, Failure> {
    let (shader, timeout) = (frames.shader, frames.long_timeout());
    let mut single = frames.start::<f32>((), timeout);
    let mut double = frames.start::<f64>((), timeout);
    let passes = shader.graph.passes();
    let image = frames.clock.inputs.size;
    let texels = passes
        .iter()
        .map(|pass| shader.graph.texels(pass.target, image) as usize);
    let max_frames = (MAX_KEPT_BYTES / (texels.sum::<usize>() * TEXEL_BYTES).max(1)).max(2);
    let mut kept = VecDeque::new();
    for number in 0..=frames.last {
        let inputs = frames.clock.frame(number);
        single.render(&inputs).map_err(|error| error.failure)?;
        double.render(&inputs).map_err(|error| error.failure)?;
        let bound = (0..passes.len()).map(|pass| [single.bound(pass, &inputs), double.bound(pass, &inputs)]);
        let textures = passes.iter().filter_map(|pass| {
            Some([
                single.texture(pass.target)?.clone(),
                double.texture(pass.target)?.clone(),
            ])
        });
        kept.push_back(Rendered {
            number,
            bound: bound.collect(),
            textures: textures.collect(),
        });
        if kept.len() > max_frames {
            kept.pop_front();
        }
    }
    Ok(kept)
}

/// A pixel of a pass, evaluated in double precision with various inputs.
struct Probe<'a> {
    program: &'a Program,
    /// The inputs of the pass, in float32 and in double precision.
    bound: &'a [Frame; 2],
    pixel: [u32; 2],
    deadline: Instant,
}

impl Probe<'_> {
    /// The channel and the texel from which most of the difference comes; `None` if most of it arises in the
    /// pass.
    fn origin(
        &self,
        single: [f64; 4],
        double: [f64; 4],
        inputs: [Option<Source>; 4],
    ) -> Result<Option<(usize, [u32; 2])>, Failure> {
        // This pass alone in double precision, on float32 inputs: its difference from float32 arises here.
        let own_double = self.color(&self.bound[0])?;
        let (own, inherited) = (distance(single, own_double), distance(own_double, double));
        if inherited <= own {
            return Ok(None);
        }
        let [single, double] = self.bound;
        let mut best = None;
        for (channel, input) in inputs.into_iter().enumerate() {
            if !matches!(input, Some(Source::Buffer(_))) {
                continue;
            }
            let mut mixed = single.clone();
            mixed.channels[channel].clone_from(&double.channels[channel]);
            let change = distance(self.color(&mixed)?, own_double);
            if best.is_none_or(|(most, _)| change > most) && change > 0.0 {
                best = Some((change, channel));
            }
        }
        let Some((_, channel)) = best else {
            return Ok(None);
        };
        self.most_influential_texel(channel, own_double)
            .map(|texel| Some((channel, texel)))
    }

    /// The texel of a channel whose difference changes the pixel most: in each quarter of the texture in
    /// turn, double precision takes the place of float32. `own_double` is the color with float32 everywhere.
    fn most_influential_texel(&self, channel: usize, own_double: [f64; 4]) -> Result<[u32; 2], Failure> {
        let [single, double] = self.bound;
        let [Some(single_texture), Some(double_texture)] =
            [single, double].map(|frame| frame.channels[channel].as_ref())
        else {
            return Ok([0; 2]);
        };
        let mut from = [0; 2];
        let mut size = single_texture.size();
        while size != [1, 1] {
            let half = size.map(|side| side.div_ceil(2));
            let mut best: Option<(f64, [u32; 2], [u32; 2])> = None;
            for quarter in 0..4 {
                let offset = [quarter & 1, quarter >> 1];
                let corner = [0, 1].map(|axis| from[axis] + offset[axis] * half[axis]);
                let extent = [0, 1].map(|axis| {
                    if offset[axis] == 0 {
                        half[axis]
                    } else {
                        size[axis] - half[axis]
                    }
                });
                if extent.contains(&0) {
                    continue;
                }
                let mut mixed = single.clone();
                mixed.channels[channel] = Some(patched(single_texture, double_texture, corner, extent));
                let change = distance(self.color(&mixed)?, own_double);
                if best.is_none_or(|(most, ..)| change > most) {
                    best = Some((change, corner, extent));
                }
            }
            if let Some((_, corner, extent)) = best {
                (from, size) = (corner, extent);
            }
        }
        Ok(from)
    }

    fn color(&self, frame: &Frame) -> Result<[f64; 4], Failure> {
        let settings = Settings::<f64> {
            undefined: UndefinedPolicy::Plain,
            deadline: Some(self.deadline),
            ..Settings::default()
        };
        let debugger = self.program.pixel_debugger(frame, settings)?;
        let trace = debugger.trace(self.pixel, None)?;
        let [r, g, b] = trace.color.unwrap_or_default();
        Ok([r, g, b, 0.0])
    }
}

/// A texture in double precision: the float32 texels, except in a rectangle.
fn patched(single: &Texture, double: &Texture, from: [u32; 2], size: [u32; 2]) -> Texture {
    let [width, height] = single.size();
    let is_inside =
        |x, y| (from[0]..from[0] + size[0]).contains(&x) && (from[1]..from[1] + size[1]).contains(&y);
    let texels = (0..height)
        .flat_map(|y| (0..width).map(move |x| if is_inside(x, y) { double } else { single }.texel([x, y])));
    let patched = Texture::from(Image::new(width, height, texels.collect()));
    if single.levels() > 1 {
        patched.with_mipmaps()
    } else {
        patched
    }
}

/// The largest difference of red, green and blue; infinite if a color is NaN, or both are the same infinity.
fn distance(a: [f64; 4], b: [f64; 4]) -> f64 {
    let differences = a.iter().zip(&b).take(3).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |most, difference| {
        if difference.is_nan() {
            f64::INFINITY
        } else {
            most.max(difference)
        }
    })
}
