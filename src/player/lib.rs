//! The order in which `ShaderToy` renders the passes of a shader over frames, for any renderer: the evaluator
//! in each precision, and a graphics driver.
//!
//! In a frame, the buffers are rendered in the order of the graph, and then the image. Each buffer has two
//! textures: a pass reads the one that was completed last, and renders into the other. So a pass reads a
//! buffer that precedes it as of this frame, and itself or a later one as of the previous frame. Both
//! textures are zero at first and never cleared, so that a discarded pixel of a buffer keeps its value of two
//! frames ago, and one of the image that of the previous frame. In other hosts, a buffer may be cleared before
//! each frame.
//!
//! A buffer has the size of the image, or one that follows from it. Cube A is a buffer that is rendered after
//! the others: the faces of a cube map, stacked in one image.
//!
//! ```
//! use toyproof_image::Frame;
//! use toyproof_player::{Channel, Graph, Pass, Player, Renderer, Source, Storage, Target};
//!
//! /// Buffers of one number: Buffer A adds 1 to itself, and the image shows it.
//! struct Counter;
//!
//! impl Renderer for Counter {
//!     type Texture = u32;
//!     type Error = std::convert::Infallible;
//!
//!     fn zeros(&mut self, _: Storage, _: bool) -> Result<u32, Self::Error> {
//!         Ok(0)
//!     }
//!     fn draw(&mut self, pass: usize, _: u32, _: &Frame, channels: [Channel<'_, u32>; 4]) -> Result<u32, Self::Error> {
//!         let Channel::Texture(last) = channels[0] else { return Ok(0) };
//!         Ok(if pass == 0 { last + 1 } else { *last })
//!     }
//!     fn resized(&mut self, texture: u32, _: [u32; 2]) -> Result<u32, Self::Error> {
//!         Ok(texture)
//!     }
//! }
//!
//! let read_a = [Some(Source::Buffer(0)), None, None, None];
//! let passes = [Target::Buffer(0), Target::Image].map(|target| Pass { target, inputs: read_a });
//! let graph = Graph::new(passes.to_vec(), Default::default());
//! let mut player = Player::new(graph, Counter);
//! for frame in 0..3 {
//!     player.render(&Frame { frame, ..Frame::default() }).unwrap();
//! }
//! assert_eq!(player.texture(Target::Image), Some(&3));
//! ```
//!
//! # Parts
//!
//! - `play`: [`Player`], which decides what a pass reads and renders, and the trait [`Renderer`].
//! - `buffer`: the size of a buffer, and what else its textures have; `size`: sizes that are computed.
//! - `clock`: the inputs of each frame.
//! - `state`: what the next frame depends on.

mod buffer;
mod clock;
mod driver;
mod failure;
mod play;
mod size;
mod state;

use std::borrow::Cow;
use std::fmt;

pub use buffer::{BufferFormat, BufferSize, OversizedBuffer};
pub use clock::Clock;
pub use driver::{DrawOutput, Driver, Readback};
pub use failure::{DriverFailure, Phase};
pub use play::{Channel, Player, Renderer, Storage};
use serde::{Deserialize, Serialize};
pub use size::{BinaryFunction, SizeExpr, Step, UnaryFunction};
pub use state::State;
use toyproof_image::{Component, Frame, Image, MAX_PIXELS, Texture};

/// The number of images among the buffers: Buffer A to Buffer Z. `ShaderToy` has four of them.
pub const IMAGE_BUFFERS: usize = 26;

/// The number of buffers that a shader can have: images, and Cube A.
pub const BUFFERS: usize = IMAGE_BUFFERS + 1;

/// The number of Cube A among the buffers.
pub const CUBE_A: usize = IMAGE_BUFFERS;

/// The side of the faces of Cube A, in texels.
pub const CUBE_SIDE: u32 = 1024;

/// The passes of a shader, and what each reads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Graph {
    /// Buffers in the order in which they are rendered, then Cube A, and the image last.
    passes: Vec<Pass>,
    /// How the textures of each buffer are made.
    formats: Box<[BufferFormat; BUFFERS]>,
}

/// A pass: its target and its inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pass {
    /// The target that it renders.
    pub target: Target,
    /// The inputs of `iChannel0` to `iChannel3`.
    pub inputs: [Option<Source>; 4],
}

/// The target of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Target {
    /// The buffer with this number, from 0.
    Buffer(usize),
    /// The image.
    Image,
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Buffer(CUBE_A) => f.write_str("Cube A"),
            Self::Buffer(number) => write!(f, "Buffer {}", char::from(b'A' + *number as u8)),
            Self::Image => f.write_str("Image"),
        }
    }
}

impl Target {
    /// The texture that passes read, of what the pass of this target rendered.
    pub fn texture<T: Component>(self, image: Image<T>) -> Texture {
        match self {
            Self::Buffer(CUBE_A) => Texture::cube(&image).with_resolution([CUBE_SIDE, CUBE_SIDE, 1]),
            Self::Buffer(_) | Self::Image => image.into(),
        }
    }
}

/// The source of an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// The buffer with this number, from 0.
    Buffer(usize),
    /// The texture with this number among those that do not change.
    Medium(usize),
    /// The texture with this number among those that change from frame to frame.
    Moving(usize),
    /// The keyboard.
    Keyboard,
}

impl Graph {
    /// Creates a graph of these passes; `formats` are those of the buffers. The size of Cube A is ignored.
    ///
    /// # Panics
    /// If a pass other than the last renders the image, the last does not, or a buffer has a number
    /// of [`BUFFERS`] or more.
    pub fn new(passes: Vec<Pass>, formats: [BufferFormat; BUFFERS]) -> Self {
        let image = passes.iter().position(|pass| pass.target == Target::Image);
        assert_eq!(image, passes.len().checked_sub(1), "the image is rendered last");
        let numbers = passes.iter().flat_map(|pass| {
            let target = match pass.target {
                Target::Buffer(number) => Some(number),
                Target::Image => None,
            };
            target
                .into_iter()
                .chain(pass.inputs.iter().flatten().filter_map(|input| input.buffer()))
        });
        assert!(numbers.max() < Some(BUFFERS), "there are {BUFFERS} buffers");
        Self {
            passes,
            formats: Box::new(formats),
        }
    }

    /// The passes in the order in which they are rendered.
    pub fn passes(&self) -> &[Pass] {
        &self.passes
    }

    /// Makes the image read a texture that does not change.
    pub fn bind_to_image(&mut self, channel: usize, medium: usize) {
        if let Some(image) = self.passes.last_mut() {
            image.inputs[channel] = Some(Source::Medium(medium));
        }
    }

    /// Makes each pass whose channel reads nothing read a texture that does not change.
    pub fn bind_to_all(&mut self, channel: usize, medium: usize) {
        for pass in &mut self.passes {
            pass.inputs[channel].get_or_insert(Source::Medium(medium));
        }
    }

    /// How the textures of each buffer are made.
    pub fn formats(&self) -> &[BufferFormat; BUFFERS] {
        &self.formats
    }

    /// Whether mipmaps of a buffer are made.
    pub fn has_mipmaps(&self, buffer: usize) -> bool {
        self.formats[buffer].mipmaps
    }

    /// What the textures of a buffer store if the image has this size, in pixels.
    pub fn storage(&self, buffer: usize, image: [u32; 2]) -> Storage {
        match buffer {
            CUBE_A => Storage::Cube(CUBE_SIDE),
            _ => Storage::Image(self.formats[buffer].size.of(image)),
        }
    }

    /// The size of what a pass renders if the image has this size, in pixels; the faces of a cube map are
    /// stacked.
    pub fn size(&self, target: Target, image: [u32; 2]) -> [u32; 2] {
        match target {
            Target::Image => image,
            Target::Buffer(buffer) => self.storage(buffer, image).size(),
        }
    }

    /// The number of texels of what a pass renders if the image has this size, in pixels.
    pub fn texels(&self, target: Target, image: [u32; 2]) -> u64 {
        self.size(target, image).into_iter().map(u64::from).product()
    }

    /// The frame as the pass of this target renders it.
    pub fn frame<'f>(&self, target: Target, frame: &'f Frame) -> Cow<'f, Frame> {
        let size = self.size(target, frame.size);
        let resolution = (target == Target::Buffer(CUBE_A)).then_some([CUBE_SIDE; 2]);
        if size == frame.size && resolution.is_none() {
            return Cow::Borrowed(frame);
        }
        Cow::Owned(Frame {
            size,
            resolution,
            ..frame.clone()
        })
    }

    /// Checks the computed sizes of the buffers for an image of this size, in pixels. Together they may have
    /// the pixels of the largest image, or as many as buffers of the image's size.
    ///
    /// # Errors
    /// The first buffer that is larger than an image can be, or the pixels of all.
    pub fn check_sizes(&self, image: [u32; 2]) -> Result<(), OversizedBuffer> {
        let used: Vec<usize> = (0..CUBE_A).filter(|&buffer| self.uses(buffer)).collect();
        for &buffer in &used {
            let size = self.formats[buffer].size.check(image);
            size.map_err(|error| OversizedBuffer::One {
                buffer: Target::Buffer(buffer),
                error,
            })?;
        }
        let texels = used
            .iter()
            .map(|&buffer| self.texels(Target::Buffer(buffer), image));
        let texels = texels.sum();
        let limit = MAX_PIXELS.max(used.len() as u64 * self.texels(Target::Image, image));
        if texels > limit {
            return Err(OversizedBuffer::All { texels, limit });
        }
        Ok(())
    }

    /// Whether a target of this graph has the size of the same target of another, for images of any size.
    pub fn is_sized_like(&self, other: &Self, target: Target) -> bool {
        match target {
            Target::Image => true,
            Target::Buffer(buffer) => self.formats[buffer].size == other.formats[buffer].size,
        }
    }

    /// Whether a buffer is rendered or read. One that is only read stays zero.
    pub fn uses(&self, buffer: usize) -> bool {
        self.passes.iter().any(|pass| {
            pass.target == Target::Buffer(buffer) || pass.inputs.contains(&Some(Source::Buffer(buffer)))
        })
    }
}

impl Source {
    fn buffer(self) -> Option<usize> {
        match self {
            Self::Buffer(number) => Some(number),
            Self::Medium(_) | Self::Moving(_) | Self::Keyboard => None,
        }
    }
}

#[cfg(test)]
mod tests;
