//! What went wrong, by name: a wrong picture is compared with those of tracers that have one classic mistake in them, and with
//! two at once where no single one explains it. Mistakes are edits of the shader that paints the scene, changes of the scene, or
//! a number that is not the scene's.

mod catalogue;
mod change;
mod edit;
mod fit;
mod look;
mod noisy;
mod pair;
mod suspect;

use std::borrow::Cow;
use std::sync::OnceLock;

use rayon::prelude::*;
use toyproof_eval::{Places, Program};
use toyproof_image::Frame;
use toyproof_scene::{Moment, Scene, export};

use self::look::{Glance, Looked, View, differing, left_over, pixels, work};
pub use self::noisy::NoisyPixel;
use self::suspect::{Made, Suspect, paint};
use crate::compare::MAX_DIFFERING;

/// What explains a wrong picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// The mistake.
    pub name: &'static str,
    /// What a tracer does that makes it, to stand after “a tracer that”.
    pub says: Cow<'static, str>,
}

/// What else may have led to a picture is told of so many mistakes at most.
const TOLD: usize = 3;

impl Named {
    /// The same, with others that paint the same picture.
    fn or(&self, others: &[&Suspect]) -> Self {
        let others = others.iter().flat_map(|other| &other.mistakes).take(TOLD);
        let mut says = vec![self.says.as_ref()];
        for other in others {
            // A change of the scene may be what an edit of the shader is.
            if !says.contains(&other.says.as_ref()) {
                says.push(&other.says);
            }
        }
        Self {
            name: self.name,
            says: says.join("; or that ").into(),
        }
    }
}

/// Pictures are first compared at so many pixels a side at most, and are no more work than this, so that hundreds of pictures take seconds.
const SMALL: u32 = 96;
const SMALL_WORK: u64 = 100_000;

/// What explains a small picture is looked at in one that may be so much work.
const LARGE_WORK: u64 = 16 * SMALL_WORK;

/// Fewer pixels than this tell nothing.
const FEWEST: u32 = 256;

/// Where fewer pixels are wrong, larger pictures are compared: more of them a side, and as much more work.
const ENOUGH: u64 = 32;
const FINER: u32 = 3;

/// Fewer wrong pixels than this may be anything, even secondary rays of another style.
const FEW: u64 = 8;

/// Of mistakes that paint the same picture the first is named; with more than so many others beside it, none: there are too many
/// explanations.
const MANY: usize = 3;

/// Fewer pixels are not explained by a mistake that explains them all, and of more than so many, so many are looked at.
const FEWEST_EXPLAINED: usize = 4;
const MOST_EXPLAINED: usize = 40;

/// So many pairs of mistakes are painted before it is asked whether one of them explains the picture.
const AT_ONCE: usize = 32;

/// The tracers that have a classic mistake in them. Their pictures are painted once, when they are first asked for.
#[derive(Debug)]
pub struct Suspects {
    scene: Scene,
    moment: Moment,
    /// Of few pixels.
    small: View,
    /// What paints the scene rightly: the tracer, and the shaders.
    right: Vec<Suspect>,
    /// What loses so much of the picture that many mistakes may have led to it.
    general: Vec<Suspect>,
    wrong: Vec<Suspect>,
    /// The shader that paints the scene, as students write it, in each of the styles that matter.
    styles: Vec<String>,
    /// The same with larger pictures, made when they are needed; none if these are large.
    finer: Option<OnceLock<Box<Suspects>>>,
}

impl Suspects {
    /// Of a scene, for pictures of that frame; none if it takes so long to paint that no picture worth comparing is small enough.
    #[must_use]
    pub fn of(scene: &Scene, frame: &Frame) -> Option<Self> {
        let small = View::of(frame, SMALL, SMALL_WORK / work(scene));
        let is_enough = small.pixels() >= u64::from(FEWEST).min(pixels(frame));
        is_enough.then(|| Self::in_size(scene, small, Some(OnceLock::new())))
    }

    fn in_size(scene: &Scene, small: View, finer: Option<OnceLock<Box<Self>>>) -> Self {
        let moment = Moment {
            frame: small.frame.frame,
            time: f64::from(small.frame.time),
        };
        let styles = export::shader(scene)
            .map(|text| edit::styles(&text))
            .unwrap_or_default();
        let tracer = Made::Scene(Box::new(scene.clone()), moment);
        let rights = [tracer]
            .into_iter()
            .chain(styles.iter().cloned().map(Made::Shader));
        let changed = |change: change::Change| {
            Suspect::new(
                vec![change.named],
                Made::Scene(Box::new(change.scene), change.moment),
            )
        };
        let edited = styles
            .iter()
            .flat_map(|text| catalogue::all().filter_map(|mistake| Suspect::edited(text, mistake)));
        let changes = change::all(scene, moment).into_iter().map(changed);
        Self {
            scene: scene.clone(),
            moment,
            small,
            right: rights.map(|made| Suspect::new(Vec::new(), made)).collect(),
            general: change::general(scene, moment).into_iter().map(changed).collect(),
            wrong: edited.chain(changes).collect(),
            styles,
            finer,
        }
    }

    /// The same for pictures large enough to tell one mistake from another where few pixels are wrong.
    fn finer(&self, frame: &Frame) -> Option<&Self> {
        let finer = self.finer.as_ref()?;
        let work = u64::from(FINER * FINER) * SMALL_WORK / work(&self.scene);
        let large = View::of(frame, FINER * SMALL, work);
        let is_finer = large.pixels() > self.small.pixels();
        is_finer.then(|| {
            finer
                .get_or_init(|| Box::new(Self::in_size(&self.scene, large, None)))
                .as_ref()
        })
    }

    /// The mistake, or the two, that paint what the `student`'s shader does in that frame, in f64. Where no single one
    /// does, two at once are looked for, `pairs` of them at most: the same whatever else the machine does.
    #[must_use]
    pub fn recognise(&self, student: &Program, frame: &Frame, pairs: usize) -> Option<Vec<Named>> {
        let small = paint(student, &self.small)?;
        let pixels = small.pixels().len();
        let rights = self.right.iter().filter_map(|right| right.picture(&self.small));
        let (differing, right) = rights
            .map(|right| (look::differing(&small, right), right))
            .min_by_key(|&(differing, _)| differing)?;
        if differing < ENOUGH
            && let Some(finer) = self.finer(frame)
        {
            return finer.recognise(student, frame, pairs);
        }
        if differing < FEW || differing as f64 <= pixels as f64 * MAX_DIFFERING {
            return None;
        }
        let looked_at = Looked {
            differing,
            small: &small,
            view: &self.small,
        };
        let confirmed = |suspect: &Suspect, others: &[&Suspect]| {
            let mut named = self.confirm(suspect, student, frame)?;
            if let [single] = &mut named[..] {
                *single = single.or(others);
            }
            Some(named)
        };
        let generals = looked_at.matching(&self.general);
        let singles = looked_at.matching(&self.wrong);
        if let Some(general) = generals.first() {
            return match singles[..] {
                [single] => confirmed(single, &[]),
                _ => confirmed(general, &singles),
            };
        }
        if let Some((first, others)) = singles.split_first() {
            return (others.len() <= MANY).then(|| confirmed(first, others)).flatten();
        }
        // Some number takes all colour out of any picture, and so do many pairs: of one colour nothing more can be told.
        if small.pixels().windows(2).all(|pair| pair[0] == pair[1]) {
            return None;
        }
        let text = self.styles.first().map(String::as_str);
        let fitted = fit::suspects(&self.scene, self.moment, text, &looked_at, right);
        if let Some(suspect) = looked_at.matching(&fitted).first() {
            return confirmed(suspect, &[]);
        }
        let near = looked_at.near(self.general.iter().chain(&self.wrong));
        let restyled: Vec<Suspect> = near
            .iter()
            .flat_map(|suspect| suspect.in_other_styles(self.moment, self.scene.max_offset))
            .collect();
        if let Some(suspect) = looked_at.matching(&restyled).first() {
            return confirmed(suspect, &[]);
        }
        if pairs == 0 {
            return None;
        }
        // What is general comes first: of what paints the same picture, it says least that may not be so.
        let glance = Glance::at(student, &self.right, &self.small)?;
        let mut likely = pair::likely(self.general.iter().chain(&self.wrong), &looked_at, right);
        likely.truncate(pairs);
        likely.chunks(AT_ONCE).find_map(|pairs| {
            let painted: Vec<Suspect> = pairs
                .par_iter()
                .filter_map(|&pair| pair::both(pair, self.moment))
                .filter(|pair| glance.is_worth_a_look(pair) && looked_at.left(pair).is_some())
                .collect();
            looked_at
                .matching(&painted)
                .first()
                .and_then(|pair| confirmed(pair, &[]))
        })
    }

    /// The names, if a larger picture is explained as well, perhaps in another style of secondary rays.
    fn confirm(&self, suspect: &Suspect, student: &Program, frame: &Frame) -> Option<Vec<Named>> {
        let large = View::of(frame, u32::MAX, LARGE_WORK / work(&self.scene));
        let wrong = paint(student, &large)?;
        let right = self.right.first()?.made.paint(&large)?;
        let all = differing(&wrong, &right);
        let limit = left_over(all, wrong.pixels().len());
        drop(right);
        let explains = |suspect: &Suspect| {
            let picture = suspect.made.paint(&large);
            picture.is_some_and(|picture| differing(&wrong, &picture) <= limit)
        };
        let in_any_style = || {
            let others = suspect.in_other_styles(self.moment, self.scene.max_offset);
            others.par_iter().any(explains)
        };
        (explains(suspect) || in_any_style()).then(|| suspect.mistakes.clone())
    }

    /// The mistake that explains a few pixels in which the `student`'s shader is another color than it should be, and all that are not: it
    /// shows in nothing else. None with fewer than `FEWEST_EXPLAINED` pixels.
    #[must_use]
    pub fn explaining(&self, student: &Program, pixels: &[[u32; 2]]) -> Option<Named> {
        if pixels.len() < FEWEST_EXPLAINED {
            return None;
        }
        let step = pixels.len().div_ceil(MOST_EXPLAINED);
        let along = |axis: usize| {
            let places = pixels.iter().step_by(step).map(|pixel| pixel[axis]);
            let places: std::collections::BTreeSet<u32> = places.collect();
            places.into_iter().map(|place| f64::from(place) + 0.5).collect()
        };
        let view = View {
            frame: self.small.frame.clone(),
            places: Places {
                columns: along(0),
                rows: along(1),
            },
        };
        let own = paint(student, &view)?;
        let right = self.right.first()?.made.paint(&view)?;
        let wrong = differing(&own, &right);
        let explains = |suspect: &&Suspect| {
            let picture = suspect.made.paint(&view);
            picture.is_some_and(|picture| differing(&own, &picture) == 0)
        };
        if wrong < FEWEST_EXPLAINED as u64 {
            return None;
        }
        let explaining: Vec<&Suspect> = self.wrong.par_iter().filter(explains).collect();
        let (first, others) = explaining.split_first()?;
        (others.len() <= MANY).then(|| first.mistakes[0].or(others))
    }
}
