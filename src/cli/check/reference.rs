//! The scene that a shader is compared with.

use std::path::{Path, PathBuf};

use crate::cli::shader::Unusable;
use crate::scene::{self, Scene};
use crate::source::{self, Files, Found, FoundIn};

/// The scene of a shader.
pub(in crate::cli) struct Reference {
    pub(in crate::cli) name: String,
    pub(in crate::cli) scene: Result<Scene, Unusable>,
    pub(in crate::cli) files: Files,
}

impl Reference {
    /// Where the scene of a shader is: the one that `--scene` names, else the one beside the shader.
    pub(super) fn path(scene: Option<&Path>, found: &Found) -> Option<PathBuf> {
        match (scene, &found.place) {
            (Some(path), _) => Some(path.to_owned()),
            (None, FoundIn::File(shader)) => {
                let beside = shader.with_extension("toml");
                beside.is_file().then_some(beside)
            }
            (None, FoundIn::StandardInput) => None,
        }
    }

    /// The scene of a shader; none if it has none.
    pub(in crate::cli) fn find(scene: Option<&Path>, found: &Found) -> Option<Self> {
        let path = Self::path(scene, found)?;
        let mut files = Files::default();
        let scene = match source::read_text(&path) {
            Ok(text) => {
                let file = files.add(text);
                scene::parse(&files, file).map_err(Unusable::Invalid)
            }
            Err(error) => Err(Unusable::Trouble(error.to_string())),
        };
        Some(Self {
            name: path.display().to_string(),
            scene,
            files,
        })
    }
}
