//! The state that a frame depends on besides its inputs.

use serde::{Deserialize, Serialize};
use toyproof_image::Texture;

use crate::{BUFFERS, Graph, Player, Renderer, Storage, Target};

/// The textures between two frames, so that a run can continue later.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// The number of the frame that was rendered last.
    pub frame: i32,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    /// The textures of each buffer that is used, the one that was completed last first, without mipmaps.
    pub buffers: [Option<[Texture; 2]>; BUFFERS],
    /// The image, which stays where pixels are discarded.
    pub image: Option<Texture>,
}

impl State {
    /// Whether a state that was read from a file is one of this graph: all its textures are there, in their
    /// sizes.
    pub fn fits(&self, graph: &Graph) -> bool {
        let mut buffers = self.buffers.iter().enumerate();
        let has_buffers = buffers.all(|(number, textures)| match textures {
            Some(textures) => {
                let size = match graph.storage(number, self.size) {
                    Storage::Image(size) => size,
                    Storage::Cube(side) => [side; 2],
                };
                graph.uses(number) && textures.iter().all(|texture| texture.is_whole(size))
            }
            None => !graph.uses(number),
        });
        let image = self.image.as_ref();
        has_buffers && self.frame >= 0 && image.is_none_or(|image| image.is_whole(self.size))
    }
}

impl<R: Renderer> Player<R> {
    /// The state after a frame; `read` copies a texture.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn state<E>(
        &self,
        frame: i32,
        mut read: impl FnMut(&R::Texture) -> Result<Texture, E>,
    ) -> Result<State, E> {
        let mut buffers = [const { None }; BUFFERS];
        for (number, buffer) in buffers.iter_mut().enumerate() {
            if let Some([last, other]) = self.buffer(number) {
                *buffer = Some([read(last)?, read(other)?]);
            }
        }
        let image = self.texture(Target::Image).map(&mut read).transpose()?;
        Ok(State {
            frame,
            size: self.size().unwrap_or_default(),
            buffers,
            image,
        })
    }

    /// Continues from a state; `load` makes a texture, perhaps with mipmaps.
    ///
    /// # Errors
    /// Those of `load`.
    pub fn restore<E>(
        &mut self,
        state: &State,
        mut load: impl FnMut(&mut R, &Texture, bool) -> Result<R::Texture, E>,
    ) -> Result<(), E> {
        let mut buffers = [const { None }; BUFFERS];
        for (number, buffer) in buffers.iter_mut().enumerate() {
            if let (Some([last, other]), true) = (&state.buffers[number], self.graph().uses(number)) {
                let mipmaps = self.graph().has_mipmaps(number);
                let renderer = self.renderer_mut();
                *buffer = Some([load(renderer, last, mipmaps)?, load(renderer, other, mipmaps)?]);
            }
        }
        let image = state
            .image
            .as_ref()
            .map(|image| load(self.renderer_mut(), image, false));
        let image = image.transpose()?;
        self.set_textures(state.size, buffers, image);
        Ok(())
    }
}
