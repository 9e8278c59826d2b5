//! Textures that change from frame to frame: films and sounds.

use std::fmt::Debug;
use std::sync::Arc;

use crate::{Frame, Texture};

/// A texture that changes from frame to frame.
pub trait Moving: Debug + Send + Sync {
    /// The texture in a frame, by its number, its time and its rate.
    fn texture(&self, frame: &Frame) -> Texture;

    /// `iChannelTime`: the position in a frame, in seconds.
    fn position(&self, frame: &Frame) -> f32;
}

/// The textures that change, of all frames.
#[derive(Debug, Clone, Default)]
pub struct MovingTextures(pub Vec<Arc<dyn Moving>>);

impl PartialEq for MovingTextures {
    fn eq(&self, other: &Self) -> bool {
        let pairs = self.0.iter().zip(&other.0);
        self.0.len() == other.0.len() && pairs.into_iter().all(|(a, b)| Arc::ptr_eq(a, b))
    }
}
