//! The inputs and outputs of a frame: uniforms, channel textures, and the framebuffer.

use toyproof_glsl::tree::Input;
use toyproof_image::{FRAME_RATE, Frame, Image, SAMPLE_RATE};

use crate::number::Number;

/// Returns one component of a float input.
pub(crate) fn float_input<N: Number>(frame: &Frame, input: Input, component: u8) -> N {
    let at = usize::from(component);
    let value = match input {
        Input::Resolution => [frame.size[0] as f32, frame.size[1] as f32, 1.0][at],
        Input::Time => frame.time,
        Input::TimeDelta => 1.0 / FRAME_RATE,
        Input::FrameRate => FRAME_RATE,
        Input::ChannelResolution => match &frame.channels[at / 3] {
            Some(image) => [image.size()[0] as f32, image.size()[1] as f32, 1.0][at % 3],
            None => 0.0,
        },
        Input::Mouse => frame.mouse[at],
        Input::Date => frame.date[at],
        Input::SampleRate => SAMPLE_RATE,
        Input::Frame | Input::ChannelTime | Input::Channel(_) => 0.0,
    };
    // A GPU flushes subnormal operands before it computes with them.
    N::from_f64(f64::from(if value.is_subnormal() { 0.0 } else { value }))
}

/// Returns `iFrame`, the only integer input.
pub(crate) fn frame_counter(frame: &Frame) -> u32 {
    frame.frame.cast_unsigned()
}

// Channel textures: one mip level, repeated in both directions.

/// An image as a texture; row 0 is the bottom.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Texture<'a>(pub(crate) &'a Image);

impl Texture<'_> {
    /// Returns one component of a texel; coordinates are clamped to the edge, as naga does.
    pub(crate) fn fetch(self, place: [i32; 2], component: usize) -> f32 {
        let size = self.0.size();
        let clamped = |axis: usize| (place[axis] as u32).min(size[axis] - 1);
        self.0.get(clamped(0), clamped(1))[component]
    }

    /// Returns one component by bilinear filtering; texture coordinates are normalized and repeat.
    pub(crate) fn sample<N: Number>(
        self,
        at: [N; 2],
        offset: [i32; 2],
        component: usize,
        noise: N::Noise,
    ) -> N {
        let size = self.0.size();
        let half = N::from_f64(0.5);
        let axis = |axis: usize| {
            let texels = at[axis]
                .mul(N::from_f64(f64::from(size[axis])), noise)
                .sub(half, noise);
            let below = texels.floor();
            let weight = texels.sub(below, noise);
            let wrap = |step: f64| {
                let place = below.to_f64() + step + f64::from(offset[axis]);
                place.rem_euclid(f64::from(size[axis])) as u32
            };
            (
                wrap(0.0).min(size[axis] - 1),
                wrap(1.0).min(size[axis] - 1),
                weight,
            )
        };
        let (left, right, across) = axis(0);
        let (low, high, up) = axis(1);
        let texel = |x, y| N::from_f64(f64::from(self.0.get(x, y)[component]));
        let between = |a: N, b: N, weight: N| a.add(b.sub(a, noise).mul(weight, noise), noise);
        let lower = between(texel(left, low), texel(right, low), across);
        let upper = between(texel(left, high), texel(right, high), across);
        between(lower, upper, up)
    }
}

// The framebuffer: an image in any number type, with flags for each pixel.

/// The output of a shader: linear RGB, bottom row first. Alpha is 1, as on the GPU.
#[derive(Debug, Clone, PartialEq)]
pub struct Framebuffer<N> {
    size: [u32; 2],
    pixels: Vec<[N; 3]>,
    flags: Vec<u8>,
}

/// Flag: the pixel executed an operation that GLSL leaves undefined.
pub(crate) const UNDEFINED: u8 = 1;
/// Flag: the shader discarded the pixel.
pub(crate) const DISCARDED: u8 = 2;

/// The value of a discarded pixel in the GPU's render target.
const DISCARDED_COLOR: [f32; 4] = [0.0, 0.0, 0.0, 0.5];

impl<N: Number> Framebuffer<N> {
    pub(crate) fn new(size: [u32; 2]) -> Self {
        let count = size[0] as usize * size[1] as usize;
        Self {
            size,
            pixels: vec![[N::default(); 3]; count],
            flags: vec![0; count],
        }
    }

    pub(crate) fn parts_mut(&mut self) -> (&mut [[N; 3]], &mut [u8]) {
        (&mut self.pixels, &mut self.flags)
    }

    /// Returns width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.size[0] as usize + x as usize
    }

    /// Returns the color at (x, y), y upwards from the bottom. For a discarded pixel it is the value of the
    /// output variable at that time.
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> [N; 3] {
        self.pixels[self.index(x, y)]
    }

    /// Whether the pixel executed an operation that GLSL leaves undefined; other implementations may render a
    /// different color.
    #[must_use]
    pub fn is_undefined(&self, x: u32, y: u32) -> bool {
        self.flags[self.index(x, y)] & UNDEFINED != 0
    }

    /// Whether the shader discarded the pixel.
    #[must_use]
    pub fn is_discarded(&self, x: u32, y: u32) -> bool {
        self.flags[self.index(x, y)] & DISCARDED != 0
    }

    /// Counts the pixels that executed an undefined operation.
    #[must_use]
    pub fn undefined(&self) -> u64 {
        self.flags.iter().filter(|&&flag| flag & UNDEFINED != 0).count() as u64
    }

    /// Returns the image in f32, as the GPU's render target holds it.
    #[must_use]
    pub fn image(&self) -> Image {
        let [width, height] = self.size;
        let pixels = self.pixels.iter().zip(&self.flags);
        Image::new(
            width,
            height,
            pixels.map(|(&color, &flag)| target_color(color, flag)).collect(),
        )
    }
}

/// Converts a pixel to its value in the GPU's render target.
pub(crate) fn target_color<N: Number>(color: [N; 3], flag: u8) -> [f32; 4] {
    if flag & DISCARDED != 0 {
        return DISCARDED_COLOR;
    }
    let [r, g, b] = color.map(N::to_f32);
    [r, g, b, 1.0]
}
