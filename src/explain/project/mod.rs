//! Explanations of a project with a wrong image: the pass in which it departs from a reference project, and
//! the repairs of that pass.
//!
//! Both projects are rendered side by side. A pass that differs although it reads what the reference's reads
//! is wrong, and is one shader in one frame: it is explained like any other (`step`). Where passes hold other
//! things than the reference's, edits are tried in the whole project (`whole`). A repair counts if the project
//! with it renders the expected image, from frame 0 on (`replay`).

mod difference;
mod replay;
mod side_by_side;
mod step;
#[cfg(test)]
mod tests;
mod whole;
mod wrapper;

use std::time::{Duration, Instant};

use rayon::ThreadPool;
use toyproof_diagnostic::{FileId, Files};
use toyproof_image::Frame;
use toyproof_player::Target;
use toyproof_verify::bounds::{EXPLANATION_TIMEOUT, explanation_deadline};
use toyproof_verify::contain::Panic;
use toyproof_verify::project::playback::PassShader;
use toyproof_verify::{Expected, within};

use self::replay::Replays;
use self::side_by_side::Players;
use crate::departure::Departure;
use crate::known::Diagnosis;
use crate::repair::SearchResult;

/// The work of replays for each unit of the budget, in pixels of passes.
const REPLAYED_PIXELS_PER_UNIT: f64 = 2e7;

/// The least number of replays.
const MIN_REPLAYS: usize = 2;

/// The largest number of replays.
const MAX_REPLAYS: usize = 24;

/// The share of the budget for the search in the whole project, after a search in one pass.
const SHARE_AFTER_PASS: f64 = 0.4;

/// A project with its texts.
#[derive(Debug, Clone, Copy)]
pub struct Project<'a> {
    /// The passes that render the project's image.
    pub shader: &'a PassShader<'a>,
    /// The texts.
    pub files: &'a Files,
    /// The tab of each pass.
    pub tabs: &'a [FileId],
}

/// What is explained, and how.
#[derive(Debug, Clone, Copy)]
pub struct ProjectCase<'a> {
    /// The project with the wrong image.
    pub project: Project<'a>,
    /// The project with the expected image.
    pub reference: Project<'a>,
    /// The image of the reference in the frame.
    pub expected: &'a Expected,
    /// The frame that was checked, without the channels of the image.
    pub frame: &'a Frame,
    /// The budget of the search for repairs, as in
    /// [`SearchOptions`](crate::repair::SearchOptions::budget).
    pub budget: f64,
    /// Whether the values that depart from those of the reference are rendered.
    pub value_images: bool,
    /// The evaluator's pool; rayon's global pool if `None`.
    pub pool: Option<&'a ThreadPool>,
}

/// Where a project departs from a reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PassDeparture {
    /// The pass.
    pub pass: Target,
    /// The first frame in which the pass differs.
    pub frame: i32,
}

/// Why the image of a project is wrong.
#[derive(Debug)]
pub struct ProjectExplanation {
    /// The first pass that differs.
    pub departure: PassDeparture,
    /// Where the values of the pass depart from those of the reference's.
    pub values: Option<Departure>,
    /// The known mistake that explains the image of the pass.
    pub mistake: Option<Diagnosis>,
    /// The repairs of the pass and its suspect lines; `None` if the difference is too small to search for
    /// them.
    pub search: Option<SearchResult>,
    /// Whether only a hang ended the explanation.
    pub is_cut_by_time: bool,
    /// Internal errors; the parts in which they occurred are missing here.
    pub panics: Vec<Panic>,
}

/// Explains why the image of a project is wrong; `None` if its passes do not correspond to those of the
/// reference.
#[must_use]
pub fn explain(case: &ProjectCase) -> Option<ProjectExplanation> {
    let deadline = explanation_deadline(case.budget);
    let passes = [case.project, case.reference].map(|project| project.shader.graph.passes().len());
    // A texture that is given in place of a pass changes what the image reads.
    if passes.contains(&1) || case.frame.channels.iter().any(Option::is_some) {
        return None;
    }
    let replays = max_replays(case);
    let by_pass = explain_pass(case, replays, deadline);
    let search = by_pass.as_ref().and_then(|found| found.search.as_ref());
    if search.is_some_and(|search| !search.repairs.is_empty()) {
        return by_pass;
    }
    let replays = Replays::new(case, replays, deadline);
    let share = if by_pass.is_some() { SHARE_AFTER_PASS } else { 1.0 };
    let whole = within(case.pool, || {
        whole::search(case, share * case.budget, &replays, deadline)
    });
    let Some(whole) = whole.filter(|whole| by_pass.is_none() || !whole.search.repairs.is_empty()) else {
        return by_pass;
    };
    let departure = PassDeparture {
        pass: Target::Image,
        frame: whole.frame,
    };
    let mut explained = by_pass.unwrap_or_else(|| ProjectExplanation {
        departure,
        values: None,
        mistake: None,
        search: None,
        is_cut_by_time: false,
        panics: Vec::new(),
    });
    explained.search = Some(whole.search);
    explained.is_cut_by_time |= Instant::now() >= deadline;
    Some(explained)
}

/// Explains the first pass that differs; `None` if none is wrong in both projects, or its texture does not
/// hold what the reference's holds.
fn explain_pass(case: &ProjectCase, replays: usize, deadline: Instant) -> Option<ProjectExplanation> {
    let players = Players::new(case, deadline)?;
    let wrong = within(case.pool, || players.first_wrong(replays)).filter(|wrong| wrong.corresponds)?;
    let replays = Replays::new(case, replays, deadline);
    let mut explained = step::explain(case, &wrong, &replays);
    Some(ProjectExplanation {
        departure: wrong.departure,
        values: explained.as_mut().and_then(|findings| findings.departure.take()),
        mistake: explained.as_mut().and_then(|findings| findings.mistake.take()),
        search: explained.as_mut().and_then(|findings| findings.search.take()),
        is_cut_by_time: Instant::now() >= deadline,
        panics: explained.map_or_else(Vec::new, |findings| findings.panics),
    })
}

/// The number of times that the project is rendered again from the first frame on.
fn max_replays(case: &ProjectCase) -> usize {
    let [width, height] = case.frame.size.map(f64::from);
    let frames = f64::from(case.frame.frame) + 1.0;
    let pixels = width * height * frames * case.project.shader.graph.passes().len() as f64;
    let affordable = case.budget * REPLAYED_PIXELS_PER_UNIT / pixels;
    (affordable as usize).clamp(MIN_REPLAYS, MAX_REPLAYS)
}

impl<'a> Project<'a> {
    /// The text of a pass, after that of Common.
    fn text(&self, pass: usize) -> &'a str {
        self.files.get(self.file(pass)).text()
    }

    /// The file with the text of a pass.
    fn file(&self, pass: usize) -> FileId {
        let checked = self.shader.checked[pass];
        checked.tree[checked.main_image].at.span.file
    }
}

/// The time limit of a frame, which only a hang exceeds.
fn frame_timeout(deadline: Instant) -> Duration {
    deadline
        .saturating_duration_since(Instant::now())
        .min(EXPLANATION_TIMEOUT)
}
