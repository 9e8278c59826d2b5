//! The inputs of one frame: the values that ShaderToy provides to a shader, and their uniform block.

use std::ops::Range;
use std::sync::Arc;

use bytemuck::bytes_of;
use serde::{Deserialize, Serialize};

use crate::{Keys, Script, Texture};

/// All inputs of a shader for the frame that it renders.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// `iResolution.xy`, in pixels.
    pub size: [u32; 2],
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
    /// The textures of `iChannel0` to `iChannel3`; an unbound channel is black and its resolution 0.
    pub channels: [Option<Texture>; 4],
}

impl Default for Frame {
    /// The first frame at 640×360, everything else zero: the same image on every day.
    fn default() -> Self {
        Self {
            size: [640, 360],
            time: 0.0,
            time_delta: 1.0 / FRAME_RATE,
            frame_rate: FRAME_RATE,
            frame: 0,
            mouse: IDLE_MOUSE,
            date: [0.0; 4],
            keys: Keys::default(),
            script: None,
            channels: [const { None }; 4],
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

/// The std140 uniform block at set 0, binding 0. Other hosts rely on its offsets.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Block {
    resolution: [f32; 3],
    time: f32,
    time_delta: f32,
    frame: i32,
    frame_rate: f32,
    padding: f32,
    channel_time: [[f32; 4]; 4],
    channel_resolution: [[f32; 4]; 4],
    mouse: [f32; 4],
    date: [f32; 4],
    sample_rate: [f32; 4],
}

/// The size of the uniform block in bytes.
pub const BLOCK_BYTES: usize = size_of::<Block>();

impl Frame {
    /// The frame with another number and time, with the mouse and the keyboard that it has by the script.
    #[must_use]
    pub fn at(&self, number: i32, time: f32) -> Self {
        let scripted = self.script.as_ref();
        Self {
            frame: number,
            time,
            mouse: scripted
                .and_then(|script| script.mouse(number))
                .unwrap_or(self.mouse),
            keys: scripted.map_or(self.keys, |script| script.keys(number)),
            ..self.clone()
        }
    }

    /// All rows of the frame.
    #[must_use]
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

    /// The bytes of the uniform block in the layout that translated shaders expect.
    #[must_use]
    pub fn block(&self) -> [u8; BLOCK_BYTES] {
        self.block_with(
            self.channels
                .each_ref()
                .map(|channel| channel.as_ref().map(Texture::size)),
        )
    }

    /// The uniform block with channels of these sizes instead of the frame's own.
    #[must_use]
    pub fn block_with(&self, channels: [Option<[u32; 2]>; 4]) -> [u8; BLOCK_BYTES] {
        let resolution = |size: Option<[u32; 2]>| {
            size.map_or([0.0; 4], |[width, height]| {
                [width as f32, height as f32, 1.0, 0.0]
            })
        };
        let block = Block {
            resolution: [self.size[0] as f32, self.size[1] as f32, 1.0],
            time: self.time,
            time_delta: self.time_delta,
            frame: self.frame,
            frame_rate: self.frame_rate,
            padding: 0.0,
            channel_time: [[0.0; 4]; 4],
            channel_resolution: channels.map(resolution),
            mouse: self.mouse,
            date: self.date,
            sample_rate: [SAMPLE_RATE, 0.0, 0.0, 0.0],
        };
        let mut bytes = [0; BLOCK_BYTES];
        bytes.copy_from_slice(bytes_of(&block));
        bytes
    }
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

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
    fn the_block_has_the_documented_offsets() {
        assert_eq!(offset_of!(Block, resolution), 0);
        assert_eq!(offset_of!(Block, time), 12);
        assert_eq!(offset_of!(Block, time_delta), 16);
        assert_eq!(offset_of!(Block, frame), 20);
        assert_eq!(offset_of!(Block, frame_rate), 24);
        assert_eq!(offset_of!(Block, channel_time), 32);
        assert_eq!(offset_of!(Block, channel_resolution), 96);
        assert_eq!(offset_of!(Block, mouse), 160);
        assert_eq!(offset_of!(Block, date), 176);
        assert_eq!(offset_of!(Block, sample_rate), 192);
        assert_eq!(BLOCK_BYTES, 208);
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
