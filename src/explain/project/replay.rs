//! Repairs of a pass are confirmed in the image of the project, which is rendered again from frame 0 on.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use toyproof_diagnostic::{Edit, FileId, Fix};
use toyproof_glsl::Checked;
use toyproof_lint::Lints;
use toyproof_player::Target;
use toyproof_verify::bounds::MAX_ITERATIONS;
use toyproof_verify::project::bind::{Renderers, bind};
use toyproof_verify::project::playback::PassShader;
use toyproof_verify::{Case, FromStart, Verdict, verify_within};

use super::wrapper::with_suffix;
use super::{Project, ProjectCase, frame_timeout};
use crate::engine::confirm::{Confirmation, apply, unset_variables};

/// Renders a project after edits of passes, a limited number of times.
#[derive(Debug)]
pub(super) struct Replays<'a> {
    case: &'a ProjectCase<'a>,
    /// The number of replays that are left.
    left: AtomicUsize,
    deadline: Instant,
}

impl<'a> Replays<'a> {
    pub(super) fn new(case: &'a ProjectCase<'a>, most: usize, deadline: Instant) -> Self {
        Self {
            case,
            left: AtomicUsize::new(most),
            deadline,
        }
    }

    /// The image of the project after an edit of a pass, if it is the expected one.
    pub(super) fn confirm(&self, pass: usize, fix: &Fix) -> Option<Confirmation> {
        let decrement = |left: usize| left.checked_sub(1);
        self.left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, decrement)
            .ok()?;
        let case = self.case;
        let changed = edited(case, pass, fix)?;
        let own = case.project.shader;
        let adds_unset =
            |(&at, edited): (&usize, &Checked)| unset_variables(edited) > unset_variables(own.checked[at]);
        if changed.iter().any(adds_unset) {
            return None;
        }
        let shader = with_changed(own, &changed);
        let image = own
            .graph
            .passes()
            .iter()
            .position(|pass| pass.target == Target::Image)?;
        let lints = Lints::default();
        let mut frame = case.frame.clone();
        let plain = Case::new(shader.checked[image], &lints, case.frame);
        let renderers = Renderers {
            driver: None,
            float: plain.float,
            timeout: frame_timeout(self.deadline),
            pool: case.pool,
        };
        let bound = bind(&shader, &mut frame, true, renderers).ok()??;
        let from_start = FromStart {
            double: &bound.double,
            growth: bound.growth.visible,
        };
        let image = Case {
            frame: &frame,
            pool: case.pool,
            from_start: Some(from_start),
            ..plain.with_expected(case.expected)
        };
        let verified = verify_within(&image, MAX_ITERATIONS, self.deadline).ok()?;
        let is_right = matches!(
            verified.ruling().verdict,
            Verdict::Correct | Verdict::Unstable | Verdict::Chaotic
        );
        let summary = &verified.results.algorithm.as_ref()?.summary;
        let (agreeing, pixels) = (summary.pixels - summary.differing, summary.pixels);
        is_right.then_some(Confirmation {
            agreeing,
            pixels,
            by_means: false,
            image: verified.results.actual,
        })
    }
}

/// A project with changed passes.
pub(super) fn with_changed<'a>(
    shader: &PassShader<'a>,
    changed: &'a HashMap<usize, Checked>,
) -> PassShader<'a> {
    let passes = shader.checked.iter().enumerate();
    PassShader {
        checked: passes
            .map(|(at, &checked)| changed.get(&at).unwrap_or(checked))
            .collect(),
        ..shader.clone()
    }
}

/// The passes that an edit of one changes: this one, and all others if it is an edit of Common.
pub(super) fn edited(case: &ProjectCase, pass: usize, fix: &Fix) -> Option<HashMap<usize, Checked>> {
    let project = case.project;
    let checked = |pass: usize, edits: Vec<Edit>| {
        let fix = Fix {
            message: String::new(),
            edits,
        };
        let text = apply(project.text(pass), &fix)?;
        let original = project.shader.checked[pass];
        Some((pass, with_suffix(original, &text, "")?))
    };
    let file = project.file(pass);
    let placed = |edit: &Edit| {
        let mut edit = edit.clone();
        edit.span.file = file;
        edit
    };
    let edits: Vec<Edit> = fix.edits.iter().map(placed).collect();
    let of_common = edits.iter().filter_map(|edit| {
        let origin = project.files.origin(edit.span);
        (!project.tabs.contains(&origin.file)).then(|| Edit {
            span: origin,
            ..edit.clone()
        })
    });
    let of_common: Vec<Edit> = of_common.collect();
    let others = (0..project.shader.checked.len()).filter(|&other| other != pass && !of_common.is_empty());
    let others: Vec<usize> = others.collect();
    let mut changed = HashMap::new();
    for other in others {
        let edits = of_common
            .iter()
            .map(|edit| in_pass(project, edit, other))
            .collect::<Option<_>>()?;
        changed.extend([checked(other, edits)?]);
    }
    changed.extend([checked(pass, edits)?]);
    Some(changed)
}

/// An edit of Common as one of the text of a pass, which contains Common.
fn in_pass(project: Project, edit: &Edit, pass: usize) -> Option<Edit> {
    let common: FileId = edit.span.file;
    let start = project.text(pass).find(project.files.get(common).text())? as u32;
    let mut edit = edit.clone();
    edit.span.file = project.file(pass);
    edit.span.start += start;
    edit.span.end += start;
    Some(edit)
}
