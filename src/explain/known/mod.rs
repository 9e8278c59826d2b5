//! Finds the mistake that explains a wrong image: the image is compared with those of mutants, tracers with
//! one classic mistake, and with two at once where no single one explains it. A mistake replaces parts of the
//! shader that renders the scene (`catalogue`), changes the scene (`change`), or is one wrong number
//! (`numbers`).

mod catalogue;
mod change;
pub mod documentation;
pub(crate) mod documented;
mod mutant;
mod numbers;
mod pair;
mod view;

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};

use rayon::prelude::*;
use toyproof_diagnostic::Span;
use toyproof_eval::Places;
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image};
use toyproof_scene::export::MarkedShader;
use toyproof_scene::{FrameTime, Scene};
use toyproof_verify::MAX_DIFFERING;
use toyproof_verify::random::NoisyPixel;

use crate::engine::bias::remaining_bias;
use crate::known::documented::{Documented, documented};
use crate::known::mutant::{Mutant, MutantSource};
use crate::known::view::{COMPLETELY, MOSTLY, Observation, ROUGHLY, View, cost_per_pixel};

/// A mistake that a shader may have, or a symptom of many mistakes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KnownMistake {
    /// The id, such as `far-root`, under which the guide lists it.
    pub id: &'static str,
    /// The bug in the shader, to follow “likely mistake: ”.
    pub description: Cow<'static, str>,
    /// Whether it is only a symptom of many mistakes: most of the image is lost.
    pub is_symptom: bool,
    /// Its place in the shader, if known.
    pub at: Option<Span>,
}

impl KnownMistake {
    pub(crate) fn new(id: &'static str, description: impl Into<Cow<'static, str>>) -> Self {
        Self {
            id,
            description: description.into(),
            is_symptom: false,
            at: None,
        }
    }
}

/// What the guide says about rays that hit the surface they start from.
pub(crate) const SELF_INTERSECTION: &[Documented; 1] = documented! {
    /// Start the ray at `point + 1e-3 * normal` (`point - 1e-3 * normal` for rays that enter glass), or
    /// accept only hits with `t > 1e-3`.
    SelfIntersection "self-intersection":
        "self-intersection (shadow acne): secondary rays start on the surface; offset the origin along the normal or use a minimum t of about 1e-3";
};

/// Rays that hit the surface they start from.
pub(crate) fn self_intersection() -> KnownMistake {
    let [documented] = SELF_INTERSECTION;
    KnownMistake::new(documented.id, documented.form)
}

/// What explains a wrong image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnosis {
    /// The mistake, or two that were made at once; never empty.
    pub mistakes: Vec<KnownMistake>,
    /// Other mistakes that alone render the same image, the most likely first.
    pub alternatives: Vec<KnownMistake>,
}

/// The largest number of alternative mistakes that are reported.
const MAX_ALTERNATIVES: usize = 3;

impl Diagnosis {
    /// A single mistake without alternatives.
    pub(crate) fn single(mistake: KnownMistake) -> Self {
        Self {
            mistakes: vec![mistake],
            alternatives: Vec::new(),
        }
    }

    /// The mistakes of a mutant. The `others` render the same image.
    fn new(mutant: &Mutant, others: &[&Mutant]) -> Self {
        let mistakes = mutant.mistakes.clone();
        let mut alternatives: Vec<KnownMistake> = Vec::new();
        for other in others.iter().flat_map(|other| &other.mistakes) {
            // A change of the scene may be equivalent to an edit of the shader.
            let is_same =
                |known: &KnownMistake| known.id == other.id || known.description == other.description;
            if alternatives.len() < MAX_ALTERNATIVES && !mistakes.iter().chain(&alternatives).any(is_same) {
                alternatives.push(other.clone());
            }
        }
        Self {
            mistakes,
            alternatives,
        }
    }

    /// The id of the mistake; for two at once both ids, such as `no-aspect+no-gamma`.
    #[must_use]
    pub fn id(&self) -> String {
        let ids: Vec<&str> = self.mistakes.iter().map(|mistake| mistake.id).collect();
        ids.join("+")
    }
}

/// A part of the search for the mistake, in the order of the parts. The later ones find nothing where a
/// single mistake matches, even if it is not reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The mistakes of the catalogue, and changes of the scene.
    Single,
    /// One wrong number, and single mistakes with other ray epsilons.
    Number,
    /// Two mistakes at once, in at most that many pairs.
    Pair(usize),
}

/// The largest width and height, in pixels, and the largest work of the first comparison, so that hundreds of
/// images take seconds.
const SMALL_SIDE: u32 = 96;
const SMALL_WORK: u64 = 100_000;

/// The largest work of the image that confirms a mistake.
const LARGE_WORK: u64 = 16 * SMALL_WORK;

/// The smallest number of pixels of an image that is compared.
const MIN_VIEW_PIXELS: u32 = 256;

/// The number of wrong pixels below which larger images are compared, and the factor of their width and
/// height.
const MIN_WRONG_PIXELS_SMALL: usize = 32;
const FINE_FACTOR: u32 = 3;

/// The number of wrong pixels below which the cause may be anything, even other ray epsilons.
const MIN_WRONG_PIXELS: usize = 8;

/// The largest number of mistakes, besides the first, that render the same image; with more, there are too
/// many explanations and no mistake is reported.
const MAX_OTHER_MISTAKES: usize = 3;

/// The smallest number of pixels that a mistake must explain, all of them, and the largest number that are
/// compared.
const MIN_EXPLAINED_PIXELS: usize = 4;
const MAX_COMPARED_PIXELS: usize = 40;

/// The factor by which a near miss may exceed the unexplained pixels, and the largest number of near misses
/// that are tried with other ray epsilons.
const NEAR_MISS_FACTOR: usize = 6;
const MAX_NEAR_MISSES: usize = 8;

/// The number of pairs of mistakes that are rendered before they are compared, and the largest width and
/// height of the image by which most pairs are ruled out.
const PAIR_BATCH: usize = 32;
const PAIR_SIDE: u32 = 24;

/// The largest difference of the remaining bias from the least one, of mistakes that explain a stochastic
/// shader as well.
const MAX_REMAINING_DIFFERENCE: f64 = 0.05;

/// The mutants of a scene. Their images are rendered once, on first use.
#[derive(Debug)]
pub struct Hypotheses {
    scene: Scene,
    frame_time: FrameTime,
    /// The view of the first comparison.
    small: Arc<View>,
    /// The tracer and the shaders without a mistake.
    correct: Vec<Mutant>,
    /// Mutants that lose most of the image, so that many mistakes may be the cause.
    general: Vec<Mutant>,
    wrong: Vec<Mutant>,
    /// The shader that renders the scene, as students write it, in each of the variants that matter.
    shaders: Vec<MarkedShader>,
    /// The hypotheses for larger images, created when needed; `None` if these are large.
    fine: Option<OnceLock<Box<Hypotheses>>>,
}

impl Hypotheses {
    /// Creates the hypotheses for images of a frame; `None` if the scene is so expensive that no image worth
    /// comparing is small enough.
    #[must_use]
    pub fn new(scene: &Scene, frame: &Frame) -> Option<Self> {
        let small = View::new(frame, SMALL_SIDE, SMALL_WORK / cost_per_pixel(scene));
        let pixels: u64 = frame.size.into_iter().map(u64::from).product();
        let is_enough = small.pixels() >= u64::from(MIN_VIEW_PIXELS).min(pixels);
        is_enough.then(|| Self::in_view(scene, small, Some(OnceLock::new())))
    }

    fn in_view(scene: &Scene, small: View, fine: Option<OnceLock<Box<Self>>>) -> Self {
        let frame_time = FrameTime::from(&small.frame);
        let small = Arc::new(small);
        let shaders = mutant::variants(scene);
        let tracer = MutantSource::Scene(Box::new(scene.clone()), frame_time);
        let correct = [tracer]
            .into_iter()
            .chain(shaders.iter().cloned().map(MutantSource::Shader));
        let changed = |change: change::Change| {
            let source = MutantSource::Scene(Box::new(change.scene), change.frame_time);
            Mutant::new(vec![change.mistake], source, &small)
        };
        let edited = shaders.iter().flat_map(|shader| {
            catalogue::all().filter_map(|mistake| Mutant::edited(shader, mistake, &small))
        });
        let changes = change::all(scene, frame_time).into_iter().map(changed);
        Self {
            scene: scene.clone(),
            frame_time,
            correct: correct
                .map(|source| Mutant::new(Vec::new(), source, &small))
                .collect(),
            general: change::general(scene, frame_time)
                .into_iter()
                .map(changed)
                .collect(),
            wrong: edited.chain(changes).collect(),
            shaders,
            fine,
            small: Arc::clone(&small),
        }
    }

    /// Returns the hypotheses for images large enough to distinguish mistakes where few pixels are wrong.
    fn fine(&self, frame: &Frame) -> Option<&Self> {
        let fine = self.fine.as_ref()?;
        let work = u64::from(FINE_FACTOR * FINE_FACTOR) * SMALL_WORK / cost_per_pixel(&self.scene);
        let large = View::new(frame, FINE_FACTOR * SMALL_SIDE, work);
        let create = || Box::new(Self::in_view(&self.scene, large.clone(), None));
        (large.pixels() > self.small.pixels()).then(|| fine.get_or_init(create).as_ref())
    }

    /// General mistakes first: of those that render the same image, they claim least.
    fn mutants(&self) -> impl Iterator<Item = &Mutant> {
        self.general.iter().chain(&self.wrong)
    }

    /// Returns the mistake, or the two, that render the `student`'s image of that frame, in f64. The result
    /// does not depend on the machine's load.
    #[must_use]
    pub fn recognize(&self, student: &Program, frame: &Frame, pairs: usize) -> Option<Diagnosis> {
        let stages = [Stage::Single, Stage::Number, Stage::Pair(pairs)];
        stages
            .into_iter()
            .find_map(|stage| self.recognize_in(stage, student, frame))
    }

    /// Returns what [`Self::recognize`] finds in one of its stages.
    #[must_use]
    pub fn recognize_in(&self, stage: Stage, student: &Program, frame: &Frame) -> Option<Diagnosis> {
        let correct = self.correct.iter().filter_map(Mutant::image);
        let observed = Observation::new(student, &self.small, correct, MOSTLY)?;
        let (pixels, differing) = (observed.probes.all.len(), observed.probes.wrong());
        if differing < MIN_WRONG_PIXELS_SMALL
            && let Some(fine) = self.fine(frame)
        {
            return fine.recognize_in(stage, student, frame);
        }
        if differing < MIN_WRONG_PIXELS || differing as f64 <= pixels as f64 * MAX_DIFFERING {
            return None;
        }
        let confirmed = |mutant: &Mutant, others: &[&Mutant]| {
            let is_confirmed = self.is_confirmed(mutant, student, frame);
            is_confirmed.then(|| Diagnosis::new(mutant, others))
        };
        let general = matching(&observed, &self.general);
        let single = matching(&observed, &self.wrong);
        if stage == Stage::Single {
            return match (general.first(), &single[..]) {
                (Some(_), [single]) => confirmed(single, &[]),
                (Some(general), singles) => confirmed(general, singles),
                (None, [first, others @ ..]) if others.len() <= MAX_OTHER_MISTAKES => {
                    confirmed(first, others)
                }
                _ => None,
            };
        }
        // Some numbers remove all color from any image, and so do many pairs: an image of one color allows no
        // further conclusion.
        let is_of_one_color = observed.image.pixels().windows(2).all(|pair| pair[0] == pair[1]);
        if !general.is_empty() || !single.is_empty() || is_of_one_color {
            return None;
        }
        let explaining = |mutants: &[Mutant]| {
            matching(&observed, mutants)
                .first()
                .and_then(|mutant| confirmed(mutant, &[]))
        };
        if let Stage::Pair(most) = stage {
            self.pairs(student, &observed, most, &explaining)
        } else {
            let Self {
                scene,
                frame_time,
                shaders,
                small: view,
                ..
            } = self;
            let (frame_time, shader) = (*frame_time, shaders.first());
            let fitted = numbers::Parameters {
                scene,
                frame_time,
                shader,
                view,
            }
            .fitted(&observed.probes);
            if !matching(&observed, &fitted).is_empty() {
                return explaining(&fitted);
            }
            explaining(&self.near_misses(&observed))
        }
    }

    /// Tries two mistakes at once.
    fn pairs(
        &self,
        student: &Program,
        observed: &Observation,
        most: usize,
        explaining: &dyn Fn(&[Mutant]) -> Option<Diagnosis>,
    ) -> Option<Diagnosis> {
        let view = View::new(&self.small.frame, PAIR_SIDE, u64::MAX);
        let correct = self.correct.first()?.source.render(&view)?;
        let few = Observation::new(student, &view, [&correct].into_iter(), ROUGHLY)?;
        let mut likely = pair::likely(self.mutants(), &observed.probes);
        likely.truncate(most);
        likely.chunks(PAIR_BATCH).find_map(|pairs| {
            let mutants = pairs
                .par_iter()
                .filter_map(|&pair| Mutant::both(pair, self.frame_time));
            let mutants: Vec<Mutant> = mutants.filter(|pair| few.is_explained_by(pair)).collect();
            explaining(&mutants)
        })
    }

    /// Mutants that leave few pixels more than they may, with other ray epsilons, which might explain these.
    fn near_misses(&self, observed: &Observation) -> Vec<Mutant> {
        let limit = NEAR_MISS_FACTOR * observed.most().max(1);
        let near_misses = self
            .mutants()
            .filter_map(|mutant| Some((observed.unexplained(mutant)?.0, mutant)));
        let near_misses = near_misses.filter(|&(left, _)| left <= limit && left < observed.probes.wrong());
        let mut near_misses: Vec<_> = near_misses.collect();
        near_misses.sort_by_key(|&(left, _)| left);
        let nearest = near_misses.into_iter().take(MAX_NEAR_MISSES);
        nearest
            .flat_map(|(_, mutant)| mutant.with_other_epsilons(self.frame_time, self.scene.max_offset))
            .collect()
    }

    /// Whether a mutant explains a larger image as well, perhaps with other ray epsilons.
    fn is_confirmed(&self, mutant: &Mutant, student: &Program, frame: &Frame) -> bool {
        let large = View::new(frame, u32::MAX, LARGE_WORK / cost_per_pixel(&self.scene));
        let correct = self
            .correct
            .first()
            .and_then(|correct| correct.source.render(&large));
        let observed = Observation::new(student, &large, correct.iter(), MOSTLY);
        observed.is_some_and(|observed| {
            let others = || mutant.with_other_epsilons(self.frame_time, self.scene.max_offset);
            let explains = |mutant: &Mutant| observed.is_explained_by(mutant);
            explains(mutant) || others().par_iter().any(explains)
        })
    }

    /// Returns the mistake that explains a few pixels in which the `student`'s shader has a wrong color, and
    /// no others; `None` with fewer than `MIN_EXPLAINED_PIXELS` pixels.
    #[must_use]
    pub fn explaining(&self, student: &Program, pixels: &[[u32; 2]]) -> Option<Diagnosis> {
        if pixels.len() < MIN_EXPLAINED_PIXELS {
            return None;
        }
        let step = pixels.len().div_ceil(MAX_COMPARED_PIXELS);
        let coordinates = |axis: usize| {
            let places: BTreeSet<u32> = pixels.iter().step_by(step).map(|pixel| pixel[axis]).collect();
            places.into_iter().map(|place| f64::from(place) + 0.5).collect()
        };
        let places = Places {
            columns: coordinates(0),
            rows: coordinates(1),
        };
        let view = View {
            frame: self.small.frame.clone(),
            places,
        };
        let correct = self.correct.first()?.source.render(&view)?;
        let observed = Observation::new(student, &view, [&correct].into_iter(), COMPLETELY)?;
        if observed.probes.wrong() < MIN_EXPLAINED_PIXELS {
            return None;
        }
        let explaining = self
            .wrong
            .par_iter()
            .filter(|mutant| observed.is_explained_by(mutant));
        let explaining: Vec<&Mutant> = explaining.collect();
        let (first, others) = explaining.split_first()?;
        (others.len() <= MAX_OTHER_MISTAKES).then(|| Diagnosis::new(first, others))
    }

    // Stochastic shaders, whose pixels equal no mutant's.

    /// The pixels that [`Self::recognize_noisy`] takes.
    #[must_use]
    pub fn places(&self) -> &Places {
        &self.small.places
    }

    /// Returns the mistake of a stochastic shader, from its pixels at [`Self::places`]: the mean difference
    /// of such a shader is projected onto the change of each mistake, which is the most powerful test for it.
    #[must_use]
    pub fn recognize_noisy(&self, pixels: &[NoisyPixel]) -> Option<Diagnosis> {
        let correct = self.correct.first()?.image()?;
        let part = |image: &Image, at: usize, i: usize| f64::from(image.pixels()[at][i]).clamp(0.0, 1.0);
        let remaining = |mutant: &Mutant| {
            let wrong = mutant.image()?;
            let change = |at| std::array::from_fn(|i| part(wrong, at, i) - part(correct, at, i));
            remaining_bias(pixels, (0..pixels.len()).map(change))
        };
        let all = self.general.par_iter().chain(&self.wrong);
        let fitting: Vec<(f64, &Mutant)> = all
            .filter_map(|mutant| Some((remaining(mutant)?, mutant)))
            .collect();
        let least = fitting
            .iter()
            .map(|&(remaining, _)| remaining)
            .min_by(f64::total_cmp)?;
        let best = fitting
            .into_iter()
            .filter(|&(remaining, _)| remaining <= least + MAX_REMAINING_DIFFERENCE);
        let best = first_of_each_id(best.map(|(_, mutant)| mutant));
        let (first, others) = best.split_first()?;
        (others.len() <= MAX_OTHER_MISTAKES).then(|| Diagnosis::new(first, others))
    }
}

/// Returns the mutants that explain an image best, one of each id.
fn matching<'m>(observed: &Observation, mutants: &'m [Mutant]) -> Vec<&'m Mutant> {
    let all = mutants
        .par_iter()
        .filter_map(|mutant| Some((observed.unexplained(mutant)?, mutant)));
    let all: Vec<_> = all.filter(|((_, are_few), _)| *are_few).collect();
    let least = all.iter().map(|((left, _), _)| *left).min();
    let best = all.into_iter().filter(|((left, _), _)| Some(*left) == least);
    first_of_each_id(best.map(|(_, mutant)| mutant))
}

fn first_of_each_id<'m>(mutants: impl Iterator<Item = &'m Mutant>) -> Vec<&'m Mutant> {
    let mut first: Vec<&Mutant> = Vec::new();
    for mutant in mutants {
        if first.iter().all(|other| other.ids().ne(mutant.ids())) {
            first.push(mutant);
        }
    }
    first
}

/// The scenes of the exercises.
#[cfg(test)]
mod exercises {
    use toyproof_diagnostic::{File, Files};
    use toyproof_scene::{Scene, parse};

    macro_rules! exercises {
        ($($name:literal),* $(,)?) => {
            [$(($name, include_str!(concat!("../../../glsl/", $name, ".toml")))),*]
        };
    }

    /// The name and the text of each.
    pub(super) const EXERCISES: [(&str, &str); 15] = exercises![
        "01-sampling",
        "02-sphere",
        "03-shading",
        "04-many-objects",
        "05-complex-scene",
        "06-reflections",
        "07-diffuse",
        "08-disney",
        "09-soft-shadows",
        "10-quadrics",
        "11-animation",
        "12-whitted",
        "13-importance-sampling",
        "14-accelerator",
        "15-parallel-rays",
    ];

    /// Scenes with features that no exercise has.
    const OTHER_SCENES: [&str; 5] = [NESTED_MOTIONS, BOTH_GLASSES, DIFFUSE_PATHS, MOVED_CAMERA, TURNED];

    /// A turned camera, a turned box, and patterns.
    pub(super) const TURNED: &str = r#"
        camera = { eye = [2, 3, 1], look_at = [0.1, 0, -6], roll = 20, fov = 50 }
        light = [{ position = [9, 9, 5] }]
        box = [
            { center = [-0.8, 0.2, -6], size = [1.5, 1.2, 1], axis = [0.2, 1, 0], angle = 30, material = { model = "lambert", color = [0.9, 0.4, 0.2], checker = { color = [0.2, 0.3, 0.4], size = 0.3, space = "object" } } },
        ]
        sphere = [
            { center = [1.2, 0, -6.5], radius = 1, material = { model = "lambert", color = [0.2, 0.4, 0.9], stripes = { color = [0.9, 0.9, 0.6], size = 0.3, direction = [1, 2, 0], space = "object" } } },
        ]
    "#;

    const NESTED_MOTIONS: &str = r#"
        motion = [
            { name = "a", axis = [0, 1, 0], seconds = 2 },
            { name = "b", axis = [0, 1, 0], seconds = 2, within = "a" },
            { name = "c", axis = [0, 1, 0], seconds = 2, within = "b" },
            { name = "d", axis = [0, 1, 0], seconds = 2, within = "c" },
        ]
        sphere = [
            { center = [0, 0, -6], radius = 1, motion = "d", material = { model = "facing", color = [1, 1, 0] } },
        ]
    "#;

    const BOTH_GLASSES: &str = r#"
        sphere = [
            { center = [-2, 0, -6], radius = 1, material = { model = "glass", color = [1, 1, 0], ior = 1.5 } },
            { center = [2, 0, -6], radius = 1, material = { model = "glass", color = [1, 1, 0], ior = 1.5, fresnel = "schlick" } },
        ]
    "#;

    const MOVED_CAMERA: &str = r#"
        camera = { eye = [0, 1, 0] }
        sphere = [{ center = [0, 0, -6], radius = 1, material = { model = "facing", color = [1, 1, 0] } }]
    "#;

    const DIFFUSE_PATHS: &str = r#"
        film = { integrator = "path", max_depth = 3, samples = 2, sampler = "independent" }
        sphere = [
            { center = [0, 4, -6], radius = 1, material = { model = "emitter", color = [9, 9, 9] } },
            { center = [0, 0, -6], radius = 1, material = { model = "diffuse", color = [1, 1, 0] } },
        ]
    "#;

    /// The scenes of the exercises, and others, so that each mistake can be made in one of them.
    pub(super) fn scenes() -> impl Iterator<Item = Scene> {
        let exercises = EXERCISES.into_iter().map(|(_, text)| text);
        exercises.chain(OTHER_SCENES).map(scene_of)
    }

    pub(super) fn scene_of(text: &str) -> Scene {
        let mut files = Files::default();
        let file = files.add(File::new("scene", text));
        parse(&files, file).unwrap()
    }
}

#[cfg(test)]
mod tests {
    use super::exercises::scenes;
    use super::*;

    #[test]
    fn alternatives_are_few_and_not_repeated() {
        let scene = scenes().next().unwrap();
        let mutant = |id, description: &'static str| {
            let source = MutantSource::Scene(Box::new(scene.clone()), FrameTime::default());
            let view = Arc::new(View::new(&Frame::default(), 1, 1));
            Mutant::new(vec![KnownMistake::new(id, description)], source, &view)
        };
        let first = mutant("a", "one");
        let others = [
            mutant("a", "two"),
            mutant("b", "one"),
            mutant("c", "three"),
            mutant("c", "four"),
            mutant("d", "five"),
            mutant("e", "six"),
            mutant("f", "seven"),
        ];
        let diagnosis = Diagnosis::new(&first, &others.iter().collect::<Vec<_>>());
        assert_eq!(diagnosis.id(), "a");
        let alternatives: Vec<_> = diagnosis.alternatives.iter().map(|known| known.id).collect();
        assert_eq!(alternatives, ["c", "d", "e"]);
    }
}
