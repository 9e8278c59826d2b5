//! Protocol between parent and worker: length-prefixed postcard messages over pipes.

use std::io::{self, Read, Write};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toyproof_image::{Frame, Image, Sampling, Texture};
use toyproof_player::{DrawOutput, DriverFailure as Failure, Graph, Phase, Readback, State};
use toyproof_translate::backend::{Target, roundtrip};
use toyproof_translate::naga_ir::{Shape, ValidModule};
use toyproof_translate::wgsl::HostedShader;
use toyproof_translate::{FloatMode, Lowered, TranslateError};

use super::{AdapterSelector, Driver, Sandbox};

/// The parent's first message.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Setup {
    /// Whether a job may load a driver.
    pub(super) uses_driver: bool,
    /// The adapter that all jobs use.
    pub(super) selector: AdapterSelector,
}

/// A request from the parent.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Job {
    /// List the Vulkan drivers, the selected one first.
    Probe,
    /// Translate and emit. SPIR-V gets strict decorations if the float mode requires them.
    Translate(Lowered, Target, FloatMode),
    /// Parse and validate WGSL.
    ReadWgsl(String),
    /// Parse a converted shader again, and write it as a shader of `ShaderToy`.
    RewriteArtifact(Box<ShaderArtifact>),
    /// Translate, compile and render a frame.
    Draw(Box<DrawJob>),
    /// Parse a converted shader again, compile it with driver-dependent operations expanded, and render
    /// frames.
    RenderArtifact(Box<ShaderArtifact>, [Sampling; 4], Vec<Frame>),
    /// Compile the passes of a shader, whose frames the next jobs render.
    OpenPlayer(Box<PlayJob>),
    /// Go on from a state.
    RestorePlayer(Box<State>),
    /// Render the next frame, if there is one, and read textures back.
    Play(Option<Box<Frame>>, Vec<Readback>),
    /// Count the pixels of a frame in which the driver terminates a loop.
    WatchLoops(Box<DrawJob>),
    /// Report how the process is restricted.
    Sandbox,
    /// Load the driver. There is no result: the next job has it.
    Open,
}

impl Job {
    /// The number of pixels of the one image that it renders; `None` if it renders no image, or several.
    pub(super) fn pixels(&self) -> Option<u64> {
        match self {
            Self::Draw(job) | Self::WatchLoops(job) => {
                let [width, height] = job.frame.size;
                Some(u64::from(width) * u64::from(height))
            }
            _ => None,
        }
    }
}

/// A shader and the frame to render.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct DrawJob {
    pub(super) lowered: Lowered,
    pub(super) frame: Frame,
    pub(super) float: FloatMode,
}

/// The passes of a shader.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct PlayJob {
    /// In the order of the graph.
    pub(super) passes: PassCode,
    /// The samplers of each pass.
    pub(super) sampling: Vec<[Sampling; 4]>,
    pub(super) graph: Graph,
    /// The textures that do not change.
    pub(super) media: Vec<Texture>,
    /// The state to continue from.
    pub(super) state: Option<State>,
}

/// The code of the passes of a shader.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum PassCode {
    /// As they are lowered.
    Lowered(Vec<(Lowered, FloatMode)>),
    /// As they are converted. Operations in which drivers differ are expanded to operations on which they
    /// agree, with strict arithmetic.
    Converted(Vec<ShaderArtifact>),
}

/// A converted shader, as its file holds it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ShaderArtifact {
    /// A WGSL file, with a replacement for its host.
    Wgsl(HostedShader),
    /// GLSL: the lowered shader from which naga emitted a file, or a file that was parsed again.
    Lowered(Lowered),
    /// A SPIR-V file, or what a different compiler produced from a file.
    Words {
        /// The module.
        words: Vec<u32>,
        /// The shapes of channels 0 to 3.
        channels: [Shape; 4],
        /// Whether row 0 of the target is the top of the image.
        upside_down: bool,
    },
}

impl ShaderArtifact {
    /// Parses the shader with naga, and writes it as a shader of `ShaderToy`.
    ///
    /// # Errors
    /// naga's message.
    pub fn as_shadertoy(&self) -> Result<String, Failure> {
        let reread = |error: TranslateError| Failure::Reread(error.0);
        let module = match self {
            Self::Wgsl(hosted) => ValidModule::of_wgsl(&hosted.text).map_err(reread)?,
            Self::Lowered(lowered) => {
                ValidModule::parse(lowered).map_err(|errors| Failure::Refused(errors.into()))?
            }
            Self::Words { words, .. } => ValidModule::of_spirv(words).map_err(reread)?,
        };
        roundtrip::shadertoy(&module).map_err(|error| Failure::Naga(error.0))
    }

    /// Whether row 0 of the target is the top of the image.
    #[must_use]
    pub fn is_upside_down(&self) -> bool {
        match self {
            Self::Wgsl(hosted) => hosted.upside_down,
            Self::Words { upside_down, .. } => *upside_down,
            Self::Lowered(_) => false,
        }
    }
}

/// A reply of the worker: any number of phases and bands of the image, from the bottom up, and then the
/// result.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Reply {
    Phase(Phase),
    Band(#[serde(with = "raw_pixels")] Image),
    Done(Result<Output, Failure>),
}

/// The result of a job.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Output {
    Drivers(Vec<Driver>),
    Translated(Vec<u8>),
    Drawn(Box<DrawOutput>),
    Completed,
    Rendered(Vec<Image>, String),
    /// The name of the device.
    Opened(String),
    LoopTruncated(u64),
    Sandbox(Sandbox),
}

/// The pixels of an image as the bytes in memory, which are copied at once.
mod raw_pixels {
    use std::fmt;

    use serde::de::{self, Visitor};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use toyproof_image::Image;

    /// Bytes that are not a sequence of numbers.
    struct Bytes<'a>(&'a [u8]);

    impl Serialize for Bytes<'_> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            serializer.serialize_bytes(self.0)
        }
    }

    struct Pixels(Vec<[f32; 4]>);

    impl<'de> Deserialize<'de> for Pixels {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            struct PixelsVisitor;
            impl Visitor<'_> for PixelsVisitor {
                type Value = Pixels;
                fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                    f.write_str("the bytes of pixels")
                }
                fn visit_bytes<E: de::Error>(self, bytes: &[u8]) -> Result<Pixels, E> {
                    let pixels = bytes.chunks_exact(size_of::<[f32; 4]>());
                    Ok(Pixels(pixels.map(bytemuck::pod_read_unaligned).collect()))
                }
            }
            deserializer.deserialize_bytes(PixelsVisitor)
        }
    }

    pub(super) fn serialize<S: Serializer>(image: &Image, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes = Bytes(bytemuck::cast_slice(image.pixels()));
        (image.size(), bytes).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Image, D::Error> {
        let ([width, height], Pixels(pixels)) = <([u32; 2], Pixels)>::deserialize(deserializer)?;
        if pixels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(de::Error::custom("an image of another size"));
        }
        Ok(Image::new(width, height, pixels))
    }
}

/// Maximum length of a message in bytes: the text of a shader and the images of its channels.
const MAX_MESSAGE_BYTES: u64 = 1 << 30;

/// Maximum memory that is allocated before the message arrives, in bytes: a band.
const MAX_PREPARED_BYTES: u64 = 4 << 20;

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
    if length > MAX_MESSAGE_BYTES {
        return Err(io::Error::other("message too long"));
    }
    let mut bytes = Vec::with_capacity(length.min(MAX_PREPARED_BYTES) as usize);
    if from.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    postcard::from_bytes(&bytes).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_round_trip_bit_for_bit() {
        let nan = f32::from_bits(0x7fc0_1234);
        let image = Image::new(1, 1, vec![[nan, -0.0, f32::INFINITY, 1e-45]]);
        let mut pipe = Vec::new();
        send(&mut pipe, &Reply::Band(image.clone())).unwrap();
        let Ok(Reply::Band(back)) = receive(&pipe[..]) else {
            panic!("no band");
        };
        assert_eq!(
            back.get(0, 0).map(f32::to_bits),
            image.get(0, 0).map(f32::to_bits)
        );
    }

    #[test]
    fn malformed_messages_are_errors_without_allocation() {
        assert!(receive::<Image>(&[0xff; 64][..]).is_err());
        // A band of 1×2 pixels with the bytes of one.
        let mut pipe = Vec::new();
        let one = Image::new(1, 1, vec![[0.0; 4]]);
        send(&mut pipe, &Reply::Band(one)).unwrap();
        assert_eq!(pipe[9..11], [1, 1]);
        pipe[10] = 2;
        assert!(receive::<Reply>(&pipe[..]).is_err());
        assert!(receive::<Image>(&b"short"[..]).is_err());
    }
}
