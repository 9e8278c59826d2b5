//! What parent and worker say to each other: length-prefixed postcard messages over pipes.

use std::io::{self, Read, Write};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toyproof_image::{Frame, Image};
use toyproof_translate::backend::Target;
use toyproof_translate::naga_ir::Shape;
use toyproof_translate::wgsl::Hosted;
use toyproof_translate::{FloatMode, Lowered};

use super::{Drawn, Driver, Failure, On, Phase};

/// What the parent asks for.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Job {
    /// Which Vulkan drivers are there, and which would be chosen.
    Probe(On),
    /// Translate and emit; strict decorations on SPIR-V if asked for.
    Translate(Lowered, Target, FloatMode),
    /// Read WGSL.
    Read(String),
    /// Translate, compile and paint a frame.
    Draw(Box<Shot>),
    /// Compile and paint a frame with another compiler's SPIR-V.
    Run(Box<Foreign>),
    /// Read a converted shader again, compile it with what drivers differ in spelled out, and paint frames.
    Paint(Box<Written>, Vec<Frame>, On),
    /// Tell in how many pixels of that frame the driver ends a loop by force.
    WatchLoops(Box<Shot>),
}

/// A shader and the frame that it paints.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Shot {
    pub(super) lowered: Lowered,
    pub(super) frame: Frame,
    pub(super) float: FloatMode,
    pub(super) on: On,
}

/// SPIR-V from elsewhere and the frame that it paints.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Foreign {
    pub(super) words: Vec<u32>,
    pub(super) frame: Frame,
    pub(super) float: FloatMode,
    pub(super) on: On,
}

/// A shader that was converted, as its file holds it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Written {
    /// A WGSL file, within what stands for its host.
    Wgsl(Hosted),
    /// GLSL: what naga was fed to write a file, or a file that was read again.
    Lowered(Lowered),
    /// The words of a SPIR-V file, or what another compiler made of a file, and the shapes of channels 0 to 3.
    Words(Vec<u32>, [Shape; 4]),
}

/// What the worker says: any number of phases, the bands of a picture from the bottom up, and then the end.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Reply {
    Phase(Phase),
    Band(Image),
    Done(Result<Output, Failure>),
}

/// What a job gives.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Output {
    Drivers(Vec<Driver>),
    Translated(Vec<u8>),
    Drawn(Box<Drawn>),
    Ran,
    Painted(Vec<Image>, String),
    CutShort(u64),
}

/// The longest message: the text of a shader and the pictures that it reads.
const MAX_MESSAGE: u64 = 1 << 30;

pub(super) fn send(mut to: impl Write, message: &impl Serialize) -> io::Result<()> {
    let bytes = postcard::to_stdvec(message).map_err(io::Error::other)?;
    to.write_all(&(bytes.len() as u64).to_le_bytes())?;
    to.write_all(&bytes)?;
    to.flush()
}

pub(super) fn receive<T: DeserializeOwned>(mut from: impl Read) -> io::Result<T> {
    let mut length = [0; 8];
    from.read_exact(&mut length)?;
    let length = u64::from_le_bytes(length);
    if length > MAX_MESSAGE {
        return Err(io::Error::other("a message longer than any there is"));
    }
    let mut bytes = Vec::new();
    if from.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    postcard::from_bytes(&bytes).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_arrive_bit_for_bit() {
        let nan = f32::from_bits(0x7fc0_1234);
        let image = Image::new(1, 1, vec![[nan, -0.0, f32::INFINITY, 1e-45]]);
        let mut pipe = Vec::new();
        send(&mut pipe, &image).unwrap();
        let back: Image = receive(&pipe[..]).unwrap();
        assert_eq!(
            back.get(0, 0).map(f32::to_bits),
            image.get(0, 0).map(f32::to_bits)
        );
    }

    #[test]
    fn garbage_is_an_error_and_not_an_allocation() {
        assert!(receive::<Image>(&[0xff; 64][..]).is_err());
        assert!(receive::<Image>(&b"short"[..]).is_err());
    }
}
