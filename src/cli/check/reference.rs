//! The reference of shaders: the scene of each, or the shader or image that `--reference` names.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, LazyLock};
use std::time::Duration;

use toyproof_classroom::function_test::is_test_file;
use toyproof_diagnostic::{File, Files, path_name};
use toyproof_eval as eval;
use toyproof_explain::whole_image::OtherScenes;
use toyproof_image::{FrameInputs, Image};
use toyproof_project::files::{self, Input, InputSource, OutsideLink, ReadError};
use toyproof_scene::{self as scene, Scene};
use toyproof_verify::{Expected, Failure};

use super::options::CheckOptions;
use super::plan::{Plan, PlannedFrame, assignment_beside};
use super::reference_cache::CachedReference;
use crate::cli::inputs::LanguageArgs;
use crate::cli::reference::{GivenReference, ReferenceArgs};
use crate::cli::scenes::{builtin_scenes, parse_scene, read_scene, with_builtin_hint};
use crate::cli::shader::Shader;
use crate::cli::{CliError, Terminal};

/// The scene of a shader.
pub(in crate::cli) struct SceneOfShader {
    pub(in crate::cli) name: String,
    pub(in crate::cli) scene: Result<Scene, Failure>,
    pub(in crate::cli) files: Files,
}

/// Finds the scenes of shaders.
pub(in crate::cli) struct Scenes {
    /// The path and the text, or the error, of the scene that `--scene` names. The file may be a pipe, so it
    /// is read once.
    named: Option<(PathBuf, Result<File, String>)>,
}

/// The reference of a shader.
pub(super) enum Reference<'a> {
    /// A scene: the shader's own, or the one that `--scene` names.
    Scene(Box<SceneOfShader>),
    /// The shader or image that `--reference` names.
    Given(&'a PreparedReference),
}

impl Reference<'_> {
    /// The name of a scene, and that of another reference.
    pub(super) fn names(&self) -> (Option<&str>, Option<&str>) {
        match self {
            Self::Scene(scene) => (Some(&scene.name), None),
            Self::Given(prepared) => (None, Some(&prepared.given.name)),
        }
    }
}

/// A reference shader or image, rendered in the frames of all shaders.
pub(super) struct PreparedReference {
    given: GivenReference,
    /// Whether a warning has stated how much the image depends on how the shader marches.
    is_march_told: AtomicBool,
    /// One for each frame.
    pub(super) cached: Vec<Arc<CachedReference>>,
}

impl PreparedReference {
    /// The shader, if it is one.
    pub(super) fn shader(&self) -> Option<&Shader> {
        self.given.shader().map(|(shader, _)| shader)
    }

    /// The images in the frames of a plan.
    ///
    /// # Errors
    /// If a shader that is too large for the cache cannot be evaluated again.
    pub(super) fn images(&self, plan: &Plan) -> Result<Vec<Image>, eval::Failure> {
        let frames = plan.frames.iter().map(|planned| &planned.frame);
        let cached = self.cached.iter().zip(frames);
        cached
            .map(|(cached, frame)| cached.expected.image(frame))
            .collect()
    }

    /// A warning about pixels that depend on how the shader marches, once a comparison has needed it; `None`
    /// if it has been given before.
    pub(super) fn march_warning(&self, expected: &Expected) -> Option<String> {
        let dependence = expected.used_march_dependence()?;
        let is_first = !self.is_march_told.swap(true, Relaxed);
        is_first.then(|| self.given.march_warning(dependence))?
    }
}

/// Finds what shaders are compared with.
pub(super) enum References {
    /// The scene of each.
    Scenes(Scenes),
    /// The same reference for all.
    Given(PreparedReference),
}

/// Reads a shader or an image, and renders it in frames, which get the size of an image. A shader is read
/// anew for each set of values of uniforms, with the language of its frames; that of the first frame is
/// returned. `None` if the arguments name neither.
///
/// # Errors
/// Shaders cannot be compared with it.
pub(in crate::cli) fn expected_in(
    args: &ReferenceArgs,
    frames: &mut [PlannedFrame],
    language: impl Fn(&FrameInputs) -> LanguageArgs,
    timeout: Duration,
    terminal: &Terminal,
) -> Result<Option<(GivenReference, Vec<Expected>)>, CliError> {
    let mut first = None;
    let mut all = Vec::new();
    for alike in frames.chunk_by_mut(|a, b| a.inputs.uniforms == b.inputs.uniforms) {
        let Some(given) = GivenReference::read(args, &language(&alike[0].inputs), timeout)? else {
            return Ok(None);
        };
        for PlannedFrame { inputs, frame } in &mut *alike {
            given.resize(frame, inputs.size)?;
        }
        let frames = alike.iter().map(|planned| &planned.frame);
        all.extend(given.expected(frames, timeout, terminal)?);
        first.get_or_insert(given);
    }
    Ok(first.map(|first| (first, all)))
}

/// Renders a scene in frames, which get its size unless they have one.
pub(in crate::cli) fn expected_of_scene(scene: &Scene, frames: &mut [PlannedFrame]) -> Vec<Expected> {
    let with_size = |PlannedFrame { inputs, frame }: &mut PlannedFrame| {
        let mut scene = scene.clone();
        frame.size = inputs.size.unwrap_or(scene.film.size);
        scene.film.size = frame.size;
        Expected::from_scene(scene, frame)
    };
    frames.iter_mut().map(with_size).collect()
}

impl References {
    /// Reads what shaders are compared with. The frames get the size of a reference image.
    pub(super) fn new(
        options: &CheckOptions,
        plan: &mut Plan,
        terminal: &Terminal,
    ) -> Result<Self, CliError> {
        let mut frames = plan.frames.clone();
        let language = |frame: &FrameInputs| plan.language(&options.language, frame);
        let timeout = options.driver.timeout();
        let expected = expected_in(&plan.reference, &mut frames, language, timeout, terminal)?;
        let Some((given, expected)) = expected else {
            let scenes = Scenes::new(plan.reference.scene.as_deref());
            scenes.check()?;
            return Ok(Self::Scenes(scenes));
        };
        plan.frames = frames;
        let cached = expected
            .into_iter()
            .map(|expected| Arc::new(CachedReference::new(expected)));
        Ok(Self::Given(PreparedReference {
            cached: cached.collect(),
            given,
            is_march_told: AtomicBool::new(false),
        }))
    }

    /// Returns the reference of a shader; `None` if it has no scene.
    pub(super) fn find(&self, found: &Input) -> Option<Reference<'_>> {
        match self {
            Self::Scenes(scenes) => scenes.find(found).map(|scene| Reference::Scene(Box::new(scene))),
            Self::Given(given) => Some(Reference::Given(given)),
        }
    }

    /// Bytes that identify the content of a shader's reference, if it has one; an error if it cannot be read.
    pub(super) fn content(&self, found: &Input) -> Option<Result<Vec<u8>, String>> {
        match self {
            Self::Scenes(scenes) => {
                let (_, text) = scenes.text(found)?;
                Some(text.map(|text| text.text().as_bytes().to_vec()))
            }
            Self::Given(prepared) => Some(Ok(prepared.given.hash.to_vec())),
        }
    }
}

impl Scenes {
    /// Reads the scene that `--scene` names, if any.
    pub(in crate::cli) fn new(named: Option<&Path>) -> Self {
        let named = named.map(|path| (path.to_owned(), read_scene(path)));
        Self { named }
    }

    /// Checks the scene that `--scene` names, if any.
    fn check(&self) -> Result<(), CliError> {
        let Some((path, text)) = &self.named else {
            return Ok(());
        };
        if files::is_shader(path) {
            let name = path_name(path);
            let error = format!("{name} is a shader; `--scene` takes a scene file or the name of a scene");
            return Err(CliError::new(error).with_help("name a shader to compare with with --reference"));
        }
        parse_scene(text.clone()?).map(drop)
    }

    /// The path of a shader's scene, and its text or the error: the scene that `--scene` names, else the one
    /// next to the shader, unless that is a link that leads out of the folder.
    fn text(&self, found: &Input) -> Option<(PathBuf, Result<File, String>)> {
        match (&self.named, &found.source) {
            (Some(named), _) => Some(named.clone()),
            (None, InputSource::File(shader)) => {
                let beside = shader.with_extension("toml");
                if !beside.is_file() && !beside.is_symlink() || assignment_beside(found).is_some() {
                    return None;
                }
                let text = match leaving_link(found, shader, &beside) {
                    Some(skipped) => Err(format!("there is no scene to compare with: {skipped}")),
                    None if beside.is_file() => files::read_text(&beside).map_err(|error| error.to_string()),
                    None => Err(with_builtin_hint(ReadError::missing(&beside)).to_string()),
                };
                Some((beside, text))
            }
            (None, InputSource::Stream { .. }) => None,
        }
    }

    /// Parses the scene of a shader; `None` if it has none.
    pub(in crate::cli) fn find(&self, found: &Input) -> Option<SceneOfShader> {
        let (path, text) = self.text(found)?;
        let mut files = Files::default();
        let scene = text.map_err(Failure::Unreadable).and_then(|text| {
            let file = files.add(text);
            scene::parse(&files, file).map_err(|errors| Failure::InvalidScene(errors.into()))
        });
        Some(SceneOfShader {
            name: path_name(&path),
            scene,
            files,
        })
    }
}

/// The largest number of scene files in the folder of a given one that are read: a wrong shader is compared
/// with each.
const MAX_NEIGHBORS: usize = 32;

/// The scenes that a shader may render instead of its own: the built-in ones, and those in the folder of the
/// scene that `--scene` names.
pub(super) fn other_scenes(named: Option<&Path>) -> OtherScenes {
    let folder = named.filter(|path| path.is_file()).and_then(Path::parent);
    let folder = folder.map(|folder| {
        if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        }
    });
    let folder = folder.map(Path::to_owned);
    LazyLock::new(Box::new(move || {
        let mut paths: Vec<PathBuf> = folder
            .and_then(|folder| std::fs::read_dir(folder).ok())
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
            .filter(|path| !is_test_file(path))
            .collect();
        paths.sort_unstable();
        let neighbors = paths.into_iter().take(MAX_NEIGHBORS).filter_map(|path| {
            let scene = parse_scene(files::read_text(&path).ok()?).ok()?;
            Some((path.file_stem()?.to_string_lossy().into_owned(), scene))
        });
        let mut scenes: Vec<(String, Scene)> = neighbors.collect();
        scenes.extend(builtin_scenes());
        scenes
    }))
}

/// The only scene in the folder of a shader, which is not used because of its name.
pub(super) fn unused_scene(shader: &Path) -> Option<PathBuf> {
    let folder = match shader.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let paths = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| Some(entry.ok()?.path()));
    let is_scene = |path: &PathBuf| {
        let is_toml = path.extension().is_some_and(|extension| extension == "toml");
        is_toml && !is_test_file(path) && files::read_text(path).is_ok_and(|text| parse_scene(text).is_ok())
    };
    let mut scenes = paths.filter(is_scene);
    let only = scenes.next()?;
    let name = only.file_name()?;
    (scenes.next().is_none()).then(|| shader.with_file_name(name))
}

/// Checks whether the scene next to a shader is a link that leads out of the searched folder, or else of the
/// shader's own folder.
fn leaving_link(found: &Input, shader: &Path, beside: &Path) -> Option<OutsideLink> {
    let folder = found.folder.as_deref().or(shader.parent())?;
    OutsideLink::find(beside, folder)
}
