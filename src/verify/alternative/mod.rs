//! Finds how a wrong image differs as a whole from the expected one: a shader that solves its task may be
//! antialiased, mirrored, corrected for gamma, or read another input than was asked for.

mod difference;

use std::sync::LazyLock;

use toyproof_scene::Scene;

pub use self::difference::Difference;

/// What a wrong shader is compared with besides its reference.
#[derive(Debug, Clone, Copy, Default)]
pub struct Alternatives<'a> {
    /// The differences with which a shader is still correct.
    pub permitted: &'a [Difference],
    /// Other scenes, one of which a shader may render instead of its own.
    pub scenes: Option<&'a OtherScenes>,
}

/// Scenes with their names, read on first use: correct shaders need none.
pub type OtherScenes = LazyLock<Vec<(String, Scene)>, Box<dyn FnOnce() -> Vec<(String, Scene)> + Send>>;
