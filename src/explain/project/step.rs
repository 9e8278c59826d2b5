//! The wrong pass in one frame as a shader on its own, whose reference is the other project's pass.

use std::borrow::Cow;
use std::fmt::Write as _;

use toyproof_diagnostic::{FileId, Fix};
use toyproof_glsl::Checked;
use toyproof_lint::Lints;
use toyproof_player::Target;
use toyproof_verify::bounds::EXPLANATION_TIMEOUT;
use toyproof_verify::compare::EXACT_TOLERANCE;
use toyproof_verify::{Case, Expected, MAX_DIFFERING, ShaderReference};

use super::ProjectCase;
use super::difference::Difference;
use super::replay::Replays;
use super::side_by_side::Wrong;
use super::wrapper::{COLOR, POSITION, suffix, with_suffix};
use crate::repair::{Confirmation, EditedPass, SearchOptions};
use crate::whole_image::Alternatives;
use crate::{Findings, Options, check};

/// The largest part of the frame that is enlarged because few pixels are wrong.
const MAX_ENLARGED: f64 = 0.25;

/// The largest share of wrong pixels that are few.
const MAX_FEW: f64 = 10.0 * MAX_DIFFERING;

/// Explains the wrong pass; `None` if it cannot be compared alone.
pub(super) fn explain(case: &ProjectCase, wrong: &Wrong, replays: &Replays) -> Option<Findings> {
    let Wrong {
        pass,
        reference,
        step,
        ..
    } = wrong;
    let own = case.project.shader.checked[*pass];
    let solution = case.reference.shader.checked[*reference];
    let is_image = wrong.departure.pass == Target::Image;
    let takes_derivatives = own.takes_derivatives() || solution.takes_derivatives();
    let view = View::new(&step.difference, step.frame.size, is_image, takes_derivatives);
    let shown = |checked: &Checked, text: &str| view.check(checked, text);
    let text = case.project.text(*pass);
    let (own, solution) = match &view.suffix {
        None => (Cow::Borrowed(own), Cow::Borrowed(solution)),
        Some(_) => (
            Cow::Owned(shown(own, text)?),
            Cow::Owned(shown(solution, case.reference.text(*reference))?),
        ),
    };
    let tolerance = if is_image {
        case.expected.tolerance()
    } else {
        EXACT_TOLERANCE
    };
    let lints = Lints::default();
    let reference = ShaderReference::new(&solution, &lints, &step.reference, tolerance, EXPLANATION_TIMEOUT);
    let expected = Expected::Shader(Box::new(reference.ok()?.0));
    let shader = Case {
        pool: case.pool,
        ..Case::new(&own, &lints, &step.frame)
            .with_expected(&expected)
            .with_timeout(EXPLANATION_TIMEOUT)
    };
    let edited = Edited {
        original: case.project.shader.checked[*pass],
        pass: *pass,
        view: &view,
        replays,
    };
    let options = Options {
        hypotheses: None,
        // A buffer is no picture, in which left and right or a curve of colors could be wrong.
        alternatives: (is_image && view.suffix.is_none()).then(Alternatives::default),
        search: Some(SearchOptions {
            source: text,
            budget: case.budget,
            donors: None,
            pass: Some(&edited),
        }),
        value_images: case.value_images,
    };
    let mut findings = check(None, &shader, &options).ok()?;
    findings.mistake = findings.mistake.filter(|_| is_image);
    // Lines are those of the tab, which the report names, and not those of Common or of what is added.
    let is_in_tab = |span| case.project.files.origin(span).file == case.project.tabs[*pass];
    findings.departure = findings.departure.filter(|departure| {
        let mut spans = departure.spans();
        view.suffix.is_none() && spans.all(is_in_tab)
    });
    move_to(case.project.file(*pass), &mut findings);
    Some(findings)
}

/// Moves the places of repairs and suspects to the file of the shader, whose text is the same.
fn move_to(file: FileId, findings: &mut Findings) {
    let Some(search) = &mut findings.search else {
        return;
    };
    for repair in &mut search.repairs {
        for edit in &mut repair.fix.edits {
            edit.span.file = file;
        }
        if let Some(at) = &mut repair.mistake.at {
            at.file = file;
        }
    }
    for suspect in &mut search.suspects {
        suspect.span.file = file;
    }
}

/// How a pass is shown as an image.
#[derive(Debug)]
struct View {
    /// The function that maps the pass's texture to colors; `None` if the difference is visible without it.
    suffix: Option<String>,
}

impl View {
    /// Shows the channels that differ, each in the range of the reference's values. Pixels that are too few
    /// for a verdict are enlarged, unless that changes derivatives.
    fn new(difference: &Difference, size: [u32; 2], is_image: bool, takes_derivatives: bool) -> Self {
        let is_visible =
            is_image || difference.channels[3] == 0 && 2 * difference.visible >= difference.pixels;
        let body = if is_visible {
            String::new()
        } else {
            shown_channels(difference)
        };
        let enlarged = if takes_derivatives {
            None
        } else {
            enlarged(difference, size)
        };
        let is_plain = is_visible && enlarged.is_none();
        Self {
            suffix: (!is_plain).then(|| suffix(&body, enlarged.as_deref())),
        }
    }

    fn check(&self, shader: &Checked, text: &str) -> Option<Checked> {
        with_suffix(shader, text, self.suffix.as_deref().unwrap_or(""))
    }
}

/// The statement that maps the channels of a texture to [0, 1]. Alpha takes the place of the color in which
/// the fewest pixels differ.
fn shown_channels(difference: &Difference) -> String {
    let counts = &difference.channels;
    let mut channels = [0, 1, 2];
    if let Some(least) = (0..3).min_by_key(|&channel| counts[channel])
        && counts[3] > counts[least]
    {
        channels[least] = 3;
    }
    let shown = channels.map(|channel| {
        let (first, factor) = difference.ranges[channel].shown();
        let component = ["x", "y", "z", "w"][channel];
        format!("({COLOR}.{component} - ({first:?})) * {factor:?}")
    });
    let mut body = String::new();
    let _ = write!(body, "{COLOR} = vec4({}, 1.0);", shown.join(", "));
    body
}

/// The place of a pixel if the rectangle of the differing pixels fills the frame; `None` if many differ.
fn enlarged(difference: &Difference, size: [u32; 2]) -> Option<String> {
    let [first, last] = difference.rectangle;
    // Some pixels around the differing ones are right.
    let first = first.map(|place| place.saturating_sub(1));
    let last = [0, 1].map(|axis| (last[axis] + 1).min(size[axis]));
    let [width, height] = [0, 1].map(|axis| f64::from(last[axis].saturating_sub(first[axis])));
    let [columns, rows] = size.map(f64::from);
    let is_small = width * height <= MAX_ENLARGED * columns * rows;
    (difference.ratio() <= MAX_FEW && is_small && width * height > 0.0).then(|| {
        let [x, y] = first.map(f64::from);
        let [across, up] = [width / columns, height / rows];
        format!("vec2({x:?}, {y:?}) + floor({POSITION} * vec2({across:?}, {up:?})) + 0.5")
    })
}

/// The wrong pass after an edit.
#[derive(Debug)]
struct Edited<'a> {
    original: &'a Checked,
    pass: usize,
    view: &'a View,
    replays: &'a Replays<'a>,
}

impl EditedPass for Edited<'_> {
    fn check(&self, text: &str) -> Option<Checked> {
        self.view.check(self.original, text)
    }

    fn confirm(&self, fix: &Fix) -> Option<Confirmation> {
        self.replays.confirm(self.pass, fix)
    }
}
