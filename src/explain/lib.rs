//! Explains why an image is wrong or imprecise: [`check`] runs the three checks of `toyproof_verify`, and
//! [`explain`] searches for what explains a difference.
//!
//! A wrong image is compared with those of classic mistakes ([`known`]) and with the expected image as a
//! whole ([`whole_image`]); edits of the shader's text are tried until its image is the expected one
//! ([`repair`]). All three are hypotheses of one search engine (`engine`): its probes, its tournament, its
//! fit of numbers, its confirmation on whole images and its budget of work. Of a project with a wrong image,
//! the pass that is wrong is explained in this way ([`project`]). An imprecise image is traced to the
//! operation that loses the digits.
//!
//! # Example
//!
//! ```
//! use toyproof_diagnostic::{Deadline, File, Files};
//! use toyproof_explain::known::Hypotheses;
//! use toyproof_explain::{Options, check};
//! use toyproof_image::Frame;
//! use toyproof_verify::{Case, Expected, Verdict};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut files = Files::default();
//! let scene = files.add(File::new("red.toml", "[background]\ncolor = [1.0, 0.0, 0.0]\n"));
//! let scene = toyproof_scene::parse(&files, scene)?;
//! let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0, 0, 1, 1); }";
//! let shader = files.add(File::new("blue.glsl", text));
//! let checked = toyproof_glsl::check(&files, shader, &Default::default())?;
//! let lints = toyproof_lint::lint(&files, &checked, &Deadline::default());
//! let frame = Frame { size: [16, 9], ..Frame::default() };
//! let hypotheses = Hypotheses::new(&scene, &frame);
//! let expected = Expected::from_scene(scene, &frame);
//! let case = Case::new(&checked, &lints, &frame).with_expected(&expected);
//! let options = Options { hypotheses: hypotheses.as_ref(), ..Options::default() };
//! let findings = check(None, &case, &options)?;
//! assert_eq!(findings.verdict, Verdict::Wrong);
//! # Ok(())
//! # }
//! ```

pub mod departure;
mod engine;
pub mod equality;
pub mod known;
pub mod project;
pub mod repair;
mod search;
pub mod trail;
pub mod unused;
pub mod whole_image;

use toyproof_diagnostic::{Diagnostic, Span};
use toyproof_verify::compare::CheckSummary;
use toyproof_verify::contain::Panic;
use toyproof_verify::{Case, CheckResults, Driver, Failure, Reason, Ruling, Verdict, verify};

use crate::departure::Departure;
use crate::known::{Diagnosis, Hypotheses};
use crate::project::{PassDeparture, ProjectExplanation};
use crate::repair::{SearchOptions, SearchResult};
pub use crate::search::explain;
use crate::whole_image::Alternatives;

/// What is searched for.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options<'a> {
    /// The mistakes that are searched for in a wrong image, for the case's scene and frame.
    pub hypotheses: Option<&'a Hypotheses>,
    /// What a wrong image is compared with as a whole; `None` for no such comparison.
    pub alternatives: Option<Alternatives<'a>>,
    /// How to search for repairs of a wrong shader; `None` if not at all.
    pub search: Option<SearchOptions<'a>>,
    /// Whether the values that depart from those of the reference are rendered, see
    /// [`Departure::images`](departure::Departure::images).
    pub value_images: bool,
}

/// The final verdict, and what explains a difference.
#[derive(Debug)]
pub struct Explanation {
    /// The verdict and its reason.
    pub ruling: Ruling,
    /// The algorithm check without a permitted difference, if there is one.
    pub permitted: Option<CheckSummary>,
    /// Where the shader loses precision, if float32 is not enough and the place could be found; a note or a
    /// warning describes it.
    pub cause: Option<Span>,
    /// The known mistake, or the two, that explain a wrong image.
    pub mistake: Option<Diagnosis>,
    /// Where a wrong shader's values depart from those of its reference.
    pub departure: Option<Departure>,
    /// The repairs of a wrong shader and its suspect lines; `None` if they were not searched for.
    pub search: Option<SearchResult>,
    /// The known mistake that explains the few differing pixels of a correct image.
    pub tolerated_mistake: Option<Diagnosis>,
    /// Whether the explanation was cut by its time limit, which only a hang reaches: on another machine, the
    /// explanation may be another one.
    pub is_cut_by_time: bool,
    /// Notes about unbound channels and about the place where the shader loses precision.
    pub notes: Vec<Diagnostic>,
    /// Internal errors; the parts in which they occurred are missing here.
    pub panics: Vec<Panic>,
}

/// The results of the checks of a shader, with the explanation of a difference.
#[derive(Debug)]
pub struct Findings {
    /// The verdict.
    pub verdict: Verdict,
    /// Why.
    pub reason: Reason,
    /// The images and the checks. The algorithm check is the one without a permitted difference.
    pub results: CheckResults,
    /// Where the shader loses precision, if float32 is not enough and the place could be found.
    pub cause: Option<Span>,
    /// The known mistake, or the two, that explain a wrong image.
    pub mistake: Option<Diagnosis>,
    /// Where a wrong shader's values depart from those of its reference.
    pub departure: Option<Departure>,
    /// The repairs of a wrong shader and its suspect lines; `None` if they were not searched for.
    pub search: Option<SearchResult>,
    /// The pass in which a project departs from the one that it is compared with.
    pub pass_departure: Option<PassDeparture>,
    /// The known mistake that explains the few differing pixels of a correct image.
    pub tolerated_mistake: Option<Diagnosis>,
    /// Whether the explanation was cut by its time limit, which only a hang reaches.
    pub is_cut_by_time: bool,
    /// All notes, with their lines.
    pub notes: Vec<Diagnostic>,
    /// Internal errors; the parts in which they occurred are missing here.
    pub panics: Vec<Panic>,
}

impl Findings {
    /// Combines the results of the checks with their explanation.
    #[must_use]
    pub fn new(mut results: CheckResults, explanation: Explanation) -> Self {
        if let (Some(algorithm), Some(permitted)) = (&mut results.algorithm, explanation.permitted) {
            algorithm.summary = permitted;
        }
        let mut notes = std::mem::take(&mut results.notes);
        notes.extend(explanation.notes);
        notes.extend(results.driver_note.take());
        let mut panics = std::mem::take(&mut results.panics);
        panics.extend(explanation.panics);
        Self {
            verdict: explanation.ruling.verdict,
            reason: explanation.ruling.reason,
            results,
            cause: explanation.cause,
            mistake: explanation.mistake,
            departure: explanation.departure,
            search: explanation.search,
            pass_departure: None,
            tolerated_mistake: explanation.tolerated_mistake,
            is_cut_by_time: explanation.is_cut_by_time,
            notes,
            panics,
        }
    }

    /// Adds the explanation of a project.
    pub fn explain_with(&mut self, explanation: ProjectExplanation) {
        self.pass_departure = Some(explanation.departure);
        self.mistake = explanation.mistake;
        self.departure = explanation.values;
        self.search = explanation.search;
        self.is_cut_by_time |= explanation.is_cut_by_time;
        self.panics.extend(explanation.panics);
    }
}

/// Runs the three checks, and explains a difference. Without a `driver`, the evaluator renders the image, and
/// there is no toolchain check.
///
/// # Errors
/// Returns why there is no image of the shader.
pub fn check(driver: Option<&mut Driver>, case: &Case, options: &Options) -> Result<Findings, Failure> {
    let verified = verify(driver, case)?;
    let explanation = explain(&verified, options);
    Ok(Findings::new(verified.results, explanation))
}
