//! A tracer with a mistake in it, and what it paints.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{File, Files};
use toyproof_eval::{Program, Settings, Variant};
use toyproof_glsl as glsl;
use toyproof_image::Image;
use toyproof_scene::{Moment, Scene, export};
use toyproof_tracer::Tracer;

use super::Named;
use super::catalogue::Mistake;
use super::edit::{restyled, styles};
use super::look::View;

/// The longest that one picture may take, whatever becomes of it: most take milliseconds, and what is said must not depend on how busy the
/// machine is.
const PATIENCE: Duration = Duration::from_secs(60);

/// What paints a wrong picture.
#[derive(Debug, Clone)]
pub(super) enum Made {
    /// A shader, painted by the evaluator.
    Shader(String),
    /// A scene that is not the one asked for, or another moment of it, painted by the reference tracer.
    Scene(Box<Scene>, Moment),
}

impl Made {
    /// None where there is no picture: what was made is no shader, or takes too long.
    pub(super) fn paint(&self, view: &View) -> Option<Image> {
        match self {
            Self::Shader(text) => {
                let mut files = Files::default();
                let file = files.add(File::new("<mistake>", text.as_str()));
                let checked = glsl::check(&files, file, &glsl::Options::default()).ok()?;
                paint(&Program::prepared(&checked, Variant::Plain).ok()?, view)
            }
            Self::Scene(scene, moment) => {
                let mut scene = scene.as_ref().clone();
                scene.film.size = view.frame.size;
                let [columns, rows] = view.places.pixels();
                Some(Tracer::<f64>::at(&scene, *moment).sampled(&columns, &rows))
            }
        }
    }
}

/// What a shader shows of a view in f64.
pub(super) fn paint(program: &Program, view: &View) -> Option<Image> {
    let settings = Settings::<f64> {
        variant: Variant::Plain,
        deadline: Some(Instant::now() + PATIENCE),
        ..Settings::default()
    };
    program.at(&view.frame, &view.places, &settings).ok()
}

/// A tracer with mistakes in it. Its picture is painted once, when it is first asked for.
#[derive(Debug)]
pub(super) struct Suspect {
    pub(super) mistakes: Vec<Named>,
    pub(super) made: Made,
    /// The mistake, where it is one alone, and an edit.
    pub(super) edit: Option<&'static Mistake>,
    picture: OnceLock<Option<Image>>,
}

impl Suspect {
    pub(super) fn new(mistakes: Vec<Named>, made: Made) -> Self {
        Self {
            mistakes,
            made,
            edit: None,
            picture: OnceLock::new(),
        }
    }

    /// With one mistake of the catalogue in that shader; none where it cannot be made.
    pub(super) fn edited(text: &str, mistake: &'static Mistake) -> Option<Self> {
        let made = Made::Shader(mistake.made_in(text)?);
        Some(Self {
            edit: Some(mistake),
            ..Self::new(vec![mistake.named()], made)
        })
    }

    /// The same mistakes in shaders whose secondary rays start in other ways.
    pub(super) fn in_other_styles(&self, moment: Moment, max_offset: f64) -> Vec<Self> {
        let Some(text) = self.text(moment) else {
            return Vec::new();
        };
        let others = restyled(&text, max_offset).into_iter();
        others
            .map(|text| Self::new(self.mistakes.clone(), Made::Shader(text)))
            .collect()
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.mistakes.iter().map(|named| named.name)
    }

    /// The picture in that view, which must always be the same. Nobody waits for it: a thread of rayon's that did, while it paints another
    /// for somebody else, might wait for itself.
    pub(super) fn picture(&self, view: &View) -> Option<&Image> {
        if self.picture.get().is_none() {
            // Somebody may have been faster, with the same picture.
            let _ = self.picture.set(self.made.paint(view));
        }
        self.picture.get()?.as_ref()
    }

    /// The shader that paints this, as students write it; none of another moment.
    pub(super) fn text(&self, moment: Moment) -> Option<String> {
        match &self.made {
            Made::Shader(text) => Some(text.clone()),
            Made::Scene(scene, own) if *own == moment => {
                styles(&export::shader(scene).ok()?).into_iter().next()
            }
            Made::Scene(..) => None,
        }
    }
}
