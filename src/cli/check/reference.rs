//! The scenes that shaders are compared with.

use std::path::{Path, PathBuf};

use toyproof_diagnostic::{File, Files, path_name};
use toyproof_scene::{self as scene, Scene};

use crate::cli::files::{self, Found, FoundIn, ReadError, Skipped};
use crate::cli::shader::Unusable;

/// The scene of a shader.
pub(in crate::cli) struct Reference {
    pub(in crate::cli) name: String,
    pub(in crate::cli) scene: Result<Scene, Unusable>,
    pub(in crate::cli) files: Files,
}

/// Where the scenes of shaders come from.
pub(in crate::cli) struct References {
    /// The one that `--scene` names, which may be a pipe and is read once: its path, and its text or why there is none.
    named: Option<(PathBuf, Result<File, String>)>,
}

impl References {
    /// Reads the scene that `--scene` names, if it does.
    pub(in crate::cli) fn new(named: Option<&Path>) -> Self {
        let named = named.map(|path| (path.to_owned(), text(path)));
        Self { named }
    }

    /// Where the scene of a shader is, and its text or why there is none: the one that `--scene` names, else the one beside the
    /// shader, unless it is a link that leads out of the folder.
    pub(super) fn text(&self, found: &Found) -> Option<(PathBuf, Result<File, String>)> {
        match (&self.named, &found.place) {
            (Some(named), _) => Some(named.clone()),
            (None, FoundIn::File(shader)) => {
                let beside = shader.with_extension("toml");
                if !beside.is_file() && !beside.is_symlink() {
                    return None;
                }
                let text = match leaves(found, shader, &beside) {
                    Some(skipped) => Err(format!("there is no scene to compare with: {skipped}")),
                    None if beside.is_file() => text(&beside),
                    None => Err(ReadError::Missing(beside.clone()).to_string()),
                };
                Some((beside, text))
            }
            (None, FoundIn::Stream { .. }) => None,
        }
    }

    /// The scene of a shader; none if it has none.
    pub(in crate::cli) fn find(&self, found: &Found) -> Option<Reference> {
        let (path, text) = self.text(found)?;
        let mut files = Files::default();
        let scene = text.map_err(Unusable::Trouble).and_then(|text| {
            let file = files.add(text);
            scene::parse(&files, file).map_err(Unusable::Invalid)
        });
        Some(Reference {
            name: path_name(&path),
            scene,
            files,
        })
    }
}

/// Whether what lies beside a shader is a link out of the folder that was searched, or out of the shader's own.
fn leaves(found: &Found, shader: &Path, beside: &Path) -> Option<Skipped> {
    let folder = found.folder.as_deref().or(shader.parent())?;
    Skipped::of(beside, folder)
}

fn text(path: &Path) -> Result<File, String> {
    files::read_text(path).map_err(|error| error.to_string())
}
