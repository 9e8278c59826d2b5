//! The search in the passes of a project that holds other textures than the reference: each edit of any pass
//! is tried in the whole project, which is rendered from frame 0 on at a small size.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;
use toyproof_diagnostic::{Files, Span};
use toyproof_eval::{Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::{Frame, Image, Texture};
use toyproof_player::Target;
use toyproof_verify::MAX_DIFFERING;
use toyproof_verify::project::bind::{clock, programs};
use toyproof_verify::project::playback::{CpuPlayback, PassShader};

use super::difference::Difference;
use super::replay::{Replays, edited, with_changed};
use super::side_by_side::plain;
use super::{ProjectCase, frame_timeout};
use crate::repair::{ListedEdit, Repair, SearchResult, Suspect, edits};

/// The largest number of pixels of an image.
const MAX_PIXELS: f64 = 1200.0;

/// The last frame that is rendered.
const MAX_FRAME: i32 = 62;

/// The number of frames after the first wrong one that must be right, too.
const FRAMES_AFTER: i32 = 2;

/// The largest cost of an edit.
const MAX_COST: u32 = 24;

/// How much higher than that of the first repair the rank of an alternative may be.
const MAX_EXTRA_RANK: f64 = 2.0;

/// The largest number of loop iterations of a pixel after an edit, which may make a loop endless.
const MAX_ITERATIONS: u32 = 1 << 14;

/// The work of compiling an edited pass, in pixels that are rendered in the same time.
const COMPILE_WORK: usize = 20_000;

/// The work for each unit of the budget, in pixels.
const PIXELS_PER_UNIT: f64 = 2e7;

/// How much lower the rank of an edit is in a statement where others removed all of the difference.
const PROGRESS_BONUS: f64 = 6.0;

/// The number of edits that are tried between two decisions on how to continue.
const BATCH: usize = 64;

/// The largest number of repairs.
const MAX_REPAIRS: usize = 3;

/// The largest number of suspects.
const MAX_SUSPECTS: usize = 3;

/// The channels that are not compared: the image shows no alpha.
const IGNORED: [bool; 4] = [false, false, false, true];

/// What the search found.
pub(super) struct Found {
    /// The first frame whose image is wrong.
    pub(super) frame: i32,
    pub(super) search: SearchResult,
}

/// Searches all passes within a budget for edits after which the image is right in all frames; `None` if no
/// frame is wrong at the small size.
pub(super) fn search(case: &ProjectCase, budget: f64, replays: &Replays, deadline: Instant) -> Option<Found> {
    let small = Small::new(case, deadline)?;
    let mut left = small.edits();
    let mut search = SearchResult::default();
    let mut progress = Progress::default();
    let mut work = 0;
    let mut best_rank = f64::INFINITY;
    loop {
        let rank = |edit: &PassEdit| {
            f64::from(edit.listed.cost) - PROGRESS_BONUS * progress.of(edit.listed.statement)
        };
        left.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
        let batch: Vec<PassEdit> = left.drain(..BATCH.min(left.len())).collect();
        let is_spent = work as f64 > budget * PIXELS_PER_UNIT;
        let is_worse = batch
            .first()
            .is_none_or(|first| rank(first) > best_rank + MAX_EXTRA_RANK);
        if is_spent || is_worse || search.repairs.len() >= MAX_REPAIRS || Instant::now() >= deadline {
            search.is_cut = is_spent && !batch.is_empty();
            break;
        }
        let ranks: Vec<f64> = batch.iter().map(rank).collect();
        let outcomes: Vec<(Outcome, usize)> = batch.par_iter().map(|edit| small.outcome(edit)).collect();
        work += outcomes.iter().map(|(_, work)| work).sum::<usize>();
        for ((edit, rank), (outcome, _)) in batch.into_iter().zip(ranks).zip(outcomes) {
            if let Outcome::Wrong { remaining } = outcome {
                progress.add(edit.listed.statement, 1.0 - remaining);
            }
            if matches!(outcome, Outcome::Right)
                && search.repairs.len() < MAX_REPAIRS
                && let Some(confirmation) = replays.confirm(edit.pass, &edit.listed.fix)
            {
                progress.add(edit.listed.statement, 1.0);
                best_rank = best_rank.min(rank);
                search.repairs.push(Repair {
                    fix: edit.listed.fix,
                    mistake: edit.listed.mistake,
                    agreeing: confirmation.agreeing,
                    pixels: confirmation.pixels,
                    by_means: confirmation.by_means,
                    image: confirmation.image,
                });
            }
        }
    }
    search.suspects = progress.suspects(case.project.files);
    Some(Found {
        frame: small.first,
        search,
    })
}

/// An edit of a pass.
struct PassEdit {
    pass: usize,
    listed: ListedEdit,
}

/// The largest share of the difference that an edit of each statement removes.
#[derive(Default)]
struct Progress(HashMap<Span, f64>);

impl Progress {
    fn add(&mut self, statement: Span, removed: f64) {
        let best = self.0.entry(statement).or_insert(0.0);
        *best = best.max(removed);
    }

    fn of(&self, statement: Span) -> f64 {
        self.0.get(&statement).copied().unwrap_or(0.0)
    }

    /// The statements where edits remove most of the difference, on different lines.
    fn suspects(&self, files: &Files) -> Vec<Suspect> {
        let all = self.0.iter().filter(|&(_, &removed)| removed > 0.0);
        let mut all: Vec<Suspect> = all.map(|(&span, &score)| Suspect { span, score }).collect();
        let place = |suspect: &Suspect| (suspect.span.file, suspect.span.start);
        all.sort_by(|a, b| b.score.total_cmp(&a.score).then(place(a).cmp(&place(b))));
        let line = |suspect: &Suspect| {
            let origin = files.origin(suspect.span);
            (origin.file, files.position(origin).line)
        };
        let mut suspects: Vec<Suspect> = Vec::new();
        for suspect in all {
            if suspects.len() == MAX_SUSPECTS {
                break;
            }
            if suspects.iter().all(|known| line(known) != line(&suspect)) {
                suspects.push(suspect);
            }
        }
        suspects
    }
}

/// What the images are after an edit.
enum Outcome {
    /// There are none: the edit is invalid.
    Invalid,
    /// One is wrong; the share of the difference that is left.
    Wrong { remaining: f64 },
    /// All are right.
    Right,
}

/// The project at a small size.
struct Small<'a> {
    case: &'a ProjectCase<'a>,
    frame: Frame,
    programs: Vec<Program>,
    /// The images of the reference, from frame 0 on.
    expected: Vec<Arc<Image>>,
    /// The first frame whose image is wrong.
    first: i32,
    /// The number of wrong pixels in each frame, before an edit.
    before: Vec<usize>,
    deadline: Instant,
}

impl<'a> Small<'a> {
    fn new(case: &'a ProjectCase<'a>, deadline: Instant) -> Option<Self> {
        let [width, height] = case.frame.size.map(f64::from);
        let scale = (MAX_PIXELS / (width * height)).sqrt().min(1.0);
        let mut frame = case.frame.clone();
        frame.size = case
            .frame
            .size
            .map(|side| ((f64::from(side) * scale).round() as u32).max(1));
        frame.mouse = case.frame.mouse.map(|place| place * scale as f32);
        let timeout = frame_timeout(deadline);
        let reference = programs(case.reference.shader, timeout, case.pool).ok()?;
        let mut small = Self {
            case,
            frame,
            programs: programs(case.project.shader, timeout, case.pool).ok()?,
            expected: Vec::new(),
            first: 0,
            before: Vec::new(),
            deadline,
        };
        let last = case.frame.frame.min(MAX_FRAME);
        let mut expected = Vec::new();
        small.play(case.reference.shader, reference.iter(), last, |image| {
            expected.push(image);
            true
        })?;
        small.expected = expected;
        let mut before = Vec::new();
        let mut first = None;
        small.play(case.project.shader, small.programs.iter(), last, |image| {
            let difference = small.difference(before.len(), &image);
            if first.is_none() && difference.ratio() > MAX_DIFFERING {
                first = Some(before.len() as i32);
            }
            before.push(difference.pixels);
            first.is_none_or(|first| before.len() as i32 <= first + FRAMES_AFTER)
        })?;
        small.before = before;
        small.first = first?;
        Some(small)
    }

    /// Renders frames until `visit` returns false for an image; `None` if one cannot be rendered.
    fn play<'p>(
        &self,
        shader: &PassShader<'p>,
        programs: impl IntoIterator<Item = &'p Program>,
        last: i32,
        mut visit: impl FnMut(Arc<Image>) -> bool,
    ) -> Option<()> {
        let clock = clock(&self.frame);
        let timeout = frame_timeout(self.deadline);
        let settings = Settings::<f64> {
            max_iterations: MAX_ITERATIONS,
            ..plain()
        };
        let mut playback = CpuPlayback::new(shader, programs, None, timeout, settings);
        for number in 0..=last {
            playback.render(&clock.frame(number)).ok()?;
            let image = playback.texture(Target::Image).map(Texture::to_single)?;
            if !visit(image.into_iter().next()?) {
                break;
            }
        }
        Some(())
    }

    fn difference(&self, frame: usize, image: &Image) -> Difference {
        let tolerance = Some(self.case.expected.tolerance());
        Difference::new(image, &self.expected[frame], IGNORED, tolerance)
    }

    /// The edits of all passes. An edit of Common is an edit of the first pass that uses the edited code.
    fn edits(&self) -> Vec<PassEdit> {
        let project = self.case.project;
        let mut of_common = HashSet::new();
        let mut all = Vec::new();
        for (pass, checked) in project.shader.checked.iter().enumerate() {
            let references = &self.case.reference.shader.checked;
            let own = edits(checked, project.text(pass), references, MAX_COST).into_iter();
            all.extend(own.filter_map(|edit| {
                let places = edit.fix.edits.iter().map(|edit| {
                    let origin = project.files.origin(edit.span);
                    (origin.file, origin.start, origin.end, edit.replacement.clone())
                });
                let places: Vec<_> = places.collect();
                let is_common = places.iter().any(|(file, ..)| !project.tabs.contains(file));
                (!is_common || of_common.insert(places)).then_some(PassEdit { pass, listed: edit })
            }));
        }
        all
    }

    /// Renders the project with an edit, up to the first image that is wrong. Also returns the work in pixels.
    fn outcome(&self, edit: &PassEdit) -> (Outcome, usize) {
        let invalid = (Outcome::Invalid, COMPILE_WORK);
        let Some(changed) = edited(self.case, edit.pass, &edit.listed.fix) else {
            return invalid;
        };
        let timeout = frame_timeout(self.deadline);
        let compiled = changed.iter().map(|(&at, checked): (&usize, &Checked)| {
            let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(timeout));
            Some((at, program.ok()?))
        });
        let Some(compiled) = compiled.collect::<Option<HashMap<usize, Program>>>() else {
            return invalid;
        };
        let shader = with_changed(self.case.project.shader, &changed);
        let own = self.programs.iter().enumerate();
        let programs = own.map(|(at, program)| compiled.get(&at).unwrap_or(program));
        let (mut frames, mut outcome) = (0, Outcome::Right);
        let last = self.before.len() as i32 - 1;
        let first = self.first as usize;
        let played = self.play(&shader, programs, last, |image| {
            let difference = self.difference(frames, &image);
            let number = frames;
            frames += 1;
            // An edit must not make a right image differ in the few pixels that a verdict permits.
            if difference.ratio() <= MAX_DIFFERING && difference.pixels <= self.before[number] {
                return true;
            }
            let remaining = if number < first {
                // This frame was right before.
                1.0
            } else {
                difference.pixels as f64 / self.before[first].max(1) as f64
            };
            outcome = Outcome::Wrong { remaining };
            false
        });
        let pixels = self.frame.size[0] as usize * self.frame.size[1] as usize * self.programs.len();
        let work = COMPILE_WORK + frames * pixels;
        match played {
            Some(()) => (outcome, work),
            None => (Outcome::Invalid, work),
        }
    }
}
