//! Repair: finds the lines that a wrong image depends on, and the smallest edits of the shader's own text
//! after which its image is the expected one.

mod copied;
mod edit;
mod edits;
mod evaluation;
mod listing;
mod localize;
mod scan;
mod schema;
mod search;
mod shader;
mod term;

use std::fmt;

use toyproof_diagnostic::{Fix, Span};
use toyproof_glsl::Checked;
use toyproof_image::Rgb8Image;

pub(crate) use self::edit::DOCUMENTED;
pub(crate) use self::listing::{ListedEdit, edits};
pub use self::search::corrects_one_mistake;
pub(crate) use self::search::{NoisyImage, search};
pub(crate) use self::shader::written;
pub use crate::engine::confirm::Confirmation;
use crate::known::KnownMistake;

/// The mistakes that repairs are named after.
#[cfg(test)]
pub(crate) fn mistakes() -> impl Iterator<Item = KnownMistake> {
    edit::EditKind::ALL.iter().map(|kind| kind.mistake())
}

/// The options of a search.
#[derive(Debug, Clone, Copy)]
pub struct SearchOptions<'a> {
    /// The text of the shader's file.
    pub source: &'a str,
    /// The work that may be done, in units of about a second on one core. Work is counted, not timed, so that
    /// the result is the same on any machine and with any number of threads.
    pub budget: f64,
    /// Expressions of correct shaders; if given, only these are tried.
    pub donors: Option<&'a Donors>,
    /// What an edit must do in the project of which the shader is a pass; `None` if it is no pass.
    pub pass: Option<&'a dyn EditedPass>,
}

/// A pass of a project, in which edits are tried.
pub trait EditedPass: fmt::Debug + Sync {
    /// Checks the text of the pass after an edit, as the case's shader was checked; `None` if it is invalid.
    fn check(&self, text: &str) -> Option<Checked>;

    /// The image of the project after an edit of the pass, if it is the expected one.
    fn confirm(&self, fix: &Fix) -> Option<Confirmation>;
}

/// Expressions of correct shaders for the same assignment. If no small edit repairs a shader, one of them
/// may.
#[derive(Debug, Default)]
pub struct Donors(Vec<edits::Donor>);

impl Donors {
    /// Collects the expressions of some shaders; their order does not matter.
    pub fn new<'a>(shaders: impl IntoIterator<Item = &'a Checked>) -> Self {
        Self(edits::donors(shaders.into_iter().map(|shader| &shader.tree)))
    }
}

/// The default of [`SearchOptions::budget`].
pub const DEFAULT_BUDGET: f64 = 5.0;

/// An edit of the shader, or two at once, after which its image is the expected one.
#[derive(Debug, Clone)]
pub struct Repair {
    /// The edits, with a sentence such as ``replace `tca + thc` with `tca - thc` ``.
    pub fix: Fix,
    /// The mistake of the shader, named by the kind of the edit.
    pub mistake: KnownMistake,
    /// The number of pixels that agree with the reference after the edit.
    pub agreeing: u64,
    /// The number of pixels that were compared.
    pub pixels: u64,
    /// Whether their means agree, because the shader has its own random numbers.
    pub by_means: bool,
    /// The image after the edit, as displayed.
    pub image: Rgb8Image,
}

/// A part of the shader on which the wrong pixels depend more than the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suspect {
    /// The statement.
    pub span: Span,
    /// The suspicion, from 0 to 1.
    pub score: f64,
}

/// The results of the search.
#[derive(Debug, Clone, Default)]
pub struct SearchResult {
    /// At most three repairs, the most likely first. Each alone repairs the image.
    pub repairs: Vec<Repair>,
    /// At most three suspects, on different lines, the most suspicious first; also if there are repairs.
    pub suspects: Vec<Suspect>,
    /// Whether the budget ended before all edits were tried. That a search ended at its deadline, which only
    /// a hang exceeds, is in [`Findings::is_cut_by_time`](crate::Findings::is_cut_by_time).
    pub is_cut: bool,
}
