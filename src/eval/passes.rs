//! The passes of a shader, rendered by the evaluator.

use std::time::Instant;

use thiserror::Error;
use toyproof_image::{Frame, Texture};
use toyproof_player::{Channel, Renderer};

use crate::exec::evaluate::Number;
use crate::exec::limits::Failure;
use crate::exec::observe::Observations;
use crate::exec::settings::Settings;
use crate::exec::texture::texel;
use crate::program::Program;
use crate::render::Rendered;

/// Renders passes in a number type; buffers hold numbers of that type.
#[derive(Debug)]
pub struct PassRenderer<'a, N: Number> {
    programs: Vec<&'a Program>,
    media: &'a [Texture],
    settings: Settings<'a, N>,
    observations: Vec<Observations>,
}

/// Why a pass was not rendered.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{failure}")]
pub struct PassFailure {
    /// The number of the pass.
    pub pass: usize,
    /// The reason.
    pub failure: Failure,
}

impl<'a, N: Number> PassRenderer<'a, N> {
    /// A renderer with a program for each pass, and the textures that do not change.
    #[must_use]
    pub fn new(
        programs: impl IntoIterator<Item = &'a Program>,
        media: &'a [Texture],
        settings: Settings<'a, N>,
    ) -> Self {
        let programs: Vec<_> = programs.into_iter().collect();
        Self {
            observations: vec![Observations::default(); programs.len()],
            programs,
            media,
            settings,
        }
    }

    /// Sets the time at which a pass gives up.
    pub fn set_deadline(&mut self, deadline: Instant) {
        self.settings.deadline = Some(deadline);
    }

    /// A texture of a state, in the precision of the number type.
    #[must_use]
    pub fn load(texture: &Texture, mipmaps: bool) -> Texture {
        let [width, height] = texture.size();
        let texel = |x, y| [0, 1, 2, 3].map(|component| texel::<N>(texture, 0, [x, y], component));
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| texel(x, y)));
        let loaded = N::texture(texture.size(), texels.collect());
        if mipmaps { loaded.with_mipmaps() } else { loaded }
    }

    /// A frame with these channels.
    #[must_use]
    pub fn bound(&self, frame: &Frame, channels: [Channel<'_, Texture>; 4]) -> Frame {
        bound(frame, channels, self.media)
    }

    /// The observations of each pass, over all frames.
    #[must_use]
    pub fn observations(&self) -> &[Observations] {
        &self.observations
    }
}

/// A frame with these channels, some of which read `media`.
#[must_use]
pub fn bound(frame: &Frame, channels: [Channel<'_, Texture>; 4], media: &[Texture]) -> Frame {
    Frame {
        channels: channels.map(|channel| match channel {
            Channel::Unbound => None,
            Channel::Texture(texture) => Some(texture.clone()),
            Channel::Medium(number) => media.get(number).cloned(),
            Channel::Keyboard => Some(frame.keys.texture()),
        }),
        ..frame.clone()
    }
}

impl<N: Number> Renderer for PassRenderer<'_, N> {
    type Texture = Texture;
    type Error = PassFailure;

    fn zeros(&mut self, size: [u32; 2], mipmaps: bool) -> Result<Texture, PassFailure> {
        let count = size[0] as usize * size[1] as usize;
        let texture = N::texture(size, vec![[N::default(); 4]; count]);
        Ok(if mipmaps { texture.with_mipmaps() } else { texture })
    }

    fn draw(
        &mut self,
        pass: usize,
        over: Texture,
        frame: &Frame,
        channels: [Channel<'_, Texture>; 4],
    ) -> Result<Texture, PassFailure> {
        let frame = self.bound(frame, channels);
        let rendered = self.programs[pass].render(&frame, &self.settings);
        let Rendered {
            framebuffer,
            observations,
        } = rendered.map_err(|failure| PassFailure { pass, failure })?;
        self.observations[pass].merge(&observations);
        let has_mipmaps = over.levels() > 1;
        let texture = framebuffer.texture_over(&over);
        Ok(if has_mipmaps {
            texture.with_mipmaps()
        } else {
            texture
        })
    }

    fn resized(&mut self, texture: Texture, size: [u32; 2]) -> Result<Texture, PassFailure> {
        let has_mipmaps = texture.levels() > 1;
        let texture = texture.cropped(size);
        Ok(if has_mipmaps {
            texture.with_mipmaps()
        } else {
            texture
        })
    }
}
