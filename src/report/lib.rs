//! Reports of the findings, for people and for programs: one file per format, each a function of the records.
//!
//! # Parts
//!
//! - `record`: the record of a check, and the report of all records of a run.
//! - `terminal`, `csv`, `junit`, `sarif`, `html`: the formats; `verdict.schema.json` is that of
//!   `verdict.json`. `html` is one page that needs no network.
//! - [`platform`]: the results of autograders, and the files that grading platforms run.
//! - `hints`: redacts the hints that a report gives to the author of a wrong shader.
//! - `decision`: what a teacher decides instead.
//! - `rubric`: the marks of a shader; `class`: the table of a class.
//! - `frames`: one record of all frames of an assignment.
//! - `explanation`: the sections of `docs/guide/diagnostics.md` and `docs/guide/mistakes.md`, and terms.

mod assigned;
mod class;
mod comparison;
mod csv;
mod decision;
mod departure;
mod earlier;
mod explanation;
mod frames;
mod growth;
mod hints;
mod html;
mod junit;
pub mod platform;
mod profile;
mod reason;
mod record;
mod repair;
mod rubric;
mod rubrics;
mod sarif;
mod share;
mod submitted;
mod terminal;
mod thumbnails;
mod trace;
mod unused;

pub use assigned::{FeatureRecord, FunctionRecord, RulesRecord, Violation};
pub use class::ClassTable;
pub use comparison::{
    COMPARISON_SCHEMA, ComparedImages, ComparedShaders, ComparisonReport, FirstDifferenceRecord, ImageStatus,
    ShaderPlace,
};
pub use csv::csv;
pub use decision::{Decision, DecisionRecord};
pub use departure::{Departure, MissingValue, UnknownValue};
pub use earlier::{Change, Earlier};
pub use explanation::{Explanation, explain, explanations};
pub use frames::{CheckedFrame, FrameRecord};
pub use growth::{CauseName, GrowthFrame, GrowthRecord};
pub use hints::Hints;
pub use html::profile::profile_html;
pub use html::{
    Exhibit, Gallery, MAX_IMAGE_BYTES, MAX_PAGE_SHADERS, PARTS, html, html_index, html_part, part_name,
    parts as page, subsample,
};
pub use junit::{TestCase, TestStatus, junit, test_suite};
pub use profile::{ProfiledPass, profile_csv};
pub use reason::{Statement, failure_position, loop_truncated, state};
pub use record::{
    Alternative, DialectRecord, FrameResult, Mistake, Position, Record, Report, SCHEMA, Seconds,
};
pub use repair::{Repair, RepairEdit, SourceRange, Suspect};
pub use rubric::{Mark, Rubric, StudentImages, Visibility, optional_points};
pub use rubrics::Rubrics;
pub use sarif::sarif;
pub use submitted::{Late, StudentSubmission};
pub use terminal::{Detail, Layout, Tally, lines, place};
use terminal::{details, plain};
pub use thumbnails::Thumbnails;
pub use trace::{PixelTrace, TracedPixel};

/// The text that a report writes, in tests.
#[cfg(test)]
fn written(write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}
