//! The values that ShaderToy provides to a shader for one frame, and their uniform block.

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::inputs::VECTOR_BYTES;
use crate::{BLOCK_BYTES, Input, Keys, MovingTextures, Script, Texture};

/// All inputs of a shader for the frame that it renders.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// The size of the rendered image, and `iResolution.xy` unless that is given, in pixels.
    pub size: [u32; 2],
    /// `iResolution.xy` if it is not the size of the image: that of one of the stacked faces of a cube map.
    pub resolution: Option<[u32; 2]>,
    /// `iTime`, in seconds.
    pub time: f32,
    /// `iTimeDelta`: the time since the previous frame, in seconds.
    pub time_delta: f32,
    /// `iFrameRate`, in frames per second.
    pub frame_rate: f32,
    /// `iFrame`, from 0.
    pub frame: i32,
    /// `iMouse`, in pixels, as in ShaderToy: xy is the last drag position, zw the click.
    pub mouse: [f32; 4],
    /// `iDate`: year, month from 0, day, seconds since midnight.
    pub date: [f32; 4],
    /// The keyboard.
    pub keys: Keys,
    /// The user's actions over the frames of a run, which determine the mouse and the keyboard of this frame.
    #[serde(skip)]
    pub script: Option<Arc<Script>>,
    /// The textures of all frames that change, which determine those of this frame.
    #[serde(skip)]
    pub films: MovingTextures,
    /// The textures of this frame that change, with their `iChannelTime` in seconds.
    pub moving: Vec<(Texture, f32)>,
    /// The textures of `iChannel0` to `iChannel3`; an unbound channel is black and its resolution 0.
    pub channels: [Option<Texture>; 4],
    /// `iChannelTime`, in seconds.
    pub channel_times: [f32; 4],
}

impl Default for Frame {
    /// The first frame at 640×360, everything else zero: the same image on every day.
    fn default() -> Self {
        Self {
            size: [640, 360],
            resolution: None,
            time: 0.0,
            time_delta: 1.0 / FRAME_RATE,
            frame_rate: FRAME_RATE,
            frame: 0,
            mouse: IDLE_MOUSE,
            date: [0.0; 4],
            keys: Keys::default(),
            script: None,
            films: MovingTextures::default(),
            moving: Vec::new(),
            channels: [const { None }; 4],
            channel_times: [0.0; 4],
        }
    }
}

/// Pixels per band of rows that is rendered and compared at once: an image of 640×360 is one band; a larger
/// one has several, so that it takes little more memory.
const BAND_PIXELS: u32 = 1 << 18;
/// Bands begin at multiples of this number of rows, so that neither the evaluator's tiles nor the quads of
/// derivatives cross bands.
const BAND_ROWS: u32 = 32;

/// `iMouse` before the first click: as on ShaderToy, zw is negative.
pub const IDLE_MOUSE: [f32; 4] = [0.0, 0.0, -0.0, -0.0];

/// The default of `iFrameRate`, in frames per second; `iTimeDelta` is its reciprocal.
pub const FRAME_RATE: f32 = 60.0;
/// `iSampleRate`, in hertz.
pub const SAMPLE_RATE: f32 = 44_100.0;

impl Frame {
    /// The frame with another number and time, with the mouse and the keyboard that it has by the script, and
    /// the textures that change.
    #[must_use]
    pub fn at(&self, number: i32, time: f32) -> Self {
        let scripted = self.script.as_ref();
        let frame = Self {
            frame: number,
            time,
            mouse: scripted
                .and_then(|script| script.mouse(number))
                .unwrap_or(self.mouse),
            keys: scripted.map_or(self.keys, |script| script.keys(number)),
            ..self.clone()
        };
        let films = self.films.0.iter();
        let moving = films.map(|film| (film.texture(&frame), film.position(&frame)));
        Self {
            moving: moving.collect(),
            ..frame
        }
    }

    /// All rows of the frame.
    pub fn rows(&self) -> Range<u32> {
        0..self.size[1]
    }

    /// The rows of the frame in bands, from the bottom up.
    pub fn bands(&self) -> impl Iterator<Item = Range<u32>> + use<> {
        let [width, height] = self.size;
        let rows = (BAND_PIXELS / width.max(1) / BAND_ROWS * BAND_ROWS).max(BAND_ROWS);
        (0..height)
            .step_by(rows as usize)
            .map(move |first| first..(first + rows).min(height))
    }

    /// One component of an input as a float, in the order of its elements; 0 for `iFrame`, an integer.
    pub fn component(&self, input: Input, at: usize) -> f32 {
        self.component_with(&self.channel_resolutions(), input, at)
    }

    fn component_with(&self, channels: &[[u32; 3]; 4], input: Input, at: usize) -> f32 {
        match input {
            Input::Resolution => {
                let [width, height] = self.resolution.unwrap_or(self.size);
                [width as f32, height as f32, 1.0][at]
            }
            Input::Time => self.time,
            Input::TimeDelta => self.time_delta,
            Input::FrameRate => self.frame_rate,
            Input::ChannelResolution => channels[at / 3][at % 3] as f32,
            Input::Mouse => self.mouse[at],
            Input::Date => self.date[at],
            Input::SampleRate => SAMPLE_RATE,
            Input::ChannelTime => self.channel_times[at],
            Input::Frame => 0.0,
        }
    }

    fn channel_resolutions(&self) -> [[u32; 3]; 4] {
        let channels = self.channels.each_ref();
        channels.map(|channel| channel.as_ref().map_or([0; 3], Texture::resolution))
    }

    /// The bytes of the uniform block, in the layout of [`Input::offset`].
    pub fn block(&self) -> [u8; BLOCK_BYTES] {
        self.block_with(self.channel_resolutions())
    }

    /// The uniform block with this `iChannelResolution` instead of the frame's own.
    pub fn block_with(&self, channels: [[u32; 3]; 4]) -> [u8; BLOCK_BYTES] {
        let mut bytes = [0; BLOCK_BYTES];
        for input in Input::ALL {
            let components = input.ty().components();
            for at in 0..input.length().unwrap_or(1) * components {
                let word = match input {
                    Input::Frame => self.frame.to_ne_bytes(),
                    _ => self.component_with(&channels, input, at).to_ne_bytes(),
                };
                let start = input.offset() + at / components * VECTOR_BYTES + at % components * 4;
                bytes[start..start + 4].copy_from_slice(&word);
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Image;

    #[test]
    fn bands_cover_the_image_and_small_images_are_one_band() {
        let bands = |width, height| {
            let frame = Frame {
                size: [width, height],
                ..Frame::default()
            };
            let bands = frame.bands().map(|rows| (rows.start, rows.end));
            bands.collect::<Vec<_>>()
        };
        assert_eq!(bands(640, 360), [(0, 360)]);
        assert_eq!(bands(1, 1), [(0, 1)]);
        assert_eq!(bands(16_384, 70), [(0, 32), (32, 64), (64, 70)]);
        assert_eq!(bands(3840, 2160).len(), 34);
        assert_eq!(bands(3840, 2160).last(), Some(&(2112, 2160)));
    }

    #[test]
    fn a_bound_channel_has_its_resolution_and_an_unbound_one_zero() {
        let mut frame = Frame::default();
        frame.channels[1] = Some(Image::new(2, 1, vec![[0.0; 4]; 2]).into());
        let bytes = frame.block();
        let bits = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!(
            [bits(0), bits(4), bits(8)],
            [640.0f32, 360.0, 1.0].map(f32::to_bits)
        );
        assert_eq!(
            [bits(96), bits(112), bits(116)],
            [0.0f32, 2.0, 1.0].map(f32::to_bits)
        );
    }
}
