//! Rendering of whole frames, and of parts of them.

use std::ops::Range;

use toyproof_image::{Frame, Image};

use crate::exec::evaluate::{Number, Pixels};
use crate::exec::frame::{Framebuffer, UNDEFINED};
use crate::exec::limits::Failure;
use crate::exec::observe::Observations;
use crate::exec::places::{Part, Places};
use crate::exec::settings::Settings;
use crate::program::Program;

/// An image and the observations made while rendering it.
#[derive(Debug, Clone)]
pub struct Rendered<N> {
    /// The image.
    pub framebuffer: Framebuffer<N>,
    /// The observations.
    pub observations: Observations,
}

/// A rendered image in f32, and its observations.
#[derive(Debug, Clone)]
pub struct RenderedF32 {
    /// The image, as the GPU's render target holds it.
    pub image: Image,
    /// Which pixels executed an operation that GLSL leaves undefined, bottom row first.
    pub undefined: Vec<bool>,
    /// The observations.
    pub observations: Observations,
}

impl Program {
    /// Renders a frame.
    ///
    /// # Errors
    /// If a limit is exceeded, or the shader is too large.
    pub fn render<N: Number>(
        &self,
        frame: &Frame,
        settings: &Settings<'_, N>,
    ) -> Result<Rendered<N>, Failure> {
        let mut framebuffer = Framebuffer::new(frame.size);
        let (pixels, flags) = framebuffer.parts_mut();
        let part = Part::Rows(frame.rows());
        let executable = self.executable(settings.undefined)?;
        let observations = N::fill(executable, frame, part, settings, Pixels::Own(pixels), flags)?;
        Ok(Rendered {
            framebuffer,
            observations,
        })
    }

    /// Renders a band of rows of a frame, such as those of [`Frame::bands`], rounded to f32. Observations
    /// have positions in the frame; the image's coordinates are relative to the band.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_rows<N: Number>(
        &self,
        frame: &Frame,
        rows: Range<u32>,
        settings: &Settings<'_, N>,
    ) -> Result<RenderedF32, Failure> {
        let size = [frame.size[0], rows.len() as u32];
        self.render_part(frame, Part::Rows(rows), size, settings)
    }

    /// Evaluates a frame at some positions only, rounded to f32: a pixel for each.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn at<N: Number>(
        &self,
        frame: &Frame,
        places: &Places,
        settings: &Settings<'_, N>,
    ) -> Result<Image, Failure> {
        let size = places.size();
        if size.contains(&0) {
            return Ok(Image::new(size[0], size[1], Vec::new()));
        }
        let rendered = self.render_part(frame, Part::Places(places), size, settings)?;
        Ok(rendered.image)
    }

    /// Renders a part of a frame, rounded to f32, as an image of this size.
    fn render_part<N: Number>(
        &self,
        frame: &Frame,
        part: Part<'_>,
        [width, height]: [u32; 2],
        settings: &Settings<'_, N>,
    ) -> Result<RenderedF32, Failure> {
        let mut colors = vec![[0.0; 4]; width as usize * height as usize];
        let mut flags = vec![0; colors.len()];
        let executable = self.executable(settings.undefined)?;
        let pixels = Pixels::Rounded(&mut colors);
        let observations = N::fill(executable, frame, part, settings, pixels, &mut flags)?;
        Ok(RenderedF32 {
            image: Image::new(width, height, colors),
            undefined: flags.into_iter().map(|flag| flag & UNDEFINED != 0).collect(),
            observations,
        })
    }
}
