//! The inputs of a frame as a user describes them: the files of its channels are not read yet.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

#[cfg(feature = "files")]
use crate::{Frame, Image, ImageError, Texture, noise, read};
use crate::{IDLE_MOUSE, Script};

/// The inputs of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameInputs {
    /// `iResolution.xy`, in pixels; `None` for the size of the reference.
    pub size: Option<[u32; 2]>,
    /// `iTime`, in seconds.
    pub time: f32,
    /// `iFrame`, from 0.
    pub frame: i32,
    /// `iMouse`, in pixels.
    pub mouse: [f32; 4],
    /// `iDate`: year, month from 0, day, seconds since midnight.
    pub date: [f32; 4],
    /// The mouse and the keyboard over the frames of a run, in place of `mouse`.
    pub script: Option<Arc<Script>>,
    /// The textures of `iChannel0` to `iChannel3`; `None` for black.
    pub channels: [Option<Channel>; 4],
    /// The values of uniforms that the author declares, in this frame.
    pub uniforms: Vec<UniformValue>,
}

/// The value of a uniform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UniformValue {
    /// The name of the uniform.
    pub name: String,
    /// Its components, matrices in column order; 1 and 0 for `true` and `false`.
    pub components: Vec<f64>,
}

impl UniformValue {
    /// Adds the values of the uniforms that have none yet.
    pub fn add_missing(all: &mut Vec<Self>, values: &[Self]) {
        for value in values {
            if all.iter().all(|given| given.name != value.name) {
                all.push(value.clone());
            }
        }
    }
}

impl fmt::Display for UniformValue {
    /// As `--uniform` takes it: `color=1,0.5,0`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let components: Vec<String> = self.components.iter().map(f64::to_string).collect();
        write!(f, "{}={}", self.name, components.join(","))
    }
}

impl Default for FrameInputs {
    fn default() -> Self {
        Self {
            size: None,
            time: 0.0,
            frame: 0,
            mouse: IDLE_MOUSE,
            date: [0.0; 4],
            script: None,
            channels: [const { None }; 4],
            uniforms: Vec::new(),
        }
    }
}

/// The texture of a channel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Channel {
    /// The noise texture, see [`noise`](crate::noise()).
    Noise,
    /// An image file.
    File(PathBuf),
}

impl Channel {
    /// The name of the noise texture, where a file name could be.
    pub const NOISE: &str = "noise";

    /// The channel that a user names: `noise`, or a file.
    pub fn named(name: &Path) -> Self {
        if name.as_os_str() == Self::NOISE {
            Self::Noise
        } else {
            Self::File(name.to_owned())
        }
    }

    /// The path of the file; `None` for noise.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Noise => None,
            Self::File(path) => Some(path),
        }
    }

    #[cfg(feature = "files")]
    fn load(&self) -> Result<Image, ImageError> {
        match self {
            Self::Noise => Ok(noise()),
            Self::File(path) => read(path),
        }
    }
}

impl FrameInputs {
    /// The image files of the channels.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.channels.iter().flatten().filter_map(Channel::file)
    }

    /// The frame with its channels loaded; without a size, it has the default one.
    ///
    /// # Errors
    /// If an image file cannot be read.
    #[cfg(feature = "files")]
    pub fn load(&self) -> Result<Frame, ImageError> {
        let mut channels = [const { None }; 4];
        for (image, channel) in channels.iter_mut().zip(&self.channels) {
            let loaded = channel.as_ref().map(Channel::load).transpose()?;
            *image = loaded.map(Texture::from);
        }
        let frame = Frame {
            size: self.size.unwrap_or(Frame::default().size),
            mouse: self.mouse,
            date: self.date,
            script: self.script.clone(),
            channels,
            ..Frame::default()
        };
        Ok(frame.at(self.frame, self.time))
    }
}
