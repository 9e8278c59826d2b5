//! What went wrong, by name: a wrong picture is compared with those of the shader that paints the scene, each with one classic
//! mistake made in it, and with two at once where no single one explains it.

mod catalogue;
mod edit;

use std::collections::BTreeSet;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use self::catalogue::{CATALOGUE, Mistake};
use crate::compare::{MAX_DIFFERING, Pixel, SEEN};
use crate::eval::{Program, Settings, Variant};
use crate::export;
use crate::frame::Frame;
use crate::glsl;
use crate::image::Image;
use crate::scene::Scene;
use crate::source::{File, Files};

/// What explains a wrong picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Named {
    /// The mistake.
    pub name: &'static str,
    /// What a tracer does that makes it, to stand after “a tracer that”.
    pub says: &'static str,
}

/// Pictures are first compared at so many pixels a side at most: a thousand of them take a second.
const SMALL: u32 = 96;

/// A mistake explains a picture if it leaves no more than this share of the pixels that were wrong, and of all pixels, another visible
/// colour: secondary rays of another style shift the edges of shadows and of what mirrors show.
const LEFT_OVER: f64 = 0.05;
const MAX_LEFT_OVER: f64 = 0.005;

/// Of mistakes that paint the same picture the first in the catalogue is named; with more than so many others beside it, none: a black
/// picture has too many explanations.
const MANY: usize = 2;

/// The longest that one picture may take: most take milliseconds.
const PATIENCE: Duration = Duration::from_secs(10);

/// The shaders that paint a scene with a classic mistake in them. Their pictures are painted once, when they are first asked for.
#[derive(Debug)]
pub struct Suspects {
    /// Of few pixels.
    frame: Frame,
    right: Suspect,
    wrong: Vec<Suspect>,
}

/// A shader, with the mistakes that were made in it.
#[derive(Debug)]
struct Suspect {
    mistakes: Vec<&'static Mistake>,
    text: String,
    picture: OnceLock<Option<Image>>,
}

impl Suspects {
    /// Of a scene, for pictures of that frame; none if the scene cannot be exported.
    #[must_use]
    pub fn of(scene: &Scene, frame: &Frame) -> Option<Self> {
        let styles = edit::styles(&export::shader(scene).ok()?);
        let right = Suspect::new(Vec::new(), styles.first()?.clone());
        let wrong = styles.iter().flat_map(|text| {
            let made = CATALOGUE.iter().map(|mistake| (mistake, mistake.made_in(text)));
            made.filter_map(|(mistake, text)| Some(Suspect::new(vec![mistake], text?)))
        });
        Some(Self {
            frame: smaller(frame),
            right,
            wrong: wrong.collect(),
        })
    }

    /// The mistake, or the two, that paint what the `student`'s shader does: `wrong`, painted in that frame in f64. Where no single one
    /// does, two at once are looked for, for as long as `patience` says.
    #[must_use]
    pub fn recognise(
        &self,
        student: &Program,
        wrong: &Image,
        frame: &Frame,
        patience: Duration,
    ) -> Option<Vec<Named>> {
        let small = paint(student, &self.frame, None)?;
        let pixels = small.pixels().len();
        let differing = differing(&small, self.right.picture(&self.frame)?);
        if differing as f64 <= pixels as f64 * MAX_DIFFERING {
            return None;
        }
        let limit = left_over(differing, pixels);
        let left = |picture: &Image| Some(self::differing(&small, picture)).filter(|&left| left <= limit);
        let singles = self.wrong.par_iter();
        let singles = singles.filter_map(|suspect| Some((left(suspect.picture(&self.frame)?)?, suspect)));
        let singles: Vec<(u64, &Suspect)> = singles.collect();
        if let Some(least) = singles.iter().map(|&(left, _)| left).min() {
            let mut best = singles.into_iter().filter(|&(left, _)| left == least);
            let (_, first) = best.next()?;
            let others: BTreeSet<_> = best
                .map(|(_, suspect)| suspect.mistakes[0].named().name)
                .collect();
            if others.len() > MANY {
                return None;
            }
            return first.confirm(wrong, &self.right.paint(frame, None)?, frame);
        }
        let deadline = Instant::now() + patience;
        let pairs: Vec<Suspect> = self.pairs().collect();
        let pairs = pairs.into_par_iter().filter_map(|pair| {
            let picture = pair.paint(&self.frame, Some(deadline))?;
            Some((left(&picture)?, pair))
        });
        let best = pairs
            .collect::<Vec<_>>()
            .into_iter()
            .min_by_key(|(left, _)| *left);
        best.and_then(|(_, pair)| pair.confirm(wrong, &self.right.paint(frame, None)?, frame))
    }

    /// Two mistakes at once, where they do not touch the same words.
    fn pairs(&self) -> impl Iterator<Item = Suspect> {
        self.wrong.iter().enumerate().flat_map(|(at, first)| {
            let second = self.wrong[at + 1..].iter().flat_map(|second| &second.mistakes);
            second.filter_map(|&mistake| {
                let mistakes = first.mistakes.iter().copied().chain([mistake]).collect();
                Some(Suspect::new(mistakes, mistake.made_in(&first.text)?))
            })
        })
    }
}

impl Suspect {
    fn new(mistakes: Vec<&'static Mistake>, text: String) -> Self {
        Self {
            mistakes,
            text,
            picture: OnceLock::new(),
        }
    }

    /// The picture in that frame, painted once: the frame is always the same. Nobody waits for it: a thread of rayon's that did, while it
    /// paints another for somebody else, might wait for itself.
    fn picture(&self, frame: &Frame) -> Option<&Image> {
        if self.picture.get().is_none() {
            // Somebody was faster, with the same picture.
            let _ = self.picture.set(self.paint(frame, None));
        }
        self.picture.get()?.as_ref()
    }

    fn paint(&self, frame: &Frame, deadline: Option<Instant>) -> Option<Image> {
        if deadline.is_some_and(|deadline| Instant::now() > deadline) {
            return None;
        }
        let mut files = Files::default();
        let file = files.add(File::new("<mistake>", self.text.as_str()));
        let checked = glsl::check(&files, file, &glsl::Options::default()).ok()?;
        paint(
            &Program::prepared(&checked, Variant::Plain).ok()?,
            frame,
            deadline,
        )
    }

    /// The names, if the whole picture is explained as well.
    fn confirm(&self, wrong: &Image, right: &Image, frame: &Frame) -> Option<Vec<Named>> {
        let limit = left_over(differing(wrong, right), wrong.pixels().len());
        let left = differing(wrong, &self.paint(frame, None)?);
        (left <= limit).then(|| self.mistakes.iter().map(|mistake| mistake.named()).collect())
    }
}

/// How many pixels may remain unexplained.
fn left_over(differing: u64, pixels: usize) -> u64 {
    let share = (differing as f64 * LEFT_OVER).min(pixels as f64 * MAX_LEFT_OVER);
    share.floor() as u64
}

/// The same frame in fewer pixels.
fn smaller(frame: &Frame) -> Frame {
    let [width, height] = frame.size;
    let divisor = width.max(height).div_ceil(SMALL);
    Frame {
        size: [width, height].map(|side| (side / divisor).max(1)),
        ..frame.clone()
    }
}

/// In how many pixels two pictures are visibly different.
fn differing(one: &Image, other: &Image) -> u64 {
    let differs = |&at: &usize| Pixel::at(at, one, other).difference() > SEEN;
    (0..one.pixels().len()).filter(differs).count() as u64
}

fn paint(program: &Program, frame: &Frame, deadline: Option<Instant>) -> Option<Image> {
    let settings = Settings::<f64> {
        variant: Variant::Plain,
        deadline: Some(deadline.unwrap_or_else(|| Instant::now() + PATIENCE)),
        ..Settings::default()
    };
    Some(program.paint(frame, &settings).ok()?.painting.image())
}
