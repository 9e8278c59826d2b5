//! A picture in a number type, and what is known of each pixel.

use toyproof_image::Image;

use crate::number::Number;

/// What a shader painted: linear RGB, bottom row first. Alpha is 1, as on the GPU.
#[derive(Debug, Clone, PartialEq)]
pub struct Painting<N> {
    size: [u32; 2],
    pixels: Vec<[N; 3]>,
    marks: Vec<u8>,
}

/// The pixel met an operation that GLSL leaves undefined.
pub(crate) const UNDEFINED: u8 = 1;
/// The shader discarded the pixel.
pub(crate) const DISCARDED: u8 = 2;

/// What the GPU's target holds where a shader discards.
const UNPAINTED: [f32; 4] = [0.0, 0.0, 0.0, 0.5];

impl<N: Number> Painting<N> {
    pub(crate) fn new(size: [u32; 2]) -> Self {
        let count = size[0] as usize * size[1] as usize;
        Self {
            size,
            pixels: vec![[N::default(); 3]; count],
            marks: vec![0; count],
        }
    }

    pub(crate) fn parts_mut(&mut self) -> (&mut [[N; 3]], &mut [u8]) {
        (&mut self.pixels, &mut self.marks)
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.size[0] as usize + x as usize
    }

    /// The colour at (x, y), y upwards from the bottom; of a pixel that was discarded, what the variable held.
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> [N; 3] {
        self.pixels[self.index(x, y)]
    }

    /// Whether the pixel met an operation that GLSL leaves undefined: what others paint there may differ.
    #[must_use]
    pub fn is_undefined(&self, x: u32, y: u32) -> bool {
        self.marks[self.index(x, y)] & UNDEFINED != 0
    }

    /// Whether the shader discarded the pixel.
    #[must_use]
    pub fn is_discarded(&self, x: u32, y: u32) -> bool {
        self.marks[self.index(x, y)] & DISCARDED != 0
    }

    /// In how many pixels an undefined operation was met.
    #[must_use]
    pub fn undefined(&self) -> u64 {
        self.marks.iter().filter(|&&mark| mark & UNDEFINED != 0).count() as u64
    }

    /// The picture in f32, as the GPU's target holds it.
    #[must_use]
    pub fn image(&self) -> Image {
        let [width, height] = self.size;
        let pixels = self.pixels.iter().zip(&self.marks);
        Image::new(
            width,
            height,
            pixels.map(|(&colour, &mark)| shown(colour, mark)).collect(),
        )
    }
}

/// A pixel as the GPU's target holds it.
pub(crate) fn shown<N: Number>(colour: [N; 3], mark: u8) -> [f32; 4] {
    if mark & DISCARDED != 0 {
        return UNPAINTED;
    }
    let [r, g, b] = colour.map(N::to_f32);
    [r, g, b, 1.0]
}
