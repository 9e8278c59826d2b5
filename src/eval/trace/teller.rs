//! Tells what single pixels do.

use toyproof_image::Frame;

use crate::lower::isel::Prepared;
use crate::number::Number;
use crate::program::{Compiled, Program};
use crate::render::{Failure, Limits, Settings};
use crate::texture::Texture;
use crate::tile::Job;
use crate::trace::story::{Lead, Plot, Story};

/// A shader that is ready to tell what the pixels of a frame do.
#[derive(Debug)]
pub struct Teller<'a, N: Number> {
    compiled: &'a Compiled,
    prepared: Prepared<N>,
    frame: &'a Frame,
    settings: Settings<'a, N>,
}

impl Program {
    /// Prepares to tell of a frame.
    ///
    /// # Errors
    /// If the shader is too large.
    pub fn teller<'a, N: Number>(
        &'a self,
        frame: &'a Frame,
        settings: Settings<'a, N>,
    ) -> Result<Teller<'a, N>, Failure> {
        let compiled = self.telling()?;
        Ok(Teller {
            compiled,
            prepared: N::prepare(compiled, frame),
            frame,
            settings,
        })
    }
}

impl<'a, N: Number> Teller<'a, N> {
    /// What may happen.
    #[must_use]
    pub fn plot(&self) -> &'a Plot {
        &self.compiled.plot
    }

    /// What the pixel at (x, y) does, y upwards from the bottom. With a `lead`, its values are at first those of another story.
    ///
    /// # Errors
    /// Limits.
    ///
    /// # Panics
    /// If the pixel lies outside of the frame.
    pub fn story(&self, pixel: [u32; 2], lead: Option<Lead<'_>>) -> Result<Story, Failure> {
        let (frame, settings) = (self.frame, &self.settings);
        assert!(pixel[0] < frame.size[0] && pixel[1] < frame.size[1], "{pixel:?}");
        let textures = frame.channels.each_ref().map(|image| image.as_ref().map(Texture));
        let limits = Limits::of(settings);
        let job = Job::new(
            self.compiled,
            &self.prepared,
            &textures,
            &limits,
            settings,
            frame.size,
        );
        job.story(pixel, lead)
            .map_err(|end| end.failure(self.compiled, &limits, settings.rounds))
    }
}
