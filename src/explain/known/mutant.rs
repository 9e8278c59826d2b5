//! Mutants: tracers with mistakes in them, and the variants of the shader that students write without a
//! mistake.

use std::sync::{Arc, OnceLock};

use toyproof_diagnostic::{File, Files};
use toyproof_eval::{Places, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl as glsl;
use toyproof_image::{Frame, Image};
use toyproof_scene::export::{self, MarkedShader, Slot};
use toyproof_scene::{FrameTime, Scene};
use toyproof_tracer::Tracer;
use toyproof_verify::bounds::MAX_ITERATIONS;
use toyproof_verify::evaluator::evaluate_at;

use crate::engine::probes::Probes;
use crate::engine::{Colors, colors_of};
use crate::known::KnownMistake;
use crate::known::catalogue::Mistake;
use crate::known::view::View;

/// The subject that a mutant renders.
#[derive(Debug, Clone)]
pub(super) enum MutantSource {
    /// A shader, rendered by the evaluator.
    Shader(MarkedShader),
    /// A changed scene, or another time, rendered by the reference tracer.
    Scene(Box<Scene>, FrameTime),
}

impl MutantSource {
    fn program(shader: &MarkedShader) -> Option<Program> {
        let mut files = Files::default();
        let file = files.add(File::new("<mistake>", shader.text.as_str()));
        let checked = glsl::check(&files, file, &glsl::Options::default()).ok()?;
        Program::prepared(&checked, UndefinedPolicy::Plain).ok()
    }

    fn tracer(scene: &Scene, frame_time: FrameTime, frame: &Frame) -> Tracer<f64> {
        let mut scene = scene.clone();
        scene.film.size = frame.size;
        Tracer::at(&scene, frame_time)
    }

    /// Renders a view; `None` if the shader is invalid or runs too many loop iterations.
    pub(super) fn render(&self, view: &View) -> Option<Image> {
        match self {
            Self::Shader(shader) => view.render(&Self::program(shader)?),
            Self::Scene(scene, frame_time) => {
                let [columns, rows] = view.places.pixels();
                Some(Self::tracer(scene, *frame_time, &view.frame).sampled(&columns, &rows))
            }
        }
    }

    /// The colors at some probes of a frame; `None` like [`Self::render`].
    pub(super) fn colors(&self, frame: &Frame, probes: &Probes) -> Option<Colors> {
        if let Some(places) = probes.grid.clone() {
            return Some(colors_of(&self.render(&View {
                frame: frame.clone(),
                places,
            })?));
        }
        let points = probes.all.iter().map(|probe| probe.point);
        match self {
            Self::Shader(shader) => {
                let program = Self::program(shader)?;
                let color = |[x, y]: [f64; 2]| {
                    let place = Places {
                        columns: vec![x],
                        rows: vec![y],
                    };
                    let image = evaluate_at(&program, frame, &place, MAX_ITERATIONS)?;
                    colors_of(&image).pop()
                };
                points.map(color).collect()
            }
            Self::Scene(scene, frame_time) => {
                let tracer = Self::tracer(scene, *frame_time, frame);
                Some(points.map(|[x, y]| tracer.pixel(x as u32, y as u32)).collect())
            }
        }
    }
}

/// A tracer with mistakes in it. Its image of one view is rendered once, on first use.
#[derive(Debug, Clone)]
pub(super) struct Mutant {
    pub(super) mistakes: Vec<KnownMistake>,
    pub(super) source: MutantSource,
    /// The mistake of the catalogue, if it is a single one.
    pub(super) edit: Option<&'static Mistake>,
    view: Arc<View>,
    image: OnceLock<Option<Image>>,
}

impl Mutant {
    pub(super) fn new(mistakes: Vec<KnownMistake>, source: MutantSource, view: &Arc<View>) -> Self {
        Self {
            mistakes,
            source,
            edit: None,
            view: Arc::clone(view),
            image: OnceLock::new(),
        }
    }

    /// Creates a mutant with one mistake of the catalogue in that shader; `None` if it does not apply.
    pub(super) fn edited(shader: &MarkedShader, mistake: &'static Mistake, view: &Arc<View>) -> Option<Self> {
        let source = MutantSource::Shader(mistake.apply(shader)?);
        Some(Self {
            edit: Some(mistake),
            ..Self::new(vec![mistake.known()], source, view)
        })
    }

    /// The same mistakes in shaders with other ray epsilons.
    pub(super) fn with_other_epsilons(&self, frame_time: FrameTime, max_offset: f64) -> Vec<Self> {
        let variants = self
            .shader(frame_time)
            .map(|shader| epsilon_variants(&shader, max_offset));
        let variants = variants.into_iter().flatten().map(MutantSource::Shader);
        variants
            .map(|source| Self::new(self.mistakes.clone(), source, &self.view))
            .collect()
    }

    pub(super) fn ids(&self) -> impl Iterator<Item = &'static str> {
        self.mistakes.iter().map(|mistake| mistake.id)
    }

    /// The image of the view. It does not wait for another thread's: a thread of rayon's that waits while it
    /// renders for another task might wait for itself.
    pub(super) fn image(&self) -> Option<&Image> {
        if self.image.get().is_none() {
            // Another thread may have been faster, with the same image.
            let _ = self.image.set(self.source.render(&self.view));
        }
        self.image.get()?.as_ref()
    }

    /// The colors at some probes.
    pub(super) fn colors(&self, probes: &Probes) -> Option<Colors> {
        if probes.grid.as_ref() == Some(&self.view.places) {
            return self.image().map(colors_of);
        }
        self.source.colors(&self.view.frame, probes)
    }

    /// The shader of this mutant, as students write it; `None` at another time.
    pub(super) fn shader(&self, frame_time: FrameTime) -> Option<MarkedShader> {
        match &self.source {
            MutantSource::Shader(shader) => Some(shader.clone()),
            MutantSource::Scene(scene, own) if *own == frame_time => variants(scene).into_iter().next(),
            MutantSource::Scene(..) => None,
        }
    }

    /// A mutant with both mistakes; `None` if they replace the same part, or both change the scene.
    pub(super) fn both(pair: [&Self; 2], frame_time: FrameTime) -> Option<Self> {
        let [one, other] = pair;
        [[one, other], [other, one]]
            .into_iter()
            .find_map(|[first, second]| {
                let shader = second.edit?.apply(&first.shader(frame_time)?)?;
                // Descriptions of changes are longer, and come last.
                let order = if first.edit.is_none() {
                    [second, first]
                } else {
                    pair
                };
                let mistakes = order
                    .into_iter()
                    .flat_map(|mutant| mutant.mistakes.iter().cloned());
                Some(Self::new(
                    mistakes.collect(),
                    MutantSource::Shader(shader),
                    &one.view,
                ))
            })
    }
}

/// Returns the shader of a scene as students write it, in each of the variants that matter; empty if it
/// cannot be exported. Correct variants render the same image; with a mistake in them they may not.
pub(super) fn variants(scene: &Scene) -> Vec<MarkedShader> {
    let Ok(mut shader) = export::marked_shader(scene) else {
        return Vec::new();
    };
    let mut rewrites: Vec<&[(Slot, &str)]> = Vec::new();
    let other_surfaces = [
        Slot::PlaneMinT,
        Slot::NearQuadricMinT,
        Slot::BoxMinT,
        Slot::GridSteps,
    ];
    if !other_surfaces.into_iter().any(|slot| shader.has(slot)) {
        if scene.objects.len() == 1 {
            rewrites.push(NO_SHADOWS);
        }
        rewrites.extend([ANY_SPHERE, ANY_SPHERE_SOFT]);
    }
    for edits in rewrites {
        shader = shader.replaced(edits).unwrap_or(shader);
    }
    let with_min_t = with_min_t(&shader);
    [Some(shader), with_min_t].into_iter().flatten().collect()
}

/// A loop over all spheres, for shadow rays in a direction.
macro_rules! any_sphere {
    ($direction:literal) => {
        concat!(
            "Ray ray = Ray(origin, ",
            $direction,
            ");
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < «ShadowLength») {
            return true;
        }
    }
    return false;"
        )
    };
}

/// A single sphere casts no shadow on itself.
const NO_SHADOWS: &[(Slot, &str)] = &[(Slot::LitAndVisible, "«Lit»")];

/// A shadow ray tests each sphere instead of finding the nearest hit; also of lights with a radius.
const ANY_SPHERE: &[(Slot, &str)] = &[(Slot::ShadowStatement, any_sphere!("«ShadowDirection»"))];
const ANY_SPHERE_SOFT: &[(Slot, &str)] = &[(Slot::SoftShadowStatement, any_sphere!("toLight"))];

/// Returns the shader whose reflected and refracted rays start on their surface and ignore nearer hits;
/// `None` if it has no such rays and no quadrics, on which a shadow ray may also start.
fn with_min_t(shader: &MarkedShader) -> Option<MarkedShader> {
    let origins = [Slot::ReflectedOrigin, Slot::RefractedOrigin];
    if shader.has(Slot::ReflectedOrigin) && shader.has(Slot::SphereMinT) {
        let at_surface = origins.into_iter().fold(shader.clone(), |shader, origin| {
            shader.with_all(origin, "hit.point")
        });
        let min_ts = [Slot::SphereMinT, Slot::BoxMinT];
        return Some(
            min_ts
                .into_iter()
                .fold(at_surface, |shader, min_t| shader.with_all(min_t, "0.001")),
        );
    }
    let min_ts = [Slot::NearQuadricMinT, Slot::FarQuadricMinT];
    shader.replaced(&min_ts.map(|slot| (slot, "0.001")))
}

/// Returns the shader with other ray epsilons: offsets of secondary rays and smallest t's, as shares of the
/// largest that the scene accepts.
pub(super) fn epsilon_variants(shader: &MarkedShader, max_offset: f64) -> Vec<MarkedShader> {
    let all = EPSILONS.into_iter().map(|[offset, min_t]| {
        let offsets = OFFSETS.map(|slot| (slot, offset * max_offset));
        let min_ts = MIN_TS.map(|slot| (slot, (min_t * max_offset).max(LEAST_MIN_T)));
        let numbers = offsets.into_iter().chain(min_ts);
        numbers.fold(shader.clone(), |shader, (slot, value)| {
            shader.with_all(slot, &format!("{value:?}"))
        })
    });
    all.filter(|other| other.text != shader.text).collect()
}

/// The offsets of secondary rays from their surfaces, and the smallest t's that count.
const OFFSETS: [Slot; 4] = [
    Slot::ShadowOffset,
    Slot::ReflectionOffset,
    Slot::RefractionOffset,
    Slot::SampledOffset,
];
const MIN_TS: [Slot; 5] = [
    Slot::BoxMinT,
    Slot::SphereMinT,
    Slot::PlaneMinT,
    Slot::NearQuadricMinT,
    Slot::FarQuadricMinT,
];

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
/// The least of the smallest t's: one below it is within the rounding error of a ray that starts on its
/// surface.
const LEAST_MIN_T: f64 = 1e-9;
