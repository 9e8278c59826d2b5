//! The inputs and outputs of a frame: uniforms and the framebuffer.

use toyproof_glsl::tree::Input;
use toyproof_image::{Frame, Image, Texture};

use crate::exec::number::Arithmetic;
use crate::exec::texture;

/// Returns one component of a float input.
pub(crate) fn float_input<N: Arithmetic>(frame: &Frame, input: Input, component: u8) -> N {
    let value = frame.component(input, component.into());
    // A GPU flushes subnormal operands before it computes with them.
    N::from_f64(f64::from(if value.is_subnormal() { 0.0 } else { value }))
}

/// Returns `iFrame`, the only integer input.
pub(crate) fn frame_counter(frame: &Frame) -> u32 {
    frame.frame.cast_unsigned()
}

// The framebuffer: an image in any number type, with flags for each pixel.

/// The output of a shader: linear RGBA, bottom row first. The alpha of an image is 1, as on the GPU.
#[derive(Debug, Clone, PartialEq)]
pub struct Framebuffer<N> {
    size: [u32; 2],
    pixels: Vec<[N; 4]>,
    flags: Vec<u8>,
}

/// Flag: the pixel executed an operation that GLSL leaves undefined.
pub(crate) const UNDEFINED: u8 = 1;
/// Flag: the shader discarded the pixel.
pub(crate) const DISCARDED: u8 = 2;

/// The value of a discarded pixel in the GPU's render target.
const DISCARDED_COLOR: [f32; 4] = [0.0, 0.0, 0.0, 0.5];

impl<N: Arithmetic> Framebuffer<N> {
    pub(crate) fn new(size: [u32; 2]) -> Self {
        let count = size[0] as usize * size[1] as usize;
        Self {
            size,
            pixels: vec![[N::default(); 4]; count],
            flags: vec![0; count],
        }
    }

    pub(crate) fn parts_mut(&mut self) -> (&mut [[N; 4]], &mut [u8]) {
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
        let [red, green, blue, _] = self.pixels[self.index(x, y)];
        [red, green, blue]
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

    /// Returns a texture in the precision of the number type, which has the shape of `over`. Discarded pixels
    /// keep its texels; its layers are stacked.
    pub(crate) fn texture_over(self, over: &Texture) -> Texture {
        let Self {
            size,
            mut pixels,
            flags,
        } = self;
        let discarded = flags
            .iter()
            .enumerate()
            .filter(|(_, flag)| **flag & DISCARDED != 0);
        for (at, _) in discarded {
            let [x, y] = [at as u32 % size[0], at as u32 / size[0]];
            pixels[at] = [0, 1, 2, 3].map(|component| texture::texel(over, [x, y], component));
        }
        N::texture(size, pixels).shaped_as(over)
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
#[inline(always)]
pub(crate) fn target_color<N: Arithmetic>(color: [N; 4], flag: u8) -> [f32; 4] {
    if flag & DISCARDED != 0 {
        return DISCARDED_COLOR;
    }
    color.map(N::to_f32)
}
