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
use super::{ProjectCase, frame_timeout};
use crate::engine::confirm::{Confirmation, apply};

/// Renders a project after an edit of a pass, a limited number of times.
#[derive(Debug)]
pub(super) struct Replays<'a> {
    case: &'a ProjectCase<'a>,
    pass: usize,
    left: AtomicUsize,
    deadline: Instant,
}

impl<'a> Replays<'a> {
    pub(super) fn new(case: &'a ProjectCase<'a>, pass: usize, most: usize, deadline: Instant) -> Self {
        Self {
            case,
            pass,
            left: AtomicUsize::new(most),
            deadline,
        }
    }

    /// The image of the project after an edit of the pass, if it is the expected one.
    pub(super) fn confirm(&self, fix: &Fix) -> Option<Confirmation> {
        let decrement = |left: usize| left.checked_sub(1);
        self.left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, decrement)
            .ok()?;
        let case = self.case;
        let changed = self.edited(fix)?;
        let own = case.project.shader;
        let passes = own.checked.iter().enumerate();
        let shader = PassShader {
            checked: passes
                .map(|(at, &checked)| changed.get(&at).unwrap_or(checked))
                .collect(),
            ..own.clone()
        };
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

    /// The passes that an edit changes: the wrong one, and all others if it is an edit of Common.
    fn edited(&self, fix: &Fix) -> Option<HashMap<usize, Checked>> {
        let project = self.case.project;
        let checked = |pass: usize, edits: Vec<Edit>| {
            let fix = Fix {
                message: String::new(),
                edits,
            };
            let text = apply(project.text(pass), &fix)?;
            let original = project.shader.checked[pass];
            Some((pass, with_suffix(original, &text, "", self.case.lenient)?))
        };
        let file = project.file(self.pass);
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
        let others =
            (0..project.shader.checked.len()).filter(|&pass| pass != self.pass && !of_common.is_empty());
        let others: Vec<usize> = others.collect();
        let mut changed = HashMap::new();
        for pass in others {
            let edits = of_common
                .iter()
                .map(|edit| self.in_pass(edit, pass))
                .collect::<Option<_>>()?;
            changed.extend([checked(pass, edits)?]);
        }
        changed.extend([checked(self.pass, edits)?]);
        Some(changed)
    }

    /// An edit of Common as one of the text of a pass, which contains Common.
    fn in_pass(&self, edit: &Edit, pass: usize) -> Option<Edit> {
        let project = self.case.project;
        let common: FileId = edit.span.file;
        let start = project.text(pass).find(project.files.get(common).text())? as u32;
        let mut edit = edit.clone();
        edit.span.file = project.file(pass);
        edit.span.start += start;
        edit.span.end += start;
        Some(edit)
    }
}
