//! Rewrites of the expressions in which a shader loses digits: forms from a catalogue of identities, tried on
//! the values that the shader really computes, as Herbie does for single functions (Panchekha et al.,
//! “Automatically Improving Accuracy for Floating Point Expressions”, PLDI 2015).

mod catalogue;
mod site;

use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use toyproof_diagnostic::{Deadline, Edit, File, Files, Fix, Span};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_image::Frame;

use self::catalogue::{RULES, shifted_variance};
use self::site::Definitions;
use crate::error::{Judge, Precision, Rendered, relative_time};

/// The most rewrites that are combined.
const MAX_ROUNDS: usize = 4;

/// The factor by which a rewrite must reduce the imprecise pixels or the largest error.
const MIN_GAIN: f64 = 2.0;

/// The rewrites that were found, and what they change.
#[derive(Debug, Clone)]
pub struct Rewrites {
    /// The edits, with the identities and their effect; `None` if there are none.
    pub fix: Option<Fix>,
    /// The shader with the edits.
    pub text: String,
    /// The shader's own error, against its image in double precision.
    pub before: Precision,
    /// The error with the edits, against the same image.
    pub after: Precision,
}

/// A shader whose expressions are rewritten.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The tree.
    pub checked: &'a Checked,
    /// Its text.
    pub text: &'a str,
    /// The frame in which it loses digits.
    pub frame: &'a Frame,
    /// Where digits are lost, if that is known: the nearest expressions are tried first.
    pub near: Option<Span>,
    /// The number of other forms that are tried in each of a few rounds.
    pub max_candidates: usize,
}

/// An expression with another form, and what else changes with it.
#[derive(Debug, Clone)]
struct Candidate {
    edits: Vec<Edit>,
    identity: &'static str,
    is_exact: bool,
}

/// Finds rewrites that make a shader more precise, until the deadline; `None` if it cannot be rendered in
/// time. No pixel becomes worse by more than one 8-bit level, except on edges, where rounding decides anyway.
#[must_use]
pub fn rewrite(subject: Subject<'_>, deadline: Instant, interrupt: &AtomicBool) -> Option<Rewrites> {
    let options = glsl::Options {
        deadline: Deadline::after(deadline.saturating_duration_since(Instant::now())),
        ..subject.checked.options()
    };
    let render = |text: &str, judge: Option<&Judge>| -> Option<Rendered> {
        let mut files = Files::default();
        let file = files.add(File::new("<rewrite>", text));
        let checked = glsl::check(&files, file, &options).ok()?;
        Rendered::new(&checked, subject.frame, deadline, judge)
    };
    let own = render(subject.text, None)?;
    let judge = Judge::new(&own, subject.frame, deadline);
    let before = judge.precision(&own);
    let mut best: Option<Rendered> = None;
    let mut error = before;
    let mut chosen: Vec<Candidate> = Vec::new();
    let candidates = if before.imprecise == 0 {
        Vec::new()
    } else {
        candidates(&subject)
    };
    for _ in 0..MAX_ROUNDS {
        let mut improved: Option<(Precision, Rendered, Candidate)> = None;
        for candidate in &candidates {
            if interrupt.load(Ordering::Relaxed) || Instant::now() > deadline {
                break;
            }
            let edits: Vec<&Edit> = chosen.iter().flat_map(|one| &one.edits).collect();
            let touches = |edit: &Edit| edits.iter().any(|other| other.span.touches(edit.span));
            if candidate.edits.iter().any(touches) {
                continue;
            }
            let edits: Vec<&Edit> = edits.into_iter().chain(&candidate.edits).collect();
            let Some(rendered) = render(&edited(subject.text, &edits), Some(&judge)) else {
                continue;
            };
            let now = judge.precision(&rendered);
            let least = improved.as_ref().map_or(error, |(least, ..)| *least);
            let is_equal = !candidate.is_exact || judge.is_equal(&rendered);
            if now < least && is_equal && !judge.is_worse(best.as_ref().unwrap_or(&own), &rendered) {
                improved = Some((now, rendered, candidate.clone()));
            }
        }
        let Some((now, rendered, candidate)) = improved.filter(|(now, ..)| error.gain(*now) >= MIN_GAIN)
        else {
            break;
        };
        (error, best) = (now, Some(rendered));
        chosen.push(candidate);
        if error.imprecise == 0 {
            break;
        }
    }
    let mut identities: Vec<_> = chosen.iter().map(|one| one.identity).collect();
    identities.dedup();
    let time = best.and_then(|best| relative_time(&own, &best, subject.frame, deadline));
    let edits: Vec<Edit> = chosen.into_iter().flat_map(|one| one.edits).collect();
    let advice = match &edits[..] {
        [edit] => format!("write `{}`, {}", edit.replacement, identities.join("; ")),
        _ => format!("write {} other forms: {}", edits.len(), identities.join("; ")),
    };
    let message = format!(
        "{advice}: {}{}",
        before.change(error),
        time.map_or_else(String::new, slower)
    );
    Some(Rewrites {
        text: edited(subject.text, &edits.iter().collect::<Vec<_>>()),
        fix: (!edits.is_empty()).then_some(Fix { message, edits }),
        before,
        after: error,
    })
}

/// All other forms of the shader's expressions, those of the nearest statements first.
fn candidates(subject: &Subject<'_>) -> Vec<Candidate> {
    let definitions = Definitions::new(subject.checked, subject.text);
    let mut seen = HashSet::new();
    let mut found = Vec::new();
    for site in definitions.sites() {
        let at = definitions.tree[site].at;
        if let Some(edits) = shifted_variance(&definitions, site) {
            found.push(Candidate {
                edits,
                identity: "the variance of differences from the first sample",
                is_exact: true,
            });
        }
        for rule in RULES {
            for form in (rule.forms)(&definitions, site).into_iter().flatten() {
                if seen.insert((at.spelling, form.clone())) {
                    found.push(Candidate {
                        edits: vec![Edit {
                            span: at.spelling,
                            replacement: form,
                        }],
                        identity: rule.name,
                        is_exact: rule.is_exact,
                    });
                }
            }
        }
    }
    if let Some(near) = subject.near {
        let distance = |candidate: &Candidate| candidate.edits[0].span.start.abs_diff(near.start);
        found.sort_by_key(distance);
    }
    // Exact identities before approximations.
    found.sort_by_key(|candidate| !candidate.is_exact);
    found.truncate(subject.max_candidates);
    found
}

fn edited(text: &str, edits: &[&Edit]) -> String {
    let mut edits = edits.to_vec();
    edits.sort_by_key(|edit| std::cmp::Reverse(edit.span.start));
    let mut text = text.to_owned();
    for edit in edits {
        text.replace_range(
            edit.span.start as usize..edit.span.end as usize,
            &edit.replacement,
        );
    }
    text
}

/// `, 4 % slower`
fn slower(time: f64) -> String {
    let percent = 100.0 * (time - 1.0);
    let word = if percent < 0.0 { "faster" } else { "slower" };
    format!(", {:.0} % {word}", percent.abs())
}

#[cfg(test)]
mod tests;
