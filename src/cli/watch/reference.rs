//! The reference beside the image: what `check` compares the shader with, rendered in the moment of a tab.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use toyproof_eval::{Failure, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image, Rgb8Image};
use toyproof_project::PassKind;
use toyproof_project::files::{Input, ReadError};
use toyproof_scene::{FrameTime, Scene};
use toyproof_tracer::Tracer;
use toyproof_verify::project::bind::{accumulate, bind_reference};

use crate::cli::CliError;
use crate::cli::check::Scenes;
use crate::cli::debug::expected_color;
use crate::cli::inputs::LanguageArgs;
use crate::cli::project::{pass_shader, rendering};
use crate::cli::reference::{GivenReference, ReferenceArgs};
use crate::cli::run::evaluation_error;

/// What the shader is compared with.
pub(super) enum WatchedReference {
    Scene(String, Box<Scene>),
    Given(Box<GivenReference>),
}

/// What identifies an image of a reference.
#[derive(PartialEq)]
struct Key {
    scene: Option<Scene>,
    hash: Option<[u8; 32]>,
    size: [u32; 2],
    frame: i32,
    time: f32,
    mouse: [f32; 4],
}

/// The largest number of images of references that are kept: those of the tabs.
const MAX_IMAGES: usize = 4;

/// The images of references that were shown last, the latest first.
#[derive(Default)]
pub(super) struct References(VecDeque<(Key, Arc<Rgb8Image>)>);

impl WatchedReference {
    /// Reads the reference that the arguments name, else the scene beside the shader; `None` without one.
    pub(super) fn read(
        args: &ReferenceArgs,
        input: &Result<Input, ReadError>,
        language: &LanguageArgs,
        timeout: Duration,
    ) -> Result<Option<Self>, CliError> {
        if let Some(given) = GivenReference::read(args, language, timeout)? {
            return Ok(Some(Self::Given(Box::new(given))));
        }
        let Ok(input) = input else {
            return Ok(None);
        };
        let Some(found) = Scenes::new(args.scene.as_deref()).find(input) else {
            return Ok(None);
        };
        let name = found.name;
        let scene = found.scene.map_err(|failure| match failure {
            toyproof_verify::Failure::InvalidScene(errors) => CliError::diagnostics(errors, &found.files),
            other => CliError::new(format_args!("{name}: {other}")),
        })?;
        Ok(Some(Self::Scene(name, Box::new(scene))))
    }

    /// The name, as the user gave it.
    pub(super) fn name(&self) -> &str {
        match self {
            Self::Scene(name, _) => name,
            Self::Given(given) => &given.name,
        }
    }

    /// The scene, if it is one.
    pub(super) fn scene(&self) -> Option<&Scene> {
        match self {
            Self::Scene(_, scene) => Some(scene),
            Self::Given(_) => None,
        }
    }

    /// The size that the reference gives to the image, in pixels, if it has one.
    pub(super) fn size(&self) -> Option<[u32; 2]> {
        match self {
            Self::Scene(_, scene) => Some(scene.film.size),
            Self::Given(_) => self.fixed_size(),
        }
    }

    /// The only size of the reference: that of an image.
    pub(super) fn fixed_size(&self) -> Option<[u32; 2]> {
        match self {
            Self::Given(given) => given.image().map(Image::size),
            Self::Scene(..) => None,
        }
    }

    /// Whether the reference may depend on the moment.
    pub(super) fn is_animated(&self) -> bool {
        match self {
            Self::Scene(_, scene) => !scene.motions.is_empty(),
            Self::Given(given) => given.shader().is_some(),
        }
    }

    fn key(&self, frame: &Frame) -> Key {
        let (scene, hash) = match self {
            Self::Scene(_, scene) => (Some(Scene::clone(scene)), None),
            Self::Given(given) => (None, Some(given.hash)),
        };
        let moment = if self.is_animated() {
            (frame.frame, frame.time, frame.mouse)
        } else {
            Default::default()
        };
        Key {
            scene,
            hash,
            size: frame.size,
            frame: moment.0,
            time: moment.1,
            mouse: moment.2,
        }
    }

    /// Renders the reference in a frame; `None` if it is an image of another size. A shader that has passes
    /// accumulates its samples, as the reference then does.
    pub(super) fn image(
        &self,
        frame: &Frame,
        has_history: bool,
        (timeout, stop): (Duration, &AtomicBool),
    ) -> Result<Option<Rgb8Image>, RenderError> {
        match self {
            Self::Scene(_, scene) => {
                let mut scene = Scene::clone(scene);
                scene.film.size = frame.size;
                if has_history {
                    accumulate(&mut scene, frame.frame);
                }
                let time = FrameTime {
                    frame: frame.frame,
                    time: f64::from(frame.time),
                };
                let image = Tracer::<f64>::at(&scene, time).render(|| ());
                Ok(Some((&image).into()))
            }
            Self::Given(given) => match (given.image(), given.shader()) {
                (Some(image), _) => Ok((image.size() == frame.size).then(|| image.into())),
                (None, Some((shader, checked))) => {
                    let mut frame = frame.clone();
                    if let Some(passes) = shader.project() {
                        let rendering = rendering(passes, PassKind::Image, frame.size);
                        let bound = rendering.and_then(|rendering| {
                            bind_reference(&pass_shader(passes, &rendering), &mut frame, timeout)
                        });
                        bound.map_err(|failure| RenderError::Failed(failure.to_string()))?;
                    }
                    let failed = |failure: Failure| match failure {
                        Failure::Interrupted => RenderError::Stopped,
                        failure => RenderError::Failed(evaluation_error(&failure, shader).in_one_line()),
                    };
                    let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(timeout));
                    let program = program.map_err(|refusal| failed(refusal.into()))?;
                    let settings = Settings::<f64> {
                        deadline: Some(Instant::now() + timeout),
                        interrupt: Some(stop),
                        ..Settings::plain()
                    };
                    let rendered = program
                        .render_rows(&frame, frame.rows(), &settings)
                        .map_err(failed)?;
                    Ok(Some((&rendered.image).into()))
                }
                (None, None) => Ok(None),
            },
        }
    }

    /// The expected color in a pixel, where it takes little time.
    pub(super) fn pixel(&self, frame: &Frame, pixel @ [x, y]: [u32; 2]) -> Option<[f64; 3]> {
        match self {
            Self::Scene(_, scene) => Some(expected_color(Scene::clone(scene), frame, pixel)),
            Self::Given(given) => {
                let image = given.image().filter(|image| image.size() == frame.size)?;
                let [r, g, b, _] = image.get(x, y);
                Some([r, g, b].map(f64::from))
            }
        }
    }
}

/// Why there is no image.
pub(super) enum RenderError {
    Stopped,
    Failed(String),
}

impl References {
    /// An image that was rendered before.
    pub(super) fn find(&self, reference: &WatchedReference, frame: &Frame) -> Option<Arc<Rgb8Image>> {
        let key = reference.key(frame);
        let found = self.0.iter().find(|(known, _)| *known == key);
        found.map(|(_, image)| Arc::clone(image))
    }

    /// Keeps an image.
    pub(super) fn keep(&mut self, reference: &WatchedReference, frame: &Frame, image: Arc<Rgb8Image>) {
        self.0.truncate(MAX_IMAGES - 1);
        self.0.push_front((reference.key(frame), image));
    }
}
