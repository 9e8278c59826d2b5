//! The passes of a shader, rendered by the evaluator.

use std::time::Instant;

use thiserror::Error;
use toyproof_image::{Frame, Texture, cube};
use toyproof_player::{Channel, Renderer, Storage};

use crate::exec::evaluate::Number;
use crate::exec::limits::Failure;
use crate::exec::settings::Settings;
use crate::exec::texture::texel;
use crate::program::Program;

/// Renders passes in a number type; buffers hold numbers of that type.
#[derive(Debug)]
pub struct PassRenderer<'a, N: Number> {
    programs: Vec<&'a Program>,
    media: &'a [Texture],
    settings: Settings<'a, N>,
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
        Self {
            programs: programs.into_iter().collect(),
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
        let [width, height] = texture.stack_size();
        let texel = |x, y| [0, 1, 2, 3].map(|component| texel::<N>(texture, [x, y], component));
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| texel(x, y)));
        let stack = N::texture([width, height], texels.collect());
        with_mipmaps(stack.shaped_as(texture), mipmaps)
    }

    /// A frame with these channels.
    #[must_use]
    pub fn bound(&self, frame: &Frame, channels: [Channel<'_, Texture>; 4]) -> Frame {
        bound(frame, channels, self.media)
    }
}

/// A frame with these channels, some of which read `media`.
#[must_use]
pub fn bound(frame: &Frame, channels: [Channel<'_, Texture>; 4], media: &[Texture]) -> Frame {
    let moving = |channel: &Channel<'_, Texture>| match channel {
        Channel::Moving(number) => frame.moving.get(*number),
        _ => None,
    };
    Frame {
        channel_times: channels
            .each_ref()
            .map(|channel| moving(channel).map_or(0.0, |(_, time)| *time)),
        channels: channels.map(|channel| match channel {
            Channel::Unbound => None,
            Channel::Texture(texture) => Some(texture.clone()),
            Channel::Medium(number) => media.get(number).cloned(),
            Channel::Moving(number) => frame.moving.get(number).map(|(texture, _)| texture.clone()),
            Channel::Keyboard => Some(frame.keys.texture()),
        }),
        ..frame.clone()
    }
}

/// The texture with mipmaps, if it has any.
fn with_mipmaps(texture: Texture, mipmaps: bool) -> Texture {
    if mipmaps { texture.with_mipmaps() } else { texture }
}

impl<N: Number> Renderer for PassRenderer<'_, N> {
    type Texture = Texture;
    type Error = PassFailure;

    fn zeros(&mut self, storage: Storage, mipmaps: bool) -> Result<Texture, PassFailure> {
        let zeros = |[width, height]: [u32; 2]| {
            N::texture(
                [width, height],
                vec![[N::default(); 4]; width as usize * height as usize],
            )
        };
        let texture = match storage {
            Storage::Image(size) => zeros(size),
            Storage::Cube(side) => zeros([side, side * cube::FACES])
                .into_cube()
                .with_resolution([side, side, 1]),
        };
        Ok(with_mipmaps(texture, mipmaps))
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
        let rendered = rendered.map_err(|failure| PassFailure { pass, failure })?;
        let texture = rendered.framebuffer.texture_over(&over);
        Ok(with_mipmaps(texture, over.levels() > 1))
    }

    fn resized(&mut self, texture: Texture, size: [u32; 2]) -> Result<Texture, PassFailure> {
        Ok(with_mipmaps(texture.cropped(size), texture.levels() > 1))
    }
}
