//! Frames of a graph, by a renderer.

use toyproof_image::{Frame, cube};

use crate::{BUFFERS, Graph, Source, Target};

/// Renders single passes.
pub trait Renderer {
    /// A texture that passes render and read.
    type Texture;
    /// Why a pass cannot be rendered.
    type Error;

    /// A texture of zeros, perhaps with mipmaps.
    ///
    /// # Errors
    /// If there is not enough memory.
    fn zeros(&mut self, storage: Storage, mipmaps: bool) -> Result<Self::Texture, Self::Error>;

    /// Renders the pass with this number over a texture, whose discarded pixels stay as they are. `frame`
    /// holds the size of the texture, and the values of all inputs but the channels.
    ///
    /// # Errors
    /// If the pass fails.
    fn draw(
        &mut self,
        pass: usize,
        over: Self::Texture,
        frame: &Frame,
        channels: [Channel<'_, Self::Texture>; 4],
    ) -> Result<Self::Texture, Self::Error>;

    /// An image of another size with the same lower left part, and zeros elsewhere.
    ///
    /// # Errors
    /// If there is not enough memory.
    fn resized(&mut self, texture: Self::Texture, size: [u32; 2]) -> Result<Self::Texture, Self::Error>;
}

/// What a texture stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// An image of this size, in pixels.
    Image([u32; 2]),
    /// A cube map whose faces have this side, in texels.
    Cube(u32),
}

impl Storage {
    /// The size in pixels; the faces of a cube map are stacked.
    pub fn size(self) -> [u32; 2] {
        match self {
            Self::Image(size) => size,
            Self::Cube(side) => [side, side * cube::FACES],
        }
    }
}

/// The content of a channel of a pass.
#[derive(Debug)]
pub enum Channel<'a, T> {
    /// Nothing: opaque black.
    Unbound,
    /// A buffer.
    Texture(&'a T),
    /// The texture with this number among those that do not change.
    Medium(usize),
    /// The texture with this number among those of the frame that change.
    Moving(usize),
    /// The keyboard of the frame.
    Keyboard,
}

/// The state of a graph between two frames.
#[derive(Debug)]
pub struct Player<R: Renderer> {
    graph: Graph,
    renderer: R,
    buffers: [Option<Buffer<R::Texture>>; BUFFERS],
    image: Option<R::Texture>,
    size: Option<[u32; 2]>,
}

/// The two textures of a buffer. A texture is absent while it is rendered.
#[derive(Debug)]
struct Buffer<T> {
    textures: [Option<T>; 2],
    /// The index of the texture that was completed last.
    last: usize,
}

impl<R: Renderer> Player<R> {
    /// A player before the first frame.
    pub fn new(graph: Graph, renderer: R) -> Self {
        Self {
            graph,
            renderer,
            buffers: [const { None }; BUFFERS],
            image: None,
            size: None,
        }
    }

    /// The graph.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// The renderer.
    pub fn renderer(&self) -> &R {
        &self.renderer
    }

    /// The renderer, to change its settings.
    pub fn renderer_mut(&mut self) -> &mut R {
        &mut self.renderer
    }

    /// The renderer; all textures are dropped.
    pub fn into_renderer(self) -> R {
        self.renderer
    }

    /// The last image of a pass: `None` before the first frame, and for buffers that are not used.
    pub fn texture(&self, target: Target) -> Option<&R::Texture> {
        match target {
            Target::Image => self.image.as_ref(),
            Target::Buffer(number) => {
                let buffer = self.buffers[number].as_ref()?;
                buffer.textures[buffer.last].as_ref()
            }
        }
    }

    /// The textures of a buffer, the one that was completed last first: all that the next frame depends on,
    /// together with the image.
    pub fn buffer(&self, number: usize) -> Option<[&R::Texture; 2]> {
        let buffer = self.buffers[number].as_ref()?;
        let [first, second] = buffer.textures.each_ref().map(Option::as_ref);
        let [last, other] = if buffer.last == 0 {
            [first, second]
        } else {
            [second, first]
        };
        Some([last?, other?])
    }

    /// The channels of a pass in the last frame.
    ///
    /// # Panics
    /// If there is no such pass.
    pub fn inputs(&self, pass: usize) -> [Channel<'_, R::Texture>; 4] {
        let from = &self.graph.passes()[pass..];
        channels(&self.graph, pass, |number| {
            let [last, other] = self.buffer(number)?;
            // If a buffer was rendered afterwards, this was its previous frame.
            let is_rendered_since = from.iter().any(|pass| pass.target == Target::Buffer(number));
            Some(if is_rendered_since { other } else { last })
        })
    }

    /// The size of the textures: `None` before the first frame.
    pub(crate) fn size(&self) -> Option<[u32; 2]> {
        self.size
    }

    /// Replaces all textures; for each buffer that is used, its textures as returned by [`Self::buffer`].
    pub(crate) fn set_textures(
        &mut self,
        size: [u32; 2],
        buffers: [Option<[R::Texture; 2]>; BUFFERS],
        image: Option<R::Texture>,
    ) {
        self.size = Some(size);
        self.image = image;
        self.buffers = buffers.map(|textures| {
            textures.map(|textures| Buffer {
                textures: textures.map(Some),
                last: 0,
            })
        });
    }

    /// Renders the next frame. If its size differs from that of the previous one, all textures keep their
    /// lower left part.
    ///
    /// # Errors
    /// If a pass fails; the player must not be used again.
    pub fn render(&mut self, frame: &Frame) -> Result<(), R::Error> {
        self.resize(frame.size)?;
        self.clear(frame.size)?;
        for number in 0..self.graph.passes().len() {
            let target = self.graph.passes()[number].target;
            let over = match self.take(target) {
                Some(texture) => texture,
                None => self.renderer.zeros(Storage::Image(frame.size), false)?,
            };
            let last = |buffer: usize| {
                let buffer = self.buffers[buffer].as_ref()?;
                buffer.textures[buffer.last].as_ref()
            };
            let channels = channels(&self.graph, number, last);
            let frame = self.graph.frame(target, frame);
            let drawn = self.renderer.draw(number, over, &frame, channels)?;
            match target {
                Target::Image => self.image = Some(drawn),
                Target::Buffer(number) => {
                    if let Some(buffer) = &mut self.buffers[number] {
                        buffer.last = 1 - buffer.last;
                        buffer.textures[buffer.last] = Some(drawn);
                    }
                }
            }
        }
        Ok(())
    }

    /// Takes the texture that a pass renders into.
    fn take(&mut self, target: Target) -> Option<R::Texture> {
        match target {
            Target::Image => self.image.take(),
            Target::Buffer(number) => {
                let buffer = self.buffers[number].as_mut()?;
                buffer.textures[1 - buffer.last].take()
            }
        }
    }

    /// Makes the textures of the buffers that do not keep their content anew.
    fn clear(&mut self, size: [u32; 2]) -> Result<(), R::Error> {
        for (number, buffer) in self.buffers.iter_mut().enumerate() {
            let Some(buffer) = buffer
                .as_mut()
                .filter(|_| self.graph.formats()[number].is_cleared)
            else {
                continue;
            };
            for texture in &mut buffer.textures {
                let storage = self.graph.storage(number, size);
                *texture = Some(self.renderer.zeros(storage, self.graph.has_mipmaps(number))?);
            }
        }
        Ok(())
    }

    /// Makes the textures, or changes their size.
    fn resize(&mut self, size: [u32; 2]) -> Result<(), R::Error> {
        if self.size == Some(size) {
            return Ok(());
        }
        let is_new = self.size.replace(size).is_none();
        for (number, buffer) in self.buffers.iter_mut().enumerate() {
            if !self.graph.uses(number) {
                continue;
            }
            let mut textures = [const { None }; 2];
            for (at, texture) in textures.iter_mut().enumerate() {
                let old = buffer.as_mut().and_then(|buffer| buffer.textures[at].take());
                let storage = self.graph.storage(number, size);
                *texture = Some(match (old, storage) {
                    (Some(old), Storage::Image(size)) => self.renderer.resized(old, size)?,
                    (Some(old), Storage::Cube(_)) => old,
                    (None, storage) => self.renderer.zeros(storage, self.graph.has_mipmaps(number))?,
                });
            }
            // As on the site, the first texture counts as the one that was completed last.
            *buffer = Some(Buffer { textures, last: 0 });
        }
        // The canvas is cleared when its size changes.
        if !is_new {
            self.image = None;
        }
        Ok(())
    }
}

/// The channels of a pass; `texture` returns the texture of a buffer.
fn channels<'t, T>(
    graph: &Graph,
    pass: usize,
    texture: impl Fn(usize) -> Option<&'t T>,
) -> [Channel<'t, T>; 4] {
    graph.passes()[pass].inputs.map(|input| match input {
        None => Channel::Unbound,
        Some(Source::Medium(medium)) => Channel::Medium(medium),
        Some(Source::Moving(number)) => Channel::Moving(number),
        Some(Source::Keyboard) => Channel::Keyboard,
        Some(Source::Buffer(buffer)) => texture(buffer).map_or(Channel::Unbound, Channel::Texture),
    })
}
