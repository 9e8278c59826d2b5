//! Mutants: tracers with mistakes in them, and the edits that make a mistake in the shader that [`export`]
//! writes.

use crate::mistake::Named;
use crate::mistake::catalogue::Mistake;
use crate::mistake::thumbnail::View;
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use toyproof_diagnostic::{File, Files};
use toyproof_eval::{Program, Settings, UndefinedPolicy};
use toyproof_glsl as glsl;
use toyproof_image::Image;
use toyproof_scene::{FrameTime, Scene, export};
use toyproof_tracer::Tracer;

/// The time limit of an image. It is generous, since most take milliseconds and the result must not depend on
/// the machine's load.
const RENDER_TIMEOUT: Duration = Duration::from_secs(60);

/// What a mutant renders.
#[derive(Debug, Clone)]
pub(super) enum MutantSource {
    /// A shader, rendered by the evaluator.
    Shader(String),
    /// A changed scene, or another time, rendered by the reference tracer.
    Scene(Box<Scene>, FrameTime),
}

impl MutantSource {
    /// Renders a view; none if the shader is invalid or exceeds the time limit.
    pub(super) fn render(&self, view: &View) -> Option<Image> {
        match self {
            Self::Shader(text) => {
                let mut files = Files::default();
                let file = files.add(File::new("<mistake>", text.as_str()));
                let checked = glsl::check(&files, file, &glsl::Options::default()).ok()?;
                render(&Program::prepared(&checked, UndefinedPolicy::Plain).ok()?, view)
            }
            Self::Scene(scene, frame_time) => {
                let mut scene = scene.as_ref().clone();
                scene.film.size = view.frame.size;
                let [columns, rows] = view.places.pixels();
                Some(Tracer::<f64>::at(&scene, *frame_time).sampled(&columns, &rows))
            }
        }
    }
}

/// Renders a view of a shader in f64.
pub(super) fn render(program: &Program, view: &View) -> Option<Image> {
    let settings = Settings::<f64> {
        undefined: UndefinedPolicy::Plain,
        deadline: Some(Instant::now() + RENDER_TIMEOUT),
        ..Settings::default()
    };
    program.at(&view.frame, &view.places, &settings).ok()
}

/// A tracer with mistakes in it. Its image is rendered once, on first use.
#[derive(Debug)]
pub(super) struct Mutant {
    pub(super) mistakes: Vec<Named>,
    pub(super) source: MutantSource,
    /// The mistake of the catalogue, if it is a single one.
    pub(super) edit: Option<&'static Mistake>,
    image: OnceLock<Option<Image>>,
}

impl Mutant {
    pub(super) fn new(mistakes: Vec<Named>, source: MutantSource) -> Self {
        Self {
            mistakes,
            source,
            edit: None,
            image: OnceLock::new(),
        }
    }

    /// Creates a mutant with one mistake of the catalogue in that shader; none where its edits do not apply.
    pub(super) fn edited(text: &str, mistake: &'static Mistake) -> Option<Self> {
        let source = MutantSource::Shader(mistake.apply(text)?);
        Some(Self {
            edit: Some(mistake),
            ..Self::new(vec![mistake.named()], source)
        })
    }

    /// The same mistakes in shaders with other ray epsilons.
    pub(super) fn with_other_epsilons(&self, frame_time: FrameTime, max_offset: f64) -> Vec<Self> {
        let Some(text) = self.text(frame_time) else {
            return Vec::new();
        };
        let variants = epsilon_variants(&text, max_offset).into_iter();
        variants
            .map(|text| Self::new(self.mistakes.clone(), MutantSource::Shader(text)))
            .collect()
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.mistakes.iter().map(|named| named.name)
    }

    /// The image of a view, which must be the same in all calls. It does not wait for another thread's: a
    /// thread of rayon's that waits while it renders for another task might wait for itself.
    pub(super) fn image(&self, view: &View) -> Option<&Image> {
        if self.image.get().is_none() {
            // Another thread may have been faster, with the same image.
            let _ = self.image.set(self.source.render(view));
        }
        self.image.get()?.as_ref()
    }

    /// The shader of this mutant, as students write it; none at another time.
    pub(super) fn text(&self, frame_time: FrameTime) -> Option<String> {
        match &self.source {
            MutantSource::Shader(text) => Some(text.clone()),
            MutantSource::Scene(scene, own) if *own == frame_time => {
                variants(&export::shader(scene).ok()?).into_iter().next()
            }
            MutantSource::Scene(..) => None,
        }
    }
}

/// `(from, to)`. `from` occurs exactly once in the text. A `…` in it matches the text up to the first
/// occurrence of what follows it, and a `…` in `to` is replaced by that text.
pub(super) type Edit = (&'static str, &'static str);

/// Applies the edits in order; none if the text of one of them does not occur exactly once.
pub(super) fn edited(text: &str, edits: &[(&str, &str)]) -> Option<String> {
    let mut text = text.to_owned();
    for (from, to) in edits {
        let (head, tail) = from.split_once('…').unwrap_or((from, ""));
        let mut starts = text.match_indices(head).map(|(at, _)| at);
        let start = starts.next().filter(|_| starts.next().is_none())?;
        let after = start + head.len();
        let between = text[after..].find(tail)?;
        let to = to.replace('…', &text[after..after + between]);
        text.replace_range(start..after + between + tail.len(), &to);
    }
    Some(text)
}

/// Returns the exported shader as students write it, in each of the variants that matter. Correct variants
/// render the same image; with a mistake in them they may not.
pub(super) fn variants(text: &str) -> Vec<String> {
    let mut first = text.to_owned();
    let rewrite = |text: &mut String, edits: &[Edit]| {
        if let Some(edited) = edited(text, edits) {
            *text = edited;
        }
    };
    if text.contains("const int SPHERES = 1;") {
        // A single sphere casts no shadow on itself.
        rewrite(&mut first, &[NO_SHADOWS]);
    }
    if ["Plane", "Quadric", "Grid"]
        .iter()
        .all(|other| !text.contains(other))
    {
        rewrite(&mut first, &[ANY_SPHERE]);
        rewrite(&mut first, &[ANY_SPHERE_SOFT]);
    }
    let second = edited(&first, MIN_T_EDITS_IN_GLASS)
        .or_else(|| edited(&first, MIN_T_EDITS))
        .or_else(|| edited(&first, MIN_T_EDITS_OF_QUADRICS));
    [Some(first), second].into_iter().flatten().collect()
}

/// Returns the shader with other ray epsilons: offsets of secondary rays and smallest t's, as shares of the
/// largest that the scene accepts.
pub(super) fn epsilon_variants(text: &str, max_offset: f64) -> Vec<String> {
    let all = EPSILONS.into_iter().map(|[offset, t_min]| {
        let [offset, t_min] = [offset * max_offset, (t_min * max_offset).max(MIN_T)];
        // The replaced numbers occur nowhere else.
        text.replace(" 0.001 * ", &format!(" {offset:?} * "))
            .replace("> 0.00001", &format!("> {t_min:?}"))
            .replace("> 0.001)", &format!("> {t_min:?})"))
    });
    all.filter(|other| other != text).collect()
}

/// Offsets and smallest t's.
const EPSILONS: [[f64; 2]; 9] = [
    [1.0, 0.0],
    [0.5, 0.0],
    [0.2, 0.0],
    [0.1, 0.0],
    [0.01, 0.0],
    [0.0, 1.0],
    [0.0, 0.1],
    [1.0, 1.0],
    [0.1, 0.1],
];
/// The smallest t: a smaller one is below the rounding error of a ray that starts on its surface.
const MIN_T: f64 = 1e-9;

pub(super) const NO_SHADOWS: Edit = (
    "if (cosine > 0.0 && !inShadow(hit, lights[i].position)) {",
    "if (cosine > 0.0) {",
);

/// A shadow ray tests each sphere instead of finding the nearest hit.
const ANY_SPHERE: Edit = (
    "    return nearestHit(Ray(origin, toLight / distance)).t < distance;",
    "    Ray ray = Ray(origin, toLight / distance);
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    return false;",
);

/// The same for lights with a radius.
const ANY_SPHERE_SOFT: Edit = (
    "    return nearestHit(Ray(origin, toLight)).t < distance;",
    "    Ray ray = Ray(origin, toLight);
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    return false;",
);

/// Reflected rays start on their surface, and nearer hits do not count.
const MIN_T_EDITS: &[Edit] = &[
    ("Ray(hit.point + 0.001 * side,", "Ray(hit.point,"),
    NEAR_ROOT,
    FAR_ROOT,
];

/// The same where there is glass.
const MIN_T_EDITS_IN_GLASS: &[Edit] = &[
    ("Ray(hit.point + 0.001 * side,", "Ray(hit.point,"),
    ("Ray(hit.point - 0.001 * side,", "Ray(hit.point,"),
    NEAR_ROOT,
    FAR_ROOT,
];

/// Immediate hits of quadrics do not count, either.
const MIN_T_EDITS_OF_QUADRICS: &[Edit] = &[
    ("if (ahead + near > 0.00001 ", "if (ahead + near > 0.001 "),
    ("if (ahead + beyond > 0.00001 ", "if (ahead + beyond > 0.001 "),
];

const NEAR_ROOT: Edit = (
    "float t = -b - root;\n        if (t > 0.00001)",
    "float t = -b - root;\n        if (t > 0.001)",
);
const FAR_ROOT: Edit = (
    "t = -b + root;\n        if (t > 0.00001)",
    "t = -b + root;\n        if (t > 0.001)",
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_applies_only_where_its_text_occurs_once() {
        assert_eq!(
            edited("f(x, -2.0)", &[("f(x, -…)", "g(…)")]).as_deref(),
            Some("g(2.0)")
        );
        assert_eq!(edited("a b", &[("a", "b"), ("b b", "c")]).as_deref(), Some("c"));
        assert_eq!(edited("a a", &[("a", "b")]), None);
        assert_eq!(edited("a", &[("b", "c")]), None);
    }
}
